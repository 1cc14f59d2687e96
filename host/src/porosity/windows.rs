//! Boxes of cells around bodies: where a union with them differs from one without them.

use super::snap;
use crate::geometry::bodies::Bodies;
use glam::DVec3;
use std::ops::Range;
use voidage_core::grid::Grid;

/// A run of cells along each axis.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Window {
    /// The cells, none of the runs empty.
    pub cells: [Range<usize>; 3],
}

impl Window {
    /// All cells.
    #[must_use]
    pub fn whole(grid: &Grid<f64>) -> Self {
        Window { cells: grid.cells().map(|count| 0..count) }
    }

    /// The cells that a box reaches or touches, if there are any.
    #[must_use]
    pub fn around(grid: &Grid<f64>, [lo, hi]: [DVec3; 2]) -> Option<Self> {
        let cells = [0, 1, 2].map(|a| reached(grid.edges(a), lo[a], hi[a]));
        cells.iter().all(|run| !run.is_empty()).then_some(Window { cells })
    }

    /// With one more cell on each side where there is one: then both sides of all faces of the window are seen.
    #[must_use]
    pub fn with_margin(&self, grid: &Grid<f64>) -> Self {
        let count = grid.cells();
        Window {
            cells: [0, 1, 2].map(|a| self.cells[a].start.saturating_sub(1)..(self.cells[a].end + 1).min(count[a])),
        }
    }

    /// Its part of a grid.
    #[must_use]
    pub fn grid<'a>(&self, grid: &Grid<'a, f64>) -> Grid<'a, f64> {
        let [x, y, z] = [0, 1, 2].map(|a| &grid.edges(a)[self.cells[a].start..=self.cells[a].end]);
        Grid::new(x, y, z).expect("part of a grid")
    }

    /// Its lowest and highest corner.
    #[must_use]
    pub fn bounds(&self, grid: &Grid<f64>) -> [DVec3; 2] {
        let corner =
            |end: fn(&Range<usize>) -> usize| DVec3::from_array([0, 1, 2].map(|a| grid.edges(a)[end(&self.cells[a])]));
        [corner(|run| run.start), corner(|run| run.end)]
    }

    fn cell_count(&self) -> usize {
        self.cells.iter().map(Range::len).product()
    }
}

/// The cells along an axis that a run of coordinates reaches or touches.
#[must_use]
pub fn reached(edges: &[f64], lo: f64, hi: f64) -> Range<usize> {
    edges.partition_point(|&e| e < lo).saturating_sub(1)..edges.partition_point(|&e| e <= hi).min(edges.len() - 1)
}

/// Where the bodies of one porosity change the union of those of lower ones: around each, or everywhere where that costs less.
#[must_use]
pub fn windows(grid: &Grid<f64>, bodies: &Bodies, porosity: f64) -> Vec<Window> {
    let own = bodies.bodies.iter().filter(|b| b.porosity == porosity);
    let found: Vec<Window> = own.filter_map(|b| Window::around(grid, snap::reach(grid, b))).collect();
    let cost: usize = found.iter().map(|window| window.with_margin(grid).cell_count()).sum();
    if cost < grid.cell_count() { found } else { vec![Window::whole(grid)] }
}

/// Tasks in batches that have at most as many cells as the grid, or one task.
pub fn batches<'t, T>(grid: &Grid<f64>, tasks: &'t [(T, Window)]) -> impl Iterator<Item = &'t [(T, Window)]> {
    let (mut rest, most) = (tasks, grid.cell_count());
    std::iter::from_fn(move || {
        let mut cells = 0;
        let fits = rest.iter().take_while(|(_, window)| {
            cells += window.with_margin(grid).cell_count();
            cells <= most
        });
        let (batch, others) = rest.split_at(fits.count().max(1).min(rest.len()));
        rest = others;
        (!batch.is_empty()).then_some(batch)
    })
}
