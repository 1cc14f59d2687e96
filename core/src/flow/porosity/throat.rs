//! Flow through a sudden change of open area.
//!
//! No flux of the form beta F + p Δbeta converges where the porosity jumps: the Riemann solver takes the change of velocity
//! that the change of area causes for a sound wave. So at a jump both states are first carried to one common area, the
//! throat, by the stationary isentropic wave (constant mass flux, total enthalpy and entropy; only the normal velocity
//! changes); the fluxes follow in `jump`. The map is lossless; form losses belong in the drag.
//!
//! References: S. Clain, D. Rochette, J. Comput. Phys. 228 (2009) 8214 (regular and jump part of the porosity);
//! D. Kröner, M. D. Thanh, SIAM J. Numer. Anal. 43 (2005) 796 (stationary waves).

use crate::flow::porosity::fractions::rounding;
use crate::flow::state::{Gas, Primitive};
use crate::number::real::Real;

/// Newton steps at most. Away from choking three suffice; at the double root of a choked throat each step halves the error.
const MAX_STEPS: usize = 60;

/// A state carried to the throat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AtThroat<R, const D: usize> {
    /// The state there.
    pub state: Primitive<R, D>,
    /// Area of the stream in the cell that passes: the duct's area, or less if the throat chokes.
    pub passing: R,
}

/// Exponents of the isentropic relations of a gas.
#[derive(Clone, Copy, Debug)]
pub struct ThroatGas<R> {
    gas: Gas<R>,
    /// n = 2/(gamma − 1): density goes with temperature to the power n/2.
    n: R,
    /// n, if it is a whole number small enough to multiply out.
    whole: Option<u32>,
    /// 1/n, 1/(n + 1) and n/(n + 1).
    inv_n: R,
    inv_next: R,
    share: R,
}

/// A power by squaring.
#[inline]
fn whole_power<R: Real>(mut x: R, mut n: u32) -> R {
    if n == 5 {
        // gamma = 1.4
        let square = x * x;
        return square * square * x;
    }
    let mut result = R::ONE;
    while n > 0 {
        if n & 1 == 1 {
            result *= x;
        }
        x *= x;
        n >>= 1;
    }
    result
}

/// The same power of every lane.
#[inline(always)]
fn whole_powers<R: Real, const L: usize>(mut x: [R; L], mut n: u32) -> [R; L] {
    if n == 5 {
        return core::array::from_fn(|i| (x[i] * x[i]) * (x[i] * x[i]) * x[i]);
    }
    let mut result = [R::ONE; L];
    while n > 0 {
        if n & 1 == 1 {
            result = core::array::from_fn(|i| result[i] * x[i]);
        }
        x = core::array::from_fn(|i| x[i] * x[i]);
        n >>= 1;
    }
    result
}

impl<R: Real> ThroatGas<R> {
    /// From a gas.
    pub fn new(gas: Gas<R>) -> Self {
        let n = R::TWO / (gas.gamma() - R::ONE);
        let nearest = (n + R::HALF).floor();
        let close = (n - nearest).abs() <= R::from_f64(16.0) * R::EPSILON * n;
        let whole = if close && n < R::from_f64(64.0) { Some(nearest.to_f64() as u32) } else { None };
        let inv_next = R::ONE / (n + R::ONE);
        ThroatGas { gas, n, whole, inv_n: R::ONE / n, inv_next, share: n * inv_next }
    }

    /// The same for several states at once, one per lane.
    ///
    /// Nearly all lie below choking on the subsonic branch; they take a fixed number of steps side by side, the others
    /// go one by one. A lane's result does not depend on its neighbours, and gas at rest comes out as it is.
    pub(crate) fn carry_all<const D: usize, const L: usize>(
        &self,
        w: &Primitive<[R; L], D>,
        from: &[R; L],
        to: &[R; L],
    ) -> AtThroat<[R; L], D> {
        let k: [R; L] = core::array::from_fn(|i| from[i] / to[i]);
        let (gamma, u) = (self.gas.gamma(), &w.velocity[0]);
        let mach_sq: [R; L] = core::array::from_fn(|i| w.density[i] * u[i] * u[i] / (gamma * w.pressure[i]));
        let mut at = AtThroat { state: *w, passing: *from };
        let mut inside = [false; L];
        if let Some(n) = self.whole {
            let (ratio, t, holds) = self.subsonic_lanes(n, &mach_sq, &k);
            inside = holds;
            for i in 0..L {
                at.state.density[i] *= ratio[i];
                at.state.velocity[0][i] *= k[i] / ratio[i];
                at.state.pressure[i] *= ratio[i] * t[i];
            }
        }
        for i in (0..L).filter(|&i| !inside[i]) {
            let one = self.carry(&w.lane(i), from[i], to[i]);
            at.state.set_lane(i, &one.state);
            at.passing[i] = one.passing;
        }
        at
    }

