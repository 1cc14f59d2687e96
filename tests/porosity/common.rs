//! What solids by formula have in common, against quadrature of chords and against closed volumes.

use glam::DVec3;
use proptest::prelude::*;
use std::f64::consts::PI;
use voidage_core::solids::quadric::{QuadricSolid, excess};
use voidage_tests::meeting::{FAMILIES, Family, bounds_agree, planes_agree, planes_enclose_a_torus, quadric, solids};
use voidage_tests::quadrature::{Exact, common_area, common_volume};
use voidage_tests::random::Random;

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
    let all: Vec<QuadricSolid> = exact.iter().map(quadric).collect();
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
    #![proptest_config(ProptestConfig { cases: 4, failure_persistence: None, max_shrink_iters: 4, ..ProptestConfig::default() })]
    #[test]
    fn what_is_common_lies_within_its_bounds(seed in any::<u64>(), family in 0..FAMILIES.len()) {
        agrees(FAMILIES[family], seed)?;
    }
}

fn volume(solids: &[Exact], enough: f64) -> [f64; 2] {
    let all: Vec<QuadricSolid> = solids.iter().map(quadric).collect();
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

/// The half ball at the end of a capsule that is all but upright reaches over the cell's bottom by a sliver, long and 1e-14 thick: little in every
/// slice, and little between them.
#[test]
fn a_sliver_of_a_half_ball_is_bounded_closely() {
    agrees(Family::NearlyAligned, 7_643_991_702_517_342_692).expect("close bounds");
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
    assert_eq!(excess(&pipes, [[0.0, 1.0]; 3], 1e-4), None);
}

/// Whatever the tolerance, and however the cell is cut, bounds hold the same number; and no numbers make it panic.
#[test]
fn bounds_of_wholes_and_parts_agree() {
    (0..120).for_each(bounds_agree);
}

/// By planes between which solids lie the same as by sections; those around a torus hold its points.
#[test]
fn planes_say_what_sections_say() {
    (0..80).for_each(planes_agree);
    let decided: usize = (0..400).map(planes_enclose_a_torus).sum();
    assert!(decided > 20_000, "{decided}");
}
