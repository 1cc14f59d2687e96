//! What lies behind a few planes, as a solid: it is its own polytope.

use super::constraint::{BoxAround, Constraint, Enclosure};
use super::union::{Enclosed, share_of};
use crate::grid::bounds::Bounds;
use crate::number::axis::Axis;
use crate::surface::PlanarPart;

/// Distances from a plane are rounded by this share of their terms.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

impl Enclosed for PlanarPart<f64> {
    fn enclosures(&self, place: &BoxAround, tell: &mut impl FnMut(Enclosure)) {
        let behind = |[normal, point]: &[[f64; 3]; 2]| {
            let from = Axis::ALL.map(|n| place.middle[n] - point[n]);
            Constraint::side_of_plane(place, normal.map(|n| -n), from, ROUNDING)
        };
        tell(Enclosure::new(self.planes.iter().filter_map(behind)));
    }

    fn share(&self, place: &BoxAround) -> Bounds<f64> {
        share_of(self, place, f64::INFINITY, &mut 0).map_or(Bounds::CLOSED, |[lower, upper]| Bounds { lower, upper })
    }

    fn price(&self) -> f64 {
        1.0
    }
}
