//! Solids by formula, one at a time, against quadrature and against what must hold whatever the numbers.

use glam::{DVec3, Vec3};
use proptest::prelude::*;
use std::collections::HashMap;
use std::f64::consts::{FRAC_PI_2, PI};
use voidage_core::grid::Grid;
use voidage_core::grid::cell_range::RangeKind;
use voidage_core::solids::quadric::{FaceBetween, FacesBetween, QuadricSolid, excess};
use voidage_tests::effort::cases;
use voidage_tests::quadrature::with_chords;
use voidage_tests::quadric::{
    FAMILIES, Family, Kind, edges, errors, is_within_grid, never_panics, parts_sum_to_the_whole, shares, solid_of,
    volume,
};
use voidage_tests::random::Random;

/// Largest error of a cell or face, in cells and faces.
fn allowed(family: Family) -> f64 {
    if family == Family::Huge { 1e-11 } else { 1e-12 }
}

fn agrees(family: Family, seed: u64) -> Result<(), TestCaseError> {
    agrees_of(family, Kind::Any, seed)
}

fn agrees_of(family: Family, kinds: Kind, seed: u64) -> Result<(), TestCaseError> {
    let most = if family == Family::Huge { 200_000_000 } else { 10_000_000 };
    let found = with_chords(most, || errors(&mut Random::new(seed), family, kinds, 1));
    prop_assume!(found.is_some(), "quadrature needs too many chords");
    let (cell, face, place) = found.expect("assumed");
    prop_assert!(cell <= allowed(family) && face <= allowed(family), "cells {cell:e}, faces {face:e}: {place}");
    Ok(())
}

macro_rules! families {
    ($cases:literal, $($name:ident: $family:ident),*) => {
        proptest! {
            #![proptest_config(ProptestConfig { cases: $cases, failure_persistence: None, max_shrink_iters: 4, ..ProptestConfig::default() })]
            $(#[test]
            fn $name(seed in any::<u64>()) {
                agrees(Family::$family, seed)?;
            })*
        }
    };
}
families!(
    2,
    aligned: Aligned,
    nearly_aligned: NearlyAligned,
    oblique: Oblique,
    tangent: Tangent,
    flush: Flush,
    tiny: Tiny,
    inside_one_cell: Inside,
    cutting_the_domain: Cutting
);
proptest! {
    #![proptest_config(ProptestConfig { cases: 4, failure_persistence: None, max_shrink_iters: 4, ..ProptestConfig::default() })]
    #[test]
    fn truncated_cones(seed in any::<u64>(), family in 0..FAMILIES.len() - 1) {
        agrees_of(FAMILIES[family], Kind::Frustum, seed)?;
    }
}

/// A line of the grid along a line of the cone meets the cone once, or its other nappe alone.
#[test]
fn cones_with_a_line_along_an_axis() {
    let mut within = 0;
    for seed in 0..cases(2000) as u64 {
        let (solid, exact) = solid_of(&mut Random::new(seed), Family::Oblique, Kind::Leaning);
        if !is_within_grid(&exact) {
            continue;
        }
        within += 1;
        let edges = edges();
        let grid = Grid::new(&edges[0], &edges[1], &edges[2]).unwrap();
        let found = shares(&solid, &grid);
        let cells = edges.iter().fold(1.0, |product, e| product * e[1]);
        let sum: f64 = found.fields[0].iter().sum::<f64>() * cells;
        assert!((sum / volume(&exact) - 1.0).abs() < 1e-11, "{seed}: {exact:?}: {sum} {}", volume(&exact));
        assert!(found.worst < 1e-9, "{seed}: {exact:?}: {}", found.worst);
    }
    assert!(within * 5 > cases(2000), "{within}");
    let compared = (0..cases(24) as u64).filter(|&seed| match agrees_of(Family::Oblique, Kind::Leaning, seed) {
        Err(TestCaseError::Reject(_)) => false,
        found => {
            found.unwrap();
            true
        }
    });
    assert!(compared.count() * 3 > cases(24));
}

