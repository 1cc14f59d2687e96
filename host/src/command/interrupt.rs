//! Ctrl-C: a run that can end in good order is asked to; any other ends at once.

use crate::files::written;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

static WATCHED: AtomicBool = AtomicBool::new(false);
static ASKED: AtomicBool = AtomicBool::new(false);

/// A run that can go on has been watched and is not any more.
static STEPPED: AtomicBool = AtomicBool::new(false);

/// While it lives, an interrupt only asks the run to stop: see [`asked`].
#[derive(Debug)]
pub struct Watch(());

impl Watch {
    /// Begins to watch.
    #[must_use]
    #[allow(clippy::new_without_default)]
    pub fn new() -> Self {
        WATCHED.store(true, Ordering::SeqCst);
        Watch(())
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        WATCHED.store(false, Ordering::SeqCst);
        STEPPED.store(true, Ordering::SeqCst);
    }
}

/// Signals within this time of the first count as that one: shells and supervisors send two at once.
const ONE: Duration = Duration::from_secs(2);

/// When the first signal came, and whether the run was watched then.
static FIRST: Mutex<Option<(Instant, bool)>> = Mutex::new(None);

/// The run has been asked to stop.
#[must_use]
pub fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}

/// What a run that ends at once leaves.
#[must_use]
pub fn cut_off() -> String {
    let advice = if STEPPED.load(Ordering::SeqCst) { "; with --resume the run is finished" } else { "" };
    let left = match written() {
        (1, Some(file)) => format!("interrupted: {} was written, and nothing else", file.display()),
        (_, Some(last)) => format!("interrupted: files were written, each whole; the last is {}", last.display()),
        _ => "interrupted: no file was written".to_owned(),
    };
    left + advice
}

/// For the signal handler: asks the run to stop, and returns whether it will do so by itself. False, so that the program ends at once, if the run was
/// not watched when the first signal came, or if that was two seconds ago or more. A sooner signal counts as the first, even if the run has
/// stopped stepping by then and is about to say so.
#[must_use]
pub fn interrupt() -> bool {
    ASKED.store(true, Ordering::SeqCst);
    let mut first = FIRST.lock().unwrap_or_else(PoisonError::into_inner); // a moment is valid at any moment
    let (begun, watched) = first.get_or_insert_with(|| (Instant::now(), WATCHED.load(Ordering::SeqCst)));
    *watched && begun.elapsed() < ONE
}
