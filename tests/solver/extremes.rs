//! Corners of the input: tiny cells, blocked space, hardly any cells, states that are none.

use voidage::flow::{Flow, Treatment};
use voidage_core::flow::{Boundary, Conserved, Error, Gas, Mesh, Primitive, Problem, Report};
use voidage_tests::euler::property::Source;
use voidage_tests::euler::{Riemann, State};

const IDEAL: Gas<f64> = Gas::Ideal { gamma: 1.4 };

fn blast<const D: usize>(flow: &mut Flow<f64, D>) {
    flow.fill(|x| Primitive {
        density: if x[0] < 0.5 { 1.0 } else { 0.125 },
        velocity: [0.0; D],
        pressure: if x[0] < 0.5 { 1.0 } else { 0.1 },
    });
}

fn finite<const D: usize>(flow: &Flow<f64, D>) -> bool {
    (0..flow.len()).all(|c| {
        let w = flow.get(c);
        w.density > 0.0 && w.pressure > 0.0 && w.density.is_finite() && w.pressure.is_finite()
    })
}

/// A mesh of `n` cells across the unit interval along axis 0 with thin cells of open volume `tiny` strewn in.
fn thin_cells<const D: usize>(n: [usize; D], tiny: f64) -> (usize, usize) {
    let make = |porous: bool| {
        let mut flow: Flow<f64, D> = Flow::uniform(n, [1.0 / n[0] as f64; D], IDEAL, [[Boundary::Wall; 2]; D]);
        if porous {
            let volume = (0..flow.len()).map(|c| if c % 7 == 3 || c % 11 == 4 { tiny } else { 1.0 }).collect();
            let faces = std::array::from_fn(|d| vec![1.0; (0..D).map(|a| n[a] + usize::from(a == d)).product()]);
            flow.set_porosity(volume, faces, Treatment::default()).unwrap();
        }
        blast(&mut flow);
        let before = flow.content();
        flow.run(0.8, 0.2).unwrap();
        let after = flow.content();
        assert!(finite(&flow) && flow.total.floored == 0);
        assert!((after.density / before.density - 1.0).abs() < 1e-12);
        assert!((after.energy / before.energy - 1.0).abs() < 1e-12);
        flow.steps
    };
    (make(true), make(false))
}

#[test]
fn tiny_cells_cost_at_most_four_times_the_steps() {
    for tiny in [0.3, 1e-3, 1e-12] {
        for (porous, plain) in [thin_cells([200], tiny), thin_cells([48, 9], tiny), thin_cells([24, 6, 5], tiny)] {
            assert!(porous <= 4 * plain, "{tiny}: {porous} {plain}");
        }
    }
}

/// Error of a shock tube through random slices of open volume, in the length that they leave, against the same of as many cells
/// without slices.
fn through_slices(seed: u64) -> f64 {
    const N: usize = 200;
    let mut s = Source::seeded(seed);
    let sliced: Vec<f64> = (0..N).map(|_| if s.unit() < 0.25 { 10f64.powf(-12.0 * s.unit()) } else { 1.0 }).collect();
    let (left, right) = (State::new(1.0, 0.0, 1.0), State::new(0.125, 0.0, 0.1));
    let exact = Riemann::new(left, right, 1.4);
    let error = |open: Vec<f64>| {
        let width = 1.0 / open.iter().sum::<f64>();
        let mut flow: Flow<f64, 1> = Flow::uniform([N], [width], IDEAL, [[Boundary::ZeroGradient; 2]]);
        flow.set_porosity(open.clone(), [vec![1.0; N + 1]], Treatment::default()).unwrap();
        for i in 0..N {
            flow.set(i, &if i < N / 2 { left } else { right }.primitive());
        }
        flow.run(0.8, 0.2).unwrap();
        let middle: f64 = open[..N / 2].iter().sum::<f64>() * width;
        let mut x = 0.0;
        let mut error = 0.0;
        for (i, beta) in open.iter().enumerate() {
            let own = beta * width;
            error += own * (flow.get(i).density - exact.at((x + 0.5 * own - middle) / 0.2).rho).abs();
            x += own;
        }
        error
    };
    error(sliced) / error(vec![1.0; N])
}

#[test]
fn tiny_cells_cost_little_accuracy() {
    let ratios: Vec<f64> = (0..6).map(through_slices).collect();
    println!("times the error without slices: {ratios:.2?}");
    assert!(ratios.iter().sum::<f64>() < 4.5 * 6.0 && ratios.iter().all(|&r| r < 6.0), "{ratios:?}");
}

