//! Grids all solid and all open, bodies that leave the grid, solids that touch each other and the grid.

use crate::command::stress::case::{Effort, Numbers, StressCase, at_least, at_most};
use crate::command::stress::kit::boxes::share_of_disjoint;
use crate::command::stress::kit::doors::measure;
use crate::command::stress::kit::random::Random;
use crate::command::stress::kit::truth::{half_space, larger, open_fractions, worst};
use crate::command::triangulated::{cuboid, ring, scene, turned_box};
use crate::geometry::bodies::Bodies;
use crate::geometry::scene;
use crate::grid::Edges;
use crate::porosity::Options;
use glam::DVec3;
use std::f64::consts::PI;
use std::path::Path;

/// The cases.
pub const CASES: &[StressCase] = &[
    StressCase::new(
        "geometry/all-solid",
        "grids within a box, a box askew, a heap of boxes, and exactly as large as a box: 0",
        &[at_most(0.0, "open fraction of a cell or face"), at_most(0.0, "cells not closed"), at_least(4.0, "scenes")],
        all_solid,
    ),
    StressCase::new(
        "geometry/all-open",
        "grids beside bodies, in the hole of a ring, and without bodies: 1",
        &[at_most(0.0, "solid fraction of a cell or face"), at_most(0.0, "cells not open"), at_least(4.0, "scenes")],
        all_open,
    ),
    StressCase::new(
        "geometry/cut-by-domain",
        "boxes and boxes askew that leave the grid on every side: products of overlaps, planes in closed form",
        &[at_most(1e-12, "error of a cell or face"), at_least(100.0, "scenes")],
        cut_by_domain,
    ),
    StressCase::new(
        "geometry/tangent",
        "balls, cylinders and capsules by formula that fill a cell and touch its sides and each other: π/6, π/4, 4π/3, 0 in the faces",
        &[at_most(1e-12, "error of a cell"), at_most(1e-12, "error of a face"), at_least(3.0, "scenes")],
        tangent,
    ),
];

fn all_solid(_: Effort) -> Numbers {
    let (mut open, mut not_closed, mut scenes) = (0.0, 0, 0);
    let grid = Edges::cube(0.0, 1.0, 5);
    let heap = (0..8).map(|n| {
        let [x, y, z] = [n & 1, n >> 1 & 1, n >> 2 & 1].map(|high| 0.45 * f64::from(high));
        cuboid(DVec3::new(x, y, z) - 0.1, DVec3::new(x, y, z) + 0.65)
    });
    for solids in [
        vec![cuboid(DVec3::splat(-1.0), DVec3::splat(2.0))],
        vec![cuboid(DVec3::ZERO, DVec3::ONE)],
        vec![turned_box(DVec3::splat(0.5), DVec3::splat(1.0), Random::new(1).turn())],
        heap.collect(),
    ] {
        let found = measure(&grid, &scene(&solids)?, Options::default())?;
        let nothing = open_fractions(&grid, |_| 1.0);
        open = larger(open, worst(&found.beta, &nothing));
        not_closed += found.cells.open + found.cells.cut;
        scenes += 1;
    }
    Ok(vec![open, not_closed as f64, f64::from(scenes)])
}

fn all_open(_: Effort) -> Numbers {
    let (mut solid, mut not_open, mut scenes) = (0.0, 0, 0);
    let grid = Edges::cube(0.0, 1.0, 5);
    for solids in [
        vec![],
        vec![cuboid(DVec3::splat(1.5), DVec3::splat(2.0))],
        vec![turned_box(DVec3::new(-1.0, 0.5, 0.5), DVec3::splat(0.5), Random::new(1).turn())],
        vec![ring(DVec3::splat(0.5), 3.0, 1.0, Random::new(2).turn(), 24)],
    ] {
        let found = measure(&grid, &scene(&solids)?, Options::default())?;
        solid = larger(solid, worst(&found.beta, &open_fractions(&grid, |_| 0.0)));
        not_open += found.cells.cut + found.cells.closed;
        scenes += 1;
    }
    Ok(vec![solid, not_open as f64, f64::from(scenes)])
}

