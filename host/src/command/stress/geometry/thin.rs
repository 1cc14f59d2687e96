//! Bodies much thinner than a cell.

use crate::command::stress::case::{Effort, Numbers, StressCase, at_least, at_most};
use crate::command::stress::kit::boxes::share_of_disjoint;
use crate::command::stress::kit::doors::measure;
use crate::command::stress::kit::random::Random;
use crate::command::stress::kit::solids::{cuboid, scene, turned_box};
use crate::command::stress::kit::truth::{larger, open_fractions, worst};
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
        "200 needles of 1e-5 of a cell in 8 directions through the grid: section times length, section over cosine",
        &[
            at_most(1e-14, "error of a cell (a needle takes 1e-10)"),
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

/// Needles beside each other that all pass the whole grid, and their turn.
fn bundle(seed: u64) -> (Vec<Needle>, DMat3) {
    let turn = Random::new(seed).turn();
    let needle = |n: u32| {
        let (u, v) = (f64::from(n % 5) - 2.0, f64::from(n / 5) - 2.0);
        let through = DVec3::splat(4.0) + turn * DVec3::new(0.0, 0.713 * u + 0.011, 0.687 * v + 0.007);
        Needle { through, along: turn.x_axis }
    };
    ((0..25).map(needle).collect(), turn)
}

fn needles(_: Effort) -> Numbers {
    let (mut error, mut error_in_planes) = (0.0, 0.0);
    for seed in 0..8 {
        let (needles, turn) = bundle(100 + seed);
        let half = DVec3::new(12.0, 0.5 * WIDTH, 0.5 * WIDTH);
        let solids: Vec<_> = needles.iter().map(|n| turned_box(n.through, half, turn)).collect();
        let found = measure(&edges(), &scene(&solids)?, Options::default())?;
        // Where it enters a cell, its section is cut askew: an error of the order of its width cubed.
        let inside = |corners| needles.iter().map(|n| n.length_in(corners)).sum::<f64>() * WIDTH * WIDTH;
        let cells = open_fractions(&edges(), inside).v;
        let worst_cell = found.beta.v.iter().zip(&cells).fold(0.0, |most, (a, b)| larger(most, (a - b).abs()));
        error = larger(error, worst_cell);
        error_in_planes = larger(error_in_planes, error_in_middle_planes(&found.beta, &needles));
    }
    Ok(vec![error, error_in_planes])
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
