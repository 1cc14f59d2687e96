//! The pictures of a study: a panel a scene, errors against run time.

use super::row::{ROUNDING, Row};
use super::spread::slope;
use crate::picture::panels::{Line, Mark, Panel, Panels};
use std::collections::BTreeMap;

/// An error of a row that a picture shows.
type Error = fn(&Row) -> Option<f64>;

/// The pictures of some points: the end of each file's name, and the picture.
#[must_use]
pub fn pictures(title: &str, rows: &[Row]) -> Vec<(&'static str, Panels)> {
    let over = |what: &str| if title.is_empty() { what.to_owned() } else { format!("{title}: {what}") };
    let volume: Error = |row| row.error.map(f64::abs);
    let cell: Error = |row| row.cell.map(|e| e.largest);
    let of_volume = errors(rows, volume, true);
    let of_cells = errors(rows, cell, false);
    vec![
        (
            "",
            Panels {
                title: over("error of the solid volume against run time"),
                y: "relative error of the solid volume".into(),
                ..of_volume
            },
        ),
        (
            "_cells",
            Panels {
                title: over("largest error of a cell against run time"),
                y: "largest error of beta_v in a cell".into(),
                ring: String::new(),
                ..of_cells
            },
        ),
    ]
}

/// A colour for each family of methods, a line for each grid, or for each depth and tolerance, whatever varies.
fn errors(rows: &[Row], error: Error, fronts: bool) -> Panels {
    let series = unique(rows.iter().map(|r| r.family.clone()));
    let panels = unique(rows.iter().map(|r| r.scene.clone())).into_iter().map(|scene| {
        let of_scene: Vec<&Row> = rows.iter().filter(|r| r.scene == scene).collect();
        panel(&scene, &of_scene, &series, error, fronts)
    });
    Panels {
        x: "run time, s".into(),
        panels: panels.collect(),
        series,
        floor: Some((ROUNDING, format!("exact to rounding: at most {ROUNDING:e}").replace('-', "−"))),
        square: "the paper's leaf and point: what is touched at depth 3 is solid".into(),
        ring: "Pareto front of its grid: no other point takes less time and errs less".into(),
        bar: "fastest to slowest run".into(),
        slopes: "slopes".into(),
        ..Panels::default()
    }
}

fn panel(scene: &str, rows: &[&Row], series: &[String], error: Error, fronts: bool) -> Panel {
    let grids = unique(rows.iter().map(|r| r.cells)).len();
    let mut lines: BTreeMap<(usize, String), Vec<Mark>> = BTreeMap::new();
    for row in rows {
        let (Some(y), Some(n)) = (error(row), series.iter().position(|s| *s == row.family)) else { continue };
        // With several grids a line goes from one to the next; with one, from depth to depth.
        let line = if grids > 1 { format!("{} {}", row.method, row.threads) } else { row.threads.to_string() };
        lines.entry((n, line)).or_default().push(Mark {
            at: [row.seconds.median, y],
            x_ends: Some([row.seconds.fastest, row.seconds.slowest]).filter(|[a, b]| a < b),
            y_ends: None,
            square: row.paper,
            ring: fronts && row.front,
        });
    }
    let mut slopes: Vec<(usize, String)> = Vec::new();
    for ((n, _), marks) in &lines {
        let points: Vec<[f64; 2]> = marks.iter().map(|m| m.at).filter(|p| p[1] > ROUNDING).collect();
        if slopes.iter().all(|(known, _)| known != n)
            && let Some((slope, _)) = slope(&points)
        {
            slopes.push((*n, format!("{slope:.2}").replace('-', "−")));
        }
    }
    let lines = lines.into_iter().map(|((series, _), marks)| Line { series, marks }).collect();
    Panel { title: scene.to_owned(), lines, slopes }
}

/// Values in the order of their first appearance, each once.
pub(super) fn unique<T: PartialEq>(values: impl Iterator<Item = T>) -> Vec<T> {
    values.fold(Vec::new(), |mut all, value| {
        if !all.contains(&value) {
            all.push(value);
        }
        all
    })
}
