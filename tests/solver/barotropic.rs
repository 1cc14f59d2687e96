//! What gases without an energy equation have of their own, and what a step must not tell them apart by.

use voidage::flow::{Flow, Treatment};
use voidage_core::flow::{Boundary, Gas, Limiter, Primitive, Scheme};

const IDEAL: Gas<f64> = Gas::Ideal { gamma: 1.4 };
const ISOTHERMAL: Gas<f64> = Gas::Isothermal { sound_speed: 1.0 };

/// A column in the balance that the scheme keeps, p = ρ, under gravity −1; its largest velocity until t = 5.
fn largest_velocity(widths: &[f64], gas: Gas<f64>, limiter: Limiter, small: Option<usize>) -> f64 {
    let mut flow: Flow<f64, 1> = Flow::new([widths.to_vec()], gas, [[Boundary::Wall; 2]]);
    (flow.gravity, flow.scheme) = ([-1.0], Scheme { limiter, ..Scheme::default() });
    if let Some(cell) = small {
        let mut volume = vec![1.0; widths.len()];
        volume[cell] = 0.05;
        flow.set_porosity(volume, [vec![1.0; widths.len() + 1]], Treatment::default()).unwrap();
        assert_eq!(flow.clusters().len(), 1);
    }
    let mut density = 1.0;
    for cell in 0..widths.len() {
        if cell > 0 {
            density *= (1.0 - 0.5 * widths[cell - 1]) / (1.0 + 0.5 * widths[cell]);
        }
        flow.set(cell, &Primitive { density, velocity: [0.0], pressure: density });
    }
    let mut largest = 0.0;
    while flow.time < 5.0 {
        flow.advance(0.6, f64::MAX).unwrap();
        largest = (0..flow.len()).fold(largest, |most, cell| flow.get(cell).velocity[0].abs().max(most));
    }
    largest
}

/// Gas at rest stays so on cells of any widths, by any limiter, also where small cells share a state.
#[test]
fn columns_stay_at_rest() {
    let growing: Vec<f64> = (0..16).map(|i| 0.03 * 1.15_f64.powi(i)).collect();
    let alternating: Vec<f64> = (0..16).map(|i| [0.06, 0.14][i % 2]).collect();
    let limiters =
        [Limiter::Steep, Limiter::MonotonizedCentral, Limiter::Minmod, Limiter::Unlimited, Limiter::AroraRoe];
    for gas in [IDEAL, ISOTHERMAL] {
        for limiter in limiters {
            for widths in [&growing, &alternating] {
                let found = largest_velocity(widths, gas, limiter, None);
                assert!(found < 1e-13, "{gas:?} {limiter:?} {widths:?}: {found:e}");
            }
        }
        let found = largest_velocity(&[0.1; 16], gas, Limiter::Steep, Some(8));
        assert!(found < 1e-13, "{gas:?} with a small cell: {found:e}");
    }
}

