//! The shares of one part in a layer of cells, row by row.

use super::aligned::{AlignedPipe, Shares};
use super::outline::Rectangle;
use super::part::{Ends, FaceFlux, Part, Plane, span_between};
use super::wall::Span;
use super::window::{EVERYWHERE, reached, reached_of};
use crate::grid::Grid;
use crate::grid::cell_range::RangeKind;
use crate::number::axis::Axis;
use crate::number::real::Real;
use core::ops::Range;
use heapless::Vec;

/// The rectangle between planes across the two axes of another one.
fn rectangle(u: [&Plane; 2], v: [&Plane; 2]) -> Rectangle {
    Rectangle { u: u.map(|p| p.h.value), v: v.map(|p| p.h.value) }
}

/// A part over one row of cells: planes below and above along y and z, and lines along x, `[y][z]`.
struct Row<'a> {
    part: &'a Part,
    /// Those of its ends that matter.
    ends: Ends<'a>,
    j: usize,
    y: [&'a Plane; 2],
    z: [&'a Plane; 2],
    x_lines: [[Span; 2]; 2],
}

/// What stands in a plane across x: lines along y by z; and in one row lines along z by y, and the face.
struct Column {
    at: usize,
    plane: Plane,
    y_lines: [Span; 2],
    row: Option<usize>,
    z_lines: [Span; 2],
    face: FaceFlux,
}

/// Columns that stay at hand, by their numbers.
const COLUMNS: usize = 4;

/// The columns of a layer that were computed last.
#[derive(Default)]
struct Columns([Option<Column>; COLUMNS]);

impl Columns {
    /// The column of a number, if it is at hand.
    fn get(&self, at: usize) -> Option<&Column> {
        self.0.get(at % COLUMNS)?.as_ref().filter(|column| column.at == at)
    }

    /// Computes column `at`, at `x`, for a row, as far as it is not known.
    #[inline]
    fn find(&mut self, row: &Row, at: usize, x: f64) {
        let Some(slot) = self.0.get_mut(at % COLUMNS) else { return };
        let (part, j, [y0, y1], [z0, z1]) = (row.part, row.j, row.y, row.z);
        let column = match slot {
            Some(column) if column.at == at && column.row == Some(j) => return,
            Some(column) if column.at == at => column,
            _ => {
                let plane = part.plane_with(row.ends, Axis::X, x);
                let y_lines = [z0, z1].map(|z| part.span(Axis::Y, [z, &plane]));
                let (z_lines, face) = ([Span::EMPTY; 2], FaceFlux::default());
                slot.insert(Column { at, plane, y_lines, row: None, z_lines, face })
            }
        };
        let below = column.row.filter(|row| row + 1 == j).map(|_| column.z_lines[1]);
        let z_line = |y: &Plane| part.span(Axis::Z, [&column.plane, y]);
        column.z_lines = [below.unwrap_or_else(|| z_line(y0)), z_line(y1)];
        let spans = [column.y_lines[0], column.z_lines[1], column.y_lines[1], column.z_lines[0]];
        column.face = part.face(&column.plane, &rectangle([y0, y1], [z0, z1]), &spans);
        column.row = Some(j);
    }
}

/// Shares of a cell and its low faces; and the high ones.
struct CellShares {
    volume: f64,
    faces: [[FaceFlux; 2]; 3],
}

impl<'a> Row<'a> {
    /// `below`: the lines along x between it and the row below, if they are known.
    fn new(
        (part, ends): (&'a Part, Ends<'a>),
        j: usize,
        [y, z]: [[&'a Plane; 2]; 2],
        below: Option<[Span; 2]>,
    ) -> Self {
        let [y0, y1] = y.map(|y| move || z.map(|z| part.span(Axis::X, [y, z])));
        let x_lines = [below.unwrap_or_else(y0), y1()];
        Row { part, ends, j, y, z, x_lines }
    }

    /// The run along x, from the part's origin, in which whole cells of the row are inside.
    fn inside(&self) -> Span {
        let mut run = Span::ALL;
        for j in 0..2 {
            for k in 0..2 {
                let line = self.x_lines[j][k];
                if !(line.lo < line.hi) {
                    return Span::EMPTY;
                }
                run = run.intersection(span_between(&self.ends, Axis::X, [self.y[j], self.z[k]], line));
            }
        }
        run
    }

    /// `known`: the low faces along y and z, as far as they are known.
    #[inline]
    fn cell(&self, low: &Column, high: &Column, known: [Option<FaceFlux>; 2]) -> CellShares {
        let (part, [y0, y1], [z0, z1]) = (self.part, self.y, self.z);
        let (x, x_lines) = ([&low.plane, &high.plane], &self.x_lines);
        let across_y = |j: usize| {
            let spans = [low.z_lines[j], x_lines[j][1], high.z_lines[j], x_lines[j][0]];
            part.face(self.y[j], &rectangle([z0, z1], x), &spans)
        };
        let across_z = |k: usize| {
            let spans = [x_lines[0][k], high.y_lines[k], x_lines[1][k], low.y_lines[k]];
            part.face(self.z[k], &rectangle(x, [y0, y1]), &spans)
        };
        let [low_y, low_z] = known;
        let (low_y, low_z) = (low_y.unwrap_or_else(|| across_y(0)), low_z.unwrap_or_else(|| across_z(0)));
        let faces = [[low.face, high.face], [low_y, across_y(1)], [low_z, across_z(1)]];
        let volume = part.volume(&[x, [y0, y1], [z0, z1]], &faces);
        CellShares { volume, faces }
    }
}

/// Most faces between two rows that are computed but once.
const MOST_KEPT: usize = 64;

/// The high faces along y of a row's cells as far as they were computed, from the row's first cell on.
#[derive(Default)]
struct HighFaces {
    row: usize,
    first: usize,
    faces: Vec<Option<FaceFlux>, MOST_KEPT>,
}

impl HighFaces {
    /// Begins a row.
    fn begin(&mut self, row: usize, first: usize) {
        (self.row, self.first) = (row, first);
        self.faces.clear();
    }

    /// Of a cell in the row below another one.
    fn below(&self, row: usize, i: usize) -> Option<FaceFlux> {
        let face = self.faces.get(i.checked_sub(self.first)?)?;
        face.filter(|_| self.row + 1 == row)
    }
}

/// What a part has of a face in a plane between two layers; or a pipe along z, the share of its section in the cells beside it.
#[derive(Clone, Copy, Debug)]
pub struct FaceBetween(FaceFlux);

/// Faces in a plane between two layers of one grid, as one layer leaves them to the next, so that they are computed once. They are told by the number of a
/// solid's part and their position, in ascending order of both.
pub trait FacesBetween {
    /// A face below the layer, if the layer below has left it here.
    fn below(&mut self, part: usize, at: usize) -> Option<FaceBetween>;

    /// A face above the layer.
    fn above(&mut self, part: usize, at: usize, face: FaceBetween);
}

/// Nothing is left.
impl FacesBetween for () {
    fn below(&mut self, _: usize, _: usize) -> Option<FaceBetween> {
        None
    }

    fn above(&mut self, _: usize, _: usize, _: FaceBetween) {}
}

/// A part of a solid by its number, and what layers leave to each other.
pub(super) struct NumberedPart<'a, B> {
    pub part: &'a Part,
    pub number: usize,
    pub between: &'a mut B,
}

/// What rows of a layer have of each other: columns, the high faces of the row below, and those of the row itself.
struct AtHand<'a> {
    columns: &'a mut Columns,
    below: &'a HighFaces,
    own: &'a mut HighFaces,
}

/// The fraction of a face.
fn fraction(face: &FaceFlux, area: f64) -> f64 {
    if face.whole { 1.0 } else { (face.area / area).clamp(0.0, 1.0) }
}

/// Tells the shares of a part in layer `k`: of cells, and with `areas` of x and y faces and of the z faces below. Each is told once, by
/// its position in the fields of a layer. Returns by how much the worst share left 0 to 1 before it was cut.
pub(super) fn layer<R: Real, B: FacesBetween>(
    NumberedPart { part, number, between }: NumberedPart<B>,
    grid: &Grid<R>,
    k: usize,
    areas: bool,
    visit: &mut impl FnMut(RangeKind, usize, f64),
) -> f64 {
    let [xs, ys, zs] = [0, 1, 2].map(|axis| grid.edges(axis));
    let (Some(&[z0, z1]), [nx, ny, _]) = (zs.get(k..).and_then(|e| e.first_chunk()), grid.cells()) else { return 0.0 };
    let zs = [z0.to_f64(), z1.to_f64()];
    let [lowest, highest] = part.extent(Axis::Z);
    if lowest > zs[1] || highest < zs[0] {
        return 0.0;
    }
    if let Some(pipe) = AlignedPipe::new(part) {
        return layer_of_aligned(&pipe, NumberedPart { part, number, between }, grid, k, areas, visit);
    }
    let mut told = Teller { cells: [nx, ny], areas, worst: 0.0, number, between, visit };
    let within = part.extent_within([EVERYWHERE, EVERYWHERE, zs]);
    let runs = part.runs(zs);
    let (across, rows) = (reached(xs, within[0]), reached(ys, within[1]));
    let around = |edges: &[R], cells: &Range<usize>| {
        let edge = |n: usize| edges.get(n).map_or(f64::NAN, |e| e.to_f64());
        [edge(cells.start), edge(cells.end)]
    };
    let ends = part.ends_near([around(xs, &across), around(ys, &rows), zs]);
    // Written out: `map` of an array moves planes about.
    let z = [part.plane_with(ends, Axis::Z, zs[0]), part.plane_with(ends, Axis::Z, zs[1])];
    // Planes between rows by the parity of their numbers, and the row that stands below the next one.
    let mut planes: [Option<Plane>; 2] = [None, None];
    let mut below: Option<(usize, [Span; 2])> = None;
    let mut columns = Columns::default();
    let (mut even, mut odd) = (HighFaces::default(), HighFaces::default());
    for j in rows.clone() {
        let (Some(y0), Some(y1)) = (ys.get(j), ys.get(j + 1)) else { break };
        let last_row = j + 1 == rows.end;
        let Some(run) = runs.between([y0.to_f64(), y1.to_f64()]) else { continue };
        let known = below.filter(|(row, _)| *row + 1 == j).map(|(_, lines)| lines);
        let [even_plane, odd_plane] = &mut planes;
        let (low, high) = if j % 2 == 0 { (even_plane, odd_plane) } else { (odd_plane, even_plane) };
        if known.is_none() {
            *low = Some(part.plane_with(ends, Axis::Y, y0.to_f64()));
        }
        *high = Some(part.plane_with(ends, Axis::Y, y1.to_f64()));
        let (Some(low), Some(high)) = (low, high) else { break };
        let row = Row::new((part, ends), j, [[low, high], z.each_ref()], known);
        let (own, other) = if j % 2 == 0 { (&mut even, &odd) } else { (&mut odd, &even) };
        let at_hand = AtHand { columns: &mut columns, below: other, own };
        told.row(xs, &row, last_row, reached_of(xs, &across, run), at_hand);
        below = Some((j, row.x_lines[1]));
    }
    told.worst
}

/// The same of a pipe along an axis. Of one along z layers leave each other what they have of its section.
fn layer_of_aligned<R: Real, B: FacesBetween>(
    pipe: &AlignedPipe,
    NumberedPart { part, number, between }: NumberedPart<B>,
    grid: &Grid<R>,
    k: usize,
    areas: bool,
    visit: &mut impl FnMut(RangeKind, usize, f64),
) -> f64 {
    let (edges, [nx, ny, _]) = ([0, 1, 2].map(|axis| grid.edges(axis)), grid.cells());
    let mut recall = |[i, j]: [usize; 2], share: &dyn Fn() -> f64| {
        let at = j * nx + i;
        let known = between.below(number, at);
        let face = known.unwrap_or_else(|| FaceBetween(FaceFlux { area: share(), ..FaceFlux::default() }));
        between.above(number, at, face);
        face.0.area
    };
    let mut told = Teller { cells: [nx, ny], areas, worst: 0.0, number, between: &mut (), visit };
    let mut tell = |[i, j, _]: [usize; 3], [last, last_row, _]: [bool; 3], shares: &Shares| {
        told.tell_cell(i, (j, last_row), last, shares);
    };
    let cells = [reached(edges[0], part.extent(Axis::X)), reached(edges[1], part.extent(Axis::Y)), k..k + 1];
    pipe.tell(edges, &cells, &mut recall, &mut tell)
}

struct Teller<'v, F, B> {
    cells: [usize; 2],
    areas: bool,
    worst: f64,
    /// The part's number, and what layers leave to each other.
    number: usize,
    between: &'v mut B,
    visit: &'v mut F,
}

