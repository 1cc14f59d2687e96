//! How the time grows: generated scenes with more and more cells, triangles, bodies, overlaps, or on more and more threads.

use super::session::Session;
use super::spread::{Spread, slope, timed};
use super::table::{Cell, Listing, Reading, readable};
use super::values::{choice, many, some, unique, word};
use crate::command::stages::{self, room_for};
use crate::error::{Error, Result};
use crate::geometry::bodies::Bodies;
use crate::geometry::mesh::Mesh;
use crate::geometry::scene::table::StrictTable;
use crate::grid::Edges;
use crate::picture::panels::{Line, Mark, Panel, Panels};
use crate::porosity::{self, Options};
use crate::words::either;
use clap::ValueEnum;
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// What grows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Along {
    /// Cells along each axis of the grid, around one ball.
    Cells,
    /// Triangles of one ball.
    Triangles,
    /// Balls that are apart.
    Bodies,
    /// Balls of a lattice, each of which overlaps its neighbours.
    Overlaps,
    /// Threads.
    Threads,
}

/// A table `[[scaling]]`.
#[derive(Debug, Clone)]
pub struct ScalingRecipe {
    /// Its name.
    pub name: String,
    /// What grows.
    pub along: Along,
    /// How far, step by step.
    pub counts: Vec<usize>,
}

/// A step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ScalingRow {
    /// By its table.
    pub scaling: String,
    /// What grows.
    pub along: String,
    /// How many there are of it: cells in all, triangles, bodies, pairs that overlap, threads.
    pub count: usize,
    /// Cells in all.
    pub cells: usize,
    /// Triangles.
    pub triangles: usize,
    /// Bodies.
    pub bodies: usize,
    /// Threads.
    pub threads: usize,
    /// How often it was run.
    pub repeats: usize,
    /// Times of the porosity of all cells and faces.
    pub seconds: Spread,
}

/// Cells along each axis where their number does not grow, and rings of triangles of a ball.
const CELLS: usize = 64;
const RINGS: usize = 6;

/// The recipe of a table.
///
/// # Errors
/// A value that is none.
pub fn scaling_recipe(mut keys: StrictTable) -> Result<ScalingRecipe> {
    let along = keys.need("along", choice::<Along>)?;
    let given = keys.has("name");
    let name = keys.named()?;
    let name = if given { name } else { word(along) };
    let counts = keys.need("counts", some(many))?;
    keys.finish()?;
    let most = match along {
        Along::Cells => 1000,
        Along::Triangles => 10_000_000,
        Along::Bodies | Along::Overlaps => 100_000,
        Along::Threads => 1024,
    };
    if let Some(n) = counts.iter().find(|n| **n > most) {
        return Err(keys.wrong("counts", format!("must be at most {most} along {}, not {n}", word(along))));
    }
    if along == Along::Cells {
        let cells = counts.iter().copied().max().unwrap_or(0).saturating_pow(3);
        room_for(cells.saturating_mul(BYTES_A_CELL)).map_err(|e| keys.wrong("counts", e.reason))?;
    }
    Ok(ScalingRecipe { name, along, counts })
}

/// Bytes that the porosities of a cell and its faces take.
const BYTES_A_CELL: usize = 4 * size_of::<f64>();

impl ScalingRecipe {
    /// What its steps cost, roughly, in units of cells.
    #[must_use]
    pub fn cost(&self, count: usize, repeats: usize) -> f64 {
        let n = count as f64;
        let cells = if self.along == Along::Cells { n.powi(3) } else { (CELLS as f64).powi(3) };
        let more = match self.along {
            Along::Triangles => n,
            Along::Bodies => 300.0 * n,
            Along::Overlaps => 3000.0 * n,
            Along::Cells | Along::Threads => 0.0,
        };
        (cells + more) * repeats as f64
    }
}

/// Runs all steps.
///
/// # Errors
/// A scene that does not work.
pub fn all(recipes: &[ScalingRecipe], repeats: usize, session: &mut Session) -> Result<Vec<ScalingRow>> {
    let mut rows = Vec::new();
    for recipe in recipes {
        for &count in &recipe.counts {
            let key = format!("scaling | {} | {count}", recipe.name);
            let measure = |_: &mut _| run(recipe, count, repeats);
            rows.push(session.point(&key, recipe.cost(count, repeats), measure, line)?);
        }
    }
    Ok(rows)
}

