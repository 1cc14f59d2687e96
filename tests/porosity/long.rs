//! Solids much longer than the grid, against the same that end just beyond it.

use glam::DVec3;
use voidage_core::grid::Grid;
use voidage_core::solids::quadric::QuadricSolid;
use voidage_tests::quadric::shares;
use voidage_tests::random::Random;

/// A point whose coordinates are multiples of an eighth, and a direction of small whole numbers: their sums are exact.
fn line(random: &mut Random) -> (DVec3, DVec3) {
    let mut eighths = || [0, 1, 2].map(|_| (8 + random.below(24)) as f64 / 8.0);
    let point = DVec3::from_array(eighths());
    loop {
        let along = [0, 1, 2].map(|_| random.below(11) as f64 - 5.0);
        if along != [0.0; 3] {
            return (point, DVec3::from_array(along));
        }
    }
}

/// Pipes, capsules and cones from 2^6 to 2^40 times as long as a cell, with both ends far or one near: every share is that of a solid that ends just
/// beyond the grid, to the last digits.
#[test]
fn solids_much_longer_than_the_grid_keep_their_digits() {
    let random = &mut Random::new(1216);
    let edges: Vec<f64> = (0..=5).map(f64::from).collect();
    let grid = Grid::new(&edges, &edges[..5], &edges[..4]).unwrap();
    for round in 0..400 {
        let (point, along) = line(random);
        let far = 2_f64.powi(6 + random.below(35) as i32);
        let near = -[0.0, 2.0, 4.0, far][random.below(4)];
        let radius = (4 + random.below(9)) as f64 / 8.0;
        let [from, to, short] = [near, far, 16.0].map(|times| point + along * times);
        let [long, short] = match round % 3 {
            0 if near == -far => {
                [[from, to], [point - along * 16.0, short]].map(|[a, b]| QuadricSolid::cylinder(a, b, radius))
            }
            0 => [[to, from], [short, from]].map(|[a, b]| QuadricSolid::cylinder(a, b, radius)),
            1 if near == -far => {
                [[from, to], [point - along * 16.0, short]].map(|[a, b]| QuadricSolid::capsule(a, b, radius))
            }
            1 => [[from, to], [from, short]].map(|[a, b]| QuadricSolid::capsule(a, b, radius)),
            _ => {
                let radius = if random.below(2) == 0 { radius } else { radius * far.min(512.0) };
                let there = radius * ((far - 16.0) / (far - near));
                [QuadricSolid::cone(from, to, radius), QuadricSolid::truncated_cone(short, from, [there, radius])]
            }
        }
        .map(|solid| shares(&solid.expect("a solid"), &grid));
        assert!(long.worst < 1e-12, "{round}: {point} + {along} × {near}…{far}: {} beyond 0 to 1", long.worst);
        for (field, (long, short)) in long.fields.iter().zip(&short.fields).enumerate() {
            for (at, (long, short)) in long.iter().zip(short).enumerate() {
                assert!(
                    (long - short).abs() < 1e-12,
                    "{round}: {point} + {along} × {near}…{far}: {field} {at}: {long}, {short}"
                );
            }
        }
    }
}
