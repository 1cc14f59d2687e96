//! Which solids by formula meet: asked of GJK once for each two whose boxes overlap, unless capsules around them are apart.

use super::capsule::are_apart;
use super::round::Round;
use super::solid::{FormulaSolid, Kind, Pair, Partner};
use super::touching::Slab;
use crate::porosity::convex::Convex;
use glam::DVec3;
use rayon::prelude::*;
use voidage_core::convex::gjk::{Intersection, intersect};
use voidage_core::convex::support::{Support, SupportPoint, Transformed};
use voidage_core::number::aabb::Aabb;
use voidage_core::solids::torus::TorusSolid;

/// Solids that overlap by less than this share of their size are taken to touch.
pub(super) const TOUCHING: f64 = 1e-9;

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

/// Directions in which a solid is likely to end where another begins: along the axis of a rod, across the ends of a bend.
fn directions(kind: &Kind) -> Vec<DVec3> {
    let along = |[from, to]: [DVec3; 2]| vec![to - from];
    match kind {
        Kind::Quadric(_, Convex::Cylinder(s)) => along(s.ends()),
        Kind::Quadric(_, Convex::Cone(s)) => along(s.ends()),
        Kind::Quadric(_, Convex::Capsule(s)) => along([s.from, s.to]),
        Kind::Quadric(..) => Vec::new(),
        Kind::Torus(torus, _) => torus.ends().map(|(_, inward, _)| DVec3::from_array(inward)).collect(),
    }
}

/// How two convex bodies lie to each other; none if they are apart. With `directions` in which they may end.
fn pair(
    a: impl Support<Vector = DVec3> + Copy,
    b: impl Support<Vector = DVec3> + Copy,
    directions: &[DVec3],
) -> Option<Found> {
    if matches!(intersect(&a, &b, None), Intersection::Apart { .. }) {
        return None;
    }
    let Intersection::Apart { axis } = intersect(&smaller(a), &smaller(b), None) else {
        return Some((Pair::Meeting, Vec::new()));
    };
    // Along rods that lie beside each other what separates them is across both.
    let across = directions.iter().filter_map(|d| d.try_normalize()).map(|d| axis - d * d.dot(axis));
    let normals = directions.iter().copied().chain(across).chain([axis]);
    Some((Pair::Touching, Slab::between(&a, &b, normals).into_iter().collect()))
}

/// How two solids lie to each other, and if they touch what holds all that they have in common.
type Found = (Pair, Vec<Slab>);

/// A body, shrunk about its centre.
fn smaller<S: Support<Vector = DVec3>>(s: S) -> Transformed<S> {
    let shift = Support::center(&s) * TOUCHING;
    Transformed::new(s, DVec3::AXES, DVec3::splat(1.0 - TOUCHING), shift)
}

/// How two solids lie to each other; of tori, their pieces.
fn pair_of_solids(a: &Kind, b: &Kind) -> Option<Found> {
    if let (Kind::Quadric(_, a), Kind::Quadric(_, b)) = (a, b)
        && are_apart(a, b)
    {
        return None;
    }
    let both = || -> Vec<DVec3> { [a, b].into_iter().flat_map(directions).collect() };
    let worse = |a: Option<Found>, b: Option<Found>| match (a, b) {
        (Some((Pair::Touching, some)), Some((Pair::Touching, more))) => Some((Pair::Touching, [some, more].concat())),
        (met @ Some((Pair::Meeting, _)), _) | (_, met @ Some((Pair::Meeting, _))) => met,
        (found, None) | (None, found) => found,
    };
    match (a, b) {
        (Kind::Quadric(_, a), Kind::Quadric(_, b)) => pair(Round(a), Round(b), &both()),
        (Kind::Quadric(_, a), Kind::Torus(_, pieces)) | (Kind::Torus(_, pieces), Kind::Quadric(_, a)) => {
            let directions = both();
            pieces.iter().map(|piece| pair(Round(a), Hull(piece), &directions)).fold(None, worse)
        }
        (Kind::Torus(_, some), Kind::Torus(_, pieces)) => {
            let directions = &both();
            let pairs = |one| pieces.iter().map(move |piece| pair(Hull(one), Hull(piece), directions));
            some.iter().flat_map(pairs).fold(None, worse)
        }
    }
}

