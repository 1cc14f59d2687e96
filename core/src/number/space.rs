//! Points and vectors of space as arrays, for clipped surfaces and closed forms: their sums and products.

use crate::number::real::Real;

/// A point or vector in space.
pub(crate) type P3 = [f64; 3];

/// `a - b`.
#[inline(always)]
pub(crate) fn sub<R: Real>(a: [R; 3], b: [R; 3]) -> [R; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// The scalar product.
#[inline(always)]
pub(crate) fn dot<R: Real>(a: [R; 3], b: [R; 3]) -> R {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The vector product.
#[inline(always)]
pub(crate) fn cross<R: Real>(a: [R; 3], b: [R; 3]) -> [R; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The high and the low half of the digits of a number: T. Dekker, Numerische Mathematik 18 (1971).
#[inline(always)]
fn halves<R: Real>(x: R) -> [R; 2] {
    // 2 to half the digits of the scalar, and 1.
    let scaled = x * R::from_f64(if R::EPSILON.to_f64() > 1e-12 { 4097.0 } else { 134_217_729.0 });
    let high = scaled - (scaled - x);
    [high, x - high]
}

/// What rounding takes away from `a b`, which is `value`.
#[inline(always)]
pub(crate) fn rest_of_product<R: Real>(a: R, b: R, value: R) -> R {
    let ([ah, al], [bh, bl]) = (halves(a), halves(b));
    ((ah * bh - value) + ah * bl + al * bh) + al * bl
}

/// The vector product to the last digits, also of vectors that are all but parallel.
#[inline(never)]
pub(crate) fn sharp_cross<R: Real>(a: [R; 3], b: [R; 3]) -> [R; 3] {
    let difference = |p: usize, q: usize| {
        let (one, other) = (a[p] * b[q], a[q] * b[p]);
        (one - other) + (rest_of_product(a[p], b[q], one) - rest_of_product(a[q], b[p], other))
    };
    [difference(1, 2), difference(2, 0), difference(0, 1)]
}

/// The length, of a vector whose squares neither overflow nor underflow.
#[inline(always)]
pub(crate) fn length<R: Real>(a: [R; 3]) -> R {
    dot(a, a).sqrt()
}

/// The vector of length 1 in the same direction; none of zero, nor of a vector with an infinite component or a NaN.
pub(crate) fn unit<R: Real>(v: [R; 3]) -> Option<[R; 3]> {
    let largest = v[0].abs().max(v[1].abs()).max(v[2].abs());
    if !(largest > R::ZERO && v.iter().all(|c| c.is_finite())) {
        return None;
    }
    let scaled = v.map(|c| c / largest);
    let length = length(scaled);
    Some(scaled.map(|c| c / length))
}
