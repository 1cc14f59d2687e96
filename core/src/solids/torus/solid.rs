//! The public interface of this module: a torus or a pipe bend, and what it tells of a layer.

use super::ring::{Ends, NOISE, Ring, ahead, length2};
use super::section::{Rectangle, Reference, Section};
use crate::grid::cell_range::RangeKind;
use crate::grid::{Grid, rounding};
use crate::number::axis::Axis;
use crate::number::plane::P2;
use crate::number::real::{Real, Vector};
use crate::number::space::{P3, cross, dot, unit};
use core::f64::consts::PI;
use core::ops::Range;
use heapless::Vec;

/// A torus, or a part of a turn of one between flat ends. Not convex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TorusSolid {
    ring: Ring,
}

/// What a torus is made from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TorusShape<V: Vector> {
    /// Centre of the ring.
    pub center: V,
    /// Along the axis of the ring, of any length.
    pub axis: V,
    /// From the axis to where a part of a turn begins; what it has along the axis does not count.
    pub start: V,
    /// Radius of the circle in the middle of the tube.
    pub radius: V::Scalar,
    /// Radius of the tube, not above that of the ring.
    pub tube: V::Scalar,
    /// Degrees from the start, counter-clockwise seen from the tip of the axis; 360 for a whole torus.
    pub angle: f64,
}

/// Lengths beyond these are refused.
const SIZES: Range<f64> = 1e-30..1e30;

/// What rounding takes of a volume, as a share of a cell and for each of its sizes to the axis.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// A hole is closed that is narrower than this share of the ring.
const CLOSED_HOLE: f64 = 1e-6;

/// How near to a cell the middle of a ring with a closed hole is in it, in sizes of the cell; and what the share of such a cell may be off by, for each of its
/// sizes to the ring's radius: a sixtieth of the root of a rounding. The largest found in 30 000 random cells is 1.1·10⁻⁷, with a radius of hundreds of cells.
const MARGIN_AT_HOLE: f64 = 1e-3;
const TOUCHING: f64 = 2.5e-10;

/// Margin for rounding, as a share of coordinates and sizes.
const MARGIN: f64 = 1e-12;

/// The vector of length 1 in the direction of one within these sizes; components that could only underflow are zero.
fn direction(v: P3) -> Option<P3> {
    let largest = v.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let unit = if SIZES.contains(&largest) { unit(v) } else { None };
    Some(unit?.map(|x| if x.abs() < 1e-120 { 0.0 } else { x }))
}

/// A vector of about length 1; along an axis if no other component is more than rounding: an end that lies in a plane of a grid lies there exactly.
fn without_noise(v: P3) -> P3 {
    let noise = |x: &f64| x.abs() <= NOISE;
    if v.iter().filter(|x| noise(x)).count() == 2 { v.map(|x| if noise(&x) { 0.0 } else { x }) } else { v }
}

/// Cosine and sine of degrees, quarter turns exactly.
fn turned(degrees: f64) -> P2 {
    let quarters = degrees / 90.0;
    if quarters == 1.0 {
        [0.0, 1.0]
    } else if quarters == 2.0 {
        [-1.0, 0.0]
    } else if quarters == 3.0 {
        [0.0, -1.0]
    } else {
        let angle = degrees * (PI / 180.0);
        [libm::cos(angle), libm::sin(angle)]
    }
}

/// Of so many cells of a row the faces that the next one shares are kept.
const ROW: usize = 64;

/// A cell's extent along each axis, from the centre.
type Sides = [P2; 3];

fn corners(sides: &Sides) -> impl Iterator<Item = P3> + Clone {
    let [x, y, z] = *sides;
    (0..8_usize).map(move |n| [x[n & 1], y[(n >> 1) & 1], z[(n >> 2) & 1]])
}

/// What a solid has of a face, and from where its azimuth counts.
#[derive(Clone, Copy)]
struct Face {
    section: Section,
    toward: P2,
}

