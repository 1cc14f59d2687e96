//! Where the values of an array come from: a slice, or three slices interleaved while writing.

use crate::files::bytes::encode;

/// Values in a block. A multiple of 3, so that blocks hold whole vectors; 192 KiB, six windows of deflate.
pub(super) const BLOCK: usize = 3 * 8192;

pub(super) enum ArraySource<'a> {
    Values(&'a [f64]),
    Interleaved { cells: [usize; 3], parts: [Part<'a>; 3] },
}

/// One component: a value for each cell, in rows and planes that may be longer than those of the cells.
pub(super) struct Part<'a> {
    data: &'a [f64],
    row: usize,
    plane: usize,
}

impl<'a> ArraySource<'a> {
    /// None if a length does not fit.
    pub(super) fn vector(parts: [&'a [f64]; 3], cells: [usize; 3]) -> Option<Self> {
        Self::interleaved(parts, cells, [cells; 3])
    }

    /// None if a length does not fit.
    pub(super) fn low_faces(faces: [&'a [f64]; 3], cells: [usize; 3]) -> Option<Self> {
        let [nx, ny, nz] = cells;
        Self::interleaved(faces, cells, [[nx + 1, ny, nz], [nx, ny + 1, nz], [nx, ny, nz + 1]])
    }

    fn interleaved(data: [&'a [f64]; 3], cells: [usize; 3], shapes: [[usize; 3]; 3]) -> Option<Self> {
        let fits = data.iter().zip(&shapes).all(|(d, s)| d.len() == s.iter().product::<usize>());
        let part = |c: usize| Part { data: data[c], row: shapes[c][0], plane: shapes[c][0] * shapes[c][1] };
        fits.then(|| ArraySource::Interleaved { cells, parts: [part(0), part(1), part(2)] })
    }

    /// Number of values.
    pub(super) fn len(&self) -> usize {
        match self {
            ArraySource::Values(data) => data.len(),
            ArraySource::Interleaved { cells, .. } => 3 * cells.iter().product::<usize>(),
        }
    }

    /// Fills `bytes` with the values from `first` on; for vectors both are whole tuples.
    pub(super) fn encode(&self, first: usize, bytes: &mut [u8]) {
        match self {
            ArraySource::Values(data) => encode(&data[first..first + bytes.len() / 8], bytes),
            ArraySource::Interleaved { cells, parts } => interleave(*cells, parts, first / 3, bytes),
        }
    }
}

/// Row by row, since only within a row the three parts advance alike.
fn interleave([nx, ny, _]: [usize; 3], parts: &[Part; 3], mut cell: usize, mut bytes: &mut [u8]) {
    while !bytes.is_empty() {
        let (i, j, k) = (cell % nx, cell / nx % ny, cell / (nx * ny));
        let n = (nx - i).min(bytes.len() / 24);
        let (run, rest) = bytes.split_at_mut(24 * n);
        for (c, part) in parts.iter().enumerate() {
            let start = k * part.plane + j * part.row + i;
            for (to, value) in run.chunks_exact_mut(24).zip(&part.data[start..start + n]) {
                to[8 * c..8 * c + 8].copy_from_slice(&value.to_le_bytes());
            }
        }
        cell += n;
        bytes = rest;
    }
}
