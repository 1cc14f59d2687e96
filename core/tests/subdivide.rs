//! Ranges of cells, the stack of them, clipped polygons: capacities at their extremes, and what callers may get wrong.

use core::error::Error;

use glam::{DVec3, Vec3};
use voidage_core::convex::chord::Chords;
use voidage_core::convex::shape::{Capsule, Cone, Cylinder, Ellipsoid, Sphere};
use voidage_core::grid::Grid;
use voidage_core::grid::cell_range::{CellRange, RangeKind};
use voidage_core::number::aabb::Aabb;
use voidage_core::number::real::{Real, Vector};
use voidage_core::subdivide::{
    Bounds, Candidate, LeafRule, MAX_RANGES, QueryCount, RangeStack, SubdivisionMemory, SubdivisionRule,
    TooLittleMemory, share, subdivide,
};
use voidage_core::surface::clip::{MAX_CORNERS, Polygon, crossing, keep};

/// Numbers that repeat from run to run (xorshift).
fn next(state: &mut u64) -> u64 {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    *state
}

#[test]
fn the_stack_of_ranges_is_filled_and_never_exceeded() {
    let whole = CellRange { lo: [0; 3], hi: [u32::MAX; 3] };
    let mut stack = RangeStack::new(whole, ());
    let mut most = 1;
    // Straight down to the first cell.
    while let Some((range, ())) = stack.pop() {
        if !stack.push_halves(range, ()) {
            assert_eq!(range, CellRange { lo: [0; 3], hi: [1; 3] });
            break;
        }
        most = most.max(stack.len());
    }
    assert_eq!(most, MAX_RANGES, "32 halvings of three sides of 2³² − 1");
    // Pushing halves of part of what is popped never takes more.
    let mut state = 5;
    for _ in 0..200 {
        let hi = [0; 3].map(|_: u32| (next(&mut state) >> 32 >> (next(&mut state) % 32)) as u32 | 1);
        let mut stack = RangeStack::new(CellRange { lo: [0; 3], hi }, ());
        for _ in 0..1000 {
            let Some((range, ())) = stack.pop() else { break };
            if !next(&mut state).is_multiple_of(3) {
                stack.push_halves(range, ());
            }
            assert!(stack.len() <= MAX_RANGES);
        }
    }
}

#[test]
fn halves_make_up_their_range_and_end_in_single_cells() {
    let whole = CellRange { lo: [2, 0, 5], hi: [9, 3, 6] };
    let mut seen = [[[0; 10]; 10]; 10];
    let mut stack = RangeStack::new(whole, ());
    while let Some((range, ())) = stack.pop() {
        if !stack.push_halves(range, ()) {
            let [i, j, k] = range.lo.map(|n| n as usize);
            assert_eq!(range.hi, range.lo.map(|n| n + 1));
            seen[k][j][i] += 1;
        }
    }
    assert!(stack.is_empty());
    for (k, j, i) in (0..1000).map(|n| (n / 100, n / 10 % 10, n % 10)) {
        let inside = (2..9).contains(&i) && j < 3 && k == 5;
        assert_eq!(seen[k][j][i], i32::from(inside), "{i} {j} {k}");
    }
}

#[test]
fn empty_and_foreign_ranges_are_not_halved() {
    let (whole, empty) = (CellRange { lo: [0; 3], hi: [8; 3] }, CellRange { lo: [0, 5, 0], hi: [8, 2, 8] });
    let mut stack = RangeStack::new(whole, ());
    assert!(!stack.push_halves(empty, ()), "a range whose end lies below its beginning");
    while stack.push_halves(whole, ()) {}
    assert_eq!(stack.len(), MAX_RANGES, "two at a time, until there is no place for two");
    let edges = [0.0, 1.0];
    let grid = Grid::new(&edges, &edges, &edges).expect("a grid");
    let _ = (grid.cell_index([usize::MAX; 3]), grid.face_index(1, [usize::MAX; 3]));
}

#[test]
fn ranges_around_boxes_are_cut_to_the_grid() {
    let edges = [0.0, 1.0, 2.0, 3.0];
    let grid = Grid::new(&edges, &edges, &edges).expect("a grid");
    let bounds = Aabb { min: DVec3::new(-5.0, 1.0, 1.5), max: DVec3::new(0.5, 2.0, 9.0) };
    let cells = CellRange::touching(&grid, RangeKind::Cells, &bounds);
    assert_eq!(cells, CellRange { lo: [0, 0, 1], hi: [1, 3, 3] }, "a closed box touches the cells beside its sides");
    let faces = CellRange::touching(&grid, RangeKind::Faces(1), &bounds);
    assert_eq!(faces, CellRange { lo: [0, 1, 1], hi: [1, 3, 3] }, "planes 1 and 2");
    let other = CellRange { lo: [0, 2, 0], hi: [3, 3, 2] };
    assert_eq!(cells.intersection(other), CellRange { lo: [0, 2, 1], hi: [1, 3, 2] });
    assert_eq!(cells.union(other), CellRange { lo: [0; 3], hi: [3; 3] });
    assert!(CellRange { lo: [0, 2, 0], hi: [3, 2, 3] }.is_empty());
    assert_eq!(CellRange::all(&grid, RangeKind::Faces(2)).hi, [3, 3, 4]);
}

