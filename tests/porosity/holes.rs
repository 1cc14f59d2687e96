//! Holes: rims that touch in corners are rims of their own, a rim that is not plane leaves bounds for any surface that it may hold, and parts of a surface that
//! do not quite meet are no body that is nothing.

use glam::{DMat3, DVec3};
use voidage::geometry::bodies::Bodies;
use voidage::geometry::mesh::Mesh;
use voidage::grid::Edges;
use voidage::porosity::{FieldSet, Options, porosity};
use voidage_tests::solids::{Triangle, cuboid, sphere};

fn bodies(triangles: Vec<Triangle>) -> Bodies {
    let mut bodies = Bodies::default();
    bodies.add(&Mesh { name: "ball".into(), ..Mesh::from(triangles) }, 1.0).expect("a ball has an area");
    bodies
}

/// A scale that would mirror a body, or leave nothing of it, is refused.
#[test]
fn a_scale_is_above_zero() {
    let ball = Mesh { name: "ball".into(), ..Mesh::from(sphere([0.0; 3].into(), 1.0, 5)) };
    for scale in [-1.0, 0.0, f64::NAN, f64::INFINITY] {
        let mut bodies = Bodies::default();
        let told = bodies.add(&ball, scale).expect_err("no scale").to_string();
        assert!(told.contains("a scale is above 0 and finite") && bodies.bodies.is_empty(), "{scale}: {told}");
    }
}

/// The three triangles beside a fourth are missing: each is put back by itself, whichever of their edges comes first.
#[test]
fn holes_that_share_corners_are_closed_one_by_one() {
    let ball = sphere([0.1, 0.2, 0.3].into(), 1.0, 5);
    let volume = bodies(ball.clone()).bodies[0].volume;
    for first in [0, 7, 100] {
        let middle = ball[first];
        let shared = |t: &Triangle| t.iter().filter(|p| middle.contains(p)).count();
        let mut left: Vec<Triangle> = ball.iter().copied().filter(|t| shared(t) != 2).collect();
        assert_eq!(left.len() + 3, ball.len());
        for _ in 0..3 {
            left.rotate_left(ball.len() / 3);
            let found = bodies(left.clone());
            assert_eq!(found.diagnoses[0].holes, 3);
            assert!((found.bodies[0].volume - volume).abs() < 1e-13, "{} of {volume}", found.bodies[0].volume);
        }
    }
}

/// A hole whose rim is not plane, closed otherwise than by the cap: all values lie within the bounds, which differ.
#[test]
fn bounds_hold_what_may_close_an_uneven_hole() {
    let ball = sphere([0.1, 0.2, 0.3].into(), 1.0, 5);
    let fan = |n: usize| {
        let corner = ball[n][0];
        ball.iter().copied().partition::<Vec<Triangle>, _>(|t| t.contains(&corner))
    };
    let axis: Vec<f64> = (0..=9).map(|i| f64::from(i) * 0.3 - 1.15).collect();
    let edges = Edges([0.0, 0.1, 0.2].map(|by| axis.iter().map(|e| e + by).collect()));
    let measured = |triangles: Vec<Triangle>| {
        let bodies = bodies(triangles);
        let found =
            porosity(&edges.grid(None).expect("a grid"), &bodies, Options { bounds: true, ..Options::default() });
        (bodies, found)
    };
    let of = |set: &FieldSet| [set.v.to_vec(), set.x.to_vec(), set.y.to_vec(), set.z.to_vec()].concat();
    let mut uneven = 0;
    for n in (0..ball.len()).step_by(61) {
        let (missing, left) = fan(n);
        let corner = ball[n][0];
        let rim: Vec<_> = missing
            .iter()
            .map(|t| {
                let at = t.iter().position(|p| *p == corner).expect("its corner");
                [t[(at + 1) % 3], t[(at + 2) % 3]]
            })
            .collect();
        let (bodies, found) = measured(left.clone());
        let Some([lower, upper]) = &found.bounds else { panic!("bounds were asked for") };
        if found.max_gap < 1e-9 {
            continue;
        }
        uneven += 1;
        assert!(bodies.warnings.iter().any(|w| w.contains("not plane")), "{:?}", bodies.warnings);
        for from in rim.iter().map(|edge| edge[0]) {
            let cap = rim.iter().filter(|edge| !edge.contains(&from)).map(|&[a, b]| [from, a, b]);
            let (_, other) = measured(left.iter().copied().chain(cap).collect());
            let held = of(&other.beta).into_iter().zip(of(lower).into_iter().zip(of(upper)));
            assert!(held.into_iter().all(|(v, (l, u))| l - 1e-12 <= v && v <= u + 1e-12), "closed from {from}");
        }
    }
    assert!(uneven > 3, "{uneven} holes that are not plane");
}

