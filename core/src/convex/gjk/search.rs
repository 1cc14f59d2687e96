//! The boolean search: does the difference hold the origin?

use super::closest::intersect_rounded;
use super::outcome::{Intersection, OverlapProof, Reason};
use super::pair::{BodyPair, Probe, sized};
use super::working_simplex::{SupportPairs, WorkingSimplex, across};
use crate::convex::opaque::Opaque;
use crate::convex::simplex::{OriginSide, Simplex, side};
use crate::convex::support::{ScalarOf, Support, lengthened};
use crate::number::real::{Real, Vector};

/// How many support points a search may look at. Polytopes of some hundred vertices need twenty at most; what needs more is a symmetry or a
/// smooth body that nearly touches, and goes to another search.
pub const MAX_ITERATIONS: u32 = 32;

/// Do the bodies of a pair share an inner point? The first direction is `hint`, or that between their centres. With `lean` the directions lean
/// away from those that the search would take, for bodies so placed that a symmetry keeps the origin on the rim of every simplex; without, a pair
/// that is undecided goes to [`search_harder`].
#[inline(always)]
pub(super) fn search<A, B, const SCALED: bool>(
    pair: &BodyPair<A, B, ScalarOf<A>, SCALED>,
    hint: Option<A::Vector>,
    lean: bool,
) -> Intersection<A::Vector>
where
    A: Support,
    B: Support<Vector = A::Vector>,
{
    // The bodies are apart if d·w exceeds this times |d|₁.
    let margin = pair.margin();
    let mut axis = pair.seed(hint);
    let mut starts = (0, 0);
    let (mut simplex, mut pairs) = (WorkingSimplex::<A::Vector>::new(), SupportPairs::new());
    let mut reason = Reason::Iterations;
    // The last support plane passes the origin by more than rounding: the bodies overlap, yet no simplex proves it.
    let mut deep = false;
    for iteration in 0..MAX_ITERATIONS {
        let surrounding = lean && iteration < 4;
        if lean {
            axis = leaning_axis(axis, iteration);
        }
        let size = match sized(axis) {
            Ok((direction, size)) => {
                axis = direction;
                size
            }
            // The origin is a vertex of the difference, or the simplex is flat.
            Err(direction) => {
                (axis, reason) = (direction, Reason::Rounding);
                break;
            }
        };
        let tolerance = margin * size;
        let Some(found) = nearer(pair, axis, starts, tolerance) else { return Intersection::Apart { axis } };
        starts = found.starts();
        // A point can only come again where the search makes no progress beyond rounding.
        let stalled = simplex.count > 0 && found.w.dot(axis) + tolerance >= simplex.w[0].dot(axis);
        if stalled && simplex.holds(found.w) {
            if surrounding {
                continue;
            }
            (reason, deep) = (Reason::Rounding, found.w.dot(axis) < -tolerance);
            break;
        }
        simplex.push(&found, &mut pairs);
        if surrounding && iteration < 3 {
            continue;
        }
        match simplex.step(pair.slack) {
            Some(next) => axis = next,
            None => return overlapping(simplex.simplex(&pairs)),
        }
    }
    if !lean && (deep || reason == Reason::Iterations || pair.slack > Real::ZERO) {
        let (a, b) = pair.bodies();
        let [a, b] = [Opaque::new(a), Opaque::new(b)];
        return search_harder(&pair.opaque([&a, &b]), axis, reason);
    }
    Intersection::Undecided { reason, axis }
}

/// The support point of the difference along an axis; none if it lies beyond the origin by more than `tolerance` for certain.
#[inline(always)]
fn nearer<A, B, const SCALED: bool>(
    pair: &BodyPair<A, B, ScalarOf<A>, SCALED>,
    axis: A::Vector,
    starts: (u32, u32),
    tolerance: ScalarOf<A>,
) -> Option<Probe<A::Vector>>
where
    A: Support,
    B: Support<Vector = A::Vector>,
{
    let found = pair.probe(axis, starts);
    if !(found.w.dot(axis) > tolerance) {
        return Some(found);
    }
    let found = pair.probe_surely(axis, found);
    (!(found.w.dot(axis) > tolerance)).then_some(found)
}

#[inline(always)]
fn overlapping<V: Vector>(simplex: Simplex<V>) -> Intersection<V> {
    Intersection::Overlapping { proof: OverlapProof::Inside(simplex) }
}

/// Tries again with leaning directions, for bodies so placed that simplices keep the origin on an edge; then, for curved bodies, with
/// the search for the distance, which takes more steps.
#[cold]
#[inline(never)]
fn search_harder<V: Vector, const SCALED: bool>(
    pair: &BodyPair<Opaque<V>, Opaque<V>, V::Scalar, SCALED>,
    axis: V,
    reason: Reason,
) -> Intersection<V> {
    for axis in [pair.seed(None), axis] {
        if let Some(simplex) = surround(pair, axis) {
            return overlapping(simplex);
        }
    }
    let found = search(pair, None, true);
    if !matches!(found, Intersection::Undecided { .. }) {
        return found;
    }
    let harder = intersect_rounded(pair, Some(axis));
    if matches!(harder, Intersection::Undecided { .. }) { Intersection::Undecided { reason, axis } } else { harder }
}

/// Points along an axis and all around it, if they surround the origin: for shallow overlaps of bodies placed symmetrically about the axis.
fn surround<A, B, const SCALED: bool>(
    pair: &BodyPair<A, B, ScalarOf<A>, SCALED>,
    axis: A::Vector,
) -> Option<Simplex<A::Vector>>
where
    A: Support,
    B: Support<Vector = A::Vector>,
{
    let axis = lengthened(axis);
    let u = lengthened(across(axis));
    let v = lengthened(axis.cross(u));
    let half = u * ScalarOf::<A>::HALF;
    let mut simplex = Simplex { a: [A::Vector::ZERO; 4], b: [A::Vector::ZERO; 4] };
    let mut w = [A::Vector::ZERO; 4];
    for (i, direction) in [axis, u, v - half, -v - half].into_iter().enumerate() {
        let found = pair.probe(direction, (0, 0));
        (simplex.a[i], simplex.b[i]) = (found.a.point, found.b.point);
        w[i] = found.w;
    }
    (side(w, pair.slack) == OriginSide::Inside).then_some(simplex)
}

/// Where a second try looks first: the points of a body along these surround its middle, also those of a box.
const CORNERS: [[f64; 3]; 4] = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];

/// Directions to lean towards when a search has met a symmetry: none of them, nor any sum or difference of two, lies in a plane of one.
const LEANINGS: [[f64; 3]; 5] =
    [[0.71, -0.53, 0.34], [-0.47, 0.29, 0.83], [0.31, 0.92, -0.41], [-0.88, -0.37, -0.23], [0.19, -0.77, 0.61]];

/// The direction of an iteration of the search with leaning directions: first around a body, then near where the search would look.
fn leaning_axis<V: Vector>(axis: V, iteration: u32) -> V {
    let axis = match CORNERS.get(iteration as usize) {
        Some(corner) => V::from_array(corner.map(V::Scalar::from_f64)),
        None => axis,
    };
    leaning(axis, iteration)
}

/// A direction near another: a different one in each iteration, and after the first five ever nearer, so that shallow overlaps are not missed.
fn leaning<V: Vector>(axis: V, iteration: u32) -> V {
    let [x, y, z] = LEANINGS[(iteration % 5) as usize];
    let real = V::Scalar::from_f64;
    let by = axis.norm_max() * real(0.5 / f64::from(1u32 << iteration.clamp(3, 31)));
    axis + V::new(real(x), real(y), real(z)) * by
}
