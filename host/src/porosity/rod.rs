//! How thick and how long a body is: the straight or bent rod that it is taken for in a table of congestion.

use super::drag::is_round;
use crate::geometry::bodies::Body;
use crate::geometry::form::Form;
use crate::geometry::repair::weld::bits;
use glam::{DMat3, DVec3};
use rustc_hash::{FxHashMap, FxHashSet};
use voidage_core::surface::surface_area::SurfaceArea;

/// Diameter and length of a body in m.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Rod {
    /// Of round sections the diameter, of others 4 A / P of their area and perimeter: the side of a square, twice the thickness of a plate.
    pub diameter: f64,
    /// Along its axis, around bends.
    pub length: f64,
}

impl Rod {
    /// Of a body with these areas; `triangles` are its own, none if it is known by its form alone.
    #[must_use]
    pub fn of_body(body: &Body, triangles: &[[DVec3; 3]], area: &SurfaceArea<f64>) -> Self {
        let of_ends = |[a, b]: [DVec3; 2], diameter: f64| Rod { diameter, length: a.distance(b) };
        match body.form.as_ref().filter(|_| triangles.is_empty()) {
            Some(Form::Sphere(s)) => Rod { diameter: 2.0 * s.radius, length: 2.0 * s.radius },
            Some(Form::Capsule(s)) => {
                let straight = of_ends([s.from, s.to], 2.0 * s.radius);
                Rod { length: straight.length + 2.0 * s.radius, ..straight }
            }
            Some(Form::Cylinder(s)) => of_ends(s.ends(), 2.0 * s.base_radius()),
            Some(Form::Cone(s)) => of_ends(s.ends(), s.base_radius() + s.top_radius()),
            Some(Form::Torus(s)) => Rod { diameter: 2.0 * s.tube, length: s.radius * s.angle.to_radians() },
            Some(Form::Ellipsoid(s)) => {
                let (semi_axes, origin) = (s.shape().semi_axes, s.apply(DVec3::ZERO));
                let half = |d: DVec3| (s.apply(d * semi_axes) - origin).length();
                straight(2.0 * half(DVec3::X).max(half(DVec3::Y)).max(half(DVec3::Z)), body.volume, area.wetted)
            }
            Some(Form::Box(_) | Form::Hull(_)) | None => of_surface(body, triangles, area),
        }
    }
}

/// A rod of this length between flat ends: volume A L and surface P L + 2 A tell 4 A / P. Of a ball its diameter.
fn straight(length: f64, volume: f64, wetted: f64) -> Rod {
    let around = if length > 0.0 { wetted - 2.0 * volume / length } else { 0.0 };
    Rod { diameter: if around > 0.0 { (4.0 * volume / around).max(0.0) } else { 0.0 }, length }
}

/// Sections of round bodies are no larger than those of their diameters by more than this: polygons whose edges turn by less than 40°.
const ROUND_SECTION: f64 = 1.05;

/// A body that reaches farther than this many diameters is slender: its ends are a small share of its surface.
const SLENDER: f64 = 2.0;

/// Volume and surface of a slender round body tell its diameter, even if it is bent, and its length, if that is more than it reaches. It must have one closed
/// surface without a way through: what has one may be a pipe with a wall.
fn of_surface(body: &Body, triangles: &[[DVec3; 3]], area: &SurfaceArea<f64>) -> Rod {
    let rod = straight(extent(triangles), body.volume, area.wetted);
    let is_slender = rod.diameter > 0.0 && rod.length > SLENDER * rod.diameter;
    if !(is_slender && is_simple(triangles) && is_round(body, triangles)) {
        return rod;
    }
    let length = |rod: Rod| body.volume / (std::f64::consts::FRAC_PI_4 * rod.diameter * rod.diameter);
    let round = (0..ROUND_STEPS).fold(rod, |rod, _| straight(length(rod), body.volume, area.wetted));
    let is_bent = round.length > ROUND_SECTION * rod.length;
    Rod { diameter: round.diameter, length: if is_bent { round.length } else { rod.length } }
}

/// Each step brings diameter and length nearer by the share that the ends have of the surface.
const ROUND_STEPS: usize = 16;

/// Is a closed surface that of a ball but for its shape? Corners, edges and faces then come to 2 by Euler.
fn is_simple(triangles: &[[DVec3; 3]]) -> bool {
    let corners: FxHashSet<[u64; 3]> = triangles.iter().flatten().map(|p| bits(*p)).collect();
    2 * corners.len() == triangles.len() + 4
}

