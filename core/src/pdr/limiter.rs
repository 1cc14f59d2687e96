//! Slopes over one cell from the differences to its two neighbours.
//!
//! Reference: R. J. LeVeque, *Finite Volume Methods for Hyperbolic Problems*, 2002, sec. 6.9–6.11.

use super::state::lesser;
use crate::real::Real;

/// How a slope is limited where the solution bends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Limiter {
    /// Monotonised central: the central slope, at most twice the smaller one-sided one.
    MonotonizedCentral,
    /// The harmonic mean of van Leer.
    VanLeer,
    /// The smaller of the two.
    Minmod,
    /// The central slope as it is; for smooth flow only.
    Unlimited,
    /// No slope: first order in space.
    FirstOrder,
}

/// A limiter as a type, so that the loop over a row holds no choice.
pub(crate) trait Slope {
    /// The slope over the cell from the difference to the lower and to the upper neighbour.
    fn slope<R: Real>(a: R, b: R) -> R;
}

pub(crate) struct MonotonizedCentral;
pub(crate) struct VanLeer;
pub(crate) struct Minmod;
pub(crate) struct Unlimited;

#[inline(always)]
fn same_sign<R: Real>(a: R, b: R) -> bool {
    // Comparing signs, not a product: a product of small differences underflows.
    (a > R::ZERO) == (b > R::ZERO)
}

impl Slope for MonotonizedCentral {
    #[inline(always)]
    fn slope<R: Real>(a: R, b: R) -> R {
        let central = R::HALF * (a + b);
        let size = lesser(central.abs(), R::TWO * lesser(a.abs(), b.abs()));
        let size = if same_sign(a, b) { size } else { R::ZERO };
        if central < R::ZERO { -size } else { size }
    }
}

impl Slope for VanLeer {
    #[inline(always)]
    fn slope<R: Real>(a: R, b: R) -> R {
        let sum = a + b;
        let mean = R::TWO * (a * b) / sum;
        if same_sign(a, b) & (sum != R::ZERO) { mean } else { R::ZERO }
    }
}

impl Slope for Minmod {
    #[inline(always)]
    fn slope<R: Real>(a: R, b: R) -> R {
        let size = lesser(a.abs(), b.abs());
        let size = if same_sign(a, b) { size } else { R::ZERO };
        if a < R::ZERO { -size } else { size }
    }
}

impl Slope for Unlimited {
    #[inline(always)]
    fn slope<R: Real>(a: R, b: R) -> R {
        R::HALF * (a + b)
    }
}
