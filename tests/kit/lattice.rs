//! The oracle for boxes whose corners lie on a lattice: count voxels.

use crate::random::Random;
use crate::solids::{Triangle, cuboid};
use glam::DVec3;

/// Side of the lattice, in voxels.
pub const SIDE: usize = 16;

/// A union of boxes with integer corners in 0..=[`SIDE`].
#[derive(Debug, Clone)]
pub struct Lattice {
    /// Lowest and highest corners.
    pub boxes: Vec<[[usize; 3]; 2]>,
    solid: Vec<bool>,
}

impl Lattice {
    /// From boxes.
    #[must_use]
    pub fn new(boxes: Vec<[[usize; 3]; 2]>) -> Self {
        let inside = |p: [usize; 3]| boxes.iter().any(|[lo, hi]| (0..3).all(|a| lo[a] <= p[a] && p[a] < hi[a]));
        let solid = (0..SIDE * SIDE * SIDE).map(|n| inside([n % SIDE, n / SIDE % SIDE, n / SIDE / SIDE])).collect();
        Lattice { boxes, solid }
    }

    /// Some random boxes; corners fall on a coarse sublattice half of the time, so that many faces coincide.
    #[must_use]
    pub fn random(rng: &mut Random, count: usize) -> Self {
        let mut corner = |lo: usize| {
            let step = if rng.below(2) == 0 { 4 } else { 1 };
            let room = (SIDE - lo) / step;
            lo + step * rng.below(room.max(1))
        };
        let mut boxes = Vec::new();
        while boxes.len() < count {
            let [a, b] = [[corner(0), corner(0), corner(0)], [corner(1), corner(1), corner(1)]];
            let (lo, hi) = ([0, 1, 2].map(|i: usize| a[i].min(b[i])), [0, 1, 2].map(|i: usize| a[i].max(b[i])));
            if (0..3).all(|i| lo[i] < hi[i]) {
                boxes.push([lo, hi]);
            }
        }
        Self::new(boxes)
    }

    /// The boxes as solids.
    #[must_use]
    pub fn solids(&self) -> Vec<Vec<Triangle>> {
        let point = |p: [usize; 3]| DVec3::from_array(p.map(|c| c as f64));
        self.boxes.iter().map(|[lo, hi]| cuboid(point(*lo), point(*hi))).collect()
    }

    fn at(&self, p: [isize; 3]) -> bool {
        p.iter().all(|&c| c >= 0 && c < SIDE as isize)
            && self.solid[(p[2] as usize * SIDE + p[1] as usize) * SIDE + p[0] as usize]
    }

    /// Solid fraction of the voxels `lo..hi`.
    #[must_use]
    pub fn cell(&self, lo: [usize; 3], hi: [usize; 3]) -> f64 {
        let mut count = 0;
        for_each(lo, hi, |p| count += usize::from(self.at(p)));
        count as f64 / (0..3).map(|a| hi[a] - lo[a]).product::<usize>() as f64
    }

    /// Closed fraction of a face normal to `axis`, whose `lo` and `hi` agree along it: closed where either side is solid.
    #[must_use]
    pub fn face(&self, axis: usize, lo: [usize; 3], hi: [usize; 3]) -> f64 {
        let mut top = hi;
        top[axis] += 1;
        let (mut count, mut area) = (0, 0);
        for_each(lo, top, |p| {
            let mut below = p;
            below[axis] -= 1;
            count += usize::from(self.at(p) || self.at(below));
            area += 1;
        });
        count as f64 / area as f64
    }
}

fn for_each(lo: [usize; 3], hi: [usize; 3], mut visit: impl FnMut([isize; 3])) {
    for z in lo[2]..hi[2] {
        for y in lo[1]..hi[1] {
            for x in lo[0]..hi[0] {
                visit([x as isize, y as isize, z as isize]);
            }
        }
    }
}
