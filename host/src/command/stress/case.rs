//! A case: what is stressed, by what it is judged, and how it is measured.

use std::error::Error as AnyError;

/// How much is done.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Effort {
    /// More pairs, more steps, larger scenes.
    pub long: bool,
}

impl Effort {
    /// One of two amounts.
    #[must_use]
    pub fn pick<T>(self, short: T, long: T) -> T {
        if self.long { long } else { short }
    }
}

/// What a number may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Allowed {
    /// This, or less.
    AtMost(f64),
    /// This, or more: of things that must have been seen, for example.
    AtLeast(f64),
}

impl Allowed {
    /// Whether a number is; NaN is not.
    #[must_use]
    pub fn holds(self, number: f64) -> bool {
        match self {
            Allowed::AtMost(limit) => number <= limit,
            Allowed::AtLeast(limit) => number >= limit,
        }
    }

    /// The limit.
    #[must_use]
    pub fn limit(self) -> f64 {
        match self {
            Allowed::AtMost(limit) | Allowed::AtLeast(limit) => limit,
        }
    }
}

/// One number of a case, and what it may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Criterion {
    /// What is counted or measured, with its unit, if it has one.
    pub what: &'static str,
    /// The limit.
    pub allowed: Allowed,
}

/// A number that must not exceed a limit.
#[must_use]
pub const fn at_most(limit: f64, what: &'static str) -> Criterion {
    Criterion { what, allowed: Allowed::AtMost(limit) }
}

/// A number that must reach a limit.
#[must_use]
pub const fn at_least(limit: f64, what: &'static str) -> Criterion {
    Criterion { what, allowed: Allowed::AtLeast(limit) }
}

/// The numbers of a case, one for each criterion; or why there are none.
pub type Numbers = Result<Vec<f64>, Box<dyn AnyError>>;

/// A case of the battery.
#[derive(Debug, Clone, Copy)]
pub struct StressCase {
    /// Family and name: `geometry/needles`.
    pub name: &'static str,
    /// What is stressed.
    pub stresses: &'static str,
    /// By what it is judged.
    pub criteria: &'static [Criterion],
    /// Left out without `--long`, unless named.
    pub long: bool,
    /// Measures it.
    pub measure: fn(Effort) -> Numbers,
}

impl StressCase {
    /// A case of every run.
    #[must_use]
    pub const fn new(
        name: &'static str,
        stresses: &'static str,
        criteria: &'static [Criterion],
        measure: fn(Effort) -> Numbers,
    ) -> Self {
        StressCase { name, stresses, criteria, long: false, measure }
    }

    /// The same, left out of short runs.
    #[must_use]
    pub const fn only_long(self) -> Self {
        StressCase { long: true, ..self }
    }
}