/// Cones that lie on a plane of the grid have nothing below it and block nothing in it.
#[test]
fn cones_that_lie_on_a_plane() {
    let mut random = Random::new(5);
    for _ in 0..4000 {
        let half: f64 = random.between(0.1, 1.4);
        let around = [0.0, FRAC_PI_2, random.between(0.0, 6.2)][random.below(3)];
        let axis = DVec3::new(half.cos() * around.cos(), half.cos() * around.sin(), half.sin());
        let apex = random.vector::<DVec3>(4.0).round() * 0.25;
        let length = 0.25 * (1 + random.below(4)) as f64;
        let end = [0.0, 0.5][random.below(2)];
        let radius = length * half.tan();
        let (base, top) = (apex + axis * length, apex + axis * (length * end));
        let cone = QuadricSolid::truncated_cone(base, top, [radius, radius * end]).unwrap();
        let beside = |place: f64| [-1.0, 0.0, 1.0].map(|step| (place * 4.0).round() * 0.25 + step);
        let (x, y) = (beside(apex.x + 0.5 * axis.x), beside(apex.y + 0.5 * axis.y));
        let z = [apex.z - 1.0, apex.z, apex.z + 1.0];
        let grid = Grid::new(&x, &y, &z).unwrap();
        let (mut below, mut blocked, mut worst) = (0.0_f64, 0.0_f64, 0.0_f64);
        for k in 0..2 {
            let told = cone.layer(&grid, k, true, &mut |kind, _, share| match kind {
                RangeKind::Cells if k == 0 => below = below.max(share),
                RangeKind::Faces(2) if k == 1 => blocked = blocked.max(share),
                _ => {}
            });
            worst = worst.max(told);
        }
        assert!(
            worst < 1e-9 && below < 1e-12 && blocked < 1e-5,
            "{half} {around} {apex} {length} {end}: {below} {blocked} {worst}"
        );
    }
}

// Its quadrature takes up to ten seconds.
families!(1, huge: Huge);

#[test]
fn parts_sum_and_nothing_panics() {
    let mut solids = 0;
    for seed in 0..12_000 {
        solids += usize::from(never_panics::<DVec3>(seed)) + usize::from(never_panics::<Vec3>(seed));
        if seed < 4_000 {
            parts_sum_to_the_whole(seed);
        }
    }
    assert!(solids > 8_000, "{solids} solids");
}

#[test]
fn the_scalar_of_the_grid_does_not_matter() {
    let single: Vec<f32> = (0..=8).map(|i| i as f32 * 0.3).collect();
    let double: Vec<f64> = single.iter().map(|&x| f64::from(x)).collect();
    let solid = QuadricSolid::capsule(DVec3::new(0.4, 0.5, 0.6), DVec3::new(1.9, 1.4, 1.6), 0.3).expect("a capsule");
    let mut told = [Vec::new(), Vec::new()];
    let (one, other) = (Grid::new(&single, &single, &single), Grid::new(&double, &double, &double));
    for k in 0..8 {
        solid.layer(one.as_ref().expect("a grid"), k, true, &mut |kind, at, s| told[0].push((kind, at, s)));
        solid.layer(other.as_ref().expect("a grid"), k, true, &mut |kind, at, s| told[1].push((kind, at, s)));
    }
    assert!(told[0].len() > 100 && told[0] == told[1]);
}

/// The disc where cylinder and half ball meet counts once.
#[test]
fn the_junctions_of_a_capsule_in_grid_planes_count_once() {
    let list = [0.0, 1.0, 2.0, 3.0];
    let grid = Grid::new(&list, &list, &list).expect("a grid");
    let solid = QuadricSolid::capsule(DVec3::new(1.5, 1.5, 1.0), DVec3::new(1.5, 1.5, 2.0), 0.4).expect("a capsule");
    let found = shares(&solid, &grid);
    let disc = std::f64::consts::PI * 0.16;
    for k in [1, 2] {
        assert!((found.fields[3][k * 9 + 4] - disc).abs() < 1e-15, "{k}");
    }
}

