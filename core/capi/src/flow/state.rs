//! The state of a flow along some axes, and its steps.

use super::case::{Checked, boundary};
use super::inlet::relax;
use super::totals::totals;
use crate::memory::Memory;
use crate::status::{Answer, Status};
use crate::types::{self, StepReport};
use voidage_core::flow::{
    Boundary, Conserved, Drag, Error, Fields, FieldsMut, Fractions, Gas, Merging, Mesh, Prepared, Primitive, Problem,
    Report, Scheme, Treatment, cluster_scratch, prepare, scratch_needed, stable_step,
};
use voidage_core::number::real::Real;

/// Slices of the block that a flow lies in. It is never freed while the flow is used.
type Block<T> = &'static mut [T];

/// Open fractions ready for steps.
type Space<R, const D: usize> = Prepared<Block<R>, Block<u8>, Block<u32>, D>;

/// A field that a flow owns.
struct Field<R: Real, const D: usize> {
    density: Block<R>,
    momentum: [Block<R>; D],
    energy: Block<R>,
}

impl<R: Real, const D: usize> Field<R, D> {
    fn new<M: Memory<'static>>(memory: &mut M, cells: usize, gas: Gas<R>) -> Self {
        let mut take = |count| memory.take(count, |_| R::ZERO);
        let density = take(cells);
        let momentum = core::array::from_fn(|_| take(cells));
        Field { density, momentum, energy: take(if gas.has_energy() { cells } else { 0 }) }
    }

    fn view(&self) -> Fields<'_, R, D> {
        let momentum = self.momentum.each_ref().map(|m| &**m);
        Fields { density: self.density, momentum, energy: self.energy, capacity: &[] }
    }

    fn view_mut(&mut self) -> FieldsMut<'_, R, D> {
        let momentum = self.momentum.each_mut().map(|m| &mut **m);
        FieldsMut { density: self.density, momentum, energy: self.energy, capacity: &mut [] }
    }
}

/// What stays the same during a step.
pub(super) struct Setup<R: Real, const D: usize> {
    /// The axes that flow, among x, y, z.
    pub live: [usize; D],
    widths: [Block<R>; D],
    pub gas: Gas<R>,
    scheme: Scheme,
    gravity: [R; D],
    /// Low and high side of each axis.
    pub boundaries: [[Boundary<R, D>; 2]; D],
    /// The time in which the pressure of an inlet follows.
    pub relax: [[R; 2]; D],
    space: Option<Space<R, D>>,
    drag: Option<[[Block<R>; D]; 2]>,
}

impl<R: Real, const D: usize> Setup<R, D> {
    pub fn mesh(&self) -> Result<Mesh<'_, R, D>, Error> {
        Mesh::new(self.widths.each_ref().map(|w| &**w))
    }

    /// Open fractions of the cells, and of the faces of each axis, if not all is open.
    pub fn openings(&self) -> Option<(&[R], [&[R]; D])> {
        self.space.as_ref().map(|space| (space.view().volume(), space.view().faces()))
    }

    fn problem(&self) -> Result<Problem<'_, R, D>, Error> {
        let problem = Problem::new(self.mesh()?, self.gas, self.boundaries)?;
        let mut problem = problem.with_scheme(self.scheme).with_gravity(self.gravity);
        if let Some(space) = &self.space {
            problem = problem.with_porosity(space.view())?;
        }
        if let Some([quadratic, linear]) = &self.drag {
            let (quadratic, linear) = (quadratic.each_ref().map(|q| &**q), linear.each_ref().map(|l| &**l));
            problem = problem.with_drag(Drag { quadratic, linear })?;
        }
        Ok(problem)
    }
}

/// A flow along `D` axes.
pub struct State<R: Real, const D: usize> {
    pub(super) setup: Setup<R, D>,
    /// The present state, and the next one.
    fields: [Field<R, D>; 2],
    flags: Block<u8>,
    scratch: Block<R>,
    /// The signal rate of the present state, if known.
    rate: Option<R>,
    time: R,
}

/// A copy of a slice in the caller's memory.
fn copied<R: Real, M: Memory<'static>>(memory: &mut M, from: &[R]) -> Block<R> {
    memory.take(from.len(), |n| from.get(n).copied().unwrap_or(R::ZERO))
}

