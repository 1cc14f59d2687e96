//! One solid by formula: its shares of cells and faces, and those that it meets.

use super::round::closed_form;
use super::touching::Slab;
use crate::porosity::convex::Convex;
use glam::DVec3;
use std::ops::Range;
use voidage_core::grid::Grid;
use voidage_core::grid::bounds::Bounds;
use voidage_core::number::aabb::Aabb;
use voidage_core::solids::enclosure::{BoxAround, Enclosed, Enclosure};
use voidage_core::solids::quadric::QuadricSolid;
use voidage_core::solids::torus::{TorusShape, TorusSolid};
use voidage_core::subdivide::Subdividable;

/// Shares that leave 0 to 1 by more than this are not believed: the solid is subdivided in that layer.
pub(super) const BELIEVED: f64 = 1e-9;

/// Pieces of a torus are this long at most, in degrees.
const PIECE: f64 = 12.0;

/// How two solids lie to each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Pair {
    /// They share no inner point but for a share of 1e-9 of their size, which is told; they may share a wall.
    Touching,
    /// They may share inner points.
    Meeting,
}

/// A solid by formula, or what is left of it beside others, and those that it meets.
#[derive(Debug, Clone)]
pub struct FormulaSolid {
    /// The number of its body; several that are parts of one have the same.
    pub body: usize,
    /// Its own among all solids.
    pub(super) number: usize,
    /// A box around it.
    pub bounds: Aabb<DVec3>,
    pub(super) kind: Kind,
    /// The solids that it meets or touches, by ascending numbers.
    pub(super) partners: Vec<Partner>,
}

/// A solid that another one meets or touches.
#[derive(Debug, Clone)]
pub(super) struct Partner {
    pub number: usize,
    pub pair: Pair,
    /// Of one that it touches, what holds all that both have in common beyond rounding.
    pub common: Vec<Slab>,
    /// The box outside of which they share no cell or face.
    pub overlap: Aabb<DVec3>,
}

#[derive(Debug, Clone)]
#[expect(clippy::large_enum_variant, reason = "there are few tori")]
pub(super) enum Kind {
    /// By closed forms; as GJK sees it.
    Quadric(QuadricSolid, Convex<'static>),
    /// A torus, by quadrature, and the pieces of it whose hulls GJK sees in its place.
    Torus(TorusSolid, Vec<TorusSolid>),
}

impl FormulaSolid {
    /// A body that has a closed form.
    #[must_use]
    pub fn new(body: usize, convex: Convex<'static>) -> Option<Self> {
        let kind = Kind::Quadric(closed_form(&convex)?, convex);
        Some(FormulaSolid { body, number: 0, bounds: Subdividable::bounds(&convex), kind, partners: Vec::new() })
    }

    /// A torus; none if it has no size with which one can compute.
    #[must_use]
    pub fn torus(body: usize, shape: &TorusShape<DVec3>) -> Option<Self> {
        let solid = TorusSolid::new(shape)?;
        let extents = [0, 1, 2].map(|axis| solid.extent(axis));
        let [min, max] = [0, 1].map(|end| DVec3::from_array(extents.map(|e| e[end])));
        let pieces = solid.pieces((shape.angle / PIECE).ceil() as u32).collect();
        let kind = Kind::Torus(solid, pieces);
        Some(FormulaSolid { body, number: 0, bounds: Aabb { min, max }, kind, partners: Vec::new() })
    }

    /// Of how many parts sections are made.
    pub(super) fn part_count(&self) -> usize {
        match &self.kind {
            Kind::Quadric(solid, _) => solid.part_count(),
            Kind::Torus(..) => 1,
        }
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

    /// Centres of the flat ends that lie in a plane, and their radii.
    pub(super) fn ends_in_plane(&self, axis: usize, plane: f64) -> Vec<(DVec3, f64)> {
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
    pub(super) fn is_same(&self, other: &FormulaSolid) -> bool {
        match (&self.kind, &other.kind) {
            (Kind::Quadric(one, _), Kind::Quadric(another, _)) => one == another,
            (Kind::Torus(one, _), Kind::Torus(another, _)) => one == another,
            _ => false,
        }
    }

    pub(super) fn pair_with(&self, other: &FormulaSolid) -> Option<Pair> {
        self.partner(other).map(|partner| partner.pair)
    }

    /// No less than the share of a cell or face that it has in common with one that it touches.
    pub(super) fn common_with(&self, other: &FormulaSolid, place: &BoxAround) -> f64 {
        self.partner(other).map_or(0.0, |partner| partner.common.iter().fold(0.0, |sum, slab| sum + slab.share(place)))
    }

    fn partner(&self, other: &FormulaSolid) -> Option<&Partner> {
        let at = self.partners.binary_search_by_key(&other.number, |p| p.number).ok()?;
        self.partners.get(at)
    }

    /// Rows and columns of cells and faces, by their numbers along x and y, of which partners may have a share too between two planes across z.
    pub(super) fn shared_with_partners(&self, grid: &Grid<f64>, z: [f64; 2]) -> [Range<usize>; 2] {
        let mut bounds = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for Partner { overlap: Aabb { min, max }, .. } in &self.partners {
            if min.z <= z[1] && max.z >= z[0] {
                bounds = [0, 1].map(|axis| [bounds[axis][0].min(min[axis]), bounds[axis][1].max(max[axis])]);
            }
        }
        [0, 1].map(|axis| {
            let (edges, [lo, hi]) = (grid.edges(axis), bounds[axis]);
            if lo > hi {
                return 0..0;
            }
            // The plane above a cell has the number of the next one.
            edges.partition_point(|&e| e < lo).saturating_sub(1)..edges.partition_point(|&e| e <= hi) + 1
        })
    }
}

impl Enclosed for &FormulaSolid {
    fn enclosures(&self, place: &BoxAround, tell: &mut impl FnMut(Enclosure)) {
        match &self.kind {
            Kind::Quadric(solid, _) => solid.enclosures(place, tell),
            Kind::Torus(solid, _) => solid.enclosures(place, tell),
        }
    }

    fn is_apart(&self, other: &Self, place: &BoxAround) -> bool {
        match self.pair_with(other) {
            None => true,
            // Two that end in the plane of a face share some of it.
            Some(Pair::Touching) => place.half.iter().all(|half| *half > 0.0),
            Some(Pair::Meeting) => false,
        }
    }

    fn share(&self, place: &BoxAround) -> Bounds<f64> {
        match &self.kind {
            Kind::Quadric(solid, _) => Enclosed::share(solid, place),
            Kind::Torus(solid, _) => Enclosed::share(solid, place),
        }
    }

    fn price(&self) -> f64 {
        match &self.kind {
            Kind::Quadric(solid, _) => solid.price(),
            Kind::Torus(solid, _) => solid.price(),
        }
    }
}
