//! The public interface of this module: solids, and what they tell of a layer.

use super::anchor::Anchor;
use super::ends::End;
use super::part::Part;
use super::spread::{self, FacesBetween, NumberedPart};
use super::wall::{Curved, UnitMap, Wall};
use super::window::reached;
use crate::grid::Grid;
use crate::grid::cell_range::RangeKind;
use crate::number::axis::Axis;
use crate::number::real::{Real, Vector};

/// A solid by formula: convex, of one to three parts that share no volume.
#[derive(Clone, Debug, PartialEq)]
pub struct QuadricSolid {
    parts: heapless::Vec<Part, 3>,
}

/// Lengths beyond these are refused: products of four of them leave the range of `f64`.
const SIZES: core::ops::Range<f64> = 1e-60..1e60;

fn wide<V: Vector>(v: V) -> Option<[f64; 3]> {
    let a = v.to_array().map(Real::to_f64);
    a.iter().all(|x| x.abs() < SIZES.end).then_some(a)
}

/// Two places that are nearer to each other along an axis than this, in ε of their distance from the origin along it, are at one place there.
const ONE_PLACE: f64 = 4.0;

/// The ends of a solid; where its axis is along one of the grid but for rounding, it is along that: then an end that should lie in a plane lies there.
fn straight<V: Vector>(from: V, to: V) -> Option<[[f64; 3]; 2]> {
    let (from, to) = (wide(from)?, wide(to)?);
    let room = ONE_PLACE * V::Scalar::EPSILON.to_f64();
    let is_off = |n: &Axis| (to[*n] - from[*n]).abs() > room * from[*n].abs().max(to[*n].abs());
    let length = Axis::ALL.map(|n| (to[n] - from[n]).abs()).into_iter().fold(0.0, f64::max);
    let mut off = Axis::ALL.into_iter().filter(|n| is_off(n) && (to[*n] - from[*n]).abs() > room * length);
    let (Some(along), None) = (off.next(), off.next()) else { return Some([from, to]) };
    let mut end = from;
    end[along] = to[along];
    Some([from, end])
}

/// Length and direction between two points; none if they are too close or too far.
fn direction(from: [f64; 3], to: [f64; 3]) -> Option<(f64, [f64; 3])> {
    let d = Axis::ALL.map(|n| to[n] - from[n]);
    let largest = d.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    if !SIZES.contains(&largest) {
        return None;
    }
    let scaled = d.map(|x| x / largest);
    let length = Real::sqrt(scaled[0] * scaled[0] + scaled[1] * scaled[1] + scaled[2] * scaled[2]);
    // A component below the smallest square would pretend a tilt that no product can hold.
    let unit = scaled.map(|x| x / length).map(|x| if x.abs() < 1e-120 { 0.0 } else { x });
    Some((length * largest, unit))
}

impl QuadricSolid {
    fn of(parts: &[Part]) -> Self {
        QuadricSolid { parts: parts.iter().copied().collect() }
    }

    /// How many parts it is made of that share no volume: three of a capsule, else one.
    #[must_use]
    pub fn part_count(&self) -> usize {
        self.parts.len()
    }

    /// Whether it is a ball.
    #[must_use]
    pub fn is_ball(&self) -> bool {
        self.parts.iter().all(|part| part.ball().is_some())
    }

    /// Its parts, which share no volume.
    pub(super) fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// A ball; none if its radius or centre leaves 10⁻⁶⁰ to 10⁶⁰.
    #[must_use]
    pub fn ball<V: Vector>(center: V, radius: V::Scalar) -> Option<Self> {
        let (center, radius) = (wide(center)?, radius.to_f64());
        let curved = Curved::new(Wall::Ball { radius }, [0.0, 0.0, 1.0]);
        SIZES.contains(&radius).then(|| Self::of(&[Part::new(center, curved, [None; 2])]))
    }

    /// A cylinder between the centres of its flat ends; none if a length leaves 10⁻⁶⁰ to 10⁶⁰.
    #[must_use]
    pub fn cylinder<V: Vector>(from: V, to: V, radius: V::Scalar) -> Option<Self> {
        let [from, to] = straight(from, to)?;
        Some(Self::of(&[tube(from, to, radius.to_f64())?]))
    }

