//! The parts of a box: eight of a cell, four of a face, and what a polytope's planes say of them.

use super::local_planes::{LocalPlanes, MAX_PLANES, PlaneDistances};
use super::occupancy::{ActiveFacets, Occupancy, QueryCount, WarmStart};
use super::place::{BodyScalar, Subdividable};
use crate::grid::bounds::Bounds;
use crate::number::aabb::Aabb;
use crate::number::real::{Real, Vector};

/// The axes along which a box has no thickness.
#[inline(always)]
pub(super) fn flat_axes<V: Vector>(cell: &Aabb<V>) -> [bool; 3] {
    cell.size().to_array().map(|s| s == V::Scalar::ZERO)
}

/// A part of a box: the bits of its number choose the upper halves along the axes that are not flat.
#[inline(always)]
pub(super) fn part_of<V: Vector>(cell: &Aabb<V>, flat: [bool; 3], number: usize) -> Aabb<V> {
    let mut bits = number;
    let upper = flat.map(|flat| {
        let upper = !flat && bits & 1 == 1;
        bits >>= u32::from(!flat);
        upper
    });
    // Without arrays in between: written by scalars and read as vectors at once they would stall the processor.
    let (min, max, middle) = (cell.min, cell.max, cell.center());
    let low = |axis: usize, min: V::Scalar, middle: V::Scalar| if upper[axis] { middle } else { min };
    let high = |axis: usize, max: V::Scalar, middle: V::Scalar| if upper[axis] || flat[axis] { max } else { middle };
    Aabb {
        min: V::new(low(0, min.x(), middle.x()), low(1, min.y(), middle.y()), low(2, min.z(), middle.z())),
        max: V::new(high(0, max.x(), middle.x()), high(1, max.y(), middle.y()), high(2, max.z(), middle.z())),
    }
}

/// From the middle of a box to that of a part, by axis, in units of half the size of the outermost box.
#[inline(always)]
fn shift_of<R: Real>(flat: [bool; 3], number: usize, scale: R) -> [R; 3] {
    let mut bits = number;
    flat.map(|flat| {
        if flat {
            return R::ZERO;
        }
        let upper = bits & 1 == 1;
        bits >>= 1;
        if upper { scale } else { -scale }
    })
}

/// A box that one body alone cuts, a polytope: that body, and those of its planes that cut the box.
pub(super) struct PolytopeParts<'a, B: Subdividable> {
    pub body: &'a B,
    pub near: &'a [u32],
    pub planes: LocalPlanes<BodyScalar<B>>,
    pub flat: [bool; 3],
    pub count: &'a mut QueryCount,
}

impl<B: Subdividable> PolytopeParts<'_, B> {
    /// Bounds of the solid share of `cell`, which is the box or a part of it, from its own parts; these are divided `levels - 1` times more.
    /// `scale` is the size of the parts as a share of the box's. Calls itself, once a level.
    pub fn share(
        &mut self,
        cell: &Aabb<B::Vector>,
        distances: &PlaneDistances<BodyScalar<B>>,
        levels: u32,
        scale: BodyScalar<B>,
    ) -> Bounds<BodyScalar<B>> {
        let count = 1_usize << self.flat.iter().filter(|&&flat| !flat).count();
        let mut sum: Bounds<BodyScalar<B>> = Bounds::OPEN;
        for number in 0..count {
            let (found, part) = self.planes.part(distances, shift_of(self.flat, number, scale), scale);
            let share = match found {
                Some(Occupancy::Open) => continue,
                Some(Occupancy::Closed) => Bounds::CLOSED,
                _ if levels > 1 => self.share(&part_of(cell, self.flat, number), &part, levels - 1, scale * Real::HALF),
                Some(Occupancy::Cut) => Bounds::UNKNOWN,
                None => self.ask(&part_of(cell, self.flat, number)),
            };
            sum.lower += share.lower;
            sum.upper += share.upper;
        }
        let weight = BodyScalar::<B>::ONE / Real::from_usize(count);
        Bounds { lower: sum.lower * weight, upper: sum.upper * weight }
    }

    /// The share of a smallest part that several planes cut, but perhaps not together.
    #[cold]
    fn ask(&mut self, part: &Aabb<B::Vector>) -> Bounds<BodyScalar<B>> {
        let mut memory = [0; MAX_PLANES];
        let mut warm = WarmStart::default();
        match self.body.occupancy(part, self.near, &mut ActiveFacets::new(&mut memory), &mut warm, self.count) {
            Occupancy::Open => Bounds::OPEN,
            Occupancy::Cut => Bounds::UNKNOWN,
            Occupancy::Closed => Bounds::CLOSED,
        }
    }
}
