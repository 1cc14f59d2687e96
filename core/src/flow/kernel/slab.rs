//! A slab of layers in one step: the problem, the old field, the sizes, and where each row stands in the window.

use crate::flow::face_gas::FaceGas;
use crate::flow::kernel::scratch::{ROWS_BESIDE, Sizes};
use crate::flow::kernel::solver_calls::SolverCalls;
use crate::flow::porosity::cell_walls::Border;
use crate::flow::porosity::fractions::Medium;
use crate::flow::porosity::throat::ThroatGas;
use crate::flow::problem::Problem;
use crate::flow::state::{Fields, Gas, rotate};
use crate::flow::wall_forces::CellPush;
use crate::number::real::Real;
use core::cell::Cell;
use core::ops::Range;

/// A row of cells inside the domain.
#[derive(Clone, Copy)]
pub(in crate::flow) struct RowAt<const D: usize> {
    /// Flat index of its first cell.
    pub start: usize,
    /// Indices of its first cell.
    pub at: [usize; D],
}

/// Row of the window: layer and row.
pub(in crate::flow) type Place = (isize, isize);

/// Where a row inside the domain stands.
pub(in crate::flow) fn place_of<const D: usize>(at: [usize; D]) -> Place {
    (at[D - 1] as isize, if D == 3 { at[1] as isize } else { 0 })
}

/// Neighbour of a row of the window along an axis above 0.
pub(in crate::flow) fn beside<const D: usize>((l, j): Place, e: usize, step: isize) -> Place {
    if e == D - 1 { (l + step, j) } else { (l, j + step) }
}

/// What one call advances of a problem, and from where.
#[derive(Clone)]
pub(in crate::flow) struct Part<'p, R, const D: usize> {
    /// The old field, of the whole mesh.
    pub old: &'p Fields<'p, R, D>,
    /// The step.
    pub dt: R,
    /// One byte per cell of the mesh: not 0 for a reconstruction of first order.
    pub first_order: Option<&'p [u8]>,
    /// Layers along the last axis; the one layer of a line.
    pub layers: Range<usize>,
    /// Cells of a row that enter the report: all but the outer ones of a piece of a line.
    pub reported: Range<usize>,
    /// Cells whose walls are watched, if there are any.
    pub walls: Option<&'p Walls<'p, R, D>>,
    /// Where the first cell of the mesh stands on the line that it is a piece of; 0 for a whole mesh.
    pub first: usize,
}

/// Cells whose walls are watched, and how. What writes is held by pointers: a program that watches no walls does not link it.
pub(in crate::flow) struct Walls<'w, R, const D: usize> {
    /// Flat indices, ascending, and what acts on the walls there.
    pub cells: &'w [usize],
    pub pushes: &'w [Cell<CellPush<R, D>>],
    /// Pressure that all others are counted from.
    pub reference: R,
    /// Cells of the whole mesh, of which a piece of a line is a part.
    pub all: usize,
    /// Writes what acts at faces: [`push_walls`](crate::flow::kernel::wall_pushes::push_walls).
    pub at_faces: fn(&Slab<'_, R, D>, &FaceRow<'_, R, D>, CellsBeside),
    /// Writes what drag takes: [`push_obstacles`](crate::flow::kernel::wall_pushes::push_obstacles).
    pub in_cell: fn(&Slab<'_, R, D>, usize, [R; D]),
}

impl<'w, R, const D: usize> Walls<'w, R, D> {
    /// The watched ones among some cells of a row that begins at `start` of the whole mesh: place in the row, and what acts on the walls.
    pub fn of_row(&self, start: usize, cells: Range<usize>) -> impl Iterator<Item = (usize, &'w Cell<CellPush<R, D>>)> {
        let (begin, end) = (start + cells.start, start + cells.end);
        let (watched, pushes) = (self.cells, self.pushes);
        let seam = self.all.max(begin).min(end);
        // A piece across the seam of a periodic line goes on at its beginning.
        let over = end - seam;
        let place = watched.partition_point(|&cell| cell < begin);
        let found = watched.get(place..).unwrap_or_default().iter().zip(pushes.get(place..).unwrap_or_default());
        let before = found.map(|(cell, push)| (*cell, push)).take_while(move |(cell, _)| *cell < seam);
        let after = watched.iter().zip(pushes).take_while(move |(cell, _)| **cell < over);
        let turned = after.map(move |(cell, push)| (cell + seam, push));
        before.chain(turned).map(move |(cell, push)| (cell - begin + cells.start, push))
    }
}

