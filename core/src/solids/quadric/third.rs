//! What a third pipe leaves of the polygon that two pipes have in common in a plane along the axes of both.
//!
//! Its section is an ellipse that keeps its shape and moves with the plane. Seen so that this is the unit circle about the origin, what both have in common is
//! a sum over the polygon's sides: of triangles about the origin where a side is inside, of sectors where it is outside.
//!
//! The area grows as sides move outward relative to the ellipse, each as far as it is inside: the ellipse's own motion moves its arcs as much as it would
//! move the sides back, as normals of a closed outline add up to nothing.

use super::polygon::{Corner, Corners, Line, Strips};
use crate::number::plane::{P2, cross, dot, sub};
use crate::number::real::Real;
use crate::number::space::P3;
use core::f64::consts::PI;

/// Axes that rise less out of the planes, for their length, are left to sections.
const LEAST_RISE: f64 = 1.0 / 32.0;

/// A third pipe, between its ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Third {
    /// Rows of the map that makes its section a unit circle.
    rows: [P2; 2],
    /// The section's centre at height 0, and by how much that moves with the height.
    center: P2,
    drift: P2,
    /// By how much its axis rises, for its length.
    pub rise: f64,
    /// Area of the section.
    pub area: f64,
}

/// What the ellipse has of a polygon.
pub(super) enum Left {
    /// Area, by how much it grows with the height, and how fast the sides move in all.
    Area([f64; 3]),
    /// Nothing.
    Nothing(Apart),
}

/// A line between an ellipse and a polygon that are apart.
pub(super) struct Apart {
    /// By how much they are apart: a convex function of the height.
    pub missing: f64,
    /// By how much that shrinks with the height.
    pub growth: f64,
    /// By how much `missing` is off for each unit of length that lines are off by.
    pub weight: f64,
}

/// A polygon at a height.
pub(super) struct AtHeight<'a> {
    pub corners: &'a Corners,
    pub lines: &'a [Line],
    pub height: f64,
    pub strips: &'a Strips,
}

impl AtHeight<'_> {
    /// The line of the side after a corner.
    fn line(&self, corner: &Corner) -> Option<&Line> {
        self.lines.get(usize::from(corner.line))
    }

    /// Each corner with the next one.
    fn sides(&self) -> impl Iterator<Item = (&Corner, &Corner)> {
        self.corners.iter().zip(self.corners.iter().skip(1).chain(self.corners.first()))
    }
}

/// The shares of the way from `p` between which a side is in the unit circle; none if it misses that.
fn chord(p: P2, way: P2) -> Option<P2> {
    let square = dot(way, way);
    let (length, aside) = (Real::sqrt(square), cross(p, way).abs());
    let room = (length - aside) * (length + aside);
    if !(room > 0.0) {
        return None;
    }
    let (root, foot) = (Real::sqrt(room) / square, -dot(p, way) / square);
    let (from, to) = ((foot - root).max(0.0), (foot + root).min(1.0));
    (from < to).then_some([from, to])
}

/// The angle from one point to another about the origin.
fn angle(p: P2, q: P2) -> f64 {
    libm::atan2(cross(p, q), dot(p, q))
}

impl Third {
    /// A pipe by its radius, its axis and a point of that, their last coordinates upright to the planes. None if the axis runs nearly along these.
    pub fn new(radius: f64, axis: P3, point: P3) -> Option<Self> {
        let [along, up] = [[axis[0], axis[1]], [axis[2], point[2]]];
        let [rise, height] = up;
        if !(rise.abs() >= LEAST_RISE) {
            return None;
        }
        let drift = along.map(|a| a / rise);
        let center = [point[0] - drift[0] * height, point[1] - drift[1] * height];
        let length = Real::sqrt(dot(along, along));
        let way = if length > 0.0 { along.map(|a| a / length) } else { [1.0, 0.0] };
        let rows = [way.map(|w| w * (rise.abs() / radius)), [-way[1] / radius, way[0] / radius]];
        Some(Third { rows, center, drift, rise: rise.abs(), area: PI * radius * radius / rise.abs() })
    }

