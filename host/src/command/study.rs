//! `voidage study`: error against run time, for any scenes, grids, methods and numbers of threads; flows; how times grow.
//!
//! In reading order: [`values`], [`spread`], [`table`], [`session`]; [`recipe`], [`flows`], [`scaling`], [`case`]; [`row`], [`single`],
//! [`points`], [`measure`], [`left_out`]; [`found`], [`pictures`], [`page`].

pub mod case;
pub mod flows;
pub mod found;
pub mod left_out;
pub mod measure;
pub mod page;
pub mod pictures;
pub mod points;
pub mod recipe;
pub mod row;
pub mod scaling;
pub mod session;
pub mod single;
pub mod spread;
pub mod table;
pub mod values;

use crate::command::cli::StudyArgs;
use crate::command::progress::{Progress, print};
use crate::command::solve::frames::forget;
use crate::command::stages::command_line;
use crate::command::streams::{INPUT, check_directory, text_of};
use crate::command::template;
use crate::error::{Error, Result};
use crate::files::{atomically, json};
use found::StudyFindings;
use session::Session;
use std::path::Path;

/// Run it.
///
/// # Errors
/// A case, a scene or an output that does not work.
pub fn study(args: &StudyArgs) -> Result<()> {
    let Some(path) = args.case.as_deref().filter(|_| !args.template) else {
        return print(template::STUDY.as_bytes());
    };
    let mut progress = Progress::new(&args.talk);
    let piped = text_of(path)?;
    let path = if piped.is_some() { Path::new(INPUT) } else { path };
    let text = piped.map_or_else(|| case::text(path), Ok)?;
    let case = case::parse(path, &text)?;
    let case = if args.quick { case.quick() } else { case };
    let dir = args.output.as_deref();
    dir.iter().try_for_each(|dir| check_directory("-o", dir))?;
    // Before anything is measured all scenes must be there.
    let scenes = measure::scenes(path, &case, &mut progress)?;
    let name = session::fingerprint(&text, &scenes, args.quick);
    dir.iter().try_for_each(|dir| session::keep_results(dir, &name, args.force))?;
    let mut session = Session::new(&mut progress, dir, name, found::plan(&case), args.force);
    let found = found::measure(&case, &scenes, command_line(), &mut session)?;
    session.finish()?;
    match dir {
        Some(dir) => write(found, dir, &mut progress),
        None => print(format!("{}\n", page::markdown(&found, &[])).as_bytes()),
    }
}

/// Writes the files of a directory.
fn write(mut found: StudyFindings, dir: &Path, progress: &mut Progress) -> Result<()> {
    std::fs::create_dir_all(dir).map_err(|e| Error::io(dir, "create the directory", &e))?;
    let put = |name: &str, text: &str| atomically(&dir.join(name), |out| out.write_all(text.as_bytes()));
    let tables = [
        ("study.csv", points::table(&found.rows)),
        ("study_flows.csv", flows::runs::table(&found.flows)),
        ("study_scaling.csv", scaling::table(&found.scalings)),
        ("study_left_out.csv", left_out::table(&found.left_out)),
    ];
    for (name, table) in &tables {
        match table.rows.is_empty() {
            // What another study has left would speak for this one.
            true => forget(&dir.join(name))?,
            false => put(name, &table.csv())?,
        }
    }
    let pictures = pictures::pictures(&found);
    let mut old: Vec<&str> = pictures::NAMES.to_vec();
    for (name, picture) in &pictures {
        if let (Some(canvas), Some(svg)) = (picture.canvas(), picture.svg()) {
            canvas.write(&dir.join(format!("{name}.png")))?;
            put(&format!("{name}.svg"), &svg)?;
            old.retain(|other| other != name);
        }
    }
    for name in &old {
        ["png", "svg"].iter().try_for_each(|suffix| forget(&dir.join(format!("{name}.{suffix}"))))?;
    }
    if old.len() == pictures::NAMES.len() {
        progress.warn("no picture: nothing in this study has an error to draw");
    }
    found.warnings.clone_from(&progress.warnings);
    put("study.md", &page::markdown(&found, &pictures))?;
    put("study.html", &page::html(&found, &pictures))?;
    json::write(&dir.join(session::REPORT), &found.report())
}