/// A row of faces of axis `d` with its fluxes.
pub(in crate::flow) struct FaceRow<'f, R, const D: usize> {
    /// Axis of the faces.
    pub d: usize,
    /// The cell above the first face; `at[d]` may be one past the end.
    pub at: [usize; D],
    /// Face state blocks on the left and on the right, `n` long.
    pub states: [&'f [R]; 2],
    /// Flux block, `n` long.
    pub flux: &'f [R],
    pub n: usize,
}

/// Cells of a row that have faces of a [`FaceRow`] on one of their sides.
#[derive(Clone, Copy)]
pub(in crate::flow) struct CellsBeside {
    /// Flat index of the first cell.
    pub start: usize,
    /// The first cell's face in its row of faces.
    pub face: usize,
    /// The faces are on the high side of the cells.
    pub high: bool,
}

/// One slab of one step, and what it reads.
pub(in crate::flow) struct Slab<'p, R, const D: usize> {
    pub problem: &'p Problem<'p, R, D>,
    pub solver: SolverCalls<R, D>,
    pub medium: Option<Medium<'p, R, D>>,
    pub size: Sizes,
    pub periodic: [bool; D],
    pub weighted: bool,
    /// All cells along an axis have one width.
    pub even: [bool; D],
    pub first_order: Option<&'p [u8]>,
    pub face_gas: FaceGas<R>,
    pub throat: ThroatGas<R>,
    /// Lowest and highest capacity.
    pub capacities: [R; 2],
    pub old: &'p Fields<'p, R, D>,
    pub dt: R,
    pub layers: Range<usize>,
    /// Rows of a layer that are advanced: a tile of a 3D mesh, else the one row.
    pub rows: Range<usize>,
    /// Cells of a row that enter the report.
    pub reported: Range<usize>,
    /// Cells whose walls are watched.
    pub walls: Option<&'p Walls<'p, R, D>>,
    /// Where the first cell of the mesh stands on the line that it is a piece of.
    pub first: usize,
}

impl<'p, R: Real, const D: usize> Slab<'p, R, D> {
    /// The slab of a part of a problem; its rows are to be set.
    pub fn new(problem: &'p Problem<'p, R, D>, part: &Part<'p, R, D>, solver: SolverCalls<R, D>) -> Self {
        Slab {
            problem,
            solver,
            medium: problem.medium(),
            size: Sizes::new(problem.mesh.cells(), problem.gas.is_mixed()),
            periodic: problem.periodic(),
            weighted: problem.gravity.iter().any(|&g| g != R::ZERO),
            even: problem.mesh.widths.map(|w| w.iter().all(|x| *x == w[0])),
            first_order: part.first_order,
            face_gas: FaceGas::new(problem.gas),
            throat: ThroatGas::new(problem.gas),
            capacities: problem.gas.capacities(),
            old: part.old,
            dt: part.dt,
            layers: part.layers.clone(),
            rows: 0..1,
            reported: part.reported.clone(),
            walls: part.walls,
            first: part.first,
        }
    }

    /// Whether face `i` of a row along or across axis `d` lies in a side of the domain that is not periodic; `at` is the cell above the first of them.
    pub fn is_in_side(&self, d: usize, at: [usize; D], i: usize) -> bool {
        let place = if d == 0 { i } else { at[d] };
        !self.periodic[d] && (place == 0 || place >= self.problem.mesh.cells()[d])
    }

