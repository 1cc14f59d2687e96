//! Extreme sizes and places, and what must not matter: the unit, the origin, the shape of the cells, the number of threads.

use crate::command::stress::case::{Criterion, Effort, Numbers, StressCase, at_least, at_most};
use crate::command::stress::kit::boxes::VoxelUnion;
use crate::command::stress::kit::doors::measure;
use crate::command::stress::kit::random::Random;
use crate::command::stress::kit::truth::{differing, half_space, larger, open_fractions, worst};
use crate::command::triangulated::{Corners, changed, coarse, ring, scene, turned_box};
use crate::grid::Edges;
use crate::porosity::Options;
use glam::DVec3;

const SIZES: &[Criterion] =
    &[at_most(1e-12, "error of a cell or face"), at_most(0.0, "bits that differ from the same scene in metres")];

/// The cases.
pub const CASES: &[StressCase] = &[
    StressCase::new(
        "geometry/nano",
        "cells and bodies of 1e-9 m: unions of boxes, counted; and times 2^-30",
        SIZES,
        nano,
    ),
    StressCase::new(
        "geometry/giga",
        "cells and bodies of 1e9 m: unions of boxes, counted; and times 2^30",
        SIZES,
        giga,
    ),
    StressCase::new(
        "geometry/far",
        "cells of 1 m at 1e7 m from the origin: unions of boxes, counted; overlapping rings and boxes askew, moved",
        &[at_most(1e-12, "error of a cell or face"), at_most(1e-12, "change by the move")],
        far,
    ),
    StressCase::new(
        "geometry/aspect",
        "cells of aspect 16384: a plane askew in closed form; overlapping rings and boxes askew, flattened by 2^-14",
        &[at_most(1e-11, "error of a cell or face"), at_most(1e-9, "change by the flattening")],
        aspect,
    ),
    StressCase::new(
        "geometry/lattice",
        "1000 scenes (10000 with `--long`) of 8 boxes with sides in common planes, voxels counted",
        &[at_most(1e-14, "error of a cell or face"), at_least(1000.0, "scenes")],
        lattice,
    ),
    StressCase::new(
        "geometry/threads",
        "overlapping rings and boxes askew on 1, 2 and 7 threads",
        &[at_most(0.0, "bits that differ")],
        threads,
    ),
];

/// Planes of an uneven grid over 16 voxels.
fn planes() -> [Vec<usize>; 3] {
    [vec![0, 1, 3, 4, 8, 11, 16], vec![0, 2, 8, 12, 16], vec![0, 5, 8, 15, 16]]
}

/// Largest error of scenes of boxes, voxels of a size, the first at an origin.
fn error_of_boxes(scenes: u64, count: usize, origin: DVec3, size: f64) -> Result<f64, Box<dyn std::error::Error>> {
    let mut most = 0.0;
    for seed in 0..scenes {
        let boxes = VoxelUnion::random(&mut Random::new(seed), 16, count, 12);
        let bodies = scene(&boxes.solids(origin, size))?;
        let found = measure(&VoxelUnion::edges(&planes(), origin, size), &bodies, Options::default())?;
        most = larger(most, worst(&found.beta, &boxes.truth(&planes())));
    }
    Ok(most)
}

/// A ring and three boxes askew that overlap, in the unit cube; coordinates are coarse.
fn askew() -> Vec<Vec<Corners>> {
    let mut random = Random::new(7);
    let mut turned = || {
        let center = random.point(DVec3::splat(0.3), DVec3::splat(0.7));
        coarse(&turned_box(center, DVec3::new(0.3, 0.1, 0.05), random.turn()))
    };
    let mut solids = vec![turned(), turned(), turned()];
    solids.push(coarse(&ring(DVec3::splat(0.5), 0.28, 0.1, Random::new(3).turn(), 16)));
    solids
}

/// Cells of the unit cube; edges are coarse.
fn unit_edges() -> Edges {
    let axis = |n: u32| (0..=n).map(|i| f64::from(i * 128 / n) / 128.0).collect();
    Edges([axis(7), axis(9), axis(11)])
}

fn moved_edges(edges: &Edges, scale: DVec3, shift: DVec3) -> Edges {
    Edges([0, 1, 2].map(|axis| edges.0[axis].iter().map(|c| c * scale[axis] + shift[axis]).collect()))
}

fn nano(_: Effort) -> Numbers {
    sized(1e-9, 2f64.powi(-30))
}

fn giga(_: Effort) -> Numbers {
    sized(1e9, 2f64.powi(30))
}

fn sized(size: f64, power: f64) -> Numbers {
    let error = error_of_boxes(40, 8, DVec3::ZERO, size)?;
    let plain = measure(&unit_edges(), &scene(&askew())?, Options::default())?;
    let solids: Vec<_> = askew().iter().map(|s| changed(s, |p| p * power)).collect();
    let edges = moved_edges(&unit_edges(), DVec3::splat(power), DVec3::ZERO);
    let scaled = measure(&edges, &scene(&solids)?, Options::default())?;
    Ok(vec![error, differing(&scaled.beta, &plain.beta)])
}

fn far(_: Effort) -> Numbers {
    let shift = DVec3::new(1e7, -1e7, 1e7);
    let error = error_of_boxes(40, 8, shift, 1.0)?;
    let plain = measure(&unit_edges(), &scene(&askew())?, Options::default())?;
    let solids: Vec<_> = askew().iter().map(|s| changed(s, |p| p + shift)).collect();
    let edges = moved_edges(&unit_edges(), DVec3::ONE, shift);
    let moved = measure(&edges, &scene(&solids)?, Options::default())?;
    Ok(vec![error, worst(&moved.beta, &plain.beta)])
}

fn aspect(_: Effort) -> Numbers {
    let flat = DVec3::new(1.0, 1.0, 2f64.powi(-14));
    let plain = measure(&unit_edges(), &scene(&askew())?, Options::default())?;
    let solids: Vec<_> = askew().iter().map(|s| changed(s, |p| p * flat)).collect();
    let edges = moved_edges(&unit_edges(), flat, DVec3::ZERO);
    let flattened = measure(&edges, &scene(&solids)?, Options::default())?;
    // A large box of which only one side passes through the grid.
    let (turn, half) = (Random::new(5).turn(), 40.0);
    let normal = turn.x_axis;
    let offset = normal.dot(DVec3::new(0.45, 0.52, 0.5 * flat.z));
    let center = normal * (offset - half);
    let plane = scene(&[turned_box(center, DVec3::splat(half), turn)])?;
    let found = measure(&edges, &plane, Options::default())?;
    let error = worst(&found.beta, &open_fractions(&edges, |corners| half_space(normal, offset, corners)));
    Ok(vec![error, worst(&flattened.beta, &plain.beta)])
}

fn lattice(effort: Effort) -> Numbers {
    let scenes = effort.pick(1000, 10_000);
    Ok(vec![error_of_boxes(scenes, 8, DVec3::ZERO, 1.0)?, scenes as f64])
}

fn threads(_: Effort) -> Numbers {
    let bodies = scene(&askew())?;
    let edges = unit_edges();
    let mut found = Vec::new();
    for count in [1, 2, 7] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build()?;
        found.push(pool.install(|| measure(&edges, &bodies, Options::default()))?);
    }
    Ok(vec![found.windows(2).map(|pair| differing(&pair[0].beta, &pair[1].beta)).sum()])
}
