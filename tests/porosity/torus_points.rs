//! Points of a torus or a bend, by its definition alone.

use glam::DVec3;
use std::f64::consts::TAU;
use voidage_core::solids::torus::TorusShape;

/// Unit vectors towards the start, a quarter of a turn on, and along the axis.
pub(super) fn frame(shape: &TorusShape<DVec3>) -> [DVec3; 3] {
    let a = shape.axis.normalize();
    let e = (shape.start - a * a.dot(shape.start)).normalize();
    [e, a.cross(e), a]
}

/// Is a point inside?
pub(super) fn inside(shape: &TorusShape<DVec3>, p: DVec3) -> bool {
    let [e, f, a] = frame(shape);
    let q = p - shape.center;
    let (x, y, z) = (q.dot(e), q.dot(f), q.dot(a));
    let turn = y.atan2(x).rem_euclid(TAU);
    (x.hypot(y) - shape.radius).hypot(z) <= shape.tube && (shape.angle >= 360.0 || turn <= shape.angle.to_radians())
}
