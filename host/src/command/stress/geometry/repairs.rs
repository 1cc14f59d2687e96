//! Surfaces as they should not be: what a repair makes of them is the solid that was meant, and what is none is refused.

use crate::command::stress::case::{Effort, Numbers, StressCase, at_least, at_most};
use crate::command::stress::kit::doors::measure;
use crate::command::stress::kit::random::Random;
use crate::command::stress::kit::truth::{larger, worst};
use crate::command::triangulated::{Corners, cuboid, inward, ring, scene, turned_box, volume};
use crate::geometry::bodies::Bodies;
use crate::geometry::mesh::Mesh;
use crate::grid::Edges;
use crate::porosity::Options;
use glam::DVec3;

/// The cases.
pub const CASES: &[StressCase] = &[
    StressCase::new(
        "geometry/repairs",
        "rings and boxes with triangles turned, repeated, without area, in any order, inside out, a side left out: as without",
        &[
            at_most(1e-12, "change of a cell or face"),
            at_most(1e-12, "relative error of the volume"),
            at_least(14.0, "surfaces that were mended and said so"),
        ],
        repairs,
    ),
    StressCase::new(
        "geometry/cracks",
        "rings whose corners differ by half a unit in the last place of f32 from triangle to triangle: volume and fields as without",
        &[
            at_most(1e-6, "change of a cell or face"),
            at_most(1e-6, "relative error of the volume"),
            at_least(4.0, "rings with cracks"),
        ],
        cracks,
    ),
    StressCase::new(
        "geometry/non-finite",
        "NaN, infinities and 1e300 in every coordinate of a box; a box without area: refused, no panic",
        &[
            at_most(0.0, "meshes accepted"),
            at_least(400.0, "meshes tried"),
            at_most(1e-12, "error of the volume of the box as it was"),
        ],
        non_finite,
    ),
];

/// The same surface, spoiled in seven ways.
fn spoiled(solid: &[Corners], seed: u64) -> Vec<Vec<Corners>> {
    let mut random = Random::new(seed);
    let turned = |[a, b, c]: Corners| [a, c, b];
    let mut any_order = solid.to_vec();
    for n in (1..any_order.len()).rev() {
        any_order.swap(n, random.below(n + 1));
    }
    // Two neighbours of its first side, so that a flat cap closes it; of any surface one triangle.
    let left_out = if solid.len() == 12 { 2 } else { 1 };
    let flat = solid.iter().step_by(3).map(|&[a, b, _]| [a, b, (a + b) * 0.5]);
    vec![
        solid.iter().map(|&t| if random.below(3) == 0 { turned(t) } else { t }).collect(),
        solid.iter().flat_map(|&t| vec![t; 1 + random.below(3)]).collect(),
        solid.iter().copied().chain(flat).collect(),
        any_order.iter().map(|&[a, b, c]| if random.below(2) == 0 { [b, c, a] } else { [a, c, b] }).collect(),
        inward(solid),
        solid[left_out..].to_vec(),
        solid.iter().flat_map(|&t| [t, turned(t)]).collect(),
    ]
}

fn repairs(_: Effort) -> Numbers {
    let (mut change, mut error, mut mended) = (0.0, 0.0, 0);
    let turn = Random::new(8).turn();
    for (n, solid) in [
        cuboid(DVec3::new(-0.5, -0.6, -0.3), DVec3::new(0.5, 0.25, 0.7)),
        turned_box(DVec3::splat(0.1), DVec3::new(0.5, 0.3, 0.2), turn),
        ring(DVec3::ZERO, 0.6, 0.25, turn, 20),
    ]
    .into_iter()
    .enumerate()
    {
        let plain = measure(&Edges::cube(-1.0, 1.0, 7), &scene(std::slice::from_ref(&solid))?, Options::default())?;
        for surface in spoiled(&solid, n as u64) {
            let bodies = scene(&[surface])?;
            mended += usize::from(!bodies.warnings.is_empty());
            let found = measure(&Edges::cube(-1.0, 1.0, 7), &bodies, Options::default())?;
            change = larger(change, worst(&found.beta, &plain.beta));
            error = larger(error, (found.solid_volume / volume(&solid) - 1.0).abs());
        }
    }
    Ok(vec![change, error, mended as f64])
}

fn cracks(_: Effort) -> Numbers {
    let (mut change, mut error, mut cracked) = (0.0, 0.0, 0);
    for seed in 0..4 {
        let mut random = Random::new(50 + seed);
        let solid = ring(DVec3::ZERO, 0.6, 0.25, random.turn(), 20);
        let shaken = |p: DVec3| {
            DVec3::from_array(p.to_array().map(|x| {
                let single = x as f32;
                f64::from(if random.below(2) == 0 { single.next_up() } else { single })
            }))
        };
        let mesh = Mesh { single_precision: true, ..Mesh::from(solid.clone()) };
        let mut shaken = shaken;
        let triangles = solid.iter().map(|t| t.map(&mut shaken)).collect();
        let mut bodies = Bodies::default();
        bodies.add(&Mesh { triangles, ..mesh }, 1.0)?;
        cracked += usize::from(bodies.diagnoses.iter().any(|d| d.welded_by > 0.0));
        let plain = measure(&Edges::cube(-1.0, 1.0, 7), &scene(std::slice::from_ref(&solid))?, Options::default())?;
        let found = measure(&Edges::cube(-1.0, 1.0, 7), &bodies, Options::default())?;
        change = larger(change, worst(&found.beta, &plain.beta));
        error = larger(error, (found.solid_volume / volume(&solid) - 1.0).abs());
    }
    Ok(vec![change, error, cracked as f64])
}

fn non_finite(_: Effort) -> Numbers {
    let (mut accepted, mut tried) = (0, 0);
    let solid = cuboid(DVec3::ZERO, DVec3::ONE);
    let mut refused = |triangles: Vec<Corners>| {
        tried += 1;
        accepted += usize::from(Bodies::default().add(&Mesh::from(triangles), 1.0).is_ok());
    };
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300] {
        for n in 0..108 {
            let mut triangles = solid.clone();
            triangles[n / 9][n / 3 % 3][n % 3] = bad;
            refused(triangles);
        }
    }
    refused(vec![[DVec3::ZERO, DVec3::X, DVec3::X * 2.0]; 12]);
    refused(Vec::new());
    let whole = measure(&Edges::cube(-1.0, 1.0, 7), &scene(&[solid])?, Options::default())?.solid_volume;
    Ok(vec![accepted as f64, f64::from(tried), (whole - 1.0).abs()])
}
