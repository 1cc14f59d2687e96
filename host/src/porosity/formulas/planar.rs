//! Solids by formula in a cell with bodies that have few planes there: pipes on a floor, columns on a slab, pipes through a wall or the web of a beam.
//!
//! A solid that reaches a plane by no more than rounding, or than the tolerance allows, lies beyond the body or within it: then nothing has to be found out.
//! For the others the union is bounded by planes between which their surfaces lie.

use super::round::Round;
use super::solid::{FormulaSolid, Kind, Pair};
use super::touching::{Slab, TOLD};
use super::union::{FIRST, ends_in};
use glam::DVec3;
use voidage_core::convex::support::Support;
use voidage_core::grid::bounds::Bounds;
use voidage_core::number::aabb::Aabb;
use voidage_core::solids::enclosure::{BoxAround, Enclosed, Enclosure, UnionEffort, union_bounds};
use voidage_core::surface::PlanarPart;

/// As little counts in any case.
const LEAST: f64 = 1e-12;

/// Where bounds come close enough by that, so many times as much is looked at: not where surfaces coincide, as those of a pipe and of a bore with its radius.
const MORE: usize = 32;

/// Bounds of the union of some solids and bodies in a cell, in its low x, y and z face and in its high ones, so far as they are `wanted`; in a face, flat
/// along one axis, all are its own.
pub fn union_with(
    solids: &[&FormulaSolid],
    bodies: &[PlanarPart<f64>],
    (cell, wanted): (Aabb<DVec3>, [bool; 7]),
    tol: f64,
) -> [Bounds<f64>; 7] {
    let sides = [0, 1, 2].map(|n| [cell.min[n], cell.max[n]]);
    let union = |face: Option<(usize, usize)>| {
        let mut sides = sides;
        if let Some((axis, end)) = face {
            sides[axis] = [sides[axis][end]; 2];
        }
        union_in(solids, bodies, sides, face.map(|(axis, _)| axis), tol)
    };
    if let Some(axis) = (0..3).find(|&n| sides[n][0] == sides[n][1]) {
        return [union(Some((axis, 0))); 7];
    }
    let places = [None, Some((0, 0)), Some((1, 0)), Some((2, 0)), Some((0, 1)), Some((1, 1)), Some((2, 1))];
    std::array::from_fn(|n| if wanted[n] { union(places[n]) } else { Bounds::UNKNOWN })
}

/// Bounds of the union in a cell, or in a face normal to an axis.
fn union_in(
    solids: &[&FormulaSolid],
    parts: &[PlanarPart<f64>],
    sides: [[f64; 2]; 3],
    axis: Option<usize>,
    tol: f64,
) -> Bounds<f64> {
    let place = &BoxAround::new(sides);
    let room = (TOLD * tol).max(LEAST);
    // How much the union may be more than what is found, or less, for what solids reach beyond planes.
    let (mut more, mut less) = (0.0, 0.0);
    let bodies: Vec<_> = parts.chunk_by(|a, b| a.body == b.body).collect();
    let (mut members, mut apart): (Vec<Member>, bool) = (Vec::new(), bodies.len() == 1);
    let mut alone: Vec<&FormulaSolid> = Vec::new();
    'solids: for &solid in solids.iter().filter(|s| reaches(s, place)) {
        let mut beyond = 0.0;
        for body in &bodies {
            match place_of(solid, body, place, room) {
                Place::Within(share) => {
                    more += share;
                    continue 'solids;
                }
                Place::Beyond(share) => beyond += share,
                Place::Across => apart = false,
            }
        }
        less += beyond;
        for other in &alone {
            let meet = meet(solid, other, axis, sides);
            apart = apart && !meet;
            // What meets in a face is found out.
            less += if meet && axis.is_some() { 0.0 } else { solid.common_with(other, place) };
        }
        alone.push(solid);
        members.push(Member::Solid(solid));
    }
    // One by one, so that a place is only compared with those near it.
    members.extend(parts.iter().map(Member::Part));
    let sum = members.iter().map(|member| member.share(place)).fold(Bounds::OPEN, |sum: Bounds<f64>, share| Bounds {
        lower: sum.lower + share.lower,
        upper: sum.upper + share.upper,
    });
    let effort = UnionEffort { tol: 0.5 * tol, most: FIRST, more: MORE };
    let found = if apart { sum } else { union_bounds(&members, sides, sum, effort) };
    Bounds { lower: (found.lower - less).clamp(0.0, 1.0), upper: (found.upper + more).min(1.0) }
}

