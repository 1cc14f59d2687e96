//! The exact oracle for one file of axis-aligned boxes: coordinate compression, in integers.
//!
//! **What the solid of such a file is.** Each box is a body, whatever touches it, and the solid is the union of all bodies. A box that is there
//! more than once is there once; with double-sided triangles it is that box, outward. If boxes of both
//! orientations are there, one inside another of opposite orientation that is itself a body (the smallest that holds it; touching from
//! within is inside) is a cavity of that body, and only of that one; any other box is a body, whichever way round.
//!
//! Where both orientations are there, a box that shares whole edges with several others is not defined: whose edges they are cannot be told.
//!
//! **Walls.** A point of a face is open if both one-sided limits are. What is left of a body between a cavity and its own outside, or
//! between two of its cavities, has no thickness: it may block or not.

use crate::random::Random;
use crate::solids::{Triangle, cuboid};
use glam::DVec3;
use voidage::geometry::bodies::Bodies;
use voidage::geometry::mesh::Mesh;
use voidage::grid::Edges;
use voidage::porosity::{FieldSet, Options, Porosity, porosity};

/// A point, in units of the scene.
type Point = [i64; 3];

/// A box.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Brick {
    /// Lowest corner.
    pub min: Point,
    /// Highest corner.
    pub max: Point,
    /// Its triangles look inward.
    pub inverted: bool,
}

impl Brick {
    fn volume(&self) -> i64 {
        (0..3).map(|a| self.max[a] - self.min[a]).product()
    }

    fn holds(&self, other: &Brick) -> bool {
        (0..3).all(|a| self.min[a] <= other.min[a] && other.max[a] <= self.max[a])
    }

    /// Is a whole edge of one an edge of the other?
    fn shares_an_edge(&self, other: &Brick) -> bool {
        let ends = |b: &Brick, a: usize| [b.min[a], b.max[a]];
        let meet = |a: usize| ends(self, a).iter().any(|end| ends(other, a).contains(end));
        (0..3).any(|a| ends(self, a) == ends(other, a) && (0..3).all(|b| b == a || meet(b)))
    }

    fn overlaps(&self, other: &Brick) -> bool {
        (0..3).all(|a| self.min[a] < other.max[a] && other.min[a] < self.max[a])
    }

    /// Is it around the voxel with these corners?
    fn covers(&self, lo: Point, hi: Point) -> bool {
        (0..3).all(|a| self.min[a] <= lo[a] && hi[a] <= self.max[a])
    }

    /// Does its surface lie in the facet `lo..hi`, flat along `axis`?
    fn walls(&self, axis: usize, lo: Point, hi: Point) -> bool {
        self.covers(lo, hi) && [self.min[axis], self.max[axis]].contains(&lo[axis])
    }
}

/// Boxes and a grid.
#[derive(Debug, Clone)]
pub struct Scene {
    /// The boxes.
    pub bricks: Vec<Brick>,
    /// Planes of the grid.
    pub edges: [Vec<i64>; 3],
    /// The file's triangles, in metres.
    pub triangles: Vec<Triangle>,
    /// Where the origin is, in units.
    pub offset: i64,
    /// A unit in metres, a power of two.
    pub unit: f64,
}

/// A body: a box without its cavities.
struct Hollow {
    outside: Brick,
    cavities: Vec<Brick>,
}

impl Hollow {
    fn covers(&self, lo: Point, hi: Point) -> bool {
        self.outside.covers(lo, hi) && !self.cavities.iter().any(|c| c.covers(lo, hi))
    }

    /// Does a part of its surface lie in the facet `lo..hi`, flat along `axis`, and not within a cavity?
    fn walls(&self, axis: usize, lo: Point, hi: Point) -> bool {
        let within = |c: &Brick| c.covers(lo, hi) && c.min[axis] < lo[axis] && lo[axis] < c.max[axis];
        (self.outside.walls(axis, lo, hi) || self.cavities.iter().any(|c| c.walls(axis, lo, hi)))
            && !self.cavities.iter().any(within)
    }
}

