//! Caller's memory for the unions of cells.

use super::bsp::{Node, Part, PendingNode};
use super::descent::Fragment;
use super::octree::{Octant, octree_room};
use super::piece::Piece;
use crate::number::real::Real;

/// Pieces of one body in a cell, and the parts that its own planes cut them into, for which room is asked for at most.
const MOST_OF_ONE: usize = 1 << 14;

/// Caller's memory for the unions of cells; the larger, the more surface a cell may hold. Contents do not matter. The default is
/// none: every cell that bodies share is divided.
#[derive(Debug, Default)]
pub struct UnionMemory<'a, R: Real> {
    /// Pieces of all bodies.
    pub pieces: &'a mut [Piece<R>],
    /// Parts of pieces that were cut while a tree grew.
    pub split_pieces: &'a mut [Piece<R>],
    /// Which pieces and split pieces go where while a tree grows.
    pub order: &'a mut [u32],
    /// Nodes of all trees.
    pub nodes: &'a mut [Node<R>],
    /// Bodies.
    pub parts: &'a mut [Part<R>],
    /// Fragments under way.
    pub fragments: &'a mut [Fragment<R>],
    /// Branches of a tree still to grow.
    pub pending: &'a mut [PendingNode],
    /// Octants of a cell where more than 64 bodies meet. May be empty: then every piece asks every body, which takes the square of their number.
    pub octants: &'a mut [Octant<R>],
    /// Numbers of bodies near octants.
    pub near: &'a mut [u32],
}

/// Lengths of the slices of [`UnionMemory`] that serve cells of up to so many pieces well. Any others do; with less, more cells are divided.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct UnionNeeded {
    /// Of [`UnionMemory::pieces`].
    pub pieces: usize,
    /// Of [`UnionMemory::split_pieces`].
    pub split_pieces: usize,
    /// Of [`UnionMemory::order`].
    pub order: usize,
    /// Of [`UnionMemory::nodes`].
    pub nodes: usize,
    /// Of [`UnionMemory::parts`].
    pub parts: usize,
    /// Of [`UnionMemory::fragments`].
    pub fragments: usize,
    /// Of [`UnionMemory::pending`].
    pub pending: usize,
    /// Of [`UnionMemory::octants`]; none where too few bodies meet to need them.
    pub octants: usize,
    /// Of [`UnionMemory::near`]; likewise.
    pub near: usize,
}

impl<R: Real> UnionMemory<'_, R> {
    /// Lengths for cells of up to so many pieces; [`Layers::union_pieces`](crate::surface::layer::Layers::union_pieces) tells how many there may be.
    #[must_use]
    pub const fn needed(pieces: usize) -> UnionNeeded {
        let fourfold = pieces.saturating_mul(4);
        // Of one body, or of the parts of one polygon under way.
        let of_one = if fourfold < MOST_OF_ONE { fourfold } else { MOST_OF_ONE };
        let at_once = if pieces < of_one { pieces } else { of_one };
        let [octants, near] = octree_room(pieces);
        UnionNeeded {
            pieces,
            split_pieces: of_one,
            order: of_one,
            nodes: fourfold,
            parts: pieces.div_ceil(4),
            fragments: at_once,
            pending: at_once,
            octants,
            near,
        }
    }

    /// The same memory, for a shorter time.
    pub fn reborrow(&mut self) -> UnionMemory<'_, R> {
        UnionMemory {
            pieces: self.pieces,
            split_pieces: self.split_pieces,
            order: self.order,
            nodes: self.nodes,
            parts: self.parts,
            fragments: self.fragments,
            pending: self.pending,
            octants: self.octants,
            near: self.near,
        }
    }
}

/// Memory for the unions of cells with up to `N` pieces in one value, which may stand on the stack, in a static or in a box.
#[derive(Clone, Debug)]
pub struct UnionBuffers<R: Real, const N: usize> {
    pieces: [Piece<R>; N],
    split_pieces: [[Piece<R>; 4]; N],
    order: [[u32; 4]; N],
    nodes: [[Node<R>; 4]; N],
    parts: [Part<R>; N],
    fragments: [Fragment<R>; N],
    pending: [PendingNode; N],
}

impl<R: Real, const N: usize> Default for UnionBuffers<R, N> {
    fn default() -> Self {
        UnionBuffers {
            pieces: core::array::from_fn(|_| Piece::default()),
            split_pieces: core::array::from_fn(|_| core::array::from_fn(|_| Piece::default())),
            order: [[0; 4]; N],
            nodes: [[Node::default(); 4]; N],
            parts: [Part::default(); N],
            fragments: core::array::from_fn(|_| Fragment::default()),
            pending: [PendingNode::default(); N],
        }
    }
}

impl<R: Real, const N: usize> UnionBuffers<R, N> {
    /// Its slices.
    pub fn memory(&mut self) -> UnionMemory<'_, R> {
        UnionMemory {
            pieces: &mut self.pieces,
            split_pieces: self.split_pieces.as_flattened_mut(),
            order: self.order.as_flattened_mut(),
            nodes: self.nodes.as_flattened_mut(),
            parts: &mut self.parts,
            fragments: &mut self.fragments,
            pending: &mut self.pending,
            octants: &mut [],
            near: &mut [],
        }
    }
}