impl<R: Real, const D: usize> State<R, D> {
    /// Takes memory for a case along the axes `live`; with `cut` the memory is there and the state is made, else it is only measured.
    pub fn new<M: Memory<'static>>(
        case: &Checked<R>,
        live: [usize; D],
        memory: &mut M,
        cut: bool,
    ) -> Answer<Option<Self>> {
        let cells = case.grid.cell_count();
        let lengths = live.map(|axis| case.grid.cells()[axis]);
        let widths = live.map(|axis| {
            let edges = case.grid.edges(axis);
            let width = |n: usize| Some(*edges.get(n + 1)? - *edges.get(n)?);
            memory.take(edges.len() - 1, |n| width(n).unwrap_or(R::ZERO))
        });
        let fields = [Field::new(memory, cells, case.gas), Field::new(memory, cells, case.gas)];
        let (flags, scratch) = (memory.take(cells, |_| 0), memory.take(scratch_needed(lengths), |_| R::ZERO));
        let mut drag = None;
        if case.drag.iter().flatten().any(|d| !d.is_empty()) {
            drag = Some(case.drag.map(|kind| live.map(|axis| copied(memory, kind[axis]))));
        }
        let space = case.beta.map(|beta| {
            let fractions = Fractions {
                volume: copied(memory, beta[0]),
                faces: live.map(|axis| copied(memory, beta[axis + 1])),
                flags: memory.take(cells, |_| 0),
            };
            let mut numbers = || memory.take(cells, |_| 0_u32);
            let (list, parent) = (numbers(), numbers());
            (fractions, Merging { list, parent, scratch: memory.take(cluster_scratch(cells), |_| R::ZERO) })
        });
        let (boundaries, relax) = sides(case, live)?;
        let gravity = live.map(|axis| case.gravity[axis]);
        if !cut {
            return Ok(None);
        }
        let (gas, scheme) = (case.gas, case.scheme);
        let mut setup = Setup { live, widths, gas, scheme, gravity, boundaries, relax, space: None, drag };
        if let Some((fractions, merging)) = space {
            let treatment = Treatment { jump: case.jump, merge: true };
            let periodic = boundaries.map(|b| b[0].is_periodic());
            setup.space = Some(prepare(&setup.mesh()?, periodic, fractions, treatment, |_| merging)?);
        }
        setup.problem()?;
        Ok(Some(State { setup, fields, flags, scratch, rate: None, time: R::ZERO }))
    }

    pub fn len(&self) -> usize {
        self.fields[0].density.len()
    }

    pub fn has_energy(&self) -> bool {
        self.setup.gas.has_energy()
    }

    /// Sets all cells from density, velocity along x, y, z, and pressure; what is empty counts as zero.
    pub fn set(&mut self, values: [&[R]; 5]) -> Answer {
        let (gas, live) = (self.setup.gas, self.setup.live);
        self.rate = None;
        let mut field = self.fields[0].view_mut();
        for cell in 0..field.density.len() {
            let value = |n: usize| values[n].get(cell).copied().unwrap_or(R::ZERO);
            let w = Primitive { density: value(0), velocity: live.map(|axis| value(axis + 1)), pressure: value(4) };
            field.set(cell, &gas.conserved(&w));
        }
        self.rate().map(|_| ())
    }

    /// Tells all cells, likewise.
    pub fn get(&self, mut values: [Option<&mut [R]>; 5]) {
        let view = self.fields[0].view();
        for cell in 0..self.len() {
            let Some(u) = view.get(cell) else { continue };
            let w = self.setup.gas.primitive(&u);
            let mut all = [w.density, R::ZERO, R::ZERO, R::ZERO, w.pressure];
            for (axis, velocity) in self.setup.live.into_iter().zip(w.velocity) {
                all[axis + 1] = velocity;
            }
            for (field, value) in values.iter_mut().zip(all) {
                if let Some(place) = field.as_mut().and_then(|field| field.get_mut(cell)) {
                    *place = value;
                }
            }
        }
    }

    /// The signal rate of the present state, which is made ready for its first step.
    pub fn rate(&mut self) -> Answer<R> {
        if let Some(rate) = self.rate {
            return Ok(rate);
        }
        let rate = self.setup.problem()?.start(&mut self.fields[0].view_mut())?;
        self.rate = Some(rate);
        Ok(rate)
    }

    /// The next field by a step of `dt`.
    fn attempt(&mut self, dt: R) -> Answer<Report<R, D>> {
        let [old, new] = &mut self.fields;
        let problem = self.setup.problem();
        let problem = problem.as_ref().map_err(|&refusal| refusal)?;
        Ok(problem.step(&old.view(), &mut new.view_mut(), dt, self.flags, self.scratch)?)
    }

    /// The next field, at a time and after a step of `dt`, becomes the present one.
    fn accept(&mut self, time: R, dt: R, report: &Report<R, D>, total: &mut StepReport<R>) -> Answer {
        self.fields.swap(0, 1);
        self.time = time;
        self.rate = Some(report.rate);
        (total.time, total.dt, total.rate) = (self.time, dt, report.rate);
        total.steps += 1;
        total.first_order += report.first_order as u64;
        total.floored += report.floored as u64;
        for (axis, sides) in self.setup.live.into_iter().zip(&report.inflow) {
            for (side, inflow) in sides.iter().enumerate() {
                add(&mut total.inflow[2 * axis + side], &by_axes(self.setup.live, inflow));
            }
        }
        Ok(relax(&mut self.setup, &self.fields[0].view(), dt)?)
    }

    /// One step, whatever its stability; `total` learns what it did.
    pub fn step(&mut self, dt: R, total: &mut StepReport<R>) -> Answer {
        self.rate()?;
        let report = self.attempt(dt);
        self.accept(self.time + dt, dt, report.as_ref().map_err(|&refusal| refusal)?, total)
    }

    /// Stable steps until `end`, or until `most` have been done; what has been done counts whatever the answer.
    pub fn advance(&mut self, end: R, cfl: R, most: u64) -> (StepReport<R>, Answer) {
        let mut total = StepReport { time: self.time, ..StepReport::default() };
        let mut answer = self.rate().map(|rate| total.rate = rate);
        while answer.is_ok() && self.time < end && total.steps < most {
            answer = self.stable_step(end, cfl, &mut total);
        }
        (total, answer)
    }

    /// One stable step that does not pass `end`; one that would need floors is repeated with half the time.
    fn stable_step(&mut self, end: R, cfl: R, total: &mut StepReport<R>) -> Answer {
        let (rate, time) = (self.rate()?, self.time);
        let longest = if rate > R::ZERO { cfl / rate } else { R::INFINITY };
        let mut tried = 0_u64;
        let done = stable_step(time, end, longest, |dt| {
            tried += 1;
            self.attempt(dt)
        });
        total.repeated += tried.saturating_sub(1);
        let done = done?;
        self.accept(done.time, done.dt, &done.report, total)
    }

    /// Mass, momentum along x, y, z and energy in the domain.
    pub fn totals(&self) -> [R; 5] {
        let found = totals(&self.setup, &self.fields[0].view());
        found.map_or([R::ZERO; 5], |found| by_axes(self.setup.live, &found))
    }

    /// Changes a side; that of a dead axis does not count.
    pub fn set_side(&mut self, number: usize, side: &types::Boundary<R>) -> Answer {
        let (found, time) =
            boundary(side, number / 2, self.setup.gas, self.setup.live).map_err(|refusal| refusal.index(number))?;
        let Some(d) = self.setup.live.iter().position(|&axis| axis == number / 2) else { return Ok(()) };
        let slot = &mut self.setup.boundaries[d][number % 2];
        if found.is_periodic() != slot.is_periodic() {
            return Err(Status::Periodic.of(c"side.kind").axis(number / 2));
        }
        *slot = found;
        self.setup.relax[d][number % 2] = time;
        Ok(())
    }
}

