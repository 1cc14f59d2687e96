//! Triangulated solids, counter-clockwise from outside.

use crate::error::Result;
use crate::geometry::bodies::Bodies;
use crate::geometry::mesh::Mesh;
use glam::{DMat3, DVec3};
use std::f64::consts::TAU;

/// Three corners.
pub type Corners = [DVec3; 3];

/// A box along the axes, 12 triangles.
#[must_use]
pub fn cuboid(min: DVec3, max: DVec3) -> Vec<Corners> {
    let corner = |n: usize| {
        let pick = |axis: usize| if n >> axis & 1 == 0 { min[axis] } else { max[axis] };
        DVec3::new(pick(0), pick(1), pick(2))
    };
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).map(|t| t.map(corner)).collect()
}

/// A box of half lengths `half`, turned and moved.
#[must_use]
pub fn turned_box(center: DVec3, half: DVec3, turn: DMat3) -> Vec<Corners> {
    changed(&cuboid(-half, half), |p| center + turn * p)
}

/// A ring about the z axis, `parts` quads along it and around it, turned and moved.
#[must_use]
pub fn ring(center: DVec3, radius: f64, thickness: f64, turn: DMat3, parts: usize) -> Vec<Corners> {
    let at = |i: usize, j: usize| {
        let [u, v] = [i, j].map(|n| TAU * (n % parts) as f64 / parts as f64);
        let out = radius + thickness * v.cos();
        center + turn * DVec3::new(out * u.cos(), out * u.sin(), thickness * v.sin())
    };
    let quads = (0..parts * parts).map(|n| (n / parts, n % parts));
    let quad = |(i, j)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    quads.flat_map(quad).collect()
}

/// A prism over a polygon in the plane z = `bottom`, by triangles that fan out from the origin.
#[must_use]
pub fn fan_prism(polygon: &[DVec3], bottom: f64, top: f64) -> Vec<Corners> {
    let at = |p: DVec3, z: f64| DVec3::new(p.x, p.y, z);
    let sides = polygon.iter().zip(polygon.iter().cycle().skip(1));
    let side = |(&p, &q): (&DVec3, &DVec3)| {
        let [a, b, c, d] = [at(p, bottom), at(q, bottom), at(q, top), at(p, top)];
        [[a, b, c], [a, c, d], [at(DVec3::ZERO, bottom), b, a], [at(DVec3::ZERO, top), d, c]]
    };
    sides.flat_map(side).collect()
}

/// Every corner changed.
#[must_use]
pub fn changed(solid: &[Corners], change: impl Fn(DVec3) -> DVec3) -> Vec<Corners> {
    solid.iter().map(|t| t.map(&change)).collect()
}

/// The same surface, looking inward.
#[must_use]
pub fn inward(solid: &[Corners]) -> Vec<Corners> {
    solid.iter().map(|&[a, b, c]| [a, c, b]).collect()
}

/// Coordinates at whole multiples of 2^-20, so that shifts and powers of two are exact.
#[must_use]
pub fn coarse(solid: &[Corners]) -> Vec<Corners> {
    let step = 2f64.powi(-20);
    changed(solid, |p| (p / step).round() * step)
}

/// Volume inside: tetrahedra from the first corner, summed.
#[must_use]
pub fn volume(solid: &[Corners]) -> f64 {
    let first = solid.first().map_or(DVec3::ZERO, |t| t[0]);
    solid.iter().map(|t| t.map(|p| p - first)).map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum()
}

/// A scene of solids, as if each came from a file of its own.
///
/// # Errors
/// A solid that is refused.
pub fn scene(solids: &[Vec<Corners>]) -> Result<Bodies> {
    let mut bodies = Bodies::default();
    solids.iter().try_for_each(|solid| bodies.add(&Mesh::from(solid.clone()), 1.0))?;
    Ok(bodies)
}
