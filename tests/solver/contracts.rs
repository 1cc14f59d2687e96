//! What a caller may get wrong is named, whatever it is: nothing panics.

use voidage_core::flow::porosity::clusters::{cluster_scratch, clusters};
use voidage_core::flow::{
    Boundary, Clusters, Conserved, Drag, Error, Fields, FieldsMut, Gas, Mesh, Porosity, Primitive, Problem, Report,
    Scheme, mark,
};
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
    cluster: u32,
}

const SOUND: Numbers = Numbers { width: 0.5, gas: Gas::Ideal { gamma: 1.4 }, cluster: 5 };

/// Calls everything on slices of the lengths given (the scratch: so much more or less than is needed); returns the errors.
fn call_all(lengths: &[usize; 17], numbers: Numbers) -> Vec<Error> {
    let of = |i: usize, value: f64| vec![value; lengths[i]];
    let [volume, x, y] = [of(0, 1.0), of(1, 1.0), of(2, 1.0)];
    let mut marks = vec![0; lengths[3]];
    let (quadratic, linear) = (of(4, 0.1), of(5, 0.1));
    let (density, momentum, energy) = (of(6, 1.0), of(7, 0.1), of(8, 2.5));
    let (mut new_density, mut new_momentum, mut new_energy) = (of(9, 1.0), [of(10, 0.0), of(10, 0.0)], of(11, 2.5));
    let mut first_order = vec![0; lengths[12]];
    let (mut list, mut parent, mut cluster_work) = (vec![0; lengths[13]], vec![0; lengths[14]], of(15, 0.0));
    let widths = [[0.5, 0.5, numbers.width, 0.5], [0.5; 4]];
    let mesh = Mesh { widths: [&widths[0], &widths[1][..3]] };
    let mut errors = Vec::new();
    let mut note = |result: Result<(), Error>| errors.extend(result.err());

    note(mark(&mesh, &volume, &[&x, &y], [false; 2], 0.1, &mut marks));
    note(clusters(&mesh, (&volume, &[&x, &y]), [false; 2], &mut list, &mut parent, &mut cluster_work).map(drop));
    let last = 1 << 31;
    let problem = Problem {
        mesh,
        gas: numbers.gas,
        boundaries: [[Boundary::Wall; 2]; 2],
        scheme: Scheme::default(),
        porosity: Some(Porosity { volume: &volume, faces: [&x, &y], marks: &marks }),
        clusters: Clusters(&[4, numbers.cluster | last]),
        drag: Some(Drag { quadratic: [&quadratic, &[]], linear: [&[], &linear] }),
        gravity: [0.0, -1.0],
    };
    let old = Fields { density: &density, momentum: [&momentum, &momentum], energy: &energy };
    let [u, v] = &mut new_momentum;
    let mut new = FieldsMut { density: &mut new_density, momentum: [u, v], energy: &mut new_energy };
    let mut scratch = vec![0.0; (problem.scratch_len() + lengths[16]).saturating_sub(1)];
    let mut report = Report::new();
    note(problem.check());
    note(problem.rate(&old).map(drop));
    note(problem.prepare(&mut new));
    note(problem.advance_slab(&old, &mut new, 0..3, 0.01, Some(&first_order), &mut scratch).map(drop));
    note(problem.merge(&old, &mut new, &mut report));
    note(problem.mark_troubled(&new.as_fields(), &mut first_order).map(drop));
    note(problem.apply_floors(&old, &mut new, &mut report));
    note(problem.step(&old, &mut new, 0.01, &mut first_order, &mut scratch).map(drop));
    errors
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
        let errors = call_all(&lengths(), Numbers { width, ..SOUND });
        assert!(
            errors.len() >= 7 && errors.iter().all(|e| *e == Error::Width { axis: 0, cell: 2 }),
            "{width}: {errors:?}"
        );
    }
    for cluster in [12, 13, 1 << 20, (1 << 31) - 1] {
        let errors = call_all(&lengths(), Numbers { cluster, ..SOUND });
        assert!(errors.len() >= 7 && errors.iter().all(|e| *e == Error::Cluster { entry: 1 }), "{cluster}: {errors:?}");
    }
    let gases = [1.0, 0.5, -1.4, f64::NAN, f64::INFINITY].map(|gamma| Gas::Ideal { gamma });
    let barotropic = [
        Gas::Isothermal { sound_speed: 0.0 },
        Gas::Isothermal { sound_speed: f64::NAN },
        Gas::Isentropic { gamma: 1.4, density: -1.0, pressure: 1.0 },
        Gas::Isentropic { gamma: 1.4, density: 1.0, pressure: f64::INFINITY },
    ];
    for gas in gases.into_iter().chain(barotropic) {
        let errors = call_all(&lengths(), Numbers { gas, ..SOUND });
        assert!(errors.len() >= 7 && errors.iter().all(|e| *e == Error::Gas), "{gas:?}: {errors:?}");
    }
}

#[test]
fn states_that_are_none_are_stepped_over_without_panic() {
    let none = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, 0.0, 1e300, 1e-300];
    let widths = [0.5; 6];
    let mut s = Source::seeded(5);
    for _ in 0..500 {
        let problem = Problem {
            mesh: Mesh { widths: [&widths] },
            gas: Gas::Ideal { gamma: 1.4 },
            boundaries: [[
                Boundary::Wall,
                Boundary::FarField(Primitive { density: 1.0, velocity: [0.1], pressure: 1.0 }),
            ]],
            scheme: Scheme::default(),
            porosity: None,
            clusters: Clusters(&[]),
            drag: None,
            gravity: [0.0],
        };
        let mut value = |usual: f64| if s.bits().is_multiple_of(4) { s.pick(&none) } else { usual };
        let states: Vec<Conserved<f64, 1>> =
            (0..6).map(|_| Conserved { density: value(1.0), momentum: [value(0.1)], energy: value(2.5) }).collect();
        let density: Vec<f64> = states.iter().map(|u| u.density).collect();
        let momentum: Vec<f64> = states.iter().map(|u| u.momentum[0]).collect();
        let energy: Vec<f64> = states.iter().map(|u| u.energy).collect();
        let old = Fields { density: &density, momentum: [&momentum], energy: &energy };
        let (mut a, mut b, mut c) = (vec![0.0; 6], vec![0.0; 6], vec![0.0; 6]);
        let mut new = FieldsMut { density: &mut a, momentum: [&mut b], energy: &mut c };
        let mut scratch = vec![0.0; problem.scratch_len()];
        assert!(problem.step(&old, &mut new, 1e-3, &mut [0; 6], &mut scratch).is_ok());
    }
}