/// Which boxes are bodies and which their cavities. None where the text leaves it open: a box is there in both orientations, boxes of both
/// orientations overlap in part, one
/// with a cavity is there twice (the copy may fill it), one lies in a cavity of its own orientation, of two smallest containers of one size one
/// would make a cavity, and one not, or cavities of a body overlap and one of them may as well be another body's.
fn bodies(bricks: &[Brick]) -> Option<Vec<Hollow>> {
    let crossing = |a: &Brick, b: &Brick| a.inverted != b.inverted && a.overlaps(b) && !a.holds(b) && !b.holds(a);
    if bricks.iter().any(|a| bricks.iter().any(|b| crossing(a, b))) {
        return None;
    }
    let mixed = bricks.iter().any(|b| b.inverted) && bricks.iter().any(|b| !b.inverted);
    let touched = |a: &Brick| bricks.iter().filter(|b| *b != a && a.shares_an_edge(b)).count();
    if mixed && bricks.iter().any(|b| touched(b) > 1) {
        return None;
    }
    let mut distinct: Vec<Brick> = Vec::new();
    for b in bricks {
        match distinct.iter_mut().find(|d| d.min == b.min && d.max == b.max) {
            Some(same) if same.inverted != b.inverted => return None,
            Some(_) => {}
            None => distinct.push(*b),
        }
    }
    distinct.sort_by_key(|b| -b.volume());
    let mut cavity_of: Vec<Option<usize>> = vec![None; distinct.len()];
    for s in 0..distinct.len() {
        let inner = distinct[s];
        let role = |p: usize| (distinct[p].inverted != inner.inverted && cavity_of[p].is_none()).then_some(p);
        let holding = (0..s).filter(|&p| distinct[p].holds(&inner) && distinct[p].volume() > inner.volume());
        let Some(parent) = holding.clone().next_back() else { continue };
        let mut rivals = holding.filter(|&p| distinct[p].volume() == distinct[parent].volume());
        if rivals.any(|p| role(p).is_some() != role(parent).is_some()) {
            return None;
        }
        cavity_of[s] = role(parent);
        if cavity_of[parent].is_some() && distinct[parent].inverted == inner.inverted {
            return None;
        }
        let copies = bricks.iter().filter(|b| b.min == distinct[parent].min && b.max == distinct[parent].max);
        if cavity_of[s].is_some() && copies.count() > 1 {
            return None;
        }
    }
    let may_move = |c: usize| {
        let is_other = |p: usize| distinct[p].inverted != distinct[c].inverted && cavity_of[p].is_none();
        (0..distinct.len()).any(|p| Some(p) != cavity_of[c] && is_other(p) && distinct[p].holds(&distinct[c]))
    };
    let overlap = |c: usize, o: usize| c != o && cavity_of[c] == cavity_of[o] && distinct[c].overlaps(&distinct[o]);
    let cavities: Vec<usize> = (0..distinct.len()).filter(|&c| cavity_of[c].is_some()).collect();
    if cavities.iter().any(|&c| may_move(c) && cavities.iter().any(|&o| overlap(c, o))) {
        return None;
    }
    let hollow = |s: usize| {
        let cavities = (0..distinct.len()).filter(|&c| Some(s) == cavity_of[c]).map(|c| distinct[c]);
        Hollow { outside: distinct[s], cavities: cavities.collect() }
    };
    Some((0..distinct.len()).filter(|&s| cavity_of[s].is_none()).map(hollow).collect())
}

impl Scene {
    /// A scene of up to seven boxes, at random: nested, hollow, flush, touching, repeated, turned inward, wholly or partly double-sided, a
    /// lone one with sides in parts or with a triangle turned, far from the origin, of any size; triangles shuffled; a
    /// grid along the boxes' faces or not.
    #[must_use]
    pub fn random(rng: &mut Random) -> Self {
        let side = [2, 3, 4, 8][rng.below(4)];
        let double = [0, 0, 0, 1, 2][rng.below(5)];
        let flips = double == 0 && rng.below(3) == 0;
        let hollow = double == 0 && rng.below(5) == 0;
        let bricks = bricks(rng, side, flips, hollow);
        let (unit, offset) = match rng.below(3) {
            0 => (1.0, 0),
            1 => (2f64.powi(rng.below(61) as i32 - 30), 0),
            _ => (2f64.powi(rng.below(61) as i32 - 30), 1 << rng.below(24)),
        };
        let mut scene = Scene { bricks, edges: [0; 3].map(|_| planes(rng, side)), triangles: Vec::new(), offset, unit };
        // Several parts with two sides and sides in parts are a family of their own.
        let in_parts = rng.below(4) == 0 && (scene.bricks.len() == 1 || double == 0);
        for brick in scene.bricks.clone() {
            for quad in scene.surface(&brick).chunks_exact(4) {
                let back = double == 1 || (double == 2 && rng.below(6) == 0);
                for quad in parts_of(quad, in_parts && rng.below(6) == 0) {
                    scene.push(rng, quad, brick.inverted, back);
                }
            }
        }
        scene.shuffle(rng);
        if scene.bricks.len() == 1 && double == 0 {
            let turned = rng.below(scene.triangles.len());
            scene.triangles[turned].swap(1, 2);
        }
        scene
    }