/// Directions of faces that are tried, those of the largest.
const MOST_FACES: usize = 8;

/// How far a surface reaches along its axis: along that direction, of those across its largest faces and of its axes of inertia, along which it
/// reaches farthest.
fn extent(triangles: &[[DVec3; 3]]) -> f64 {
    let reach = |direction: DVec3| {
        let places = triangles.iter().flatten().map(|p| p.dot(direction));
        let [lo, hi] = places.fold([f64::INFINITY, -f64::INFINITY], |[lo, hi], p| [p.min(lo), p.max(hi)]);
        (hi - lo).max(0.0)
    };
    axes(triangles).into_iter().chain(across_faces(triangles)).map(reach).fold(0.0, f64::max)
}

/// Normals of the largest plane faces, of opposite ones one.
fn across_faces(triangles: &[[DVec3; 3]]) -> Vec<DVec3> {
    let mut faces: FxHashMap<[i64; 3], (f64, DVec3)> = FxHashMap::default();
    for [a, b, c] in triangles {
        let doubled = (*b - *a).cross(*c - *a);
        let Some(normal) = doubled.try_normalize() else { continue };
        // Rounding may divide a face: then its parts count.
        let sign = normal.to_array().into_iter().find(|c| c.abs() > 1e-9).unwrap_or(1.0).signum();
        let normal = normal * sign;
        let face = faces.entry((normal * 1e6).round().to_array().map(|c| c as i64)).or_insert((0.0, normal));
        face.0 += doubled.length();
    }
    let mut faces: Vec<(f64, DVec3)> = faces.into_values().collect();
    let order = |(area, normal): &(f64, DVec3)| (-*area, normal.x, normal.y, normal.z);
    faces.sort_by(|a, b| order(a).partial_cmp(&order(b)).unwrap_or(std::cmp::Ordering::Equal));
    faces.into_iter().take(MOST_FACES).map(|(_, normal)| normal).collect()
}

/// Axes of inertia of a surface that differ from each other by more than this, as a share of the largest moment, have a direction.
const APART: f64 = 1e-3;

/// The axes of inertia of a surface, but for those that have no direction of their own.
fn axes(triangles: &[[DVec3; 3]]) -> Vec<DVec3> {
    let (mut area, mut first) = (0.0, DVec3::ZERO);
    let parts: Vec<(f64, [DVec3; 3])> =
        triangles.iter().map(|t| ((t[1] - t[0]).cross(t[2] - t[0]).length(), *t)).collect();
    for (weight, [a, b, c]) in &parts {
        area += weight;
        first += (*a + *b + *c) * (weight / 3.0);
    }
    let center = if area > 0.0 { first / area } else { return Vec::new() };
    let mut second = DMat3::ZERO;
    let outer = |p: DVec3| DMat3::from_cols(p * p.x, p * p.y, p * p.z);
    for (weight, corners) in &parts {
        // The middles of the edges give second moments of a triangle exactly.
        let [a, b, c] = corners.map(|p| p - center);
        let sum = outer((a + b) * 0.5) + outer((b + c) * 0.5) + outer((c + a) * 0.5);
        second += sum * (weight / (3.0 * area));
    }
    let (moments, axes) = diagonal(second);
    let largest = moments.max_element();
    let own = |n: usize| (0..3).all(|m| m == n || (moments[n] - moments[m]).abs() > APART * largest);
    (0..3).filter(|&n| own(n)).map(|n| axes.col(n)).collect()
}

/// Moments and axes of a symmetric matrix, by Jacobi's turns.
fn diagonal(mut matrix: DMat3) -> (DVec3, DMat3) {
    let mut axes = DMat3::IDENTITY;
    for (p, q) in [(0, 1), (0, 2), (1, 2)].into_iter().cycle().take(60) {
        let off = matrix.col(p)[q];
        if off == 0.0 {
            continue;
        }
        let angle = 0.5 * (2.0 * off).atan2(matrix.col(q)[q] - matrix.col(p)[p]);
        let (s, c) = angle.sin_cos();
        let mut turn = DMat3::IDENTITY;
        turn.col_mut(p)[p] = c;
        turn.col_mut(q)[q] = c;
        turn.col_mut(p)[q] = -s;
        turn.col_mut(q)[p] = s;
        matrix = turn.transpose() * matrix * turn;
        (matrix.col_mut(p)[q], matrix.col_mut(q)[p]) = (0.0, 0.0);
        axes *= turn;
    }
    (DVec3::new(matrix.x_axis.x, matrix.y_axis.y, matrix.z_axis.z), axes)
}
