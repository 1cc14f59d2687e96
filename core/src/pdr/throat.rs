//! Flow through a sudden change of open area.
//!
//! No flux of the form beta F + p Δbeta converges where the porosity jumps: the Riemann solver takes the change of velocity
//! that the change of area causes for a sound wave. So at a jump both states are first carried to one common area, the
//! throat, by the stationary isentropic wave (constant mass flux, total enthalpy and entropy; only the normal velocity
//! changes), and one Riemann problem is solved there. What each cell loses in momentum follows from its own side of the wave.
//! The map is lossless; form losses belong in the drag.
//!
//! References: S. Clain, D. Rochette, J. Comput. Phys. 228 (2009) 8214 (regular and jump part of the porosity);
//! D. Kröner, M. D. Thanh, SIAM J. Numer. Anal. 43 (2005) 796 (stationary waves).

use super::flux::{FaceGas, Flux, Riemann, flux};
use super::state::{Gas, Primitive};
use crate::real::Real;

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
    let mut result = [R::ONE; L];
    while n > 0 {
        for i in 0..L {
            if n & 1 == 1 {
                result[i] *= x[i];
            }
            x[i] *= x[i];
        }
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
        ThroatGas { gas, n, whole }
    }

    /// The same for several states at once, one per lane.
    ///
    /// Nearly all lie below choking on the subsonic branch; they take a fixed number of Newton steps side by side, the others
    /// go one by one. A lane's result does not depend on its neighbours.
    pub(crate) fn carry_all<const D: usize, const L: usize>(
        &self,
        states: &[Primitive<R, D>; L],
        from: &[R; L],
        to: &[R; L],
    ) -> [AtThroat<R, D>; L] {
        let k: [R; L] = core::array::from_fn(|i| from[i] / to[i]);
        let gamma = self.gas.gamma();
        let mach_sq: [R; L] = core::array::from_fn(|i| {
            let w = &states[i];
            w.density * w.velocity[0] * w.velocity[0] / (gamma * w.pressure)
        });
        let subsonic = self.whole.map(|n| self.subsonic_lanes(n, &mach_sq, &k));
        core::array::from_fn(|i| {
            let w = &states[i];
            match &subsonic {
                Some((ratio, t, inside)) if inside[i] && w.velocity[0] != R::ZERO && from[i] != to[i] => {
                    let mut state = *w;
                    state.density *= ratio[i];
                    state.velocity[0] *= k[i] / ratio[i];
                    state.pressure *= ratio[i] * t[i];
                    AtThroat { state, passing: from[i] }
                }
                _ => self.carry(w, from[i], to[i]),
            }
        })
    }

    /// Density and temperature ratio of every lane, and whether they hold: subsonic and not close to choking.
    ///
    /// t − 1 = d obeys d + c (1 + d)^-n = A, c = A k². The parabola that osculates the left side at d = 0 gives a start from
    /// which four Newton steps reach rounding error wherever k² is below 0.95 of the largest that passes (checked for n from
    /// 3 to 200).
    fn subsonic_lanes<const L: usize>(&self, whole: u32, mach_sq: &[R; L], k: &[R; L]) -> ([R; L], [R; L], [bool; L]) {
        const STEPS: usize = 4;
        let n = self.n;
        let a: [R; L] = core::array::from_fn(|i| mach_sq[i] / n);
        let c: [R; L] = core::array::from_fn(|i| a[i] * (k[i] * k[i]));
        let sonic: [R; L] = core::array::from_fn(|i| (R::ONE + a[i]) * n / (n + R::ONE));
        let choking = whole_powers(sonic, whole);
        let inside = core::array::from_fn(|i| {
            let largest_c = (R::ONE + a[i]) / (n + R::ONE) * choking[i];
            (mach_sq[i] < R::ONE) & (c[i] < R::from_f64(0.95) * largest_c)
        });
        let mut d: [R; L] = core::array::from_fn(|i| {
            let (slope, bend) = (R::ONE - n * c[i], c[i] * (n * (n + R::ONE)));
            let rest = c[i] - a[i];
            let root = R::larger(slope * slope - R::TWO * bend * rest, R::ZERO).sqrt();
            let start = -R::TWO * rest / (slope + root);
            R::smaller(R::larger(start, sonic[i] - R::ONE), a[i])
        });
        for _ in 0..STEPS {
            let powers = whole_powers(d.map(|d| R::ONE + d), whole);
            for i in 0..L {
                let q = c[i] / powers[i];
                let value = d[i] + (q - a[i]);
                let slope = R::ONE - n * q / (R::ONE + d[i]);
                d[i] = R::smaller(d[i] - value / slope, a[i]);
            }
        }
        let t = d.map(|d| R::ONE + d);
        (whole_powers(t.map(|t| t.sqrt()), whole), t, inside)
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
            // Left of the minimum of the left side, t^(n+1) = n A k².
            R::from_f64(0.8) * (n * ak_sq).pow(R::ONE / (n + R::ONE)) - R::ONE
        };
        let d = newton(start, a, |d| {
            let q = inv_power(d);
            (d + (ak_sq * q - a), slope(d, q))
        });
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
        let start = if mach_sq < R::ONE { a } else { (mach * k).ln() - R::HALF };
        let l = newton(start, a, |l| {
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
}

/// Newton's method on a convex function with a known upper bound of the root.
///
/// Convergence is quadratic, so a step below this share (of the square root of the rounding error) of the root is the last
/// that counts. At the double root of a throat about to choke the steps halve instead, and the root itself is only known to
/// that share.
fn newton<R: Real>(start: R, bound: R, f: impl Fn(R) -> (R, R)) -> R {
    let enough = R::from_f64(0.0625) * R::EPSILON.sqrt();
    let mut x = start;
    for _ in 0..MAX_STEPS {
        let (value, slope) = f(x);
        let step = value / slope;
        let next = x - step;
        x = if next > bound { bound } else { next };
        if !(step.abs() > enough * x.abs()) {
            break;
        }
    }
    x
}

/// Area of the throat at a jump face: of a plain jump the mean of both ducts, at most twice the narrower one (so that the
/// narrow cell's time step shrinks by two at most); of a true orifice its own.
pub fn throat_area<R: Real>(area_left: R, face: R, area_right: R) -> R {
    let least = R::smaller(area_left, area_right);
    if !(face > R::ZERO) {
        R::ZERO
    } else if face >= least {
        R::smaller(R::HALF * (area_left + area_right), R::TWO * least)
    } else {
        face
    }
}

/// What passes a jump face, areas included; the two cells lose different normal momentum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JumpFlux<R, const D: usize> {
    /// Mass and tangential momentum (components from 1) and energy per time.
    pub through: Flux<R, D>,
    /// Normal momentum that the left cell loses, less `area_left` times its reference pressure.
    pub left: R,
    /// Normal momentum that the right cell gains, less `area_right` times its reference pressure.
    pub right: R,
}

