//! Where many bodies meet in one cell: which of them have solid near a polygon.
//!
//! An octree of the cell, or of each part of it that planes separate from the others ([`separate`](super::separate)), grown where it is asked. Each octant lists the bodies that have solid in a box of [`REACH`] times its width about its centre, so
//! that a polygon whose ball stays within the box need not go down the trees of the others. Of bodies about one centre few reach any small octant on the
//! surface of their union.

use super::piece::{Ball, Plane};
use super::separate::{Bodies, is_before};
use crate::number::real::Real;
use crate::surface::clip::Polygon;
use core::ops::Range;

/// Where no more bodies than this meet, lists cost more than they save.
const MANY: usize = 64;

/// Lists as short as this are not shortened further.
const SHORT: usize = 64;

/// Width of the box that the list of an octant holds for, in widths of the octant.
const REACH: f64 = 2.0;

/// A plane of which this share of the bodies reaches one of its sides separates too few.
const MOST: f64 = 0.75;

/// A child that is not made yet, and one that memory does not allow.
const UNKNOWN: u32 = 0;
const NONE: u32 = u32::MAX;

/// A cube of the octree, in the frame of the cell; of one that a plane divides, the sides.
#[derive(Clone, Copy, Debug, Default)]
pub struct Octant<R: Real> {
    center: [R; 3],
    /// Half of its width.
    half: R,
    /// Its list: numbers of bodies, rising.
    first: u32,
    end: u32,
    children: [u32; 8],
    /// A plane that separates the bodies of its list, if there are octants for what is behind and before it.
    plane: Plane<R>,
    sides: Option<[u32; 2]>,
}

/// Pieces of a body in a cell, as [`Layers::union_pieces`](crate::surface::layer::Layers::union_pieces) counts them.
const PIECES_EACH: usize = 16;

/// Octants and numbers of bodies near them that serve a cell of up to so many pieces well; none where too few bodies meet to need them.
pub(super) const fn octree_room(pieces: usize) -> [usize; 2] {
    if pieces > MANY * PIECES_EACH { [pieces, pieces.saturating_mul(64)] } else { [0, 0] }
}

/// A polygon that is cut before it has passed so many bodies is not looked up again.
const FIRST: u32 = 32;

/// Which bodies a polygon still has to ask.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ToAsk {
    /// What is left of its list.
    next: u32,
    end: u32,
    /// From which body on it is looked up again.
    again: u32,
    /// It has a list shorter than that of all bodies.
    pub is_listed: bool,
}

/// How much of the memory is in use; nothing while there is no octree.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct OctreeSize {
    octants: usize,
    near: usize,
}

/// The octree of a cell.
pub(super) struct Octree<'a, R: Real> {
    pub octants: &'a mut [Octant<R>],
    /// All lists.
    pub near: &'a mut [u32],
    pub size: &'a mut OctreeSize,
    pub bodies: Bodies<'a, R>,
}

