//! What a caller may get wrong is named, whatever it is: nothing panics.

use voidage::flow::Flow;
use voidage_core::flow::{
    Boundary, Conserved, Drag, Error, Fields, FieldsMut, Fractions, Gas, Merging, Mesh, Primitive, Problem, Report,
    Treatment, cluster_scratch, prepare, scratch_needed, stable_step,
};
use voidage_tests::euler::hostile::{Calls, any_calls_from_bytes};
use voidage_tests::euler::property::Source;

/// Lengths of all slices of a plane problem of 4 × 3 cells, by name.
const LENGTHS: [(&str, usize); 17] = [
    ("beta_v", 12),
    ("beta_x", 15),
    ("beta_y", 16),
    ("marks", 12),
    ("quadratic", 12),
    ("linear", 12),
    ("old density", 12),
    ("old momentum", 12),
    ("old energy", 12),
    ("new density", 12),
    ("new momentum", 12),
    ("new energy", 12),
    ("first order", 12),
    ("list", 12),
    ("parent", 12),
    ("cluster scratch", cluster_scratch(12)),
    ("scratch", 0),
];

/// What the outer numbers of a problem are.
#[derive(Clone, Copy)]
struct Numbers {
    width: f64,
    gas: Gas<f64>,
}

const SOUND: Numbers = Numbers { width: 0.5, gas: Gas::Ideal { gamma: 1.4 } };

/// Calls everything on slices of the lengths given (the scratch: so much more or less than is needed); returns the errors.
fn call_all(lengths: &[usize; 17], numbers: Numbers) -> Vec<Error> {
    let mut errors = Vec::new();
    if let Err(error) = call_each(lengths, numbers, &mut errors) {
        errors.push(error);
    }
    errors
}

/// The same; ends where nothing can go on.
fn call_each(lengths: &[usize; 17], numbers: Numbers, errors: &mut Vec<Error>) -> Result<(), Error> {
    let of = |i: usize, value: f64| vec![value; lengths[i]];
    let [mut volume, x, y] = [of(0, 1.0), of(1, 1.0), of(2, 1.0)];
    // Cell 5 is small: it must be merged.
    if let Some(v) = volume.get_mut(5) {
        *v = 0.01;
    }
    let (quadratic, linear) = (of(4, 0.1), of(5, 0.1));
    let (density, momentum, energy) = (of(6, 1.0), of(7, 0.1), of(8, 2.5));
    let (mut new_density, mut new_momentum, mut new_energy) = (of(9, 1.0), [of(10, 0.0), of(10, 0.0)], of(11, 2.5));
    let mut first_order = vec![0; lengths[12]];
    let widths = [[0.5, 0.5, numbers.width, 0.5], [0.5; 4]];
    let mesh = Mesh::new([&widths[0], &widths[1][..3]])?;
    let fractions = Fractions { volume, faces: [x, y], flags: vec![0; lengths[3]] };
    let merging = |_| Merging { list: vec![0; lengths[13]], parent: vec![0; lengths[14]], scratch: of(15, 0.0) };
    let space = prepare(&mesh, [false; 2], fractions, Treatment::default(), merging)?;
    assert!(space.merged_cells() > 1);
    let problem = Problem::new(mesh, numbers.gas, [[Boundary::Wall; 2]; 2])?
        .with_gravity([0.0, -1.0])
        .with_porosity(space.view())?
        .with_drag(Drag { quadratic: [&quadratic, &[]], linear: [&[], &linear] })?;
    let old = Fields { density: &density, momentum: [&momentum, &momentum], energy: &energy, capacity: &[] };
    let [u, v] = &mut new_momentum;
    let mut new = FieldsMut { density: &mut new_density, momentum: [u, v], energy: &mut new_energy, capacity: &mut [] };
    let mut scratch = vec![0.0; (scratch_needed([4, 3]) + lengths[16]).saturating_sub(1)];
    let mut report = Report::new();
    let mut note = |result: Result<(), Error>| errors.extend(result.err());
    note(problem.rate(&old).map(drop));
    note(problem.start(&mut new).map(drop));
    note(problem.advance_slab(&old, &mut new, 0..3, 0.01, Some(&first_order), &mut scratch).map(drop));
    note(problem.merge(&old, &mut new, &mut report));
    note(problem.mark_troubled(&new.as_fields(), &mut first_order).map(drop));
    note(problem.apply_floors(&old, &mut new, &mut report));
    note(problem.step(&old, &mut new, 0.01, &mut first_order, &mut scratch).map(drop));
    Ok(())
}

