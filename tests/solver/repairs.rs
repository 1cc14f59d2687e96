//! What stands before a floor: fluxes between cell averages that keep any state physical, and keep mass and energy.

use voidage::flow::{Flow, Treatment};
use voidage_core::flow::fallback::{FIRST_ORDER, POSITIVE};
use voidage_core::flow::{Boundary, Conserved, Fields, FieldsMut, Gas, Mesh, Primitive, Problem};
use voidage_tests::euler::property::{Source, porosity};

const GAMMA: f64 = 1.4;
const IDEAL: Gas<f64> = Gas::Ideal { gamma: GAMMA };

/// Random states whose density and pressure span so many powers of ten, at speeds up to a Mach number.
fn rough(s: &mut Source<'_>, cells: usize, powers: f64, mach: f64) -> Vec<[f64; 3]> {
    (0..cells)
        .map(|_| {
            let (density, pressure) = (10f64.powf(-powers * s.unit()), 10f64.powf(-powers * s.unit()));
            let speed = mach * (GAMMA * pressure / density).sqrt() * (2.0 * s.unit() - 1.0);
            [density, density * speed, pressure / (GAMMA - 1.0) + 0.5 * density * speed * speed]
        })
        .collect()
}

fn pressure([density, momentum, energy]: [f64; 3]) -> f64 {
    (GAMMA - 1.0) * (energy - 0.5 * momentum * momentum / density)
}

/// |u| + c.
fn signal(u: [f64; 3]) -> f64 {
    (u[1] / u[0]).abs() + (GAMMA * pressure(u) / u[0]).sqrt()
}

/// Rusanov's flux, Toro eq. (10.42), written down anew.
fn rusanov(l: [f64; 3], r: [f64; 3]) -> [f64; 3] {
    let flux = |u: [f64; 3]| {
        let (v, p) = (u[1] / u[0], pressure(u));
        [u[1], u[1] * v + p, (u[2] + p) * v]
    };
    let (f, g, speed) = (flux(l), flux(r), signal(l).max(signal(r)));
    std::array::from_fn(|k| 0.5 * (f[k] + g[k]) - 0.5 * speed * (r[k] - l[k]))
}

/// One step of a periodic line of cells of width 1, all of which carry a mark.
fn marked_step(states: &[[f64; 3]], dt: f64, mark: u8) -> Vec<[f64; 3]> {
    let n = states.len();
    let widths = vec![1.0; n];
    let problem = Problem::new(Mesh::new([&widths]).unwrap(), IDEAL, [[Boundary::Periodic; 2]]).unwrap();
    let old: [Vec<f64>; 3] = std::array::from_fn(|k| states.iter().map(|u| u[k]).collect());
    let mut new = old.clone();
    let [density, momentum, energy] = &mut new;
    let fields = Fields { density: &old[0], momentum: [&old[1]], energy: &old[2], capacity: &[] };
    let mut out = FieldsMut { density, momentum: [momentum], energy, capacity: &mut [] };
    let mut scratch = vec![0.0; problem.scratch_len()];
    let _ = problem.advance_slab(&fields, &mut out, 0..1, dt, Some(&vec![mark; n]), &mut scratch).unwrap();
    (0..n).map(|i| std::array::from_fn(|k| new[k][i])).collect()
}

#[test]
fn marked_cells_have_the_first_order_flux_of_rusanov() {
    let mut s = Source::seeded(3);
    for n in [7, 300] {
        let states = rough(&mut s, n, 2.0, 3.0);
        let dt = 0.5 / states.iter().map(|&u| signal(u)).fold(0.0, f64::max);
        let new = marked_step(&states, dt, POSITIVE);
        let mut other = 0;
        for (i, of_first_order) in marked_step(&states, dt, FIRST_ORDER).into_iter().enumerate() {
            let (below, above) = (states[(i + n - 1) % n], states[(i + 1) % n]);
            let (low, high) = (rusanov(below, states[i]), rusanov(states[i], above));
            for k in 0..3 {
                let exact = states[i][k] - dt * (high[k] - low[k]);
                let scale = states[i][2] + dt * (high[k].abs() + low[k].abs());
                assert!((new[i][k] - exact).abs() < 1e-13 * scale, "cell {i} of {n}: {:?}", new[i]);
                other += usize::from((of_first_order[k] - exact).abs() > 1e-6 * scale);
            }
        }
        assert!(other > n, "the mark makes no difference");
    }
}

