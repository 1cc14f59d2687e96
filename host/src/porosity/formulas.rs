//! Solids by formula in a layer: closed forms, and sections where two of them truly meet in a cell.
//!
//! Shares of solids that do not meet add up, and that is exact. Which pairs meet is asked of GJK once for each pair of solids whose boxes
//! overlap. Only in a cell or face that two such solids share is what they have in common taken off ([`voidage_core::quadric::excess`]); with
//! tori, or too many solids, their union is subdivided there. A solid that closes the cell settles it.

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
use voidage_core::quadric::{AsQuadric, QuadricSolid, excess};
use voidage_core::subdivide::SubdivisionRule;
use voidage_core::torus::{TorusShape, TorusSolid};

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
    kind: Kind,
    /// Numbers of the bodies that it meets or touches, ascending.
    partners: Vec<(usize, Pair)>,
}

#[derive(Debug, Clone)]
#[expect(clippy::large_enum_variant, reason = "there are few tori")]
enum Kind {
    /// By closed forms; as GJK sees it.
    Quadric(QuadricSolid, Convex<'static>),
    /// A torus, by quadrature, and the pieces of it whose hulls GJK sees in its place.
    Torus(TorusSolid, Vec<TorusSolid>),
}

/// A convex body of a round kind, as a support mapping.
#[derive(Clone, Copy)]
struct Round<'a>(&'a Convex<'static>);

/// The convex hull of a piece of a torus.
#[derive(Clone, Copy)]
struct Hull<'a>(&'a TorusSolid);

impl Support for Hull<'_> {
    type Vector = DVec3;
    const ROUNDED: bool = true;
    fn support(&self, direction: DVec3, _: u32) -> SupportPoint<DVec3> {
        SupportPoint { point: DVec3::from_array(self.0.outermost(direction.to_array())), index: 0 }
    }
    fn center(&self) -> DVec3 {
        DVec3::from_array(self.0.middle())
    }
    fn extent(&self) -> f64 {
        let far = |axis: usize| self.0.extent(axis).map(f64::abs).into_iter().fold(0.0, f64::max);
        far(0).max(far(1)).max(far(2)) + self.0.size()
    }
    fn slack(&self) -> f64 {
        // As of a cylinder: a handful of roundings in the frame, in the direction across the ring and in the sums.
        48.0 * f64::EPSILON * self.extent()
    }
}

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

/// How two convex bodies lie to each other; none if they are apart.
fn pair(a: impl Support<Vector = DVec3> + Copy, b: impl Support<Vector = DVec3> + Copy) -> Option<Pair> {
    if matches!(intersect(&a, &b, None), Intersection::Apart { .. }) {
        return None;
    }
    match intersect(&smaller(a), &smaller(b), None) {
        Intersection::Apart { .. } => Some(Pair::Touching),
        _ => Some(Pair::Meeting),
    }
}

/// A body, shrunk about its centre.
fn smaller<S: Support<Vector = DVec3>>(s: S) -> Transformed<S> {
    let shift = Support::center(&s) * TOUCHING;
    Transformed::new(s, DVec3::AXES, DVec3::splat(1.0 - TOUCHING), shift)
}

