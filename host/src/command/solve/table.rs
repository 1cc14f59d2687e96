//! CSV tables that grow with the run: whole lines, and on resuming cut back to where the checkpoint left them.

use crate::error::{Error, Result};
use std::fs::{File, OpenOptions};
use std::io::{ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Bytes of lines kept before they are written.
const BUFFER: usize = 1 << 16;

/// A table on disk.
#[derive(Debug)]
pub struct Table {
    path: PathBuf,
    file: File,
    lines: String,
    written: u64,
}

impl Table {
    /// A new table with its first line.
    ///
    /// # Errors
    /// The file cannot be made.
    pub fn new(path: &Path, head: &str) -> Result<Self> {
        let file = File::create(path).map_err(|e| Error::io(path, "create", &e))?;
        let mut table = Table { path: path.to_owned(), file, lines: String::new(), written: 0 };
        table.line(head)?;
        Ok(table)
    }

    /// The first `bytes` of a table, to be continued; `of` is the key of the case that makes its columns.
    ///
    /// # Errors
    /// The file cannot be opened, is shorter, or has other columns.
    pub fn resume(path: &Path, head: &str, of: &str, bytes: u64) -> Result<Self> {
        let failed = |e: std::io::Error| match e.kind() {
            ErrorKind::NotFound => {
                Error::file(path, "is missing, and the run was to go on with it: without --resume it begins anew")
            }
            _ => Error::io(path, "go on with", &e),
        };
        let mut file = OpenOptions::new().read(true).write(true).open(path).map_err(failed)?;
        let length = file.metadata().map_err(failed)?.len();
        if length < bytes {
            return Err(Error::file(path, format!("has {length} bytes; the checkpoint needs its first {bytes}")));
        }
        let mut start = vec![0; head.len() + 1];
        if file.read_exact(&mut start).is_err() || start != [head.as_bytes(), b"\n"].concat() {
            let reason =
                format!("has other columns than {of} asks for now: leave that as it was, or run without --resume");
            return Err(Error::file(path, reason));
        }
        file.set_len(bytes).map_err(failed)?;
        file.seek(SeekFrom::Start(bytes)).map_err(failed)?;
        Ok(Table { path: path.to_owned(), file, lines: String::new(), written: bytes })
    }

    /// Adds a line.
    ///
    /// # Errors
    /// As [`Table::flush`].
    pub fn line(&mut self, line: &str) -> Result<()> {
        self.lines += line;
        self.lines.push('\n');
        if self.lines.len() < BUFFER { Ok(()) } else { self.flush() }
    }

    /// Writes all lines to the file; returns its length.
    ///
    /// # Errors
    /// The disk is full, or the like.
    pub fn flush(&mut self) -> Result<()> {
        self.file.write_all(self.lines.as_bytes()).map_err(|e| Error::io(&self.path, "write", &e))?;
        self.written += self.lines.len() as u64;
        self.lines.clear();
        Ok(())
    }

    /// Length of the file.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.written
    }
}
