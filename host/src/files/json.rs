//! Reports: one JSON object, for programs and for people.

use std::path::Path;

use crate::error::Result;

use super::atomically;

/// Writes `value` indented, with a newline at the end. JSON has no NaN or infinity: they become `null`.
///
/// # Errors
/// As [`atomically`]; or the value has no JSON form (a map with keys that are not strings).
pub fn write(path: &Path, value: &impl serde::Serialize) -> Result<()> {
    atomically(path, |out| {
        serde_json::to_writer_pretty(&mut *out, value)?;
        out.write_all(b"\n")
    })
}
