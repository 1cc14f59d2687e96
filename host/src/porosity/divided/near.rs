//! The triangles of solid bodies that reach some cells of a grid.

use crate::geometry::bodies::{Bodies, Body, Doubt};
use crate::geometry::facets;
use crate::porosity::{snap, windows};
use glam::DVec3;
use std::ops::Range;
use voidage_core::grid::Grid;
use voidage_core::surface::clip::{Polygon, keep};

/// A triangle, with the number of its body.
pub type OfBody = (u32, [DVec3; 3]);

/// The triangles that reach each of some cells, or nearly so.
pub struct Near {
    triangles: Vec<OfBody>,
    /// Of each cell, in ascending order.
    lists: Vec<Vec<u32>>,
}

/// A triangle whose box reaches so many cells is not cut to tell which of them it reaches itself.
const FEW_CELLS: usize = 27;

impl Near {
    /// Of cells in ascending order; curved bodies as facets.
    pub fn new(grid: &Grid<f64>, bodies: &Bodies, cells: &[usize]) -> Self {
        let mut slots = vec![u32::MAX; grid.cell_count()];
        cells.iter().zip(0..).for_each(|(&n, slot)| slots[n] = slot);
        let mut near = Near { triangles: Vec::new(), lists: vec![Vec::new(); cells.len()] };
        let solid = |(_, body): &(usize, &Body)| body.porosity == 0.0 && body.doubt != Doubt::Unknown;
        let to_planes = snap::ToPlanes::new(grid);
        for (n, body) in bodies.bodies.iter().enumerate().filter(solid) {
            match facets::of_body(body) {
                Some(facets) => facets.iter().for_each(|facet| near.add(grid, &slots, n as u32, facet, |t| t)),
                None => {
                    let triangles = &bodies.triangles[body.triangles.clone()];
                    triangles.iter().for_each(|t| near.add(grid, &slots, n as u32, t, |t| to_planes.moved(t, body)));
                }
            }
        }
        near
    }

    /// Those that reach the cell of this number among the cells.
    pub fn of(&self, cell: usize) -> impl Iterator<Item = OfBody> {
        self.lists[cell].iter().map(|&t| self.triangles[t as usize])
    }

    /// Add a triangle of a body to the cells that it reaches, once it is moved into planes of the grid that it misses by rounding: then it lies within no
    /// other cell than before.
    fn add(
        &mut self,
        grid: &Grid<f64>,
        slots: &[u32],
        body: u32,
        triangle: &[DVec3; 3],
        moved: impl Fn([DVec3; 3]) -> [DVec3; 3],
    ) {
        let number = self.triangles.len() as u32;
        let mut is_near = false;
        let mut list = |at: [usize; 3]| {
            if let Some(list) = self.lists.get_mut(slots[grid.cell_index(at)] as usize) {
                list.push(number);
                is_near = true;
            }
        };
        let [a, b, c] = *triangle;
        let (lo, hi) = (a.min(b).min(c), a.max(b).max(c));
        let x = windows::reached(grid.edges(0), lo.x, hi.x);
        let y = windows::reached(grid.edges(1), lo.y, hi.y);
        let z = windows::reached(grid.edges(2), lo.z, hi.z);
        let cut = (x.len() * y.len() * z.len() > FEW_CELLS).then(|| moved(*triangle));
        if let Some(triangle) = cut {
            let whole = Polygon::new(&triangle.map(|p| p.to_array()));
            for k in z {
                let slab = between(grid, 2, k, &whole);
                for j in reached(grid, 1, &slab) {
                    let row = between(grid, 1, j, &slab);
                    reached(grid, 0, &row).for_each(|i| list([i, j, k]));
                }
            }
        } else {
            for (k, j) in z.flat_map(|k| y.clone().map(move |j| (k, j))) {
                x.clone().for_each(|i| list([i, j, k]));
            }
        }
        if is_near {
            self.triangles.push((body, cut.unwrap_or_else(|| moved(*triangle))));
        }
    }
}

/// The cells along an axis that a polygon reaches or touches.
fn reached(grid: &Grid<f64>, axis: usize, polygon: &Polygon<f64>) -> Range<usize> {
    if polygon.is_empty() {
        return 0..0;
    }
    let (lo, hi) = polygon.extent(axis);
    windows::reached(grid.edges(axis), lo, hi)
}

/// What of a polygon lies between the planes of a layer.
fn between(grid: &Grid<f64>, axis: usize, layer: usize, polygon: &Polygon<f64>) -> Polygon<f64> {
    let (mut above, mut both) = (Polygon::new(&[]), Polygon::new(&[]));
    keep(polygon, axis, grid.edges(axis)[layer], true, &mut above);
    keep(&above, axis, grid.edges(axis)[layer + 1], false, &mut both);
    both
}
