//! The directions along which most of a surface lies.

use crate::geometry::repair::face::bounds;
use glam::{DMat3, DVec3};
use rustc_hash::FxHashMap as HashMap;

/// Normals are alike if each component, in so many steps to 1, is.
const STEPS: f64 = 256.0;

/// Directions this near to a right angle, as the cosine, are across each other.
const ACROSS: f64 = 0.02;

/// A frame is taken if the boxes along it have at most this share of the surface of those along the axes.
const SMALLER: f64 = 0.5;

/// Axes that are not those of space, and where they begin.
#[derive(Debug, Clone, Copy)]
pub struct Turned {
    to_frame: DMat3,
    origin: DVec3,
}

impl Turned {
    /// The one normal to which most of the surface of some triangles has, and that across it which then most has; none if boxes around the
    /// triangles along the axes are about as small.
    #[must_use]
    pub fn of(triangles: &[[DVec3; 3]]) -> Option<Self> {
        let mut areas: HashMap<[i32; 3], DVec3> = HashMap::default();
        for [a, b, c] in triangles {
            let normal = (*b - *a).cross(*c - *a);
            // Both sides of a wall count as one.
            let normal = if normal[normal.abs().max_position()] < 0.0 { -normal } else { normal };
            let steps = (normal.normalize_or_zero() * STEPS).round();
            *areas.entry(steps.to_array().map(|s| s as i32)).or_default() += normal;
        }
        let mut areas: Vec<([i32; 3], DVec3)> = areas.into_iter().collect();
        areas.sort_unstable_by(|a, b| b.1.length_squared().total_cmp(&a.1.length_squared()).then(a.0.cmp(&b.0)));
        let mut directions = areas.iter().filter_map(|(_, normal)| normal.try_normalize());
        let first = directions.next()?;
        let second = directions.find(|d| d.dot(first).abs() < ACROSS).unwrap_or_else(|| first.any_orthonormal_vector());
        let third = first.cross(second).normalize_or_zero();
        let axes = DMat3::from_cols(first, third.cross(first), third);
        let frame = Turned { to_frame: axes.transpose(), origin: triangles.first()?[0] };
        let surface = |place: &dyn Fn(DVec3) -> DVec3| -> f64 {
            let of_box = |t: &[DVec3; 3]| {
                let [lo, hi] = bounds(&t.map(place));
                let size = hi - lo;
                size.dot(DVec3::new(size.y, size.z, size.x))
            };
            triangles.iter().map(of_box).sum()
        };
        (surface(&|p| frame.point(p)) < SMALLER * surface(&|p| p)).then_some(frame)
    }

    /// A point in its axes.
    #[must_use]
    pub fn point(&self, p: DVec3) -> DVec3 {
        self.to_frame * (p - self.origin)
    }

    /// A direction in its axes.
    #[must_use]
    pub fn direction(&self, d: DVec3) -> DVec3 {
        self.to_frame * d
    }

    /// The box along its axes around one along those of space.
    #[must_use]
    pub fn around(&self, [lo, hi]: [DVec3; 2]) -> [DVec3; 2] {
        let (middle, half) = (self.point((lo + hi) * 0.5), (hi - lo) * 0.5);
        let reach = self.to_frame.x_axis.abs() * half.x
            + self.to_frame.y_axis.abs() * half.y
            + self.to_frame.z_axis.abs() * half.z;
        [middle - reach, middle + reach]
    }
}
