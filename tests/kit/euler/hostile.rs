//! The doors of the flow with whatever a caller may hand over: slices of wrong lengths, indices beyond the mesh, numbers that are none. What is
//! refused says why; nothing panics.

use super::property::Source;
use voidage::flow::Scalar;
use voidage_core::flow::{
    AnyGas, Boundary, CellPush, Drag, Error, Feed, Fields, FieldsMut, Fractions, Gas, Limiter, Merging, Mesh, Patch,
    Prepared, PressureForm, Primitive, Problem, Report, Riemann, Scheme, Treatment, WatchedWalls, cluster_scratch,
    prepare, scratch_needed, stable_step,
};

/// How many calls did what was asked of them, and how many refused.
#[derive(Clone, Copy, Debug, Default)]
pub struct Calls {
    /// Spaces made ready with clusters in them.
    pub merged: usize,
    /// Steps done.
    pub stepped: usize,
    /// Calls that named an error.
    pub refused: usize,
}

/// The first byte chooses precision and dimensions.
pub fn any_calls_from_bytes(bytes: &[u8], calls: &mut Calls) {
    let Some((first, rest)) = bytes.split_first() else { return };
    let mut s = Source::new(rest);
    match first % 6 {
        0 => any_calls::<f64, 1>(&mut s, calls),
        1 => any_calls::<f64, 2>(&mut s, calls),
        2 => any_calls::<f64, 3>(&mut s, calls),
        3 => any_calls::<f32, 1>(&mut s, calls),
        4 => any_calls::<f32, 2>(&mut s, calls),
        _ => any_calls::<f32, 3>(&mut s, calls),
    }
}

/// Everything that has a door, once, on one mesh.
pub fn any_calls<R: Scalar, const D: usize>(s: &mut Source<'_>, calls: &mut Calls) {
    if let Err(error) = call_each::<R, D>(&mut Hostile::new(s), calls) {
        calls.refuse(error);
    }
}

impl Calls {
    fn refuse(&mut self, error: Error) {
        assert!(!error.to_string().is_empty());
        self.refused += 1;
    }

    /// The value, unless it was refused.
    fn note<T>(&mut self, result: Result<T, Error>) -> Option<T> {
        result.map_err(|error| self.refuse(error)).ok()
    }
}

/// Values as a caller should give them, but for some.
struct Hostile<'s, 'b> {
    s: &'s mut Source<'b>,
    /// One number in so many is none; 0 for none of them.
    numbers: u16,
    /// One length and one index in so many is wrong; 0 for none.
    lengths: u16,
}

impl<'s, 'b> Hostile<'s, 'b> {
    fn new(s: &'s mut Source<'b>) -> Self {
        let (numbers, lengths) = (s.pick(&[0, 0, 4, 16, 64]), s.pick(&[0, 0, 0, 8, 32]));
        Hostile { s, numbers, lengths }
    }

    fn one_in(&mut self, many: u16) -> bool {
        many > 0 && self.s.bits().is_multiple_of(many)
    }

