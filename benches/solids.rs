//! Time of solids by formula: `cargo bench -p voidage-benches --bench solids`; with words after `--`, of the cases whose names hold them all as words.
//! With the word `once` each case is computed a single time on one thread, so that callgrind counts its instructions.
//!
//! One line a case: medians over several runs of the computation alone, on one thread and on two, and of the grid without solids on one, whose
//! fields are all 1; nanoseconds of one thread for each cut cell, all in all and beyond those of the grid.

use glam::DVec3;
use std::path::Path;
use std::time::Instant;
use voidage::geometry::bodies::Bodies;
use voidage::geometry::form::Form;
use voidage::geometry::scene::{self, load};
use voidage::grid::Edges;
use voidage::porosity::{Options, porosity};
use voidage_benches::{is_asked, once, porosity_seconds};
use voidage_core::convex::shape::{Cylinder, Sphere};
use voidage_core::solids::torus::TorusShape;
use voidage_tests::random::Random;
use voidage_tests::solids::{formulas, sixteen_balls};

const RUNS: usize = 9;

fn main() {
    println!(
        "{:24} {:>11} {:>9} {:>9} {:>5} {:>9} {:>9} {:>7} {:>8}",
        "case", "cells", "1 thread", "2 threads", "gain", "the grid", "ns a cell", "beyond", "max gap"
    );
    let rack = Edges::uniform(DVec3::ZERO, DVec3::new(52.0, 52.0, 17.0), [104, 104, 34]);
    let hall = Edges::uniform(DVec3::ZERO, DVec3::new(100.0, 100.0, 30.0), [200, 200, 60]);
    case("1000 pipes, aligned", || pipes(1000, false, &rack), &rack);
    case("1000 pipes, oblique", || pipes(1000, true, &rack), &rack);
    case("120 pipes apart, aligned", || pipes_apart(false, &rack), &rack);
    case("120 pipes apart, oblique", || pipes_apart(true, &rack), &rack);
    case("10000 pipes, aligned", || pipes(10_000, false, &hall), &hall);
    case("10000 pipes, oblique", || pipes(10_000, true, &hall), &hall);
    let balls: Vec<Form> = sixteen_balls().into_iter().map(Form::Sphere).collect();
    case("16 balls", || formulas(&balls), &Edges::cube(0.0, 1.0, 100));
    case("1000 overlapping balls", || overlapping_balls(1000), &Edges::cube(0.0, 1.0, 50));
    case("200 elbows, aligned", || elbows(200, false, &rack), &rack);
    case("200 elbows, oblique", || elbows(200, true, &rack), &rack);
    let platform = Path::new(env!("CARGO_MANIFEST_DIR")).join("../host/examples/study/platform_scene.toml");
    let platform = scene::read(&platform).expect("the shipped platform");
    let edges = platform
        .grid
        .clone()
        .unwrap_or_else(|| Edges::uniform(DVec3::ZERO, DVec3::new(99.0, 99.0, 63.0), [99, 99, 63]));
    let mut bodies = Bodies::default();
    load::add(&platform, &mut bodies).expect("solids");
    case("the shipped platform", || bodies, &edges);
}

/// Balls of 0.05 m radius in a unit box, of which half is filled.
fn overlapping_balls(count: usize) -> Bodies {
    let random = &mut Random::new(17);
    let ball = |_| Form::Sphere(Sphere { center: random.point(DVec3::ZERO, DVec3::ONE), radius: 0.05 });
    formulas(&(0..count).map(ball).collect::<Vec<_>>())
}

/// Pipes of 0.05 to 0.25 m radius and 2 to 12 m length in a grid.
fn pipes(count: usize, oblique: bool, edges: &Edges) -> Bodies {
    let random = &mut Random::new(15);
    let [lo, hi] = edges.bounds();
    let pipe = |_| {
        let along = if oblique { random.vector::<DVec3>(1.0).normalize() } else { DVec3::AXES[random.below(3)] };
        let (half, radius) = (along * random.between(1.0, 6.0), random.between(0.05, 0.25));
        let room = half.abs() + radius;
        let middle = random.point(lo + room, hi - room);
        Form::Cylinder(Cylinder::new(middle - half, middle + half, radius))
    };
    formulas(&(0..count).map(pipe).collect::<Vec<_>>())
}

