//! The six sides of the domain, each a ghost state that meets the Riemann solver.
//!
//! In the frame of the side: normal velocity first, positive out of the domain.
//! Reference: E. F. Toro, *Riemann Solvers and Numerical Methods for Fluid Dynamics*, 3rd ed., sec. 6.3; the invariants are those
//! of simple waves, sec. 3.1.

use crate::flow::state::{Gas, Primitive, rotate, rotate_back};
use crate::number::real::Real;

/// What stands outside one side of the domain.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Boundary<R, const D: usize> {
    /// The opposite side; must stand on both.
    Periodic,
    /// A wall without friction.
    Wall,
    /// The same state as inside: waves leave, steady flow drifts.
    ZeroGradient,
    /// A given state; the Riemann solver lets waves leave and the state enter.
    FarField(Primitive<R, D>),
    /// Gas of a given velocity and density enters. The pressure is that of a far field which the caller lets follow the flow
    /// with [`Boundary::relaxed`], so the velocity is met over a few crossings and waves still leave.
    Inlet(Primitive<R, D>),
    /// Gas leaves against a given pressure; a supersonic stream does not feel it.
    Outlet {
        /// Static pressure outside.
        pressure: R,
    },
    /// Gas enters from rest: entropy and total enthalpy are given, the wave that leaves comes from inside.
    Reservoir {
        /// Stagnation density.
        density: R,
        /// Stagnation pressure.
        pressure: R,
    },
}

/// A part of a side of the domain where something else stands than on the rest of it: a vent, an opening, a nozzle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch<R, const D: usize> {
    /// The axis of the side.
    pub axis: usize,
    /// Its high side, else the low one.
    pub high: bool,
    /// Indices of the first cell beside the patch along each axis; along its own axis they do not count.
    pub first: [usize; D],
    /// One past the last, likewise.
    pub end: [usize; D],
    /// What stands there; not [`Boundary::Periodic`].
    pub boundary: Boundary<R, D>,
}

/// The ratio of specific heats of the gas that a side feeds, where the gas is mixed: of a far field or an inlet. What comes back through other sides is
/// what stands inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Feed<'a, R, const D: usize> {
    /// Low and high side of each axis.
    pub sides: [[R; 2]; D],
    /// Of each patch; if empty, the lowest of the gas.
    pub patches: &'a [R],
}

impl<R: Real, const D: usize> Patch<R, D> {
    /// The patch stands beside a cell on a side of an axis.
    pub fn covers(&self, axis: usize, high: bool, at: [usize; D]) -> bool {
        let within = |a: usize| a == axis || (self.first[a] <= at[a] && at[a] < self.end[a]);
        self.axis == axis && self.high == high && (0..D).all(within)
    }
}

impl<R: Real, const D: usize> Boundary<R, D> {
    /// What stands outside is a state of the gas: its density and pressure (of a gas without energy its density alone) are positive, all numbers finite.
    pub(in crate::flow) fn is_sound(&self, gas: Gas<R>) -> bool {
        let [density, pressure] = match self {
            Boundary::Periodic | Boundary::Wall | Boundary::ZeroGradient => return true,
            Boundary::FarField(w) | Boundary::Inlet(w) => {
                if !w.velocity.iter().all(|u| u.is_finite()) {
                    return false;
                }
                [w.density, if gas.has_energy() { w.pressure } else { w.density }]
            }
            Boundary::Outlet { pressure } => [*pressure; 2],
            Boundary::Reservoir { density, pressure } => {
                [*density, if gas.has_energy() { *pressure } else { *density }]
            }
        };
        density > R::ZERO && pressure > R::ZERO && density.is_finite() && pressure.is_finite()
    }

    /// Nothing flows through.
    pub fn is_wall(&self) -> bool {
        match self {
            Boundary::Wall => true,
            Boundary::Periodic
            | Boundary::ZeroGradient
            | Boundary::FarField(_)
            | Boundary::Inlet(_)
            | Boundary::Outlet { .. }
            | Boundary::Reservoir { .. } => false,
        }
    }

    /// What leaves comes in at the opposite side.
    pub fn is_periodic(&self) -> bool {
        match self {
            Boundary::Periodic => true,
            Boundary::Wall
            | Boundary::ZeroGradient
            | Boundary::FarField(_)
            | Boundary::Inlet(_)
            | Boundary::Outlet { .. }
            | Boundary::Reservoir { .. } => false,
        }
    }