    /// A scene of one to six double-sided boxes whose sides come in parts that need not meet those beside them corner to corner: all sides have backs,
    /// or most, or few, or those of some boxes.
    #[must_use]
    pub fn in_parts(rng: &mut Random) -> Self {
        let single_sides = [0, 1, 3, 5, SOME_BOXES][rng.below(5)];
        Self::with_sides_in_parts(rng, single_sides, false)
    }

    /// A scene of up to seven boxes of both orientations, often one in another, whose sides come in parts and have no backs.
    #[must_use]
    pub fn mixed(rng: &mut Random) -> Self {
        Self::with_sides_in_parts(rng, NO_BACKS, true)
    }

    /// So many sides in six have no backs, or with [`SOME_BOXES`] those of some boxes.
    fn with_sides_in_parts(rng: &mut Random, single_sides: usize, mixed: bool) -> Self {
        let side = [2, 3, 4, 8][rng.below(4)];
        let hollow = mixed && rng.below(2) == 0;
        let bricks = bricks(rng, side, mixed, hollow);
        let (unit, offset) = match rng.below(3) {
            0 => (1.0, 0),
            _ => (2f64.powi(rng.below(61) as i32 - 30), 1 << rng.below(24)),
        };
        let mut scene = Scene { bricks, edges: [0; 3].map(|_| planes(rng, side)), triangles: Vec::new(), offset, unit };
        let whole_sides = 1 + rng.below(6);
        for brick in scene.bricks.clone() {
            let single_box = single_sides == SOME_BOXES && rng.below(2) == 0;
            for quad in scene.surface(&brick).chunks_exact(4) {
                let back = !single_box && (single_sides == SOME_BOXES || rng.below(6) >= single_sides);
                for half in scene.halves(rng, quad, whole_sides) {
                    for quarter in scene.halves(rng, &half, whole_sides + 2) {
                        scene.push(rng, quarter, brick.inverted, back);
                    }
                }
            }
        }
        scene.shuffle(rng);
        scene
    }

