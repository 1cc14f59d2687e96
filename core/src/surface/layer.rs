//! The public interface of this module: porosity of the layers of a grid from bodies of triangles, overlaps counted once.
//!
//! [`Layers`] checks bodies and sorts their triangles by layer, once. [`Layers::layer`] then gives the open fractions of one layer of cells
//! and of its faces: each body's share by [`crate::surface::cells`] and [`crate::surface::z_faces`], exact unions where bodies share
//! cells, and where a union has no proof the cell is divided, each part a layer of its own in what is left of the caller's memory. If
//! depth or memory is spent, what remains are bounds, and [`LayerReport::max_gap`] says how wide.
//!
//! A layer needs no result of another, so threads may share [`Layers`]; each has a [`LayerMemory`] of its own.

mod error;
mod fractions;
mod memory;
mod parts;
mod report;
mod shadows;
mod slices;
mod solid_bounds;
mod surface_areas;
mod weighted_areas;

pub use error::LayerError;
pub use memory::{LayerMemory, MemoryNeeded};
pub use report::{CellKinds, LayerReport};
pub use shadows::ShadowReport;
pub use slices::LayerSlices;
pub use surface_areas::{AreaReport, AreaSlices, CellSides, KnownSurface, LayerReports, OpenLayer};

use crate::grid::Grid;
use crate::grid::fields::{Fields, Layer};
use crate::number::real::{Real, Vector};
use crate::surface::bins::{Bins, BinsError, BinsNeeded, Group, Surface};
use crate::surface::cell_unions::UnionSums;
use crate::surface::cells::Scratch;
use crate::surface::division::{Effort, Shared, Site, SpareMemory};
use crate::surface::error::Defects;
use crate::surface::other_bodies::OtherBodies;
use fractions::{count_cells, open_field, to_open_fractions};
use parts::{LEVEL, parts};
use solid_bounds::{solid_bounds, solid_bounds_on_top};

/// A cell is not halved more often along an axis: its middle would be one of its ends.
const MOST_HALVINGS: u32 = f64::MANTISSA_DIGITS;

/// What to compute and how far to refine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayerOptions<R> {
    /// Where a union has no proof, divide the cell until its bounds are this close.
    pub tol: R,
    /// How often such a cell may be divided by 2 along each axis.
    pub depth: u32,
    /// Compute the faces; without, their slices are empty.
    pub areas: bool,
    /// Where between its bounds a value lies: 0 at the open end, 1 at the solid one.
    pub solid_end: R,
}

impl<R: Real> Default for LayerOptions<R> {
    /// Bounds as close as 10⁻⁴, at most 6 divisions, faces, values in the middle of their bounds.
    fn default() -> Self {
        LayerOptions { tol: R::from_f64(1e-4), depth: 6, areas: true, solid_end: R::HALF }
    }
}

/// Where the values of a layer go, and their bounds, lower and upper, if wanted.
type BetaAndBounds<'a, R> = (LayerSlices<'a, R>, Option<[LayerSlices<'a, R>; 2]>);

/// Bodies in a grid, sorted by layer. Threads may share it.
#[derive(Clone, Copy, Debug)]
pub struct Layers<'a, V: Vector> {
    grid: Grid<'a, V::Scalar>,
    bins: Bins<'a, V>,
    options: LayerOptions<V::Scalar>,
}

impl<'a, V: Vector> Layers<'a, V> {
    /// Memory for [`Layers::new`].
    #[must_use]
    pub fn needed(grid: &Grid<V::Scalar>, bodies: &[Surface<V>]) -> BinsNeeded {
        Bins::needed(grid, bodies.iter().copied())
    }

