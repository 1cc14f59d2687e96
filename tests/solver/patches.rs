//! Patches on the sides: of the same kind as their side they are not seen, over the whole of it they replace it, in between they let pass what
//! they must.

use voidage::flow::{Flow, Treatment};
use voidage_core::flow::{Boundary, Error, Feed, Gas, Mesh, Patch, Primitive, Problem};
use voidage_tests::euler::property::{Source, porosity};

const IDEAL: Gas<f64> = Gas::Ideal { gamma: 1.4 };

/// Random gas in a random porous space between walls.
fn random<const D: usize>(n: [usize; D], boundaries: [[Boundary<f64, D>; 2]; D]) -> Flow<f64, D> {
    let mut s = Source::seeded(11);
    let mut flow: Flow<f64, D> = Flow::uniform(n, [0.1; D], IDEAL, boundaries);
    flow.gravity = std::array::from_fn(|d| 0.1 * (d + 1) as f64);
    let (volume, faces) = porosity(&mut s, n);
    flow.set_porosity(volume, faces, Treatment::default()).unwrap();
    for cell in 0..flow.len() {
        let velocity = std::array::from_fn(|_| s.unit() - 0.5);
        flow.set(cell, &Primitive { density: 0.5 + s.unit(), velocity, pressure: 0.5 + s.unit() });
    }
    flow
}

fn state<const D: usize>() -> Primitive<f64, D> {
    Primitive { density: 1.3, velocity: [0.2; D], pressure: 1.1 }
}

fn kinds<const D: usize>() -> [Boundary<f64, D>; 6] {
    [
        Boundary::Wall,
        Boundary::ZeroGradient,
        Boundary::FarField(state()),
        Boundary::Inlet(state()),
        Boundary::Outlet { pressure: 0.7 },
        Boundary::Reservoir { density: 1.5, pressure: 1.7 },
    ]
}

/// Bits of the state after some steps.
fn after<const D: usize>(mut flow: Flow<f64, D>) -> Vec<u64> {
    for _ in 0..6 {
        flow.step(2e-3).unwrap();
    }
    let state = flow.state;
    let columns = std::iter::once(&state.density).chain(&state.momentum).chain([&state.energy]);
    columns.flat_map(|c| c.iter().map(|x| x.to_bits())).collect()
}

/// A patch over cells `first..end` of a side.
fn with_patch<const D: usize>(
    n: [usize; D],
    side: (usize, usize),
    [around, there]: [Boundary<f64, D>; 2],
    [first, end]: [[usize; D]; 2],
) -> Vec<u64> {
    let mut sides = [[Boundary::Wall; 2]; D];
    sides[side.0][side.1] = around;
    let mut flow = random(n, sides);
    flow.patches = vec![Patch { axis: side.0, high: side.1 == 1, first, end, boundary: there }];
    after(flow)
}

fn as_the_side<const D: usize>(n: [usize; D]) {
    let part = [n.map(|n| n / 3), n.map(|n| 2 * n / 3)];
    for (d, side) in (0..D).flat_map(|d| [(d, 0), (d, 1)]) {
        for kind in kinds() {
            let mut sides = [[Boundary::Wall; 2]; D];
            sides[d][side] = kind;
            let plain = after(random(n, sides));
            assert!(with_patch(n, (d, side), [kind, kind], part) == plain, "{kind:?} on side {side} of axis {d}");
            let around = Boundary::FarField(Primitive { pressure: 9.0, ..state() });
            assert!(with_patch(n, (d, side), [around, kind], [[0; D], n]) == plain, "{kind:?} over side {side} of {d}");
            let apart = with_patch(n, (d, side), [around, kind], part);
            assert!(apart != plain, "{kind:?}: a part is not the whole");
        }
    }
}

#[test]
fn a_patch_is_a_side_to_the_bit() {
    as_the_side([9, 7]);
    as_the_side([7, 6, 5]);
}

/// A closed box with a hole: what leaves is booked, and what is beside the hole does not leave through the wall.
#[test]
fn a_box_empties_through_its_vent() {
    let n = [20, 12, 12];
    let mut flow: Flow<f64, 3> = Flow::uniform(n, [0.1; 3], IDEAL, [[Boundary::Wall; 2]; 3]);
    flow.fill(|_| Primitive { density: 1.2, velocity: [0.0; 3], pressure: 1.5e5 });
    let vent =
        Patch { axis: 0, high: true, first: [0, 4, 4], end: [0, 8, 8], boundary: Boundary::Outlet { pressure: 1e5 } };
    flow.patches = vec![vent];
    let before = flow.content();
    flow.run(0.8, 4e-3).unwrap();
    let (after, through) = (flow.content(), flow.total.inflow[0][1]);
    assert!(through.density < -0.02 * before.density, "{through:?}");
    for (before, after, through) in
        [(before.density, after.density, through.density), (before.energy, after.energy, through.energy)]
    {
        assert!(((after - before - through) / before).abs() < 1e-13, "{before} {after} {through}");
    }
    for (d, side) in (0..3).flat_map(|d| [(d, 0), (d, 1)]).filter(|&side| side != (0, 1)) {
        assert_eq!(flow.total.inflow[d][side].density, 0.0, "wall {side} of axis {d}");
    }
    // Symmetric about both planes through the middle of the vent, to rounding.
    for cell in 0..flow.len() {
        let [x, y, z] = [cell % 20, cell / 20 % 12, cell / 240];
        let mirrored = (11 - z) * 240 + (11 - y) * 20 + x;
        let (a, b) = (flow.get(cell).pressure, flow.get(mirrored).pressure);
        assert!((a / b - 1.0).abs() < 1e-12, "{x} {y} {z}: {a} {b}");
    }
}

#[test]
fn patches_that_cannot_be_are_refused() {
    let widths = [vec![0.1; 4], vec![0.1; 3]];
    let mesh = Mesh::new([&widths[0][..], &widths[1][..]]).unwrap();
    let wall = [[Boundary::Wall; 2]; 2];
    let good = Patch { axis: 0, high: true, first: [0; 2], end: [9; 2], boundary: Boundary::ZeroGradient };
    let refused =
        |sides, patches: &[Patch<f64, 2>]| Problem::new(mesh, IDEAL, sides).unwrap().with_patches(patches).map(drop);
    assert_eq!(refused(wall, &[good, good]), Ok(()));
    assert_eq!(refused(wall, &[good, Patch { axis: 2, ..good }]), Err(Error::Patch { number: 1 }));
    assert_eq!(refused(wall, &[Patch { boundary: Boundary::Periodic, ..good }]), Err(Error::Patch { number: 0 }));
    let periodic = [[Boundary::Periodic; 2], [Boundary::Wall; 2]];
    assert_eq!(refused(periodic, &[good]), Err(Error::Patch { number: 0 }));
    let line = Problem::new(Mesh::new([&widths[0][..]]).unwrap(), IDEAL, [[Boundary::Wall; 2]]).unwrap();
    let patch = Patch { axis: 0, high: true, first: [0], end: [9], boundary: Boundary::ZeroGradient };
    assert_eq!(line.with_patches(&[patch]).map(drop), Err(Error::Patch { number: 0 }));
    let mixed = Problem::new(mesh, Gas::Mixed { gammas: [1.2, 1.4] }, wall).unwrap();
    let (one, two) = ([good], [good, good]);
    let fed = mixed.with_patches(&one).unwrap().with_feed(Feed { sides: [[1.4; 2]; 2], patches: &[1.3] }).unwrap();
    assert_eq!(fed.with_patches(&two).map(drop), Err(Error::ShapeMismatch { expected: 2, found: 1 }));
}
