//! The point of the difference nearest to the origin: the distance of two bodies, and the boolean of rounded ones.
//!
//! Each iteration yields two bounds of the distance. The support plane across `v`, the nearest point so far, is a lower bound; the length of `v`
//! itself an upper one; rounding widens both. Their difference is the duality gap: how far the stated distance can be from the truth.

use super::outcome::{Intersection, OverlapProof, Reason, within_radii};
use super::pair::{BodyPair, Probe, sized};
use super::working_simplex::{SupportPairs, WorkingSimplex, across};
use crate::convex::simplex::{NearestPoint, Simplex};
use crate::convex::support::{ScalarOf, Support};
use crate::number::real::{Real, Vector};

/// How many support points a distance query may look at. Polytopes need some twenty; for smooth bodies each one makes the gap smaller by a factor.
pub const MAX_DISTANCE_ITERATIONS: u32 = 160;

/// Rounding of a convex combination of four differences, in units of ε times their largest component: the differences, the weights, their
/// products and sums, and the root of three for the length.
const COMBINATION_ROUNDINGS: f64 = 16.0;

/// Gap at which a search stops, in units of ε times the distance: a few roundings, below which no step makes progress.
const GAP_ROUNDINGS: f64 = 16.0;

/// How many steps of a search, in a row or not, may fail to improve a bound. With fewer, distances to needles are off by their thickness; more
/// take longer where bodies nearly touch.
const PATIENCE: u32 = 8;

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
    let ((a, b), (p, q)) = (pair.bodies(), found.points());
    let error = ScalarOf::<A>::from_f64(4.0) * ScalarOf::<A>::EPSILON * (a.extent() + b.extent());
    if within_radii(p, q, a.radius() + b.radius(), a.slack().max(b.slack()) + error) {
        return Intersection::Overlapping { proof: OverlapProof::Within { a: p, b: q } };
    }
    Intersection::Undecided { reason: found.reason, axis: found.axis }
}

/// What the nearest point is searched for.
#[derive(Clone, Copy)]
pub(super) enum Goal<R> {
    /// The distance, as close as rounding lets it.
    Distance,
    /// Whether the distance is above or below this length.
    Compare(R),
}

/// Rounding of a bound, in units of ε times the bound.
const BOUND_ROUNDINGS: f64 = 8.0;

/// What is known of the point of the difference nearest to the origin. Lengths are those of the cores, scaled; points are not scaled.
pub(super) struct Closest<V: Vector> {
    /// The cores overlap, if proved.
    pub inside: Option<Simplex<V>>,
    /// The distance of the cores is not less than this.
    pub lower: V::Scalar,
    /// The distance of the cores is not more than this.
    pub upper: V::Scalar,
    /// The nearest point so far.
    pub v: V,
    /// The direction that gave the lower bound.
    pub axis: V,
    /// Why the search ended, if not with a proof.
    pub reason: Reason,
    /// The pairs of points that `v` comes from, with its barycentric weights.
    witnesses: [(V::Scalar, (V, V)); 3],
}

impl<V: Vector> Closest<V> {
    fn nothing_known(seed: V) -> Self {
        Closest {
            inside: None,
            lower: V::Scalar::ZERO,
            upper: V::Scalar::INFINITY,
            v: seed,
            axis: seed,
            reason: Reason::Iterations,
            witnesses: [(V::Scalar::ZERO, (V::ZERO, V::ZERO)); 3],
        }
    }

    /// The points of both cores that are nearest to each other, as far as found.
    pub fn points(&self) -> (V, V) {
        let (mut a, mut b) = (V::ZERO, V::ZERO);
        for (weight, (p, q)) in self.witnesses {
            a += p * weight;
            b += q * weight;
        }
        (a, b)
    }

    /// The support points across `direction`, of 1-norm `size`, and the lower bound that they give.
    #[inline(always)]
    fn probe<A, B, const SCALED: bool>(
        &mut self,
        pair: &BodyPair<A, B, V::Scalar, SCALED>,
        direction: V,
        size: V::Scalar,
        starts: (u32, u32),
    ) -> Probe<V>
    where
        A: Support<Vector = V>,
        B: Support<Vector = V>,
    {
        let relative = V::Scalar::from_f64(BOUND_ROUNDINGS) * V::Scalar::EPSILON;
        let margin = pair.margin();
        let mut found = pair.probe(direction, starts);
        let inv_length = V::Scalar::ONE / direction.dot(direction).sqrt();
        let bound = |w: V| {
            let along = w.dot(direction) - margin * size;
            (along - along.abs() * relative) * inv_length
        };
        if bound(found.w) > self.lower {
            found = pair.probe_surely(direction, found);
            let lower = bound(found.w);
            if lower > self.lower {
                (self.lower, self.axis) = (lower, direction);
            }
        }
        found
    }

