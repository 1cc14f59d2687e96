//! Solids by formula in a layer: closed forms, and subdivision only where two of them truly meet in a cell.
//!
//! Shares of solids that do not meet add up, and that is exact. Which pairs meet is asked of GJK once for each pair of solids whose boxes
//! overlap. Only in a cell or face that two such solids share is their union subdivided; a solid that closes the cell settles it.

use super::convex::Convex;
use glam::DVec3;
use rayon::prelude::*;
use voidage_core::convex::gjk::{Intersection, intersect};
use voidage_core::convex::support::{Support, SupportPoint, Transformed};
use voidage_core::grid::Grid;
use voidage_core::grid::bounds::Bounds;
use voidage_core::grid::cell_range::{CellRange, RangeKind};
use voidage_core::grid::fields::Layer;
use voidage_core::number::aabb::Aabb;
use voidage_core::quadric::{AsQuadric, QuadricSolid};

/// Shares that leave 0 to 1 by more than this are not believed: the solid is subdivided in that layer.
const BELIEVED: f64 = 1e-9;

/// Sums this near to 1 are 1, as in the core's sums over surfaces.
const FULL: f64 = 1.0 - 256.0 * f64::EPSILON;

/// Solids that overlap by less than this share of their size are taken to touch.
const TOUCHING: f64 = 1e-9;

/// How two solids lie to each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Pair {
    /// They share no inner point, but may share a wall.
    Touching,
    /// They may share inner points.
    Meeting,
}

/// A solid by formula, and those that it meets.
#[derive(Debug, Clone)]
pub struct FormulaSolid {
    /// Its number among all bodies.
    pub body: usize,
    /// A box around it.
    pub bounds: Aabb<DVec3>,
    /// As GJK sees it.
    pub convex: Convex<'static>,
    solid: QuadricSolid,
    /// Numbers of the bodies that it meets or touches, ascending.
    partners: Vec<(usize, Pair)>,
}

/// A convex body of a round kind, as a support mapping.
struct Round<'a>(&'a Convex<'static>);

/// The same expression for each round kind; another for bodies of facets.
macro_rules! of_round {
    ($body:expr, $shape:ident => $value:expr, $other:expr) => {
        match $body {
            Convex::Sphere($shape) => $value,
            Convex::Ellipsoid($shape) => $value,
            Convex::Cylinder($shape) => $value,
            Convex::Capsule($shape) => $value,
            Convex::Cone($shape) => $value,
            Convex::Polytope(_) | Convex::Mesh(_) => $other,
        }
    };
}

impl Support for Round<'_> {
    type Vector = DVec3;
    const ROUNDED: bool = true;
    fn support(&self, direction: DVec3, start: u32) -> SupportPoint<DVec3> {
        of_round!(self.0, s => s.support(direction, start), SupportPoint { point: DVec3::NAN, index: 0 })
    }
    fn center(&self) -> DVec3 {
        of_round!(self.0, s => Support::center(s), DVec3::NAN)
    }
    fn extent(&self) -> f64 {
        of_round!(self.0, s => s.extent(), f64::INFINITY)
    }
    fn radius(&self) -> f64 {
        of_round!(self.0, s => Support::radius(s), 0.0)
    }
    fn slack(&self) -> f64 {
        of_round!(self.0, s => s.slack(), f64::INFINITY)
    }
}

/// The closed form of a body, if it has one.
#[must_use]
pub fn closed_form(body: &Convex<'static>) -> Option<QuadricSolid> {
    of_round!(body, s => s.quadric(), None)
}

/// How two solids lie to each other; none if they are apart.
fn pair(a: &Convex<'static>, b: &Convex<'static>) -> Option<Pair> {
    let (a, b) = (Round(a), Round(b));
    if matches!(intersect(&a, &b, None), Intersection::Apart { .. }) {
        return None;
    }
    let smaller = |s| {
        let shift = Support::center(&s) * TOUCHING;
        Transformed::new(s, DVec3::AXES, DVec3::splat(1.0 - TOUCHING), shift)
    };
    match intersect(&smaller(a), &smaller(b), None) {
        Intersection::Apart { .. } => Some(Pair::Touching),
        _ => Some(Pair::Meeting),
    }
}

/// Finds the partners of all solids, which are in the order of their numbers.
pub fn find_partners(solids: &mut [FormulaSolid]) {
    let mut order: Vec<usize> = (0..solids.len()).collect();
    order.sort_by(|&a, &b| solids[a].bounds.min.x.total_cmp(&solids[b].bounds.min.x));
    let found: Vec<(usize, usize, Pair)> = order
        .par_iter()
        .enumerate()
        .flat_map_iter(|(n, &a)| {
            let (solids, end) = (&*solids, solids[a].bounds.max.x);
            let later = order[n + 1..].iter().take_while(move |&&b| solids[b].bounds.min.x <= end);
            later.filter_map(move |&b| {
                let (one, other) = (&solids[a], &solids[b]);
                let pair = one.bounds.touches(other.bounds).then(|| pair(&one.convex, &other.convex))?;
                pair.map(|pair| (a, b, pair))
            })
        })
        .collect();
    for (a, b, pair) in found {
        let (one, other) = (solids[a].body, solids[b].body);
        solids[a].partners.push((other, pair));
        solids[b].partners.push((one, pair));
    }
    solids.iter_mut().for_each(|s| s.partners.sort_unstable_by_key(|p| p.0));
}

