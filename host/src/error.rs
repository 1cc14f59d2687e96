//! One error: which file, where in it, and why.

use std::fmt;
use std::path::{Path, PathBuf};

/// A failure that the user can act on. Prints as `file: place: reason`, and below it the line that it is about.
#[derive(Clone, PartialEq, Eq)]
pub struct Error {
    /// The file it is about, if any.
    pub path: Option<PathBuf>,
    /// Where in the file: `line 12`, `triangle 3`, `key grid.x`.
    pub place: Option<String>,
    /// What is wrong and, where known, what to do.
    pub reason: String,
    /// Lines that show the place, printed below.
    pub excerpt: Option<String>,
    /// The command line itself is at fault (exit code 2 rather than 1).
    pub usage: bool,
}

/// Result with [`Error`].
pub type Result<T> = std::result::Result<T, Error>;

impl Error {
    /// A failure about no file in particular.
    pub fn new(reason: impl Into<String>) -> Self {
        Error { path: None, place: None, reason: reason.into(), excerpt: None, usage: false }
    }

    /// A failure of a file as a whole.
    pub fn file(path: &Path, reason: impl Into<String>) -> Self {
        Error { path: Some(path.to_owned()), ..Error::new(reason) }
    }

    /// A failure at a place in a file.
    pub fn at(path: &Path, place: impl Into<String>, reason: impl Into<String>) -> Self {
        Error { place: Some(place.into()), ..Error::file(path, reason) }
    }

    /// A contradiction on the command line.
    pub fn usage(reason: impl Into<String>) -> Self {
        Error { usage: true, ..Error::new(reason) }
    }

    /// An operating-system error about a file.
    pub fn io(path: &Path, doing: &str, cause: &std::io::Error) -> Self {
        Error::file(path, format!("cannot {doing}: {}", said(cause)))
    }
}

/// What the system says of a failure, without its number.
#[must_use]
pub fn said(cause: &std::io::Error) -> String {
    let text = cause.to_string();
    text.split(" (os error ").next().unwrap_or(&text).to_owned()
}

/// Characters of a line that a message shows at most.
const SHOWN: usize = 100;

/// A line of a file by its number, and a mark under `width` of its characters from the one after `column` others on. Characters that would
/// command a terminal stand as �, a tab as a space.
#[must_use]
pub fn excerpt(number: usize, line: &str, column: usize, width: usize) -> String {
    let harmless = |c: char| match c {
        '\t' => ' ',
        c if c.is_control() => char::REPLACEMENT_CHARACTER,
        c => c,
    };
    let line: Vec<char> = line.trim_end().chars().map(harmless).collect();
    let column = column.min(line.len());
    let first = column.saturating_sub(SHOWN / 2);
    let shown: String = line[first..].iter().take(SHOWN).collect();
    let room = (shown.chars().count() + first).saturating_sub(column);
    let (mark, number) = ("^".repeat(width.min(room).max(1)), number.to_string());
    format!("{number:>4} | {shown}\n{:>4} | {}{mark}", "", " ".repeat(column - first))
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(path) = &self.path {
            write!(f, "{}: ", path.display())?;
        }
        if let Some(place) = &self.place {
            write!(f, "{place}: ")?;
        }
        f.write_str(&self.reason)?;
        self.excerpt.as_ref().map_or(Ok(()), |lines| write!(f, "\n{lines}"))
    }
}

/// The message itself: what a `main` that returns errors prints.
impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl std::error::Error for Error {}
