//! Timing shared by the benchmarks.

use std::hint::black_box;
use std::time::Instant;

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

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times.get(times.len() / 2).copied().unwrap_or(f64::NAN)
}