/// A capsule of 5000 cells whose surface all but lies in a face: arithmetic of 50 digits gives 0.316992130062978.
#[test]
fn a_huge_capsule_that_cuts_a_face_flat() {
    agrees(Family::Huge, 5_126_940_677_642_304_581).expect("right areas");
    let (from, to) = (
        DVec3::new(-2347.2730663278453, -666.8610491091372, -2509.2619327847615),
        DVec3::new(1427.8518817778252, 3179.4110785190983, 332.8638661565394),
    );
    let solid = QuadricSolid::capsule(from, to, 1724.6878574378077).expect("a capsule");
    let edges = voidage_tests::quadric::edges();
    let grid = Grid::new(&edges[0], &edges[1], &edges[2]).expect("a grid");
    let found = shares(&solid, &grid).fields[3][(4 * 8 + 6) * 9 + 5];
    assert!((found - 0.316992130062978).abs() < 1e-11, "{found}");
}

/// Lines through a face near the outermost point of an ellipsoid of 4500 cells: the area was off by 1.5e-10, as a quadrature in 50
/// digits says.
#[test]
fn a_face_near_the_outermost_point_of_a_huge_ellipsoid() {
    agrees(Family::Huge, 11_626_795_322_963_022_375).expect("right areas");
}

/// Cylinder and half ball meet in the grid, which the capsule holds: their shares of each cell and face are 1 together. By the angle that the half ball
/// takes up at its centre, cells were off by as much as 10⁻⁴.
#[test]
fn the_junction_inside_a_huge_capsule_leaves_no_gap() {
    let edges = [0.0, 0.5, 1.0, 1.25, 2.0];
    let grid = Grid::new(&edges, &edges, &edges).expect("a grid");
    for seed in 0..400 {
        let random = &mut Random::new(seed);
        let upright = DVec3::AXES[random.below(3)];
        let along = match seed % 4 {
            0 => upright,
            1 => (upright + random.vector::<DVec3>(1.0) * 10.0_f64.powf(random.between(-15.0, -3.0))).normalize(),
            _ => DVec3::from_array(random.on_sphere()),
        };
        let mut from = random.point(DVec3::ZERO, DVec3::splat(2.0));
        if seed % 3 == 0 {
            from = DVec3::from_array([0, 1, 2].map(|_| edges[random.below(5)]));
        }
        let (radius, long) = (10.0_f64.powf(random.between(1.0, 4.0)), random.between(0.1, 20.0));
        let solid = QuadricSolid::capsule(from, from + along * long, radius).expect("a capsule");
        let found = shares(&solid, &grid);
        let off = found.fields.iter().flatten().map(|share| (share - 1.0).abs()).fold(found.worst, f64::max);
        assert!(off <= 1e-12, "seed {seed}: {off:e}");
    }
}

/// Pipes beside a plane by one radius, but for the last bits: the sliver that the plane cuts off, from the numbers as they are.
#[test]
fn a_plane_that_is_touched_but_for_rounding() {
    // Its x faces at 1.75 reach 5.6e-17 into the pipe.
    agrees(Family::Tangent, 2_815_233_781_385_205_047).expect("right areas");
}

/// A cone whose radii differ by half a unit in the last place, beside a plane by one of them: the quadrature rounded the radius where the plane is.
#[test]
fn a_cone_that_is_all_but_a_cylinder_beside_a_plane() {
    agrees_of(Family::Tangent, Kind::Frustum, 6_540_968_884_064_701_195).expect("right areas");
}

