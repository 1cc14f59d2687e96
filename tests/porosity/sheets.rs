//! Sheets without volume in, on and through solids: what a solid holds of one is no surface, what lies on its wall is that wall, and a face that both block is
//! blocked once. The truth is counted on a lattice.

use super::obstacles::{Cuboid, edges, is_solid, lattice_area, obstacles, triangles};
use glam::DVec3;
use proptest::prelude::*;
use voidage::geometry::bodies::Bodies;
use voidage::grid::Edges;
use voidage::porosity::{Options, Porosity, porosity};
use voidage_tests::random::Random;
use voidage_tests::solids::{Triangle, scene};

/// A rectangle on a lattice: its axis, where it lies along that, and the lowest and highest corner along the two axes that follow.
type Sheet = (usize, u8, [[u8; 2]; 2]);

fn rectangle(&(axis, at, [lo, hi]): &Sheet) -> Vec<Triangle> {
    let corner = |u: u8, v: u8| {
        let mut p = DVec3::ZERO;
        (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (f64::from(at), f64::from(u), f64::from(v));
        p
    };
    let [a, b, c, d] = [corner(lo[0], lo[1]), corner(hi[0], lo[1]), corner(hi[0], hi[1]), corner(lo[0], hi[1])];
    vec![[a, b, c], [a, c, d]]
}

/// Does a sheet hold the square below a cell of the lattice along an axis?
fn holds(&(own, at, [lo, hi]): &Sheet, axis: usize, cell: [i32; 3]) -> bool {
    let [u, v] = [cell[(axis + 1) % 3], cell[(axis + 2) % 3]];
    let within = |x: i32, n: usize| i32::from(lo[n]) <= x && x < i32::from(hi[n]);
    own == axis && i32::from(at) == cell[axis] && within(u, 0) && within(v, 1)
}

/// How many squares of a sheet have no solid on either side.
fn free_squares(boxes: &[Cuboid], sheet: &Sheet) -> f64 {
    let &(axis, at, [lo, hi]) = sheet;
    let mut free = 0.0;
    for (u, v) in (lo[0]..hi[0]).flat_map(|u| (lo[1]..hi[1]).map(move |v| (u, v))) {
        let mut above = [0; 3];
        (above[axis], above[(axis + 1) % 3], above[(axis + 2) % 3]) = (i32::from(at), i32::from(u), i32::from(v));
        let mut below = above;
        below[axis] -= 1;
        free += f64::from(u8::from(!is_solid(boxes, above) && !is_solid(boxes, below)));
    }
    free
}

fn boxes_of(corners: &[([u8; 3], [u8; 3])]) -> Vec<Cuboid> {
    corners.iter().map(|(lo, size)| [*lo, [0, 1, 2].map(|a| lo[a] + size[a])]).collect()
}

fn run(edges: &Edges, bodies: &Bodies) -> Porosity {
    porosity(&edges.grid(None).expect("a grid"), bodies, Options::default())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    /// On grids beside the planes of the lattice, on all of them and on every second.
    #[test]
    fn what_solids_hold_of_a_sheet_does_not_count(
        corners in prop::collection::vec((prop::array::uniform3(0_u8..5), prop::array::uniform3(1_u8..4)), 1..6),
        axis in 0_usize..3,
        at in 0_u8..9,
        (lo, size) in (prop::array::uniform2(0_u8..6), prop::array::uniform2(1_u8..4)),
        cells in 1_usize..8,
    ) {
        let (boxes, sheet): (_, Sheet) = (boxes_of(&corners), (axis, at, [lo, [lo[0] + size[0], lo[1] + size[1]]]));
        let bodies = scene(&boxes.iter().map(triangles).chain([rectangle(&sheet)]).collect::<Vec<_>>());
        prop_assert!(bodies.bodies.last().is_some_and(|body| body.sheet));
        let (solids, free) = (lattice_area(&boxes), free_squares(&boxes, &sheet));
        let truth = [0, 1, 2].map(|n| solids[n] + if n == axis { 2.0 * free } else { 0.0 });
        let wetted: f64 = truth.iter().sum();
        for edges in [edges(cells, -0.637, 9.811), edges(10, -1.0, 9.0), edges(5, -1.0, 9.0)] {
            let found = obstacles(&edges, &bodies).totals;
            prop_assert!((found.wetted_area - wetted).abs() <= 1e-11 * wetted, "{found:?} {wetted}");
            prop_assert_eq!(found.unproved, 0);
        }
        let beside = obstacles(&edges(cells, -0.637, 9.811), &bodies).totals.frontal_area;
        for n in 0..3 {
            prop_assert!((beside[n] - truth[n] / 2.0).abs() <= 1e-11 * wetted, "{beside:?} {truth:?}");
        }
        // Faces of two by two squares, each blocked by a solid on either side or by the sheet.
        let coarse = edges(5, -1.0, 9.0);
        let (found, grid) = (run(&coarse, &bodies), coarse.grid(None).expect("a grid"));
        prop_assert!(found.max_gap < 1e-13, "{}", found.max_gap);
        for (n, face) in (0..3).flat_map(|n| (0..5 * 5 * 5).map(move |c| (n, [c % 5, c / 5 % 5, c / 25]))) {
            let mut blocked = 0.0;
            for (u, v) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                let mut above = face.map(|i| 2 * i as i32 - 1);
                (above[(n + 1) % 3], above[(n + 2) % 3]) = (above[(n + 1) % 3] + u, above[(n + 2) % 3] + v);
                let mut below = above;
                below[n] -= 1;
                let is_blocked = is_solid(&boxes, above) || is_solid(&boxes, below) || holds(&sheet, n, above);
                blocked += f64::from(u8::from(is_blocked));
            }
            let open = found.beta.faces(n)[grid.face_index(n, face)];
            prop_assert!((open - (1.0 - blocked / 4.0)).abs() < 1e-13, "{n} {face:?} {open} {blocked} {boxes:?} {sheet:?}");
        }
    }

    /// The same turned anyhow, where corners are rounded, and far off.
    #[test]
    fn a_turn_changes_nothing_of_that(
        corners in prop::collection::vec((prop::array::uniform3(0_u8..5), prop::array::uniform3(1_u8..4)), 1..5),
        (axis, at) in (0_usize..3, 0_u8..9),
        (lo, size) in (prop::array::uniform2(0_u8..6), prop::array::uniform2(1_u8..4)),
        seed in any::<u64>(),
        (cells, far) in (1_usize..12, any::<bool>()),
    ) {
        let (boxes, sheet): (_, Sheet) = (boxes_of(&corners), (axis, at, [lo, [lo[0] + size[0], lo[1] + size[1]]]));
        let (turn, offset) = (Random::new(seed).turn(), DVec3::splat(if far { 512.0 } else { 0.0 }));
        let place = |t: Triangle| t.map(|p| offset + turn * (p - DVec3::splat(4.0)));
        let parts = boxes.iter().map(triangles).chain([rectangle(&sheet)]);
        let bodies = scene(&parts.map(|part| part.into_iter().map(place).collect()).collect::<Vec<_>>());
        let (mut area, free) = (lattice_area(&boxes), free_squares(&boxes, &sheet));
        area[axis] += 2.0 * free;
        let found = obstacles(&edges(cells, offset.x - 9.3, offset.x + 9.1), &bodies).totals;
        let near = |found: f64, truth: f64| (found - truth).abs() <= if far { 1e-9 } else { 1e-11 } * area.iter().sum::<f64>();
        prop_assert!(near(found.wetted_area, area.iter().sum()), "{found:?} {area:?} {boxes:?} {sheet:?}");
        for n in 0..3 {
            let seen: f64 = (0..3).map(|normal| area[normal] * turn.col(normal)[n].abs()).sum();
            prop_assert!(near(found.frontal_area[n], seen / 2.0), "{n}: {found:?} {seen} {boxes:?} {sheet:?}");
        }
        prop_assert_eq!(found.unproved, 0);
    }
}
