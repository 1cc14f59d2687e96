//! The binary space partition of a cell by the surface of one body.

use super::extent::Extent;
use super::piece::NoProof::{self, Ambiguous, Full};
use super::piece::{Piece, Place, Plane, cut};
use crate::number::real::Real;
use core::cell::Cell;
use core::ops::Range;

/// Where a branch of a tree leads.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) enum Branch {
    #[default]
    Open,
    Solid,
    Node(u32),
}

/// A plane that divides a part of the cell.
#[derive(Clone, Copy, Debug, Default)]
pub struct Node<R: Real> {
    pub(super) plane: Plane<R>,
    pub(super) positive: Branch,
    pub(super) negative: Branch,
}

/// A body in the cell: its pieces, its tree, and the side from which walls of a face see it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Part<R: Real> {
    pub(super) first: usize,
    pub(super) end: usize,
    pub(super) root: Branch,
    pub(super) below: bool,
    /// So many bodies were added before it.
    pub(super) number: usize,
    pub(super) extent: Extent<R>,
    /// Bodies of different groups are apart.
    pub(super) group: usize,
}

/// A list of pieces still to be made a subtree.
#[derive(Clone, Copy, Debug, Default)]
pub struct PendingNode {
    first: usize,
    end: usize,
    parent: Option<(u32, bool)>,
}

/// Memory in which a tree grows.
pub(super) struct BspMemory<'a, R: Real> {
    pub split_pieces: &'a mut [Piece<R>],
    pub order: &'a mut [u32],
    pub pending: &'a mut [PendingNode],
    pub nodes: &'a mut [Node<R>],
    /// So many nodes there are.
    pub node_count: &'a mut usize,
}

/// Of more pieces than this a plane across an axis divides the crowd, if one serves: every plane of a convex body has all the others behind it, and its tree
/// would be a list.
const CROWD: usize = 96;

/// Such a plane serves if neither of its sides gets more than this share of the pieces.
const MOST: f64 = 0.75;

/// It is so far from the mean of the pieces, as a share of their extent: what is symmetric has faces in the middle.
const ASIDE: f64 = 0.0137;

/// Build the tree of a body, which has surface in the cell: crowds are divided across axes, then the largest piece divides, and the others go to its sides.
pub(super) fn build_bsp<R: Real>(pieces: &[Piece<R>], memory: BspMemory<R>, thickness: R) -> Result<Branch, NoProof> {
    let BspMemory { split_pieces, order, pending, nodes, node_count } = memory;
    let mut builder = BspBuilder { pieces, split_pieces, used: 0, thickness };
    let all = order.get_mut(..pieces.len()).ok_or(Full)?;
    let mut largest = Largest::among(0);
    for (id, (place, piece)) in all.iter_mut().zip(pieces).enumerate() {
        *place = id as u32;
        largest.see(piece.area, id);
    }
    swap(all, 0, largest.at);
    *pending.first_mut().ok_or(Full)? = PendingNode { first: 0, end: pieces.len(), parent: None };
    let (mut open_nodes, root) = (1, *node_count as u32);
    while open_nodes > 0 {
        open_nodes -= 1;
        let PendingNode { first, end, parent } = *pending.get(open_nodes).ok_or(Full)?;
        let number = *node_count as u32;
        let room = order.len().saturating_sub(first);
        let (divider, plane) = builder.divider(order.get(first..end).ok_or(Full)?, room)?;
        *nodes.get_mut(*node_count).ok_or(Full)? = Node { plane, positive: Branch::Open, negative: Branch::Solid };
        *node_count += 1;
        if let Some((node, positive)) = parent {
            let node = nodes.get_mut(node as usize).ok_or(Full)?;
            *(if positive { &mut node.positive } else { &mut node.negative }) = Branch::Node(number);
        }
        let (middle, end) = builder.divide(order, first..end, divider, &plane)?;
        for (first, end, positive) in [(first, middle, false), (middle, end, true)] {
            if end > first {
                *pending.get_mut(open_nodes).ok_or(Full)? =
                    PendingNode { first, end, parent: Some((number, positive)) };
                open_nodes += 1;
            }
        }
    }
    Ok(Branch::Node(root))
}

/// The place of the piece of largest area, the first of equals.
#[derive(Clone, Copy)]
struct Largest<R> {
    area: R,
    at: usize,
}

impl<R: Real> Largest<R> {
    fn among(at: usize) -> Self {
        Largest { area: R::ZERO, at }
    }

