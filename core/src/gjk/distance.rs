//! The distance between two bodies: the point of the difference nearest to the origin.
//!
//! Each round yields two bounds. The support plane across `v` is a lower bound, the simplex point `v` itself an upper one; rounding widens
//! both. Their difference is the duality gap: how far the stated distance can be from the truth.

use super::{Intersection, Overlap, Reason, SUPPORT_ROUNDINGS, Scale, across, scale, search, seed, within_radii};
use crate::real::{Real, Vector};
use crate::simplex::{Nearest, Side, Simplex, nearest, side};
use crate::support::{ScalarOf, Scaled, Support, lengthened};

/// What [`distance`] found.
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
        proof: Overlap<V>,
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

/// How many support points a distance query may look at. Polytopes need some twenty; smooth bodies converge by a factor a round.
pub const MAX_DISTANCE_ITERATIONS: u32 = 160;

/// Rounding of a convex combination of four differences, in units of ε times their largest component: the differences, the weights, their
/// products and sums, and the root of three for the length.
const COMBINATION_ROUNDINGS: f64 = 16.0;

/// Gap at which a search stops, in units of ε times the distance: a few roundings, below which no step makes progress.
const GAP_ROUNDINGS: f64 = 16.0;

/// How many steps may go by without a gain. Fewer leave distances to needles off by their thickness; more cost time near touch.
const PATIENCE: u32 = 8;

/// The distance of two bodies, with the points where it is attained.
///
/// `hint` is a direction from `a` towards `b`, of any length; see [`super::intersect`].
///
/// ```
/// use glam::DVec3;
/// use voidage_core::{aabb::Aabb, gjk::{Distance, distance}, shape::Sphere};
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
    match scale(a.extent() + b.extent()) {
        Scale::Keep => measure(a, b, hint, Real::ONE),
        Scale::Multiply(factor) => {
            let (a, b) = (Scaled { shape: a, factor }, Scaled { shape: b, factor });
            measure(&a, &b, hint, ScalarOf::<A>::ONE / factor)
        }
        Scale::Refuse(reason) => Distance::Undecided { lower: Real::ZERO, upper: Real::INFINITY, reason },
    }
}

fn measure<A, B>(a: &A, b: &B, hint: Option<A::Vector>, back: ScalarOf<A>) -> Distance<A::Vector>
where
    A: Support,
    B: Support<Vector = A::Vector>,
{
    let radii = a.radius() + b.radius();
    let mut found = walk(a, b, hint, Goal::Distance);
    if found.inside.is_none() && !(found.lower > Real::ZERO) {
        // Near the origin a symmetry may keep it on the simplex's rim: the boolean knows a way round that.
        let again = search(a, b, a.extent() + b.extent(), None, true);
        if let Intersection::Overlapping { proof: Overlap::Inside(simplex) } = again {
            found.inside = Some(simplex);
        }
    }
    stated(found, radii, back)
}

/// A walk's result in the words of the caller: radii taken off, scale undone.
fn stated<V: Vector>(found: Walk<V>, radii: V::Scalar, back: V::Scalar) -> Distance<V> {
    let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
    let relative = V::Scalar::from_f64(4.0) * V::Scalar::EPSILON;
    if let Some(simplex) = found.inside {
        let simplex = Simplex { a: simplex.a.map(|p| p * back), b: simplex.b.map(|p| p * back) };
        return Distance::Overlapping { proof: Overlap::Inside(simplex) };
    }
    if radii > zero && found.upper < radii * (one - relative) {
        return Distance::Overlapping { proof: Overlap::Within { a: found.a * back, b: found.b * back } };
    }
    // Bounds move outwards with each rounding, also that of a result below the normal numbers.
    let below = |x: V::Scalar| (x - x.abs() * relative) * back;
    let above = |x: V::Scalar| (x + x.abs() * relative) * back + V::Scalar::MIN_POSITIVE * V::Scalar::EPSILON;
    let lower = below(found.lower - radii * (one + relative));
    let upper = above((found.upper - radii * (one - relative)).max(zero));
    if !(lower > zero) {
        return Distance::Undecided { lower: zero, upper, reason: found.reason };
    }
    let length = found.v.length();
    let axis = if length > zero { found.v * (one / length) } else { V::ZERO };
    Distance::Separated {
        distance: ((length - radii) * back).max(lower).min(upper),
        a: (found.a + axis * found.radius_a) * back,
        b: (found.b - axis * found.radius_b) * back,
        axis,
        lower,
        upper,
    }
}

