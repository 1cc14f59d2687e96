//! Gas through porous spaces.

mod gas;

use crate::command::stress::case::StressCase;

/// The cases.
pub fn families() -> impl Iterator<Item = &'static [StressCase]> {
    [gas::CASES].into_iter()
}