fn lengths() -> [usize; 17] {
    // One more than one less than the scratch that is needed.
    LENGTHS.map(|(name, length)| if name == "scratch" { 1 } else { length })
}

#[test]
fn every_slice_of_a_wrong_length_is_refused() {
    assert_eq!(call_all(&lengths(), SOUND), []);
    for (i, (name, length)) in LENGTHS.into_iter().enumerate() {
        for wrong in [0, length.saturating_sub(1), length + 1, 1000] {
            let mut all = lengths();
            all[i] = wrong;
            // More scratch than is needed is no error; no drag stands for zero.
            let fine = (name.ends_with("scratch") && wrong > length)
                || (["quadratic", "linear"].contains(&name) && wrong == 0);
            let errors = call_all(&all, SOUND);
            assert_eq!(errors.is_empty(), fine, "{name} of {wrong}: {errors:?}");
            assert!(errors.iter().all(|e| matches!(e, Error::ShapeMismatch { .. })), "{name} of {wrong}: {errors:?}");
        }
    }
}

#[test]
fn any_mixture_of_lengths_is_refused_without_panic() {
    let mut s = Source::seeded(17);
    for _ in 0..3000 {
        let mut all = lengths();
        for length in &mut all {
            if s.bits().is_multiple_of(4) {
                *length = usize::from(s.bits() % 40);
            }
        }
        for error in call_all(&all, SOUND) {
            assert!(!error.to_string().is_empty());
        }
    }
}

#[test]
fn numbers_that_are_none_are_named() {
    for width in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(call_all(&lengths(), Numbers { width, ..SOUND }), [Error::Width { axis: 0, cell: 2 }], "{width}");
    }
    let gases = [1.0, 0.5, -1.4, f64::NAN, f64::INFINITY].map(|gamma| Gas::Ideal { gamma });
    let barotropic = [
        Gas::Isothermal { sound_speed: 0.0 },
        Gas::Isothermal { sound_speed: f64::NAN },
        Gas::Isentropic { gamma: 1.4, density: -1.0, pressure: 1.0 },
        Gas::Isentropic { gamma: 1.4, density: 1.0, pressure: f64::INFINITY },
    ];
    for gas in gases.into_iter().chain(barotropic) {
        assert_eq!(call_all(&lengths(), Numbers { gas, ..SOUND }), [Error::Gas], "{gas:?}");
    }
}

#[test]
fn states_that_are_none_are_stepped_over_without_panic() {
    let none = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, 0.0, 1e300, 1e-300];
    let widths = [0.5; 6];
    let mut s = Source::seeded(5);
    for _ in 0..500 {
        let far = Boundary::FarField(Primitive { density: 1.0, velocity: [0.1], pressure: 1.0 });
        let mesh = Mesh::new([&widths]).unwrap();
        let problem = Problem::new(mesh, Gas::Ideal { gamma: 1.4 }, [[Boundary::Wall, far]]).unwrap();
        let mut value = |usual: f64| if s.bits().is_multiple_of(4) { s.pick(&none) } else { usual };
        let states: Vec<Conserved<f64, 1>> =
            (0..6).map(|_| Conserved { density: value(1.0), momentum: [value(0.1)], energy: value(2.5) }).collect();
        let density: Vec<f64> = states.iter().map(|u| u.density).collect();
        let momentum: Vec<f64> = states.iter().map(|u| u.momentum[0]).collect();
        let energy: Vec<f64> = states.iter().map(|u| u.energy).collect();
        let old = Fields { density: &density, momentum: [&momentum], energy: &energy, capacity: &[] };
        let (mut a, mut b, mut c) = (vec![0.0; 6], vec![0.0; 6], vec![0.0; 6]);
        let mut new = FieldsMut { density: &mut a, momentum: [&mut b], energy: &mut c, capacity: &mut [] };
        let mut scratch = vec![0.0; problem.scratch_len()];
        assert!(problem.step(&old, &mut new, 1e-3, &mut [0; 6], &mut scratch).is_ok());
    }
}

