//! Porosity fields of bodies on a grid: the layers of [`voidage_core`] in threads, unions where bodies share cells.
//!
//! A layer of cells depends on no other, and what a thread writes depends only on the layer: the bits are the same for
//! any number of threads.

mod bins;
mod fields;
mod layers;
mod planes;
mod unions;
mod values;

use crate::bodies::Bodies;
use bins::Bins;
pub use fields::FieldSet;
use layers::{Summary, Target, Worker};
use rayon::prelude::*;
use serde::Serialize;
pub use values::Values;
use voidage_core::grid::Grid;

/// What to compute and how far to refine.
#[derive(Debug, Clone, Copy)]
pub struct Options {
    /// Unions are found exactly; where one has no proof, divide the cell until its bounds are this close.
    pub tol: f64,
    /// How often a cell whose union has no proof may be divided by 2 along each axis.
    pub depth: u32,
    /// Keep lower and upper bounds of all fields.
    pub bounds: bool,
    /// Compute the faces; without, their fields stay empty.
    pub areas: bool,
}

impl Default for Options {
    fn default() -> Self {
        Options { tol: 1e-4, depth: 6, bounds: false, areas: true }
    }
}

/// Cells by kind.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct CellCounts {
    /// No solid.
    pub open: usize,
    /// Partly solid, or with surface inside.
    pub cut: usize,
    /// All solid.
    pub closed: usize,
    /// Of the cut cells: shared by several bodies, so that their union had to be found.
    pub ambiguous: usize,
}

/// Where a body's surface fails to close.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Leak {
    /// The body.
    pub body: usize,
    /// How far the worst row ends from zero, as a fraction of a face.
    pub fraction: f64,
    /// Its layer of cells.
    pub layer: usize,
}

/// Porosities of a grid.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Porosity {
    /// Open fractions: 1 open, 0 blocked.
    pub beta: FieldSet,
    /// Lower and upper bounds of the same, if asked for.
    pub bounds: Option<[FieldSet; 2]>,
    /// Cells by kind.
    pub cells: CellCounts,
    /// Solid volume within the grid.
    pub solid_volume: f64,
    /// Largest distance of the bounds of any cell or face.
    pub max_gap: f64,
    /// Cells divided because their union had no proof at once.
    pub divided: usize,
    /// By how much a body's own share of a cell left 0..1: surface that crosses itself.
    pub winding: f64,
    /// Bodies whose rows did not return to zero, worst first, one entry a body.
    pub leaks: Vec<Leak>,
}

/// Bytes that the fields of a grid take, with what one thread needs beside them.
#[must_use]
pub fn memory(grid: &Grid<f64>, options: Options) -> usize {
    let faces = if options.areas { [0, 1, 2].map(|a| grid.face_shape(a).iter().product()).iter().sum() } else { 0 };
    let sets = if options.bounds { 3 } else { 1 };
    size_of::<f64>().saturating_mul(sets * (grid.cell_count() + faces) + Worker::needed(grid))
}

/// Porosities of `bodies` on `grid`; runs in the current rayon pool.
#[must_use]
pub fn porosity(grid: &Grid<f64>, bodies: &Bodies, options: Options) -> Porosity {
    porosity_watched(grid, bodies, options, &|| ())
}

/// As [`porosity`]; `layer_done` is called after each layer of cells, from any thread.
#[must_use]
pub fn porosity_watched(
    grid: &Grid<f64>,
    bodies: &Bodies,
    options: Options,
    layer_done: &(dyn Fn() + Sync),
) -> Porosity {
    let moved = planes::into_planes(grid, &bodies.triangles);
    let bins = Bins::new(grid, bodies, moved.as_deref().unwrap_or(&bodies.triangles));
    let mut beta = FieldSet::new(grid, options.areas);
    let mut bounds = options.bounds.then(|| [FieldSet::new(grid, options.areas), FieldSet::new(grid, options.areas)]);
    let summaries: Vec<Summary> = targets(grid, &mut beta, bounds.as_mut())
        .into_par_iter()
        .enumerate()
        .map_init(
            || Worker::new(grid, options),
            |worker, (k, target)| {
                let summary = worker.layer(grid, &bins, k, target);
                layer_done();
                summary
            },
        )
        .collect();
    let total = summaries.iter().fold(Summary::default(), Summary::join);
    Porosity {
        beta,
        bounds,
        cells: total.cells,
        solid_volume: total.volume,
        max_gap: total.max_gap,
        divided: total.divided,
        winding: total.winding,
        leaks: worst_leaks(bodies.bodies.len(), &summaries),
    }
}

/// Where each layer writes.
fn targets<'a>(grid: &Grid<f64>, beta: &'a mut FieldSet, bounds: Option<&'a mut [FieldSet; 2]>) -> Vec<Target<'a>> {
    let beta = beta.layers(grid);
    match bounds {
        None => beta.into_iter().map(|beta| Target { beta, bounds: None }).collect(),
        Some([low, high]) => {
            let bounds = low.layers(grid).into_iter().zip(high.layers(grid));
            beta.into_iter().zip(bounds).map(|(beta, (l, h))| Target { beta, bounds: Some([l, h]) }).collect()
        }
    }
}

fn worst_leaks(bodies: usize, summaries: &[Summary]) -> Vec<Leak> {
    let mut worst: Vec<Option<Leak>> = vec![None; bodies];
    for (layer, summary) in summaries.iter().enumerate() {
        for &(body, fraction) in &summary.leaks {
            let body = body as usize;
            if worst[body].is_none_or(|l| l.fraction < fraction) {
                worst[body] = Some(Leak { body, fraction, layer });
            }
        }
    }
    let mut leaks: Vec<Leak> = worst.into_iter().flatten().collect();
    leaks.sort_by(|a, b| b.fraction.total_cmp(&a.fraction).then(a.body.cmp(&b.body)));
    leaks
}