impl TorusSolid {
    /// None if a length leaves 10⁻³⁰ to 10³⁰, a direction is missing, the tube is wider than the ring, or the angle is not above 0 and up to 360.
    #[must_use]
    pub fn new<V: Vector>(shape: &TorusShape<V>) -> Option<Self> {
        let number = |v: V| v.to_array().map(Real::to_f64);
        let (center, axis, start) =
            (number(shape.center), direction(number(shape.axis))?, direction(number(shape.start))?);
        let (radius, tube) = (shape.radius.to_f64(), shape.tube.to_f64());
        let sizes = SIZES.contains(&radius) && SIZES.contains(&tube) && tube <= radius;
        let placed = center.iter().all(|x| x.abs() < SIZES.end);
        if !(sizes && placed && shape.angle > 0.0 && shape.angle <= 360.0) {
            return None;
        }
        let along = dot(start, axis);
        let across = Axis::ALL.map(|n| start[n] - along * axis[n]);
        if !(dot(across, across) > 1e-12) {
            return None;
        }
        let across = direction(without_noise(across))?;
        let beside = cross(axis, across);
        let frame = [across, beside, axis];
        let ends = (shape.angle < 360.0).then(|| {
            let [c, s] = turned(shape.angle);
            let global = |p: P2| Axis::ALL.map(|n| p[0] * across[n] + p[1] * beside[n]);
            let inward = [global([0.0, 1.0]), global([s, -c])].map(without_noise);
            let toward = [[1.0, 0.0], [c, s]];
            Ends { inward, toward, wide: shape.angle > 180.0, middle: turned(shape.angle * 0.5) }
        });
        Some(TorusSolid { ring: Ring { center, frame, radius, tube, ends } })
    }

    pub(super) fn ring(&self) -> &Ring {
        &self.ring
    }

    /// Its share of one cell, or of the face normal to an axis, and what that may be off by: of a box from `lo` to `hi`, which for a face is flat.
    /// Where no numbers come out, as of a box without end, 0 that may be off by 1.
    #[must_use]
    pub fn share(&self, kind: RangeKind, lo: P3, hi: P3) -> (f64, f64) {
        let ring = &self.ring;
        let sides = Axis::ALL.map(|n| {
            let room = rounding([lo[n], hi[n]]);
            [lo[n], hi[n]].map(|x| if (x - ring.center[n]).abs() <= room { 0.0 } else { x - ring.center[n] })
        });
        let (share, error) = if let RangeKind::Faces(axis) = kind {
            let axis = Axis::new(axis).unwrap_or(Axis::Z);
            let rectangle = rectangle(axis, sides[axis][0], &sides);
            let section = ring.section(&rectangle, None, false);
            let area = (rectangle.u[1] - rectangle.u[0]) * (rectangle.v[1] - rectangle.v[0]);
            (fraction(&section, area), section.error)
        } else {
            match ring.cell(&sides, [None; 2]) {
                Cell::Open => (0.0, 0.0),
                Cell::Closed => (1.0, 0.0),
                Cell::Cut { share, error, .. } => (share.clamp(0.0, 1.0), error + (share - 1.0).max(-share).max(0.0)),
            }
        };
        if (share + error).is_nan() { (0.0, 1.0) } else { (share, error) }
    }

    /// May the solid reach a box? False is certain.
    #[must_use]
    pub fn may_reach(&self, lo: P3, hi: P3) -> bool {
        let sides = Axis::ALL.map(|n| [lo[n] - self.ring.center[n], hi[n] - self.ring.center[n]]);
        let size = sides.map(|[lo, hi]| hi - lo);
        let half = Real::sqrt(dot(size, size)) * 0.5;
        let (_, missed) = self.ring.beside_ends(corners(&sides));
        self.ring.outside(sides.map(|[lo, hi]| (lo + hi) * 0.5)) <= half * (1.0 + 1e-9) && !missed
    }

    /// Centres and inward normals of its flat ends, and the radius of both.
    pub fn ends(&self) -> impl Iterator<Item = (P3, P3, f64)> {
        let ring = self.ring;
        let [e, f, _] = ring.frame;
        let end = move |[x, y]: P2, inward: P3| {
            let center = Axis::ALL.map(|k| ring.center[k] + ring.radius * (x * e[k] + y * f[k]));
            (center, inward, ring.tube)
        };
        ring.ends.into_iter().flat_map(move |ends| {
            ends.toward.into_iter().zip(ends.inward).map(move |(toward, inward)| end(toward, inward))
        })
    }

    /// Is another one, along the same ring and between the same ends, no thicker? False where numbers differ in any bit.
    #[must_use]
    pub fn holds(&self, other: &TorusSolid) -> bool {
        let (a, b) = (&self.ring, &other.ring);
        let is_same_ring = a.center == b.center && a.frame == b.frame && a.radius == b.radius;
        is_same_ring && (a.ends.is_none() || a.ends == b.ends) && b.tube <= a.tube
    }

