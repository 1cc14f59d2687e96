//! Do two bodies meet, and how far apart are they: degenerate hulls against exact arithmetic, round bodies in closed form, any power of two,
//! numbers that are none.

mod families;
mod numbers;
mod oracle;
mod round;

use crate::command::stress::case::StressCase;

/// The cases.
pub fn families() -> impl Iterator<Item = &'static [StressCase]> {
    [families::CASES, round::CASES, numbers::CASES].into_iter()
}