    /// The border askew to the grid in the cells beside the low face of a cell along `d`, in the frame of that axis. `at[d]` may be one past the end.
    #[inline(always)]
    pub fn border(&self, d: usize, at: [usize; D]) -> Option<Border<R, D>> {
        let medium = self.medium.as_ref().filter(|_| D > 1)?;
        if medium.is_far_from_borders(d, at) { None } else { self.border_beside(medium, d, at) }
    }

    /// Whether there is one.
    #[inline(always)]
    pub fn has_border(&self, d: usize, at: [usize; D]) -> bool {
        let Some(medium) = self.medium.as_ref().filter(|_| D > 1) else { return false };
        !medium.is_far_from_borders(d, at) && medium.has_border(medium.mesh.beside(d, at, self.periodic[d]))
    }

    /// The border at a face where there may be one.
    #[inline(never)]
    fn border_beside(&self, medium: &Medium<'_, R, D>, d: usize, at: [usize; D]) -> Option<Border<R, D>> {
        let border = medium.border(d, medium.mesh.beside(d, at, self.periodic[d]))?;
        Some(Border { normal: rotate(border.normal, d), ..border })
    }

    /// The gas of the capacity at a place of a block; the one gas there is, if it is not mixed.
    pub fn gas_of<const MIXED: bool>(&self, block: &[R], capacity: usize) -> Gas<R> {
        if MIXED { self.problem.gas.at(block[capacity]) } else { self.problem.gas }
    }

    /// Cells of the whole mesh along an axis.
    pub fn cells(&self, d: usize) -> isize {
        self.problem.mesh.cells()[d] as isize
    }

    /// The rows that are advanced.
    pub fn rows(&self) -> Range<isize> {
        self.rows.start as isize..self.rows.end as isize
    }

    /// Rows of a layer of the whole mesh.
    pub fn all_rows(&self) -> isize {
        if D == 3 { self.problem.mesh.cells()[1] as isize } else { 1 }
    }

    /// Rows of a layer that the window holds: those of the tile and, in 3D, two more on each side; one beyond a side of the domain.
    pub fn held_rows(&self) -> Range<isize> {
        let (first, last) = (self.rows.start as isize, self.rows.end as isize);
        if D < 3 {
            return first..last;
        }
        let beside = |at_side: bool| if at_side && !self.periodic[1] { 1 } else { ROWS_BESIDE as isize };
        first - beside(first == 0)..last + beside(last == self.all_rows())
    }

    /// Which row of the window row `j` of layer `l` is.
    pub fn slot(&self, l: isize, j: isize) -> usize {
        let layer = if D == 1 { 0 } else { l.rem_euclid(3) as usize };
        let row = if D == 3 { (j - self.rows.start as isize + ROWS_BESIDE as isize) as usize } else { 0 };
        layer * self.size.rows_padded + row
    }

    /// Where row `j` of layer `l` stands in the window.
    pub fn block(&self, l: isize, j: isize) -> Range<usize> {
        let len = self.size.state * self.size.padded;
        let start = self.slot(l, j) * len;
        start..start + len
    }

    /// Place of row `j` among those of the tile.
    pub fn place(&self, j: isize) -> usize {
        j as usize - self.rows.start
    }

    /// Where the changes of the row at a place of the tile stand along axis `d`.
    pub fn changes(&self, d: usize, place: usize) -> Range<usize> {
        let len = self.size.state * self.size.n;
        let row = if d == D - 1 { 0 } else { place };
        row * len..(row + 1) * len
    }
}

/// Open fraction of a cell up to which its faces get an infinite pace, and so the flux of plain HLLC: states there are rounding. Larger: more
/// small cells get the plain flux.
const DUST: f64 = 1e-6;

/// The pace of a face of open fraction `open`, between cells of open fractions `low` and `high`, from that of open space.
#[inline(always)]
pub(in crate::flow) fn tightened<R: Real>(pace: R, open: R, low: R, high: R) -> R {
    let least = R::smaller(low, high);
    if least > R::from_f64(DUST) { pace * (open / least) } else { R::INFINITY }
}
