//! One time step of a slab of layers: the sweep over rows, and what surrounds it.
//!
//! Rows come in storage order. A window of three layers of primitive variables moves along the last axis; the fluxes across
//! the other axes are differenced when the row above arrives. A cell's new state depends on the old field alone, by the same
//! operations wherever the slab is cut, so slabs advanced by any number of threads give the same bits.

use super::boundary::Boundary;
use super::drag::Drag;
use super::flux::{FaceGas, Hllc, Hlle, Riemann, Rusanov, Solver};
use super::limiter::{Limiter, Minmod, MonotonizedCentral, Slope, Unlimited, VanLeer};
use super::medium::{Medium, Mesh, Porosity, SEALED, SMALL, SMALL_SHARE, jump_high, jump_low};
use super::merge::{self, Clusters, least_volume};
use super::row::{self, Openings, Rate, var};
use super::state::{Conserved, Fields, FieldsMut, Gas, greater, lesser, rotate_back, sum};
use super::throat::{ThroatGas, jump_flux};
use crate::real::Real;
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
        Scheme { riemann: Riemann::Hllc, limiter: Limiter::MonotonizedCentral, pressure: PressureForm::Geometric }
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
    /// Clusters of small cells, from [`merge::clusters`]; empty for none.
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

/// What a slab, or a whole step, did.
#[derive(Clone, Copy, Debug)]
pub struct Report<R, const D: usize> {
    /// Largest signal rate Σ_d open_d (|u_d| + c)/dx_d of the new state; the next stable step is cfl over it.
    pub rate: R,
    /// New states outside the physical set.
    pub unphysical: usize,
    /// Cells whose reconstruction fell back to first order.
    pub first_order: usize,
    /// Cells that had to be set to a floor.
    pub floored: usize,
    /// What entered the domain during the step through the low and high side of each axis (area times time included).
    pub inflow: [[Conserved<R, D>; 2]; D],
}

impl<R: Real, const D: usize> Report<R, D> {
    /// Nothing done.
    pub fn new() -> Self {
        let zero = Conserved { density: R::ZERO, momentum: [R::ZERO; D], energy: R::ZERO };
        Report { rate: R::ZERO, unphysical: 0, first_order: 0, floored: 0, inflow: [[zero; 2]; D] }
    }

    /// Joins the report of the next slab.
    #[must_use]
    pub fn and(mut self, other: &Self) -> Self {
        self.rate = greater(other.rate, self.rate);
        self.unphysical += other.unphysical;
        self.first_order += other.first_order;
        self.floored += other.floored;
        for d in 0..D {
            for s in 0..2 {
                let (a, b) = (&mut self.inflow[d][s], &other.inflow[d][s]);
                a.density += b.density;
                a.energy += b.energy;
                for c in 0..D {
                    a.momentum[c] += b.momentum[c];
                }
            }
        }
        self
    }
}

impl<R: Real, const D: usize> Default for Report<R, D> {
    fn default() -> Self {
        Self::new()
    }
}

/// Hands out pieces of one slice.
struct Arena<'s, R>(&'s mut [R]);

impl<'s, R: Real> Arena<'s, R> {
    fn take(&mut self, n: usize) -> &'s mut [R] {
        let (piece, rest) = core::mem::take(&mut self.0).split_at_mut(n);
        self.0 = rest;
        piece
    }

    fn axes<const D: usize>(&mut self, n: usize) -> [&'s mut [R]; D] {
        core::array::from_fn(|_| self.take(n))
    }
}

/// Sizes of the pieces of scratch.
#[derive(Clone, Copy)]
struct Sizes {
    /// Cells along a row, with ghosts, and faces.
    n: usize,
    padded: usize,
    m: usize,
    /// Rows of a layer, and with ghost rows.
    rows: usize,
    rows_padded: usize,
    /// Layers of the window.
    layers: usize,
}

impl Sizes {
    fn new<R: Real, const D: usize>(mesh: &Mesh<'_, R, D>) -> Self {
        let cells = mesh.cells();
        let n = cells[0];
        let rows = if D == 3 { cells[1] } else { 1 };
        Sizes {
            n,
            padded: n + 2,
            m: n + 1,
            rows,
            rows_padded: if D == 3 { rows + 2 } else { 1 },
            layers: if D == 1 { 1 } else { 3 },
        }
    }

    fn total<const D: usize>(&self) -> usize {
        let v = D + 2;
        let f = D + 3;
        let window = self.layers * self.rows_padded * v * self.padded;
        let row = D * v * self.n + v * self.n + 2 * f * self.m + 2 * f * self.m + 2 * f * self.m;
        let lagged = if D == 1 { 0 } else { self.rows * 2 * f * self.n };
        let changes = self.rows * D * v * self.n;
        let metric = (4 * D + 4) * self.n + 2 * self.m;
        window + row + lagged + changes + metric
    }
}

/// Buffers of a sweep.
struct Work<'s, R, const D: usize> {
    window: &'s mut [R],
    slope: [&'s mut [R]; D],
    half: &'s mut [R],
    left: &'s mut [R],
    right: &'s mut [R],
    flux: &'s mut [R],
    /// High face states and fluxes of the row below along axis 1 of a 3D mesh.
    middle: Lag<'s, R>,
    /// The same of the layer below, all rows.
    last: Lag<'s, R>,
    change: [&'s mut [R]; D],
    metric: Metric<'s, R, D>,
}

/// What the row (or layer) below has left for the face between.
struct Lag<'s, R> {
    state: &'s mut [R],
    flux: &'s mut [R],
}

