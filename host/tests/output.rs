//! What is written, read back by other means: bytes of the formats, tiny parsers, decoders of other crates.

mod atomic;
mod npy;
mod pictures;
mod report;
mod vtr;

use std::fs;
use std::path::PathBuf;

/// A directory of its own for each test, empty at the start, removed at the end.
struct Dir(PathBuf);

impl Dir {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("voidage-output-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).expect("temporary directory");
        Dir(path)
    }

    fn file(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.0).expect("readable");
        let mut names: Vec<_> = entries.map(|e| e.expect("entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }
}

impl Drop for Dir {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Numbers in 0..1, most of them exactly 1, as porosity is; the same for the same seed.
fn porosity(n: usize, seed: u64) -> Vec<f64> {
    let mut state = seed;
    (0..n)
        .map(|_| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let u = (state >> 11) as f64 / (1u64 << 53) as f64;
            if u < 0.7 { 1.0 } else { u }
        })
        .collect()
}

fn bits(data: &[f64]) -> Vec<u64> {
    data.iter().map(|v| v.to_bits()).collect()
}

fn uniform(n: usize) -> Vec<f64> {
    (0..=n).map(|i| i as f64).collect()
}

/// All indices of an array of four axes, the first one fastest.
fn indices(a: usize, b: usize, c: usize, d: usize) -> impl Iterator<Item = (usize, usize, usize, usize)> {
    (0..a * b * c * d).map(move |n| (n % a, n / a % b, n / (a * b) % c, n / (a * b * c)))
}