    /// A capsule; none if a length leaves 10⁻⁶⁰ to 10⁶⁰. With both ends in one place it is a ball.
    #[must_use]
    pub fn capsule<V: Vector>(from: V, to: V, radius: V::Scalar) -> Option<Self> {
        if from == to {
            return Self::ball(from, radius);
        }
        let ([from, to], radius) = (straight(from, to)?, radius.to_f64());
        let tube = tube(from, to, radius)?;
        let half = |center: [f64; 3], sign: f64| {
            let inward = tube.curved.axis.map(|a| a * sign);
            // The disc where it meets the cylinder belongs to that.
            let end = End { center, shift: [0.0; 3], inward, radius, closed: false };
            Part::new(center, Curved::new(Wall::Ball { radius }, tube.curved.axis), [Some(end), None])
        };
        Some(Self::of(&[tube, half(from, -1.0), half(to, 1.0)]))
    }

    /// A cone from the centre and radius of its base to its apex; none if a length leaves 10⁻⁶⁰ to 10⁶⁰.
    #[must_use]
    pub fn cone<V: Vector>(base: V, apex: V, radius: V::Scalar) -> Option<Self> {
        Self::truncated_cone(base, apex, [radius, V::Scalar::ZERO])
    }

    /// A cone between the centres of its flat ends, by their radii, one of which may be 0; none if a length leaves 10⁻⁶⁰ to 10⁶⁰. Equal radii
    /// make a cylinder.
    #[must_use]
    pub fn truncated_cone<V: Vector>(from: V, to: V, radii: [V::Scalar; 2]) -> Option<Self> {
        let ([from, to], [one, other]) = (straight(from, to)?, radii.map(Real::to_f64));
        if one == other {
            return Some(Self::of(&[tube(from, to, one)?]));
        }
        // From the larger end; the origin is there, or in the apex if there is one, unless that is far. An apex that is not the origin is an end of
        // no radius.
        let (wide_end, narrow, radii) = if one > other { (from, to, [one, other]) } else { (to, from, [other, one]) };
        let (height, axis) = direction(wide_end, narrow)?;
        if !SIZES.contains(&radii[0]) || !(radii[1] == 0.0 || SIZES.contains(&radii[1])) {
            return None;
        }
        let slope = (radii[1] - radii[0]) / height;
        let start = if radii[1] == 0.0 { (narrow, 0.0) } else { (wide_end, radii[0]) };
        let anchor = Anchor::of([wide_end, narrow], (height, axis), start.0, radii[0]);
        let (origin, radius) = anchor.map_or(start, |anchor| (anchor.place, anchor.radius(radii)));
        let end = |center: [f64; 3], sign: f64, radius: f64| End {
            center,
            shift: Axis::ALL.map(|n| center[n] - origin[n]),
            inward: axis.map(|a| a * sign),
            radius,
            closed: true,
        };
        let (base, top) = (end(wide_end, 1.0, radii[0]), end(narrow, -1.0, radii[1]));
        let ends = [Some(base), (radius > 0.0).then_some(top)];
        Some(Self::of(&[Part::new(origin, Curved::new(Wall::Cone { radius, slope }, axis), ends)]))
    }

    /// An ellipsoid from its centre and half axes, which must be orthogonal; none if a length leaves 10⁻⁶⁰ to 10⁶⁰.
    #[must_use]
    pub fn ellipsoid<V: Vector>(center: V, half_axes: [V; 3]) -> Option<Self> {
        let center = wide(center)?;
        let [a, b, c] = half_axes.map(|v| (wide(v), v.length().to_f64()));
        if ![a.1, b.1, c.1].iter().all(|length| SIZES.contains(length)) {
            return None;
        }
        let axes = [a.0?, b.0?, c.0?];
        let turn = |p: usize, q: usize| axes[0][p] * axes[1][q] - axes[0][q] * axes[1][p];
        let right = turn(1, 2) * axes[2][0] + turn(2, 0) * axes[2][1] + turn(0, 1) * axes[2][2];
        let axes = if right < 0.0 { [axes[0], axes[1], axes[2].map(|x| -x)] } else { axes };
        let curved = Curved::new(Wall::Ellipsoid(UnitMap::new(axes)), [0.0, 0.0, 1.0]);
        Some(Self::of(&[Part::new(center, curved, [None; 2])]))
    }

