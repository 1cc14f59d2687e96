//! Slopes over one cell from the differences to its two neighbours.
//!
//! References: R. J. LeVeque, *Finite Volume Methods for Hyperbolic Problems*, 2002, sec. 6.9–6.11; P. K. Sweby, SIAM J. Numer. Anal. 21 (1984) 995 (how far a limiter may
//! steepen); M. Arora and P. L. Roe, J. Comput. Phys. 132 (1997) 3 (third order for waves of a known Courant number).

use crate::number::real::Real;

/// How a slope is limited where the solution bends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Limiter {
    /// That of Arora and Roe for sound, each wave by itself: of third order in space and time where one goes along an axis, bounded by what its
    /// Courant number allows, so that the peaks of blasts are less clipped. What goes with the gas, and cells beside walls and jumps, are as
    /// by [`Limiter::Steep`].
    AroraRoe,
    /// Monotonised central for pressure and velocity; of the density only the part that goes with the pressure, the rest, the
    /// entropy wave, gets a slope that keeps contacts within a few cells. A barotropic gas has no contacts: there it is the
    /// same as [`Limiter::MonotonizedCentral`].
    Steep,
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

    /// Half a slope stays within both differences, on cells that are alike.
    const LIMITED: bool = true;

    /// The limiter takes the density apart into the share of the sound waves and the entropy wave.
    const SPLIT: bool = false;

    /// The slope of the entropy wave.
    #[inline(always)]
    fn entropy_slope<R: Real>(a: R, b: R) -> R {
        Self::slope(a, b)
    }
}

/// Slope of the velocity along the normal of a wall, in the cell beside it: that which makes it vanish at the wall, at most twice
/// the difference to the neighbour on the other side (a shock that arrives is no stagnation flow). `here` is the velocity of
/// the cell, `away` the difference on the other side, `high` tells on which side the wall stands.
///
/// A velocity left over at the wall costs rho c times as much in pressure, and slow flow stagnates at hardly more than ½ rho u².
#[inline(always)]
pub(crate) fn wall_slope<R: Real>(here: R, away: R, high: bool) -> R {
    let to_wall = if high { -(here + here) } else { here + here };
    let size = R::smaller(to_wall.abs(), R::TWO * away.abs());
    let size = if same_sign(to_wall, away) { size } else { R::ZERO };
    if to_wall < R::ZERO { -size } else { size }
}

/// How far the slope of a sound wave may exceed the difference on its downwind side, and that on its upwind side. The bounds of Sweby, 2/(1 − |ν|) and 2/|ν|, go
/// beyond that; half a slope as large as those would leave pressures below 0 at strong shocks.
const MOST_DOWNWIND: f64 = 4.0;
const MOST_UPWIND: f64 = 8.0;

/// 1 over the Courant number from which a wave has a direction. A slower one is nearly at rest, and rounding decides whither it goes: up to here the slope
/// changes over to the central one with the bounds of all limiters.
const DIRECTED: f64 = 32.0;

/// A sound wave that passes some cells in a step: what its slopes are made of.
#[derive(Clone, Copy)]
pub(crate) struct SoundWave<R> {
    /// Weight of the third order: of (b − a)/6, from the central slope to that of third order.
    bend: R,
    /// How far a slope may exceed the difference to the lower and to the upper neighbour.
    most_low: R,
    most_high: R,
}

impl<R: Real> SoundWave<R> {
    /// One that passes `courant` cells in a step, upward if that is above 0.
    #[inline(always)]
    pub fn new(courant: R) -> Self {
        let size = R::smaller(courant.abs(), R::ONE);
        let directed = R::smaller(R::from_f64(DIRECTED) * size, R::ONE);
        let bend = directed - size - size;
        let rest = R::ONE - R::smaller(size, R::from_f64(1.0 - 2.0 / MOST_DOWNWIND));
        let passed = R::larger(size, R::from_f64(2.0 / MOST_UPWIND));
        // 2 over each, by one division.
        let both = R::TWO / (rest * passed);
        let (downwind, upwind) = (both * passed, R::TWO + directed * (both * rest - R::TWO));
        let upward = courant > R::ZERO;
        SoundWave {
            bend: if upward { bend } else { -bend },
            most_low: if upward { upwind } else { downwind },
            most_high: if upward { downwind } else { upwind },
        }
    }

    /// The slope over the cell from the differences to the lower and to the upper neighbour. With it the value at the downwind face at the half step is of
    /// third order; no new extremum arises.
    #[inline(always)]
    pub fn slope(self, a: R, b: R) -> R {
        let third = R::HALF * (a + b) + self.bend * ((b - a) * R::from_f64(1.0 / 6.0));
        let most = R::smaller(self.most_low * a.abs(), self.most_high * b.abs());
        let size = R::smaller(third.abs(), most);
        let size = if same_sign(a, b) { size } else { R::ZERO };
        if a < R::ZERO { -size } else { size }
    }
}

pub(crate) struct Steep;
pub(crate) struct MonotonizedCentral;
pub(crate) struct VanLeer;
pub(crate) struct Minmod;
pub(crate) struct Unlimited;

#[inline(always)]
fn same_sign<R: Real>(a: R, b: R) -> bool {
    // Comparing signs, not a product: a product of small differences underflows.
    (a > R::ZERO) == (b > R::ZERO)
}

/// Strength of the steepening, see [`Steep`]. 4 holds a contact within four cells; much more turns long waves into steps.
const STEEPENING: f64 = 4.0;

impl Slope for Steep {
    const SPLIT: bool = true;

    #[inline(always)]
    fn slope<R: Real>(a: R, b: R) -> R {
        MonotonizedCentral::slope(a, b)
    }

    /// The central slope and κ (a − b)²/(a + b), at most twice the smaller difference, the bound of all monotone limiters.
    /// κ = −½ is van Leer's harmonic mean, κ = 0 the monotonised central slope; above 0 a front steepens until its differences
    /// are in the ratio where the bound takes over. In smooth flow the added term is of third order, so accuracy stays.
    #[inline(always)]
    fn entropy_slope<R: Real>(a: R, b: R) -> R {
        let (sum, gap) = (a.abs() + b.abs(), a.abs() - b.abs());
        let steep = R::HALF * sum + R::from_f64(STEEPENING) * (gap * (gap / sum));
        let size = R::smaller(steep, R::TWO * R::smaller(a.abs(), b.abs()));
        let size = if same_sign(a, b) & (sum != R::ZERO) { size } else { R::ZERO };
        if a < R::ZERO { -size } else { size }
    }
}

impl Slope for MonotonizedCentral {
    #[inline(always)]
    fn slope<R: Real>(a: R, b: R) -> R {
        let central = R::HALF * (a + b);
        let size = R::smaller(central.abs(), R::TWO * R::smaller(a.abs(), b.abs()));
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
        let size = R::smaller(a.abs(), b.abs());
        let size = if same_sign(a, b) { size } else { R::ZERO };
        if a < R::ZERO { -size } else { size }
    }
}

impl Slope for Unlimited {
    const LIMITED: bool = false;

    #[inline(always)]
    fn slope<R: Real>(a: R, b: R) -> R {
        R::HALF * (a + b)
    }
}