    /// Equal parts of it along the ring.
    pub fn pieces(&self, count: u32) -> impl Iterator<Item = TorusSolid> {
        let ring = self.ring;
        let turn = ring.ends.map_or(2.0 * PI, |ends| {
            let angle = ahead(ends.toward[1], ends.toward[0]);
            if ends.wide && angle < 0.0 || angle <= 0.0 { angle + 2.0 * PI } else { angle }
        });
        let parts = f64::from(count.max(1));
        (0..count.max(1)).map(move |n| {
            let at = |part: u32| -> P2 {
                match (part, ring.ends) {
                    (0, _) => [1.0, 0.0],
                    (part, Some(ends)) if part == count.max(1) => ends.toward[1],
                    _ => [libm::cos(turn * f64::from(part) / parts), libm::sin(turn * f64::from(part) / parts)],
                }
            };
            let (from, to) = (at(n), at(n + 1));
            let middle = turn * (f64::from(n) + 0.5) / parts;
            let [e, f, _] = ring.frame;
            let global = |p: P2| Axis::ALL.map(|k| p[0] * e[k] + p[1] * f[k]);
            let inward = [global([-from[1], from[0]]), global([to[1], -to[0]])];
            let middle = [libm::cos(middle), libm::sin(middle)];
            let ends = Ends { inward, toward: [from, to], wide: turn / parts > PI, middle };
            TorusSolid { ring: Ring { ends: Some(ends), ..ring } }
        })
    }

    /// A point inside, in the middle of the tube.
    #[must_use]
    pub fn middle(&self) -> P3 {
        let ring = &self.ring;
        let [x, y] = ring.ends.map_or([1.0, 0.0], |ends| ends.middle);
        let [e, f, _] = ring.frame;
        Axis::ALL.map(|n| ring.center[n] + ring.radius * (x * e[n] + y * f[n]))
    }

    /// Radii of ring and tube together.
    #[must_use]
    pub fn size(&self) -> f64 {
        self.ring.radius + self.ring.tube
    }

    /// Its outermost point along a direction.
    #[must_use]
    pub fn outermost(&self, direction: P3) -> P3 {
        let p = self.ring.outermost(direction);
        Axis::ALL.map(|n| self.ring.center[n] + p[n])
    }

    /// Lowest and highest coordinate along an axis, with a margin for rounding; NaN along axes beyond 2.
    #[must_use]
    pub fn extent(&self, axis: usize) -> P2 {
        Axis::new(axis).map_or([f64::NAN; 2], |axis| self.extent_along(axis))
    }

    fn extent_along(&self, axis: Axis) -> P2 {
        let toward = |sign: f64| {
            let mut direction = [0.0; 3];
            direction[axis] = sign;
            self.outermost(direction)[axis]
        };
        let [lo, hi] = [toward(-1.0), toward(1.0)];
        let margin = (lo.abs().max(hi.abs()) + self.ring.radius + self.ring.tube) * MARGIN;
        [lo - margin, hi + margin]
    }

    /// Tells the shares in layer `k` as [`crate::solids::quadric::QuadricSolid::layer`] does, each with what it may be off by. Returns by how much the worst
    /// left 0 to 1 beyond that.
    pub fn layer<R: Real>(
        &self,
        grid: &Grid<R>,
        k: usize,
        areas: bool,
        visit: &mut impl FnMut(RangeKind, usize, f64, f64),
    ) -> f64 {
        let [xs, ys, zs] = [0, 1, 2].map(|axis| grid.edges(axis));
        let Some(&[z0, z1]) = zs.get(k..).and_then(|e| e.first_chunk()) else { return 0.0 };
        let z = [z0, z1].map(|z| z.to_f64());
        let [lowest, highest] = self.extent_along(Axis::Z);
        if lowest > z[1] || highest < z[0] {
            return 0.0;
        }
        let ring = self.ring.in_planes(grid);
        let z = z.map(|z| z - ring.center[2]);
        let [nx, ny, _] = grid.cells();
        let rows = reached(ys, self.extent_along(Axis::Y));
        let cells = reached(xs, self.extent_along(Axis::X));
        let mut told = Teller { ring: &ring, cells: [nx, ny], areas, worst: 0.0, visit };
        // The faces that a row shares with the one before it, as far as there is room.
        let mut shared: Vec<Option<Face>, ROW> = Vec::new();
        let _ = shared.resize(cells.len().min(ROW), None);
        for j in rows.clone() {
            let Some(y) = side(ys, j, ring.center[1]) else { break };
            let mut before = None;
            for (n, i) in cells.clone().enumerate() {
                let Some(x) = side(xs, i, ring.center[0]) else { break };
                let mut none = None;
                let below = shared.get_mut(n).unwrap_or(&mut none);
                told.cell([i, j], &[x, y, z], [&mut before, below], [i + 1 == cells.end, j + 1 == rows.end]);
            }
        }
        told.worst
    }

