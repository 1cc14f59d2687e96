//! Which cells a part may reach: boxes and runs along x, a little too large rather than too small.

use super::ends::End;
use super::part::Part;
use super::wall::Wall;
use crate::number::axis::Axis;
use crate::number::plane::P2;
use crate::number::real::Real;
use core::ops::Range;

/// Lowest and highest coordinate.
pub(super) type Extent = [f64; 2];

/// Margin for rounding, as a share of coordinates and sizes.
const MARGIN: f64 = 1e-12;

/// All along an axis.
pub(super) const EVERYWHERE: Extent = [f64::NEG_INFINITY, f64::INFINITY];

/// A box that holds nothing.
const NOWHERE: [Extent; 3] = [[f64::INFINITY, f64::NEG_INFINITY]; 3];

fn widened([lo, hi]: Extent) -> Extent {
    let margin = (lo.abs().larger(hi.abs()) + (hi - lo)) * MARGIN;
    [lo - margin, hi + margin]
}

/// The cells along an axis that an extent reaches or touches.
pub(super) fn reached<R: Real>(edges: &[R], [lo, hi]: Extent) -> Range<usize> {
    let first = edges.partition_point(|e| e.to_f64() < lo).saturating_sub(1);
    first..edges.partition_point(|e| e.to_f64() <= hi).min(edges.len().saturating_sub(1))
}

/// The same among some cells, which hold all that it reaches.
pub(super) fn reached_of<R: Real>(edges: &[R], cells: &Range<usize>, extent: Extent) -> Range<usize> {
    let found = reached(edges.get(cells.start..=cells.end).unwrap_or_default(), extent);
    cells.start + found.start..cells.start + found.end
}

/// A part of the axis of a cylinder or cone, by shares of the way between its ends, and the largest radius.
struct Stretch {
    ends: [[f64; 3]; 2],
    radius: f64,
    shares: [f64; 2],
}

impl Stretch {
    /// All of the axis.
    fn of(part: &Part) -> Self {
        let (ends, radius) = part.segment();
        Stretch { ends, radius, shares: [0.0, 1.0] }
    }

    /// The shares from which the part may reach between two planes across an axis too; limits in the wrong order if it reaches nothing there.
    #[inline]
    fn within(&self, part: &Part, axis: Axis, limits: Extent) -> P2 {
        let ([a, b], reach) = (self.ends, self.radius * part.curved.across[axis]);
        let ([lo, hi], [first, last]) = (widened([limits[0] - reach, limits[1] + reach]), self.shares);
        let along = b[axis] - a[axis];
        if along != 0.0 {
            let (s, t) = ((lo - a[axis]) / along, (hi - a[axis]) / along);
            [first.larger(s.smaller(t)), last.smaller(s.larger(t))]
        } else if a[axis] < lo || a[axis] > hi {
            [f64::INFINITY, f64::NEG_INFINITY]
        } else {
            [first, last]
        }
    }

    /// How far along an axis of the grid the part's surface may be from between two shares of the axis; none if these are in the wrong order.
    #[inline]
    fn extent(&self, part: &Part, axis: Axis, [first, last]: P2) -> Option<Extent> {
        let margin = MARGIN * (1.0 + first.abs() + last.abs());
        if !(first <= last + margin) {
            return None;
        }
        let [a, b] = self.ends;
        let shares = [first - margin, last + margin];
        let [s, t] = shares.map(|share| a[axis] + share.clamp(0.0, 1.0) * (b[axis] - a[axis]));
        let reach = self.radius * part.curved.across[axis];
        Some(widened([s.smaller(t) - reach, s.larger(t) + reach]))
    }
}

/// Where along x a part may be, row by row, between two planes across z.
pub(super) struct Runs<'a> {
    part: &'a Part,
    z: Extent,
    stretch: Option<Stretch>,
}

impl Part {
    /// Along all axes.
    pub fn extents(&self) -> [Extent; 3] {
        match &self.curved.wall {
            Wall::Ball { .. } | Wall::Ellipsoid(_) => Axis::ALL.map(|axis| self.extent(axis)),
            Wall::Cylinder { .. } | Wall::Cone { .. } => {
                let ([a, b], radius) = self.segment();
                Axis::ALL.map(|axis| {
                    let reach = radius * self.curved.across[axis];
                    widened([a[axis].min(b[axis]) - reach, a[axis].max(b[axis]) + reach])
                })
            }
        }
    }

