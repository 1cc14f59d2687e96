//! One run at a time in a directory.

use crate::error::{Error, Result};
use std::fs::{File, TryLockError};
use std::path::Path;

/// Held as long as a run writes into a directory; the system lets go of it when the run ends, however it ends.
#[derive(Debug)]
pub struct Lock(#[expect(dead_code, reason = "the lock lasts as long as the file is open")] File);

impl Lock {
    /// Locks a directory; none if it is not there yet, or where the system locks no directories.
    ///
    /// # Errors
    /// Another run writes there.
    pub fn take(dir: &Path) -> Result<Option<Self>> {
        let Ok(file) = File::open(dir) else { return Ok(None) };
        match file.try_lock() {
            Ok(()) => Ok(Some(Lock(file))),
            Err(TryLockError::WouldBlock) => {
                Err(Error::file(dir, "another run writes there: wait for its end, or give -o DIR"))
            }
            Err(TryLockError::Error(_)) => Ok(None),
        }
    }
}