    #[inline(always)]
    fn see(&mut self, area: R, at: usize) {
        if area > self.area {
            *self = Largest { area, at };
        }
    }
}

/// Numbers of pieces while they are sorted by a plane: those behind it take the places already read, those before it gather
/// above the end.
struct Sorted<'a, R> {
    order: &'a mut [u32],
    behind: usize,
    before: usize,
    largest: [Largest<R>; 2],
}

impl<'a, R: Real> Sorted<'a, R> {
    fn new(order: &'a mut [u32], first: usize, end: usize) -> Self {
        Sorted { order, behind: first, before: end, largest: [Largest::among(first), Largest::among(end)] }
    }

    /// Put a piece that was at place `p`, or a part of it, behind.
    #[inline(always)]
    fn behind(&mut self, id: u32, area: R, p: usize) -> Result<(), NoProof> {
        // The second half of a full polygon may need room that is not yet free.
        if self.behind > p {
            return Err(Full);
        }
        *self.order.get_mut(self.behind).ok_or(Full)? = id;
        self.largest[0].see(area, self.behind);
        self.behind += 1;
        Ok(())
    }

    #[inline(always)]
    fn before(&mut self, id: u32, area: R) -> Result<(), NoProof> {
        *self.order.get_mut(self.before).ok_or(Full)? = id;
        self.largest[1].see(area, self.before);
        self.before += 1;
        Ok(())
    }

    /// Move both lists together, behind the plane from `first`, the largest first in each; returns where they end.
    fn finish(self, first: usize, end: usize) -> Result<(usize, usize), NoProof> {
        let Sorted { order, behind, before, largest } = self;
        if behind > first {
            swap(order, first, largest[0].at);
        }
        if before > end {
            swap(order, end, largest[1].at);
        }
        let places = Cell::from_mut(order).as_slice_of_cells();
        let (to, from) = (places.get(behind..).ok_or(Full)?, places.get(end..before).ok_or(Full)?);
        to.iter().zip(from).for_each(|(to, from)| to.set(from.get()));
        Ok((behind, behind + before - end))
    }
}

/// The pieces of a body while its tree grows, by number: first those of the cell, then the parts of those that were cut.
struct BspBuilder<'a, R: Real> {
    pieces: &'a [Piece<R>],
    split_pieces: &'a mut [Piece<R>],
    /// So many split pieces there are.
    used: usize,
    thickness: R,
}

