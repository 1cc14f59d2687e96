//! `voidage study`: error against run time, for any scenes, grids, methods and numbers of threads.
//!
//! In reading order: [`values`], [`spread`]; [`recipe`], [`case`]; [`row`], [`session`], [`single`]; [`table`], [`points`], [`measure`];
//! [`pictures`].

pub mod case;
pub mod measure;
pub mod pictures;
pub mod points;
pub mod recipe;
pub mod row;
pub mod session;
pub mod single;
pub mod spread;
pub mod table;
pub mod values;

use crate::command::cli::StudyArgs;
use crate::command::progress::{Progress, print};
use crate::command::stages::command_line;
use crate::command::streams::{INPUT, text_of};
use crate::command::template;
use crate::command::version::{BUILD, Build};
use crate::error::{Error, Result};
use crate::files::{atomically, json};
use crate::picture::panels::Panels;
use case::StudyCase;
use row::Row;
use serde::Serialize;
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
    let name = session::fingerprint(&text, case.files(), args.quick);
    let dir = args.output.as_deref();
    let mut session = Session::new(&mut progress, dir, name, case.plan(), args.force);
    let rows = measure::all(path, &case, &mut session)?;
    match dir {
        Some(dir) => write(&case, &rows, dir, &mut progress),
        None => print(format!("{}\n", markdown(&case, &rows)).as_bytes()),
    }
}

/// What programs read.
#[derive(Debug, Serialize)]
struct StudyReport<'a> {
    title: &'a str,
    build: Build,
    command: String,
    processors: usize,
    quick: bool,
    points: &'a [Row],
    warnings: &'a [String],
}

fn markdown(case: &StudyCase, rows: &[Row]) -> String {
    let head = if case.title.is_empty() { String::new() } else { format!("# {}\n\n", case.title) };
    head + &points::table(rows).markdown()
}

/// Writes the files of a directory.
fn write(case: &StudyCase, rows: &[Row], dir: &Path, progress: &mut Progress) -> Result<()> {
    std::fs::create_dir_all(dir).map_err(|e| Error::io(dir, "create the directory", &e))?;
    let put = |name: &str, text: &str| atomically(&dir.join(name), |out| out.write_all(text.as_bytes()));
    put("study.csv", &points::table(rows).csv())?;
    put("study.md", &markdown(case, rows))?;
    let mut drawn = false;
    for (end, picture) in pictures::pictures(&case.title, rows) {
        drawn |= draw(dir, &format!("study{end}"), &picture)?;
    }
    if !drawn {
        progress.warn("no picture: nothing in this study has an error to draw");
    }
    let report = StudyReport {
        title: &case.title,
        build: BUILD,
        command: command_line(),
        processors: std::thread::available_parallelism().map_or(1, usize::from),
        quick: case.is_quick,
        points: rows,
        warnings: &progress.warnings,
    };
    json::write(&dir.join("study.json"), &report)
}

/// A picture as PNG and as SVG; whether there was anything to draw.
fn draw(dir: &Path, name: &str, picture: &Panels) -> Result<bool> {
    let (Some(canvas), Some(svg)) = (picture.canvas(), picture.svg()) else { return Ok(false) };
    canvas.write(&dir.join(format!("{name}.png")))?;
    atomically(&dir.join(format!("{name}.svg")), |out| out.write_all(svg.as_bytes()))?;
    Ok(true)
}
