//! All that a study found.

use super::case::{Published, StudyCase};
use super::flows::runs::{self, FlowOrder, FlowRow};
use super::left_out::{self, LeftOutRow};
use super::measure;
use super::row::Row;
use super::scaling::{self, Exponent, ScalingRow};
use super::session::Session;
use crate::command::version::{BUILD, Build};
use crate::error::Result;
use crate::geometry::bodies::Bodies;
use serde::Serialize;

/// All that a study found, and how.
#[derive(Debug, Clone, Default)]
pub struct StudyFindings {
    /// Head of the reports.
    pub title: String,
    /// What readers should know.
    pub note: Option<String>,
    /// As typed.
    pub command: String,
    /// Version and commit.
    pub program: String,
    /// Of the machine.
    pub processors: usize,
    /// Runs of each.
    pub repeats: usize,
    /// Shortened.
    pub quick: bool,
    /// Points of porosity.
    pub rows: Vec<Row>,
    /// Times of others, by scene.
    pub published: Vec<(String, Published)>,
    /// Runs of flows.
    pub flows: Vec<FlowRow>,
    /// Steps of what grows.
    pub scalings: Vec<ScalingRow>,
    /// What is left out.
    pub left_out: Vec<LeftOutRow>,
    /// As printed.
    pub warnings: Vec<String>,
}

/// What programs read.
#[derive(Debug, Serialize)]
pub struct StudyReport<'a> {
    title: &'a str,
    build: Build,
    command: &'a str,
    processors: usize,
    quick: bool,
    points: &'a [Row],
    flows: &'a [FlowRow],
    orders: Vec<FlowOrder>,
    scalings: &'a [ScalingRow],
    exponents: Vec<Exponent>,
    left_out: &'a [LeftOutRow],
    warnings: &'a [String],
}

impl StudyFindings {
    /// For programs.
    #[must_use]
    pub fn report(&self) -> StudyReport<'_> {
        StudyReport {
            title: &self.title,
            build: BUILD,
            command: &self.command,
            processors: self.processors,
            quick: self.quick,
            points: &self.rows,
            flows: &self.flows,
            orders: runs::orders(&self.flows),
            scalings: &self.scalings,
            exponents: scaling::exponents(&self.scalings),
            left_out: &self.left_out,
            warnings: &self.warnings,
        }
    }
}

/// How many points a study has, and what they cost.
#[must_use]
pub fn plan(case: &StudyCase) -> (usize, f64) {
    let flows: f64 = case.flows.iter().map(|f| f.cost(case.repeats)).sum();
    let growing = case.scalings.iter().flat_map(|s| s.counts.iter().map(|&n| s.cost(n, case.repeats)));
    let parts = [
        case.plan(),
        (case.flows.len(), flows),
        growing.fold((0, 0.0), |(count, sum), cost| (count + 1, sum + cost)),
        left_out::plan(case),
    ];
    parts.into_iter().fold((0, 0.0), |a, b| (a.0 + b.0, a.1 + b.1))
}

/// Measures all.
///
/// # Errors
/// A scene that a method cannot measure; a flow that is refused.
pub fn measure(case: &StudyCase, scenes: &[Bodies], command: String, session: &mut Session) -> Result<StudyFindings> {
    let of = |subject: &super::case::Subject| {
        let name = subject.name.clone();
        subject.published.iter().map(move |p| (name.clone(), p.clone())).collect::<Vec<_>>()
    };
    Ok(StudyFindings {
        title: case.title.clone(),
        note: case.note.clone(),
        command,
        program: format!("voidage {}, commit {}", env!("CARGO_PKG_VERSION"), env!("VOIDAGE_COMMIT")),
        processors: std::thread::available_parallelism().map_or(1, usize::from),
        repeats: case.repeats,
        quick: case.is_quick,
        rows: measure::all(case, scenes, session)?,
        published: case.subjects.iter().flat_map(of).collect(),
        flows: runs::all(&case.flows, case.repeats, session)?,
        scalings: scaling::all(&case.scalings, case.repeats, session)?,
        left_out: left_out::all(case, scenes, session)?,
        warnings: session.progress.warnings.clone(),
    })
}
