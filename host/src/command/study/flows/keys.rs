//! The flows of a study: the lists of a table `[[flow]]` multiply out.

use super::problems::{FlowChoice, FlowProblem};
use crate::command::solve::case::{LimiterName, RiemannName};
use crate::command::stages::room_for;
use crate::command::study::recipe::Precision;
use crate::command::study::values::{choice, few, many, product, some, varied, word};
use crate::error::Result;
use crate::geometry::scene::table::{self, StrictTable};
use crate::words::counted;
use toml::de::DeValue;
use voidage_core::flow::{Limiter, PressureForm, Scheme};

/// A problem and how it is computed.
#[derive(Debug, Clone)]
pub struct FlowRecipe {
    /// Its name in tables: that of its table, and what varies within it but the cells.
    pub name: String,
    /// What flows.
    pub problem: FlowProblem,
    /// Scheme and cells.
    pub choice: FlowChoice,
    /// Words for Riemann solver and limiter.
    pub words: [String; 2],
    /// 1 or 2.
    pub order: usize,
    /// In which numbers.
    pub precision: Precision,
    /// On so many threads.
    pub threads: usize,
}

impl FlowRecipe {
    /// What it costs, roughly, in the units of the porosity's cells: steps grow with the cells along an axis.
    #[must_use]
    pub fn cost(&self, repeats: usize) -> f64 {
        let steps = match self.problem {
            FlowProblem::Slab => 250.0,
            FlowProblem::Nozzle => 120.0,
            FlowProblem::InclinedWall => 4.0,
            FlowProblem::Sod => 0.6,
            FlowProblem::Vortex => 6.0,
            FlowProblem::ShuOsher => 1.2,
        };
        (self.choice.cells as f64).powi(1 + self.problem.axes()) * steps * repeats as f64
    }
}

/// The recipes of a table, in the order of its lists.
///
/// # Errors
/// A value that is none.
pub fn flow_recipes(mut keys: StrictTable) -> Result<Vec<FlowRecipe>> {
    let problems = keys.need("problem", some(choice::<FlowProblem>))?;
    let given = keys.has("name");
    let name = keys.named()?;
    let name = if given || problems.len() > 1 { name } else { problems.first().map_or(name, |p| word(*p)) };
    let cells = keys.need("cells", some(cells))?;
    let fluxes = keys.get("riemann", some(choice::<RiemannName>))?.unwrap_or_else(|| vec![RiemannName::Hllc]);
    let limiters = keys.get("limiter", some(choice::<LimiterName>))?;
    let orders = keys.get("order", some(order))?.unwrap_or_else(|| vec![2]);
    if limiters.is_some() && !orders.contains(&2) {
        return Err(keys.fail("limiter has no effect: order 1 has no slopes to limit"));
    }
    let limiters = limiters.unwrap_or_else(|| vec![LimiterName::Steep]);
    let precisions = keys.get("precision", some(choice::<Precision>))?.unwrap_or_else(|| vec![Precision::F64]);
    let threads = keys.get("threads", some(few))?.unwrap_or_else(|| vec![1]);
    keys.finish()?;
    let most = cells.iter().copied().max().unwrap_or(0);
    for problem in &problems {
        // Two fields.
        let bytes = 2 * size_of::<f64>() * (problem.axes() as usize + 2);
        let all = most.saturating_pow(problem.axes() as u32);
        room_for(all.saturating_mul(bytes)).map_err(|e| keys.wrong("cells", e.reason))?;
    }
    let mut all: Vec<FlowRecipe> = Vec::new();
    for (&problem, &order, &precision) in product(&problems, &orders, &precisions) {
        for (&flux, &limiter, &count) in product(&fluxes, &limiters, &threads) {
            for &cells in &cells {
                let parts = [
                    (problems.len(), word(problem)),
                    (fluxes.len(), word(flux)),
                    (if order == 2 { limiters.len() } else { 1 }, word(limiter)),
                    (orders.len(), format!("order {order}")),
                    (precisions.len(), precision.name().to_owned()),
                    (threads.len(), counted(count, "thread", "threads")),
                ];
                let name = varied(&name, &parts);
                if all.iter().any(|r| r.name == name && r.choice.cells == cells) {
                    continue;
                }
                let slope = if order == 2 { limiter.meaning() } else { Limiter::FirstOrder };
                let scheme = Scheme { riemann: flux.meaning(), limiter: slope, pressure: PressureForm::Geometric };
                let choice = FlowChoice { scheme, cells };
                let slopes = if order == 2 { word(limiter) } else { "no slopes".to_owned() };
                let words = [word(flux), slopes];
                all.push(FlowRecipe { name, problem, choice, words, order, precision, threads: count });
            }
        }
    }
    Ok(all)
}

/// Cells along an axis: enough for slopes, few enough for memory.
fn cells(value: &DeValue) -> std::result::Result<usize, String> {
    match many(value)? {
        n @ 4..=100_000 => Ok(n),
        n => Err(format!("must be from 4 to 100000, not {n}")),
    }
}

/// 1 or 2.
fn order(value: &DeValue) -> std::result::Result<usize, String> {
    match table::count(value)? {
        n @ 1..=2 => Ok(n),
        n => Err(format!("must be 1 or 2, not {n}")),
    }
}
