//! Drag that all but stops the gas within one cell.

use super::arrays;
use super::coarse::is_resolved;
use super::state::centre;
use crate::command::progress::Progress;
use crate::flow::Flow;
use crate::geometry::bodies::{Bodies, Body};
use crate::grid::Edges;
use crate::picture::ticks::number;
use crate::words::counted;
use glam::DVec3;

/// Up to this loss in one cell, in dynamic pressures of the gas in its pores, what passes a plug one cell thick errs by less than a tenth under a
/// difference of 1 kPa.
const MOST: f64 = 100.0;

/// Warns of cells with more. A linear coefficient counts as what it takes from a stream as fast as sound. `bodies` are those whose drag a law gives, if one does.
pub fn warn<const D: usize>(
    flow: &Flow<f64, D>,
    live: [usize; D],
    edges: &Edges,
    bodies: Option<&Bodies>,
    progress: &mut Progress,
) {
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
            "drag: {} more than {MOST} dynamic pressures from a stream, the one at ({x}, {y}, {z}) m {}: through few such cells more gas passes \
             than should; what gas cannot pass should be solid{}",
            counted(count, "cell takes", "cells take"),
            number(largest),
            bodies.and_then(|bodies| of_a_rim(bodies, (edges, &live), place)).unwrap_or_default()
        ));
    }
}

/// What is to be done if the law takes the rim of a solid body for obstacles; none if no tight body with a drag by the law, and many cells wide, comes near the cell `place`.
fn of_a_rim(bodies: &Bodies, (edges, live): (&Edges, &[usize]), place: usize) -> Option<String> {
    let at = arrays::index(place, edges.cells());
    let [low, high] = [0, 1].map(|end| DVec3::from_array([0, 1, 2].map(|axis| edges.0[axis][at[axis] + end])));
    let is_near = |body: &Body| body.bounds[0].cmple(high).all() && body.bounds[1].cmpge(low).all();
    let drags = |body: &Body| body.porosity == 0.0 && body.drag.cr.is_none() && body.drag.cd != Some(0.0);
    let found = |(_, body): &(usize, &Body)| drags(body) && is_near(body) && is_resolved(body, edges, live);
    let near: Vec<usize> = bodies.bodies.iter().enumerate().filter(found).map(|(n, _)| n).collect();
    let solid_of = |n: &usize| bodies.solids.iter().find(|solid| solid.bodies.contains(n)).map(|solid| &solid.name[..]);
    let name = near.first().and_then(solid_of).filter(|name| near.iter().all(|n| solid_of(n) == Some(name)));
    let there = name.map_or_else(String::new, |name| format!(" (there of \"{name}\")"));
    (!near.is_empty()).then(|| {
        format!(
            ". Where these cells are the rim of a solid body that many cells resolve{there}, the law counts that rim as obstacles: cd = 0 of that solid \
             in its scene takes the drag away"
        )
    })
}
