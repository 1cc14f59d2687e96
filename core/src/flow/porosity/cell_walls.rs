//! What kind of wall a cell holds, as its open fractions tell, and how far its gas flows along it or through it.
//!
//! The high open face of a cell less the low one, axis by axis, is the area vector A of the walls inside it (Gauss).
//!
//! - One component: a duct that changes its area, a layer or a body aligned with the grid. The stationary wave of a contraction
//!   acts there, and closed faces are walls that the gas meets.
//! - Several, and the fractions are those that a plane leaves: the wall of a body that the grid resolves. The stream runs along it,
//!   and the geometric form is exact for a uniform one.
//! - Several, the walls of all cells around have nearly the same normal, and the space beyond is open: the border of a porous layer or body askew to the
//!   grid. The stationary wave of a contraction acts along the normal alone ([`oblique_jump`](super::oblique_jump)).
//! - Several, and none of both, or a wall that is all but aligned while the space beyond is open: obstacles smaller than the cell, two walls of a gap, the
//!   corner of a turned body. The flow tells: along walls Σ A_d u_d = 0, through a contraction along one axis |Σ A_d u_d| = Σ |A_d u_d|, and the
//!   ratio of both is the weight of the stationary wave, axis by axis.
//!
//! The direction of A alone does not tell these apart: taking every cell with a second component for a wall costs a layer of random
//! obstacles 0.7 q at a porosity of 0.8 and 6 q at 0.5 where this choice loses 0.1 q and 0.25 q, and taking each for a border 1.6 q. Nor does the velocity alone:
//! before it has turned along a wall, the map would act there, and a layer askew of a porosity of 0.5 costs 0.5 to 1 q where its border costs 0.0003 q.
//! `tests/solver/inclined.rs` and `tests/solver/askew.rs` hold all sides.

use crate::flow::porosity::flags::{BORDER, is};
use crate::flow::porosity::fractions::Medium;
use crate::flow::state::{dot, sum};
use crate::number::real::Real;

/// Open fractions of a cell's two faces along an axis that differ by no more than this differ by rounding: of the geometry, of
/// fractions stored in single precision, or of the scalar. A wall so little inclined that it differs no more counts as aligned
/// with the grid, at an error of about this share over the Mach number in units of the dynamic pressure.
fn rounding<R: Real>() -> R {
    R::larger(R::from_f64(1e-6), R::from_f64(16.0) * R::EPSILON)
}

/// Do the open fractions of two faces differ by more than rounding?
fn differs<R: Real>(low: R, high: R) -> bool {
    (high - low).abs() > rounding()
}

/// The largest component of an area vector.
fn largest<R: Real, const D: usize>(area: [R; D]) -> R {
    area.iter().fold(R::ZERO, |most, a| R::larger(most, a.abs()))
}

/// The number of axes along which the two faces of a cell differ: of the components of the area vector of its walls.
fn components<R: Real, const D: usize>(openings: [(R, R); D]) -> usize {
    openings.iter().filter(|(low, high)| differs(*low, *high)).count()
}

/// Open fractions that differ by no more than this from those that a plane leaves are those of a wall which bends within the cell: a circle
/// of a radius of four cells or more. The border of a layer of porosity 0.8 at 45° to the grid differs by up to 0.06, one of 0.5 by more.
const BEND: f64 = 0.03;

/// Walls whose area vector has no second component above this share of the first are tilted so little that a cell does not tell their end from their going on.
const TILT: f64 = 0.1;

/// Least open volume of a cell that counts as crossed by a border, as a share of its widest face.
const NARROWEST: f64 = 0.1;

/// Cells beyond a wall that are looked at, at most.
const FURTHEST: usize = 6;

/// Cosine of the angle up to which the walls of cells side by side are parts of one border.
const GOES_ON: f64 = 0.9;

/// Porous bodies less open than this are walls to the gas beside them.
const DENSE: f64 = 0.05;

/// Solids are turned by so little, as a share, that nobody meant it.
const NOISE: f64 = 1e-3;

/// Halvings of the interval in which the best plane is searched for; its place is wanted to a share of what walls may bend.
const HALVINGS: usize = 20;

/// The walls of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
enum CellWalls<R, const D: usize> {
    /// None, or aligned with the grid.
    Aligned,
    /// Of the area vector given.
    Askew([R; D]),
}