    /// The ghost state is that of the cell inside, but for the sign of a velocity: under gravity it lacks the weight of the gas between them.
    pub(crate) fn copies_inside(&self) -> bool {
        match self {
            Boundary::Wall | Boundary::ZeroGradient => true,
            Boundary::Periodic
            | Boundary::FarField(_)
            | Boundary::Inlet(_)
            | Boundary::Outlet { .. }
            | Boundary::Reservoir { .. } => false,
        }
    }

    /// A given gas may enter here.
    pub(crate) fn feeds(&self) -> bool {
        match self {
            Boundary::FarField(_) | Boundary::Inlet(_) => true,
            Boundary::Periodic
            | Boundary::Wall
            | Boundary::ZeroGradient
            | Boundary::Outlet { .. }
            | Boundary::Reservoir { .. } => false,
        }
    }

    /// The ghost state beside an inner state, both in the frame of axis `d`; `low` is the low side of the axis. Periodic
    /// sides have no ghost of their own: the inner state comes back.
    pub(crate) fn ghost_face(&self, inner: &Primitive<R, D>, d: usize, low: bool, gas: Gas<R>) -> Primitive<R, D> {
        let outward = |f: &dyn Fn(Primitive<R, D>) -> Primitive<R, D>| {
            let turn = |mut w: Primitive<R, D>| {
                if low {
                    w.velocity[0] = -w.velocity[0];
                }
                w
            };
            turn(f(turn(*inner)))
        };
        match self {
            Boundary::Periodic | Boundary::ZeroGradient => *inner,
            Boundary::FarField(outer) | Boundary::Inlet(outer) => {
                let pressure = stated(outer.density, outer.pressure, gas);
                Primitive { velocity: rotate(outer.velocity, d), pressure, ..*outer }
            }
            Boundary::Wall => {
                let mut w = *inner;
                w.velocity[0] = -w.velocity[0];
                w
            }
            Boundary::Outlet { pressure } => outward(&|w| outlet(w, *pressure, gas)),
            Boundary::Reservoir { density, pressure } => {
                outward(&|w| reservoir(w, *density, stated(*density, *pressure, gas), gas))
            }
        }
    }

    /// The state that stands beside an inner one at the low or high side of axis `d`, velocities along x, y, z; behind a periodic side the inner one.
    pub fn ghost_cell(&self, inner: &Primitive<R, D>, d: usize, low: bool, gas: Gas<R>) -> Primitive<R, D> {
        let turned = Primitive { velocity: rotate(inner.velocity, d), ..*inner };
        let ghost = self.ghost_face(&turned, d, low, gas);
        Primitive { velocity: rotate_back(ghost.velocity, d), ..ghost }
    }

    /// An inlet whose pressure has followed the flow for one step, so that the velocity just inside tends to the wanted one.
    ///
    /// `velocity` is the mean normal velocity inside, out of the domain negative (that is, counted in the direction of the
    /// wanted velocity); `share` = dt over the time in which the difference should vanish. At least a tenth of the pressure is left. Other sides come back
    /// unchanged.
    pub fn relaxed(self, d: usize, velocity: R, sound_speed: R, share: R) -> Self {
        let Boundary::Inlet(mut w) = self else { return self };
        let impedance = w.density * sound_speed;
        let wanted = w.velocity.get(d).map_or(velocity, |v| v.abs());
        let least = R::from_f64(0.1) * w.pressure;
        w.pressure = R::larger(w.pressure + share * impedance * (wanted - velocity), least);
        Boundary::Inlet(w)
    }
}

/// The pressure of gas outside: of a gas without energy that of its density, whatever is given.
fn stated<R: Real>(density: R, pressure: R, gas: Gas<R>) -> R {
    if gas.has_energy() { pressure } else { gas.pressure(density, R::ZERO) }
}

/// The state that a simple wave from outside makes of `w` when it brings the pressure to `pressure`.
pub(in crate::flow) fn outlet<R: Real, const D: usize>(
    w: Primitive<R, D>,
    pressure: R,
    gas: Gas<R>,
) -> Primitive<R, D> {
    let c = gas.sound_speed(&w);
    let v = w.velocity[0];
    if !(v < c) || pressure == w.pressure {
        return w;
    }
    let gamma = gas.gamma();
    let density = w.density * (pressure / w.pressure).pow(R::ONE / gamma);
    let mut velocity = w.velocity;
    velocity[0] = match gas {
        Gas::Isothermal { .. } => v + c * (w.density / density).ln(),
        _ => v - rise_of_sound(pressure / w.pressure, c, gamma),
    };
    Primitive { density, velocity, pressure }
}

