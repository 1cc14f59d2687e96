//! Slices of a field, three to a picture, as PNG.

use std::path::Path;

use rayon::prelude::*;

use super::canvas::Canvas;
use super::colour::ColourMap;
use super::figure::Figure;
use super::ticks::number;
use crate::error::{Error, Result};
use crate::words::either;

/// Draws three slices of the open volume fraction, where each shows most: the planes of largest contrast.
///
/// # Errors
/// `beta_v` does not fit the edges, the edges do not ascend, or the file cannot be written.
pub fn slices(path: &Path, title: &str, x: &[f64], y: &[f64], z: &[f64], unit: &str, beta_v: &[f64]) -> Result<()> {
    let canvas = picture(title, [x, y, z], unit, beta_v, [None; 3]);
    canvas.map_err(|reason| Error::file(path, reason))?.write(path)
}

/// The picture of [`slices`]; along an axis it is cut through the given coordinate, if there is one.
///
/// # Errors
/// The reason: `beta_v` does not fit the edges, or the edges do not ascend.
pub fn picture(
    title: &str,
    edges: [&[f64]; 3],
    unit: &str,
    beta_v: &[f64],
    through: [Option<f64>; 3],
) -> std::result::Result<Canvas, String> {
    let (telling, open) = survey(edges, beta_v).ok_or("beta_v does not have the grid's length")?;
    let at = cut(edges, telling, through);
    let note = note(edges, unit, open);
    let map = &ColourMap::open_fraction();
    let (name, range, ends) = ("beta_v", [0.0, 1.0], ["blocked", "open"]);
    let (moment, note, values, told) = ("", &note[..], beta_v, [true; 2]);
    Figure { title, moment, note, edges, unit, values, at, name, range, ends, told, map }.draw()
}

/// The picture of another field that is not negative, cut as [`picture`] is; `name` has its unit.
///
/// # Errors
/// As [`picture`].
pub fn picture_of(
    (name, values): (&str, &[f64]),
    title: &str,
    edges: [&[f64]; 3],
    unit: &str,
    through: [Option<f64>; 3],
) -> std::result::Result<Canvas, String> {
    let (telling, mean) = survey(edges, values).ok_or_else(|| format!("{name} does not have the grid's length"))?;
    let most = values.iter().copied().fold(0.0, f64::max);
    let note = format!("{} · mean {}, most {}", grid_note(edges, unit), number(mean), number(most));
    let last = last_of_scale(values, most);
    let ends = ["", if last < most { "and above" } else { "" }];
    let (at, range, map) = (cut(edges, telling, through), [0.0, last], &ColourMap::density());
    let (moment, note, told) = ("", &note[..], [true; 2]);
    Figure { title, moment, note, edges, unit, values, at, name, range, ends, told, map }.draw()
}

/// Share of the values above zero that the scale of a picture reaches.
const IN_SCALE: f64 = 0.98;

/// The last value of a scale from zero: the largest; or if that is more than twice what nearly all others are below, that: a sliver in a cell must not
/// leave all others without colour.
fn last_of_scale(values: &[f64], most: f64) -> f64 {
    let mut some: Vec<f64> = values.iter().copied().filter(|&v| v > 0.0).collect();
    let rank = (some.len() as f64 * IN_SCALE) as usize;
    if rank + 1 >= some.len() {
        return most;
    }
    let (_, &mut nearly_all, _) = some.select_nth_unstable_by(rank, f64::total_cmp);
    if most > 2.0 * nearly_all { nearly_all } else { most }
}

/// The cells that the slices show: those at the given coordinates, else the most telling ones.
fn cut(edges: [&[f64]; 3], telling: [usize; 3], through: [Option<f64>; 3]) -> [usize; 3] {
    std::array::from_fn(|a| {
        let cell = |x: f64| edges[a].partition_point(|&e| e <= x).clamp(1, edges[a].len() - 1) - 1;
        through[a].map_or(telling[a], cell)
    })
}

/// Cells, their sizes, the domain, how much is open.
fn note(edges: [&[f64]; 3], unit: &str, open: f64) -> String {
    // Under 1e-12 it is rounding of the sum.
    let blocked = number(((1.0 - open) * 1e12).round() / 1e10);
    format!("{} · {blocked} % of the volume blocked", grid_note(edges, unit))
}

