//! Surfaces that share edges so that nobody can tell whose triangles are whose: the regions between them.
//!
//! A surface divides space into regions. The one that reaches to infinity is open. If no triangle has a back, all others have a winding number.
//! A surface with two sides says where solid and gas meet, but not on which side the solid is: there a region beside the open one, or behind a
//! triangle that has no back, is solid; of any other it is not known: it may be a room between parts that touch, or a part within others.
//!
//! The sides of two triangles belong to one region where a straight line from the one to the other meets nothing between, or where the triangles
//! meet in an edge that is theirs alone. A line that passes closer than rounding to an edge tells nothing and is not used, so a region may fall
//! into several here, of which less is known; it is never joined to another. Regions after Q. Zhou, E. Grinspun, D. Zorin, A. Jacobson,
//! *Mesh Arrangements for Solid Geometry*, ACM Trans. Graph. 35 (2016), sec. 3.
//!
//! **Proof.** The surfaces found must be closed: their areas cancel and their volumes along x, y and z agree, else there is no answer.

use crate::geometry::repair::closed::signed_volume;
use crate::geometry::repair::crossing::{Meetings, SideUse, edges, is_closed, tolerance};
use crate::geometry::repair::face::{Face, bounds, push_parts};
use crate::geometry::repair::lines::{FLAT, Way, directions};
use crate::geometry::repair::sets::Sets;
use crate::geometry::repair::tree::Tree;
use crate::geometry::repair::weld::bits;
use glam::DVec3;
use rustc_hash::{FxHashMap as HashMap, FxHashSet as HashSet};
use std::sync::OnceLock;

/// Parts connected by edges of their own are asked at so many places.
const PLACES: usize = 8;

/// A set of sides that sees no other one has been asked at so many places at most.
const MOST_PLACES: usize = 512;

/// So many boxes around triangles may be looked at along lines for one surface: some seconds. Then regions that were not seen to be one stay apart.
const BUDGET: usize = 50_000_000;

/// Triangles in more parts than this have them in a tree.
const MANY: usize = 16;

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

/// All triangles of a source as they were read: those that lie on a surface tell where it has a back.
pub struct SourceTriangles<'a> {
    triangles: &'a [[DVec3; 3]],
    tree: OnceLock<Tree>,
}

impl<'a> SourceTriangles<'a> {
    /// Of these triangles.
    #[must_use]
    pub fn new(triangles: &'a [[DVec3; 3]]) -> Self {
        SourceTriangles { triangles, tree: OnceLock::new() }
    }

    /// All of them.
    #[must_use]
    pub fn triangles(&self) -> &'a [[DVec3; 3]] {
        self.triangles
    }

    /// Those that may have points in the plane of a triangle, and there as near to it as `on`. Most files never ask.
    fn in_plane_of(&self, face: &Face, on: f64) -> Vec<Face> {
        let tree = self.tree.get_or_init(|| Tree::turned(self.triangles, on));
        let (mut found, [lo, hi]) = (Vec::new(), bounds(&face.corners));
        tree.touching([lo - on, hi + on], |n| {
            let other = Face::new(self.triangles[n as usize]);
            if other.normal.dot(face.normal).abs() > 1.0 - FLAT {
                found.push(other);
            }
        });
        found
    }
}

/// A triangle, and how often it is there from the front and from the back.
#[derive(Clone, Copy, Debug)]
struct Sided {
    corners: [DVec3; 3],
    front: i32,
    back: i32,
}

/// The triangles of a surface, each once.
fn sided(triangles: &[[DVec3; 3]]) -> Vec<Sided> {
    let mut at: HashMap<[[u64; 3]; 3], usize> = HashMap::default();
    let mut all: Vec<Sided> = Vec::new();
    for &corners in triangles {
        let mut key = corners.map(bits);
        key.sort_unstable();
        let n = *at.entry(key).or_insert_with(|| {
            all.push(Sided { corners, front: 0, back: 0 });
            all.len() - 1
        });
        let [a, b, _] = all[n].corners;
        let begins = corners.iter().position(|&p| p == a).unwrap_or(0);
        let same = corners[(begins + 1) % 3] == b;
        *(if same { &mut all[n].front } else { &mut all[n].back }) += 1;
    }
    all
}

/// A convex part of a triangle.
struct Element {
    triangle: u32,
    corners: Vec<DVec3>,
    middle: DVec3,
}

