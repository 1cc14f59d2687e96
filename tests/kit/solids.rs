//! Triangulated solids, outward, and scenes of them.

use glam::{DMat3, DVec3};
use std::f64::consts::PI;
use voidage::geometry::bodies::{Bodies, Body, Doubt, OwnDrag};
use voidage::geometry::form::Form;
use voidage::geometry::mesh::{Mesh, Solid};
use voidage::geometry::scene::hull::HullSolid;
use voidage_core::convex::shape::Sphere;

/// A triangle: three corners, counter-clockwise from outside.
pub type Triangle = [DVec3; 3];

/// An axis-aligned box, 12 triangles.
#[must_use]
pub fn cuboid(min: DVec3, max: DVec3) -> Vec<Triangle> {
    let corner = |n: usize| {
        DVec3::new(
            if n & 1 == 0 { min.x } else { max.x },
            if n & 2 == 0 { min.y } else { max.y },
            if n & 4 == 0 { min.z } else { max.z },
        )
    };
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).map(|t| t.map(corner)).collect()
}

/// A box of half-lengths `half`, turned and moved.
#[must_use]
pub fn turned_box(center: DVec3, half: DVec3, turn: DMat3) -> Vec<Triangle> {
    cuboid(-half, half).into_iter().map(|t| t.map(|p| center + turn * p)).collect()
}

/// A geodesic sphere: an icosahedron with every edge cut into `frequency` parts: 10 f² + 2 points, 20 f² triangles.
#[must_use]
pub fn sphere(center: DVec3, radius: f64, frequency: usize) -> Vec<Triangle> {
    let g = (1.0 + 5.0_f64.sqrt()) / 2.0;
    let points = [
        [-1.0, g, 0.0],
        [1.0, g, 0.0],
        [-1.0, -g, 0.0],
        [1.0, -g, 0.0],
        [0.0, -1.0, g],
        [0.0, 1.0, g],
        [0.0, -1.0, -g],
        [0.0, 1.0, -g],
        [g, 0.0, -1.0],
        [g, 0.0, 1.0],
        [-g, 0.0, -1.0],
        [-g, 0.0, 1.0],
    ]
    .map(DVec3::from_array);
    let faces = [
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ];
    let mut triangles = Vec::with_capacity(20 * frequency * frequency);
    for [a, b, c] in faces {
        // Weighted sums in the order of the corners' numbers: neighbours get the same bits.
        let at = |i: usize, j: usize| {
            let mut weights = [(a, frequency - i - j), (b, i), (c, j)];
            weights.sort_unstable();
            let sum: DVec3 = weights.iter().map(|&(p, w): &(usize, usize)| points[p] * w as f64).sum();
            center + sum.normalize() * radius
        };
        for i in 0..frequency {
            for j in 0..frequency - i {
                triangles.push([at(i, j), at(i + 1, j), at(i, j + 1)]);
                if i + j + 1 < frequency {
                    triangles.push([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
                }
            }
        }
    }
    triangles
}

/// Sixteen spheres of 362 points in the unit cube, as in the paper's largest case.
#[must_use]
pub fn sixteen_spheres() -> Vec<Vec<Triangle>> {
    sixteen_centers().map(|c| sphere(c, 0.11, 6)).collect()
}

fn sixteen_centers() -> impl Iterator<Item = DVec3> {
    (0..16).map(|n| {
        DVec3::new(0.125 + 0.25 * (n % 4) as f64, 0.25 + 0.5 * (n / 4 % 2) as f64, 0.25 + 0.5 * (n / 8) as f64)
    })
}

/// Volume enclosed by triangles.
#[must_use]
pub fn volume(triangles: &[Triangle]) -> f64 {
    voidage::geometry::repair::closed::signed_volume(triangles, triangles.first().map_or(DVec3::ZERO, |t| t[0]))
}

/// A scene of closed solids, as if each had been read from a file of its own.
///
/// # Panics
/// If a solid has no area.
#[must_use]
pub fn scene(solids: &[Vec<Triangle>]) -> Bodies {
    let mut bodies = Bodies::default();
    for (n, triangles) in solids.iter().enumerate() {
        let solids = vec![Solid { name: format!("solid {n}"), triangles: 0..triangles.len() }];
        let mesh = Mesh { name: format!("solid-{n}.stl"), solids, ..Mesh::from(triangles.clone()) };
        bodies.add(&mesh, 1.0).expect("a solid with an area");
    }
    bodies
}

/// A sphere of `count` points spread evenly by the golden angle, radius 1, each digit to a millionth; with its hull.
///
/// # Panics
/// For fewer than four points.
#[must_use]
pub fn point_sphere(count: usize) -> HullSolid {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let points: Vec<DVec3> = (0..count)
        .map(|n| {
            let z = 1.0 - (2 * n + 1) as f64 / count as f64;
            let (sin, cos) = (golden * n as f64).sin_cos();
            let r = (1.0 - z * z).sqrt();
            (DVec3::new(r * cos, r * sin, z) * 1e6).round() / 1e6
        })
        .collect();
    HullSolid::new(&points).expect("points of a sphere span a volume")
}

/// A hull as the text of an OBJ file.
#[must_use]
pub fn obj(hull: &HullSolid) -> String {
    let mut text = String::new();
    for p in &hull.corners {
        text += &format!("v {} {} {}\n", p.x, p.y, p.z);
    }
    for [a, b, c] in &hull.triangles {
        text += &format!("f {} {} {}\n", a + 1, b + 1, c + 1);
    }
    text
}

/// Sixteen balls where [`sixteen_spheres`] has geodesic ones.
#[must_use]
pub fn sixteen_balls() -> Vec<Sphere<DVec3>> {
    sixteen_centers().map(|center| Sphere { center, radius: 0.11 }).collect()
}

/// A scene of bodies known by formula.
#[must_use]
pub fn formulas(forms: &[Form]) -> Bodies {
    let body = |(n, form): (usize, &Form)| Body {
        name: format!("solid {n}"),
        triangles: 0..0,
        form: Some(form.clone()),
        single: None,
        porosity: 0.0,
        volume: volume_of(form),
        bounds: form.bounds(),
        cavities: 0,
        doubt: Doubt::None,
        rounding: 0.0,
        unknown: Vec::new(),
        sheet: false,
        drag: OwnDrag::default(),
    };
    Bodies { bodies: forms.iter().enumerate().map(body).collect(), ..Bodies::default() }
}

/// The volume of a curved solid; of those bounded by planes none is asked for.
fn volume_of(form: &Form) -> f64 {
    let ball = |radii: DVec3| 4.0 / 3.0 * PI * radii.element_product();
    let frustum = |[from, to]: [DVec3; 2], a: f64, b: f64| PI / 3.0 * from.distance(to) * (a * a + a * b + b * b);
    match form {
        Form::Sphere(s) => ball(DVec3::splat(s.radius)),
        Form::Ellipsoid(s) => ball(s.shape().semi_axes),
        Form::Cylinder(s) => frustum(s.ends(), s.base_radius(), s.base_radius()),
        Form::Cone(s) => frustum(s.ends(), s.base_radius(), s.top_radius()),
        Form::Capsule(s) => frustum([s.from, s.to], s.radius, s.radius) + ball(DVec3::splat(s.radius)),
        Form::Torus(s) => PI * s.tube * s.tube * s.radius * s.angle.to_radians(),
        _ => 0.0,
    }
}
