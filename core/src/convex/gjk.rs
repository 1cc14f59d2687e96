//! Do two convex bodies meet, and how far apart are they? An answer comes with a proof, or is [`Undecided`](Intersection::Undecided).
//!
//! Gilbert, Johnson and Keerthi's search in the Minkowski difference `b - a` of all differences of points. If a direction has all of it
//! on one side, the bodies are apart; if four of its points hold the origin, they overlap. Interiors decide: bodies that only touch do not
//! overlap. Every comparison is relative to the size of what is compared; no tolerance has a unit.
//!
//! Reference: E. G. Gilbert, D. W. Johnson, S. S. Keerthi, "A fast procedure for computing the distance between complex objects in
//! three-dimensional space", *IEEE J. Robotics and Automation* 4 (1988).

use crate::convex::simplex::{OriginSide, Simplex, side};
use crate::convex::support::{ScalarOf, Support, lengthened};
use crate::number::real::{Real, Vector};

mod distance;
mod pair;
pub use distance::{Distance, distance};
use pair::{BodyPair, Scale, scale};

/// What [`intersect`] found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Intersection<V: Vector> {
    /// The bodies share no interior point: proved by [`separates`].
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

/// How many support points a search may look at. Polytopes of some hundred vertices need twenty at most; after that it is a symmetry, or a
/// smooth body near touch, and another search takes over.
pub const MAX_ITERATIONS: u32 = 32;

/// Rounding of `d·(b - a)` against the true least value over both bodies, in units of ε |d|₁ (extents): two scalar products of the scan on
/// each side (3), the difference and its product (2); rounded up for second-order terms and the bound's own rounding.
const SUPPORT_ROUNDINGS: f64 = 8.0;

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
    if A::ROUNDED || B::ROUNDED { distance::intersect_rounded(pair, hint) } else { search(pair, hint, false) }
}

/// Some vector across another: its product with the coordinate axis least along it.
#[inline(always)]
pub(crate) fn across<V: Vector>(e: V) -> V {
    let [x, y, z] = e.abs().to_array();
    let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
    e.cross(if x <= y && x <= z {
        V::new(one, zero, zero)
    } else if y <= z {
        V::new(zero, one, zero)
    } else {
        V::new(zero, zero, one)
    })
}

/// Where a second try looks first: the points of a body along these surround its middle, also those of a box.
const CORNERS: [[f64; 3]; 4] = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];

/// Directions to lean towards when a search has met a symmetry: none of them, nor any sum or difference of two, lies in a plane of one.
const LEANINGS: [[f64; 3]; 5] =
    [[0.71, -0.53, 0.34], [-0.47, 0.29, 0.83], [0.31, 0.92, -0.41], [-0.88, -0.37, -0.23], [0.19, -0.77, 0.61]];

/// A direction near another; a different one each round, and after the first five ever nearer, so that shallow overlaps are not passed over.
fn leaning<V: Vector>(axis: V, round: u32) -> V {
    let [x, y, z] = LEANINGS[(round % 5) as usize];
    let real = V::Scalar::from_f64;
    let by = axis.norm_max() * real(0.5 / f64::from(1u32 << round.clamp(3, 31)));
    axis + V::new(real(x), real(y), real(z)) * by
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
        let (a, b) = pair.supports(direction, (0, 0));
        (simplex.a[i], simplex.b[i]) = (a.point, b.point);
        w[i] = pair.difference(a.point, b.point);
    }
    (side(w, pair.slack) == OriginSide::Inside).then_some(simplex)
}

/// Tries again with leaning directions, for bodies so placed that simplices keep the origin on an edge; then, for curved bodies, with
/// the distance, which has more patience.
#[cold]
#[inline(never)]
fn search_harder<A, B, const SCALED: bool>(
    pair: &BodyPair<A, B, ScalarOf<A>, SCALED>,
    axis: A::Vector,
    reason: Reason,
) -> Intersection<A::Vector>
where
    A: Support,
    B: Support<Vector = A::Vector>,
{
    for axis in [pair.seed(None), axis] {
        if let Some(simplex) = surround(pair, axis) {
            return Intersection::Overlapping { proof: OverlapProof::Inside(simplex) };
        }
    }
    let found = search(pair, None, true);
    if !matches!(found, Intersection::Undecided { .. }) {
        return found;
    }
    let harder = distance::intersect_rounded(pair, Some(axis));
    if matches!(harder, Intersection::Undecided { .. }) { Intersection::Undecided { reason, axis } } else { harder }
}

