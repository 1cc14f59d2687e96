//! The rows of a study as CSV for programs and as Markdown for people.

use super::measure::Row;
use std::fmt::Write;

/// Names of the columns, in both forms.
const COLUMNS: [&str; 15] = [
    "scene",
    "bodies",
    "cells",
    "method",
    "threads",
    "seconds",
    "fastest",
    "solid_volume",
    "exact",
    "error",
    "cell_error",
    "face_error",
    "gap",
    "beta_v",
    "beta_v_exact",
];

/// The values of a row by columns; `number` writes one, an empty text says that there is none.
fn values(row: &Row, number: impl Fn(&str, f64) -> String) -> [String; COLUMNS.len()] {
    let [nx, ny, nz] = row.cells;
    let maybe = |column: &str, value: Option<f64>| value.map_or_else(String::new, |v| number(column, v));
    [
        row.scene.clone(),
        row.bodies.to_string(),
        format!("{nx}x{ny}x{nz}"),
        row.method.clone(),
        row.threads.to_string(),
        number("seconds", row.seconds),
        number("seconds", row.fastest),
        number("volume", row.volume),
        maybe("volume", row.exact),
        maybe("error", row.error),
        maybe("gap", row.cell_error),
        maybe("gap", row.face_error),
        number("gap", row.gap),
        maybe("beta", row.probe.map(|[found, _]| found)),
        maybe("beta", row.probe.map(|[_, expected]| expected)),
    ]
}

/// Numbers for people.
fn readable(column: &str, value: f64) -> String {
    match column {
        "seconds" => format!("{value:.4}"),
        "volume" => format!("{value:.9}"),
        "error" => format!("{:+.4} %", 100.0 * value),
        "beta" => format!("{value:.6}"),
        _ => format!("{value:.1e}"),
    }
}

/// A line for the terminal while the study runs.
#[must_use]
pub fn line(row: &Row) -> String {
    let [scene, _, cells, method, threads, seconds, _, volume, _, error, ..] = values(row, readable);
    format!("{scene:<24} {cells:>12} {method:<16} {threads:>2} threads {seconds:>9} s {volume:>18} m³ {error:>12}")
}

/// Comma-separated values, every digit.
#[must_use]
pub fn csv(rows: &[Row]) -> String {
    let mut text = COLUMNS.join(",") + "\n";
    for row in rows {
        let cells = values(row, |_, value| value.to_string()).map(|cell| {
            let plain = !cell.contains([',', '"', '\n', '\r']);
            if plain { cell } else { format!("\"{}\"", cell.replace('"', "\"\"")) }
        });
        text += &(cells.join(",") + "\n");
    }
    text
}

/// A table under a title; columns without a value are left out.
#[must_use]
pub fn markdown(title: &str, rows: &[Row]) -> String {
    let cells: Vec<_> = rows.iter().map(|row| values(row, readable)).collect();
    let used: Vec<usize> = (0..COLUMNS.len()).filter(|&c| cells.iter().any(|row| !row[c].is_empty())).collect();
    let mut text = if title.is_empty() { String::new() } else { format!("# {title}\n\n") };
    let line = |text: &mut String, cell: &dyn Fn(usize) -> String| {
        let joined: Vec<String> = used.iter().map(|&c| cell(c)).collect();
        let _ = writeln!(text, "| {} |", joined.join(" | "));
    };
    line(&mut text, &|c| COLUMNS[c].replace('_', " "));
    line(&mut text, &|c| if [0, 2, 3].contains(&c) { "---".to_owned() } else { "---:".to_owned() });
    for row in &cells {
        line(&mut text, &|c| row[c].replace('|', "\\|").replace(['\n', '\r'], " "));
    }
    text
}
