//! Functions in a box, between two that are affine.

use crate::number::axis::Axis;
use crate::number::plane::P2;
use heapless::Vec;

/// A box by its middle and half of its size along each axis, 0 where it is flat. Points in it are told by −1 to 1 along each axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoxAround {
    /// Its middle.
    pub middle: [f64; 3],
    /// Half of its size.
    pub half: [f64; 3],
}

impl BoxAround {
    /// From low and high coordinates.
    #[must_use]
    pub fn new(sides: [[f64; 2]; 3]) -> Self {
        let half = |[lo, hi]: P2| if lo == hi { 0.0 } else { 0.5 * hi - 0.5 * lo };
        let middle = |[lo, hi]: P2| if lo == hi { lo } else { 0.5 * lo + 0.5 * hi };
        BoxAround { middle: sides.map(middle), half: sides.map(half) }
    }

    /// Low and high coordinates.
    #[must_use]
    pub fn sides(&self) -> [[f64; 2]; 3] {
        Axis::ALL.map(|n| [self.middle[n] - self.half[n], self.middle[n] + self.half[n]])
    }

    /// A part of a box halved along each axis along which it is not flat: the bits of its number choose the upper halves.
    pub(super) fn part(&self, number: usize) -> Self {
        let half = self.half.map(|h| 0.5 * h);
        let mut bits = number;
        let middle = Axis::ALL.map(|n| {
            if half[n] == 0.0 {
                return self.middle[n];
            }
            let up = bits & 1 == 1;
            bits >>= 1;
            if up { self.middle[n] + half[n] } else { self.middle[n] - half[n] }
        });
        BoxAround { middle, half }
    }

    /// Coordinates are rounded by about this.
    #[must_use]
    pub fn rounding(&self) -> f64 {
        let far = Axis::ALL.map(|n| self.middle[n].abs() + self.half[n]);
        4.0 * f64::EPSILON * (far[0] + far[1] + far[2])
    }
}

/// A solid is where a function is not positive; in a box the function is affine but for a rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constraint {
    /// The affine function in the middle of the box.
    pub middle: f64,
    /// By how much it grows from there to the high side along each axis.
    pub slope: [f64; 3],
    /// Bounds of the function less the affine one.
    pub rest: [f64; 2],
}

impl Constraint {
    /// The side of a plane to which its unit normal `inward` points; `from` leads from a point of the plane to the middle of the box, and its terms are rounded by
    /// the share `rounding`. None if the box lies in the plane.
    #[must_use]
    pub fn side_of_plane(place: &BoxAround, inward: [f64; 3], from: [f64; 3], rounding: f64) -> Option<Self> {
        let slope = Axis::ALL.map(|n| -inward[n] * place.half[n]);
        let terms = Axis::ALL.map(|n| -inward[n] * from[n]);
        let middle = terms[0] + terms[1] + terms[2];
        if slope == [0.0; 3] && middle == 0.0 {
            return None;
        }
        // A difference of two coordinates, of a plane across an axis, has the right sign.
        let exact = inward.iter().filter(|a| **a != 0.0).count() == 1;
        let sizes = terms.iter().chain(&slope).map(|t| t.abs()).sum::<f64>();
        let room = if exact { 0.0 } else { rounding * sizes + place.rounding() };
        Some(Constraint { middle, slope, rest: [-room, room] })
    }

    /// The same, but no point is known to be inside.
    fn or_nowhere(self) -> Self {
        let beyond = 2.0 * (self.middle.abs() + self.reach()) + 1.0;
        Constraint { rest: [self.rest[0], beyond], ..self }
    }

    /// What no point is inside of.
    #[must_use]
    pub const fn nowhere() -> Self {
        Constraint { middle: 1.0, slope: [0.0; 3], rest: [0.0; 2] }
    }

    /// How far the affine function is from its value in the middle, at most.
    fn reach(&self) -> f64 {
        self.slope[0].abs() + self.slope[1].abs() + self.slope[2].abs()
    }

    /// No point of the box is inside.
    fn excludes(&self) -> bool {
        self.middle + self.rest[0] - self.reach() > 0.0
    }

    /// All points of the box are inside.
    fn holds(&self) -> bool {
        self.middle + self.rest[1] + self.reach() <= 0.0
    }
}

/// Most constraints of a convex part of a solid: a curved surface and two flat ends.
pub(super) const MOST_CONSTRAINTS: usize = 3;

/// What is known of a part of a solid in a box.
#[derive(Clone, Debug, PartialEq)]
pub enum Enclosure {
    /// It does not reach the inside of the box.
    Open,
    /// It is where all these functions are not positive; without any it holds the box.
    Within(Vec<Constraint, MOST_CONSTRAINTS>),
}

impl Enclosure {
    /// From the constraints of a part; what decides nothing in the box is left out. Where more than three decide something, what lies within all of them is not known.
    pub fn new(constraints: impl IntoIterator<Item = Constraint>) -> Self {
        let mut kept = Vec::new();
        for constraint in constraints {
            if constraint.excludes() {
                return Enclosure::Open;
            }
            if !constraint.holds()
                && kept.push(constraint).is_err()
                && let Some(last) = kept.last_mut()
            {
                *last = last.or_nowhere();
            }
        }
        Enclosure::Within(kept)
    }
}
