//! The flux through sections of a cone, whole or truncated, of a field that is tangent to it.
//!
//! With s the height along the axis and R(s) the radius there, (p − apex) (1 − (R₀/R)³) / 3 has divergence 1, is tangent to the cone, and
//! vanishes at the height where R is R₀. Where that is the middle of a cell the field is small in the cell, however far the apex is: with
//! σ = s − s₀ and x = R/R₀ − 1 it is σ (1 + x + x²/3) / (1 + x)² · (a + R' ρ/R), ρ from the axis, which is that of a cylinder if the radius
//! hardly changes. Its integrals over triangles and lenses are those of the difference of an area and that of its central shadow, taken as one: of
//! a triangle by the σ of its corners, of a lens by how the weight of its arc changes in the shadow.

use super::arc::{Bow, Lens, bends, lens_of};
use super::outline::{Piece, Rectangle, Region, Section};
use super::wall::{Curved, Ellipse};
use crate::number::axis::Axis;
use crate::number::plane::{P2, cross, sub};
use crate::number::real::Real;

/// A plane across axis `n` at height `h` from the origin of a cone.
pub(super) struct PlaneOfCone<'a> {
    pub curved: &'a Curved,
    /// Radius at the origin.
    pub radius: f64,
    /// By which it grows along the axis.
    pub slope: f64,
    pub n: Axis,
    pub h: f64,
}

/// Where the field vanishes: height along the axis, and the radius there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reference {
    pub height: f64,
    pub radius: f64,
}

impl Reference {
    /// The apex is farther than some widths of a face or cell of this size.
    pub fn is_far(&self, slope: f64, size: f64, widths: f64) -> bool {
        self.radius > slope.abs() * size * widths
    }
}

/// The field at a height, along the axis, if it vanishes at a reference `below`; the radius there is `radius`.
pub(super) fn along_axis(below: f64, reference: &Reference, radius: f64) -> f64 {
    let ratio = reference.radius / radius;
    below * (1.0 + ratio * (1.0 + ratio)) / 3.0
}

impl PlaneOfCone<'_> {
    /// How far the field carries through the plane, in radii at unit height.
    fn through(&self) -> f64 {
        self.slope * self.h + self.radius * self.curved.axis[self.n]
    }

    /// The height of a face's middle.
    pub fn reference(&self, rectangle: &Rectangle) -> Reference {
        let ([u, v], [x, y], a) = (self.n.others(), rectangle.middle(), &self.curved.axis);
        let height = a[self.n] * self.h + (a[u] * x + a[v] * y);
        Reference { height, radius: self.radius + self.slope * height }
    }

    /// Flux of (p − apex) / 3 through an area.
    pub fn of_apex(&self, area: f64) -> f64 {
        self.through() / self.slope * area / 3.0
    }

    /// Flux through an area for another reference, at `shift` from the face's own.
    pub fn moved(&self, flux: f64, area: f64, own: &Reference, to: &Reference, shift: f64) -> f64 {
        let ratio = to.radius / own.radius;
        let square = 1.0 + ratio * (1.0 + ratio);
        flux * ratio * ratio * ratio - self.through() / own.radius * area * shift * square / 3.0
    }

    /// Flux of the field through a region, upwards, if it vanishes at the height of the face's middle; 0 if the apex is near.
    pub fn flux(&self, section: &Section, region: &Region, rectangle: &Rectangle) -> f64 {
        let reference = self.reference(rectangle);
        let size = (rectangle.u[1] - rectangle.u[0]) + (rectangle.v[1] - rectangle.v[0]);
        if !reference.is_far(self.slope, size, 3.0) {
            return 0.0;
        }
        let ([u, v], a) = (self.n.others(), &self.curved.axis);
        let region_of = RegionOfCone {
            plane: self,
            section,
            reference,
            middle: rectangle.middle(),
            along: [a[u], a[v]],
            growth: self.slope / reference.radius,
            size,
        };
        region_of.flux(region, rectangle)
    }
}

/// A plane over one rectangle.
struct RegionOfCone<'a> {
    plane: &'a PlaneOfCone<'a>,
    section: &'a Section,
    reference: Reference,
    middle: P2,
    /// The axis in the plane.
    along: P2,
    /// Of the radius, per height and in radii of the reference.
    growth: f64,
    /// Of the rectangle, along both sides.
    size: f64,
}