    /// What its section has of a polygon.
    pub fn of(&self, polygon: &AtHeight) -> Option<Left> {
        let center = [0, 1].map(|n| self.center[n] + self.drift[n] * polygon.height);
        let (mut twice, mut grown, mut speed) = (0.0, 0.0, 0.0);
        let (mut meets, mut about) = (false, true);
        for (corner, next) in polygon.sides() {
            let (p, q) = (self.place(corner.at, center), self.place(next.at, center));
            let way = sub(q, p);
            let turned = cross(p, way);
            about &= turned >= 0.0;
            let Some([from, to]) = chord(p, way) else {
                twice += angle(p, q);
                continue;
            };
            meets = true;
            let at = |share: f64| [p[0] + share * way[0], p[1] + share * way[1]];
            twice += turned * (to - from);
            twice += if from > 0.0 { angle(p, at(from)) } else { 0.0 };
            twice += if to < 1.0 { angle(at(to), q) } else { 0.0 };
            let (line, side) = (polygon.line(corner)?, sub(next.at, corner.at));
            let (growth, moved) = (line.growth(polygon.strips), dot(line.normal, self.drift));
            grown += (growth + moved) / line.size * ((to - from) * Real::sqrt(dot(side, side)));
            speed += (growth.abs() + moved.abs()) / line.size;
        }
        if !(meets || about) {
            return Some(Left::Nothing(self.apart(polygon, center)?));
        }
        Some(Left::Area([twice * (0.5 / PI) * self.area, grown, speed]))
    }

    /// Where a point lies as seen from a section's centre, the section being the unit circle.
    fn place(&self, at: P2, center: P2) -> P2 {
        let from = sub(at, center);
        self.rows.map(|row| dot(row, from))
    }

    /// How far the ellipse reaches from its centre along a normal, times that one's length.
    fn reach(&self, normal: P2) -> f64 {
        let [s, t] = self.rows.map(|row| dot(normal, row) / dot(row, row));
        Real::sqrt(s * s + t * t)
    }

    /// The line between them across the way from the ellipse's centre to the polygon's nearest point, where the ellipse is a circle.
    fn apart(&self, polygon: &AtHeight, center: P2) -> Option<Apart> {
        let mut before = polygon.corners.last()?;
        let (mut nearest, mut least) = (None, f64::INFINITY);
        for (corner, next) in polygon.sides() {
            let (p, q) = (self.place(corner.at, center), self.place(next.at, center));
            let way = sub(q, p);
            let share = -dot(p, way) / dot(way, way);
            let inner = share > 0.0;
            let at = if inner { [p[0] + share * way[0], p[1] + share * way[1]] } else { p };
            let square = dot(at, at);
            // What is nearest in a side's end is so in the next side's begin too.
            if share < 1.0 && square < least {
                (nearest, least) = (Some((at, if inner { corner } else { before }, corner)), square);
            }
            before = corner;
        }
        let (at, before, after) = nearest?;
        let distance = Real::sqrt(least);
        let [s, t] = at.map(|x| x / distance);
        let normal = [0, 1].map(|n| s * self.rows[0][n] + t * self.rows[1][n]);
        let (one, other) = (polygon.line(before)?, polygon.line(after)?);
        // The normal by those of the lines that bound the polygon there: points inside are at least as far along it. Whatever the shares are, if none is
        // negative, the sum of the lines is a line with that property.
        let shares = if before.line == after.line {
            [0.0, dot(normal, other.normal) / dot(other.normal, other.normal)]
        } else {
            let turned = cross(one.normal, other.normal);
            [cross(normal, other.normal) / turned, cross(one.normal, normal) / turned]
        };
        if !shares.iter().all(|share| share.is_finite()) {
            return None;
        }
        let shares = shares.map(|share| share.max(0.0));
        let normal = [0, 1].map(|n| shares[0] * one.normal[n] + shares[1] * other.normal[n]);
        let sum = |of: &dyn Fn(&Line) -> f64| shares[0] * of(one) + shares[1] * of(other);
        let room = self.reach(normal) + dot(normal, center) + sum(&|line| line.place(polygon.height, polygon.strips));
        Some(Apart {
            missing: -room,
            growth: dot(normal, self.drift) + sum(&|line| line.growth(polygon.strips)),
            weight: shares[0].abs() + shares[1].abs() + Real::sqrt(dot(normal, normal)),
        })
    }
}
