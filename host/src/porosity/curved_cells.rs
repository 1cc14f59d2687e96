//! Areas of curved solids in the cells that they have for themselves: measured, in place of those of facets.

use super::worker::Summary;
use crate::geometry::bodies::{Bodies, Body};
use crate::geometry::cut_areas;
use crate::geometry::form::Form;
use rayon::prelude::*;
use voidage_core::grid::Grid;
use voidage_core::surface::surface_area::{KeptCell, SurfaceArea, SurfaceCell};

/// Sets the areas of all cells where one curved body alone has surface, and tells their layers where it is convex; by how much the areas of all cells
/// together change. Cells that several bodies share keep what facets have.
pub fn measure(grid: &Grid<f64>, bodies: &Bodies, summaries: &mut [Summary]) -> SurfaceArea<f64> {
    if bodies.bodies.iter().all(|body| curved(body).is_none()) {
        return SurfaceArea::default();
    }
    let layers = Alone(summaries.iter().map(|summary| alone(&summary.kept.cells)).collect());
    let measured = |(k, summary): (usize, &mut Summary)| {
        let (mut change, mut found) = (SurfaceArea::default(), Vec::new());
        let mut known = std::mem::take(&mut summary.kept.cells).into_iter().peekable();
        for c in layers.cells_about(grid, k) {
            while let Some(before) = known.next_if(|own| (own.cell as usize) < c) {
                found.push(before);
            }
            let own = known.next_if(|own| own.cell as usize == c);
            let mut own = own.unwrap_or_else(|| SurfaceCell { cell: c as u32, ..SurfaceCell::default() });
            if let Some(before) = measure_cell(grid, bodies, &layers, k, &mut own) {
                change = change.plus(own.area).plus(before.times(-1.0));
            }
            if own.area != SurfaceArea::default() || own.kept != KeptCell::default() {
                found.push(own);
            }
        }
        found.extend(known);
        summary.kept.cells = found;
        change
    };
    let changes: Vec<SurfaceArea<f64>> = summaries.par_iter_mut().enumerate().map(measured).collect();
    // In the order of layers, so that the bits do not depend on the number of threads.
    changes.into_iter().fold(SurfaceArea::default(), SurfaceArea::plus)
}

/// Sets the areas of a cell of layer `k`, if curved bodies alone have surface in it; then what they were.
fn measure_cell(
    grid: &Grid<f64>,
    bodies: &Bodies,
    layers: &Alone,
    k: usize,
    own: &mut SurfaceCell<f64>,
) -> Option<SurfaceArea<f64>> {
    let nx = grid.cells()[0];
    let at = [own.cell as usize % nx, own.cell as usize / nx, k];
    let candidates = match own.kept.alone() {
        Some(body) => vec![body],
        // What bulges beyond its facets.
        None if own.kept.is_bare() => layers.beside(grid, at),
        None => Vec::new(),
    };
    let cell = grid.cell_box(at)?;
    let forms = candidates.into_iter().filter_map(|n| curved(bodies.bodies.get(n as usize)?));
    let (mut found, mut count, mut convex) = (SurfaceArea::default(), 0, true);
    for form in forms {
        let Some(part) = cut_areas::in_box(form, cell) else { continue };
        found = found.plus(part);
        count += 1;
        convex &= !matches!(form, Form::Torus(_));
    }
    if count == 0 {
        return None;
    }
    if count == 1 && convex {
        own.kept.set_convex();
    }
    Some(std::mem::replace(&mut own.area, found))
}

/// The cells of each layer that one body has for itself, in ascending order, and the body.
struct Alone(Vec<Vec<(usize, u32)>>);

fn alone(cells: &[SurfaceCell<f64>]) -> Vec<(usize, u32)> {
    cells.iter().filter_map(|own| Some((own.cell as usize, own.kept.alone()?))).collect()
}

impl Alone {
    /// The cells of a layer that one body has for itself, and all beside such, in ascending order.
    fn cells_about(&self, grid: &Grid<f64>, k: usize) -> Vec<usize> {
        let nx = grid.cells()[0];
        let of_layer = |k: usize| self.0.get(k).into_iter().flatten().map(move |(c, _)| [c % nx, c / nx, k]);
        let near = [k.wrapping_sub(1), k, k + 1].into_iter().flat_map(of_layer);
        let about = near.flat_map(|at| std::iter::once(at).chain(neighbours(grid, at)));
        let mut found: Vec<usize> = about.filter(|at| at[2] == k).map(|[i, j, _]| j * nx + i).collect();
        found.sort_unstable();
        found.dedup();
        found
    }

    /// The bodies that have the cells beside a cell for themselves, each once.
    fn beside(&self, grid: &Grid<f64>, at: [usize; 3]) -> Vec<u32> {
        let (nx, mut found) = (grid.cells()[0], Vec::new());
        for [i, j, k] in neighbours(grid, at) {
            let body = self.body(k, j * nx + i);
            found.extend(body.filter(|body| !found.contains(body)));
        }
        found
    }

    /// The body that has a cell of a layer for itself.
    fn body(&self, k: usize, cell: usize) -> Option<u32> {
        let layer = self.0.get(k)?;
        let at = layer.binary_search_by_key(&cell, |(c, _)| *c).ok()?;
        layer.get(at).map(|(_, body)| *body)
    }
}

/// The cells of the grid that share a side with one.
fn neighbours(grid: &Grid<f64>, at: [usize; 3]) -> impl Iterator<Item = [usize; 3]> {
    let cells = grid.cells();
    (0..3).flat_map(|axis| [(axis, false), (axis, true)]).filter_map(move |(axis, up)| {
        let mut next = at;
        next[axis] = if up { at[axis] + 1 } else { at[axis].checked_sub(1)? };
        (next[axis] < cells[axis]).then_some(next)
    })
}

/// The form of a body that is known by it alone and not bounded by planes.
fn curved(body: &Body) -> Option<&Form> {
    body.form_alone().filter(|form| !form.is_polytope())
}
