//! Porosity: extreme sizes and places, thin and many bodies, surfaces that meet themselves and each other, whole and empty grids, repairs.

mod crowds;
mod ends;
mod flush;
mod repairs;
mod sizes;
mod thin;

use crate::command::stress::case::StressCase;

/// The cases.
pub fn families() -> impl Iterator<Item = &'static [StressCase]> {
    [sizes::CASES, thin::CASES, crowds::CASES, flush::CASES, ends::CASES, repairs::CASES].into_iter()
}
