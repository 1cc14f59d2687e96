//! Corners that miss a grid plane by rounding are put into it.
//!
//! CAD writes 2.8e-17 where it means 0, and a file of `f32` 0.300000012 where it means 0.3. A wall that misses the plane of a face by so
//! little would block the face or not by chance; in the plane it blocks it. No corner moves farther than its source was rounded.

use crate::geometry::bodies::{Bodies, Body};
use crate::geometry::form::Form;
use crate::geometry::single::SingleSource;
use glam::DVec3;
use rayon::prelude::*;
use voidage_core::convex::shape::{Cone, Cylinder};
use voidage_core::grid::{Grid, Located};
use voidage_core::solids::torus::TorusShape;

/// Coordinates that were rounded twice, as of ends that were turned or moved, are right within this share of the largest.
const ROUNDED: f64 = 4.0 * f64::EPSILON;

/// A copy of the bodies' triangles with such corners moved; none if there are no such corners.
#[must_use]
pub fn into_planes(grid: &Grid<f64>, bodies: &Bodies) -> Option<Vec<[DVec3; 3]>> {
    let to_planes = ToPlanes::new(grid);
    let moved = |t: usize| {
        let body = bodies.bodies.get(number_of_body(bodies, t));
        bodies.triangles[t].map(|p| to_planes.corner(p, body))
    };
    let all = 0..bodies.triangles.len();
    let any = all.clone().into_par_iter().any(|t| moved(t) != bodies.triangles[t]);
    any.then(|| all.into_par_iter().map(moved).collect())
}

/// How single triangles come into the planes of a grid.
#[derive(Debug)]
pub struct ToPlanes<'a> {
    grid: &'a Grid<'a, f64>,
    /// Cells over the length of the grid along each axis.
    scale: [f64; 3],
    near: DVec3,
}

impl<'a> ToPlanes<'a> {
    /// Of a grid.
    #[must_use]
    pub fn new(grid: &'a Grid<'a, f64>) -> Self {
        let scale = [0, 1, 2].map(|axis| {
            let edges = grid.edges(axis);
            (edges.len() - 1) as f64 / (edges[edges.len() - 1] - edges[0])
        });
        ToPlanes { grid, scale, near: near(grid) }
    }

    /// A triangle of a body, as [`into_planes`] moves it.
    #[must_use]
    pub fn moved(&self, triangle: [DVec3; 3], body: &Body) -> [DVec3; 3] {
        triangle.map(|p| self.corner(p, Some(body)))
    }

    /// A solid by formula, its axis along one of the grid and its flat ends in planes, where it misses these by rounding.
    #[must_use]
    pub fn form(&self, form: &Form) -> Form {
        match form {
            Form::Cylinder(s) => {
                let [from, to] = self.ends(s.ends(), s.base_radius());
                Form::Cylinder(Cylinder::new(from, to, s.base_radius()))
            }
            Form::Cone(s) => {
                let [from, to] = self.ends(s.ends(), s.base_radius().max(s.top_radius()));
                Form::Cone(Cone::truncated(from, to, s.base_radius(), s.top_radius()))
            }
            Form::Torus(s) => Form::Torus(self.torus(s)),
            other => other.clone(),
        }
    }

    /// The ends of an axis, which is along one of the grid if it misses that by rounding, and so do discs of that radius about its ends, or no coordinate of
    /// them tells more: its flat ends lie in planes then. Across the axis nothing moves into a plane: what touches one goes on to do so.
    fn ends(&self, [from, to]: [DVec3; 2], radius: f64) -> [DVec3; 2] {
        let way = (to - from).abs();
        let told = ROUNDED * from.abs().max(to.abs()).max_element();
        let discs = (way * (radius / way.max_element()).max(1.0)).cmpgt(self.near) & way.cmpgt(DVec3::splat(told));
        let along = way.cmpgt(self.near) | discs;
        if along.bitmask().count_ones() != 1 {
            return [from, to];
        }
        [from, to].map(|p| DVec3::select(along, self.corner(p, None), from))
    }

