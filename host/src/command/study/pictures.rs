//! The pictures of a study: a panel a scene, errors against run time.

use super::flows::runs::{FLOW_ROUNDING, FlowRow, orders};
use super::found::StudyFindings;
use super::row::{ROUNDING, Row};
use super::scaling;
use super::spread::slope;
use super::values::unique;
use crate::picture::panels::{Line, Mark, Panel, Panels};
use std::collections::BTreeMap;

/// An error of a row that a picture shows.
type Error = fn(&Row) -> Option<f64>;

/// The files of all pictures that a study may have, without suffix.
pub const NAMES: [&str; 4] = ["study", "study_cells", "study_flows", "study_scaling"];

/// The pictures of a study by the names of their files, each one of [`NAMES`].
#[must_use]
pub fn pictures(found: &StudyFindings) -> Vec<(String, Panels)> {
    let mut all = Vec::new();
    if !found.rows.is_empty() {
        all.extend(of_points(&found.title, &found.rows));
    }
    if !found.flows.is_empty() {
        all.push(("study_flows".to_owned(), of_flows(&found.title, &found.flows)));
    }
    if !found.scalings.is_empty() {
        all.push(("study_scaling".to_owned(), scaling::picture(&found.title, &found.scalings)));
    }
    all
}

/// What a picture shows, after the title of the study.
fn over(title: &str, what: &str) -> String {
    if title.is_empty() { what.to_owned() } else { format!("{title}: {what}") }
}

fn of_points(title: &str, rows: &[Row]) -> Vec<(String, Panels)> {
    let over = |what: &str| over(title, what);
    let volume: Error = |row| row.error.map(f64::abs);
    let cell: Error = |row| row.cell.map(|e| e.largest);
    let of_volume = errors(rows, volume, true);
    let of_cells = errors(rows, cell, false);
    vec![
        (
            "study".to_owned(),
            Panels {
                title: over("error of the solid volume against run time"),
                y: "relative error of the solid volume".into(),
                ..of_volume
            },
        ),
        (
            "study_cells".to_owned(),
            Panels {
                title: over("largest error of a cell against run time"),
                y: "largest error of beta_v in a cell".into(),
                ring: String::new(),
                ..of_cells
            },
        ),
    ]
}

/// What varies within a family of methods: the depth, the tolerance, or both; nothing, if the method is alone.
fn step(row: &Row) -> &str {
    row.method.strip_prefix(&row.family).unwrap_or("").trim_start_matches(", ")
}

/// Share of white within the marks of the coarsest depth or tolerance; the finest have none.
const LIGHTEST: f64 = 1.0;

/// A tint for each depth and tolerance by which the methods of a family differ, from coarse to fine.
fn tints(rows: &[Row]) -> Vec<(String, f64)> {
    let mut steps: Vec<(&str, u32, f64)> = rows.iter().map(|r| (step(r), r.depth, r.tol)).collect();
    steps.retain(|(name, ..)| !name.is_empty());
    steps.sort_by(|a, b| a.1.cmp(&b.1).then(b.2.total_cmp(&a.2)));
    let kind = |name: &str| (name.contains("depth"), name.contains("tol"));
    let names = unique(steps.iter().map(|(name, ..)| (*name).to_owned()));
    let white = |name: &String| {
        let alike: Vec<&String> = names.iter().filter(|other| kind(other) == kind(name)).collect();
        let place = alike.iter().position(|other| *other == name).unwrap_or(0);
        LIGHTEST * (1.0 - place as f64 / (alike.len().max(2) - 1) as f64)
    };
    names.iter().map(|name| (name.clone(), white(name))).collect()
}

/// What has a colour of its own: a family of methods on so many threads.
fn colour_of(row: &Row) -> String {
    row.family.clone() + &on_threads(row.threads)
}

/// What follows a name where there are several threads.
fn on_threads(threads: usize) -> String {
    if threads > 1 { format!(", {threads} threads") } else { String::new() }
}

