//! What stands in the way of the gas: frontal area, wetted area and lengths of the obstacles in every cell.

use super::layers::Workers;
use super::shadows::{Shadows, of_layers};
use super::solid::{open_layer, solid_alone, with_solid_layers};
use super::{FieldSet, Options, Porosity};
use crate::geometry::bodies::Bodies;
use glam::DVec3;
use rayon::prelude::*;
use voidage_core::grid::Grid;
use voidage_core::surface::layer::{AreaReport, Layers};
use voidage_core::surface::surface_area::{CellSurface, SurfaceArea};

/// Obstacles in the cells of a grid, `nx*ny*nz`, x fastest, and their totals. Of solids that are porous themselves nothing is counted.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Resistance {
    /// Frontal area density along x, y and z in 1/m: ½ ∫ |n_i| dA / V over the surface of the union inside the cell.
    pub a: [Vec<f64>; 3],
    /// Wetted area density in 1/m: ∫ dA / V.
    pub s: Vec<f64>,
    /// Hydraulic diameter 4 β_v / s in m; 0 in cells without surface.
    pub d_h: Vec<f64>,
    /// Mean size of the obstacles 4 (1 − β_v) / s in m: of a pipe its diameter; 0 in cells without surface.
    pub l_obs: Vec<f64>,
    /// Shadows along x, y and z.
    pub shadows: Shadows,
    /// Totals.
    pub totals: Totals,
}

/// Areas within the grid, in m².
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Totals {
    /// Frontal area of the union along x, y and z, without surface in the planes of the grid.
    pub frontal_area: [f64; 3],
    /// Wetted area of the union.
    pub wetted_area: f64,
    /// Frontal areas of all bodies added up, whether they overlap or not.
    pub frontal_area_of_bodies: [f64; 3],
    /// Likewise wetted areas.
    pub wetted_area_of_bodies: f64,
    /// Cells shared by bodies whose union has no proof.
    pub unproved: usize,
    /// The largest wetted area in doubt in one of them.
    pub max_doubt: f64,
}

/// The obstacles among `bodies` on `grid`; `result` holds their porosities, faces included. Runs in the current rayon pool.
#[must_use]
pub fn resistance(grid: &Grid<f64>, bodies: &Bodies, result: &Porosity, options: Options) -> Resistance {
    let own = solid_alone(grid, bodies, options);
    let beta = &own.as_ref().unwrap_or(result).beta;
    with_solid_layers(grid, bodies, options, |layers| {
        let (union, sum, reports) = areas(grid, layers, beta);
        let shadows = of_layers(grid, layers, beta);
        Resistance { totals: totals(&union, &sum, &reports), shadows, ..densities(grid, &beta.v, &union) }
    })
}

/// Areas of the union and of all bodies added up, and how well they are known.
type Areas = (Vec<SurfaceArea<f64>>, Vec<SurfaceArea<f64>>, Vec<AreaReport<f64>>);

/// Areas in all cells.
fn areas(grid: &Grid<f64>, layers: &Layers<DVec3>, beta: &FieldSet) -> Areas {
    let [nx, ny, nz] = grid.cells();
    let mut union = vec![SurfaceArea::default(); nx * ny * nz];
    let (mut sum, workers) = (union.clone(), Workers::new());
    let reports: Vec<AreaReport<f64>> = union
        .par_chunks_mut(nx * ny)
        .zip(sum.par_chunks_mut(nx * ny))
        .enumerate()
        .map(|(k, (union, sum))| {
            workers.with(layers, |worker| {
                let (mut cells, open) = (vec![CellSurface::default(); nx * ny], open_layer(grid, k, beta));
                let mut memory = worker.memory(grid, layers, k);
                layers
                    .surface_areas(k, &open, [union, sum], &mut cells, &mut memory)
                    .expect("slices of a layer fit its grid")
            })
        })
        .collect();
    (union, sum, reports)
}

/// Totals in the order of cells, so that their bits do not depend on the number of threads.
fn totals(union: &[SurfaceArea<f64>], sum: &[SurfaceArea<f64>], reports: &[AreaReport<f64>]) -> Totals {
    let add = |areas: &[SurfaceArea<f64>]| areas.iter().fold(SurfaceArea::default(), |total, a| total.plus(*a));
    let (union, sum) = (add(union), add(sum));
    Totals {
        frontal_area: union.frontal,
        wetted_area: union.wetted,
        frontal_area_of_bodies: sum.frontal,
        wetted_area_of_bodies: sum.wetted,
        unproved: reports.iter().map(|r| r.unproved).sum(),
        max_doubt: reports.iter().fold(0.0, |most, r| r.max_doubt.max(most)),
    }
}

/// Less solid than this, as a share of a cell, is rounding.
const ROUNDING: f64 = 2e-13;

/// Areas over volumes, and the lengths that follow.
fn densities(grid: &Grid<f64>, open: &[f64], union: &[SurfaceArea<f64>]) -> Resistance {
    let widths = |axis: usize| grid.edges(axis).windows(2).map(|e| e[1] - e[0]).collect::<Vec<_>>();
    let [x, y, z] = [0, 1, 2].map(widths);
    let mut found = Resistance::default();
    let mut cells = open.iter().zip(union);
    for dz in &z {
        for dy in &y {
            for (dx, (&open, area)) in x.iter().zip(&mut cells) {
                let area = area.times((dx * dy * dz).recip());
                let length = |share: f64| if area.wetted > 0.0 { 4.0 * share / area.wetted } else { 0.0 };
                found.a.iter_mut().zip(area.frontal).for_each(|(a, f)| a.push(f));
                found.s.push(area.wetted);
                found.d_h.push(length(open));
                // What rounding leaves of a solid has no size.
                found.l_obs.push(if 1.0 - open > ROUNDING { length(1.0 - open) } else { 0.0 });
            }
        }
    }
    found
}
