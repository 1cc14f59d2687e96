//! The page of a study: one HTML file that needs no other, with pictures, tables, and what follows from them.

use super::case::{Published, joined};
use super::flows::runs::{self, FlowOrder};
use super::found::StudyFindings;
use super::row::{EXACT, ROUNDING, Row};
use super::table::{Cell, Listing, Reading, readable, without_tags};
use super::values::unique;
use super::{left_out, points, scaling};
use crate::picture::panels::Panels;
use crate::picture::svg::escape;
use crate::words::{counted, either};
use std::fmt::Write;

/// A limit on errors, and its name in a table.
const LIMITS: [(f64, &str); 3] = [(1e-2, "below_1e-2"), (1e-4, "below_1e-4"), (EXACT, "exact")];

const STYLE: &str = "body{font:15px/1.45 Helvetica,Arial,'DejaVu Sans',sans-serif;color:#222;max-width:1180px;margin:24px auto;padding:0 16px}\
h1{font-size:24px}h2{font-size:18px;margin-top:32px}table{border-collapse:collapse;font-size:13px;margin:8px 0}\
td,th{border-bottom:1px solid #ddd;padding:3px 9px;text-align:left;vertical-align:top}th{border-bottom:2px solid #999}\
.n{text-align:right;white-space:nowrap;font-variant-numeric:tabular-nums}svg{max-width:100%;height:auto}.wide{overflow-x:auto}.small{color:#666;font-size:13px}";

/// The largest of the errors of a point: of the volume, of a cell.
fn worst(row: &Row) -> Option<f64> {
    let errors = [row.error.map(f64::abs), row.cell.map(|c| c.largest)];
    errors.into_iter().flatten().reduce(f64::max)
}

/// The points of each scene on its finest grid, with the fewest threads.
fn finest(rows: &[Row]) -> Vec<Vec<&Row>> {
    let scenes = unique(rows.iter().map(|r| r.scene.clone()));
    let of = |scene: &String| {
        let own: Vec<&Row> = rows.iter().filter(|r| r.scene == *scene).collect();
        let most = own.iter().max_by_key(|r| r.cells.iter().product::<usize>());
        let grid = most.map(|r| r.grid.clone()).unwrap_or_default();
        let threads = own.iter().map(|r| r.threads).min().unwrap_or(1);
        own.into_iter().filter(|r| r.grid == grid && r.threads == threads).collect()
    };
    scenes.iter().map(of).collect()
}

/// The fastest point whose errors are within a limit.
fn fastest<'a>(rows: &[&'a Row], limit: f64) -> Option<&'a Row> {
    let within = rows.iter().filter(|r| worst(r).is_some_and(|e| e <= limit));
    within.min_by(|a, b| a.seconds.median.total_cmp(&b.seconds.median)).copied()
}

/// What to choose: for each scene on its finest grid the fastest point within each limit, and the paper's.
#[must_use]
pub fn choices(rows: &[Row]) -> Listing {
    let mut columns = vec![("scene", true), ("cells", true)];
    columns.extend(LIMITS.map(|l| (l.1, true)));
    columns.push(("the_paper's_point", true));
    let one = |row: &Row| {
        let seconds = readable(row.seconds.median, Reading::Seconds);
        format!("{} ({seconds} s)", row.method)
    };
    let cells = |own: &Vec<&Row>| {
        let first = own.first()?;
        let best = |limit: f64| fastest(own, limit).map_or("none".to_owned(), one);
        let mut row = vec![Cell::Text(first.scene.clone()), Cell::Text(first.grid.clone())];
        row.extend(LIMITS.map(|l| Cell::Text(best(l.0))));
        let paper = own.iter().find(|r| r.paper).map(|r| {
            let error = r.error.map_or_else(String::new, |e| format!(", volume {}", readable(e, Reading::Percent)));
            format!("{}{error}", one(r))
        });
        row.push(Cell::Text(paper.unwrap_or_default()));
        Some(row)
    };
    Listing { columns, rows: finest(rows).iter().filter_map(cells).collect() }
}