    /// Tells the shares in the z faces of plane `plane`, likewise.
    pub fn plane<R: Real>(&self, grid: &Grid<R>, plane: usize, visit: &mut impl FnMut(RangeKind, usize, f64, f64)) {
        let [xs, ys, zs] = [0, 1, 2].map(|axis| grid.edges(axis));
        let Some(z) = zs.get(plane).map(|z| z.to_f64()) else { return };
        let [lowest, highest] = self.extent_along(Axis::Z);
        if lowest > z || highest < z {
            return;
        }
        let ring = self.ring.in_planes(grid);
        let h = z - ring.center[2];
        for j in reached(ys, self.extent_along(Axis::Y)) {
            let Some(v) = side(ys, j, ring.center[1]) else { break };
            for i in reached(xs, self.extent_along(Axis::X)) {
                let Some(u) = side(xs, i, ring.center[0]) else { break };
                let section = ring.section(&Rectangle { n: Axis::Z, h, u, v }, None, false);
                let share = fraction(&section, (u[1] - u[0]) * (v[1] - v[0]));
                if share > 0.0 {
                    visit(RangeKind::Faces(2), j * grid.cells()[0] + i, share, section.error);
                }
            }
        }
    }
}

/// The cells along an axis that an extent reaches or touches.
fn reached<R: Real>(edges: &[R], [lo, hi]: P2) -> Range<usize> {
    let first = edges.partition_point(|e| e.to_f64() < lo).saturating_sub(1);
    first..edges.partition_point(|e| e.to_f64() <= hi).min(edges.len().saturating_sub(1))
}

fn side<R: Real>(edges: &[R], at: usize, center: f64) -> Option<P2> {
    let [lo, hi] = [edges.get(at)?, edges.get(at + 1)?].map(|e| e.to_f64() - center);
    Some([lo, hi])
}

fn fraction(section: &Section, area: f64) -> f64 {
    if section.whole { 1.0 } else { (section.area / area).clamp(0.0, 1.0) }
}

struct Teller<'v, F> {
    ring: &'v Ring,
    cells: [usize; 2],
    areas: bool,
    worst: f64,
    visit: &'v mut F,
}

impl<F: FnMut(RangeKind, usize, f64, f64)> Teller<'_, F> {
    fn tell(&mut self, kind: RangeKind, at: usize, share: f64, error: f64) {
        if share > 0.0 {
            (self.visit)(kind, at, share, error);
        }
    }

    /// A cell and its low faces, and high ones where none follows. `shared` are the faces that it shares with the cells before it along x and y, and becomes
    /// those that it shares with the next.
    fn cell(&mut self, [i, j]: [usize; 2], sides: &Sides, shared: [&mut Option<Face>; 2], last: [bool; 2]) {
        let [nx, _] = self.cells;
        let c = j * nx + i;
        let size = sides.map(|[lo, hi]| hi - lo);
        let places = [[c + j, c + j + 1], [c, c + nx], [c, c]];
        let areas = self.areas;
        let last = [last[0], last[1], false];
        let shown = |axis: Axis, high: usize| areas && (high == 0 || last[axis]);
        let [along_x, along_y] = shared;
        match self.ring.cell(sides, [along_x.take(), along_y.take()]) {
            Cell::Open => {}
            Cell::Closed => {
                self.tell(RangeKind::Cells, c, 1.0, 0.0);
                for axis in Axis::ALL {
                    for high in (0..2).filter(|&high| shown(axis, high)) {
                        self.tell(RangeKind::Faces(axis as usize), places[axis][high], 1.0, 0.0);
                    }
                }
            }
            Cell::Cut { share, error, faces } => {
                (*along_x, *along_y) = (Some(faces[0][1]), Some(faces[1][1]));
                let beyond = (share - 1.0).max(-share) - error;
                self.worst = if share.is_nan() { f64::INFINITY } else { self.worst.max(beyond) };
                self.tell(RangeKind::Cells, c, share.min(1.0), error);
                for axis in Axis::ALL {
                    let [u, v] = axis.others();
                    for high in (0..2).filter(|&high| shown(axis, high)) {
                        let section = faces[axis][high].section;
                        let share = fraction(&section, size[u] * size[v]);
                        self.tell(RangeKind::Faces(axis as usize), places[axis][high], share, section.error);
                    }
                }
            }
        }
    }
}

