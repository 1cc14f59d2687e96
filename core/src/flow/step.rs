//! The problem: mesh, gas, boundaries, porosity, drag and the choices of the scheme; and one slab of one step.
use crate::flow::boundary::Boundary;
use crate::flow::drag::Drag;
use crate::flow::kernel::long_line;
use crate::flow::kernel::scratch::Sizes;
use crate::flow::kernel::sweep::Sweep;
use crate::flow::limiter::Limiter;
use crate::flow::porosity::areas::Ducts;
use crate::flow::porosity::clusters::{self, Clusters, least_volume};
use crate::flow::porosity::fractions::{Medium, Mesh, Porosity, SMALL_SHARE};
use crate::flow::porosity::throat::ThroatGas;
use crate::flow::riemann::{FaceGas, Hllc, Hlle, Riemann, Rusanov};
use crate::flow::state::{Conserved, Fields, FieldsMut, Gas, sum};
use crate::flow::step_report::Report;
use crate::number::real::Real;
use core::ops::Range;

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
    /// Clusters of small cells, from [`clusters::clusters`]; empty for none.
    pub clusters: Clusters<'a>,
    /// Drag of sub-grid obstacles.
    pub drag: Option<Drag<'a, R, D>>,
    /// Acceleration of gravity; zero costs nothing.
    pub gravity: [R; D],
}

/// A broken contract.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Error {
    /// A slice does not fit the mesh.
    ShapeMismatch {
        /// Length by the mesh.
        expected: usize,
        /// Length given.
        found: usize,
    },
    /// An axis is periodic on one side only.
    HalfPeriodic {
        /// The axis.
        axis: usize,
    },
    /// A cell outside the physical set (density or pressure not positive, or not finite).
    Unphysical {
        /// Its flat index.
        cell: usize,
    },
}