/// How two solids lie to each other; of tori, their pieces.
fn pair_of_solids(a: &Kind, b: &Kind) -> Option<Pair> {
    let worse = |a: Option<Pair>, b: Option<Pair>| match (a, b) {
        (Some(Pair::Meeting), _) | (_, Some(Pair::Meeting)) => Some(Pair::Meeting),
        (Some(Pair::Touching), _) | (_, Some(Pair::Touching)) => Some(Pair::Touching),
        (None, None) => None,
    };
    match (a, b) {
        (Kind::Quadric(_, a), Kind::Quadric(_, b)) => pair(Round(a), Round(b)),
        (Kind::Quadric(_, a), Kind::Torus(_, pieces)) | (Kind::Torus(_, pieces), Kind::Quadric(_, a)) => {
            pieces.iter().map(|piece| pair(Round(a), Hull(piece))).fold(None, worse)
        }
        (Kind::Torus(_, some), Kind::Torus(_, pieces)) => {
            some.iter().flat_map(|one| pieces.iter().map(move |piece| pair(Hull(one), Hull(piece)))).fold(None, worse)
        }
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
                let pair = one.bounds.touches(other.bounds).then(|| pair_of_solids(&one.kind, &other.kind))?;
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
        let kind = Kind::Quadric(closed_form(&convex)?, convex);
        Some(FormulaSolid { body, bounds, kind, partners: Vec::new() })
    }

    /// A torus; none if it has no size with which one can compute.
    #[must_use]
    pub fn torus(body: usize, shape: &TorusShape<DVec3>) -> Option<Self> {
        let solid = TorusSolid::new(shape)?;
        let extents = [0, 1, 2].map(|axis| solid.extent(axis));
        let [min, max] = [0, 1].map(|end| DVec3::from_array(extents.map(|e| e[end])));
        let pieces = solid.pieces((shape.angle / PIECE).ceil() as u32).collect();
        Some(FormulaSolid { body, bounds: Aabb { min, max }, kind: Kind::Torus(solid, pieces), partners: Vec::new() })
    }

    /// As GJK sees it, if it is convex.
    #[must_use]
    pub fn convex(&self) -> Option<Convex<'static>> {
        match &self.kind {
            Kind::Quadric(_, convex) => Some(*convex),
            Kind::Torus(..) => None,
        }
    }

    /// May it reach a box, if it is not convex? Of a convex one GJK tells.
    #[must_use]
    pub fn torus_may_reach(&self, cell: Aabb<DVec3>) -> bool {
        matches!(&self.kind, Kind::Torus(solid, _) if solid.may_reach(cell.min.to_array(), cell.max.to_array()))
    }

    /// Its share of one cell or face, and what that may be off by.
    #[must_use]
    pub fn share(&self, kind: RangeKind, cell: Aabb<DVec3>) -> Bounds<f64> {
        let (share, error) = match &self.kind {
            Kind::Torus(solid, _) => solid.share(kind, cell.min.to_array(), cell.max.to_array()),
            Kind::Quadric(solid, _) => share_of_quadric(solid, kind, cell),
        };
        Bounds { lower: (share - error).max(0.0), upper: (share + error).min(1.0) }
    }

    /// Centres of the flat ends that lie in a plane, and their radii.
    fn ends_in_plane(&self, axis: usize, plane: f64) -> Vec<(DVec3, f64)> {
        match &self.kind {
            Kind::Quadric(solid, _) => {
                solid.ends_in_plane(axis, plane).map(|(center, radius)| (DVec3::from_array(center), radius)).collect()
            }
            Kind::Torus(solid, _) => {
                let lies = |(center, inward, radius): ([f64; 3], [f64; 3], f64)| {
                    let center = DVec3::from_array(center);
                    (inward[axis].abs() == 1.0 && center[axis] == plane).then_some((center, radius))
                };
                solid.ends().filter_map(lies).collect()
            }
        }
    }

    /// The same solid once more.
    fn is_same(&self, other: &FormulaSolid) -> bool {
        matches!((&self.kind, &other.kind), (Kind::Quadric(one, _), Kind::Quadric(another, _)) if one == another)
    }

    fn pair_with(&self, body: usize) -> Option<Pair> {
        let at = self.partners.binary_search_by_key(&body, |p| p.0).ok()?;
        Some(self.partners[at].1)
    }
}

/// What a quadric has of one cell or face.
fn share_of_quadric(solid: &QuadricSolid, kind: RangeKind, cell: Aabb<DVec3>) -> (f64, f64) {
    let [mut x, mut y, mut z] = [0, 1, 2].map(|n| [cell.min[n], cell.max[n]]);
    if let RangeKind::Faces(axis) = kind {
        // Of a face the cell above.
        let size = (cell.max - cell.min).max_element();
        let side = [&mut x, &mut y, &mut z];
        for (n, side) in side.into_iter().enumerate() {
            if n == axis.min(2) {
                side[1] = side[0] + size;
            }
        }
    }
    let Ok(grid) = Grid::new(&x, &y, &z) else { return (0.0, 1.0) };
    let mut found = 0.0;
    let worst = solid.layer(&grid, 0, kind != RangeKind::Cells, &mut |told, at, share| {
        if told == kind && at == 0 {
            found += share;
        }
    });
    (f64::min(found, 1.0), if worst <= BELIEVED { BELIEVED * 1e-3 } else { 1.0 })
}

