//! Cells of tables in CSV.

/// A cell that must stand in quotes: it holds a comma, a quote or a line end.
#[must_use]
pub fn needs_quotes(cell: &str) -> bool {
    cell.contains([',', '"', '\n', '\r'])
}
