//! A flow that owns its memory and steps on all threads.
//!
//! [`Flow`] is the core's [`Problem`] with storage: two fields, porosity and drag, scratch for each thread. Each thread
//! advances its own slab of layers; the bits of the state are the same for any number of threads.

use rayon::prelude::*;
use voidage_core::pdr::merge;
use voidage_core::pdr::{
    Boundary, Clusters, Conserved, Drag, Error, Fields, FieldsMut, Gas, Mesh, Porosity, Primitive, Problem, Report,
    Scheme,
};
use voidage_core::pdr::{marks, medium};
use voidage_core::real::Real;

/// One field of conserved variables.
#[derive(Clone, Debug)]
pub struct Field<R, const D: usize> {
    /// Mass per open volume.
    pub density: Vec<R>,
    /// Momentum per open volume.
    pub momentum: [Vec<R>; D],
    /// Total energy per open volume; empty for a barotropic gas.
    pub energy: Vec<R>,
}

impl<R: Real, const D: usize> Field<R, D> {
    /// A field of zeros.
    pub fn new(cells: usize, gas: Gas<R>) -> Self {
        let zeros = || vec![R::ZERO; cells];
        Field {
            density: zeros(),
            momentum: std::array::from_fn(|_| zeros()),
            energy: if gas.has_energy() { zeros() } else { Vec::new() },
        }
    }

    /// To be read.
    pub fn view(&self) -> Fields<'_, R, D> {
        Fields {
            density: &self.density,
            momentum: self.momentum.each_ref().map(|m| m.as_slice()),
            energy: &self.energy,
        }
    }

    /// To be written.
    pub fn view_mut(&mut self) -> FieldsMut<'_, R, D> {
        FieldsMut {
            density: &mut self.density,
            momentum: self.momentum.each_mut().map(|m| m.as_mut_slice()),
            energy: &mut self.energy,
        }
    }
}

/// Open fractions with what the solver derives from them.
#[derive(Clone, Debug)]
struct Space<R, const D: usize> {
    volume: Vec<R>,
    faces: [Vec<R>; D],
    marks: Vec<u8>,
    clusters: Vec<u32>,
}

/// Drag coefficients of all cells; an empty vector stands for zero.
#[derive(Clone, Debug)]
struct Resistance<R, const D: usize> {
    quadratic: [Vec<R>; D],
    linear: [Vec<R>; D],
}

/// How porosity enters: the share of the duct above which a difference counts as a jump, and whether small cells merge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Treatment<R> {
    /// Differences above this share of the wider duct are jumps and get the throat map; infinity for none.
    pub jump: R,
    /// Merge cells of little volume behind open faces. Without it the step shrinks with their volume.
    pub merge: bool,
}

impl<R: Real> Default for Treatment<R> {
    fn default() -> Self {
        Treatment { jump: R::from_f64(0.1), merge: true }
    }
}

