//! The curved surfaces: where grid lines pierce them, and the conics in which grid planes cut them.
//!
//! Everything is relative to the origin of a part: a point of a cylinder's or a cone's axis, a ball's centre. `a` is the unit vector of
//! the axis. Discriminants are kept as products, so that a line that touches a surface is told from one that misses it by its distance.

use super::arc::Conic;
use super::twofold::{Twofold, difference, difference_of_squares, dot};
use crate::number::axis::Axis;
use crate::number::plane::P2;
use crate::number::real::Real;
use core::f64::consts::PI;

/// The part of a line within a solid, as coordinates along it; empty if `lo > hi`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    pub lo: f64,
    pub hi: f64,
}

impl Span {
    pub const EMPTY: Self = Span { lo: f64::INFINITY, hi: f64::NEG_INFINITY };
    pub const ALL: Self = Span { lo: f64::NEG_INFINITY, hi: f64::INFINITY };

    /// All between two coordinates lies in it.
    #[inline(always)]
    pub fn covers(&self, lo: f64, hi: f64) -> bool {
        self.lo <= lo && self.hi >= hi
    }

    /// The share of an interval that lies in it.
    pub fn share_of(&self, [lo, hi]: P2) -> f64 {
        if self.covers(lo, hi) { 1.0 } else { ((self.hi.min(hi) - self.lo.max(lo)) / (hi - lo)).clamp(0.0, 1.0) }
    }

    /// What both hold.
    pub fn intersection(self, other: Self) -> Self {
        Span { lo: self.lo.max(other.lo), hi: self.hi.min(other.hi) }
    }
}

/// A whole ellipse in a plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ellipse {
    pub center: P2,
    pub area: f64,
}

/// An ellipsoid by the map that makes it the unit ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct UnitMap {
    /// Images of the three axes.
    pub columns: [[f64; 3]; 3],
    /// The quadratic form: products of the columns.
    pub form: [[f64; 3]; 3],
    /// How far the ellipsoid reaches along each axis.
    pub reach: [f64; 3],
    /// The outermost point along each axis, divided by its reach there.
    pub outermost: [[f64; 3]; 3],
    /// Its volume in units of that of the unit ball.
    pub scale: f64,
}

/// A curved surface.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "nothing is allocated here")]
pub(super) enum Wall {
    Cylinder {
        radius: f64,
    },
    /// Radius where the origin is, and by how much it grows along the axis; with a slope.
    Cone {
        radius: f64,
        slope: f64,
    },
    Ball {
        radius: f64,
    },
    Ellipsoid(UnitMap),
}

/// A curved surface along an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Curved {
    pub wall: Wall,
    /// Unit vector along the axis; any for balls and ellipsoids.
    pub axis: [f64; 3],
    /// Length of the axis seen along each coordinate axis.
    pub across: [f64; 3],
    /// The unit vector along the axis as it is seen along each coordinate axis, in the order of [`Axis::others`]; zeros if it runs along that.
    pub seen: [P2; 3],
}

impl Curved {
    pub fn new(wall: Wall, axis: [f64; 3]) -> Self {
        let across = Axis::ALL.map(|m| {
            let [u, v] = m.others();
            hypotenuse(axis[u], axis[v])
        });
        let seen = Axis::ALL.map(|m| {
            let (along, across) = (m.others().map(|n| axis[n]), across[m]);
            if across > 0.0 { along.map(|a| a / across) } else { [0.0; 2] }
        });
        Curved { wall, axis, across, seen }
    }

    /// What a line along axis `m` has inside, by its other two coordinates in the order of [`Axis::others`].
    #[inline]
    pub fn span(&self, m: Axis, q: [Twofold; 2]) -> Span {
        match &self.wall {
            Wall::Cylinder { radius } => self.span_of_cylinder(*radius, m, q),
            Wall::Cone { radius, slope } => self.span_of_cone([*radius, *slope], m, q),
            Wall::Ball { radius } => {
                let [near, far] = if q[0].value.abs() < q[1].value.abs() { [q[0], q[1]] } else { [q[1], q[0]] };
                let square = difference_of_squares(*radius, far) - near.value * near.value;
                symmetric(0.0, square, 1.0)
            }
            Wall::Ellipsoid(map) => map.span(m, q),
        }
    }

