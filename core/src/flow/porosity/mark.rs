//! Which faces are walls or porosity jumps, and which cells small, sealed or cut by an inclined wall, found once from the open fractions.

use crate::flow::error::{Error, fits};
use crate::flow::porosity::flags::{INCLINED, SEALED, SMALL, break_high, break_low};
use crate::flow::porosity::fractions::{Medium, Mesh, Porosity, SMALL_SHARE, rounding};
use crate::number::real::Real;

/// Whether a fraction is above a limit by more than rounding.
fn exceeds<R: Real>(fraction: R, limit: R) -> bool {
    fraction > limit + rounding::<R>()
}

/// Whether a face is a jump: the ducts differ, or the face is narrower than both, by more than `threshold`; in narrow ducts,
/// where such a difference cannot occur, by more than three times that share of the wider one (a smooth duct that closes to a
/// point has large shares of small differences: those below a fifth of the threshold do not count).
fn is_jump<R: Real>(left: R, face: R, right: R, threshold: R) -> bool {
    let (least, most) = (R::smaller(left, right), R::larger(left, right));
    let difference = R::larger(most - least, least - face);
    let narrow = exceeds(difference, R::from_f64(3.0) * threshold * most) && is_wall(difference, threshold);
    exceeds(difference, threshold) || narrow
}

/// Whether a closed face is a wall to a cell as wide as this. The point to which a smooth duct closes is none.
fn is_wall<R: Real>(width: R, threshold: R) -> bool {
    exceeds(width, R::from_f64(0.2) * threshold)
}

/// Writes the marks of all cells: which faces are walls or jumps (differences of the open fraction above `threshold`; infinity
/// for no jumps), which cells are small, which are sealed, which an inclined wall cuts.
///
/// Both belong to ducts, layers and walls aligned with the grid, and to obstacles smaller than a cell. A face beside a cell that an
/// inclined wall cuts is neither, unless it is open and the wall does not change what is open along its axis: the area of such a cell's faces changes
/// though no duct does, and the stream runs along the wall, not against the closed face ([`cell_walls`](super::cell_walls)).
///
/// `marks` is one byte per cell.
///
/// # Errors
/// A slice does not fit the mesh.
pub(in crate::flow) fn mark<R: Real, const D: usize>(
    mesh: &Mesh<'_, R, D>,
    volume: &[R],
    faces: &[&[R]; D],
    periodic: [bool; D],
    threshold: R,
    marks: &mut [u8],
) -> Result<(), Error> {
    fits(mesh.len(), volume.len())?;
    fits(mesh.len(), marks.len())?;
    for d in 0..D {
        fits(mesh.faces(d), faces[d].len())?;
    }
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
                let closed = !(open > R::ZERO) && medium.mesh.beside(d, face, periodic[d]).iter().flatten().any(feels);
                let inclined = |c: &[usize; D]| medium.holds_wall_at_face(*c, d, open);
                let breaks = closed || is_jump(left, open, right, threshold);
                if breaks && !medium.mesh.beside(d, face, periodic[d]).iter().flatten().any(inclined) {
                    bits |= bit;
                }
            }
        }
        let widest = widest(at);
        if !(widest > R::ZERO) {
            bits |= SEALED;
        } else if volume[cell] < (R::from_f64(SMALL_SHARE) - rounding::<R>()) * widest {
            bits |= SMALL;
        } else if medium.holds_inclined_wall(at) {
            bits |= INCLINED;
        }
        marks[cell] = bits;
    }
    Ok(())
}
