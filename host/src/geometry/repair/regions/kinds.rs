//! What each region is: open, solid, or one of both.

use super::complex::{Complex, Sided, run_alike};
use crate::geometry::repair::closed::signed_volume;
use crate::geometry::repair::crossing::{SideUse, is_closed};
use crate::geometry::repair::sets::Sets;
use crate::geometry::repair::weld::bits;
use glam::DVec3;
use rustc_hash::FxHashSet as HashSet;

/// Surfaces of what is solid, counter-clockwise seen from outside; from inside if the whole surface looks inward.
#[derive(Debug, Default)]
pub struct Regions {
    /// Of what is solid for certain.
    pub solid: Vec<[DVec3; 3]>,
    /// Of what is solid or open.
    pub perhaps: Vec<[DVec3; 3]>,
    /// So many triangles were the backs of others.
    pub backs: usize,
    /// So many repeated others that have no backs.
    pub repeated: usize,
    /// Some corners were computed where surfaces cross.
    pub cut: bool,
}

/// Why the regions of a surface are not told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unknown {
    /// The surface has an edge that only one triangle uses, or one region on both its sides: it is open there.
    Open,
    /// Some parts look inward and others outward.
    Mixed,
    /// The surface contradicts itself, or no proof was found.
    Unclear,
}

/// What a region is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RegionKind {
    Open,
    Solid,
    Perhaps,
}

impl Complex<'_> {
    /// What each region is, by its set, for a surface that has two sides in places; none if the surface contradicts itself.
    ///
    /// Beside the open it is solid, and so it is behind triangles without backs; where it lies before such triangles and not behind others it may
    /// as well be a cavity that touches the outside. Where the open lies behind such triangles and before none, all look inward.
    ///
    /// `mixed`: some parts look inward and others outward; then what lies behind some and before others is known only beside the open.
    pub fn by_sides(&mut self, looks: &[[bool; 2]], mixed: bool) -> Option<(Vec<RegionKind>, bool)> {
        let outside = self.outside();
        let open = self.sets.find(outside);
        let (mut behind_one, mut before_one, mut beside_open) =
            (vec![false; outside + 1], vec![false; outside + 1], vec![false; outside + 1]);
        for e in 0..self.elements.len() {
            let [behind, before] = self.beside(e);
            match looks[e] {
                [true, false] => (behind_one[behind], before_one[before]) = (true, true),
                [false, true] => (behind_one[before], before_one[behind]) = (true, true),
                _ if behind == open => beside_open[before] = true,
                _ if before == open => beside_open[behind] = true,
                _ => {}
            }
        }
        let inverted = behind_one[open] && !before_one[open];
        if inverted {
            (behind_one, before_one) = (before_one, behind_one);
        }
        let mut faces_open = vec![false; outside + 1];
        for e in 0..self.elements.len() {
            let [behind, before] = self.beside(e);
            if looks[e] == [!inverted, inverted] && before == open {
                faces_open[behind] = true;
            }
            if looks[e] == [inverted, !inverted] && behind == open {
                faces_open[before] = true;
            }
        }
        let kind = |r: usize| match r {
            r if r == open => RegionKind::Open,
            r if mixed && before_one[r] && !faces_open[r] => RegionKind::Perhaps,
            r if behind_one[r] || (beside_open[r] && !before_one[r]) => RegionKind::Solid,
            _ => RegionKind::Perhaps,
        };
        (!behind_one[open]).then(|| ((0..=outside).map(kind).collect(), inverted))
    }

    /// What each region is, by its set, for a double-sided surface of parts that touch and all look the same way; and whether they look inward.
    ///
    /// Each triangle belongs to one part, whose solid lies on the same side of it everywhere, and so does the triangle beside it across an edge that both have
    /// for themselves. Solid is what lies opposite to the open, behind such surface elsewhere, and behind triangles without backs. Where a region
    /// lies before triangles without backs of which no more is known, it may as well be a cavity that touches the outside.
    pub fn by_faces(&mut self, edges: &[SideUse]) -> Result<(Vec<RegionKind>, bool), Unknown> {
        let outside = self.outside();
        let open = self.sets.find(outside);
        let beside: Vec<[usize; 2]> = (0..self.elements.len()).map(|e| self.beside(e)).collect();
        if beside.iter().any(|[behind, before]| behind == before) {
            return Err(Unknown::Open);
        }
        let looks: Vec<[bool; 2]> = (0..beside.len()).map(|e| self.looks_of_layers(e)).collect();
        let fronts = |way: [bool; 2]| {
            let seen = |(looks, [behind, before]): (&[bool; 2], &[usize; 2])| {
                (*looks == way && *before == open) || (*looks == [way[1], way[0]] && *behind == open)
            };
            looks.iter().zip(&beside).any(seen)
        };
        let (outward, inward) = (fronts([true, false]), fronts([false, true]));
        if outward && inward {
            return Err(Unknown::Mixed);
        }
        let mut facing = Facing::new(self.sided, &self.meetings.pairs(edges));
        let same =
            |m: usize, e: usize| self.face(m).normal.dot(self.face(self.elements[e].triangle as usize).normal) > 0.0;
        for (e, [_, before]) in beside.iter().enumerate().filter(|(_, sides)| sides.contains(&open)) {
            self.layers(e).into_iter().for_each(|m| facing.know(m, (*before == open) == same(m, e)));
        }
        let (mut solid, mut behind_one, mut before_one) =
            (vec![false; outside + 1], vec![false; outside + 1], vec![false; outside + 1]);
        for (e, &[behind, before]) in beside.iter().enumerate() {
            let one_sided = looks[e][0] != looks[e][1];
            let (own, other) = if looks[e][0] != inward { (behind, before) } else { (before, behind) };
            let mut known = false;
            for m in self.layers(e) {
                let Some(solid_behind) = facing.solid_behind(m)? else { continue };
                known = true;
                let here = if solid_behind == same(m, e) { behind } else { before };
                if one_sided && here != own {
                    return Err(Unknown::Mixed);
                }
                solid[here] = true;
            }
            if one_sided {
                (solid[own], behind_one[own]) = (true, true);
                before_one[other] |= !known;
            }
        }
        let kind = |r: usize| match r {
            r if r == open => RegionKind::Open,
            r if solid[r] && (behind_one[r] || !before_one[r]) => RegionKind::Solid,
            _ => RegionKind::Perhaps,
        };
        if solid[open] { Err(Unknown::Unclear) } else { Ok(((0..=outside).map(kind).collect(), inward)) }
    }

    /// What each region is by its winding number, of which the open has 0; none if there is none, or regions beside the open differ in sign.
    /// A region of the other sign, or of winding number 0, may be a cavity, or solid where another body is missing.
    pub fn by_winding(&mut self) -> Option<(Vec<RegionKind>, bool)> {
        let outside = self.outside();
        let open = self.sets.find(outside);
        let mut neighbours: Vec<Vec<(usize, i32)>> = vec![Vec::new(); outside + 1];
        for e in 0..self.elements.len() {
            let ([behind, before], step) = (self.beside(e), self.step(e));
            neighbours[before].push((behind, step));
            neighbours[behind].push((before, -step));
        }
        let mut winding: Vec<Option<i32>> = vec![None; outside + 1];
        winding[open] = Some(0);
        let mut queue = vec![open];
        while let Some(region) = queue.pop() {
            let own = winding[region]?;
            for &(other, step) in &neighbours[region] {
                match winding[other] {
                    None => {
                        winding[other] = Some(own + step);
                        queue.push(other);
                    }
                    Some(known) if known != own + step => return None,
                    Some(_) => {}
                }
            }
        }
        let mut signs = neighbours[open].iter().map(|(_, step)| step.signum()).filter(|&sign| sign != 0);
        let sign = signs.next()?;
        if signs.any(|other| other != sign) {
            return None;
        }
        let kind = |r: usize| match winding[r] {
            _ if r == open => RegionKind::Open,
            Some(w) if w.signum() == sign => RegionKind::Solid,
            _ => RegionKind::Perhaps,
        };
        Some(((0..=outside).map(kind).collect(), sign < 0))
    }

    /// The surfaces of what is solid and of what may be; none if one of them is not closed, or nothing is solid.
    pub fn surfaces(&mut self, kinds: &[RegionKind], inverted: bool, [lo, hi]: [DVec3; 2]) -> Option<Regions> {
        let mut of = |kind: RegionKind| self.surface(|region| kinds[region] == kind);
        let (solid, perhaps) = (of(RegionKind::Solid), of(RegionKind::Perhaps));
        let middle = (lo + hi) * 0.5;
        let closed = |surface: &[[DVec3; 3]]| {
            surface.is_empty() || (is_closed(surface, [lo, hi]) && signed_volume(surface, middle) > 0.0)
        };
        if solid.is_empty() || !closed(&solid) || !closed(&perhaps) {
            return None;
        }
        let read: HashSet<[u64; 3]> = self.sided.iter().flat_map(|t| t.corners.map(bits)).collect();
        let cut = solid.iter().chain(&perhaps).flatten().any(|p| !read.contains(&bits(*p)));
        let way = |surface: Vec<[DVec3; 3]>| match inverted {
            true => surface.into_iter().map(|[a, b, c]| [a, c, b]).collect(),
            false => surface,
        };
        Some(Regions { solid: way(solid), perhaps: way(perhaps), cut, ..Regions::default() })
    }
}

