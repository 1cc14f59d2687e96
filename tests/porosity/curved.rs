//! Areas of curved solids in cells: totals by closed forms on several grids, cells cut anywhere, ends in planes, far coordinates, shadows.

use glam::{DMat3, DVec3, EulerRot};
use std::f64::consts::PI;
use voidage::geometry::bodies::Bodies;
use voidage::geometry::form::Form;
use voidage::geometry::{areas, cut_areas};
use voidage::grid::Edges;
use voidage::porosity::resistance::{Resistance, resistance};
use voidage::porosity::{Options, porosity};
use voidage_core::convex::shape::{Capsule, Cone, Cylinder, Ellipsoid, Sphere};
use voidage_core::convex::support::Transformed;
use voidage_core::number::aabb::Aabb;
use voidage_core::solids::torus::TorusShape;
use voidage_core::surface::surface_area::SurfaceArea;
use voidage_tests::random::Random;
use voidage_tests::solids::formulas;

fn obstacles(edges: &Edges, bodies: &Bodies) -> Resistance {
    let grid = edges.grid(None).expect("a grid");
    resistance(&grid, bodies, &porosity(&grid, bodies, Options::default()), Options::default())
}

/// All shapes, turned and along the axes, thin and flat, about a place.
fn forms(at: DVec3) -> Vec<Form> {
    let along = DVec3::new(1.9, 1.4, 1.6);
    let turn = DMat3::from_euler(EulerRot::XYZ, 0.4, 1.1, -0.7);
    let ellipsoid = |semi_axes| {
        let shape = Ellipsoid { center: DVec3::ZERO, semi_axes };
        Form::Ellipsoid(Transformed::new(shape, [turn.x_axis, turn.y_axis, turn.z_axis], DVec3::ONE, at))
    };
    let torus = |angle, axis| {
        Form::Torus(TorusShape { center: at, axis, start: DVec3::new(1.0, 0.1, 0.3), radius: 0.7, tube: 0.2, angle })
    };
    vec![
        Form::Sphere(Sphere { center: at, radius: 0.3 }),
        Form::Sphere(Sphere { center: at, radius: 0.04 }),
        Form::Capsule(Capsule { from: at, to: at + along, radius: 0.3 }),
        Form::Capsule(Capsule { from: at, to: at + DVec3::Y, radius: 0.1 }),
        Form::Cylinder(Cylinder::new(at, at + along, 0.3)),
        Form::Cylinder(Cylinder::new(at, at + along, 0.01)),
        Form::Cylinder(Cylinder::new(at, at + DVec3::Z * 1.1, 0.3)),
        Form::Cylinder(Cylinder::new(at, at + DVec3::new(1e-9, 1.1, 1e-4), 0.3)),
        Form::Cone(Cone::new(at, at + along, 0.9)),
        Form::Cone(Cone::new(at, at + DVec3::X, 0.5)),
        Form::Cone(Cone::truncated(at, at + along, 0.4, 0.9)),
        Form::Cone(Cone::truncated(at, at + DVec3::new(0.01, 0.02, 0.2), 1.4, 0.1)),
        ellipsoid(DVec3::new(0.5, 0.3, 0.9)),
        ellipsoid(DVec3::new(0.5, 0.01, 0.9)),
        ellipsoid(DVec3::new(0.5, 0.5, 0.02)),
        torus(360.0, along),
        torus(75.0, along),
        torus(200.0, DVec3::Z),
    ]
}

/// Planes around a body, none nearer to each other than half a `step` nor evenly spaced, the first beyond its lowest point by `beyond` of a step.
fn around(form: &Form, step: f64, beyond: f64) -> Edges {
    let [lo, hi] = form.bounds();
    Edges([0, 1, 2].map(|axis| {
        let (mut at, mut planes) = (lo[axis] - step * beyond, Vec::new());
        while planes.len() < 2 || planes[planes.len() - 2] < hi[axis] {
            planes.push(at);
            at += step * (0.75 + 0.25 * (7.0 * planes.len() as f64).sin());
        }
        planes
    }))
}

