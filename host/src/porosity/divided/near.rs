//! The triangles of solid bodies that reach some cells of a grid.

use crate::geometry::bodies::{Bodies, Body, Doubt};
use crate::geometry::facets;
use crate::porosity::cell_triangles::CellTriangles;
use crate::porosity::{snap, windows};
use glam::DVec3;
use std::ops::Range;
use voidage_core::grid::Grid;
use voidage_core::surface::clip::{Polygon, keep};

/// A triangle, with the number of its body.
pub type OfBody = (u32, [DVec3; 3]);

/// The triangles that reach each of some cells, or nearly so.
#[derive(Debug, Default)]
pub struct Near {
    triangles: Vec<OfBody>,
    /// The cells in ascending order.
    cells: Vec<usize>,
    /// Of each cell, those of a body one after the other.
    lists: Vec<Vec<u32>>,
    /// Which cells one unbroken patch cuts: its open space is not divided.
    whole: Vec<bool>,
}

/// A triangle whose box reaches so many cells is not cut to tell which of them it reaches itself.
const FEW_CELLS: usize = 27;

impl Near {
    /// Of cells in ascending order, some of which may be `known`; curved bodies as facets.
    pub fn new(grid: &Grid<f64>, bodies: &Bodies, cells: Vec<usize>, known: &CellTriangles) -> Self {
        let whole = cells.iter().map(|&n| known.is_whole(n)).collect();
        let mut near = Near { lists: vec![Vec::new(); cells.len()], cells, whole, ..Near::default() };
        let unknown = near.take_known(grid, bodies, known);
        if !unknown.is_empty() {
            near.search(grid, bodies, &unknown);
        }
        near
    }

    /// Those that reach one of the cells.
    pub fn of(&self, cell: usize) -> impl Iterator<Item = OfBody> {
        let list = self.cells.binary_search(&cell).map_or(&[][..], |at| &self.lists[at]);
        list.iter().map(|&t| self.triangles[t as usize])
    }

    /// Does one unbroken patch cut a cell?
    pub fn is_whole(&self, cell: usize) -> bool {
        self.cells.binary_search(&cell).is_ok_and(|at| self.whole[at])
    }

    /// Fills the lists of cells that are known; where the others stand among the cells.
    fn take_known(&mut self, grid: &Grid<f64>, bodies: &Bodies, known: &CellTriangles) -> Vec<usize> {
        let mut places = vec![u32::MAX; bodies.triangles.len()];
        let (to_planes, mut unknown) = (snap::ToPlanes::new(grid), Vec::new());
        for (at, (&n, list)) in self.cells.iter().zip(&mut self.lists).enumerate() {
            let Some(own) = known.of_cell(n) else {
                unknown.push(at);
                continue;
            };
            list.reserve_exact(own.len());
            list.extend(own.iter().filter_map(|&t| {
                let place = places.get_mut(t as usize)?;
                if *place == u32::MAX {
                    let number = snap::number_of_body(bodies, t as usize);
                    let body = bodies.bodies.get(number).filter(|body| is_solid(body))?;
                    *place = self.triangles.len() as u32;
                    self.triangles.push((number as u32, to_planes.moved(bodies.triangles[t as usize], body)));
                }
                Some(*place)
            }));
        }
        unknown
    }

    /// Fills some of the lists from all triangles.
    fn search(&mut self, grid: &Grid<f64>, bodies: &Bodies, lists: &[usize]) {
        let mut slots = vec![u32::MAX; grid.cell_count()];
        lists.iter().for_each(|&at| slots[self.cells[at]] = at as u32);
        let to_planes = snap::ToPlanes::new(grid);
        for (n, body) in bodies.bodies.iter().enumerate().filter(|(_, body)| is_solid(body)) {
            match facets::of_body(body) {
                Some(facets) => facets.iter().for_each(|facet| self.add(grid, &slots, n as u32, facet, |t| t)),
                None => {
                    let triangles = &bodies.triangles[body.triangles.clone()];
                    triangles.iter().for_each(|t| self.add(grid, &slots, n as u32, t, |t| to_planes.moved(t, body)));
                }
            }
        }
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

fn is_solid(body: &Body) -> bool {
    body.porosity == 0.0 && body.doubt != Doubt::Unknown
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
