//! Cells divided until bounds are close, as far as depth, memory and effort allow.

use crate::grid::Grid;
use crate::number::aabb::Aabb;
use crate::number::real::{Real, Vector};
use crate::surface::bins::{Bins, Group};
use crate::surface::other_bodies::OtherBodies;
use crate::surface::refined::{Parts, Refined};
use crate::surface::union::UnionMemory;
use core::ops::Range;

/// What all levels of division share.
pub(super) struct Shared<'s, V: Vector, O> {
    /// Bounds this close need no division.
    pub tol: V::Scalar,
    /// Bodies beside those of triangles.
    pub others: &'s mut O,
    /// Memory for one exact union at a time.
    pub union: UnionMemory<'s, V::Scalar>,
    /// How the parts of a cell are found: a function of [`crate::surface::layer`], passed because `layer` imports this file.
    pub parts: FindParts<V, O>,
    /// What the division of one cell has cost so far.
    pub effort: Effort,
}

/// Most triangles sorted while one cell is divided; or [`MOST_TIMES`] those of its first part, if these are more. Where surface meets so densely that
/// halving does not thin it, division stops here and the cell keeps the bounds that it has.
const MOST_EFFORT: usize = 1 << 17;

/// Where halving thins a cell, six levels sort each triangle some thirty times, which is some sixty times those of its first part.
const MOST_TIMES: usize = 64;

/// What the division of a cell has cost.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Effort {
    /// Depth of the part at hand; 0 for a whole cell.
    level: u32,
    /// Triangles sorted for parts of this cell, and those of tries that gave no proof.
    pub triangles: usize,
    /// So many may be.
    most: usize,
}

/// Finds the bounds of a small grid of at most 2 × 2 × 2 cells from the triangles of some layers of a site; none if depth or memory
/// is spent.
pub(super) type FindParts<V, O> = fn(
    &mut Shared<V, O>,
    &Site<V>,
    &Grid<<V as Vector>::Scalar>,
    Range<usize>,
    SpareMemory<V>,
) -> Option<Parts<<V as Vector>::Scalar>>;

/// A layer of a grid, the triangles sorted into it, and how often its cells may still be halved along some axis.
#[derive(Clone, Copy)]
pub(super) struct Site<'a, V: Vector> {
    pub grid: &'a Grid<'a, V::Scalar>,
    pub bins: &'a Bins<'a, V>,
    pub k: usize,
    pub halvings: u32,
    /// Faces are wanted.
    pub areas: bool,
}

/// Memory of one level of division; what it leaves serves the levels below.
pub(super) struct SpareMemory<'m, V: Vector> {
    pub reals: &'m mut [V::Scalar],
    pub flags: &'m mut [u8],
    pub numbers: &'m mut [u32],
    pub groups: &'m mut [Group<V>],
}

impl<V: Vector> SpareMemory<'_, V> {
    /// The same memory for a shorter time.
    pub fn reborrow(&mut self) -> SpareMemory<'_, V> {
        SpareMemory { reals: self.reals, flags: self.flags, numbers: self.numbers, groups: self.groups }
    }
}

/// Finds the parts of a cell or of a part of one; none if depth, memory or effort is spent.
pub(super) fn find_parts<V: Vector, O: OtherBodies<V>>(
    shared: &mut Shared<V, O>,
    site: &Site<V>,
    grid: &Grid<V::Scalar>,
    layers: Range<usize>,
    spare: SpareMemory<V>,
) -> Option<Parts<V::Scalar>> {
    with_effort(shared, site, layers.clone(), |shared| (shared.parts)(shared, site, grid, layers, spare))
}

/// Divides a cell, or a part of one that holds the triangles of some layers of a site; none if the effort is spent.
pub(super) fn with_effort<V: Vector, O, T>(
    shared: &mut Shared<V, O>,
    site: &Site<V>,
    layers: Range<usize>,
    division: impl FnOnce(&mut Shared<V, O>) -> Option<T>,
) -> Option<T> {
    // The layer of a whole grid holds more than one of its cells: what is sorted for that is not counted.
    if shared.effort.level == 0 {
        shared.effort = Effort { most: MOST_EFFORT, ..Effort::default() };
    } else {
        let here: usize = layers.map(|k| site.bins.count(k).numbers).sum();
        shared.effort.triangles = shared.effort.triangles.saturating_add(here);
        if shared.effort.level == 1 {
            shared.effort.most = shared.effort.most.max(here.saturating_mul(MOST_TIMES));
        }
    }
    if shared.effort.triangles > shared.effort.most {
        return None;
    }
    shared.effort.level += 1;
    let found = division(shared);
    shared.effort.level -= 1;
    found
}

/// Bounds of a cell from its parts, halves along the axes in which it is longest; none if the depth is spent.
pub(super) fn divide<V: Vector, O: OtherBodies<V>>(
    shared: &mut Shared<V, O>,
    site: &Site<V>,
    cell: Aabb<V>,
    spare: SpareMemory<V>,
) -> Option<Refined<V::Scalar>> {
    let size = cell.size().to_array();
    let longest = size.into_iter().fold(V::Scalar::ZERO, Real::max);
    let halved = size.map(|s| s > longest * V::Scalar::HALF);
    let (lo, hi) = (cell.min.to_array(), cell.max.to_array());
    let edges = [0, 1, 2].map(|a| [lo[a], if halved[a] { lo[a] + size[a] * V::Scalar::HALF } else { hi[a] }, hi[a]]);
    let list = |a: usize| if halved[a] { &edges[a][..] } else { &edges[a][..2] };
    let grid = Grid::new(list(0), list(1), list(2)).ok()?;
    let halvings = halved.iter().map(|&h| u32::from(h)).sum();
    let part = Site { halvings: site.halvings.checked_sub(halvings)?, ..*site };
    let parts = find_parts(shared, &part, &grid, site.k..site.k + 1, spare)?;
    Some(Refined::from_parts(&parts, grid.cells()))
}
