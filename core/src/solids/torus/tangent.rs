//! A torus in a box, between planes.
//!
//! Inside g = ρ² − 2 R ρ + z² + R² − r² is not positive, ρ being the distance from the axis. From the middle of a box by `d`, with components along ρ, along the
//! ring and along the axis, g changes by its gradient times d, plus |d|², less 2 R times what ρ grows by more than its gradient tells: for q the vector from
//! the axis that is |q + d| − |q| − q·d/|q| = d_ring² / (|q + d| + |q| + d_ρ).

use super::ring::{Ring, length2};
use super::solid::TorusSolid;
use crate::grid::bounds::Bounds;
use crate::grid::cell_range::RangeKind;
use crate::number::axis::Axis;
use crate::number::space::{P3, dot};
use crate::solids::enclosure::{BoxAround, Constraint, Enclosed, Enclosure};

/// Rounding of the sums below, a few units in the last place of their terms.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

impl Enclosed for TorusSolid {
    /// Of more than half a turn two parts.
    fn enclosures(&self, place: &BoxAround, tell: &mut impl FnMut(Enclosure)) {
        let ring = self.ring();
        let from = Axis::ALL.map(|n| place.middle[n] - ring.center[n]);
        let curved = ring.curved_constraint(place, from);
        let mut between = |normals: &[P3]| {
            let ends = normals.iter().filter_map(|normal| Constraint::side_of_plane(place, *normal, from, ROUNDING));
            tell(Enclosure::new([curved].into_iter().chain(ends)));
        };
        match &ring.ends {
            None => between(&[]),
            Some(ends) if !ends.wide => between(&ends.inward),
            Some(ends) => {
                let ([x, y], [start, end]) = (ends.middle, ends.inward);
                let [e, f, _] = ring.frame;
                let onward = Axis::ALL.map(|n| x * f[n] - y * e[n]);
                between(&[start, onward.map(|a| -a)]);
                between(&[onward, end]);
            }
        }
    }

    /// By quadrature.
    fn share(&self, place: &BoxAround) -> Bounds<f64> {
        let sides = place.sides();
        let flat = sides.iter().position(|[lo, hi]| lo == hi);
        let kind = flat.map_or(RangeKind::Cells, RangeKind::Faces);
        let [lo, hi] = [0, 1].map(|end| sides.map(|side| side[end]));
        let (share, error) = TorusSolid::share(self, kind, lo, hi);
        Bounds::around(share, error)
    }

    fn price(&self) -> f64 {
        500.0
    }
}

impl Ring {
    /// The surface of the whole torus; `from` leads from its centre to the middle of the box.
    fn curved_constraint(&self, place: &BoxAround, from: P3) -> Constraint {
        let [x, y, z] = self.local(from);
        let rho = length2([x, y]);
        let out = if rho > 0.0 { [x / rho, y / rho] } else { [1.0, 0.0] };
        let [e, f, axis] = self.frame;
        let (radial, around) =
            (Axis::ALL.map(|n| out[0] * e[n] + out[1] * f[n]), Axis::ALL.map(|n| out[0] * f[n] - out[1] * e[n]));
        let half = place.half;
        let reach =
            |direction: P3| direction[0].abs() * half[0] + direction[1].abs() * half[1] + direction[2].abs() * half[2];
        let (radius, tube) = (self.radius, self.tube);
        let slope = Axis::ALL.map(|n| 2.0 * ((rho - radius) * radial[n] + z * axis[n]) * half[n]);
        let middle = (rho - radius) * (rho - radius) + (z - tube) * (z + tube);
        let (aside, outward) = (reach(around), reach(radial));
        // d_ring² times 1 − 2 R / (|q + d| + |q| + d_ρ); near the axis no more is known than that ρ grows no faster than the place moves.
        let square = dot(half, half);
        let beside_ring = square.min(outward * outward + reach(axis) * reach(axis));
        let nearest = rho - outward;
        let bent = if nearest > 0.0 { (radius / nearest - 1.0).max(0.0) * aside * aside } else { f64::INFINITY };
        let least = bent.min(4.0 * radius * (aside + outward));
        let most =
            square.min(beside_ring + (1.0 - 2.0 * radius / (2.0 * (rho + outward) + aside)).max(0.0) * aside * aside);
        let terms = (rho + radius) * (rho + radius) + z * z + tube * tube;
        let shifted = 2.0 * (rho + radius + z.abs()) * place.rounding();
        let rounding = ROUNDING * (terms + square) + shifted;
        Constraint { middle, slope, rest: [-least - rounding, most + rounding] }
    }
}
