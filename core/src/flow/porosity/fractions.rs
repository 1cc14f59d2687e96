//! The porous space: open fractions of cells and faces as the caller's slices, and one byte of marks per cell.
//!
//! Works on the live axes only: a plane flow has two axes, whichever they are.

use crate::flow::porosity::flags::{SEALED, SMALL, break_high, break_low};
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
    /// One byte of marks per cell, written by [`mark`].
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

/// Whether a face is a jump: the ducts differ, or the face is narrower than both, by more than `threshold`; in narrow ducts,
/// where such a difference cannot occur, by more than three times that share of the wider one (a smooth duct that closes to a
/// point has large shares of small differences: those below a fifth of the threshold do not count).
fn is_jump<R: Real>(left: R, face: R, right: R, threshold: R) -> bool {
    let (least, most) = (R::smaller(left, right), R::larger(left, right));
    let difference = R::larger(most - least, least - face);
    let narrow = difference > R::from_f64(3.0) * threshold * most && is_wall(difference, threshold);
    difference > threshold || narrow
}

/// Whether a closed face is a wall to a cell as wide as this. The point to which a smooth duct closes is none.
fn is_wall<R: Real>(width: R, threshold: R) -> bool {
    width > R::from_f64(0.2) * threshold
}

/// Open fractions of a cell's two faces along an axis that differ by no more than this differ by rounding: of the geometry, of
/// fractions stored in single precision, or of the scalar. A wall so little inclined that it differs no more counts as aligned
/// with the grid, at an error of about this share over the Mach number in units of the dynamic pressure.
fn rounding<R: Real>() -> R {
    R::larger(R::from_f64(1e-6), R::from_f64(16.0) * R::EPSILON)
}

impl<R: Real, const D: usize> Medium<'_, R, D> {
    /// Whether the wall inside a cell is inclined to the grid.
    ///
    /// The high open face less the low one, axis by axis, is the area vector of that wall (Gauss). A duct that changes its area
    /// has one component, along itself; a wall that cuts through the cell at an angle has more. A cell with all its volume open
    /// holds no wall: what closes its faces lies in their planes.
    fn holds_inclined_wall(&self, at: [usize; D], periodic: [bool; D]) -> bool {
        let least = rounding::<R>();
        if self.porosity.volume[self.mesh.index(at)] >= R::ONE - least {
            return false;
        }
        let differs = |&d: &usize| {
            let (low, high) = self.ducts(d, at, periodic[d]).openings(0);
            (high - low).abs() > least
        };
        (0..D).filter(differs).count() > 1
    }
}

/// Writes the marks of all cells: which faces are walls or jumps (differences of the open fraction above `threshold`; infinity
/// for no jumps), which cells are small, which are sealed.
///
/// Both belong to ducts, layers and walls aligned with the grid. A face beside a cell that an inclined wall cuts is neither: the
/// area of such a cell's faces changes though no duct does, and the stream runs along the wall, not against the closed face. There
/// the geometric form is exact for a uniform stream.
///
/// The slices must have the lengths of the mesh; `marks` one byte per cell.
pub fn mark<R: Real, const D: usize>(
    mesh: &Mesh<'_, R, D>,
    volume: &[R],
    faces: &[&[R]; D],
    periodic: [bool; D],
    threshold: R,
    marks: &mut [u8],
) {
    let medium = Medium { mesh: *mesh, porosity: Porosity { volume, faces: *faces, marks: &[] } };
    let ducts = |d: usize, at: [usize; D]| medium.ducts(d, at, periodic[d]);
    let widest = |at: [usize; D]| (0..D).fold(R::ZERO, |w, d| R::larger(w, ducts(d, at).duct(0)));
    for cell in 0..marks.len() {
        let at = mesh.coordinates(cell);
        let mut bits = 0;
        for d in 0..D {
            let own = ducts(d, at);
            let (low, high) = own.openings(0);
            let mut above = at;
            above[d] += 1;
            for (face, open, bit) in [(at, low, break_low(d)), (above, high, break_high(d))] {
                let (left, right) = own.beside(0, bit == break_high(d));
                let feels = |c: &[usize; D]| widest(*c) > R::ZERO && is_wall(ducts(d, *c).width(0), threshold);
                let closed = !(open > R::ZERO) && medium.beside(d, face, periodic[d]).iter().flatten().any(feels);
                let inclined = |c: &[usize; D]| medium.holds_inclined_wall(*c, periodic);
                let breaks = closed || is_jump(left, open, right, threshold);
                if breaks && !medium.beside(d, face, periodic[d]).iter().flatten().any(inclined) {
                    bits |= bit;
                }
            }
        }
        let widest = widest(at);
        if !(widest > R::ZERO) {
            bits |= SEALED;
        } else if volume[cell] < R::from_f64(SMALL_SHARE) * widest {
            bits |= SMALL;
        }
        marks[cell] = bits;
    }
}
