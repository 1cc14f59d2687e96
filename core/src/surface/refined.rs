//! Bounds found for a cell that bodies share, and how they enter its layer.

use crate::grid::bounds::Bounds;
use crate::grid::fields::{Layer, gap};
use crate::number::real::Real;
use crate::surface::union::CellFractions;

/// Bounds of the solid fractions of a small grid: of the whole, and means over all faces in each of its planes, `[axis][plane]`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Parts<R> {
    pub cell: Bounds<R>,
    pub planes: [[Bounds<R>; 3]; 3],
}

/// Bounds of the solid fractions of a cell and of its sides, low and high along each axis.
pub(super) struct Refined<R> {
    pub cell: Bounds<R>,
    pub low: [Bounds<R>; 3],
    pub high: [Bounds<R>; 3],
}

impl<R: Real> Refined<R> {
    pub fn from_union(u: CellFractions<R>) -> Self {
        let known = |v: R| Bounds::around(v, u.error);
        Refined { cell: known(u.cell), low: u.low.map(known), high: u.high.map(known) }
    }

    /// From bounds of the cell, of its low faces and of its high ones.
    pub fn from_places([cell, x, y, z, right, back, top]: [Bounds<R>; PLACES]) -> Self {
        Refined { cell, low: [x, y, z], high: [right, back, top] }
    }

    /// From the parts of a cell, in number `cells` along each axis.
    pub fn from_parts(parts: &Parts<R>, cells: [usize; 3]) -> Self {
        let high = |axis: usize| if cells[axis] > 1 { parts.planes[axis][2] } else { parts.planes[axis][1] };
        Refined { cell: parts.cell, low: parts.planes.map(|planes| planes[0]), high: [high(0), high(1), high(2)] }
    }
}

/// A cell, its low faces and its high ones.
pub(super) const PLACES: usize = 7;

/// Of these the cell.
pub(super) const WHOLE: [bool; PLACES] = [true, false, false, false, false, false, false];

/// The face above.
pub(super) const TOP: [bool; PLACES] = [false, false, false, false, false, false, true];

/// By how much a union may leave the bounds given by the bodies' own shares and still be rounding: 10⁻⁹, more in `f32`.
pub(super) fn rounding<R: Real>() -> R {
    R::from_f64(1e-9).max(R::EPSILON * R::from_f64(64.0))
}

/// Bounds this close are one value, what remains is rounding: 10⁻¹³, more in `f32`.
pub(super) fn known<R: Real>() -> R {
    R::from_f64(1e-13).max(R::EPSILON * R::from_f64(256.0))
}

/// Narrow the bounds of a cell or face. Both pairs hold, so does their intersection, unless rounding has crossed it; a pair that
/// contradicts the bodies' own shares is not believed.
pub(super) fn narrow<R: Real>(lower: &mut R, sum: &mut R, found: Bounds<R>) {
    let (l, u) = (lower.max(found.lower), sum.min(R::ONE).min(found.upper));
    if l <= u {
        (*lower, *sum) = (l, u);
    } else if l - u <= rounding() {
        (*lower, *sum) = (u, l);
    }
}

/// Does a union lie within the bounds given by the bodies' own shares?
fn fits<R: Real>(lower: R, sum: R, found: Bounds<R>) -> bool {
    found.upper >= lower - rounding() && found.lower <= sum.min(R::ONE) + rounding()
}

/// A cell of a layer.
#[derive(Clone, Copy)]
pub(super) struct At {
    pub i: usize,
    pub j: usize,
    /// Cells of the layer along x and y.
    pub cells: [usize; 2],
}

impl At {
    pub fn cell(self) -> usize {
        self.j * self.cells[0] + self.i
    }

    /// The faces that the cell decides: its low ones, and at the upper ends of the grid the high ones; axis, position, and whether high.
    fn faces(self) -> impl Iterator<Item = (usize, usize, bool)> {
        let At { i, j, cells: [nx, ny] } = self;
        let (c, x) = (self.cell(), j * (nx + 1) + i);
        let low = [(0, x, false), (1, c, false), (2, c, false)].into_iter();
        let right = (i + 1 == nx).then_some((0, x + 1, true));
        low.chain(right).chain((j + 1 == ny).then_some((1, c + nx, true)))
    }

    pub fn cell_gap<R: Real>(self, layer: &Layer<R>) -> R {
        let (lower, sum) = (layer.lower.cell.get(self.cell()), layer.sum.cell.get(self.cell()));
        gap(lower.copied().unwrap_or_default(), sum.copied().unwrap_or_default())
    }

    /// The largest gap of the cell and of the faces that it decides, but for those in whose plane surface lies.
    pub fn largest_gap<R: Real>(self, layer: &Layer<R>) -> R {
        self.faces()
            .filter_map(|(axis, at, _)| free_face(layer, axis, at))
            .fold(self.cell_gap(layer), |most, (l, s)| most.max(gap(l, s)))
    }

    /// The cell and those of the faces that it decides of which bounds are apart.
    pub fn open_places<R: Real>(self, layer: &Layer<R>) -> [bool; PLACES] {
        let mut open = [self.cell_gap(layer) > known(), false, false, false, false, false, false];
        for (axis, at, high) in self.faces() {
            let is_open = free_face(layer, axis, at).is_some_and(|(lower, sum)| gap(lower, sum) > known());
            let place = 1 + axis + if high { 3 } else { 0 };
            open.get_mut(place).into_iter().for_each(|open| *open = is_open);
        }
        open
    }

    /// Does a union agree with the bodies' own shares of the cell and of those low faces that lie in no wall?
    /// Without `areas` nothing is known of z faces.
    pub fn agrees<R: Real>(self, layer: &Layer<R>, u: &Refined<R>, areas: bool) -> bool {
        let (Some(&lower), Some(&sum)) = (layer.lower.cell.get(self.cell()), layer.sum.cell.get(self.cell())) else {
            return false;
        };
        let low = self.faces().take(if areas { 3 } else { 2 });
        fits(lower, sum, u.cell)
            && low.zip(u.low).all(|((axis, at, _), found)| {
                free_face(layer, axis, at).is_none_or(|(lower, sum)| fits(lower, sum, found))
            })
    }

    /// Store what is known of the cell and of those of its faces that it decides.
    pub fn store<R: Real>(self, layer: &mut Layer<R>, refined: &Refined<R>) {
        let c = self.cell();
        if let (Some(lower), Some(sum)) = (layer.lower.cell.get_mut(c), layer.sum.cell.get_mut(c)) {
            narrow(lower, sum, refined.cell);
        }
        for (axis, at, high) in self.faces() {
            let side = if high { &refined.high } else { &refined.low };
            let (Some((lower, sum)), Some(&found)) = (free_face(layer, axis, at), side.get(axis)) else { continue };
            if !(gap(lower, sum) > R::ZERO) {
                continue;
            }
            let (lowers, sums) = layer.faces_mut(axis);
            if let (Some(lower), Some(sum)) = (lowers.get_mut(at), sums.get_mut(at)) {
                narrow(lower, sum, found);
            }
        }
    }
}

/// Lower bound and sum of a face in whose plane no surface lies.
fn free_face<R: Real>(layer: &Layer<R>, axis: usize, at: usize) -> Option<(R, R)> {
    let free = layer.has_surface.faces(axis).get(at) == Some(&0);
    free.then_some((*layer.lower.faces(axis).get(at)?, *layer.sum.faces(axis).get(at)?))
}
