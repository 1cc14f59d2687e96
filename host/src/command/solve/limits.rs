//! When a run ends, and when it tells, draws and saves.

use super::case_file::CaseFile;
use crate::error::Result;
use std::time::Duration;

/// When a run ends, and when it writes.
#[derive(Debug, Clone, Copy)]
pub struct Limits {
    /// The time at which the run ends.
    pub end: f64,
    /// Steps after which it ends.
    pub max_steps: usize,
    /// Time from frame to frame.
    pub every: f64,
    /// Steps from line to line of the log.
    pub log_every: usize,
    /// From checkpoint to checkpoint.
    pub checkpoint_every: Duration,
}

/// Seconds between checkpoints of a case that does not say.
const USUAL_PAUSE: f64 = 60.0;

impl Limits {
    /// Those of a case.
    ///
    /// # Errors
    /// A limit that makes no sense, or no end.
    pub fn new(file: &CaseFile) -> Result<Self> {
        let (time, output) = (&file.case.time, &file.case.output);
        if time.end.is_none() && time.max_steps.is_none() {
            return Err(file.wrong("time", "needs end or max_steps"));
        }
        if output.log_every == Some(0) {
            return Err(file.wrong("output.log_every", "is at least 1"));
        }
        if matches!((time.end, output.every), (Some(end), Some(every)) if end / every > MOST_FRAMES) {
            return Err(file.wrong("output.every", format!("makes more than {MOST_FRAMES} frames")));
        }
        Ok(Limits {
            end: time.end.unwrap_or(f64::INFINITY),
            max_steps: time.max_steps.unwrap_or(usize::MAX),
            every: output.every.unwrap_or(f64::INFINITY),
            log_every: output.log_every.unwrap_or(1),
            checkpoint_every: Duration::from_secs_f64(output.checkpoint_every.unwrap_or(USUAL_PAUSE)),
        })
    }

    /// The next moment that a step must not pass. Depends on the time alone, so that a resumed run meets the same.
    #[must_use]
    pub fn next_stop(&self, time: f64) -> f64 {
        if self.every == f64::INFINITY {
            return self.end;
        }
        let mut n = (time / self.every).floor() + 1.0;
        if n * self.every <= time {
            n += 1.0;
        }
        (n * self.every).min(self.end)
    }

    /// A case has an end, and a run that is over at this time has not come to it.
    #[must_use]
    pub fn falls_short(&self, time: f64) -> bool {
        self.end < f64::INFINITY && time < self.end
    }

    /// Is the moment of a stop that of a frame, and not merely the end?
    #[must_use]
    pub fn is_frame(&self, stop: f64) -> bool {
        stop < self.end || (stop / self.every).round() * self.every == stop
    }
}

/// Frames of a run: more is a slip of the pen.
const MOST_FRAMES: f64 = 1e6;