/// Cells, their sizes, the domain.
#[must_use]
pub fn grid_note(edges: [&[f64]; 3], unit: &str) -> String {
    let by = |texts: [String; 3]| texts.join(" × ");
    let cells = by(edges.map(|e| (e.len() - 1).to_string()));
    let sizes = edges.map(size);
    let sizes = if sizes[0] == sizes[1] && sizes[1] == sizes[2] { sizes[0].clone() } else { by(sizes) };
    let domain = by(edges.map(|e| number(e[e.len() - 1] - e[0])));
    let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
    let words = either(edges.iter().map(|e| e.len() - 1).product(), "cell", "cells");
    format!("{cells} {words} of {sizes}{unit} · domain {domain}{unit}")
}

/// Cell size along an axis, or its range.
fn size(edges: &[f64]) -> String {
    let sizes = || edges.windows(2).map(|w| w[1] - w[0]);
    let (least, most) = (sizes().fold(f64::INFINITY, f64::min), sizes().fold(0.0, f64::max));
    // Edges given in decimals differ in the last bits.
    if most - least <= 1e-6 * most { number(most) } else { format!("{}–{}", number(least), number(most)) }
}

/// The index of the slice along each axis where open space shows most of what stands in it; none if the lengths do not fit.
#[must_use]
pub fn most_telling_space(edges: [&[f64]; 3], beta_v: &[f64]) -> Option<[usize; 3]> {
    // Along a wall with a door hardly anything flows.
    let told = |slice: &Sums| slice.variance() * slice.mean().max(0.0);
    survey_by(edges, beta_v, told).map(|(at, _)| at)
}

/// The index of the slice with the largest variance along each axis, the one nearest to the middle among equals; and
/// the mean of all. None if the lengths do not fit.
fn survey(edges: [&[f64]; 3], beta: &[f64]) -> Option<([usize; 3], f64)> {
    survey_by(edges, beta, Sums::variance)
}

/// The same for the slice that tells most.
fn survey_by(edges: [&[f64]; 3], beta: &[f64], told: impl Fn(&Sums) -> f64) -> Option<([usize; 3], f64)> {
    let [dx, dy, dz] = edges.map(|e| e.windows(2).map(|w| w[1] - w[0]).collect::<Vec<f64>>());
    if dx.is_empty() || dy.is_empty() || beta.len() != dx.len() * dy.len() * dz.len() {
        return None;
    }
    let planes: Vec<[Vec<Sums>; 2]> =
        beta.par_chunks_exact(dx.len() * dy.len()).map(|plane| plane_sums(plane, &dx, &dy)).collect();
    let [mut by_x, mut by_y, mut by_z] = [&dx, &dy, &dz].map(|d| vec![Sums::default(); d.len()]);
    let mut total = Sums::default();
    for (([in_x, in_y], d), sum) in planes.iter().zip(&dz).zip(&mut by_z) {
        in_y.iter().zip(&dy).for_each(|(line, d)| sum.add(*line, *d));
        total.add(*sum, *d);
        sums_add(&mut by_x, in_x, *d);
        sums_add(&mut by_y, in_y, *d);
    }
    Some(([by_x, by_y, by_z].map(|s| strongest(&s, &told)), total.mean()))
}

/// Of one plane across z: the lines along y at each x, and along x at each y.
fn plane_sums(plane: &[f64], dx: &[f64], dy: &[f64]) -> [Vec<Sums>; 2] {
    let mut in_x = vec![Sums::default(); dx.len()];
    let mut in_y = vec![Sums::default(); dy.len()];
    for ((line, d), along) in plane.chunks_exact(dx.len()).zip(dy).zip(&mut in_y) {
        for ((b, w), across) in line.iter().zip(dx).zip(&mut in_x) {
            let one = Sums { weight: 1.0, value: *b, square: b * b };
            across.add(one, *d);
            along.add(one, *w);
        }
    }
    [in_x, in_y]
}

/// Of a weighted set of values.
#[derive(Clone, Copy, Default)]
struct Sums {
    weight: f64,
    value: f64,
    square: f64,
}

