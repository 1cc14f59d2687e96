//! Surfaces that lie on each other, within each other and through themselves.

use crate::command::stress::case::{Effort, Numbers, StressCase, at_least, at_most};
use crate::command::stress::kit::boxes::VoxelUnion;
use crate::command::stress::kit::doors::measure;
use crate::command::stress::kit::random::Random;
use crate::command::stress::kit::truth::{larger, worst};
use crate::command::triangulated::{Corners, changed, cuboid, fan_prism, inward, ring, scene, turned_box, volume};
use crate::grid::Edges;
use crate::porosity::Options;
use glam::{DMat3, DVec3};
use std::f64::consts::TAU;

/// The cases.
pub const CASES: &[StressCase] = &[
    StressCase::new(
        "geometry/double-sides",
        "boxes and rings whose every triangle has a back: as without",
        &[at_most(1e-14, "change of a cell or face"), at_most(1e-12, "relative error of the volume")],
        double_sides,
    ),
    StressCase::new(
        "geometry/nested",
        "boxes in boxes with common sides, edges and corners, as one body and as many, voxels counted",
        &[at_most(1e-12, "error of a cell or face"), at_least(50.0, "scenes")],
        nested,
    ),
    StressCase::new(
        "geometry/self-crossing",
        "star prisms {5/2}, {7/3} and {9/4}, which wind 2, 3 and 4 times around their middle: area of the outline",
        &[
            at_most(1e-9, "relative error of the volume"),
            at_most(1e-9, "change from a star that does not cross itself"),
        ],
        self_crossing,
    ),
    StressCase::new(
        "geometry/cavities",
        "rooms in boxes, and boxes in the rooms, five deep: voxels counted",
        &[at_most(1e-12, "error of a cell or face")],
        cavities,
    ),
];

fn double_sides(_: Effort) -> Numbers {
    let turn = Random::new(6).turn();
    let (mut change, mut error) = (0.0, 0.0);
    for solid in [
        cuboid(DVec3::splat(-0.5), DVec3::new(0.5, 0.25, 0.7)),
        turned_box(DVec3::splat(0.1), DVec3::new(0.5, 0.3, 0.2), turn),
        ring(DVec3::ZERO, 0.6, 0.2, turn, 20),
    ] {
        let both: Vec<Corners> = solid.iter().zip(&inward(&solid)).flat_map(|(a, b)| [*a, *b]).collect();
        let one = measure(&Edges::cube(-1.0, 1.0, 7), &scene(std::slice::from_ref(&solid))?, Options::default())?;
        let found = measure(&Edges::cube(-1.0, 1.0, 7), &scene(&[both])?, Options::default())?;
        change = larger(change, worst(&found.beta, &one.beta));
        error = larger(error, (found.solid_volume / volume(&solid) - 1.0).abs());
    }
    Ok(vec![change, error])
}

fn nested(effort: Effort) -> Numbers {
    let planes = [vec![0, 3, 8, 13, 16], vec![0, 4, 8, 16], vec![0, 5, 11, 16]];
    let edges = VoxelUnion::edges(&planes, DVec3::ZERO, 1.0);
    let (mut error, mut scenes) = (0.0, 0);
    for seed in 0..effort.pick(50, 1000) {
        let mut random = Random::new(seed);
        // Each shares with the one around it the lower or the upper end along each axis, or both.
        let mut boxes = vec![[[1; 3], [15; 3]]];
        while let Some(&[lo, hi]) = boxes.last()
            && boxes.len() < 6
        {
            let (mut inner_lo, mut inner_hi) = (lo, hi);
            for axis in 0..3 {
                match random.below(3) {
                    0 if hi[axis] - lo[axis] > 2 => inner_lo[axis] += 2,
                    1 if hi[axis] - lo[axis] > 2 => inner_hi[axis] -= 2,
                    _ => {}
                }
            }
            boxes.push([inner_lo, inner_hi]);
        }
        let boxes = VoxelUnion::new(16, boxes);
        let (solids, truth) = (boxes.solids(DVec3::ZERO, 1.0), boxes.truth(&planes));
        let many = measure(&edges, &scene(&solids)?, Options::default())?;
        let one = measure(&edges, &scene(&[solids.concat()])?, Options::default())?;
        error = larger(error, larger(worst(&many.beta, &truth), worst(&one.beta, &truth)));
        scenes += 1;
    }
    Ok(vec![error, f64::from(scenes)])
}