/// The section of a cell with the plane across an axis at a coordinate.
fn rectangle(n: Axis, h: f64, sides: &Sides) -> Rectangle {
    let [u, v] = n.others().map(|m| sides[m]);
    Rectangle { n, h, u, v }
}

/// What a solid has of a cell.
#[expect(clippy::large_enum_variant, reason = "nothing is allocated here")]
enum Cell {
    Open,
    Closed,
    /// The share of the volume and what it may be off by; the faces, low and high.
    Cut {
        share: f64,
        error: f64,
        faces: [[Face; 2]; 3],
    },
}

impl Ring {
    /// Flat ends in the planes of a grid that they miss by rounding. Nothing else moves: what touches a plane goes on to do so.
    fn in_planes<R: Real>(&self, grid: &Grid<R>) -> Self {
        let mut ring = *self;
        for n in Axis::ALL {
            let is_along = |inward: &P3| inward[n].abs() > 1.0 - 8.0 * f64::EPSILON;
            if self.ends.as_ref().is_some_and(|ends| ends.inward.iter().any(is_along)) {
                ring.center[n] = grid.plane_at(n as usize, ring.center[n]).unwrap_or(ring.center[n]);
            }
        }
        ring
    }

    /// A cell; the low faces across x and y may be known.
    fn cell(&self, sides: &Sides, low: [Option<Face>; 2]) -> Cell {
        let size = sides.map(|[lo, hi]| hi - lo);
        let half = Real::sqrt(dot(size, size)) * 0.5;
        let outside = self.outside(sides.map(|[lo, hi]| (lo + hi) * 0.5));
        if outside > half * (1.0 + 1e-9) {
            return Cell::Open;
        }
        let (held, missed) = self.beside_ends(corners(sides));
        if held && outside < -half * (1.0 + 1e-9) {
            return Cell::Closed;
        }
        let mut faces = self.faces(sides, low, false);
        let (mut share, mut error) = (0.0, 0.0);
        if !missed {
            let mut lost = self.lost(sides, &faces);
            let careful = lost > 0.0;
            if careful {
                faces = self.faces(sides, [None; 2], true);
                lost = self.lost(sides, &faces);
            }
            (share, error) = self.volume(sides, &faces, careful);
            let all = size[0] * size[1] * size[2];
            share /= all;
            error += lost * PI / all;
        }
        Cell::Cut { share, error, faces }
    }

    /// The sides of a cell; the low ones across x and y may be known.
    fn faces(&self, sides: &Sides, low: [Option<Face>; 2], careful: bool) -> [[Face; 2]; 3] {
        let face = |n: Axis, h: f64| {
            let rectangle = rectangle(n, h, sides);
            let [x, y, _] = self.local(rectangle.middle());
            Face { section: self.section(&rectangle, None, careful), toward: [x, y] }
        };
        let ([x, y, z], [low_x, low_y]) = (*sides, low);
        let both = |n: Axis, [lo, hi]: P2, low: Option<Face>| [low.unwrap_or_else(|| face(n, lo)), face(n, hi)];
        [both(Axis::X, x, low_x), both(Axis::Y, y, low_y), both(Axis::Z, z, None)]
    }

    /// By how much the flux of the field ρ e_φ through the sides of a cell and the ends in it is not zero, beyond what errors of the sections tell. The field
    /// has no divergence and is tangent to the torus: what is left is that of sections that have not been found.
    fn lost(&self, sides: &Sides, faces: &[[Face; 2]; 3]) -> f64 {
        let (mut sum, mut room) = (0.0, 0.0);
        for n in Axis::ALL {
            let [u, v] = n.others().map(|m| sides[m][1] - sides[m][0]);
            for (face, sign) in faces[n].iter().zip([-1.0, 1.0]) {
                sum += sign * face.section.moment;
                room += face.section.error * u * v;
            }
        }
        for (_, sign, moment) in self.ends_within(sides) {
            sum += sign * moment;
        }
        let reach = self.radius + self.tube;
        (sum.abs() - (room + ROUNDING * self.tube * self.tube) * reach).max(0.0)
    }