/// What a region is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Open,
    Solid,
    Perhaps,
}

/// Sides are numbered: twice the element, and one more for the side towards which it looks.
fn side(element: usize, before: bool) -> usize {
    2 * element + usize::from(before)
}

/// Do two triangles run an edge that both have in the same direction?
fn run_alike(p: [DVec3; 3], q: [DVec3; 3]) -> bool {
    let runs = |from: DVec3, to: DVec3| (0..3).any(|i| q[i] == from && q[(i + 1) % 3] == to);
    (0..3).any(|i| runs(p[i], p[(i + 1) % 3]))
}

/// A surface in parts that meet only in their edges, and the regions that their sides belong to.
struct Complex<'a> {
    sided: &'a [Sided],
    meetings: &'a Meetings<'a>,
    elements: Vec<Element>,
    /// The elements of each triangle.
    of: Vec<Vec<usize>>,
    /// Their places among these, of triangles that have many.
    trees: HashMap<u32, Tree>,
    sets: Sets,
    on: f64,
}

impl<'a> Complex<'a> {
    fn new(sided: &'a [Sided], meetings: &'a Meetings<'a>, on: f64) -> Self {
        let mut elements = Vec::new();
        let mut of = vec![Vec::new(); sided.len()];
        // What has no area has no sides.
        for n in (0..sided.len()).filter(|&n| meetings.faces[n].normal != DVec3::ZERO) {
            for corners in meetings.parts(n as u32) {
                let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
                of[n].push(elements.len());
                elements.push(Element { triangle: n as u32, corners, middle });
            }
        }
        let around = |&e: &usize| {
            let corners: &[DVec3] = &elements[e].corners;
            corners.iter().fold([corners[0]; 2], |[lo, hi], p| [lo.min(*p), hi.max(*p)])
        };
        let tree = |elements: &Vec<usize>| Tree::of_boxes(elements.iter().map(around), None);
        let trees = (0..).zip(&of).filter(|(_, elements)| elements.len() > MANY).map(|(n, of)| (n, tree(of))).collect();
        let sets = Sets::new(2 * elements.len() + 1);
        Complex { sided, meetings, elements, of, trees, sets, on }
    }

    /// With all sides joined that are seen to belong to one region.
    fn joined(sided: &'a [Sided], meetings: &'a Meetings<'a>, edges: &[SideUse], on: f64) -> Self {
        let mut complex = Self::new(sided, meetings, on);
        complex.join_neighbours(edges);
        complex.join_layers();
        complex.join_visible();
        complex
    }

    fn outside(&self) -> usize {
        2 * self.elements.len()
    }

    fn face(&self, triangle: usize) -> &Face {
        &self.meetings.faces[triangle]
    }

    /// Join the sides of whole triangles across edges that only two of them use.
    fn join_neighbours(&mut self, edges: &[SideUse]) {
        for [a, b] in self.meetings.neighbours(edges) {
            let (a, b) = (a as usize, b as usize);
            let (&[own, ..], &[other, ..]) = (&self.of[a][..], &self.of[b][..]) else { continue };
            let same = run_alike(self.sided[a].corners, self.sided[b].corners);
            for before in [false, true] {
                self.sets.join(side(own, before), side(other, before != same));
            }
        }
    }

    /// The part of a triangle that holds a point of its plane, not on its rim.
    fn part_at(&self, triangle: usize, p: DVec3) -> Option<usize> {
        let (face, clear) = (self.face(triangle), self.meetings.lines().clear);
        let within = |e: &usize| {
            let corners = &self.elements[*e].corners;
            (0..corners.len()).all(|i| {
                let (a, b) = (corners[i], corners[(i + 1) % corners.len()]);
                face.normal.cross(b - a).normalize_or_zero().dot(p - a) > clear
            })
        };
        let parts = &self.of[triangle];
        let Some(tree) = self.trees.get(&(triangle as u32)) else { return parts.iter().copied().find(within) };
        let mut found = None;
        tree.touching([p - clear, p + clear], |n| {
            let part = parts[n as usize];
            if found.is_none() && within(&part) {
                found = Some(part);
            }
        });
        found
    }