impl<R: Real> Octree<'_, R> {
    /// Begin with the whole cell, and what planes separate in it, if many bodies meet and memory allows.
    pub fn begin(&mut self, separate: bool) {
        let count = self.bodies.parts.len();
        if self.size.octants == 0 && count > MANY {
            let (Some(root), Some(all)) = (self.octants.first_mut(), self.near.get_mut(..count)) else { return };
            for (number, place) in all.iter_mut().enumerate() {
                *place = number as u32;
            }
            *root = Octant { center: [R::HALF; 3], half: R::HALF, end: count as u32, ..Octant::default() };
            *self.size = OctreeSize { octants: 1, near: count };
            if separate {
                self.separate();
            }
        }
    }

    /// Separate the bodies of the cell by planes as long as that leaves fewer on each side, and memory allows.
    fn separate(&mut self) {
        let mut number = 0;
        while number < self.size.octants {
            self.divide(number);
            number += 1;
        }
    }

    /// Divide the list of an octant by a plane; none if there is no plane that serves, or memory is spent.
    fn divide(&mut self, number: usize) -> Option<()> {
        let parent = *self.octants.get(number)?;
        let whole = parent.first as usize..parent.end as usize;
        if whole.len() <= SHORT {
            return None;
        }
        let plane = self.bodies.best_plane(self.near.get(whole.clone())?)?;
        let (bodies, near) = (self.bodies, self.size.near);
        let middle = self.list(whole.clone(), near, |body| bodies.reach(body, &plane).behind)?;
        let end = self.list(whole.clone(), middle, |body| bodies.reach(body, &plane).before)?;
        let longest = (middle - near).max(end - middle);
        if R::from_usize(longest) > R::from_usize(whole.len()) * R::from_f64(MOST) {
            return None;
        }
        let first = self.size.octants;
        let lists = [near..middle, middle..end];
        for (place, list) in self.octants.get_mut(first..first + 2)?.iter_mut().zip(lists) {
            *place = Octant { first: u32::try_from(list.start).ok()?, end: u32::try_from(list.end).ok()?, ..parent };
        }
        let parent = self.octants.get_mut(number)?;
        (parent.plane, parent.sides) = (plane, Some([first as u32, first as u32 + 1]));
        (self.size.octants, self.size.near) = (first + 2, end);
        Some(())
    }

    /// Write those of a list for which something is true from a place on; where they end.
    fn list(&mut self, of: Range<usize>, at: usize, is_true: impl Fn(u32) -> bool) -> Option<usize> {
        let mut end = at;
        for place in of {
            let body = *self.near.get(place)?;
            if is_true(body) {
                *self.near.get_mut(end)? = body;
                end += 1;
            }
        }
        Some(end)
    }

    /// The last octant to which planes lead a polygon of a radius.
    fn beside_planes(&self, polygon: &Polygon<R>, radius: R) -> u32 {
        let mut number = 0;
        while let Some(Octant { plane, sides: Some([behind, before]), .. }) = self.octants.get(number as usize)
            && let Some(is_before) = is_before(polygon, radius, plane, self.bodies.thickness)
        {
            number = if is_before { *before } else { *behind };
        }
        number
    }

    /// The first body from `from` on, but `own`, that may meet a polygon that has been located; one beyond the last if there is none.
    #[inline(never)]
    pub fn next_body(&self, at: &mut ToAsk, from: usize, own: Option<usize>) -> usize {
        while at.next < at.end
            && let Some(&body) = self.near.get(at.next as usize)
        {
            if body as usize >= from && Some(body as usize) != own {
                return body as usize;
            }
            at.next += 1;
        }
        self.bodies.parts.len()
    }

    /// Find the smallest octant whose list holds for a polygon in a ball, which has passed the bodies before `from`. Polygons shrink as they pass bodies, so
    /// it is done as often as the number of passed bodies has doubled.
    #[inline(never)]
    pub fn locate(&mut self, at: &mut ToAsk, polygon: &Polygon<R>, ball: &Ball<R>, from: usize) {
        if self.size.octants == 0 || from < at.again as usize {
            return;
        }
        let (mut octant, from) = (self.beside_planes(polygon, ball.radius), from as u32);
        while let Some(child) = self.child(octant, ball) {
            octant = child;
        }
        let Some(Octant { first, end, .. }) = self.octants.get(octant as usize).copied() else { return };
        let list = self.near.get(first as usize..end as usize).unwrap_or_default();
        let passed = list.partition_point(|&body| body < from) as u32;
        *at = ToAsk { next: first + passed, end, again: from.saturating_mul(2).max(FIRST), is_listed: octant > 0 };
    }

    /// The child of an octant that a ball is in, if its list may be shorter and holds for all of the ball.
    fn child(&mut self, octant: u32, ball: &Ball<R>) -> Option<u32> {
        let parent = *self.octants.get(octant as usize)?;
        let half = parent.half * R::HALF;
        let high = [0, 1, 2].map(|axis| ball.center[axis] > parent.center[axis]);
        let center = [0, 1, 2].map(|axis| parent.center[axis] + if high[axis] { half } else { -half });
        let room = half * R::from_f64(REACH) - ball.radius;
        let within = (0..3).all(|axis| (ball.center[axis] - center[axis]).abs() <= room);
        if parent.end - parent.first <= SHORT as u32 || !within {
            return None;
        }
        let which = usize::from(high[0]) + 2 * usize::from(high[1]) + 4 * usize::from(high[2]);
        match *parent.children.get(which)? {
            NONE => None,
            UNKNOWN => {
                let made = self.make(&parent, center, half);
                *self.octants.get_mut(octant as usize)?.children.get_mut(which)? = made.unwrap_or(NONE);
                made
            }
            child => Some(child),
        }
    }

    /// Make a child, if memory allows.
    fn make(&mut self, parent: &Octant<R>, center: [R; 3], half: R) -> Option<u32> {
        let (first, number, bodies) = (self.size.near, self.size.octants, self.bodies);
        let (whole, reach) = (parent.first as usize..parent.end as usize, half * R::from_f64(REACH));
        let end = self.list(whole.clone(), first, |body| bodies.has_solid(body, center, reach))?;
        // A list that saves little is not kept.
        let kept = (end - first) * 4 <= whole.len() * 3;
        let (first, end) = match kept {
            true => (u32::try_from(first).ok()?, u32::try_from(end).ok()?),
            false => (parent.first, parent.end),
        };
        *self.octants.get_mut(number)? = Octant { center, half, first, end, ..Octant::default() };
        self.size.octants += 1;
        if kept {
            self.size.near = end as usize;
        }
        Some(number as u32)
    }
}
