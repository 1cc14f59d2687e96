//! Vents whose opening lies in a side of the domain: a duct full of still gas is opened to a lower pressure through a hole smaller than its section. A rarefaction
//! runs into the duct, and the stream behind it leaves without losses through the hole, where it has the pressure outside, or that of a
//! stream that chokes there. That has one solution, and it is the same from the first moment on.

use voidage::flow::{Flow, Treatment};
use voidage_core::flow::{Boundary, Gas, Patch, Primitive};

const GAMMA: f64 = 1.4;

/// The mass flux out of a duct, per area of the duct, of gas of density 1 and pressure 1 at rest that leaves through an opening against a pressure: speeds in the duct by
/// bisection, what the hole takes of the stream by its energy.
fn escaping(gas: Gas<f64>, open: f64, outside: f64) -> f64 {
    // Density and specific enthalpy at a pressure; constant entropy.
    let isothermal = matches!(gas, Gas::Isothermal { .. });
    let density = |p: f64| if isothermal { p } else { p.powf(1.0 / GAMMA) };
    let enthalpy = |p: f64| if isothermal { p.ln() } else { GAMMA / (GAMMA - 1.0) * p / density(p) };
    let sonic = |p: f64| (if isothermal { 1.0 } else { GAMMA * p / density(p) }).sqrt();
    let through_duct = |p: f64| {
        let speed = if isothermal { -p.ln() } else { 2.0 / (GAMMA - 1.0) * (sonic(1.0) - sonic(p)) };
        [density(p) * speed, 0.5 * speed * speed + enthalpy(p)]
    };
    let through_hole = |total: f64| {
        // At least the pressure of a stream that chokes.
        let excess = |p: f64| 2.0 * (total - enthalpy(p)) - sonic(p).powi(2);
        let (mut low, mut high) = (1e-6, 1.0);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if excess(middle) > 0.0 { low = middle } else { high = middle }
        }
        let p = outside.max(low);
        open * density(p) * (2.0 * (total - enthalpy(p))).max(0.0).sqrt()
    };
    let (mut low, mut high) = (outside, 1.0);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        let [flux, total] = through_duct(middle);
        if flux > through_hole(total) { low = middle } else { high = middle }
    }
    through_duct(low)[0]
}

/// What has left a duct along an axis after some time, per time and area of the duct, over what should have; no wave has come back by then.
fn share<const D: usize>(gas: Gas<f64>, (axis, side): (usize, usize), open: f64, outside: f64) -> f64 {
    const CELLS: usize = 100;
    let mut n = [2; D];
    n[axis] = CELLS;
    let mut sides = [[Boundary::Wall; 2]; D];
    sides[axis][side] = Boundary::Outlet { pressure: outside };
    let mut flow: Flow<f64, D> = Flow::uniform(n, [1.0 / CELLS as f64; D], gas, sides);
    let volume = vec![1.0; flow.len()];
    let mut faces: [Vec<f64>; D] = std::array::from_fn(|d| vec![1.0; flow.len() / n[d] * (n[d] + 1)]);
    for cell in 0..flow.len() {
        let at = flow.coordinates(cell);
        if at[axis] == side * (CELLS - 1) {
            faces[axis][flow.face(axis, at, side)] = open;
        }
    }
    flow.set_porosity(volume, faces, Treatment::default()).unwrap();
    flow.fill(|_| Primitive { density: 1.0, velocity: [0.0; D], pressure: 1.0 });
    let (before, end) = (flow.content().density, 0.5);
    flow.run(0.8, end).unwrap();
    let section = (1.0 / CELLS as f64).powi(D as i32 - 1) * (flow.len() / CELLS) as f64;
    (before - flow.content().density) / (end * section) / escaping(gas, open, outside)
}

#[test]
fn gas_leaves_through_holes_in_a_side_as_fast_as_it_must() {
    let ideal = Gas::Ideal { gamma: GAMMA };
    for gas in [ideal, Gas::Isothermal { sound_speed: 1.0 }] {
        for outside in [0.999, 0.99, 0.85, 0.3] {
            for open in [0.01, 0.1, 0.3, 0.6, 0.85] {
                let found = share::<1>(gas, (0, 1), open, outside);
                assert!((found - 1.0).abs() < 0.005, "{gas:?}, {open} open, {outside} outside: {found} of what leaves");
            }
        }
    }
    for (axis, side) in [(0, 0), (1, 0), (1, 1)] {
        let found = share::<2>(ideal, (axis, side), 0.2, 0.9);
        assert!((found - 1.0).abs() < 0.005, "axis {axis}, side {side}: {found} of what leaves");
    }
    assert!((share::<3>(ideal, (2, 1), 0.2, 0.9) - 1.0).abs() < 0.005);
}

/// A vent that is a patch on a wall: the same hole in the same place.
#[test]
fn a_patch_with_a_hole_is_a_side_with_it() {
    let after = |as_patch: bool| {
        let vent = Boundary::Outlet { pressure: 0.9 };
        let high = if as_patch { Boundary::Wall } else { vent };
        let sides = [[Boundary::Wall, high], [Boundary::Wall; 2]];
        let mut flow: Flow<f64, 2> = Flow::uniform([40, 2], [0.1; 2], Gas::Ideal { gamma: GAMMA }, sides);
        if as_patch {
            flow.patches = vec![Patch { axis: 0, high: true, first: [0; 2], end: [40, 2], boundary: vent }];
        }
        let mut faces = vec![1.0; 82];
        (faces[40], faces[81]) = (0.3, 0.6);
        flow.set_porosity(vec![1.0; 80], [faces, vec![1.0; 120]], Treatment::default()).unwrap();
        flow.fill(|_| Primitive { density: 1.0, velocity: [0.0; 2], pressure: 1.0 });
        flow.run(0.8, 1.0).unwrap();
        flow.state.density.iter().map(|x| x.to_bits()).collect::<Vec<u64>>()
    };
    assert!(after(true) == after(false));
}
