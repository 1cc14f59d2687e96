//! Fluxes of the Euler equations through one face of unit area.
//!
//! The face normal is the first velocity component; the caller rotates. All solvers are written so that exchanging
//! left and right and reversing the normal reverses the flux to the bit, and so that two states at rest with one pressure
//! give exactly that pressure.
//!
//! [`Riemann::HllcLowMach`] is softened where the gas is slow. A Riemann problem answers a difference of normal velocities by a pressure ρcΔu, sound
//! or not, and a vortex of Mach number M loses 1/M times what its advection would cost. Taking Δu away (Thornber et al., J. Comput. Phys. 227
//! (2008) 4873; Rieper, J. Comput. Phys. 230 (2011) 5263) leaves the half step of Hancock unstable: of the kinetic energy of Gresho's vortex
//! (40 × 40 cells, one turn; 0.951, 0.785 and 0.458 by the plain solver at Mach 0.3, 0.03 and 0.003) it kept 1.06, with a pressure that alternates
//! from cell to cell. Fourier modes tell why, and what helps: where Δu goes, the slopes of the pressure must go too, so that the face has the
//! mean of both cells at the half step; then no mode grows as long as c dt/dx ≤ 0.6 along each axis, flat slopes included up to 0.5, and
//! above that the share 2c dt/dx − 1 of Δu is kept. With it the vortex keeps 0.960, 0.951 and 0.943. What remains: the pressure in
//! a cell differs from that which acts by ½ dt ρc² times the divergence of its limited slopes, at Mach 0.003 by 5 % of ρu², at Mach 1e-3
//! on 20 × 20 cells by as much as ρu² itself (a smaller step makes it smaller). At porosity jumps the plain solver
//! stands. It is not the default: it costs 10 % of the instructions, the share that stays is no smooth function, and steady flow may go on
//! trembling (a subsonic nozzle along one axis, where no vortex is to be saved, to 1e-4 of its pressure), so along one axis it is the plain one.
//!
//! References: E. F. Toro, *Riemann Solvers and Numerical Methods for Fluid Dynamics*, 3rd ed., ch. 10;
//! P. Batten, N. Clarke, C. Lambert, D. M. Causon, SIAM J. Sci. Comput. 18 (1997) 1553; B. Einfeldt, SIAM J. Numer. Anal. 25 (1988) 294.

use crate::flow::face_gas::FaceGases;
use crate::flow::state::{Primitive, each};
use crate::number::real::Real;

/// What passes a face per unit area and time, in the frame of the face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flux<R, const D: usize> {
    /// Mass.
    pub mass: R,
    /// Momentum: normal (with the pressure), then tangential.
    pub momentum: [R; D],
    /// Total energy; 0 for a barotropic gas.
    pub energy: R,
    /// The part of the normal momentum that is pressure at the face.
    pub pressure: R,
    /// Volume, by which a capacity 1/(gamma − 1) is carried.
    pub velocity: R,
    /// The capacity that it carries, and what diffusion adds to their product.
    pub capacity: [R; 2],
}

impl<R: Real, const D: usize> Flux<R, D> {
    /// The volume that passes, and the capacity that it carries; `through` makes what passes a face of what passes a unit of area.
    #[inline(always)]
    pub(in crate::flow) fn carried(&self, through: impl Fn(R) -> R) -> [R; 2] {
        let volume = through(self.velocity);
        [volume, volume * self.capacity[0] + through(self.capacity[1])]
    }
}

/// Which approximate Riemann solver stands at the faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Riemann {
    /// Three waves: keeps contacts and shear. In two and three dimensions faces along a strong shock have the flux of [`Riemann::Hlle`], without
    /// which it would wander; so have faces of cells that an inclined wall cuts, where a shock passes.
    Hllc,
    /// The same, shocks included, softened where the gas is slow and no sound passes; along one axis the same.
    HllcLowMach,
    /// Two waves: robust, smears contacts.
    Hlle,
    /// One speed: the most diffusive, kindest to slow shocks.
    Rusanov,
}

