//! Which triangles have surface in some cells of a grid.

use super::patch::Patches;
use crate::geometry::bodies::Bodies;
use voidage_core::surface::surface_area::KeptPieces;

/// The triangles that reach into each of some cells, as far as they are known.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct CellTriangles {
    /// The cells, by their numbers in the grid, in ascending order.
    cells: Vec<usize>,
    /// Where the triangles of each cell end.
    ends: Vec<usize>,
    /// Numbers in [`Bodies::triangles`]; those of a body come one after the other.
    triangles: Vec<u32>,
    /// For each cell, whether one unbroken patch of one body cuts it, which divides no open space.
    whole: Vec<bool>,
}

impl CellTriangles {
    /// Of cells in ascending order, from the pieces of surface that have been kept of each layer of so many cells. Nothing is known of cells of which not all
    /// were kept, nor of any if there are bodies without triangles. Cells that one unbroken patch of one body cuts are looked for among those that are given
    /// with true.
    #[must_use]
    pub fn of(
        bodies: &Bodies,
        kept: &[KeptPieces<f64>],
        in_layer: usize,
        cells: impl Iterator<Item = (usize, bool)>,
    ) -> Self {
        let (mut found, mut patches) = (CellTriangles::default(), Patches::default());
        if bodies.bodies.iter().any(|body| body.triangles.is_empty()) {
            return found;
        }
        for (cell, may_be_whole) in cells {
            let (layer, at) = (cell / in_layer.max(1), cell % in_layer.max(1));
            let Some((kept, own)) = kept.get(layer).and_then(|kept| Some((kept, kept.triangles(at)?))) else {
                continue;
            };
            let mut of_one = kept.of_one(at).filter(|_| may_be_whole);
            found.whole.push(of_one.as_mut().is_some_and(|pieces| patches.are_one(pieces)));
            let number = |[body, triangle]: [u32; 2]| bodies.bodies[body as usize].triangles.start as u32 + triangle;
            found.triangles.extend(own.map(number));
            found.cells.push(cell);
            found.ends.push(found.triangles.len());
        }
        found
    }

    /// The triangles that reach into a cell, if they are known.
    #[must_use]
    pub fn of_cell(&self, cell: usize) -> Option<&[u32]> {
        let at = self.cells.binary_search(&cell).ok()?;
        let start = at.checked_sub(1).map_or(0, |before| self.ends[before]);
        self.triangles.get(start..self.ends[at])
    }

    /// Is it known that one unbroken patch of one body cuts a cell?
    #[must_use]
    pub fn is_whole(&self, cell: usize) -> bool {
        self.cells.binary_search(&cell).is_ok_and(|at| self.whole[at])
    }
}
