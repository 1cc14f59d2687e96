//! Curved solids as triangles, for what closed forms do not give.

use super::bodies::Body;
use super::form::Form;
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use voidage_core::solids::torus::TorusShape;

/// Facets from pole to pole of a ball, and what makes its surface that of the true one.
const BALL_STEPS: usize = AROUND / 2;
const BALL_SCALE: f64 = 1.000_327_352;

/// Facets around an axis. A facetted pipe has the lateral surface of the true one; its width is off by
/// less than (π/96)²/3 = 4·10⁻⁴.
const AROUND: usize = 96;

/// The facets of a body that is known by its form alone; none if it has triangles of its own.
#[must_use]
pub fn of_body(body: &Body) -> Option<Vec<[DVec3; 3]>> {
    body.form.as_ref().filter(|_| body.triangles.is_empty()).map(triangles)
}

/// The surface of a form, counter-clockwise seen from outside; none for forms whose triangles are the body itself.
#[must_use]
pub fn triangles(form: &Form) -> Vec<[DVec3; 3]> {
    match form {
        Form::Sphere(s) => revolve(DVec3::Z, &meridian(BALL_STEPS), |p| s.center + p * (s.radius * BALL_SCALE)),
        Form::Ellipsoid(s) => revolve(DVec3::Z, &meridian(BALL_STEPS), |p| {
            s.apply(s.shape().center + p * s.shape().semi_axes * BALL_SCALE)
        }),
        Form::Cylinder(s) => {
            let ([from, to], radius) = (s.ends(), s.base_radius());
            let length = (to - from).length();
            let profile = [(0.0, 0.0), (radius, 0.0), (radius, length), (0.0, length)];
            revolve((to - from).normalize_or_zero(), &profile, |p| from + p)
        }
        Form::Cone(s) => {
            let ([base, top], length) = (s.ends(), (s.ends()[1] - s.ends()[0]).length());
            let profile = [(0.0, 0.0), (s.base_radius(), 0.0), (s.top_radius(), length), (0.0, length)];
            let profile = if s.top_radius() > 0.0 { &profile[..] } else { &profile[..3] };
            revolve((top - base).normalize_or_zero(), profile, |p| base + p)
        }
        Form::Capsule(s) => {
            let (axis, length) = ((s.to - s.from).try_normalize().unwrap_or(DVec3::Z), (s.to - s.from).length());
            let cap = |&(r, h): &(f64, f64)| (r * s.radius, h * s.radius + if h > 0.0 { length } else { 0.0 });
            let mut profile: Vec<(f64, f64)> = meridian(AROUND).iter().map(cap).collect();
            profile.insert(AROUND / 2 + 1, (s.radius, length));
            revolve(axis, &profile, |p| s.from + p)
        }
        Form::Torus(s) => bend(s),
        Form::Box(_) | Form::Hull(_) => Vec::new(),
    }
}

/// A torus or a part of one.
fn bend(shape: &TorusShape<DVec3>) -> Vec<[DVec3; 3]> {
    let axis = (shape.axis / shape.axis.abs().max_element()).normalize();
    let start = shape.start / shape.start.abs().max_element();
    let start = (start - axis * axis.dot(start)).normalize();
    let whole = shape.angle >= 360.0;
    let along = ((shape.angle / 360.0 * AROUND as f64).ceil() as usize).max(1);
    let place = |i: usize, j: usize| {
        let i = if whole { i % along } else { i };
        let around = TAU * (j % AROUND) as f64 / AROUND as f64;
        let (sin, cos) = sin_cos_of_degrees(shape.angle * i as f64 / along as f64);
        let out = start * cos + axis.cross(start) * sin;
        // The way around the ring is that of the true one only in the middle of its tube.
        let tube = shape.tube * widened();
        shape.center + out * (shape.radius + tube * around.cos()) + axis * (tube * around.sin())
    };
    let mut triangles = Vec::new();
    for (i, j) in (0..along).flat_map(|i| (0..AROUND).map(move |j| (i, j))) {
        let [a, b, c, d] = [place(i, j), place(i + 1, j), place(i + 1, j + 1), place(i, j + 1)];
        triangles.extend([[a, b, c], [a, c, d]]);
    }
    if !whole {
        // Turned as the tube is: the end closes what the tube leaves open.
        for j in 1..AROUND - 1 {
            triangles.push([place(0, 0), place(0, j), place(0, j + 1)]);
            triangles.push([place(along, 0), place(along, j + 1), place(along, j)]);
        }
    }
    triangles
}

/// Sine and cosine of degrees, of quarter turns exactly: ends of bends and turned boxes lie in planes of grids.
#[must_use]
pub fn sin_cos_of_degrees(degrees: f64) -> (f64, f64) {
    match degrees.rem_euclid(360.0) {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        other => other.to_radians().sin_cos(),
    }
}

/// Half a circle of radius 1 about the origin, from the lower pole: distance from the axis, and height.
fn meridian(steps: usize) -> Vec<(f64, f64)> {
    (0..=steps)
        .map(|n| {
            let angle = PI * n as f64 / steps as f64 - FRAC_PI_2;
            (if n == 0 || n == steps { 0.0 } else { angle.cos() }, angle.sin())
        })
        .collect()
}

/// Radius of a polygon with the perimeter of the circle of radius 1.
fn widened() -> f64 {
    let half = PI / AROUND as f64;
    half / half.sin()
}

/// A profile (distance from the axis, height along it, upwards) turned about an axis through the origin, mapped by `place`.
fn revolve(axis: DVec3, profile: &[(f64, f64)], place: impl Fn(DVec3) -> DVec3) -> Vec<[DVec3; 3]> {
    let (u, v) = axis.any_orthonormal_pair();
    let point = |(r, h): (f64, f64), n: usize| {
        let angle = TAU * (n % AROUND) as f64 / AROUND as f64;
        place(axis * h + (u * angle.cos() + v * angle.sin()) * (r * widened()))
    };
    let mut triangles = Vec::new();
    for ends in profile.windows(2) {
        for n in 0..AROUND {
            let [a, b] = [point(ends[0], n), point(ends[0], n + 1)];
            let [c, d] = [point(ends[1], n), point(ends[1], n + 1)];
            if ends[0].0 > 0.0 {
                triangles.push([a, b, d]);
            }
            if ends[1].0 > 0.0 {
                triangles.push([a, d, c]);
            }
        }
    }
    // A map that mirrors has turned them all.
    let volume: f64 = triangles.iter().map(|[a, b, c]| (*a - place(DVec3::ZERO)).dot((*b - *a).cross(*c - *a))).sum();
    if volume < 0.0 {
        triangles.iter_mut().for_each(|t| t.swap(1, 2));
    }
    triangles
}
