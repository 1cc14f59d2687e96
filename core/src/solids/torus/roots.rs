//! Roots of functions of one variable, always between two points where the signs differ.
//!
//! Reference: T. Chandrupatla, Advances in Engineering Software 28 (1997).

/// More steps than any function here needs.
const MOST_STEPS: usize = 120;

/// Newton's method is given up after so many steps: few functions need more than six.
const NEWTON_STEPS: usize = 10;

/// The only root between `a` and `b`, where a function, told with its derivative, has the values `fa` and `fb` of different signs: by Newton's method from
/// the secant, as long as it stays between points where the signs differ.
#[inline(always)]
pub(super) fn newton_root(f: impl Fn(f64) -> [f64; 2], [mut a, mut b]: [f64; 2], [mut fa, mut fb]: [f64; 2]) -> f64 {
    let mut x = a + (b - a) * (fa / (fa - fb));
    // The last step of Newton's method, none yet.
    let mut before = 0.0;
    for _ in 0..NEWTON_STEPS {
        let [value, rate] = f(x);
        if value == 0.0 {
            return x;
        }
        if (value > 0.0) == (fa > 0.0) {
            (a, fa) = (x, value);
        } else {
            (b, fb) = (x, value);
        }
        let step = -value / rate;
        let next = x + step;
        if !(next >= a && next <= b) {
            (x, before) = ((a + b) * 0.5, 0.0);
            continue;
        }
        let ratio = step / before;
        // Steps shrink with the square of the last: the one after this would be smaller by the square of this ratio.
        if (step * ratio * ratio).abs() <= f64::EPSILON * next.abs() + f64::MIN_POSITIVE {
            return next;
        }
        (x, before) = (next, step);
    }
    root(|x| f(x)[0], [a, b], [fa, fb])
}

/// A root between `a` and `b`, where the function has the values `fa` and `fb` of different signs.
pub(super) fn root(f: impl Fn(f64) -> f64, [a, b]: [f64; 2], [fa, fb]: [f64; 2]) -> f64 {
    let (mut a, mut fa, mut b, mut fb) = (b, fb, a, fa);
    let (mut c, mut fc);
    let mut t = 0.5;
    for _ in 0..MOST_STEPS {
        let next = a + t * (b - a);
        let value = f(next);
        if (value > 0.0) == (fa > 0.0) {
            (c, fc) = (a, fa);
        } else {
            (c, fc, b, fb) = (b, fb, a, fa);
        }
        (a, fa) = (next, value);
        let (best, least) = if fa.abs() < fb.abs() { (a, fa) } else { (b, fb) };
        let tolerance = f64::EPSILON * best.abs() + f64::MIN_POSITIVE;
        let limit = tolerance / (b - a).abs();
        if least == 0.0 || !(limit < 0.5) {
            return best;
        }
        let (chi, phi) = ((a - b) / (c - b), (fa - fb) / (fc - fb));
        t = if phi * phi < chi && (1.0 - phi) * (1.0 - phi) < 1.0 - chi {
            fa / (fb - fa) * (fc / (fb - fc)) + (c - a) / (b - a) * (fa / (fc - fa)) * (fb / (fc - fb))
        } else {
            0.5
        };
        t = t.max(limit).min(1.0 - limit);
    }
    a
}
