//! The points of a study as a table.

use super::row::Row;
use super::table::{Cell, Listing, Reading, readable};
use crate::words::either;

/// Columns, and whether people see them.
const COLUMNS: [(&str, bool); 31] = [
    ("scene", true),
    ("bodies", true),
    ("triangles", false),
    ("cells", true),
    ("method", true),
    ("road", false),
    ("leaf", false),
    ("depth", false),
    ("tol", false),
    ("precision", false),
    ("threads", true),
    ("repeats", false),
    ("seconds", true),
    ("fastest", true),
    ("slowest", true),
    ("solid_volume", true),
    ("exact", true),
    ("exact_from", false),
    ("uncertainty", false),
    ("error", true),
    ("cell_error", true),
    ("cell_error_mean", true),
    ("face_error", true),
    ("face_error_mean", true),
    ("cells_from", true),
    ("cells_gap", false),
    ("gap", true),
    ("beta_v", true),
    ("beta_v_exact", true),
    ("paper", true),
    ("front", true),
];

/// The rows as a table.
#[must_use]
pub fn table(rows: &[Row]) -> Listing {
    Listing { columns: COLUMNS.to_vec(), rows: rows.iter().map(|row| cells(row).to_vec()).collect() }
}

fn cells(row: &Row) -> [Cell; COLUMNS.len()] {
    let text = |text: &str| Cell::Text(text.to_owned());
    let (number, maybe) = (Cell::Number, Cell::maybe);
    [
        text(&row.scene),
        Cell::Whole(row.bodies),
        Cell::Whole(row.triangles),
        text(&row.grid),
        text(&row.method),
        text(&row.road),
        text(&row.leaf),
        Cell::Whole(row.depth as usize),
        number(row.tol, Reading::Small),
        text(&row.precision),
        Cell::Whole(row.threads),
        Cell::Whole(row.repeats),
        number(row.seconds.median, Reading::Seconds),
        number(row.seconds.fastest, Reading::Seconds),
        number(row.seconds.slowest, Reading::Seconds),
        number(row.volume, Reading::Volume),
        maybe(row.exact.volume, Reading::Volume),
        text(&row.exact.from),
        number(row.exact.uncertainty, Reading::Small),
        maybe(row.error, Reading::Percent),
        maybe(row.cell.map(|e| e.largest), Reading::Small),
        maybe(row.cell.map(|e| e.mean), Reading::Small),
        maybe(row.face.map(|e| e.largest), Reading::Small),
        maybe(row.face.map(|e| e.mean), Reading::Small),
        row.cells_from.as_ref().map_or(Cell::Nothing, |(from, _)| text(from)),
        maybe(row.cells_from.as_ref().map(|(_, gap)| *gap), Reading::Small),
        number(row.gap, Reading::Small),
        maybe(row.probe.map(|[found, _]| found), Reading::Fraction),
        maybe(row.probe.map(|[_, expected]| expected), Reading::Fraction),
        Cell::Mark(row.paper),
        Cell::Mark(row.front),
    ]
}

/// A line for the terminal while the study runs.
#[must_use]
pub fn line(row: &Row) -> String {
    let Row { scene, grid, method, threads, .. } = row;
    let (seconds, volume) = (readable(row.seconds.median, Reading::Seconds), readable(row.volume, Reading::Volume));
    let error = row.error.map_or_else(String::new, |e| readable(e, Reading::Percent));
    let words = either(*threads, "thread", "threads");
    format!("{scene:<24} {grid:>12} {method:<16} {threads:>2} {words:<7} {seconds:>9} s {volume:>18} m³ {error:>12}")
}