/// The boolean search; `lean` is for the second try.
#[inline(always)]
fn search<A, B, const SCALED: bool>(
    pair: &BodyPair<A, B, ScalarOf<A>, SCALED>,
    hint: Option<A::Vector>,
    lean: bool,
) -> Intersection<A::Vector>
where
    A: Support,
    B: Support<Vector = A::Vector>,
{
    type S<A> = ScalarOf<A>;
    let zero = S::<A>::ZERO;
    // Apart if d·w exceeds this times |d|₁.
    let margin = pair.margin();
    let mut axis = pair.seed(hint);
    let mut starts = (0, 0);

    // Differences, newest first, and where their points are kept.
    let origin = A::Vector::ZERO;
    let mut w = [origin; 4];
    let mut slot = [0usize, 1, 2, 3];
    let mut pairs = [(origin, origin); 4];
    let mut count = 0usize;
    let mut reason = Reason::Iterations;

    // Deep inside, yet without a simplex that proves it.
    let mut deep = false;
    for round in 0..MAX_ITERATIONS {
        let surrounding = lean && round < 4;
        if lean {
            if surrounding {
                axis = Vector::from_array(CORNERS[(round & 3) as usize].map(S::<A>::from_f64));
            }
            axis = leaning(axis, round);
        }
        let mut size = axis.norm_1();
        if !(size > S::<A>::SCALE_MIN) {
            axis = lengthened(axis);
            size = axis.norm_1();
            if !(size >= S::<A>::ONE) || !size.is_finite() {
                // The origin is a vertex of the difference, or the simplex is flat.
                reason = Reason::Rounding;
                break;
            }
        }
        let (mut from_a, mut from_b) = pair.supports(axis, starts);
        let mut new = pair.difference(from_a.point, from_b.point);
        if new.dot(axis) > margin * size {
            (from_a, from_b) = pair.farther(axis, from_a, from_b);
            new = pair.difference(from_a.point, from_b.point);
            if new.dot(axis) > margin * size {
                return Intersection::Apart { axis };
            }
        }
        starts = (from_a.index, from_b.index);

        // A point again can only come where there is no progress to speak of.
        let stalled = count > 0 && new.dot(axis) + margin * size >= w[0].dot(axis);
        if stalled && (w[0] == new || count > 1 && w[1] == new || count > 2 && w[2] == new) {
            if surrounding {
                continue;
            }
            reason = Reason::Rounding;
            deep = new.dot(axis) < -(margin * size);
            break;
        }
        // The newest goes first; its points into the free slot.
        let free = slot[count & 3];
        pairs[free & 3] = (from_a.point, from_b.point);
        w = [new, w[0], w[1], w[2]];
        slot = match count {
            0 => [free, slot[1], slot[2], slot[3]],
            1 => [free, slot[0], slot[2], slot[3]],
            2 => [free, slot[0], slot[1], slot[3]],
            _ => [free, slot[0], slot[1], slot[2]],
        };
        count += 1;

        if surrounding && round < 3 {
            continue;
        }
        let mut outward = None;
        if count == 4 {
            match side(w, pair.slack) {
                OriginSide::Inside => {
                    let simplex = Simplex { a: slot.map(|s| pairs[s & 3].0), b: slot.map(|s| pairs[s & 3].1) };
                    return Intersection::Overlapping { proof: OverlapProof::Inside(simplex) };
                }
                OriginSide::Beyond(dropped) => {
                    let behind = match dropped {
                        1 => {
                            slot = [slot[0], slot[2], slot[3], slot[1]];
                            w = [w[0], w[2], w[3], w[1]];
                            w[3]
                        }
                        2 => {
                            slot = [slot[0], slot[1], slot[3], slot[2]];
                            w = [w[0], w[1], w[3], w[2]];
                            w[3]
                        }
                        _ => w[3],
                    };
                    outward = Some(behind);
                    count = 3;
                }
            }
        }
        match count {
            1 => axis = new,
            2 => axis = beside(w[0], w[1]),
            _ => {
                let (ab, ac) = (w[1] - w[0], w[2] - w[0]);
                let normal = ab.cross(ac);
                if ab.cross(normal).dot(w[0]) < zero {
                    count = 2;
                    axis = beside(w[0], w[1]);
                } else if normal.cross(ac).dot(w[0]) < zero {
                    count = 2;
                    w = [w[0], w[2], w[1], w[3]];
                    slot = [slot[0], slot[2], slot[1], slot[3]];
                    axis = beside(w[0], w[1]);
                } else {
                    let ahead = match outward {
                        Some(behind) => normal.dot(behind - w[0]),
                        None => normal.dot(w[0]),
                    };
                    axis = if ahead < zero { -normal } else { normal };
                }
            }
        }
    }
    if !lean && (deep || reason == Reason::Iterations || pair.slack > zero) {
        return search_harder(pair, axis, reason);
    }
    Intersection::Undecided { reason, axis }
}

/// From the origin towards the line through two points, at right angles to it.
#[inline(always)]
fn beside<V: Vector>(a: V, b: V) -> V {
    let e = b - a;
    let towards = e.cross(a.cross(e));
    if towards == V::ZERO { across(e) } else { towards }
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

/// Proves that a point of one core and a point of another, each off by at most `slack` in each component, are closer than the radii.
pub fn within_radii<V: Vector>(a: V, b: V, radii: V::Scalar, slack: V::Scalar) -> bool {
    let relative = V::Scalar::from_f64(8.0) * V::Scalar::EPSILON;
    let w = b - a;
    // The root of three, rounded up, turns a bound by component into one of length.
    let apart = w.length() * (V::Scalar::ONE + relative) + V::Scalar::from_f64(1.75) * (slack + slack);
    apart < radii * (V::Scalar::ONE - relative)
}