/// The boolean for rounded bodies: the cores' distance against the sum of the radii, stopping as soon as that is decided.
pub(super) fn intersect_rounded<A, B>(a: &A, b: &B, hint: Option<A::Vector>) -> Intersection<A::Vector>
where
    A: Support,
    B: Support<Vector = A::Vector>,
{
    let radii = a.radius() + b.radius();
    let found = walk(a, b, hint, Goal::Compare(radii));
    let one = ScalarOf::<A>::ONE;
    let relative = ScalarOf::<A>::from_f64(4.0) * ScalarOf::<A>::EPSILON;
    if let Some(simplex) = found.inside {
        return Intersection::Overlapping { proof: Overlap::Inside(simplex) };
    }
    if found.lower > radii * (one + relative) {
        return Intersection::Apart { axis: found.axis };
    }
    if within_radii(found.a, found.b, radii, a.slack().max(b.slack()) + found.error) {
        return Intersection::Overlapping { proof: Overlap::Within { a: found.a, b: found.b } };
    }
    Intersection::Undecided { reason: found.reason, axis: found.axis }
}

/// What a walk is for.
#[derive(Clone, Copy)]
enum Goal<R> {
    /// As close as rounding lets it.
    Distance,
    /// Whether the distance is above or below this.
    Compare(R),
}

/// Where a walk ended. Lengths are those of the cores.
struct Walk<V: Vector> {
    /// The core's overlap, if proved.
    inside: Option<Simplex<V>>,
    lower: V::Scalar,
    upper: V::Scalar,
    /// Nearest point of the difference.
    v: V,
    /// The direction that gave the lower bound.
    axis: V,
    a: V,
    b: V,
    radius_a: V::Scalar,
    radius_b: V::Scalar,
    /// How far `a` and `b` may be from the cores, in each component, besides the bodies' slacks.
    error: V::Scalar,
    reason: Reason,
}

