//! Timing shared by the benchmarks.

use std::hint::black_box;
use std::time::Instant;
use voidage::geometry::bodies::Bodies;
use voidage::grid::Edges;
use voidage::porosity::{Options, Porosity, porosity};

/// Nanoseconds per item of several ways to do the same work: the medians over rounds in which each has its turn, so that a machine that
/// slows down slows all of them.
pub fn compare(items: usize, rounds: usize, ways: &mut [&mut dyn FnMut() -> usize]) -> Vec<f64> {
    let mut times = vec![Vec::with_capacity(rounds); ways.len()];
    for _ in 0..rounds {
        for (way, times) in ways.iter_mut().zip(&mut times) {
            let start = Instant::now();
            black_box(way());
            times.push(start.elapsed().as_nanos() as f64 / items as f64);
        }
    }
    times.into_iter().map(median).collect()
}

/// Median seconds of porosity fields in a pool of threads (0: all of the machine), and the fields: of `runs` runs after one to warm up, of
/// three where that takes a second, of that one where it takes five.
pub fn porosity_seconds(
    bodies: &Bodies,
    edges: &Edges,
    threads: usize,
    runs: usize,
    options: Options,
) -> (f64, Porosity) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let grid = edges.grid(None).expect("a grid");
    let run = || {
        let begin = Instant::now();
        let result = porosity(&grid, bodies, options);
        (begin.elapsed().as_secs_f64(), result)
    };
    pool.install(|| {
        let (first, result) = run();
        match first {
            5.0.. => (first, result),
            1.0.. => (median((0..3).map(|_| run().0).collect()), result),
            _ => (median((0..runs).map(|_| run().0).collect()), result),
        }
    })
}

/// The word that asks for a single run, in which callgrind counts instructions.
const ONCE: &str = "once";

/// What the benchmark is asked for, options left out.
fn words() -> impl Iterator<Item = String> {
    std::env::args().skip(1).filter(|word| !word.starts_with('-'))
}

/// Whether each case is to run a single time.
pub fn once() -> bool {
    words().any(|word| word == ONCE)
}

/// Whether a case is asked for: its name holds all words that are asked for.
pub fn is_asked(name: &str) -> bool {
    words().all(|word| word == ONCE || name.split([' ', ',']).any(|of_name| of_name == word))
}

/// The middle of some times; NaN of none.
pub fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times.get(times.len() / 2).copied().unwrap_or(f64::NAN)
}