    /// Density and temperature ratio of every lane, and whether they hold: subsonic and not close to choking.
    ///
    /// t − 1 = d obeys d + c (1 + d)^-n = A, c = A k². The parabola that osculates the left side at d = 0 gives a start from
    /// which three of Halley's steps reach rounding error wherever k² is below 0.95 of the largest that passes (checked for n from
    /// 3 to 63). Each is written with one division.
    #[inline(always)]
    fn subsonic_lanes<const L: usize>(&self, whole: u32, mach_sq: &[R; L], k: &[R; L]) -> ([R; L], [R; L], [bool; L]) {
        const STEPS: usize = 3;
        let n = self.n;
        let a: [R; L] = core::array::from_fn(|i| mach_sq[i] * self.inv_n);
        let c: [R; L] = core::array::from_fn(|i| a[i] * (k[i] * k[i]));
        let sonic: [R; L] = core::array::from_fn(|i| (R::ONE + a[i]) * self.share);
        let choking = whole_powers(sonic, whole);
        let inside = core::array::from_fn(|i| {
            let largest_c = (R::ONE + a[i]) * self.inv_next * choking[i];
            (mach_sq[i] < R::ONE) & (c[i] < R::from_f64(0.95) * largest_c)
        });
        let bend: [R; L] = core::array::from_fn(|i| c[i] * (n * (n + R::ONE)));
        let mut d: [R; L] = core::array::from_fn(|i| {
            let (slope, rest) = (R::ONE - n * c[i], c[i] - a[i]);
            let root = R::larger(slope * slope - R::TWO * bend[i] * rest, R::ZERO).sqrt();
            let start = -R::TWO * rest / (slope + root);
            R::smaller(R::larger(start, sonic[i] - R::ONE), a[i])
        });
        for _ in 0..STEPS {
            let powers = whole_powers(core::array::from_fn::<_, L, _>(|i| R::ONE + d[i]), whole);
            d = core::array::from_fn(|i| {
                let t = R::ONE + d[i];
                // Value and slope, times t^n and t^(n + 1).
                let value = (d[i] - a[i]) * powers[i] + c[i];
                let slope = powers[i] * t - n * c[i];
                let step = R::TWO * value * slope * t / (R::TWO * slope * slope - bend[i] * value);
                R::smaller(d[i] - step, a[i])
            });
        }
        let t: [R; L] = core::array::from_fn(|i| R::ONE + d[i]);
        (whole_powers(core::array::from_fn(|i| t[i].sqrt()), whole), t, inside)
    }

    /// t^n for t = T/T_cell.
    fn power(&self, t: R) -> R {
        match self.whole {
            Some(n) => whole_power(t, n),
            None => t.pow(self.n),
        }
    }

    /// Carries a state from a stream of area `from` to a throat of area `to`, on its own branch (sub- or supersonic).
    ///
    /// With k = from/to and A = M²/n, the temperature ratio t obeys t + A k² t^-n = 1 + A; for an isothermal gas l = ln rho
    /// takes its place, l + A k² e^-2l = A with A = M²/2. Both left sides are convex with the sonic point at the minimum,
    /// so Newton's steps from the outside are monotone. Solved for t − 1, to keep the digits of slow flow.
    pub fn carry<const D: usize>(&self, w: &Primitive<R, D>, from: R, to: R) -> AtThroat<R, D> {
        let u = w.velocity[0];
        if u == R::ZERO || from == to {
            return AtThroat { state: *w, passing: from };
        }
        if !(to > R::ZERO) {
            return AtThroat { state: *w, passing: R::ZERO };
        }
        let k = from / to;
        let mach_sq = w.density * u * u / (self.gas.gamma() * w.pressure);
        let isothermal = matches!(self.gas, Gas::Isothermal { .. });
        let (ratio, t, passing) = if isothermal { self.isothermal(mach_sq, k) } else { self.isentropic(mach_sq, k) };
        let passing = if passing < k { passing * to } else { from };
        let mut velocity = w.velocity;
        velocity[0] = u * (passing / to) / ratio;
        let state = Primitive { density: w.density * ratio, velocity, pressure: w.pressure * (ratio * t) };
        AtThroat { state, passing }
    }

    /// Density ratio, temperature ratio, and the largest k that passes.
    fn isentropic(&self, mach_sq: R, k: R) -> (R, R, R) {
        if let Some((ratio, t, [true])) = self.whole.map(|n| self.subsonic_lanes(n, &[mach_sq], &[k])) {
            return (ratio[0], t[0], k);
        }
        let n = self.n;
        let a = mach_sq / n;
        let ratio = |t: R| match self.whole {
            Some(n) => whole_power(t.sqrt(), n),
            None => t.pow(R::HALF * n),
        };
        let sonic = (R::ONE + a) * n / (n + R::ONE);
        let largest_sq = (R::ONE + a) / (n + R::ONE) * self.power(sonic) / a;
        if k * k >= largest_sq {
            return (ratio(sonic), sonic, largest_sq.sqrt());
        }
        let ak_sq = a * (k * k);
        let slope = |d: R, inv_power: R| R::ONE - n * ak_sq * inv_power / (R::ONE + d);
        let inv_power = |d: R| R::ONE / self.power(R::ONE + d);
        let start = if mach_sq < R::ONE {
            let bernoulli = a - ak_sq;
            let good = bernoulli > sonic - R::ONE && slope(bernoulli, inv_power(bernoulli)) > R::HALF;
            if good { bernoulli } else { a }
        } else {
            // Left of the root, as the left side alone without t is 1 + A there. (A share of the sonic t may lie on its right,
            // from where a step leads to a negative temperature.)
            (ak_sq / (R::ONE + a)).pow(self.inv_n) - R::ONE
        };
        let d = newton(
            start,
            a,
            |d| R::smaller(d.abs(), R::ONE + d),
            |d| {
                let q = inv_power(d);
                (d + (ak_sq * q - a), slope(d, q))
            },
        );
        (ratio(R::ONE + d), R::ONE + d, k)
    }

