//! The porous space: open fractions of cells and faces as the caller's slices, and one byte of marks per cell.
//!
//! Works on the live axes only: a plane flow has two axes, whichever they are.

use crate::flow::error::Error;
use crate::number::real::Real;

/// Cells per live axis and their widths; axis 0 runs fastest.
#[derive(Clone, Copy, Debug)]
pub struct Mesh<'a, R, const D: usize> {
    pub(in crate::flow) widths: [&'a [R]; D],
}

impl<'a, R: Real, const D: usize> Mesh<'a, R, D> {
    /// Cells of the given widths along each axis; their number is the number of cells.
    ///
    /// # Errors
    /// A width is not positive and finite, or there are more faces than a `usize` can count.
    pub fn new(widths: [&'a [R]; D]) -> Result<Self, Error> {
        const { assert!(D > 0 && D < 4, "a mesh has one, two or three axes") }
        for (axis, widths) in widths.iter().enumerate() {
            if let Some(cell) = widths.iter().position(|&w| !(w > R::ZERO && w.is_finite())) {
                return Err(Error::Width { axis, cell });
            }
        }
        let faces = widths.iter().try_fold(1usize, |n, w| n.checked_mul(w.len() + 1));
        if faces.is_none() {
            return Err(Error::TooManyCells);
        }
        Ok(Mesh { widths })
    }

    /// Widths of the cells along each axis.
    pub const fn widths(&self) -> [&'a [R]; D] {
        self.widths
    }
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
        self.cells()[..D.saturating_sub(1)].iter().product()
    }

    /// Indices of a cell along each axis; of a mesh without cells they mean nothing.
    pub fn coordinates(&self, mut cell: usize) -> [usize; D] {
        self.cells().map(|n| {
            let n = n.max(1);
            let i = cell % n;
            cell /= n;
            i
        })
    }

    /// Flat index of a cell.
    #[inline(always)]
    pub fn index(&self, at: [usize; D]) -> usize {
        let n = self.cells();
        (0..D).rev().fold(0usize, |i, a| i.wrapping_mul(n[a]).wrapping_add(at[a]))
    }

    /// Flat index of the low face of a cell along axis `d`; the high face is [`Mesh::face_stride`] further.
    #[inline(always)]
    pub fn face(&self, d: usize, at: [usize; D]) -> usize {
        let n = self.cells();
        (0..D).rev().fold(0usize, |i, a| i.wrapping_mul(n[a] + usize::from(a == d)).wrapping_add(at[a]))
    }

    /// Distance between the two faces of a cell along axis `d`.
    #[inline(always)]
    pub fn face_stride(&self, d: usize) -> usize {
        (0..D).filter(|&a| a < d).fold(1, |s, a| s * self.widths[a].len())
    }

    /// Flat indices of the low and high face of a cell along axis `d`.
    #[inline(always)]
    pub fn faces_of(&self, d: usize, at: [usize; D]) -> [usize; 2] {
        let low = self.face(d, at);
        [low, low.wrapping_add(self.face_stride(d))]
    }

    /// The cells below and above the low face of `at` along `d`, where `at[d]` may be one past the end.
    pub(in crate::flow) fn beside(&self, d: usize, at: [usize; D], periodic: bool) -> [Option<[usize; D]>; 2] {
        let n = self.cells()[d];
        let cell = |k: usize| {
            let mut c = at;
            c[d] = k;
            c
        };
        let around = |k: usize| periodic.then(|| cell(k));
        let (i, above) = (at[d], at[d] < n);
        [if i > 0 { Some(cell(i - 1)) } else { around(n - 1) }, if above { Some(cell(i)) } else { around(0) }]
    }

    /// Whether something holds for a cell and all those around it, corners included.
    pub(in crate::flow) fn around(
        &self,
        at: [usize; D],
        periodic: [bool; D],
        holds: impl Fn([usize; D]) -> bool,
    ) -> bool {
        (0..3usize.pow(D as u32)).all(|mut step| {
            let mut cell = at;
            for (d, place) in cell.iter_mut().enumerate() {
                let n = self.widths[d].len();
                *place = match step % 3 {
                    0 => *place,
                    1 if *place + 1 < n => *place + 1,
                    1 if periodic[d] => 0,
                    2 if *place > 0 => *place - 1,
                    2 if periodic[d] => n - 1,
                    _ => return true,
                };
                step /= 3;
            }
            holds(cell)
        })
    }

    /// Volume of a cell, its obstacles included; length or area in fewer dimensions; 0 outside the mesh.
    pub fn volume(&self, at: [usize; D]) -> R {
        let mut v = R::ONE;
        for a in 0..D {
            v *= self.widths[a].get(at[a]).copied().unwrap_or(R::ZERO);
        }
        v
    }
}

/// Open fractions: of cell volumes, and of the faces normal to each axis (one longer along their own axis).
#[derive(Clone, Copy, Debug)]
pub(in crate::flow) struct Porosity<'a, R, const D: usize> {
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

/// Open fractions that differ by less differ by rounding: geometry meets limits that are round numbers, and what its last bits say must not count.
pub(in crate::flow) fn rounding<R: Real>() -> R {
    R::larger(R::from_f64(1e-9), R::from_f64(16.0) * R::EPSILON)
}

/// The least volume a cell is counted with. Its change is its flux over this volume: huge, and undone by the averaging.
pub(in crate::flow) fn least_volume<R: Real>() -> R {
    R::EPSILON * R::EPSILON
}

/// Porosity as the kernel asks for it at single cells and faces.
#[derive(Clone, Copy, Debug)]
pub(in crate::flow) struct Medium<'a, R, const D: usize> {
    pub mesh: Mesh<'a, R, D>,
    pub porosity: Porosity<'a, R, D>,
    /// Axes whose ends are one place.
    pub periodic: [bool; D],
}
