//! A flow that owns its memory and steps on all threads.
//!
//! [`Flow`] is the core's [`Problem`] with storage: two fields, porosity and drag, scratch for each thread. Each thread
//! advances its own slab of layers; the bits of the state are the same for any number of threads.

mod contents;
mod field;
mod places;
mod slabs;
mod watch;

use crate::huge::HugeVec;
use slabs::{Working, step};
use voidage_core::flow::{
    Boundary, Drag, Error, Feed, Fractions, Gas, Merging, Mesh, Patch, Prepared, PreparedView, Primitive, Problem,
    Report, Scheme, cluster_scratch, prepare, stable_step,
};
use watch::Watch;

pub use field::{Field, Scalar};
pub use voidage_core::flow::{CellPush, Tidied, Treatment};

/// Open fractions that a flow owns.
type Space<R, const D: usize> = Prepared<HugeVec<R>, HugeVec<u8>, Vec<u32>, D>;

/// Drag coefficients of all cells; an empty vector stands for zero.
#[derive(Clone, Debug)]
struct Resistance<R: Scalar, const D: usize> {
    quadratic: [HugeVec<R>; D],
    linear: [HugeVec<R>; D],
}

/// How far a flow has come: with the state and the boundaries, all that it needs to go on to the bit.
#[derive(Clone, Copy, Debug)]
pub struct Clock<R, const D: usize> {
    /// Time reached.
    pub time: R,
    /// Steps done.
    pub steps: usize,
    /// Steps repeated with a smaller dt.
    pub repeated: usize,
    /// Sums over all steps; the rate is the present one.
    pub total: Report<R, D>,
}

/// A flow in progress.
#[derive(Clone, Debug)]
pub struct Flow<R: Scalar, const D: usize> {
    widths: [Vec<R>; D],
    gas: Gas<R>,
    /// Low and high side of each axis; may change between steps.
    pub boundaries: [[Boundary<R, D>; 2]; D],
    /// Parts of the sides where something else stands; of those that overlap, the last. May change between steps.
    pub patches: Vec<Patch<R, D>>,
    /// Of a mixed gas the ratios of specific heats that far fields and inlets feed, low and high side of each axis; the lowest of the gas, if not told.
    pub feed_sides: [[R; 2]; D],
    /// The same of each patch; empty for the lowest.
    pub feed_patches: Vec<R>,
    /// Choices of the scheme.
    pub scheme: Scheme,
    /// Acceleration of gravity.
    pub gravity: [R; D],
    space: Option<Space<R, D>>,
    resistance: Option<Resistance<R, D>>,
    /// The present state; may be changed between steps.
    pub state: Field<R, D>,
    next: Field<R, D>,
    marks: Vec<u8>,
    scratch: Vec<HugeVec<R>>,
    watch: Option<Watch<R, D>>,
    rate: Option<R>,
    /// First steps to take at a fifth of the stable step: a blast starts from states whose speeds the estimate cannot know.
    pub careful_steps: usize,
    /// Time reached.
    pub time: R,
    /// Steps done.
    pub steps: usize,
    /// Sums over all steps: fallbacks, floors, inflow. The rate is the present one.
    pub total: Report<R, D>,
    /// Steps repeated with a smaller dt to avoid a floor.
    pub repeated: usize,
}

/// Share of the stable step that careful steps take.
const CAREFUL_SHARE: f64 = 0.2;

/// A CFL number of steps that are to be stable; NaN is none.
fn is_stable<R: Scalar>(cfl: R) -> bool {
    cfl > R::ZERO && cfl <= R::ONE
}

impl<R: Scalar, const D: usize> Flow<R, D> {
    /// A flow on cells of the given widths; the state is to be set.
    pub fn new(widths: [Vec<R>; D], gas: Gas<R>, boundaries: [[Boundary<R, D>; 2]; D]) -> Self {
        let cells = widths.iter().map(Vec::len).product();
        Flow {
            widths,
            gas,
            boundaries,
            patches: Vec::new(),
            feed_sides: [[gas.gamma(); 2]; D],
            feed_patches: Vec::new(),
            scheme: Scheme::default(),
            gravity: [R::ZERO; D],
            space: None,
            resistance: None,
            state: Field::new(cells, gas),
            next: Field::new(cells, gas),
            marks: vec![0; cells],
            scratch: Vec::new(),
            watch: None,
            rate: None,
            careful_steps: 0,
            time: R::ZERO,
            steps: 0,
            total: Report::new(),
            repeated: 0,
        }
    }