fn run(recipe: &ScalingRecipe, count: usize, repeats: usize) -> Result<ScalingRow> {
    let along = recipe.along;
    let cells = if along == Along::Cells { count } else { CELLS };
    let threads = if along == Along::Threads { count } else { 1 };
    let (bodies, pairs) = match along {
        Along::Cells => lattice(1, 0.4, 2 * RINGS)?,
        Along::Triangles => lattice(1, 0.4, (0.5 + (count as f64 / 4.0).sqrt()).round() as usize)?,
        Along::Bodies => lattice(count, 0.4, RINGS)?,
        Along::Overlaps => lattice(count, 0.6, RINGS)?,
        Along::Threads => lattice(27, 0.6, 2 * RINGS)?,
    };
    let edges = Edges::cube(0.0, 1.0, cells);
    let grid = edges.grid(None)?;
    let pool = stages::threads(Some(u16::try_from(threads).map_err(|e| Error::new(format!("threads: {e}")))?))?;
    let ((), seconds) = timed(repeats, || {
        std::hint::black_box(pool.install(|| porosity::porosity(&grid, &bodies, Options::default())));
        Ok(())
    })?;
    let counted = match along {
        Along::Cells => grid.cell_count(),
        Along::Triangles => bodies.triangles.len(),
        Along::Bodies => bodies.bodies.len(),
        Along::Overlaps => pairs,
        Along::Threads => threads,
    };
    Ok(ScalingRow {
        scaling: recipe.name.clone(),
        along: word(along),
        count: counted,
        cells: grid.cell_count(),
        triangles: bodies.triangles.len(),
        bodies: bodies.bodies.len(),
        threads,
        repeats,
        seconds,
    })
}

/// Balls in a cubic lattice that fills the cube from 0 to 1, their radius as a share of the lattice's step, and how many pairs of neighbours overlap.
fn lattice(count: usize, radius: f64, rings: usize) -> Result<(Bodies, usize)> {
    let side = (1..).find(|m: &usize| m.pow(3) >= count).unwrap_or(1);
    let step = 1.0 / side as f64;
    let (mut bodies, mut pairs) = (Bodies::default(), 0);
    for n in 0..count {
        let at = [n % side, n / side % side, n / (side * side)];
        let centre = DVec3::from_array(at.map(|i| (i as f64 + 0.5) * step));
        bodies.add(&Mesh::from(ball(centre, radius * step, rings.max(2))), 1.0)?;
        let behind = [(0, 1), (1, side), (2, side * side)];
        pairs += behind.iter().filter(|(axis, stride)| at[*axis] + 1 < side && n + stride < count).count();
    }
    Ok((bodies, if radius > 0.5 { pairs } else { 0 }))
}

/// A ball of triangles in rings of latitude, outward: 4 rings (rings − 1) of them.
fn ball(centre: DVec3, radius: f64, rings: usize) -> Vec<[DVec3; 3]> {
    let segments = 2 * rings;
    let point = |ring: usize, segment: usize| {
        let (sin, cos) = (PI * ring as f64 / rings as f64).sin_cos();
        // The last point of a ring is the first, to the bit.
        let (y, x) = (TAU * (segment % segments) as f64 / segments as f64).sin_cos();
        let sin = if ring == 0 || ring == rings { 0.0 } else { sin };
        centre + radius * DVec3::new(sin * x, sin * y, cos)
    };
    let mut triangles = Vec::with_capacity(4 * rings * (rings - 1));
    for ring in 0..rings {
        for segment in 0..segments {
            let [a, b] = [point(ring, segment), point(ring, segment + 1)];
            let [c, d] = [point(ring + 1, segment), point(ring + 1, segment + 1)];
            if ring + 1 < rings {
                triangles.push([a, c, d]);
            }
            if ring > 0 {
                triangles.push([a, d, b]);
            }
        }
    }
    triangles
}