    /// Whether the bounds answer the question.
    #[inline(always)]
    fn meets(&self, goal: Goal<V::Scalar>) -> bool {
        let relative = V::Scalar::from_f64(BOUND_ROUNDINGS) * V::Scalar::EPSILON;
        let one = V::Scalar::ONE;
        match goal {
            Goal::Distance => false,
            Goal::Compare(limit) => self.lower > limit * (one + relative) || self.upper < limit * (one - relative),
        }
    }

    /// The bounds are as close as rounding lets them be.
    #[inline(always)]
    fn is_tight(&self) -> bool {
        self.upper - self.lower <= V::Scalar::from_f64(GAP_ROUNDINGS) * V::Scalar::EPSILON * self.upper
    }

    /// Takes the nearest point of a simplex, if it is nearer. False if it is not a step forward.
    #[inline(always)]
    fn take(
        &mut self,
        simplex: &WorkingSimplex<V>,
        pairs: &SupportPairs<V>,
        nearest: &NearestPoint<V>,
        slack: V::Scalar,
    ) -> bool {
        let real = V::Scalar::from_f64;
        let relative = real(BOUND_ROUNDINGS) * V::Scalar::EPSILON;
        let NearestPoint { point: v, weights, .. } = *nearest;
        let (w, count) = (&simplex.w, simplex.count);
        // Beyond the count weights are zero, and points repeat the first.
        let [p, q, r] = [w[0], if count > 1 { w[1] } else { w[0] }, if count > 2 { w[2] } else { w[0] }];
        let combined = p * weights[0] + q * weights[1] + r * weights[2];
        let reach = p.abs().max(q.abs()).max(r.abs()).norm_max();
        // The root of three, rounded up, turns a bound by component into one of length.
        let error =
            real(COMBINATION_ROUNDINGS) * V::Scalar::EPSILON * reach + real(1.75) * slack + V::Scalar::UNDERFLOW;
        let upper = norm(combined) * (V::Scalar::ONE + relative) + error;
        let progress = v.dot(v) < self.v.dot(self.v) || !(self.upper < V::Scalar::INFINITY);
        if upper < self.upper || (progress && norm(v) < self.upper) {
            self.upper = self.upper.min(upper);
            self.v = v;
            self.witnesses = [0, 1, 2].map(|i| (weights[i], simplex.pair(i, pairs)));
        }
        progress
    }
}

/// Searches for the point of the cores' difference nearest to the origin, until `goal` is met or rounding ends it.
pub(super) fn closest_point<A, B, const SCALED: bool>(
    pair: &BodyPair<A, B, ScalarOf<A>, SCALED>,
    hint: Option<A::Vector>,
    goal: Goal<ScalarOf<A>>,
) -> Closest<A::Vector>
where
    A: Support,
    B: Support<Vector = A::Vector>,
{
    let mut axis = pair.seed(hint);
    let mut starts = (0, 0);
    let (mut simplex, mut pairs) = (WorkingSimplex::new(), SupportPairs::new());
    let mut best = Closest::nothing_known(axis);
    let mut stalled = 0;
    for _ in 0..MAX_DISTANCE_ITERATIONS {
        let Ok((direction, size)) = sized(axis) else {
            best.reason = Reason::Rounding;
            break;
        };
        let found = best.probe(pair, direction, size, starts);
        starts = found.starts();
        if best.meets(goal) {
            break;
        }
        if simplex.holds(found.w) || (simplex.count > 0 && best.is_tight()) {
            best.reason = Reason::Rounding;
            break;
        }
        simplex.push(&found, &mut pairs);
        if simplex.holds_origin(pair.slack) {
            best.inside = Some(simplex.simplex(&pairs));
            break;
        }
        let nearest = simplex.shrink_to_nearest();
        // Along a needle the first steps gain less than one rounding, and yet lead to the nearest point.
        if !best.take(&simplex, &pairs, &nearest, pair.slack) {
            stalled += 1;
            if stalled > PATIENCE {
                best.reason = Reason::Rounding;
                break;
            }
        }
        axis = onward(&simplex, nearest.point);
    }
    best
}

/// Where to look next: along the nearest point, or if that is the origin, across the face or edge that holds it.
#[inline(always)]
fn onward<V: Vector>(simplex: &WorkingSimplex<V>, v: V) -> V {
    let [a, b, c, _] = simplex.w;
    match simplex.count {
        _ if v != V::ZERO => v,
        3 => (b - a).cross(c - a),
        2 => across(b - a),
        _ => v,
    }
}

/// Length of a vector not too large to square.
#[inline(always)]
fn norm<V: Vector>(v: V) -> V::Scalar {
    let sq = v.dot(v);
    if sq > V::Scalar::UNDERFLOW { sq.sqrt() } else { v.length() }
}