fn cut_by_domain(effort: Effort) -> Numbers {
    let (mut error, mut scenes) = (0.0, 0);
    let grid = Edges::cube(0.0, 1.0, 6);
    for seed in 0..effort.pick(50, 1000) {
        let mut random = Random::new(seed);
        let (mut lo, mut hi) = (random.point(DVec3::splat(0.1), DVec3::splat(0.5)), DVec3::ZERO);
        hi += lo + random.point(DVec3::splat(0.05), DVec3::splat(0.4));
        for axis in 0..3 {
            // Beyond the low side, beyond the high side, beyond both.
            match random.below(4) {
                0 => lo[axis] = -3.0,
                1 => hi[axis] = 7.0,
                2 => (lo[axis], hi[axis]) = (-1e3, 1e3),
                _ => {}
            }
        }
        let found = measure(&grid, &scene(&[cuboid(lo, hi)])?, Options::default())?;
        error = larger(error, worst(&found.beta, &open_fractions(&grid, |c| share_of_disjoint(&[[lo, hi]], c))));
        let (turn, half) = (random.turn(), random.between(3.0, 30.0));
        let offset = turn.x_axis.dot(random.point(DVec3::ZERO, DVec3::ONE));
        let center = turn.x_axis * (offset - half);
        let found = measure(&grid, &scene(&[turned_box(center, DVec3::splat(half), turn)])?, Options::default())?;
        error = larger(error, worst(&found.beta, &open_fractions(&grid, |c| half_space(turn.x_axis, offset, c))));
        scenes += 2;
    }
    Ok(vec![error, f64::from(scenes)])
}

/// A scene file's text as bodies.
fn parsed(text: &str) -> Result<Bodies, crate::error::Error> {
    let mut bodies = Bodies::default();
    scene::load::add(&scene::parse(Path::new("stress.toml"), text)?, &mut bodies)?;
    Ok(bodies)
}

fn tangent(_: Effort) -> Numbers {
    let grid = Edges::cube(0.0, 4.0, 4);
    let (mut cells, mut faces, mut scenes) = (0.0, 0.0, 0);
    // One of a row of four fills each cell of the middle; neighbours touch in a point, or along a line.
    let array = "array = { count = [4, 4, 4], step = [1, 1, 1] }";
    let along = "array = { count = [1, 4, 4], step = [0, 1, 1] }";
    let capsules = "shape = \"capsule\"\nfrom = [0.5, 0.5, 0.5]\nto = [3.5, 0.5, 0.5]\nradius = 0.5";
    for (solid, copies, inner, ends, across) in [
        ("shape = \"sphere\"\ncenter = [0.5, 0.5, 0.5]\nradius = 0.5", array, PI / 6.0, PI / 6.0, 0.0),
        (
            "shape = \"cylinder\"\nfrom = [0, 0.5, 0.5]\nto = [4, 0.5, 0.5]\nradius = 0.5",
            along,
            PI / 4.0,
            PI / 4.0,
            PI / 4.0,
        ),
        (capsules, along, PI / 4.0, PI / 8.0 + PI / 12.0, PI / 4.0),
    ] {
        let bodies = parsed(&format!("[[solid]]\nname = \"one\"\n{solid}\n{copies}\n"))?;
        let found = measure(&grid, &bodies, Options::default())?.beta;
        for (n, open) in found.v.iter().enumerate() {
            let solid = if matches!(n % 4, 0 | 3) { ends } else { inner };
            cells = larger(cells, (1.0 - open - solid).abs());
        }
        for (n, open) in found.x.iter().enumerate() {
            // The sides of the domain cut the cylinders only.
            let side = matches!(n % 5, 0 | 4);
            let solid = if side && inner != ends { 0.0 } else { across };
            faces = larger(faces, (1.0 - open - solid).abs());
        }
        faces = found.y.iter().chain(found.z.iter()).fold(faces, |most, open| larger(most, (1.0 - open).abs()));
        scenes += 1;
    }
    Ok(vec![cells, faces, f64::from(scenes)])
}
