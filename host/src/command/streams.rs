//! Standard streams by the name `-`, formats by suffix, directories that are made for outputs.

use crate::command::progress::print;
use crate::error::{Error, Result};
use crate::files::{check_takes_files, check_target, destination, json};
use serde::Serialize;
use std::ffi::OsStr;
use std::io::{ErrorKind, Read};
use std::path::Path;

/// What messages call the standard input.
pub const INPUT: &str = "standard input";

/// A path stands for a standard stream.
#[must_use]
pub fn is_stream(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// All of the standard input.
///
/// # Errors
/// It cannot be read.
pub fn read_input() -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    std::io::stdin().lock().read_to_end(&mut bytes).map_err(|e| Error::io(Path::new(INPUT), "read", &e))?;
    Ok(bytes)
}

/// The standard input as a text, if `path` names it; `None` for any other path.
///
/// # Errors
/// It cannot be read, or is no text.
pub fn text_of(path: &Path) -> Result<Option<String>> {
    if !is_stream(path) {
        return Ok(None);
    }
    crate::text::of_bytes(Path::new(INPUT), read_input()?).map(Some)
}

/// There is something at `path` that is no file: what goes there need not be a whole one.
#[must_use]
pub fn is_device(path: &Path) -> bool {
    std::fs::metadata(path).is_ok_and(|m| !m.is_file())
}

/// The suffix of a file in small letters.
fn suffix(path: &Path) -> Option<String> {
    path.extension().map(|s| s.to_string_lossy().to_lowercase())
}

/// `option` writes one format: the suffix must say so, or there be none to say otherwise.
///
/// # Errors
/// Another suffix; exit code 2.
pub fn check_suffix(option: &str, path: &Path, wanted: &str) -> Result<()> {
    match suffix(path) {
        Some(suffix) if suffix != wanted && !is_device(path) => {
            Err(Error::usage(format!("{}: {option} writes .{wanted}, not .{suffix}", path.display())))
        }
        _ => Ok(()),
    }
}

/// An output can be put at `path`: its directory takes a file, or can be made in one that does. Asked before long work.
///
/// # Errors
/// It cannot.
pub fn check_place(path: &Path) -> Result<()> {
    check_names(path)?;
    let directory = directory(path);
    if is_stream(path) || directory.is_dir() {
        return if is_stream(path) { Ok(()) } else { check_target(path) };
    }
    let above = directory.ancestors().map(or_here).find(|d| d.exists()).unwrap_or(Path::new("."));
    if !above.is_dir() {
        return Err(Error::file(path, format!("cannot create: {} is no directory", above.display())));
    }
    check_takes_files(above)
}

/// Files can go into a directory at `path`: there is nothing else of that name. `option` is what asked for it.
///
/// # Errors
/// A stream, with exit code 2; a file.
pub fn check_directory(option: &str, path: &Path) -> Result<()> {
    if is_stream(path) {
        return Err(Error::usage(format!("{option} takes a directory, not the standard output")));
    }
    check_names(path)?;
    match path.ancestors().find(|place| place.exists()) {
        Some(file) if !file.is_dir() => {
            Err(Error::file(file, format!("cannot create the directory of {option}: there is a file of that name")))
        }
        _ => Ok(()),
    }
}

/// The names in a path that are not there yet can be made.
///
/// # Errors
/// The system takes no names like one of them: most take up to 255 bytes.
fn check_names(path: &Path) -> Result<()> {
    let Some(above) = path.ancestors().map(or_here).find(|place| place.is_dir()) else { return Ok(()) };
    let absent = path.strip_prefix(above).unwrap_or(path);
    // Each is looked for where names of this disk are known: what lies between does not exist.
    let refused = |name: &&OsStr| {
        let looked = above.join(name).symlink_metadata();
        looked.is_err_and(|error| error.kind() == ErrorKind::InvalidFilename)
    };
    match absent.iter().find(refused) {
        Some(name) if name.len() > USUAL_NAME => Err(Error::file(
            path,
            format!("cannot create: a name of {} bytes is too long for this disk; most take {USUAL_NAME}", name.len()),
        )),
        Some(name) => Err(Error::file(path, format!("cannot create: this disk takes no name {}", name.display()))),
        None => Ok(()),
    }
}

/// Bytes of a file name that nearly every disk takes.
const USUAL_NAME: usize = 255;

/// `output` would replace `input`, or what another output has put there, however the paths of both are written.
#[must_use]
pub fn replaces(output: &Path, input: &Path) -> bool {
    let streams = is_stream(output) || is_stream(input);
    !streams && !is_device(output) && (output == input || destination(output) == destination(input))
}

/// Makes the directory of an output.
///
/// # Errors
/// It cannot be made.
pub fn make_place(path: &Path) -> Result<()> {
    let directory = directory(path);
    if is_stream(path) || directory.is_dir() {
        return Ok(());
    }
    std::fs::create_dir_all(directory).map_err(|e| Error::io(directory, "create the directory", &e))
}

fn directory(path: &Path) -> &Path {
    or_here(path.parent().unwrap_or(Path::new("")))
}

fn or_here(directory: &Path) -> &Path {
    if directory.as_os_str().is_empty() { Path::new(".") } else { directory }
}

/// Formats of `-o`, by suffix.
const FORMATS: &str =
    ".vtr (fields for ParaView), .png (picture), .json (report); NumPy arrays go into a directory by --npy DIR";

/// What `-o` asks for, by its suffix; without one, and for a stream or a device, fields for ParaView.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum OutputFormat {
    /// `.vtr`
    Fields,
    /// `.png`
    Picture,
    /// `.json`
    Report,
}

impl OutputFormat {
    /// Of a path.
    ///
    /// # Errors
    /// A suffix that is not known; exit code 2.
    pub fn of(path: &Path) -> Result<Self> {
        match suffix(path).as_deref() {
            Some("vtr") => Ok(OutputFormat::Fields),
            Some("png") => Ok(OutputFormat::Picture),
            Some("json") => Ok(OutputFormat::Report),
            _ if is_stream(path) || is_device(path) => Ok(OutputFormat::Fields),
            _ => Err(Error::usage(format!("{}: the suffix tells no format; known are {FORMATS}", path.display()))),
        }
    }
}

/// Writes a report to a file or to the standard output.
///
/// # Errors
/// It cannot be written.
pub fn write_json(path: &Path, value: &impl Serialize) -> Result<()> {
    if !is_stream(path) {
        make_place(path)?;
        return json::write(path, value);
    }
    let text = serde_json::to_string_pretty(value).map_err(|e| Error::new(format!("cannot write JSON: {e}")))?;
    print(format!("{text}\n").as_bytes())
}
