//! Gas, and the state of one cell in its two forms.
//!
//! The velocity has as many components as the problem has live dimensions: nothing is stored for a dead one.
//! Every gas here obeys rho a² = gamma p (isothermal: gamma = 1), so waves and slopes need one text for all three;
//! the gases differ in where the pressure comes from.

use crate::number::real::Real;

/// One value per axis or lane. As [`core::array::from_fn`], by a loop that compilers unroll before they look for vectors: with the
/// other they do so or not by how a program is put together.
#[inline(always)]
pub(crate) fn each<R: Real, const N: usize>(f: impl Fn(usize) -> R) -> [R; N] {
    let mut values = [R::ZERO; N];
    for i in 0..N {
        values[i] = f(i);
    }
    values
}

/// Sum of one term per axis, the same bits in any order of the axes: extremes first, then the middle one.
#[inline(always)]
pub(crate) fn sum<R: Real, const D: usize>(t: [R; D]) -> R {
    if D == 1 {
        t[0]
    } else if D == 2 {
        t[0] + t[1]
    } else {
        // A selection takes its second number if one is NaN: in this order each of the three reaches the sum.
        let (low, high) = (R::smaller(t[0], t[1]), R::larger(t[1], t[0]));
        let middle = R::larger(low, R::smaller(high, t[2]));
        (R::smaller(t[2], low) + R::larger(t[2], high)) + middle
    }
}

/// The product of two vectors, the same bits in any order of the axes.
#[inline(always)]
pub(crate) fn dot<R: Real, const D: usize>(a: [R; D], b: [R; D]) -> R {
    sum::<R, D>(core::array::from_fn(|c| a[c] * b[c]))
}

/// The components of a vector as seen from axis `d`: the normal one first, then the others in cyclic order.
#[inline(always)]
pub(crate) fn rotate<T: Copy, const D: usize>(v: [T; D], d: usize) -> [T; D] {
    core::array::from_fn(|c| v[(c + d) % D])
}

/// The inverse of [`rotate`].
#[inline(always)]
pub(crate) fn rotate_back<T: Copy, const D: usize>(v: [T; D], d: usize) -> [T; D] {
    core::array::from_fn(|c| v[(c + D - d) % D])
}

/// Pore averages as the Riemann solver sees them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Primitive<R, const D: usize> {
    /// Mass per open volume.
    pub density: R,
    /// Velocity in the pores.
    pub velocity: [R; D],
    /// Pressure.
    pub pressure: R,
}

impl<R: Copy, const D: usize, const L: usize> Primitive<[R; L], D> {
    /// One of several states side by side.
    #[inline(always)]
    pub(crate) fn lane(&self, i: usize) -> Primitive<R, D> {
        let velocity = core::array::from_fn(|c| self.velocity[c][i]);
        Primitive { density: self.density[i], velocity, pressure: self.pressure[i] }
    }

    /// Writes one of them.
    #[inline(always)]
    pub(crate) fn set_lane(&mut self, i: usize, w: &Primitive<R, D>) {
        self.density[i] = w.density;
        for c in 0..D {
            self.velocity[c][i] = w.velocity[c];
        }
        self.pressure[i] = w.pressure;
    }
}

/// Pore averages that the equations conserve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conserved<R, const D: usize> {
    /// Mass per open volume.
    pub density: R,
    /// Momentum per open volume.
    pub momentum: [R; D],
    /// Total energy per open volume; 0 for a barotropic gas.
    pub energy: R,
}

impl<R: Real, const D: usize> Conserved<R, D> {
    /// Adds another amount.
    pub(crate) fn add(&mut self, other: &Self) {
        self.density += other.density;
        self.energy += other.energy;
        for c in 0..D {
            self.momentum[c] += other.momentum[c];
        }
    }
}

/// A capacity beyond its bounds by at most this many ε of the upper one is rounding and put back; farther out it stays, and the cell is unphysical.
/// Larger: less of what a bad step does is seen.
const ROUNDINGS: f64 = 64.0;

/// Where the pressure comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Gas<R> {
    /// p = (gamma − 1) rho e, with an energy equation.
    Ideal {
        /// Ratio of specific heats, above 1.
        gamma: R,
    },
    /// p = c² rho, mass and momentum only.
    Isothermal {
        /// The speed of sound c.
        sound_speed: R,
    },
    /// p = p0 (rho/rho0)^gamma, mass and momentum only.
    Isentropic {
        /// Ratio of specific heats, above 1.
        gamma: R,
        /// Density rho0 of the reference state.
        density: R,
        /// Pressure p0 of the reference state.
        pressure: R,
    },
    /// p = (gamma − 1) rho e with a gamma that goes along with the gas: burnt gas in fresh gas. A field holds `capacity`, 1/(gamma − 1), of each
    /// cell; the gas of a cell is [`Gas::at`].
    Mixed {
        /// Lowest and highest ratio of specific heats, above 1.
        gammas: [R; 2],
    },
}

