//! The memory of a thread that computes layers.

use crate::grid::Grid;
use crate::grid::fields::{Fields, ShapeMismatch, at_least};
use crate::number::real::{Real, Vector};
use crate::surface::bins::Group;
use crate::surface::cells::Scratch;
use crate::surface::union::UnionMemory;

/// Lengths of the memory that any layer can do with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MemoryNeeded {
    /// Of scalars; must be met.
    pub reals: usize,
    /// Of flags; must be met.
    pub flags: usize,
    /// Of numbers. With less, cells that bodies share may keep their bounds.
    pub numbers: usize,
    /// Of groups. With less, cells that bodies share may keep their bounds.
    pub groups: usize,
}

/// A thread's memory for layers, cut from the caller's slices.
#[derive(Debug)]
pub struct LayerMemory<'a, V: Vector> {
    pub(super) cells: [usize; 2],
    /// Sums of shares; all zero between two layers.
    pub(super) sum: &'a mut [V::Scalar],
    /// Lower bounds of fields that have no slice of their own.
    pub(super) spare: &'a mut [V::Scalar],
    pub(super) scratch: &'a mut [V::Scalar],
    pub(super) has_surface: &'a mut [u8],
    pub(super) reals: &'a mut [V::Scalar],
    pub(super) flags: &'a mut [u8],
    pub(super) numbers: &'a mut [u32],
    pub(super) groups: &'a mut [Group<V>],
    pub(super) union: UnionMemory<'a, V::Scalar>,
}

impl<'a, V: Vector> LayerMemory<'a, V> {
    /// The least lengths: enough for bodies that share no cells.
    #[must_use]
    pub fn needed(grid: &Grid<V::Scalar>) -> MemoryNeeded {
        let fields = Fields::<u8>::needed(grid);
        MemoryNeeded { reals: 2 * fields + Scratch::needed(grid), flags: fields, numbers: 0, groups: 0 }
    }

    /// Cut memory for layers of `grid`; what the slices hold does not matter. [`crate::surface::layer::Layers::memory_needed`] tells lengths that are always
    /// enough. With less of numbers, groups and `union`, cells that bodies share may keep bounds instead of a value.
    ///
    /// # Errors
    /// [`ShapeMismatch`] if there are too few scalars or flags for a single body.
    pub fn new(
        grid: &Grid<V::Scalar>,
        reals: &'a mut [V::Scalar],
        flags: &'a mut [u8],
        numbers: &'a mut [u32],
        groups: &'a mut [Group<V>],
        union: UnionMemory<'a, V::Scalar>,
    ) -> Result<Self, ShapeMismatch> {
        reals.get_mut(..Fields::<u8>::needed(grid)).unwrap_or_default().fill(V::Scalar::ZERO);
        Self::of_zero_sums(grid, reals, flags, numbers, groups, union)
    }

    /// As [`LayerMemory::new`], without the work of clearing the sums: the first [`Fields::needed`] of `reals` must be zero, as a layer leaves them. What they
    /// hold otherwise counts as shares of a body.
    ///
    /// # Errors
    /// As [`LayerMemory::new`].
    pub fn of_zero_sums(
        grid: &Grid<V::Scalar>,
        reals: &'a mut [V::Scalar],
        flags: &'a mut [u8],
        numbers: &'a mut [u32],
        groups: &'a mut [Group<V>],
        union: UnionMemory<'a, V::Scalar>,
    ) -> Result<Self, ShapeMismatch> {
        let [nx, ny, _] = grid.cells();
        let fields = Fields::<u8>::needed(grid);
        let short = ShapeMismatch { expected: 2 * fields + Scratch::needed(grid), found: reals.len() };
        let (sum, reals) = reals.split_at_mut_checked(fields).ok_or(short)?;
        let (spare, reals) = reals.split_at_mut_checked(fields).ok_or(short)?;
        let (scratch, reals) = reals.split_at_mut_checked(Scratch::needed(grid)).ok_or(short)?;
        at_least(fields, flags.len())?;
        let short = ShapeMismatch { expected: fields, found: flags.len() };
        let (has_surface, flags) = flags.split_at_mut_checked(fields).ok_or(short)?;
        Ok(LayerMemory { cells: [nx, ny], sum, spare, scratch, has_surface, reals, flags, numbers, groups, union })
    }
}