    /// One side in `whole` is divided in two along either of its axes, at any coordinate of the lattice; the others are as they were.
    fn halves(&self, rng: &mut Random, quad: &[DVec3], whole: usize) -> Vec<[DVec3; 4]> {
        let first = rng.below(4);
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| quad[(first + i) % 4]);
        let steps = ((b - a).abs().max_element() / self.unit) as usize;
        if rng.below(whole) > 0 || steps < 2 {
            return vec![[a, b, c, d]];
        }
        // Exact: a step is the unit, a power of two.
        let taken = (1 + rng.below(steps - 1)) as f64;
        let between = |p: DVec3, q: DVec3| p + (q - p) / steps as f64 * taken;
        let (ab, dc) = (between(a, b), between(d, c));
        vec![[a, ab, dc, d], [ab, b, c, dc]]
    }

    /// Adds the two triangles of a convex quadrilateral, with their backs if asked for.
    fn push(&mut self, rng: &mut Random, quad: [DVec3; 4], inverted: bool, back: bool) {
        let two = if rng.below(2) == 0 { [0, 1, 2, 0, 2, 3] } else { [0, 1, 3, 1, 2, 3] };
        for t in two.chunks_exact(3) {
            let [a, b, c] = [quad[t[0]], quad[t[1]], quad[t[2]]];
            self.triangles.push(if inverted { [a, c, b] } else { [a, b, c] });
            if back {
                self.triangles.push(if inverted { [a, b, c] } else { [a, c, b] });
            }
        }
    }

    /// Puts the triangles of every second scene in any order.
    fn shuffle(&mut self, rng: &mut Random) {
        if rng.below(2) == 0 {
            for n in (1..self.triangles.len()).rev() {
                self.triangles.swap(n, rng.below(n + 1));
            }
        }
    }

    /// The four corners of each of a box' sides, counter-clockwise from outside, in metres.
    fn surface(&self, brick: &Brick) -> Vec<DVec3> {
        let (lo, hi) = (self.metres(brick.min), self.metres(brick.max));
        cuboid(lo, hi).chunks_exact(2).flat_map(|pair| [pair[0][0], pair[0][1], pair[0][2], pair[1][2]]).collect()
    }

    fn metres(&self, p: Point) -> DVec3 {
        DVec3::from_array(p.map(|c| (c + self.offset) as f64 * self.unit))
    }

    /// Is there a triangle and its reverse?
    fn has_backs(&self) -> bool {
        let bits = |p: DVec3| p.to_array().map(f64::to_bits);
        let from_lowest = |t: Triangle| {
            let t = t.map(bits);
            let lowest = (0..3).min_by_key(|&i| t[i]).unwrap_or(0);
            [t[lowest], t[(lowest + 1) % 3], t[(lowest + 2) % 3]]
        };
        let all: std::collections::HashSet<_> = self.triangles.iter().map(|&t| from_lowest(t)).collect();
        self.triangles.iter().any(|&[a, b, c]| all.contains(&from_lowest([a, c, b])))
    }

    /// Its fields as they must be, walls without thickness open or closed; none where the solid is not defined.
    #[must_use]
    pub fn truth(&self, thin_walls_block: bool) -> Option<FieldSet> {
        let bodies = bodies(&self.bricks)?;
        let axis = |a: usize| {
            let mut at: Vec<i64> =
                self.bricks.iter().flat_map(|b| [b.min[a], b.max[a]]).chain(self.edges[a].iter().copied()).collect();
            at.sort_unstable();
            at.dedup();
            at
        };
        let at = [axis(0), axis(1), axis(2)];
        let count = at.each_ref().map(|a| a.len() - 1);
        let point = |v: [usize; 3]| [0, 1, 2].map(|a| at[a][v[a]]);
        let solid = |v: [usize; 3]| {
            let (lo, hi) = (point(v), point(v.map(|c| c + 1)));
            bodies.iter().any(|b| b.covers(lo, hi))
        };
        let index = |v: [usize; 3]| (v[2] * count[1] + v[1]) * count[0] + v[0];
        let mut filled = vec![false; count.iter().product()];
        for_each([0; 3], count, |v| filled[index(v)] = solid(v));
        let inside = |v: [isize; 3]| {
            (0..3).all(|a| (0..count[a] as isize).contains(&v[a])) && filled[index(v.map(|c| c as usize))]
        };
        let closed = |axis: usize, v: [usize; 3]| {
            let above = v.map(|c| c as isize);
            let mut below = above;
            below[axis] -= 1;
            let mut end = v.map(|c| c + 1);
            end[axis] = v[axis];
            let (lo, hi) = (point(v), point(end));
            inside(above) || inside(below) || (thin_walls_block && bodies.iter().any(|b| b.walls(axis, lo, hi)))
        };
        let find = |p: Point| [0, 1, 2].map(|a| at[a].partition_point(|&c| c < p[a]));
        let cells = [0, 1, 2].map(|a| self.edges[a].len() - 1);
        let mut set = FieldSet::default();
        let corner = |c: [usize; 3]| [0, 1, 2].map(|a| self.edges[a][c[a]]);
        let mut field = Vec::new();
        for_each([0; 3], cells, |c| {
            let (lo, hi) = (corner(c), corner(c.map(|i| i + 1)));
            let mut open = 0;
            for_each(find(lo), find(hi), |v| {
                if !filled[index(v)] {
                    open += (0..3).map(|a| at[a][v[a] + 1] - at[a][v[a]]).product::<i64>();
                }
            });
            field.push(open as f64 / (0..3).map(|a| hi[a] - lo[a]).product::<i64>() as f64);
        });
        set.v = std::mem::take(&mut field).into();
        for axis in 0..3 {
            let mut faces = cells;
            faces[axis] += 1;
            let across = [0, 1, 2].into_iter().filter(|&a| a != axis);
            for_each([0; 3], faces, |f| {
                let mut end = f.map(|i| i + 1);
                end[axis] = f[axis];
                let (lo, hi) = (corner(f), corner(end));
                let (first, mut last) = (find(lo), find(hi));
                last[axis] += 1;
                let mut open = 0;
                for_each(first, last, |v| {
                    if !closed(axis, v) {
                        open += across.clone().map(|a| at[a][v[a] + 1] - at[a][v[a]]).product::<i64>();
                    }
                });
                field.push(open as f64 / across.clone().map(|a| hi[a] - lo[a]).product::<i64>() as f64);
            });
            let values = std::mem::take(&mut field).into();
            match axis {
                0 => set.x = values,
                1 => set.y = values,
                _ => set.z = values,
            }
        }
        Some(set)
    }

    /// What is found for its triangles, all in one solid without a name.
    ///
    /// # Panics
    /// If the triangles are refused.
    #[must_use]
    pub fn measured(&self) -> (Bodies, Porosity) {
        let mesh = Mesh { name: "boxes".into(), ..Mesh::from(self.triangles.clone()) };
        let mut bodies = Bodies::default();
        bodies.add(&mesh, 1.0).expect("boxes have an area");
        let edges = self.edges.each_ref().map(|e| e.iter().map(|&c| (c + self.offset) as f64 * self.unit).collect());
        let options = Options { bounds: true, ..Options::default() };
        let found = porosity(&Edges(edges).grid(None).expect("a grid"), &bodies, options);
        (bodies, found)
    }
}

