//! Shells that meet themselves: found once, independent of any grid, and made the surface of what they wind around.
//!
//! Inside is where the winding number is not 0, however often a shell winds. Triangles that other triangles of the shell cut or cover are
//! divided along them; of every part the winding numbers on both sides tell whether it is surface of the solid. The one before it counts what a
//! line from its middle passes through; the triangles that lie there are the difference. Where all lines pass close to edges, the solid
//! angles of all other triangles tell the mean of both.
//!
//! **Proof.** The new surface must be closed: its areas cancel and its volumes along x, y and z agree, else the shell stays as it is and is said to be in doubt.

use crate::geometry::repair::clear::is_clear;
use crate::geometry::repair::edges::key;
use crate::geometry::repair::face::{Crossing, Face, cut, is_apart, meeting, near, push_parts, sides_on};
use crate::geometry::repair::lines::Lines;
use crate::geometry::repair::separation::all_not_apart;
use crate::geometry::repair::sets::Sets;
use crate::geometry::repair::tree::Tree;
use crate::geometry::repair::weld::bits;
use glam::DVec3;
use rustc_hash::{FxHashMap as HashMap, FxHashSet as HashSet};
use std::cell::LazyCell;

/// Points closer to a plane or line than this share of the shell's size are on it: some hundred roundings, …
const ON: f64 = 1e-13;

/// … and so many units in the last place of its coordinates, should it be far from the origin.
const ON_ULPS: f64 = 16.0;

/// Largest difference of the volumes along x, y and z, as a share of the volume that the shell's box holds.
const SPREAD: f64 = 1e-9;

/// So many solid angles may be computed for one shell, where lines tell nothing: some seconds.
const BUDGET: usize = 100_000_000;

/// Boxes along the axes tell enough if no more than so many pairs of them touch for each triangle.
const PAIRS: usize = 64;

/// In a crowd of triangles a side lies on another if more than this share of it does: needles around one corner come closer to each other there than a
/// tolerance, on lengths that are no part of the sides to speak of.
const RESTING: f64 = 1e-6;

/// What is found of a shell.
#[derive(Debug)]
pub enum Found {
    /// It winds once around what it holds.
    Simple {
        /// It has walls without thickness, where it is folded.
        walls: bool,
    },
    /// It meets itself.
    Resolved(Resolved),
    /// It meets itself, at this place for one, and no proof was found.
    Doubtful(DVec3),
}

/// The surface of what a shell winds around; it looks inward if the shell does.
#[derive(Debug)]
pub struct Resolved {
    /// Its triangles.
    pub surface: Vec<[DVec3; 3]>,
    /// One of the places where the shell meets itself.
    pub place: DVec3,
    /// The shell winds forward around some parts and backward around others.
    pub both_ways: bool,
    /// It touches itself in edges: it may be several that were joined.
    pub touches: bool,
}

/// What was made of a shell.
#[derive(Default)]
struct Made {
    surface: Vec<[DVec3; 3]>,
    /// It is not the shell itself.
    differs: bool,
    forward: bool,
    backward: bool,
    walls: bool,
}

impl Made {
    /// Note what becomes of a piece of surface.
    fn see(&mut self, sides: Sides, keep: bool, turn: bool) {
        self.forward |= sides.behind > 0 || sides.before > 0;
        self.backward |= sides.behind < 0 || sides.before < 0;
        self.walls |= keep && sides.is_wall();
        self.differs |= turn || !keep;
    }
}

/// The solid angle of a triangle, with sign, in whole spheres.
/// A. van Oosterom and J. Strackee, *The solid angle of a plane triangle*, IEEE Trans. Biomed. Eng. 30 (1983), eq. (8).
pub fn solid_angle(triangle: &[DVec3; 3], point: DVec3) -> f64 {
    let [a, b, c] = triangle.map(|p| p - point);
    let [la, lb, lc] = [a.length(), b.length(), c.length()];
    let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    a.dot(b.cross(c)).atan2(below) / (2.0 * std::f64::consts::PI)
}

/// An edge by its lower and higher point, a triangle that has it, and which of its sides it is.
pub type SideUse = ([u32; 2], u32, usize);

/// The uses of all edges of some triangles, sorted.
#[must_use]
pub fn edges(triangles: &[[DVec3; 3]]) -> Vec<SideUse> {
    let mut edges: Vec<SideUse> = sides(triangles).collect();
    edges.sort_unstable();
    edges
}

