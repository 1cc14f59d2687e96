//! The search for the point of the difference nearest to the origin, every sign exact.

use core::cmp::Ordering;

use super::integer::{Degree4, Int, Int4, V3, dot, is_zero, minus, negated};
use super::lattice::{CoordinateLattice, ExactDifference, direction, exponent, parts, times_power};
use super::simplex::{Points, nearest};
use crate::convex::shape::Vertices;
use crate::convex::support::ScalarOf;
use crate::number::real::{Real, Vector};

/// Where an exact search ended.
pub(super) struct Search<R: Real> {
    /// The smallest simplex that holds the nearest point.
    pub(super) simplex: Points<R>,
    /// The direction from the origin to that point; zero if the origin is that point.
    pub(super) direction: V3<R>,
    /// An axis along which no point of the difference lies below the origin and some are level with it, if the search met one.
    pub(super) weak: Option<V3<R>>,
}

/// Two bodies on their lattice.
pub(super) struct LatticePair<'a, A, B> {
    pub(super) a: &'a A,
    pub(super) b: &'a B,
    pub(super) lattice: CoordinateLattice,
}

/// Rounding of a scalar product of a rounded direction and a vertex, in units of ε |d|₁ (largest coordinate): three roundings of the product,
/// two of the direction; doubled, as two products are compared, which makes 10; the rest is a margin.
const FILTER_ROUNDINGS: f64 = 16.0;

impl<A, B> LatticePair<'_, A, B>
where
    A: Vertices,
    B: Vertices<Vector = A::Vector>,
{
    /// The vertex farthest along a direction. A filter in floating point leaves the few vertices that are compared exactly.
    fn farthest<S: Vertices<Vector = A::Vector>>(&self, shape: &S, d: &V3<ScalarOf<A>>) -> u32 {
        let rounded = direction(d);
        let norm = rounded[0].abs() + rounded[1].abs() + rounded[2].abs();
        // In units of the largest coordinate's power of two.
        let along = |i: usize| {
            let p = shape.vertex(i).to_array();
            let x = |k: usize| times_power(p[k].to_f64(), -self.lattice.top);
            rounded[0] * x(0) + rounded[1] * x(1) + rounded[2] * x(2)
        };
        let close = FILTER_ROUNDINGS * f64::EPSILON * norm * 2.0;
        let mut highest = f64::NEG_INFINITY;
        for i in 0..shape.count() {
            highest = Real::max(highest, along(i));
        }
        let mut best: Option<(u32, Int4<ScalarOf<A>>)> = None;
        let mut single = None;
        for i in 0..shape.count() {
            if along(i) < highest - close {
                continue;
            }
            let i = i as u32;
            if best.is_none() {
                match single {
                    None => {
                        single = Some(i);
                        continue;
                    }
                    Some(first) => best = Some((first, self.along(shape, d, first))),
                }
            }
            let here = self.along(shape, d, i);
            if best.is_some_and(|(_, there)| here.minus(&there).is_positive()) {
                best = Some((i, here));
            }
        }
        best.map(|b| b.0).or(single).unwrap_or(0)
    }

    /// The scalar product of a direction and a vertex.
    fn along<S: Vertices<Vector = A::Vector>>(&self, shape: &S, d: &V3<ScalarOf<A>>, i: u32) -> Int4<ScalarOf<A>> {
        dot(d, &self.lattice.point(shape.vertex(i as usize)))
    }

    /// The point of the difference that lies lowest along a direction.
    pub(super) fn lowest(&self, d: &V3<ScalarOf<A>>) -> ExactDifference<ScalarOf<A>> {
        let pair = (self.farthest(self.a, d), self.farthest(self.b, &negated(d)));
        self.lattice.difference(self.a, self.b, pair)
    }

    /// GJK in exact arithmetic: each iteration replaces the simplex by a strictly nearer one, so it ends. `hint` is a direction from the first body to
    /// the second. With `stop_when_separated` it returns at the first strictly separating axis, else at the nearest point.
    pub(super) fn search(&self, hint: Option<A::Vector>, stop_when_separated: bool) -> Search<ScalarOf<A>> {
        let first = match hint {
            Some(hint) if hint.is_finite() => {
                let d = hint.to_array().map(|x| {
                    let (m, e) = (x.to_f64(), 60 - exponent(hint));
                    let (negative, m, e) = parts(if (-2000..2000).contains(&e) { times_power(m, e) } else { 0.0 });
                    // Components below the unit are dropped: a hint need not be exact.
                    if m == 0 || e < 0 { Int::ZERO } else { Int::shifted(negative, m, e as u32) }
                });
                self.lowest(&d)
            }
            _ => self.lattice.difference(self.a, self.b, (0, 0)),
        };
        let mut simplex: Points<_> = Points::from_array([first]);
        let mut weak = None;
        loop {
            let (kept, direction) = nearest(&simplex);
            simplex = kept;
            if is_zero(&direction) {
                return Search { simplex, direction, weak };
            }
            let new = self.lowest(&direction);
            let along: Int4<ScalarOf<A>> = dot(&direction, &new.w);
            match along.sign() {
                Ordering::Greater if stop_when_separated => return Search { simplex, direction, weak },
                Ordering::Equal => weak = Some(direction),
                _ => {}
            }
            let nearer = |p: &ExactDifference<_>| {
                dot::<_, _, Degree4<ScalarOf<A>>>(&direction, &minus(&new.w, &p.w)).is_negative()
            };
            // A simplex of four points holds the origin and has returned above, so the push does not fail.
            if !simplex.first().is_some_and(nearer) || simplex.push(new).is_err() {
                return Search { simplex, direction, weak };
            }
        }
    }
}
