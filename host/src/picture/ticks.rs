//! Round numbers along an axis.

/// Marks on an axis and how to write them.
#[derive(Clone, Debug, PartialEq)]
pub struct Ticks {
    /// Places, ascending, inside the range.
    pub at: Vec<f64>,
    /// Their texts, in units of 10^`power`.
    pub labels: Vec<String>,
    /// Power of ten taken out of very large or small numbers; 0 otherwise.
    pub power: i32,
}

/// Numbers within this range of powers of ten are written in full.
const PLAIN: std::ops::Range<i32> = -3..6;

/// Multiples of 1, 2 or 5 times a power of ten in `low..=high`, about as many as wanted, never more than twice that.
/// None for an empty, infinite or NaN range.
#[must_use]
pub fn ticks(low: f64, high: f64, wanted: usize) -> Ticks {
    let span = high - low;
    if !(span > 0.0 && span.is_finite()) {
        return Ticks { at: vec![], labels: vec![], power: 0 };
    }
    let (step, exponent) = round_step(span / wanted.max(1) as f64);
    let largest = low.abs().max(high.abs()).log10().floor() as i32;
    // Map coordinates (6200010, 6200020; 6200000.5) read better in full than as 6.20001, 6.20002.
    let plain = PLAIN.contains(&largest) || (0..9).contains(&largest) && largest - exponent > 3;
    let power = if plain { 0 } else { largest.div_euclid(3) * 3 };
    let decimals = (power - exponent).clamp(0, 17) as usize;
    let slack = 1e-9 * span; // a mark on the very end belongs
    let first = ((low - slack) / step).ceil();
    let at: Vec<f64> = (0..=2 * wanted).map(|n| (first + n as f64) * step).take_while(|v| *v <= high + slack).collect();
    let labels = at.iter().map(|v| label(*v, power, decimals)).collect();
    Ticks { at, labels, power }
}

/// Marks at both ends, with numbers to about a hundredth of what lies between: for axes too short for round numbers.
#[must_use]
pub fn end_ticks(low: f64, high: f64) -> Ticks {
    let Ticks { power, .. } = ticks(low, high, 1);
    let unit = 10f64.powi(power);
    let fine = 1e-2 * (high - low) / unit;
    let label = |v: f64| if v.abs() < fine { "0".to_owned() } else { number_to(v, fine) };
    Ticks { at: vec![low, high], labels: [low, high].map(|v| label(v / unit)).to_vec(), power }
}

/// The next 1, 2 or 5 times a power of ten, and that power. Rounding does not push a round number to the next.
fn round_step(rough: f64) -> (f64, i32) {
    let exponent = rough.log10().floor() as i32;
    let unit = 10f64.powi(exponent);
    match rough / unit * (1.0 - 1e-12) {
        r if r <= 1.0 => (unit, exponent),
        r if r <= 2.0 => (2.0 * unit, exponent),
        r if r <= 5.0 => (5.0 * unit, exponent),
        _ => (10.0 * unit, exponent + 1),
    }
}

fn label(value: f64, power: i32, decimals: usize) -> String {
    let text = format!("{:.decimals$}", value / 10f64.powi(power));
    if text.trim_start_matches('-').chars().all(|c| c == '0' || c == '.') {
        return "0".into(); // rather than -0.0
    }
    text.replace('-', "−")
}

/// A number for reading: four digits, no needless zeros.
#[must_use]
pub fn number(value: f64) -> String {
    number_to(value, 1e-3 * value.abs())
}

/// A number for reading, to the first digit of `fine`, no needless zeros.
#[must_use]
pub fn number_to(value: f64, fine: f64) -> String {
    plain_to(value, fine).replace('-', "−")
}

/// A measured value, which may be copied: ten digits, no needless zeros.
#[must_use]
pub fn measure(value: f64) -> String {
    plain_to(value, 1e-9 * value.abs())
}

/// A part of a `whole` of which only so many `digits` are known; what is no more than rounding of the whole is 0.
#[must_use]
pub fn part(value: f64, whole: f64, digits: i32) -> String {
    let value = if value.abs() > ROUNDING * whole.abs() { value } else { 0.0 };
    plain_to(value, 10f64.powi(1 - digits) * value.abs())
}

/// Sums of many terms are rounded to this share of their whole, at worst.
const ROUNDING: f64 = 1e-12;