/// Bounds of the union of some solids in one cell or face: shares of single ones are known, so only parts in which several have one are divided.
fn divided(solids: &[&FormulaSolid], kind: RangeKind, cell: Aabb<DVec3>, rule: SubdivisionRule<f64>) -> Bounds<f64> {
    let mut found = Bounds { lower: 0.0, upper: 0.0 };
    let axes: Vec<usize> = (0..3).filter(|&n| kind != RangeKind::Faces(n)).collect();
    let mut waiting = vec![(cell, 0_u32)];
    let most = rule.depth.saturating_add(DEEPER);
    while let Some((part, depth)) = waiting.pop() {
        let weight = 0.5_f64.powi(depth as i32 * axes.len() as i32);
        let shares = solids.iter().map(|s| s.share(kind, part));
        let (lower, sum, several) = shares.fold((0.0_f64, 0.0, 0), |(lower, sum, several), share| {
            (lower.max(share.lower), sum + share.upper, several + usize::from(share.upper > 0.0))
        });
        let upper = f64::min(sum, 1.0);
        // Parts along a curve, two of each before: their gaps sum to about the tolerance.
        let room = rule.tol * 0.5_f64.powi(depth as i32) / 8.0;
        if several < 2 || lower >= 1.0 - BELIEVED || depth >= most || (upper - lower) * weight <= room {
            (found.lower, found.upper) = (found.lower + lower * weight, found.upper + upper * weight);
            continue;
        }
        let middle = (part.min + part.max) * 0.5;
        for n in 0..1_usize << axes.len() {
            let mut half = part;
            for (bit, &axis) in axes.iter().enumerate() {
                if n >> bit & 1 == 0 { half.max[axis] = middle[axis] } else { half.min[axis] = middle[axis] }
            }
            waiting.push((half, depth + 1));
        }
    }
    Bounds { lower: found.lower, upper: found.upper.min(1.0) }
}

/// How much deeper than others the unions with tori are divided: only along the curve in which two surfaces meet.
const DEEPER: u32 = 3;

/// Pieces of a torus are this long at most, in degrees.
const PIECE: f64 = 12.0;

/// A share of a place that others may have a share of too: kind of the place, its position, the solid among those at hand, the share
/// and what it may be off by.
type Entry = (u8, u32, u32, [f64; 2]);