    /// Memory for [`Layers::new`] and for [`LayerMemory::new`], told before anything is sorted and so without a list of the bodies: as
    /// [`Layers::needed`] and [`Layers::memory_needed`].
    #[must_use]
    pub fn all_needed<'b>(
        grid: &Grid<V::Scalar>,
        bodies: impl Iterator<Item = Surface<'b, V>> + Clone,
        options: LayerOptions<V::Scalar>,
    ) -> (BinsNeeded, MemoryNeeded) {
        let most = Bins::most_in_two_layers(grid, bodies.clone());
        (Bins::needed(grid, bodies), memory_for(grid, options, most))
    }

    /// Sort the triangles of `bodies` into the layers of `grid`, in memory of the caller; what the slices hold does not matter.
    ///
    /// # Errors
    /// [`BinsError`]: a coordinate that is no number, memory that is too small.
    pub fn new(
        grid: &Grid<'a, V::Scalar>,
        bodies: &'a [Surface<'a, V>],
        options: LayerOptions<V::Scalar>,
        numbers: &'a mut [u32],
        groups: &'a mut [Group<V>],
    ) -> Result<Self, BinsError> {
        Ok(Layers { grid: *grid, bins: Bins::new(grid, bodies, numbers, groups)?, options })
    }

    /// Lengths of the memory with which any layer is refined as far as the depth allows.
    #[must_use]
    pub fn memory_needed(&self) -> MemoryNeeded {
        let mut most = BinsNeeded::default();
        for k in 0..self.grid.cells()[2] {
            let (a, b) = (self.bins.count(k), self.bins.count(k + 1));
            most.numbers = most.numbers.max(a.numbers + b.numbers);
            most.groups = most.groups.max(a.groups + b.groups);
        }
        memory_for(&self.grid, self.options, most)
    }

    /// How many bodies of triangles reach layer `k`.
    #[must_use]
    pub fn bodies_in(&self, k: usize) -> usize {
        self.bins.groups(k).len()
    }

    /// Pieces of surface for which [`UnionMemory`](crate::surface::union::UnionMemory) should have room: as many as there are triangles in the fullest layer,
    /// for they may all be in one cell, up to 64 for each body; 1024 to 32 768. With less, more cells are divided.
    #[must_use]
    pub fn union_pieces(&self) -> usize {
        let in_layer = |k: usize| {
            let BinsNeeded { numbers, groups } = self.bins.count(k);
            numbers.min(groups.saturating_mul(64)).max(groups.saturating_mul(16))
        };
        let most = (0..self.grid.cells()[2]).map(in_layer).max().unwrap_or(0);
        most.clamp(1 << 10, 1 << 15).next_power_of_two()
    }

    /// Open fractions of layer `k`: 1 open, 0 blocked, the value between its bounds as the options say. `bounds` are those of the same
    /// fractions, lower and upper, if wanted.
    ///
    /// # Errors
    /// [`LayerError`]: no such layer, slices of wrong length, memory of another grid.
    pub fn layer(
        &self,
        k: usize,
        beta: LayerSlices<V::Scalar>,
        bounds: Option<[LayerSlices<V::Scalar>; 2]>,
        memory: &mut LayerMemory<V>,
    ) -> Result<LayerReport<V::Scalar>, LayerError> {
        for field in [&mut *beta.cell, beta.x, beta.y, beta.z] {
            field.fill(V::Scalar::ZERO);
        }
        self.zeroed_layer(k, beta, bounds, memory, &mut (), |_, _| ())
    }

    /// As [`Layers::layer`], for slices of `beta` that hold zeros; with bodies beside those of triangles, and a function that is told what
    /// is wrong with each body's surface in this layer.
    ///
    /// # Errors
    /// [`LayerError`]: no such layer, slices of wrong length, memory of another grid.
    pub fn zeroed_layer<O: OtherBodies<V>>(
        &self,
        k: usize,
        beta: LayerSlices<V::Scalar>,
        bounds: Option<[LayerSlices<V::Scalar>; 2]>,
        memory: &mut LayerMemory<V>,
        others: &mut O,
        each_body: impl FnMut(usize, Defects<V::Scalar>),
    ) -> Result<LayerReport<V::Scalar>, LayerError> {
        self.measure(k, (beta, bounds), memory, (others, &mut ()), each_body)
    }

    /// Open fractions of layer `k`, and what `pieces` makes of the surface in it. Inline: a call would hold all slices twice on the stack.
    #[inline(always)]
    fn measure<O: OtherBodies<V>, P: UnionSums<V>>(
        &self,
        k: usize,
        (beta, mut bounds): BetaAndBounds<V::Scalar>,
        memory: &mut LayerMemory<V>,
        (others, pieces): (&mut O, &mut P),
        each_body: impl FnMut(usize, Defects<V::Scalar>),
    ) -> Result<LayerReport<V::Scalar>, LayerError> {
        self.check(k, &beta, bounds.as_ref(), memory)?;
        let LayerSlices { cell, x, y, z, top } = beta;
        let LayerOptions { tol, depth, areas, solid_end } = self.options;
        let LayerMemory { sum, spare, scratch, has_surface, reals, flags, numbers, groups, union, .. } = memory;
        let mut shared = Shared { tol, others, union: union.reborrow(), parts, effort: Effort::default() };
        let site = Site { grid: &self.grid, bins: &self.bins, k, halvings: 3 * depth.min(MOST_HALVINGS), areas };
        let mut divisions = SpareMemory { reals, flags, numbers, groups };
        let mut layer = Layer {
            lower: Fields::within(&self.grid, spare)?,
            sum: Fields::within(&self.grid, sum)?,
            has_surface: Fields::within(&self.grid, has_surface)?,
        };
        let mut scratch = Scratch::new(&self.grid, scratch)?;
        layer.has_surface.fill(0);
        let mut wanted = layer.reborrow();
        if areas {
            wanted.lower = Fields::new(&self.grid, cell, x, y, z)?;
        } else {
            (0..3).for_each(|axis| wanted.lower.faces_mut(axis).fill(V::Scalar::ZERO));
            wanted.lower.cell = cell;
        }
        let mut report =
            solid_bounds(&mut shared, &site, &mut wanted, &mut scratch, divisions.reborrow(), pieces, each_body);
        count_cells(&site, &wanted, solid_end, &mut report);
        to_open_fractions(&mut wanted, areas, bounds.as_mut(), solid_end, &mut report.max_gap);
        if !top.is_empty() {
            solid_bounds_on_top(&mut shared, &site, &mut layer, &mut scratch, divisions);
            let [low, high] = match &mut bounds {
                Some([low, high]) => [Some(&mut *low.top), Some(&mut *high.top)],
                None => [None, None],
            };
            open_field(layer.lower.z, layer.sum.z, low, high, solid_end, &mut report.max_gap);
            top.iter_mut().zip(&*layer.lower.z).for_each(|(top, z)| *top = *z);
        }
        Ok(report)
    }

    /// Cells along x and y of layer `k`, if there is such a layer, and if memory is given, it is of this grid.
    fn cells_of_layer(&self, k: usize, memory: Option<&LayerMemory<V>>) -> Result<[usize; 2], LayerError> {
        let [nx, ny, layers] = self.grid.cells();
        if k >= layers {
            return Err(LayerError::NoLayer { layer: k, layers });
        }
        if memory.is_some_and(|memory| memory.cells != [nx, ny]) {
            return Err(LayerError::OtherGrid);
        }
        Ok([nx, ny])
    }

    fn check(
        &self,
        k: usize,
        beta: &LayerSlices<V::Scalar>,
        bounds: Option<&[LayerSlices<V::Scalar>; 2]>,
        memory: &LayerMemory<V>,
    ) -> Result<(), LayerError> {
        self.cells_of_layer(k, Some(memory))?;
        for slices in core::iter::once(beta).chain(bounds.into_iter().flatten()) {
            slices.check(&self.grid, k, self.options.areas)?;
        }
        Ok(())
    }
}

/// Lengths of the memory with which any layer is refined as far as the depth allows; `most` is what two layers hold, one above the other.
fn memory_for<R: Real>(grid: &Grid<R>, options: LayerOptions<R>, most: BinsNeeded) -> MemoryNeeded {
    let [nx, ny, _] = grid.cells();
    let levels = 3 * options.depth.min(MOST_HALVINGS) as usize + 1;
    // A part of a cell takes triangles of one layer, or of two beside a wall, each in at most two layers of its own and in a row.
    let each = 3 * levels;
    let least = LayerMemory::<R::Vector>::needed(grid);
    MemoryNeeded {
        reals: least.reals + levels * LEVEL.reals,
        flags: least.flags + levels * LEVEL.flags,
        numbers: 2 * (nx + ny + 2) + most.numbers.saturating_mul(each) + levels * LEVEL.numbers,
        groups: most.groups.saturating_mul(each),
    }
}
