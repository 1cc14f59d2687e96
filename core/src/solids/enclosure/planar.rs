//! A body by its convex parts, as a solid: each part is its own polytope.

use super::constraint::{BoxAround, Constraint, Enclosure};
use super::union::{Enclosed, shares_of_polytopes};
use crate::grid::bounds::Bounds;
use crate::number::axis::Axis;
use crate::surface::{MOST_PLANES, PlanarPart};
use heapless::Vec;

/// Distances from a plane are rounded by this share of their terms.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

impl PlanarPart<f64> {
    /// A constraint for each plane in which the box does not lie.
    fn constraints(&self, place: &BoxAround) -> Vec<Constraint, MOST_PLANES> {
        let behind = |[normal, point]: &[[f64; 3]; 2]| {
            let from = Axis::ALL.map(|n| place.middle[n] - point[n]);
            Constraint::side_of_plane(place, normal.map(|n| -n), from, ROUNDING)
        };
        self.planes.iter().filter_map(behind).collect()
    }
}

impl Enclosed for PlanarPart<f64> {
    fn enclosures(&self, place: &BoxAround, tell: &mut impl FnMut(Enclosure)) {
        tell(Enclosure::new(self.constraints(place)));
    }

    fn is_apart(&self, other: &Self, _: &BoxAround) -> bool {
        self.body == other.body
    }

    fn share(&self, place: &BoxAround) -> Bounds<f64> {
        let constraints = self.constraints(place);
        match Enclosure::new(constraints.iter().copied()) {
            Enclosure::Open => Bounds::OPEN,
            Enclosure::Within(deciding) if deciding.is_empty() => Bounds::CLOSED,
            Enclosure::Within(_) => {
                let [lower, upper] = shares_of_polytopes([constraints.iter()].into_iter(), place);
                Bounds { lower, upper }
            }
        }
    }

    fn price(&self) -> f64 {
        1.0
    }
}
