//! The facets of a polytope near a box, as numbers relative to the box: where a part of the box lies is then a few additions.

use super::occupancy::Occupancy;
use crate::number::real::Real;

/// Most planes that [`LocalPlanes`] holds: a bit of a byte for each.
pub const MAX_PLANES: usize = 8;

/// The planes of the facets that cut a box. Lengths are those of the space.
#[derive(Clone, Copy, Debug)]
pub struct LocalPlanes<R> {
    /// Of each plane: its normal times half the box's size, by axis, with the normal's signs.
    pub(super) reach: [[R; 3]; MAX_PLANES],
    /// Of each plane: the sum of `reach` without signs, how far a corner of the box is from the parallel plane through its middle.
    pub(super) whole: [R; MAX_PLANES],
    /// Bound of the rounding of a distance from a plane.
    pub(super) margin: R,
    /// The distances of the middle of the box itself.
    pub(super) distances: PlaneDistances<R>,
}

/// The signed distances of the middle of a box, or of a part of it, from the planes of [`LocalPlanes`].
#[derive(Clone, Copy, Debug)]
pub struct PlaneDistances<R> {
    /// Of each plane that cuts: positive beyond it. Others hold what they held before.
    pub(super) middle: [R; MAX_PLANES],
    /// Bit `n` is set if plane `n` cuts the part.
    pub(super) cut: u8,
}

impl<R: Real> LocalPlanes<R> {
    /// Occupancy of a part of the box, and the distances of its middle from the planes. The part is `scale` times as large as the box; its middle lies `shift` times the
    /// half size of the box away from that of its parent, by axis. None if two planes or more cut the part, and it is not
    /// known whether any point of it lies behind all of them.
    #[inline(always)]
    pub fn part(&self, parent: &PlaneDistances<R>, shift: [R; 3], scale: R) -> (Option<Occupancy>, PlaneDistances<R>) {
        let mut part = PlaneDistances { middle: parent.middle, cut: 0 };
        for n in (0..MAX_PLANES).filter(|n| parent.cut >> n & 1 == 1) {
            let [x, y, z] = self.reach[n];
            let middle = parent.middle[n] + (x * shift[0] + y * shift[1] + z * shift[2]);
            let reach = self.whole[n] * scale;
            if middle - reach >= self.margin {
                return (Some(Occupancy::Open), part);
            }
            if !(middle + reach <= -self.margin) {
                part.cut |= 1 << n;
                part.middle[n] = middle;
            }
        }
        let found = match part.cut.count_ones() {
            0 => Some(Occupancy::Closed),
            1 => Some(Occupancy::Cut),
            _ => self.share_an_inner_point(&part, scale).then_some(Occupancy::Cut),
        };
        (found, part)
    }

    /// One corner of the part, that which lies farthest inward of the sum of the planes that cut, is inside all of them. Then part and body
    /// share inner points. False tells nothing.
    #[inline(always)]
    fn share_an_inner_point(&self, part: &PlaneDistances<R>, scale: R) -> bool {
        let cutting = || (0..MAX_PLANES).filter(|n| part.cut >> n & 1 == 1);
        let sum = cutting().fold([R::ZERO; 3], |[sx, sy, sz], n| {
            let [x, y, z] = self.reach[n];
            [sx + x, sy + y, sz + z]
        });
        let inward = sum.map(|s| -scale.copysign(s));
        cutting().all(|n| {
            let [x, y, z] = self.reach[n];
            part.middle[n] + (x * inward[0] + y * inward[1] + z * inward[2]) < -self.margin
        })
    }
}
