//! What planes tell of a convex body that they cut: the square roots of areas, concave functions of the height, and where there is nothing.

use super::concave::{lowest, squares};
use crate::number::plane::P2;
use crate::number::real::Real;

/// What a plane has of a body.
#[derive(Clone, Copy, Debug)]
pub(super) enum Polygon {
    /// Bounds of the square root of its area; by how much that grows with the height, and by how much that growth may be off: no numbers where that is
    /// not known.
    Some { root: P2, rise: P2 },
    /// Nothing, and there is nothing up to another height either; none if that is not known.
    Nothing(Option<Beyond>),
}

/// Heights at which there is nothing.
#[derive(Clone, Copy, Debug)]
pub(super) enum Beyond {
    Below(f64),
    Above(f64),
    All,
}

impl Beyond {
    /// By how much what is missing at a height, and by how much that shrinks with the height at least.
    pub fn new(height: f64, missing: f64, growth: f64) -> Option<Self> {
        match missing / growth {
            _ if !(missing > 0.0) => None,
            _ if growth == 0.0 => Some(Beyond::All),
            way if way > 0.0 => Some(Beyond::Below(height + way)),
            way if way < 0.0 => Some(Beyond::Above(height + way)),
            _ => None,
        }
    }
}

/// What a plane at a height tells: bounds of the square root of its area, and by how much that grows with the height and may be off; no numbers where
/// that is not known.
#[derive(Clone, Copy)]
pub(super) struct Sample {
    pub at: f64,
    root: P2,
    rise: P2,
    beyond: Option<Beyond>,
}

impl Sample {
    pub fn new(at: f64, polygon: &Polygon, most: f64) -> Self {
        let unknown = Sample { at, root: [0.0, Real::sqrt(most)], rise: [f64::NAN; 2], beyond: None };
        match *polygon {
            Polygon::Some { root, rise } => Sample { root, rise, ..unknown },
            Polygon::Nothing(None) => unknown,
            Polygon::Nothing(beyond) => Sample { root: [0.0; 2], beyond, ..unknown },
        }
    }

    /// Its tangent's values here and so far from here; none if it is not known.
    fn tangent(&self, far: f64) -> Option<P2> {
        let there = self.root[1] + self.rise[0] * far + self.rise[1] * far.abs();
        there.is_finite().then_some([self.root[1], there])
    }

    /// The line through what is certain of another sample and through this one, here and in a third place: an upper bound beyond this one.
    fn line(&self, other: Option<&Self>, at: f64) -> Option<P2> {
        let other = other.filter(|o| o.root[0] > 0.0)?;
        let there = self.root[1] + (self.root[1] - other.root[0]) / (self.at - other.at) * (at - self.at);
        there.is_finite().then_some([self.root[1], there])
    }

    /// Bounds of the volume from here to a higher plane, of areas up to `most`; samples below and above may help.
    pub fn between(&self, to: &Self, [below, above]: [Option<&Self>; 2], most: f64) -> P2 {
        let nothing = matches!(self.beyond, Some(Beyond::Above(_) | Beyond::All))
            || matches!(to.beyond, Some(Beyond::Below(_) | Beyond::All));
        if nothing {
            return [0.0; 2];
        }
        let width = to.at - self.at;
        let ahead = self.tangent(width).or_else(|| self.line(below, to.at));
        let back = to.tangent(-width).or_else(|| to.line(above, self.at)).map(|[near, far]| [far, near]);
        let high = lowest([ahead, back], Real::sqrt(most)) * width;
        let both = self.root[0] > 0.0 && to.root[0] > 0.0;
        [if both { squares(self.root[0], to.root[0]) * width } else { 0.0 }, high]
    }
}
