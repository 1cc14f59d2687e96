//! From floating point to integers and back: the unit of a query, and directions back.

use super::integer::{Int, V1, minus};
use crate::convex::shape::Vertices;
use crate::convex::support::ScalarOf;
use crate::number::real::{Real, Vector};
use crate::number::words::Words;

/// A vertex is NaN or infinite, or there is none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotFinite;

impl core::fmt::Display for NotFinite {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("a body has no vertices, or one that is not finite")
    }
}

impl core::error::Error for NotFinite {}

/// The unit in which all coordinates of a query are integers.
#[derive(Clone, Copy)]
pub(super) struct CoordinateLattice {
    /// Its exponent.
    pub(super) unit: i32,
    /// Exponent of the largest coordinate.
    pub(super) top: i32,
}

/// Sign, odd mantissa and exponent; a mantissa of 0 for zero.
pub(super) fn parts(x: f64) -> (bool, u64, i32) {
    let bits = x.to_bits();
    let field = (bits >> 52 & 0x7ff) as i32;
    let fraction = bits & ((1 << 52) - 1);
    let (m, e) = if field == 0 { (fraction, -1074) } else { (fraction | 1 << 52, field - 1075) };
    let zeros = if m == 0 { 0 } else { m.trailing_zeros() };
    (x.is_sign_negative(), m >> zeros, e + zeros as i32)
}

impl CoordinateLattice {
    pub(super) fn new<A: Vertices, B: Vertices<Vector = A::Vector>>(a: &A, b: &B) -> Result<Self, NotFinite> {
        let mut lattice = CoordinateLattice { unit: i32::MAX, top: i32::MIN };
        if a.count() == 0 || b.count() == 0 {
            return Err(NotFinite);
        }
        let mut include = |p: A::Vector| {
            for x in p.to_array() {
                let x = x.to_f64();
                if !Real::is_finite(x) {
                    return Err(NotFinite);
                }
                let (_, m, e) = parts(x);
                if m != 0 {
                    lattice.unit = lattice.unit.min(e);
                    lattice.top = lattice.top.max(e + 63 - m.leading_zeros() as i32);
                }
            }
            Ok(())
        };
        for i in 0..a.count() {
            include(a.vertex(i))?;
        }
        for j in 0..b.count() {
            include(b.vertex(j))?;
        }
        if lattice.unit > lattice.top {
            lattice = CoordinateLattice { unit: 0, top: 0 };
        }
        Ok(lattice)
    }

    pub(super) fn point<V: Vector>(&self, p: V) -> V1<V::Scalar> {
        p.to_array().map(|x| {
            let (negative, m, e) = parts(x.to_f64());
            if m == 0 { Int::ZERO } else { Int::shifted(negative, m, (e - self.unit) as u32) }
        })
    }

    pub(super) fn difference<A: Vertices, B: Vertices<Vector = A::Vector>>(
        &self,
        a: &A,
        b: &B,
        pair: (u32, u32),
    ) -> ExactDifference<ScalarOf<A>> {
        let w = minus(&self.point(b.vertex(pair.1 as usize)), &self.point(a.vertex(pair.0 as usize)));
        ExactDifference { pair, w }
    }
}

/// A point `b - a` of the difference.
#[derive(Clone, Copy)]
pub(super) struct ExactDifference<R: Real> {
    pub(super) pair: (u32, u32),
    pub(super) w: V1<R>,
}

/// `m · 2^e`, rounded once at most.
pub(super) fn times_power(m: f64, e: i32) -> f64 {
    let power = |e: i32| f64::from_bits(((e + 1023) as u64) << 52);
    // Two normal factors reach from 2^-2044 to 2^2046; the first leaves a normal number, so only the last one rounds.
    if e > 1000 {
        m * power(1000) * power((e - 1000).min(1000))
    } else if e < -1000 {
        m * power(-1000) * power((e + 1000).max(-1000))
    } else {
        m * power(e)
    }
}

/// Rounded to floating point, the largest component between 1 and 2; each to a relative error of 2⁻⁵², or below 2⁻⁹⁹⁹.
pub(super) fn direction<W: Words>(d: &[Int<W>; 3]) -> [f64; 3] {
    let parts = [d[0].as_float(), d[1].as_float(), d[2].as_float()];
    let top = parts.iter().filter(|p| p.0 != 0.0).map(|p| p.1).max().unwrap_or(0);
    parts.map(|(m, e)| if e - top > -1000 { times_power(m, e - top) } else { 0.0 })
}

pub(super) fn one<W: Words>() -> Int<W> {
    Int::shifted(false, 1, 0)
}

/// Exponent of the largest component of a finite vector.
pub(super) fn exponent<V: Vector>(v: V) -> i32 {
    let largest = v.norm_max().to_f64();
    let (_, m, e) = parts(largest);
    if m == 0 { 0 } else { e + 63 - m.leading_zeros() as i32 }
}