    #[inline]
    fn span_of_cylinder(&self, radius: f64, m: Axis, q: [Twofold; 2]) -> Span {
        if let Some(lines) = self.lines(m) {
            return lines.span(radius, q);
        }
        let [near, far] = if q[0].value.abs() < q[1].value.abs() { [q[0], q[1]] } else { [q[1], q[0]] };
        let inside = difference_of_squares(radius, far) >= near.value * near.value;
        if inside { Span::ALL } else { Span::EMPTY }
    }

    /// How lines along axis `m` lie to the axis; none if that runs along them.
    #[inline(always)]
    pub fn lines(&self, m: Axis) -> Option<Lines> {
        let across = self.across[m];
        (across > 0.0).then(|| Lines { along: self.seen[m], lean: self.axis[m], across })
    }

    /// With f and d the line's distances from the origin along and beside the axis, as seen along the line, and σ² = 1 − (slope cot)², the
    /// line is inside where t² σ² c² − 2 b t + C < 0, and b² − σ² c² C = c² ((R + slope f / c)² − σ² d²): for every slope a product.
    #[inline]
    fn span_of_cone(&self, [radius, slope]: [f64; 2], m: Axis, q: [Twofold; 2]) -> Span {
        let [u, v] = m.others();
        let (am, au, av, across) = (self.axis[m], self.axis[u], self.axis[v], self.across[m]);
        let growth = slope * am;
        if !(across > 0.0) {
            let [near, far] = if q[0].value.abs() < q[1].value.abs() { [q[0], q[1]] } else { [q[1], q[0]] };
            let off = hypotenuse(near.value, far.value);
            let room = difference_of_squares(radius, far) - near.value * near.value;
            let sum = radius + off;
            return ray(if sum > 0.0 { -(room / sum) / growth } else { 0.0 }, growth);
        }
        let beside = [av / across, -au / across];
        let mut off = Twofold { value: beside[0] * q[0].value + beside[1] * q[1].value, rest: 0.0 };
        let along = (au / across) * q[0].value + (av / across) * q[1].value;
        let there = difference(radius, -(slope / across) * along);
        let slant = growth / across;
        let square = (1.0 - slant) * (1.0 + slant);
        let half = am * ((1.0 + slope * slope) * along * across + slope * radius);
        let leading = across * across * square;
        let root = if square > 0.0 {
            let narrow = Real::sqrt(square);
            if (there.value - narrow * off.value.abs()).abs() < there.value * NEAR {
                off = dot(sharpened(beside), q);
            }
            let (off, lost) = if off.value < 0.0 { (-off.value, -off.rest) } else { (off.value, off.rest) };
            // Of a cone that is all but a cylinder only the difference of the lengths says whether the line touches it.
            let apart = if square > 0.5 {
                (there.value - off) + slant * slant / (1.0 + narrow) * off
            } else {
                there.value - narrow * off
            };
            let less = apart + (there.rest - narrow * lost);
            let more = (there.value + narrow * off) + (there.rest + narrow * lost);
            if !(there.value > 0.0 && less > 0.0) {
                return Span::EMPTY;
            }
            let root = Real::sqrt(less * more);
            if square > 0.5 {
                let (foot, half) = (half / leading, root / (across * square));
                return Span { lo: foot - half, hi: foot + half };
            }
            across * root
        } else {
            across * hypotenuse(there.value, Real::sqrt(-square) * off.value)
        };
        let sum = half + root.copysign(half);
        if sum == 0.0 {
            // The line through the apex along the axis, or a plane's worth of tangents.
            return if leading < 0.0 { ray(0.0, growth) } else { Span::EMPTY };
        }
        let (out, own) = (hypotenuse(off.value, along * am), radius + slope * along * across);
        let (s, t) = (sum / leading, (out - own) * (out + own) / sum);
        if leading == 0.0 {
            // Parallel to a line of the cone: beyond the plane that touches it there it meets the other nappe alone.
            return if half * growth > 0.0 { ray(t, growth) } else { Span::EMPTY };
        }
        let (lo, hi) = (s.min(t), s.max(t));
        if leading < 0.0 {
            return ray(if growth > 0.0 { hi } else { lo }, growth);
        }
        Span { lo, hi }
    }

