//! Texts of files, which are UTF-8.

use crate::error::{Error, Result};
use std::io::Read;
use std::path::Path;

/// The mark that some editors put before a text.
const BYTE_ORDER_MARK: char = '\u{feff}';

/// There is a file at `path` and nothing else, if there is anything.
///
/// # Errors
/// There is a directory, a device or a pipe.
pub fn is_file(path: &Path) -> Result<()> {
    match std::fs::metadata(path) {
        Ok(about) if about.is_dir() => Err(Error::file(path, "is a directory, not a regular file")),
        Ok(about) if !about.is_file() => {
            Err(Error::file(path, "is a device or a pipe, not a regular file; the standard input is called -"))
        }
        _ => Ok(()),
    }
}

/// The longest text, in bytes: far more than anybody writes; a device never ends.
const LONGEST: u64 = 1 << 28;

/// The text of a file, without a byte order mark.
///
/// # Errors
/// It is a directory, cannot be read, is too long, or is no UTF-8.
pub fn read(path: &Path) -> Result<String> {
    if path.is_dir() {
        return Err(Error::file(path, "is a directory, not a file"));
    }
    let mut bytes = Vec::new();
    let file = std::fs::File::open(path).map_err(|e| Error::io(path, "read", &e))?;
    file.take(LONGEST + 1).read_to_end(&mut bytes).map_err(|e| Error::io(path, "read", &e))?;
    if bytes.len() as u64 > LONGEST && !bytes.contains(&0) {
        return Err(Error::file(
            path,
            format!("is longer than {} MiB, which no text for this program is", LONGEST >> 20),
        ));
    }
    of_bytes(path, bytes)
}

/// The text in these bytes, without a byte order mark; `path` names it in messages.
///
/// # Errors
/// It is no UTF-8: says where, and what it may be.
pub fn of_bytes(path: &Path, bytes: Vec<u8>) -> Result<String> {
    if let [0xFF, 0xFE, ..] | [0xFE, 0xFF, ..] = bytes[..] {
        return Err(Error::file(path, "is UTF-16 (\"Unicode\" in some editors): save it as UTF-8"));
    }
    if bytes.contains(&0) {
        return Err(Error::file(path, "is no text: it holds bytes of 0 (UTF-16 is to be saved as UTF-8)"));
    }
    match String::from_utf8(bytes) {
        Ok(mut text) => {
            if text.starts_with(BYTE_ORDER_MARK) {
                text.remove(0);
            }
            Ok(text)
        }
        Err(e) => {
            let (valid, at) = (e.utf8_error().valid_up_to(), e.as_bytes());
            let before = String::from_utf8_lossy(&at[..valid]).into_owned();
            let (line, begin) = (before.matches('\n').count() + 1, before.rfind('\n').map_or(0, |n| n + 1));
            let column = before[begin..].trim_start_matches(BYTE_ORDER_MARK).chars().count() + 1;
            let reason = match at[valid] {
                byte @ 0xA0.. => format!(
                    "this byte is no UTF-8 (0x{byte:02X}; in Latin-1 it is {}): save the file as UTF-8",
                    char::from(byte)
                ),
                byte => format!("this byte is no UTF-8 (0x{byte:02X}): save the file as UTF-8"),
            };
            Err(Error::at(path, format!("line {line}, column {column}"), reason))
        }
    }
}
