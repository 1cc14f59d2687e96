//! Closed faces are walls: the same to the bit as walls of the domain, and slow gas stagnates at the pressure of theory.

use voidage::flow::{Flow, Treatment};
use voidage_core::flow::{Boundary, Gas, Limiter, PressureForm, Primitive, Riemann, Scheme};
use voidage_tests::euler::property::Source;

const IDEAL: Gas<f64> = Gas::Ideal { gamma: 1.4 };

/// Runs random states in a box that ends in a wall of the domain, or whose mesh goes on behind a plane of closed faces, with
/// other gas beyond; returns the bits of the cells in front of the wall. `low` puts the wall on the low side.
fn box_before_a_wall<const D: usize>(axis: usize, low: bool, scheme: Scheme, gravity: f64, by_faces: bool) -> Vec<u64> {
    let mut n: [usize; D] = std::array::from_fn(|d| 6 - d);
    let own = n;
    if by_faces {
        n[axis] *= 2;
    }
    let mut boundaries = [[Boundary::Wall; 2]; D];
    let open = usize::from(low);
    boundaries[axis][open] = Boundary::ZeroGradient;
    let mut flow: Flow<f64, D> = Flow::uniform(n, [0.1; D], IDEAL, boundaries);
    flow.scheme = scheme;
    flow.gravity[axis] = gravity;
    let first = if by_faces && low { own[axis] } else { 0 };
    let faces = std::array::from_fn(|d| {
        let size: [usize; D] = std::array::from_fn(|a| n[a] + usize::from(a == d));
        let stride: usize = size[..axis].iter().product();
        let closed = |f: usize| by_faces && d == axis && f / stride % size[axis] == own[axis];
        (0..size.iter().product()).map(|f| if closed(f) { 0.0 } else { 1.0 }).collect()
    });
    let cells = n.iter().product();
    flow.set_porosity(vec![1.0; cells], faces, Treatment::default()).unwrap();
    let at = |cell: usize| {
        let mut rest = cell;
        n.map(|n| {
            let i = rest % n;
            rest /= n;
            i
        })
    };
    for cell in 0..cells {
        let mut at = at(cell);
        let inside = (first..first + own[axis]).contains(&at[axis]);
        at[axis] -= if inside { first } else { 0 };
        let name = at.iter().fold(0, |s, i| 31 * s + *i as u64) + if inside { 0 } else { 1_000_000 };
        let mut s = Source::seeded(name);
        let velocity = std::array::from_fn(|_| s.unit() - 0.5);
        flow.set(cell, &Primitive { density: s.scale(0.6, 1.5), velocity, pressure: s.scale(0.6, 1.5) });
    }
    for _ in 0..30 {
        flow.step(0.002).unwrap();
    }
    assert_eq!(flow.total.floored, 0, "{D}D axis {axis} low {low} {scheme:?} {by_faces}");
    (0..cells)
        .filter(|&c| (first..first + own[axis]).contains(&at(c)[axis]))
        .flat_map(|c| {
            let w = flow.get(c);
            [w.density, w.pressure].into_iter().chain(w.velocity).map(|x| (x + 0.0).to_bits()).collect::<Vec<_>>()
        })
        .collect()
}

fn same_as_the_domain<const D: usize>() {
    for axis in 0..D {
        for low in [false, true] {
            for (riemann, limiter, pressure, gravity) in [
                (Riemann::Hllc, Limiter::Steep, PressureForm::Geometric, 0.0),
                (Riemann::Hllc, Limiter::MonotonizedCentral, PressureForm::Paper, -0.5),
                (Riemann::Hlle, Limiter::VanLeer, PressureForm::Geometric, 0.3),
                (Riemann::Rusanov, Limiter::FirstOrder, PressureForm::Geometric, 0.0),
            ] {
                let scheme = Scheme { riemann, limiter, pressure };
                let run = |by_faces| box_before_a_wall::<D>(axis, low, scheme, gravity, by_faces);
                assert!(run(false) == run(true), "{D}D axis {axis} low {low} {scheme:?}");
            }
        }
    }
}

#[test]
fn a_closed_face_is_a_wall_of_the_domain_to_the_bit() {
    same_as_the_domain::<1>();
    same_as_the_domain::<2>();
    same_as_the_domain::<3>();
}

/// A plane channel with a square of 8 × 8 cells in its middle, standing across `axis`, at Mach 0.03; returns the pressure before the
/// square over that of the inflow, in units of ½ rho u².
fn stagnation(axis: usize) -> f64 {
    let mut n = [24, 24];
    n[axis] = 48;
    let speed = 0.03 * 1.4f64.sqrt();
    let mut state = Primitive { density: 1.0, velocity: [0.0; 2], pressure: 1.0 };
    state.velocity[axis] = speed;
    let mut boundaries = [[Boundary::Wall; 2]; 2];
    boundaries[axis] = [Boundary::FarField(state); 2];
    let mut flow: Flow<f64, 2> = Flow::uniform(n, [0.125; 2], IDEAL, boundaries);
    let square = |d: usize| if d == axis { 20..28 } else { 8..16 };
    let solid = |at: [usize; 2]| (0..2).all(|d| square(d).contains(&at[d]));
    let volume = (0..n[0] * n[1]).map(|c| if solid([c % n[0], c / n[0]]) { 0.0 } else { 1.0 }).collect();
    let faces = std::array::from_fn(|d| {
        let size: [usize; 2] = std::array::from_fn(|a| n[a] + usize::from(a == d));
        let touches = |at: [usize; 2]| {
            let mut below = at;
            below[d] = at[d].wrapping_sub(1);
            solid(at) || solid(below)
        };
        (0..size[0] * size[1]).map(|f| if touches([f % size[0], f / size[0]]) { 0.0 } else { 1.0 }).collect()
    });
    flow.set_porosity(volume, faces, Treatment::default()).unwrap();
    flow.fill(|_| state);
    let q = 0.5 * speed * speed;
    // Two passes of the length; then the mean over one more, for waves still run up and down.
    let pass = 6.0 / speed;
    let cell = |along: usize, across: usize| if axis == 0 { across * n[0] + along } else { along * n[0] + across };
    let (mut sum, mut time) = (0.0, 0.0);
    while flow.time < 3.0 * pass {
        let dt = flow.advance(0.8, f64::MAX).unwrap();
        if flow.time > 2.0 * pass {
            let inflow = flow.get(cell(1, 12));
            sum += dt * (flow.get(cell(19, 12)).pressure - inflow.pressure) / q;
            time += dt;
        }
    }
    sum / time
}

#[test]
fn slow_gas_stagnates_at_its_dynamic_pressure() {
    for axis in [0, 1] {
        let p = stagnation(axis);
        assert!((p - 1.0).abs() < 0.25, "axis {axis}: {p}");
    }
}