/// Input of [`Riemann::HllcLowMach`] at a face, beside both states.
#[derive(Clone, Copy, Debug)]
pub struct Slowness<R> {
    /// Pressure at the face less that in the middle of the cell, summed over both sides.
    pub bend: R,
    /// Time step over the width of the cells, times open area over open volume: 1/velocity. Infinite asks for the flux of [`Riemann::Hllc`].
    pub pace: R,
}

mod sealed {
    pub trait Sealed {}
}

/// A solver as a type, so that the loop over a row holds no choice. Those of this crate, no others.
pub trait Solver: sealed::Sealed {
    /// Its name at run time.
    const KIND: Riemann;
    /// It looks at the [`Slowness`] of a face.
    const LOW_MACH: bool = false;
    /// It keeps shear and contacts, and so lets strong shocks wander where nothing else damps them.
    const KEEPS_SHEAR: bool = false;

    /// The flux between two states; `ENERGY` asks for the energy flux.
    fn flux<R: Real, const D: usize, const ENERGY: bool>(
        l: &Primitive<R, D>,
        r: &Primitive<R, D>,
        gas: &impl FaceGases<R>,
    ) -> Flux<R, D>;

    /// The flux in a field that may be slow: beside the faces inside the domain and its walls.
    #[inline(always)]
    fn slow_flux<R: Real, const D: usize, const ENERGY: bool>(
        l: &Primitive<R, D>,
        r: &Primitive<R, D>,
        gas: &impl FaceGases<R>,
        _: Slowness<R>,
    ) -> Flux<R, D> {
        Self::flux::<R, D, ENERGY>(l, r, gas)
    }
}

/// [`Riemann::Hllc`].
#[derive(Clone, Copy, Debug)]
pub struct Hllc;
/// [`Riemann::HllcLowMach`].
#[derive(Clone, Copy, Debug)]
pub struct HllcLowMach;
/// [`Riemann::Hlle`].
#[derive(Clone, Copy, Debug)]
pub struct Hlle;
/// [`Riemann::Rusanov`].
#[derive(Clone, Copy, Debug)]
pub struct Rusanov;

impl sealed::Sealed for Hllc {}

impl Solver for Hllc {
    const KIND: Riemann = Riemann::Hllc;
    const KEEPS_SHEAR: bool = true;

    #[inline(always)]
    fn flux<R: Real, const D: usize, const ENERGY: bool>(
        l: &Primitive<R, D>,
        r: &Primitive<R, D>,
        gas: &impl FaceGases<R>,
    ) -> Flux<R, D> {
        hllc::<R, D, ENERGY>(l, r, gas, |_| R::ZERO)
    }
}

impl sealed::Sealed for HllcLowMach {}

impl Solver for HllcLowMach {
    const KIND: Riemann = Riemann::HllcLowMach;
    const LOW_MACH: bool = true;
    const KEEPS_SHEAR: bool = true;

    #[inline(always)]
    fn flux<R: Real, const D: usize, const ENERGY: bool>(
        l: &Primitive<R, D>,
        r: &Primitive<R, D>,
        gas: &impl FaceGases<R>,
    ) -> Flux<R, D> {
        Hllc::flux::<R, D, ENERGY>(l, r, gas)
    }

    #[inline(always)]
    fn slow_flux<R: Real, const D: usize, const ENERGY: bool>(
        l: &Primitive<R, D>,
        r: &Primitive<R, D>,
        gas: &impl FaceGases<R>,
        slowness: Slowness<R>,
    ) -> Flux<R, D> {
        if D == 1 {
            return Self::flux::<R, D, ENERGY>(l, r, gas);
        }
        hllc::<R, D, ENERGY>(l, r, gas, |waves| softening(l, r, &waves, slowness))
    }
}

