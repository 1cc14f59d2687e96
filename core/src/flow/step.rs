//! One slab of one step, and the whole step on one thread.

use crate::flow::error::{Error, fits};
use crate::flow::fallback::FALLBACKS;
use crate::flow::kernel::flux_choice::{AnyFlux, FluxChoice};
use crate::flow::kernel::scratch::{PIECE, Sizes, in_pieces};
use crate::flow::kernel::slab::{Part, Walls};
use crate::flow::kernel::wall_pushes::{push_obstacles, push_walls};
use crate::flow::kernel::{long_line, sweep};
use crate::flow::porosity::cluster_averages;
use crate::flow::problem::Problem;
use crate::flow::state::{Fields, FieldsMut};
use crate::flow::step_report::Report;
use crate::flow::wall_forces::WatchedWalls;
use crate::number::real::Real;
use core::cell::Cell;
use core::ops::Range;

/// Scalars of scratch that one call of [`Problem::advance_slab`] or [`Problem::step`] needs on a mesh of so many cells along each axis, unless
/// the gas is mixed.
pub const fn scratch_needed<const D: usize>(cells: [usize; D]) -> usize {
    scratch_of(cells, false)
}

/// The same for a gas that is mixed or not.
const fn scratch_of<const D: usize>(cells: [usize; D], mixed: bool) -> usize {
    let sizes = Sizes::new(cells, mixed);
    let pieces = if D > 0 && in_pieces::<D>(cells[0]) { sizes.state * PIECE } else { 0 };
    sizes.total::<D>().saturating_add(pieces)
}

