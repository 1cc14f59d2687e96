//! A surface in parts that meet only in their edges, and which of their sides belong to one region.

use super::source::SourceTriangles;
use crate::geometry::repair::crossing::{Meetings, SideUse};
use crate::geometry::repair::face::{Face, push_parts};
use crate::geometry::repair::lines::{Way, directions};
use crate::geometry::repair::sets::Sets;
use crate::geometry::repair::tree::Tree;
use crate::geometry::repair::weld::bits;
use glam::DVec3;
use rustc_hash::FxHashMap as HashMap;

/// Parts connected by edges of their own are asked at so many places.
const PLACES: usize = 8;

/// A set of sides that sees no other one has been asked at so many places at most.
const MOST_PLACES: usize = 512;

/// So many boxes around triangles may be looked at along lines for one surface: some seconds. Then regions that were not seen to be one stay apart.
const BUDGET: usize = 50_000_000;

/// Triangles in more parts than this have them in a tree.
const MANY: usize = 16;

/// A triangle, and how often it is there from the front and from the back.
#[derive(Clone, Copy, Debug)]
pub struct Sided {
    pub corners: [DVec3; 3],
    pub front: i32,
    pub back: i32,
}

/// The triangles of a surface, each once.
pub fn sided(triangles: &[[DVec3; 3]]) -> Vec<Sided> {
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
pub struct Element {
    pub triangle: u32,
    corners: Vec<DVec3>,
    middle: DVec3,
}

/// Sides are numbered: twice the element, and one more for the side towards which it looks.
fn side(element: usize, before: bool) -> usize {
    2 * element + usize::from(before)
}

/// Do two triangles run an edge that both have in the same direction?
pub fn run_alike(p: [DVec3; 3], q: [DVec3; 3]) -> bool {
    let runs = |from: DVec3, to: DVec3| (0..3).any(|i| q[i] == from && q[(i + 1) % 3] == to);
    (0..3).any(|i| runs(p[i], p[(i + 1) % 3]))
}

/// A surface in parts that meet only in their edges, and the regions that their sides belong to.
pub struct Complex<'a> {
    pub sided: &'a [Sided],
    pub meetings: &'a Meetings<'a>,
    pub elements: Vec<Element>,
    /// The elements of each triangle.
    of: Vec<Vec<usize>>,
    /// Their places among these, of triangles that have many.
    trees: HashMap<u32, Tree>,
    pub sets: Sets,
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
    pub fn joined(sided: &'a [Sided], meetings: &'a Meetings<'a>, edges: &[SideUse], on: f64) -> Self {
        let mut complex = Self::new(sided, meetings, on);
        complex.join_neighbours(edges);
        complex.join_layers();
        complex.join_visible();
        complex
    }

    pub fn outside(&self) -> usize {
        2 * self.elements.len()
    }

    pub fn face(&self, triangle: usize) -> &Face {
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
    pub fn layers(&self, element: usize) -> Vec<usize> {
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
    pub fn looks_of_layers(&self, element: usize) -> [bool; 2] {
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
    pub fn looks(&self, source: &SourceTriangles<'_>) -> Vec<[bool; 2]> {
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
    pub fn beside(&mut self, element: usize) -> [usize; 2] {
        [false, true].map(|before| self.sets.find(side(element, before)))
    }

    /// Are there two regions? A side of which nothing is known, as that of a sliver that no line meets clear of its edges, is none.
    pub fn separates(&mut self) -> bool {
        let mut size = vec![0_usize; self.outside() + 1];
        (0..size.len()).for_each(|side| size[self.sets.find(side)] += 1);
        (0..self.elements.len()).map(|e| self.beside(e)).any(|[a, b]| a != b && size[a] > 1 && size[b] > 1)
    }

    /// How many more triangles of an element look to its front than to its back.
    pub fn step(&self, element: usize) -> i32 {
        let normal = self.face(self.elements[element].triangle as usize).normal;
        let net = |m: usize| {
            let Sided { front, back, .. } = self.sided[m];
            if self.face(m).normal.dot(normal) > 0.0 { front - back } else { back - front }
        };
        self.layers(element).into_iter().map(net).sum()
    }

    /// The surface of some regions: each place of the surface once.
    pub fn surface(&mut self, of: impl Fn(usize) -> bool) -> Vec<[DVec3; 3]> {
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
}
