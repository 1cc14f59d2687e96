//! Fields cut into layers, each for one thread to write.

use super::fields::FieldSet;
use super::worker::{Target, WantedOfLayer};
use voidage_core::grid::Grid;

/// Where each layer writes, and what.
pub fn targets<'a>(
    grid: &Grid<f64>,
    beta: &'a mut FieldSet,
    bounds: Option<&'a mut [FieldSet; 2]>,
    wanted: WantedOfLayer,
) -> Vec<Target<'a>> {
    let target = |beta| Target { beta, bounds: None, wanted };
    let mut targets: Vec<Target> = beta.layers(grid).into_iter().map(target).collect();
    if let Some([low, high]) = bounds {
        for (target, (low, high)) in targets.iter_mut().zip(low.layers(grid).into_iter().zip(high.layers(grid))) {
            target.bounds = Some([low, high]);
        }
    }
    targets
}