/// Sentences that follow from the points.
#[must_use]
pub fn sentences(rows: &[Row]) -> Vec<String> {
    finest(rows).iter().filter_map(|own| sentence(own)).collect()
}

fn sentence(own: &[&Row]) -> Option<String> {
    let first = own.first()?;
    let place = format!("{} on {} cells", first.scene, first.grid);
    let time = |row: &Row| readable(row.seconds.median, Reading::Seconds);
    if own.iter().all(|row| row.volume == 0.0) {
        return Some(format!("{place}: no solid lies in the grid, and there is nothing to choose by."));
    }
    let Some(exact) = fastest(own, EXACT) else {
        let near = own.iter().filter_map(|r| Some((worst(r)?, *r))).min_by(|a, b| a.0.total_cmp(&b.0));
        return near.map(|(error, row)| {
            let error = readable(error, Reading::Small);
            format!(
                "{place}: nothing is exact; {} comes nearest, errs by at most {error} and takes {} s.",
                row.method,
                time(row)
            )
        });
    };
    let mut text = format!("{place}: {} is exact in {} s.", exact.method, time(exact));
    if let Some(paper) = own.iter().find(|r| r.paper) {
        let ratio = paper.seconds.median / exact.seconds.median;
        let error = paper.error.map_or("an unknown share".to_owned(), |e| readable(e, Reading::Percent));
        let than = if ratio >= 1.0 { format!("{ratio:.1} times as long") } else { format!("{ratio:.2} of that time") };
        let _ = write!(text, " The paper's point takes {than} and finds {error} of solid volume.");
    }
    let quicker = fastest(own, LIMITS[0].0).filter(|r| r.seconds.median < 0.8 * exact.seconds.median);
    match quicker {
        Some(row) => {
            let error = worst(row).map_or_else(String::new, |e| readable(e, Reading::Small));
            let _ = write!(text, " Where {error} is good enough, {} takes {} s.", row.method, time(row));
        }
        None => text += " Nothing that errs below 1e-2 is faster by a fifth: there is no reason to choose less.",
    }
    Some(text)
}

/// What others have published, beside ours: the same scene, the grid nearest in its number of cells, the fewest threads. How many times as fast is
/// told if ours has nine tenths as many cells or more.
#[must_use]
pub fn published(all: &[(String, Published)], rows: &[Row]) -> Listing {
    let columns = [
        "scene",
        "published_by",
        "cells",
        "seconds",
        "our_cells",
        "the_paper's_point_here",
        "exact_here",
        "times_faster",
    ];
    let row = |(scene, published): &(String, Published)| {
        let own: Vec<&Row> = rows.iter().filter(|r| r.scene == *scene).collect();
        let count = |cells: [usize; 3]| cells.iter().product::<usize>();
        let nearest = own.iter().min_by_key(|r| count(r.cells).abs_diff(count(published.cells)))?;
        // Against a grid of fewer cells no time is faster.
        let is_less = 10 * count(nearest.cells) < 9 * count(published.cells);
        let near = nearest.grid.clone();
        let threads = own.iter().map(|r| r.threads).min()?;
        let here: Vec<&Row> = own.into_iter().filter(|r| r.grid == near && r.threads == threads).collect();
        let paper = here.iter().find(|r| r.paper).map(|r| r.seconds.median);
        let exact = fastest(&here, EXACT).map(|r| r.seconds.median);
        let [cells, ours] = [joined(published.cells), near].map(Cell::Text);
        Some(vec![
            Cell::Text(scene.clone()),
            Cell::Text(published.by.clone()),
            cells,
            Cell::Number(published.seconds, Reading::Seconds),
            ours,
            Cell::maybe(paper, Reading::Seconds),
            Cell::maybe(exact, Reading::Seconds),
            Cell::maybe(exact.filter(|_| !is_less).map(|s| published.seconds / s), Reading::Order),
        ])
    };
    Listing { columns: columns.map(|c| (c, true)).to_vec(), rows: all.iter().filter_map(row).collect() }
}

