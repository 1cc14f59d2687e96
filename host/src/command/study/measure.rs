//! The porosity of a study: every scene on every grid by every method, each with its time and its distance from the reference.

use super::case::{ProbeCell, StudyCase, Subject, cost};
use super::points;
use super::recipe::{Precision, Recipe};
use super::row::{EXACT, Errors, Row, Truth, mark_fronts};
use super::session::Session;
use super::single;
use super::spread::{Spread, timed};
use super::table::{Reading, readable};
use super::values::word;
use crate::command::cli::SceneArgs;
use crate::command::progress::Progress;
use crate::command::stages;
use crate::error::{Error, Result};
use crate::geometry::bodies::Bodies;
use crate::geometry::scene::{Scene, load};
use crate::grid::Edges;
use crate::porosity::{self, Leaf, Method, Options, Porosity};
use crate::words::counted;
use std::path::Path;

/// What other points are compared with.
struct Reference {
    found: Porosity,
    /// Its method.
    road: &'static str,
    /// How far apart the bounds of its cells are at most.
    gap: f64,
    /// How far its volume may be off, as a share of it.
    uncertainty: f64,
}

/// A scene on a grid.
struct Site<'a> {
    case: &'a StudyCase,
    subject: &'a Subject,
    bodies: &'a Bodies,
    edges: &'a Edges,
    /// Its name.
    grid: &'a str,
    reference: &'a Reference,
}

/// The reference by the surface: unions as exactly as they are found.
const SURFACE: Options = Options {
    tol: 0.0,
    depth: 6,
    bounds: true,
    areas: true,
    method: Method::Surface,
    leaf: Leaf::Plane,
    resistance: false,
};

/// The reference where solids have formulas and no surface: closed forms, and where they meet a finer tolerance than those it is compared with.
const FORMULA: Options = Options { tol: 1e-6, depth: 7, method: Method::Auto, ..SURFACE };

/// The bodies of all scenes of the case file at `path`.
///
/// # Errors
/// A scene that cannot be read.
pub fn scenes(path: &Path, case: &StudyCase, progress: &mut Progress) -> Result<Vec<Bodies>> {
    case.subjects.iter().map(|subject| bodies(path, subject, progress)).collect()
}

/// Run all; the bodies are those of [`scenes`].
///
/// # Errors
/// A scene that a method cannot measure.
pub fn all(case: &StudyCase, scenes: &[Bodies], session: &mut Session) -> Result<Vec<Row>> {
    let (grids, mut rows) = (case.grid_names(), Vec::new());
    for (subject, bodies) in case.subjects.iter().zip(scenes) {
        for (edges, grid) in case.grids.iter().zip(&grids) {
            on_grid(case, subject, bodies, (edges, grid), session, &mut rows)?;
        }
    }
    mark_fronts(&mut rows);
    Ok(rows)
}

/// All points of a scene on a grid.
fn on_grid(
    case: &StudyCase,
    subject: &Subject,
    bodies: &Bodies,
    (edges, grid): (&Edges, &str),
    session: &mut Session,
    rows: &mut Vec<Row>,
) -> Result<()> {
    let mut reference = None;
    // Once for grids in the same box.
    if case.grids.iter().find(|other| other.bounds() == edges.bounds()).is_some_and(|first| std::ptr::eq(first, edges))
    {
        stages::warn_if_outside(bodies, edges, [false; 3], &edges.grid(None)?, session.progress);
    }
    for recipe in &case.recipes {
        let cost = cost(edges, recipe, case.repeats);
        if let Err(why) = possible(bodies, recipe) {
            // The reason is that of the scene, on whatever grid.
            let said = format!("{}: method \"{}\" is left out: {why}", subject.name, recipe.name);
            if !session.progress.warnings.contains(&said) {
                session.progress.warn(said);
            }
            session.leave_out(case.threads.len(), cost * case.threads.len() as f64);
            continue;
        }
        for &threads in &case.threads {
            let key = format!("{} | {grid} | {} | {threads}", subject.name, recipe.name);
            if reference.is_none() && session.before::<Row>(&key).is_none() {
                let what = format!("reference of {} on {grid}", subject.name);
                let made = session.prepare(&what, || self::reference(bodies, edges, case.areas))?;
                doubt_exact(subject, &made, session);
                reference = Some(made);
            }
            let measure = |_: &mut Progress| {
                let reference = reference.as_ref().ok_or_else(|| Error::new("no reference"))?;
                Site { case, subject, bodies, edges, grid, reference }.run(recipe, threads)
            };
            rows.push(session.point(&key, cost, measure, points::line)?);
        }
    }
    Ok(())
}

