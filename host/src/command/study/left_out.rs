//! What a run leaves out, and what that saves: measured by switching it on.

use super::case::{StudyCase, joined};
use super::session::Session;
use super::spread::{Spread, timed};
use super::table::{Cell, Listing, Reading, readable};
use crate::command::stages;
use crate::error::{Error, Result};
use crate::flow::{Flow, Treatment};
use crate::geometry::bodies::Bodies;
use crate::grid::Edges;
use crate::porosity::{Options, porosity, resistance};
use serde::{Deserialize, Serialize};
use voidage_core::flow::{Boundary, Gas, Primitive};

/// Something that is left out where nobody asks for it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LeftOutRow {
    /// The scene, or the flow.
    pub scene: String,
    /// Cells along x, y, z.
    pub cells: [usize; 3],
    /// What is left out.
    pub what: String,
    /// Times without it.
    pub without: Spread,
    /// Times with it.
    pub with: Spread,
}

/// What can be left out of the porosity of a scene, in the order in which it is switched on.
const OF_SCENES: [&str; 3] = ["faces", "certified bounds", "surface in cells (for drag)"];

/// What can be left out of a flow.
const OF_FLOWS: [&str; 4] =
    ["open fractions of an empty space", "energy of an isothermal gas", "an axis of one cell", "drag of nothing"];

/// Points, and what they cost.
#[must_use]
pub fn plan(case: &StudyCase) -> (usize, f64) {
    if !case.left_out {
        return (0, 0.0);
    }
    let finest = finest(case).map_or(0.0, |g| g.cells().iter().map(|&n| n as f64).product());
    let scenes = (case.subjects.len() * OF_SCENES.len()) as f64;
    let flows = if case.flows.is_empty() { 0 } else { OF_FLOWS.len() };
    let cost = 3.0 * finest * scenes + 1e6 * flows as f64;
    (case.subjects.len() * OF_SCENES.len() + flows, cost * case.repeats as f64)
}

fn finest(case: &StudyCase) -> Option<&Edges> {
    let count = |grid: &&Edges| grid.cells().iter().product::<usize>();
    case.grids.iter().max_by_key(count)
}

/// Measures all, each scene on the finest grid, on one thread.
///
/// # Errors
/// A grid that is none.
pub fn all(case: &StudyCase, scenes: &[Bodies], session: &mut Session) -> Result<Vec<LeftOutRow>> {
    let mut rows = Vec::new();
    if !case.left_out {
        return Ok(rows);
    }
    let (points, cost) = plan(case);
    let each = cost / points.max(1) as f64;
    if let Some(edges) = finest(case) {
        for (subject, bodies) in case.subjects.iter().zip(scenes) {
            for (n, what) in OF_SCENES.iter().enumerate() {
                let key = format!("left out | {} | {what}", subject.name);
                let measure = |_: &mut _| of_scene(&subject.name, n, bodies, edges, case.repeats);
                rows.push(session.point(&key, each, measure, line)?);
            }
        }
    }
    for what in OF_FLOWS.iter().filter(|_| !case.flows.is_empty()) {
        let measure = |_: &mut _| of_flow(what, case.repeats);
        rows.push(session.point(&format!("left out of flow | {what}"), each, measure, line)?);
    }
    Ok(rows)
}

fn of_scene(scene: &str, n: usize, bodies: &Bodies, edges: &Edges, repeats: usize) -> Result<LeftOutRow> {
    let grid = edges.grid(None)?;
    let pool = stages::threads(Some(1))?;
    let run = |areas: bool, bounds: bool, surface: bool| {
        let options = Options { areas, bounds, resistance: surface, ..Options::default() };
        let (_, seconds) = timed(repeats, || {
            pool.install(|| {
                let found = porosity(&grid, bodies, options);
                if surface {
                    std::hint::black_box(resistance::resistance(&grid, bodies, &found, options));
                }
                std::hint::black_box(found);
            });
            Ok(())
        })?;
        Ok::<Spread, Error>(seconds)
    };
    let [areas, bounds, surface] = [n == 0, n == 1, n == 2];
    let without = run(n > 0, false, false)?;
    let with = run(n > 0 || areas, bounds, surface)?;
    let what = OF_SCENES.get(n).copied().unwrap_or_default().to_owned();
    Ok(LeftOutRow { scene: scene.to_owned(), cells: edges.cells(), what, without, with })
}

