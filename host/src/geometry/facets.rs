//! Curved solids as triangles, for what closed forms do not give.

use super::bodies::Body;
use super::form::Form;
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use voidage_core::solids::torus::TorusShape;

/// Facets around an axis, if nothing asks for more, and at most for solids that are round about an axis alone and for those that are round every way, which
/// have as many as the square. A facetted pipe of `n` has the lateral surface of the true one; its width is off by less than (π/n)²/3, of 96 by 4·10⁻⁴.
const AROUND: usize = 96;
const MOST_AROUND_AXIS: usize = 4096;
const MOST_EVERY_WAY: usize = 256;

/// The facets of a body that is known by its form alone; none if it has triangles of its own.
#[must_use]
pub fn of_body(body: &Body) -> Option<Vec<[DVec3; 3]>> {
    body.form_alone().map(triangles)
}

/// The same, whose outline misses the true one by no more than a length where so many facets may be. As many are needed for that as the square root of the
/// solid's size over the length.
#[must_use]
pub fn close_to_body(body: &Body, miss: f64) -> Option<Vec<[DVec3; 3]>> {
    body.form_alone().map(|form| triangles_around(form, around(form, miss)))
}

/// By how much the outline of such facets misses that of a body, at most; 0 for one that has triangles of its own.
#[must_use]
pub fn miss_of_body(body: &Body, miss: f64) -> f64 {
    body.form_alone().map_or(0.0, |form| {
        let step = PI / around(form, miss) as f64;
        roundness(form).size * step * step
    })
}

/// How a form is round: its outline is missed by `size` × (π/n)² with n facets, and there may be so many.
struct Roundness {
    size: f64,
    most: usize,
}

fn roundness(form: &Form) -> Roundness {
    // Where the polygon has the length of the circle, it lies within a third of the square of the step around it.
    let (radius, most) = match form {
        Form::Sphere(s) => (s.radius, MOST_EVERY_WAY),
        Form::Ellipsoid(s) => {
            let (center, semi_axes) = (s.shape().center, s.shape().semi_axes);
            let axis = |n: usize| s.apply(center + DVec3::AXES[n] * semi_axes[n]).distance(s.apply(center));
            (axis(0).max(axis(1)).max(axis(2)), MOST_EVERY_WAY)
        }
        Form::Capsule(s) => (s.radius, MOST_EVERY_WAY),
        Form::Cylinder(s) => (s.base_radius(), MOST_AROUND_AXIS),
        Form::Cone(s) => (s.base_radius().max(s.top_radius()), MOST_AROUND_AXIS),
        // Around the ring it is a polygon within the circle.
        Form::Torus(s) => return Roundness { size: 0.5 * (s.radius + s.tube), most: MOST_EVERY_WAY },
        Form::Box(_) | Form::Hull(_) => (0.0, AROUND),
    };
    Roundness { size: radius / 3.0, most }
}

/// Facets around an axis so that the outline is missed by no more than a length; a multiple of four.
fn around(form: &Form, miss: f64) -> usize {
    let Roundness { size, most } = roundness(form);
    let wanted = PI * (size / miss).sqrt();
    // Casts of what is no number or too large are as good as any: the limits follow.
    ((0.25 * wanted).ceil() as usize).clamp(AROUND / 4, most / 4) * 4
}

/// The surface of a form, counter-clockwise seen from outside; none for forms whose triangles are the body itself.
#[must_use]
pub fn triangles(form: &Form) -> Vec<[DVec3; 3]> {
    triangles_around(form, AROUND)
}

