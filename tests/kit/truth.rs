//! Ground truth: solid fractions from independent exact methods, and the rules of comparison.
//!
//! A set is an NPZ archive with edges `x`, `y`, `z`, solid fractions `vol`, `ax`, `ay`, `az` (NaN where solid lies in
//! the plane of a face) and for the latter `amb_?_idx`, `amb_?_below`, `amb_?_above`.

use crate::unzip::members;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use voidage::grid::Edges;
use voidage::porosity::FieldSet;

/// An array: shape, and values in C order.
#[derive(Debug, Clone)]
struct Array {
    shape: Vec<usize>,
    values: Vec<f64>,
}

/// A ground truth set.
#[derive(Debug)]
pub struct Truth(BTreeMap<String, Array>);

/// The worst differences from the truth.
#[derive(Debug, Clone, Copy, Default)]
pub struct Difference {
    /// Of cells.
    pub cell: f64,
    /// Of faces that have one value.
    pub face: f64,
    /// How far faces in the plane of a wall leave what their two sides allow.
    pub wall: f64,
}

impl Difference {
    /// The largest of all.
    #[must_use]
    pub fn worst(&self) -> f64 {
        self.cell.max(self.face).max(self.wall)
    }
}

impl Truth {
    /// Read a set.
    ///
    /// # Panics
    /// If it is not as described above.
    #[must_use]
    pub fn read(path: &Path) -> Self {
        let bytes = std::fs::read(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let arrays =
            members(&bytes).into_iter().map(|(name, npy)| (name.trim_end_matches(".npy").to_owned(), array(&npy)));
        Truth(arrays.collect())
    }

    /// The grid.
    #[must_use]
    pub fn edges(&self) -> Edges {
        Edges(["x", "y", "z"].map(|a| self.0[a].values.clone()))
    }

    /// Compare open fractions with the set.
    #[must_use]
    pub fn compare(&self, beta: &FieldSet) -> Difference {
        let mut d = Difference { cell: largest(&self.0["vol"], &beta.v), ..Difference::default() };
        for (axis, field) in [("x", &beta.x), ("y", &beta.y), ("z", &beta.z)] {
            let truth = &self.0[&format!("a{axis}")];
            d.face = d.face.max(largest(truth, field));
            let [idx, below, above] = ["idx", "below", "above"].map(|n| &self.0[&format!("amb_{axis}_{n}")]);
            for (n, (&b, &c)) in below.values.iter().zip(&above.values).enumerate() {
                let place = [0, 1, 2].map(|a| idx.values[3 * n + a] as usize);
                let solid = 1.0 - field[(place[2] * truth.shape[1] + place[1]) * truth.shape[0] + place[0]];
                d.wall = d.wall.max((b + c - 1.0).max(0.0) - solid).max(solid - (b + c).min(1.0));
            }
        }
        d
    }
}

/// Largest difference of solid fractions `truth[i,j,k]` (C order; NaN agrees with all) from open ones, x fastest.
fn largest(truth: &Array, beta: &[f64]) -> f64 {
    let [nx, ny, nz] = [truth.shape[0], truth.shape[1], truth.shape[2]];
    assert_eq!(beta.len(), nx * ny * nz);
    let mut worst = 0.0_f64;
    for (n, solid) in truth.values.iter().enumerate().filter(|(_, s)| !s.is_nan()) {
        let (i, j, k) = (n / nz / ny, n / nz % ny, n % nz);
        let d = (1.0 - beta[(k * ny + j) * nx + i] - solid).abs();
        worst = if d <= worst { worst } else { d };
    }
    worst
}

/// Parse NPY 1.0: `<f8` or an integer type.
fn array(bytes: &[u8]) -> Array {
    let length = usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let header = std::str::from_utf8(&bytes[10..10 + length]).expect("ASCII header");
    let fortran = header.contains("'fortran_order': True");
    let shape = header.split('(').nth(1).and_then(|s| s.split(')').next()).expect("a shape");
    let shape: Vec<usize> = shape.split(',').filter_map(|n| n.trim().parse().ok()).collect();
    let data = &bytes[10 + length..];
    let eight = |c: &[u8]| <[u8; 8]>::try_from(c).expect("eight bytes");
    let four = |c: &[u8]| <[u8; 4]>::try_from(c).expect("four bytes");
    let values: Vec<f64> = if header.contains("'<f8'") {
        data.chunks_exact(8).map(|c| f64::from_le_bytes(eight(c))).collect()
    } else if header.contains("'<i8'") {
        data.chunks_exact(8).map(|c| i64::from_le_bytes(eight(c)) as f64).collect()
    } else if header.contains("'<i4'") {
        data.chunks_exact(4).map(|c| f64::from(i32::from_le_bytes(four(c)))).collect()
    } else {
        panic!("not read here: {header}")
    };
    let values = if fortran { to_c_order(&shape, &values) } else { values };
    Array { shape, values }
}

/// First index fastest to last index fastest.
fn to_c_order(shape: &[usize], values: &[f64]) -> Vec<f64> {
    let mut out = Vec::with_capacity(values.len());
    for n in 0..values.len() {
        let (mut rest, mut at, mut stride) = (n, 0, values.len());
        for &extent in shape.iter().rev() {
            stride /= extent;
            at += rest % extent * stride;
            rest /= extent;
        }
        out.push(values[at]);
    }
    out
}

/// A file or directory of the data that is shared between projects and not part of the repository. Where it is absent, what needs it is
/// skipped with a line that says so.
///
/// # Panics
/// If it is absent under `CI=true`: there it stands beside the repository.
#[must_use]
pub fn shared(name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared").join(name);
    if path.exists() {
        return Some(path);
    }
    assert!(std::env::var("CI").as_deref() != Ok("true"), "../shared/{name} is absent");
    println!("SKIPPED: no ../shared/{name} beside the repository; what needs it was not run");
    None
}

/// A file that ships with the tests.
#[must_use]
pub fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures").join(name)
}
