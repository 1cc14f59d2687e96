//! Where many bodies meet in one cell: planes that have some of them on one side and the others beyond.
//!
//! Bodies around an axis or a point, as wedges of a wheel or the cones of a star, are near each other in every box about it, but any plane of a face that
//! passes the axis has nearly all of them wholly on one of its sides. What lies on one side of such a plane meets only bodies that reach into that side.
//!
//! A polygon in the plane, or so little inclined to it that much of it is as near as rounding, asks all.

use super::bsp::{Branch, Node, Part};
use super::extent::Extent;
use super::piece::{AMBIGUITY_BAND, Piece, Plane, span};
use crate::number::real::Real;
use crate::number::space::dot;
use crate::surface::clip::Polygon;
use heapless::Vec;

/// Branches of a tree that a cube may reach at the same time; beyond, it is taken to meet solid.
const BRANCHES: usize = 32;

/// Bodies whose faces are tried for a plane, and pieces of each that are tried.
const TRIED: [usize; 2] = [4, 8];

/// Bodies by which the planes that are tried are compared.
const COMPARED: usize = 16;

/// A polygon lies on one side of a plane if it reaches farther there than this share of the radius of a ball around it: then what is as near to the plane as
/// rounding is a sliver.
const INCLINED: f64 = 0.01;

/// What is known of the bodies of a cell.
#[derive(Clone, Copy)]
pub(super) struct Bodies<'a, R: Real> {
    pub parts: &'a [Part<R>],
    pub pieces: &'a [Piece<R>],
    pub nodes: &'a [Node<R>],
    /// Lowest and highest corner of the cell, in its own frame, of bodies that are not marked `below`, and of those that are.
    pub cells: &'a [[[R; 3]; 2]; 2],
    pub thickness: R,
}

/// Which sides of a plane something reaches.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Reach {
    pub behind: bool,
    pub before: bool,
}

impl<R: Real> Bodies<'_, R> {
    /// The sides of a plane that the solid of a body in its cell reaches. Its corners are those of its pieces, and the corners of the cell that are solid.
    pub fn reach(&self, body: u32, plane: &Plane<R>) -> Reach {
        let mut reach = Reach::default();
        let Some(part) = self.parts.get(body as usize) else { return reach };
        let mut see = |distance: R| {
            reach.behind |= distance < -self.thickness;
            reach.before |= distance > self.thickness;
        };
        for piece in self.pieces.get(part.first..part.end).unwrap_or_default() {
            let (least, most) = span(&piece.polygon, plane);
            see(least);
            see(most);
        }
        self.solid_corners(body).for_each(|corner| see(plane.distance(corner)));
        reach
    }

    /// The extent of the solid of a body in its cell.
    pub fn extent(&self, body: u32) -> Extent<R> {
        let mut extent = Extent::default();
        let Some(part) = self.parts.get(body as usize) else { return extent };
        for piece in self.pieces.get(part.first..part.end).unwrap_or_default() {
            piece.polygon.corners().iter().for_each(|corner| extent.see(*corner));
        }
        self.solid_corners(body).for_each(|corner| extent.see(corner));
        extent
    }

    /// The corners of its cell that a body may fill.
    fn solid_corners(&self, body: u32) -> impl Iterator<Item = [R; 3]> {
        let below = self.parts.get(body as usize).is_some_and(|part| part.below);
        let cell = &self.cells[usize::from(below)];
        let corners = (0..8).map(|corner| [0, 1, 2].map(|axis| cell[corner >> axis & 1][axis]));
        corners.filter(move |corner| self.has_solid(body, *corner, R::ZERO))
    }

    /// Whether a body may have solid in the cube of a centre and half a width; if unsure, yes.
    #[inline(never)]
    pub fn has_solid(&self, body: u32, center: [R; 3], half: R) -> bool {
        let Some(part) = self.parts.get(body as usize) else { return false };
        let clear = self.thickness * R::from_f64(AMBIGUITY_BAND);
        let mut waiting: Vec<Branch, BRANCHES> = Vec::new();
        let mut next = Some(part.root);
        while let Some(branch) = next {
            next = match branch {
                Branch::Solid => return true,
                Branch::Open => waiting.pop(),
                Branch::Node(n) => {
                    let Some(node) = self.nodes.get(n as usize) else { return true };
                    let [x, y, z] = node.plane.normal.map(R::abs);
                    let (distance, reach) = (node.plane.distance(center), half * (x + y + z) + clear);
                    if distance > reach {
                        Some(node.positive)
                    } else {
                        if !(distance < -reach) && waiting.push(node.positive).is_err() {
                            return true;
                        }
                        Some(node.negative)
                    }
                }
            };
        }
        false
    }

    /// Of the planes of some faces of listed bodies, that which leaves the fewest to the side that more bodies reach.
    pub fn best_plane(&self, list: &[u32]) -> Option<Plane<R>> {
        let (mut best, mut fewest) = (None, list.len().min(COMPARED));
        let mut last: Option<Plane<R>> = None;
        for body in spread(list, TRIED[0]) {
            let part = self.parts.get(body as usize)?;
            for Piece { plane, .. } in self.pieces.get(part.first..part.end)?.iter().take(TRIED[1]) {
                // The next triangle of a flat face.
                let is_last = |last: Plane<R>| dot(last.normal, plane.normal) > R::ONE - R::from_f64(INCLINED);
                if last.replace(*plane).is_some_and(is_last) {
                    continue;
                }
                let mut count = [0; 2];
                for body in spread(list, COMPARED) {
                    let Reach { behind, before } = self.reach(body, plane);
                    count[0] += usize::from(behind);
                    count[1] += usize::from(before);
                }
                let most = count[0].max(count[1]);
                if most < fewest {
                    (best, fewest) = (Some(*plane), most);
                }
            }
        }
        best
    }
}

/// So many of a list, evenly spread, or all.
fn spread(list: &[u32], most: usize) -> impl Iterator<Item = u32> {
    let count = list.len().min(most);
    (0..count).filter_map(move |n| list.get((2 * n + 1) * list.len() / (2 * count)).copied())
}

/// Where a polygon in a ball of a radius lies: before a plane (true), behind it, or, if it may meet what is on both of its sides, neither.
pub(super) fn is_before<R: Real>(polygon: &Polygon<R>, radius: R, plane: &Plane<R>, thickness: R) -> Option<bool> {
    let ((least, most), inclined) = (span(polygon, plane), radius * R::from_f64(INCLINED));
    let is_before = least >= -thickness && most > inclined;
    let is_behind = most <= thickness && least < -inclined;
    (is_before || is_behind).then_some(is_before)
}
