//! The shapes of [`crate::convex::shape`] as solids by formula.

use super::solid::QuadricSolid;
use crate::convex::shape::{Capsule, Cone, Cylinder, Ellipsoid, Sphere};
use crate::convex::support::{Support, Transformed};
use crate::number::real::Vector;

/// A shape that has a formula.
pub trait AsQuadric {
    /// The solid; none if a length leaves the range in which it can be computed, or nothing of it is solid.
    fn quadric(&self) -> Option<QuadricSolid>;
}

impl<V: Vector> AsQuadric for Sphere<V> {
    fn quadric(&self) -> Option<QuadricSolid> {
        QuadricSolid::ball(self.center, self.radius)
    }
}

impl<V: Vector> AsQuadric for Capsule<V> {
    fn quadric(&self) -> Option<QuadricSolid> {
        QuadricSolid::capsule(self.from, self.to, self.radius)
    }
}

impl<V: Vector> AsQuadric for Cylinder<V> {
    fn quadric(&self) -> Option<QuadricSolid> {
        QuadricSolid::cylinder(self.0.base, self.0.top, self.0.radius)
    }
}

impl<V: Vector> AsQuadric for Cone<V> {
    fn quadric(&self) -> Option<QuadricSolid> {
        let [base, top] = self.ends();
        QuadricSolid::truncated_cone(base, top, [self.base_radius(), self.top_radius()])
    }
}

impl<V: Vector> AsQuadric for Ellipsoid<V> {
    fn quadric(&self) -> Option<QuadricSolid> {
        let [a, b, c] = self.semi_axes.to_array();
        let zero = V::ZERO.x();
        QuadricSolid::ellipsoid(self.center, [V::new(a, zero, zero), V::new(zero, b, zero), V::new(zero, zero, c)])
    }
}

impl<V: Vector> AsQuadric for Transformed<Ellipsoid<V>> {
    fn quadric(&self) -> Option<QuadricSolid> {
        let [a, b, c] = self.shape.semi_axes.to_array();
        let [x, y, z] = self.columns;
        QuadricSolid::ellipsoid(self.center(), [x * a, y * b, z * c])
    }
}
