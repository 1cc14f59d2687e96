//! One stable step on the way to a time: not past it, and repeated with half the time where it would need floors.

use crate::flow::error::Error;
use crate::flow::step_report::Report;
use crate::number::real::Real;

/// How often a step that needed floors is repeated with half the time before the floors stand.
const REPEATS: usize = 4;

/// The last so many steps before the end share what is left of the time equally.
const SHARING: usize = 32;

/// A step may be longer than the longest by this share of it, lest rounding makes one more.
const ROUNDING: f64 = 1e-6;

/// A step that was accepted.
#[derive(Clone, Copy, Debug)]
pub struct StableStep<R, const D: usize> {
    /// Its length.
    pub dt: R,
    /// The time reached.
    pub time: R,
    /// What it did.
    pub report: Report<R, D>,
    /// How many longer steps were tried before it and given up.
    pub repeated: usize,
}

/// Steps from `time` by `longest`, but not past `end`; the last steps before it are a little shorter, all alike, lest the very last one is tiny: what acts on a
/// wall in a step depends on its length. `attempt(dt)` computes the next field and leaves the present one alone, as [`Problem::step`]
/// does: where its report counts floors, it is called again with half the time. The field of the last call is the one to go on with. `end` lies after
/// `time`; a `longest` that is infinite or NaN is the whole way there.
///
/// [`Problem::step`]: crate::flow::Problem::step
///
/// # Errors
/// Those of `attempt`; [`Error::Stalled`] before an attempt whose step is too short to advance `time`; and [`Error::Step`] before the first one, if `time` or
/// `end` is NaN.
pub fn stable_step<R: Real, const D: usize, E: From<Error>>(
    time: R,
    end: R,
    longest: R,
    mut attempt: impl FnMut(R) -> Result<Report<R, D>, E>,
) -> Result<StableStep<R, D>, E> {
    if end.partial_cmp(&time).is_none() {
        return Err(Error::Step.into());
    }
    let left = end - time;
    let (last, mut dt) = match equal_steps(left, longest) {
        Some((steps, dt)) => (steps == R::ONE, dt),
        None => (false, longest),
    };
    let mut repeated = 0;
    loop {
        // The end itself, whatever the sum of time and step rounds to.
        let reached = if last && repeated == 0 { end } else { time + dt };
        if time < end && !(reached > time) {
            return Err(Error::Stalled.into());
        }
        let report = attempt(dt)?;
        if report.floored == 0 || repeated == REPEATS {
            return Ok(StableStep { dt, time: reached, report, repeated });
        }
        repeated += 1;
        dt = R::HALF * dt;
    }
}

/// A time in as few equal steps as may be, how many and how long, if that takes no more than [`SHARING`] of them.
fn equal_steps<R: Real>(left: R, longest: R) -> Option<(R, R)> {
    let reach = longest + R::from_f64(ROUNDING) * longest;
    let mut steps = R::ONE;
    for _ in 0..SHARING {
        // Not so either where a step is NaN or infinite.
        if !(steps * reach < left) {
            return Some((steps, left / steps));
        }
        steps += R::ONE;
    }
    None
}
