//! The scratch of a sweep, cut from one slice: a window of layers, the buffers of one row, and what rows leave behind for the
//! faces above them.

use crate::flow::porosity::fractions::Mesh;
use crate::number::real::Real;
use core::ops::Range;

/// Hands out pieces of one slice.
struct Arena<'s, R>(&'s mut [R]);

impl<'s, R: Real> Arena<'s, R> {
    fn take(&mut self, n: usize) -> &'s mut [R] {
        let (piece, rest) = core::mem::take(&mut self.0).split_at_mut(n);
        self.0 = rest;
        piece
    }

    fn axes<const D: usize>(&mut self, n: usize) -> [&'s mut [R]; D] {
        core::array::from_fn(|_| self.take(n))
    }
}

/// Cells of a piece of a long line, those on its sides included.
pub(in crate::flow) const PIECE: usize = 256;

/// A line of so many cells goes in pieces.
pub(in crate::flow) const fn in_pieces<const D: usize>(cells: usize) -> bool {
    D == 1 && cells > PIECE
}

/// Rows that a tile of a 3D mesh holds beyond its own on each side.
pub(in crate::flow) const ROWS_BESIDE: usize = 2;
/// Cells of a layer of a tile: what a sweep keeps of them, about 300 bytes a cell, should fit a core's own cache.
const TILE: usize = 4096;
/// Rows of a tile at least; two more are reconstructed.
const LEAST_ROWS: usize = 16;

/// Number of tiles of about equal size for layers of so many rows of `n` cells.
const fn tiles(n: usize, rows: usize) -> usize {
    let of_tile = TILE / at_least(1, n);
    at_least(1, rows.div_ceil(at_least(LEAST_ROWS, of_tile)))
}

/// The larger of two numbers.
const fn at_least(a: usize, b: usize) -> usize {
    if a > b { a } else { b }
}

/// The product of some numbers, or the largest one there is.
const fn product<const N: usize>(factors: [usize; N]) -> usize {
    let (mut all, mut i) = (1usize, 0);
    while i < N {
        all = all.saturating_mul(factors[i]);
        i += 1;
    }
    all
}

/// Sizes of the pieces of scratch.
#[derive(Clone, Copy)]
pub(in crate::flow) struct Sizes {
    /// Cells along a row, with ghosts, and faces.
    pub n: usize,
    pub padded: usize,
    pub m: usize,
    /// Rows of a tile at most, and with those beside it.
    pub rows: usize,
    pub rows_padded: usize,
    /// Layers of the window.
    pub layers: usize,
    /// Variables of a state or a change block, and of a face state or a flux block.
    pub state: usize,
    pub face: usize,
}

impl Sizes {
    /// For a mesh of so many cells along each axis, and a gas that is mixed or not.
    pub const fn new<const D: usize>(cells: [usize; D], mixed: bool) -> Self {
        let n = if in_pieces::<D>(cells[0]) { PIECE } else { cells[0] };
        let rows = if D == 3 { cells[1].div_ceil(tiles(n, cells[1])) } else { 1 };
        Sizes {
            n,
            padded: n.saturating_add(2),
            m: n.saturating_add(1),
            rows,
            rows_padded: if D == 3 { rows + 2 * ROWS_BESIDE } else { 1 },
            layers: if D == 1 { 1 } else { 3 },
            state: if mixed { D + 3 } else { D + 2 },
            face: if mixed { 2 * D + 4 } else { 2 * D + 2 },
        }
    }

    /// The tiles of a mesh, by their rows.
    pub fn tiles<R: Real, const D: usize>(mesh: &Mesh<'_, R, D>) -> impl Iterator<Item = Range<usize>> {
        let cells = mesh.cells();
        let (count, rows) = if D == 3 { (tiles(cells[0], cells[1]), cells[1]) } else { (1, 1) };
        (0..count).map(move |k| rows * k / count..rows * (k + 1) / count)
    }

    /// Scalars in all; the largest number there is, if they are more.
    pub const fn total<const D: usize>(&self) -> usize {
        let (v, f) = (self.state, self.face);
        let window = product([self.layers, self.rows_padded, v, self.padded]);
        let row = product([D + 1, v, self.n]).saturating_add(self.n).saturating_add(product([3, f, self.m]));
        let (middle, last) = self.lagged::<D>();
        let lagged = product([2 * f, self.n, middle + last]);
        let (mut changes, mut d) = (0usize, 0);
        while d < D {
            changes = changes.saturating_add(product([self.change_rows::<D>(d), v, self.n]));
            d += 1;
        }
        let metric = product([4 * D + 5, self.n]).saturating_add(product([4, self.m]));
        let window = window.saturating_add(self.ranges::<D>()).saturating_add(self.contractions::<D>());
        window.saturating_add(row).saturating_add(lagged).saturating_add(changes).saturating_add(metric)
    }

