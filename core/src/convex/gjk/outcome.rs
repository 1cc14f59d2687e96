//! What a query answers, with its proof.

use crate::convex::simplex::Simplex;
use crate::number::real::{Real, Vector};

/// What [`intersect`](super::intersect) found. There is no fourth answer: it may be matched without a rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Intersection<V: Vector> {
    /// The bodies share no interior point: proved by [`separates`](super::separates).
    Apart {
        /// A direction, of any length, along which no point of `a` lies beyond any point of `b`.
        axis: V,
    },
    /// The bodies share an interior point.
    Overlapping {
        /// Why.
        proof: OverlapProof<V>,
    },
    /// Neither could be proved with the arithmetic at hand.
    Undecided {
        /// Why not.
        reason: Reason,
        /// The last direction tried; a good hint for whoever tries harder. May be zero.
        axis: V,
    },
}

/// A proof that two bodies overlap.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum OverlapProof<V: Vector> {
    /// Four pairs of points: [`Simplex::holds_origin`].
    Inside(Simplex<V>),
    /// For rounded bodies: a point of each core, closer together than the sum of the radii. See [`within_radii`].
    Within {
        /// A point of the first core.
        a: V,
        /// A point of the second core.
        b: V,
    },
}

/// Why a query was left undecided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Reason {
    /// A coordinate is NaN or infinite, a body is empty or a radius is negative, or the numbers are too large to add.
    NotFinite,
    /// All coordinates are so small that their products vanish.
    TooSmall,
    /// The bodies touch, or come closer to it than rounding lets us tell.
    Rounding,
    /// The cap on iterations was reached.
    Iterations,
}

/// What [`distance`](super::distance) found. There is no fourth answer: it may be matched without a rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Distance<V: Vector> {
    /// No point is shared.
    Separated {
        /// The distance, within `lower..=upper`.
        distance: V::Scalar,
        /// The point of the first body that is nearest to the second.
        a: V,
        /// The point of the second body that is nearest to the first.
        b: V,
        /// Unit vector from `a` to `b`.
        axis: V,
        /// The true distance is not less than this; positive.
        lower: V::Scalar,
        /// The true distance is not more than this.
        upper: V::Scalar,
    },
    /// The bodies share an interior point.
    Overlapping {
        /// Why.
        proof: OverlapProof<V>,
    },
    /// Neither could be proved: the bodies touch, or nearly so, or cannot be computed with.
    Undecided {
        /// The true distance is not less than this.
        lower: V::Scalar,
        /// The true distance is not more than this; infinite if nothing is known.
        upper: V::Scalar,
        /// Why.
        reason: Reason,
    },
}

/// Proves that a point of one core and a point of another, each off by at most `slack` in each component, are closer than the radii.
pub fn within_radii<V: Vector>(a: V, b: V, radii: V::Scalar, slack: V::Scalar) -> bool {
    let relative = V::Scalar::from_f64(8.0) * V::Scalar::EPSILON;
    let w = b - a;
    // The root of three, rounded up, turns a bound by component into one of length.
    let apart = w.length() * (V::Scalar::ONE + relative) + V::Scalar::from_f64(1.75) * (slack + slack);
    apart < radii * (V::Scalar::ONE - relative)
}
