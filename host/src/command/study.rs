//! `voidage study`: error against run time, for any scenes, grids, methods and numbers of threads.
//!
//! In reading order: [`case`], [`measure`], [`table`].

pub mod case;
pub mod measure;
pub mod table;

use crate::command::cli::StudyArgs;
use crate::command::progress::{Progress, print};
use crate::command::streams::{INPUT, text_of};
use crate::command::template;
use crate::error::{Error, Result};
use crate::files::atomically;
use crate::picture::chart::{Chart, Series};
use case::StudyCase;
use measure::Row;
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
    let case = piped.map_or_else(|| case::read(path), |text| case::parse(path, &text))?;
    let rows = measure::all(path, &case, &mut progress, |progress, row| progress.say(table::line(row)))?;
    if let Some(dir) = &args.output {
        std::fs::create_dir_all(dir).map_err(|e| Error::io(dir, "create the directory", &e))?;
        let write = |name: &str, text: String| atomically(&dir.join(name), |out| out.write_all(text.as_bytes()));
        write("study.csv", table::csv(&rows))?;
        write("study.md", table::markdown(&case.title, &rows))?;
        if !draw(&case, &rows, &dir.join("study.png"))? {
            progress.warn("no picture: nothing in this study has an error to draw");
        }
    } else {
        print(format!("{}\n", table::markdown(&case.title, &rows)).as_bytes())?;
    }
    Ok(())
}

/// What is exact is drawn here: where rounding begins.
const EXACT: f64 = 1e-16;

/// Relative error of the solid volume against run time: a colour for each method, a line for each scene and number of threads.
fn draw(case: &StudyCase, rows: &[Row], path: &Path) -> Result<bool> {
    let series = case.recipes.iter().map(|recipe| {
        let mut lines: Vec<(&str, usize, Vec<[f64; 2]>)> = Vec::new();
        for row in rows.iter().filter(|r| r.method == recipe.name) {
            let Some(error) = row.error else { continue };
            let point = [row.seconds, error.abs().max(EXACT)];
            match lines.iter_mut().find(|l| (l.0, l.1) == (&row.scene, row.threads)) {
                Some(line) => line.2.push(point),
                None => lines.push((&row.scene, row.threads, vec![point])),
            }
        }
        Series { name: &recipe.name, lines: lines.into_iter().map(|l| l.2).collect() }
    });
    let chart = Chart {
        title: &case.title,
        x: "run time, s",
        y: "relative error of the solid volume",
        series: series.collect(),
    };
    let Some(canvas) = chart.draw() else { return Ok(false) };
    canvas.write(path)?;
    Ok(true)
}