    /// The triangles that lie where an element is, itself too.
    fn layers(&self, element: usize) -> Vec<usize> {
        let Element { triangle, middle, .. } = self.elements[element];
        let holds = |m: &usize| self.face(*m).inward(middle).iter().all(|&d| d > 0.0);
        let covering = self.meetings.covering(triangle).map(|m| m as usize).filter(holds);
        covering.chain([triangle as usize]).collect()
    }

    /// Join the sides of elements that lie on each other.
    fn join_layers(&mut self) {
        for e in 0..self.elements.len() {
            let Element { triangle, middle, .. } = self.elements[e];
            for m in self.layers(e) {
                let Some(f) = self.part_at(m, middle).filter(|_| m != triangle as usize) else { continue };
                let same = self.face(m).normal.dot(self.face(triangle as usize).normal) > 0.0;
                for before in [false, true] {
                    self.sets.join(side(e, before), side(f, before == same));
                }
            }
        }
    }

    /// The side that is seen along a line, or the open; none if that cannot be told.
    fn seen_along(&self, way: &Way, from: DVec3, direction: DVec3) -> Option<usize> {
        let lines = self.meetings.lines();
        let known = |hit: &(f64, u32)| lines.clear / self.face(hit.1 as usize).normal.dot(direction).abs();
        let first =
            way.through.iter().fold((f64::INFINITY, 0), |first, hit| if hit.0 < first.0 { *hit } else { first });
        if way.unclear.is_some_and(|unclear| unclear <= first.0 + lines.slack()) {
            return None;
        }
        if way.through.is_empty() {
            return Some(self.outside());
        }
        // What may be met as early must lie on what is met first: between two walls a rounding apart is a region of its own.
        let last = first.0 + known(&first);
        let mut as_early = way.through.iter().filter(|hit| hit.1 != first.1 && hit.0 - known(hit) <= last);
        if !as_early.all(|hit| self.meetings.covering(first.1).any(|m| m == hit.1)) {
            return None;
        }
        let (along, met) = (first.0, first.1 as usize);
        let part = self.part_at(met, from + direction * along)?;
        Some(side(part, self.face(met).normal.dot(direction) < 0.0))
    }

    /// Join the sides that see each other, or the open.
    fn join_visible(&mut self) {
        let mut size = vec![0_usize; 2 * self.elements.len() + 1];
        let roots: Vec<usize> = (0..self.elements.len()).map(|e| self.sets.find(side(e, true))).collect();
        roots.iter().for_each(|&r| size[r] += 1);
        let mut seen = vec![0_usize; size.len()];
        let asked: Vec<usize> = (0..roots.len())
            .filter(|&e| {
                let (n, step) = (seen[roots[e]], size[roots[e]].div_ceil(PLACES));
                seen[roots[e]] += 1;
                n % step == 0
            })
            .collect();
        let asked: Vec<usize> = asked.into_iter().flat_map(|e| [side(e, false), side(e, true)]).collect();
        // Sets that saw no other one, with how many sides each had then.
        let mut alone: HashMap<usize, usize> = HashMap::default();
        let mut looked_at = 0;
        loop {
            let mut sets: Vec<(usize, usize)> = asked.iter().map(|&side| (self.sets.find(side), side)).collect();
            sets.sort_unstable();
            let mut joined = false;
            for sides in sets.chunk_by(|a, b| a.0 == b.0) {
                let set = sides[0].0;
                if alone.get(&set) == Some(&sides.len()) {
                    continue;
                }
                if self.joins_what_it_sees(sides, &mut looked_at) {
                    joined = true;
                } else {
                    alone.insert(set, sides.len());
                }
            }
            if !joined || looked_at > BUDGET {
                return;
            }
        }
    }

    /// Looks from the sides of a set until another set is seen, and joins that. Is there one? What is open is known to be.
    fn joins_what_it_sees(&mut self, sides: &[(usize, usize)], looked_at: &mut usize) -> bool {
        let outside = self.outside();
        let places = sides.iter().step_by(sides.len().div_ceil(MOST_PLACES));
        for &(_, own) in places {
            let element = own / 2;
            let Element { triangle, middle, .. } = self.elements[element];
            let normal = self.face(triangle as usize).normal;
            let layers: Vec<u32> = self.layers(element).into_iter().map(|m| m as u32).collect();
            for direction in directions(if own % 2 == 1 { normal } else { -normal }, element) {
                if *looked_at > BUDGET || self.sets.find(own) == self.sets.find(outside) {
                    return false;
                }
                let way = self.meetings.lines().first(middle, direction, &layers);
                *looked_at += way.looked_at;
                if let Some(other) = self.seen_along(&way, middle, direction)
                    && self.sets.find(other) != self.sets.find(own)
                {
                    self.sets.join(own, other);
                    return true;
                }
            }
        }
        false
    }