/// What is known of the waves at a face before the contact.
struct Waves<R> {
    /// The larger of both sounds.
    sound: R,
    /// Product of what the outer waves sweep over its sum.
    stiffness: R,
}

/// By how much the pressure at a face is raised over that of the Riemann problem, where the gas is slow.
///
/// The Riemann problem lowers the mean of both pressures by the impact zΔu of the streams, z = z_l z_r/(z_l + z_r), z = ρc: of sound a part, of
/// a vortex too much by 1/Mach. A share of the impact stays: the Mach number over [`SLOW`]; 2 (Δp/2zΔu)², which is above 1 in sound and
/// shocks; and 2c dt/dx − 1, without which the half step of Hancock would feed sound. What goes of the impact goes of the slopes of the
/// pressure: with the mean of both cells at the half step nothing grows, without it waves would at steps of half the stable one.
#[inline(always)]
fn softening<R: Real, const D: usize>(
    l: &Primitive<R, D>,
    r: &Primitive<R, D>,
    waves: &Waves<R>,
    Slowness { bend, pace }: Slowness<R>,
) -> R {
    let impact = waves.stiffness * (r.velocity[0] - l.velocity[0]);
    let speed = R::larger(all_speeds(&l.velocity), all_speeds(&r.velocity));
    let (fast, drop) = (R::from_f64(SLOW) * waves.sound, r.pressure - l.pressure);
    // Both shares over one denominator: 2 (½Δp)² is ½Δp².
    let square = impact * impact;
    let share = R::larger(speed * square, fast * (R::HALF * (drop * drop))) / (fast * square);
    // Where nothing meets the share is no number, and becomes 1.
    let share = R::smaller(R::larger(R::TWO * (pace * waves.sound) - R::ONE, share), R::ONE);
    (R::ONE - share) * (impact - R::HALF * bend)
}

/// Sum of the sizes of the velocities, the same for any order of the tangential ones.
#[inline(always)]
fn all_speeds<R: Real, const D: usize>(v: &[R; D]) -> R {
    let tangential = if D == 1 {
        R::ZERO
    } else if D == 2 {
        v[1].abs()
    } else {
        v[1].abs() + v[2].abs()
    };
    v[0].abs() + tangential
}

/// Mach number from which on the impact of two streams at a face is left as it is. Larger: less damping of slow flow, weaker shocks change.
const SLOW: f64 = 0.3;

/// Bounds of the fastest waves: the slower of the left sound wave and of that of the Roe average, and the mirror image.
/// Batten et al. eq. (4.13), Einfeldt eq. (4.4). Between two gases the mean of the squared speeds of sound takes the place of that of the Roe
/// average, raised by the jump of velocity as in that of the larger gamma.
///
/// A shock that stands still has the speed 0 by the Roe average: the flux is that of one side, and what crosses the shock is not damped. Rows of a shock
/// along the grid then settle in different places, with a flow along the shock of 0.2 of the speed before it at Mach 6. So the bound of a slow shock is
/// widened towards the sound wave of the gas behind it, which catches up with every shock (S. F. Davis, SIAM J. Sci. Stat. Comput. 9 (1988) 445); by no
/// more than a shock falls short of [`STANDING`]. Shocks that move faster, expansions, contacts and slow flow keep the bounds above.
#[inline(always)]
fn speeds<R: Real, const D: usize>(l: &Primitive<R, D>, r: &Primitive<R, D>, gas: &impl FaceGases<R>) -> (R, R, R) {
    let (a_sq_l, a_sq_r) = (gas.left().sound_speed_sq(l), gas.right().sound_speed_sq(r));
    // The weights √rho_l and √rho_r, both times √rho_l + √rho_r: one root instead of two, and a sum of weights to divide by.
    let mean = R::smaller(l.density * r.density, R::MAX).sqrt();
    let (weight_l, weight_r) = (l.density + mean, r.density + mean);
    let inv = R::ONE / (weight_l + weight_r);
    let (u_l, u_r) = (l.velocity[0], r.velocity[0]);
    let jump = u_r - u_l;
    let u = (weight_l * u_l + weight_r * u_r) * inv;
    let mixed = (weight_l * a_sq_l + weight_r * a_sq_r) + gas.half_gamma_minus_one() * mean * (jump * jump);
    let a = (mixed * inv).sqrt();
    let (a_l, a_r) = (a_sq_l.sqrt(), a_sq_r.sqrt());
    let (low, high, room) = (u - a, u + a, R::from_f64(STANDING) * a);
    let low = R::smaller(low, R::larger(u_r - a_r, low.abs() - room));
    let high = R::larger(high, R::smaller(u_l + a_l, room - high.abs()));
    (R::smaller(u_l - a_l, low), R::larger(u_r + a_r, high), R::larger(a_l, a_r))
}