impl<R: Real> BspBuilder<'_, R> {
    #[inline(always)]
    fn piece(&self, id: u32) -> Result<&Piece<R>, NoProof> {
        piece(self.pieces, self.split_pieces, id)
    }

    /// The plane that divides some pieces, and the piece whose plane it is, the first; none if it is one between them. There is `room` to sort them in.
    fn divider(&self, pieces: &[u32], room: usize) -> Result<(Option<u32>, Plane<R>), NoProof> {
        if pieces.len() > CROWD
            && let Some(plane) = self.plane_between(pieces, room)
        {
            return Ok((None, plane));
        }
        let first = *pieces.first().ok_or(Full)?;
        Ok((Some(first), self.piece(first)?.plane))
    }

    /// A plane across an axis in which no piece lies, with enough of them on either side and few across.
    #[inline(never)]
    fn plane_between(&self, pieces: &[u32], room: usize) -> Option<Plane<R>> {
        let (mut low, mut high, mut sum) = ([R::INFINITY; 3], [-R::INFINITY; 3], [R::ZERO; 3]);
        for &id in pieces {
            let center = self.piece(id).ok()?.ball.center;
            for axis in 0..3 {
                low[axis] = center[axis].smaller(low[axis]);
                high[axis] = center[axis].larger(high[axis]);
                sum[axis] += center[axis];
            }
        }
        let count = R::from_usize(pieces.len());
        (0..3).find_map(|axis| {
            let mut normal = [R::ZERO; 3];
            normal[axis] = R::ONE;
            let offset = sum[axis] / count + (high[axis] - low[axis]) * R::from_f64(ASIDE);
            let plane = Plane { normal, offset };
            self.serves(&plane, pieces, room).then_some(plane)
        })
    }

    /// Does a plane leave few enough of some pieces to either side, and does what it makes of them find room?
    fn serves(&self, plane: &Plane<R>, pieces: &[u32], room: usize) -> bool {
        let (mut sides, mut across) = ([0_usize; 2], 0);
        for &id in pieces {
            let Ok(piece) = self.piece(id) else { return false };
            match piece.place(plane, self.thickness) {
                Place::Negative => sides[0] += 1,
                Place::Positive => sides[1] += 1,
                Place::Across if !piece.polygon.is_full() => across += 1,
                Place::On | Place::Across => return false,
            }
        }
        let has_room =
            self.used + 2 * across <= self.split_pieces.len() / 2 && pieces.len() + sides[1] + across <= room;
        has_room && R::from_usize(sides[0].max(sides[1]) + across) <= R::from_usize(pieces.len()) * R::from_f64(MOST)
    }

    /// Sort some pieces by the sides of a plane, but the divider, which lies in it: `first..a` behind, `a..b` before, the largest
    /// first in each; returns `(a, b)`. Pieces in the plane are dropped, pieces across are cut.
    fn divide(
        &mut self,
        order: &mut [u32],
        Range { start: first, end }: Range<usize>,
        divider: Option<u32>,
        plane: &Plane<R>,
    ) -> Result<(usize, usize), NoProof> {
        let mut sorted = Sorted::new(order, first, end);
        for p in first + usize::from(divider.is_some())..end {
            let id = *sorted.order.get(p).ok_or(Full)?;
            let piece = self.piece(id)?;
            match piece.place(plane, self.thickness) {
                // Solid thinner than rounding: which side of the plane holds it cannot be told.
                Place::On if piece.backs(self.piece(divider.ok_or(Ambiguous)?)?, self.thickness) => {
                    return Err(Ambiguous);
                }
                Place::On => {}
                Place::Negative => sorted.behind(id, piece.area, p)?,
                Place::Positive => sorted.before(id, piece.area)?,
                Place::Across if piece.polygon.is_full() => {
                    for half in self.halve(id)? {
                        self.cut(half, plane, p, &mut sorted)?;
                    }
                }
                Place::Across => self.cut(id, plane, p, &mut sorted)?,
            }
        }
        sorted.finish(first, end)
    }

    /// Sort the parts of a piece that is not full, at place `p`; parts without area are dropped.
    fn cut(&mut self, id: u32, plane: &Plane<R>, p: usize, sorted: &mut Sorted<R>) -> Result<(), NoProof> {
        let (whole, [negative, positive], numbers) = self.two_parts(id)?;
        cut(&whole.polygon, plane, &mut negative.polygon, &mut positive.polygon);
        negative.become_part_of(whole);
        positive.become_part_of(whole);
        if negative.area > R::ZERO {
            sorted.behind(numbers[0], negative.area, p)?;
        }
        if positive.area > R::ZERO {
            sorted.before(numbers[1], positive.area)?;
        }
        Ok(())
    }

    /// The two halves of a piece with too many corners to be cut.
    fn halve(&mut self, id: u32) -> Result<[u32; 2], NoProof> {
        let (whole, split_pieces, numbers) = self.two_parts(id)?;
        for (part, half) in split_pieces.iter_mut().zip(whole.polygon.halves()) {
            part.polygon = half;
            part.become_part_of(whole);
        }
        Ok(numbers)
    }

    /// A piece, two new split pieces, and their numbers.
    #[expect(clippy::type_complexity, reason = "a name would say no more")]
    fn two_parts(&mut self, id: u32) -> Result<(&Piece<R>, &mut [Piece<R>; 2], [u32; 2]), NoProof> {
        let (made, free) = self.split_pieces.split_at_mut_checked(self.used).ok_or(Full)?;
        let two = free.first_chunk_mut().ok_or(Full)?;
        let number = (self.pieces.len() + self.used) as u32;
        self.used += 2;
        Ok((piece(self.pieces, made, id)?, two, [number, number + 1]))
    }
}

#[inline(always)]
fn piece<'a, R: Real>(pieces: &'a [Piece<R>], split_pieces: &'a [Piece<R>], id: u32) -> Result<&'a Piece<R>, NoProof> {
    let id = id as usize;
    pieces.get(id).or_else(|| split_pieces.get(id - pieces.len())).ok_or(Full)
}

/// Exchange two entries, if there are both.
#[inline(always)]
fn swap(order: &mut [u32], a: usize, b: usize) {
    if let (Some(&at_a), Some(&at_b)) = (order.get(a), order.get(b)) {
        for (place, id) in [(a, at_b), (b, at_a)] {
            order.get_mut(place).into_iter().for_each(|place| *place = id);
        }
    }
}
