//! Cells of tables in CSV.

use std::borrow::Cow;

/// A text as a cell of a table, by RFC 4180: in quotes if it holds a comma, a quote or a line end, with its own quotes doubled.
#[must_use]
pub fn cell(text: &str) -> Cow<'_, str> {
    match text.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")).into(),
        false => text.into(),
    }
}
