//! NumPy's array files.
//!
//! Format: a magic string, a version, the length of a header, the header (a Python dictionary in ASCII, padded so that
//! the data start at a multiple of 64 bytes), the data. See `numpy/lib/format.py`.
//! Written: version 1.0, `<f8`, Fortran order, three dimensions, so that `np.load(f)[i, j, k]` is the cell `(i, j, k)`.

mod read;

use std::io::{self, Write};
use std::path::Path;

use super::atomically;
use super::bytes::write_f64;
use crate::error::{Error, Result};

pub use read::read;

pub(super) const MAGIC: &[u8; 6] = b"\x93NUMPY";

/// Writes an array, x fastest.
///
/// # Errors
/// `data` is not as long as `shape` says, or as [`atomically`].
pub fn write(path: &Path, shape: [usize; 3], data: &[f64]) -> Result<()> {
    let [nx, ny, nz] = shape;
    if nx.checked_mul(ny).and_then(|n| n.checked_mul(nz)) != Some(data.len()) {
        return Err(Error::file(path, format!("{} values do not fill {nx} x {ny} x {nz}", data.len())));
    }
    atomically(path, |out| write_to(out, shape, data))
}

/// The bytes of [`write()`], to any writer; `data` is written whatever its length.
///
/// # Errors
/// Those of `out`.
pub fn write_to(out: &mut dyn Write, shape: [usize; 3], data: &[f64]) -> io::Result<()> {
    out.write_all(&header(shape))?;
    write_f64(out, data)
}

fn header([nx, ny, nz]: [usize; 3]) -> Vec<u8> {
    let mut dictionary = format!("{{'descr': '<f8', 'fortran_order': True, 'shape': ({nx}, {ny}, {nz}), }}");
    let before = MAGIC.len() + 4; // version and length
    let total = (before + dictionary.len() + 1).next_multiple_of(64);
    dictionary += &" ".repeat(total - before - dictionary.len() - 1);
    dictionary.push('\n');
    let length = (dictionary.len() as u16).to_le_bytes(); // three 20-digit numbers at most: under 192 bytes
    [&MAGIC[..], &[1, 0], &length[..], dictionary.as_bytes()].concat()
}