/// What [`Flow::set_porosity`] changed in the fractions given.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Tidied {
    /// Cells whose fraction was within a few rounding errors of 0 and became 0.
    pub dust_cells: usize,
    /// Faces likewise.
    pub dust_faces: usize,
    /// Open faces on the sides of the domain that were closed: too little volume behind them for any step.
    pub closed_faces: usize,
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
pub struct Flow<R, const D: usize> {
    widths: [Vec<R>; D],
    gas: Gas<R>,
    /// Low and high side of each axis; may change between steps.
    pub boundaries: [[Boundary<R, D>; 2]; D],
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
    scratch: Vec<Vec<R>>,
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

/// How often a step that needed floors is repeated with half the step before the floors stand.
const REPEATS: usize = 4;

/// Share of the stable step that careful steps take.
const CAREFUL_SHARE: f64 = 0.2;

impl<R: Real, const D: usize> Flow<R, D> {
    /// A flow on cells of the given widths; the state is to be set.
    pub fn new(widths: [Vec<R>; D], gas: Gas<R>, boundaries: [[Boundary<R, D>; 2]; D]) -> Self {
        let cells = widths.iter().map(Vec::len).product();
        Flow {
            widths,
            gas,
            boundaries,
            scheme: Scheme::default(),
            gravity: [R::ZERO; D],
            space: None,
            resistance: None,
            state: Field::new(cells, gas),
            next: Field::new(cells, gas),
            marks: vec![0; cells],
            scratch: Vec::new(),
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

    /// Gives the space its open fractions. Fractions within a few rounding errors of 0 (negative ones too) count as 0:
    /// geometry leaves such dust where a cell is closed. Returns what was changed.
    pub fn set_porosity(
        &mut self,
        mut volume: Vec<R>,
        mut faces: [Vec<R>; D],
        treatment: Treatment<R>,
    ) -> Result<Tidied, Error> {
        let mut tidied = Tidied {
            dust_cells: without_dust(&mut volume),
            dust_faces: faces.iter_mut().map(|f| without_dust(f)).sum(),
            closed_faces: 0,
        };
        let mesh = Mesh { widths: self.widths.each_ref().map(|w| w.as_slice()) };
        let n = mesh.len();
        let fits = |expected: usize, found: usize| {
            if expected == found { Ok(()) } else { Err(Error::ShapeMismatch { expected, found }) }
        };
        fits(n, volume.len())?;
        for d in 0..D {
            fits(mesh.faces(d), faces[d].len())?;
        }
        let periodic = self.boundaries.map(|b| b[0] == Boundary::Periodic);
        let cells = mesh.cells();
        let (marks, clusters) = loop {
            let views = faces.each_ref().map(|f| f.as_slice());
            let mut marks = vec![0; n];
            medium::mark(&mesh, &volume, &views, periodic, treatment.jump, &mut marks);
            if !treatment.merge || !marks.iter().any(|&m| marks::is(m, marks::SMALL)) {
                break (marks, Vec::new());
            }
            let mut parent = vec![0; n];
            let mut work = vec![R::ZERO; merge::cluster_scratch(n)];
            let mut clusters = vec![0; n];
            let used = merge::clusters(&mesh, &volume, &views, periodic, &mut clusters, &mut parent, &mut work);
            clusters.truncate(used);
            clusters.shrink_to_fit();
            // A cluster that found no more neighbours and is still too small for its faces must not stand open to the
            // outside: its faces on the sides of the domain are closed.
            let mut outside: Vec<(usize, usize)> = Vec::new();
            let mut clustered = vec![false; n];
            let mut examine = |members: &mut dyn Iterator<Item = usize>| {
                let (mut held, mut wanted, mut edge) = (R::ZERO, R::ZERO, Vec::new());
                for cell in members {
                    let at = mesh.coordinates(cell);
                    let own = mesh.volume(at);
                    held += volume[cell] * own;
                    for d in 0..D {
                        let low = mesh.face(d, at);
                        let high = low + mesh.face_stride(d);
                        for (face, last) in [(low, 0), (high, cells[d] - 1)] {
                            let open = faces[d][face] * own;
                            if open > wanted {
                                wanted = open;
                            }
                            if !periodic[d] && at[d] == last && open > R::ZERO {
                                edge.push((d, face));
                            }
                        }
                    }
                }
                if held < R::from_f64(medium::SMALL_SHARE) * wanted {
                    outside.append(&mut edge);
                }
            };
            for group in Clusters(&clusters).groups() {
                group.clone().for_each(|cell| clustered[cell] = true);
                examine(&mut group.clone());
            }
            for cell in (0..n).filter(|&c| marks::is(marks[c], marks::SMALL) && !clustered[c]) {
                examine(&mut std::iter::once(cell));
            }
            if outside.is_empty() {
                // What found no company (a periodic axis of one cell) limits the step like any other cell.
                for (mark, _) in marks.iter_mut().zip(&clustered).filter(|(_, clustered)| !**clustered) {
                    if marks::is(*mark, marks::SMALL) {
                        *mark &= !marks::KIND;
                    }
                }
                break (marks, clusters);
            }
            tidied.closed_faces += outside.len();
            for (d, face) in outside {
                faces[d][face] = R::ZERO;
            }
        };
        self.space = Some(Space { volume, faces, marks, clusters });
        self.rate = None;
        Ok(tidied)
    }

    /// Gives the cells their drag, CR in 1/length and the linear coefficient in 1/time; empty vectors stand for zero.
    pub fn set_drag(&mut self, quadratic: [Vec<R>; D], linear: [Vec<R>; D]) {
        self.resistance = Some(Resistance { quadratic, linear });
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
        self.space.as_ref().map_or(0, |s| s.clusters.len())
    }

    /// Faces where the porosity jumps and the throat map acts.
    pub fn jump_faces(&self) -> usize {
        let (mesh, cells) = (self.mesh(), self.cells());
        let Some(space) = &self.space else { return 0 };
        let of_cell = |(cell, marks): (usize, &u8)| {
            let at = mesh.coordinates(cell);
            let jumps = |d: usize, bit: u8, face: usize| marks & bit != 0 && space.faces[d][face] > R::ZERO;
            let of_axis = |d: usize| {
                let low = mesh.face(d, at);
                let high = at[d] + 1 == cells[d] && jumps(d, marks::break_high(d), low + mesh.face_stride(d));
                usize::from(jumps(d, marks::break_low(d), low)) + usize::from(high)
            };
            (0..D).map(of_axis).sum::<usize>()
        };
        space.marks.iter().enumerate().map(of_cell).sum()
    }

    /// Open fractions of the cells, if the space has any.
    pub fn beta_v(&self) -> Option<&[R]> {
        self.space.as_ref().map(|s| &s.volume[..])
    }

    /// Open fractions of the faces, axis by axis, if the space has any.
    pub fn faces(&self) -> impl Iterator<Item = &[R]> {
        self.space.iter().flat_map(|s| s.faces.iter().map(|f| &f[..]))
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
        let fits = |a: &Vec<R>, b: &Vec<R>| match (a.len(), b.len()) {
            (expected, found) if expected != found => Err(Error::ShapeMismatch { expected, found }),
            _ => Ok(()),
        };
        fits(&self.state.density, &state.density)?;
        fits(&self.state.energy, &state.energy)?;
        (0..D).try_for_each(|d| fits(&self.state.momentum[d], &state.momentum[d]))?;
        let Clock { time, steps, repeated, total } = clock;
        (self.state, self.rate) = (state, Some(total.rate));
        (self.time, self.steps, self.repeated, self.total) = (time, steps, repeated, total);
        Ok(())
    }

    /// Memory of the state and the solver's own, without porosity and drag, in units of one conserved field.
    pub fn memory_ratio(&self) -> f64 {
        let bytes = |f: &Field<R, D>| {
            (f.density.len() + f.momentum.iter().map(Vec::len).sum::<usize>() + f.energy.len()) * size_of::<R>()
        };
        let scratch: usize = self.scratch.iter().map(|s| s.len() * size_of::<R>()).sum();
        (bytes(&self.state) + bytes(&self.next) + self.marks.len() + scratch) as f64 / bytes(&self.state) as f64
    }

    /// Runs a closure with the problem and the two fields.
    fn with_problem<T>(
        &mut self,
        f: impl FnOnce(&Problem<'_, R, D>, &Field<R, D>, &mut Field<R, D>, &mut [u8], &mut Vec<Vec<R>>) -> T,
    ) -> T {
        let problem = Problem {
            mesh: Mesh { widths: self.widths.each_ref().map(|w| w.as_slice()) },
            gas: self.gas,
            boundaries: self.boundaries,
            scheme: self.scheme,
            porosity: self.space.as_ref().map(|s| Porosity {
                volume: &s.volume,
                faces: s.faces.each_ref().map(|f| f.as_slice()),
                marks: &s.marks,
            }),
            clusters: Clusters(self.space.as_ref().map_or(&[], |s| &s.clusters)),
            drag: self.resistance.as_ref().map(|r| Drag {
                quadratic: r.quadratic.each_ref().map(|q| q.as_slice()),
                linear: r.linear.each_ref().map(|q| q.as_slice()),
            }),
            gravity: self.gravity,
        };
        f(&problem, &self.state, &mut self.next, &mut self.marks, &mut self.scratch)
    }

    /// Sets every cell from the coordinates of its centre (the origin of the mesh is 0).
    pub fn fill(&mut self, f: impl Fn([R; D]) -> Primitive<R, D>) {
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
        let gas = self.gas;
        let mut view = self.state.view_mut();
        for cell in 0..view.density.len() {
            let mut rest = cell;
            let x = std::array::from_fn(|d| {
                let i = rest % cells[d];
                rest /= cells[d];
                centres[d][i]
            });
            view.set(cell, &gas.conserved(&f(x)));
        }
        self.rate = None;
    }

    /// Sets one cell.
    pub fn set(&mut self, cell: usize, w: &Primitive<R, D>) {
        let u = self.gas.conserved(w);
        self.state.view_mut().set(cell, &u);
        self.rate = None;
    }

    /// One cell.
    pub fn get(&self, cell: usize) -> Primitive<R, D> {
        self.gas.primitive(&self.state.view().get(cell))
    }

    fn mesh(&self) -> Mesh<'_, R, D> {
        Mesh { widths: self.widths.each_ref().map(|w| w.as_slice()) }
    }

    /// Open volume of a cell.
    pub fn open_volume(&self, cell: usize) -> R {
        let mesh = self.mesh();
        let volume = mesh.volume(mesh.coordinates(cell));
        self.space.as_ref().map_or(volume, |s| volume * s.volume[cell])
    }

    /// The cells along the low (`side` 0) or high (1) side of axis `d`, with the open area of their face there.
    pub fn side(&self, d: usize, side: usize) -> Vec<(usize, R)> {
        let (mesh, last) = (self.mesh(), self.widths[d].len().saturating_sub(1));
        let cells = (0..self.len()).filter(|&c| mesh.coordinates(c)[d] == side * last);
        cells
            .map(|cell| {
                let at = mesh.coordinates(cell);
                let face = mesh.face(d, at) + side * mesh.face_stride(d);
                let open = self.space.as_ref().map_or(R::ONE, |s| s.faces[d][face]);
                (cell, open * mesh.volume(at) / self.widths[d][at[d]])
            })
            .collect()
    }

    /// The largest Mach number of any cell.
    pub fn max_mach(&self) -> R {
        let rows = self.len() / self.widths[0].len().max(1);
        let larger = |a: R, b: R| if b > a { b } else { a };
        let view = self.state.view();
        let of_row = |row: usize| {
            let cells = row * self.widths[0].len()..(row + 1) * self.widths[0].len();
            cells.fold(R::ZERO, |most, cell| {
                let w = self.gas.primitive(&view.get(cell));
                let speed_sq = w.velocity.iter().fold(R::ZERO, |s, &u| s + u * u);
                larger(most, speed_sq * w.density / (self.gas.gamma() * w.pressure))
            })
        };
        (0..rows).into_par_iter().map(of_row).reduce(|| R::ZERO, larger).sqrt()
    }

    /// Contents of the domain, summed with the cells' open volumes; the same bits for any number of threads.
    pub fn content(&self) -> Conserved<R, D> {
        let n = self.widths[0].len().max(1);
        let rows: Vec<Compensated<R, D>> =
            (0..self.len() / n).into_par_iter().map(|row| self.row_content(row * n, n)).collect();
        let mut sum = Compensated::default();
        rows.iter().for_each(|row| sum.add(&row.sum));
        sum.sum
    }

    fn row_content(&self, start: usize, n: usize) -> Compensated<R, D> {
        let (mesh, view) = (self.mesh(), self.state.view());
        let mut at = mesh.coordinates(start);
        let mut sum = Compensated::default();
        for i in 0..n {
            at[0] = i;
            let open = self.space.as_ref().map_or(R::ONE, |s| s.volume[start + i]);
            let (v, u) = (mesh.volume(at) * open, view.get(start + i));
            sum.add(&Conserved { density: v * u.density, momentum: u.momentum.map(|m| v * m), energy: v * u.energy });
        }
        sum
    }

    /// Largest signal rate Σ_d (|u_d| + c)/dx_d of the present state.
    pub fn rate(&mut self) -> Result<R, Error> {
        if let Some(rate) = self.rate {
            return Ok(rate);
        }
        let mut state = std::mem::replace(&mut self.state, Field::new(0, self.gas));
        self.with_problem(|problem, _, _, _, _| problem.settle(&mut state.view_mut()));
        self.state = state;
        let rate = self.with_problem(|problem, old, _, _, _| problem.rate(&old.view()))?;
        self.rate = Some(rate);
        Ok(rate)
    }

    /// The largest stable step at a CFL number; infinite where nothing can move.
    pub fn stable_dt(&mut self, cfl: R) -> Result<R, Error> {
        let rate = self.rate()?;
        let share = if self.steps < self.careful_steps { R::from_f64(CAREFUL_SHARE) } else { R::ONE };
        Ok(if rate > R::ZERO { cfl * share / rate } else { R::INFINITY })
    }

    /// Tells the flow that the caller has changed `state`.
    pub fn touched(&mut self) {
        self.rate = None;
    }

    /// One step of `dt`, whatever its stability. Returns what it did.
    pub fn step(&mut self, dt: R) -> Result<Report<R, D>, Error> {
        self.rate()?;
        let report =
            self.with_problem(|problem, old, new, marks, scratch| step(problem, old, new, marks, scratch, dt))?;
        self.accept(dt, &report);
        Ok(report)
    }

    fn accept(&mut self, dt: R, report: &Report<R, D>) {
        std::mem::swap(&mut self.state, &mut self.next);
        self.time += dt;
        self.steps += 1;
        self.rate = Some(report.rate);
        let mut total = self.total.and(report);
        total.rate = report.rate;
        self.total = total;
    }

    /// One stable step that does not pass `end`; a step that would need floors is repeated with less.
    pub fn advance(&mut self, cfl: R, end: R) -> Result<R, Error> {
        let mut dt = self.stable_dt(cfl)?;
        let left = end - self.time;
        let last = !(dt < left);
        if last {
            dt = left;
        }
        let mut repeats = 0;
        loop {
            let report =
                self.with_problem(|problem, old, new, marks, scratch| step(problem, old, new, marks, scratch, dt))?;
            if report.floored == 0 || repeats == REPEATS {
                self.accept(dt, &report);
                self.repeated += repeats;
                if last && repeats == 0 {
                    self.time = end;
                }
                return Ok(dt);
            }
            repeats += 1;
            dt = R::HALF * dt;
        }
    }

    /// Stable steps until `end`.
    pub fn run(&mut self, cfl: R, end: R) -> Result<(), Error> {
        while self.time < end {
            self.advance(cfl, end)?;
        }
        Ok(())
    }
}

/// A sum that carries what its rounding lost: the balance is wanted to rounding whatever the number of cells.
struct Compensated<R, const D: usize> {
    sum: Conserved<R, D>,
    lost: Conserved<R, D>,
}

impl<R: Real, const D: usize> Default for Compensated<R, D> {
    fn default() -> Self {
        let zero = Conserved { density: R::ZERO, momentum: [R::ZERO; D], energy: R::ZERO };
        Compensated { sum: zero, lost: zero }
    }
}

impl<R: Real, const D: usize> Compensated<R, D> {
    fn add(&mut self, x: &Conserved<R, D>) {
        let add = |sum: &mut R, lost: &mut R, x: R| {
            let y = x - *lost;
            let t = *sum + y;
            *lost = (t - *sum) - y;
            *sum = t;
        };
        let (sum, lost) = (&mut self.sum, &mut self.lost);
        add(&mut sum.density, &mut lost.density, x.density);
        add(&mut sum.energy, &mut lost.energy, x.energy);
        for c in 0..D {
            add(&mut sum.momentum[c], &mut lost.momentum[c], x.momentum[c]);
        }
    }
}

/// Sets what is within a few rounding errors of 0, or below, to 0; returns how many were not 0 before.
fn without_dust<R: Real>(fractions: &mut [R]) -> usize {
    let dust = R::from_f64(16.0) * R::EPSILON;
    let mut count = 0;
    for x in fractions.iter_mut().filter(|x| !(**x > dust)) {
        count += usize::from(*x != R::ZERO);
        *x = R::ZERO;
    }
    count
}

/// One step on rayon's threads: slabs side by side, merging, fallback, floors, as [`Problem::step`].
fn step<R: Real, const D: usize>(
    problem: &Problem<'_, R, D>,
    old: &Field<R, D>,
    new: &mut Field<R, D>,
    marks: &mut [u8],
    scratch: &mut Vec<Vec<R>>,
    dt: R,
) -> Result<Report<R, D>, Error> {
    let layers = problem.mesh.cells()[D - 1];
    // A slab of few layers spends its time on the layers beside it.
    const LEAST_LAYERS: usize = 6;
    let threads = rayon::current_num_threads().min(layers / LEAST_LAYERS).max(1);
    let threads = if D == 1 { 1 } else { threads };
    while scratch.len() < threads {
        scratch.push(vec![R::ZERO; problem.scratch_len()]);
    }
    let scratch = &mut scratch[..threads];
    if let [one] = scratch {
        return problem.step(&old.view(), &mut new.view_mut(), dt, marks, one);
    }
    let attempt = |new: &mut Field<R, D>,
                   scratch: &mut [Vec<R>],
                   marks: Option<&[u8]>|
     -> Result<Report<R, D>, Error> {
        let layer = problem.mesh.layer();
        let mut rest = new.view_mut();
        let mut slabs = Vec::with_capacity(threads);
        let mut begin = 0;
        for t in 0..threads {
            let end = layers * (t + 1) / threads;
            let (slab, above) = rest.split_at((end - begin) * layer);
            slabs.push((begin..end, slab));
            rest = above;
            begin = end;
        }
        let reports: Result<Vec<_>, Error> = slabs
            .into_par_iter()
            .zip(scratch.par_iter_mut())
            .map(|((range, mut slab), scratch)| problem.advance_slab(&old.view(), &mut slab, range, dt, marks, scratch))
            .collect();
        let mut report = reports?.iter().fold(Report::new(), |a, b| a.and(b));
        problem.merge(&old.view(), &mut new.view_mut(), &mut report);
        Ok(report)
    };
    let mut report = attempt(new, scratch, None)?;
    if report.unphysical == 0 {
        return Ok(report);
    }
    marks.fill(0);
    for _ in 0..voidage_core::pdr::repair::FALLBACKS {
        if problem.mark_troubled(&new.view(), marks) == 0 {
            break;
        }
        report = attempt(new, scratch, Some(marks))?;
        if report.unphysical == 0 {
            return Ok(report);
        }
    }
    problem.apply_floors(&old.view(), &mut new.view_mut(), &mut report);
    Ok(report)
}