#[test]
fn marked_cells_stay_physical_at_the_whole_stable_step() {
    let mut s = Source::seeded(4);
    let mut others = 0;
    for round in 0..400 {
        let states = rough(&mut s, 40, 6.0, [1.0, 30.0, 1e3][round % 3]);
        let dt = 0.999 / states.iter().map(|&u| signal(u)).fold(0.0, f64::max);
        let physical = |u: &[f64; 3]| u[0] > 0.0 && pressure(*u) > 0.0;
        let new = marked_step(&states, dt, POSITIVE);
        assert!(new.iter().all(physical), "round {round}");
        let sum = |u: &[[f64; 3]], k: usize| u.iter().map(|u| u[k]).sum::<f64>();
        for k in [0, 2] {
            assert!((sum(&new, k) / sum(&states, k) - 1.0).abs() < 1e-12, "round {round}");
        }
        others += usize::from(!marked_step(&states, dt, FIRST_ORDER).iter().all(physical));
    }
    println!("first order alone left the physical set in {others} of 400 rounds");
}

/// Gas whose density and pressure span three powers of ten in every cell, at speeds up to a Mach number, in a periodic square.
fn rough_square(s: &mut Source<'_>, porous: bool, mach: f64) -> Flow<f64, 2> {
    let n = [12, 12];
    let mut flow: Flow<f64, 2> = Flow::uniform(n, [1.0; 2], IDEAL, [[Boundary::Periodic; 2]; 2]);
    if porous {
        let (volume, faces) = porosity(s, n);
        let tidied = flow.set_porosity(volume, faces, Treatment::default()).unwrap();
        assert!(tidied.matched_faces > 0, "the sides of a periodic axis are one plane: {tidied:?}");
    }
    for cell in 0..flow.len() {
        let (density, pressure) = (s.scale(1e-3, 1.0), s.scale(1e-3, 1.0));
        let speed = mach * f64::sqrt(GAMMA * pressure / density);
        let velocity = std::array::from_fn(|_| speed * (2.0 * s.unit() - 1.0));
        flow.set(cell, &Primitive { density, velocity, pressure });
    }
    flow
}

#[test]
fn stable_steps_through_rough_gas_need_no_floor_and_keep_mass_and_energy() {
    for porous in [false, true] {
        let (mut fallen, mut repeated) = (0, 0);
        for (mach, seed) in [3.0, 30.0, 1e3].into_iter().flat_map(|mach| (0..4).map(move |seed| (mach, seed))) {
            let mut flow = rough_square(&mut Source::seeded(seed), porous, mach);
            flow.rate().unwrap();
            let Conserved { density: mass, energy, .. } = flow.content();
            for _ in 0..60 {
                flow.advance(0.8, f64::INFINITY).unwrap();
            }
            let end = flow.content();
            println!(
                "porous {porous} Mach {mach} seed {seed}: floors {} repeats {} first order {} mass {:e} energy {:e}",
                flow.total.floored,
                flow.repeated,
                flow.total.first_order,
                end.density / mass - 1.0,
                end.energy / energy - 1.0
            );
            assert_eq!(flow.total.floored, 0, "porous {porous}, Mach {mach}, seed {seed}");
            let kept = |now: f64, then: f64| (now / then - 1.0).abs() < 1e-12;
            assert!(kept(end.density, mass) && kept(end.energy, energy), "porous {porous}, Mach {mach}: {end:?}");
            fallen += flow.total.first_order;
            repeated += flow.repeated;
        }
        assert!(fallen > 100, "no fallback was visited");
        println!("porous {porous}: {repeated} repeated steps");
    }
}

/// After floors the reported rate is that of the states that are there.
#[test]
fn floors_leave_their_own_rate() {
    let states = [(1.0, 2.0, 0.1), (1.0, 2.0, 1.0), (0.1, 2.0, 0.001), (0.01, -2.0, 0.01)];
    let mut flow: Flow<f64, 1> = Flow::uniform([4], [0.25], Gas::Ideal { gamma: 1.4 }, [[Boundary::Wall; 2]]);
    for (cell, (density, u, pressure)) in states.into_iter().enumerate() {
        flow.set(cell, &Primitive { density, velocity: [u], pressure });
    }
    let report = flow.step(0.47122).unwrap();
    assert!(report.floored > 0);
    flow.touched();
    let rate = flow.rate().unwrap();
    assert!((report.rate / rate - 1.0).abs() < 1e-12, "{} and {rate}", report.rate);
}
