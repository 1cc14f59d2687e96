//! A value for every cell and face, whole and by layers.

use crate::huge::HugeVec;
use rayon::prelude::*;
use voidage_core::grid::Grid;
use voidage_core::surface::layer::{LayerSlices, OpenLayer};

/// A value for every cell and face of a grid, x fastest.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FieldSet {
    /// Cells, `nx*ny*nz`.
    pub v: HugeVec,
    /// x faces, `(nx+1)*ny*nz`.
    pub x: HugeVec,
    /// y faces, `nx*(ny+1)*nz`.
    pub y: HugeVec,
    /// z faces, `nx*ny*(nz+1)`.
    pub z: HugeVec,
}

/// One layer's share of a field set.
#[derive(Debug)]
pub struct Slices<'a> {
    /// Cells.
    pub v: &'a mut [f64],
    /// x faces.
    pub x: &'a mut [f64],
    /// y faces.
    pub y: &'a mut [f64],
    /// z faces below.
    pub z: &'a mut [f64],
    /// z faces above: only for the topmost layer, else empty.
    pub top: &'a mut [f64],
}

impl FieldSet {
    /// All zero; without `areas` the face fields are empty.
    #[must_use]
    pub fn new(grid: &Grid<f64>, areas: bool) -> Self {
        let faces = |axis| HugeVec::zeros(if areas { grid.face_shape(axis).iter().product() } else { 0 });
        FieldSet { v: HugeVec::zeros(grid.cell_count()), x: faces(0), y: faces(1), z: faces(2) }
    }

    /// The volume of solid in all cells of a grid.
    #[must_use]
    pub fn blocked_volume(&self, grid: &Grid<f64>) -> f64 {
        let [nx, ny, _] = grid.cells();
        let width = |axis: usize| grid.edges(axis).windows(2).map(|e| e[1] - e[0]);
        let row = |row: &[f64]| row.iter().zip(width(0)).map(|(open, width)| (1.0 - open) * width).sum::<f64>();
        let layer =
            |layer: &[f64]| layer.chunks_exact(nx).zip(width(1)).map(|(cells, width)| row(cells) * width).sum::<f64>();
        let layers: Vec<f64> = self.v[..].par_chunks_exact(nx * ny).map(layer).collect();
        layers.iter().zip(width(2)).map(|(area, height)| area * height).sum()
    }

    /// The faces normal to an axis.
    #[must_use]
    pub fn faces(&self, axis: usize) -> &[f64] {
        [&self.x, &self.y, &self.z][axis]
    }

    /// The faces normal to an axis, to be changed.
    pub fn faces_mut(&mut self, axis: usize) -> &mut [f64] {
        match axis {
            0 => &mut self.x,
            1 => &mut self.y,
            _ => &mut self.z,
        }
    }

    /// The cells (0), or the x, y, z faces (1, 2, 3).
    #[must_use]
    pub fn field(&self, number: usize) -> &[f64] {
        if number == 0 { &self.v } else { self.faces(number - 1) }
    }

    /// The same, to be changed.
    pub fn field_mut(&mut self, number: usize) -> &mut [f64] {
        if number == 0 { &mut self.v } else { self.faces_mut(number - 1) }
    }

    /// The open fractions of layer `k`.
    #[must_use]
    pub fn open_layer(&self, grid: &Grid<f64>, k: usize) -> OpenLayer<'_, f64> {
        let [nx, ny, _] = grid.cells();
        let nth = |k: usize, length: usize| k * length..(k + 1) * length;
        OpenLayer {
            cell: &self.v[nth(k, nx * ny)],
            x: &self.x[nth(k, (nx + 1) * ny)],
            y: &self.y[nth(k, nx * (ny + 1))],
            z: &self.z[nth(k, nx * ny)],
            top: &self.z[nth(k + 1, nx * ny)],
        }
    }

    /// One layer into another set's.
    pub fn copy_layer(&self, k: usize, into: &mut Slices) {
        let copy = |from: &[f64], into: &mut [f64]| into.copy_from_slice(&from[k * into.len()..][..into.len()]);
        copy(&self.v, into.v);
        copy(&self.x, into.x);
        copy(&self.y, into.y);
        copy(&self.z, into.z);
        let top = self.z.len() - into.top.len();
        into.top.copy_from_slice(&self.z[top..]);
    }

    /// Cut into layers; empty fields give empty slices.
    pub fn layers(&mut self, grid: &Grid<f64>) -> Vec<Slices<'_>> {
        let [nx, ny, nz] = grid.cells();
        let FieldSet { v, x, y, z } = self;
        let (mut v, mut x, mut y, mut z) = (&mut v[..], &mut x[..], &mut y[..], &mut z[..]);
        let layers = (0..nz).map(|k| Slices {
            v: split_off(&mut v, nx * ny),
            x: split_off(&mut x, (nx + 1) * ny),
            y: split_off(&mut y, nx * (ny + 1)),
            z: split_off(&mut z, nx * ny),
            top: split_off(&mut z, if k + 1 == nz { nx * ny } else { 0 }),
        });
        layers.collect()
    }
}

impl<'a> Slices<'a> {
    /// As the core takes them.
    pub fn for_core(self) -> LayerSlices<'a, f64> {
        let Slices { v, x, y, z, top } = self;
        LayerSlices::new(v, x, y, z, top)
    }
}

/// The first `count` entries of a slice, which then begins after them.
fn split_off<'a>(slice: &mut &'a mut [f64], count: usize) -> &'a mut [f64] {
    let whole = std::mem::take(slice);
    let (first, rest) = whole.split_at_mut(count.min(whole.len()));
    *slice = rest;
    first
}