    /// In a plane across axis `n`, the second coordinates (in the order of [`Axis::others`]) between which lines along the first one meet the inside;
    /// infinite where there is no end.
    pub fn rows(&self, n: Axis, h: Twofold) -> P2 {
        let [u, v] = n.others();
        let (a, across) = (&self.axis, self.across[u]);
        let all = [f64::NEG_INFINITY, f64::INFINITY];
        let none = [f64::INFINITY, f64::NEG_INFINITY];
        let circle = |radius: f64| {
            let square = difference_of_squares(radius, h);
            if square > 0.0 { [-Real::sqrt(square), Real::sqrt(square)] } else { none }
        };
        // Where `p + q v` is positive.
        let positive = |p: f64, q: f64| match -p / q {
            _ if q == 0.0 => {
                if p > 0.0 {
                    all
                } else {
                    none
                }
            }
            at if q > 0.0 => [at, f64::INFINITY],
            at => [f64::NEG_INFINITY, at],
        };
        let both = |one: P2, other: P2| [one[0].max(other[0]), one[1].min(other[1])];
        match &self.wall {
            Wall::Ball { radius } => circle(*radius),
            Wall::Cylinder { radius } if !(across > 0.0) => circle(*radius),
            Wall::Cylinder { radius } => {
                let (own, aside) = (a[n] / across, -a[v] / across);
                let (other, lost) = (aside * h.value, aside * h.rest);
                both(positive((radius - other) - lost, -own), positive((radius + other) + lost, own))
            }
            Wall::Cone { .. } if !(across > 0.0) => all,
            Wall::Cone { radius, slope } => {
                // As in `span_of_cone`: the radius seen along the line, and how far it passes from the axis.
                let grows = slope * a[v] / (across * across);
                let there = difference(*radius, -slope * a[n] / across * (h.value / across));
                let slant = slope * a[u] / across;
                let square = if slant.abs() < 0.5 { 1.0 - slant * slant } else { (1.0 - slant) * (1.0 + slant) };
                if !(square > 0.0) {
                    return all;
                }
                let narrow = Real::sqrt(square);
                let (aside, moves) = (-a[v] / across * narrow, a[n] / across * narrow);
                let (off, lost) = (aside * h.value, aside * h.rest);
                let less = (there.value - off) + (there.rest - lost);
                let more = (there.value + off) + (there.rest + lost);
                both(positive(less, grows - moves), positive(more, grows + moves))
            }
            Wall::Ellipsoid(map) => {
                let (reach, outermost) = (map.reach[n], &map.outermost[n]);
                // Half the length along v that the outline has in this plane: that of the section through the centre, and its share.
                let square = difference_of_squares(reach, h) / (reach * reach);
                let half = hypotenuse_of_difference(map.reach[v], outermost[v] * reach);
                if !(square > 0.0) {
                    return none;
                }
                let (middle, half) = (outermost[v] * h.value, half * Real::sqrt(square));
                [middle - half, middle + half]
            }
        }
    }

    /// The conic in a plane across axis `n` at a height.
    #[inline(always)]
    pub fn conic(&self, n: Axis, h: Twofold) -> Conic {
        let [u, v] = n.others();
        match &self.wall {
            Wall::Cylinder { radius } => self.conic_of_cone([*radius, 0.0], n, h.value),
            Wall::Cone { radius, slope } => self.conic_of_cone([*radius, *slope], n, h.value),
            Wall::Ball { radius } => Conic::circle(difference_of_squares(*radius, h)),
            Wall::Ellipsoid(map) => {
                let (form, reach, scale) = (&map.form, map.reach[n], map.scale);
                let center = [u, v].map(|axis| map.outermost[n][axis] * h.value);
                let determinant = (reach / scale) * (reach / scale);
                let tau = difference_of_squares(reach, h) / (scale * scale);
                Conic::ellipse([form[u][u], form[u][v], form[v][v]], determinant, center, tau)
            }
        }
    }

