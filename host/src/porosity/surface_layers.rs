//! The surface in the cells of layers, found on the way to their porosity and finished when all faces are known.

use super::fields::FieldSet;
use super::road::Road;
use super::shadows::Shadows;
use super::solid_layers::SolidLayers;
use super::surface_fields::SurfaceFields;
use super::targets::targets;
use super::worker::{Summary, WantedOfLayer, Workers};
use super::{Options, curved_cells};
use crate::geometry::bodies::Bodies;
use glam::DVec3;
use rayon::prelude::*;
use std::sync::Arc;
use voidage_core::grid::Grid;
use voidage_core::surface::layer::Layers;
use voidage_core::surface::surface_area::SurfaceArea;

/// Of bodies in layers, whose open fractions are known otherwise.
#[must_use]
pub fn of_layers(
    grid: &Grid<f64>,
    SolidLayers { bodies, layers, facet_error }: &SolidLayers,
    options: Options,
    beta: &FieldSet,
) -> SurfaceFields {
    let mut own = FieldSet::new(grid, true);
    let (workers, road) = (Workers::new(), Road::new(Vec::new(), options));
    let mut summaries: Vec<Summary> = targets(grid, &mut own, None, WantedOfLayer::Surface)
        .into_par_iter()
        .enumerate()
        .map(|(k, target)| workers.layer(grid, layers, &road, k, target))
        .collect();
    let change = curved_cells::measure(grid, bodies, &mut summaries);
    let found = finish(grid, (bodies, layers), beta, &mut summaries);
    SurfaceFields { sum: found.sum.plus(change), facet_error: *facet_error, ..found }
}

/// From the surface that layers have, now that all faces are known.
#[must_use]
pub fn finish(
    grid: &Grid<f64>,
    (bodies, layers): (&Bodies, &Layers<DVec3>),
    beta: &FieldSet,
    summaries: &mut [Summary],
) -> SurfaceFields {
    summaries.par_iter_mut().enumerate().for_each(|(k, summary)| {
        let (open, kept) = (beta.open_layer(grid, k), &mut summary.kept);
        layers.finish_areas(k, &open, &kept.sides, &mut kept.cells).expect("slices of a layer fit its grid");
    });
    let known: Vec<_> = summaries.iter().map(|summary| summary.kept.known()).collect();
    let shadows = Arc::new(Shadows::of_layers(grid, (bodies, layers), beta, &known));
    let reports = summaries.iter().map(|summary| summary.areas);
    SurfaceFields {
        // In the order of layers, so that the bits do not depend on the number of threads.
        sum: reports.clone().fold(SurfaceArea::default(), |sum, r| sum.plus(r.sum)),
        unproved: reports.clone().map(|r| r.unproved).sum(),
        max_doubt: reports.fold(0.0, |most, r| r.max_doubt.max(most)),
        facet_error: 0.0,
        areas: areas(grid, summaries),
        shadows,
    }
}

/// The areas of all cells with surface.
fn areas(grid: &Grid<f64>, summaries: &[Summary]) -> Vec<(usize, SurfaceArea<f64>)> {
    let [nx, ny, _] = grid.cells();
    let of_layer = |(k, summary): (usize, &Summary)| {
        summary.kept.cells.iter().map(move |own| (k * nx * ny + own.cell as usize, own.area)).collect::<Vec<_>>()
    };
    summaries.iter().enumerate().flat_map(of_layer).collect()
}
