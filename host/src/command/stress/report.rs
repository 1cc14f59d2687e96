//! Outcomes as lines for reading, and as JSON.

use crate::command::stress::case::{Allowed, Criterion, StressCase};
use crate::command::stress::runner::StressOutcome;
use crate::words::counted;
use serde::Serialize;
use std::fmt::Write as _;

/// The cases as a table in Markdown, that of the manual: name, what is stressed, criteria.
#[must_use]
pub fn list(cases: &[&StressCase]) -> String {
    let mut text = String::from("| case | stresses | passes if |\n|---|---|---|\n");
    for case in cases {
        let criteria: Vec<String> = case.criteria.iter().map(|c| format!("{} {}", c.what, bound(c.allowed))).collect();
        let long = if case.long { " (only with `--long`)" } else { "" };
        let _ = writeln!(text, "| `{}` | {}{long} | {} |", case.name, case.stresses, criteria.join("; "));
    }
    text
}

fn bound(allowed: Allowed) -> String {
    match allowed {
        Allowed::AtMost(limit) => format!("≤ {}", short(limit)),
        Allowed::AtLeast(limit) => format!("≥ {}", short(limit)),
    }
}

/// A number in few digits.
fn short(number: f64) -> String {
    let size = number.abs();
    match number {
        _ if number == 0.0 => "0".to_owned(),
        _ if (1e-2..1e6).contains(&size) && number == number.round() => format!("{number}"),
        _ if (1e-2..1e6).contains(&size) => format!("{:.3}", number).trim_end_matches('0').to_owned(),
        _ => format!("{number:.1e}").replace(".0e", "e"),
    }
}

/// One line: verdict, name, what is stressed, every number with its limit, time.
#[must_use]
pub fn line(outcome: &StressOutcome, width: usize) -> String {
    let case = outcome.case;
    let verdict = if outcome.passed() { "pass" } else { "FAIL" };
    let numbers = match &outcome.numbers {
        Ok(numbers) => {
            let shown = |(c, number): (&Criterion, &f64)| match c.allowed.holds(*number) {
                true => format!("{} {} {}", c.what, short(*number), bound(c.allowed)),
                false => format!("{} {}, NOT {}", c.what, short(*number), bound(c.allowed)),
            };
            case.criteria.iter().zip(numbers).map(shown).collect::<Vec<_>>().join("; ")
        }
        Err(reason) => reason.clone(),
    };
    format!("{verdict}  {:<width$}  {}: {numbers}  ({:.1} s)", case.name, case.stresses, outcome.seconds)
}

/// All outcomes, as the file of `--json` has them.
#[derive(Debug, Serialize)]
pub struct StressSummary {
    version: &'static str,
    long: bool,
    threads: usize,
    cases: Vec<CaseSummary>,
    passed: usize,
    failed: usize,
    seconds: f64,
}

#[derive(Debug, Serialize)]
struct CaseSummary {
    name: &'static str,
    stresses: &'static str,
    criteria: Vec<CriterionSummary>,
    failure: Option<String>,
    passed: bool,
    seconds: f64,
}

#[derive(Debug, Serialize)]
struct CriterionSummary {
    what: &'static str,
    at_most: Option<f64>,
    at_least: Option<f64>,
    measured: Option<f64>,
    passed: bool,
}

impl StressSummary {
    /// Of a run.
    #[must_use]
    pub fn new(outcomes: &[StressOutcome], long: bool, threads: usize, seconds: f64) -> Self {
        let cases: Vec<CaseSummary> = outcomes.iter().map(summary).collect();
        let passed = cases.iter().filter(|case| case.passed).count();
        StressSummary {
            version: env!("CARGO_PKG_VERSION"),
            long,
            threads,
            passed,
            failed: cases.len() - passed,
            cases,
            seconds,
        }
    }

    /// The last line.
    #[must_use]
    pub fn sentence(&self) -> String {
        let StressSummary { passed, failed, seconds, cases, .. } = self;
        format!("{}, {passed} passed, {failed} failed, {seconds:.0} s", counted(cases.len(), "case", "cases"))
    }

    /// The cases that failed.
    #[must_use]
    pub fn failed_names(&self) -> Vec<&str> {
        self.cases.iter().filter(|case| !case.passed).map(|case| case.name).collect()
    }
}

fn summary(outcome: &StressOutcome) -> CaseSummary {
    let number = |n: usize| outcome.numbers.as_ref().ok().and_then(|numbers| numbers.get(n).copied());
    let criterion = |(n, c): (usize, &Criterion)| CriterionSummary {
        what: c.what,
        at_most: matches!(c.allowed, Allowed::AtMost(_)).then(|| c.allowed.limit()),
        at_least: matches!(c.allowed, Allowed::AtLeast(_)).then(|| c.allowed.limit()),
        measured: number(n).filter(|x| x.is_finite()),
        passed: number(n).is_some_and(|x| c.allowed.holds(x)),
    };
    CaseSummary {
        name: outcome.case.name,
        stresses: outcome.case.stresses,
        criteria: outcome.case.criteria.iter().enumerate().map(criterion).collect(),
        failure: outcome.numbers.as_ref().err().cloned(),
        passed: outcome.passed(),
        seconds: outcome.seconds,
    }
}
