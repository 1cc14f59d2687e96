//! Do two convex bodies meet, and how far apart are they? An answer comes with a proof, or is [`Undecided`](Intersection::Undecided).
//!
//! Gilbert, Johnson and Keerthi's search in the Minkowski difference `b - a` of all differences of points. If a direction has all of it
//! on one side, the bodies are apart; if four of its points hold the origin, they overlap. Interiors decide: bodies that only touch do not
//! overlap. Every comparison is relative to the size of what is compared; no tolerance has a unit.
//!
//! Reference: E. G. Gilbert, D. W. Johnson, S. S. Keerthi, "A fast procedure for computing the distance between complex objects in
//! three-dimensional space", *IEEE J. Robotics and Automation* 4 (1988).
//!
//! A file uses only those above it in this list:
//!
//! 1. `outcome`: the answers
//! 2. `pair`: two bodies, brought to a size that one can compute with
//! 3. `working_simplex`: the simplex of a search
//! 4. `closest`: the point of the difference nearest to the origin
//! 5. `search`: does the difference hold the origin?
//! 6. `distance`: the distance, with bounds

use crate::convex::support::{ScalarOf, Support};
use crate::number::real::{Real, Vector};

mod closest;
mod distance;
mod outcome;
mod pair;
mod search;
mod working_simplex;
pub use closest::MAX_DISTANCE_ITERATIONS;
use closest::intersect_rounded;
pub use distance::distance;
pub use outcome::{Distance, Intersection, OverlapProof, Reason, within_radii};
use pair::{BodyPair, Scale, scale};
pub use search::MAX_ITERATIONS;
use search::search;

/// Do the interiors of two bodies share a point?
///
/// `hint` is a direction from `a` towards `b`, of any length: the axis of a similar query, say. Without one the search starts along the
/// centres. It changes the work, not the truth.
///
/// ```
/// use glam::DVec3;
/// use voidage_core::{convex::gjk::{Intersection, intersect}, convex::shape::Sphere};
///
/// let a = Sphere { center: DVec3::ZERO, radius: 1.0 };
/// let b = Sphere { center: DVec3::new(3.0, 0.0, 0.0), radius: 1.5 };
/// assert!(matches!(intersect(&a, &b, None), Intersection::Apart { .. }));
/// ```
#[inline]
pub fn intersect<A, B>(a: &A, b: &B, hint: Option<A::Vector>) -> Intersection<A::Vector>
where
    A: Support,
    B: Support<Vector = A::Vector>,
{
    let extent = a.extent() + b.extent();
    match scale(extent) {
        Scale::Keep => decide(&BodyPair::<A, B, ScalarOf<A>, false>::new(a, b, extent, Real::ONE), hint),
        Scale::Multiply(factor) => intersect_scaled(&BodyPair::new(a, b, extent, factor), hint),
        Scale::Refuse(reason) => Intersection::Undecided { reason, axis: A::Vector::ZERO },
    }
}

#[cold]
#[inline(never)]
fn intersect_scaled<A, B>(pair: &BodyPair<A, B, ScalarOf<A>, true>, hint: Option<A::Vector>) -> Intersection<A::Vector>
where
    A: Support,
    B: Support<Vector = A::Vector>,
{
    decide(pair, hint)
}

#[inline(always)]
fn decide<A, B, const SCALED: bool>(
    pair: &BodyPair<A, B, ScalarOf<A>, SCALED>,
    hint: Option<A::Vector>,
) -> Intersection<A::Vector>
where
    A: Support,
    B: Support<Vector = A::Vector>,
{
    if A::ROUNDED || B::ROUNDED { intersect_rounded(pair, hint) } else { search(pair, hint, false) }
}

/// Proves that no interior point is shared: no point of `a` lies beyond any point of `b` along `axis`, whatever the rounding. It looks at
/// all of each body, and at nothing a search may have left behind.
pub fn separates<A, B>(a: &A, b: &B, axis: A::Vector) -> bool
where
    A: Support,
    B: Support<Vector = A::Vector>,
{
    let extent = a.extent() + b.extent();
    let gap = match scale(extent) {
        Scale::Keep => BodyPair::<A, B, ScalarOf<A>, false>::new(a, b, extent, Real::ONE).gap(axis),
        Scale::Multiply(factor) => BodyPair::<A, B, ScalarOf<A>, true>::new(a, b, extent, factor).gap(axis),
        Scale::Refuse(_) => None,
    };
    gap.is_some_and(|gap| gap > Real::ZERO)
}
