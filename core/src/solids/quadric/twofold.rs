//! Differences and products with their rounding errors: what remains of a distance that nearly cancels.
//!
//! References: O. Møller, BIT 5 (1965) and D. Knuth, TAOCP 2, for sums.

use crate::number::space::rest_of_product;

/// A number as a rounded value and what the rounding took away.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Twofold {
    pub value: f64,
    pub rest: f64,
}

/// `a - b`, exactly.
#[inline(always)]
pub(super) fn difference(a: f64, b: f64) -> Twofold {
    let value = a - b;
    let part = value - a;
    Twofold { value, rest: (a - (value - part)) - (b + part) }
}

/// `a · b`, exactly but for overflow and underflow.
#[inline(always)]
pub(super) fn product(a: f64, b: f64) -> Twofold {
    let value = a * b;
    Twofold { value, rest: rest_of_product(a, b, value) }
}

/// `a0 b0 + a1 b1`, to about twice the digits.
#[inline(always)]
pub(super) fn dot(a: [f64; 2], b: [Twofold; 2]) -> Twofold {
    let (p, q) = (product(a[0], b[0].value), product(a[1], b[1].value));
    let sum = difference(p.value, -q.value);
    Twofold { value: sum.value, rest: sum.rest + (p.rest + q.rest + a[0] * b[0].rest + a[1] * b[1].rest) }
}

/// `r² - d²` to the last digits, however near `d` is to `r`; `r` is not negative.
#[inline(always)]
pub(super) fn difference_of_squares(r: f64, d: Twofold) -> f64 {
    let (value, rest) = if d.value < 0.0 { (-d.value, -d.rest) } else { (d.value, d.rest) };
    ((r - value) - rest) * ((r + value) + rest)
}