    /// Along an axis.
    pub fn extent(&self, axis: Axis) -> Extent {
        let around = |reach: f64| widened([self.origin[axis] - reach, self.origin[axis] + reach]);
        match &self.curved.wall {
            Wall::Ball { radius } => around(*radius),
            Wall::Ellipsoid(map) => around(map.reach[axis]),
            Wall::Cylinder { .. } | Wall::Cone { .. } => {
                let ([a, b], radius) = self.segment();
                let reach = radius * self.curved.across[axis];
                widened([a[axis].min(b[axis]) - reach, a[axis].max(b[axis]) + reach])
            }
        }
    }

    /// The axis between the ends, and the largest radius.
    fn segment(&self) -> ([[f64; 3]; 2], f64) {
        let [one, other] = &self.ends;
        let center = |end: &Option<End>| end.as_ref().map_or(self.origin, |e| e.center);
        let radius = |end: &Option<End>| end.as_ref().map_or(0.0, |e| e.radius);
        ([center(one), center(other)], radius(one).max(radius(other)))
    }

    /// Where it may be in a box, which it reaches; limits in the wrong order if it does not.
    pub fn extent_within(&self, place: [Extent; 3]) -> [Extent; 3] {
        let around: [Extent; 3] = match &self.curved.wall {
            Wall::Ellipsoid(_) => return place,
            Wall::Ball { radius } => {
                let off = Axis::ALL.map(|n| {
                    let [lo, hi] = widened(place[n].map(|x| x - self.origin[n]));
                    if lo > 0.0 { lo } else { hi.min(0.0) }
                });
                let squares = off.map(|x| x * x);
                let left = radius * radius * (1.0 + MARGIN) - (squares[0] + squares[1] + squares[2]);
                if !(left >= 0.0) {
                    return NOWHERE;
                }
                Axis::ALL.map(|n| {
                    let reach = Real::sqrt(left + squares[n]);
                    widened([self.origin[n] - reach, self.origin[n] + reach])
                })
            }
            Wall::Cylinder { .. } | Wall::Cone { .. } => {
                let mut stretch = Stretch::of(self);
                for n in Axis::ALL {
                    if place[n] != EVERYWHERE {
                        stretch.shares = stretch.within(self, n, place[n]);
                    }
                }
                let extent = |n: Axis| stretch.extent(self, n, stretch.shares).unwrap_or(NOWHERE[0]);
                // Written out: `map` of an array calls a function for each of them.
                [extent(Axis::X), extent(Axis::Y), extent(Axis::Z)]
            }
        };
        let common = |n: Axis| [place[n][0].larger(around[n][0]), place[n][1].smaller(around[n][1])];
        [common(Axis::X), common(Axis::Y), common(Axis::Z)]
    }

    /// Rows between two planes across z.
    pub fn runs(&self, z: Extent) -> Runs<'_> {
        let axial = matches!(self.curved.wall, Wall::Cylinder { .. } | Wall::Cone { .. });
        let stretch = axial.then(|| {
            let mut stretch = Stretch::of(self);
            stretch.shares = stretch.within(self, Axis::Z, z);
            stretch
        });
        Runs { part: self, z, stretch }
    }
}

impl Runs<'_> {
    /// Along x, of what lies between two planes across y too; none if nothing does.
    pub fn between(&self, y: Extent) -> Option<Extent> {
        let (part, z) = (self.part, self.z);
        match (&part.curved.wall, &self.stretch) {
            (_, Some(stretch)) => stretch.extent(part, Axis::X, stretch.within(part, Axis::Y, y)),
            (Wall::Ball { radius }, None) => {
                let off = |axis: Axis, [lo, hi]: Extent| {
                    let [lo, hi] = widened([lo - part.origin[axis], hi - part.origin[axis]]);
                    if lo > 0.0 { lo } else { hi.min(0.0) }
                };
                let (a, b) = (off(Axis::Y, y), off(Axis::Z, z));
                let square = radius * radius * (1.0 + MARGIN) - a * a - b * b;
                let reach = Real::sqrt(square.max(0.0));
                (square >= 0.0).then(|| widened([part.origin[0] - reach, part.origin[0] + reach]))
            }
            _ => Some(part.extent(Axis::X)),
        }
    }
}