impl Sums {
    fn add(&mut self, other: Sums, weight: f64) {
        self.weight += weight * other.weight;
        self.value += weight * other.value;
        self.square += weight * other.square;
    }

    fn mean(&self) -> f64 {
        self.value / self.weight
    }

    fn variance(&self) -> f64 {
        let mean = self.mean();
        self.square / self.weight - mean * mean
    }
}

fn sums_add(all: &mut [Sums], others: &[Sums], weight: f64) {
    all.iter_mut().zip(others).for_each(|(sum, other)| sum.add(*other, weight));
}

fn strongest(slices: &[Sums], told: &impl Fn(&Sums) -> f64) -> usize {
    let most = slices.iter().map(told).fold(0.0, f64::max);
    // Rounding must not decide among slices that are alike.
    let enough = |i: &usize| told(&slices[*i]) >= 0.999 * most - 1e-12;
    (0..slices.len()).filter(enough).min_by_key(|i| (2 * i + 1).abs_diff(slices.len())).unwrap_or(slices.len() / 2)
}

#[cfg(test)]
mod tests {
    use super::*;

    const EDGES: [f64; 6] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0];

    /// A sliver does not take the colours from all others; what grows evenly keeps its largest.
    #[test]
    fn the_scale_leaves_out_slivers() {
        let even: Vec<f64> = (0..1000).map(f64::from).collect();
        assert_eq!(last_of_scale(&even, 999.0), 999.0);
        let mut with_sliver = even.clone();
        with_sliver[3] = 1e27;
        assert!((970.0..=999.0).contains(&last_of_scale(&with_sliver, 1e27)));
        assert_eq!(last_of_scale(&[0.0, 5.0, 0.0], 5.0), 5.0);
        assert_eq!(last_of_scale(&[0.0; 7], 0.0), 0.0);
    }

    #[test]
    fn an_empty_domain_is_cut_in_the_middle() {
        let (at, open) = survey([&EDGES; 3], &[1.0; 125]).expect("lengths fit");
        assert_eq!((at, open), ([2, 2, 2], 1.0));
    }

    #[test]
    fn slices_go_through_a_lone_block_but_not_along_a_floor() {
        let mut beta = vec![1.0; 125];
        beta[..25].fill(0.0); // the floor, k = 0
        beta[(3 * 5 + 4) * 5 + 1] = 0.0;
        let (at, open) = survey([&EDGES; 3], &beta).expect("lengths fit");
        assert_eq!((at, open), ([1, 4, 3], 99.0 / 125.0));
    }

    /// A wall with a large door varies most along itself; gas flows beside it, past a block.
    #[test]
    fn gas_is_cut_beside_walls() {
        let mut beta = vec![1.0; 125];
        for at in (0..125).filter(|at| at % 5 == 1 && at % 2 == 0) {
            beta[at] = 0.0; // i = 1: half of it
        }
        (0..125).filter(|at| at % 5 == 1).take(18).for_each(|at| beta[at] = 0.0);
        beta[(2 * 5 + 2) * 5 + 3] = 0.0;
        beta[(2 * 5 + 3) * 5 + 3] = 0.0;
        beta[(3 * 5 + 2) * 5 + 3] = 0.0;
        beta[(3 * 5 + 3) * 5 + 3] = 0.0;
        assert_eq!(survey([&EDGES; 3], &beta).expect("lengths fit").0[0], 1);
        assert_eq!(most_telling_space([&EDGES; 3], &beta).expect("lengths fit")[0], 3);
    }

    #[test]
    fn the_mean_counts_volumes() {
        let (_, open) = survey([&[0.0, 3.0, 4.0], &[0.0, 1.0], &[0.0, 2.0]], &[1.0, 0.0]).expect("lengths fit");
        assert_eq!(open, 0.75);
        assert!(survey([&[0.0, 3.0], &[0.0], &[0.0, 1.0]], &[]).is_none());
    }

    #[test]
    fn the_note_names_grid_and_units() {
        let text = note([&[0.0, 0.1, 0.2, 0.30000000000000004], &[0.0, 1.0], &[0.0, 1.0, 3.0]], "m", 0.5);
        assert_eq!(text, "3 × 1 × 2 cells of 0.1 × 1 × 1–2 m · domain 0.3 × 1 × 3 m · 50 % of the volume blocked");
    }
}
