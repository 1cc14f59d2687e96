//! Points of planes across an axis, for the closed forms and quadratures in such planes.

/// A point or vector in a plane.
pub(crate) type P2 = [f64; 2];

/// The two axes after one, so that all three turn to the right.
#[inline(always)]
pub(crate) const fn others(axis: usize) -> [usize; 2] {
    [[1, 2], [2, 0], [0, 1]][axis]
}

/// `a - b`.
#[inline(always)]
pub(crate) fn sub(a: P2, b: P2) -> P2 {
    [a[0] - b[0], a[1] - b[1]]
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
