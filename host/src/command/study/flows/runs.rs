//! The runs of the flows of a study, and the orders that are fitted to them.

use super::keys::FlowRecipe;
use super::lines::{self, FineDensity, fine_density};
use super::planes;
use super::problems::{FlowOutcome, FlowProblem};
use crate::command::stages;
use crate::command::study::recipe::Precision;
use crate::command::study::session::Session;
use crate::command::study::spread::{Spread, slope};
use crate::command::study::table::{Cell, Listing, Reading, readable};
use crate::command::study::values::word;
use crate::error::{Error, Result};
use crate::flow::Scalar;
use crate::words::either;
use serde::{Deserialize, Serialize};

/// A run of a flow.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FlowRow {
    /// By its table and what varies within it.
    pub flow: String,
    /// The problem.
    pub problem: String,
    /// Cells along an axis.
    pub n: usize,
    /// Cells in all.
    pub cells: usize,
    /// Riemann solver.
    pub riemann: String,
    /// Limiter of slopes.
    pub limiter: String,
    /// 1 or 2.
    pub order: usize,
    /// `f64` or `f32`.
    pub precision: String,
    /// Number of threads.
    pub threads: usize,
    /// How often it was run: more often than asked where a run is short.
    pub repeats: usize,
    /// Times of the steps alone.
    pub seconds: Spread,
    /// Steps.
    pub steps: usize,
    /// Cells times steps over the median time, in millions a second.
    pub updates: f64,
    /// What the error is.
    pub quantity: String,
    /// The error.
    pub error: f64,
    /// What it is counted from.
    pub reference: String,
    /// How far that may be off.
    pub uncertainty: f64,
}

/// Errors of a flow below this share are rounding, which grows from step to step.
pub const FLOW_ROUNDING: f64 = 1e-10;

/// Runs all.
///
/// # Errors
/// The solver refuses a problem.
pub fn all(recipes: &[FlowRecipe], repeats: usize, session: &mut Session) -> Result<Vec<FlowRow>> {
    let mut fine = None;
    let mut rows = Vec::with_capacity(recipes.len());
    for recipe in recipes {
        let key = format!("flow | {} | {}", recipe.name, recipe.choice.cells);
        let measure = |_: &mut _| {
            if recipe.problem == FlowProblem::ShuOsher && fine.is_none() {
                fine = Some(fine_density()?);
            }
            run(recipe, repeats, fine.as_ref())
        };
        rows.push(session.point(&key, recipe.cost(repeats), measure, line)?);
    }
    Ok(rows)
}

/// A flow of microseconds is run until all its runs have taken this long in s, or are this many: the time of one would be noise.
const ENOUGH: (f64, usize) = (0.02, 100);

/// Runs of these times tell too little yet.
fn is_short(seconds: &[f64]) -> bool {
    seconds.iter().sum::<f64>() < ENOUGH.0 && seconds.len() < ENOUGH.1
}

fn run(recipe: &FlowRecipe, repeats: usize, fine: Option<&FineDensity>) -> Result<FlowRow> {
    let count = u16::try_from(recipe.threads).map_err(|e| Error::new(format!("threads: {e}")))?;
    let pool = stages::threads(Some(count))?;
    let (mut seconds, mut last) = (Vec::new(), FlowOutcome::default());
    while seconds.len() < repeats.max(1) || is_short(&seconds) {
        last = pool.install(|| match recipe.precision {
            Precision::F64 => outcome::<f64>(recipe, fine),
            Precision::F32 => outcome::<f32>(recipe, fine),
        })?;
        seconds.push(last.seconds);
    }
    let (repeats, seconds) = (seconds.len(), Spread::of(seconds));
    let [riemann, limiter] = recipe.words.clone();
    Ok(FlowRow {
        flow: recipe.name.clone(),
        problem: word(recipe.problem),
        n: recipe.choice.cells,
        cells: last.cells,
        riemann,
        limiter,
        order: recipe.order,
        precision: recipe.precision.name().to_owned(),
        threads: recipe.threads,
        repeats,
        seconds,
        steps: last.steps,
        updates: 1e-6 * last.cells as f64 * last.steps as f64 / seconds.median,
        quantity: recipe.problem.error().to_owned(),
        error: last.error,
        reference: recipe.problem.reference().to_owned(),
        uncertainty: last.uncertainty,
    })
}

