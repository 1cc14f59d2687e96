//! The share of a box in which affine functions are not positive.
//!
//! The box is six tetrahedra, each from the lowest corner to the highest along another order of the axes. A tetrahedron is cut by one function after the other;
//! all that is asked of it are the values of the functions in its corners.

use super::constraint::Constraint;

/// Values of up to `N` functions in the corners of a tetrahedron.
type Corners<const N: usize> = [[f64; N]; 4];

/// The orders of the axes, as the bits of the two corners between the lowest and the highest.
const ORDERS: [[usize; 2]; 6] = [[1, 3], [1, 5], [2, 3], [2, 6], [4, 5], [4, 6]];

/// The share of a box in which the affine functions of some constraints, each plus the lower or upper bound of its rest, are not positive.
/// `N` constraints at most; more are ignored.
pub(super) fn filled<'c, const N: usize>(constraints: impl Iterator<Item = &'c Constraint>, upper: bool) -> f64 {
    let mut at = [[0.0; N]; 8];
    let mut count = 0;
    for (n, c) in constraints.take(N).enumerate() {
        let middle = c.middle + c.rest[usize::from(upper)];
        let [x, y, z] = c.slope;
        for (bits, values) in at.iter_mut().enumerate() {
            let sign = |bit: usize, slope: f64| if bits >> bit & 1 == 1 { slope } else { -slope };
            if let Some(value) = values.get_mut(n) {
                *value = middle + (sign(0, x) + sign(1, y) + sign(2, z));
            }
        }
        count = n + 1;
    }
    let share = |[p, q]: [usize; 2]| share_of_tetrahedron(&[at[0], at[p & 7], at[q & 7], at[7]], count);
    let sum: f64 = ORDERS.into_iter().map(share).sum();
    (sum / 6.0).clamp(0.0, 1.0)
}

/// The share of a tetrahedron in which the first `count` functions are not positive. Calls itself, once a function.
fn share_of_tetrahedron<const N: usize>(corners: &Corners<N>, count: usize) -> f64 {
    let Some(last) = count.checked_sub(1) else { return 1.0 };
    let value = |corner: &[f64; N]| corner.get(last).copied().unwrap_or(0.0);
    let mut inside = 0;
    // Those inside come first.
    let mut sorted = *corners;
    for n in 0..4 {
        if value(&corners[n]) <= 0.0 {
            sorted.swap(inside, n);
            inside += 1;
        }
    }
    let [a, b, c, d] = &sorted;
    // The way from a corner to one on the other side that lies on its own.
    let way = |from: &[f64; N], to: &[f64; N]| value(from) / (value(from) - value(to));
    let rest = |corners: [[f64; N]; 4]| share_of_tetrahedron(&corners, last);
    let cut = |from: &[f64; N], to: &[f64; N], part: f64| -> [f64; N] {
        core::array::from_fn(|n| from[n] + part * (to[n] - from[n]))
    };
    match inside {
        0 => 0.0,
        4 => rest(sorted),
        1 | 3 => {
            let (tip, others) = if inside == 1 { (a, [b, c, d]) } else { (d, [a, b, c]) };
            let ways = others.map(|other| way(tip, other));
            let share = ways[0] * ways[1] * ways[2];
            let corner = |n: usize| cut(tip, others[n], ways[n]);
            let part = if share > 0.0 { share * rest([*tip, corner(0), corner(1), corner(2)]) } else { 0.0 };
            if inside == 1 { part } else { rest(sorted) - part }
        }
        _ => {
            let ways = [way(a, c), way(a, d), way(b, c), way(b, d)];
            let [ac, ad, bc, bd] = [cut(a, c, ways[0]), cut(a, d, ways[1]), cut(b, c, ways[2]), cut(b, d, ways[3])];
            let [s, u, w, v] = ways;
            // A wedge of three tetrahedra.
            let parts = [
                (s * u, [*a, ac, ad, *b]),
                (v * s * (1.0 - u), [ac, ad, *b, bd]),
                ((1.0 - s) * w * v, [ac, *b, bc, bd]),
            ];
            parts.into_iter().filter(|(share, _)| *share > 0.0).map(|(share, corners)| share * rest(corners)).sum()
        }
    }
}
