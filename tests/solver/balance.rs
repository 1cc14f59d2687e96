//! Conservation, hydrostatic balance, drag.

use voidage::flow::{Flow, Treatment};
use voidage_core::flow::{Boundary, Gas, Primitive};
use voidage_tests::euler::property::{Source, porosity};

const IDEAL: Gas<f64> = Gas::Ideal { gamma: 1.4 };

fn closed_box<const D: usize>(seed: u64, porous: bool) {
    let mut s = Source::seeded(seed);
    let n: [usize; D] = std::array::from_fn(|d| 12 - 2 * d);
    let mut flow: Flow<f64, D> = Flow::uniform(n, [0.1; D], IDEAL, [[Boundary::Wall; 2]; D]);
    if porous {
        let (volume, faces) = porosity(&mut s, n);
        flow.set_porosity(volume, faces, Treatment::default()).unwrap();
    }
    for cell in 0..flow.len() {
        let pressure = if cell == flow.len() / 2 { 1e3 } else { 1.0 };
        flow.set(cell, &Primitive { density: 0.5 + s.unit(), velocity: [0.0; D], pressure });
    }
    flow.rate().unwrap();
    let before = flow.content();
    for _ in 0..100 {
        flow.advance(0.6, f64::MAX).unwrap();
    }
    let after = flow.content();
    assert_eq!(flow.total.floored, 0, "{D}D seed {seed} porous {porous} repeated {}", flow.repeated);
    assert!((after.density / before.density - 1.0).abs() < 1e-12, "mass {D}D {seed}");
    assert!((after.energy / before.energy - 1.0).abs() < 1e-12, "energy {D}D {seed}");
}

#[test]
fn mass_and_energy_of_a_closed_box() {
    for seed in 0..4 {
        for porous in [false, true] {
            closed_box::<1>(seed, porous);
            closed_box::<2>(seed, porous);
            closed_box::<3>(seed, porous);
        }
    }
}

#[test]
fn momentum_of_a_periodic_box() {
    let mut s = Source::seeded(1);
    let mut flow: Flow<f64, 3> = Flow::uniform([8, 7, 6], [0.1; 3], IDEAL, [[Boundary::Periodic; 2]; 3]);
    for cell in 0..flow.len() {
        let velocity = std::array::from_fn(|_| s.unit());
        flow.set(cell, &Primitive { density: 0.5 + s.unit(), velocity, pressure: s.scale(0.1, 10.0) });
    }
    let before = flow.content();
    for _ in 0..100 {
        flow.advance(0.6, f64::MAX).unwrap();
    }
    let after = flow.content();
    for c in 0..3 {
        assert!((after.momentum[c] / before.momentum[c] - 1.0).abs() < 1e-12);
    }
}

#[test]
fn a_column_in_discrete_balance_stays_along_every_axis() {
    fn column<const D: usize>(axis: usize) -> f64 {
        let m = 64;
        let mut n = [3; D];
        n[axis] = m;
        let (g, dz) = (-9.81, 10.0);
        let mut boundaries = [[Boundary::Periodic; 2]; D];
        boundaries[axis] = [Boundary::Wall; 2];
        let mut flow: Flow<f64, D> = Flow::uniform(n, [dz; D], IDEAL, boundaries);
        flow.gravity[axis] = g;
        // Layers of random porosity; faces as open as the narrower cell.
        let mut s = Source::seeded(9);
        let layers: Vec<f64> = (0..m).map(|_| 0.05 + 0.95 * s.unit()).collect();
        let stride: usize = n[..axis].iter().product();
        let volume: Vec<f64> = (0..flow.len()).map(|c| layers[c / stride % m]).collect();
        let faces = std::array::from_fn(|d| {
            let size: [usize; D] = std::array::from_fn(|a| n[a] + usize::from(a == d));
            (0..size.iter().product::<usize>())
                .map(|mut f| {
                    let at: [usize; D] = std::array::from_fn(|a| {
                        let i = f % size[a];
                        f /= size[a];
                        i
                    });
                    let k = at[axis];
                    if d == axis { layers[k.min(m - 1)].min(layers[k.max(1) - 1]) } else { layers[k] }
                })
                .collect()
        });
        flow.set_porosity(volume, faces, Treatment::default()).unwrap();
        let density: Vec<f64> = (0..m).map(|k| 1.2 * (-(k as f64) * dz / 8000.0).exp()).collect();
        let mut pressure = vec![1e5; m];
        for k in 1..m {
            pressure[k] = pressure[k - 1] + 0.5 * g * dz * (density[k - 1] + density[k]);
        }
        for cell in 0..flow.len() {
            let k = cell / stride % m;
            flow.set(cell, &Primitive { density: density[k], velocity: [0.0; D], pressure: pressure[k] });
        }
        for _ in 0..1000 {
            flow.advance(0.8, f64::MAX).unwrap();
        }
        (0..flow.len())
            .map(|c| flow.get(c).velocity.iter().fold(0.0f64, |m, v| m.max(v.abs())) / 340.0)
            .fold(0.0, f64::max)
    }
    assert!(column::<1>(0) < 1e-12);
    assert!(column::<2>(1) < 1e-12);
    assert!(column::<3>(2) < 1e-12);
}

#[test]
fn a_shock_meets_a_slab_of_any_drag() {
    // Mach 2 into air at rest; the slab of CR = 1e12 is a rigid wall, whose reflected pressure is exact by theory: 15.
    let n = 200;
    let run = |cr: f64| {
        let left = Primitive { density: 8.0 / 3.0, velocity: [1.479_019_945_774_904], pressure: 4.5 };
        let right = Primitive { density: 1.0, velocity: [0.0], pressure: 1.0 };
        let mut flow: Flow<f64, 1> =
            Flow::uniform([n], [1.0 / n as f64], IDEAL, [[Boundary::FarField(left), Boundary::ZeroGradient]]);
        flow.set_drag([(0..n).map(|i| if i >= n / 2 && i < 3 * n / 4 { cr } else { 0.0 }).collect()], [vec![]])
            .expect("drag");
        flow.fill(|x| if x[0] < 0.3 { left } else { right });
        flow.run(0.8, 0.25).unwrap();
        flow
    };
    let (free, rigid) = (run(0.0), run(1e12));
    assert!(rigid.steps <= free.steps * 5 / 4, "{} {}", rigid.steps, free.steps);
    let p = rigid.get(n / 2 - 10).pressure;
    assert!((p / 15.0 - 1.0).abs() < 0.03, "reflected {p}");
    let inside = (n / 2 + 2..3 * n / 4).map(|i| rigid.get(i).velocity[0].abs()).fold(0.0, f64::max);
    assert!(inside < 1e-4, "creeps {inside}");
}
