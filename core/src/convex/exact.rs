//! The exact second stage for bodies given by vertices: disjoint, touching or overlapping, with nothing left open.
//!
//! The same search as in [`crate::convex::gjk`], in exact integers: every sign is right, each round comes strictly nearer to the
//! origin, so it ends. Where the nearest point is the origin itself, on a face, an edge or a vertex of the simplex, the question is whether
//! the difference has points on both sides of every plane through that face, edge or vertex; this is answered by turning a plane about it.
//!
//! `integer` holds the numbers, `lattice` brings coordinates to them, `simplex` has the signs, `search` finds the nearest point, `touch`
//! looks around the origin, `distance` rounds what was found.
//!
//! Signs are of degree 4 at most in the coordinates. Integers are used and not floating-point expansions because a product of expansions is
//! no longer exact once a term underflows. Needs some 30 kB of stack.

use core::cmp::Ordering;

use crate::convex::gjk::{Intersection, intersect};
use crate::convex::shape::Vertices;

mod distance;
mod integer;
mod lattice;
mod search;
mod simplex;
mod touch;

pub use distance::{ExactDistance, distance};
use integer::{DEGREE_1, DEGREE_2, DEGREE_3, DEGREE_4, Int, Vec3, cross, dot, is_zero};
use lattice::{CoordinateLattice, ExactDifference, direction};
use search::LatticePair;

type V1 = Vec3<DEGREE_1>;
type V2 = Vec3<DEGREE_2>;
type V3 = Vec3<DEGREE_3>;

/// How two closed bodies lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contact {
    /// No point is shared.
    Disjoint,
    /// Points are shared, but no interior point of the difference is the origin: a push however small parts them.
    Touching,
    /// Interiors meet.
    Overlapping,
}

/// How two bodies lie, with the proof.
#[derive(Clone, Debug)]
pub enum Relation {
    /// No point is shared: the axis separates strictly.
    Disjoint(ExactAxis),
    /// Some point is shared: the axis separates all the rest.
    Touching(ExactAxis),
    /// Interiors meet: these points surround the origin.
    Overlapping(Surround),
}

impl Relation {
    /// Without the proof.
    pub fn contact(&self) -> Contact {
        match self {
            Relation::Disjoint(_) => Contact::Disjoint,
            Relation::Touching(_) => Contact::Touching,
            Relation::Overlapping(_) => Contact::Overlapping,
        }
    }
}

/// A vertex is NaN or infinite, or there is none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotFinite;

/// A direction from the first body to the second, exact.
#[derive(Clone, Copy, Debug)]
pub struct ExactAxis(V3);

impl ExactAxis {
    /// The nearest direction in floating point, its largest component between 1 and 2.
    pub fn to_array(&self) -> [f64; 3] {
        direction(&self.0)
    }

    /// How the least of all differences `b - a` along the axis compares to zero. `Greater` proves the bodies disjoint, `Equal` that they do
    /// not overlap. Looks at every vertex, exactly.
    pub fn gap<A, B>(&self, a: &A, b: &B) -> Result<Ordering, NotFinite>
    where
        A: Vertices,
        B: Vertices<Vector = A::Vector>,
    {
        if is_zero(&self.0) {
            return Ok(Ordering::Less);
        }
        let lattice = CoordinateLattice::new(a, b)?;
        let mut least: Option<(Int<DEGREE_4>, Int<DEGREE_4>)> = None;
        let along = |p: A::Vector| dot::<DEGREE_3, DEGREE_1, DEGREE_4>(&self.0, &lattice.point(p));
        for i in 0..a.count() {
            let p = along(a.vertex(i));
            least = Some(match least {
                Some((high, low)) if !p.minus(&high).is_positive() => (high, low),
                Some((_, low)) => (p, low),
                None => (p, along(b.vertex(0))),
            });
        }
        for j in 0..b.count() {
            let p = along(b.vertex(j));
            if let Some((high, low)) = least {
                least = Some((high, if p.minus(&low).is_negative() { p } else { low }));
            }
        }
        Ok(least.map_or(Ordering::Less, |(high, low)| low.minus(&high).sign()))
    }
}