#[test]
fn a_space_serves_the_mesh_it_was_prepared_for() {
    let (three, four) = ([0.5; 3], [0.5; 4]);
    let gas = Gas::Ideal { gamma: 1.4 };
    let prepared = |mesh: &Mesh<'_, f64, 2>, periodic| {
        let faces = [0, 1].map(|d| vec![1.0; mesh.faces(d)]);
        let fractions = Fractions { volume: vec![1.0; 12], faces, flags: vec![0; 12] };
        let none = |_| Merging { list: vec![], parent: vec![], scratch: vec![] };
        prepare(mesh, periodic, fractions, Treatment::default(), none).unwrap()
    };
    let mesh = Mesh::new([&three[..], &four]).unwrap();
    let turned = Mesh::new([&four[..], &three]).unwrap();
    let walls = Problem::new(mesh, gas, [[Boundary::Wall; 2]; 2]).unwrap();
    assert!(walls.with_porosity(prepared(&mesh, [false; 2]).view()).is_ok());
    for other in [prepared(&turned, [false; 2]), prepared(&mesh, [true, false])] {
        assert_eq!(walls.with_porosity(other.view()).unwrap_err(), Error::OtherMesh);
    }
    let half = [[Boundary::Wall; 2], [Boundary::Periodic, Boundary::Wall]];
    assert_eq!(Problem::new(mesh, gas, half).unwrap_err(), Error::HalfPeriodic { axis: 1 });
}

#[test]
fn any_fractions_are_made_ready_and_stepped_without_panic() {
    let none = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, -2e-6, 1.0 + 2e-6, 2.0, 1e300];
    let odd = [1e-300, 1e-17, -1e-17, -1e-7, 1.0 + 1e-15, 1.0 + 1e-7];
    let mut s = Source::seeded(23);
    let (mut merged, mut closed, mut sealed, mut refused) = (0, 0, 0, 0);
    for round in 0..4000 {
        let n = [0, 1].map(|_| usize::from(s.bits() % 5));
        let widths = n.map(|n| vec![0.5; n]);
        let mesh = Mesh::new([&widths[0][..], &widths[1]]).unwrap();
        let periodic = [0, 1].map(|_| s.bits().is_multiple_of(3));
        let mut fractions = |count: usize| -> Vec<f64> {
            let mut one = || match round % 4 {
                0 | 1 if s.bits().is_multiple_of(4) => s.pick(&odd),
                0 if s.bits().is_multiple_of(8) => s.pick(&none),
                _ => s.fraction(),
            };
            (0..count).map(|_| one()).collect()
        };
        let cells = mesh.len();
        let (volume, faces) = (fractions(cells), [0, 1].map(|d| fractions(mesh.faces(d))));
        let place = |of: &[f64]| of.iter().position(|b| !(-1e-6..=1.0 + 1e-6).contains(b));
        let of_face = |axis: usize| place(&faces[axis]).map(|face| Error::FaceFraction { axis, face });
        let of_cell = place(&volume).map(|cell| Error::CellFraction { cell });
        let wrong = of_cell.or_else(|| (0..2).find_map(of_face));
        let of = Fractions { volume, faces, flags: vec![255; cells] };
        let merging = |cells| Merging {
            list: vec![7; cells],
            parent: vec![7; cells],
            scratch: vec![f64::NAN; cluster_scratch(cells)],
        };
        let space = match prepare(&mesh, periodic, of, Treatment::default(), merging) {
            Ok(space) => space,
            Err(error) => {
                assert_eq!(Some(error), wrong);
                refused += 1;
                continue;
            }
        };
        assert_eq!(wrong, None);
        let view = space.view();
        assert!(view.volume().iter().chain(view.faces().into_iter().flatten()).all(|b| (0.0..=1.0).contains(b)));
        let mut seen = vec![false; cells];
        for cell in view.clusters().flatten() {
            assert!(!std::mem::replace(&mut seen[cell], true), "a cell in two clusters");
        }
        merged += space.merged_cells();
        closed += space.tidied().closed_faces;
        sealed += view.sealed_cells();
        let sides = periodic.map(|p| [if p { Boundary::Periodic } else { Boundary::ZeroGradient }; 2]);
        let problem = Problem::new(mesh, Gas::Ideal { gamma: 1.4 }, sides).unwrap().with_porosity(view).unwrap();
        let (density, momentum, energy) = (vec![1.0; cells], vec![0.1; cells], vec![2.5; cells]);
        let old = Fields { density: &density, momentum: [&momentum; 2], energy: &energy, capacity: &[] };
        let (mut a, mut b, mut c, mut d) = (density.clone(), momentum.clone(), momentum.clone(), energy.clone());
        let mut new = FieldsMut { density: &mut a, momentum: [&mut b, &mut c], energy: &mut d, capacity: &mut [] };
        let mut scratch = vec![0.0; problem.scratch_len()];
        let _ = problem.step(&old, &mut new, 1e-3, &mut vec![0; cells], &mut scratch).unwrap();
    }
    println!("{merged} merged, {closed} closed to the outside, {sealed} sealed, {refused} refused");
    assert!(merged > 1000 && closed > 10 && sealed > 100 && refused > 500);
}

