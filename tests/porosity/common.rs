//! What solids by formula have in common, against quadrature of chords and against closed volumes.

use glam::DVec3;
use proptest::prelude::*;
use std::f64::consts::PI;
use voidage_core::quadric::{QuadricSolid, excess};
use voidage_tests::quadrature::{Exact, common_area, common_volume};
use voidage_tests::random::Random;

/// How two or three solids lie to each other in the unit cube.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Family {
    /// Anyhow.
    Anyhow,
    /// Along axes, ends and centres often in planes of the cube.
    Aligned,
    /// Along axes but for 1e-15 to 1e-3.
    NearlyAligned,
    /// On one axis: nested, end to end, of one radius or two.
    OnOneAxis,
    /// The same solid twice, or all but for rounding.
    Twice,
    /// Touching from outside or from inside, but for rounding.
    Touching,
    /// Pipes of one radius that cross.
    Crossing,
    /// Some thousandths thick.
    Thin,
    /// A thousand times as large as the cube.
    Huge,
}

const FAMILIES: [Family; 9] = [
    Family::Anyhow,
    Family::Aligned,
    Family::NearlyAligned,
    Family::OnOneAxis,
    Family::Twice,
    Family::Touching,
    Family::Crossing,
    Family::Thin,
    Family::Huge,
];

fn quadric(exact: &Exact) -> QuadricSolid {
    match *exact {
        Exact::Ball(center, radius) => QuadricSolid::ball(center, radius),
        Exact::Ellipsoid(center, axes) => QuadricSolid::ellipsoid(center, axes),
        Exact::Cylinder(from, to, radius) => QuadricSolid::cylinder(from, to, radius),
        Exact::Capsule(from, to, radius) => QuadricSolid::capsule(from, to, radius),
        Exact::Cone(base, apex, radius) => QuadricSolid::cone(base, apex, radius),
        Exact::Frustum(from, to, radii) => QuadricSolid::truncated_cone(from, to, radii),
    }
    .expect("a solid of ordinary size")
}

/// A solid of any kind on a segment.
fn on_segment(random: &mut Random, from: DVec3, to: DVec3, radius: f64) -> Exact {
    match random.below(7) {
        0 => Exact::Ball(from, radius),
        1 => {
            let turn = random.turn();
            Exact::Ellipsoid(from, [0, 1, 2].map(|n| turn.col(n) * radius * random.between(0.4, 1.6)))
        }
        2 | 3 => Exact::Cylinder(from, to, radius),
        4 => Exact::Capsule(from, to, radius),
        5 => Exact::Cone(from, to, radius),
        _ => Exact::Frustum(from, to, [radius, radius * random.between(0.2, 1.8)]),
    }
}

fn point(random: &mut Random) -> DVec3 {
    random.point(DVec3::splat(-0.3), DVec3::splat(1.3))
}

fn any_direction(random: &mut Random) -> DVec3 {
    random.vector::<DVec3>(1.0).normalize()
}

/// A point with coordinates that are often those of planes of the cube.
fn point_on_planes(random: &mut Random) -> DVec3 {
    let mut p = point(random);
    for n in 0..3 {
        if random.below(2) == 0 {
            p[n] = [0.0, 0.25, 0.5, 1.0][random.below(4)];
        }
    }
    p
}

/// A solid that touches a pipe.
fn touching(random: &mut Random, [from, to]: [DVec3; 2], radius: f64) -> Exact {
    let axis = (to - from).normalize();
    let side = axis.cross(any_direction(random)).normalize();
    let other = radius * random.between(0.3, 1.5);
    let apart = if random.below(2) == 0 { radius + other } else { radius - other };
    let place = from + (to - from) * random.between(0.2, 0.8) + side * apart;
    let along = if random.below(2) == 0 { axis } else { side.cross(any_direction(random)).normalize() };
    match random.below(3) {
        0 => Exact::Ball(place, other),
        _ => Exact::Cylinder(place - along, place + along, other),
    }
}