fn line(row: &ScalingRow) -> String {
    let seconds = readable(row.seconds.median, Reading::Seconds);
    format!(
        "scaling with {:<10} {:>10} {:>2} {:<7} {seconds:>9} s",
        row.along,
        row.count,
        row.threads,
        either(row.threads, "thread", "threads")
    )
}

/// The rows as a table.
#[must_use]
pub fn table(rows: &[ScalingRow]) -> Listing {
    let columns = [
        "scaling",
        "along",
        "count",
        "cells",
        "triangles",
        "bodies",
        "threads",
        "repeats",
        "seconds",
        "fastest",
        "slowest",
    ];
    let seen = |name: &str| !["along", "repeats"].contains(&name);
    let cells = |row: &ScalingRow| {
        vec![
            Cell::Text(row.scaling.clone()),
            Cell::Text(row.along.clone()),
            Cell::Whole(row.count),
            Cell::Whole(row.cells),
            Cell::Whole(row.triangles),
            Cell::Whole(row.bodies),
            Cell::Whole(row.threads),
            Cell::Whole(row.repeats),
            Cell::Number(row.seconds.median, Reading::Seconds),
            Cell::Number(row.seconds.fastest, Reading::Seconds),
            Cell::Number(row.seconds.slowest, Reading::Seconds),
        ]
    };
    Listing { columns: columns.map(|c| (c, seen(c))).to_vec(), rows: rows.iter().map(cells).collect() }
}

/// The exponent of a scaling: time goes as its power of the count; and its standard error.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Exponent {
    /// The scaling.
    pub scaling: String,
    /// What grows.
    pub along: String,
    /// By least squares in logarithms.
    pub exponent: f64,
    /// None for two steps.
    pub standard_error: Option<f64>,
}

/// The exponents of all scalings that have two steps.
#[must_use]
pub fn exponents(rows: &[ScalingRow]) -> Vec<Exponent> {
    let mut all: Vec<Exponent> = Vec::new();
    for row in rows {
        let own = rows.iter().filter(|r| r.scaling == row.scaling);
        let points: Vec<[f64; 2]> = own.map(|r| [r.count as f64, r.seconds.median]).collect();
        if all.iter().all(|e| e.scaling != row.scaling)
            && let Some((exponent, standard_error)) = slope(&points)
        {
            let (scaling, along) = (row.scaling.clone(), row.along.clone());
            all.push(Exponent { scaling, along, exponent, standard_error });
        }
    }
    all
}

/// A panel for each scaling.
#[must_use]
pub fn picture(title: &str, rows: &[ScalingRow]) -> Panels {
    let exponents = exponents(rows);
    let names = unique(rows.iter().map(|r| r.scaling.clone()));
    let panel = |name: &String| {
        let own = rows.iter().filter(|r| r.scaling == *name);
        let marks = own.map(|r| Mark {
            at: [r.count as f64, r.seconds.median],
            x_ends: None,
            y_ends: Some([r.seconds.fastest, r.seconds.slowest]).filter(|[a, b]| a < b),
            ..Mark::default()
        });
        let along = rows.iter().find(|r| r.scaling == *name).map_or("", |r| r.along.as_str());
        let slopes =
            exponents.iter().filter(|e| e.scaling == *name).map(|e| (0, with_error(e.exponent, e.standard_error)));
        Panel {
            title: name.clone(),
            x: Some(format!("number of {}", if along == "overlaps" { "pairs that overlap" } else { along })),
            lines: vec![Line { series: 0, marks: marks.collect() }],
            slopes: slopes.collect(),
        }
    };
    Panels {
        title: format!("{title}{}run time as things grow", if title.is_empty() { "" } else { ": " }),
        x: "number".into(),
        y: "run time, s".into(),
        series: vec!["median of all cells and faces, method auto".into()],
        panels: names.iter().map(panel).collect(),
        own_x: true,
        bar: "fastest to slowest run".into(),
        slopes: "exponent".into(),
        ..Panels::default()
    }
}

/// A fitted number and its standard error.
#[must_use]
pub fn with_error(value: f64, error: Option<f64>) -> String {
    let error = error.map_or_else(String::new, |e| format!(" ± {e:.2}"));
    format!("{value:.2}{error}").replace('-', "−")
}
