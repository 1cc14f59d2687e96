//! What is known of one point: a scene on a grid by one way to compute, on some threads.

use super::spread::Spread;
use serde::{Deserialize, Serialize};

/// A point of a study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// The scene.
    pub scene: String,
    /// Its bodies.
    pub bodies: usize,
    /// Their triangles.
    pub triangles: usize,
    /// The grid's cells.
    pub cells: [usize; 3],
    /// The grid's name in tables, and among those of the study.
    pub grid: String,
    /// The method by the name of its table and of what varies.
    pub method: String,
    /// That name without depth and tolerance.
    pub family: String,
    /// `auto`, `surface` or `gjk`.
    pub road: String,
    /// `solid`, `half` or `plane`.
    pub leaf: String,
    /// As asked for.
    pub depth: u32,
    /// As asked for.
    pub tol: f64,
    /// `f64` or `f32`.
    pub precision: String,
    /// The paper's leaf at the paper's depth.
    pub paper: bool,
    /// Number of threads.
    pub threads: usize,
    /// How often it was run.
    pub repeats: usize,
    /// Times of the computation alone.
    pub seconds: Spread,
    /// Solid volume found, in m³.
    pub volume: f64,
    /// What it should be.
    pub exact: Truth,
    /// Relative error of the solid volume.
    pub error: Option<f64>,
    /// Errors of cells.
    pub cell: Option<Errors>,
    /// Errors of faces.
    pub face: Option<Errors>,
    /// What the errors of cells and faces are counted from, and how far apart its own bounds are at most.
    pub cells_from: Option<(String, f64)>,
    /// Largest distance of certified bounds.
    pub gap: f64,
    /// Porosity found and expected in a cell.
    pub probe: Option<[f64; 2]>,
    /// No other point of the scene on this grid takes less time and errs less.
    pub front: bool,
}

/// A solid volume to compare with.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Truth {
    /// The volume in m³, if it is known.
    pub volume: Option<f64>,
    /// Where it comes from.
    pub from: String,
    /// How far it may be off, as a share of it.
    pub uncertainty: f64,
}

/// Differences from a reference.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Errors {
    /// The largest.
    pub largest: f64,
    /// The mean over those that are cut in the reference, or differ from it.
    pub mean: f64,
}

impl Errors {
    /// Of some values from what they should be.
    pub fn of<'a>(pairs: impl Iterator<Item = (&'a f64, &'a f64)>) -> Self {
        let (mut largest, mut sum, mut count) = (0.0_f64, 0.0, 0_usize);
        for (is, should) in pairs {
            let error = (is - should).abs();
            if error > 0.0 || (*should > 0.0 && *should < 1.0) {
                (largest, sum, count) = (largest.max(error), sum + error, count + 1);
            }
        }
        Errors { largest, mean: if count > 0 { sum / count as f64 } else { 0.0 } }
    }

    /// Of two lists together.
    #[must_use]
    pub fn worst(self, other: Self) -> Self {
        Errors { largest: self.largest.max(other.largest), mean: self.mean.max(other.mean) }
    }
}

/// Marks the points that no other of the same scene, grid and number of threads beats in both time and error. What errs by less than
/// rounding, [`ROUNDING`], errs equally.
pub fn mark_fronts(rows: &mut [Row]) {
    let value = |row: &Row| row.error.map(|e| [row.seconds.median, e.abs().max(ROUNDING)]);
    let place = |row: &Row| (row.scene.clone(), row.grid.clone(), row.threads);
    let all: Vec<_> = rows.iter().map(|row| (place(row), value(row))).collect();
    for (n, row) in rows.iter_mut().enumerate() {
        let (here, Some(own)) = &all[n] else { continue };
        row.front = !all.iter().any(|(there, other)| {
            there == here && other.is_some_and(|o| o[0] <= own[0] && o[1] <= own[1] && (o[0] < own[0] || o[1] < own[1]))
        });
    }
}

/// Unions whose proof is found are exact to this; closed forms and single bodies to less.
pub const EXACT: f64 = 1e-9;

/// Relative errors of a volume below this are those of sums in double precision.
pub const ROUNDING: f64 = 1e-13;
