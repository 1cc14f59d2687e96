//! Open fractions of a grid by closed forms, and how far found ones are from them.

use crate::grid::Edges;
use crate::porosity::{FieldSet, HugeVec};
use glam::DVec3;

/// Open fractions from the solid share of any box (lowest and highest corner); for a face the box is flat.
#[must_use]
pub fn open_fractions(edges: &Edges, solid: impl Fn([DVec3; 2]) -> f64) -> FieldSet {
    let cells = edges.cells();
    let all = |flat: Option<usize>| {
        let size = [0, 1, 2].map(|axis| cells[axis] + usize::from(flat == Some(axis)));
        let one = |n: usize| {
            let at = [n % size[0], n / size[0] % size[1], n / size[0] / size[1]];
            let corner = |high: usize| {
                let edge = |axis: usize| edges.0[axis][at[axis] + if flat == Some(axis) { 0 } else { high }];
                DVec3::new(edge(0), edge(1), edge(2))
            };
            1.0 - solid([corner(0), corner(1)])
        };
        HugeVec::from((0..size.iter().product()).map(one).collect::<Vec<f64>>())
    };
    FieldSet { v: all(None), x: all(Some(0)), y: all(Some(1)), z: all(Some(2)) }
}

/// The cells and the faces of all axes.
fn fields(set: &FieldSet) -> [&[f64]; 4] {
    [&set.v, &set.x, &set.y, &set.z]
}

/// The larger of two; NaN counts as infinite.
#[must_use]
pub fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::INFINITY } else { a.max(b) }
}

/// Largest difference of any cell or face; infinite if there are not as many.
#[must_use]
pub fn worst(found: &FieldSet, truth: &FieldSet) -> f64 {
    let pairs = fields(found).into_iter().zip(fields(truth));
    let of_field = |(found, truth): (&[f64], &[f64])| match found.len() == truth.len() {
        true => found.iter().zip(truth).fold(0.0, |most, (a, b)| larger(most, (a - b).abs())),
        false => f64::INFINITY,
    };
    pairs.map(of_field).fold(0.0, larger)
}

/// How far the truth lies outside of bounds, at the worst place.
#[must_use]
pub fn outside(bounds: &Option<[FieldSet; 2]>, truth: &FieldSet) -> f64 {
    let Some([lower, upper]) = bounds else { return f64::INFINITY };
    let mut most = 0.0;
    for (truth, (lower, upper)) in fields(truth).into_iter().zip(fields(lower).into_iter().zip(fields(upper))) {
        for (n, value) in truth.iter().enumerate() {
            let at = |bound: &[f64]| bound.get(n).copied().unwrap_or(f64::NAN);
            most = larger(most, larger(at(lower) - value, value - at(upper)));
        }
    }
    most
}

/// Cells and faces whose bits differ.
#[must_use]
pub fn differing(a: &FieldSet, b: &FieldSet) -> f64 {
    let pairs = fields(a).into_iter().zip(fields(b));
    let count = |(a, b): (&[f64], &[f64])| {
        a.len().abs_diff(b.len()) + a.iter().zip(b).filter(|(a, b)| a.to_bits() != b.to_bits()).count()
    };
    pairs.map(count).sum::<usize>() as f64
}

/// Share of a box, flat along any axes, that lies where normal · x < offset.
///
/// Of lengths of one axis it is a ratio; of more, the mean over the axis along which the plane's height changes least of the share in the
/// others: between kinks a polynomial, which Gauss' rule integrates exactly. So cells of any aspect lose no digits.
#[must_use]
pub fn half_space(normal: DVec3, offset: f64, [low, high]: [DVec3; 2]) -> f64 {
    let rest = offset - (normal * low).min(normal * high).element_sum();
    let mut spans: Vec<f64> = (normal * (high - low)).abs().to_array().into_iter().filter(|span| *span > 0.0).collect();
    spans.sort_by(|a, b| b.total_cmp(a));
    share_below(&spans, rest)
}

/// Share of a box of some spans, largest first, where the sum of the coordinates stays below `rest`.
fn share_below(spans: &[f64], rest: f64) -> f64 {
    let Some((&span, larger)) = spans.split_last() else { return f64::from(u8::from(rest > 0.0)) };
    if larger.is_empty() {
        return (rest / span).clamp(0.0, 1.0);
    }
    let corner = |set: usize| larger.iter().enumerate().filter(|(d, _)| set >> d & 1 == 1).map(|(_, s)| s).sum::<f64>();
    let mut kinks: Vec<f64> = (0..1usize << larger.len()).map(|set| rest - corner(set)).collect();
    kinks.retain(|t| *t > 0.0 && *t < span);
    kinks.extend([0.0, span]);
    kinks.sort_by(f64::total_cmp);
    let piece = |ends: &[f64]| {
        let (middle, half) = (0.5 * (ends[0] + ends[1]), 0.5 * (ends[1] - ends[0]));
        let at = |x: f64| share_below(larger, rest - (middle + x * half));
        half * (at(-GAUSS) + at(GAUSS))
    };
    kinks.windows(2).map(piece).sum::<f64>() / span
}

/// Node of Gauss' rule of two points, exact for cubics: 1/√3.
const GAUSS: f64 = 0.577_350_269_189_625_8;
