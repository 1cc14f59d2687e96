//! Gas through porous spaces: violent and slow, in cells of any size, over closed and nearly closed space, with drag and gravity, and what
//! repairs add.

mod drag;
mod gas;
mod meshes;
mod porous;
mod repairs;
mod rest;
mod walls;

use crate::command::stress::case::StressCase;

/// The cases.
pub fn families() -> impl Iterator<Item = &'static [StressCase]> {
    [gas::CASES, walls::CASES, porous::CASES, drag::CASES, meshes::CASES, rest::CASES, repairs::CASES].into_iter()
}
