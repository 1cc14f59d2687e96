//! How a cell is seen while the union in it is made, and triangles as seen from there.

use super::piece::{Ball, Piece, Plane};
use crate::number::aabb::Aabb;
use crate::number::real::{Real, Vector};
use crate::number::space::{cross, dot, sharp_cross, sub, unit};
use crate::surface::clip::{Polygon, keep};

/// Rounding of corners in the frame of a cell, in ε of the coordinates as seen from there. Planes closer than that are
/// one plane.
const THICKNESS_IN_EPSILONS: f64 = 64.0;

/// Where rounding asks for planes thicker than this, in cells, what that may cost counts as that of a blur does: cells far from the origin, in `f32` a hundred
/// of their lengths.
pub(super) const MOST_ROUNDING: f64 = 1e-3;

/// How a cell is seen: 0..1 along each axis.
#[derive(Clone, Copy, Debug)]
pub(in crate::surface) struct Frame<R> {
    pub(super) origin: [R; 3],
    pub(super) scale: [R; 3],
    /// Planes closer than this are one.
    pub(super) thickness: R,
}

impl<R: Real> Frame<R> {
    /// Of a cell, with a thickness that rounding asks for.
    pub fn of<V: Vector<Scalar = R>>(cell: Aabb<V>) -> Self {
        Self::beside(cell, None)
    }

    /// The same, rounding along a `thin` axis aside.
    pub(super) fn beside<V: Vector<Scalar = R>>(cell: Aabb<V>, thin: Option<usize>) -> Self {
        let (lo, hi) = (cell.min.to_array(), cell.max.to_array());
        let size = sub(hi, lo);
        let mut reach = R::ONE;
        for axis in (0..3).filter(|&axis| thin != Some(axis)) {
            reach = reach.max(lo[axis].abs().max(hi[axis].abs()) / size[axis]);
        }
        Frame { origin: lo, scale: size, thickness: R::EPSILON * R::from_f64(THICKNESS_IN_EPSILONS) * reach }
    }

    /// What a triangle has inside a cell, in the frame, and twice its area vector; none if it has nothing there or lies in the plane of a side.
    pub fn inside<V: Vector<Scalar = R>>(
        &self,
        triangle: &[[R; 3]; 3],
        cell: Aabb<V>,
        scratch: &mut [Polygon<R>; 2],
        part: &mut Polygon<R>,
    ) -> Option<[R; 3]> {
        let (lo, hi) = (cell.min.to_array(), cell.max.to_array());
        if !reaches(triangle, lo, hi) {
            return None;
        }
        if triangle.iter().all(|p| (0..3).all(|axis| p[axis] >= lo[axis] && p[axis] <= hi[axis])) {
            part.clear();
            for p in triangle {
                part.push(self.framed(*p));
            }
        } else if !self.part(triangle, lo, hi, scratch, part) {
            return None;
        }
        let (doubled, [a, b, c], [x, y, z]) = (part.doubled_area(), *triangle, self.scale);
        let whole = cross(sub(b, a), sub(c, a));
        let seen = dot(doubled, [whole[0] * x, whole[1] * y, whole[2] * z]);
        (seen > R::ZERO).then_some(doubled)
    }

    /// A point as seen from the cell.
    #[inline(always)]
    pub fn framed(&self, p: [R; 3]) -> [R; 3] {
        let d = sub(p, self.origin);
        [d[0] / self.scale[0], d[1] / self.scale[1], d[2] / self.scale[2]]
    }

    /// A polygon as seen from the cell.
    pub fn framed_polygon(&self, corners: &[[R; 3]]) -> Polygon<R> {
        let mut polygon = Polygon::default();
        for corner in corners {
            polygon.push(self.framed(*corner));
        }
        polygon
    }

    /// The part of a triangle inside the cell `lo..hi`, in the frame; false if there is none. Cut along z, y, x as in [`crate::surface::cells`].
    #[inline(always)]
    fn part(
        &self,
        corners: &[[R; 3]; 3],
        lo: [R; 3],
        hi: [R; 3],
        scratch: &mut [Polygon<R>; 2],
        part: &mut Polygon<R>,
    ) -> bool {
        let [mut polygon, mut kept] = scratch.each_mut();
        polygon.set(corners);
        for axis in (0..3).rev() {
            let (min, max) = polygon.extent(axis);
            if !(min < hi[axis] && max > lo[axis]) {
                return false;
            }
            for (cut, at, above) in [(min < lo[axis], lo[axis], true), (max > hi[axis], hi[axis], false)] {
                if cut {
                    keep(polygon, axis, at, above, kept);
                    core::mem::swap(&mut polygon, &mut kept);
                }
            }
            if polygon.is_empty() {
                return false;
            }
        }
        part.clear();
        for c in polygon.corners() {
            part.push(self.framed(*c));
        }
        true
    }

    /// The piece that a triangle has inside the cell `lo..hi`; false if there is none.
    pub(super) fn piece(
        &self,
        corners: &[[R; 3]; 3],
        lo: [R; 3],
        hi: [R; 3],
        scratch: &mut [Polygon<R>; 2],
        piece: &mut Piece<R>,
    ) -> bool {
        if !self.part(corners, lo, hi, scratch, &mut piece.polygon) {
            return false;
        }
        let [a, b, c] = corners.map(|c| self.framed(c));
        let (Some(normal), Some(&corner)) = (unit(normal(sub(b, a), sub(c, a))), piece.polygon.corners().first())
        else {
            return false;
        };
        piece.plane = Plane { normal, offset: dot(normal, corner) };
        piece.area = dot(piece.polygon.doubled_area(), normal);
        piece.ball = Ball::around(&piece.polygon);
        piece.area > R::ZERO
    }

    /// Does a piece lie on a side of the cell `lo..hi`, and if so, is the solid on the inner side of it?
    pub(super) fn on_side(&self, piece: &Piece<R>, lo: [R; 3], hi: [R; 3]) -> Option<bool> {
        let (low, high) = (self.framed(lo), self.framed(hi));
        (0..3).find_map(|axis| {
            let near = |at: R| piece.polygon.corners().iter().all(|c| (c[axis] - at).abs() <= self.thickness);
            if near(low[axis]) {
                Some(piece.plane.normal[axis] < R::ZERO)
            } else {
                near(high[axis]).then_some(piece.plane.normal[axis] > R::ZERO)
            }
        })
    }
}

/// Sides of a triangle whose angle has a smaller sine leave their vector product too few digits: it would not be normal to the longer one.
const SHARP: f64 = 0.1;

/// Normal to two sides of a triangle.
#[inline(always)]
fn normal<R: Real>(a: [R; 3], b: [R; 3]) -> [R; 3] {
    let rough = cross(a, b);
    let is_sharp = dot(rough, rough) < R::from_f64(SHARP * SHARP) * (dot(a, a) * dot(b, b));
    if is_sharp { sharp_cross(a, b) } else { rough }
}

/// Does rounding ask for planes so thick in a cell that what this may cost counts?
pub(in crate::surface) fn rounds_much<V: Vector>(cell: Aabb<V>) -> bool {
    Frame::of(cell).thickness > V::Scalar::from_f64(MOST_ROUNDING)
}

/// Does the box of a triangle share space with the cell `lo..hi`?
pub(super) fn reaches<R: Real>([a, b, c]: &[[R; 3]; 3], lo: [R; 3], hi: [R; 3]) -> bool {
    (0..3).all(|axis| {
        let (min, max) = (a[axis].min(b[axis]).min(c[axis]), a[axis].max(b[axis]).max(c[axis]));
        min < hi[axis] && max > lo[axis]
    })
}