#[test]
fn blocked_and_enclosed_space_is_inert() {
    // All blocked; a sealed pocket; a dead end; a blocked row.
    let n = [8, 6];
    for kind in 0..4 {
        let mut volume = vec![1.0; 48];
        let mut faces = [vec![1.0; 9 * 6], vec![1.0; 8 * 7]];
        match kind {
            0 => {
                volume.fill(0.0);
                faces.iter_mut().for_each(|f| f.fill(0.0));
            }
            1 => {
                // Cell (4, 3) closed all round but open inside.
                faces[0][3 * 9 + 4] = 0.0;
                faces[0][3 * 9 + 5] = 0.0;
                faces[1][3 * 8 + 4] = 0.0;
                faces[1][4 * 8 + 4] = 0.0;
            }
            2 => {
                faces[0][3 * 9 + 5] = 0.0;
                faces[1][3 * 8 + 4] = 0.0;
                faces[1][4 * 8 + 4] = 0.0;
            }
            _ => {
                for i in 0..8 {
                    volume[2 * 8 + i] = 0.0;
                    faces[1][2 * 8 + i] = 0.0;
                    faces[1][3 * 8 + i] = 0.0;
                    faces[0][2 * 9 + i] = 0.0;
                }
                faces[0][2 * 9 + 8] = 0.0;
            }
        }
        let mut flow = Flow::uniform(n, [0.125; 2], IDEAL, [[Boundary::Wall; 2]; 2]);
        flow.set_porosity(volume.clone(), faces, Treatment::default()).unwrap();
        blast(&mut flow);
        let before: Vec<_> = (0..48).map(|c| flow.get(c)).collect();
        for _ in 0..200 {
            let dt = flow.stable_dt(0.8).unwrap();
            flow.step(if dt.is_finite() { dt } else { 1.0 }).unwrap();
        }
        assert!(finite(&flow), "kind {kind}");
        for c in 0..48 {
            let still = kind == 0 || (kind == 1 && c == 3 * 8 + 4) || volume[c] == 0.0;
            if still {
                assert_eq!(flow.get(c), before[c], "kind {kind} cell {c}");
            }
        }
    }
}

#[test]
fn hardly_any_cells_and_odd_gases() {
    for n in 1..4 {
        for ends in [Boundary::Periodic, Boundary::Wall, Boundary::ZeroGradient] {
            let mut flow: Flow<f64, 3> = Flow::uniform([n, 1, 2], [0.1, 1e-4, 0.1], IDEAL, [[ends; 2]; 3]);
            flow.fill(|x| Primitive { density: 1.0 + x[0] + x[2], velocity: [0.1, 0.2, 0.3], pressure: 1.0 });
            for _ in 0..20 {
                flow.advance(0.8, f64::MAX).unwrap();
            }
            assert!(finite(&flow));
        }
    }
    for gamma in [1.01, 1.4, 3.0] {
        let mut flow: Flow<f64, 1> = Flow::uniform([100], [0.01], Gas::Ideal { gamma }, [[Boundary::Wall; 2]]);
        blast(&mut flow);
        flow.run(0.8, 0.2).unwrap();
        assert!(finite(&flow), "{gamma}");
    }
}

#[test]
fn a_state_that_is_none_is_refused_with_its_cell() {
    for (cell, density, pressure) in [(3, f64::NAN, 1.0), (4, -1.0, 1.0), (5, 1.0, -1.0), (6, 1.0, f64::INFINITY)] {
        let mut flow: Flow<f64, 1> = Flow::uniform([10], [0.1], IDEAL, [[Boundary::Wall; 2]]);
        flow.fill(|_| Primitive { density: 1.0, velocity: [0.0], pressure: 1.0 });
        flow.set(cell, &Primitive { density, velocity: [0.0], pressure });
        assert_eq!(flow.stable_dt(0.8), Err(Error::Unphysical { cell }));
    }
}

#[test]
fn broken_contracts_are_named() {
    let mut flow: Flow<f64, 1> = Flow::uniform([10], [0.1], IDEAL, [[Boundary::Wall, Boundary::Periodic]]);
    flow.fill(|_| Primitive { density: 1.0, velocity: [0.0], pressure: 1.0 });
    assert_eq!(flow.stable_dt(0.8), Err(Error::HalfPeriodic { axis: 0 }));
    let fit = flow.set_porosity(vec![1.0; 9], [vec![1.0; 11]], Treatment::default());
    assert_eq!(fit, Err(Error::ShapeMismatch { expected: 10, found: 9 }));
}