/// Pipes and cones with tiny tapers whose axes lie in planes that they touch but for rounding, askew to the other axes: slivers of faces, their shares
/// from arithmetic of 60 digits.
#[test]
fn slivers_askew_in_a_plane() {
    // Both ends, both radii, the plane's axis, the face, and its share.
    type Case = ([f64; 6], [f64; 2], usize, [usize; 3], f64);
    let cases: [Case; 5] = [
        (
            [
                0.24999784201269182,
                0.7995190349337498,
                1.179360032154269,
                0.24999784201269182,
                0.7711253487288591,
                1.0675446441523109,
            ],
            [2.157987308182946e-06, 2.157987308182946e-06],
            0,
            [1, 3, 3],
            5.844_252_114_875_665e-12,
        ),
        (
            [
                1.3127158895065336,
                1.2451677547835993,
                2.321722606656758,
                1.3127158895065336,
                1.3127513988554889,
                1.7756046650865844,
            ],
            [0.0627158895065337, 0.06271588950653371],
            0,
            [5, 6, 5],
            2.332_723_563_683_24e-8,
        ),
        (
            [
                5.698176693395388,
                68.58698672788375,
                10.039343420819122,
                -2.983743130581632,
                68.58698672788375,
                -8.66021388634103,
            ],
            [67.98698672788376, 67.98698672788375],
            1,
            [6, 3, 4],
            0.0,
        ),
        (
            [
                0.5253723347851151,
                0.9728520226706516,
                -477.3912388406138,
                -3.2156499900564706,
                6.106310995558533,
                -477.3912388406138,
            ],
            [477.7245721739472, 477.72457217394714],
            2,
            [0, 6, 1],
            1.379_038_261_908_784_2e-5,
        ),
        (
            [
                3.2424698002098067,
                -3.4907786206094324,
                3.995593064808767,
                -2.5982306461407223,
                4.206949863185182,
                3.995593064808767,
            ],
            [1.6622597314754337, 1.6622597314754342],
            2,
            [0, 2, 7],
            2.046_903_925_411_467e-7,
        ),
    ];
    let edges = voidage_tests::quadric::edges();
    let grid = Grid::new(&edges[0], &edges[1], &edges[2]).expect("a grid");
    for (ends, radii, n, [i, j, k], truth) in cases {
        let solid = cone_of(ends, radii);
        let [nx, ny, _] = grid.face_shape(n);
        let found = shares(&solid, &grid).fields[n + 1][(k * ny + j) * nx + i];
        assert!((found - truth).abs() < 1e-12, "{ends:?} {radii:?}: {found:e}, not {truth:e}");
    }
}

fn cone_of([a, b, c, d, e, f]: [f64; 6], radii: [f64; 2]) -> QuadricSolid {
    QuadricSolid::truncated_cone(DVec3::new(a, b, c), DVec3::new(d, e, f), radii).expect("a cone")
}

/// Cones that touch a plane along a line, but for rounding, which may make of it an ellipse of any size: no share leaves 0 to 1.
#[test]
fn cones_along_a_line_of_a_plane() {
    let edges = voidage_tests::quadric::edges();
    let grid = Grid::new(&edges[0], &edges[1], &edges[2]).expect("a grid");
    let random = &mut Random::new(15);
    let mut touching = 0;
    for round in 0..4000 {
        let n = random.below(3);
        let size = 0.25 * 10_f64.powf(random.between(-4.0, 2.0));
        let radii = [size * random.between(0.3, 1.0), size * random.between(0.3, 1.0)];
        let length = size.clamp(0.05, 10.0) * random.between(0.5, 3.0);
        let tan = (radii[1] - radii[0]) / length;
        let cos = 1.0 / (1.0 + tan * tan).sqrt();
        let turn = random.between(0.0, std::f64::consts::TAU);
        let side = if random.below(2) == 0 { 1.0 } else { -1.0 };
        let (u, v) = ((n + 1) % 3, (n + 2) % 3);
        let mut axis = DVec3::AXES[n] * (side * tan * cos);
        (axis[u], axis[v]) = (turn.cos() * cos, turn.sin() * cos);
        let mut from = random.point(DVec3::splat(0.3), DVec3::splat(1.3));
        from[n] = edges[n][1 + random.below(4)] + side * radii[0] * cos;
        let solid = QuadricSolid::truncated_cone(from, from + axis * length, radii).expect("a cone");
        let found = shares(&solid, &grid);
        assert!(found.worst < 1e-11, "{round}: {from} {axis} {length} {radii:?}: beyond by {:e}", found.worst);
        touching += usize::from(found.fields[n + 1].iter().any(|&s| s > 0.0 && s < 1e-3));
    }
    assert!(touching > 1000, "{touching} cones touch a plane");
}

