//! Bodies much thinner than a cell.

use crate::command::stress::case::{Effort, Numbers, StressCase, at_least, at_most};
use crate::command::stress::kit::boxes::share_of_disjoint;
use crate::command::stress::kit::doors::measure;
use crate::command::stress::kit::random::Random;
use crate::command::stress::kit::truth::{larger, open_fractions, worst};
use crate::command::triangulated::{cuboid, scene, turned_box};
use crate::grid::Edges;
use crate::porosity::{FieldSet, Options};
use glam::{DMat3, DVec3};

/// The cases.
pub const CASES: &[StressCase] = &[
    StressCase::new(
        "geometry/plates",
        "60 plates of 1e-6 of a cell across each axis, some in planes of the grid: products of overlaps",
        &[
            at_most(1e-14, "error of a cell or face"),
            at_least(1e-6, "solid share of the emptiest cell that a plate crosses"),
        ],
        plates,
    ),
    StressCase::new(
        "geometry/needles",
        "needles of 1e-5 of a cell through the grid in 8 directions, 72 alone in their cells and 200 that share cells: section times length, \
         section over cosine",
        &[
            at_most(1e-14, "error of a cell of one needle (which takes 1e-10)"),
            at_most(1e-9, "error of a cell of several"),
            at_most(1e-14, "truth outside of its bounds"),
            at_most(1e-14, "error of what needles close in a plane of the grid, in faces"),
        ],
        needles,
    ),
];

/// Cells of 1 m.
const CELLS: usize = 8;

fn edges() -> Edges {
    Edges([0, 1, 2].map(|_| (0..=CELLS).map(|i| i as f64).collect()))
}

fn plates(_: Effort) -> Numbers {
    let (mut error, mut emptiest) = (0.0, f64::INFINITY);
    for axis in 0..3 {
        let mut random = Random::new(axis as u64);
        let plate = |n: usize| {
            let (mut lo, mut hi) = (DVec3::splat(0.3), DVec3::splat(7.6));
            // Every tenth begins in a plane of the grid; the others lie anywhere in slots that no two share.
            lo[axis] =
                if n.is_multiple_of(10) { (n / 10 + 1) as f64 } else { (n as f64 + random.between(0.1, 0.9)) / 8.0 };
            hi[axis] = lo[axis] + 1e-6;
            [lo, hi]
        };
        let boxes: Vec<[DVec3; 2]> = (1..61).map(plate).collect();
        let bodies = scene(&boxes.iter().map(|[lo, hi]| cuboid(*lo, *hi)).collect::<Vec<_>>())?;
        let found = measure(&edges(), &bodies, Options::default())?;
        let truth = open_fractions(&edges(), |corners| share_of_disjoint(&boxes, corners));
        error = larger(error, worst(&found.beta, &truth));
        let crossed = found.beta.v.iter().zip(&truth.v).filter(|(_, open)| **open < 1.0 - 0.4e-6).map(|(b, _)| 1.0 - b);
        emptiest = crossed.fold(emptiest, f64::min);
    }
    Ok(vec![error, emptiest])
}

/// A square needle along the first axis of a turn, through a point.
struct Needle {
    through: DVec3,
    along: DVec3,
}

const WIDTH: f64 = 1e-5;

impl Needle {
    /// Length of its axis within a box.
    fn length_in(&self, [lo, hi]: [DVec3; 2]) -> f64 {
        let (a, b) = ((lo - self.through) / self.along, (hi - self.through) / self.along);
        (a.max(b).min_element() - a.min(b).max_element()).max(0.0)
    }
}

/// Needles beside each other, `side` by `side` at a distance, that all pass the whole grid; and their turn.
fn bundle(seed: u64, side: u32, apart: f64) -> (Vec<Needle>, DMat3) {
    let turn = Random::new(seed).turn();
    let needle = |n: u32| {
        let [u, v] = [n % side, n / side].map(|i| apart * (f64::from(i) - 0.5 * f64::from(side - 1)));
        Needle { through: DVec3::splat(4.0) + turn * DVec3::new(0.0, u + 0.011, v + 0.007), along: turn.x_axis }
    };
    ((0..side * side).map(needle).collect(), turn)
}

/// Errors of a bundle: of the worst cell, of what is closed in the middle planes; and how far the truth is outside of the bounds of cells.
fn judge(needles: &[Needle], turn: DMat3) -> Result<[f64; 3], crate::error::Error> {
    let half = DVec3::new(12.0, 0.5 * WIDTH, 0.5 * WIDTH);
    let solids: Vec<_> = needles.iter().map(|n| turned_box(n.through, half, turn)).collect();
    let found = measure(&edges(), &scene(&solids)?, Options { bounds: true, ..Options::default() })?;
    // Where it enters a cell, its section is cut askew: an error of the order of its width cubed.
    let inside = |corners| needles.iter().map(|n| n.length_in(corners)).sum::<f64>() * WIDTH * WIDTH;
    let truth = open_fractions(&edges(), inside).v;
    let of_cell = |most, n: usize| larger(most, (found.beta.v[n] - truth[n]).abs());
    let [lower, upper] = found.bounds.as_ref().map(|bounds| bounds.each_ref().map(|b| &b.v)).unwrap_or([&truth; 2]);
    let out_of = |most, n: usize| larger(most, larger(lower[n] - truth[n], truth[n] - upper[n]));
    let cells = 0..truth.len();
    Ok([cells.clone().fold(0.0, of_cell), error_in_middle_planes(&found.beta, needles), cells.fold(0.0, out_of)])
}

fn needles(_: Effort) -> Numbers {
    let (mut one, mut several, mut outside, mut planes) = (0.0, 0.0, 0.0, 0.0);
    for seed in 100..108 {
        let (sparse, turn) = bundle(seed, 3, 2.1);
        let alone = judge(&sparse, turn)?;
        let together = judge(&bundle(seed, 5, 0.7).0, turn)?;
        (one, several) = (larger(one, alone[0]), larger(several, together[0]));
        planes = larger(planes, larger(alone[1], together[1]));
        outside = larger(outside, larger(alone[2], together[2]));
    }
    Ok(vec![one, several, outside, planes])
}

/// The middle plane across each axis is pierced by every needle whose point there lies within the grid.
fn error_in_middle_planes(beta: &FieldSet, needles: &[Needle]) -> f64 {
    let mut error = 0.0;
    for axis in 0..3 {
        let at = (CELLS / 2) as f64;
        let pierces = |n: &&Needle| {
            let point = n.through + n.along * ((at - n.through[axis]) / n.along[axis]);
            (0..3).all(|d| d == axis || (0.0..=CELLS as f64).contains(&point[d]))
        };
        let truth: f64 = needles.iter().filter(pierces).map(|n| WIDTH * WIDTH / n.along[axis].abs()).sum();
        let size = [0, 1, 2].map(|d| CELLS + usize::from(d == axis));
        let place = |n: usize| [n % size[0], n / size[0] % size[1], n / size[0] / size[1]][axis];
        let faces = beta.faces(axis).iter().enumerate().filter(|(n, _)| place(*n) == CELLS / 2);
        error = larger(error, (faces.map(|(_, open)| 1.0 - open).sum::<f64>() - truth).abs());
    }
    error
}