/// Speed of a shock from which on the bounds of its waves are not widened, in units of the speed of sound. Larger: shocks that stand within a cell and
/// not at a face begin to part (with twice as much, at Mach 20); smaller: drifting ones are damped less.
const STANDING: f64 = 0.25;

/// Toro sec. 10.4 with the star pressure averaged over both sides, and the flux written as a share of the upwind side
/// plus a share of the star pressure: F = s (F_K − S U_K) + (1 − s) p* (0, 1, 0, 0, S*), s = S* / (S* − S). `raise` is added to p*.
#[inline(always)]
fn hllc<R: Real, const D: usize, const ENERGY: bool>(
    l: &Primitive<R, D>,
    r: &Primitive<R, D>,
    gas: &impl FaceGases<R>,
    raise: impl Fn(Waves<R>) -> R,
) -> Flux<R, D> {
    let (speed_l, speed_r, sound) = speeds(l, r, gas);
    let (u_l, u_r) = (l.velocity[0], r.velocity[0]);
    // Mass swept by the outer waves, Toro eq. (10.37); negative on the left, positive on the right.
    let (swept_l, swept_r) = (l.density * (speed_l - u_l), r.density * (speed_r - u_r));
    let (push, swept) = ((r.pressure - l.pressure) + (swept_l * u_l - swept_r * u_r), swept_l - swept_r);
    let star = push / swept;
    let p_star = R::HALF * ((l.pressure + swept_l * (star - u_l)) + (r.pressure + swept_r * (star - u_r)));
    let p_star = p_star + raise(Waves { sound, stiffness: swept_l * swept_r / swept });
    let p_star = R::larger(p_star, R::ZERO);

    // S* >= 0, since what is swept is negative. Share and side follow from the push, so that nothing waits for S*.
    let from_left = push <= R::ZERO;
    let pick = |a: R, b: R| core::hint::select_unpredictable(from_left, a, b);
    let speed = pick(R::smaller(speed_l, R::ZERO), R::larger(speed_r, R::ZERO));
    let density = pick(l.density, r.density);
    let velocity: [R; D] = each(|c| pick(l.velocity[c], r.velocity[c]));
    let pressure = pick(l.pressure, r.pressure);
    let gap = push - speed * swept;
    let share = push / gap;
    let share = if gap == R::ZERO { R::ONE } else { share };
    let rest = R::ONE - share;

    let upwind = gas.upwind(from_left);
    let relative = velocity[0] - speed;
    let mass = share * (density * relative);
    let mut momentum = [R::ZERO; D];
    momentum[0] = share * (density * velocity[0] * relative + pressure) + rest * p_star;
    for c in 1..D {
        momentum[c] = mass * velocity[c];
    }
    let energy = if ENERGY {
        let total = upwind.energy(&Primitive { density, velocity, pressure });
        share * (total * relative + pressure * velocity[0]) + rest * (p_star * star)
    } else {
        R::ZERO
    };
    let face_pressure = if speed == R::ZERO { pressure } else { p_star };
    let capacity = [upwind.capacity(), R::ZERO];
    // The volume of upwind gas that crosses the face, E. Johnsen and T. Colonius, J. Comput. Phys. 219 (2006) 715: the speed of the contact would jump where an
    // outer wave stands at the face, as at a choked throat, and rounding would choose.
    Flux { mass, momentum, energy, pressure: face_pressure, velocity: share * relative, capacity }
}