/// Low and high sides of the axes that flow, and the times in which inlets follow.
#[expect(clippy::type_complexity, reason = "two arrays of one shape")]
fn sides<R: Real, const D: usize>(
    case: &Checked<R>,
    live: [usize; D],
) -> Answer<([[Boundary<R, D>; 2]; D], [[R; 2]; D])> {
    let (mut boundaries, mut relax) = ([[Boundary::Wall; 2]; D], [[R::ZERO; 2]; D]);
    for (d, axis) in live.into_iter().enumerate() {
        for side in 0..2 {
            let number = 2 * axis + side;
            let found = boundary(&case.side[number], axis, case.gas, live).map_err(|refusal| refusal.index(number))?;
            (boundaries[d][side], relax[d][side]) = found;
        }
        let [low, high] = boundaries[d];
        if low.is_periodic() != high.is_periodic() {
            return Err(Status::Periodic.of(c"side.kind").axis(axis));
        }
    }
    Ok((boundaries, relax))
}

/// Mass, momentum along x, y, z and energy.
fn by_axes<R: Real, const D: usize>(live: [usize; D], amount: &Conserved<R, D>) -> [R; 5] {
    let mut all = [amount.density, R::ZERO, R::ZERO, R::ZERO, amount.energy];
    for (axis, momentum) in live.into_iter().zip(amount.momentum) {
        all[axis + 1] = momentum;
    }
    all
}

fn add<R: Real>(sum: &mut [R; 5], amount: &[R; 5]) {
    sum.iter_mut().zip(amount).for_each(|(sum, amount)| *sum += *amount);
}