fn assert_close(found: SurfaceArea<f64>, truth: SurfaceArea<f64>, slack: f64, what: &str) {
    let pairs = found.frontal.into_iter().zip(truth.frontal).chain([(found.wetted, truth.wetted)]);
    assert!(pairs.into_iter().all(|(f, t)| (f - t).abs() <= slack), "{what}: {found:?}, {truth:?}");
}

/// On grids coarse and fine, whatever planes cut: the totals are those of the whole solid.
#[test]
fn cells_have_the_areas_of_the_whole() {
    for form in forms(DVec3::new(0.43, 0.52, 0.61)) {
        let truth = areas::of_form(&form).expect("curved");
        for (step, beyond) in [(3.0, 0.37), (0.5, 0.11), (0.23, 0.63)] {
            let found = obstacles(&around(&form, step, beyond), &formulas(std::slice::from_ref(&form)));
            let totals = found.totals;
            let what = format!("{form:?}, {step}");
            let union = SurfaceArea { frontal: totals.frontal_area, wetted: totals.wetted_area };
            assert_close(union, truth, 3e-11, &what);
            let sum = SurfaceArea { frontal: totals.frontal_area_of_bodies, wetted: totals.wetted_area_of_bodies };
            assert_close(sum, truth, 3e-11, &what);
        }
    }
}

/// A box has what its parts have, wherever it is cut; places where something changes are others in each part.
#[test]
fn boxes_have_the_areas_of_their_parts() {
    let mut random = Random::new(16);
    let mut cut = 0;
    for form in forms(DVec3::new(0.1, -0.2, 0.3)) {
        let [lo, hi] = form.bounds();
        for _ in 0..40 {
            let place = |random: &mut Random| {
                DVec3::from_array([0, 1, 2].map(|axis| lo[axis] - 0.1 + (hi[axis] - lo[axis] + 0.2) * random.unit()))
            };
            let [a, b] = [place(&mut random), place(&mut random)];
            let (min, max) = (a.min(b), a.max(b) + 0.05);
            let middle = min + (max - min) * DVec3::from_array([0; 3].map(|_| 0.1 + 0.8 * random.unit()));
            let whole = cut_areas::in_box(&form, Aabb { min, max }).expect("curved");
            let mut parts = SurfaceArea::default();
            for n in 0..8 {
                let upper = [0, 1, 2].map(|axis| n >> axis & 1 == 1);
                let of = |axis: usize, end: bool| match (upper[axis], end) {
                    (false, false) => min[axis],
                    (true, true) => max[axis],
                    _ => middle[axis],
                };
                let [min, max] = [false, true].map(|end| DVec3::from_array([0, 1, 2].map(|axis| of(axis, end))));
                parts = parts.plus(cut_areas::in_box(&form, Aabb { min, max }).expect("curved"));
            }
            let largest = (max - min).max_element().powi(2);
            assert_close(whole, parts, 1e-10 * largest, &format!("{form:?}, {min}, {max}, {middle}"));
            cut += usize::from(whole.wetted > 0.0);
        }
    }
    assert!(cut > 400, "{cut}");
}

/// Ends that lie in planes of the grid are wetted from the cells before them, and have no frontal area.
#[test]
fn ends_in_planes() {
    let (from, to, radius) = (DVec3::new(0.9, 1.1, 0.5), DVec3::new(0.9, 1.1, 2.0), 0.35);
    let axis: Vec<f64> = (0..=5).map(|n| 0.5 * f64::from(n)).collect();
    let form = Form::Cylinder(Cylinder::new(from, to, radius));
    let found = obstacles(&Edges([axis.clone(), axis.clone(), axis]), &formulas(&[form])).totals;
    let side = 2.0 * radius * 1.5;
    let union = SurfaceArea { frontal: found.frontal_area, wetted: found.wetted_area };
    let truth = SurfaceArea { frontal: [side, side, 0.0], wetted: 2.0 * PI * radius * (1.5 + radius) };
    assert_close(union, truth, 1e-12, "ends");
}