/// A pipe along x but for two units in the last place: a plane along it meets it in a rectangle.
#[test]
fn a_pipe_aligned_but_for_rounding() {
    let [from, to] = [1.259_029_430_475_024_7, 1.600_212_832_502_424];
    let [y, z, radius] = [0.338_102_746_910_566_47, 0.824_602_460_730_262_8, 0.077_162_059_956_558_4];
    let edges = [4.0, 5.0, 3.0].map(|n| (0..9).map(|i| f64::from(i) / n).collect::<Vec<_>>());
    let grid = Grid::new(&edges[0], &edges[1], &edges[2]).expect("a grid");
    let almost = DVec3::new(to, y, z - 2.0 * f64::EPSILON / 2.0);
    for to in [DVec3::new(to, y, z), almost] {
        let solid = QuadricSolid::cylinder(DVec3::new(from, y, z), to, radius).expect("a cylinder");
        let found = shares(&solid, &grid);
        let half = (radius * radius - (0.4 - y) * (0.4 - y)).sqrt();
        let truth = (1.5 - from) * 2.0 * half / (0.25 / 3.0);
        let [nx, ny, _] = grid.face_shape(1);
        let share = found.fields[2][(2 * ny + 2) * nx + 5];
        assert!((share - truth).abs() < 1e-14, "{share} instead of {truth}");
    }
}

/// A pipe that ends in a plane of the grid blocks it, and closes nothing beyond.
#[test]
fn a_flat_end_in_a_plane_blocks_it() {
    let list = [0.0, 1.0, 2.0, 3.0];
    let grid = Grid::new(&list, &list, &list).expect("a grid");
    let solid = QuadricSolid::cylinder(DVec3::new(1.5, 1.5, 1.0), DVec3::new(1.5, 1.5, 2.0), 0.5).expect("a cylinder");
    let found = shares(&solid, &grid);
    let disc = std::f64::consts::PI * 0.25;
    let cells: Vec<usize> = (0..27).filter(|&n| found.fields[0][n] > 0.0).collect();
    assert_eq!(cells, [13]);
    assert!((found.fields[0][13] - disc).abs() < 1e-15);
    let faces: Vec<usize> = (0..36).filter(|&n| found.fields[3][n] > 0.0).collect();
    assert_eq!(faces, [13, 22]);
    // It touches the planes at its sides only.
    assert!(found.fields[1].iter().chain(&found.fields[2]).all(|&s| s == 0.0));
}

/// Solids about the origin, with their volumes.
fn about_the_origin(rng: &mut Random, kind: usize) -> (QuadricSolid, f64) {
    let mut number = |lo: f64, hi: f64| lo + (hi - lo) * rng.unit();
    let dir = DVec3::new(number(-1.0, 1.0), number(-1.0, 1.0), number(-1.0, 1.0)) * 0.2;
    let (radius, length) = (number(0.05, 0.2), dir.length());
    let ball = 4.0 / 3.0 * PI * radius.powi(3);
    let disc = PI * radius * radius;
    let (solid, volume) = match kind {
        0 => (QuadricSolid::ball(DVec3::ZERO, radius), ball),
        1 => (QuadricSolid::capsule(DVec3::ZERO, dir, radius), ball + disc * length),
        2 => (QuadricSolid::cylinder(DVec3::ZERO, dir, radius), disc * length),
        3 => (QuadricSolid::cone(dir, DVec3::ZERO, radius), disc * length / 3.0),
        _ => {
            let a = dir.normalize();
            let (b, c) = a.any_orthonormal_pair();
            let [s, t] = [number(0.05, 0.2), number(0.05, 0.2)];
            (QuadricSolid::ellipsoid(DVec3::ZERO, [a * radius, b * s, c * t]), 4.0 / 3.0 * PI * radius * s * t)
        }
    };
    (solid.expect("sizes that serve"), volume)
}