impl FormulaSolid {
    /// A body that has a closed form.
    #[must_use]
    pub fn new(body: usize, bounds: Aabb<DVec3>, convex: Convex<'static>) -> Option<Self> {
        let solid = closed_form(&convex)?;
        Some(FormulaSolid { body, bounds, convex, solid, partners: Vec::new() })
    }

    fn pair_with(&self, body: usize) -> Option<Pair> {
        let at = self.partners.binary_search_by_key(&body, |p| p.0).ok()?;
        Some(self.partners[at].1)
    }
}

/// A share of a place that others may have a share of too: kind of the place, its position, the solid among those at hand, the share.
type Entry = (u8, u32, u32, f64);

/// A thread's memory.
#[derive(Debug, Default)]
pub struct FormulaMemory {
    /// Sums of the shares of cells and x, y, z faces.
    sums: [Vec<f64>; 4],
    entries: Vec<Entry>,
}

const KINDS: [RangeKind; 4] = [RangeKind::Cells, RangeKind::Faces(0), RangeKind::Faces(1), RangeKind::Faces(2)];

fn number(kind: RangeKind) -> usize {
    match kind {
        RangeKind::Cells => 0,
        RangeKind::Faces(axis) => 1 + axis.min(2),
    }
}

/// What of a layer is wanted.
#[derive(Debug, Clone, Copy)]
pub enum LayerPart {
    /// Cells, and with true their low faces.
    Layer(usize, bool),
    /// The z faces in a plane.
    Plane(usize),
}

impl LayerPart {
    fn layer(self) -> usize {
        match self {
            LayerPart::Layer(k, _) | LayerPart::Plane(k) => k,
        }
    }

    /// Lowest and highest plane.
    #[must_use]
    pub fn planes(self) -> [usize; 2] {
        match self {
            LayerPart::Layer(k, _) => [k, k + 1],
            LayerPart::Plane(k) => [k, k],
        }
    }
}

