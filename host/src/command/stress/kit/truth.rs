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
/// R. Scardovelli, S. Zaleski, J. Comput. Phys. 164 (2000) 228: an alternating sum over the corners; its own error is some roundings
/// over the ratio of the spans along the axes.
#[must_use]
pub fn half_space(normal: DVec3, offset: f64, [low, high]: [DVec3; 2]) -> f64 {
    let rest = offset - (normal * low).min(normal * high).element_sum();
    let spans: Vec<f64> = (normal * (high - low)).abs().to_array().into_iter().filter(|span| *span > 0.0).collect();
    if rest <= 0.0 {
        return 0.0;
    }
    if rest >= spans.iter().sum() {
        return 1.0;
    }
    let power = spans.len() as i32;
    let corner = |set: usize| {
        let chosen = spans.iter().enumerate().filter(|(d, _)| set >> d & 1 == 1).map(|(_, span)| *span);
        let (count, sum) = chosen.fold((0, 0.0), |(count, sum), span| (count + 1, sum + span));
        if count % 2 == 0 { (rest - sum).max(0.0).powi(power) } else { -(rest - sum).max(0.0).powi(power) }
    };
    let sum: f64 = (0..1usize << power).map(corner).sum();
    sum / (f64::from((1..=power).product::<i32>()) * spans.iter().product::<f64>())
}
