//! From where to where a body extends in its cell, along some fixed directions: a discrete oriented polytope around it. J. T. Klosowski et al., *Efficient
//! Collision Detection Using Bounding Volume Hierarchies of k-DOPs*, IEEE Transactions on Visualization and Computer Graphics 4, 1998.

use crate::number::real::Real;

/// The axes and the diagonals of the planes between them.
const DIRECTIONS: usize = 9;

/// The lowest and the highest place along each direction; of nothing by default.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent<R> {
    along: [[R; 2]; DIRECTIONS],
}

impl<R: Real> Default for Extent<R> {
    fn default() -> Self {
        Extent { along: [[R::INFINITY, -R::INFINITY]; DIRECTIONS] }
    }
}

impl<R: Real> Extent<R> {
    /// Extend it to a point.
    #[inline(always)]
    pub fn see(&mut self, [x, y, z]: [R; 3]) {
        let places = [x, y, z, x + y, x - y, y + z, y - z, z + x, z - x];
        for ([low, high], place) in self.along.iter_mut().zip(places) {
            *low = place.smaller(*low);
            *high = place.larger(*high);
        }
    }

    /// Does another one begin more than `clear` beyond this one along a direction, or end before it?
    pub fn is_apart(&self, other: &Self, clear: R) -> bool {
        self.along.iter().zip(&other.along).any(|(a, b)| a[0] > b[1] + clear || b[0] > a[1] + clear)
    }
}