/// The sides of triangles in their order.
fn sides(triangles: &[[DVec3; 3]]) -> impl Iterator<Item = SideUse> {
    let mut numbers: HashMap<[u64; 3], u32> = HashMap::default();
    triangles.iter().enumerate().flat_map(move |(n, t)| {
        let [a, b, c] = t.map(|p| {
            let next = numbers.len() as u32;
            *numbers.entry(bits(p)).or_insert(next)
        });
        let sides = [([a, b], 0), ([b, c], 1), ([c, a], 2)];
        sides.map(|([p, q], side)| ([p.min(q), p.max(q)], n as u32, side))
    })
}

/// The first triangle, by the order of edges, that has an edge with more than one other.
fn at_edge_of_many(triangles: &[[DVec3; 3]]) -> Option<u32> {
    let mut keys: Vec<u64> = sides(triangles).map(|([p, q], ..)| key(p, q)).collect();
    keys.sort_unstable();
    let many = keys.windows(3).find(|w| w[0] == w[2])?[0];
    sides(triangles).find(|&([p, q], ..)| key(p, q) == many).map(|(_, n, _)| n)
}

/// What triangles have in common.
#[derive(Default)]
struct Contacts {
    /// For each triangle that others meet, these others.
    met: HashMap<u32, Vec<(u32, Crossing)>>,
    /// Triangles and their sides that lie on others: there the surface on both sides of an edge may be in different regions.
    resting: HashSet<(u32, usize)>,
    /// Sides that two triangles share, counted for each pair of them.
    shared_sides: usize,
}

impl Contacts {
    /// Looks at two triangles. A side lies on another one if more than the share `least` of it does.
    fn see(&mut self, faces: &[Face], [m, n]: [u32; 2], [on, least]: [f64; 2]) {
        let (a, b) = (&faces[m as usize], &faces[n as usize]);
        let seen = a.sees(b);
        self.shared_sides += seen.shared_sides();
        let Some(back) = near(a, b, &seen, on) else { return };
        let inward = [(a, b), (b, a)].map(|(face, other)| LazyCell::new(move || other.corners.map(|p| face.inward(p))));
        let have_area = a.normal != DVec3::ZERO && b.normal != DVec3::ZERO;
        let covers = LazyCell::new(|| have_area && !inward.iter().any(|inward| is_apart(inward, on)));
        for (m, n, a, b, seen, inward) in [(m, n, a, b, &seen, &inward[0]), (n, m, b, a, &back, &inward[1])] {
            let found = meeting(a, b, &seen.heights, on, || *covers);
            if found != Crossing::None {
                self.met.entry(m).or_default().push((n, found));
            }
            let sides = sides_on(a, b, seen, [on, least], || **inward);
            self.resting.extend((0..3).filter(|&side| sides[side]).map(|side| (n, side)));
        }
    }

    /// Of all triangles that no plane tells apart, in the order of their numbers.
    fn of_crowd(faces: &[Face], on: f64) -> Self {
        let mut contacts = Contacts::default();
        all_not_apart(faces, on, |m, n| {
            contacts.see(faces, [m as u32, n as u32], [on, RESTING]);
            true
        });
        contacts.met.values_mut().for_each(|met| met.sort_unstable_by_key(|(n, _)| *n));
        contacts
    }
}

/// Triangles, and where they meet.
pub struct Meetings<'a> {
    triangles: &'a [[DVec3; 3]],
    /// Their planes.
    pub faces: Vec<Face>,
    tree: Tree,
    contacts: Contacts,
    on: f64,
}

/// Winding numbers on the two sides of a part of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Sides {
    /// Behind it, where its own triangle has the solid.
    behind: i32,
    before: i32,
}

impl Sides {
    fn is_surface(self) -> bool {
        (self.behind != 0) != (self.before != 0)
    }

    /// A wall without thickness in the open.
    fn is_wall(self) -> bool {
        self.behind == 0 && self.before == 0
    }
}

impl<'a> Meetings<'a> {
    /// Of some triangles; points closer than `on` to a plane or line are on it.
    #[must_use]
    pub fn new(triangles: &'a [[DVec3; 3]], on: f64) -> Self {
        let faces: Vec<Face> = triangles.iter().map(|&t| Face::new(t)).collect();
        let tree = Tree::turned(triangles, on);
        let mut contacts = Contacts::default();
        let mut see = |m, n| contacts.see(&faces, [m, n], [on, 0.0]);
        if !tree.some_touching_pairs(PAIRS * triangles.len(), &mut see) {
            contacts = Contacts::of_crowd(&faces, on);
        }
        Meetings { triangles, faces, tree, contacts, on }
    }