    /// The conic of a cone, or of a cylinder with no slope: 1 across the axis as it is seen in the plane.
    #[inline(always)]
    fn conic_of_cone(&self, [radius, slope]: [f64; 2], n: Axis, h: f64) -> Conic {
        let (a, across) = (&self.axis, self.across[n]);
        let reach = slope * h + radius * a[n];
        if !(across > 0.0) {
            return Conic::circle(reach * reach);
        }
        let (factor, along) = (self.steeper(n, slope), self.seen[n]);
        let linear = -((1.0 + slope * slope) * a[n] * h + slope * radius) * across;
        Conic { size: 1.0, across: [along[1], -along[0]], factor, along, linear: [0.0, linear], tau: reach * reach }
    }

    /// By how much the square of the axis along `n` exceeds that of a cone's slope seen in a plane across: positive if that cuts an ellipse.
    #[inline(always)]
    fn steeper(&self, n: Axis, slope: f64) -> f64 {
        let (along, tilt) = (self.axis[n].abs(), slope.abs() * self.across[n]);
        (along - tilt) * (along + tilt)
    }

    /// The conic in a plane across axis `n`, if it is an ellipse with an inside.
    #[inline]
    pub fn ellipse(&self, n: Axis, h: Twofold) -> Option<Ellipse> {
        let [u, v] = n.others();
        let a = &self.axis;
        let positive = |area: f64| area > 0.0;
        match &self.wall {
            Wall::Cylinder { radius } => {
                let center = [a[u], a[v]].map(|along| h.value * (along / a[n]));
                (a[n] != 0.0).then(|| Ellipse { center, area: PI * radius * radius / a[n].abs() })
            }
            Wall::Cone { radius, slope } => {
                let factor = self.steeper(n, *slope);
                let reach = slope * h.value + radius * a[n];
                if !(factor > 0.0 && reach * a[n] > 0.0) {
                    return None;
                }
                let shift = ((1.0 + slope * slope) * a[n] * h.value + slope * radius) / factor;
                let area = PI * reach * reach / (factor * Real::sqrt(factor));
                Some(Ellipse { center: [a[u] * shift, a[v] * shift], area })
            }
            Wall::Ball { radius } => {
                let area = PI * difference_of_squares(*radius, h);
                positive(area).then_some(Ellipse { center: [0.0; 2], area })
            }
            Wall::Ellipsoid(map) => {
                let reach = map.reach[n];
                let area = PI * map.scale * difference_of_squares(reach, h) / (reach * reach * reach);
                let center = [u, v].map(|axis| map.outermost[n][axis] * h.value);
                positive(area).then_some(Ellipse { center, area })
            }
        }
    }
}

/// How lines along one axis of the grid lie to the axis of a cylinder.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lines {
    /// The unit vector along the axis as seen along the lines, in the order of [`Axis::others`].
    along: P2,
    /// What the axis has along the lines, and across.
    lean: f64,
    across: f64,
}

impl Lines {
    /// What a line has inside a radius, by its other two coordinates.
    #[inline(always)]
    pub fn span(&self, radius: f64, q: [Twofold; 2]) -> Span {
        let beside = [self.along[1], -self.along[0]];
        let mut distance = Twofold { value: beside[0] * q[0].value + beside[1] * q[1].value, rest: 0.0 };
        if (radius - distance.value.abs()).abs() < radius * NEAR {
            distance = dot(sharpened(beside), q);
        }
        let foot = self.lean * (self.along[0] * q[0].value + self.along[1] * q[1].value) / self.across;
        symmetric(foot, difference_of_squares(radius, distance), self.across)
    }
}

