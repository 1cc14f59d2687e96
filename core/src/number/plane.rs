//! Points of planes across an axis, for the closed forms and quadratures in such planes.

/// A point or vector in a plane.
pub(crate) type P2 = [f64; 2];

/// `a - b`.
#[inline(always)]
pub(crate) fn sub(a: P2, b: P2) -> P2 {
    [a[0] - b[0], a[1] - b[1]]
}

/// The point a share of the way from one to another.
#[inline(always)]
pub(crate) fn on_way(from: P2, to: P2, part: f64) -> P2 {
    [from[0] + part * (to[0] - from[0]), from[1] + part * (to[1] - from[1])]
}

/// The vector product, positive if `b` lies to the left of `a`.
#[inline(always)]
pub(crate) fn cross(a: P2, b: P2) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// The scalar product.
#[inline(always)]
pub(crate) fn dot(a: P2, b: P2) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}