impl<F: FnMut(RangeKind, usize, f64), B: FacesBetween> Teller<'_, F, B> {
    fn tell(&mut self, kind: RangeKind, at: usize, share: f64) {
        if share > 0.0 {
            (self.visit)(kind, at, share);
        }
    }

    /// Tells a row of cells.
    fn row<R: Real>(&mut self, xs: &[R], row: &Row, last_row: bool, cells: Range<usize>, at_hand: AtHand) {
        let (AtHand { columns, below, own }, j) = (at_hand, row.j);
        let inside = row.inside();
        let from_origin = |i: usize| xs.get(i).map_or(f64::NAN, |x| x.to_f64() - row.part.origin[0]);
        // A face in the plane of an end that does not belong to the part is none of it.
        let open = row.ends.iter().flatten().any(|end| !end.closed);
        let covers = |lo: f64, hi: f64| if open { inside.lo < lo && inside.hi > hi } else { inside.covers(lo, hi) };
        own.begin(j, cells.start);
        for i in cells.clone() {
            let (Some(x0), Some(x1)) = (xs.get(i), xs.get(i + 1)) else { break };
            let (shares, face) = if covers(from_origin(i), from_origin(i + 1)) {
                (Shares::WHOLE, None)
            } else {
                columns.find(row, i, x0.to_f64());
                columns.find(row, i + 1, x1.to_f64());
                let (Some(low), Some(high)) = (columns.get(i), columns.get(i + 1)) else { break };
                let at = j * self.cells[0] + i;
                let low_z = self.between.below(self.number, at).map(|face| face.0);
                let found = row.cell(low, high, [below.below(j, i), low_z]);
                self.between.above(self.number, at, FaceBetween(found.faces[2][1]));
                let shares = self.shares(row, [low, high], &found);
                (shares, Some(found.faces[1][1]))
            };
            let _ = own.faces.push(face);
            self.tell_cell(i, (j, last_row), i + 1 == cells.end, &shares);
        }
    }

    /// The shares of the cell between two columns of a row.
    #[inline]
    fn shares(&mut self, row: &Row, [low, high]: [&Column; 2], found: &CellShares) -> Shares {
        let [dy, dz] = [row.y, row.z].map(|[lo, hi]| hi.h.value - lo.h.value);
        let dx = high.plane.h.value - low.plane.h.value;
        let share = found.volume / (dx * dy * dz);
        let [x, y, z] = &found.faces;
        let sizes = [dy * dz, dz * dx, dx * dy];
        let beyond = |face: &FaceFlux, size: f64| (face.area - size).max(-face.area) / size;
        let faces = beyond(&x[0], sizes[0]).max(beyond(&y[0], sizes[1])).max(beyond(&z[0], sizes[2]));
        self.worst = self.worst.max(share - 1.0).max(-share).max(faces);
        if share.is_nan() {
            self.worst = f64::INFINITY;
        }
        let low = [fraction(&x[0], sizes[0]), fraction(&y[0], sizes[1]), fraction(&z[0], sizes[2])];
        Shares { cell: share.min(1.0), low, high: [fraction(&x[1], sizes[0]), fraction(&y[1], sizes[1])] }
    }

    /// Tells what is known of cell `i` of a row, the high faces of the last cell and the last row.
    fn tell_cell(&mut self, i: usize, (j, last_row): (usize, bool), last: bool, shares: &Shares) {
        let [nx, _] = self.cells;
        let c = j * nx + i;
        self.tell(RangeKind::Cells, c, shares.cell);
        if !self.areas {
            return;
        }
        for (axis, at) in [(0, c + j), (1, c), (2, c)] {
            self.tell(RangeKind::Faces(axis), at, shares.low[axis]);
        }
        if last {
            self.tell(RangeKind::Faces(0), c + j + 1, shares.high[0]);
        }
        if last_row {
            self.tell(RangeKind::Faces(1), c + nx, shares.high[1]);
        }
    }
}