/// Shares of all cells of a grid.
fn shares_of_cells(solid: &QuadricSolid, edges: [&[f64]; 3]) -> Vec<f64> {
    let grid = Grid::new(edges[0], edges[1], edges[2]).expect("a grid");
    let [nx, ny, nz] = grid.cells();
    let mut all = vec![0.0; nx * ny * nz];
    for k in 0..nz {
        let mut visit = |kind: RangeKind, at: usize, share: f64| {
            if kind == RangeKind::Cells {
                all[k * nx * ny + at] += share;
            }
        };
        assert!(solid.layer(&grid, k, false, &mut visit) < 1e-9, "a share beyond 0 to 1");
    }
    all
}

/// Planes through the centre of a ball, an ellipsoid, the end of a capsule or a cylinder, the apex of a cone, and planes as close to it as
/// rounding brings them or a little farther: the volume is right, and no cell's share leaps.
#[test]
fn planes_through_and_beside_a_centre() {
    let mut rng = Random::new(5);
    for round in 0..4000 {
        let (solid, volume) = about_the_origin(&mut rng, round % 5);
        let width = 0.1 + 0.3 * rng.unit();
        let even: Vec<f64> = (-5..=5).map(|i| f64::from(i) * width).collect();
        let through = shares_of_cells(&solid, [&even, &even, &even]);
        let total: f64 = through.iter().sum::<f64>() * width.powi(3);
        assert!((total / volume - 1.0).abs() < 1e-11, "{round}: {total}, not {volume}");
        let off = 10f64.powf(-9.0 - 9.0 * rng.unit());
        let beside = [0, 1, 2].map(|_| {
            let mut edges = even.clone();
            edges[5] = off * [0.0, 1.0, -1.0, 0.3, -0.7][rng.below(5)];
            edges
        });
        let found = shares_of_cells(&solid, beside.each_ref().map(|e| &e[..]));
        for (cell, (a, b)) in through.iter().zip(&found).enumerate() {
            assert!((a - b).abs() < 1e-11 + 4.0 * off / width, "{round}: cell {cell} {a} through, {b} {off:e} beside");
        }
    }
}

/// Long thin cones, whole and truncated, in many cells: arcs of less than half an ellipse whose shadow on the cone's circle is more than half of it.
#[test]
fn long_thin_cones_have_their_volume() {
    let random = &mut Random::new(711);
    let even: Vec<f64> = (0..=40).map(|i| f64::from(i) * 0.67).collect();
    for round in 0..400 {
        let along = random.vector::<DVec3>(1.0).normalize() * 7.0;
        let center = random.point(DVec3::splat(13.0), DVec3::splat(14.0));
        let radius = 14.0 * 10_f64.powf(random.between(-2.5, -1.0));
        let taper = if round % 2 == 0 { 0.0 } else { random.between(0.0, 1.0) };
        let cone =
            QuadricSolid::truncated_cone(center - along, center + along, [radius, radius * taper]).expect("a cone");
        let found: f64 = shares_of_cells(&cone, [&even, &even, &even]).iter().sum();
        let volume = PI * radius * radius * (1.0 + taper + taper * taper) * 14.0 / 3.0 / 0.67_f64.powi(3);
        assert!((found - volume).abs() < 1e-11 * (1.0 + volume), "{round}: {found} cells, not {volume}");
    }
}

/// A solid that a pipe may meet, in or near the unit cell.
fn beside_a_pipe(random: &mut Random, along: DVec3) -> QuadricSolid {
    let (center, half) = (random.point(DVec3::splat(-0.5), DVec3::splat(1.5)), random.vector::<DVec3>(1.0));
    let half = if random.below(3) == 0 { along.any_orthonormal_vector() } else { half };
    let radius = random.between(0.05, 1.2);
    let solid = match random.below(3) {
        0 => QuadricSolid::ball(center, radius),
        1 => QuadricSolid::cylinder(center - half * 2.0, center + half * 2.0, radius),
        _ => QuadricSolid::capsule(center - half, center + half, radius),
    };
    solid.expect("a solid")
}