/// As [`number_to`], with minus signs that programs read.
#[must_use]
pub fn plain_to(value: f64, fine: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{}", value.abs() * value.signum()).replace("-0", "0");
    }
    let exponent = |v: f64| v.abs().log10().floor() as i32;
    let (largest, last) = (exponent(value), exponent(fine.max(1e-12 * value.abs())));
    if (PLAIN.start..9).contains(&largest) {
        shorter(&format!("{:.*}", (-last).max(0) as usize, value)).to_owned()
    } else {
        let text = format!("{:.*e}", (largest - last).max(0) as usize, value);
        text.split_once('e').map_or(text.clone(), |(digits, power)| format!("{}e{power}", shorter(digits)))
    }
}

/// Without zeros at the end of a fraction.
fn shorter(digits: &str) -> &str {
    if digits.contains('.') { digits.trim_end_matches('0').trim_end_matches('.') } else { digits }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_of_a_short_axis() {
        let of = |low, high| (end_ticks(low, high).labels.join(" "), end_ticks(low, high).power);
        assert_eq!(of(-2.623, 5.844), ("−2.62 5.84".to_owned(), 0));
        assert_eq!(of(0.0, 1.0), ("0 1".to_owned(), 0));
        assert_eq!(of(1e-9, 250.0), ("0 250".to_owned(), 0));
        assert_eq!(of(0.0, 2.5e-6), ("0 2.5".to_owned(), -6));
        assert_eq!(of(6_200_000.0, 6_200_003.5), ("6200000 6200003.5".to_owned(), 0));
    }

    #[test]
    fn round_numbers_in_the_range() {
        assert_eq!(ticks(0.0, 1.0, 5).labels, ["0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(ticks(-3.0, 7.5, 5).labels, ["0", "5"]);
        assert_eq!(ticks(-3.0, 7.5, 6).labels, ["−2", "0", "2", "4", "6"]);
        assert_eq!(ticks(500_000.0, 500_100.0, 4).labels, ["500000", "500050", "500100"]);
        assert_eq!(ticks(6_200_000.0, 6_200_040.0, 2).labels, ["6200000", "6200020", "6200040"]);
        assert_eq!(ticks(6_200_000.0, 6_200_001.0, 2).labels, ["6200000.0", "6200000.5", "6200001.0"]);
    }

    #[test]
    fn far_powers_are_taken_out() {
        let small = ticks(0.0, 2.5e-6, 5);
        assert_eq!((small.power, &small.labels[1][..]), (-6, "0.5"));
        let large = ticks(0.0, 3e7, 3);
        assert_eq!((large.power, &large.labels[1][..]), (6, "10"));
    }

    #[test]
    fn never_too_many_and_never_from_nonsense() {
        for n in 1..12 {
            for (low, high) in [(0.0, 1.0), (-1e300, 1e300), (1e15, 1e15 + 8.0), (0.1, 0.3), (-7e-9, -1e-9)] {
                let marks = ticks(low, high, n);
                assert!(marks.at.len() <= 2 * n + 1 && marks.at.iter().all(|v| v.is_finite()), "{low} {high} {n}");
            }
        }
        for (low, high) in [(1.0, 1.0), (2.0, 1.0), (f64::NAN, 1.0), (0.0, f64::INFINITY), (-1e308, 1.7e308)] {
            assert!(ticks(low, high, 5).at.is_empty(), "{low} {high}");
        }
    }

    #[test]
    fn numbers_for_reading() {
        let texts = [0.0, 1.0, 0.25, 12.3456, -99.996, 123_456.0, 2.5e-7, 1e9, -0.0, f64::NAN].map(number);
        assert_eq!(texts, ["0", "1", "0.25", "12.35", "−100", "123456", "2.5e−7", "1e9", "0", "NaN"]);
        assert_eq!(number_to(6_200_010.5, 0.01), "6200010.5");
        assert_eq!(number_to(-3.123_456e-5, 1e-8), "−3.123e−5");
        assert_eq!(number_to(2.0, 0.0), "2");
        let texts = [9.166_567_214_301_798, 10_129.659_451_750_3, 1e-27 / 3.0, 6e9, -1.0].map(measure);
        assert_eq!(texts, ["9.166567214", "10129.65945", "3.333333333e-28", "6e9", "-1"]);
    }
}