impl<R: Real, const D: usize> Medium<'_, R, D> {
    /// Open fractions of the low and high faces of a cell, axis by axis.
    #[inline(always)]
    fn openings_of(&self, at: [usize; D]) -> [(R, R); D] {
        core::array::from_fn(|d| {
            let fraction = |face: usize| self.porosity.faces[d].get(face).copied().unwrap_or(R::ONE);
            let [low, high] = self.mesh.faces_of(d, at);
            (fraction(low), fraction(high))
        })
    }

    /// Open fraction of a cell.
    #[inline(always)]
    pub fn open_volume(&self, at: [usize; D]) -> R {
        self.porosity.volume.get(self.mesh.index(at)).copied().unwrap_or(R::ONE)
    }

    /// The walls of a cell. One with all its volume open holds none: what closes its faces lies in their planes.
    #[inline(always)]
    fn walls_of(&self, at: [usize; D]) -> CellWalls<R, D> {
        let open = self.open_volume(at);
        let least = rounding::<R>();
        if D == 1 || open >= R::ONE - least {
            return CellWalls::Aligned;
        }
        let openings = self.openings_of(at);
        if components(openings) < 2 || self.holds_corner(at, openings, open) {
            CellWalls::Aligned
        } else {
            CellWalls::Askew(openings.map(|(low, high)| high - low))
        }
    }

    /// Whether a cell holds the corner of a body aligned with the grid, or of the space beside one. The border of a layer of porosity 0.5 (in space 7/9)
    /// leaves the same fractions where it cuts off a corner of the cell, at any angle; but it goes on askew in the cells beside.
    #[inline(never)]
    fn holds_corner(&self, at: [usize; D], openings: [(R, R); D], open: R) -> bool {
        let Some(corner) = corner_of(openings, open) else { return false };
        let goes_on_askew = |d: usize| {
            let (low, high) = openings[d];
            if !differs(low, high) {
                return false;
            }
            let upward = (low < high) != (corner == Corner::Solid);
            self.beside(at, d, upward).is_some_and(|beside| self.is_askew_or_medium(beside))
        };
        !(0..D).any(goes_on_askew)
    }

    /// Has a cell walls along several axes that are not those of a box, or a part of all its faces closed and no walls?
    fn is_askew_or_medium(&self, at: [usize; D]) -> bool {
        let (open, least) = (self.open_volume(at), rounding::<R>());
        let openings = self.openings_of(at);
        match components(openings) {
            _ if open >= R::ONE - least => false,
            0 => openings.iter().all(|(low, _)| *low < R::ONE - least),
            1 => false,
            _ => corner_of(openings, open).is_none(),
        }
    }

    /// Whether a wall that is all but aligned with the grid is the front of something that gas passes: of a porous layer, or beside a slit. In one cell it
    /// looks like a plane wall that crosses the face; but beyond the face that would leave next to nothing open.
    fn is_front_of_duct(&self, at: [usize; D], area: [R; D]) -> bool {
        let openings = self.openings_of(at);
        let largest = largest(area);
        let tilts = area.iter().filter(|a| a.abs() > R::from_f64(TILT) * largest).count();
        let along = (0..D).find(|&d| area.get(d).is_some_and(|a| a.abs() >= largest));
        let (1, Some(d)) = (tilts, along) else { return false };
        let (low, high) = openings.get(d).copied().unwrap_or_default();
        let narrow = R::smaller(low, high);
        let beyond = self.beside(at, d, high < low);
        narrow > rounding() && beyond.is_some_and(|cell| self.open_volume(cell) >= R::HALF * narrow)
    }

    /// Whether a cell holds an inclined wall that tells what one of its faces across an axis is, of which so much is open. A wall tilted from the axis by less
    /// than [`NOISE`] does not, unless it closes the face but for so much: a jump there is that of something else, as of the mouth of a slit.
    pub fn holds_wall_at_face(&self, at: [usize; D], d: usize, open: R) -> bool {
        let noise = R::from_f64(NOISE);
        let changes = |area: [R; D]| area.get(d).is_some_and(|a| a.abs() > noise * largest(area));
        self.inclined_wall(at).is_some_and(|area| changes(area) || !(open > noise))
    }

    /// Whether a single wall askew to the grid, plane but for what it bends within a cell, leaves the open fractions of a cell.
    pub fn holds_inclined_wall(&self, at: [usize; D]) -> bool {
        self.inclined_wall(at).is_some()
    }

    /// The area vector of such a wall.
    fn inclined_wall(&self, at: [usize; D]) -> Option<[R; D]> {
        let CellWalls::Askew(area) = self.walls_of(at) else { return None };
        let wall = !self.is_front_of_duct(at, area) && self.fits_plane(at, area) && !self.on_border(at);
        wall.then_some(area)
    }

    /// Whether a plane wall of an area vector, but for what it bends, leaves the open fractions of a cell.
    fn fits_plane(&self, at: [usize; D], area: [R; D]) -> bool {
        // In double precision: a component of the normal may be a millionth of another.
        let open = self.open_volume(at).to_f64();
        let sum = area.iter().fold(0.0, |s, a| s + a.abs().to_f64());
        // The normal into the gas, mirrored so that the solid stands at the origin. What is no component but rounding drops out.
        let normal = area.map(|a| if a.abs() > rounding::<R>() { a.abs().to_f64() / sum } else { 0.0 });
        let openings = self.openings_of(at);
        // What the plane at an offset leaves open too much, and too little, at most. The first falls and the second rises with the offset.
        let misfit = |offset: f64| {
            let (mut much, mut little) = (0.0, 0.0);
            let mut compare = |plane: f64, found: f64| {
                much = f64::larger(plane - found, much);
                little = f64::larger(found - plane, little);
            };
            compare(beyond_plane(normal, offset), open);
            for d in 0..D {
                let mut flat = normal;
                flat[d] = 0.0;
                let (a, b) = openings[d];
                compare(beyond_plane(flat, offset), R::smaller(a, b).to_f64());
                compare(beyond_plane(flat, offset - normal[d]), R::larger(a, b).to_f64());
            }
            (much, little)
        };
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            let (much, little) = misfit(middle);
            if f64::larger(much, little) <= BEND {
                return true;
            }
            // An offset below leaves more too much, one above more too little: none fits.
            if f64::smaller(much, little) > BEND {
                return false;
            }
            if much > little { low = middle } else { high = middle }
        }
        false
    }

    /// The cell so many steps beyond another along an axis, into what the area vector of its walls says is solid; none outside the mesh.
    fn beyond(&self, at: [usize; D], area: [R; D], d: usize, steps: usize) -> Option<[usize; D]> {
        let falls = *area.get(d)? < R::ZERO;
        (0..steps).try_fold(at, |cell, _| self.beside(cell, d, falls))
    }

    /// The next cell along an axis, upward or downward, around periodic ends; none outside the mesh.
    fn beside(&self, at: [usize; D], d: usize, upward: bool) -> Option<[usize; D]> {
        let (place, cells) = (*at.get(d)?, *self.mesh.cells().get(d)?);
        let around = |k: usize| if self.periodic.get(d) == Some(&true) { Some(k) } else { None };
        let mut cell = at;
        *cell.get_mut(d)? = match upward {
            true if place + 1 < cells => place + 1,
            true => around(0)?,
            false => place.checked_sub(1).or(around(cells.wrapping_sub(1)))?,
        };
        Some(cell)
    }

    /// Whether the cells beyond the wall of a cell are open, and the faces that lead there, along the axis that leads behind a plane wall soonest: up to the first
    /// cell that lies behind it.
    fn goes_on_open(&self, at: [usize; D], area: [R; D]) -> bool {
        let size = |d: usize| area.get(d).map_or(R::ZERO, |a| a.abs());
        let all = sum::<R, D>(area.map(R::abs));
        let steps =
            |d: &usize| (1..=FURTHEST).find(|&steps| R::from_f64(steps as f64) * size(*d) >= all - rounding::<R>());
        let ways = (0..D).filter_map(|d| steps(&d).filter(|&n| self.beyond(at, area, d, n).is_some()).map(|n| (n, d)));
        let Some(least) = ways.clone().map(|(n, _)| n).min() else { return false };
        let limit = R::from_f64(DENSE);
        let is_open = |cell: [usize; D], d: usize| {
            let (low, high) = self.openings_of(cell).get(d).copied().unwrap_or_default();
            // Of the faces that lead from cell to cell and the cells themselves.
            let entered = if area.get(d).is_some_and(|a| *a < R::ZERO) { low } else { high };
            self.open_volume(cell) > limit && entered > limit
        };
        let open = |(n, d): (usize, usize)| (1..=n).filter_map(|n| self.beyond(at, area, d, n)).all(|c| is_open(c, d));
        // All that are as short: axes that are exchanged tell the same.
        ways.filter(|(n, _)| *n == least).all(open)
    }

    /// Area vector of the walls of a cell, per volume of the cell.
    fn area_of(&self, at: [usize; D]) -> [R; D] {
        let openings = self.openings_of(at);
        core::array::from_fn(|d| openings.get(d).map_or(R::ZERO, |(low, high)| *high - *low) / self.width_along(d, at))
    }

    /// Whether the border of a porous layer or body crosses a cell askew to the grid. It goes on in the cells around, which have
    /// no walls or such of nearly its normal, and what it encloses lets gas pass. Obstacles smaller than a cell, corners, and walls that meet have no
    /// such neighbours.
    ///
    /// A border may leave a cell with a wide face little volume, and lets pass no more than that; but where it is less than a tenth of the face,
    /// steps would be too short.
    #[inline(never)]
    pub fn holds_border(&self, at: [usize; D]) -> bool {
        let CellWalls::Askew(change) = self.walls_of(at) else { return false };
        if self.open_volume(at) < R::from_f64(NARROWEST) * self.widest(at) || !self.goes_on_open(at, change) {
            return false;
        }
        let own = self.area_of(at);
        let size = dot(own, own);
        let agrees = |cell: [usize; D]| {
            if components(self.openings_of(cell)) == 0 {
                return true;
            }
            let other = self.area_of(cell);
            let both = dot(own, other);
            both * both >= R::from_f64(GOES_ON * GOES_ON) * (size * dot(other, other))
        };
        self.mesh.around(at, self.periodic, agrees)
    }

    /// Whether a cell is marked as crossed by such a border.
    #[inline(always)]
    pub fn on_border(&self, at: [usize; D]) -> bool {
        self.porosity.marks.get(self.mesh.index(at)).is_some_and(|&m| is(m, BORDER))
    }

    /// Whether the low face of `at` along `d` stands inside the mesh, between two cells that no border crosses; else there may be one.
    #[inline(always)]
    pub fn is_far_from_borders(&self, d: usize, at: [usize; D]) -> bool {
        let crossed = |cell: usize| self.porosity.marks.get(cell).is_some_and(|&m| is(m, BORDER));
        let above = self.mesh.index(at);
        at[d] > 0
            && at[d] < self.mesh.cells()[d]
            && !crossed(above)
            && !crossed(above.wrapping_sub(self.mesh.face_stride(d)))
    }

    /// The border askew to the grid beside a face of axis `d`. None if there is none, and none at a side of the mesh: what stands outside knows no border.
    #[inline(never)]
    pub fn border(&self, d: usize, beside: [Option<[usize; D]>; 2]) -> Option<Border<R, D>> {
        let [Some(a), Some(b)] = beside else { return None };
        if D == 1 {
            return None;
        }
        let area = |cell: [usize; D]| if self.on_border(cell) { Some(self.area_of(cell)) } else { None };
        let areas = [area(a), area(b)];
        let both = match areas {
            [None, None] => return None,
            [Some(one), None] | [None, Some(one)] => one,
            // A layer enters one of the cells and leaves the other with opposite area vectors.
            [Some(a), Some(b)] if dot(a, b) < R::ZERO => core::array::from_fn(|d| a[d] - b[d]),
            [Some(a), Some(b)] => core::array::from_fn(|d| a[d] + b[d]),
        };
        let length = dot(both, both).sqrt();
        let along = both.get(d).copied().unwrap_or_default();
        let signed = if along < R::ZERO { -length } else { length };
        let duct = |side: usize| areas[side].map(|_| self.duct_askew(if side == 0 { a } else { b }));
        (length > R::ZERO).then(|| Border { normal: both.map(|a| a / signed), ducts: [duct(0), duct(1)] })
    }

    /// Whether there is such a border.
    #[inline(never)]
    pub fn has_border(&self, beside: [Option<[usize; D]>; 2]) -> bool {
        // A sealed cell, which is marked as the others are, has no walls.
        let crossed = |cell: [usize; D]| self.on_border(cell) && self.openings_of(cell).iter().any(|(a, b)| a != b);
        match beside {
            [Some(a), Some(b)] => crossed(a) || crossed(b),
            _ => false,
        }
    }

    /// Width of a cell along an axis.
    fn width_along(&self, d: usize, at: [usize; D]) -> R {
        at.get(d).and_then(|i| self.mesh.widths.get(d)?.get(*i)).copied().unwrap_or(R::ONE)
    }

    /// Duct area of a cell at a border, across whatever direction: its open volume, at most its widest face.
    fn duct_askew(&self, at: [usize; D]) -> R {
        R::smaller(self.open_volume(at), self.widest(at))
    }

    /// The most open face of a cell.
    pub fn widest(&self, at: [usize; D]) -> R {
        self.openings_of(at).iter().fold(R::ZERO, |w, (a, b)| R::larger(w, R::larger(*a, *b)))
    }

    /// How far gas of a momentum flows through the contraction that a cell is, 1, or along its walls, 0. Gas at rest does not care.
    ///
    /// What the fractions differ by is a share of the face: the area of a wall along an axis is that share of the cell's volume over its
    /// width there. A sum that rounding of the fractions may leave counts as none.
    #[inline(always)]
    pub fn contraction(&self, at: [usize; D], momentum: [R; D]) -> R {
        let CellWalls::Askew(area) = self.walls_of(at) else { return R::ONE };
        let width = |d: usize| self.mesh.widths[d].get(at[d]).copied().unwrap_or(R::ONE);
        let flow: [R; D] = core::array::from_fn(|d| momentum[d] / width(d));
        let through: [R; D] = core::array::from_fn(|d| area[d] * flow[d]);
        let size = sum::<R, D>(through.map(R::abs));
        let unsure = R::from_f64(16.0) * R::EPSILON * sum::<R, D>(flow.map(R::abs));
        let passes = sum::<R, D>(through).abs() - unsure;
        // Written so that gas whose momentum is no number gets 1 as well.
        if size > R::ZERO { R::larger(R::smaller(passes / size, R::ONE), R::ZERO) } else { R::ONE }
    }
}