    /// A torus, its axis and its beginning along axes of the grid if no point of it misses that by more than rounding; flat ends across one are in a plane.
    fn torus(&self, torus: &TorusShape<DVec3>) -> TorusShape<DVec3> {
        let reach = torus.radius + torus.tube;
        let aligned = |direction: DVec3| {
            let unit = direction / direction.abs().max_element();
            let along = (unit.abs() * reach).cmpgt(self.near);
            if along.bitmask().count_ones() == 1 { DVec3::select(along, unit, DVec3::ZERO) } else { direction }
        };
        let [axis, start] = [torus.axis, torus.start].map(aligned);
        let is_aligned = |d: DVec3| d.cmpne(DVec3::ZERO).bitmask().count_ones() == 1;
        let mut across = DVec3::ZERO;
        if torus.angle < 360.0 && is_aligned(axis) && is_aligned(start) {
            // The first end is across the third direction; of an odd number of quarter turns the last is across the first.
            across = axis.cross(start).abs();
            if torus.angle % 180.0 == 90.0 {
                across += start.abs();
            }
        }
        let center = DVec3::select(across.cmpgt(DVec3::ZERO), self.corner(torus.center, None), torus.center);
        TorusShape { center, axis, start, ..*torus }
    }

    /// A corner, its coordinates replaced by those of the planes that it misses by rounding.
    fn corner(&self, p: DVec3, body: Option<&Body>) -> DVec3 {
        let plane = DVec3::new(self.nearest(0, p.x), self.nearest(1, p.y), self.nearest(2, p.z));
        let off = (plane - p).abs();
        let mut room = self.near;
        let reach = |source: &SingleSource| off.min_element() <= self.near.max_element() + source.reach(p);
        if let Some(source) = body.and_then(|b| b.single).filter(reach) {
            room += source.error(p);
        }
        DVec3::select(off.cmple(room), plane, p)
    }

    /// The plane nearest to a coordinate, whose cell is guessed as if all were equally wide, and searched where it is another.
    #[inline(always)]
    fn nearest(&self, axis: usize, value: f64) -> f64 {
        let edges = self.grid.edges(axis);
        let guess = ((value - edges[0]) * self.scale[axis]) as u32 as usize;
        match edges.get(guess..) {
            Some(&[below, above, ..]) if below <= value && value < above => nearer(below, above, value),
            _ => nearest(self.grid, axis, value),
        }
    }
}

/// Distance along each axis within which any corner is in a plane, in metres.
#[must_use]
pub fn near(grid: &Grid<f64>) -> DVec3 {
    DVec3::from_array([0, 1, 2].map(|axis| grid.rounding(axis)))
}

/// The box around a body once its corners are in the planes that they miss by rounding, or a little larger.
#[must_use]
pub fn reach(grid: &Grid<f64>, body: &Body) -> [DVec3; 2] {
    let room = near(grid) + body.single_error();
    [body.bounds[0] - room, body.bounds[1] + room]
}

/// The number of the body that a triangle belongs to; bodies have their triangles one after the other.
#[must_use]
pub fn number_of_body(bodies: &Bodies, triangle: usize) -> usize {
    bodies.bodies.partition_point(|b| b.triangles.end <= triangle)
}

/// The plane nearest to a coordinate.
#[must_use]
pub fn nearest(grid: &Grid<f64>, axis: usize, value: f64) -> f64 {
    let edges = grid.edges(axis);
    let last = edges.len() - 1;
    let (below, above) = match grid.locate(axis, value) {
        Located::Below => (0, 0),
        Located::Cell(i) => (i, i + 1),
        Located::Above => (last, last),
    };
    nearer(edges[below], edges[above], value)
}

/// The nearer of two planes, the first if both are equally near.
#[inline(always)]
fn nearer(below: f64, above: f64, value: f64) -> f64 {
    if value - below <= above - value { below } else { above }
}

/// Sheets without thickness that lie, wholly or in part, in no plane of the grid: such parts block nothing.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct OffPlanes {
    /// Number of such sheets.
    pub sheets: usize,
    /// Area of those parts, one side of them, in m².
    pub area: f64,
}

/// Finds such sheets; `triangles` are those of `bodies`, or a copy with corners moved.
#[must_use]
pub fn sheets_off_planes(grid: &Grid<f64>, bodies: &Bodies, triangles: &[[DVec3; 3]]) -> OffPlanes {
    let mut found = OffPlanes::default();
    for sheet in bodies.bodies.iter().filter(|b| b.sheet) {
        let off = triangles[sheet.triangles.clone()].iter().filter(|t| !lies_in_plane(grid, t));
        // A sheet has two sides, and triangles on each.
        let area = off.map(|[a, b, c]| (b - a).cross(c - a).length() * 0.25).sum::<f64>();
        found.sheets += usize::from(area > 0.0);
        found.area += area;
    }
    found
}

fn lies_in_plane(grid: &Grid<f64>, [a, b, c]: &[DVec3; 3]) -> bool {
    (0..3).any(|axis| a[axis] == b[axis] && b[axis] == c[axis] && nearest(grid, axis, a[axis]) == a[axis])
}