    /// Of the ends in a cell: their directions, on which side of them the solid lies, ∫ ρ dA.
    fn ends_within(&self, sides: &Sides) -> impl Iterator<Item = (P2, f64, f64)> {
        let within = move |((inward, toward), sign): ((P3, P2), f64)| {
            let heights = corners(sides).map(|p| dot(inward, p));
            // A cell before the end: if its side lies in the end's plane, the section there has been counted.
            let before = heights.fold(f64::INFINITY, f64::min) < 0.0;
            before.then(|| (toward, sign, self.moment_of_disc(toward, sides)))
        };
        let ends = self.ends.iter();
        ends.flat_map(|ends| ends.inward.into_iter().zip(ends.toward).zip([-1.0, 1.0])).filter_map(within)
    }

    /// Volume in a cell from the fluxes through its sides and the ends in it, and what its share may be off by.
    fn volume(&self, sides: &Sides, faces: &[[Face; 2]; 3], careful: bool) -> (f64, f64) {
        let width = |n: Axis| sides[n][1] - sides[n][0];
        let around_axis = self.axis_meets(sides);
        let reference = if around_axis {
            // The cut of a whole torus lies opposite the cell's middle, so that no side of the cell lies in it.
            let [x, y, _] = self.local(sides.map(|[lo, hi]| (lo + hi) * 0.5));
            let off = length2([x, y]) > 1e-3 * (width(Axis::X) + width(Axis::Y) + width(Axis::Z));
            let toward = self.ends.as_ref().map_or(if off { [x, y] } else { [0.6, 0.8] }, |ends| ends.middle);
            let toward = toward.map(|c| c / length2(toward));
            Reference { toward, cut: self.ends.is_none() }
        } else {
            let [x, y, _] = self.local(sides.map(|[lo, hi]| (lo + hi) * 0.5));
            Reference { toward: [x, y], cut: false }
        };
        let (mut volume, mut error) = (0.0, 0.0);
        let mean = (width(Axis::X) + width(Axis::Y) + width(Axis::Z)) / 3.0;
        for n in Axis::ALL {
            for ((face, h), sign) in faces[n].iter().zip(sides[n]).zip([-1.0, 1.0]) {
                let mut section = face.section;
                if section.area == 0.0 {
                    continue;
                }
                if around_axis {
                    section = self.section(&rectangle(n, h, sides), Some(reference), careful);
                } else {
                    section.flux += ahead(face.toward, reference.toward) * section.moment;
                }
                volume += sign * section.flux;
                error += section.error * mean / width(n);
            }
        }
        if reference.cut {
            volume += 2.0 * PI * self.moment_of_disc(reference.toward.map(|x| -x), sides);
        }
        for (toward, sign, moment) in self.ends_within(sides) {
            volume += sign * ahead(toward, reference.toward) * moment;
        }
        let least = width(Axis::X).min(width(Axis::Y)).min(width(Axis::Z));
        let rounding = ROUNDING * (1.0 + (self.radius + self.tube) / least);
        // Where the tube closes the hole, the circles that touch in the middle do so by a root of what rounding leaves.
        let touches = self.radius - self.tube <= CLOSED_HOLE * self.radius
            && sides
                .iter()
                .all(|[lo, hi]| lo - MARGIN_AT_HOLE * (hi - lo) <= 0.0 && hi + MARGIN_AT_HOLE * (hi - lo) >= 0.0);
        let touching = if touches { TOUCHING * (self.radius / least) } else { 0.0 };
        (volume, error + rounding + touching)
    }

    /// Does the axis meet a cell or a rectangle, or nearly?
    pub(super) fn axis_meets(&self, sides: &Sides) -> bool {
        let axis = self.frame[2];
        let (mut first, mut last) = (f64::NEG_INFINITY, f64::INFINITY);
        for (&[lo, hi], along) in sides.iter().zip(axis) {
            let margin = (hi - lo) * 1e-3;
            let (lo, hi) = (lo - margin, hi + margin);
            if along == 0.0 {
                if lo > 0.0 || hi < 0.0 {
                    return false;
                }
                continue;
            }
            let (s, t) = (lo / along, hi / along);
            (first, last) = (first.max(s.min(t)), last.min(s.max(t)));
        }
        first <= last
    }
}
