//! The problems by name, what their errors are, and what they are counted from.

use crate::error::{Error, Result};
use crate::flow::{Flow, Scalar};
use clap::ValueEnum;
use voidage_core::flow::Scheme;

/// A built-in problem.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, ValueEnum)]
pub enum FlowProblem {
    /// The shock tube of Sod.
    Sod,
    /// A shock that meets waves of density, of Shu and Osher.
    ShuOsher,
    /// A vortex that drifts, of Shu.
    Vortex,
    /// A stream through a slab of porosity 0.5.
    Slab,
    /// A subsonic nozzle made by porosity.
    Nozzle,
    /// A stream along a wall at 20° to the grid.
    InclinedWall,
}

/// What a run found.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct FlowOutcome {
    /// The error, see [`FlowProblem::error`].
    pub error: f64,
    /// How far what it is counted from may be off, in the same unit.
    pub uncertainty: f64,
    /// Seconds of the steps alone.
    pub seconds: f64,
    /// Steps.
    pub steps: usize,
    /// Cells in all.
    pub cells: usize,
}

/// Share of the stable time step along a line, and in a plane.
pub const CFL: [f64; 2] = [0.75, 0.8];

impl FlowProblem {
    /// What the error is.
    #[must_use]
    pub fn error(self) -> &'static str {
        match self {
            FlowProblem::Sod | FlowProblem::ShuOsher | FlowProblem::Vortex => "mean |Δρ|",
            FlowProblem::Slab => "mean |Δp| / (ρu²/2)",
            FlowProblem::Nozzle => "mean |Δp| / p at rest",
            FlowProblem::InclinedWall => "mean |Δp| / (ρu²/2)",
        }
    }

    /// What it is counted from.
    #[must_use]
    pub fn reference(self) -> &'static str {
        match self {
            FlowProblem::Sod => "exact Riemann solution",
            FlowProblem::ShuOsher => "this program on 12800 cells",
            FlowProblem::Vortex => "exact solution",
            FlowProblem::Slab | FlowProblem::Nozzle => "exact isentropic flow",
            FlowProblem::InclinedWall => "the undisturbed stream",
        }
    }

    /// Axes along which anything happens.
    #[must_use]
    pub fn axes(self) -> i32 {
        if matches!(self, FlowProblem::Vortex | FlowProblem::InclinedWall) { 2 } else { 1 }
    }
}

/// Why the solver refused.
pub(super) fn refused(error: voidage_core::flow::Error) -> Error {
    Error::new(format!("the flow: {error}"))
}

/// Runs a flow to a time, with full steps to the end or beyond it where it is steady, and tells seconds and steps.
pub(super) fn advance<R: Scalar, const D: usize>(flow: &mut Flow<R, D>, end: f64, steady: bool) -> Result<FlowOutcome> {
    let begin = std::time::Instant::now();
    let cfl = R::from_f64(if D == 1 { CFL[0] } else { CFL[1] });
    let last = if steady { R::MAX } else { R::from_f64(end) };
    while flow.time.to_f64() < end && flow.time < last {
        flow.advance(cfl, last).map_err(refused)?;
    }
    let seconds = begin.elapsed().as_secs_f64();
    Ok(FlowOutcome { seconds, steps: flow.steps, cells: flow.len(), ..FlowOutcome::default() })
}

/// How a flow is computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlowChoice {
    /// Fluxes and slopes.
    pub scheme: Scheme,
    /// Cells along each axis.
    pub cells: usize,
}