/// A colour for each family of methods and number of threads, a tint for each depth and tolerance; a line for each method from grid to grid, or on a single grid for
/// each family.
fn errors(rows: &[Row], error: Error, fronts: bool) -> Panels {
    let series = unique(rows.iter().map(colour_of));
    let tints = tints(rows);
    let panels = unique(rows.iter().map(|r| r.scene.clone())).into_iter().map(|scene| {
        let of_scene: Vec<&Row> = rows.iter().filter(|r| r.scene == scene).collect();
        panel(&scene, &of_scene, (&series, &tints), error, fronts)
    });
    Panels {
        x: "run time, s".into(),
        panels: panels.collect(),
        series,
        tints: tints.clone(),
        floor: Some((ROUNDING, format!("exact to rounding: at most {ROUNDING:e}").replace('-', "−"))),
        square: "the paper's leaf and point: what is touched at depth 3 is solid".into(),
        ring: "Pareto front of its grid: no other point takes less time and errs less".into(),
        bar: "fastest to slowest run".into(),
        slopes: "slopes".into(),
        ..Panels::default()
    }
}

fn panel(
    scene: &str,
    rows: &[&Row],
    (series, tints): (&[String], &[(String, f64)]),
    error: Error,
    fronts: bool,
) -> Panel {
    let grids = unique(rows.iter().map(|r| &r.grid)).len();
    let mut lines: BTreeMap<(usize, String), Vec<Mark>> = BTreeMap::new();
    for row in rows {
        let (Some(y), Some(n)) = (error(row), series.iter().position(|s| *s == colour_of(row))) else { continue };
        // With several grids a line goes from one to the next; with one, from depth to depth.
        let line = if grids > 1 { row.method.clone() } else { String::new() };
        lines.entry((n, line)).or_default().push(Mark {
            at: [row.seconds.median, y],
            x_ends: Some([row.seconds.fastest, row.seconds.slowest]).filter(|[a, b]| a < b),
            y_ends: None,
            square: row.paper,
            ring: fronts && row.front,
            tint: tints.iter().position(|(name, _)| name == step(row)),
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
    Panel { title: scene.to_owned(), lines, slopes, x: None }
}

/// A panel for each problem: error against run time, a line for each scheme from grid to grid.
fn of_flows(title: &str, rows: &[FlowRow]) -> Panels {
    let scheme = |r: &FlowRow| {
        let slopes = if r.order == 1 { "first order".to_owned() } else { r.limiter.clone() };
        format!("{}, {slopes}, {}{}", r.riemann, r.precision, on_threads(r.threads))
    };
    let (series, fitted) = (unique(rows.iter().map(scheme)), orders(rows));
    let number = |r: &FlowRow| series.iter().position(|s| *s == scheme(r)).unwrap_or(0);
    let panel = |problem: &String| {
        let own: Vec<&FlowRow> = rows.iter().filter(|r| r.problem == *problem).collect();
        let mark = |r: &&FlowRow| Mark {
            at: [r.seconds.median, r.error],
            x_ends: Some([r.seconds.fastest, r.seconds.slowest]).filter(|[a, b]| a < b),
            y_ends: (r.uncertainty > 0.01 * r.error && r.error > r.uncertainty)
                .then_some([r.error - r.uncertainty, r.error + r.uncertainty]),
            ..Mark::default()
        };
        let flows = unique(own.iter().map(|r| r.flow.clone()));
        let line = |flow: &String| {
            let runs: Vec<&FlowRow> = own.iter().copied().filter(|r| r.flow == *flow).collect();
            Line { series: runs.first().map_or(0, |r| number(r)), marks: runs.iter().map(mark).collect() }
        };
        let slopes = flows.iter().filter_map(|flow| {
            let order = fitted.iter().find(|o| o.flow == *flow)?;
            let first = own.iter().find(|r| r.flow == *flow)?;
            Some((number(first), scaling::with_error(order.order, None)))
        });
        let quantity = own.first().map_or("", |r| r.quantity.as_str());
        Panel {
            title: format!("{problem}: {quantity}"),
            x: None,
            lines: flows.iter().map(line).collect(),
            slopes: slopes.collect(),
        }
    };
    let problems = unique(rows.iter().map(|r| r.problem.clone()));
    Panels {
        title: over(title, "errors of flows against run time, from grid to grid"),
        x: "run time, s".into(),
        y: "error, see over each panel".into(),
        panels: problems.iter().map(panel).collect(),
        series,
        floor: Some((FLOW_ROUNDING, format!("exact to rounding: at most {FLOW_ROUNDING:e}").replace('-', "−"))),
        bar: "fastest to slowest run; uncertainty of the reference".into(),
        slopes: "order in N".into(),
        ..Panels::default()
    }
}
