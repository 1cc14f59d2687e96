//! How two bodies lie, with the proof.

use core::cmp::Ordering;

use heapless::Vec;

use super::integer::{Int3, Int4, V1, V2, V3, cross, dot, is_zero};
use super::lattice::{CoordinateLattice, ExactDifference, NotFinite, direction};
use crate::convex::shape::Vertices;
use crate::convex::support::ScalarOf;
use crate::number::real::Real;

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
pub enum Relation<R: Real> {
    /// No point is shared: the axis separates strictly.
    Disjoint(ExactAxis<R>),
    /// Some point is shared: the axis separates all the rest.
    Touching(ExactAxis<R>),
    /// Interiors meet: these points surround the origin.
    Overlapping(Surround),
}

impl<R: Real> Relation<R> {
    /// Without the proof.
    pub fn contact(&self) -> Contact {
        match self {
            Relation::Disjoint(_) => Contact::Disjoint,
            Relation::Touching(_) => Contact::Touching,
            Relation::Overlapping(_) => Contact::Overlapping,
        }
    }
}

/// A direction from the first body to the second, exact.
#[derive(Clone, Copy, Debug)]
pub struct ExactAxis<R: Real>(V3<R>);

impl<R: Real> ExactAxis<R> {
    pub(super) fn new(direction: V3<R>) -> Self {
        ExactAxis(direction)
    }

    /// The nearest direction in floating point, its largest component between 1 and 2.
    pub fn to_array(&self) -> [f64; 3] {
        direction(&self.0)
    }

    /// How the least of all differences `b - a` along the axis compares to zero. `Greater` proves the bodies disjoint, `Equal` that they do
    /// not overlap. Looks at every vertex, exactly.
    pub fn gap<A, B>(&self, a: &A, b: &B) -> Result<Ordering, NotFinite>
    where
        A: Vertices<Vector = R::Vector>,
        B: Vertices<Vector = R::Vector>,
    {
        if is_zero(&self.0) {
            return Ok(Ordering::Less);
        }
        let lattice = CoordinateLattice::new(a, b)?;
        let mut least: Option<(Int4<R>, Int4<R>)> = None;
        let along = |p: R::Vector| -> Int4<R> { dot(&self.0, &lattice.point(p)) };
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
    pairs: Vec<(u32, u32), SURROUNDING>,
}

/// Most points that are needed to surround the origin: two along each axis of some base of space (Steinitz).
const SURROUNDING: usize = 6;

impl Surround {
    pub(super) fn of(points: &[&ExactDifference<impl Real>]) -> Self {
        let mut pairs = Vec::new();
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
        let mut w = Vec::<V1<ScalarOf<A>>, SURROUNDING>::new();
        for &pair in &self.pairs {
            // As many as there are pairs.
            let _ = w.push(lattice.difference(a, b, pair).w);
        }
        let mut spans = false;
        for (i, p) in w.iter().enumerate() {
            for q in w.iter().skip(i + 1) {
                let normal: V2<ScalarOf<A>> = cross(p, q);
                if is_zero(&normal) {
                    continue;
                }
                let (mut below, mut above) = (false, false);
                for r in &w {
                    let side: Int3<ScalarOf<A>> = dot(&normal, r);
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