/// One jump face: the states beside it (normal velocity first), the areas of the ducts and of the face, and the pressures that
/// act on the walls inside each cell at this face.
#[derive(Clone, Copy, Debug)]
pub struct JumpFace<R, const D: usize> {
    /// States on the left and right.
    pub states: [Primitive<R, D>; 2],
    /// Duct areas on the left and right.
    pub ducts: [R; 2],
    /// Open area of the face.
    pub face: R,
    /// Reference pressures on the left and right.
    pub references: [R; 2],
    /// A step went wrong here: the Riemann problem in the throat, however weak the waves.
    pub troubled: bool,
}

/// The fluxes through several jump faces, one per lane.
pub fn jump_fluxes<R: Real, const D: usize, const L: usize>(
    solver: Riemann,
    faces: &[JumpFace<R, D>; L],
    gas: &FaceGas<R>,
    throat: &ThroatGas<R>,
) -> [JumpFlux<R, D>; L] {
    let to: [R; L] = core::array::from_fn(|i| throat_area(faces[i].ducts[0], faces[i].face, faces[i].ducts[1]));
    let side = |s: usize| {
        let states = core::array::from_fn(|i| faces[i].states[s]);
        throat.carry_all(&states, &core::array::from_fn(|i| faces[i].ducts[s]), &to)
    };
    let (left, right) = (side(0), side(1));
    core::array::from_fn(|i| jump_flux(solver, &faces[i], to[i], [&left[i], &right[i]], gas, throat))
}

/// The flux through one jump face whose states have been carried to the throat.
fn jump_flux<R: Real, const D: usize>(
    solver: Riemann,
    face: &JumpFace<R, D>,
    to: R,
    at: [&AtThroat<R, D>; 2],
    gas: &FaceGas<R>,
    throat: &ThroatGas<R>,
) -> JumpFlux<R, D> {
    let through = if to > R::ZERO {
        let f = flux(solver, &at[0].state, &at[1].state, gas);
        Flux { mass: to * f.mass, momentum: f.momentum.map(|m| to * m), energy: to * f.energy, pressure: f.pressure }
    } else {
        Flux { mass: R::ZERO, momentum: [R::ZERO; D], energy: R::ZERO, pressure: R::ZERO }
    };
    // Impulse rho u² + p on the throat side, and in the cell relative to the reference pressure.
    let side = |s: usize, into_wall: R| {
        let (w, at, reference) = (&face.states[s], at[s], face.references[s]);
        let throat_part = if to > R::ZERO {
            let t = &at.state;
            through.momentum[0] - to * (t.density * t.velocity[0] * t.velocity[0] + t.pressure)
        } else {
            R::ZERO
        };
        let u = w.velocity[0];
        let stream = at.passing * (w.density * u * u + (w.pressure - reference));
        let blocked = face.ducts[s] - at.passing;
        let wall = if blocked > R::ZERO {
            blocked * (throat.wall_pressure(w.density, w.pressure, into_wall) - reference)
        } else {
            R::ZERO
        };
        throat_part + (stream + wall)
    };
    let left = side(0, face.states[0].velocity[0]);
    let right = side(1, -face.states[1].velocity[0]);
    let strong = JumpFlux { through, left, right };
    if face.troubled || !(to > R::ZERO) || at[0].passing < face.ducts[0] || at[1].passing < face.ducts[1] {
        return strong;
    }
    let weak = acoustic(face, at, gas);
    let share = weakness(weak.through.mass / to, at, gas);
    if share > R::ZERO { weak.blend(&strong, share) } else { strong }
}

