//! The distance between two bodies: the point of the difference nearest to the origin.
//!
//! Each round yields two bounds. The support plane across `v` is a lower bound, the simplex point `v` itself an upper one; rounding widens
//! both. Their difference is the duality gap: how far the stated distance can be from the truth.

use super::pair::{BodyPair, Scale, scale};
use super::{Intersection, OverlapProof, Reason, across, search, within_radii};
use crate::convex::simplex::{NearestPoint, OriginSide, Simplex, nearest, side};
use crate::convex::support::{ScalarOf, Support, lengthened};
use crate::number::real::{Real, Vector};

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
    // OverlapProof is quickly seen, and else the axis that shows the gap leads the walk.
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
        // Near the origin a symmetry may keep it on the simplex's rim: the boolean knows a way round that.
        if let Intersection::Overlapping { proof: OverlapProof::Inside(simplex) } = search(pair, None, true) {
            found.inside = Some(simplex);
        }
    }
    into_distance(pair, &found)
}

/// A walk's result in the words of the caller: radii taken off, scale undone.
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
    if radii > zero && found.upper < radii * (one - relative) {
        return Distance::Overlapping { proof: OverlapProof::Within { a: found.a, b: found.b } };
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
        a: found.a + axis * a.radius(),
        b: found.b - axis * b.radius(),
        axis,
        lower,
        upper,
    }
}

/// The boolean for rounded bodies: the cores' distance against the sum of the radii, stopping as soon as that is decided.
pub(super) fn intersect_rounded<A, B, const SCALED: bool>(
    pair: &BodyPair<A, B, ScalarOf<A>, SCALED>,
    hint: Option<A::Vector>,
) -> Intersection<A::Vector>
where
    A: Support,
    B: Support<Vector = A::Vector>,
{
    let found = closest_point(pair, hint, Goal::Compare(pair.radii()));
    let relative = ScalarOf::<A>::from_f64(4.0) * ScalarOf::<A>::EPSILON;
    if let Some(simplex) = found.inside {
        return Intersection::Overlapping { proof: OverlapProof::Inside(simplex) };
    }
    if found.lower > pair.radii() * (ScalarOf::<A>::ONE + relative) {
        return Intersection::Apart { axis: found.axis };
    }
    let (a, b) = pair.bodies();
    let error = ScalarOf::<A>::from_f64(4.0) * ScalarOf::<A>::EPSILON * (a.extent() + b.extent());
    if within_radii(found.a, found.b, a.radius() + b.radius(), a.slack().max(b.slack()) + error) {
        return Intersection::Overlapping { proof: OverlapProof::Within { a: found.a, b: found.b } };
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

/// Where a walk ended. Lengths are those of the cores, scaled; points are not.
struct Closest<V: Vector> {
    /// The core's overlap, if proved.
    inside: Option<Simplex<V>>,
    lower: V::Scalar,
    upper: V::Scalar,
    /// NearestPoint point of the difference.
    v: V,
    /// The direction that gave the lower bound.
    axis: V,
    a: V,
    b: V,
    reason: Reason,
}

fn closest_point<A, B, const SCALED: bool>(
    pair: &BodyPair<A, B, ScalarOf<A>, SCALED>,
    hint: Option<A::Vector>,
    goal: Goal<ScalarOf<A>>,
) -> Closest<A::Vector>
where
    A: Support,
    B: Support<Vector = A::Vector>,
{
    type S<A> = ScalarOf<A>;
    let (zero, one) = (S::<A>::ZERO, S::<A>::ONE);
    let real = S::<A>::from_f64;
    let margin = pair.margin();
    let relative = real(8.0) * S::<A>::EPSILON;
    let origin = A::Vector::ZERO;

    let mut axis = pair.seed(hint);
    let mut starts = (0, 0);
    // Differences, newest first, and where their points are kept.
    let mut w = [origin; 4];
    let mut slot = [0usize, 1, 2, 3];
    let mut pairs = [(origin, origin); 4];
    let mut count = 0;
    let mut stalled = 0;
    // The nearest point so far: weights, and the points they belong to.
    let mut witnesses = [(zero, (origin, origin)); 3];
    let mut best = Closest {
        inside: None,
        lower: zero,
        upper: S::<A>::INFINITY,
        v: axis,
        axis,
        a: origin,
        b: origin,
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
        let (mut from_a, mut from_b) = pair.supports(direction, starts);
        let mut new = pair.difference(from_a.point, from_b.point);
        let inv_length = one / direction.dot(direction).sqrt();
        let bound = |w: A::Vector| {
            let along = w.dot(direction) - margin * size;
            (along - along.abs() * relative) * inv_length
        };
        if bound(new) > best.lower {
            (from_a, from_b) = pair.farther(direction, from_a, from_b);
            new = pair.difference(from_a.point, from_b.point);
            let lower = bound(new);
            if lower > best.lower {
                (best.lower, best.axis) = (lower, direction);
            }
        }
        starts = (from_a.index, from_b.index);
        match goal {
            Goal::Compare(limit) if best.lower > limit * (one + relative) => break,
            Goal::Compare(limit) if best.upper < limit * (one - relative) => break,
            _ => {}
        }
        let gap = best.upper - best.lower;
        let repeated = w.iter().take(count).any(|&p| p == new);
        if repeated || (count > 0 && gap <= real(GAP_ROUNDINGS) * S::<A>::EPSILON * best.upper) {
            best.reason = Reason::Rounding;
            break;
        }
        let free = slot[3];
        pairs[free & 3] = (from_a.point, from_b.point);
        w = [new, w[0], w[1], w[2]];
        slot = [free, slot[0], slot[1], slot[2]];
        count = (count + 1).min(4);
        if count == 4 && side(w, pair.slack) == OriginSide::Inside {
            best.inside = Some(Simplex { a: slot.map(|s| pairs[s & 3].0), b: slot.map(|s| pairs[s & 3].1) });
            return best;
        }
        let NearestPoint { point: v, weights, count: kept, order } = nearest(w, count);
        w = order.map(|i| w[i & 3]);
        slot = order.map(|i| slot[i & 3]);
        count = kept;
        // Beyond the count weights are zero, and points repeat the first.
        let [p, q, r] = [w[0], if count > 1 { w[1] } else { w[0] }, if count > 2 { w[2] } else { w[0] }];
        let combined = p * weights[0] + q * weights[1] + r * weights[2];
        let reach = p.abs().max(q.abs()).max(r.abs()).norm_max();
        let error = real(COMBINATION_ROUNDINGS) * S::<A>::EPSILON * reach + real(1.75) * pair.slack + S::<A>::UNDERFLOW;
        let upper = norm(combined) * (one + relative) + error;
        let progress = v.dot(v) < best.v.dot(best.v) || !(best.upper < S::<A>::INFINITY);
        if upper < best.upper || (progress && norm(v) < best.upper) {
            best.upper = best.upper.min(upper);
            best.v = v;
            witnesses = [0, 1, 2].map(|i| (weights[i], pairs[slot[i] & 3]));
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
            axis = (w[1] - w[0]).cross(w[2] - w[0]);
        } else if v == origin && count == 2 {
            axis = across(w[1] - w[0]);
        }
    }
    for (weight, (p, q)) in witnesses {
        best.a += p * weight;
        best.b += q * weight;
    }
    best
}

/// Length of a vector not too large to square.
#[inline(always)]
fn norm<V: Vector>(v: V) -> V::Scalar {
    let sq = v.dot(v);
    if sq > V::Scalar::UNDERFLOW { sq.sqrt() } else { v.length() }
}
