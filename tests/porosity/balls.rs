//! Unions of balls, by closed forms: against lines through them, against closed forms of pairs, and on grids that must agree.

use glam::DVec3;
use std::f64::consts::PI;
use voidage_core::grid::bounds::Bounds;
use voidage_core::solids::quadric::{QuadricSolid, share_of_union};
use voidage_tests::effort::cases;
use voidage_tests::random::Random;

type Ball = (DVec3, f64);

/// Share of a cell, or of a face, that the union of some balls has.
fn share(balls: &[Ball], cell: [[f64; 2]; 3]) -> Bounds<f64> {
    let solids: Vec<QuadricSolid> = balls.iter().map(|&(c, r)| QuadricSolid::ball(c, r).expect("a ball")).collect();
    // No slice is allowed: closed forms alone.
    share_of_union(&solids, cell, Bounds { lower: 0.0, upper: f64::INFINITY }, 1e-6, 0).expect("a closed form")
}

/// Its middle; the bounds are as close as rounding.
fn close(balls: &[Ball], cell: [[f64; 2]; 3]) -> f64 {
    let found = share(balls, cell);
    assert!(found.upper - found.lower < 1e-10, "{found:?} of {balls:?} in {cell:?}");
    0.5 * (found.lower + found.upper)
}

const UNIT: [[f64; 2]; 3] = [[0.0, 1.0]; 3];

fn point(random: &mut Random, lo: f64, hi: f64) -> DVec3 {
    random.point(DVec3::splat(lo), DVec3::splat(hi))
}

fn some_balls(random: &mut Random, most: usize) -> Vec<Ball> {
    let count = 1 + random.below(most);
    let one = |random: &mut Random| (point(random, -0.3, 1.3), random.between(0.1, 0.9));
    (0..count).map(|_| one(random)).collect()
}

/// Length of the union of intervals.
fn covered(mut intervals: Vec<[f64; 2]>) -> f64 {
    intervals.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let (mut sum, mut end) = (0.0, 0.0_f64);
    for [from, to] in intervals {
        sum += (to.min(1.0) - from.max(end)).max(0.0);
        end = end.max(to.min(1.0));
    }
    sum
}

#[test]
fn unions_are_those_of_lines_through_the_cell() {
    const LINES: usize = 300;
    let random = &mut Random::new(61);
    for _ in 0..cases(40) {
        let balls = some_balls(random, 7);
        let mut sum = 0.0;
        for (i, j) in (0..LINES).flat_map(|i| (0..LINES).map(move |j| (i, j))) {
            let [x, y] = [i, j].map(|n| (n as f64 + 0.5) / LINES as f64);
            let of_ball = |&(c, r): &Ball| {
                let square = r * r - (x - c.x).powi(2) - (y - c.y).powi(2);
                (square > 0.0).then(|| [c.z - square.sqrt(), c.z + square.sqrt()])
            };
            sum += covered(balls.iter().filter_map(of_ball).collect()) / (LINES * LINES) as f64;
        }
        let found = close(&balls, UNIT);
        assert!((found - sum).abs() < 1e-4, "{found} and by lines {sum}: {balls:?}");
        let (x, z) = (random.between(0.0, 1.0), random.between(0.0, 1.0));
        let of_ball = |&(c, r): &Ball| {
            let square = r * r - (x - c.x).powi(2) - (z - c.z).powi(2);
            (square > 0.0).then(|| [c.y - square.sqrt(), c.y + square.sqrt()])
        };
        let line = covered(balls.iter().filter_map(of_ball).collect());
        // A face so narrow that it is a line.
        let face = share(&balls, [[x, x], [0.0, 1.0], [z, z + 1e-5]]);
        assert!((face.lower - line).abs() < 1e-3, "{face:?}, the line {line}: {balls:?}");
    }
}

#[test]
fn two_balls_share_a_lens() {
    let random = &mut Random::new(62);
    for _ in 0..cases(300) {
        let [(a, r), (b, s)] = [(); 2].map(|()| (point(random, 1.0, 2.0), random.between(0.2, 0.9)));
        let (d, ball) = (a.distance(b), |r: f64| 4.0 / 3.0 * PI * r.powi(3));
        let union = if d >= r + s {
            ball(r) + ball(s)
        } else if d <= (r - s).abs() {
            ball(r.max(s))
        } else {
            let lens = PI * (r + s - d).powi(2) * (d * d + 2.0 * d * (r + s) - 3.0 * (r - s).powi(2)) / (12.0 * d);
            ball(r) + ball(s) - lens
        };
        let found = 27.0 * close(&[(a, r), (b, s)], [[0.0, 3.0]; 3]);
        assert!((found - union).abs() < 1e-12, "{found}, not {union}: {a} {r}, {b} {s}");
    }
}

