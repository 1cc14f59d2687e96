//! Convex solids of round kinds: as GJK sees them, and in closed form.

use crate::porosity::convex::Convex;
use glam::DVec3;
use voidage_core::convex::support::{Support, SupportPoint};
use voidage_core::solids::quadric::{AsQuadric, QuadricSolid};

/// A convex body of a round kind, as a support mapping.
#[derive(Clone, Copy)]
pub(super) struct Round<'a>(pub &'a Convex<'static>);

/// The same expression for each round kind; another for bodies of facets.
macro_rules! of_round {
    ($body:expr, $shape:ident => $value:expr, $other:expr) => {
        match $body {
            Convex::Sphere($shape) => $value,
            Convex::Ellipsoid($shape) => $value,
            Convex::Cylinder($shape) => $value,
            Convex::Capsule($shape) => $value,
            Convex::Cone($shape) => $value,
            Convex::Polytope(_) | Convex::Mesh(_) => $other,
        }
    };
}

impl Support for Round<'_> {
    type Vector = DVec3;
    const ROUNDED: bool = true;
    fn support(&self, direction: DVec3, start: u32) -> SupportPoint<DVec3> {
        of_round!(self.0, s => s.support(direction, start), SupportPoint { point: DVec3::NAN, index: 0 })
    }
    fn center(&self) -> DVec3 {
        of_round!(self.0, s => Support::center(s), DVec3::NAN)
    }
    fn extent(&self) -> f64 {
        of_round!(self.0, s => s.extent(), f64::INFINITY)
    }
    fn radius(&self) -> f64 {
        of_round!(self.0, s => Support::radius(s), 0.0)
    }
    fn slack(&self) -> f64 {
        of_round!(self.0, s => s.slack(), f64::INFINITY)
    }
}

/// The closed form of a body, if it has one.
#[must_use]
pub(super) fn closed_form(body: &Convex<'static>) -> Option<QuadricSolid> {
    of_round!(body, s => s.quadric(), None)
}