impl<R: Real> Gas<R> {
    /// The gas carries an energy equation.
    #[inline(always)]
    pub fn has_energy(self) -> bool {
        matches!(self, Gas::Ideal { .. } | Gas::Mixed { .. })
    }

    /// Each cell has a ratio of specific heats of its own.
    #[inline(always)]
    pub fn is_mixed(self) -> bool {
        matches!(self, Gas::Mixed { .. })
    }

    /// rho a² / p; the lowest of a mixed gas.
    #[inline(always)]
    pub fn gamma(self) -> R {
        match self {
            Gas::Ideal { gamma } | Gas::Isentropic { gamma, .. } | Gas::Mixed { gammas: [gamma, _] } => gamma,
            Gas::Isothermal { .. } => R::ONE,
        }
    }

    /// 1/(gamma − 1): the heat capacity at constant volume over the gas constant, and the internal energy per volume over the pressure.
    #[inline(always)]
    pub fn capacity(self) -> R {
        R::ONE / (self.gamma() - R::ONE)
    }

    /// Lowest and highest capacity of a cell.
    pub(in crate::flow) fn capacities(self) -> [R; 2] {
        match self {
            Gas::Mixed { gammas: [low, high] } => [R::ONE / (high - R::ONE), R::ONE / (low - R::ONE)],
            _ => [self.capacity(); 2],
        }
    }

    /// A capacity that left the bounds by rounding, put back to them; any other as it is.
    #[inline(always)]
    pub(in crate::flow) fn within_bounds(self, capacity: R) -> R {
        let [least, most] = self.capacities();
        let inside = capacity.limited(least, most);
        if (capacity - inside).abs() <= R::from_f64(ROUNDINGS) * R::EPSILON * most { inside } else { capacity }
    }

    /// The gas in a cell of this capacity: of a mixed gas an ideal one, else this gas.
    #[inline(always)]
    #[must_use]
    pub fn at(self, capacity: R) -> Self {
        match self {
            Gas::Mixed { .. } => Gas::Ideal { gamma: R::ONE + R::ONE / capacity },
            _ => self,
        }
    }

    /// All numbers are positive and finite, the ratio of specific heats above 1.
    pub(in crate::flow) fn is_sound(self) -> bool {
        let positive = |x: R| x > R::ZERO && x.is_finite();
        match self {
            Gas::Ideal { gamma } => gamma > R::ONE && gamma.is_finite(),
            Gas::Mixed { gammas: [low, high] } => low > R::ONE && low <= high && high.is_finite(),
            Gas::Isothermal { sound_speed } => positive(sound_speed),
            Gas::Isentropic { gamma, density, pressure } => {
                gamma > R::ONE && gamma.is_finite() && positive(density) && positive(pressure)
            }
        }
    }

    /// Pressure of a barotropic gas; of an ideal gas from its internal energy per volume; of a mixed gas where gamma is lowest.
    #[inline(always)]
    pub fn pressure(self, density: R, internal: R) -> R {
        match self {
            Gas::Ideal { gamma } | Gas::Mixed { gammas: [gamma, _] } => (gamma - R::ONE) * internal,
            Gas::Isothermal { sound_speed } => sound_speed * sound_speed * density,
            // NaN for a negative density, which the caller's check for positive states finds.
            Gas::Isentropic { gamma, density: rho0, pressure: p0 } => p0 * (density / rho0).pow(gamma),
        }
    }

    /// Speed of sound.
    #[inline(always)]
    pub fn sound_speed<const D: usize>(self, w: &Primitive<R, D>) -> R {
        (self.gamma() * w.pressure / w.density).sqrt()
    }

    /// Density of a barotropic gas at a pressure; `None` for an ideal gas, which has two degrees of freedom.
    pub fn density(self, pressure: R) -> Option<R> {
        match self {
            Gas::Ideal { .. } | Gas::Mixed { .. } => None,
            Gas::Isothermal { sound_speed } => Some(pressure / (sound_speed * sound_speed)),
            Gas::Isentropic { gamma, density, pressure: p0 } => Some(density * (pressure / p0).pow(R::ONE / gamma)),
        }
    }

    /// The primitive form of a cell. Of a mixed gas ask [`Gas::at`].
    #[inline(always)]
    pub fn primitive<const D: usize>(self, u: &Conserved<R, D>) -> Primitive<R, D> {
        let velocity = u.momentum.map(|m| m / u.density);
        let kinetic = R::HALF * sum::<R, D>(core::array::from_fn(|c| u.momentum[c] * velocity[c]));
        Primitive { density: u.density, velocity, pressure: self.pressure(u.density, u.energy - kinetic) }
    }

    /// The conserved form of a state; a barotropic gas ignores the pressure. Of a mixed gas ask [`Gas::at`].
    #[inline(always)]
    pub fn conserved<const D: usize>(self, w: &Primitive<R, D>) -> Conserved<R, D> {
        let momentum = w.velocity.map(|v| w.density * v);
        let energy = match self {
            Gas::Ideal { gamma } | Gas::Mixed { gammas: [gamma, _] } => {
                let kinetic = R::HALF * sum::<R, D>(core::array::from_fn(|c| momentum[c] * w.velocity[c]));
                w.pressure / (gamma - R::ONE) + kinetic
            }
            _ => R::ZERO,
        };
        Conserved { density: w.density, momentum, energy }
    }
}