/// Nearer to the radius than this share, distances are computed to twice the digits.
const NEAR: f64 = 1e-4;

/// `foot ± √square / scale`.
#[inline(always)]
fn symmetric(foot: f64, square: f64, scale: f64) -> Span {
    if square > 0.0 {
        let half = Real::sqrt(square) / scale;
        Span { lo: foot - half, hi: foot + half }
    } else {
        Span::EMPTY
    }
}

/// All beyond a coordinate, in the direction of a sign.
fn ray(from: f64, sign: f64) -> Span {
    if sign > 0.0 { Span { lo: from, ..Span::ALL } } else { Span { hi: from, ..Span::ALL } }
}

/// A unit vector whose length rounding changed: the longer part from the other, so that one along an axis but for 10⁻⁸ has all digits.
fn sharpened([a, b]: P2) -> P2 {
    let other = |x: f64| Real::sqrt(1.0 - x * x);
    if a.abs() < b.abs() { [a, other(a).copysign(b)] } else { [other(b).copysign(a), b] }
}

/// Length of a vector; exact if one component is zero.
#[inline(always)]
pub(super) fn hypotenuse(a: f64, b: f64) -> f64 {
    let (a, b) = (a.abs(), b.abs());
    if a == 0.0 || b == 0.0 { a + b } else { Real::sqrt(a * a + b * b) }
}

/// `√(a² − b²)`, zero if `b` is larger.
fn hypotenuse_of_difference(a: f64, b: f64) -> f64 {
    Real::sqrt(((a - b.abs()) * (a + b.abs())).max(0.0))
}

impl UnitMap {
    /// Some times the square of the ratio of its longest to its shortest axis, and no less.
    pub fn flatness(&self) -> f64 {
        let squares = |all: &[f64]| all.iter().fold(0.0, |sum, x| sum + x * x);
        squares(&self.reach) * squares(self.columns.as_flattened())
    }

    /// From the inverse map, which makes the unit ball the ellipsoid: the images of the three axes; orthogonal, none of them zero.
    pub fn new(axes: [[f64; 3]; 3]) -> Self {
        let squares = axes.map(|a| a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
        let columns = Axis::ALL.map(|m| Axis::ALL.map(|r| axes[r][m] / squares[r]));
        let product = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let form = Axis::ALL.map(|m| Axis::ALL.map(|n| product(columns[m], columns[n])));
        let row = |n: Axis| [axes[0][n], axes[1][n], axes[2][n]];
        let reach = Axis::ALL.map(|n| hypotenuse(hypotenuse(axes[0][n], axes[1][n]), axes[2][n]));
        let outermost = Axis::ALL.map(|n| Axis::ALL.map(|m| product(row(n), row(m)) / (reach[n] * reach[n])));
        let lengths = squares.map(Real::sqrt);
        UnitMap { columns, form, reach, outermost, scale: lengths[0] * lengths[1] * lengths[2] }
    }

    /// Where a point lies.
    #[inline(always)]
    pub fn map(&self, p: [f64; 3]) -> [f64; 3] {
        Axis::ALL.map(|r| self.columns[0][r] * p[0] + self.columns[1][r] * p[1] + self.columns[2][r] * p[2])
    }

    /// As the plane across it in which the line lies farther out has it: near the outermost point that conic is small, and known to the last digits.
    #[inline]
    fn span(&self, m: Axis, q: [Twofold; 2]) -> Span {
        let [u, v] = m.others();
        let first = q[0].value.abs() * self.reach[v] >= q[1].value.abs() * self.reach[u];
        let (n, out, far, near) = if first { (u, v, q[0], q[1]) } else { (v, u, q[1], q[0]) };
        let (reach, center, leading) = (self.reach[n], &self.outermost[n], self.form[m][m]);
        let beside = near.value - center[out] * far.value;
        let share = difference_of_squares(reach, far) / (reach * reach);
        let aside = beside * (reach / self.scale);
        let foot = center[m] * far.value - self.form[m][out] / leading * beside;
        symmetric(foot, leading * share - aside * aside, leading)
    }
}
