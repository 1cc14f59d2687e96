//! What two solids that touch may have in common: it lies between two parallel planes.

use glam::DVec3;
use voidage_core::convex::support::Support;
use voidage_core::solids::enclosure::BoxAround;

/// All points that are no farther from a plane than `half`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Slab {
    /// A unit vector across the plane.
    pub normal: DVec3,
    /// A point of the plane.
    pub point: DVec3,
    /// Half of the thickness; below 0 there is nothing in it.
    pub half: f64,
}

/// Of what is left out this share of the tolerance is told in the bounds; what may be more is found out.
pub(super) const TOLD: f64 = 1.0 / 8.0;

/// Thinner slabs are as coordinates and supports are rounded, in ε of the extents.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

impl Slab {
    /// The thinnest of those across some directions that hold what two convex bodies have in common; none if that is nothing but rounding.
    pub fn between(
        a: &impl Support<Vector = DVec3>,
        b: &impl Support<Vector = DVec3>,
        normals: impl Iterator<Item = DVec3>,
    ) -> Option<Self> {
        let rounding = ROUNDING * (a.extent() + b.extent());
        let across = |normal: DVec3| {
            let top = a.farthest(normal).point.dot(normal) + a.radius();
            let bottom = b.farthest(-normal).point.dot(normal) - b.radius();
            let half = 0.5 * (top - bottom);
            Slab { normal, point: normal * (bottom + half), half }
        };
        let both_ways = normals.filter_map(DVec3::try_normalize).flat_map(|normal| [normal, -normal]);
        let thinnest = both_ways.map(across).min_by(|a, b| a.half.total_cmp(&b.half))?;
        (thinnest.half > rounding).then_some(Slab { half: thinnest.half + rounding, ..thinnest })
    }

    /// No less than the share of a cell or face that lies in it.
    pub fn share(&self, place: &BoxAround) -> f64 {
        let normal = self.normal.to_array();
        let middle: f64 = (0..3).map(|n| normal[n] * (place.middle[n] - self.point[n])).sum();
        let slopes = [0, 1, 2].map(|n| (normal[n] * place.half[n]).abs());
        let steepest = slopes.iter().fold(0.0_f64, |most, s| most.max(*s));
        if self.half < 0.0 || middle.abs() > slopes.iter().sum::<f64>() + self.half {
            return 0.0;
        }
        if steepest > self.half { self.half / steepest } else { 1.0 }
    }
}
