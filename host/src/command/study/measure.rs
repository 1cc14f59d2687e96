//! The runs of a study, each with its time and its distance from the reference.

use super::case::{ProbeCell, Recipe, StudyCase, Subject};
use crate::command::cli::SceneArgs;
use crate::command::progress::Progress;
use crate::command::stages;
use crate::error::{Error, Result};
use crate::geometry::bodies::Bodies;
use crate::geometry::scene::{Scene, load};
use crate::grid::Edges;
use crate::porosity::{self, FieldSet, Leaf, Method, Options, Porosity};
use std::path::Path;
use std::time::Instant;

/// One line of the table.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// The scene.
    pub scene: String,
    /// Its bodies.
    pub bodies: usize,
    /// The grid's cells.
    pub cells: [usize; 3],
    /// The method.
    pub method: String,
    /// Number of threads.
    pub threads: usize,
    /// Median time of the computation alone.
    pub seconds: f64,
    /// Shortest time.
    pub fastest: f64,
    /// Solid volume found, in m³.
    pub volume: f64,
    /// What it should be, if that is known.
    pub exact: Option<f64>,
    /// Relative error of the solid volume.
    pub error: Option<f64>,
    /// Largest error of a cell, if there is a reference.
    pub cell_error: Option<f64>,
    /// Largest error of a face.
    pub face_error: Option<f64>,
    /// Largest distance of certified bounds.
    pub gap: f64,
    /// Porosity found and expected in a cell.
    pub probe: Option<[f64; 2]>,
}

/// The reference by the surface: unions as exactly as they are found.
const REFERENCE: Options =
    Options { tol: 0.0, depth: 6, bounds: false, areas: true, method: Method::Surface, leaf: Leaf::Plane };

/// Run all; `row_done` is called after each.
///
/// # Errors
/// A scene that cannot be read, or that a method cannot measure.
pub fn all(
    path: &Path,
    case: &StudyCase,
    progress: &mut Progress,
    row_done: impl Fn(&Progress, &Row),
) -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    for subject in &case.subjects {
        let bodies = bodies(path, subject, progress)?;
        for grid in &case.grids {
            let reference = reference(&bodies, grid, case.areas)?;
            for recipe in &case.recipes {
                if let (Method::Surface, Err(why)) = (recipe.options.method, stages::need_surfaces(&bodies)) {
                    progress.warn(format!("method \"{}\" is left out: {why}", recipe.name));
                    continue;
                }
                for &threads in &case.threads {
                    let run = run(case, subject, &bodies, grid, recipe, threads, reference.as_ref())?;
                    row_done(progress, &run);
                    rows.push(run);
                }
            }
        }
    }
    Ok(rows)
}

/// The bodies of a scene of the case file at `path`.
///
/// # Errors
/// As [`stages::load`].
pub fn bodies(path: &Path, subject: &Subject, progress: &mut Progress) -> Result<Bodies> {
    let args = SceneArgs { scene: subject.files.clone(), unit: None };
    let (mut bodies, _) = stages::load(&args, progress)?;
    let own = Scene { path: path.to_owned(), solids: subject.solids.clone(), grid: None };
    let said = bodies.warnings.len();
    load::add(&own, &mut bodies)?;
    bodies.warnings[said..].iter().for_each(|w| progress.warn(w.as_str()));
    Ok(bodies)
}

fn reference(bodies: &Bodies, edges: &Edges, areas: bool) -> Result<Option<Porosity>> {
    if stages::need_surfaces(bodies).is_err() {
        return Ok(None);
    }
    let grid = edges.grid(None)?;
    Ok(Some(porosity::porosity(&grid, bodies, Options { areas, ..REFERENCE })))
}

fn run(
    case: &StudyCase,
    subject: &Subject,
    bodies: &Bodies,
    edges: &Edges,
    recipe: &Recipe,
    threads: usize,
    reference: Option<&Porosity>,
) -> Result<Row> {
    let grid = edges.grid(None)?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|e| Error::new(format!("cannot start {threads} threads: {e}")))?;
    let (mut seconds, mut result) = (Vec::new(), Porosity::default());
    for _ in 0..case.repeats {
        let begin = Instant::now();
        result = pool.install(|| porosity::porosity(&grid, bodies, recipe.options));
        seconds.push(begin.elapsed().as_secs_f64());
    }
    seconds.sort_by(f64::total_cmp);
    let exact = subject.exact.or_else(|| reference.map(|r| r.solid_volume));
    let beta = |probe: ProbeCell| {
        let ([nx, ny, _], [i, j, k]) = (edges.cells(), probe.cell);
        [result.beta.v[(k * ny + j) * nx + i], probe.beta_v]
    };
    Ok(Row {
        scene: subject.name.clone(),
        bodies: bodies.bodies.len(),
        cells: edges.cells(),
        method: recipe.name.clone(),
        threads,
        seconds: seconds[seconds.len() / 2],
        fastest: seconds[0],
        volume: result.solid_volume,
        exact,
        error: exact.filter(|&e| e > 0.0).map(|e| result.solid_volume / e - 1.0),
        cell_error: reference.map(|r| largest(&r.beta.v, &result.beta.v)),
        face_error: reference.filter(|_| case.areas).map(|r| faces(&r.beta, &result.beta)),
        gap: result.max_gap,
        probe: subject.probe.map(beta),
    })
}

fn largest(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |worst, (a, b)| (a - b).abs().max(worst))
}

fn faces(a: &FieldSet, b: &FieldSet) -> f64 {
    largest(&a.x, &b.x).max(largest(&a.y, &b.y)).max(largest(&a.z, &b.z))
}