/// Tells of an exact volume that is not what the scene holds by the reference and its bounds.
fn doubt_exact(subject: &Subject, reference: &Reference, session: &mut Session) {
    let Some(exact) = subject.exact else { return };
    let volume = reference.found.solid_volume;
    let off = (exact - volume).abs();
    if off <= reference.uncertainty * volume + EXACT * exact {
        return;
    }
    let said = format!(
        "{}: exact is {exact}, but the scene holds {} m³ in the grid (to within {:.0e}); errors of volumes are counted from exact all the same",
        subject.name,
        readable(volume, Reading::Volume),
        reference.uncertainty * volume + EXACT * exact,
    );
    if !session.progress.warnings.contains(&said) {
        session.progress.warn(said);
    }
}

/// The bodies of a scene of the case file at `path`.
///
/// # Errors
/// As [`stages::load`].
pub fn bodies(path: &Path, subject: &Subject, progress: &mut Progress) -> Result<Bodies> {
    let args = SceneArgs { scene: subject.files.clone(), unit: subject.unit };
    let (mut bodies, _) = stages::load(&args, progress)?;
    let own = Scene { path: path.to_owned(), solids: subject.solids.clone(), grid: None };
    let said = bodies.warnings.len();
    load::add(&own, &mut bodies)?;
    bodies.warnings[said..].iter().for_each(|w| progress.warn(w.as_str()));
    Ok(bodies)
}

/// A recipe can measure these bodies.
fn possible(bodies: &Bodies, recipe: &Recipe) -> Result<()> {
    if recipe.options.method == Method::Surface {
        stages::need_surfaces(bodies)?;
    }
    if recipe.options.method == Method::Gjk {
        stages::need_convex(bodies)?;
    }
    if recipe.precision == Precision::F32 { single::possible(bodies) } else { Ok(()) }
}

fn reference(bodies: &Bodies, edges: &Edges, areas: bool) -> Result<Reference> {
    let (options, road) = match stages::need_surfaces(bodies) {
        Ok(()) => (SURFACE, "surface"),
        Err(_) => (FORMULA, "auto"),
    };
    let grid = edges.grid(None)?;
    let mut found = porosity::porosity(&grid, bodies, Options { areas, ..options });
    // Solid of the lower bounds less that of the upper ones, halved: the value lies in the middle.
    let [nx, ny, _] = edges.cells();
    let widths = [0, 1, 2].map(|axis| edges.widths(axis));
    let volume = |cell: usize| {
        let at = [cell % nx, cell / nx % ny, cell / (nx * ny)];
        (0..3).map(|axis| widths[axis].get(at[axis]).copied().unwrap_or(0.0)).product::<f64>()
    };
    let (mut unsure, mut gap) = (0.0, 0.0_f64);
    if let Some([lower, upper]) = found.bounds.take() {
        for (cell, (low, high)) in lower.v.iter().zip(upper.v.iter()).enumerate().filter(|(_, (low, high))| high > low)
        {
            unsure += 0.5 * (high - low) * volume(cell);
            gap = gap.max(high - low);
        }
    }
    let uncertainty = if found.solid_volume > 0.0 { unsure / found.solid_volume } else { 0.0 };
    Ok(Reference { found, road, gap, uncertainty })
}

