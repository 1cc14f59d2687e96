//! Very many bodies: beside each other, through each other, in one cell.

use crate::command::stress::case::{Effort, Numbers, StressCase, at_least, at_most};
use crate::command::stress::kit::boxes::{VoxelUnion, share_of_disjoint};
use crate::command::stress::kit::doors::measure;
use crate::command::stress::kit::random::Random;
use crate::command::stress::kit::truth::{larger, open_fractions, outside, worst};
use crate::command::triangulated::{cuboid, scene, turned_box, volume};
use crate::grid::Edges;
use crate::porosity::Options;
use glam::DVec3;

/// The cases.
pub const CASES: &[StressCase] = &[
    StressCase::new(
        "geometry/coincident",
        "a block of 39304 bricks, 1.1e5 pairs of faces that coincide, on a grid off their planes: products of overlaps",
        &[at_most(1e-9, "error of a cell or face"), at_least(1e5, "pairs of faces that coincide")],
        coincident,
    ),
    StressCase::new(
        "geometry/copies",
        "2, 3, 5 and 8 boxes askew in the same place, and 40: volume of one",
        &[
            at_most(1e-9, "relative error of the solid volume, up to 8"),
            at_most(1e-12, "volume outside of the bounds, up to 40"),
        ],
        copies,
    ),
    StressCase::new(
        "geometry/overlapping",
        "10000 boxes that overlap in 512 cells, voxels counted",
        &[
            at_most(1e-9, "error of a cell or face"),
            at_most(1e-9, "truth outside of the bounds"),
            at_least(10_000.0, "bodies"),
        ],
        overlapping,
    ),
    StressCase::new(
        "geometry/heap",
        "10648 pieces askew in one cell, none in another: sum of their volumes",
        &[at_most(1e-12, "error of the open fraction"), at_least(1e4, "pieces")],
        heap,
    ),
    StressCase::new(
        "geometry/heap-overlapping",
        "2000 boxes (10000 with `--long`) through each other in one cell, voxels counted",
        &[
            at_most(1e-9, "truth outside of the bounds"),
            at_most(1e-4, "error of a cell or face"),
            at_least(2000.0, "pieces"),
        ],
        heap_overlapping,
    ),
];

fn coincident(_: Effort) -> Numbers {
    const SIDE: usize = 34;
    let corner = |n: usize| DVec3::new((n % SIDE) as f64, (n / SIDE % SIDE) as f64, (n / SIDE / SIDE) as f64);
    let bricks: Vec<_> = (0..SIDE.pow(3)).map(|n| cuboid(corner(n), corner(n) + DVec3::ONE)).collect();
    let edges = Edges::cube(-0.7, 35.3, 14);
    let found = measure(&edges, &scene(&bricks)?, Options::default())?;
    let block = [[DVec3::ZERO, DVec3::splat(SIDE as f64)]];
    let truth = open_fractions(&edges, |corners| share_of_disjoint(&block, corners));
    Ok(vec![worst(&found.beta, &truth), (3 * SIDE * SIDE * (SIDE - 1)) as f64])
}

fn copies(_: Effort) -> Numbers {
    let one = turned_box(DVec3::splat(0.5), DVec3::new(0.3, 0.2, 0.1), Random::new(2).turn());
    let edges = Edges::cube(0.0, 1.0, 5);
    let (mut error, mut outside) = (0.0, 0.0);
    for count in [2, 3, 5, 8, 40] {
        let bodies = scene(&vec![one.clone(); count])?;
        let found = measure(&edges, &bodies, Options { bounds: true, ..Options::default() })?;
        if count <= 8 {
            error = larger(error, (found.solid_volume / volume(&one) - 1.0).abs());
        }
        // All cells are alike.
        let solid = |open: &[f64]| open.iter().map(|b| 1.0 - b).sum::<f64>() / open.len() as f64;
        let [least, most] =
            found.bounds.as_ref().map_or([f64::NAN; 2], |[lower, upper]| [solid(&upper.v), solid(&lower.v)]);
        outside = larger(outside, larger(least - volume(&one), volume(&one) - most));
    }
    Ok(vec![error, outside])
}

fn overlapping(effort: Effort) -> Numbers {
    let count = effort.pick(10_000, 100_000);
    let boxes = VoxelUnion::random(&mut Random::new(1), 64, count, 6);
    let bodies = scene(&boxes.solids(DVec3::ZERO, 1.0))?;
    let planes = [0, 1, 2].map(|_| (0..=8).map(|i| 8 * i).collect::<Vec<usize>>());
    let options = Options { bounds: true, ..Options::default() };
    let found = measure(&VoxelUnion::edges(&planes, DVec3::ZERO, 1.0), &bodies, options)?;
    let truth = boxes.truth(&planes);
    Ok(vec![worst(&found.beta, &truth), outside(&found.bounds, &truth), bodies.bodies.len() as f64])
}

fn heap(_: Effort) -> Numbers {
    const SIDE: usize = 22;
    let mut random = Random::new(9);
    let slot = 1.0 / SIDE as f64;
    let pieces: Vec<_> = (0..SIDE.pow(3))
        .map(|n| {
            let at = DVec3::new((n % SIDE) as f64, (n / SIDE % SIDE) as f64, (n / SIDE / SIDE) as f64);
            let half = random.point(DVec3::splat(0.05), DVec3::splat(0.28)) * slot;
            turned_box((at + 0.5) * slot, half, random.turn())
        })
        .collect();
    let bodies = scene(&pieces)?;
    let edges = Edges([vec![0.0, 1.0, 2.0], vec![0.0, 1.0], vec![0.0, 1.0]]);
    let found = measure(&edges, &bodies, Options::default())?;
    let truth = 1.0 - pieces.iter().map(|piece| volume(piece)).sum::<f64>();
    let error = found.beta.v.iter().zip([truth, 1.0]).map(|(b, t)| (b - t).abs()).fold(0.0, f64::max);
    Ok(vec![error, bodies.bodies.len() as f64])
}

fn heap_overlapping(effort: Effort) -> Numbers {
    let boxes = VoxelUnion::random(&mut Random::new(4), 64, effort.pick(2000, 10_000), 6);
    let bodies = scene(&boxes.solids(DVec3::ZERO, 1.0))?;
    let planes = [vec![0, 64], vec![0, 64], vec![0, 64]];
    let options = Options { bounds: true, ..Options::default() };
    let found = measure(&VoxelUnion::edges(&planes, DVec3::ZERO, 1.0), &bodies, options)?;
    let truth = boxes.truth(&planes);
    Ok(vec![outside(&found.bounds, &truth), worst(&found.beta, &truth), bodies.bodies.len() as f64])
}
