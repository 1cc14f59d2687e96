//! Largest forces on solids over a run. A checkpoint keeps them, so that those of a run that was resumed are those of the whole.

use super::solids::SolidForce;
use serde::{Deserialize, Serialize};

/// Largest forces so far on the solids of a name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ForcePeak {
    /// Their name.
    pub name: String,
    /// Along x, y and z: the force that was largest in size, with its sign, in N.
    pub peak: [f64; 3],
    /// When these acted, in s.
    pub peak_time: [f64; 3],
    /// Largest size of the force as a vector, in N.
    pub largest: f64,
    /// When that was, in s.
    pub largest_time: f64,
}

/// Takes the forces of a moment into the largest so far. Of equal ones the first counts; NaN never.
pub fn take(peaks: &mut Vec<ForcePeak>, forces: &[SolidForce], time: f64) {
    for (n, SolidForce { name, force }) in forces.iter().enumerate() {
        // As a rule they come in the same order each time.
        let same = peaks.get(n).is_some_and(|p| p.name == *name).then_some(n);
        let known = same.or_else(|| peaks.iter().position(|p| p.name == *name));
        let n = known.unwrap_or_else(|| {
            let (peak, peak_time) = ([0.0; 3], [time; 3]);
            peaks.push(ForcePeak { name: name.clone(), peak, peak_time, largest: 0.0, largest_time: time });
            peaks.len() - 1
        });
        let so_far = &mut peaks[n];
        for (axis, &now) in force.iter().enumerate() {
            if now.abs() > so_far.peak[axis].abs() {
                (so_far.peak[axis], so_far.peak_time[axis]) = (now, time);
            }
        }
        let size = force.iter().map(|f| f * f).sum::<f64>().sqrt();
        if size > so_far.largest {
            (so_far.largest, so_far.largest_time) = (size, time);
        }
    }
}