impl Site<'_> {
    fn run(&self, recipe: &Recipe, threads: usize) -> Result<Row> {
        let Site { case, subject, bodies, edges, .. } = *self;
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let pool =
            pool.map_err(|e| Error::new(format!("cannot start {}: {e}", counted(threads, "thread", "threads"))))?;
        let Options { method, leaf, depth, tol, .. } = recipe.options;
        let row = Row {
            scene: subject.name.clone(),
            bodies: bodies.bodies.len(),
            triangles: bodies.triangles.len(),
            cells: edges.cells(),
            grid: self.grid.to_owned(),
            method: recipe.name.clone(),
            family: recipe.family.clone(),
            road: word(method),
            leaf: word(leaf),
            depth,
            tol,
            precision: recipe.precision.name().to_owned(),
            paper: recipe.is_the_papers(),
            threads,
            repeats: case.repeats,
            seconds: Spread::default(),
            volume: 0.0,
            exact: self.truth(),
            error: None,
            cell: None,
            face: None,
            cells_from: None,
            gap: 0.0,
            probe: None,
            front: false,
        };
        let grid = edges.grid(None)?;
        let found = match recipe.precision {
            Precision::F64 => {
                let (found, seconds) =
                    timed(case.repeats, || Ok(pool.install(|| porosity::porosity(&grid, bodies, recipe.options))))?;
                let porosity::FieldSet { v, x, y, z } = &found.beta;
                self.judge(Row { seconds, volume: found.solid_volume, gap: found.max_gap, ..row }, [v, x, y, z])
            }
            Precision::F32 => {
                let run = || single::fields(bodies, edges, recipe.options, case.repeats);
                let (found, seconds) = pool.install(run)?;
                let fields = found.beta.map(|f| f.into_iter().map(f64::from).collect::<Vec<f64>>());
                let [v, x, y, z] = &fields;
                self.judge(Row { seconds, volume: found.volume, gap: found.gap, ..row }, [v, x, y, z])
            }
        };
        Ok(found)
    }

    /// The volume as it should be: as the case gives it, or that of the reference.
    fn truth(&self) -> Truth {
        let Reference { found, road, uncertainty, .. } = self.reference;
        match self.subject.exact {
            Some(volume) => Truth { volume: Some(volume), from: "given".to_owned(), uncertainty: 0.0 },
            None => Truth { volume: Some(found.solid_volume), from: (*road).to_owned(), uncertainty: *uncertainty },
        }
    }

    /// A row with its errors: of the volume, of cells, x, y and z faces.
    fn judge(&self, row: Row, [v, x, y, z]: [&[f64]; 4]) -> Row {
        let Reference { found, road, gap, .. } = self.reference;
        let own = row.road == *road || *road == "surface" && row.road == "auto";
        let same = own && row.precision == Precision::F64.name() && row.leaf == word(Leaf::Plane);
        let cell = Errors::of(v.iter().zip(found.beta.v.iter()));
        let mark = if same && cell.largest == 0.0 { " (itself)" } else { "" };
        let beta = |probe: ProbeCell| {
            let ([nx, ny, _], [i, j, k]) = (row.cells, probe.cell);
            [v.get((k * ny + j) * nx + i).copied().unwrap_or(f64::NAN), probe.beta_v]
        };
        let faces = [(x, &found.beta.x), (y, &found.beta.y), (z, &found.beta.z)];
        let faces = faces.map(|(is, should)| Errors::of(is.iter().zip(should.iter())));
        Row {
            error: row.exact.volume.filter(|&e| e > 0.0).map(|e| row.volume / e - 1.0),
            cell: Some(cell),
            face: self.case.areas.then(|| faces[0].worst(faces[1]).worst(faces[2])),
            cells_from: Some((format!("{road}{mark}"), *gap)),
            probe: self.subject.probe.map(beta),
            ..row
        }
    }
}