    fn number<R: Scalar>(&mut self, usual: f64) -> R {
        let none = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, 0.0, -0.0, 1e300, 1e-300, 5e-324, f64::MIN];
        R::from_f64(if self.one_in(self.numbers) { self.s.pick(&none) } else { usual })
    }

    fn length(&mut self, right: usize) -> usize {
        if !self.one_in(self.lengths) {
            return right;
        }
        let any = usize::from(self.s.bits() % 40);
        self.s.pick(&[0, right.saturating_sub(1), right + 1, any])
    }

    fn index(&mut self, below: usize) -> usize {
        let right = usize::from(self.s.bits()) % below.max(1);
        if self.one_in(self.lengths) { self.s.pick(&[below, below + 1, usize::MAX, usize::MAX / 2]) } else { right }
    }

    fn numbers<R: Scalar>(&mut self, right: usize, usual: f64) -> Vec<R> {
        (0..self.length(right)).map(|_| self.number(usual)).collect()
    }

    fn fractions<R: Scalar>(&mut self, right: usize) -> Vec<R> {
        let length = self.length(right);
        let mut fraction = || {
            let usual = self.s.fraction();
            self.number(usual)
        };
        (0..length).map(|_| fraction()).collect()
    }

    fn state<R: Scalar, const D: usize>(&mut self) -> Primitive<R, D> {
        Primitive {
            density: self.number(1.0),
            velocity: std::array::from_fn(|_| self.number(0.3)),
            pressure: self.number(1.0),
        }
    }

    fn gas<R: Scalar>(&mut self) -> Gas<R> {
        let gamma = self.number(1.4);
        match self.s.bits() % 4 {
            0 => Gas::Isothermal { sound_speed: self.number(1.0) },
            1 => Gas::Isentropic { gamma, density: self.number(1.0), pressure: self.number(1.0) },
            2 => Gas::Mixed { gammas: [self.number(1.2), gamma] },
            _ => Gas::Ideal { gamma },
        }
    }

    fn boundary<R: Scalar, const D: usize>(&mut self) -> Boundary<R, D> {
        match self.s.bits() % 8 {
            0 => Boundary::ZeroGradient,
            1 => Boundary::FarField(self.state()),
            2 => Boundary::Inlet(self.state()).relaxed(
                self.index(D),
                self.number(0.1),
                self.number(1.0),
                self.number(0.5),
            ),
            3 => Boundary::Outlet { pressure: self.number(1.0) },
            4 => Boundary::Reservoir { density: self.number(1.0), pressure: self.number(1.2) },
            5 if self.lengths > 0 => Boundary::Periodic,
            _ => Boundary::Wall,
        }
    }

    fn patch<R: Scalar, const D: usize>(&mut self, cells: [usize; D]) -> Patch<R, D> {
        Patch {
            axis: self.index(D),
            high: self.s.bits().is_multiple_of(2),
            first: cells.map(|n| self.index(n)),
            end: cells.map(|n| self.index(n + 1)),
            boundary: self.boundary(),
        }
    }

    fn scheme(&mut self) -> Scheme {
        Scheme {
            riemann: self.s.pick(&[Riemann::Hllc, Riemann::HllcLowMach, Riemann::Hlle, Riemann::Rusanov]),
            limiter: self.s.pick(&[
                Limiter::Steep,
                Limiter::AroraRoe,
                Limiter::VanLeer,
                Limiter::Unlimited,
                Limiter::FirstOrder,
            ]),
            pressure: self.s.pick(&[PressureForm::Geometric, PressureForm::Paper]),
        }
    }
}

/// The variables of a field as vectors.
struct Variables<R, const D: usize> {
    density: Vec<R>,
    momentum: [Vec<R>; D],
    energy: Vec<R>,
    capacity: Vec<R>,
}

impl<R: Scalar, const D: usize> Variables<R, D> {
    fn new(h: &mut Hostile<'_, '_>, cells: usize, gas: Gas<R>) -> Self {
        Variables {
            density: h.numbers(cells, 1.0),
            momentum: std::array::from_fn(|_| h.numbers(cells, 0.1)),
            energy: h.numbers(if gas.has_energy() { cells } else { 0 }, 2.5),
            capacity: h.numbers(if gas.is_mixed() { cells } else { 0 }, 3.0),
        }
    }

    fn view(&self) -> Fields<'_, R, D> {
        let momentum = self.momentum.each_ref().map(|m| &m[..]);
        Fields { density: &self.density, momentum, energy: &self.energy, capacity: &self.capacity }
    }

    fn view_mut(&mut self) -> FieldsMut<'_, R, D> {
        FieldsMut {
            density: &mut self.density,
            momentum: self.momentum.each_mut().map(|m| &mut m[..]),
            energy: &mut self.energy,
            capacity: &mut self.capacity,
        }
    }
}

type Space<R, const D: usize> = Prepared<Vec<R>, Vec<u8>, Vec<u32>, D>;