fn reaches(solid: &FormulaSolid, place: &BoxAround) -> bool {
    let mut reaches = false;
    (&solid).enclosures(place, &mut |enclosure| reaches |= matches!(enclosure, Enclosure::Within(_)));
    reaches
}

/// May two solids share more of a cell or face than a wall? In a face they may if both end in its plane.
fn meet(a: &FormulaSolid, b: &FormulaSolid, axis: Option<usize>, sides: [[f64; 2]; 3]) -> bool {
    match a.pair_with(b) {
        None => false,
        Some(Pair::Meeting) => true,
        Some(Pair::Touching) => {
            axis.is_some_and(|axis| [a, b].iter().all(|s| ends_in(&s.bounds, axis, sides[axis][0])))
        }
    }
}

/// Where a solid lies as a body sees it; with the share of the cell or face in which that may be wrong.
enum Place {
    Beyond(f64),
    Within(f64),
    Across,
}

/// Beyond all parts of a body, or within one of them.
fn place_of(solid: &FormulaSolid, body: &[PlanarPart<f64>], place: &BoxAround, room: f64) -> Place {
    let mut beyond = 0.0;
    let mut is_beyond = true;
    for part in body {
        match place_of_part(solid, part, place, room) {
            Place::Beyond(share) => beyond += share,
            Place::Within(share) => return Place::Within(share),
            Place::Across => is_beyond = false,
        }
    }
    if is_beyond { Place::Beyond(beyond) } else { Place::Across }
}

fn place_of_part(solid: &FormulaSolid, body: &PlanarPart<f64>, place: &BoxAround, room: f64) -> Place {
    let mut within = Some(0.0);
    for [normal, point] in &body.planes {
        let [behind, before] = [normal.map(|n| -n), *normal].map(|n| reach(solid, n.into(), (*point).into()));
        let share = |half: f64| Slab { normal: (*normal).into(), point: (*point).into(), half }.share(place);
        if share(behind) <= room {
            return Place::Beyond(share(behind));
        }
        within = within.map(|sum| sum + share(before)).filter(|sum| *sum <= room);
    }
    within.map_or(Place::Across, Place::Within)
}

/// How far a solid reaches beyond a plane, to the side of a unit normal, not less than it does; below 0 if it does not.
fn reach(solid: &FormulaSolid, normal: DVec3, point: DVec3) -> f64 {
    let farthest = match &solid.kind {
        Kind::Quadric(_, convex) => {
            let round = Round(convex);
            round.farthest(normal).point.dot(normal) + Support::radius(&round)
        }
        Kind::Torus(torus, _) => DVec3::from_array(torus.outermost(normal.to_array())).dot(normal),
    };
    // As of the slack of supports, of which what is along the plane is no part.
    let Aabb { min, max } = solid.bounds;
    let sizes = (min.abs().max(max.abs()) + point.abs()).dot(normal.abs()) + (max - min).min_element();
    let rounding = 64.0 * f64::EPSILON * sizes;
    farthest - point.dot(normal) + rounding
}

/// A solid, or a part of a body.
enum Member<'a> {
    Solid(&'a FormulaSolid),
    Part(&'a PlanarPart<f64>),
}

impl Enclosed for Member<'_> {
    fn enclosures(&self, place: &BoxAround, tell: &mut impl FnMut(Enclosure)) {
        match self {
            Member::Solid(solid) => solid.enclosures(place, tell),
            Member::Part(part) => part.enclosures(place, tell),
        }
    }

    fn is_apart(&self, other: &Self, place: &BoxAround) -> bool {
        match (self, other) {
            (Member::Solid(one), Member::Solid(another)) => one.is_apart(another, place),
            (Member::Part(one), Member::Part(another)) => one.is_apart(another, place),
            _ => false,
        }
    }

    fn share(&self, place: &BoxAround) -> Bounds<f64> {
        match self {
            Member::Solid(solid) => solid.share(place),
            Member::Part(part) => part.share(place),
        }
    }

    fn price(&self) -> f64 {
        match self {
            Member::Solid(solid) => solid.price(),
            Member::Part(part) => part.price(),
        }
    }
}
