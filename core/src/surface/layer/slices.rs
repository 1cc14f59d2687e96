//! Where the values of a layer go.

use super::error::LayerError;
use crate::grid::Grid;
use crate::grid::fields::{ShapeMismatch, exactly};
use crate::number::real::Real;

/// Where the values of one layer go: cells `ny*nx`, x faces `ny*(nx+1)`, y faces `(ny+1)*nx`, z faces below the cells `ny*nx`, and
/// for the topmost layer those above it; x fastest. Face slices are empty where faces are not wanted.
#[derive(Debug)]
pub struct LayerSlices<'a, R> {
    pub(super) cell: &'a mut [R],
    pub(super) x: &'a mut [R],
    pub(super) y: &'a mut [R],
    pub(super) z: &'a mut [R],
    pub(super) top: &'a mut [R],
}

impl<'a, R: Real> LayerSlices<'a, R> {
    /// Layer `k` of whole fields of the grid: cells `nx*ny*nz`, x faces `(nx+1)*ny*nz`, y faces `nx*(ny+1)*nz`, z faces `nx*ny*(nz+1)`.
    /// Face fields that are not wanted are all empty.
    ///
    /// # Errors
    /// [`LayerError`] for a layer that the grid has not, or the first field of wrong length.
    pub fn of_fields(grid: &Grid<R>, k: usize, cell: &'a mut [R], faces: [&'a mut [R]; 3]) -> Result<Self, LayerError> {
        let [nx, ny, nz] = grid.cells();
        if k >= nz {
            return Err(LayerError::NoLayer { layer: k, layers: nz });
        }
        exactly(nx * ny * nz, cell.len())?;
        if !faces.iter().all(|f| f.is_empty()) {
            for (axis, field) in faces.iter().enumerate() {
                exactly(grid.face_shape(axis).into_iter().product(), field.len())?;
            }
        }
        let [x, y, z] = faces;
        let (z, top) = z.split_at_mut(z.len().min(nx * ny * (k + 1)));
        Ok(LayerSlices {
            cell: nth(cell, k, nx * ny),
            x: nth(x, k, (nx + 1) * ny),
            y: nth(y, k, nx * (ny + 1)),
            z: nth(z, k, nx * ny),
            top: if k + 1 == nz { top } else { &mut [] },
        })
    }

    /// Five slices; what they must hold, [`crate::surface::layer::Layers::layer`] checks.
    #[must_use]
    pub fn new(cell: &'a mut [R], x: &'a mut [R], y: &'a mut [R], z: &'a mut [R], top: &'a mut [R]) -> Self {
        LayerSlices { cell, x, y, z, top }
    }

    /// The faces normal to an axis (0, 1, otherwise 2), but for those above the layer.
    pub(super) fn faces(&mut self, axis: usize) -> &mut [R] {
        match axis {
            0 => self.x,
            1 => self.y,
            _ => self.z,
        }
    }

    pub(super) fn check(&self, grid: &Grid<R>, k: usize, areas: bool) -> Result<(), ShapeMismatch> {
        let [nx, ny, nz] = grid.cells();
        let wanted = |count: usize| if areas { count } else { 0 };
        exactly(nx * ny, self.cell.len())?;
        exactly(wanted((nx + 1) * ny), self.x.len())?;
        exactly(wanted(nx * (ny + 1)), self.y.len())?;
        exactly(wanted(nx * ny), self.z.len())?;
        exactly(if k + 1 == nz { wanted(nx * ny) } else { 0 }, self.top.len())
    }
}

/// The slice number `n` of equal slices; empty if there is none.
fn nth<R>(all: &mut [R], n: usize, length: usize) -> &mut [R] {
    all.get_mut(n * length..(n + 1) * length).unwrap_or_default()
}