/// The border of a porous layer askew to the grid, at a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Border<R, const D: usize> {
    /// Unit vector normal to it; the component along the axis of the face is not negative.
    pub normal: [R; D],
    /// Duct areas of the cells on the left and on the right across whatever direction; none of a cell that it does not cross.
    pub ducts: [Option<R>; 2],
}

/// A box that a cell holds in one of its corners.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Corner {
    /// Of the body: it closes a part of the less open face of each axis.
    Solid,
    /// Of the open space, which ends at the more open face of each axis.
    Open,
}

/// Whether a cell holds the corner of a body aligned with the grid, or is the space that such a corner leaves.
///
/// Either is a box: in a plane its area is the product of its sides, in space the square of its volume the product of its faces. A
/// plane cuts off half of that or less.
fn corner_of<R: Real, const D: usize>(openings: [(R, R); D], open: R) -> Option<Corner> {
    let least = rounding::<R>();
    let (mut components, mut product) = (0, R::ONE);
    // By how much the product changes with its factors.
    let mut slope = R::ZERO;
    let (mut solid_corner, mut open_corner) = (true, true);
    for (low, high) in openings {
        let change = (high - low).abs();
        if change > least {
            components += 1;
            slope = slope * change + product;
            product *= change;
            let part = change < R::ONE - least;
            solid_corner &= part & (R::larger(low, high) >= R::ONE - least);
            open_corner &= part & (R::smaller(low, high) <= least);
        }
    }
    // As far as rounding of the fractions tells: slivers have small products, whatever their shape.
    let is_box = |volume: R| match components {
        3 => (volume * volume - product).abs() <= least * (R::TWO * volume + slope),
        _ => (volume - product).abs() <= least * (R::ONE + slope),
    };
    if solid_corner && is_box(R::ONE - open) {
        return Some(Corner::Solid);
    }
    (open_corner && is_box(open)).then_some(Corner::Open)
}

/// Share of a unit box at the origin that lies where normal · x > offset; the components of the normal are not negative, and along those
/// that are 0 the box may be flat.
///
/// R. Scardovelli, S. Zaleski, J. Comput. Phys. 164 (2000) 228: an alternating sum over the corners.
fn beyond_plane<const D: usize>(normal: [f64; D], offset: f64) -> f64 {
    let mut spans = [0.0; 3];
    let (mut count, mut product, mut total) = (0, 1.0, 0.0);
    for span in normal.into_iter().filter(|&n| n > 0.0) {
        spans[count] = span;
        count += 1;
        product *= span * count as f64;
        total += span;
    }
    if !(offset > 0.0) {
        return 1.0;
    }
    if offset >= total {
        return 0.0;
    }
    let mut sum = 0.0;
    for corner in 0..1usize << count {
        let (mut height, mut sign) = (offset, 1.0);
        for (i, span) in spans[..count].iter().enumerate() {
            if corner >> i & 1 == 1 {
                height -= span;
                sign = -sign;
            }
        }
        let height = f64::larger(height, 0.0);
        sum += (0..count).fold(sign, |power, _| power * height);
    }
    1.0 - sum / product
}