    /// Lines through the triangles.
    #[must_use]
    pub fn lines(&self) -> Lines<'_> {
        Lines::new(&self.faces, &self.tree, self.on)
    }

    /// Pairs of triangles across edges that they alone use and that lie on no other.
    pub fn pairs(&self, edges: &[SideUse]) -> Vec<[u32; 2]> {
        let free = |&(_, n, side): &SideUse| !self.contacts.resting.contains(&(n, side));
        let pair = |uses: &[SideUse]| match uses {
            [a, b] if free(a) && free(b) => Some([a.1, b.1]),
            _ => None,
        };
        edges.chunk_by(|a, b| a.0 == b.0).filter_map(pair).collect()
    }

    /// Those [pairs](Self::pairs) of which no other triangle meets one.
    pub fn neighbours(&self, edges: &[SideUse]) -> Vec<[u32; 2]> {
        let mut pairs = self.pairs(edges);
        pairs.retain(|pair| !pair.iter().any(|&n| self.meets(n)));
        pairs
    }

    /// The triangles that no other meets, in groups of [neighbours](Self::neighbours).
    fn patches(&self) -> Vec<Vec<u32>> {
        let mut sets = Sets::new(self.triangles.len());
        self.neighbours(&edges(self.triangles)).into_iter().for_each(|[a, b]| sets.join(a as usize, b as usize));
        let free = |patch: Vec<usize>| -> Vec<u32> {
            patch.into_iter().map(|n| n as u32).filter(|&n| !self.meets(n)).collect()
        };
        sets.groups().into_iter().map(free).filter(|patch| !patch.is_empty()).collect()
    }

    /// The first triangle, by the order of edges, that has an edge with more than one other; the triangles are closed.
    fn at_edge_of_many(&self) -> Option<u32> {
        // An edge of two is shared by one pair, an edge of four by six.
        if 2 * self.contacts.shared_sides == 3 * self.triangles.len() { None } else { at_edge_of_many(self.triangles) }
    }

    /// Do other triangles cut or cover this one?
    #[must_use]
    pub fn meets(&self, n: u32) -> bool {
        self.contacts.met.contains_key(&n)
    }

    /// The triangles that cover a part of this one.
    pub fn covering(&self, n: u32) -> impl Iterator<Item = u32> {
        let met = self.contacts.met.get(&n).into_iter().flatten();
        met.filter(|(_, found)| *found == Crossing::Cover).map(|(m, _)| *m)
    }

    /// The sides of a part with this middle of triangle `n`; `own` are the triangles that lie there, itself too. None if there is doubt.
    fn sides(&self, middle: DVec3, n: u32, own: &[u32], spent: &mut usize) -> Option<Sides> {
        let normal = self.faces[n as usize].normal;
        let sheets: i32 =
            own.iter().map(|&m| if self.faces[m as usize].normal.dot(normal) > 0.0 { 1 } else { -1 }).sum();
        let by_angles = || {
            *spent += self.triangles.len();
            let others = self.triangles.iter().enumerate().filter(|(m, _)| !own.contains(&(*m as u32)));
            let mean: f64 = others.map(|(_, t)| solid_angle(t, middle)).sum();
            let before = mean - 0.5 * f64::from(sheets);
            ((before - before.round()).abs() < 0.05 && *spent <= BUDGET).then_some(before.round() as i32)
        };
        let before = self.lines().winding(middle, normal, own).or_else(by_angles)?;
        Some(Sides { behind: before + sheets, before })
    }

    /// The convex parts into which others divide triangle `n`.
    #[must_use]
    pub fn parts(&self, n: u32) -> Vec<Vec<DVec3>> {
        let face = &self.faces[n as usize];
        let mut parts = vec![face.corners.to_vec()];
        for (m, meeting) in self.contacts.met.get(&n).into_iter().flatten() {
            let other = &self.faces[*m as usize];
            let around = |ends: &[DVec3]| {
                let (lo, hi) = ends.iter().fold((ends[0], ends[0]), |(a, b), p| (a.min(*p), b.max(*p)));
                [lo - self.on, hi + self.on]
            };
            match meeting {
                Crossing::None => {}
                Crossing::Cut(ends) => cut(&mut parts, ends[0], other.normal, around(ends), self.on),
                Crossing::Cover => {
                    for i in 0..3 {
                        let (a, b) = (other.corners[i], other.corners[(i + 1) % 3]);
                        let normal = face.normal.cross(b - a).normalize_or_zero();
                        cut(&mut parts, a, normal, around(&other.corners), self.on);
                    }
                }
            }
        }
        parts
    }

    /// The surface of what the shell winds around, looking inward if the shell is `inverted`; none if there is doubt.
    fn resolved(&self, inverted: bool) -> Option<Made> {
        let mut made = Made::default();
        let patches = self.patches();
        let mut spent = 0;
        let area = |n: u32| {
            let [a, b, c] = self.triangles[n as usize];
            (b - a).cross(c - a).length_squared()
        };
        for patch in patches {
            let largest = patch.iter().copied().max_by(|&a, &b| area(a).total_cmp(&area(b)))?;
            if self.faces[largest as usize].normal == DVec3::ZERO {
                // Slivers without an area are no surface, but hold edges together.
                made.surface.extend(patch.iter().map(|&n| self.triangles[n as usize]));
                continue;
            }
            let [a, b, c] = self.triangles[largest as usize];
            let sides = self.sides((a + b + c) / 3.0, largest, &[largest], &mut spent)?;
            let (keep, turn) = (sides.is_surface(), (sides.behind == 0) != inverted);
            made.see(sides, keep, turn);
            if keep {
                let whole = patch.iter().map(|&n| self.triangles[n as usize]);
                made.surface.extend(whole.map(|[a, b, c]| if turn { [a, c, b] } else { [a, b, c] }));
            }
        }
        let mut met: Vec<u32> = self.contacts.met.keys().copied().collect();
        met.sort_unstable();
        for n in met {
            let parts = self.parts(n);
            let mut wanted = Vec::with_capacity(parts.len());
            for part in &parts {
                let middle = part.iter().sum::<DVec3>() / part.len() as f64;
                let holds = |m: u32| self.faces[m as usize].inward(middle).iter().all(|&d| d > 0.0);
                let own: Vec<u32> = self.covering(n).filter(|&m| holds(m)).chain([n]).collect();
                let sides = self.sides(middle, n, &own, &mut spent)?;
                let first = own.iter().all(|&m| m >= n);
                let wall = sides.is_wall() && own.len() > 1;
                let turn = !wall && (sides.behind == 0) != inverted;
                let keep = wall || (sides.is_surface() && first);
                made.see(sides, keep, turn);
                wanted.push(keep.then_some(!turn));
            }
            let parts = parts.iter().map(|part| &part[..]).zip(wanted.iter().copied());
            push_parts(&mut made.surface, self.triangles[n as usize], parts);
        }
        Some(made)
    }
}

