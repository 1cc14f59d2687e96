//! Truths of boxes along the axes: products of overlaps, and counted voxels.

use crate::command::stress::kit::random::Random;
use crate::command::stress::kit::truth::open_fractions;
use crate::command::triangulated::{Corners, cuboid};
use crate::grid::Edges;
use crate::porosity::FieldSet;
use glam::DVec3;

/// Solid share of a box, flat along any axes, by boxes that share no inner point. A face in the plane of a side is blocked by it.
#[must_use]
pub fn share_of_disjoint(boxes: &[[DVec3; 2]], [low, high]: [DVec3; 2]) -> f64 {
    let along = |[from, to]: &[DVec3; 2], axis: usize| match high[axis] > low[axis] {
        true => (to[axis].min(high[axis]) - from[axis].max(low[axis])).max(0.0) / (high[axis] - low[axis]),
        false => f64::from(u8::from(from[axis] <= low[axis] && low[axis] <= to[axis])),
    };
    boxes.iter().map(|b| along(b, 0) * along(b, 1) * along(b, 2)).sum()
}

/// A union of boxes with whole corners within 0..=`side`, as voxels.
#[derive(Debug, Clone)]
pub struct VoxelUnion {
    side: usize,
    boxes: Vec<[[usize; 3]; 2]>,
    solid: Vec<bool>,
}

impl VoxelUnion {
    /// From boxes.
    #[must_use]
    pub fn new(side: usize, boxes: Vec<[[usize; 3]; 2]>) -> Self {
        let mut solid = vec![false; side * side * side];
        for [lo, hi] in &boxes {
            for z in lo[2]..hi[2] {
                for y in lo[1]..hi[1] {
                    let row = (z * side + y) * side;
                    solid[row + lo[0]..row + hi[0]].fill(true);
                }
            }
        }
        VoxelUnion { side, boxes, solid }
    }

    /// Boxes of up to `most` voxels along each axis; half of their corners fall on every fourth plane, so that many faces coincide.
    #[must_use]
    pub fn random(random: &mut Random, side: usize, count: usize, most: usize) -> Self {
        let mut one = || {
            let mut lo = [0; 3];
            let mut hi = [0; 3];
            for axis in 0..3 {
                let step = if random.below(2) == 0 { 4.min(most) } else { 1 };
                let length = step * (1 + random.below(most / step));
                lo[axis] = step * random.below((side - length) / step + 1);
                hi[axis] = lo[axis] + length;
            }
            [lo, hi]
        };
        Self::new(side, (0..count).map(|_| one()).collect())
    }

    /// The boxes as solids, voxels of a size, the first at an origin.
    #[must_use]
    pub fn solids(&self, origin: DVec3, size: f64) -> Vec<Vec<Corners>> {
        let point = |p: &[usize; 3]| origin + DVec3::from_array(p.map(|c| c as f64 * size));
        self.boxes.iter().map(|[lo, hi]| cuboid(point(lo), point(hi))).collect()
    }

    /// Edges at whole voxels in the same place.
    #[must_use]
    pub fn edges(planes: &[Vec<usize>; 3], origin: DVec3, size: f64) -> Edges {
        Edges([0, 1, 2].map(|axis| planes[axis].iter().map(|&c| origin[axis] + c as f64 * size).collect()))
    }

    /// Open fractions of the grid with edges at these voxels. A face is blocked where either side is solid.
    #[must_use]
    pub fn truth(&self, planes: &[Vec<usize>; 3]) -> FieldSet {
        let edges = Self::edges(planes, DVec3::ZERO, 1.0);
        open_fractions(&edges, |corners| {
            let [lo, hi] = corners.map(|p| p.to_array().map(|c| c as usize));
            let flat = (0..3).find(|&axis| lo[axis] == hi[axis]);
            let (mut solid, mut all) = (0usize, 0usize);
            let span = |axis: usize| lo[axis]..hi[axis].max(lo[axis] + 1);
            for z in span(2) {
                for y in span(1) {
                    for x in span(0) {
                        let below = flat.is_some_and(|axis| self.below([x, y, z], axis));
                        solid += usize::from(below || self.at([x, y, z]));
                        all += 1;
                    }
                }
            }
            solid as f64 / all as f64
        })
    }

    fn at(&self, [x, y, z]: [usize; 3]) -> bool {
        x < self.side && y < self.side && z < self.side && self.solid[(z * self.side + y) * self.side + x]
    }

    fn below(&self, mut at: [usize; 3], axis: usize) -> bool {
        match at[axis].checked_sub(1) {
            Some(one_less) => {
                at[axis] = one_less;
                self.at(at)
            }
            None => false,
        }
    }
}
