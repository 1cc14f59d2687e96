//! Do two bodies meet, and how far apart are they.

use crate::command::stress::case::StressCase;

/// The cases.
pub fn families() -> impl Iterator<Item = &'static [StressCase]> {
    [].into_iter()
}
