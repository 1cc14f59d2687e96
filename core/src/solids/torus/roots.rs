//! Roots of functions of one variable, always between two points where the signs differ.
//!
//! Reference: T. Chandrupatla, Advances in Engineering Software 28 (1997).

/// More steps than any function here needs.
const MOST_STEPS: usize = 120;

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