/// Row buffers of cell metrics.
struct Metric<'s, R, const D: usize> {
    inv_width: &'s mut [R],
    rate: [&'s mut [R]; D],
    widening: [&'s mut [R]; D],
    weight: [&'s mut [R]; D],
    open: [&'s mut [R]; D],
    scale: &'s mut [R],
    signal: &'s mut [R],
    spare: &'s mut [R],
    vol_left: &'s mut [R],
    vol_right: &'s mut [R],
}

/// A row of cells: its index along axis 1 (3D) and along the last axis, inside the domain.
#[derive(Clone, Copy)]
struct Row<const D: usize> {
    /// Flat index of its first cell.
    start: usize,
    /// Indices of its first cell.
    at: [usize; D],
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
        Sizes::new(&self.mesh).total::<D>()
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
        let sweep = Sweep {
            problem: self,
            medium: self.porosity.map(|porosity| Medium { mesh: self.mesh, porosity }),
            size: Sizes::new(&self.mesh),
            periodic: self.periodic(),
            weighted: self.gravity.iter().any(|&g| g != R::ZERO),
            first_order,
            face_gas: FaceGas::new(self.gas),
            throat: ThroatGas::new(self.gas),
            old,
            dt,
            slab,
        };
        let run = match (self.gas.has_energy(), self.scheme.riemann) {
            (true, Riemann::Hllc) => Sweep::run::<Hllc, true>,
            (true, Riemann::Hlle) => Sweep::run::<Hlle, true>,
            (true, Riemann::Rusanov) => Sweep::run::<Rusanov, true>,
            (false, Riemann::Hllc) => Sweep::run::<Hllc, false>,
            (false, Riemann::Hlle) => Sweep::run::<Hlle, false>,
            (false, Riemann::Rusanov) => Sweep::run::<Rusanov, false>,
        };
        Ok(run(&sweep, new, scratch))
    }

    /// Signal rate of one cell, jumps and merging included.
    fn cell_rate(&self, u: &Conserved<R, D>, cell: usize) -> R {
        let w = self.gas.primitive(u);
        let c = self.gas.sound_speed(&w);
        let at = self.mesh.coordinates(cell);
        sum::<R, D>(core::array::from_fn(|d| {
            let t = (w.velocity[d].abs() + c) / self.mesh.widths[d][at[d]];
            match self.porosity {
                None => t,
                Some(porosity) => t * self.openness(&Medium { mesh: self.mesh, porosity }, cell, at, d),
            }
        }))
    }

    /// Open area over open volume of a cell along `d`, as far as it limits the step.
    fn openness(&self, medium: &Medium<'_, R, D>, cell: usize, at: [usize; D], d: usize) -> R {
        let marks = medium.porosity.marks[cell];
        let periodic = self.boundaries[d][0] == Boundary::Periodic;
        let mut above = at;
        above[d] += 1;
        let (low, high) = medium.openings(d, at);
        let low = if marks & jump_low(d) != 0 { medium.passage(d, at, periodic) } else { low };
        let high = if marks & jump_high(d) != 0 { medium.passage(d, above, periodic) } else { high };
        let passage = greater(low, high);
        let ratio = passage / greater(medium.porosity.volume[cell], least_volume());
        let merged = marks & SMALL != 0 && !self.clusters.0.is_empty();
        // A cluster holds its share of the volume that its widest face asks for; a throat may be wider than its face.
        let widening = if marks & (jump_low(d) | jump_high(d)) != 0 { R::TWO } else { R::ONE };
        if merged { lesser(ratio, widening * R::from_f64(1.0 / SMALL_SHARE)) } else { ratio }
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
            rate = greater(self.cell_rate(&u, cell), rate);
        }
        Ok(rate)
    }

    /// Positive density and pressure, all finite.
    pub fn is_physical(&self, u: &Conserved<R, D>) -> bool {
        let w = self.gas.primitive(u);
        let finite = u.momentum.iter().all(|m| m.is_finite()) && u.density.is_finite() && w.pressure.is_finite();
        finite && u.density > R::ZERO && w.pressure > R::ZERO
    }

    /// Prepares a starting field: clusters whose cells differ much share one state. Gas at rest is left alone.
    pub fn settle(&self, field: &mut FieldsMut<'_, R, D>) {
        if let Some(p) = &self.porosity {
            merge::settle(self.clusters, &self.mesh, p.volume, self.gas, field);
        }
    }

    /// Merges the small cells of a new field in place; the report's rate and count cover the merged cells.
    pub fn merge(&self, old: &Fields<'_, R, D>, new: &mut FieldsMut<'_, R, D>, report: &mut Report<R, D>) {
        let Some(p) = &self.porosity else { return };
        merge::apply(self.clusters, &self.mesh, p.volume, old, new);
        for cell in self.clusters.cells() {
            let u = new.get(cell);
            if self.is_physical(&u) {
                report.rate = greater(self.cell_rate(&u, cell), report.rate);
            } else {
                report.unphysical += 1;
            }
        }
    }

    /// Marks every unphysical cell of a new field and its neighbours for a first-order step; returns how many marks are new.
    pub fn mark_troubled(&self, new: &Fields<'_, R, D>, first_order: &mut [u8]) -> usize {
        let cells = self.mesh.cells();
        let periodic = self.periodic();
        let mut added = 0;
        for cell in 0..self.mesh.len() {
            if self.is_physical(&new.get(cell)) {
                continue;
            }
            let at = self.mesh.coordinates(cell);
            let mut set = |i: usize| {
                if let Some(mark) = first_order.get_mut(i) {
                    added += usize::from(*mark == 0);
                    *mark = 1;
                }
            };
            set(cell);
            for d in 0..D {
                let mut next = at;
                if at[d] > 0 || periodic[d] {
                    next[d] = (at[d] + cells[d] - 1) % cells[d];
                    set(self.mesh.index(next));
                }
                if at[d] + 1 < cells[d] || periodic[d] {
                    next[d] = (at[d] + 1) % cells[d];
                    set(self.mesh.index(next));
                }
            }
        }
        added
    }

    /// The last resort: gives every unphysical cell a positive state scaled to its old one. Returns how many.
    pub fn apply_floors(&self, old: &Fields<'_, R, D>, new: &mut FieldsMut<'_, R, D>, report: &mut Report<R, D>) {
        // Share of the old density or pressure that a floor keeps. Smaller: hotter or emptier cells, shorter steps.
        let share = R::from_f64(1e-3);
        for cell in 0..self.mesh.len() {
            let u = new.get(cell);
            if self.is_physical(&u) {
                continue;
            }
            let before = self.gas.primitive(&old.get(cell));
            // The kinetic energy must fit the scalar with room for what a step multiplies it by.
            let kinetic = u.density * sum::<R, D>(u.momentum.map(|m| (m / u.density) * (m / u.density)));
            let sound = u.density > R::ZERO && u.density.is_finite() && kinetic < R::MAX * R::EPSILON;
            let mut w = if sound { self.gas.primitive(&u) } else { before };
            if !sound {
                w.density = greater(before.density * share, R::MIN_POSITIVE);
            }
            w.pressure = match self.gas {
                // Above the rounding of the kinetic energy it is stored with.
                Gas::Ideal { gamma } => {
                    let kinetic = w.density * sum::<R, D>(w.velocity.map(|u| u * u));
                    let least = R::from_f64(64.0) * R::EPSILON * (gamma - R::ONE) * kinetic;
                    greater(greater(before.pressure * share, least), R::MIN_POSITIVE)
                }
                gas => gas.pressure(w.density, R::ZERO),
            };
            let floored = self.gas.conserved(&w);
            new.set(cell, &floored);
            report.floored += 1;
            report.rate = greater(self.cell_rate(&floored, cell), report.rate);
        }
        report.unphysical = 0;
    }

    /// One step on one thread: slab, merging, and, if a state came out unphysical, again with first order around it, at last
    /// with floors. `marks` is one byte per cell of scratch. A caller with threads does the same with its own slabs.
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
        if marks.len() != self.mesh.len() {
            return Err(Error::ShapeMismatch { expected: self.mesh.len(), found: marks.len() });
        }
        let all = 0..self.mesh.cells()[D - 1];
        let mut report = self.advance_slab(old, new, all.clone(), dt, None, scratch)?;
        self.merge(old, new, &mut report);
        if report.unphysical == 0 {
            return Ok(report);
        }
        marks.fill(0);
        for _ in 0..FALLBACKS {
            if self.mark_troubled(&new.as_fields(), marks) == 0 {
                break;
            }
            report = self.advance_slab(old, new, all.clone(), dt, Some(marks), scratch)?;
            self.merge(old, new, &mut report);
            if report.unphysical == 0 {
                return Ok(report);
            }
        }
        self.apply_floors(old, new, &mut report);
        Ok(report)
    }
}

