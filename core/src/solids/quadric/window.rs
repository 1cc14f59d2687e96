//! Which cells a part may reach: boxes and runs along x, a little too large rather than too small.

use super::part::Part;
use super::wall::Wall;
use crate::number::axis::Axis;
use crate::number::real::Real;
use core::ops::Range;

/// Lowest and highest coordinate.
pub(super) type Extent = [f64; 2];

/// Margin for rounding, as a share of coordinates and sizes.
const MARGIN: f64 = 1e-12;

/// A box that holds nothing.
const NOWHERE: [Extent; 3] = [[f64::INFINITY, f64::NEG_INFINITY]; 3];

fn widened([lo, hi]: Extent) -> Extent {
    let margin = (lo.abs().max(hi.abs()) + (hi - lo)) * MARGIN;
    [lo - margin, hi + margin]
}

/// The cells along an axis that an extent reaches or touches.
pub(super) fn reached<R: Real>(edges: &[R], [lo, hi]: Extent) -> Range<usize> {
    let first = edges.partition_point(|e| e.to_f64() < lo).saturating_sub(1);
    first..edges.partition_point(|e| e.to_f64() <= hi).min(edges.len().saturating_sub(1))
}

/// A part of the axis of a cylinder or cone, by shares of the way between its ends, and the largest radius.
struct Stretch {
    ends: [[f64; 3]; 2],
    radius: f64,
    shares: [f64; 2],
}

impl Stretch {
    /// How far along an axis of the grid the part's surface may be from here.
    #[inline]
    fn extent(&self, part: &Part, axis: Axis) -> Extent {
        let [a, b] = self.ends;
        let [s, t] = self.shares.map(|share| a[axis] + share.clamp(0.0, 1.0) * (b[axis] - a[axis]));
        let reach = self.radius * part.curved.across[axis];
        widened([s.min(t) - reach, s.max(t) + reach])
    }
}

impl Part {
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
        let [one, other] = self.ends;
        let center = |end: Option<super::ends::End>| end.map_or(self.origin, |e| e.center);
        let radius = |end: Option<super::ends::End>| end.map_or(0.0, |e| e.radius);
        ([center(one), center(other)], radius(one).max(radius(other)))
    }

    /// The stretch of the axis from which it may reach between planes across some axes; none if it reaches nothing there.
    #[inline]
    fn stretch(&self, limits: impl Iterator<Item = (Axis, Extent)>) -> Option<Stretch> {
        let ([a, b], radius) = self.segment();
        let (mut first, mut last) = (0.0_f64, 1.0_f64);
        for (axis, limits) in limits {
            let reach = radius * self.curved.across[axis];
            let [lo, hi] = widened([limits[0] - reach, limits[1] + reach]);
            let along = b[axis] - a[axis];
            if along != 0.0 {
                let (s, t) = ((lo - a[axis]) / along, (hi - a[axis]) / along);
                (first, last) = (first.max(s.min(t)), last.min(s.max(t)));
            } else if a[axis] < lo || a[axis] > hi {
                return None;
            }
        }
        let margin = MARGIN * (1.0 + first.abs() + last.abs());
        (first <= last + margin).then_some(Stretch { ends: [a, b], radius, shares: [first - margin, last + margin] })
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
                let Some(stretch) = self.stretch(Axis::ALL.into_iter().zip(place)) else { return NOWHERE };
                Axis::ALL.map(|n| stretch.extent(self, n))
            }
        };
        Axis::ALL.map(|n| [place[n][0].max(around[n][0]), place[n][1].min(around[n][1])])
    }

    /// Along x, of what lies between two planes across y and two across z; none if nothing does.
    pub fn run(&self, y: Extent, z: Extent) -> Option<Extent> {
        match &self.curved.wall {
            Wall::Ellipsoid(_) => Some(self.extent(Axis::X)),
            Wall::Ball { radius } => {
                let off = |axis: Axis, [lo, hi]: Extent| {
                    let [lo, hi] = widened([lo - self.origin[axis], hi - self.origin[axis]]);
                    if lo > 0.0 { lo } else { hi.min(0.0) }
                };
                let (a, b) = (off(Axis::Y, y), off(Axis::Z, z));
                let square = radius * radius * (1.0 + MARGIN) - a * a - b * b;
                let reach = Real::sqrt(square.max(0.0));
                (square >= 0.0).then(|| widened([self.origin[0] - reach, self.origin[0] + reach]))
            }
            Wall::Cylinder { .. } | Wall::Cone { .. } => {
                let stretch = self.stretch([(Axis::Y, y), (Axis::Z, z)].into_iter())?;
                Some(stretch.extent(self, Axis::X))
            }
        }
    }
}
