//! Repeated measurements, and lines through points in logarithms.

use crate::error::Result;
use serde::{Deserialize, Serialize};
use std::time::Instant;

/// Times of some runs of one thing, in seconds.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// The median.
    pub median: f64,
    /// The shortest.
    pub fastest: f64,
    /// The longest.
    pub slowest: f64,
}

impl Spread {
    /// Of some values; of none, all zero.
    #[must_use]
    pub fn of(mut values: Vec<f64>) -> Self {
        values.sort_by(f64::total_cmp);
        let at = |n: usize| values.get(n).copied().unwrap_or_default();
        let (below, above) = (at(values.len().saturating_sub(1) / 2), at(values.len() / 2));
        Spread { median: 0.5 * (below + above), fastest: at(0), slowest: at(values.len().saturating_sub(1)) }
    }
}

/// Runs something `repeats` times, at least once, and gives the last result.
///
/// # Errors
/// The first of any run.
pub fn timed<T>(repeats: usize, mut run: impl FnMut() -> Result<T>) -> Result<(T, Spread)> {
    let mut seconds = Vec::with_capacity(repeats);
    loop {
        let begin = Instant::now();
        let result = run()?;
        seconds.push(begin.elapsed().as_secs_f64());
        if seconds.len() >= repeats {
            return Ok((result, Spread::of(seconds)));
        }
    }
}

/// Slope of the straight line through the logarithms of some points, by least squares, and the standard error of it (none for two points).
/// Points that are not positive do not count; nothing if fewer than two places along x are left.
#[must_use]
pub fn slope(points: &[[f64; 2]]) -> Option<(f64, Option<f64>)> {
    let logs = points.iter().filter(|p| p.iter().all(|v| v.is_finite() && *v > 0.0)).map(|p| p.map(f64::ln));
    let logs: Vec<[f64; 2]> = logs.collect();
    let n = logs.len() as f64;
    let mean = |axis: usize| logs.iter().map(|p| p[axis]).sum::<f64>() / n;
    let (mx, my) = (mean(0), mean(1));
    let xx: f64 = logs.iter().map(|p| (p[0] - mx).powi(2)).sum();
    let xy: f64 = logs.iter().map(|p| (p[0] - mx) * (p[1] - my)).sum();
    if !(xx > 1e-12) {
        return None;
    }
    let slope = xy / xx;
    let rest: f64 = logs.iter().map(|p| (p[1] - my - slope * (p[0] - mx)).powi(2)).sum();
    Some((slope, (n > 2.5).then(|| (rest / (n - 2.0) / xx).sqrt())))
}