#[test]
fn channel_with_a_box_is_symmetric_and_still_in_the_box() {
    let n = [20, 9, 9];
    let solid = |c: usize| {
        let (i, j, k) = (c % 20, c / 20 % 9, c / 180);
        (8..10).contains(&i) && (3..6).contains(&j) && (3..6).contains(&k)
    };
    let volume: Vec<f64> = (0..1620).map(|c| if solid(c) { 0.0 } else { 1.0 }).collect();
    let faces = std::array::from_fn(|d| {
        let size: [usize; 3] = std::array::from_fn(|a| n[a] + usize::from(a == d));
        (0..size.iter().product::<usize>())
            .map(|f| {
                let at = [f % size[0], f / size[0] % size[1], f / size[0] / size[1]];
                let cell = |at: [usize; 3]| (at[2] * 9 + at[1]) * 20 + at[0];
                let mut below = at;
                let open_above = at[d] >= n[d] || !solid(cell(at));
                let open_below = at[d] == 0 || {
                    below[d] -= 1;
                    !solid(cell(below))
                };
                f64::from(u8::from(open_above && open_below))
            })
            .collect()
    });
    let wind = Primitive { density: 1.2, velocity: [10.0, 0.0, 0.0], pressure: 101325.0 };
    let mut boundaries = [[Boundary::Wall; 2]; 3];
    boundaries[0] = [Boundary::FarField(wind); 2];
    let mut flow: Flow<f64, 3> = Flow::uniform(n, [0.5; 3], IDEAL, boundaries);
    flow.set_porosity(volume, faces, Treatment::default()).unwrap();
    for c in 0..1620 {
        let mut w = wind;
        if solid(c) {
            w.velocity = [0.0; 3];
        }
        flow.set(c, &w);
    }
    for _ in 0..600 {
        flow.advance(0.8, f64::MAX).unwrap();
    }
    assert!(finite(&flow));
    for c in 0..1620 {
        let (i, j, k) = (c % 20, c / 20 % 9, c / 180);
        let (w, m) = (flow.get(c), flow.get((k * 9 + 8 - j) * 20 + i));
        assert_eq!(w.density.to_bits(), m.density.to_bits());
        assert_eq!(w.velocity[1], -m.velocity[1]);
        if solid(c) {
            assert_eq!(w.velocity, [0.0; 3]);
        }
    }
    assert!(flow.get((4 * 9 + 4) * 20 + 12).velocity[0] < 9.0, "no wake");
}

/// A box of 5 × 5 cells of gas at rest in which only the middle one has been through something: the pressure it had, and the kinetic and
/// total energy it has now. Returns its state after the floor, and what the floor changed.
fn floored_middle(pressure: f64, kinetic: f64, total: f64) -> (Primitive<f64, 2>, Conserved<f64, 2>) {
    const MIDDLE: usize = 12;
    let mut flow: Flow<f64, 2> = Flow::uniform([5, 5], [0.5; 2], IDEAL, [[Boundary::Periodic; 2]; 2]);
    flow.fill(|_| Primitive { density: 1.0, velocity: [0.0; 2], pressure: 1.0 });
    flow.set(MIDDLE, &Primitive { density: 1.0, velocity: [0.0; 2], pressure });
    let old = flow.state.clone();
    let momentum = [(2.0 * kinetic).sqrt(), 0.0];
    flow.state.view_mut().set(MIDDLE, &Conserved { density: 1.0, momentum, energy: total });
    let widths = [0.5; 5];
    let problem = Problem::new(Mesh::new([&widths, &widths]).unwrap(), IDEAL, flow.boundaries).unwrap();
    let mut report = Report::new();
    problem.apply_floors(&old.view(), &mut flow.state.view_mut(), &mut report).unwrap();
    assert_eq!((report.floored, report.floored_cell), (1, Some(MIDDLE)));
    (flow.get(MIDDLE), report.floor_change)
}

