//! Drag that all but stops the gas within one cell.

use super::state::centre;
use crate::command::progress::Progress;
use crate::flow::Flow;
use crate::grid::Edges;
use crate::words::counted;

/// Up to this loss in one cell, in dynamic pressures of the gas in its pores, what passes a plug one cell thick errs by less than a tenth under a
/// difference of 1 kPa.
const MOST: f64 = 100.0;

/// Warns of cells with more. A linear coefficient counts as what it takes from a stream as fast as sound.
pub fn warn<const D: usize>(flow: &Flow<f64, D>, live: [usize; D], edges: &Edges, progress: &mut Progress) {
    let coefficients: Vec<&[f64]> = flow.drag().collect();
    if coefficients.is_empty() {
        return;
    }
    let widths = live.map(|axis| edges.widths(axis));
    let (mut count, mut largest, mut place) = (0, MOST, 0);
    for cell in 0..flow.len() {
        let (at, w) = (flow.coordinates(cell), flow.get(cell));
        let sound = (flow.gas_at(cell).gamma() * w.pressure / w.density).sqrt();
        // Quadratic ones of each axis, then linear ones.
        let lost = |(n, all): (usize, &&[f64])| {
            let c = all.get(cell).copied().unwrap_or(0.0) * widths[n % D][at[n % D]];
            if n < D { c } else { 2.0 * c / sound }
        };
        let most = coefficients.iter().enumerate().map(lost).fold(0.0, f64::max);
        count += usize::from(most > MOST);
        if most > largest {
            (largest, place) = (most, cell);
        }
    }
    if count > 0 {
        let [x, y, z] = centre(edges, place).map(|x| x as f32);
        progress.warn(format!(
            "drag: {} more than {MOST} dynamic pressures from a stream, the one at ({x}, {y}, {z}) m {largest:.3e}: through few such cells more gas passes \
             than should; what gas cannot pass should be solid",
            counted(count, "cell takes", "cells take"),
        ));
    }
}