fn walk<A, B>(a: &A, b: &B, hint: Option<A::Vector>, goal: Goal<ScalarOf<A>>) -> Walk<A::Vector>
where
    A: Support,
    B: Support<Vector = A::Vector>,
{
    type S<A> = ScalarOf<A>;
    let (zero, one) = (S::<A>::ZERO, S::<A>::ONE);
    let real = S::<A>::from_f64;
    let extent = a.extent() + b.extent();
    let slack = a.slack() + b.slack();
    let margin = real(SUPPORT_ROUNDINGS) * S::<A>::EPSILON * extent + slack + S::<A>::UNDERFLOW;
    let relative = real(8.0) * S::<A>::EPSILON;
    let origin = A::Vector::ZERO;

    let mut axis = seed(a, b, hint);
    let (mut start_a, mut start_b) = (0, 0);
    let mut points = [(origin, origin, origin); 4];
    let mut count = 0;
    let mut stalled = 0;
    let mut best = Walk {
        inside: None,
        lower: zero,
        upper: S::<A>::INFINITY,
        v: axis,
        axis,
        a: a.center(),
        b: b.center(),
        radius_a: a.radius(),
        radius_b: b.radius(),
        error: real(4.0) * S::<A>::EPSILON * extent,
        reason: Reason::Iterations,
    };

    for _ in 0..MAX_DISTANCE_ITERATIONS {
        let (mut direction, mut size) = (axis, axis.norm_1());
        if !(size > S::<A>::SCALE_MIN) {
            direction = lengthened(axis);
            size = direction.norm_1();
            if !(size >= one) || !size.is_finite() {
                best.reason = Reason::Rounding;
                break;
            }
        }
        let mut from_a = a.support(direction, start_a);
        let mut from_b = b.support(-direction, start_b);
        let inv_length = one / direction.dot(direction).sqrt();
        let bound = |w: A::Vector| {
            let along = w.dot(direction) - margin * size;
            (along - along.abs() * relative) * inv_length
        };
        let mut new = from_b.point - from_a.point;
        if bound(new) > best.lower {
            from_a = a.farther(direction, from_a.index).unwrap_or(from_a);
            from_b = b.farther(-direction, from_b.index).unwrap_or(from_b);
            new = from_b.point - from_a.point;
            let lower = bound(new);
            if lower > best.lower {
                (best.lower, best.axis) = (lower, direction);
            }
        }
        (start_a, start_b) = (from_a.index, from_b.index);
        match goal {
            Goal::Compare(limit) if best.lower > limit * (one + relative) => return best,
            Goal::Compare(limit) if best.upper < limit * (one - relative) => return best,
            _ => {}
        }
        let gap = best.upper - best.lower;
        let repeated = points.iter().take(count).any(|p| p.0 == new);
        if repeated || (count > 0 && gap <= real(GAP_ROUNDINGS) * S::<A>::EPSILON * best.upper) {
            best.reason = Reason::Rounding;
            break;
        }
        points = [(new, from_a.point, from_b.point), points[0], points[1], points[2]];
        count = (count + 1).min(4);
        let w = points.map(|p| p.0);
        if count == 4 && side(w, slack) == Side::Inside {
            best.inside = Some(Simplex { a: points.map(|p| p.1), b: points.map(|p| p.2) });
            return best;
        }
        let Nearest { point: v, weights, count: kept, order } = nearest(w, count);
        points = order.map(|i| points[i & 3]);
        count = kept;
        let mut combined = [origin; 3];
        let mut reach = zero;
        for (p, weight) in points.iter().zip(weights).take(count) {
            combined[0] += p.0 * weight;
            combined[1] += p.1 * weight;
            combined[2] += p.2 * weight;
            reach = reach.max(p.0.norm_max());
        }
        let error = real(COMBINATION_ROUNDINGS) * S::<A>::EPSILON * reach + real(1.75) * slack + S::<A>::UNDERFLOW;
        let upper = norm(combined[0]) * (one + relative) + error;
        let progress = v.dot(v) < best.v.dot(best.v) || !(best.upper < S::<A>::INFINITY);
        if upper < best.upper || (progress && norm(v) < best.upper) {
            best.upper = best.upper.min(upper);
            best.v = v;
            best.a = combined[1];
            best.b = combined[2];
        }
        // Along a needle the first steps gain less than one rounding, and yet lead to the nearest point.
        if !progress {
            stalled += 1;
            if stalled > PATIENCE {
                best.reason = Reason::Rounding;
                break;
            }
        }
        axis = v;
        if v == origin && count == 3 {
            axis = (w_of(&points, 1) - w_of(&points, 0)).cross(w_of(&points, 2) - w_of(&points, 0));
        } else if v == origin && count == 2 {
            axis = across(w_of(&points, 1) - w_of(&points, 0));
        }
    }
    best
}

/// Length of a vector not too large to square.
#[inline(always)]
fn norm<V: Vector>(v: V) -> V::Scalar {
    let sq = v.dot(v);
    if sq > V::Scalar::UNDERFLOW { sq.sqrt() } else { v.length() }
}

fn w_of<V: Vector>(points: &[(V, V, V); 4], i: usize) -> V {
    points[i & 3].0
}
