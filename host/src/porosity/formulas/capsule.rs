//! Capsules around round solids: most pairs whose boxes overlap are told apart by them.

use crate::porosity::convex::Convex;
use glam::DVec3;

/// Solids are apart only if they are so by this share of their coordinates and radii.
const MARGIN: f64 = 1e-12;

/// A segment with a radius, which holds a solid.
#[derive(Clone, Copy)]
struct Capsule {
    ends: [DVec3; 2],
    radius: f64,
}

impl Capsule {
    /// Around a solid along an axis.
    fn around(solid: &Convex) -> Option<Self> {
        let (ends, radius) = match solid {
            Convex::Sphere(s) => ([s.center; 2], s.radius),
            Convex::Capsule(s) => ([s.from, s.to], s.radius),
            Convex::Cylinder(s) => (s.ends(), s.base_radius()),
            Convex::Cone(s) => (s.ends(), s.base_radius().max(s.top_radius())),
            Convex::Ellipsoid(_) | Convex::Polytope(_) | Convex::Mesh(_) => return None,
        };
        Some(Capsule { ends, radius })
    }

    /// The largest coordinate, and the radius.
    fn size(&self) -> f64 {
        self.ends[0].abs().max(self.ends[1].abs()).max_element() + self.radius
    }
}

/// The way between the points of two segments that are nearest to each other, but for rounding.
fn shortest_way([a, b]: [DVec3; 2], [c, d]: [DVec3; 2]) -> DVec3 {
    let (one, other, between) = (b - a, d - c, a - c);
    let (square, other_square, both) = (one.length_squared(), other.length_squared(), one.dot(other));
    let (along, other_along) = (one.dot(between), other.dot(between));
    let share = |part: f64, of: f64| if of > 0.0 { (part / of).clamp(0.0, 1.0) } else { 0.0 };
    let s = share(both * other_along - along * other_square, square * other_square - both * both);
    let t = share(both * s + other_along, other_square);
    // The nearest point of the first segment to that of the second one.
    let s = share(both * t - along, square);
    between + one * s - other * t
}

/// Is it certain that two solids are apart, by a plane between capsules around them? None of solids without an axis.
pub(super) fn are_apart(a: &Convex, b: &Convex) -> bool {
    let (Some(a), Some(b)) = (Capsule::around(a), Capsule::around(b)) else { return false };
    let way = shortest_way(a.ends, b.ends);
    let reach = |capsule: &Capsule| capsule.ends.map(|end| way.dot(end));
    let ([p, q], [r, s]) = (reach(&a), reach(&b));
    // Of the plane across the way all that counts is that it lies between the ends: rounding of its direction does not.
    p.min(q) - r.max(s) > way.length() * (a.radius + b.radius + MARGIN * (a.size() + b.size()))
}

#[cfg(test)]
mod tests {
    use super::{Convex, are_apart};
    use glam::DVec3;
    use voidage_core::convex::shape::{Cylinder, Sphere};

    fn pipe(from: [f64; 3], to: [f64; 3], radius: f64) -> Convex<'static> {
        Convex::Cylinder(Cylinder::new(from.into(), to.into(), radius))
    }

    #[test]
    fn pipes_are_apart_as_far_as_their_axes_are() {
        let one = pipe([-2.0, 0.0, 0.0], [2.0, 0.0, 0.0], 0.25);
        for (height, apart) in [(0.5, false), (0.51, true), (-0.51, true), (0.0, false)] {
            let crossing = pipe([0.0, -1.0, height], [0.5, 1.0, height], 0.25);
            assert_eq!(are_apart(&one, &crossing), apart, "{height}");
            assert_eq!(are_apart(&crossing, &one), apart, "{height}");
        }
    }

    #[test]
    fn pipes_beside_and_behind_each_other() {
        let one = pipe([0.0; 3], [2.0, 0.0, 0.0], 0.25);
        assert!(are_apart(&one, &pipe([1.0, 0.6, 0.0], [3.0, 0.6, 0.0], 0.25)));
        assert!(!are_apart(&one, &pipe([1.0, 0.4, 0.0], [3.0, 0.4, 0.0], 0.25)));
        assert!(are_apart(&one, &pipe([3.0, 0.0, 0.0], [4.0, 0.0, 0.0], 0.25)));
        assert!(!are_apart(&one, &one));
    }

    #[test]
    fn balls_and_what_is_no_number() {
        let ball = |x: f64| Convex::Sphere(Sphere { center: DVec3::new(x, 0.0, 0.0), radius: 1.0 });
        assert!(are_apart(&ball(0.0), &ball(2.1)) && !are_apart(&ball(0.0), &ball(1.9)));
        assert!(!are_apart(&ball(0.0), &ball(f64::NAN)));
    }
}
