//! Areas of curved solids in the cells that they have for themselves: measured, in place of those of facets.

use super::worker::Summary;
use crate::geometry::bodies::{Bodies, Body};
use crate::geometry::cut_areas;
use crate::geometry::form::Form;
use rayon::prelude::*;
use voidage_core::grid::Grid;
use voidage_core::surface::surface_area::SurfaceArea;

/// Sets the areas of all cells where one curved body alone has surface, and tells their layers where it is convex; by how much the areas of all cells
/// together change. Cells that several bodies share keep what facets have.
pub fn measure(
    grid: &Grid<f64>,
    bodies: &Bodies,
    areas: &mut [SurfaceArea<f64>],
    summaries: &mut [Summary],
) -> SurfaceArea<f64> {
    let [nx, ny, _] = grid.cells();
    if bodies.bodies.iter().all(|body| curved(body).is_none()) {
        return SurfaceArea::default();
    }
    let alone: Vec<Option<u32>> =
        summaries.iter().flat_map(|summary| summary.kept.cells().iter().map(|cell| cell.alone())).collect();
    let layer = |(k, (areas, summary)): (usize, (&mut [SurfaceArea<f64>], &mut Summary))| {
        let (mut change, kept) = (SurfaceArea::default(), summary.kept.cells_mut());
        for (c, (area, kept)) in areas.iter_mut().zip(kept).enumerate() {
            let at = [c % nx, c / nx, k];
            let candidates = match kept.alone() {
                Some(body) => vec![Some(body)],
                // What bulges beyond its facets.
                None if kept.is_bare() => beside(grid, &alone, at),
                None => continue,
            };
            let Some(cell) = grid.cell_box(at) else { continue };
            let forms = candidates.into_iter().flatten().filter_map(|n| curved(bodies.bodies.get(n as usize)?));
            let (mut found, mut count, mut convex) = (SurfaceArea::default(), 0, true);
            for form in forms {
                let Some(part) = cut_areas::in_box(form, cell) else { continue };
                found = found.plus(part);
                count += 1;
                convex &= !matches!(form, Form::Torus(_));
            }
            if count == 0 {
                continue;
            }
            change = change.plus(found).plus(area.times(-1.0));
            *area = found;
            if count == 1 && convex {
                kept.set_convex();
            }
        }
        change
    };
    let changes: Vec<SurfaceArea<f64>> =
        areas.par_chunks_mut(nx * ny).zip(summaries.par_iter_mut()).enumerate().map(layer).collect();
    // In the order of layers, so that the bits do not depend on the number of threads.
    changes.into_iter().fold(SurfaceArea::default(), SurfaceArea::plus)
}

/// The form of a body that is known by it alone and not bounded by planes.
fn curved(body: &Body) -> Option<&Form> {
    body.form_alone().filter(|form| !form.is_polytope())
}

/// The bodies that have the cells beside a cell for themselves, each once.
fn beside(grid: &Grid<f64>, alone: &[Option<u32>], at: [usize; 3]) -> Vec<Option<u32>> {
    let cells = grid.cells();
    let mut found = Vec::new();
    for (axis, up) in (0..3).flat_map(|axis| [(axis, false), (axis, true)]) {
        let mut next = at;
        next[axis] = if up { at[axis] + 1 } else { at[axis].wrapping_sub(1) };
        if next[axis] < cells[axis] {
            let [i, j, k] = next;
            let body = alone.get((k * cells[1] + j) * cells[0] + i).copied().flatten();
            if body.is_some() && !found.contains(&body) {
                found.push(body);
            }
        }
    }
    found
}