/// Adds the union of some solids to a part of a layer. `union` gives bounds of the union of some of them in one cell or face. Returns those
/// whose shares cannot be relied on here; then nothing has been added.
pub fn add(
    solids: &[&FormulaSolid],
    grid: &Grid<f64>,
    part: LayerPart,
    memory: &mut FormulaMemory,
    layer: &mut Layer<f64>,
    mut union: impl FnMut(&[Convex<'static>], RangeKind, CellRange) -> Bounds<f64>,
) -> Vec<usize> {
    let mut doubtful = Vec::new();
    for (sums, kind) in memory.sums.iter_mut().zip(KINDS) {
        sums.clear();
        sums.resize(length(layer, kind), 0.0);
    }
    let FormulaMemory { sums, entries } = memory;
    entries.clear();
    for (n, s) in solids.iter().enumerate() {
        let alone = s.partners.is_empty();
        let mut visit = |kind: RangeKind, at: usize, share: f64| {
            let place = number(kind);
            if alone {
                sums[place][at] += share;
            } else {
                entries.push((place as u8, at as u32, n as u32, share));
            }
        };
        let worst = match part {
            LayerPart::Layer(k, areas) => s.solid.layer(grid, k, areas, &mut visit),
            LayerPart::Plane(plane) => {
                s.solid.plane(grid, plane, &mut visit);
                0.0
            }
        };
        if !(worst <= BELIEVED) {
            doubtful.push(n);
        }
    }
    if !doubtful.is_empty() {
        return doubtful;
    }
    for (sums, kind) in sums.iter_mut().zip(KINDS) {
        let (lower, sum) = values(layer, kind);
        for ((share, lower), sum) in sums.iter_mut().zip(lower).zip(sum) {
            if *share > 0.0 {
                let whole = if *share > FULL { 1.0 } else { *share };
                (*lower, *sum) = (lower.max(whole), *sum + whole);
            }
        }
    }
    add_shared(solids, grid, part, memory, layer, &mut union);
    doubtful
}

/// Adds the places that solids with partners have shares of; those of the others have been added.
fn add_shared(
    solids: &[&FormulaSolid],
    grid: &Grid<f64>,
    part: LayerPart,
    memory: &mut FormulaMemory,
    layer: &mut Layer<f64>,
    union: &mut impl FnMut(&[Convex<'static>], RangeKind, CellRange) -> Bounds<f64>,
) {
    let FormulaMemory { sums, entries } = memory;
    entries.sort_by_key(|e| (e.0, e.1, e.2));
    let mut shares: Vec<(usize, f64)> = Vec::new();
    let mut bodies: Vec<Convex<'static>> = Vec::new();
    for place in entries.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        let (kind, at) = (KINDS[usize::from(place[0].0)], place[0].1 as usize);
        shares.clear();
        for &(_, _, n, share) in place {
            match shares.last_mut() {
                // The parts of a capsule.
                Some((last, sum)) if *last == n as usize => *sum += share,
                _ => shares.push((n as usize, share)),
            }
        }
        let range = cell(grid, kind, at, part);
        let beside = |n: usize| ends_at(&solids[n].bounds, grid, kind, range);
        let meets = |a: usize| {
            let with = |&(b, _): &(usize, f64)| match solids[a].pair_with(solids[b].body) {
                None => false,
                Some(Pair::Meeting) => true,
                Some(Pair::Touching) => beside(a) && beside(b),
            };
            shares.iter().any(with)
        };
        let alone = sums[number(kind)][at];
        let mut found = Bounds { lower: alone, upper: alone };
        let (mut largest, mut sum) = (0.0_f64, 0.0);
        bodies.clear();
        for &(n, share) in &shares {
            let share = if share > FULL { 1.0 } else { share };
            if shares.len() > 1 && meets(n) {
                bodies.push(solids[n].convex);
                (largest, sum) = (largest.max(share), sum + share);
            } else {
                (found.lower, found.upper) = (found.lower + share, found.upper + share);
            }
        }
        if !bodies.is_empty() {
            let known = Bounds { lower: largest, upper: sum.min(1.0) };
            let known = if largest == 1.0 {
                known
            } else if shares.len() == bodies.len()
                && concentric(shares.iter().map(|&(n, _)| solids[n]), grid, kind, range)
            {
                Bounds { lower: largest, upper: largest }
            } else {
                narrowed(known, union(&bodies, kind, range))
            };
            (found.lower, found.upper) = (found.lower + known.lower, found.upper + known.upper);
        }
        let (lower, sum) = values(layer, kind);
        if found.lower > FULL {
            found = Bounds::CLOSED;
        }
        // The shares of those that meet nothing stand there already.
        lower[at] = lower[at].max(found.lower);
        sum[at] += found.upper - alone;
    }
}

/// Does a solid end in the plane of a face? Where two touch without that, their sections share no area.
fn ends_at(bounds: &Aabb<DVec3>, grid: &Grid<f64>, kind: RangeKind, range: CellRange) -> bool {
    let RangeKind::Faces(axis) = kind else { return false };
    let Some(&plane) = grid.edges(axis).get(range.lo[axis.min(2)] as usize) else { return true };
    let (low, high) = (bounds.min[axis.min(2)], bounds.max[axis.min(2)]);
    let near = TOUCHING * (high - low + plane.abs());
    (low - plane).abs() <= near || (high - plane).abs() <= near
}

/// Are all that the solids have of a face discs about one centre, flat ends in its plane? Then the largest holds the others.
fn concentric<'s>(
    solids: impl Iterator<Item = &'s FormulaSolid>,
    grid: &Grid<f64>,
    kind: RangeKind,
    range: CellRange,
) -> bool {
    let RangeKind::Faces(axis) = kind else { return false };
    let Some(&plane) = grid.edges(axis).get(range.lo[axis.min(2)] as usize) else { return false };
    let mut first = None;
    for solid in solids {
        let Some((center, _)) = solid.solid.ends_in_plane(axis, plane).next() else { return false };
        if *first.get_or_insert(center) != center {
            return false;
        }
    }
    first.is_some()
}

/// What both pairs of bounds say; the first where they contradict each other by rounding.
fn narrowed(a: Bounds<f64>, b: Bounds<f64>) -> Bounds<f64> {
    let both = Bounds { lower: a.lower.max(b.lower), upper: a.upper.min(b.upper) };
    if both.lower <= both.upper { both } else { Bounds { lower: a.lower, upper: a.lower } }
}

/// A single cell or face of a layer.
fn cell(grid: &Grid<f64>, kind: RangeKind, at: usize, part: LayerPart) -> CellRange {
    let row = match kind {
        RangeKind::Cells => grid.cells()[0],
        RangeKind::Faces(axis) => grid.face_shape(axis)[0],
    };
    let lo = [at % row, at / row, part.layer()].map(|n| n as u32);
    CellRange { lo, hi: lo.map(|n| n + 1) }
}

fn values<'l>(layer: &'l mut Layer<f64>, kind: RangeKind) -> (&'l mut [f64], &'l mut [f64]) {
    match kind {
        RangeKind::Cells => layer.cells_mut(),
        RangeKind::Faces(axis) => layer.faces_mut(axis),
    }
}

fn length(layer: &Layer<f64>, kind: RangeKind) -> usize {
    match kind {
        RangeKind::Cells => layer.sum().cells().len(),
        RangeKind::Faces(axis) => layer.sum().faces(axis).len(),
    }
}