fn outcome<R: Scalar>(recipe: &FlowRecipe, fine: Option<&FineDensity>) -> Result<FlowOutcome> {
    let choice = recipe.choice;
    match (recipe.problem, fine) {
        (FlowProblem::Sod, _) => lines::sod::<R>(choice),
        (FlowProblem::ShuOsher, Some(fine)) => lines::shu_osher::<R>(choice, fine),
        (FlowProblem::ShuOsher, None) => Err(Error::new("no reference")),
        (FlowProblem::Vortex, _) => planes::vortex::<R>(choice),
        (FlowProblem::Slab, _) => lines::slab::<R>(choice),
        (FlowProblem::Nozzle, _) => lines::nozzle::<R>(choice),
        (FlowProblem::InclinedWall, _) => planes::inclined_wall::<R>(choice),
    }
}

fn line(row: &FlowRow) -> String {
    let (seconds, error) = (readable(row.seconds.median, Reading::Seconds), readable(row.error, Reading::Small));
    format!(
        "{:<32} N {:>6} {:>2} {:<7} {seconds:>9} s  {} {error}",
        row.flow,
        row.n,
        row.threads,
        either(row.threads, "thread", "threads"),
        row.quantity
    )
}

/// Order of convergence: how fast the error falls with N.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FlowOrder {
    /// The flow.
    pub flow: String,
    /// Its error.
    pub quantity: String,
    /// Runs that were fitted: those that err by more than rounding.
    pub runs: usize,
    /// Minus the slope of the error over N in logarithms, and its standard error.
    pub order: f64,
    /// None for two runs.
    pub standard_error: Option<f64>,
}

/// Orders by least squares, of the flows that have two runs that err by more than rounding and than the reference.
#[must_use]
pub fn orders(rows: &[FlowRow]) -> Vec<FlowOrder> {
    let mut all: Vec<FlowOrder> = Vec::new();
    for row in rows {
        if all.iter().any(|o| o.flow == row.flow) {
            continue;
        }
        let own = rows.iter().filter(|r| r.flow == row.flow && r.error > FLOW_ROUNDING.max(r.uncertainty));
        let points: Vec<[f64; 2]> = own.map(|r| [r.n as f64, r.error]).collect();
        if let Some((slope, standard_error)) = slope(&points) {
            let (flow, quantity) = (row.flow.clone(), row.quantity.clone());
            all.push(FlowOrder { flow, quantity, runs: points.len(), order: -slope, standard_error });
        }
    }
    all
}

/// Columns, and whether people see them.
const COLUMNS: [(&str, bool); 19] = [
    ("flow", true),
    ("problem", false),
    ("n", true),
    ("cells", false),
    ("riemann", false),
    ("limiter", false),
    ("order", false),
    ("precision", false),
    ("threads", true),
    ("repeats", false),
    ("seconds", true),
    ("fastest", true),
    ("slowest", true),
    ("steps", true),
    ("million_updates_per_second", true),
    ("quantity", true),
    ("error", true),
    ("reference", true),
    ("uncertainty", true),
];

/// The rows as a table.
#[must_use]
pub fn table(rows: &[FlowRow]) -> Listing {
    let text = |text: &str| Cell::Text(text.to_owned());
    let cells = |row: &FlowRow| {
        vec![
            text(&row.flow),
            text(&row.problem),
            Cell::Whole(row.n),
            Cell::Whole(row.cells),
            text(&row.riemann),
            text(&row.limiter),
            Cell::Whole(row.order),
            text(&row.precision),
            Cell::Whole(row.threads),
            Cell::Whole(row.repeats),
            Cell::Number(row.seconds.median, Reading::Seconds),
            Cell::Number(row.seconds.fastest, Reading::Seconds),
            Cell::Number(row.seconds.slowest, Reading::Seconds),
            Cell::Whole(row.steps),
            Cell::Number(row.updates, Reading::Order),
            text(&row.quantity),
            Cell::Number(row.error, Reading::Small),
            text(&row.reference),
            Cell::Number(row.uncertainty, Reading::Small),
        ]
    };
    Listing { columns: COLUMNS.to_vec(), rows: rows.iter().map(cells).collect() }
}

/// The orders as a table.
#[must_use]
pub fn order_table(orders: &[FlowOrder]) -> Listing {
    let columns =
        [("flow", true), ("quantity", true), ("runs", true), ("fitted_order", true), ("standard_error", true)];
    let cells = |o: &FlowOrder| {
        let [flow, quantity] = [&o.flow, &o.quantity].map(|t| Cell::Text(t.clone()));
        let fitted = Cell::Number(o.order, Reading::Order);
        vec![flow, quantity, Cell::Whole(o.runs), fitted, Cell::maybe(o.standard_error, Reading::Order)]
    };
    Listing { columns: columns.to_vec(), rows: orders.iter().map(cells).collect() }
}
