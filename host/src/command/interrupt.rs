//! Ctrl-C: a run that can end in good order is asked to; any other ends at once.

use std::sync::atomic::{AtomicBool, Ordering};

static WATCHED: AtomicBool = AtomicBool::new(false);
static ASKED: AtomicBool = AtomicBool::new(false);

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
    }
}

/// The run has been asked to stop.
#[must_use]
pub fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}

/// For the signal handler: whether the run will stop by itself. A second interrupt does not wait for that.
#[must_use]
pub fn interrupt() -> bool {
    let first = !ASKED.swap(true, Ordering::SeqCst);
    first && WATCHED.load(Ordering::SeqCst)
}
