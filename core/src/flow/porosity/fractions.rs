//! The porous space: open fractions of cells and faces as the caller's slices, and one byte of marks per cell.
//!
//! Works on the live axes only: a plane flow has two axes, whichever they are.

use crate::number::real::Real;

/// Cells per live axis and their widths; axis 0 runs fastest.
#[derive(Clone, Copy, Debug)]
pub struct Mesh<'a, R, const D: usize> {
    /// Cell widths along each axis; their number is the number of cells.
    pub widths: [&'a [R]; D],
}

impl<R: Real, const D: usize> Mesh<'_, R, D> {
    /// Cells along each axis.
    #[inline(always)]
    pub fn cells(&self) -> [usize; D] {
        self.widths.map(<[R]>::len)
    }

    /// Cells in all.
    pub fn len(&self) -> usize {
        self.cells().iter().product()
    }

    /// No cell at all.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Faces normal to axis `d`.
    pub fn faces(&self, d: usize) -> usize {
        let n = self.cells();
        (0..D).map(|a| if a == d { n[a] + 1 } else { n[a] }).product()
    }

    /// Cells of one layer: those that share an index of the last axis. Slabs for threads are whole layers.
    pub fn layer(&self) -> usize {
        self.cells()[..D - 1].iter().product()
    }

    /// Indices of a cell along each axis.
    pub fn coordinates(&self, mut cell: usize) -> [usize; D] {
        self.cells().map(|n| {
            let i = cell % n;
            cell /= n;
            i
        })
    }

    /// Flat index of a cell.
    #[inline(always)]
    pub fn index(&self, at: [usize; D]) -> usize {
        let n = self.cells();
        (0..D).rev().fold(0, |i, a| i * n[a] + at[a])
    }

    /// Flat index of the low face of a cell along axis `d`; the high face is [`Mesh::face_stride`] further.
    #[inline(always)]
    pub fn face(&self, d: usize, at: [usize; D]) -> usize {
        let n = self.cells();
        (0..D).rev().fold(0, |i, a| i * (n[a] + usize::from(a == d)) + at[a])
    }

    /// Distance between the two faces of a cell along axis `d`.
    #[inline(always)]
    pub fn face_stride(&self, d: usize) -> usize {
        (0..D).filter(|&a| a < d).fold(1, |s, a| s * self.widths[a].len())
    }

    /// Volume of a cell, its obstacles included; length or area in fewer dimensions.
    pub fn volume(&self, at: [usize; D]) -> R {
        let mut v = R::ONE;
        for a in 0..D {
            v *= self.widths[a][at[a]];
        }
        v
    }
}

/// Open fractions: of cell volumes, and of the faces normal to each axis (one longer along their own axis).
#[derive(Clone, Copy, Debug)]
pub struct Porosity<'a, R, const D: usize> {
    /// `beta_v`.
    pub volume: &'a [R],
    /// `beta_x`, `beta_y`, `beta_z` of the live axes.
    pub faces: [&'a [R]; D],
    /// One byte of marks per cell, written by [`mark`](super::mark::mark).
    pub marks: &'a [u8],
}

/// A cell counts as small below this share of its largest open face: the share that merging restores, and so the factor
/// (its inverse) by which the stable time step may shrink. A little less than the share 1/3 of the first cell of a ball (a duct
/// whose area goes with r²), which needs no neighbour.
pub const SMALL_SHARE: f64 = 0.33;

/// Porosity as the kernel asks for it at single cells and faces.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Medium<'a, R, const D: usize> {
    pub mesh: Mesh<'a, R, D>,
    pub porosity: Porosity<'a, R, D>,
}

impl<R: Real, const D: usize> Medium<'_, R, D> {
    /// The cells below and above the low face of `at` along `d`, where `at[d]` may be one past the end.
    pub fn beside(&self, d: usize, at: [usize; D], periodic: bool) -> [Option<[usize; D]>; 2] {
        let n = self.mesh.cells()[d];
        let cell = |k: usize| {
            let mut c = at;
            c[d] = k;
            c
        };
        let around = |k: usize| periodic.then(|| cell(k));
        let (i, above) = (at[d], at[d] < n);
        [if i > 0 { Some(cell(i - 1)) } else { around(n - 1) }, if above { Some(cell(i)) } else { around(0) }]
    }
}
