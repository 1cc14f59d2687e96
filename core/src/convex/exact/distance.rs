//! The exact distance, rounded at the end.

use super::integer::{Degree2, Degree4, Int, Int3, V1, V2, cross, dot, is_zero, minus};
use super::lattice::{CoordinateLattice, NotFinite, one, times_power};
use super::search::LatticePair;
use crate::convex::shape::Vertices;
use crate::convex::support::ScalarOf;
use crate::number::real::{Real, Vector};
use crate::number::words::Words;

/// An exact distance, rounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExactDistance {
    /// The distance, to a relative error of 16 ε, below the normal numbers to their last bit; 0 exactly if a point is shared.
    pub distance: f64,
    /// The nearest point of the first body, to rounding.
    pub a: [f64; 3],
    /// The nearest point of the second body, to rounding.
    pub b: [f64; 3],
}

/// The distance of two bodies, from exact signs and exact products: right to 16 ε however the vertices lie. A distance beyond
/// the largest number is infinite.
pub fn distance<A, B>(a: &A, b: &B, hint: Option<A::Vector>) -> Result<ExactDistance, NotFinite>
where
    A: Vertices,
    B: Vertices<Vector = A::Vector>,
{
    let pair = LatticePair { a, b, lattice: CoordinateLattice::new(a, b)? };
    let search = pair.search(hint, false);
    let points = search.simplex.as_slice();
    let (sq, weights) = match points {
        [p] => (Ratio::new(dot::<_, _, Degree4<ScalarOf<A>>>(&p.w, &p.w), one()), [one(), Int::ZERO, Int::ZERO]),
        [p, q] => {
            let e = minus(&q.w, &p.w);
            let area: V2<ScalarOf<A>> = cross(&p.w, &e);
            let weights = [dot(&q.w, &e), dot::<_, _, Degree4<ScalarOf<A>>>(&p.w, &e).negated(), Int::ZERO];
            (Ratio::new::<Degree4<ScalarOf<A>>>(dot(&area, &area), dot(&e, &e)), weights)
        }
        [p, q, r] => {
            let n: V2<ScalarOf<A>> = cross(&minus(&q.w, &p.w), &minus(&r.w, &p.w));
            let height: Int3<ScalarOf<A>> = dot(&n, &p.w);
            let part = |x: &V1<ScalarOf<A>>, y: &V1<ScalarOf<A>>| {
                dot::<_, _, Degree4<ScalarOf<A>>>(&n, &cross::<_, _, Degree2<ScalarOf<A>>>(x, y))
            };
            let weights = [part(&q.w, &r.w), part(&r.w, &p.w), part(&p.w, &q.w)];
            (Ratio::square_over(height, dot::<_, _, Degree4<ScalarOf<A>>>(&n, &n)), weights)
        }
        _ => (Ratio { m: 0.0, e: 0 }, [one(), Int::ZERO, Int::ZERO]),
    };
    // Only the ratios of the weights count.
    let top = weights.iter().filter(|w| !w.is_zero()).map(|w| w.as_float().1).max().unwrap_or(0);
    let weights = weights.map(|w| {
        let (m, e) = w.as_float();
        times_power(m, e - top)
    });
    let total: f64 = weights.iter().sum();
    // A distance that underflows stays above 0, which means a shared point.
    let least = if is_zero(&search.direction) { 0.0 } else { f64::from_bits(1) };
    let mut nearest =
        ExactDistance { distance: Real::max(sq.root(pair.lattice.unit), least), a: [0.0; 3], b: [0.0; 3] };
    for (p, weight) in points.iter().zip(weights) {
        let (i, j) = p.pair;
        let (u, v) = (a.vertex(i as usize).to_array(), b.vertex(j as usize).to_array());
        for k in 0..3 {
            nearest.a[k] += weight / total * u[k].to_f64();
            nearest.b[k] += weight / total * v[k].to_f64();
        }
    }
    Ok(nearest)
}

/// A positive number `m · 2^e`.
struct Ratio {
    m: f64,
    e: i32,
}

impl Ratio {
    /// `numerator / denominator`.
    fn new<W: Words>(numerator: Int<W>, denominator: Int<W>) -> Self {
        let ((m, e), (n, f)) = (numerator.as_float(), denominator.as_float());
        Ratio { m: m / n, e: e - f }
    }

    /// `root² / denominator`.
    fn square_over(root: Int<impl Words>, denominator: Int<impl Words>) -> Self {
        let ((m, e), (n, f)) = (root.as_float(), denominator.as_float());
        Ratio { m: m * m / n, e: 2 * e - f }
    }

    /// The square root, times `2^unit`.
    fn root(&self, unit: i32) -> f64 {
        let odd = self.e & 1;
        let m = if odd == 0 { self.m } else { 2.0 * self.m };
        times_power(Real::sqrt(m), (self.e - odd) / 2 + unit)
    }
}
