//! Scenes far from the origin, seen from the grid's lowest corner.
//!
//! Coordinates of a survey (5.8e6 m) leave few digits for a part's own size, and every product of them loses more. Differences from a corner
//! nearby are exact, or rounded far below the digits that were there. Equal coordinates stay equal, and none change their order.

use super::snap::{self, ToPlanes};
use crate::geometry::bodies::Bodies;
use crate::grid::Edges;
use glam::DVec3;
use voidage_core::grid::Grid;

/// Grids whose corner is farther from the origin than so many of their lengths are seen from there.
const FAR: f64 = 4.0;

/// The grid and the bodies seen from the grid's corner, with these triangles, formulas in the planes that they miss by rounding; none if it is not far.
#[must_use]
pub fn from_corner(grid: &Grid<f64>, bodies: &Bodies, triangles: &[[DVec3; 3]]) -> Option<(Edges, Bodies)> {
    let corner = [0, 1, 2].map(|axis| grid.edges(axis)[0]);
    let length = [0, 1, 2].map(|axis| grid.edges(axis).last().map_or(0.0, |end| end - corner[axis]));
    let far = (0..3).any(|axis| corner[axis].abs() > FAR * length[axis]);
    if !far {
        return None;
    }
    let to_planes = ToPlanes::new(grid);
    let edges = [0, 1, 2].map(|axis| grid.edges(axis).iter().map(|e| e - corner[axis]).collect());
    let corner = DVec3::from_array(corner);
    let mut seen = bodies.clone();
    seen.triangles = triangles.iter().map(|t| t.map(|p| p - corner)).collect();
    for body in &mut seen.bodies {
        body.bounds = snap::reach(grid, body).map(|p| p - corner);
        body.form = body.form.as_ref().map(|form| to_planes.form(form).moved(-corner));
        body.unknown.iter_mut().flatten().for_each(|p| *p -= corner);
        body.single = None;
    }
    Some((Edges(edges), seen))
}
