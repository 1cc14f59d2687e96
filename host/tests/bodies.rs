//! Triangles to bodies: what may be moved, capped and taken for a cavity, wherever the scene lies.

use glam::{DVec3, dvec3};
use voidage::geometry::bodies::Bodies;
use voidage::geometry::mesh::{Mesh, Solid};

type Triangle = [DVec3; 3];

/// Twelve triangles, outward; `turned` inward.
fn cuboid(lo: DVec3, hi: DVec3, turned: bool) -> Vec<Triangle> {
    let corner = |n: usize| lo + (hi - lo) * dvec3((n >> 2) as f64, (n >> 1 & 1) as f64, (n & 1) as f64);
    let sides = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    let halves = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
    halves.map(|[a, b, c]| if turned { [a, c, b] } else { [a, b, c] }.map(corner)).collect()
}

fn bodies(parts: &[&[Triangle]]) -> Bodies {
    let triangles = parts.concat();
    let solids = vec![Solid { name: "part".into(), triangles: 0..triangles.len() }];
    let mut bodies = Bodies::default();
    let mesh = Mesh { name: "test.stl".into(), solids, ..Mesh::from(triangles) };
    bodies.add(&mesh, 1.0).expect("bodies");
    bodies
}

/// Map coordinates, for one: a step of `f32` is half a metre there, but these are not `f32`.
const SITE: DVec3 = dvec3(450_000.25, 6_700_000.5, 10.0);

#[test]
fn a_hole_far_from_the_origin_does_not_swallow_its_body() {
    let shell = cuboid(SITE, SITE + 1.0, false);
    for open in [&shell[1..], &shell[2..]] {
        let found = bodies(&[open, &cuboid(SITE + 2.0, SITE + dvec3(7.0, 2.02, 2.02), false)]);
        let d = &found.diagnoses[0];
        assert_eq!((d.bodies, d.holes, d.welded_by), (2, 1, 0.0), "{:?}", found.warnings);
        let volume = 1.0 + 5.0 * 0.02 * 0.02;
        assert!((d.body_volume - volume).abs() < 1e-7, "{}", d.body_volume);
    }
}

#[test]
fn cracks_close_and_nothing_else_moves() {
    // Every corner written anew, a little off; beside it a closed body far smaller than the crack is allowed to be wide.
    let mut off = 0.0;
    let mut noise = || {
        off = (off + 0.37) % 1.0;
        DVec3::splat(off * 2e-7)
    };
    let cracked: Vec<_> =
        cuboid(DVec3::ZERO, DVec3::ONE, false).into_iter().map(|t| t.map(|p| p * 100.0 + noise())).collect();
    let small = cuboid(DVec3::splat(-3e-5), DVec3::ZERO - 1e-5, false);
    let found = bodies(&[&cracked, &small]);
    let d = &found.diagnoses[0];
    assert!(d.welded_by > 0.0 && d.welded_by < 1e-6 && d.boundary_edges == 0, "{:?}", found.warnings);
    assert_eq!(d.bodies, 2);
    assert!((found.bodies[1].volume / 8e-15 - 1.0).abs() < 1e-9, "{}", found.bodies[1].volume);
}

#[test]
fn small_holes_far_apart_are_holes() {
    // In two sides of a large box a triangle each is missing, a thousandth as long as the side.
    let shell = cuboid(DVec3::ZERO, DVec3::splat(100.0), false);
    let around = |t: &Triangle| {
        let middle = (t[0] + t[1] + t[2]) / 3.0;
        let inner = t.map(|p| middle + (p - middle) * 1e-3);
        (0..3)
            .flat_map(|i| {
                let j = (i + 1) % 3;
                [[t[i], t[j], inner[j]], [t[i], inner[j], inner[i]]]
            })
            .collect::<Vec<_>>()
    };
    let found = bodies(&[&shell[1..11], &around(&shell[0]), &around(&shell[11])]);
    let d = &found.diagnoses[0];
    assert_eq!((d.holes, d.boundary_edges, d.t_junction_edges), (2, 6, 0), "{:?}", found.warnings);
    assert!((d.body_volume - 1e6).abs() < 1e-6, "{}", d.body_volume);
}

#[test]
fn an_edge_divided_on_one_side_only_is_no_hole() {
    // The point in the middle of an edge is off it by the rounding of f32, as far from the origin as may be.
    for at in [DVec3::ZERO, DVec3::splat(1000.0)] {
        let mut shell = cuboid(at, at + 1.0, false);
        let [a, b, c] = shell[0];
        let middle = ((a + b) * 0.5).as_vec3().as_dvec3() + DVec3::splat(f64::from(f32::EPSILON) * (at.x + 1.0));
        shell[0] = [a, middle, c];
        shell.push([middle, b, c]);
        let found = bodies(&[&shell]);
        let d = &found.diagnoses[0];
        assert_eq!((d.holes, d.t_junction_edges), (0, 3), "{at}: {:?}", found.warnings);
    }
}

#[test]
fn a_cavity_may_touch_the_wall_of_its_body() {
    // Turned inward and inside, with a side in the wall of the body: a pocket, wherever rounding puts the two.
    for n in 0..50 {
        let at = SITE * (f64::from(n) * 0.013_7) - 0.1;
        let at = dvec3(at.x % 10.0, at.y % 10.0, at.z);
        let pocket = cuboid(at + dvec3(0.25, 0.25, 0.0), at + 0.75, true);
        let found = bodies(&[&cuboid(at, at + 1.0, false), &pocket]);
        let d = &found.diagnoses[0];
        assert_eq!((d.bodies, d.cavities), (1, 1), "{at}: {:?}", found.warnings);
        assert!((d.body_volume - 0.8125).abs() < 1e-12, "{}", d.body_volume);
    }
}

#[test]
fn beside_another_body_or_in_its_place_is_no_cavity() {
    let cube = cuboid(DVec3::ZERO, DVec3::ONE, false);
    let same = cuboid(DVec3::ZERO, DVec3::ONE, true);
    assert_eq!(bodies(&[&cube, &same]).diagnoses[0].cavities, 0);
    // In the notch of a body like an L, its box around it.
    let plate = cuboid(DVec3::ZERO, dvec3(3.0, 3.0, 1.0), false);
    let wall = cuboid(DVec3::ZERO, dvec3(1.0, 3.0, 3.0), false);
    let notch = cuboid(dvec3(1.0, 0.0, 1.0), dvec3(2.0, 1.0, 2.0), true);
    assert_eq!(bodies(&[&plate, &wall, &notch]).diagnoses[0].cavities, 0);
}
