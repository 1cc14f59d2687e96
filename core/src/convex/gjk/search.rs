//! The boolean search: does the difference hold the origin?

use super::closest::intersect_rounded;
use super::outcome::{Intersection, OverlapProof, Reason};
use super::pair::{BodyPair, Probe, sized};
use super::working_simplex::{SupportPairs, WorkingSimplex, across};
use crate::convex::opaque::Opaque;
use crate::convex::simplex::{OriginSide, Simplex, side};
use crate::convex::support::{ScalarOf, Support, lengthened};
use crate::number::real::{Real, Vector};

/// How many support points a search may look at. Polytopes of some hundred vertices need twenty at most; after that it is a symmetry, or a
/// smooth body near touch, and another search takes over.
pub const MAX_ITERATIONS: u32 = 32;

/// Do the bodies of a pair share an inner point? From `hint`, or along their centres. With `lean` it looks in leaning directions, for bodies so
/// placed that a symmetry keeps the origin on the rim of every simplex; without, what it cannot tell is searched harder.
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
    for round in 0..MAX_ITERATIONS {
        let surrounding = lean && round < 4;
        if lean {
            axis = leaning_axis(axis, round);
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
        let room = margin * size;
        let Some(found) = nearer(pair, axis, starts, room) else { return Intersection::Apart { axis } };
        starts = found.starts();
        // A point again can only come where there is no progress to speak of.
        let stalled = simplex.count > 0 && found.w.dot(axis) + room >= simplex.w[0].dot(axis);
        if stalled && simplex.holds(found.w) {
            if surrounding {
                continue;
            }
            (reason, deep) = (Reason::Rounding, found.w.dot(axis) < -room);
            break;
        }
        simplex.push(&found, &mut pairs);
        if surrounding && round < 3 {
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

/// The support point of the difference along an axis; none if it lies beyond the origin by more than `room` for certain.
#[inline(always)]
fn nearer<A, B, const SCALED: bool>(
    pair: &BodyPair<A, B, ScalarOf<A>, SCALED>,
    axis: A::Vector,
    starts: (u32, u32),
    room: ScalarOf<A>,
) -> Option<Probe<A::Vector>>
where
    A: Support,
    B: Support<Vector = A::Vector>,
{
    let found = pair.probe(axis, starts);
    if !(found.w.dot(axis) > room) {
        return Some(found);
    }
    let found = pair.probe_surely(axis, found);
    (!(found.w.dot(axis) > room)).then_some(found)
}

#[inline(always)]
fn overlapping<V: Vector>(simplex: Simplex<V>) -> Intersection<V> {
    Intersection::Overlapping { proof: OverlapProof::Inside(simplex) }
}

/// Tries again with leaning directions, for bodies so placed that simplices keep the origin on an edge; then, for curved bodies, with
/// the distance, which has more patience.
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

/// The direction of a round of the search with leaning directions: first around a body, then near where the search would look.
fn leaning_axis<V: Vector>(axis: V, round: u32) -> V {
    let axis = match CORNERS.get(round as usize) {
        Some(corner) => V::from_array(corner.map(V::Scalar::from_f64)),
        None => axis,
    };
    leaning(axis, round)
}

/// A direction near another; a different one each round, and after the first five ever nearer, so that shallow overlaps are not passed over.
fn leaning<V: Vector>(axis: V, round: u32) -> V {
    let [x, y, z] = LEANINGS[(round % 5) as usize];
    let real = V::Scalar::from_f64;
    let by = axis.norm_max() * real(0.5 / f64::from(1u32 << round.clamp(3, 31)));
    axis + V::new(real(x), real(y), real(z)) * by
}
