//! The flux of p/ζ³ through sections of a cone: the area of their shadows on the plane ζ = 1, ζ the height from the apex.
//!
//! Both p/3 and p/ζ³ are tangent to the cone, and the second has no divergence. So from p/3 as much of it may be taken as makes both equal
//! in the middle of a cell: what is left is small there, however far the apex is. The central shadow of a triangle has its area divided
//! by the heights of its corners, and a conic's shadow is the circle of the cone.

use super::arc::{P2, bend, cross, sub};
use super::outline::{MayBeMajor, Piece, Rectangle, Region, Section};
use super::wall::{Curved, others};
use crate::number::real::Real;
use core::f64::consts::PI;

/// A plane across axis `n` at height `h` over the apex of a cone.
pub(super) struct PlaneOverApex<'a> {
    pub curved: &'a Curved,
    pub slope: f64,
    pub n: usize,
    pub h: f64,
}

impl PlaneOverApex<'_> {
    /// Height of a point along the axis; of a difference with `h` zero.
    fn height(&self, p: P2, h: f64) -> f64 {
        let ([u, v], a) = (others(self.n), &self.curved.axis);
        a[self.n] * h + a[u] * p[0] + a[v] * p[1]
    }

    /// Area of a region's shadow, |h| ∫ dA / ζ³. Not finite if the apex is near.
    pub fn shadow(&self, section: &Section, region: &Region, rectangle: &Rectangle) -> f64 {
        match region {
            Region::Empty => 0.0,
            Region::Ellipse(_) => PI * self.slope * self.slope,
            Region::Pieces(pieces, major) => self.of_pieces(section, pieces, *major),
            Region::Whole => self.of_pieces(section, &rectangle.sides(), false),
        }
    }

    fn of_pieces(&self, section: &Section, pieces: &[Piece], major: MayBeMajor) -> f64 {
        let (Some(first), Some(last)) = (pieces.first(), pieces.last()) else { return 0.0 };
        let base = first.from;
        let (mut lenses, mut triangles) = (0.0, 0.0);
        let (mut before, mut corner) = (last.to, base);
        for piece in pieces {
            if !piece.joined {
                lenses += self.lens(before, piece.from, major && section.is_major(before, piece.from));
            }
            for next in [piece.from, piece.to] {
                let heights = self.height(corner, self.h) * self.height(next, self.h);
                triangles += cross(sub(corner, base), sub(next, base)) * 0.5 / heights;
                corner = next;
            }
            before = piece.to;
        }
        triangles * (self.h.abs() / self.height(base, self.h)) + lenses
    }

    /// Area between the shadows of an arc and of its chord: a segment of the cone's circle.
    fn lens(&self, p: P2, q: P2, major: bool) -> f64 {
        let [u, v] = others(self.n);
        let d = sub(q, p);
        let (height, step) = (self.height(p, self.h), self.height(d, 0.0));
        let mut chord = [0.0; 3];
        chord[self.n] = -step * self.h;
        chord[u] = height * d[0] - step * p[0];
        chord[v] = height * d[1] - step * p[1];
        let square = chord.iter().map(|x| x * x).sum::<f64>();
        let scale = height * (height + step);
        let length = Real::sqrt(square) / scale.abs();
        let half = (length / (2.0 * self.slope)).min(1.0);
        let w = Real::sqrt((1.0 - half) * (1.0 + half));
        let minor = length * length * length / (8.0 * self.slope) * bend(w);
        if major { PI * self.slope * self.slope - minor } else { minor }
    }
}
