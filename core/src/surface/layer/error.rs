//! Why a layer is refused.

use crate::grid::fields::ShapeMismatch;
use core::fmt;

/// Why there is no porosity of a layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LayerError {
    /// The grid has no such layer.
    NoLayer {
        /// The layer asked for.
        layer: usize,
        /// How many there are.
        layers: usize,
    },
    /// A slice has the wrong length.
    Shape(ShapeMismatch),
    /// The memory was made for a grid with another number of cells along x and y.
    OtherGrid,
}

impl From<ShapeMismatch> for LayerError {
    fn from(error: ShapeMismatch) -> Self {
        LayerError::Shape(error)
    }
}

impl fmt::Display for LayerError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            LayerError::NoLayer { layer, layers } => write!(f, "layer {layer} of a grid of {layers} layers"),
            LayerError::Shape(mismatch) => mismatch.fmt(f),
            LayerError::OtherGrid => f.write_str("memory made for a grid with other numbers of cells along x and y"),
        }
    }
}

impl core::error::Error for LayerError {}
