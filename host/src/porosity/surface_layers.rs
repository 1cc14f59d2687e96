//! The surface in the cells of layers, found on the way to their porosity and finished when all faces are known.

use super::fields::FieldSet;
use super::road::Road;
use super::shadows::Shadows;
use super::solid_layers::SolidLayers;
use super::surface_fields::SurfaceFields;
use super::targets::targets;
use super::worker::{Summary, Workers};
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
    let (mut own, mut areas) = (FieldSet::new(grid, true), no_areas(grid));
    let (workers, road) = (Workers::new(), Road::new(Vec::new(), options));
    let mut summaries: Vec<Summary> = targets(grid, &mut own, None, Some(&mut areas))
        .into_par_iter()
        .enumerate()
        .map(|(k, target)| workers.layer(grid, layers, &road, k, target))
        .collect();
    let change = curved_cells::measure(grid, bodies, &mut areas, &mut summaries);
    let found = finish(grid, (bodies, layers), beta, areas, &summaries);
    SurfaceFields { sum: found.sum.plus(change), facet_error: *facet_error, ..found }
}

/// From the areas that layers have given, now that all faces are known.
#[must_use]
pub fn finish(
    grid: &Grid<f64>,
    (bodies, layers): (&Bodies, &Layers<DVec3>),
    beta: &FieldSet,
    mut areas: Vec<SurfaceArea<f64>>,
    summaries: &[Summary],
) -> SurfaceFields {
    let [nx, ny, _] = grid.cells();
    areas.par_chunks_mut(nx * ny).zip(summaries).enumerate().for_each(|(k, (areas, summary))| {
        let open = beta.open_layer(grid, k);
        layers.finish_areas(k, &open, &summary.sides, areas).expect("slices of a layer fit its grid");
    });
    let known: Vec<_> = summaries.iter().map(|summary| (&summary.sides[..], summary.kept.pieces())).collect();
    let shadows = Arc::new(Shadows::of_layers(grid, (bodies, layers), beta, (&areas, &known)));
    let reports = summaries.iter().map(|summary| summary.areas);
    SurfaceFields {
        // In the order of layers, so that the bits do not depend on the number of threads.
        sum: reports.clone().fold(SurfaceArea::default(), |sum, r| sum.plus(r.sum)),
        unproved: reports.clone().map(|r| r.unproved).sum(),
        max_doubt: reports.fold(0.0, |most, r| r.max_doubt.max(most)),
        facet_error: 0.0,
        areas,
        shadows,
    }
}

/// Room for the areas of all cells.
#[must_use]
pub fn no_areas(grid: &Grid<f64>) -> Vec<SurfaceArea<f64>> {
    vec![SurfaceArea::default(); grid.cell_count()]
}
