//! The distance between two bodies, with bounds.

use super::closest::{Closest, Goal, closest_point};
use super::outcome::{Distance, Intersection, OverlapProof};
use super::pair::{BodyPair, Scale, scale};
use super::search::search;
use crate::convex::support::{ScalarOf, Support};
use crate::number::real::{Real, Vector};

/// The distance of two bodies, with the points where it is attained.
///
/// `hint` is a direction from `a` towards `b`, of any length; see [`super::intersect`].
///
/// ```
/// use glam::DVec3;
/// use voidage_core::{number::aabb::Aabb, convex::gjk::{Distance, distance}, convex::shape::Sphere};
///
/// let cell = Aabb { min: DVec3::ZERO, max: DVec3::ONE };
/// let ball = Sphere { center: DVec3::new(3.0, 0.5, 0.5), radius: 1.0 };
/// let Distance::Separated { distance, lower, upper, .. } = distance(&cell, &ball, None) else { panic!() };
/// assert!(lower <= 1.0 && 1.0 <= upper && (distance - 1.0).abs() < 1e-14);
/// ```
pub fn distance<A, B>(a: &A, b: &B, hint: Option<A::Vector>) -> Distance<A::Vector>
where
    A: Support,
    B: Support<Vector = A::Vector>,
{
    let extent = a.extent() + b.extent();
    match scale(extent) {
        Scale::Keep => distance_scaled(&BodyPair::<A, B, ScalarOf<A>, false>::new(a, b, extent, Real::ONE), hint),
        Scale::Multiply(factor) => {
            distance_scaled(&BodyPair::<A, B, ScalarOf<A>, true>::new(a, b, extent, factor), hint)
        }
        Scale::Refuse(reason) => Distance::Undecided { lower: Real::ZERO, upper: Real::INFINITY, reason },
    }
}

fn distance_scaled<A, B, const SCALED: bool>(
    pair: &BodyPair<A, B, ScalarOf<A>, SCALED>,
    hint: Option<A::Vector>,
) -> Distance<A::Vector>
where
    A: Support,
    B: Support<Vector = A::Vector>,
{
    // An overlap is quickly seen; else the axis that separates is a good first direction.
    let mut hint = hint;
    if !(A::ROUNDED || B::ROUNDED) {
        match search(pair, hint, false) {
            Intersection::Overlapping { proof } => return Distance::Overlapping { proof },
            Intersection::Apart { axis } => hint = Some(axis),
            Intersection::Undecided { .. } => {}
        }
    }
    let mut found = closest_point(pair, hint, Goal::Distance);
    if found.inside.is_none() && !(found.lower > Real::ZERO) {
        // Where bodies overlap, a symmetry may keep the origin on the rim of every simplex: the boolean search has leaning directions for that.
        if let Intersection::Overlapping { proof: OverlapProof::Inside(simplex) } = search(pair, None, true) {
            found.inside = Some(simplex);
        }
    }
    into_distance(pair, &found)
}

/// Turns the closest points of the cores into the distance of the bodies: subtracts the radii, undoes the scale, widens the bounds by rounding.
fn into_distance<A, B, const SCALED: bool>(
    pair: &BodyPair<A, B, ScalarOf<A>, SCALED>,
    found: &Closest<A::Vector>,
) -> Distance<A::Vector>
where
    A: Support,
    B: Support<Vector = A::Vector>,
{
    type S<A> = ScalarOf<A>;
    let (zero, one) = (S::<A>::ZERO, S::<A>::ONE);
    let relative = S::<A>::from_f64(4.0) * S::<A>::EPSILON;
    let radii = pair.radii();
    if let Some(simplex) = found.inside {
        return Distance::Overlapping { proof: OverlapProof::Inside(simplex) };
    }
    let (p, q) = found.points();
    if radii > zero && found.upper < radii * (one - relative) {
        return Distance::Overlapping { proof: OverlapProof::Within { a: p, b: q } };
    }
    // Bounds move outwards with each rounding, also that of a result below the normal numbers.
    let below = |x: S<A>| pair.unscaled(x - x.abs() * relative);
    let above = |x: S<A>| pair.unscaled(x + x.abs() * relative) + S::<A>::MIN_POSITIVE * S::<A>::EPSILON;
    let lower = below(found.lower - radii * (one + relative));
    let upper = above((found.upper - radii * (one - relative)).max(zero));
    if !(lower > zero) {
        return Distance::Undecided { lower: zero, upper, reason: found.reason };
    }
    let length = found.v.length();
    let axis = if length > zero { found.v * (one / length) } else { A::Vector::ZERO };
    let (a, b) = pair.bodies();
    Distance::Separated {
        distance: pair.unscaled(length - radii).max(lower).min(upper),
        a: p + axis * a.radius(),
        b: q - axis * b.radius(),
        axis,
        lower,
        upper,
    }
}
