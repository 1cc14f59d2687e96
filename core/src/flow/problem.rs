//! The problem: mesh, gas, boundaries, porosity, drag and the choices of the scheme; its contracts, and the rate of its signals.

use crate::flow::boundary::Boundary;
use crate::flow::drag::Drag;
use crate::flow::error::{Error, fits};
use crate::flow::limiter::Limiter;
use crate::flow::porosity::areas::Ducts;
use crate::flow::porosity::clusters::{Clusters, least_volume};
use crate::flow::porosity::fractions::{Medium, Mesh, Porosity, SMALL_SHARE};
use crate::flow::riemann::Riemann;
use crate::flow::state::{Conserved, Fields, Gas, sum};
use crate::number::real::Real;

/// How the pressure acts in a cell whose faces are not as open as its volume.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PressureForm {
    /// `beta_f p` on the faces and the cell's own pressure on the walls inside it; in smooth media −beta_f grad p.
    Geometric,
    /// The paper's −beta_v grad p. Where `beta_v` differs from the faces it makes entropy at the rate (beta_v − beta_f) u dp/dx.
    Paper,
}

/// The choices of the scheme.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scheme {
    /// Riemann solver at the faces.
    pub riemann: Riemann,
    /// Limiter of the slopes.
    pub limiter: Limiter,
    /// Form of the pressure force in a porous medium.
    pub pressure: PressureForm,
}

impl Default for Scheme {
    fn default() -> Self {
        Scheme { riemann: Riemann::Hllc, limiter: Limiter::Steep, pressure: PressureForm::Geometric }
    }
}

/// Everything that stays the same during a step.
#[derive(Clone, Copy, Debug)]
pub struct Problem<'a, R, const D: usize> {
    /// Cells and widths.
    pub mesh: Mesh<'a, R, D>,
    /// The gas.
    pub gas: Gas<R>,
    /// Low and high side of each axis.
    pub boundaries: [[Boundary<R, D>; 2]; D],
    /// Choices of the scheme.
    pub scheme: Scheme,
    /// Open fractions; without them nothing is read.
    pub porosity: Option<Porosity<'a, R, D>>,
    /// Clusters of small cells, from [`crate::flow::porosity::clusters::clusters`]; empty for none.
    pub clusters: Clusters<'a>,
    /// Drag of sub-grid obstacles.
    pub drag: Option<Drag<'a, R, D>>,
    /// Acceleration of gravity; zero costs nothing.
    pub gravity: [R; D],
}

impl<R: Real, const D: usize> Problem<'_, R, D> {
    /// Checks the contracts between the slices once.
    pub fn check(&self) -> Result<(), Error> {
        let n = self.mesh.len();
        for d in 0..D {
            if (self.boundaries[d][0] == Boundary::Periodic) != (self.boundaries[d][1] == Boundary::Periodic) {
                return Err(Error::HalfPeriodic { axis: d });
            }
        }
        let positive = |x: R| x > R::ZERO && x.is_finite();
        for (axis, widths) in self.mesh.widths.iter().enumerate() {
            if let Some(cell) = widths.iter().position(|&w| !positive(w)) {
                return Err(Error::Width { axis, cell });
            }
        }
        let gas = match self.gas {
            Gas::Ideal { gamma } => gamma > R::ONE && gamma.is_finite(),
            Gas::Isothermal { sound_speed } => positive(sound_speed),
            Gas::Isentropic { gamma, density, pressure } => {
                gamma > R::ONE && gamma.is_finite() && positive(density) && positive(pressure)
            }
        };
        if !gas {
            return Err(Error::Gas);
        }
        if let Some(entry) = self.clusters.cells().position(|cell| cell >= n) {
            return Err(Error::Cluster { entry });
        }
        if let Some(p) = &self.porosity {
            fits(n, p.volume.len())?;
            fits(n, p.marks.len())?;
            for d in 0..D {
                fits(self.mesh.faces(d), p.faces[d].len())?;
            }
        }
        if let Some(drag) = &self.drag {
            for s in drag.quadratic.iter().chain(&drag.linear) {
                if !s.is_empty() {
                    fits(n, s.len())?;
                }
            }
        }
        Ok(())
    }

    /// Positive density and pressure, all finite.
    pub fn is_physical(&self, u: &Conserved<R, D>) -> bool {
        let w = self.gas.primitive(u);
        let finite = u.momentum.iter().all(|m| m.is_finite()) && u.density.is_finite() && w.pressure.is_finite();
        finite && u.density > R::ZERO && w.pressure > R::ZERO
    }

    /// The axis has periodic ends.
    pub fn periodic(&self) -> [bool; D] {
        self.boundaries.map(|b| b[0] == Boundary::Periodic)
    }

    pub(in crate::flow) fn check_fields(&self, old: &Fields<'_, R, D>) -> Result<(), Error> {
        self.check()?;
        self.fits(old, self.mesh.len())
    }

    pub(in crate::flow) fn fits(&self, f: &Fields<'_, R, D>, expected: usize) -> Result<(), Error> {
        let energy = if self.gas.has_energy() { f.energy.len() } else { expected };
        let lengths = f.momentum.iter().map(|m| m.len()).chain([f.density.len(), energy]);
        lengths.into_iter().try_for_each(|found| fits(expected, found))
    }

    /// Signal rate of one cell, jumps and merging included.
    pub(in crate::flow) fn cell_rate(&self, u: &Conserved<R, D>, cell: usize) -> R {
        let w = self.gas.primitive(u);
        let c = self.gas.sound_speed(&w);
        let at = self.mesh.coordinates(cell);
        sum::<R, D>(core::array::from_fn(|d| {
            let t = (w.velocity[d].abs() + c) / self.mesh.widths[d][at[d]];
            match self.porosity {
                None => t,
                Some(porosity) => {
                    let medium = Medium { mesh: self.mesh, porosity };
                    let periodic = self.boundaries[d][0] == Boundary::Periodic;
                    t * self.openness(&medium.ducts(d, at, periodic), 0)
                }
            }
        }))
    }

    /// Open area over open volume of a cell along the axis of its ducts, as far as it limits the step.
    #[inline(always)]
    pub(in crate::flow) fn openness(&self, ducts: &Ducts<'_, R>, i: usize) -> R {
        let (low, high) = ducts.passages(i);
        let ratio = R::larger(low, high) / R::larger(ducts.volume(i), least_volume());
        if self.clusters.0.is_empty() || !ducts.is_small(i) {
            return ratio;
        }
        // A cluster holds its share of the volume that its widest face asks for; a throat may be wider than its face.
        let widening = if ducts.breaks(i, false) || ducts.breaks(i, true) { R::TWO } else { R::ONE };
        R::smaller(ratio, widening * R::from_f64(1.0 / SMALL_SHARE))
    }

    /// Largest signal rate of a field, for the first step; refuses an unphysical cell.
    pub fn rate(&self, field: &Fields<'_, R, D>) -> Result<R, Error> {
        self.check_fields(field)?;
        let mut rate = R::ZERO;
        for cell in 0..self.mesh.len() {
            let u = field.get(cell);
            if !self.is_physical(&u) {
                return Err(Error::Unphysical { cell });
            }
            rate = R::larger(self.cell_rate(&u, cell), rate);
        }
        Ok(rate)
    }
}