impl RegionOfCone<'_> {
    /// Height of a point over the reference.
    fn sigma(&self, p: P2) -> f64 {
        self.rise(sub(p, self.middle))
    }

    fn rise(&self, d: P2) -> f64 {
        self.along[0] * d[0] + self.along[1] * d[1]
    }

    fn flux(&self, region: &Region, rectangle: &Rectangle) -> f64 {
        let sum = match region {
            Region::Empty => 0.0,
            Region::Ellipse(ellipse) => return self.through_ellipse(ellipse),
            Region::Pieces(pieces, about) => self.of_pieces(pieces, *about),
            Region::Whole => self.of_pieces(&rectangle.sides(), false),
        };
        sum * self.plane.through() / self.reference.radius
    }

    /// A whole ellipse less its shadow: 1 − ρ³ times its area, ρ² being rational.
    fn through_ellipse(&self, ellipse: &Ellipse) -> f64 {
        let PlaneOfCone { curved, slope, n, h, .. } = *self.plane;
        let (an, across, through) = (curved.axis[n], curved.across[n], self.plane.through());
        let Reference { height, radius } = self.reference;
        let tilt = slope.abs() * across;
        let ratio = Real::sqrt(((an.abs() - tilt) * (an.abs() + tilt)).max(0.0)) * radius / through.abs();
        let less = (h - height * an) * (radius * an + through) + slope * radius * radius * across * across;
        ellipse.area / (3.0 * through) * less * (1.0 + ratio * (1.0 + ratio)) / (1.0 + ratio)
    }

    /// Sum over fans of triangles and lenses, in units of [`PlaneOfCone::through`] in radii of the reference. `about` as that of
    /// [`Region::Pieces`].
    fn of_pieces(&self, pieces: &[Piece], about: bool) -> f64 {
        let (Some(first), Some(last)) = (pieces.first(), pieces.last()) else { return 0.0 };
        let base = first.from;
        let low = self.sigma(base);
        let mut total = 0.0;
        let (mut before, mut corner) = (last.to, base);
        for piece in pieces {
            if !piece.joined {
                let major = about && self.section.is_major(before, piece.from);
                total += self.arc(before, piece.from, major);
            }
            for next in [piece.from, piece.to] {
                let area = cross(sub(corner, base), sub(next, base)) * 0.5;
                total += self.triangle(area, [low, self.sigma(corner), self.sigma(next)]);
                corner = next;
            }
            before = piece.to;
        }
        total
    }

    /// Of a triangle, by its area and the heights of its corners.
    fn triangle(&self, area: f64, [a, b, c]: [f64; 3]) -> f64 {
        let g = self.growth;
        let sum = a + b + c + g * (a * b + b * c + c * a + g * a * b * c);
        area * sum / (3.0 * (1.0 + g * a) * (1.0 + g * b) * (1.0 + g * c))
    }

    fn arc(&self, p: P2, q: P2, major: bool) -> f64 {
        if major {
            let Some(ellipse) = &self.section.ellipse else { return 0.0 };
            let whole = self.through_ellipse(ellipse) * self.reference.radius / self.plane.through();
            return whole - self.minor(q, p);
        }
        self.minor(p, q)
    }

    fn minor(&self, p: P2, q: P2) -> f64 {
        let conic = &self.section.conic;
        match lens_of([p, q], conic.turn(p, q), conic, self.size) {
            Lens::Nothing => 0.0,
            Lens::Triangle(corner, area) => {
                let low = self.sigma(p);
                self.triangle(area, [low, low + self.rise(corner), self.sigma(q)])
            }
            Lens::Bow(bow) => self.bow(&bow, self.sigma(p)),
        }
    }

    /// Of a lens whose arc begins at a height: its shadow's arc has the weight w (1 + x_M) / √((1 + x_P) (1 + x_Q)), M where the tangents
    /// meet.
    fn bow(&self, bow: &Bow, low: f64) -> f64 {
        let (g, high) = (self.growth, low + self.rise(bow.chord));
        let less = low + high + g * low * high;
        let square = (1.0 + g * low) * (1.0 + g * high);
        let root = Real::sqrt(square);
        let cube = square * root;
        let corner = bow.w * low + 0.5 * bow.ratio * self.rise(bow.tangent);
        let change = (corner - bow.w * less / (1.0 + root)) / root;
        if !(bow.w + g * change > -1.0) {
            // No shadow has such an arc: of a plane along a line of the cone only rounding is left.
            return 0.0;
        }
        let [rate, there] = bends(bow.w, g * change);
        let x = g * less;
        let shrunk = less * (3.0 + x * (3.0 + x)) / (cube * (1.0 + cube));
        bow.size / 3.0 * (there * shrunk - change * rate)
    }
}
