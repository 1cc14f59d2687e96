//! Which faces are walls or porosity jumps, and which cells small, sealed or cut by an inclined wall, found once from the open fractions.

use crate::flow::error::{Error, fits};
use crate::flow::porosity::areas::{Ducts, IN_NARROW, LEAST, gentleness};
use crate::flow::porosity::flags::{BORDER, INCLINED, SMALL, break_high, break_low};
use crate::flow::porosity::fractions::{Medium, Mesh, Porosity, SMALL_SHARE, rounding};
use crate::number::real::Real;

/// Whether a fraction is above a limit by more than rounding.
fn exceeds<R: Real>(fraction: R, limit: R) -> bool {
    fraction > limit + rounding::<R>()
}

/// Whether a face is a jump: the ducts differ, or the face is narrower than both, by more than `threshold`; in narrow ducts,
/// where such a difference cannot occur, by more than three times that share of the wider one (a smooth duct that closes to a
/// point has large shares of small differences: those below a fifth of the threshold do not count).
fn is_jump<R: Real>([left, right]: [R; 2], face: R, threshold: R) -> bool {
    let (least, most) = (R::smaller(left, right), R::larger(left, right));
    let difference = R::larger(most - least, least - face);
    let narrow = exceeds(difference, R::from_f64(IN_NARROW) * threshold * most) && is_wall(difference, threshold);
    exceeds(difference, threshold) || narrow
}

/// Whether the low or high face of a cell is an open one and a jump by itself.
fn jumps_suddenly<R: Real>(own: &Ducts<'_, R>, high: bool, threshold: R) -> bool {
    let (open, (left, right)) = (own.opening(0, high), own.beside(0, high));
    open > R::ZERO && is_jump([left, right], open, threshold)
}

/// Where the duct narrows over many cells, what it does at each face counts from this share of the threshold on.
const GRADUAL: f64 = 0.01;

/// Whether the low or high face of a cell is an open one and a jump, alone or with others of a duct that narrows over many cells.
fn jumps_at<R: Real>(own: &Ducts<'_, R>, high: bool, threshold: R) -> bool {
    let (open, (left, right)) = (own.opening(0, high), own.beside(0, high));
    let ends = [left, right];
    let differ = |threshold: R| move |ends: [R; 2]| is_jump(ends, R::smaller(ends[0], ends[1]), threshold);
    let changes = differ(R::from_f64(GRADUAL) * threshold);
    let gradual = || {
        changes(ends)
            && gentleness(ends, open) > R::ZERO
            && own.narrows_through((0, high), ends, changes, differ(threshold))
    };
    open > R::ZERO && (is_jump(ends, open, threshold) || gradual())
}

/// Whether a closed face is a wall to a cell as wide as this. The point to which a smooth duct closes is none.
fn is_wall<R: Real>(width: R, threshold: R) -> bool {
    exceeds(width, R::from_f64(LEAST) * threshold)
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
    let porosity = Porosity { volume, faces: *faces, marks: &[] };
    let medium = Medium { mesh: *mesh, porosity, periodic };
    mark_borders(&medium, threshold, marks);
    for cell in 0..marks.len() {
        // Of other cells it is asked only whether a border crosses them, at faces that are open.
        let medium = Medium { porosity: Porosity { marks, ..porosity }, ..medium };
        let at = mesh.coordinates(cell);
        let bits = breaks_of(&medium, threshold, at) | kind_of(&medium, at);
        marks[cell] |= bits;
    }
    Ok(())
}

/// Marks the cells that a border askew to the grid crosses, where the porosity jumps suddenly at one of their faces or at one of a cell beside: the stationary wave of a border
/// acts at all faces of a cell or at none.
fn mark_borders<R: Real, const D: usize>(medium: &Medium<'_, R, D>, threshold: R, marks: &mut [u8]) {
    // Until all are known: a cell at a border without a jump of its own, and one beside a cell that has one.
    const ALONE: u8 = INCLINED;
    const BESIDE: u8 = SMALL;
    let mesh = &medium.mesh;
    for (cell, mark) in marks.iter_mut().enumerate() {
        let at = mesh.coordinates(cell);
        let jumps =
            |d: usize| [false, true].into_iter().any(|high| jumps_suddenly(&medium.ducts(d, at), high, threshold));
        *mark = match medium.holds_border(at) {
            true if (0..D).any(jumps) => BORDER,
            true => ALONE,
            false => 0,
        };
    }
    for cell in 0..marks.len() {
        if marks[cell] == ALONE {
            let at = mesh.coordinates(cell);
            let beside = |d: usize, high: bool| {
                let mut face = at;
                face[d] += usize::from(high);
                mesh.beside(d, face, medium.periodic[d]).into_iter().flatten()
            };
            let mut around = (0..D).flat_map(|d| beside(d, false).chain(beside(d, true)));
            if around.any(|c| marks[mesh.index(c)] == BORDER) {
                marks[cell] = BESIDE;
            }
        }
    }
    for mark in marks {
        *mark = if matches!(*mark, BORDER | BESIDE) { BORDER } else { 0 };
    }
}

/// Marks of the faces of a cell at which the open space breaks.
fn breaks_of<R: Real, const D: usize>(medium: &Medium<'_, R, D>, threshold: R, at: [usize; D]) -> u8 {
    let mut bits = 0;
    for d in 0..D {
        let own = medium.ducts(d, at);
        let (low, high) = own.openings(0);
        let mut above = at;
        above[d] += 1;
        for (face, open, bit) in [(at, low, break_low(d)), (above, high, break_high(d))] {
            let cells = medium.mesh.beside(d, face, medium.periodic[d]);
            let feels =
                |c: &[usize; D]| medium.widest(*c) > R::ZERO && is_wall(medium.ducts(d, *c).width(0), threshold);
            let inclined = |c: &[usize; D]| medium.holds_wall_at_face(*c, d, open);
            let on_border =
                || cells.iter().all(Option::is_some) && cells.iter().flatten().any(|c| medium.on_border(*c));
            let breaks = if open > R::ZERO {
                jumps_at(&own, bit == break_high(d), threshold) || on_border()
            } else {
                cells.iter().flatten().any(feels)
            };
            if breaks && !cells.iter().flatten().any(inclined) {
                bits |= bit;
            }
        }
    }
    bits
}

/// The kind of a cell, if it is not marked as one at a border.
fn kind_of<R: Real, const D: usize>(medium: &Medium<'_, R, D>, at: [usize; D]) -> u8 {
    let (widest, volume) = (medium.widest(at), medium.open_volume(at));
    if !(widest > R::ZERO) {
        BORDER
    } else if medium.on_border(at) {
        0
    } else if volume < (R::from_f64(SMALL_SHARE) - rounding::<R>()) * widest {
        SMALL
    } else if medium.holds_inclined_wall(at) {
        INCLINED
    } else {
        0
    }
}