/// Ends where nothing can go on.
fn call_each<R: Scalar, const D: usize>(h: &mut Hostile<'_, '_>, calls: &mut Calls) -> Result<(), Error> {
    let n: [usize; D] = std::array::from_fn(|_| usize::from(h.s.bits() % 5));
    let widths: [Vec<R>; D] = n.map(|n| h.numbers(n, 0.5));
    let mesh = Mesh::new(widths.each_ref().map(|w| &w[..]))?;
    ask_of_mesh(h, &mesh);
    let boundaries: [[Boundary<R, D>; 2]; D] = std::array::from_fn(|_| match h.s.bits() % 4 {
        0 => [Boundary::Periodic; 2],
        _ => [h.boundary(), h.boundary()],
    });
    let periodic = boundaries.map(|[low, _]| low.is_periodic());
    let space = calls.note(make_ready(h, &mesh, periodic));
    calls.merged += usize::from(space.as_ref().is_some_and(|space| space.merged_cells() > 0));
    let gas = h.gas();
    let mut problem = Problem::new(mesh, gas, boundaries)?.with_scheme(h.scheme());
    if h.s.bits().is_multiple_of(3) {
        problem = problem.with_gravity(std::array::from_fn(|_| h.number(-9.81)));
    }
    if let Some(space) = &space {
        problem = calls.note(problem.with_porosity(space.view())).unwrap_or(problem);
    }
    let patches: Vec<Patch<R, D>> = (0..h.s.bits() % 3).map(|_| h.patch(mesh.cells())).collect();
    problem = calls.note(problem.with_patches(&patches)).unwrap_or(problem);
    let fed = h.numbers(patches.len(), 1.3);
    if gas.is_mixed() {
        let feed = Feed { sides: std::array::from_fn(|_| [h.number(1.3), h.number(1.3)]), patches: &fed };
        problem = calls.note(problem.with_feed(feed)).unwrap_or(problem);
    }
    let [quadratic, linear]: [[Vec<R>; D]; 2] =
        std::array::from_fn(|_| std::array::from_fn(|_| h.numbers(mesh.len(), 0.1)));
    if h.s.bits().is_multiple_of(2) {
        let [quadratic, linear] = [&quadratic, &linear].map(|all| all.each_ref().map(|s| &s[..]));
        problem = calls.note(problem.with_drag(Drag { quadratic, linear })).unwrap_or(problem);
    }
    let [old, mut new] = std::array::from_fn(|_| Variables::new(h, mesh.len(), gas));
    advance(h, &problem, &old, &mut new, calls);
    repair(h, &problem, &old, &mut new, calls);
    Ok(())
}

/// What a mesh tells of cells and faces, also of those that it does not have.
fn ask_of_mesh<R: Scalar, const D: usize>(h: &mut Hostile<'_, '_>, mesh: &Mesh<'_, R, D>) {
    let at = mesh.cells().map(|n| h.index(n));
    let (cell, d) = (h.index(mesh.len()), h.index(D));
    let _ = (mesh.coordinates(cell), mesh.index(at), mesh.volume(at), mesh.layer(), mesh.is_empty());
    let _ = (mesh.faces(d), mesh.face(d, at), mesh.face_stride(d), mesh.faces_of(d, at));
    let _ = scratch_needed(mesh.cells().map(|n| h.index(n)));
}

fn make_ready<R: Scalar, const D: usize>(
    h: &mut Hostile<'_, '_>,
    mesh: &Mesh<'_, R, D>,
    periodic: [bool; D],
) -> Result<Space<R, D>, Error> {
    let cells = mesh.len();
    let fractions = Fractions {
        volume: h.fractions(cells),
        faces: std::array::from_fn(|d| h.fractions(mesh.faces(d))),
        flags: vec![255; h.length(cells)],
    };
    let treatment = Treatment { jump: h.number(0.1), merge: !h.s.bits().is_multiple_of(4) };
    let space = prepare(mesh, periodic, fractions, treatment, |cells| Merging {
        list: vec![7; h.length(cells)],
        parent: vec![7; h.length(cells)],
        scratch: h.numbers(cluster_scratch(cells), f64::NAN),
    })?;
    let view = space.view();
    assert!(view.volume().iter().chain(view.faces().into_iter().flatten()).all(|open| *open >= R::ZERO));
    assert!(view.clusters().flatten().all(|cell| cell < cells) && view.sealed_cells() <= cells);
    let _ = (view.jump_faces(), space.tidied());
    Ok(space)
}