/// Two or three solids.
fn solids(random: &mut Random, family: Family) -> Vec<Exact> {
    let size = |random: &mut Random| random.between(0.1, 0.7);
    let anyhow = |random: &mut Random| {
        let (from, to, radius) = (point(random), point(random), size(random));
        on_segment(random, from, to, radius)
    };
    let along_axis = |random: &mut Random, tilt: f64| {
        let from = point_on_planes(random);
        let axis = DVec3::AXES[random.below(3)] * [1.0, -1.0][random.below(2)];
        let length = [0.25, 0.5, 1.0, 2.0][random.below(4)];
        let radius = [0.125, 0.25, 0.5, random.between(0.1, 0.7)][random.below(4)];
        let lean = random.vector::<DVec3>(tilt);
        on_segment(random, from, from + axis * length + lean, radius)
    };
    let (from, to, radius) = (point(random), point(random), size(random));
    match family {
        Family::Anyhow => (0..2 + random.below(2)).map(|_| anyhow(random)).collect(),
        Family::Aligned => (0..2 + random.below(2)).map(|_| along_axis(random, 0.0)).collect(),
        Family::NearlyAligned => {
            let tilt = 10_f64.powf(random.between(-15.0, -3.0));
            (0..2 + random.below(2)).map(|_| along_axis(random, tilt)).collect()
        }
        Family::OnOneAxis => (0..2 + random.below(2))
            .map(|_| {
                let place = |random: &mut Random| from + (to - from) * [-0.3, 0.0, 0.5, 1.0, 1.4][random.below(5)];
                let (a, mut b) = (place(random), place(random));
                if a == b {
                    b = a + (to - from) * 0.7;
                }
                let radius = radius * [0.5, 1.0, 1.0, 1.0 + 1e-13][random.below(4)];
                on_segment(random, a, b, radius)
            })
            .collect(),
        Family::Twice => {
            let one = on_segment(random, from, to, radius);
            let moved = match one {
                Exact::Ball(c, r) => Exact::Ball(c, r * (1.0 + f64::EPSILON)),
                Exact::Cylinder(a, b, r) => Exact::Cylinder(b, a, r),
                Exact::Capsule(a, b, r) => Exact::Capsule(b, a, r),
                other => other,
            };
            vec![one, if random.below(2) == 0 { one } else { moved }]
        }
        Family::Touching => vec![Exact::Cylinder(from, to, radius), touching(random, [from, to], radius)],
        Family::Crossing => {
            let (one, other) = (any_direction(random), any_direction(random));
            let axis = |n: usize| DVec3::AXES[n];
            let n = random.below(3);
            let [one, other] = if random.below(2) == 0 { [axis(n), axis((n + 1) % 3)] } else { [one, other] };
            let center = random.point(DVec3::splat(0.2), DVec3::splat(0.8));
            let other_radius = radius * [1.0, 1.0, 0.5][random.below(3)];
            vec![
                Exact::Cylinder(center - one * 2.0, center + one * 2.0, radius),
                Exact::Cylinder(center - other * 2.0, center + other * 2.0, other_radius),
            ]
        }
        Family::Thin => {
            let thin = 10_f64.powf(random.between(-4.0, -2.0));
            let one = Exact::Cylinder(from, to, thin);
            let other = anyhow(random);
            vec![one, other]
        }
        Family::Huge => {
            let radius = 10_f64.powf(random.between(2.0, 3.0));
            let (place, side) = (random.point(DVec3::splat(0.2), DVec3::splat(0.8)), any_direction(random));
            let along = side.any_orthonormal_vector() * radius;
            let center = place + side * radius;
            let large = if random.below(2) == 0 {
                Exact::Ball(center, radius)
            } else {
                Exact::Cylinder(center - along, center + along, radius)
            };
            vec![large, anyhow(random)]
        }
    }
}

/// The sum over pairs less that over threes, of whatever is common to a set.
fn by_sets(solids: &[Exact], common: impl Fn(&[Exact]) -> f64) -> f64 {
    match *solids {
        [a, b] => common(&[a, b]),
        [a, b, c] => common(&[a, b]) + common(&[b, c]) + common(&[a, c]) - common(&[a, b, c]),
        _ => unreachable!("two or three solids"),
    }
}

/// Volume that solids have in common in the unit cube, from 4 × 4 × 4 uneven parts.
fn volume_of_parts(solids: &[Exact]) -> f64 {
    const CUTS: [f64; 5] = [0.0, 0.231, 0.517, 0.743, 1.0];
    let at = |i: usize, j: usize, k: usize| DVec3::new(CUTS[i], CUTS[j], CUTS[k]);
    let parts = (0..64).map(|n| [n % 4, n / 4 % 4, n / 16]);
    parts.map(|[i, j, k]| common_volume(solids, [at(i, j, k), at(i + 1, j + 1, k + 1)], 1e-6)).sum()
}

