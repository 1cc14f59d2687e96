//! NumPy's array files.
//!
//! Format: a magic string, a version, the length of a header, the header (a Python dictionary in ASCII, padded so that
//! the data start at a multiple of 64 bytes), the data. See `numpy/lib/format.py`.
//! Written: version 1.0, `<f8`, Fortran order, three dimensions, so that `np.load(f)[i, j, k]` is the cell `(i, j, k)`.

mod read;

use std::fs;
use std::io::{self, Write};
use std::path::Path;

use super::bytes::write_f64;
use super::{atomically, together};
use crate::error::{Error, Result};
use crate::grid::Edges;

pub use read::read;

pub(super) const MAGIC: &[u8; 6] = b"\x93NUMPY";

/// Writes an array, x fastest.
///
/// # Errors
/// `data` is not as long as `shape` says, or as [`atomically`].
pub fn write(path: &Path, shape: [usize; 3], data: &[f64]) -> Result<()> {
    check(path, shape, data)?;
    atomically(path, |out| write_to(out, shape, data))
}

/// Name of the grid file that [`write_fields`] puts beside arrays.
pub const EDGES: &str = "edges.json";

/// Arrays that belong together: name, shape, values.
pub type Named<'a> = (String, [usize; 3], &'a [f64]);

/// Writes arrays that belong together into a directory: `NAME.npy` for each, all or none.
///
/// # Errors
/// The directory cannot be made, or as [`write()`].
pub fn write_all(directory: &Path, arrays: &[Named]) -> Result<()> {
    write_into(directory, arrays, None)
}

/// [`write_all()`] of fields of one grid, with its edges in [`EDGES`]: arrays alone do not say how large their cells are.
///
/// # Errors
/// As [`write_all()`].
pub fn write_fields(directory: &Path, edges: &Edges, arrays: &[Named]) -> Result<()> {
    write_into(directory, arrays, Some(edges))
}

fn write_into(directory: &Path, arrays: &[Named], edges: Option<&Edges>) -> Result<()> {
    let mut paths: Vec<_> = arrays.iter().map(|(name, ..)| directory.join(format!("{name}.npy"))).collect();
    paths.iter().zip(arrays).try_for_each(|(path, &(_, shape, data))| check(path, shape, data))?;
    let edges = edges.map(|edges| {
        paths.push(directory.join(EDGES));
        edges.to_json()
    });
    let new = !directory.exists();
    fs::create_dir_all(directory).map_err(|e| Error::io(directory, "create the directory", &e))?;
    let write = |n: usize, out: &mut dyn Write| match arrays.get(n) {
        Some(&(_, shape, data)) => write_to(out, shape, data),
        None => out.write_all(edges.as_deref().unwrap_or_default().as_bytes()),
    };
    together(&paths, write).inspect_err(|_| {
        if new {
            let _ = fs::remove_dir(directory); // it stays if somebody else has put something there
        }
    })
}

fn check(path: &Path, [nx, ny, nz]: [usize; 3], data: &[f64]) -> Result<()> {
    if nx.checked_mul(ny).and_then(|n| n.checked_mul(nz)) == Some(data.len()) {
        return Ok(());
    }
    Err(Error::file(path, format!("{} values do not fill {nx} x {ny} x {nz}", data.len())))
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
