//! What is wrong with a body's surface, and why it cannot be added.

use crate::grid::fields::ShapeMismatch;
use crate::number::real::{Real, Vector};
use core::fmt;

/// Whether surfaces may have the corner `point`: differences and sums of a few of its coordinates are finite, too.
#[must_use]
pub fn is_computable<V: Vector>(point: V) -> bool {
    point.is_finite() && point.norm_max() <= V::Scalar::MAX * V::Scalar::from_f64(0.25)
}

/// What is wrong with a body's surface in one layer; zero, but for rounding, if it is closed and does not cross itself.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Defects<R> {
    /// The largest amount by which a row failed to return to zero, as a fraction of a face.
    pub leak: R,
    /// The largest amount by which the body's own share of a cell left 0..1.
    pub winding: R,
}

impl<R: Real> Defects<R> {
    /// The worse of both, each by itself.
    #[must_use]
    pub fn worst(self, other: Self) -> Self {
        Defects { leak: self.leak.max(other.leak), winding: self.winding.max(other.winding) }
    }
}

/// Why a body cannot be added to a layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SurfaceError {
    /// The grid has no such layer of cells, or no such plane.
    NoLayer {
        /// The layer or plane asked for.
        layer: usize,
        /// How many there are.
        layers: usize,
    },
    /// A number stands for no triangle.
    NoTriangle {
        /// That number.
        id: u32,
        /// How many triangles there are.
        triangles: usize,
    },
    /// A triangle has a coordinate that is NaN, infinite or too large to compute with.
    NotFinite {
        /// The triangle's number.
        id: u32,
    },
    /// Layer or scratch belong to another grid.
    Shape(ShapeMismatch),
}

impl From<ShapeMismatch> for SurfaceError {
    fn from(error: ShapeMismatch) -> Self {
        SurfaceError::Shape(error)
    }
}

impl fmt::Display for SurfaceError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            SurfaceError::NoLayer { layer, layers } => write!(f, "layer or plane {layer} of {layers}"),
            SurfaceError::NoTriangle { id, triangles } => write!(f, "triangle {id} of {triangles}"),
            SurfaceError::NotFinite { id } => {
                write!(f, "triangle {id} has a coordinate that is NaN, infinite or too large to compute with")
            }
            SurfaceError::Shape(mismatch) => mismatch.fmt(f),
        }
    }
}

impl core::error::Error for SurfaceError {}