/// The parts of a report in their order: a heading, what to say, a table.
#[must_use]
pub fn parts(found: &StudyFindings) -> Vec<(&'static str, Vec<String>, Listing)> {
    let mut parts: Vec<(&'static str, Vec<String>, Listing)> = Vec::new();
    if !found.rows.is_empty() {
        let mut words = vec![
            "For each scene on its finest grid the fastest point whose volume and whose every cell err by no more than the limit; exact means 1e-9 at most."
                .to_owned(),
        ];
        words.extend(sentences(&found.rows));
        parts.push(("What to choose", words, choices(&found.rows)));
    }
    if !found.published.is_empty() {
        let words = "Times of others as they were published, on their machines; ours on this one.".to_owned();
        parts.push(("Beside what is published", vec![words], published(&found.published, &found.rows)));
    }
    if !found.flows.is_empty() {
        let orders = runs::orders(&found.flows);
        let words = flow_sentences(found, &orders);
        // On a single grid nothing falls.
        if !orders.is_empty() || words.len() > 1 {
            parts.push(("Orders of convergence", words, runs::order_table(&orders)));
        }
        parts.push(("Flows", vec![], runs::table(&found.flows)));
    }
    if !found.scalings.is_empty() {
        let say = |e: &scaling::Exponent| {
            let exponent = scaling::with_error(e.exponent, e.standard_error);
            format!("{}: the time goes as the power {exponent} of the number of {}.", e.scaling, e.along)
        };
        let exponents = scaling::exponents(&found.scalings);
        let head = "Exponents are those of straight lines through the logarithms of all steps.".to_owned();
        let words = std::iter::once(head).chain(exponents.iter().map(say)).collect();
        parts.push(("As things grow", words, scaling::table(&found.scalings)));
    }
    if !found.left_out.is_empty() {
        let words = "What a run leaves out where nobody asks for it, and the share of time that this saves: measured by switching it on.";
        parts.push(("Left out", vec![words.to_owned()], left_out::table(&found.left_out)));
    }
    let absent = absent(found);
    if !absent.is_empty() {
        parts.push(("What is not here", absent, Listing::default()));
    }
    if !found.rows.is_empty() {
        let words = format!(
            "Errors of cells and faces are counted from the method under “cells from”; volumes below {ROUNDING:e} are exact to rounding."
        );
        parts.push(("All points", vec![words], points::table(&found.rows)));
    }
    parts
}

/// What the tables and pictures lack, and why: points without an error, what a quick look does not measure, all warnings.
fn absent(found: &StudyFindings) -> Vec<String> {
    let mut words = Vec::new();
    let count = found.rows.len();
    for (of, missing) in [
        ("volume", found.rows.iter().filter(|r| r.error.is_none()).count()),
        ("cells", found.rows.iter().filter(|r| r.cell.is_none()).count()),
    ] {
        if missing > 0 {
            words.push(format!(
                "{missing} of {} no error of the {of} and {} in no picture of it: nothing is known to count it from.",
                counted(count, "point has", "points have"),
                either(missing, "stands", "stand")
            ));
        }
    }
    if found.quick {
        words.push(
            "A quick look takes the two smallest grids, one number of threads and a single run of each, of short flows as many as take 0.02 s; the rest is left out."
                .to_owned(),
        );
    }
    words.extend(unique(found.warnings.iter().cloned()));
    if words.is_empty() { words } else { [vec![LACKING.to_owned()], words].concat() }
}

/// Above the list of what is not there.
const LACKING: &str = "What the tables and pictures do not show, and what was said on the way.";

/// What follows from the orders.
fn flow_sentences(found: &StudyFindings, orders: &[FlowOrder]) -> Vec<String> {
    let rounding = unique(found.flows.iter().map(|f| f.flow.clone()));
    let exact =
        |name: &&String| found.flows.iter().filter(|f| f.flow == **name).all(|f| f.error <= runs::FLOW_ROUNDING);
    let exact: Vec<&str> = rounding.iter().filter(exact).map(String::as_str).collect();
    let mut words = vec!["The order is how fast the error falls with the cells along an axis; errors within rounding or within the uncertainty of the reference are left out of the fit.".to_owned()];
    if !exact.is_empty() {
        words.push(format!("Exact to rounding on every grid: {}.", exact.join("; ")));
    }
    if let (Some(low), Some(high)) = (
        orders.iter().min_by(|a, b| a.order.total_cmp(&b.order)),
        orders.iter().max_by(|a, b| a.order.total_cmp(&b.order)),
    ) {
        words.push(match orders {
            [only] => format!("It is {:.2} ({}).", only.order, only.flow),
            _ => format!("From {:.2} ({}) to {:.2} ({}).", low.order, low.flow, high.order, high.flow),
        });
    }
    words
}

/// The page.
#[must_use]
pub fn html(found: &StudyFindings, pictures: &[(String, Panels)]) -> String {
    let title = if found.title.is_empty() { "A study" } else { &found.title };
    let mut text = format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{0}</title>\n<style>{STYLE}</style></head><body>\n<h1>{0}</h1>\n",
        escape(title)
    );
    for line in about(found) {
        let _ = writeln!(text, "<p class=\"small\">{}</p>", escape(&line));
    }
    for (n, (head, words, table)) in parts(found).into_iter().enumerate() {
        let _ = writeln!(text, "<h2>{}</h2>", escape(head));
        match &words[..] {
            [] => {}
            [one] => {
                let _ = writeln!(text, "<p>{}</p>", escape(one));
            }
            [first, rest @ ..] => {
                let items: String = rest.iter().map(|w| format!("<li>{}</li>\n", escape(w))).collect();
                let _ = writeln!(text, "<p>{}</p>\n<ul>\n{items}</ul>", escape(first));
            }
        }
        if !table.columns.is_empty() {
            let _ = writeln!(text, "<div class=\"wide\">{}</div>", table.html());
        }
        if n == 0 {
            pictures.iter().filter_map(|(_, p)| p.svg()).for_each(|svg| text.push_str(&svg));
        }
    }
    text + "</body></html>\n"
}