fn agrees(family: Family, seed: u64) -> Result<(), TestCaseError> {
    let random = &mut Random::new(seed);
    let exact = solids(random, family);
    let owned: Vec<QuadricSolid> = exact.iter().map(quadric).collect();
    let all: Vec<&QuadricSolid> = owned.iter().collect();
    let unit = [0.0, 1.0];
    // Chords of large solids are rough by rounding.
    let rough = if family == Family::Huge { 1e3 } else { 1.0 };
    for n in 0..3 {
        // Off planes in which flat ends may lie: of these one side counts.
        let at = random.between(0.01, 0.99);
        let mut face = [unit; 3];
        face[n] = [at; 2];
        let [low, high] = excess(&all, face, 1e-13).expect("few solids");
        let truth = by_sets(&exact, |set| common_area(set, n, at, [unit; 2], 1e-14 * rough));
        // Curves that are one but for rounding are not told apart.
        let close = if matches!(family, Family::OnOneAxis | Family::Twice) { 1e-8 } else { 1e-11 * rough };
        prop_assert!(high - low <= close, "face {n} at {at}: {low} to {high} of {exact:?}");
        let slack = 2e-12 * rough;
        let holds = low - slack <= truth && truth <= high + slack;
        prop_assert!(holds, "face {n} at {at}: {low} to {high} instead of {truth} of {exact:?}");
    }
    let mut truth = by_sets(&exact, |set| common_volume(set, [DVec3::ZERO, DVec3::ONE], 1e-7));
    for enough in [1e-3, 1e-5] {
        let [low, high] = excess(&all, [unit; 3], enough).expect("few solids");
        prop_assert!(high - low <= 1.01 * enough, "{low} to {high} of {exact:?}");
        let holds = |truth: f64| low - 1e-6 <= truth && truth <= high + 1e-6;
        if !holds(truth) {
            // Rarely a kink hides from the nodes of the quadrature; from those of the cube's parts it does not.
            truth = by_sets(&exact, volume_of_parts);
        }
        prop_assert!(holds(truth), "{low} to {high} instead of {truth} of {exact:?}");
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 32, failure_persistence: None, max_shrink_iters: 4, ..ProptestConfig::default() })]
    #[test]
    fn what_is_common_lies_within_its_bounds(seed in any::<u64>(), family in 0..FAMILIES.len()) {
        agrees(FAMILIES[family], seed)?;
    }
}

fn volume(solids: &[Exact], enough: f64) -> [f64; 2] {
    let owned: Vec<QuadricSolid> = solids.iter().map(quadric).collect();
    let all: Vec<&QuadricSolid> = owned.iter().collect();
    excess(&all, [[-2.0, 2.0], [-2.5, 1.5], [-1.7, 2.3]], enough).expect("few solids")
}

/// Closed volumes: pipes of one radius that cross at right angles, turned and not; two balls; a ball in a pipe; a pipe in itself.
#[test]
fn closed_volumes() {
    let turn = glam::DMat3::from_axis_angle(DVec3::new(1.0, 2.0, -0.5).normalize(), 0.7);
    let pipe = |axis: DVec3, r: f64| Exact::Cylinder(-axis * 1.4, axis * 1.4, r);
    let ball = |x: f64, r: f64| Exact::Ball(turn * DVec3::new(x, 0.0, 0.0), r);
    let two_balls = PI * (4.0 + 0.6) * (2.0 - 0.6) * (2.0 - 0.6) / 12.0 * 0.5_f64.powi(3);
    let cases = [
        (vec![pipe(DVec3::X, 0.5), pipe(DVec3::Y, 0.5)], 16.0 / 3.0 * 0.125),
        (vec![pipe(turn.x_axis, 0.5), pipe(turn.z_axis, 0.5)], 16.0 / 3.0 * 0.125),
        // Three: each pair 16/3 r³, all three 8 (2 − √2) r³.
        (
            vec![pipe(turn.x_axis, 0.5), pipe(turn.y_axis, 0.5), pipe(turn.z_axis, 0.5)],
            (16.0 - 8.0 * (2.0 - 2.0_f64.sqrt())) * 0.125,
        ),
        (vec![ball(0.0, 0.5), ball(0.3, 0.5)], two_balls),
        (vec![ball(0.0, 0.5), pipe(turn.y_axis, 0.5)], 4.0 / 3.0 * PI * 0.125),
        (vec![ball(0.0, 0.5), pipe(turn.y_axis, 0.3)], 4.0 / 3.0 * PI * (0.125 - 0.4_f64.powi(3))),
        (vec![pipe(turn.y_axis, 0.3), pipe(turn.y_axis, 0.3)], PI * 0.09 * 2.8),
        (vec![pipe(turn.y_axis, 0.3); 3], 2.0 * PI * 0.09 * 2.8),
    ];
    for (solids, truth) in cases {
        for enough in [1e-3, 1e-5, 1e-6] {
            let [low, high] = volume(&solids, enough);
            let held = low - 1e-12 <= truth && truth <= high + 1e-12;
            assert!(held && high - low <= enough, "{low} to {high} instead of {truth} for {solids:?}");
        }
    }
}

/// Nothing is claimed of what does not meet.
#[test]
fn what_is_apart_has_nothing_in_common() {
    let pipe = |x: f64, z: f64| Exact::Cylinder(DVec3::new(x, -1.9, z), DVec3::new(x, 1.4, z + 0.3), 0.25);
    assert_eq!(volume(&[pipe(0.0, 0.0), pipe(0.51, 0.1)], 1e-6), [0.0; 2]);
    assert_eq!(volume(&[pipe(0.0, 0.0), Exact::Ball(DVec3::new(1.0, 0.0, 0.0), 0.5)], 1e-6), [0.0; 2]);
}

/// Too many at one place are left to others.
#[test]
fn crowds_are_refused() {
    let pipes: Vec<QuadricSolid> =
        (0..40).map(|n| quadric(&Exact::Ball(DVec3::splat(0.01 * f64::from(n)), 0.5))).collect();
    let all: Vec<&QuadricSolid> = pipes.iter().collect();
    assert_eq!(excess(&all, [[0.0, 1.0]; 3], 1e-4), None);
}