    /// Cells of equal widths along each axis.
    pub fn uniform(cells: [usize; D], width: [R; D], gas: Gas<R>, boundaries: [[Boundary<R, D>; 2]; D]) -> Self {
        Self::new(std::array::from_fn(|d| vec![width[d]; cells[d]]), gas, boundaries)
    }

    /// Gives the space its open fractions, 0 to 1. Fractions within a few rounding errors of 0 (negative ones too) count as 0:
    /// geometry leaves such dust where a cell is closed. Returns what was changed.
    ///
    /// # Errors
    /// An array does not fit the mesh, or a fraction is NaN or not from 0 to 1.
    pub fn set_porosity(
        &mut self,
        volume: Vec<R>,
        faces: [Vec<R>; D],
        treatment: Treatment<R>,
    ) -> Result<Tidied, Error> {
        let periodic = self.boundaries.map(|b| b[0].is_periodic());
        let flags = HugeVec::zeros(volume.len());
        let fractions = Fractions { volume: volume.into(), faces: faces.map(Into::into), flags };
        let space = prepare(&self.mesh()?, periodic, fractions, treatment, |cells| Merging {
            list: vec![0; cells],
            parent: vec![0; cells],
            scratch: HugeVec::zeros(cluster_scratch(cells)),
        })?;
        let tidied = space.tidied();
        self.space = Some(space);
        self.rate = None;
        Ok(tidied)
    }

    /// Gives the cells their drag, CR in 1/length and the linear coefficient in 1/time; empty vectors stand for zero.
    ///
    /// # Errors
    /// [`Error::ShapeMismatch`]: neither empty nor a number for each cell; [`Error::Drag`]: negative or not finite. What was there stays.
    pub fn set_drag(&mut self, quadratic: [Vec<R>; D], linear: [Vec<R>; D]) -> Result<(), Error> {
        for (axis, along) in quadratic.iter().enumerate().chain(linear.iter().enumerate()) {
            if !along.is_empty() && along.len() != self.len() {
                return Err(Error::ShapeMismatch { expected: self.len(), found: along.len() });
            }
            if let Some(cell) = along.iter().position(|&c| !(c >= R::ZERO && c.is_finite())) {
                return Err(Error::Drag { axis, cell });
            }
        }
        self.resistance = Some(Resistance { quadratic: quadratic.map(Into::into), linear: linear.map(Into::into) });
        Ok(())
    }

    /// Cells along each axis.
    pub fn cells(&self) -> [usize; D] {
        self.widths.each_ref().map(Vec::len)
    }

    /// Cells in all.
    pub fn len(&self) -> usize {
        self.state.density.len()
    }

    /// No cell at all.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The gas.
    pub fn gas(&self) -> Gas<R> {
        self.gas
    }

    /// Cells merged into clusters.
    pub fn merged_cells(&self) -> usize {
        self.space.as_ref().map_or(0, Prepared::merged_cells)
    }

    /// The cells of each cluster, which share one state.
    pub fn clusters(&self) -> Vec<Vec<usize>> {
        self.porosity().map_or_else(Vec::new, |p| p.clusters().map(Iterator::collect).collect())
    }

    /// Faces where the porosity jumps and the throat map acts.
    pub fn jump_faces(&self) -> usize {
        self.porosity().map_or(0, |p| p.jump_faces())
    }

    /// Open fractions of the cells, if the space has any.
    pub fn beta_v(&self) -> Option<&[R]> {
        self.porosity().map(|p| p.volume())
    }

    /// Open fractions of the faces, axis by axis, if the space has any.
    pub fn faces(&self) -> impl Iterator<Item = &[R]> {
        self.porosity().into_iter().flat_map(|p| p.faces())
    }