/// Long pipes along x, or nearly so, of 0.05 to 0.25 m radius, none of which meets another.
fn pipes_apart(oblique: bool, edges: &Edges) -> Bodies {
    let random = &mut Random::new(18);
    let [lo, hi] = edges.bounds();
    let pipe = |n: usize| {
        let place = DVec3::new(0.0, (n % 20) as f64 + 0.5, (n / 20) as f64 + 0.5) / DVec3::new(1.0, 20.0, 6.0);
        let middle = lo + (hi - lo) * place + random.vector::<DVec3>(1.0) * DVec3::new(0.0, 0.5, 0.5);
        let [from, to] = [2.0, hi.x - 2.0].map(|x| middle.with_x(x + random.between(-1.0, 1.0)));
        let aside = if oblique { DVec3::new(0.0, 1.1, 0.7) } else { DVec3::ZERO };
        Form::Cylinder(Cylinder::new(from, to + aside, random.between(0.05, 0.25)))
    };
    formulas(&(0..120).map(pipe).collect::<Vec<_>>())
}

/// Elbows of a quarter turn, of pipes of 0.05 to 0.25 m radius, bent by three of their diameters.
fn elbows(count: usize, oblique: bool, edges: &Edges) -> Bodies {
    let random = &mut Random::new(16);
    let [lo, hi] = edges.bounds();
    let elbow = |_| {
        let n = random.below(3);
        let (axis, start) = if oblique {
            let axis = random.vector::<DVec3>(1.0).normalize();
            (axis, axis.any_orthonormal_vector())
        } else {
            (DVec3::AXES[n], DVec3::AXES[(n + 1) % 3])
        };
        let tube = random.between(0.05, 0.25);
        let center = random.point(lo + 2.0, hi - 2.0);
        Form::Torus(TorusShape { center, axis, start, radius: 3.0 * tube, tube, angle: 90.0 })
    };
    formulas(&(0..count).map(elbow).collect::<Vec<_>>())
}

fn case(name: &str, bodies: impl FnOnce() -> Bodies, edges: &Edges) {
    if !is_asked(name) {
        return;
    }
    let [nx, ny, nz] = edges.cells();
    let bodies = &bodies();
    if once() {
        return run_once(name, bodies, edges);
    }
    let (one, result) = porosity_seconds(bodies, edges, 1, RUNS, Options::default());
    let (two, _) = porosity_seconds(bodies, edges, 2, RUNS, Options::default());
    let (alone, _) = porosity_seconds(&Bodies::default(), edges, 1, RUNS, Options::default());
    let cut = result.beta.v.iter().filter(|&&b| b > 0.0 && b < 1.0).count().max(1);
    let a_cell = |seconds: f64| seconds * 1e9 / cut as f64;
    println!(
        "{name:24} {:>11} {:>7.1}ms {:>7.1}ms {:>5.2} {:>7.1}ms {:>9.0} {:>7.0} {:>8.1e}",
        format!("{nx}x{ny}x{nz}"),
        one * 1e3,
        two * 1e3,
        one / two,
        alone * 1e3,
        a_cell(one),
        a_cell(one - alone),
        result.max_gap
    );
}

/// One run on one thread, the time of which is printed with a sum of the field.
fn run_once(name: &str, bodies: &Bodies, edges: &Edges) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let grid = edges.grid(None).expect("a grid");
    let begin = Instant::now();
    let result = pool.install(|| porosity(&grid, bodies, Options::default()));
    println!(
        "{name:34} {:.1} ms, volume {}, gap {:.1e}, {} cells cut, {} shared",
        begin.elapsed().as_secs_f64() * 1e3,
        result.solid_volume,
        result.max_gap,
        result.cells.cut,
        result.cells.ambiguous
    );
}