fn triangles_around(form: &Form, around: usize) -> Vec<[DVec3; 3]> {
    let revolve = |axis, profile: &[(f64, f64)], place: &dyn Fn(DVec3) -> DVec3| revolve(around, axis, profile, place);
    match form {
        Form::Sphere(s) => {
            let radius = s.radius * ball_scale(around);
            revolve(DVec3::Z, &meridian(around / 2), &|p| s.center + p * radius)
        }
        Form::Ellipsoid(s) => {
            let scale = ball_scale(around);
            let place = |p| s.apply(s.shape().center + p * s.shape().semi_axes * scale);
            revolve(DVec3::Z, &meridian(around / 2), &place)
        }
        Form::Cylinder(s) => {
            let ([from, to], radius) = (s.ends(), s.base_radius());
            let length = (to - from).length();
            let profile = [(0.0, 0.0), (radius, 0.0), (radius, length), (0.0, length)];
            revolve((to - from).normalize_or_zero(), &profile, &|p| from + p)
        }
        Form::Cone(s) => {
            let ([base, top], length) = (s.ends(), (s.ends()[1] - s.ends()[0]).length());
            let profile = [(0.0, 0.0), (s.base_radius(), 0.0), (s.top_radius(), length), (0.0, length)];
            let profile = if s.top_radius() > 0.0 { &profile[..] } else { &profile[..3] };
            revolve((top - base).normalize_or_zero(), profile, &|p| base + p)
        }
        Form::Capsule(s) => {
            let (axis, length) = ((s.to - s.from).try_normalize().unwrap_or(DVec3::Z), (s.to - s.from).length());
            let cap = |&(r, h): &(f64, f64)| (r * s.radius, h * s.radius + if h > 0.0 { length } else { 0.0 });
            let mut profile: Vec<(f64, f64)> = meridian(around).iter().map(cap).collect();
            profile.insert(around / 2 + 1, (s.radius, length));
            revolve(axis, &profile, &|p| s.from + p)
        }
        Form::Torus(s) => bend(around, s),
        Form::Box(_) | Form::Hull(_) => Vec::new(),
    }
}

/// A torus or a part of one.
fn bend(count: usize, shape: &TorusShape<DVec3>) -> Vec<[DVec3; 3]> {
    let axis = (shape.axis / shape.axis.abs().max_element()).normalize();
    let start = shape.start / shape.start.abs().max_element();
    let start = (start - axis * axis.dot(start)).normalize();
    let whole = shape.angle >= 360.0;
    let along = ((shape.angle / 360.0 * count as f64).ceil() as usize).max(1);
    let place = |i: usize, j: usize| {
        let i = if whole { i % along } else { i };
        let around = TAU * (j % count) as f64 / count as f64;
        let (sin, cos) = sin_cos_of_degrees(shape.angle * i as f64 / along as f64);
        let out = start * cos + axis.cross(start) * sin;
        // The way around the ring is that of the true one only in the middle of its tube.
        let tube = shape.tube * widened(count);
        shape.center + out * (shape.radius + tube * around.cos()) + axis * (tube * around.sin())
    };
    let mut triangles = Vec::new();
    for (i, j) in (0..along).flat_map(|i| (0..count).map(move |j| (i, j))) {
        let [a, b, c, d] = [place(i, j), place(i + 1, j), place(i + 1, j + 1), place(i, j + 1)];
        triangles.extend([[a, b, c], [a, c, d]]);
    }
    if !whole {
        // Turned as the tube is: the end closes what the tube leaves open.
        for j in 1..count - 1 {
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
fn widened(corners: usize) -> f64 {
    let half = PI / corners as f64;
    half / half.sin()
}

/// What makes the surface of a facetted ball that of the true one: its strips are as long as the circles, and as wide as their middles are apart.
fn ball_scale(around: usize) -> f64 {
    let flat = widened(around) * (PI / around as f64).cos();
    let strip = |ends: &[(f64, f64)]| {
        let [(r, h), (s, k)] = [ends[0], ends[1]];
        PI * (r + s) * ((s - r) * flat).hypot(k - h)
    };
    let area: f64 = meridian(around / 2).windows(2).map(strip).sum();
    (4.0 * PI / area).sqrt()
}

/// A profile (distance from the axis, height along it, upwards) turned about an axis through the origin, mapped by `place`.
fn revolve(around: usize, axis: DVec3, profile: &[(f64, f64)], place: &dyn Fn(DVec3) -> DVec3) -> Vec<[DVec3; 3]> {
    let wide = widened(around);
    let (u, v) = axis.any_orthonormal_pair();
    let point = |(r, h): (f64, f64), n: usize| {
        let angle = TAU * (n % around) as f64 / around as f64;
        place(axis * h + (u * angle.cos() + v * angle.sin()) * (r * wide))
    };
    let mut triangles = Vec::new();
    for ends in profile.windows(2) {
        for n in 0..around {
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
