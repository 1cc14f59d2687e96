//! Bodies of a kind known at run time are as far apart as their closed forms say.

use glam::DVec3;
use voidage_core::convex::shape::{Capsule, Cone, Cylinder, Ellipsoid, Point, Sphere};
use voidage_core::convex::{self, AnyBody, Clearance};

fn distance(a: &AnyBody<DVec3>, b: &AnyBody<DVec3>) -> f64 {
    match convex::distance(a, b) {
        Clearance::Apart { distance, lower, upper, .. } => {
            assert!(lower <= distance && distance <= upper, "{lower} {distance} {upper}");
            distance
        }
        other => panic!("not apart: {other:?}"),
    }
}

/// Each kind stands along z about the origin and reaches 0.5 along x: from a point at x = 3, and from itself moved by 3.
#[test]
fn curved_kinds_keep_their_size() {
    let bodies = [
        ("ball", AnyBody::new(Sphere { center: DVec3::ZERO, radius: 0.5 })),
        ("capsule", AnyBody::new(Capsule { from: -DVec3::Z, to: DVec3::Z, radius: 0.5 })),
        ("cylinder", AnyBody::new(Cylinder::new(-DVec3::Z, DVec3::Z, 0.5))),
        ("cone", AnyBody::new(Cone::new(DVec3::ZERO, DVec3::Z, 0.5))),
        ("ellipsoid", AnyBody::new(Ellipsoid { center: DVec3::ZERO, semi_axes: DVec3::new(0.5, 0.7, 0.9) })),
    ];
    let point = AnyBody::new(Point(DVec3::new(3.0, 0.0, 0.0))).expect("a point");
    for (name, body) in bodies {
        let body = body.expect(name);
        let moved = body.posed(DVec3::AXES, DVec3::new(3.0, 0.0, 0.0)).expect(name);
        let (to_point, to_moved) = (distance(&body, &point), distance(&body, &moved));
        assert!((to_point - 2.5).abs() < 1e-9, "{name} from a point: {to_point}");
        assert!((to_moved - 2.0).abs() < 1e-9, "{name} from itself: {to_moved}");
    }
}