/// The mean of two fluxes, a share of their difference, and a diffusion of the jump.
#[inline(always)]
fn blend<R: Real, const D: usize, const ENERGY: bool>(
    l: &Primitive<R, D>,
    r: &Primitive<R, D>,
    gas: &impl FaceGases<R>,
    lean: R,
    diffusion: R,
) -> Flux<R, D> {
    let mix = |f_l: R, f_r: R, u_l: R, u_r: R| {
        R::HALF * (f_l + f_r) + (R::HALF * lean * (f_l - f_r) - diffusion * (u_r - u_l))
    };
    let (m_l, m_r) = (l.density * l.velocity[0], r.density * r.velocity[0]);
    let mass = mix(m_l, m_r, l.density, r.density);
    let pressure = mix(l.pressure, r.pressure, R::ZERO, R::ZERO);
    let mut momentum = [R::ZERO; D];
    for c in 0..D {
        momentum[c] =
            mix(m_l * l.velocity[c], m_r * r.velocity[c], l.density * l.velocity[c], r.density * r.velocity[c]);
    }
    momentum[0] += pressure;
    let energy = if ENERGY {
        let (e_l, e_r) = (gas.left().energy(l), gas.right().energy(r));
        mix((e_l + l.pressure) * l.velocity[0], (e_r + r.pressure) * r.velocity[0], e_l, e_r)
    } else {
        R::ZERO
    };
    // The same for the capacity, taken apart into that of the mean of both sides and what their difference adds.
    let (u_l, u_r) = (l.velocity[0], r.velocity[0]);
    let velocity = mix(u_l, u_r, R::ZERO, R::ZERO);
    let (c_l, c_r) = (gas.left().capacity(), gas.right().capacity());
    let half = R::HALF * (c_r - c_l);
    let capacity = [R::HALF * (c_l + c_r), mix(-half * u_l, half * u_r, -half, half)];
    Flux { mass, momentum, energy, pressure, velocity, capacity }
}

impl sealed::Sealed for Hlle {}

impl Solver for Hlle {
    const KIND: Riemann = Riemann::Hlle;

    /// Toro eq. (10.21), regrouped about the mean of both fluxes.
    #[inline(always)]
    fn flux<R: Real, const D: usize, const ENERGY: bool>(
        l: &Primitive<R, D>,
        r: &Primitive<R, D>,
        gas: &impl FaceGases<R>,
    ) -> Flux<R, D> {
        let (speed_l, speed_r, _) = speeds(l, r, gas);
        let (low, high) = (R::smaller(speed_l, R::ZERO), R::larger(speed_r, R::ZERO));
        let span = high - low;
        let inv = if span > R::ZERO { R::ONE / span } else { R::ZERO };
        blend::<R, D, ENERGY>(l, r, gas, (high + low) * inv, -(high * low) * inv)
    }
}

impl sealed::Sealed for Rusanov {}

impl Solver for Rusanov {
    const KIND: Riemann = Riemann::Rusanov;

    /// Toro eq. (10.42): the mean of both sides less the fastest wave times half the jump.
    #[inline(always)]
    fn flux<R: Real, const D: usize, const ENERGY: bool>(
        l: &Primitive<R, D>,
        r: &Primitive<R, D>,
        gas: &impl FaceGases<R>,
    ) -> Flux<R, D> {
        let fastest = |w: &Primitive<R, D>, sound: R| w.velocity[0].abs() + sound;
        let speed = R::larger(fastest(l, gas.left().sound_speed(l)), fastest(r, gas.right().sound_speed(r)));
        blend::<R, D, ENERGY>(l, r, gas, R::ZERO, R::HALF * speed)
    }
}