    fn isothermal(&self, mach_sq: R, k: R) -> (R, R, R) {
        let a = R::HALF * mach_sq;
        let mach = mach_sq.sqrt();
        let largest = (a - R::HALF).exp() / mach;
        if k >= largest {
            return (mach * largest, R::ONE, largest);
        }
        let ak_sq = a * (k * k);
        let start = if mach_sq < R::ONE { a } else { supersonic_start(a, k) };
        let l = newton(start, a, R::abs, |l| {
            let q = ak_sq * (-(l + l)).exp();
            (l + (q - a), R::ONE - (q + q))
        });
        (l.exp(), R::ONE, k)
    }

    /// Pressure on a wall that the gas meets with normal velocity `v` (negative: leaves), from the exact Riemann problem of
    /// a state and its mirror image, Toro sec. 4.3. For an isentropic gas the shock is that of the ideal gas, which agrees
    /// to third order in its strength.
    pub fn wall_pressure(&self, density: R, pressure: R, v: R) -> R {
        let gamma = self.gas.gamma();
        if v == R::ZERO {
            return pressure;
        }
        let c = (gamma * pressure / density).sqrt();
        if v > R::ZERO {
            let q = R::from_f64(0.25) * (gamma + R::ONE) * v;
            return pressure + density * v * (q + (q * q + c * c).sqrt());
        }
        if matches!(self.gas, Gas::Isothermal { .. }) {
            return pressure * (v / c).exp();
        }
        let t = R::larger(R::ONE + v / (self.n * c), R::ZERO);
        match self.whole {
            Some(n) => pressure * whole_power(t, n + 2),
            None => pressure * t.pow(self.n + R::TWO),
        }
    }

    /// The same for the gas of a cell, less a reference pressure.
    pub(in crate::flow) fn relative_wall_pressure<const D: usize>(&self, w: &Primitive<R, D>, v: R, reference: R) -> R {
        self.wall_pressure(w.density, w.pressure, v) - reference
    }
}

/// A place left of the supersonic root of l + A k² e^-2l = A. It is ln k for a contraction. For an expansion the left side at
/// ln k − x is at least A + ln k + (2A − 1) x + 2A x², which is A at the x taken here.
fn supersonic_start<R: Real>(a: R, k: R) -> R {
    let rise = R::larger(-k.ln(), R::ZERO);
    let slope = R::TWO * a - R::ONE;
    let root = (slope * slope + R::from_f64(8.0) * a * rise).sqrt();
    let x = if rise > R::ZERO { R::TWO * rise / (slope + root) } else { R::ZERO };
    k.ln() - x
}

/// Newton's method on a convex function with a known upper bound of the root; `size` is what its error is measured against.
///
/// Convergence is quadratic, so a step below this share (of the square root of the rounding error) of the size is the last
/// that counts. At the double root of a throat about to choke the steps halve instead, and the root itself is only known to
/// that share.
fn newton<R: Real>(start: R, bound: R, size: impl Fn(R) -> R, f: impl Fn(R) -> (R, R)) -> R {
    let enough = R::from_f64(0.0625) * R::EPSILON.sqrt();
    let mut x = start;
    for _ in 0..MAX_STEPS {
        let (value, slope) = f(x);
        let step = value / slope;
        let next = x - step;
        x = if next > bound { bound } else { next };
        if !(step.abs() > enough * size(x)) {
            break;
        }
    }
    x
}

/// Area of the throat at a jump face: of a plain jump the mean of both ducts, at most twice the narrower one (so that the
/// narrow cell's time step shrinks by two at most), and the narrower one itself if its cell is narrower than those on both sides of it
/// and a stream nearly chokes there (`pinched`), since no other face would choke it; of a true orifice, narrower than both by more than rounding, its own.
pub fn throat_area<R: Real>(area_left: R, face: R, area_right: R, pinched: bool) -> R {
    let least = R::smaller(area_left, area_right);
    if !(face > R::ZERO) {
        R::ZERO
    } else if face < least - rounding::<R>() * least {
        face
    } else if pinched {
        least
    } else {
        R::smaller(R::HALF * (area_left + area_right), R::TWO * least)
    }
}
