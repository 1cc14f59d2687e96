//! Concave functions between two places, by lines above them: how large they and the means of their squares are at most.

use crate::number::plane::P2;

/// The share of the way at which two lines cross, if they do on it; lines by their values at both ends.
pub(super) fn crossing(l: P2, r: P2) -> Option<f64> {
    let (p, q) = (l[0] - r[0], l[1] - r[1]);
    (p * q < 0.0).then(|| p / (p - q))
}

/// The mean of the squares of a linear function where it is positive, by its ends.
pub(super) fn squares(p: f64, q: f64) -> f64 {
    let (low, high) = (p.min(q), p.max(q));
    if low >= 0.0 {
        (low * low + low * high + high * high) / 3.0
    } else if high <= 0.0 {
        0.0
    } else {
        high * high * (high / (high - low)) / 3.0
    }
}

/// The mean of the squares of the lower of two lines, and the greatest value of that one.
fn under(l: P2, r: P2) -> P2 {
    if let Some(at) = crossing(l, r) {
        let (first, middle, last) = (l[0].min(r[0]), l[0] + (l[1] - l[0]) * at, l[1].min(r[1]));
        return [squares(first, middle) * at + squares(middle, last) * (1.0 - at), first.max(middle).max(last)];
    }
    // Of one line only: where it is above the other it counts no more.
    let lower = if l[0] + l[1] < r[0] + r[1] { l } else { r };
    [squares(lower[0], lower[1]), lower[0].max(lower[1])]
}

/// The mean of the squares of the lowest of some lines, none higher than `most`.
pub(super) fn lowest(lines: [Option<P2>; 2], most: f64) -> f64 {
    let flat = [most; 2];
    match lines {
        [None, None] => most * most,
        [Some(l), None] | [None, Some(l)] => under(l, flat)[0],
        [Some(l), Some(r)] => match under(l, r) {
            [mean, greatest] if greatest <= most => mean,
            [mean, _] => mean.min(under(l, flat)[0]).min(under(r, flat)[0]),
        },
    }
}
