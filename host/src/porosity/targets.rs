//! Fields cut into layers, each for one thread to write.

use super::fields::FieldSet;
use super::layers::Target;
use voidage_core::grid::Grid;

/// Where each layer writes.
pub fn targets<'a>(grid: &Grid<f64>, beta: &'a mut FieldSet, bounds: Option<&'a mut [FieldSet; 2]>) -> Vec<Target<'a>> {
    let beta = beta.layers(grid);
    match bounds {
        None => beta.into_iter().map(|beta| Target { beta, bounds: None }).collect(),
        Some([low, high]) => {
            let bounds = low.layers(grid).into_iter().zip(high.layers(grid));
            beta.into_iter().zip(bounds).map(|(beta, (l, h))| Target { beta, bounds: Some([l, h]) }).collect()
        }
    }
}