/// Pairs of vertices whose differences surround the origin: no plane through it has them all on one closed side.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Surround {
    pairs: heapless::Vec<(u32, u32), SURROUNDING>,
}

/// Most points that are needed to surround the origin: two along each axis of some base of space (Steinitz).
const SURROUNDING: usize = 6;

impl Surround {
    fn of(points: &[&ExactDifference]) -> Self {
        let mut pairs = heapless::Vec::new();
        for p in points {
            let pushed = pairs.push(p.pair).is_ok();
            debug_assert!(pushed, "each search ends with at most six points");
        }
        Surround { pairs }
    }

    /// Indices of a vertex of the first body and one of the second, for each difference.
    pub fn pairs(&self) -> &[(u32, u32)] {
        &self.pairs
    }

    /// Whether the differences do surround the origin: they span space, and no plane through the origin and two of them has all others on
    /// one side.
    pub fn holds<A, B>(&self, a: &A, b: &B) -> Result<bool, NotFinite>
    where
        A: Vertices,
        B: Vertices<Vector = A::Vector>,
    {
        let lattice = CoordinateLattice::new(a, b)?;
        let mut w = heapless::Vec::<V1, SURROUNDING>::new();
        for &pair in &self.pairs {
            // As many as there are pairs.
            let _ = w.push(lattice.difference(a, b, pair).w);
        }
        let mut spans = false;
        for (i, p) in w.iter().enumerate() {
            for q in w.iter().skip(i + 1) {
                let normal: V2 = cross(p, q);
                if is_zero(&normal) {
                    continue;
                }
                let (mut below, mut above) = (false, false);
                for r in &w {
                    let side: Int<DEGREE_3> = dot(&normal, r);
                    below |= side.is_negative();
                    above |= side.is_positive();
                }
                if !(below && above) {
                    return Ok(false);
                }
                spans = true;
            }
        }
        Ok(spans)
    }
}

/// Disjoint, touching or overlapping: by [`intersect`] where that can tell, else exactly.
///
/// ```
/// use glam::DVec3;
/// use voidage_core::{number::aabb::Aabb, convex::exact::{Contact, contact}, convex::shape::Triangle};
///
/// let cell = Aabb { min: DVec3::ZERO, max: DVec3::ONE };
/// let (a, b, c) = (DVec3::new(1.0, 0.2, 0.2), DVec3::new(1.0, 0.8, 0.2), DVec3::new(1.5, 0.2, 0.9));
/// assert_eq!(contact(&cell, &Triangle { a, b, c }, None), Ok(Contact::Touching));
/// ```
pub fn contact<A, B>(a: &A, b: &B, hint: Option<A::Vector>) -> Result<Contact, NotFinite>
where
    A: Vertices,
    B: Vertices<Vector = A::Vector>,
{
    match intersect(a, b, hint) {
        Intersection::Apart { .. } => Ok(Contact::Disjoint),
        Intersection::Overlapping { .. } => Ok(Contact::Overlapping),
        Intersection::Undecided { axis, .. } => relation(a, b, Some(axis)).map(|found| found.contact()),
    }
}

/// How two bodies lie, exactly. `hint` is a direction from `a` to `b` to start with.
pub fn relation<A, B>(a: &A, b: &B, hint: Option<A::Vector>) -> Result<Relation, NotFinite>
where
    A: Vertices,
    B: Vertices<Vector = A::Vector>,
{
    let pair = LatticePair { a, b, lattice: CoordinateLattice::new(a, b)? };
    let search = pair.search(hint, true);
    if !is_zero(&search.direction) {
        return Ok(Relation::Disjoint(ExactAxis(search.direction)));
    }
    let points = search.simplex.as_slice();
    Ok(match search.weak {
        Some(axis) => Relation::Touching(ExactAxis(axis)),
        None => match points {
            [a, b, c, d] => Relation::Overlapping(Surround::of(&[a, b, c, d])),
            [a, b, c] => pair.about_face(a, b, c),
            [a, b] => pair.about_edge(a, b),
            _ => pair.about_vertex(),
        },
    })
}
