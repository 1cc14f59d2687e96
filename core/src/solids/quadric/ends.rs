//! Flat ends: discs across an axis.

use super::arc::{Conic, Moments};
use super::end_line::EndLine;
use super::outline::{Pieces, Rectangle, Section, Side, cut};
use super::twofold::{Twofold, difference, difference_of_squares};
use super::wall::{Ellipse, Span, hypotenuse};
use crate::number::axis::Axis;
use crate::number::plane::{P2, cross, sub};
use crate::number::real::Real;
use core::f64::consts::PI;

/// The length of a unit vector seen along an axis, by its parts along and across that axis: of one across it exactly 1.
fn beside(along: f64, [u, v]: P2) -> f64 {
    if along.abs() < 0.7 { Real::sqrt(1.0 - along * along) } else { hypotenuse(u, v) }
}

/// A flat end of a part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct End {
    /// Its centre.
    pub center: [f64; 3],
    /// The same, from the part's origin.
    pub shift: [f64; 3],
    /// Unit normal into the solid.
    pub inward: [f64; 3],
    pub radius: f64,
    /// Points of its plane belong to the part.
    pub closed: bool,
}

impl End {
    /// Its line in the plane across axis `n` at a coordinate.
    pub fn line(&self, n: Axis, coordinate: f64) -> EndLine {
        let [u, v] = n.others();
        let a = self.inward;
        let height = difference(coordinate, self.center[n]);
        let (slope, shift) = ([a[u], a[v]], [self.shift[u], self.shift[v]]);
        let constant = a[n] * height.value;
        if a[u] == 0.0 && a[v] == 0.0 {
            // The end lies in planes like this one: all of it is inside or outside.
            let inside = constant > 0.0 || (constant == 0.0 && self.closed);
            return EndLine { constant: if inside { 1.0 } else { -1.0 }, slope: [0.0; 2], shift };
        }
        EndLine { constant, slope, shift }
    }

    /// What its disc has of that line, by its ends; none if the disc does not reach the plane, or lies along it.
    pub fn chord(&self, n: Axis, coordinate: f64) -> Option<[P2; 2]> {
        let [u, v] = n.others();
        let a = self.inward;
        let height = difference(coordinate, self.center[n]);
        let across = beside(a[n], [a[u], a[v]]);
        if !(across > 0.0) {
            return None;
        }
        let scaled = Twofold { value: height.value / across, rest: height.rest / across };
        let square = difference_of_squares(self.radius, scaled);
        (square > 0.0).then(|| {
            let half = Real::sqrt(square);
            let along = [-a[v] / across, a[u] / across];
            let foot = -a[n] * (height.value / across);
            let middle = [self.shift[u] + foot * (a[u] / across), self.shift[v] + foot * (a[v] / across)];
            [-half, half].map(|t| [middle[0] + t * along[0], middle[1] + t * along[1]])
        })
    }

    /// What a line along axis `m` has inside, as coordinates from the part's origin, by its own other two coordinates: from the origin rounding might
    /// take a line beside the end into its plane.
    pub fn span(&self, m: Axis, q: P2) -> Span {
        let [u, v] = m.others();
        let a = self.inward;
        let aside = a[u] * (q[0] - self.center[u]) + a[v] * (q[1] - self.center[v]);
        let all = Span::ALL;
        if a[m] == 0.0 {
            return if aside > 0.0 || (aside == 0.0 && self.closed) { all } else { Span::EMPTY };
        }
        let at = self.shift[m] - aside / a[m];
        if a[m] > 0.0 { Span { lo: at, ..all } } else { Span { hi: at, ..all } }
    }

    /// The disc, seen along axis `xi`: area and first moments, in the other two axes and about the rectangle's middle, of what lies over
    /// a rectangle and between two planes across `xi`, given by their lines.
    pub fn projected(&self, xi: Axis, rectangle: &Rectangle, planes: [&EndLine; 2]) -> Moments {
        let mut corners = rectangle.corners();
        // The lower plane's line is positive where that plane is inside; whether the end is above it depends on where inside is.
        let up = self.inward[xi] > 0.0;
        let [low, high] = planes;
        let lines = if up { [low.reversed(), *high] } else { [*low, high.reversed()] };
        for line in &lines {
            corners = cut(&corners, line, 4);
        }
        if corners.is_empty() {
            return Moments::default();
        }
        let section = self.seen_along(xi);
        let mut pieces = Pieces::new();
        let region = section
            .pieces((&corners, rectangle, lines.iter()), &mut pieces, |corner, to| self.piece(xi, corner.at, to));
        section.moments(&region, rectangle)
    }

    /// The disc's outline, seen along axis `xi`.
    fn seen_along(&self, xi: Axis) -> Section {
        let [u, v] = xi.others();
        let (a, center) = (self.inward, [self.shift[u], self.shift[v]]);
        let s = [-a[u] / a[xi], -a[v] / a[xi]];
        let (uu, vv, reach) = (s[0] * s[0], s[1] * s[1], self.radius / a[xi]);
        let conic = Conic::ellipse([1.0 + uu, s[0] * s[1], 1.0 + vv], 1.0 + (uu + vv), center, reach * reach);
        Section { conic, ellipse: Some(Ellipse { center, area: PI * self.radius * self.radius * a[xi].abs() }) }
    }

    /// What the disc, seen along axis `xi`, has of a segment.
    fn piece(&self, xi: Axis, from: P2, to: P2) -> Option<Side> {
        let [u, v] = xi.others();
        let a = self.inward;
        let s = [-a[u] / a[xi], -a[v] / a[xi]];
        let quadratic = [1.0 + s[0] * s[0], s[0] * s[1], 1.0 + s[1] * s[1]];
        let p = sub(from, [self.shift[u], self.shift[v]]);
        let d = sub(to, from);
        let sd = [quadratic[0] * d[0] + quadratic[1] * d[1], quadratic[1] * d[0] + quadratic[2] * d[1]];
        let leading = d[0] * sd[0] + d[1] * sd[1];
        let half = p[0] * sd[0] + p[1] * sd[1];
        let aside = (cross(p, d) / a[xi]).abs();
        let reach = self.radius * Real::sqrt(leading);
        let square = (reach - aside) * (reach + aside);
        if !(square > 0.0 && leading > 0.0) {
            return None;
        }
        let root = Real::sqrt(square);
        let (near, far) = ((-half - root) / leading, (-half + root) / leading);
        if !(near < 1.0 && far > 0.0) {
            return None;
        }
        let at = |t: f64| [from[0] + t * d[0], from[1] + t * d[1]];
        let (from_corner, to_corner) = (near <= 0.0, far >= 1.0);
        let (start, end) = (if from_corner { from } else { at(near) }, if to_corner { to } else { at(far) });
        Some(Side { from: start, to: end, from_corner, to_corner })
    }
}