/// What a pipe along an axis but for rounding has in common with others is what it would have along the axis: rows of a slice along it pass it by up
/// to 10¹⁶ lengths, and what tangents to such lengths tell was believed to the last digit.
#[test]
fn a_pipe_along_rows_but_for_rounding() {
    let random = &mut Random::new(712);
    let mut met = 0;
    for round in 0..800 {
        let (n, tilt) = (random.below(3), 10_f64.powf(random.between(-16.5, -11.5)));
        let [along, aside, upward] = [n, (n + 1) % 3, (n + 2) % 3].map(|axis| DVec3::AXES[axis]);
        let tilt = tilt * (aside * random.between(-1.0, 1.0) + upward * if random.below(2) == 0 { 1.0 } else { 0.1 });
        let (center, radius) = (random.point(DVec3::splat(-0.3), DVec3::splat(1.3)), random.between(0.05, 1.2));
        let half = random.between(1.0, 3.0);
        let pipe = |along: DVec3| {
            QuadricSolid::cylinder(center - along * half, center + along * half, radius).expect("a pipe")
        };
        let (straight, tilted, other) = (pipe(along), pipe(along + tilt), beside_a_pipe(random, along));
        for flat in 0..4 {
            let mut place = [[0.0, 1.0]; 3];
            place.iter_mut().skip(flat).take(1).for_each(|sides| *sides = [0.5, 0.5]);
            let close = if flat < 3 { 1e-13 } else { 1e-4 };
            let [one, two] = [&straight, &tilted].map(|pipe| excess([pipe, &other], place, close).expect("two solids"));
            let apart = (one[0] - two[1]).max(two[0] - one[1]);
            assert!(apart < 1e-10, "{round}, flat along {flat}: {one:?} along the axis, {two:?} tilted by {tilt}");
            met += u32::from(one[0] > 0.01);
        }
    }
    assert!(met > 500, "{met} places in which two meet");
}

/// Faces that one layer has left for the next one.
#[derive(Default)]
struct Kept {
    below: HashMap<(usize, usize), FaceBetween>,
    above: HashMap<(usize, usize), FaceBetween>,
    used: usize,
}

impl FacesBetween for Kept {
    fn below(&mut self, part: usize, at: usize) -> Option<FaceBetween> {
        let found = self.below.get(&(part, at)).copied();
        self.used += usize::from(found.is_some());
        found
    }

    fn above(&mut self, part: usize, at: usize, face: FaceBetween) {
        self.above.insert((part, at), face);
    }
}

/// What a layer leaves to the next one is what that would compute itself, to the last bit.
#[test]
fn faces_between_layers_are_the_same_from_both_sides() {
    let random = &mut Random::new(21);
    let edges = voidage_tests::quadric::edges();
    let grid = Grid::new(&edges[0], &edges[1], &edges[2]).expect("a grid");
    let mut used = 0;
    for case in 0..600 {
        let family = FAMILIES[case % FAMILIES.len()];
        let (solid, exact) = voidage_tests::quadric::solid(random, family);
        let mut kept = Kept::default();
        for k in 0..grid.cells()[2] {
            kept.below = std::mem::take(&mut kept.above);
            let (mut alone, mut after) = (Vec::new(), Vec::new());
            let worst = solid.layer(&grid, k, true, &mut |kind, at, share| alone.push((kind, at, share.to_bits())));
            let same = solid.layer_between(&grid, k, true, &mut kept, &mut |kind, at, share| {
                after.push((kind, at, share.to_bits()));
            });
            assert!(alone == after && worst.to_bits() == same.to_bits(), "case {case}, layer {k} of {exact:?}");
        }
        used += kept.used;
    }
    assert!(used > 1000, "{used} faces were left");
}