/// The same in Markdown; pictures by the names of their files, beside it.
#[must_use]
pub fn markdown(found: &StudyFindings, pictures: &[(String, Panels)]) -> String {
    let mut text = if found.title.is_empty() { String::new() } else { format!("# {}\n\n", without_tags(&found.title)) };
    for line in about(found) {
        let _ = writeln!(text, "{line}\n");
    }
    let mut shown: Vec<&(String, Panels)> = pictures.iter().filter(|(_, p)| p.svg().is_some()).collect();
    for (head, words, table) in parts(found) {
        let _ = writeln!(text, "## {head}\n");
        for sentence in &words {
            let _ = writeln!(text, "- {}", without_tags(sentence));
        }
        let gap = if words.is_empty() { "" } else { "\n" };
        let table = if table.columns.is_empty() { String::new() } else { table.markdown() };
        let _ = writeln!(text, "{gap}{table}");
        for (name, picture) in shown.drain(..) {
            let _ = writeln!(text, "![{}]({name}.svg)\n", without_tags(&picture.title));
        }
    }
    text.trim_end().to_owned() + "\n"
}

/// How it was measured.
fn about(found: &StudyFindings) -> Vec<String> {
    let quick = if found.quick { " A quick look: one run of each, the smallest grids." } else { "" };
    let more = if found.flows.is_empty() { "" } else { ", of short flows more" };
    let mut lines = vec![format!(
        "Made by `{}`, {}, on {}; medians of {}{more}, the fastest and the slowest beside them.{quick}",
        found.command,
        found.program,
        counted(found.processors, "processor", "processors"),
        counted(found.repeats, "run", "runs")
    )];
    lines.extend(found.note.iter().cloned());
    lines
}