    /// Ranges of pressure in the window, two scalars a row.
    const fn ranges<const D: usize>(&self) -> usize {
        if D == 1 { 0 } else { product([2, self.layers, self.rows_padded]) }
    }

    /// How far gas passes contractions, one scalar a cell of the window and its ghosts.
    const fn contractions<const D: usize>(&self) -> usize {
        if D == 1 { 0 } else { product([self.layers, self.rows_padded, self.padded]) }
    }

    /// Rows whose changes along axis `d` are kept: those of a layer, until the layer above has come. Along the last axis they are
    /// used at once.
    const fn change_rows<const D: usize>(&self, d: usize) -> usize {
        if d == D - 1 { 1 } else { self.rows }
    }

    /// Rows of face states and fluxes to be kept for the faces above them: along axis 1 of a 3D mesh, and along the last axis.
    const fn lagged<const D: usize>(&self) -> (usize, usize) {
        match D {
            1 => (0, 0),
            2 => (0, 1),
            _ => (1, self.rows),
        }
    }
}

/// Buffers of a sweep.
pub(in crate::flow) struct Work<'s, R, const D: usize> {
    pub window: &'s mut [R],
    /// The least and the largest pressure of each row of the window; of none in one dimension.
    pub ranges: &'s mut [R],
    /// How far the gas of each cell of the window passes contractions; of none in one dimension.
    pub contractions: &'s mut [R],
    pub slope: [&'s mut [R]; D],
    /// Half-step states of the row, and after them the pressures on the walls inside its cells.
    pub half: &'s mut [R],
    pub left: &'s mut [R],
    pub right: &'s mut [R],
    pub flux: &'s mut [R],
    /// How strong a shock lies along each face of a row.
    pub strength: &'s mut [R],
    /// What the row below left for the faces along axis 1 of a 3D mesh.
    pub below_row: FacesBelow<'s, R>,
    /// What the rows of the layer below left for the faces along the last axis.
    pub below_layer: FacesBelow<'s, R>,
    pub change: [&'s mut [R]; D],
    pub coefficients: RowCoefficients<'s, R, D>,
}

/// High face states of rows below, and the fluxes through the faces under them.
#[derive(Default)]
pub(in crate::flow) struct FacesBelow<'s, R> {
    pub state: &'s mut [R],
    pub flux: &'s mut [R],
}

/// Coefficients of the cells of a row.
pub(in crate::flow) struct RowCoefficients<'s, R, const D: usize> {
    pub inv_width: &'s mut [R],
    pub rate: [&'s mut [R]; D],
    pub widening: [&'s mut [R]; D],
    pub weight: [&'s mut [R]; D],
    pub open: [&'s mut [R]; D],
    /// 1/c².
    pub compliance: &'s mut [R],
    pub scale: &'s mut [R],
    pub signal: &'s mut [R],
    pub spare: &'s mut [R],
    pub vol_left: &'s mut [R],
    pub vol_right: &'s mut [R],
    /// Of faces: see [`crate::flow::riemann::Slowness`].
    pub pace: &'s mut [R],
}

impl<'s, R: Real, const D: usize> Work<'s, R, D> {
    /// Cuts the scratch, which holds [`Sizes::total`] scalars.
    pub fn new(s: Sizes, scratch: &'s mut [R]) -> Self {
        let (v, f) = (s.state, s.face);
        let mut arena = Arena(scratch);
        let (middle, last) = s.lagged::<D>();
        let mut faces =
            |rows: usize| FacesBelow { state: arena.take(rows * f * s.n), flux: arena.take(rows * f * s.n) };
        let (below_row, below_layer) = (faces(middle), faces(last));
        Work {
            below_row,
            below_layer,
            window: arena.take(s.layers * s.rows_padded * v * s.padded),
            ranges: arena.take(s.ranges::<D>()),
            contractions: arena.take(s.contractions::<D>()),
            slope: arena.axes(v * s.n),
            half: arena.take((v + 1) * s.n),
            left: arena.take(f * s.m),
            right: arena.take(f * s.m),
            flux: arena.take(f * s.m),
            strength: arena.take(s.m),
            change: core::array::from_fn(|d| arena.take(s.change_rows::<D>(d) * v * s.n)),
            coefficients: RowCoefficients {
                inv_width: arena.take(s.n),
                rate: arena.axes(s.n),
                widening: arena.axes(s.n),
                weight: arena.axes(s.n),
                open: arena.axes(s.n),
                compliance: arena.take(s.n),
                scale: arena.take(s.n),
                signal: arena.take(s.n),
                spare: arena.take(s.n),
                vol_left: arena.take(s.m),
                vol_right: arena.take(s.m),
                pace: arena.take(s.m),
            },
        }
    }
}