#[test]
fn a_floor_takes_from_the_kinetic_energy_what_the_pressure_lacks() {
    let (w, change) = floored_middle(1.0, 2.0, 1.9);
    let energy = w.pressure / 0.4 + 0.5 * w.density * w.velocity[0].powi(2);
    assert!((energy - 1.9).abs() < 1e-14 && w.pressure >= 1e-3 * (1.0 - 1e-12), "{w:?}");
    assert!(change.density == 0.0 && change.energy.abs() < 1e-14, "{change:?}");
    // A quarter of the momentum that is gone: the cells are 0.5 × 0.5.
    assert!((change.momentum[0] - 0.25 * (2.0 - w.velocity[0])).abs() < 1e-14, "{change:?}");
}

#[test]
fn a_floor_that_must_add_adds_a_share_of_what_is_around() {
    for total in [-1.0, -1e-9, f64::NAN] {
        let (w, change) = floored_middle(1.0, 2.0, total);
        assert!((w.pressure - 1e-3).abs() < 1e-12 && w.velocity == [0.0; 2], "{w:?}");
        let before = if total.is_nan() { 2.5 } else { total };
        assert!((change.energy - 0.25 * (1e-3 / 0.4 - before).abs()).abs() < 1e-12, "{change:?}");
    }
}

#[test]
fn floors_do_not_repeat_into_nothing() {
    // What an earlier floor has left counts for one of five.
    let (w, _) = floored_middle(1e-30, 2.0, 1.9);
    assert!((w.pressure - 0.8e-3).abs() < 1e-9, "{w:?}");
}

#[test]
fn energy_grows_by_what_is_booked_for_floors() {
    let mut floors = 0;
    for (mach, seed) in [3.0, 30.0, 1e3].into_iter().flat_map(|mach| (0..4).map(move |seed| (mach, seed))) {
        // Random gas in a periodic box, at a step so much too long that now and then only a floor helps.
        let mut s = Source::seeded(seed);
        let mut flow: Flow<f64, 2> = Flow::uniform([12, 12], [1.0; 2], IDEAL, [[Boundary::Periodic; 2]; 2]);
        for cell in 0..144 {
            let (density, pressure) = (s.scale(1e-2, 1.0), s.scale(1e-2, 1.0));
            let speed = mach * f64::sqrt(1.4 * pressure / density);
            let velocity = std::array::from_fn(|_| speed * (2.0 * s.unit() - 1.0));
            flow.set(cell, &Primitive { density, velocity, pressure });
        }
        let begin = flow.content();
        for _ in 0..60 {
            let dt = flow.stable_dt(1.5).unwrap();
            flow.step(dt).unwrap();
            assert!(finite(&flow));
        }
        let (end, change) = (flow.content(), flow.total.floor_change);
        let grown = |a: f64, b: f64, booked: f64| (b - a - booked).abs() < 1e-11 * a;
        assert!(
            grown(begin.energy, end.energy, change.energy),
            "Mach {mach} seed {seed}: {begin:?} {end:?} {change:?}"
        );
        assert!(
            grown(begin.density, end.density, change.density),
            "Mach {mach} seed {seed}: {begin:?} {end:?} {change:?}"
        );
        floors += flow.total.floored;
    }
    assert!(floors > 0, "no floor was visited");
}

#[test]
fn stable_steps_through_rough_gas_need_no_floor_and_keep_mass_and_energy() {
    let mut fallen = 0;
    for (mach, seed) in [3.0, 30.0, 1e3].into_iter().flat_map(|mach| (0..4).map(move |seed| (mach, seed))) {
        let mut s = Source::seeded(seed);
        let mut flow: Flow<f64, 2> = Flow::uniform([12, 12], [1.0; 2], IDEAL, [[Boundary::Periodic; 2]; 2]);
        for cell in 0..144 {
            let (density, pressure) = (s.scale(1e-3, 1.0), s.scale(1e-3, 1.0));
            let speed = mach * f64::sqrt(1.4 * pressure / density);
            let velocity = std::array::from_fn(|_| speed * (2.0 * s.unit() - 1.0));
            flow.set(cell, &Primitive { density, velocity, pressure });
        }
        let Conserved { density: mass, energy, .. } = flow.content();
        for _ in 0..60 {
            let dt = flow.stable_dt(0.8).unwrap();
            flow.step(dt).unwrap();
        }
        let end = flow.content();
        assert_eq!(flow.total.floored, 0, "Mach {mach} seed {seed}");
        assert!((end.density / mass - 1.0).abs() < 1e-12 && (end.energy / energy - 1.0).abs() < 1e-12, "{end:?}");
        fallen += flow.total.first_order;
    }
    assert!(fallen > 100, "no fallback was visited");
}