    /// Is an element there from the front, and from the back?
    fn looks_of_layers(&self, element: usize) -> [bool; 2] {
        let normal = self.face(self.elements[element].triangle as usize).normal;
        let mut looks = [false; 2];
        for m in self.layers(element) {
            let Sided { front, back, .. } = self.sided[m];
            let same = self.face(m).normal.dot(normal) > 0.0;
            looks[0] |= if same { front } else { back } > 0;
            looks[1] |= if same { back } else { front } > 0;
        }
        looks
    }

    /// The same of all elements, counting what else of the source lies there.
    fn looks(&self, source: &SourceTriangles<'_>) -> Vec<[bool; 2]> {
        let mut looks = vec![[false; 2]; self.elements.len()];
        for (n, elements) in self.of.iter().enumerate().filter(|(_, elements)| !elements.is_empty()) {
            let normal = self.face(n).normal;
            let here = source.in_plane_of(self.face(n), self.on);
            for &e in elements {
                let middle = self.elements[e].middle;
                looks[e] = self.looks_of_layers(e);
                let lies_here =
                    |f: &&Face| f.height(middle).abs() <= self.on && f.inward(middle).iter().all(|&d| d > 0.0);
                for face in here.iter().filter(lies_here) {
                    looks[e][usize::from(face.normal.dot(normal) <= 0.0)] = true;
                }
            }
        }
        looks
    }

    /// The two regions beside an element: behind and before it.
    fn beside(&mut self, element: usize) -> [usize; 2] {
        [false, true].map(|before| self.sets.find(side(element, before)))
    }

    /// Are there two regions? A side of which nothing is known, as that of a sliver that no line meets clear of its edges, is none.
    fn separates(&mut self) -> bool {
        let mut size = vec![0_usize; self.outside() + 1];
        (0..size.len()).for_each(|side| size[self.sets.find(side)] += 1);
        (0..self.elements.len()).map(|e| self.beside(e)).any(|[a, b]| a != b && size[a] > 1 && size[b] > 1)
    }

