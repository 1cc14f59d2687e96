//! Do two bodies meet, and how far apart are they: degenerate hulls and those that touch but for rounding against exact arithmetic, round bodies in closed form, any power of two,
//! numbers that are none.

mod families;
mod nearly;
mod numbers;
mod oracle;
mod round;

use crate::command::stress::case::StressCase;

/// The cases.
pub fn families() -> impl Iterator<Item = &'static [StressCase]> {
    [families::CASES, nearly::CASES, round::CASES, numbers::CASES].into_iter()
}
