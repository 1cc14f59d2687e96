//! Whether the origin, known to be a point of the Minkowski difference, is an inner point of it. A plane is turned about the face, edge or
//! vertex of the simplex that holds the origin, until it has all points on one side or every such plane has points on both.

use core::cmp::Ordering;

use super::integer::{Degree4, Int, V1, V2, V3, cross, dot, is_zero, minus, negated, resized};
use super::lattice::{ExactDifference, one};
use super::relation::{ExactAxis, Relation, Surround};
use super::search::LatticePair;
use super::simplex::{Points, nearest_in_cone, turn};
use crate::convex::shape::Vertices;
use crate::convex::support::ScalarOf;
use crate::number::real::Real;

/// Points strictly below and above a plane.
type Sides<R> = (ExactDifference<R>, ExactDifference<R>);

impl<A, B> LatticePair<'_, A, B>
where
    A: Vertices,
    B: Vertices<Vector = A::Vector>,
{
    /// The origin is inside the triangle: are there points on both sides of its plane?
    pub(super) fn about_face(
        &self,
        p: &ExactDifference<ScalarOf<A>>,
        q: &ExactDifference<ScalarOf<A>>,
        r: &ExactDifference<ScalarOf<A>>,
    ) -> Relation<ScalarOf<A>> {
        let normal: V2<ScalarOf<A>> = cross(&minus(&q.w, &p.w), &minus(&r.w, &p.w));
        match self.both_sides(&resized(&normal)) {
            Ok((low, high)) => Relation::Overlapping(Surround::of(&[p, q, r, &low, &high])),
            Err(axis) => Relation::Touching(axis),
        }
    }

    /// A point strictly below and one strictly above the plane through the origin with normal `d`; else the axis, `d` or its opposite, along
    /// which no point lies below the origin.
    fn both_sides(&self, d: &V3<ScalarOf<A>>) -> Result<Sides<ScalarOf<A>>, ExactAxis<ScalarOf<A>>> {
        let low = self.lowest(d);
        if !dot::<_, _, Degree4<ScalarOf<A>>>(d, &low.w).is_negative() {
            return Err(ExactAxis::new(*d));
        }
        let opposite = negated(d);
        let high = self.lowest(&opposite);
        if !dot::<_, _, Degree4<ScalarOf<A>>>(&opposite, &high.w).is_negative() {
            return Err(ExactAxis::new(opposite));
        }
        Ok((low, high))
    }

    /// The origin is between two points: seen along that edge, does every half plane through the origin hold points?
    pub(super) fn about_edge(
        &self,
        p: &ExactDifference<ScalarOf<A>>,
        q: &ExactDifference<ScalarOf<A>>,
    ) -> Relation<ScalarOf<A>> {
        let e = minus(&q.w, &p.w);
        let (mut first, mut last) = match self.both_sides(&across::<ScalarOf<A>>(&e)) {
            Ok(found) => found,
            Err(axis) => return Relation::Touching(axis),
        };
        // Turns `last` away from `first` until the sector between them exceeds a half plane, is one, or cannot grow.
        if turn::<ScalarOf<A>>(&e, &first.w, &last.w) == Ordering::Less {
            (first, last) = (last, first);
        }
        loop {
            let outward: V2<ScalarOf<A>> = cross(&e, &last.w);
            if turn::<ScalarOf<A>>(&e, &first.w, &last.w) == Ordering::Equal {
                return match self.both_sides(&resized(&outward)) {
                    Ok((low, high)) => Relation::Overlapping(Surround::of(&[p, q, &first, &last, &low, &high])),
                    Err(axis) => Relation::Touching(axis),
                };
            }
            let inward = negated(&resized(&outward));
            let new = self.lowest(&inward);
            if !dot::<_, _, Degree4<ScalarOf<A>>>(&inward, &new.w).is_negative() {
                return Relation::Touching(ExactAxis::new(inward));
            }
            if turn::<ScalarOf<A>>(&e, &first.w, &new.w) == Ordering::Less {
                return Relation::Overlapping(Surround::of(&[p, q, &first, &last, &new]));
            }
            last = new;
        }
    }

    /// The origin is a vertex of the simplex. Takes some other point of the difference and searches the cone of all points for the opposite
    /// direction: if the cone holds it, the origin lies between points of the difference, else a plane through the origin has all on one side.
    pub(super) fn about_vertex(&self) -> Relation<ScalarOf<A>> {
        let axis = [one(), Int::ZERO, Int::ZERO];
        let anchor = match self.both_sides(&axis) {
            Ok((low, _)) => low,
            Err(axis) => return Relation::Touching(axis),
        };
        let target = negated(&anchor.w);
        let mut cone = Points::new();
        loop {
            let (kept, residual) = nearest_in_cone(&target, &cone);
            cone = kept;
            if is_zero(&residual) {
                return match cone.as_slice() {
                    [p] => self.about_edge(&anchor, p),
                    [p, q] => self.about_face(&anchor, p, q),
                    [p, q, r] => Relation::Overlapping(Surround::of(&[&anchor, p, q, r])),
                    _ => Relation::Touching(ExactAxis::new(axis)),
                };
            }
            let down = negated(&residual);
            let new = self.lowest(&down);
            if !dot::<_, _, Degree4<ScalarOf<A>>>(&down, &new.w).is_negative() {
                return Relation::Touching(ExactAxis::new(down));
            }
            // The part that is kept has three edges at most, so the push does not fail.
            if cone.push(new).is_err() {
                return Relation::Touching(ExactAxis::new(down));
            }
        }
    }
}

/// Some vector perpendicular to `e`, not zero.
fn across<R: Real>(e: &V1<R>) -> V3<R> {
    let [x, y, _] = resized(e);
    let zero = Int::ZERO;
    if x.is_zero() { [one(), zero, zero] } else { [y.negated(), x, zero] }
}