/// Boxes with corners on a lattice of `side` steps of 4 units; `hollow`: with one more inside one of them, which looks the other way and may touch it from within.
pub(crate) fn bricks(rng: &mut Random, side: usize, flips: bool, hollow: bool) -> Vec<Brick> {
    let corner = |rng: &mut Random| [0; 3].map(|_: i64| 4 * rng.below(side + 1) as i64);
    let mut bricks: Vec<Brick> = Vec::new();
    let count = 1 + rng.below(6);
    while bricks.len() < count {
        let inverted = flips && rng.below(3) == 0;
        if rng.below(10) == 0 && !bricks.is_empty() {
            bricks.push(bricks[rng.below(bricks.len())]);
            continue;
        }
        let (a, b) = (corner(rng), corner(rng));
        let (min, max) = ([0, 1, 2].map(|i| a[i].min(b[i])), [0, 1, 2].map(|i| a[i].max(b[i])));
        if (0..3).all(|i| min[i] < max[i]) {
            bricks.push(Brick { min, max, inverted });
        }
    }
    if hollow {
        let around = bricks[rng.below(bricks.len())];
        let (min, max) = (around.min.map(|c| c + rng.below(3) as i64), around.max.map(|c| c - rng.below(2) as i64));
        bricks.push(Brick { min, max, inverted: !around.inverted });
    }
    bricks
}

/// A side of a box, or its two halves.
fn parts_of(quad: &[DVec3], halved: bool) -> Vec<[DVec3; 4]> {
    let [a, b, c, d] = [quad[0], quad[1], quad[2], quad[3]];
    let (ab, cd) = ((a + b) * 0.5, (c + d) * 0.5);
    if halved { vec![[a, ab, cd, d], [ab, b, c, cd]] } else { vec![[a, b, c, d]] }
}

/// Planes along the lattice, or anywhere.
fn planes(rng: &mut Random, side: usize) -> Vec<i64> {
    let side = 4 * side as i64;
    match rng.below(4) {
        0 => (0..=side / 4).map(|i| 4 * i).collect(),
        1 => (0..=side / 4).step_by(2).map(|i| 4 * i).chain([side + 4]).collect(),
        2 => vec![-1, side / 2 + 1, side + 3],
        _ => {
            let mut planes: Vec<i64> = (0..2 + rng.below(4)).map(|_| rng.below(side as usize + 3) as i64 - 1).collect();
            planes.extend([-1, side]);
            planes.sort_unstable();
            planes.dedup();
            planes
        }
    }
}