/// Steps: whole, by slabs, with watched walls, and as long as they may be.
fn advance<R: Scalar, const D: usize>(
    h: &mut Hostile<'_, '_>,
    problem: &Problem<'_, R, D>,
    old: &Variables<R, D>,
    new: &mut Variables<R, D>,
    calls: &mut Calls,
) {
    let (cells, dt) = (problem.mesh().len(), h.number(0.01));
    let layers = problem.mesh().cells()[D - 1];
    let mut scratch = vec![R::ZERO; h.length(problem.scratch_len())];
    let mut marks = vec![0; h.length(cells)];
    let marked: Vec<u8> = (0..h.length(cells)).map(|_| h.s.bits() as u8).collect();
    let done = problem.step_by::<AnyGas>(&old.view(), &mut new.view_mut(), dt, &mut marks, &mut scratch);
    calls.stepped += usize::from(calls.note(done).is_some());

    let slab = h.index(layers + 1)..h.index(layers + 1);
    let held = (problem.mesh().layer() * slab.len().min(layers)).min(cells);
    let (mut part, _) = new.view_mut().split_at(if D == 1 { cells } else { held });
    calls.note(problem.advance_slab_by::<AnyGas>(&old.view(), &mut part, slab, dt, Some(&marked), &mut scratch));

    let mut watched: Vec<usize> = (0..h.s.bits() % 6).map(|_| h.index(cells)).collect();
    if h.lengths == 0 {
        watched.sort_unstable();
    }
    let zero = [[R::ZERO; 2]; D];
    let none = CellPush { sides: zero, along: [[[R::ZERO; D]; 2]; D], mass: zero, drag: [R::ZERO; D] };
    let mut pushes = vec![none; h.length(watched.len())];
    let walls = WatchedWalls { cells: &watched, pushes: &mut pushes, reference: h.number(1.0) };
    let mut whole = new.view_mut();
    calls.note(problem.advance_slab_watching::<AnyGas>(
        &old.view(),
        &mut whole,
        0..layers,
        (dt, None),
        walls,
        &mut scratch,
    ));

    let (time, end, longest) = (h.number(0.0), h.number(1.0), h.number(0.01));
    calls.note(stable_step(time, end, longest, |dt| {
        problem.step_by::<AnyGas>(&old.view(), &mut new.view_mut(), dt, &mut marks, &mut scratch)
    }));
}

/// The parts of a step by themselves.
fn repair<R: Scalar, const D: usize>(
    h: &mut Hostile<'_, '_>,
    problem: &Problem<'_, R, D>,
    old: &Variables<R, D>,
    new: &mut Variables<R, D>,
    calls: &mut Calls,
) {
    let cells = problem.mesh().len();
    let mut marks = vec![0; h.length(cells)];
    let mut report = Report::new();
    calls.note(problem.rate(&old.view()));
    calls.note(problem.mark_troubled(&old.view(), &mut marks));
    calls.note(problem.merge(&old.view(), &mut new.view_mut(), &mut report));
    calls.note(problem.apply_floors(&old.view(), &mut new.view_mut(), &mut report));
    calls.note(problem.start(&mut new.view_mut()));
    let tried = h.index(3);
    let attempt = |_: &mut FieldsMut<'_, R, D>, _: Option<&[u8]>| Ok(Report { unphysical: tried, ..Report::new() });
    calls.note(problem.step_in_slabs(&old.view(), &mut new.view_mut(), &mut marks, attempt));
    let (from, to) = (h.index(cells), h.index(cells));
    let taken = old.view().get(from);
    assert!(taken.is_some() || from >= old.density.len() || old.momentum.iter().any(|m| from >= m.len()));
    let _ = old.view().gas_at(problem.gas(), from);
    if let Some(u) = taken {
        let _ = problem.is_physical(&u);
        new.view_mut().set(to, &u);
    }
}