/// A thread's memory.
#[derive(Debug, Default)]
pub struct FormulaMemory {
    /// Sums of the shares of cells and x, y, z faces.
    sums: [Vec<f64>; 4],
    entries: Vec<Entry>,
    /// Cells so far in which solids meet.
    pub shared: usize,
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
    rule: SubdivisionRule<f64>,
    mut union: impl FnMut(&[Convex<'static>], RangeKind, CellRange) -> Bounds<f64>,
) -> Vec<usize> {
    let mut doubtful = Vec::new();
    for (sums, kind) in memory.sums.iter_mut().zip(KINDS) {
        sums.clear();
        sums.resize(length(layer, kind), 0.0);
    }
    let FormulaMemory { sums, entries, .. } = memory;
    entries.clear();
    for (n, s) in solids.iter().enumerate() {
        let worst = match &s.kind {
            Kind::Torus(solid, _) => {
                tell_torus(solid, grid, part, n as u32, entries);
                0.0
            }
            Kind::Quadric(solid, _) => {
                let alone = s.partners.is_empty();
                let mut visit = |kind: RangeKind, at: usize, share: f64| {
                    if alone {
                        sums[number(kind)][at] += share;
                    } else {
                        entries.push((number(kind) as u8, at as u32, n as u32, [share, 0.0]));
                    }
                };
                match part {
                    LayerPart::Layer(k, areas) => solid.layer(grid, k, areas, &mut visit),
                    LayerPart::Plane(plane) => {
                        solid.plane(grid, plane, &mut visit);
                        0.0
                    }
                }
            }
        };
        if !(worst <= BELIEVED) {
            doubtful.push(n);
        }
    }
    if !doubtful.is_empty() {
        return doubtful;
    }
    add_alone(sums, layer);
    add_shared(solids, grid, part, memory, layer, rule.tol, &mut |meeting, kind, range| {
        let convex: Option<Vec<Convex<'static>>> = meeting.iter().map(|s| s.convex()).collect();
        match (convex, box_of(grid, kind, range)) {
            (Some(bodies), _) => union(&bodies, kind, range),
            (None, Some(cell)) => divided(meeting, kind, cell, rule),
            (None, None) => Bounds::UNKNOWN,
        }
    });
    doubtful
}

/// Adds the shares of solids that meet no other.
fn add_alone(sums: &[Vec<f64>; 4], layer: &mut Layer<f64>) {
    for (sums, kind) in sums.iter().zip(KINDS) {
        let (lower, sum) = values(layer, kind);
        for ((share, lower), sum) in sums.iter().zip(lower).zip(sum) {
            if *share > 0.0 {
                let whole = if *share > FULL { 1.0 } else { *share };
                (*lower, *sum) = (lower.max(whole), *sum + whole);
            }
        }
    }
}

/// The shares of a torus, with what each may be off by.
fn tell_torus(solid: &TorusSolid, grid: &Grid<f64>, part: LayerPart, n: u32, entries: &mut Vec<Entry>) {
    let first = entries.len();
    let mut visit = |kind: RangeKind, at: usize, share: f64, error: f64| {
        entries.push((number(kind) as u8, at as u32, n, [share, error]));
    };
    match part {
        LayerPart::Layer(k, areas) => {
            let worst = solid.layer(grid, k, areas, &mut visit);
            if worst > 0.0 {
                entries[first..].iter_mut().for_each(|e| e.3[1] += worst);
            }
        }
        LayerPart::Plane(plane) => solid.plane(grid, plane, &mut visit),
    }
}

/// Adds the places that solids with partners have shares of; those of the others have been added.
fn add_shared(
    solids: &[&FormulaSolid],
    grid: &Grid<f64>,
    part: LayerPart,
    memory: &mut FormulaMemory,
    layer: &mut Layer<f64>,
    tol: f64,
    union: &mut impl FnMut(&[&FormulaSolid], RangeKind, CellRange) -> Bounds<f64>,
) {
    let FormulaMemory { sums, entries, shared } = memory;
    entries.sort_by_key(|e| (e.0, e.1, e.2));
    let mut shares: Vec<(usize, [f64; 2])> = Vec::new();
    let mut bodies: Vec<&FormulaSolid> = Vec::new();
    for place in entries.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        let (kind, at) = (KINDS[usize::from(place[0].0)], place[0].1 as usize);
        shares.clear();
        place.iter().for_each(|entry| add_share(&mut shares, entry));
        let range = cell(grid, kind, at, part);
        let beside = |n: usize| ends_at(&solids[n].bounds, grid, kind, range);
        let meets = |a: usize| {
            let with = |&(b, _): &(usize, [f64; 2])| match solids[a].pair_with(solids[b].body) {
                None => false,
                Some(Pair::Meeting) => true,
                Some(Pair::Touching) => beside(a) && beside(b),
            };
            shares.iter().any(with)
        };
        let alone = sums[number(kind)][at];
        let mut found = Bounds { lower: alone, upper: alone };
        let (mut largest, mut sum) = (0.0_f64, Bounds { lower: 0.0, upper: 0.0 });
        bodies.clear();
        for &(n, [share, error]) in &shares {
            let share = if share > FULL { 1.0 } else { share };
            let (low, high) = ((share - error).max(0.0), share + error);
            if bodies.iter().any(|other| other.is_same(solids[n])) {
                continue;
            }
            if shares.len() > 1 && meets(n) {
                bodies.push(solids[n]);
                (largest, sum) = (largest.max(low), Bounds { lower: sum.lower + low, upper: sum.upper + high });
            } else {
                (found.lower, found.upper) = (found.lower + low, found.upper + high);
            }
        }
        if !bodies.is_empty() {
            *shared += usize::from(kind == RangeKind::Cells);
            let known = Bounds { lower: largest, upper: sum.upper.min(1.0) };
            let ends =
                if shares.iter().all(|&(n, _)| meets(n)) { concentric(&bodies, grid, kind, range) } else { None };
            let errors: f64 = shares.iter().map(|(_, [_, error])| 2.0 * error).sum();
            let known = match ends {
                _ if largest == 1.0 => known,
                Some(apart) => Bounds { lower: largest, upper: (largest + errors + apart).min(1.0) },
                None => match box_of(grid, kind, range).and_then(|cell| by_sections(&bodies, sum, cell, tol)) {
                    Some(found) if found.gap() <= 2.0 * tol => narrowed(known, found),
                    found => narrowed(found.map_or(known, |f| narrowed(known, f)), union(&bodies, kind, range)),
                },
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

/// The union of solids of which all have closed forms, by what they have in common; `sum` is that of their shares. None if there are too many of
/// them.
fn by_sections(solids: &[&FormulaSolid], sum: Bounds<f64>, cell: Aabb<DVec3>, tol: f64) -> Option<Bounds<f64>> {
    fn quadric<'s>(s: &&'s FormulaSolid) -> Option<&'s QuadricSolid> {
        match &s.kind {
            Kind::Quadric(solid, _) => Some(solid),
            Kind::Torus(..) => None,
        }
    }
    let quadrics: Vec<&QuadricSolid> = solids.iter().map(quadric).collect::<Option<_>>()?;
    let sides = [0, 1, 2].map(|n| [cell.min[n], cell.max[n]]);
    let size: f64 = sides.iter().map(|[lo, hi]| hi - lo).filter(|width| *width > 0.0).product();
    let flat = sides.iter().any(|[lo, hi]| lo == hi);
    let enough = if flat { EXACT } else { tol };
    let [low, high] = excess(quadrics, sides, enough * size)?;
    Some(Bounds { lower: (sum.lower - high / size).max(0.0), upper: (sum.upper - low / size).min(1.0) })
}

/// Areas that solids have in common are wanted this close, as a share of a face.
const EXACT: f64 = 1e-13;

/// Adds an entry to the shares of a place, ordered by solids.
fn add_share(shares: &mut Vec<(usize, [f64; 2])>, &(_, _, n, share): &Entry) {
    match shares.last_mut() {
        // The parts of a capsule.
        Some((last, sum)) if *last == n as usize => *sum = [sum[0] + share[0], sum[1] + share[1]],
        _ => shares.push((n as usize, share)),
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

/// Are all that the solids have of a face discs about one centre but for rounding, flat ends in its plane? Then the largest holds the others, but
/// for the share of the face that is told.
fn concentric(solids: &[&FormulaSolid], grid: &Grid<f64>, kind: RangeKind, range: CellRange) -> Option<f64> {
    let RangeKind::Faces(axis) = kind else { return None };
    let &plane = grid.edges(axis).get(range.lo[axis.min(2)] as usize)?;
    let mut first: Option<DVec3> = None;
    let mut beside = 0.0;
    for solid in solids {
        let &(center, radius) = solid.ends_in_plane(axis, plane).first()?;
        let off = first.get_or_insert(center).distance(center);
        if off > TOUCHING * radius {
            return None;
        }
        beside += 4.0 * off * radius;
    }
    let size = box_of(grid, kind, range)?.size();
    let area: f64 = (0..3).filter(|&n| n != axis).map(|n| size[n]).product();
    first.map(|_| beside / area)
}

/// A single cell or face.
fn box_of(grid: &Grid<f64>, kind: RangeKind, range: CellRange) -> Option<Aabb<DVec3>> {
    let mut cell = Aabb { min: DVec3::ZERO, max: DVec3::ZERO };
    for axis in 0..3 {
        let at = range.lo[axis] as usize;
        cell.min[axis] = *grid.edges(axis).get(at)?;
        cell.max[axis] = if kind == RangeKind::Faces(axis) { cell.min[axis] } else { *grid.edges(axis).get(at + 1)? };
    }
    Some(cell)
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