/// The bounds of the solid volume in a grid of cells of 0.3 m around the origin, and the warnings.
fn volume_bounds(triangles: Vec<Triangle>) -> ([f64; 2], String) {
    let edges = Edges([0.0, 0.1, 0.2].map(|by| (0..=9).map(|i| f64::from(i) * 0.3 - 1.45 + by).collect()));
    let bodies = bodies(triangles);
    let found = porosity(&edges.grid(None).expect("a grid"), &bodies, Options { bounds: true, ..Options::default() });
    let [lower, upper] = found.bounds.as_ref().expect("bounds were asked for");
    let solid = |set: &FieldSet| set.v.iter().map(|open| 0.027 * (1.0 - open)).sum::<f64>();
    ([solid(upper), solid(lower)], bodies.warnings.join("\n"))
}

/// The faces of a cube, each a little smaller than its side, however they are turned and rounded: perhaps a cube, perhaps six plates of nothing.
#[test]
fn faces_that_nearly_meet_may_be_a_body_however_they_are_turned() {
    let faces: Vec<Triangle> = cuboid(DVec3::splat(-0.5), DVec3::splat(0.5))
        .into_iter()
        .map(|t| {
            let normal = (t[1] - t[0]).cross(t[2] - t[0]).normalize();
            t.map(|p| p * 0.999 + normal * (0.5 * 0.001))
        })
        .collect();
    for angle in [0.0, 0.3, 0.7, 2.0] {
        for digits in [6, 9, 17] {
            let turn = DMat3::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), angle);
            let write = |x: f64| format!("{x:.digits$}").parse::<f64>().expect("a number");
            let written = faces.iter().map(|t| t.map(|p| DVec3::from((turn * p).to_array().map(write)))).collect();
            let ([least, most], said) = volume_bounds(written);
            assert!(least < 1e-6 && 1.0 <= most, "turned by {angle}, {digits} digits: from {least} to {most}\n{said}");
            assert!(said.contains("nearly meet"), "turned by {angle}, {digits} digits: {said}");
        }
    }
}

/// A box with a room in it, written inside out, that is flush with a wall or breaks through it: the wall is what is left, or bounds hold both readings, and it is told.
#[test]
fn a_room_that_breaks_through_a_wall() {
    let inward = |t: Triangle| [t[0], t[2], t[1]];
    for (end, wall) in [(0.4, 0.488), (0.5, 0.424), (0.501, 0.424)] {
        let mut triangles = cuboid(DVec3::splat(-0.5), DVec3::splat(0.5));
        triangles.extend(cuboid(DVec3::splat(-0.4), DVec3::new(end, 0.4, 0.4)).into_iter().map(inward));
        let ([least, most], said) = volume_bounds(triangles);
        assert!(least - 1e-9 <= wall && wall <= most + 1e-9, "{end}: from {least} to {most}\n{said}");
        assert_eq!(said.contains("breaks through their surface"), end > 0.5, "{end}: {said}");
    }
    // A part turned inside out that only ends in another is a part.
    let mut triangles = cuboid(DVec3::splat(-0.5), DVec3::splat(0.5));
    triangles.extend(cuboid(DVec3::new(0.1, -0.1, -0.1), DVec3::new(1.0, 0.1, 0.1)).into_iter().map(inward));
    let ([least, most], said) = volume_bounds(triangles);
    assert!((least - 1.02).abs() < 1e-9 && (most - 1.02).abs() < 1e-9, "from {least} to {most}\n{said}");
}