/// Cells along an axis of the flows, and steps of each run.
const SIDE: usize = 48;
const STEPS: usize = 20;

/// A gentle wave in a periodic box.
fn wave<const D: usize>(cells: [usize; D], gas: Gas<f64>) -> Flow<f64, D> {
    let mut flow: Flow<f64, D> = Flow::uniform(cells, [1.0 / SIDE as f64; D], gas, [[Boundary::Periodic; 2]; D]);
    flow.fill(|x| {
        let density = 1.0 + 0.1 * (std::f64::consts::TAU * (x[0] + x[1])).sin();
        Primitive { density, velocity: [0.1; D], pressure: density }
    });
    flow
}

/// An error of the core as one of the study.
fn refused(error: voidage_core::flow::Error) -> Error {
    Error::new(format!("the flow: {error}"))
}

/// Times of some steps, without the first, which makes memory ready.
fn steps<const D: usize>(mut flow: Flow<f64, D>, repeats: usize) -> Result<Spread> {
    flow.advance(0.5, f64::MAX).map_err(refused)?;
    let (_, seconds) =
        timed(repeats, || (0..STEPS).try_for_each(|_| flow.advance(0.5, f64::MAX).map(drop)).map_err(refused))?;
    Ok(seconds)
}

fn of_flow(what: &str, repeats: usize) -> Result<LeftOutRow> {
    let ideal = Gas::Ideal { gamma: 1.4 };
    let pool = stages::threads(Some(1))?;
    let box_ = [SIDE; 3];
    let measure = || -> Result<([usize; 3], Spread, Spread)> {
        let plain = || steps(wave(box_, ideal), repeats);
        Ok(match OF_FLOWS.iter().position(|w| *w == what) {
            Some(0) => {
                let mut open = wave(box_, ideal);
                let faces = || vec![1.0; SIDE * SIDE * (SIDE + 1)];
                let volume = vec![1.0; SIDE * SIDE * SIDE];
                open.set_porosity(volume, [faces(), faces(), faces()], Treatment::default()).map_err(refused)?;
                (box_, plain()?, steps(open, repeats)?)
            }
            Some(1) => (box_, steps(wave(box_, Gas::Isothermal { sound_speed: 1.0 }), repeats)?, plain()?),
            Some(2) => {
                let square = [SIDE * 4, SIDE * 4];
                let flat = [SIDE * 4, SIDE * 4, 1];
                (flat, steps(wave(square, ideal), repeats)?, steps(wave(flat, ideal), repeats)?)
            }
            _ => {
                let mut still = wave(box_, ideal);
                let none = || vec![0.0; SIDE * SIDE * SIDE];
                still.set_drag([none(), none(), none()], [vec![], vec![], vec![]]).map_err(refused)?;
                (box_, plain()?, steps(still, repeats)?)
            }
        })
    };
    let (cells, without, with) = pool.install(measure)?;
    let scene = format!("gas in a periodic box, {STEPS} steps");
    Ok(LeftOutRow { scene, cells, what: what.to_owned(), without, with })
}

fn line(row: &LeftOutRow) -> String {
    let [without, with] = [row.without, row.with].map(|s| readable(s.median, Reading::Seconds));
    format!("{:<24} without {:<32} {without} s, with {with} s", row.scene, row.what)
}

/// The rows as a table.
#[must_use]
pub fn table(rows: &[LeftOutRow]) -> Listing {
    let columns = [
        "scene",
        "cells",
        "left_out",
        "seconds",
        "fastest",
        "slowest",
        "with_it",
        "with_it_fastest",
        "with_it_slowest",
        "saves",
    ];
    let cells = |row: &LeftOutRow| {
        let times = [row.without, row.with].map(|s| [s.median, s.fastest, s.slowest]);
        let times = times.as_flattened().iter().map(|s| Cell::Number(*s, Reading::Seconds));
        let saves = Cell::Number(1.0 - row.without.median / row.with.median, Reading::Share);
        let grid = joined(row.cells);
        let words = [row.scene.clone(), grid, row.what.clone()].map(Cell::Text);
        words.into_iter().chain(times).chain([saves]).collect()
    };
    let seen = |name: &str| !name.contains("est");
    Listing { columns: columns.map(|c| (c, seen(c))).to_vec(), rows: rows.iter().map(cells).collect() }
}
