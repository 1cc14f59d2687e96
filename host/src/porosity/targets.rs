//! Fields cut into layers, each for one thread to write.

use super::fields::FieldSet;
use super::worker::Target;
use voidage_core::grid::Grid;
use voidage_core::surface::surface_area::SurfaceArea;

/// Where each layer writes.
pub fn targets<'a>(
    grid: &Grid<f64>,
    beta: &'a mut FieldSet,
    bounds: Option<&'a mut [FieldSet; 2]>,
    areas: Option<&'a mut Vec<SurfaceArea<f64>>>,
) -> Vec<Target<'a>> {
    let [nx, ny, _] = grid.cells();
    let target = |beta| Target { beta, bounds: None, areas: None };
    let mut targets: Vec<Target> = beta.layers(grid).into_iter().map(target).collect();
    if let Some([low, high]) = bounds {
        for (target, (low, high)) in targets.iter_mut().zip(low.layers(grid).into_iter().zip(high.layers(grid))) {
            target.bounds = Some([low, high]);
        }
    }
    if let Some(areas) = areas {
        for (target, areas) in targets.iter_mut().zip(areas.chunks_exact_mut(nx * ny)) {
            target.areas = Some(areas);
        }
    }
    targets
}