/// However a box is divided, its cells hold as much.
#[test]
fn cells_add_up_to_their_box() {
    let random = &mut Random::new(63);
    for _ in 0..cases(60) {
        let balls = some_balls(random, 20);
        let cuts = [0; 3].map(|_| [0.0, random.between(0.1, 0.45), random.between(0.55, 0.9), 1.0]);
        let mut sum = 0.0;
        for n in 0..27 {
            let cell: [[f64; 2]; 3] = std::array::from_fn(|a| {
                let at = n / 3_usize.pow(a as u32) % 3;
                [cuts[a][at], cuts[a][at + 1]]
            });
            sum += share(&balls, cell).lower * cell.iter().map(|[lo, hi]| hi - lo).product::<f64>();
        }
        let whole = close(&balls, UNIT);
        assert!((sum - whole).abs() < 1e-10, "{sum} in parts, {whole} as a whole: {balls:?}");
    }
}

/// Planes between balls that lie in planes of the grid or in each other, balls that are one or hold another, that touch, that are cut in half.
#[test]
fn balls_in_order() {
    let half = 2.0 / 3.0 * PI * 0.125;
    let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    let one = (at(0.5, 0.5, 0.5), 0.5);
    for (balls, wanted) in [
        (vec![one; 5], 2.0 * half),
        (vec![one, (at(0.5, 0.5, 0.6), 0.25)], 2.0 * half),
        (vec![(at(0.5, 0.5, 0.75), 0.25), one], 2.0 * half),
        (vec![one, (at(1.5, 0.5, 0.5), 0.5)], 2.0 * half),
        (vec![(at(0.0, 0.5, 0.5), 0.5), (at(1.0, 0.5, 0.5), 0.5)], 2.0 * half),
        // What a mirror in the side of the cell leaves.
        (vec![(at(0.9, 0.5, 0.5), 0.5), (at(1.1, 0.5, 0.5), 0.5)], close(&[(at(0.9, 0.5, 0.5), 0.5)], UNIT)),
        (vec![(at(0.5, 0.5, 0.5), 1.0)], 1.0),
        (vec![], 0.0),
    ] {
        let found = close(&balls, UNIT);
        assert!((found - wanted).abs() < 1e-12, "{found}, not {wanted}: {balls:?}");
        let mut turned = balls.clone();
        turned.reverse();
        assert!((close(&turned, UNIT) - found).abs() < 1e-14, "{balls:?} the other way");
    }
    // A lattice of balls that overlap, eight to a cell: each leaves the cell an eighth of what it has beyond its neighbours.
    let lattice = |n: usize| at((n % 4) as f64 - 1.0, (n / 4 % 4) as f64 - 1.0, (n / 16) as f64 - 1.0);
    let balls: Vec<Ball> = (0..64).map(|n| (lattice(n), 0.6)).collect();
    let cap = PI * 0.1_f64.powi(2) * (0.6 - 0.1 / 3.0);
    let wanted = 4.0 / 3.0 * PI * 0.6_f64.powi(3) - 6.0 * cap;
    let found = close(&balls, UNIT);
    assert!((found - wanted).abs() < 1e-12, "{found}, not {wanted}");
    // In single precision edges and centres are still numbers: far off as here.
    for far in [1e3, 1e6] {
        let moved: Vec<Ball> = balls.iter().map(|&(c, r)| (c + DVec3::splat(far), r)).collect();
        let found = close(&moved, [[far, far + 1.0]; 3]);
        assert!((found - wanted).abs() < 1e-12, "{found}, not {wanted} at {far}");
    }
}

/// What is large against the cell is known less well, and says so.
#[test]
fn bounds_hold_for_large_balls() {
    let random = &mut Random::new(64);
    for _ in 0..cases(300) {
        let large = 10.0_f64.powf(random.between(0.0, 1.8));
        let surface = |random: &mut Random| {
            let way = point(random, -1.0, 1.0).normalize_or(DVec3::X);
            (DVec3::splat(0.5) + way * large + point(random, -0.3, 0.3), large)
        };
        let balls: Vec<Ball> = (0..3).map(|_| surface(random)).collect();
        let whole = share(&balls, UNIT);
        let mut sum = [0.0; 2];
        for n in 0..8 {
            let cell = [n % 2, n / 2 % 2, n / 4].map(|at| [f64::from(at) * 0.5, f64::from(at) * 0.5 + 0.5]);
            let part = share(&balls, cell);
            sum = [sum[0] + part.lower / 8.0, sum[1] + part.upper / 8.0];
        }
        assert!(sum[0] <= whole.upper && sum[1] >= whole.lower, "{sum:?} in parts, {whole:?}: {balls:?}");
    }
}