/// Where the stream from a reservoir meets the gas inside: it enters at the speed s at which both have one pressure and one velocity. The stream has come to
/// that pressure from rest at constant entropy and total enthalpy, the gas inside by the wave that runs into the domain. At most it enters at its speed of sound.
// Called, not inlined: it would lie in the frame of every row's ghosts.
#[inline(never)]
fn reservoir<R: Real, const D: usize>(w: Primitive<R, D>, density0: R, pressure0: R, gas: Gas<R>) -> Primitive<R, D> {
    let stream = Stream { density0, pressure0, gas };
    // By how much the stream enters faster than the gas inside retreats from it, and how fast that grows with s.
    let excess = |s: R| {
        let [density, pressure] = stream.at(s);
        let [rise, slope] = rise_of_velocity(&w, pressure, gas);
        [s + w.velocity[0] - rise, R::ONE + slope * density * s]
    };
    if !(excess(R::ZERO)[0] < R::ZERO) {
        return outlet(w, pressure0, gas);
    }
    let (mut low, mut high) = (R::ZERO, stream.sonic());
    let mut entering = high;
    if excess(high)[0] > R::ZERO {
        // The excess rises with s: Newton's steps, or halves where one leads out of what is left.
        for _ in 0..MOST_STEPS {
            let [value, slope] = excess(entering);
            if value > R::ZERO {
                high = entering;
            } else {
                low = entering;
            }
            let next = entering - value / slope;
            let next = if low <= next && next <= high { next } else { R::HALF * (low + high) };
            let is_known = (next - entering).abs() <= R::TWO * R::EPSILON * stream.sonic();
            entering = next;
            if is_known {
                break;
            }
        }
    }
    let [density, pressure] = stream.at(entering);
    let mut velocity = [R::ZERO; D];
    velocity[0] = -entering;
    Primitive { density, velocity, pressure }
}

/// Far more steps than the speed of entry takes.
const MOST_STEPS: usize = 64;

/// Gas from rest, at constant entropy and total enthalpy.
struct Stream<R> {
    density0: R,
    pressure0: R,
    gas: Gas<R>,
}

impl<R: Real> Stream<R> {
    /// The speed at which the stream is as fast as its sound.
    fn sonic(&self) -> R {
        match self.gas {
            Gas::Isothermal { sound_speed } => sound_speed,
            gas => (R::TWO * gas.gamma() / (gas.gamma() + R::ONE) * self.pressure0 / self.density0).sqrt(),
        }
    }

    /// Density and pressure at a speed, up to the sonic one.
    fn at(&self, speed: R) -> [R; 2] {
        let kinetic = R::HALF * speed * speed * self.density0 / self.pressure0;
        if let Gas::Isothermal { .. } = self.gas {
            let share = (-kinetic).exp();
            return [self.density0 * share, self.pressure0 * share];
        }
        let m = self.gas.gamma() - R::ONE;
        let t = R::ONE - m / self.gas.gamma() * kinetic;
        let share = t.pow(R::ONE / m);
        [self.density0 * share, self.pressure0 * (share * t)]
    }
}

/// By how much a wave that runs into the gas lowers its velocity in the opposite direction when it brings it to a pressure, and how fast that grows with
/// the pressure: of a shock or a rarefaction (Toro sec. 4.2), of gases without energy that of a simple wave.
fn rise_of_velocity<R: Real, const D: usize>(w: &Primitive<R, D>, pressure: R, gas: Gas<R>) -> [R; 2] {
    let c = gas.sound_speed(w);
    if let Gas::Isothermal { .. } = gas {
        return [c * (pressure / w.pressure).ln(), c / pressure];
    }
    let gamma = gas.gamma();
    let m = gamma - R::ONE;
    if gas.has_energy() && pressure > w.pressure {
        let sum = pressure + m / (gamma + R::ONE) * w.pressure;
        let root = (R::TWO / ((gamma + R::ONE) * w.density * sum)).sqrt();
        let step = pressure - w.pressure;
        return [step * root, root * (R::ONE - R::HALF * step / sum)];
    }
    let share = (pressure / w.pressure).pow(R::HALF * m / gamma);
    [rise_of_sound(pressure / w.pressure, c, gamma), c * share / (gamma * pressure)]
}

/// 2/(γ − 1) times the rise of the speed of sound from `c` when a simple wave changes the pressure by a factor: to the last digits, however near γ is to 1.
fn rise_of_sound<R: Real>(factor: R, c: R, gamma: R) -> R {
    let m = gamma - R::ONE;
    R::TWO * c / m * (R::HALF * m / gamma * factor.ln()).exp_m1()
}