    fn porosity(&self) -> Option<PreparedView<'_, R, D>> {
        self.space.as_ref().map(|s| s.view())
    }

    /// Drag coefficients, the quadratic ones of each axis first, if there are any.
    pub fn drag(&self) -> impl Iterator<Item = &[R]> {
        self.resistance.iter().flat_map(|r| r.quadratic.iter().chain(&r.linear).map(|c| &c[..]))
    }

    /// How far the flow has come.
    ///
    /// # Errors
    /// As [`Flow::rate`].
    pub fn clock(&mut self) -> Result<Clock<R, D>, Error> {
        let rate = self.rate()?;
        Ok(Clock { time: self.time, steps: self.steps, repeated: self.repeated, total: Report { rate, ..self.total } })
    }

    /// Puts the flow where another with the same problem stood.
    ///
    /// # Errors
    /// The field does not fit.
    pub fn resume(&mut self, state: Field<R, D>, clock: Clock<R, D>) -> Result<(), Error> {
        let fits = |a: &[R], b: &[R]| match (a.len(), b.len()) {
            (expected, found) if expected != found => Err(Error::ShapeMismatch { expected, found }),
            _ => Ok(()),
        };
        fits(&self.state.density, &state.density)?;
        fits(&self.state.energy, &state.energy)?;
        fits(&self.state.capacity, &state.capacity)?;
        (0..D).try_for_each(|d| fits(&self.state.momentum[d], &state.momentum[d]))?;
        let Clock { time, steps, repeated, total } = clock;
        (self.state, self.rate) = (state, Some(total.rate));
        (self.time, self.steps, self.repeated, self.total) = (time, steps, repeated, total);
        Ok(())
    }

    /// Memory of the state and the solver's own, without porosity and drag, in units of one conserved field.
    pub fn memory_ratio(&self) -> f64 {
        let bytes = |f: &Field<R, D>| {
            let momentum = f.momentum.iter().map(|m| m.len()).sum::<usize>();
            (f.density.len() + momentum + f.energy.len() + f.capacity.len()) * size_of::<R>()
        };
        let scratch: usize = self.scratch.iter().map(|s| s.len() * size_of::<R>()).sum();
        (bytes(&self.state) + bytes(&self.next) + self.marks.len() + scratch) as f64 / bytes(&self.state) as f64
    }

    /// Runs a closure with the problem and the two fields.
    fn with_problem<T>(
        &mut self,
        f: impl FnOnce(&Problem<'_, R, D>, &Field<R, D>, &mut Field<R, D>, Working<'_, R, D>) -> Result<T, Error>,
    ) -> Result<T, Error> {
        let mesh = Mesh::new(self.widths.each_ref().map(|w| w.as_slice()))?;
        let mut problem =
            Problem::new(mesh, self.gas, self.boundaries)?.with_scheme(self.scheme).with_gravity(self.gravity);
        problem = problem.with_patches(&self.patches)?;
        if self.gas.is_mixed() {
            problem = problem.with_feed(Feed { sides: self.feed_sides, patches: &self.feed_patches })?;
        }
        if let Some(space) = &self.space {
            problem = problem.with_porosity(space.view())?;
        }
        if let Some(r) = &self.resistance {
            problem = problem.with_drag(Drag {
                quadratic: r.quadratic.each_ref().map(|q| &**q),
                linear: r.linear.each_ref().map(|q| &**q),
            })?;
        }
        let working = Working { marks: &mut self.marks, scratch: &mut self.scratch, watch: self.watch.as_mut() };
        f(&problem, &self.state, &mut self.next, working)
    }

    /// Sets every cell from the coordinates of its centre (the origin of the mesh is 0). A mixed gas has its lowest ratio of specific heats there.
    pub fn fill(&mut self, f: impl Fn([R; D]) -> Primitive<R, D>) {
        let gamma = self.gas.gamma();
        self.fill_mixed(|x| (f(x), gamma));
    }

    /// The same with the ratio of specific heats of the gas there, which counts in a mixed gas.
    pub fn fill_mixed(&mut self, f: impl Fn([R; D]) -> (Primitive<R, D>, R)) {
        let centres: [Vec<R>; D] = self.widths.each_ref().map(|w| {
            let mut edge = R::ZERO;
            w.iter()
                .map(|&w| {
                    edge += w;
                    edge - R::HALF * w
                })
                .collect()
        });
        let cells = self.cells();
        for cell in 0..self.len() {
            let mut rest = cell;
            let x = std::array::from_fn(|d| {
                let i = rest % cells[d];
                rest /= cells[d];
                centres[d][i]
            });
            let (w, gamma) = f(x);
            self.set_mixed(cell, &w, gamma);
        }
    }

    /// Sets one cell; where there is none, nothing. A mixed gas has its lowest ratio of specific heats there.
    pub fn set(&mut self, cell: usize, w: &Primitive<R, D>) {
        self.set_mixed(cell, w, self.gas.gamma());
    }

    /// Sets one cell and the ratio of specific heats of the gas there, which counts in a mixed gas.
    pub fn set_mixed(&mut self, cell: usize, w: &Primitive<R, D>, gamma: R) {
        let gas = if self.gas.is_mixed() { Gas::Ideal { gamma } } else { self.gas };
        let mut view = self.state.view_mut();
        view.set(cell, &gas.conserved(w));
        if let Some(capacity) = view.capacity.get_mut(cell) {
            *capacity = gas.capacity();
        }
        self.rate = None;
    }

    /// One cell.
    ///
    /// # Panics
    /// If there is no such cell, as an index does.
    pub fn get(&self, cell: usize) -> Primitive<R, D> {
        self.gas_at(cell).primitive(&self.state.view().get(cell).expect("a cell of the mesh"))
    }

    /// The gas in a cell.
    pub fn gas_at(&self, cell: usize) -> Gas<R> {
        self.state.view().gas_at(self.gas, cell)
    }

    fn mesh(&self) -> Result<Mesh<'_, R, D>, Error> {
        Mesh::new(self.widths.each_ref().map(|w| w.as_slice()))
    }

    /// Watches from now on what acts on the walls of some cells, on what drags in them, and what passes their faces, with pressures counted from
    /// `reference`. Until the next step that is the pressure of each cell, the drag at its velocity, and the mean of both cells at a face.
    pub fn watch_walls(&mut self, mut cells: Vec<usize>, reference: R) {
        cells.sort_unstable();
        cells.dedup();
        cells.retain(|&cell| cell < self.len());
        let pushes = cells.iter().map(|&cell| self.push_of_state(cell, reference)).collect();
        self.watch = (!cells.is_empty()).then_some(Watch { cells, pushes, reference });
    }

    /// The same cells again, from the present state.
    pub fn watch_walls_anew(&mut self) {
        if let Some(Watch { cells, reference, .. }) = self.watch.take() {
            self.watch_walls(cells, reference);
        }
    }

    /// The watched cells, ascending, and what acted on their walls in the last step.
    pub fn watched_walls(&self) -> (&[usize], &[CellPush<R, D>]) {
        self.watch.as_ref().map_or((&[], &[]), |watch| (&watch.cells, &watch.pushes))
    }

    /// Puts back what acted on the walls of the watched cells, as [`Flow::watched_walls`] gave it; what is not as long is left alone.
    pub fn restore_walls(&mut self, pushes: &[CellPush<R, D>]) {
        if let Some(watch) = self.watch.as_mut().filter(|watch| watch.pushes.len() == pushes.len()) {
            watch.pushes.copy_from_slice(pushes);
        }
    }

    /// What the present state alone tells of the walls of a cell.
    fn push_of_state(&self, cell: usize, reference: R) -> CellPush<R, D> {
        let (w, at) = (self.get(cell), self.coordinates(cell));
        let speed = w.velocity.iter().fold(R::ZERO, |s, &u| s + u * u).sqrt();
        let faces: Vec<&[R]> = self.faces().collect();
        let closed = |d: usize, side: usize| faces.get(d).map_or(R::ZERO, |f| R::ONE - f[self.face(d, at, side)]);
        let open = self.beta_v().map_or(R::ONE, |open| open[cell]);
        let coefficient = |n: usize| self.drag().nth(n).and_then(|c| c.get(cell)).copied().unwrap_or(R::ZERO);
        let drag = |d: usize| {
            let rate = coefficient(D + d) + R::HALF * coefficient(d) * speed;
            open * w.density * rate * w.velocity[d]
        };
        let over = |d: usize, side: usize| {
            let tilt = R::HALF * w.density * self.gravity[d] * self.widths[d][at[d]];
            w.pressure + if side == 0 { -tilt } else { tilt } - reference
        };
        let passing = |d: usize, side: usize| {
            let other = self.behind(d, at, side).map_or(w, |cell| self.get(cell));
            let mean = R::HALF * (w.density * w.velocity[d] + other.density * other.velocity[d]);
            (R::ONE - closed(d, side)) * mean
        };
        CellPush {
            sides: std::array::from_fn(|d| [0, 1].map(|side| closed(d, side) * over(d, side))),
            along: [[[R::ZERO; D]; 2]; D],
            mass: std::array::from_fn(|d| [0, 1].map(|side| passing(d, side))),
            drag: std::array::from_fn(drag),
        }
    }

    /// Largest signal rate Σ_d w_d (|u_d| + c)/dx_d of the present state, w_d its open area over its open volume along d.
    pub fn rate(&mut self) -> Result<R, Error> {
        if let Some(rate) = self.rate {
            return Ok(rate);
        }
        let mut state = std::mem::replace(&mut self.state, Field::new(0, self.gas));
        let rate = self.with_problem(|problem, _, _, _| problem.start(&mut state.view_mut()));
        self.state = state;
        let rate = rate?;
        self.rate = Some(rate);
        Ok(rate)
    }

    /// The largest stable step at a CFL number; infinite where nothing can move.
    ///
    /// # Errors
    /// If the state is unphysical, or the CFL number is not positive.
    pub fn stable_dt(&mut self, cfl: R) -> Result<R, Error> {
        if !(cfl > R::ZERO) {
            return Err(Error::Step);
        }
        let rate = self.rate()?;
        let share = if self.steps < self.careful_steps { R::from_f64(CAREFUL_SHARE) } else { R::ONE };
        Ok(if rate > R::ZERO { cfl * share / rate } else { R::INFINITY })
    }

    /// Tells the flow that the caller has changed `state`.
    pub fn touched(&mut self) {
        self.rate = None;
    }

    /// One step of `dt`, whatever its stability. Returns what it did.
    ///
    /// # Errors
    /// The state is unphysical, or `dt` is negative or not finite.
    pub fn step(&mut self, dt: R) -> Result<Report<R, D>, Error> {
        self.rate()?;
        let report = self.attempt(dt)?;
        self.accept(self.time + dt, &report);
        Ok(report)
    }

    /// The next state by a step of `dt`.
    fn attempt(&mut self, dt: R) -> Result<Report<R, D>, Error> {
        self.with_problem(|problem, old, new, working| step(problem, old, new, working, dt))
    }

    /// The next state, at a time, becomes the present one.
    fn accept(&mut self, time: R, report: &Report<R, D>) {
        std::mem::swap(&mut self.state, &mut self.next);
        self.time = time;
        self.steps += 1;
        self.rate = Some(report.rate);
        let mut total = self.total.and(report);
        total.rate = report.rate;
        self.total = total;
    }

    /// One stable step that does not pass `end`; a step that would need floors is repeated with less.
    ///
    /// # Errors
    /// As [`Flow::stable_dt`] and [`Flow::step`]; `cfl` is above 1; `end` lies before the time reached, or one of them is NaN; or a stable step is too short to advance the time.
    pub fn advance(&mut self, cfl: R, end: R) -> Result<R, Error> {
        if !is_stable(cfl) {
            return Err(Error::Step);
        }
        let longest = self.stable_dt(cfl)?;
        let done = stable_step(self.time, end, longest, |dt| self.attempt(dt))?;
        self.accept(done.time, &done.report);
        self.repeated += done.repeated;
        Ok(done.dt)
    }

    /// Stable steps until `end`; none, if that is not after the time reached.
    ///
    /// # Errors
    /// As [`Flow::advance`]; a `cfl` that is not above 0 and at most 1 also if there is no step to do.
    pub fn run(&mut self, cfl: R, end: R) -> Result<(), Error> {
        if !is_stable(cfl) {
            return Err(Error::Step);
        }
        // Written so that a time or an end that is NaN is refused by a step.
        while !(self.time >= end) {
            self.advance(cfl, end)?;
        }
        Ok(())
    }
}