fn solid(range: CellRange, kind: RangeKind, rule: SubdivisionRule<f64>) -> Vec<(CellRange, Bounds<f64>)> {
    let edges = [0.0, 0.5, 1.0];
    let grid = Grid::new(&edges, &edges, &edges).expect("a grid");
    let ball = [Sphere { center: DVec3::splat(0.5), radius: 0.4 }];
    let (mut candidates, mut facets) = ([Candidate::default(); 32], [0; 4]);
    let mut memory = SubdivisionMemory { candidates: &mut candidates, facets: &mut facets };
    let mut found = Vec::new();
    subdivide(&grid, kind, range, &ball, rule, &mut memory, |range, share| found.push((range, share))).expect("room");
    found
}

#[test]
fn wrong_calls_are_cut_to_size() {
    let rule = SubdivisionRule { leaf: LeafRule::Plane, depth: 4, tol: 1e-2 };
    let within = CellRange { lo: [0; 3], hi: [2; 3] };
    let all = solid(within, RangeKind::Cells, rule);
    assert_eq!(all.len(), 8);
    // A range beyond the grid, an axis that there is not, a depth beyond any.
    assert_eq!(solid(CellRange { lo: [0; 3], hi: [u32::MAX; 3] }, RangeKind::Cells, rule), all);
    assert_eq!(solid(within, RangeKind::Faces(7), rule), all);
    assert!(solid(CellRange { lo: [5; 3], hi: [9; 3] }, RangeKind::Cells, rule).is_empty());
    let deepest = SubdivisionRule { depth: u32::MAX, tol: 1e-3, ..rule };
    assert_eq!(solid(within, RangeKind::Cells, deepest).len(), 8);
    let truth = 4.0 / 3.0 * core::f64::consts::PI * 0.4_f64.powi(3);
    for (_, share) in all {
        assert!(share.lower <= truth && truth <= share.upper && share.gap() < 1e-2, "{share:?} holds {truth}");
    }
}

#[test]
fn memory_that_is_too_short_is_named() {
    let ball = [Sphere { center: DVec3::ZERO, radius: 1.0 }; 3];
    let rule = SubdivisionRule { leaf: LeafRule::Half, depth: 1, tol: 0.0 };
    let cell = Aabb { min: DVec3::ZERO, max: DVec3::ONE };
    let mut memory = SubdivisionMemory { candidates: &mut [], facets: &mut [] };
    let found = share(&cell, &ball, rule, &mut memory, &mut QueryCount::default());
    assert_eq!(found, Err(TooLittleMemory { candidates: 3, facets: 0 }));
    let error: &dyn Error = &found.expect_err("too short");
    assert!(error.to_string().contains("3 candidates"));
}

#[test]
fn a_triangle_cut_by_a_box_has_nine_corners_at_most() {
    let mut state = 7;
    let mut most = 0;
    let mut number = || (next(&mut state) >> 11) as f64 / (1_u64 << 53) as f64;
    for _ in 0..20_000 {
        let corners = [(); 3].map(|()| [number() * 4.0 - 2.0, number() * 4.0 - 2.0, number() * 4.0 - 2.0]);
        let (mut whole, mut kept) = (Polygon::new(&corners), Polygon::default());
        for axis in 0..3 {
            for (at, above) in [(-0.5, true), (0.5, false)] {
                keep(&whole, axis, at, above, &mut kept);
                core::mem::swap(&mut whole, &mut kept);
            }
        }
        most = most.max(whole.corners().len());
    }
    assert_eq!(most, 9);
}

#[test]
fn a_polygon_takes_as_many_corners_as_it_has_room_for() {
    let ring: Vec<[f64; 3]> = (0..MAX_CORNERS as u32 + 3).map(|n| [f64::from(n), f64::from(n * n), 0.0]).collect();
    let mut polygon = Polygon::new(&ring);
    assert!(polygon.is_full() && polygon.corners() == &ring[..MAX_CORNERS]);
    assert!(!polygon.push([0.0; 3]), "no room");
    let [a, b] = polygon.halves();
    assert!(a.corners().len() < MAX_CORNERS && b.corners().len() < MAX_CORNERS);
    assert_eq!(a.doubled_area()[2] + b.doubled_area()[2], polygon.doubled_area()[2], "small integers are exact");
    polygon.clear();
    assert!(polygon.is_empty() && polygon.push([1.0; 3]));
}