/// Corners of a star of `n` points around the unit circle, every `step`-th joined.
fn star(n: usize, step: usize) -> Vec<DVec3> {
    (0..n).map(|i| TAU * (i * step % n) as f64 / n as f64).map(|a| DVec3::new(a.cos(), a.sin(), 0.0)).collect()
}

/// The outline of the same star, which does not cross itself: its points, and between them where two sides cross.
fn outline(n: usize, step: usize) -> Vec<DVec3> {
    let half = TAU / (2 * n) as f64;
    let inner = (half * step as f64).cos() / (half * (step as f64 - 1.0)).cos();
    let point = |i: usize| {
        let (angle, radius) = (half * i as f64, if i.is_multiple_of(2) { 1.0 } else { inner });
        DVec3::new(radius * angle.cos(), radius * angle.sin(), 0.0)
    };
    (0..2 * n).map(point).collect()
}

fn self_crossing(_: Effort) -> Numbers {
    let (mut error, mut change) = (0.0, 0.0);
    let turn = DMat3::from_rotation_z(0.1);
    for (n, step) in [(5, 2), (7, 3), (9, 4)] {
        let outline = outline(n, step);
        let height = 1.1;
        // By triangles from the middle.
        let area: f64 = outline.iter().zip(outline.iter().cycle().skip(1)).map(|(p, q)| 0.5 * p.cross(*q).z).sum();
        let prism = |polygon: &[DVec3]| changed(&fan_prism(polygon, -0.53, -0.53 + height), |p| turn * p);
        let crossing = measure(&Edges::cube(-1.0, 1.0, 6), &scene(&[prism(&star(n, step))])?, Options::default())?;
        let simple = measure(&Edges::cube(-1.0, 1.0, 6), &scene(&[prism(&outline)])?, Options::default())?;
        error = larger(error, (crossing.solid_volume / (area * height) - 1.0).abs());
        change = larger(change, worst(&crossing.beta, &simple.beta));
    }
    Ok(vec![error, change])
}

fn cavities(_: Effort) -> Numbers {
    let planes = [vec![0, 3, 8, 13, 20], vec![0, 4, 9, 20], vec![0, 5, 11, 20]];
    let shell = |n: usize| cuboid(DVec3::splat(1.0 + n as f64), DVec3::splat(19.0 - n as f64));
    let surface: Vec<Corners> =
        (0..5).flat_map(|n| if n % 2 == 0 { shell(2 * n) } else { inward(&shell(2 * n)) }).collect();
    let found = measure(&VoxelUnion::edges(&planes, DVec3::ZERO, 1.0), &scene(&[surface])?, Options::default())?;
    // Of each solid shell the six slabs that are left around the room in it.
    let mut boxes = Vec::new();
    for outer in [0, 4, 8] {
        let (lo, hi) = (1 + outer, 19 - outer);
        let Some(room) = (outer < 8).then_some([lo + 2, hi - 2]) else {
            boxes.push([[lo; 3], [hi; 3]]);
            continue;
        };
        for axis in 0..3 {
            for [from, to] in [[lo, room[0]], [room[1], hi]] {
                let (mut low, mut high) = ([lo; 3], [hi; 3]);
                (low[axis], high[axis]) = (from, to);
                boxes.push([low, high]);
            }
        }
    }
    Ok(vec![worst(&found.beta, &VoxelUnion::new(20, boxes).truth(&planes))])
}