    /// What each region is, by its set, for a surface that has two sides in places; none if the surface contradicts itself.
    ///
    /// Beside the open it is solid, and so it is behind triangles without backs; where it lies before such triangles and not behind others it may
    /// as well be a cavity that touches the outside. Where the open lies behind such triangles and before none, all look inward.
    ///
    /// `mixed`: some parts look inward and others outward; then what lies behind some and before others is known only beside the open.
    fn by_sides(&mut self, looks: &[[bool; 2]], mixed: bool) -> Option<(Vec<Kind>, bool)> {
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
            r if r == open => Kind::Open,
            r if mixed && before_one[r] && !faces_open[r] => Kind::Perhaps,
            r if behind_one[r] || (beside_open[r] && !before_one[r]) => Kind::Solid,
            _ => Kind::Perhaps,
        };
        (!behind_one[open]).then(|| ((0..=outside).map(kind).collect(), inverted))
    }

    /// What each region is, by its set, for a double-sided surface of parts that touch and all look the same way; and whether they look inward.
    ///
    /// Each triangle belongs to one part, whose solid lies on the same side of it everywhere, and so does the triangle beside it across an edge that both have
    /// for themselves. Solid is what lies opposite to the open, behind such surface elsewhere, and behind triangles without backs. Where a region
    /// lies before triangles without backs of which no more is known, it may as well be a cavity that touches the outside.
    fn by_faces(&mut self, edges: &[SideUse]) -> Result<(Vec<Kind>, bool), Unknown> {
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
            r if r == open => Kind::Open,
            r if solid[r] && (behind_one[r] || !before_one[r]) => Kind::Solid,
            _ => Kind::Perhaps,
        };
        if solid[open] { Err(Unknown::Unclear) } else { Ok(((0..=outside).map(kind).collect(), inward)) }
    }

    /// How many more triangles of an element look to its front than to its back.
    fn step(&self, element: usize) -> i32 {
        let normal = self.face(self.elements[element].triangle as usize).normal;
        let net = |m: usize| {
            let Sided { front, back, .. } = self.sided[m];
            if self.face(m).normal.dot(normal) > 0.0 { front - back } else { back - front }
        };
        self.layers(element).into_iter().map(net).sum()
    }

    /// What each region is by its winding number, of which the open has 0; none if there is none, or regions beside the open differ in sign.
    /// A region of the other sign, or of winding number 0, may be a cavity, or solid where another body is missing.
    fn by_winding(&mut self) -> Option<(Vec<Kind>, bool)> {
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
            _ if r == open => Kind::Open,
            Some(w) if w.signum() == sign => Kind::Solid,
            _ => Kind::Perhaps,
        };
        Some(((0..=outside).map(kind).collect(), sign < 0))
    }

    /// The surface of some regions: each place of the surface once.
    fn surface(&mut self, of: impl Fn(usize) -> bool) -> Vec<[DVec3; 3]> {
        let mut surface = Vec::new();
        for n in 0..self.sided.len() {
            let mut wanted = Vec::new();
            for e in self.of[n].clone() {
                let [behind, before] = [false, true].map(|b| of(self.sets.find(side(e, b))));
                let here = behind != before && self.layers(e).into_iter().all(|m| m >= n);
                wanted.push((e, here.then_some(behind)));
            }
            push_parts(
                &mut surface,
                self.sided[n].corners,
                wanted.iter().map(|&(e, looks)| (&self.elements[e].corners[..], looks)),
            );
        }
        surface
    }

    /// The surfaces of what is solid and of what may be; none if one of them is not closed, or nothing is solid.
    fn surfaces(&mut self, kinds: &[Kind], inverted: bool, [lo, hi]: [DVec3; 2]) -> Option<Regions> {
        let mut of = |kind: Kind| self.surface(|region| kinds[region] == kind);
        let (solid, perhaps) = (of(Kind::Solid), of(Kind::Perhaps));
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

/// The regions of a surface, a part of `source`. `mixed`: some parts look inward, others outward.
///
/// # Errors
/// Why they cannot be told.
pub fn arrangement(
    triangles: &[[DVec3; 3]],
    [lo, hi]: [DVec3; 2],
    source: &SourceTriangles<'_>,
    mixed: bool,
) -> Result<Regions, Unknown> {
    let sided = sided(triangles);
    let corners: Vec<[DVec3; 3]> = sided.iter().map(|t| t.corners).collect();
    let on = tolerance([lo, hi]);
    let edges = edges(&corners);
    if edges.chunk_by(|a, b| a.0 == b.0).any(|uses| uses.len() == 1) {
        return Err(Unknown::Open);
    }
    let meetings = Meetings::new(&corners, on);
    let mut complex = Complex::joined(&sided, &meetings, &edges, on);
    let looks = complex.looks(source);
    let two_sided = looks.contains(&[true, true]);
    let kinds = if two_sided { complex.by_sides(&looks, mixed) } else { complex.by_winding() };
    let backs = if two_sided { triangles.len() - sided.len() } else { 0 };
    let found = kinds.and_then(|(kinds, inverted)| complex.surfaces(&kinds, inverted, [lo, hi]));
    let why = if complex.separates() { Unknown::Unclear } else { Unknown::Open };
    Ok(Regions { backs, ..found.ok_or(why)? })
}

/// The regions of a cluster of triangles that share edges, some of which have backs; all look the same way.
///
/// # Errors
/// Why they cannot be told.
pub fn of_two_sided(triangles: &[[DVec3; 3]], bounds: [DVec3; 2]) -> Result<Regions, Unknown> {
    let sided = sided(triangles);
    let corners: Vec<[DVec3; 3]> = sided.iter().map(|t| t.corners).collect();
    let (on, edges) = (tolerance(bounds), edges(&corners));
    let meetings = Meetings::new(&corners, on);
    let mut complex = Complex::joined(&sided, &meetings, &edges, on);
    let (kinds, inverted) = complex.by_faces(&edges)?;
    let dropped = |two: bool| {
        let of = sided.iter().filter(|t| (t.front > 0 && t.back > 0) == two);
        of.map(|t| (t.front + t.back - 1) as usize).sum()
    };
    let found = complex.surfaces(&kinds, inverted, bounds).ok_or(Unknown::Unclear)?;
    Ok(Regions { backs: dropped(true), repeated: dropped(false), ..found })
}