/// Up to half this strength (Mach number in the throat, or jump of its pressure as a share) waves count as weak, from all of it
/// on as strong.
const STRONG: f64 = 0.6;

/// How far the waves at a jump are weak: 1 if sound, 0 if a shock arrives, or if `mass_flux` per area of the throat, that of weak
/// waves, is more than it would take.
fn weakness<R: Real, const D: usize>(mass_flux: R, [l, r]: [&AtThroat<R, D>; 2], gas: &FaceGas<R>) -> R {
    let mach = |w: &Primitive<R, D>| {
        let u = R::larger(w.velocity[0].abs(), mass_flux.abs() / w.density);
        u / gas.sound_speed(w)
    };
    let (p_l, p_r) = (l.state.pressure, r.state.pressure);
    let strength = R::larger(R::larger(mach(&l.state), mach(&r.state)), (p_l - p_r).abs() / R::smaller(p_l, p_r));
    let share = R::TWO - strength * R::from_f64(2.0 / STRONG);
    R::smaller(R::larger(share, R::ZERO), R::ONE)
}

/// The fluxes of weak waves at a change of area: one sound wave into each duct, the stationary wave between them. A Riemann
/// problem in the throat instead, as for strong waves, gives sound at a contraction energy that it does not have, and noise
/// would grow between two of them.
///
/// Both sides have the mass flux Q in common and differ from their cells by the outgoing wave: the pressure by ∓c (Q − Q_K)/a, the
/// momentum flux by (u ∓ c)(Q − Q_K), the total enthalpy by ∓c (Q − Q_K)/(a rho), left and right. Q is such that the pressures in the
/// throat meet; the waves change them there as they do in the ducts, which is so in slow flow, and does not matter in a steady one.
fn acoustic<R: Real, const D: usize>(
    face: &JumpFace<R, D>,
    at: [&AtThroat<R, D>; 2],
    gas: &FaceGas<R>,
) -> JumpFlux<R, D> {
    let c: [R; 2] = core::array::from_fn(|s| gas.sound_speed(&face.states[s]));
    let mass: [R; 2] = core::array::from_fn(|s| face.ducts[s] * (face.states[s].density * face.states[s].velocity[0]));
    let (stiff_l, stiff_r) = (c[0] / face.ducts[0], c[1] / face.ducts[1]);
    let drive = at[0].state.pressure - at[1].state.pressure;
    let common = ((stiff_l * mass[0] + stiff_r * mass[1]) + drive) / (stiff_l + stiff_r);
    let own = |s: usize, wave: R| {
        let w = &face.states[s];
        let u = w.velocity[0];
        let change = common - mass[s];
        let impulse = face.ducts[s] * (w.density * u * u + (w.pressure - face.references[s]));
        let enthalpy = gas.enthalpy(w) + wave * change / (face.ducts[s] * w.density);
        (impulse + (u + wave) * change, common * enthalpy)
    };
    let ((left, energy_l), (right, energy_r)) = (own(0, -c[0]), own(1, c[1]));
    let from_left = common >= R::ZERO;
    let (upwind, energy) = if from_left { (&face.states[0], energy_l) } else { (&face.states[1], energy_r) };
    let momentum = core::array::from_fn(|i| if i == 0 { R::ZERO } else { common * upwind.velocity[i] });
    JumpFlux { through: Flux { mass: common, momentum, energy, pressure: R::ZERO }, left, right }
}

impl<R: Real, const D: usize> JumpFlux<R, D> {
    /// A share of this flux and the rest of another.
    fn blend(&self, other: &Self, share: R) -> Self {
        if share == R::ONE {
            return *self;
        }
        let mix = |a: R, b: R| share * a + (R::ONE - share) * b;
        let (a, b) = (&self.through, &other.through);
        JumpFlux {
            through: Flux {
                mass: mix(a.mass, b.mass),
                momentum: core::array::from_fn(|i| mix(a.momentum[i], b.momentum[i])),
                energy: mix(a.energy, b.energy),
                pressure: b.pressure,
            },
            left: mix(self.left, other.left),
            right: mix(self.right, other.right),
        }
    }
}