/// On which side of triangles the solid lies of the parts that they belong to. Each has two entries: it lies behind the triangle, or before it.
struct Facing {
    sets: Sets,
    known: Vec<bool>,
}

impl Facing {
    /// `pairs`: triangles that belong to one part.
    fn new(sided: &[Sided], pairs: &[[u32; 2]]) -> Self {
        let mut sets = Sets::new(2 * sided.len());
        for [a, b] in pairs.iter().map(|pair| pair.map(|n| n as usize)) {
            let turned = usize::from(run_alike(sided[a].corners, sided[b].corners));
            sets.join(2 * a, 2 * b + turned);
            sets.join(2 * a + 1, 2 * b + 1 - turned);
        }
        Facing { sets, known: vec![false; 2 * sided.len()] }
    }

    fn know(&mut self, triangle: usize, behind: bool) {
        let entry = self.sets.find(2 * triangle + usize::from(!behind));
        self.known[entry] = true;
    }

    /// Does the solid lie behind a triangle? None if that is not known.
    fn solid_behind(&mut self, triangle: usize) -> Result<Option<bool>, Unknown> {
        let [behind, before] = [0, 1].map(|n| self.known[self.sets.find(2 * triangle + n)]);
        match [behind, before] {
            [true, true] => Err(Unknown::Unclear),
            [false, false] => Ok(None),
            _ => Ok(Some(behind)),
        }
    }
}