/// A field of conserved variables: one slice per variable, x fastest.
#[derive(Clone, Copy, Debug)]
pub struct Fields<'a, R, const D: usize> {
    /// Mass per open volume.
    pub density: &'a [R],
    /// Momentum per open volume.
    pub momentum: [&'a [R]; D],
    /// Total energy per open volume; empty for a barotropic gas.
    pub energy: &'a [R],
    /// 1/(gamma − 1) of a [`Gas::Mixed`]; else empty.
    pub capacity: &'a [R],
}

impl<R: Real, const D: usize> Fields<'_, R, D> {
    /// The cell at a flat index; `None` beyond the end of a variable.
    pub fn get(&self, cell: usize) -> Option<Conserved<R, D>> {
        let inside = cell < self.density.len() && self.momentum.iter().all(|m| cell < m.len());
        inside.then(|| self.at(cell))
    }

    /// The cell at a flat index.
    #[inline(always)]
    pub(in crate::flow) fn at(&self, cell: usize) -> Conserved<R, D> {
        Conserved {
            density: self.density[cell],
            momentum: self.momentum.map(|m| m[cell]),
            energy: self.energy.get(cell).copied().unwrap_or(R::ZERO),
        }
    }

    /// The gas of the cell at a flat index: that of its capacity, if `gas` is mixed.
    #[inline(always)]
    pub fn gas_at(&self, gas: Gas<R>, cell: usize) -> Gas<R> {
        self.capacity.get(cell).map_or(gas, |&capacity| gas.at(capacity))
    }
}

/// The same, to be written.
#[derive(Debug)]
pub struct FieldsMut<'a, R, const D: usize> {
    /// Mass per open volume.
    pub density: &'a mut [R],
    /// Momentum per open volume.
    pub momentum: [&'a mut [R]; D],
    /// Total energy per open volume; empty for a barotropic gas.
    pub energy: &'a mut [R],
    /// 1/(gamma − 1) of a [`Gas::Mixed`]; else empty.
    pub capacity: &'a mut [R],
}

impl<'a, R: Real, const D: usize> FieldsMut<'a, R, D> {
    /// A shorter loan of the same field.
    pub fn reborrow(&mut self) -> FieldsMut<'_, R, D> {
        FieldsMut {
            density: &mut *self.density,
            momentum: self.momentum.each_mut().map(|m| &mut **m),
            energy: &mut *self.energy,
            capacity: &mut *self.capacity,
        }
    }

    /// The same field, to be read.
    pub fn as_fields(&self) -> Fields<'_, R, D> {
        Fields {
            density: self.density,
            momentum: self.momentum.each_ref().map(|m| &**m),
            energy: self.energy,
            capacity: self.capacity,
        }
    }

    /// Cells before `cell` (all, if there are fewer), and the rest: how a caller cuts a field into slabs for its threads.
    pub fn split_at(self, cell: usize) -> (Self, Self) {
        fn cut<R>(s: &mut [R], cell: usize) -> (&mut [R], &mut [R]) {
            s.split_at_mut(cell.min(s.len()))
        }
        let (d0, d1) = cut(self.density, cell);
        let (e0, e1) = cut(self.energy, cell);
        let (c0, c1) = cut(self.capacity, cell);
        let mut low = [const { None }; D];
        let mut high = [const { None }; D];
        for (c, m) in self.momentum.into_iter().enumerate() {
            let (a, b) = cut(m, cell);
            low[c] = Some(a);
            high[c] = Some(b);
        }
        let part = |a: [Option<&'a mut [R]>; D]| a.map(|s| s.unwrap_or_default());
        (
            FieldsMut { density: d0, momentum: part(low), energy: e0, capacity: c0 },
            FieldsMut { density: d1, momentum: part(high), energy: e1, capacity: c1 },
        )
    }

    /// The cell at a flat index.
    #[inline(always)]
    pub(in crate::flow) fn at(&self, cell: usize) -> Conserved<R, D> {
        Conserved {
            density: self.density[cell],
            momentum: core::array::from_fn(|c| self.momentum[c][cell]),
            energy: self.energy.get(cell).copied().unwrap_or(R::ZERO),
        }
    }

    /// Writes the cell at a flat index; of a field that ends before, nothing.
    #[inline(always)]
    pub fn set(&mut self, cell: usize, u: &Conserved<R, D>) {
        let variables = self.momentum.iter_mut().zip(&u.momentum).map(|(s, value)| (&mut **s, value));
        for (s, value) in variables.chain([(&mut *self.density, &u.density), (&mut *self.energy, &u.energy)]) {
            if let Some(s) = s.get_mut(cell) {
                *s = *value;
            }
        }
    }
}
