//! A logarithmic axis: its ends, and where numbers stand.

/// A logarithmic axis.
#[derive(Debug, Clone, PartialEq)]
pub struct LogAxis {
    low: f64,
    high: f64,
    /// Values and their texts, ascending.
    pub ticks: Vec<(f64, String)>,
}

/// Above this ratio of the ends only powers of ten are marked.
const DECADES: f64 = 100.0;

impl LogAxis {
    /// Around some positive values, with at most `most` numbers; nothing if there is no value.
    #[must_use]
    pub fn around(values: impl Iterator<Item = f64>, most: usize) -> Option<LogAxis> {
        let [low, high] = values
            .filter(|v| v.is_normal() && *v > 0.0)
            .fold(None, |ends: Option<[f64; 2]>, v| Some(ends.map_or([v, v], |[a, b]| [a.min(v), b.max(v)])))?;
        let powers = low.log10().floor() as i32 - 1..=high.log10().ceil() as i32 + 1;
        let steps: &[f64] = if high / low < DECADES { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let marks: Vec<f64> = powers.flat_map(|p| steps.iter().map(move |s| s * 10_f64.powi(p))).collect();
        let slack = 1.0 + 1e-9;
        let first = marks.iter().rposition(|m| *m <= low * slack).unwrap_or(0);
        let last = marks.iter().position(|m| *m * slack >= high).unwrap_or(marks.len().saturating_sub(1));
        let last = if last <= first { first + 1 } else { last };
        let inside = marks.get(first..=last)?;
        let every = (inside.len() - 1) / most.max(1) + 1;
        let ticks = inside.iter().step_by(every).map(|&m| (m, text(m))).collect();
        Some(LogAxis { low: inside.first()?.log10(), high: inside.last()?.log10(), ticks })
    }

    /// Where a positive value stands: 0 at the low end, 1 at the high one.
    #[must_use]
    pub fn share(&self, value: f64) -> f64 {
        (value.log10() - self.low) / (self.high - self.low)
    }
}

/// A number at an axis.
fn text(mark: f64) -> String {
    let power = (mark.log10() + 1e-9).floor() as i32;
    if (-2..5).contains(&power) {
        format!("{mark:.*}", (-power).max(0) as usize)
    } else {
        format!("{:.0}e{power}", mark / 10_f64.powi(power)).replace('-', "−")
    }
}