fn for_each(lo: [usize; 3], hi: [usize; 3], mut visit: impl FnMut([usize; 3])) {
    for z in lo[2]..hi[2] {
        for y in lo[1]..hi[1] {
            for x in lo[0]..hi[0] {
                visit([x, y, z]);
            }
        }
    }
}

/// What one scene was.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Visited {
    /// Its solid is defined.
    pub defined: bool,
    /// All its bounds coincide.
    pub exact: bool,
    /// Boxes of both orientations.
    pub flipped: bool,
    /// It has cavities.
    pub hollow: bool,
    /// What some triangles hold could not be told.
    pub doubtful: bool,
    /// Surface was dropped that was there twice.
    pub doubled: bool,
    /// Some triangles have their reverse in the file.
    pub two_sided: bool,
    /// Sides in parts: edges without partners.
    pub t_junctions: bool,
    /// It is so far from the origin that coordinates are counted from the corner of the grid.
    pub far: bool,
}

/// By how much a value may leave its bounds.
pub const SLACK: f64 = 1e-12;

/// Of six sides none has a back.
const NO_BACKS: usize = 6;

/// Of some boxes no side has a back, of others every one.
const SOME_BOXES: usize = 7;

/// How scenes are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// [`Scene::random`].
    Random,
    /// [`Scene::in_parts`].
    Parts,
    /// [`Scene::mixed`].
    Mixed,
}

impl Family {
    /// A scene by some random numbers.
    #[must_use]
    pub fn scene(self, rng: &mut Random) -> Scene {
        match self {
            Family::Random => Scene::random(rng),
            Family::Parts => Scene::in_parts(rng),
            Family::Mixed => Scene::mixed(rng),
        }
    }
}

/// Every value of a family's scene with this seed lies within its bounds.
///
/// # Errors
/// The first value that does not, with its place.
pub fn bounds_hold(family: Family, seed: u64) -> Result<Visited, String> {
    scene_holds(&family.scene(&mut Random::new(seed))).map_err(|text| format!("{family:?} seed {seed}: {text}"))
}

/// The first byte chooses the family, random or in parts, each other one decides one random number of the scene.
///
/// # Panics
/// If a value leaves its bounds.
pub fn bytes_hold(bytes: &[u8]) {
    let Some((first, rest)) = bytes.split_first() else { return };
    let family = if first % 2 == 0 { Family::Random } else { Family::Parts };
    scene_holds(&family.scene(&mut Random::from_bytes(rest))).unwrap_or_else(|text| panic!("{text}"));
}

/// Every value of a scene lies within its bounds.
fn scene_holds(scene: &Scene) -> Result<Visited, String> {
    let Some([closed, open]) = scene.truth(true).zip(scene.truth(false)).map(<[FieldSet; 2]>::from) else {
        return Ok(Visited::default());
    };
    let (bodies, found) = scene.measured();
    let [lower, upper] = found.bounds.as_ref().expect("bounds");
    let of = |set: &FieldSet| [set.v.to_vec(), set.x.to_vec(), set.y.to_vec(), set.z.to_vec()];
    let [closed, open, lower, upper] = [&closed, &open, lower, upper].map(of);
    for (field, name) in ["v", "x", "y", "z"].into_iter().enumerate() {
        for n in 0..closed[field].len() {
            let [least, most, l, u] = [&closed, &open, &lower, &upper].map(|set| set[field][n]);
            if !(l - SLACK <= most && least <= u + SLACK) {
                return Err(format!(
                    "beta_{name}[{n}] is {least} to {most}, its bounds {l} and {u}\n{:?}\n{:?}\n{:?}",
                    scene.bricks, scene.edges, bodies.warnings
                ));
            }
        }
    }
    let d = &bodies.diagnoses[0];
    Ok(Visited {
        defined: true,
        exact: found.max_gap <= SLACK,
        flipped: scene.bricks.iter().any(|b| b.inverted) && scene.bricks.iter().any(|b| !b.inverted),
        hollow: d.cavities > 0,
        doubtful: d.doubtful > 0,
        doubled: d.repeated + d.doubled > 0,
        two_sided: scene.has_backs(),
        t_junctions: d.t_junction_edges > 0,
        far: scene.offset >= 256,
    })
}