/// Rounds of the first-order fallback: the marked region grows by one cell each.
pub const FALLBACKS: usize = 4;

struct Sweep<'p, R, const D: usize> {
    problem: &'p Problem<'p, R, D>,
    medium: Option<Medium<'p, R, D>>,
    size: Sizes,
    periodic: [bool; D],
    weighted: bool,
    first_order: Option<&'p [u8]>,
    face_gas: FaceGas<R>,
    throat: ThroatGas<R>,
    old: &'p Fields<'p, R, D>,
    dt: R,
    slab: Range<usize>,
}

impl<R: Real, const D: usize> Sweep<'_, R, D> {
    const V: usize = D + 2;
    const F: usize = D + 3;

    fn run<S: Solver, const ENERGY: bool>(&self, new: &mut FieldsMut<'_, R, D>, scratch: &mut [R]) -> Report<R, D> {
        let s = self.size;
        let (v, f) = (Self::V, Self::F);
        let mut arena = Arena(scratch);
        let lag_last = if D == 1 { 0 } else { s.rows * f * s.n };
        let mut work: Work<'_, R, D> = Work {
            window: arena.take(s.layers * s.rows_padded * v * s.padded),
            slope: arena.axes(v * s.n),
            half: arena.take(v * s.n),
            left: arena.take(f * s.m),
            right: arena.take(f * s.m),
            flux: arena.take(f * s.m),
            middle: Lag { state: arena.take(f * s.m), flux: arena.take(f * s.m) },
            last: Lag { state: arena.take(lag_last), flux: arena.take(lag_last) },
            change: arena.axes(s.rows * v * s.n),
            metric: Metric {
                inv_width: arena.take(s.n),
                rate: arena.axes(s.n),
                widening: arena.axes(s.n),
                weight: arena.axes(s.n),
                open: arena.axes(s.n),
                scale: arena.take(s.n),
                signal: arena.take(s.n),
                spare: arena.take(s.n),
                vol_left: arena.take(s.m),
                vol_right: arena.take(s.m),
            },
        };
        for i in 0..s.n {
            work.metric.inv_width[i] = R::ONE / self.problem.mesh.widths[0][i];
        }
        let mut report = Report::new();
        if D == 1 {
            self.load_layer(0, &mut work);
            let row = Row { start: 0, at: [0; D] };
            self.reconstruct(row, 0, 0, &mut work, &mut report.first_order);
            self.cross_row::<S, ENERGY>(row, 0, &mut work, &mut report);
            self.finish::<ENERGY>(row, 0, &mut work, new, 0, &mut report);
            return report;
        }
        let n_last = self.problem.mesh.cells()[D - 1] as isize;
        let (lo, hi) = (self.slab.start as isize, self.slab.end as isize);
        let rows = s.rows as isize;
        for l in lo - 1..=hi {
            let outside = l < 0 || l >= n_last;
            let inside = l >= lo && l < hi;
            if outside && !self.periodic[D - 1] {
                // The ghost of a boundary: no cells, only the face beside the domain.
                if l == hi {
                    for j in 0..s.rows {
                        self.cross_last::<S, ENERGY>(l, j, None, &mut work, &mut report);
                        self.finish_below::<ENERGY>(l, j, &mut work, new, &mut report);
                    }
                }
                continue;
            }
            if l == lo - 1 || (l == lo && !self.periodic[D - 1] && lo == 0) {
                self.load_layer(l - 1, &mut work);
                self.load_layer(l, &mut work);
            }
            self.load_layer(l + 1, &mut work);
            let wrapped = l.rem_euclid(n_last) as usize;
            let ghost_rows = isize::from(D == 3 && inside);
            for j in -ghost_rows..rows + ghost_rows {
                let ghost = j < 0 || j >= rows;
                if ghost && !self.periodic[1 % D] {
                    if j == rows {
                        self.cross_middle::<S, ENERGY>(wrapped, j, None, &mut work, &mut report);
                    }
                    continue;
                }
                let jw = j.rem_euclid(rows) as usize;
                let mut at = [0; D];
                at[D - 1] = wrapped;
                if D == 3 {
                    at[1] = jw;
                }
                let row = Row { start: self.problem.mesh.index(at), at };
                let counted = inside && !ghost;
                let mut ignored = 0;
                self.reconstruct(row, l, jw, &mut work, if counted { &mut report.first_order } else { &mut ignored });
                if !ghost {
                    if l == lo - 1 {
                        self.keep_last(jw, &mut work);
                    } else {
                        self.cross_last::<S, ENERGY>(l, jw, Some(row), &mut work, &mut report);
                        if l > lo {
                            self.finish_below::<ENERGY>(l, jw, &mut work, new, &mut report);
                        }
                        if inside {
                            self.keep_last(jw, &mut work);
                        }
                    }
                }
                if D == 3 && inside {
                    if j >= 0 {
                        self.cross_middle::<S, ENERGY>(wrapped, j, Some(row), &mut work, &mut report);
                    }
                    self.keep_middle(&mut work);
                }
                if inside && !ghost {
                    self.cross_row::<S, ENERGY>(row, jw, &mut work, &mut report);
                }
            }
        }
        report
    }

    // --- loading -----------------------------------------------------------------------------------------------------

    fn block(&self, l: isize, row: usize) -> Range<usize> {
        let s = self.size;
        let slot = if D == 1 { 0 } else { l.rem_euclid(3) as usize };
        let len = Self::V * s.padded;
        let start = (slot * s.rows_padded + row) * len;
        start..start + len
    }

    /// Primitive variables of a layer with its ghosts. A layer beyond a boundary is made from the layer inside it.
    fn load_layer(&self, l: isize, work: &mut Work<'_, R, D>) {
        let s = self.size;
        let cells = self.problem.mesh.cells();
        let n_last = if D == 1 { 1 } else { cells[D - 1] as isize };
        let ghost = D > 1 && !self.periodic[D - 1] && (l < 0 || l >= n_last);
        let source = if ghost { l.clamp(0, n_last - 1) } else { l.rem_euclid(n_last) } as usize;
        let pad = usize::from(D == 3);
        for j in 0..s.rows {
            let start = (source * s.rows + j) * s.n;
            let block = &mut work.window[self.block(l, j + pad)];
            row::primitives(self.problem.gas, self.old, start, block, s.padded);
            let state = |block: &[R], i: usize| row::face_state::<R, D>(block, s.padded, i);
            let gas = self.problem.gas;
            let [low, high] = &self.problem.boundaries[0];
            let (a, b) = if self.periodic[0] {
                (state(block, s.n), state(block, 1))
            } else {
                (low.ghost_cell(&state(block, 1), 0, true, gas), high.ghost_cell(&state(block, s.n), 0, false, gas))
            };
            row::put_state(block, s.padded, 0, &a);
            row::put_state(block, s.padded, s.padded - 1, &b);
            if ghost {
                self.mirror(block, D - 1, l < 0);
            }
        }
        if D == 3 {
            for (ghost_row, low) in [(0, true), (s.rows + 1, false)] {
                let inner = if low != self.periodic[1] { 1 } else { s.rows };
                work.window.copy_within(self.block(l, inner), self.block(l, ghost_row).start);
                if !self.periodic[1] {
                    self.mirror(&mut work.window[self.block(l, ghost_row)], 1, low);
                }
            }
        }
    }

    /// Turns a row of inner states into the ghosts beyond a boundary of axis `d`.
    fn mirror(&self, block: &mut [R], d: usize, low: bool) {
        let padded = self.size.padded;
        let boundary = &self.problem.boundaries[d][usize::from(!low)];
        for i in 0..padded {
            let w = row::face_state::<R, D>(block, padded, i);
            row::put_state(block, padded, i, &boundary.ghost_cell(&w, d, low, self.problem.gas));
        }
    }

    // --- reconstruction ----------------------------------------------------------------------------------------------

    /// Slopes and half-step states of a row of real cells; `l` and `j` say where it stands in the window.
    fn reconstruct(&self, row: Row<D>, l: isize, j: usize, work: &mut Work<'_, R, D>, fallen: &mut usize) {
        match self.problem.scheme.limiter {
            Limiter::MonotonizedCentral => self.reconstruct_with::<MonotonizedCentral>(row, l, j, work, fallen, true),
            Limiter::VanLeer => self.reconstruct_with::<VanLeer>(row, l, j, work, fallen, true),
            Limiter::Minmod => self.reconstruct_with::<Minmod>(row, l, j, work, fallen, true),
            Limiter::Unlimited => self.reconstruct_with::<Unlimited>(row, l, j, work, fallen, true),
            Limiter::FirstOrder => self.reconstruct_with::<Minmod>(row, l, j, work, fallen, false),
        }
    }

    fn reconstruct_with<S: Slope>(
        &self,
        row: Row<D>,
        l: isize,
        j: usize,
        work: &mut Work<'_, R, D>,
        fallen: &mut usize,
        sloped: bool,
    ) {
        let s = self.size;
        let n = s.n;
        let pad = usize::from(D == 3);
        let mesh = &self.problem.mesh;
        self.metric(row, &mut work.metric);
        let window = &*work.window;
        let here = &window[self.block(l, j + pad)];
        for d in 0..D {
            let out = &mut *work.slope[d];
            if !sloped {
                out.fill(R::ZERO);
                continue;
            }
            // The three values along axis d: shifted in the row, the rows beside it, or the layers beside it.
            let (below, above, shift) = if d == 0 {
                (here, here, 1)
            } else if d == D - 1 {
                (&window[self.block(l - 1, j + pad)], &window[self.block(l + 1, j + pad)], 0)
            } else {
                (&window[self.block(l, j + pad - 1)], &window[self.block(l, j + pad + 1)], 0)
            };
            let three = |v: usize| {
                (
                    &var(below, v, s.padded)[1 - shift..][..n],
                    &var(here, v, s.padded)[1..][..n],
                    &var(above, v, s.padded)[1 + shift..][..n],
                )
            };
            let widths = mesh.widths[d];
            let uniform = widths.iter().all(|w| *w == widths[0]);
            let hydrostatic = self.weighted && self.problem.gravity[d] != R::ZERO;
            for v in 0..Self::V {
                let (a, b, c) = three(v);
                let o = &mut out[v * n..][..n];
                if uniform {
                    row::slopes::<R, S>(a, b, c, o);
                } else if d == 0 {
                    row::slopes_stretched::<R, S>((a, b, c), |i| stretch(widths, i), o);
                } else {
                    let scale = stretch(widths, row.at[d]);
                    row::slopes_stretched::<R, S>((a, b, c), |_| scale, o);
                }
            }
            if hydrostatic {
                let half_g = R::HALF * self.problem.gravity[d];
                // Distance of the centres; beyond a boundary a cell of the same width.
                let distance = |i: usize| {
                    let at = |k: usize| widths[k.min(widths.len() - 1)];
                    let low = if i == 0 { widths[0] } else { R::HALF * (at(i - 1) + at(i)) };
                    (half_g * low, half_g * (R::HALF * (at(i) + at(i + 1))))
                };
                let (p, rho) = (three(D + 1), three(0));
                let o = &mut out[(D + 1) * n..][..n];
                if d == 0 {
                    row::slopes_hydrostatic::<R, S>(p, rho, distance, o);
                } else {
                    let w = distance(row.at[d]);
                    row::slopes_hydrostatic::<R, S>(p, rho, |_| w, o);
                }
            }
        }
        let marks = self.medium.as_ref().map(|m| &m.porosity.marks[row.start..][..n]);
        if let Some(marks) = marks {
            self.flatten_at_jumps(marks, &mut work.slope);
        }
        let slope = work.slope.each_ref().map(|b| &**b);
        let rows = work.metric.rate.each_ref().map(|b| &**b);
        let rate = core::array::from_fn(|d| {
            if d == 0 || self.medium.is_some() {
                Rate::Row(rows[d])
            } else {
                Rate::One(R::HALF * self.dt / mesh.widths[d][row.at[d]])
            }
        });
        let widening = work.metric.widening.each_ref().map(|b| &**b);
        let weights = work.metric.weight.each_ref().map(|b| &**b);
        let weight = if self.weighted { Some(&weights) } else { None };
        let gamma = self.problem.gas.gamma();
        if self.medium.is_some() {
            row::half_step::<R, D, true>(here, s.padded, &slope, &rate, &widening, weight, gamma, work.half);
        } else {
            row::half_step::<R, D, false>(here, s.padded, &slope, &rate, &widening, weight, gamma, work.half);
        }
        if self.problem.drag.is_some() {
            self.drag_half(row, here, work.half);
        }
        // First order where the face states would leave the physical set, where the caller asks, and in small cells.
        let leaves = row::leaves_physical_set::<R, D>(work.half, &slope, n);
        let asked = self.first_order.map(|f| &f[row.start..][..n]).filter(|f| f.iter().any(|&b| b != 0));
        let small = marks.filter(|m| m.iter().any(|&b| b & (SMALL | SEALED) != 0));
        if leaves || asked.is_some() || small.is_some() {
            for i in 0..n {
                let steepest = |v: usize| (0..D).fold(R::ZERO, |m, d| greater(work.slope[d][v * n + i].abs(), m));
                let low_rho = work.half[i] - R::HALF * steepest(0);
                let low_p = work.half[(D + 1) * n + i] - R::HALF * steepest(D + 1);
                let leaves = !(low_rho > R::ZERO && low_p > R::ZERO);
                let asked = asked.is_some_and(|f| f[i] != 0);
                let small = small.is_some_and(|m| m[i] & (SMALL | SEALED) != 0);
                if leaves || asked || small {
                    *fallen += usize::from(leaves || asked);
                    for v in 0..Self::V {
                        work.half[v * n + i] = here[v * s.padded + 1 + i];
                        for d in 0..D {
                            work.slope[d][v * n + i] = R::ZERO;
                        }
                    }
                }
            }
        }
    }

    /// No slope across a porosity jump: both cells beside it are flat along that axis.
    fn flatten_at_jumps(&self, marks: &[u8], slope: &mut [&mut [R]; D]) {
        let n = self.size.n;
        if marks.iter().fold(0, |m, b| m | b) & !(SMALL | SEALED) == 0 {
            return;
        }
        for (i, &mark) in marks.iter().enumerate() {
            for d in 0..D {
                if mark & (jump_low(d) | jump_high(d)) != 0 {
                    for v in 0..Self::V {
                        slope[d][v * n + i] = R::ZERO;
                    }
                }
            }
        }
    }

    /// Per-cell scales of the half step for one row.
    fn metric(&self, row: Row<D>, metric: &mut Metric<'_, R, D>) {
        let n = self.size.n;
        let mesh = &self.problem.mesh;
        let half_dt = R::HALF * self.dt;
        if self.weighted {
            for d in 0..D {
                for i in 0..n {
                    let k = if d == 0 { i } else { row.at[d] };
                    metric.weight[d][i] = self.problem.gravity[d] * mesh.widths[d][k];
                }
            }
        }
        let Some(medium) = &self.medium else {
            for i in 0..n {
                metric.rate[0][i] = half_dt / mesh.widths[0][i];
            }
            return;
        };
        let volume = &medium.porosity.volume[row.start..][..n];
        let inv = &mut metric.spare[..n];
        for i in 0..n {
            inv[i] = R::ONE / greater(volume[i], least_volume());
        }
        for d in 0..D {
            let (low, high) = self.face_rows(medium, d, row);
            let (rate, widening) = (&mut metric.rate[d][..n], &mut metric.widening[d][..n]);
            let across = if d == 0 { R::ZERO } else { half_dt / mesh.widths[d][row.at[d]] };
            let widths = &mesh.widths[0][..n];
            if d == 0 {
                for i in 0..n {
                    let scale = half_dt / widths[i];
                    rate[i] = R::HALF * (low[i] + high[i]) * inv[i] * scale;
                    widening[i] = (high[i] - low[i]) * inv[i] * scale;
                }
            } else {
                for i in 0..n {
                    rate[i] = R::HALF * (low[i] + high[i]) * inv[i] * across;
                    widening[i] = (high[i] - low[i]) * inv[i] * across;
                }
            }
        }
        let marks = &medium.porosity.marks[row.start..][..n];
        if marks.iter().fold(0, |m, b| m | b) & !(SMALL | SEALED) == 0 {
            return;
        }
        for i in 0..n {
            for d in 0..D {
                let (low, high) = (marks[i] & jump_low(d) != 0, marks[i] & jump_high(d) != 0);
                if low || high {
                    // A jump is the throat's business: the duct goes on behind it.
                    let mut at = row.at;
                    at[0] += i;
                    let (a, b) = medium.openings(d, at);
                    let duct = greater(a, b);
                    let (a, b) = (if low { duct } else { a }, if high { duct } else { b });
                    let scale = half_dt / mesh.widths[d][at[d]];
                    metric.widening[d][i] = (b - a) * metric.spare[i] * scale;
                }
            }
        }
    }

    /// The rows of open fractions on the low and high faces of axis `d`.
    fn face_rows<'m>(&self, medium: &Medium<'m, R, D>, d: usize, row: Row<D>) -> (&'m [R], &'m [R]) {
        let start = medium.mesh.face(d, row.at);
        let b = medium.porosity.faces[d];
        let n = self.size.n;
        (&b[start..][..n], &b[start + medium.mesh.face_stride(d)..][..n])
    }

    /// Drag over the half step: slows the half state and heats it.
    fn drag_half(&self, row: Row<D>, here: &[R], half: &mut [R]) {
        let (n, padded) = (self.size.n, self.size.padded);
        let Some(drag) = &self.problem.drag else { return };
        for i in 0..n {
            let coefficients = drag.at(row.start + i);
            if coefficients.is_free() {
                continue;
            }
            let u: [R; D] = core::array::from_fn(|c| here[(1 + c) * padded + 1 + i]);
            let pushed: [R; D] = core::array::from_fn(|c| half[(1 + c) * n + i]);
            let v = coefficients.step(u, pushed, R::HALF * self.dt);
            let lost = sum::<R, D>(core::array::from_fn(|c| pushed[c] * pushed[c] - v[c] * v[c]));
            for c in 0..D {
                half[(1 + c) * n + i] = v[c];
            }
            if let Gas::Ideal { gamma } = self.problem.gas {
                half[(D + 1) * n + i] += (gamma - R::ONE) * R::HALF * half[i] * lost;
            }
        }
    }

    // --- faces -------------------------------------------------------------------------------------------------------

    /// Face states of the present row on one side of axis `d`.
    fn states(&self, high: bool, d: usize, work: (&[R], &[R], &[R]), out: &mut [R], stride: usize, offset: usize) {
        let (half, slope, weight) = work;
        let n = self.size.n;
        let hydrostatic = self.weighted && self.problem.gravity[d] != R::ZERO;
        row::face_states::<R, D>(high, d, half, slope, n, None, out, stride, offset);
        if hydrostatic {
            for i in 0..n {
                let tilt = R::HALF * weight[i] * half[i];
                for v in [D + 1, D + 2] {
                    let p = &mut out[v * stride + offset + i];
                    *p = if high { *p + tilt } else { *p - tilt };
                }
            }
        }
    }

    /// Fluxes through the faces inside and at both ends of a row, and their differences.
    fn cross_row<S: Solver, const ENERGY: bool>(
        &self,
        row: Row<D>,
        j: usize,
        work: &mut Work<'_, R, D>,
        report: &mut Report<R, D>,
    ) {
        let s = self.size;
        let (n, m) = (s.n, s.m);
        let from = (&*work.half, &*work.slope[0], &*work.metric.weight[0]);
        self.states(true, 0, from, work.left, m, 1);
        self.states(false, 0, from, work.right, m, 0);
        let gas = self.problem.gas;
        let inner_low = row::face_state::<R, D>(work.right, m, 0);
        let inner_high = row::face_state::<R, D>(work.left, m, n);
        let (low, high) = if self.periodic[0] {
            (inner_high, inner_low)
        } else {
            let [a, b] = &self.problem.boundaries[0];
            (a.ghost(&inner_low, 0, true, gas), b.ghost(&inner_high, 0, false, gas))
        };
        row::put_state(work.left, m, 0, &low);
        work.left[(D + 2) * m] = low.pressure;
        row::put_state(work.right, m, n, &high);
        work.right[(D + 2) * m + n] = high.pressure;

        let openings = match &self.medium {
            None => Openings::None,
            Some(medium) => {
                let face = &medium.porosity.faces[0][medium.mesh.face(0, row.at)..][..m];
                match self.problem.scheme.pressure {
                    PressureForm::Geometric => Openings::Geometric(face),
                    PressureForm::Paper => {
                        let volume = &medium.porosity.volume[row.start..][..n];
                        work.metric.vol_left[1..].copy_from_slice(volume);
                        work.metric.vol_right[..n].copy_from_slice(volume);
                        work.metric.vol_left[0] = if self.periodic[0] { volume[n - 1] } else { volume[0] };
                        work.metric.vol_right[n] = if self.periodic[0] { volume[0] } else { volume[n - 1] };
                        Openings::Paper(face, work.metric.vol_left, work.metric.vol_right)
                    }
                }
            }
        };
        row::fluxes::<R, S, D, ENERGY>(work.left, work.right, openings, &self.face_gas, work.flux, m);
        if let Some(medium) = &self.medium {
            let marks = &medium.porosity.marks[row.start..][..n];
            if marks.iter().fold(0, |a, b| a | b) & (jump_low(0) | jump_high(0)) != 0 {
                for i in 0..=n {
                    let jump = if i < n { marks[i] & jump_low(0) != 0 } else { marks[n - 1] & jump_high(0) != 0 };
                    if jump {
                        let mut at = row.at;
                        at[0] = i;
                        self.jump(medium, 0, at, (work.left, work.right), work.flux, m, i);
                    }
                }
            }
        }
        let flux = &*work.flux;
        for (side, i) in [(0, 0), (1, n)] {
            let wall = if side == 0 { &*work.right } else { &*work.left };
            self.count_inflow::<ENERGY>(0, side, row, (flux, wall), m, i, 1, report);
        }
        let inv = &*work.metric.inv_width;
        let weight = self.half_weight(0, &mut *work.metric.spare, &work.metric.weight);
        row::differences::<R, D, ENERGY>(
            0,
            |v| &var(flux, v, m)[..n],
            |v| &var(flux, v, m)[1..],
            |i| inv[i],
            weight,
            &mut work.change[0][j * Self::V * n..][..Self::V * n],
            n,
        );
    }

    /// ½ g dx of a row along `d`, if gravity acts there.
    fn half_weight<'s>(&self, d: usize, spare: &'s mut [R], weight: &[&mut [R]; D]) -> Option<&'s [R]> {
        if !(self.weighted && self.problem.gravity[d] != R::ZERO) {
            return None;
        }
        for i in 0..self.size.n {
            spare[i] = R::HALF * weight[d][i];
        }
        Some(spare)
    }

    /// Replaces the flux at one flagged face.
    fn jump(
        &self,
        medium: &Medium<'_, R, D>,
        d: usize,
        at: [usize; D],
        (left, right): (&[R], &[R]),
        flux: &mut [R],
        m: usize,
        i: usize,
    ) {
        let (l, r) = (row::face_state::<R, D>(left, m, i), row::face_state::<R, D>(right, m, i));
        let face = medium.porosity.faces[d][medium.mesh.face(d, at)];
        let (area_l, area_r) = medium.ducts(d, at, self.periodic[d]);
        let f = jump_flux(
            self.problem.scheme.riemann,
            (&l, &r),
            (area_l, face, area_r),
            (left[(D + 2) * m + i], right[(D + 2) * m + i]),
            &self.face_gas,
            &self.throat,
        );
        flux[i] = f.through.mass;
        flux[m + i] = f.left;
        for c in 1..D {
            flux[(1 + c) * m + i] = f.through.momentum[c];
        }
        flux[(D + 1) * m + i] = f.through.energy;
        flux[(D + 2) * m + i] = f.right;
    }

    /// Fluxes of a row of faces across axis `d` > 0 between `left` and `work.right`, into `work.flux`. `at` names the row of
    /// cells above the faces, with `at[d]` one past the end at the upper boundary.
    fn cross_faces<S: Solver, const ENERGY: bool>(
        &self,
        d: usize,
        at: [usize; D],
        left: &[R],
        right: &[R],
        flux: &mut [R],
    ) {
        let n = self.size.n;
        let cells = self.problem.mesh.cells()[d];
        let row_of = |k: usize| {
            let mut a = at;
            a[d] = k;
            self.problem.mesh.index(a)
        };
        let k = at[d];
        let above = row_of(if k < cells {
            k
        } else if self.periodic[d] {
            0
        } else {
            cells - 1
        });
        let below = row_of(if k > 0 {
            k - 1
        } else if self.periodic[d] {
            cells - 1
        } else {
            0
        });
        let openings = match &self.medium {
            None => Openings::None,
            Some(medium) => {
                let face = &medium.porosity.faces[d][medium.mesh.face(d, at)..][..n];
                match self.problem.scheme.pressure {
                    PressureForm::Geometric => Openings::Geometric(face),
                    PressureForm::Paper => {
                        let volume = medium.porosity.volume;
                        Openings::Paper(face, &volume[below..][..n], &volume[above..][..n])
                    }
                }
            }
        };
        row::fluxes::<R, S, D, ENERGY>(left, right, openings, &self.face_gas, flux, n);
        if let Some(medium) = &self.medium {
            let (start, bit) = if k < cells { (row_of(k), jump_low(d)) } else { (row_of(cells - 1), jump_high(d)) };
            let marks = &medium.porosity.marks[start..][..n];
            if marks.iter().fold(0, |a, b| a | b) & bit != 0 {
                for i in 0..n {
                    if marks[i] & bit != 0 {
                        let mut face = at;
                        face[0] = i;
                        self.jump(medium, d, face, (left, right), flux, n, i);
                    }
                }
            }
        }
    }

    /// Ghost states beside the boundary faces of axis `d`, from the inner face states.
    fn ghosts(&self, d: usize, low: bool, inner: &[R], out: &mut [R]) {
        let n = self.size.n;
        let boundary = &self.problem.boundaries[d][usize::from(!low)];
        for i in 0..n {
            let w = boundary.ghost(&row::face_state::<R, D>(inner, n, i), d, low, self.problem.gas);
            row::put_state(out, n, i, &w);
            out[(D + 2) * n + i] = w.pressure;
        }
    }

    /// Faces between the present row and the one below it along axis 1 of a 3D mesh, and the changes of the row below.
    fn cross_middle<S: Solver, const ENERGY: bool>(
        &self,
        layer: usize,
        j: isize,
        row: Option<Row<D>>,
        work: &mut Work<'_, R, D>,
        report: &mut Report<R, D>,
    ) {
        let n = self.size.n;
        let f = Self::F * n;
        let d = 1 % D;
        let rows = self.size.rows as isize;
        let mut at = [0; D];
        at[D - 1] = layer;
        at[d] = j as usize;
        if row.is_some() {
            let from = (&*work.half, &*work.slope[d], &*work.metric.weight[d]);
            self.states(false, d, from, &mut work.right[..f], n, 0);
            if j == 0 && !self.periodic[d] {
                self.ghosts(d, true, &work.right[..f], &mut work.middle.state[..f]);
            }
        } else {
            self.ghosts(d, false, &work.middle.state[..f], &mut work.right[..f]);
        }
        self.cross_faces::<S, ENERGY>(d, at, &work.middle.state[..f], &work.right[..f], &mut work.flux[..f]);
        let mut of_row = at;
        for (side, edge) in [(0, 0), (1, rows)] {
            if j == edge {
                of_row[d] = if side == 0 { 0 } else { self.size.rows - 1 };
                let row = Row { start: self.problem.mesh.index(of_row), at: of_row };
                let wall = if side == 0 { &work.right[..f] } else { &work.middle.state[..f] };
                self.count_inflow::<ENERGY>(d, side, row, (&work.flux[..f], wall), n, 0, n, report);
            }
        }
        if j > 0 {
            let below = j as usize - 1;
            let inv = R::ONE / self.problem.mesh.widths[d][below];
            let g = self.gravity_half(d, below, &mut *work.metric.spare);
            let (low, high) = (&*work.middle.flux, &*work.flux);
            row::differences::<R, D, ENERGY>(
                d,
                |v| var(low, v, n),
                |v| var(high, v, n),
                |_| inv,
                g,
                &mut work.change[d][below * Self::V * n..][..Self::V * n],
                n,
            );
        }
        core::mem::swap(&mut work.middle.flux, &mut work.flux);
    }

    fn gravity_half<'s>(&self, d: usize, k: usize, spare: &'s mut [R]) -> Option<&'s [R]> {
        if !(self.weighted && self.problem.gravity[d] != R::ZERO) {
            return None;
        }
        let spare = &mut spare[..self.size.n];
        spare.fill(R::HALF * self.problem.gravity[d] * self.problem.mesh.widths[d][k]);
        Some(spare)
    }

    fn keep_middle(&self, work: &mut Work<'_, R, D>) {
        let n = self.size.n;
        let d = 1 % D;
        let from = (&*work.half, &*work.slope[d], &*work.metric.weight[d]);
        self.states(true, d, from, &mut work.middle.state[..Self::F * n], n, 0);
    }

    fn keep_last(&self, j: usize, work: &mut Work<'_, R, D>) {
        let n = self.size.n;
        let from = (&*work.half, &*work.slope[D - 1], &*work.metric.weight[D - 1]);
        self.states(true, D - 1, from, &mut work.last.state[j * Self::F * n..][..Self::F * n], n, 0);
    }

    /// Faces between row `j` of layer `l` and of the layer below, and the changes of the layer below.
    fn cross_last<S: Solver, const ENERGY: bool>(
        &self,
        l: isize,
        j: usize,
        row: Option<Row<D>>,
        work: &mut Work<'_, R, D>,
        report: &mut Report<R, D>,
    ) {
        let n = self.size.n;
        let f = Self::F * n;
        let d = D - 1;
        let n_last = self.problem.mesh.cells()[d];
        let own = j * f..(j + 1) * f;
        let mut at = [0; D];
        if D == 3 {
            at[1] = j;
        }
        at[d] = l as usize;
        if row.is_some() {
            let from = (&*work.half, &*work.slope[d], &*work.metric.weight[d]);
            self.states(false, d, from, &mut work.right[..f], n, 0);
            if l == 0 && !self.periodic[d] {
                self.ghosts(d, true, &work.right[..f], &mut work.last.state[own.clone()]);
            }
        } else {
            self.ghosts(d, false, &work.last.state[own.clone()], &mut work.right[..f]);
        }
        self.cross_faces::<S, ENERGY>(d, at, &work.last.state[own.clone()], &work.right[..f], &mut work.flux[..f]);
        // A face between two slabs is computed by both; a boundary face is counted by the slab inside.
        let (lo, hi) = (self.slab.start as isize, self.slab.end as isize);
        for (side, edge, mine) in [(0, 0, lo == 0), (1, n_last as isize, hi == n_last as isize)] {
            if l == edge && mine {
                let mut of_row = at;
                of_row[d] = if side == 0 { 0 } else { n_last - 1 };
                let row = Row { start: self.problem.mesh.index(of_row), at: of_row };
                let wall = if side == 0 { &work.right[..f] } else { &work.last.state[own.clone()] };
                self.count_inflow::<ENERGY>(d, side, row, (&work.flux[..f], wall), n, 0, n, report);
            }
        }
        if l > lo {
            let below = l as usize - 1;
            let inv = R::ONE / self.problem.mesh.widths[d][below];
            let g = self.gravity_half(d, below, &mut *work.metric.spare);
            let (low, high) = (&work.last.flux[own.clone()], &*work.flux);
            row::differences::<R, D, ENERGY>(
                d,
                |v| var(low, v, n),
                |v| var(high, v, n),
                |_| inv,
                g,
                &mut work.change[d][j * Self::V * n..][..Self::V * n],
                n,
            );
        }
        work.last.flux[own].copy_from_slice(&work.flux[..f]);
    }

    /// Adds what enters through `count` boundary faces from index `i` of a flux block; `wall` is the block of face states
    /// inside, whose reference pressure the flux is counted from.
    fn count_inflow<const ENERGY: bool>(
        &self,
        d: usize,
        side: usize,
        row: Row<D>,
        (flux, wall): (&[R], &[R]),
        m: usize,
        i: usize,
        count: usize,
        report: &mut Report<R, D>,
    ) {
        let sign = if side == 0 { self.dt } else { -self.dt };
        let mut total = Conserved { density: R::ZERO, momentum: [R::ZERO; D], energy: R::ZERO };
        for f in 0..count {
            let mut at = row.at;
            if d != 0 {
                at[0] = f;
            } else if side == 1 {
                at[0] = self.size.n - 1;
            }
            let area = self.problem.mesh.volume(at) / self.problem.mesh.widths[d][at[d]];
            let weight = sign * area;
            let normal = if side == 0 { D + 2 } else { 1 };
            let open = match &self.medium {
                None => R::ONE,
                Some(medium) => {
                    let (low, high) = medium.openings(d, at);
                    if side == 0 { low } else { high }
                }
            };
            total.density += weight * flux[i + f];
            let mut momentum = [R::ZERO; D];
            momentum[0] = weight * (flux[normal * m + i + f] + open * wall[(D + 2) * m + i + f]);
            for c in 1..D {
                momentum[c] = weight * flux[(1 + c) * m + i + f];
            }
            let momentum = rotate_back(momentum, d);
            for c in 0..D {
                total.momentum[c] += momentum[c];
            }
            if ENERGY {
                total.energy += weight * flux[(D + 1) * m + i + f];
            }
        }
        let into = &mut report.inflow[d][side];
        into.density += total.density;
        into.energy += total.energy;
        for c in 0..D {
            into.momentum[c] += total.momentum[c];
        }
    }

    // --- the new state -----------------------------------------------------------------------------------------------

    fn finish_below<const ENERGY: bool>(
        &self,
        l: isize,
        j: usize,
        work: &mut Work<'_, R, D>,
        new: &mut FieldsMut<'_, R, D>,
        report: &mut Report<R, D>,
    ) {
        let mut at = [0; D];
        if D == 3 {
            at[1] = j;
        }
        at[D - 1] = l as usize - 1;
        let row = Row { start: self.problem.mesh.index(at), at };
        let to = row.start - self.slab.start * self.problem.mesh.layer();
        self.finish::<ENERGY>(row, j, work, new, to, report);
    }

    /// New states of a row, drag included; their signal rate and whether they are physical.
    fn finish<const ENERGY: bool>(
        &self,
        row: Row<D>,
        j: usize,
        work: &mut Work<'_, R, D>,
        new: &mut FieldsMut<'_, R, D>,
        to: usize,
        report: &mut Report<R, D>,
    ) {
        let n = self.size.n;
        let mesh = &self.problem.mesh;
        let metric = &mut work.metric;
        let change = core::array::from_fn(|d| &work.change[d][j * Self::V * n..][..Self::V * n]);
        let scale = if let Some(medium) = &self.medium {
            let volume = &medium.porosity.volume[row.start..][..n];
            let (inv, scale) = (&mut metric.spare[..n], &mut metric.scale[..n]);
            for i in 0..n {
                inv[i] = R::ONE / greater(volume[i], least_volume());
                scale[i] = self.dt * inv[i];
            }
            for d in 0..D {
                let (low, high) = self.face_rows(medium, d, row);
                let open = &mut metric.open[d][..n];
                for i in 0..n {
                    open[i] = greater(low[i], high[i]) * inv[i];
                }
            }
            let marks = &medium.porosity.marks[row.start..][..n];
            if marks.iter().any(|&b| b & !SEALED != 0) {
                for i in 0..n {
                    if marks[i] & !SEALED != 0 {
                        let mut at = row.at;
                        at[0] = i;
                        for d in 0..D {
                            let jump = marks[i] & (jump_low(d) | jump_high(d)) != 0;
                            if jump || marks[i] & SMALL != 0 {
                                metric.open[d][i] = self.problem.openness(medium, row.start + i, at, d);
                            }
                        }
                    }
                }
            }
            Some(&metric.scale[..n])
        } else {
            None
        };
        row::update::<R, D, ENERGY>(self.old, row.start, &change, scale, self.dt, new, to, n);
        if let Some(drag) = &self.problem.drag {
            for i in 0..n {
                let coefficients = drag.at(row.start + i);
                if !coefficients.is_free() {
                    let (before, mut after) = (self.old.get(row.start + i), new.get(to + i));
                    let u = before.momentum.map(|m| m / before.density);
                    let pushed = after.momentum.map(|m| m / after.density);
                    let v = coefficients.step(u, pushed, self.dt);
                    after.momentum = v.map(|v| after.density * v);
                    new.set(to + i, &after);
                }
            }
        }
        let inv_width = &*metric.inv_width;
        let across: [R; D] = core::array::from_fn(|d| R::ONE / mesh.widths[d][row.at[d]]);
        let inverse = |d: usize, i: usize| if d == 0 { inv_width[i] } else { across[d] };
        let open = metric.open.each_ref().map(|o| &**o);
        let signal = &mut metric.signal[..n];
        let view = new.as_fields();
        let bad = if self.medium.is_some() {
            row::signal_rates::<R, D, true>(self.problem.gas, &view, to, inverse, &open, signal)
        } else {
            row::signal_rates::<R, D, false>(self.problem.gas, &view, to, inverse, &open, signal)
        };
        // Cells of clusters are judged after merging.
        let small = match &self.medium {
            Some(medium) if !self.problem.clusters.0.is_empty() => {
                Some(&medium.porosity.marks[row.start..][..n]).filter(|m| m.iter().any(|&b| b & SMALL != 0))
            }
            _ => None,
        };
        if let Some(marks) = small {
            for i in 0..n {
                if marks[i] & SMALL != 0 {
                    signal[i] = R::ZERO;
                }
            }
        }
        report.rate = greater(row::largest(signal), report.rate);
        if bad {
            for i in 0..n {
                let merged = small.is_some_and(|m| m[i] & SMALL != 0);
                report.unphysical += usize::from(!merged && !self.problem.is_physical(&view.get(to + i)));
            }
        }
    }
}

/// Scales of the differences to the lower and upper neighbour on a stretched axis: own width over the distance of the centres.
fn stretch<R: Real>(widths: &[R], i: usize) -> (R, R) {
    let own = widths[i];
    let low = if i > 0 { widths[i - 1] } else { own };
    let high = if i + 1 < widths.len() { widths[i + 1] } else { own };
    (R::TWO * own / (own + low), R::TWO * own / (own + high))
}
