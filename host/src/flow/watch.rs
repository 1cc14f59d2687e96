//! Cells of a flow whose walls are watched at every step.

use super::Flow;
use super::field::Scalar;
use voidage_core::flow::{CellPush, WatchedWalls};

/// The cells, and what the last step did to their walls.
#[derive(Clone, Debug)]
pub(super) struct Watch<R, const D: usize> {
    cells: Vec<usize>,
    pushes: Vec<CellPush<R, D>>,
    reference: R,
}

impl<R: Scalar, const D: usize> Watch<R, D> {
    /// As the core takes them.
    pub fn walls(&mut self) -> WatchedWalls<'_, R, D> {
        WatchedWalls { cells: &self.cells, pushes: &mut self.pushes, reference: self.reference }
    }
}

impl<R: Scalar, const D: usize> Flow<R, D> {
    /// Watches from now on what acts on the walls of some cells and on what drags in them, with pressures counted from `reference`. Until the next
    /// step that is the pressure of each cell, and the drag at its velocity.
    pub fn watch_walls(&mut self, mut cells: Vec<usize>, reference: R) {
        cells.sort_unstable();
        cells.dedup();
        cells.retain(|&cell| cell < self.len());
        let pushes = cells.iter().map(|&cell| self.push_of_state(cell, reference)).collect();
        self.watch = (!cells.is_empty()).then_some(Watch { cells, pushes, reference });
    }

    /// The watched cells, ascending, and what acted on their walls in the last step.
    pub fn watched_walls(&self) -> (&[usize], &[CellPush<R, D>]) {
        self.watch.as_ref().map_or((&[], &[]), |watch| (&watch.cells, &watch.pushes))
    }

    /// Puts back what acted on the walls of the watched cells, as [`Flow::watched_walls`] gave it; what is not as long is left alone.
    pub fn restore_walls(&mut self, pushes: &[CellPush<R, D>]) {
        if let Some(watch) = self.watch.as_mut().filter(|watch| watch.pushes.len() == pushes.len()) {
            watch.pushes.copy_from_slice(pushes);
        }
    }

    /// What the present state alone tells of the walls of a cell.
    fn push_of_state(&self, cell: usize, reference: R) -> CellPush<R, D> {
        let (w, at) = (self.get(cell), self.coordinates(cell));
        let speed = w.velocity.iter().fold(R::ZERO, |s, &u| s + u * u).sqrt();
        let faces: Vec<&[R]> = self.faces().collect();
        let closed = |d: usize, side: usize| faces.get(d).map_or(R::ZERO, |f| R::ONE - f[self.face(d, at, side)]);
        let open = self.beta_v().map_or(R::ONE, |open| open[cell]);
        let coefficient = |n: usize| self.drag().nth(n).and_then(|c| c.get(cell)).copied().unwrap_or(R::ZERO);
        let drag = |d: usize| {
            let rate = coefficient(D + d) + R::HALF * coefficient(d) * speed;
            open * w.density * rate * w.velocity[d]
        };
        CellPush {
            sides: std::array::from_fn(|d| [0, 1].map(|side| closed(d, side) * (w.pressure - reference))),
            drag: std::array::from_fn(drag),
        }
    }
}
