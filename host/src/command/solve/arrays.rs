//! NPY arrays of cells and faces: shapes and values checked, errors with file and index.

use crate::error::{Error, Result};
use crate::files::npy;
use crate::words::written;
use std::path::Path;

/// Reads an array with one value for each cell or face of `shape`, x fastest. Axes of length 1 may be missing in the
/// file. `wrong` says what is the matter with a value, if anything.
///
/// # Errors
/// The file cannot be read, has another shape, or holds a value that is not finite or is `wrong`.
pub fn read(path: &Path, shape: [usize; 3], wrong: impl Fn(f64) -> Option<String>) -> Result<Vec<f64>> {
    let (found, values) = npy::read(path)?;
    let long = |shape: &[usize]| shape.iter().copied().filter(|&n| n != 1).collect::<Vec<_>>();
    if found.len() > 3 || long(&found) != long(&shape) {
        return Err(Error::at(path, "shape", format!("{found:?} does not fit the grid, which needs {shape:?}")));
    }
    let reason = |x: f64| if x.is_finite() { wrong(x) } else { Some("is not finite".to_owned()) };
    match values.iter().enumerate().find_map(|(n, &x)| Some((n, x, reason(x)?))) {
        None => Ok(values),
        Some((n, x, reason)) => {
            Err(Error::at(path, format!("{:?}", index(n, shape)), format!("{} {reason}", written(x))))
        }
    }
}

/// Indices along x, y, z of the `n`-th value, x fastest.
#[must_use]
pub fn index(n: usize, [nx, ny, _]: [usize; 3]) -> [usize; 3] {
    [n % nx, n / nx % ny, n / (nx * ny)]
}

/// Where the value with these indices along x, y, z stands, x fastest.
#[must_use]
pub fn position([i, j, k]: [usize; 3], [nx, ny, _]: [usize; 3]) -> usize {
    (k * ny + j) * nx + i
}

/// An open fraction.
#[must_use]
pub fn fraction(x: f64) -> Option<String> {
    // Geometry may leave rounding beyond the ends.
    (!(-1e-12..=1.0 + 1e-12).contains(&x)).then(|| "is not within 0..1".to_owned())
}