#[test]
fn an_edge_is_crossed_at_the_same_point_from_both_ends() {
    let (a, b) = ([0.1, 0.7, -0.3], [1.3, -0.2, 0.9]);
    assert_eq!(crossing(a, b, 0, 0.9), crossing(b, a, 0, 0.9));
}

/// The share of a box from `low` to `high` along each axis that a body has.
fn share_of<B: Chords>(body: B, low: f64, high: f64) -> [f64; 2] {
    let side = |x: f64| B::Vector::splat(<B::Vector as Vector>::Scalar::from_f64(x));
    let cell = Aabb { min: side(low), max: side(high) };
    let rule = SubdivisionRule { leaf: LeafRule::Plane, depth: 3, tol: Real::from_f64(1e-2) };
    let (mut candidates, mut facets) = ([Candidate::default(); 64], [0; 64]);
    let mut memory = SubdivisionMemory { candidates: &mut candidates, facets: &mut facets };
    let found = share(&cell, &[body], rule, &mut memory, &mut QueryCount::default()).expect("room");
    [found.lower.to_f64(), found.upper.to_f64()]
}

/// Round bodies as large as `size`: deep inside them a box is full, far off it is empty, just outside it is not full; and a box about one of them has
/// its volume.
fn of_any_size<V: Vector>(size: f64) {
    let point = |x: f64, y: f64, z: f64| V::from_array([x, y, z].map(|c| V::Scalar::from_f64(c * size)));
    let r = V::Scalar::from_f64(size);
    let pi = core::f64::consts::PI;
    for away in [0.0, 4.0, -1.0] {
        let at = |x: f64, y: f64, z: f64| point(x + away, y, z);
        // The volume of each, in cubes of side 2.
        let found = |low: f64, high: f64| {
            [
                (share_of(Sphere { center: at(0.0, 0.0, 0.0), radius: r }, low, high), pi / 6.0),
                (
                    share_of(Ellipsoid { center: at(0.0, 0.0, 0.0), semi_axes: point(1.0, 0.5, 1.0) }, low, high),
                    pi / 12.0,
                ),
                (share_of(Cylinder::new(at(0.0, -1.0, 0.0), at(0.0, 1.0, 0.0), r), low, high), pi / 4.0),
                (share_of(Cone::new(at(0.0, -1.0, 0.0), at(0.0, 1.0, 0.0), r), low, high), pi / 12.0),
                (
                    share_of(
                        Capsule { from: at(0.0, -0.5, 0.0), to: at(0.0, 0.5, 0.0), radius: r * V::Scalar::HALF },
                        low,
                        high,
                    ),
                    pi / 4.0 * 0.25 * 0.5 + pi / 6.0 * 0.125,
                ),
            ]
        };
        // Boxes in the middle that are small beside the bodies, whose surfaces they may touch if these lie to one side.
        for (n, ([lower, upper], _)) in found(0.0, size * 1e-9).into_iter().enumerate() {
            match away {
                0.0 => assert!(lower == 1.0, "body {n} of size {size:e} is not full: {lower}..{upper}"),
                4.0 => assert!(upper == 0.0, "body {n} of size {size:e} is elsewhere: {lower}..{upper}"),
                _ => assert!(lower < 1e-2, "body {n} of size {size:e} ends here: {lower}..{upper}"),
            }
        }
        if away == 0.0 {
            for (n, ([lower, upper], truth)) in found(-size, size).into_iter().enumerate() {
                assert!(
                    lower <= truth + 1e-6 && truth - 1e-6 <= upper && upper - lower < 0.2,
                    "body {n} of size {size:e}: {truth} in {lower}..{upper}"
                );
            }
        }
    }
}

/// The lengths of a query may be such that their squares are infinite, or nothing: a cell deep inside a ball of 1e20 counted as open in `f32`.
#[test]
fn balls_whose_squares_overflow_or_underflow_are_balls() {
    for size in [1.0, 1e18, 3e19, 1e25, 1e-18, 1e-22, 1e-25] {
        of_any_size::<Vec3>(size);
    }
    for size in [1.0, 1e153, 1e155, 1e200, 1e-153, 1e-160, 1e-200] {
        of_any_size::<DVec3>(size);
    }
}
