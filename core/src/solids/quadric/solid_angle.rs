//! The solid angle of a region of a plane, seen from the centre of the unit ball that bounds it.
//!
//! Of a ball the volume in a cell is a third of Σ h A − R³ Σ ω over the sections with the cell's planes, h the distance of a plane and ω the
//! solid angle of its section, and R³ times the angle that the cell takes up at the centre itself: the field (p/3)(1 − R³/r³) has divergence
//! 1 and vanishes on the sphere. So what a section misses along its rim by rounding counts with its square only.
//!
//! Reference for triangles: A. van Oosterom and J. Strackee, IEEE Trans. Biomed. Eng. 30 (1983).

use super::outline::{Piece, Rectangle, Region, Section};
use crate::number::plane::{self, P2};
use crate::number::real::Real;
use crate::number::space::{dot, length, sub};
use core::f64::consts::PI;

/// A plane in the space where the ball is the unit ball about the origin.
pub(super) struct PlaneOfUnitBall<M> {
    /// Of the plane's own coordinates and its height, a linear map; of differences, with no height.
    pub map: M,
    /// The height that `map` takes.
    pub at: f64,
    /// Unit normal; the plane's own coordinates turn to the right about it.
    pub normal: [f64; 3],
    /// The plane's distance from the centre, along the normal.
    pub height: f64,
    /// Square of the section's radius: 1 − h².
    pub square: f64,
    /// The section is small and farther from the centre than that.
    pub far: bool,
    /// The foot of the centre in the plane's own coordinates. Only these tell how far the sides of a face pass from it if that is little.
    pub foot: P2,
    /// What `map` makes of areas in the plane.
    pub area: f64,
    /// How far the lines of the ends pass from the foot of the centre, positive if that is inside.
    pub ends: [f64; 2],
}

/// A point in the plane, and where it is mapped. Differences are mapped as such, so that they keep their digits.
#[derive(Clone, Copy)]
struct Mapped {
    plane: P2,
    unit: [f64; 3],
}

impl<M: Fn(P2, f64) -> [f64; 3]> PlaneOfUnitBall<M> {
    fn mapped(&self, plane: P2) -> Mapped {
        Mapped { plane, unit: (self.map)(plane, self.at) }
    }

    fn difference(&self, a: Mapped, b: Mapped) -> [f64; 3] {
        (self.map)(plane::sub(a.plane, b.plane), 0.0)
    }

    /// Solid angle of a region, not negative.
    pub fn solid_angle(&self, section: &Section, region: &Region, rectangle: &Rectangle) -> f64 {
        match region {
            Region::Empty => 0.0,
            Region::Ellipse(_) => 2.0 * PI * self.square / (1.0 + self.height.abs()),
            Region::Pieces(pieces, about) => self.of_pieces(section, pieces, *about),
            Region::Whole => self.of_pieces(section, &rectangle.sides(), false),
        }
    }

    /// `about` as that of [`Region::Pieces`].
    fn of_pieces(&self, section: &Section, pieces: &[Piece], about: bool) -> f64 {
        let (Some(first), Some(last)) = (pieces.first(), pieces.last()) else { return 0.0 };
        let mut fan = Fan::new(self, self.mapped(first.from));
        let mut rest = 0.0;
        let mut before = self.mapped(last.to);
        for piece in pieces {
            // A piece that is joined begins where the one before ended.
            let from = if piece.joined { before } else { self.mapped(piece.from) };
            let to = self.mapped(piece.to);
            if !piece.joined {
                let major = about && section.is_major(before.plane, piece.from);
                rest += if self.far { self.lens(before, from, major) } else { self.sector(before, from, major) };
            }
            if self.far {
                if !(piece.joined || fan.corner.is_none()) {
                    fan.add(from);
                }
                fan.add(to);
            } else {
                let aside = usize::from(piece.side).checked_sub(4).and_then(|end| self.ends.get(end));
                rest += self.triangle_at_foot(from, to, aside.copied());
            }
            before = to;
        }
        rest + fan.solid_angle()
    }

    /// Twice the area of a triangle from a point of the plane, by its other corners.
    fn twice(&self, from: P2, p: Mapped, q: Mapped) -> f64 {
        self.area * plane::cross(plane::sub(p.plane, from), plane::sub(q.plane, p.plane))
    }

    /// Twice the area of the triangle of the plane's foot and two of its points, and the product of their distances times the cosine.
    fn about_foot(&self, p: Mapped, q: Mapped) -> (f64, f64) {
        let foot = self.normal.map(|x| x * self.height);
        (self.twice(self.foot, p, q), dot(sub(p.unit, foot), sub(q.unit, foot)))
    }