impl<R: Real, const D: usize> Problem<'_, R, D> {
    /// Checks the contracts between the slices once.
    pub fn check(&self) -> Result<(), Error> {
        let n = self.mesh.len();
        let fits = |expected: usize, found: usize| {
            if expected == found { Ok(()) } else { Err(Error::ShapeMismatch { expected, found }) }
        };
        for d in 0..D {
            if (self.boundaries[d][0] == Boundary::Periodic) != (self.boundaries[d][1] == Boundary::Periodic) {
                return Err(Error::HalfPeriodic { axis: d });
            }
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

    /// Scalars of scratch that one call of [`Problem::advance_slab`] needs, whatever the slab.
    pub fn scratch_len(&self) -> usize {
        let total = Sizes::new(&self.mesh).total::<D>();
        if long_line::in_pieces::<D>(self.mesh.len()) { total + (D + 2) * long_line::PIECE } else { total }
    }

    /// The axis has periodic ends.
    pub fn periodic(&self) -> [bool; D] {
        self.boundaries.map(|b| b[0] == Boundary::Periodic)
    }

    fn check_fields(&self, old: &Fields<'_, R, D>) -> Result<(), Error> {
        self.check()?;
        self.fits(old, self.mesh.len())
    }

    fn fits(&self, f: &Fields<'_, R, D>, expected: usize) -> Result<(), Error> {
        let energy = if self.gas.has_energy() { f.energy.len() } else { expected };
        for found in f.momentum.iter().map(|m| m.len()).chain([f.density.len(), energy]) {
            if found != expected {
                return Err(Error::ShapeMismatch { expected, found });
            }
        }
        Ok(())
    }

    /// Advances the layers `slab` (along the last axis; all of them in 1D) by `dt`.
    ///
    /// `new` holds those layers only. `first_order`, if given, is one byte per cell of the whole mesh: cells with a non-zero
    /// byte are reconstructed to first order. Small cells are not yet merged: see [`Problem::merge`].
    pub fn advance_slab(
        &self,
        old: &Fields<'_, R, D>,
        new: &mut FieldsMut<'_, R, D>,
        slab: Range<usize>,
        dt: R,
        first_order: Option<&[u8]>,
        scratch: &mut [R],
    ) -> Result<Report<R, D>, Error> {
        self.check_fields(old)?;
        let cells = self.mesh.cells();
        let slab = if D == 1 { 0..1 } else { slab.start..slab.end.min(cells[D - 1]) };
        if self.mesh.is_empty() || slab.is_empty() {
            return Ok(Report::new());
        }
        let layer = if D == 1 { cells[0] } else { self.mesh.layer() };
        self.fits(&new.as_fields(), layer * slab.len())?;
        if let Some(f) = first_order.filter(|f| f.len() != self.mesh.len()) {
            return Err(Error::ShapeMismatch { expected: self.mesh.len(), found: f.len() });
        }
        let needed = self.scratch_len();
        if scratch.len() < needed {
            return Err(Error::ShapeMismatch { expected: needed, found: scratch.len() });
        }
        if long_line::in_pieces::<D>(self.mesh.len()) {
            return Ok(self.advance_line(old, new, dt, first_order, scratch));
        }
        Ok(self.sweep(old, new, slab, dt, first_order, 0..cells[0], scratch))
    }

    /// The sweep of a slab whose slices and scratch fit. Of a line only the cells `counted` enter the report.
    pub(in crate::flow) fn sweep(
        &self,
        old: &Fields<'_, R, D>,
        new: &mut FieldsMut<'_, R, D>,
        slab: Range<usize>,
        dt: R,
        first_order: Option<&[u8]>,
        counted: Range<usize>,
        scratch: &mut [R],
    ) -> Report<R, D> {
        let run = match (self.gas.has_energy(), self.scheme.riemann) {
            (true, Riemann::Hllc) => Sweep::run::<Hllc, true>,
            (true, Riemann::Hlle) => Sweep::run::<Hlle, true>,
            (true, Riemann::Rusanov) => Sweep::run::<Rusanov, true>,
            (false, Riemann::Hllc) => Sweep::run::<Hllc, false>,
            (false, Riemann::Hlle) => Sweep::run::<Hlle, false>,
            (false, Riemann::Rusanov) => Sweep::run::<Rusanov, false>,
        };
        let mut sweep = Sweep {
            problem: self,
            medium: self.porosity.map(|porosity| Medium { mesh: self.mesh, porosity }),
            size: Sizes::new(&self.mesh),
            periodic: self.periodic(),
            weighted: self.gravity.iter().any(|&g| g != R::ZERO),
            even: self.mesh.widths.map(|w| w.iter().all(|x| *x == w[0])),
            first_order,
            face_gas: FaceGas::new(self.gas),
            throat: ThroatGas::new(self.gas),
            old,
            dt,
            slab,
            rows: 0..1,
            counted,
        };
        Sizes::tiles(&self.mesh).fold(Report::new(), |report, rows| {
            sweep.rows = rows;
            report.and(&run(&sweep, new, scratch))
        })
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

    /// Prepares a starting field: clusters whose cells differ much share one state. Gas at rest is left alone.
    pub fn settle(&self, field: &mut FieldsMut<'_, R, D>) {
        if let Some(p) = &self.porosity {
            clusters::settle(self.clusters, &self.mesh, p.volume, self.gas, field);
        }
    }

    /// Merges the small cells of a new field in place; the report's rate and count cover the merged cells.
    pub fn merge(&self, old: &Fields<'_, R, D>, new: &mut FieldsMut<'_, R, D>, report: &mut Report<R, D>) {
        let Some(p) = &self.porosity else { return };
        clusters::apply(self.clusters, &self.mesh, p.volume, old, new);
        for cell in self.clusters.cells() {
            let u = new.get(cell);
            if self.is_physical(&u) {
                report.rate = R::larger(self.cell_rate(&u, cell), report.rate);
            } else {
                report.unphysical += 1;
            }
        }
    }
}
