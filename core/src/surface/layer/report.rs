//! What is told about a layer.

use crate::surface::error::Defects;

/// Cells of a layer by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CellKinds {
    /// No solid.
    pub open: usize,
    /// Partly solid, or with surface inside.
    pub cut: usize,
    /// All solid.
    pub closed: usize,
    /// Of the cut cells: shared by several bodies, so that their union had to be found.
    pub ambiguous: usize,
}

/// What a layer holds, and how well it is known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LayerReport<R> {
    /// Cells by kind.
    pub cells: CellKinds,
    /// Solid volume, in the unit of the grid.
    pub solid_volume: R,
    /// Largest distance of the bounds of any cell or face.
    pub max_gap: R,
    /// Cells divided because their union had no proof at once.
    pub divided: usize,
    /// The worst of the bodies' surfaces in this layer.
    pub defects: Defects<R>,
}
