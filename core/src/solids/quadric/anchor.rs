//! Where the axis of a solid is counted from.
//!
//! A pipe that begins a thousand kilometres away lies where its direction says only within the rounding of that length. Grids stand near the
//! origin of coordinates, so the axis of a solid that is long beside its distance from there begins at its point nearest to the origin, which
//! is known to the last digit.

use super::twofold::{difference, product};
use super::wall::hypotenuse;
use crate::number::axis::Axis;

/// A point of an axis between two ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Anchor {
    pub place: [f64; 3],
    /// Its share of the way from the first end to the second.
    share: f64,
}

/// Axes that begin farther from their anchor than so many of its distances from the origin and of the solid's radius are counted from it.
const LONG: f64 = 16.0;

/// `a + t (b − a)`, rounded once where b is far.
fn between(a: f64, b: f64, t: f64) -> f64 {
    let way = difference(b, a);
    let part = product(t, way.value);
    let sum = difference(part.value, -a);
    sum.value + (sum.rest + (part.rest + t * way.rest))
}

impl Anchor {
    /// Of an axis of this length and direction; none if it may as well begin at `start`.
    pub fn of(
        [from, to]: [[f64; 3]; 2],
        (length, axis): (f64, [f64; 3]),
        start: [f64; 3],
        radius: f64,
    ) -> Option<Self> {
        let share = (-(from[0] * axis[0] + from[1] * axis[1] + from[2] * axis[2]) / length).clamp(0.0, 1.0);
        let place = if share == 1.0 { to } else { Axis::ALL.map(|n| between(from[n], to[n], share)) };
        let distance = |from: [f64; 3]| {
            let [x, y, z] = Axis::ALL.map(|n| place[n] - from[n]);
            hypotenuse(hypotenuse(x, y), z)
        };
        (distance(start) > LONG * (distance([0.0; 3]) + radius)).then_some(Anchor { place, share })
    }

    /// The radius there of a solid that has these at its ends.
    pub fn radius(&self, [from, to]: [f64; 2]) -> f64 {
        if self.share == 1.0 { to } else { between(from, to, self.share) }
    }
}
