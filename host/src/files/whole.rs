//! A file appears whole or not at all: write beside it, then rename.
//!
//! The temporary is `.voidage-PID-N.tmp` in the target's directory (a rename is atomic only within a file system). It
//! is removed on any error and on a panic. A signal kills a process without running destructors: a handler for SIGINT
//! should call [`discard_unfinished`] before it exits. After SIGKILL or a power cut the temporary stays; nothing is
//! synced to the disk, so a power cut may also lose the new file.
//!
//! Links are followed: the file behind them is replaced. What is not a regular file (`/dev/null`, a pipe) cannot be
//! replaced and is written directly.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Component, Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use crate::error::{Error, Result};
use rayon::prelude::*;

/// Bytes of the write buffer. Array writers hand over blocks of this size, which then bypass it.
pub(super) const BUFFER: usize = 64 * 1024;

/// Calls `write` with a buffered writer and, if it succeeds, puts the result at `path`.
///
/// # Errors
/// The file cannot be created, written or renamed, `write` fails, or an existing target is read-only or a directory;
/// the error names `path`. An existing target is then untouched.
pub fn atomically(path: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
    replace(path, |out| write(out))
}

/// [`atomically`] for writers that also seek.
pub(super) fn replace(path: &Path, write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> Result<()> {
    beside(path, write)?.map_or(Ok(()), Finished::replace)
}

/// Several files that belong together: all are written before the first is put in its place. `write` gets the position of its path.
///
/// # Errors
/// As [`atomically`], for the first file that fails; unless renaming itself fails half way, none has been replaced then.
pub fn together(paths: &[PathBuf], write: impl Fn(usize, &mut dyn Write) -> io::Result<()> + Sync) -> Result<()> {
    let each = paths.par_iter().enumerate();
    let finished: Result<Vec<_>> = each.map(|(n, path)| beside(path, |out| write(n, out))).collect();
    finished?.into_iter().flatten().try_for_each(Finished::replace)
}

/// Can a file be put at `path`? Asked before long work, so that the answer does not come after it.
///
/// # Errors
/// The target is a directory or read-only, there is no directory to hold it, or none that takes a new file.
pub fn check_target(path: &Path) -> Result<()> {
    has_place(path)?;
    if fs::metadata(path).is_ok_and(|old| !old.is_file()) {
        return Ok(());
    }
    temporary_for(path).map(drop)
}

/// A directory takes files.
///
/// # Errors
/// It does not.
pub fn check_takes_files(directory: &Path) -> Result<()> {
    Temporary::create(directory).map(drop).map_err(|cause| Error::io(directory, "create files in", &cause))
}

/// Links from one place to another, at most.
const MOST_LINKS: usize = 40;

/// What a link leads to, also where nothing is there yet.
fn followed(path: &Path) -> PathBuf {
    let mut target = path.to_owned();
    for _ in 0..MOST_LINKS {
        let Ok(next) = fs::read_link(&target) else { break };
        target = directory(&target).join(next);
    }
    target
}

/// The file that a path leads to, links followed, also where nothing is there yet: two paths of one file lead to the same.
#[must_use]
pub fn destination(path: &Path) -> PathBuf {
    if let Ok(found) = fs::canonicalize(path) {
        return found;
    }
    let target = followed(path);
    let resolved = |above: &Path| {
        let above = if above.as_os_str().is_empty() { Path::new(".") } else { above };
        fs::canonicalize(above).ok()
    };
    let nearest = target.ancestors().skip(1).find_map(|above| Some((above, resolved(above)?)));
    let Some((above, mut place)) = nearest else { return target };
    for name in target.strip_prefix(above).unwrap_or(&target).components() {
        match name {
            // Of a directory that is not there yet, and can be no link.
            Component::ParentDir => drop(place.pop()),
            Component::CurDir => {}
            other => place.push(other),
        }
    }
    place
}

/// A temporary beside the target, links followed.
fn temporary_for(path: &Path) -> Result<(PathBuf, Temporary, File)> {
    let target = fs::canonicalize(path).unwrap_or_else(|_| followed(path));
    let (temporary, file) = Temporary::create(directory(&target)).map_err(|cause| Error::io(path, "create", &cause))?;
    Ok((target, temporary, file))
}

/// A directory holds or may hold a file at `path`, and nothing that must stay is there.
fn has_place(path: &Path) -> Result<()> {
    if let Ok(old) = fs::metadata(path) {
        if old.is_dir() {
            return Err(Error::file(path, "cannot write: it is a directory"));
        }
        if old.permissions().readonly() {
            return Err(Error::file(path, "cannot write: the existing file is read-only"));
        }
    }
    let directory = directory(path);
    if directory.is_dir() {
        return Ok(());
    }
    Err(Error::file(path, format!("cannot create: there is no directory {}", directory.display())))
}

fn directory(path: &Path) -> &Path {
    path.parent().filter(|d| !d.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Write a temporary beside the target; nothing is left to do if the target is no regular file.
fn beside(path: &Path, write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> Result<Option<Finished>> {
    has_place(path)?;
    let failed = |doing| move |cause: io::Error| Error::io(path, doing, &cause);
    let old = fs::metadata(path).ok();
    if old.as_ref().is_some_and(|old| !old.is_file()) {
        let file = OpenOptions::new().write(true).open(path).map_err(failed("open"))?;
        return fill(file, write).map(|()| None).map_err(failed("write"));
    }
    let (target, temporary, file) = temporary_for(path)?;
    fill(file, write).map_err(failed("write"))?;
    if let Some(old) = old {
        fs::set_permissions(&temporary.path, old.permissions()).map_err(failed("keep its permissions"))?;
    }
    Ok(Some(Finished { temporary, path: path.to_owned(), target }))
}

/// A whole file that waits beside its target.
struct Finished {
    temporary: Temporary,
    /// As the user wrote it.
    path: PathBuf,
    /// Links followed.
    target: PathBuf,
}

impl Finished {
    fn replace(self) -> Result<()> {
        fs::rename(&self.temporary.path, &self.target).map_err(|cause| Error::io(&self.path, "replace", &cause))?;
        let mut written = WRITTEN.lock().unwrap_or_else(PoisonError::into_inner); // a count is valid at any moment
        *written = (written.0 + 1, Some(self.path));
        Ok(())
    }
}

fn fill(file: File, write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> io::Result<()> {
    let mut out = BufWriter::with_capacity(BUFFER, file);
    write(&mut out)?;
    out.flush()
}

/// Removes the temporaries of writes that have not ended: for a signal handler's thread, just before the process exits.
/// Writes still running then fail at their rename.
pub fn discard_unfinished() {
    for path in unfinished().iter() {
        let _ = fs::remove_file(path); // it may not exist yet or any more, and there is nobody to tell
    }
}

static WRITTEN: Mutex<(usize, Option<PathBuf>)> = Mutex::new((0, None));

/// How often this program has put a whole file in its place, and the last of these: for a message about a run that was cut off.
#[must_use]
pub fn written() -> (usize, Option<PathBuf>) {
    WRITTEN.lock().unwrap_or_else(PoisonError::into_inner).clone()
}

static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn unfinished() -> std::sync::MutexGuard<'static, Vec<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner) // a list of paths is valid at any moment
}

/// A file that is removed when dropped, unless renamed before.
struct Temporary {
    path: PathBuf,
}

impl Temporary {
    /// A new file under a name that nobody has: left-overs and other machines on a shared disk may have the first ones.
    fn create(directory: &Path) -> io::Result<(Self, File)> {
        static NEXT: AtomicUsize = AtomicUsize::new(0);
        loop {
            let n = NEXT.fetch_add(1, Ordering::Relaxed);
            let path = directory.join(format!(".voidage-{}-{n}.tmp", std::process::id()));
            match OpenOptions::new().write(true).create_new(true).open(&path) {
                Err(taken) if taken.kind() == io::ErrorKind::AlreadyExists => {}
                Err(other) => return Err(other),
                Ok(file) => {
                    unfinished().push(path.clone());
                    return Ok((Temporary { path }, file));
                }
            }
        }
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.path); // absent after the rename
        unfinished().retain(|p| *p != self.path);
    }
}