/// Equal cells are equal cells under gravity, too: a limiter needs no more than its own bounds there.
#[test]
fn gravity_of_nothing_changes_nothing() {
    let run = |gravity: f64| {
        let mut flow: Flow<f64, 1> = Flow::uniform([48], [1.0 / 48.0], IDEAL, [[Boundary::Periodic; 2]]);
        (flow.gravity, flow.scheme) = ([gravity], Scheme { limiter: Limiter::AroraRoe, ..Scheme::default() });
        flow.fill(|[x]| {
            let pressure = 1.0 + 0.001 * (-((x - 0.5) / 0.03).powi(2)).exp();
            Primitive { density: pressure.powf(1.0 / 1.4), velocity: [(pressure - 1.0) / 1.4_f64.sqrt()], pressure }
        });
        for _ in 0..60 {
            flow.advance(0.6, f64::MAX).unwrap();
        }
        (0..48).map(|cell| flow.get(cell).pressure).collect::<Vec<f64>>()
    };
    let apart = run(0.0).iter().zip(run(1e-300)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(apart < 1e-14, "{apart:e}");
}

/// The pressure of a gas without energy follows from its density, on sides too.
#[test]
fn the_density_outside_tells_the_pressure() {
    let gas = Gas::Isothermal { sound_speed: 340.0 };
    for pressure in [0.0, 1.0, f64::NAN] {
        let outside = Primitive { density: 1.2, velocity: [0.0], pressure };
        let sides = [Boundary::FarField(outside), Boundary::Reservoir { density: 1.2, pressure }];
        for side in sides {
            let mut flow: Flow<f64, 1> = Flow::uniform([8], [0.1], gas, [[side, Boundary::Wall]]);
            flow.fill(|_| Primitive { density: 1.2, velocity: [0.0], pressure: 340.0 * 340.0 * 1.2 });
            for _ in 0..20 {
                flow.advance(0.6, f64::MAX).unwrap();
            }
            let still = (0..8).all(|cell| flow.get(cell).velocity[0].abs() < 1e-9);
            assert!(still && flow.total.floored == 0, "{side:?}");
        }
    }
}

/// An outlet of a little less pressure draws as sound does, however near γ is to 1, in single precision too.
#[test]
fn outlets_of_all_gammas_draw_alike() {
    for gamma in [1.0001_f32, 1.001, 1.01, 1.4] {
        let gas = Gas::Ideal { gamma };
        let sides = [[Boundary::Wall, Boundary::Outlet { pressure: 1e5 - 50.0 }]];
        let mut flow: Flow<f32, 1> = Flow::uniform([4], [1.0], gas, sides);
        flow.fill(|_| Primitive { density: 1.2, velocity: [0.0], pressure: 1e5 });
        let inside = flow.get(3);
        let ghost = sides[0][1].ghost_cell(&inside, 0, false, gas);
        let expected = 50.0 / (1.2 * gas.sound_speed(&inside));
        assert!((ghost.velocity[0] / expected - 1.0).abs() < 0.01, "{gamma}: {} for {expected}", ghost.velocity[0]);
    }
}

/// A step of no length changes nothing, and drag too weak to be told does not take the push of other forces.
#[test]
fn drag_of_next_to_nothing() {
    let mut flow: Flow<f64, 1> = Flow::uniform([4], [0.25], IDEAL, [[Boundary::Wall; 2]]);
    flow.set_drag([Vec::new()], [vec![1.0; 4]]).unwrap();
    flow.fill(|_| Primitive { density: 1.0, velocity: [0.1], pressure: 1.0 });
    let before: Vec<_> = (0..4).map(|cell| flow.get(cell)).collect();
    flow.step(0.0).unwrap();
    assert!(flow.total.floored == 0 && (0..4).all(|cell| flow.get(cell) == before[cell]));
    let mut flow: Flow<f32, 1> = Flow::uniform([4], [0.25], Gas::Ideal { gamma: 1.4 }, [[Boundary::Periodic; 2]]);
    flow.set_drag([Vec::new()], [vec![1e-39; 4]]).unwrap();
    flow.gravity = [1.0];
    flow.fill(|_| Primitive { density: 1.0, velocity: [0.0], pressure: 1.0 });
    flow.step(0.01).unwrap();
    assert!((flow.get(0).velocity[0] - 0.01).abs() < 1e-6, "{}", flow.get(0).velocity[0]);
}

/// Whether members of a cluster share a state at the beginning does not depend on their order.
#[test]
fn clusters_begin_alike_in_any_order() {
    let pressures = |mirrored: bool| {
        let turned = |mut list: Vec<f64>| {
            if mirrored {
                list.reverse();
            }
            list
        };
        let mut flow: Flow<f64, 1> = Flow::uniform([4], [0.1], IDEAL, [[Boundary::Wall; 2]]);
        let (volume, faces) = (turned(vec![1.0, 1.0, 0.05, 1.0]), turned(vec![1.0, 1.0, 0.95, 1.0, 1.0]));
        flow.set_porosity(volume, [faces], Treatment::default()).unwrap();
        let start = turned(vec![1.0, 1.0, 1.0, 1.105]);
        flow.fill(|[x]| Primitive { density: 1.0, velocity: [0.0], pressure: start[(x * 10.0) as usize] });
        flow.rate().unwrap();
        turned((0..4).map(|cell| flow.get(cell).pressure).collect())
    };
    assert_eq!(pressures(false), pressures(true));
}

/// The two ends of a periodic axis are one face.
#[test]
fn jumps_at_a_seam_count_once() {
    let mut flow: Flow<f64, 1> = Flow::uniform([4], [0.25], IDEAL, [[Boundary::Periodic; 2]]);
    flow.set_porosity(vec![0.5, 1.0, 1.0, 1.0], [vec![0.5, 0.5, 1.0, 1.0, 0.5]], Treatment::default()).unwrap();
    assert_eq!(flow.jump_faces(), 2);
}