/// Walls are found by bisection among watched cells: where their indices did not ascend, a step panicked.
#[test]
fn any_call_of_the_flow_answers() {
    let mut calls = Calls::default();
    for round in 0..3000_u16 {
        any_calls_from_bytes(&[round as u8, round.to_le_bytes()[1], round as u8], &mut calls);
    }
    println!("{calls:?}");
    assert!(calls.merged > 100 && calls.stepped > 500 && calls.refused > 3000, "{calls:?}");
}

#[test]
fn a_run_that_cannot_advance_ends_with_an_error() {
    let walls = [[Boundary::Wall; 2]; 2];
    let mut flow = Flow::<f64, 2>::uniform([4, 3], [0.1; 2], Gas::Ideal { gamma: 1.4 }, walls);
    flow.fill(|_| Primitive { density: 1.2, velocity: [0.0; 2], pressure: 1e5 });
    for cfl in [0.0, -0.5, f64::NAN, 1.01, 5.0, f64::INFINITY] {
        assert_eq!(flow.run(cfl, 1.0), Err(Error::Step), "CFL number {cfl}");
        assert_eq!(flow.run(cfl, 0.0), Err(Error::Step), "CFL number {cfl} where no step is left to do");
        assert_eq!(flow.advance(cfl, 1.0).err(), Some(Error::Step), "CFL number {cfl}");
        assert_eq!((flow.time, flow.steps), (0.0, 0), "CFL number {cfl}");
    }
    // A time that is no number is neither reached nor passed.
    assert_eq!(flow.run(0.8, f64::NAN), Err(Error::Step));
    assert_eq!(flow.advance(0.8, f64::NAN).err(), Some(Error::Step));
    assert_eq!(flow.advance(0.8, -1.0).err(), Some(Error::Step), "back in time");
    assert_eq!(flow.step(f64::NAN).err(), Some(Error::Step));
    let mut asked = 0;
    let found = stable_step(0.0, f64::NAN, 1e-3, |_| -> Result<Report<f64, 2>, Error> {
        asked += 1;
        Ok(Report::new())
    });
    assert_eq!((found.err(), asked), (Some(Error::Step), 0));
    flow.time = f64::NAN;
    assert_eq!(flow.run(0.8, 1.0), Err(Error::Step));
    flow.time = 0.0;
    assert_eq!((flow.time, flow.steps), (0.0, 0));
    // A stable step here is some 1e-4: less than the last digit of the time.
    flow.time = 1e15;
    assert_eq!(flow.run(0.5, 2e15), Err(Error::Stalled));
    assert_eq!(flow.time, 1e15);
    flow.time = 0.0;
    assert_eq!(flow.run(0.5, 1e-3), Ok(()));
    assert_eq!(flow.time, 1e-3);
}

/// Drag that no obstacle has is refused, and what was there stays.
#[test]
fn drag_is_checked() {
    let gas = Gas::Ideal { gamma: 1.4 };
    let mut flow: Flow<f64, 2> = Flow::uniform([2, 2], [1.0; 2], gas, [[Boundary::Wall; 2]; 2]);
    flow.fill(|_| Primitive { density: 1.0, velocity: [1.0, 0.0], pressure: 1.0 });
    let one = || vec![1.0; 4];
    assert_eq!(flow.set_drag([one(), vec![]], [vec![], vec![]]), Ok(()));
    for wrong in [-1.0, f64::NAN, f64::INFINITY] {
        let along = vec![0.0, 0.0, wrong, 0.0];
        assert_eq!(flow.set_drag([one(), along.clone()], [vec![], vec![]]), Err(Error::Drag { axis: 1, cell: 2 }));
        assert_eq!(flow.set_drag([one(), vec![]], [along, vec![]]), Err(Error::Drag { axis: 0, cell: 2 }));
    }
    let short = flow.set_drag([vec![1.0; 3], vec![]], [vec![], vec![]]);
    assert_eq!(short, Err(Error::ShapeMismatch { expected: 4, found: 3 }));
    flow.step(0.1).expect("a step with the drag before");
    assert!(flow.get(0).velocity[0] < 0.99);
}