/// Volumes enclosed by closed triangles, computed along x, y and z.
fn volumes(triangles: &[[DVec3; 3]], origin: DVec3) -> DVec3 {
    let one = |[a, b, c]: &[DVec3; 3]| (b - a).cross(c - a) * ((*a - origin) + (*b - origin) + (*c - origin)) / 6.0;
    triangles.iter().map(one).sum()
}

/// Distance within which points are on a plane or line.
#[must_use]
pub fn tolerance([lo, hi]: [DVec3; 2]) -> f64 {
    ON * (hi - lo).max_element() + ON_ULPS * f64::EPSILON * lo.abs().max(hi.abs()).max_element()
}

/// What a closed shell winds around.
#[must_use]
pub fn untangle(triangles: &[[DVec3; 3]], [lo, hi]: [DVec3; 2]) -> Found {
    let on = tolerance([lo, hi]);
    if is_clear(triangles, on) {
        return Found::Simple { walls: false };
    }
    let shell = Meetings::new(triangles, on);
    let Some(n) = shell.contacts.met.keys().min().copied().or_else(|| shell.at_edge_of_many()) else {
        return Found::Simple { walls: false };
    };
    let place = triangles[n as usize][0];
    let origin = (lo + hi) * 0.5;
    let inverted = volumes(triangles, origin).x < 0.0;
    match shell.resolved(inverted) {
        Some(made) if !made.differs => Found::Simple { walls: made.walls },
        Some(made) if is_closed(&made.surface, [lo, hi]) => {
            let Made { surface, forward, backward, .. } = made;
            Found::Resolved(Resolved {
                surface,
                place,
                both_ways: forward && backward,
                touches: shell.at_edge_of_many().is_some(),
            })
        }
        _ => Found::Doubtful(place),
    }
}

/// Do the areas of some triangles within the box `lo..hi` cancel, and their volumes along the axes agree, to a share of the box?
#[must_use]
pub fn is_closed(triangles: &[[DVec3; 3]], [lo, hi]: [DVec3; 2]) -> bool {
    let (size, least) = (hi - lo, SPREAD * (hi - lo).element_product());
    let area: DVec3 = triangles.iter().map(|[a, b, c]| (b - a).cross(c - a) * 0.5).sum();
    // Seen from no plane in which a surface is likely to lie: there it would have no volume.
    let along = volumes(triangles, lo + size * DVec3::new(0.433, 0.571, 0.397));
    !triangles.is_empty()
        && (area * size).abs().max_element() <= least
        && along.max_element() - along.min_element() <= least
}