/// Tells the shares of a part in the z faces of a plane.
pub(super) fn plane<R: Real>(part: &Part, grid: &Grid<R>, plane: usize, visit: &mut impl FnMut(RangeKind, usize, f64)) {
    let [xs, ys, zs] = [0, 1, 2].map(|axis| grid.edges(axis));
    let Some(z) = zs.get(plane).map(|z| z.to_f64()) else { return };
    let [lowest, highest] = part.extent(Axis::Z);
    if lowest > z || highest < z {
        return;
    }
    let nx = grid.cells()[0];
    let (level, runs) = (part.plane(Axis::Z, z), part.runs([z, z]));
    for j in reached(ys, part.extent(Axis::Y)) {
        let (Some(y0), Some(y1)) = (ys.get(j), ys.get(j + 1)) else { break };
        let ys = [y0.to_f64(), y1.to_f64()];
        let y = ys.map(|y| part.plane(Axis::Y, y));
        let Some(run) = runs.between(ys) else { continue };
        let x_lines = y.each_ref().map(|y| part.span(Axis::X, [y, &level]));
        for i in reached(xs, run) {
            let (Some(x0), Some(x1)) = (xs.get(i), xs.get(i + 1)) else { break };
            let x = [x0.to_f64(), x1.to_f64()].map(|x| part.plane(Axis::X, x));
            let y_lines = x.each_ref().map(|x| part.span(Axis::Y, [&level, x]));
            let spans = [x_lines[0], y_lines[1], x_lines[1], y_lines[0]];
            let face = part.face(&level, &rectangle([&x[0], &x[1]], [&y[0], &y[1]]), &spans);
            let [width, depth] = [&x, &y].map(|[lo, hi]| hi.h.value - lo.h.value);
            let share = fraction(&face, width * depth);
            if share > 0.0 {
                visit(RangeKind::Faces(2), j * nx + i, share);
            }
        }
    }
}
