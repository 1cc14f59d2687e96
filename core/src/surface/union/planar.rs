//! Bodies that in one cell are what lies behind a few planes: walls, edges and corners of boxes and plates, beams however they are turned.

use super::piece::{Piece, Plane, span};
use super::{CellUnion, Frame};
use crate::number::real::Real;
use crate::number::space::dot;
use heapless::Vec;

/// Planes of a body in a cell, and bodies.
const MOST_PLANES: usize = 3;
const MOST_BODIES: usize = 4;

/// The bodies in a cell, or on both sides of a face.
pub(in crate::surface) type PlanarParts<R> = Vec<PlanarPart<R>, MOST_BODIES>;

/// What lies behind all of some planes. In a cell a body may be that.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlanarPart<R> {
    /// The outward unit normal of each plane, and a point in it.
    pub planes: Vec<[[R; 3]; 2], MOST_PLANES>,
}

impl<R: Real> CellUnion<'_, R> {
    /// The bodies, if each is convex in the cell and all of its surface inside lies in a few planes: what a closed surface encloses is then
    /// what lies behind them; without any, all of the cell. None else.
    pub(in crate::surface) fn planar_parts(&self) -> Option<PlanarParts<R>> {
        let mut found = Vec::new();
        for part in self.space.parts.get(..self.part_count)? {
            found.push(self.frame.behind(self.space.pieces.get(part.first..part.end)?)?).ok()?;
        }
        Some(found)
    }
}

impl<R: Real> Frame<R> {
    /// What lies behind the planes of all pieces; none if these are too many, or a piece is before one of them.
    fn behind(&self, pieces: &[Piece<R>]) -> Option<PlanarPart<R>> {
        let mut planes: Vec<Plane<R>, MOST_PLANES> = Vec::new();
        for Piece { polygon, plane, .. } in pieces {
            let is_in = |other: &Plane<R>| {
                let (least, most) = span(polygon, other);
                least >= -self.thickness && most <= self.thickness && dot(plane.normal, other.normal) > R::ZERO
            };
            if !planes.iter().any(is_in) {
                planes.push(*plane).ok()?;
            }
        }
        let is_behind = |plane: &Plane<R>| pieces.iter().all(|p| span(&p.polygon, plane).1 <= self.thickness);
        let planes = planes.iter().map(|p| is_behind(p).then(|| self.in_space(p)));
        Some(PlanarPart { planes: planes.collect::<Option<_>>()? })
    }

    /// The outward unit normal of a plane and a point in it, in the coordinates of the cell's corners.
    fn in_space(&self, plane: &Plane<R>) -> [[R; 3]; 2] {
        let normal = [0, 1, 2].map(|n| plane.normal[n] / self.scale[n]);
        let length = dot(normal, normal).sqrt();
        let unit = normal.map(|n| n / length);
        [unit, [0, 1, 2].map(|n| self.origin[n] + unit[n] * (plane.offset / length))]
    }
}