/// A box around a solid, along axes in some order, and the solid's number.
#[derive(Clone, Copy)]
struct Boxed {
    min: [f64; 3],
    max: [f64; 3],
    n: usize,
}

impl Boxed {
    /// Do boxes touch that do so along the first axis?
    fn touches(&self, other: &Self) -> bool {
        let touch = |axis: usize| self.min[axis] <= other.max[axis] && other.min[axis] <= self.max[axis];
        touch(1) && touch(2)
    }
}

/// The axes, first those along which boxes are shortest for the room that all of them take up: most pairs of them are apart along these.
fn widest_axes(solids: &[FormulaSolid]) -> [usize; 3] {
    let (mut all, mut sizes) = (Aabb { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY }, DVec3::ZERO);
    for FormulaSolid { bounds, .. } in solids {
        all = Aabb { min: all.min.min(bounds.min), max: all.max.max(bounds.max) };
        sizes += bounds.size();
    }
    let filled = sizes / all.size();
    let mut axes = [0, 1, 2];
    axes.sort_by(|&a, &b| filled[a].total_cmp(&filled[b]));
    axes
}

/// What `look` finds for two solids, for each two whose boxes touch.
pub(super) fn of_touching_boxes<T: Send>(
    solids: &[FormulaSolid],
    look: impl Fn(usize, usize) -> Option<T> + Sync,
) -> Vec<T> {
    let axes = widest_axes(solids);
    let boxed = |(n, s): (usize, &FormulaSolid)| {
        let [min, max] = [s.bounds.min, s.bounds.max].map(|corner| axes.map(|axis| corner[axis]));
        Boxed { min, max, n }
    };
    let mut boxes: Vec<Boxed> = solids.iter().enumerate().map(boxed).collect();
    boxes.sort_by(|a, b| a.min[0].total_cmp(&b.min[0]));
    let of_one = |(at, one): (usize, &Boxed)| {
        let (boxes, look, one) = (&boxes, &look, *one);
        let later = boxes[at + 1..].iter().take_while(move |other| other.min[0] <= one.max[0]);
        later.filter(move |other| one.touches(other)).filter_map(move |other| look(one.n, other.n))
    };
    boxes.par_iter().enumerate().flat_map_iter(of_one).collect()
}

/// Numbers all solids, and finds the partners of each.
pub fn find_partners(solids: &mut [FormulaSolid]) {
    solids.iter_mut().enumerate().for_each(|(n, s)| s.number = n);
    let look = |a: usize, b: usize| pair_of_solids(&solids[a].kind, &solids[b].kind).map(|found| (a, b, found));
    let found: Vec<(usize, usize, Found)> = of_touching_boxes(solids, look);
    for (a, b, (pair, common)) in found {
        let overlap = overlap(solids[a].bounds, solids[b].bounds);
        solids[a].partners.push(Partner { number: b, pair, common: common.clone(), overlap });
        solids[b].partners.push(Partner { number: a, pair, common, overlap });
    }
    solids.iter_mut().for_each(|s| s.partners.sort_unstable_by_key(|p| p.number));
}

/// What two boxes have in common, enlarged against rounding of the places where solids end.
fn overlap(a: Aabb<DVec3>, b: Aabb<DVec3>) -> Aabb<DVec3> {
    let (min, max) = (a.min.max(b.min), a.max.min(b.max));
    let margin = TOUCHING * (a.max.abs().max(a.min.abs()) + b.max.abs().max(b.min.abs()));
    Aabb { min: min - margin, max: max + margin }
}