/// The same of ends at decimal coordinates, between which the unit vector along the solid may miss 1 by rounding, and of bends whose ends lie in planes.
#[test]
fn ends_at_decimals_in_planes() {
    let decimal = |n: i32| f64::from(n) / 10.0;
    let z: Vec<f64> = (-1..=31).map(decimal).collect();
    let across: Vec<f64> = (0..=2).map(|n| 0.15 * f64::from(n)).collect();
    let at = |height: f64| DVec3::new(0.152, 0.148, height);
    for (from, to) in (0..30).flat_map(|from| (from + 1..31).map(move |to| (from, to))) {
        for axis in 0..3 {
            let order = |p: DVec3| DVec3::from_array([0, 1, 2].map(|n| p[(n + 5 - axis) % 3]));
            let edges = Edges([0, 1, 2].map(|n| if n == axis { z.clone() } else { across.clone() }));
            let ends = [from, to].map(|n| order(at(decimal(n))));
            let form = match (from + to) % 2 {
                0 => Form::Cylinder(Cylinder::new(ends[0], ends[1], 0.12)),
                _ => Form::Cone(Cone::truncated(ends[0], ends[1], 0.12, 0.05)),
            };
            let own = areas::of_form(&form).expect("a curved solid");
            let found = obstacles(&edges, &formulas(&[form])).totals;
            // Of a cone that stands upright the ring around the smaller end is seen along it.
            let ring = if (from + to) % 2 == 0 { 0.0 } else { 0.5 * PI * (0.12 * 0.12 - 0.05 * 0.05) };
            let seen = found.frontal_area[axis];
            assert!((seen - ring).abs() < 1e-12, "{from} to {to} along {axis}: {seen} {ring}");
            assert!((found.wetted_area - own.wetted).abs() < 1e-11, "{from} to {to} along {axis}: {found:?} {own:?}");
        }
    }
}

/// In single precision far from the origin nothing is lost but what the coordinates have lost.
#[test]
fn far_and_in_single_precision() {
    let rounded = |p: DVec3| p.as_vec3().as_dvec3();
    let (from, to) = (rounded(DVec3::new(4e5, -3e5, 1e5) + 0.3), rounded(DVec3::new(4e5, -3e5, 1e5) + 1.7));
    for form in [
        Form::Sphere(Sphere { center: from, radius: 0.6 }),
        Form::Cylinder(Cylinder::new(from, to, 0.2)),
        Form::Cone(Cone::new(from, to, 0.4)),
    ] {
        let truth = areas::of_form(&form).expect("curved");
        let found = obstacles(&around(&form, 0.5, 0.4), &formulas(std::slice::from_ref(&form))).totals;
        let union = SurfaceArea { frontal: found.frontal_area, wetted: found.wetted_area };
        assert_close(union, truth, 1e-8, &format!("{form:?}"));
    }
}

/// The shadow of a ball in a cell is what lines meet of it there, with the part that reaches beyond a side, too.
#[test]
fn shadows_of_a_ball() {
    let (radius, deep) = (0.3_f64, 0.1);
    let ball = Form::Sphere(Sphere { center: DVec3::new(1.0 + deep, 0.5, 0.5), radius });
    let found = obstacles(&Edges([vec![0.0, 1.0, 2.0], vec![0.0, 1.0], vec![0.0, 1.0]]), &formulas(&[ball]));
    let [x, y, _] = found.shadows.tau.each_ref();
    let section = PI * (radius * radius - deep * deep);
    assert!((x[0] - section).abs() < 1e-12 && (x[1] - PI * radius * radius).abs() < 1e-12, "{x:?}");
    // Seen across, the plane x = 1 cuts a segment off the disc.
    let segment = radius * radius * (deep / radius).acos() - deep * (radius * radius - deep * deep).sqrt();
    assert!((y[0] - segment).abs() < 1e-12 && (y[1] - (PI * radius * radius - segment)).abs() < 1e-12, "{y:?}");
}
