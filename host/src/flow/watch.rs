//! Cells of a flow whose walls are watched at every step.

use super::field::Scalar;
use voidage_core::flow::{CellPush, WatchedWalls};

/// The cells, ascending, and what the last step did to their walls, with pressures counted from a reference.
#[derive(Clone, Debug)]
pub(super) struct Watch<R, const D: usize> {
    pub cells: Vec<usize>,
    pub pushes: Vec<CellPush<R, D>>,
    pub reference: R,
}

impl<R: Scalar, const D: usize> Watch<R, D> {
    /// As the core takes them.
    pub fn walls(&mut self) -> WatchedWalls<'_, R, D> {
        WatchedWalls { cells: &self.cells, pushes: &mut self.pushes, reference: self.reference }
    }
}