    /// Centres and radii of the flat ends that lie in the plane across `axis` at a coordinate.
    pub fn ends_in_plane(&self, axis: usize, coordinate: f64) -> impl Iterator<Item = ([f64; 3], f64)> {
        let ends = self.parts.iter().flat_map(|part| part.ends.iter().flatten()).filter(|end| end.closed);
        let lies = move |end: &&End| {
            let along = end.inward.get(axis).is_some_and(|a| a.abs() == 1.0);
            along && end.center.get(axis) == Some(&coordinate)
        };
        ends.filter(lies).map(|end| (end.center, end.radius))
    }

    /// Tells the solid's shares in layer `k`: of cells, and with `areas` of x and y faces and of the z faces below, by their positions in
    /// the fields of a layer ([`crate::grid::fields::Fields`]). The shares of a capsule's three parts are told one by one and add up.
    /// Returns by how much the worst of them left 0 to 1 before it was cut, or may be off where an ellipsoid is flat and cells are thin; more than rounding means
    /// that it cannot be relied on.
    pub fn layer<R: Real>(
        &self,
        grid: &Grid<R>,
        k: usize,
        areas: bool,
        visit: &mut impl FnMut(RangeKind, usize, f64),
    ) -> f64 {
        self.layer_between(grid, k, areas, &mut (), visit)
    }

    /// The same with faces in the planes below and above, as layers leave them to each other.
    pub fn layer_between<R: Real>(
        &self,
        grid: &Grid<R>,
        k: usize,
        areas: bool,
        between: &mut impl FacesBetween,
        visit: &mut impl FnMut(RangeKind, usize, f64),
    ) -> f64 {
        let mut worst = 0.0;
        for (number, part) in self.parts.iter().enumerate() {
            worst = f64::max(worst, spread::layer(NumberedPart { part, number, between }, grid, k, areas, visit));
            if matches!(&part.curved.wall, Wall::Ellipsoid(map) if map.flatness() > FLAT) {
                let lost = part.cancelled(narrowest(part, grid, k));
                worst = if lost > LOST { worst.max(lost) } else { worst };
            }
        }
        worst
    }

    /// Tells its shares in the z faces of plane `plane`, likewise.
    pub fn plane<R: Real>(&self, grid: &Grid<R>, plane: usize, visit: &mut impl FnMut(RangeKind, usize, f64)) {
        self.parts.iter().for_each(|part| spread::plane(part, grid, plane, visit));
    }
}

/// Of ellipsoids flatter than this, whose longest axis is some thirty times the shortest, it is asked what cancels in their cells.
const FLAT: f64 = 1e3;

/// More than this counts.
const LOST: f64 = 1e-6;

/// The least widths of the cells of a layer that a part reaches.
fn narrowest<R: Real>(part: &Part, grid: &Grid<R>, k: usize) -> [f64; 3] {
    Axis::ALL.map(|axis| {
        let edges = grid.edges(axis as usize);
        let cells = if axis == Axis::Z { k..k + 1 } else { reached(edges, part.extent(axis)) };
        let edges = edges.get(cells.start..=cells.end).unwrap_or_default().windows(2);
        edges.fold(f64::INFINITY, |least, pair| match pair {
            [low, high] => least.min((*high - *low).to_f64()),
            _ => least,
        })
    })
}

/// A cylinder.
fn tube(from: [f64; 3], to: [f64; 3], radius: f64) -> Option<Part> {
    let (length, axis) = direction(from, to)?;
    let origin = Anchor::of([from, to], (length, axis), from, radius).map_or(from, |anchor| anchor.place);
    let end = |center: [f64; 3], sign: f64| End {
        center,
        shift: Axis::ALL.map(|n| center[n] - origin[n]),
        inward: axis.map(|a| a * sign),
        radius,
        closed: true,
    };
    let ends = [Some(end(from, 1.0)), Some(end(to, -1.0))];
    SIZES.contains(&radius).then(|| Part::new(origin, Curved::new(Wall::Cylinder { radius }, axis), ends))
}