impl<R: Real, const D: usize> Problem<'_, R, D> {
    /// [`scratch_needed`] for the cells of this mesh and its gas.
    pub fn scratch_len(&self) -> usize {
        scratch_of(self.mesh.cells(), self.gas.is_mixed())
    }

    /// Advances the layers `slab` (along the last axis; all of them in 1D) by `dt`.
    ///
    /// `new` holds those layers only. `first_order`, if given, is one byte per cell of the whole mesh, as [`crate::flow::fallback`] marks them: cells
    /// with a non-zero byte are reconstructed to first order, those with the second mark get positive fluxes besides. Small cells are not yet merged: see [`Problem::merge`].
    pub fn advance_slab(
        &self,
        old: &Fields<'_, R, D>,
        new: &mut FieldsMut<'_, R, D>,
        slab: Range<usize>,
        dt: R,
        first_order: Option<&[u8]>,
        scratch: &mut [R],
    ) -> Result<Report<R, D>, Error> {
        self.advance_slab_by::<AnyFlux>(old, new, slab, dt, first_order, scratch)
    }

    /// The same, compiled for some solvers and gases: for fewer, or for mixed gases too.
    ///
    /// # Errors
    /// As of [`Problem::advance_slab`]; and [`Error::OtherFlux`].
    pub fn advance_slab_by<F: FluxChoice>(
        &self,
        old: &Fields<'_, R, D>,
        new: &mut FieldsMut<'_, R, D>,
        slab: Range<usize>,
        dt: R,
        first_order: Option<&[u8]>,
        scratch: &mut [R],
    ) -> Result<Report<R, D>, Error> {
        let mut report = Report::new();
        self.advance_part::<F>(old, new, slab, (dt, first_order, None), scratch, &mut report)?;
        Ok(report)
    }

    /// The same, which also tells what acts on the walls of some cells. One call writes those of its slab, so that callers with threads give each its own.
    ///
    /// # Errors
    /// As of [`Problem::advance_slab_by`]; the watched cells and their results are not equally many, or their indices do not ascend.
    pub fn advance_slab_watching<F: FluxChoice>(
        &self,
        old: &Fields<'_, R, D>,
        new: &mut FieldsMut<'_, R, D>,
        slab: Range<usize>,
        (dt, first_order): (R, Option<&[u8]>),
        watched: WatchedWalls<'_, R, D>,
        scratch: &mut [R],
    ) -> Result<Report<R, D>, Error> {
        fits(watched.cells.len(), watched.pushes.len())?;
        if let Some(before) = watched.cells.windows(2).position(|pair| pair[0] > pair[1]) {
            return Err(Error::WatchedOrder { number: before + 1 });
        }
        let walls = Walls {
            cells: watched.cells,
            pushes: Cell::from_mut(watched.pushes).as_slice_of_cells(),
            reference: watched.reference,
            all: self.mesh.len(),
            at_faces: push_walls,
            in_cell: push_obstacles,
        };
        let mut report = Report::new();
        self.advance_part::<F>(old, new, slab, (dt, first_order, Some(&walls)), scratch, &mut report)?;
        Ok(report)
    }

    /// Refuses what is no time step. One piece of code for all fluxes.
    #[inline(never)]
    fn fits_step(dt: R) -> Result<(), Error> {
        if dt >= R::ZERO && dt.is_finite() { Ok(()) } else { Err(Error::Step) }
    }

    fn advance_part<F: FluxChoice>(
        &self,
        old: &Fields<'_, R, D>,
        new: &mut FieldsMut<'_, R, D>,
        slab: Range<usize>,
        (dt, first_order, walls): (R, Option<&[u8]>, Option<&Walls<'_, R, D>>),
        scratch: &mut [R],
        report: &mut Report<R, D>,
    ) -> Result<(), Error> {
        let by = F::sweep(self)?;
        self.check_fields(old)?;
        Self::fits_step(dt)?;
        let cells = self.mesh.cells();
        let slab = if D == 1 { 0..1 } else { slab.start..slab.end.min(cells[D - 1]) };
        if self.mesh.is_empty() || slab.is_empty() {
            return Ok(());
        }
        let layer = if D == 1 { cells[0] } else { self.mesh.layer() };
        self.fits(&new.as_fields(), layer * slab.len())?;
        if let Some(f) = first_order {
            fits(self.mesh.len(), f.len())?;
        }
        let needed = self.scratch_len();
        if scratch.len() < needed {
            return Err(Error::ShapeMismatch { expected: needed, found: scratch.len() });
        }
        let part = Part { old, dt, first_order, layers: slab, reported: 0..cells[0], walls, first: 0 };
        if in_pieces::<D>(self.mesh.len()) {
            long_line::advance(self, &part, new, scratch, by, report);
        } else {
            sweep::advance(self, &part, new, scratch, by, report);
        }
        Ok(())
    }

    /// Makes a starting field ready for its first step and returns its largest signal rate: clusters whose cells differ much share
    /// one state. Gas at rest is left alone.
    ///
    /// # Errors
    /// A slice does not fit the mesh, or a cell is not physical.
    pub fn start(&self, field: &mut FieldsMut<'_, R, D>) -> Result<R, Error> {
        self.check_fields(&field.as_fields())?;
        if let Some(p) = &self.porosity {
            cluster_averages::average_unequal(self.clusters, &self.mesh, p.volume, self.gas, field);
            if self.gas.is_mixed() {
                cluster_averages::apply_capacities(self.clusters, &self.mesh, p.volume, self.gas, field);
            }
        }
        self.rate(&field.as_fields())
    }

    /// Merges the small cells of a new field in place; the report's rate and count cover the merged cells.
    ///
    /// # Errors
    /// A slice does not fit the mesh.
    pub fn merge(
        &self,
        old: &Fields<'_, R, D>,
        new: &mut FieldsMut<'_, R, D>,
        report: &mut Report<R, D>,
    ) -> Result<(), Error> {
        self.check_fields(old)?;
        self.fits(&new.as_fields(), self.mesh.len())?;
        let Some(p) = &self.porosity else { return Ok(()) };
        cluster_averages::apply(self.clusters, &self.mesh, p.volume, self.gas, old, new);
        if self.gas.is_mixed() {
            cluster_averages::apply_capacities(self.clusters, &self.mesh, p.volume, self.gas, new);
        }
        for cell in self.clusters.cells() {
            if self.holds(&new.as_fields(), cell) {
                report.rate = R::larger(self.cell_rate(&new.as_fields(), cell), report.rate);
            } else {
                report.unphysical += 1;
            }
        }
        Ok(())
    }

    /// One step on one thread: slab, merging, and, if a state came out unphysical, again with first order around it, then with positive
    /// fluxes, at last with floors. `marks` is one byte per cell of scratch. For a caller with threads there is [`Problem::step_in_slabs`].
    ///
    /// `old` must be physical; it is untouched, so a caller may repeat a step that had to be floored with a smaller `dt`.
    pub fn step(
        &self,
        old: &Fields<'_, R, D>,
        new: &mut FieldsMut<'_, R, D>,
        dt: R,
        marks: &mut [u8],
        scratch: &mut [R],
    ) -> Result<Report<R, D>, Error> {
        self.step_by::<AnyFlux>(old, new, dt, marks, scratch)
    }

    /// The same, compiled for some solvers and gases only: `problem.step_by::<OneFlux<Hllc, WithEnergy>>(…)` links less code than
    /// [`Problem::step`].
    ///
    /// # Errors
    /// As of [`Problem::step`]; and [`Error::OtherFlux`].
    pub fn step_by<F: FluxChoice>(
        &self,
        old: &Fields<'_, R, D>,
        new: &mut FieldsMut<'_, R, D>,
        dt: R,
        marks: &mut [u8],
        scratch: &mut [R],
    ) -> Result<Report<R, D>, Error> {
        let mut report = Report::new();
        self.with_fallbacks(old, new, marks, &mut report, |new, first_order, report| {
            *report = Report::new();
            let all = 0..self.mesh.cells()[D - 1];
            self.advance_part::<F>(old, new, all, (dt, first_order, None), scratch, report)
        })?;
        Ok(report)
    }

    /// The same for a caller with threads: `attempt` advances all slabs by one and the same time ([`Problem::advance_slab_by`]), with the marks
    /// that it is given, and joins their reports; it is called again for each fallback.
    ///
    /// # Errors
    /// As of [`Problem::step`], and those of `attempt`.
    pub fn step_in_slabs(
        &self,
        old: &Fields<'_, R, D>,
        new: &mut FieldsMut<'_, R, D>,
        marks: &mut [u8],
        mut attempt: impl FnMut(&mut FieldsMut<'_, R, D>, Option<&[u8]>) -> Result<Report<R, D>, Error>,
    ) -> Result<Report<R, D>, Error> {
        let mut report = Report::new();
        self.with_fallbacks(old, new, marks, &mut report, |new, first_order, report| {
            *report = attempt(new, first_order)?;
            Ok(())
        })?;
        Ok(report)
    }

    /// Attempts until all states are physical, or set to floors; `report` is that of the last one. It lies with the caller: moved from call to call, it
    /// would lie on the stack many times.
    fn with_fallbacks(
        &self,
        old: &Fields<'_, R, D>,
        new: &mut FieldsMut<'_, R, D>,
        marks: &mut [u8],
        report: &mut Report<R, D>,
        mut attempt: impl FnMut(&mut FieldsMut<'_, R, D>, Option<&[u8]>, &mut Report<R, D>) -> Result<(), Error>,
    ) -> Result<(), Error> {
        fits(self.mesh.len(), marks.len())?;
        let mut repetitions = 0;
        loop {
            attempt(new, if repetitions > 0 { Some(&*marks) } else { None }, report)?;
            self.merge(old, new, report)?;
            if report.unphysical == 0 {
                return Ok(());
            }
            if repetitions == 0 {
                marks.fill(0);
            }
            if repetitions == FALLBACKS || self.mark_troubled(&new.as_fields(), marks)? == 0 {
                return self.apply_floors(old, new, report);
            }
            repetitions += 1;
        }
    }
}