    /// Signed solid angle of the triangle of the plane's foot and two of its points, whose line passes `aside` of the foot, if that is known
    /// better than from the points.
    fn triangle_at_foot(&self, p: Mapped, q: Mapped, aside: Option<f64>) -> f64 {
        let h = self.height.abs();
        let (area, _) = self.about_foot(p, q);
        let along = self.difference(q, p);
        let size = length(along);
        let aside = aside.unwrap_or(if size > 0.0 { area / size } else { 0.0 });
        let foot = self.normal.map(|x| x * self.height);
        let [s, t] = [p, q].map(|point| if size > 0.0 { dot(sub(point.unit, foot), along) / size } else { 0.0 });
        if s < 0.0 && t > 0.0 {
            // The foot of the foot lies between: each side of it by itself, or the digits of what lies close to the foot would be lost.
            let m = aside.abs();
            let half = |s: f64| {
                let square = m * m + s * s;
                let reach = Real::sqrt(square + h * h);
                libm::atan2(s * m * (square / (reach + h)), m * m * reach + h * s * s)
            };
            return (half(t) - half(s)).copysign(aside);
        }
        let (a, b) = (length(p.unit), length(q.unit));
        2.0 * libm::atan2(aside * size, a * b + dot(p.unit, q.unit) + h * (a + b))
    }

    /// Solid angle of the sector of an arc about the foot.
    fn sector(&self, p: Mapped, q: Mapped, major: bool) -> f64 {
        let (area, cosine) = self.about_foot(p, q);
        let angle = libm::atan2(area, cosine);
        // Near half a turn and a whole one rounding may take the other side. Near nothing it may too, and what lies between the points has that sign
        // then in the triangles beside.
        let angle = if if major { angle <= 1.0 } else { angle < -1.0 } { angle + 2.0 * PI } else { angle };
        angle * self.square / (1.0 + self.height.abs())
    }

    /// Solid angle between an arc and its chord: 2 (atan hτ − h atan τ), τ the tangent of half the arc's angle.
    fn lens(&self, p: Mapped, q: Mapped, major: bool) -> f64 {
        let (area, cosine) = self.about_foot(p, q);
        if major || !(cosine > 0.0) {
            return self.sector(p, q, major) - self.triangle_at_foot(p, q, None);
        }
        let (tau, h) = (area / (self.square + cosine), self.height.abs());
        let (t, h_square) = (tau * tau, h * h);
        if t > 0.05 {
            return 2.0 * (libm::atan(h * tau) - h * libm::atan(tau));
        }
        // Σ (−t)ᵏ (1 − h²ᵏ⁺²) / (2k + 3), each 1 − h²ᵏ⁺² a multiple of 1 − h². Terms alternate and each is less than a sixteenth of the one before,
        // so that all that follow one below the rounding of the sum are so together.
        let (mut sum, mut power, mut factor, mut n) = (1.0 / 3.0, -t, 1.0 + h_square, 5.0);
        loop {
            let term = power * factor / n;
            sum += term;
            if !(term.abs() > NEGLIGIBLE) {
                break;
            }
            power *= -t;
            factor = factor * h_square + 1.0;
            n += 2.0;
        }
        2.0 * h * tau * t * self.square * sum
    }
}

/// Triangles that share a point of the plane: half of their solid angle together as the argument of a complex number.
struct Fan<'a, M> {
    plane: &'a PlaneOfUnitBall<M>,
    base: Mapped,
    base_length: f64,
    /// The corner before, its length, and its scalar product with the base.
    corner: Option<(Mapped, f64, f64)>,
    product: [f64; 2],
}

impl<'a, M: Fn(P2, f64) -> [f64; 3]> Fan<'a, M> {
    fn new(plane: &'a PlaneOfUnitBall<M>, base: Mapped) -> Self {
        Fan { plane, base, base_length: length(base.unit), corner: None, product: [1.0, 0.0] }
    }

    /// The triangle of the base, the corner before and this one.
    #[inline(always)]
    fn add(&mut self, next: Mapped) {
        let (own, to_base) = (length(next.unit), dot(next.unit, self.base.unit));
        if let Some((corner, before, before_to_base)) = self.corner {
            let volume = self.plane.height.abs() * self.plane.twice(self.base.plane, corner, next);
            let a = self.base_length;
            let real = a * before * own + before_to_base * own + dot(corner.unit, next.unit) * a + to_base * before;
            self.product = turned(self.product, [real, volume]);
        }
        self.corner = Some((next, own, to_base));
    }

    fn solid_angle(&self) -> f64 {
        2.0 * libm::atan2(self.product[1], self.product[0])
    }
}

/// Terms below this share of a sum that is at least a quarter do not change it.
const NEGLIGIBLE: f64 = f64::EPSILON / 32.0;

/// The product of two complex numbers.
fn turned(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}
