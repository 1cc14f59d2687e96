//! Shells that meet themselves: found once, independent of any grid, and made the surface of what they wind around.
//!
//! Inside is where the winding number is not 0, however often a shell winds. Triangles that other triangles of the shell cut or cover are
//! divided along them; of every part the winding numbers on both sides tell whether it is surface of the solid. The winding
//! number in the middle of a part, without the triangles that lie there, is the mean of those on both sides, and the triangles that
//! lie there are the difference: no point beside the surface needs to be chosen.
//!
//! **Proof.** The new surface must be closed: its volumes along x, y and z agree, else the shell stays as it is and is said to be in doubt.

use crate::geometry::repair::sets::Sets;
use crate::geometry::repair::tree::Tree;
use glam::DVec3;
use rustc_hash::FxHashMap as HashMap;

/// Points closer to a plane or line than this share of the shell's coordinates are on it: some hundred roundings.
const ON: f64 = 1e-13;

/// Largest difference of the volumes along x, y and z, as a share of the volume that the shell's box holds.
const SPREAD: f64 = 1e-9;

/// So many solid angles may be computed for one shell: some seconds.
const BUDGET: usize = 100_000_000;

/// What a look at a shell says.
#[derive(Debug)]
pub enum Found {
    /// It winds once around what it holds.
    Simple,
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
    /// It has walls without thickness.
    pub walls: bool,
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
    /// Keep a piece of surface, as it is or turned, or drop it.
    fn add(&mut self, piece: impl Iterator<Item = [DVec3; 3]>, sides: Sides, keep: bool, turn: bool) {
        self.forward |= sides.behind > 0 || sides.before > 0;
        self.backward |= sides.behind < 0 || sides.before < 0;
        self.walls |= keep && sides.is_wall();
        self.differs |= turn || !keep;
        if keep {
            self.surface.extend(piece.map(|[a, b, c]| if turn { [a, c, b] } else { [a, b, c] }));
        }
    }
}

/// A triangle with its plane.
#[derive(Clone, Copy)]
struct Face {
    corners: [DVec3; 3],
    normal: DVec3,
}

impl Face {
    fn new(corners: [DVec3; 3]) -> Self {
        let [a, b, c] = corners;
        // The longest two sides give the most digits.
        let normals = [(b - a).cross(c - a), (c - b).cross(a - b), (a - c).cross(b - c)];
        let largest =
            normals.into_iter().fold(DVec3::ZERO, |l, n| if n.length_squared() > l.length_squared() { n } else { l });
        Face { corners, normal: largest.normalize_or_zero() }
    }

    fn height(&self, p: DVec3) -> f64 {
        self.normal.dot(p - self.corners[0])
    }

    /// Distances of a point inward from the lines of the sides, in the plane.
    fn inward(&self, p: DVec3) -> [f64; 3] {
        [0, 1, 2].map(|i| {
            let (a, b) = (self.corners[i], self.corners[(i + 1) % 3]);
            self.normal.cross(b - a).normalize_or_zero().dot(p - a)
        })
    }
}

/// How a triangle meets the inner part of another.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Meeting {
    /// It does not.
    None,
    /// Across, along this segment.
    Cut([DVec3; 2]),
    /// It lies in the same plane, on the same spot.
    Cover,
}

/// How `other` meets the inner part of `face`.
fn meeting(face: &Face, other: &Face, on: f64) -> Meeting {
    let shared = other.corners.map(|p| face.corners.contains(&p));
    let heights = [0, 1, 2].map(|i| if shared[i] { 0.0 } else { face.height(other.corners[i]) });
    let (above, below) = (heights.iter().any(|&h| h > on), heights.iter().any(|&h| h < -on));
    if !above && !below {
        return if covers(face, other, on) { Meeting::Cover } else { Meeting::None };
    }
    let mut ends = [DVec3::ZERO; 2];
    let mut count = 0;
    let mut end = |p: DVec3| {
        if count < 2 {
            ends[count] = p;
        }
        count += 1;
    };
    for i in 0..3 {
        let j = (i + 1) % 3;
        let (p, q, hp, hq) = (other.corners[i], other.corners[j], heights[i], heights[j]);
        if hp.abs() <= on {
            end(p);
        } else if hp.abs() > on && hq.abs() > on && (hp > 0.0) != (hq > 0.0) {
            end(p + (q - p) * (hp / (hp - hq)));
        }
    }
    if count != 2 {
        return Meeting::None;
    }
    // The part of the segment that lies within the triangle, off its sides.
    let (from, to) = (face.inward(ends[0]), face.inward(ends[1]));
    let (mut lo, mut hi) = (0.0_f64, 1.0_f64);
    for i in 0..3 {
        let (a, b) = (from[i] - on, to[i] - on);
        if a <= 0.0 && b <= 0.0 {
            return Meeting::None;
        }
        if a <= 0.0 {
            lo = lo.max(a / (a - b));
        } else if b <= 0.0 {
            hi = hi.min(a / (a - b));
        }
    }
    if (hi - lo) * ends[0].distance(ends[1]) > on { Meeting::Cut(ends) } else { Meeting::None }
}

/// Do two triangles in one plane share more than their sides?
fn covers(a: &Face, b: &Face, on: f64) -> bool {
    let apart = |a: &Face, b: &Face| {
        let inward = b.corners.map(|p| a.inward(p));
        (0..3).any(|side| inward.iter().all(|d| d[side] <= on))
    };
    a.normal != DVec3::ZERO && b.normal != DVec3::ZERO && !apart(a, b) && !apart(b, a)
}

/// Cut convex polygons by the plane through `at` normal to `normal`, those near the box `lo..hi`.
fn cut(parts: &mut Vec<Vec<DVec3>>, at: DVec3, normal: DVec3, [lo, hi]: [DVec3; 2], on: f64) {
    let mut more = Vec::new();
    for part in parts.iter_mut() {
        let (min, max) = part.iter().fold((part[0], part[0]), |(a, b), p| (a.min(*p), b.max(*p)));
        if min.cmpgt(hi).any() || max.cmplt(lo).any() {
            continue;
        }
        let heights: Vec<f64> = part.iter().map(|p| normal.dot(*p - at)).collect();
        if !(heights.iter().any(|&h| h > on) && heights.iter().any(|&h| h < -on)) {
            continue;
        }
        let (mut above, mut below) = (Vec::new(), Vec::new());
        for i in 0..part.len() {
            let j = (i + 1) % part.len();
            let (p, q, hp, hq) = (part[i], part[j], heights[i], heights[j]);
            if hp >= -on {
                above.push(p);
            }
            if hp <= on {
                below.push(p);
            }
            if (hp > on && hq < -on) || (hp < -on && hq > on) {
                // From the lower end, so that neighbours get the same point.
                let (p, q, hp, hq) = if hp < hq { (p, q, hp, hq) } else { (q, p, hq, hp) };
                let crossing = p + (q - p) * (hp / (hp - hq));
                above.push(crossing);
                below.push(crossing);
            }
        }
        *part = above;
        more.push(below);
    }
    parts.append(&mut more);
}

/// The solid angle of a triangle, with sign, in whole spheres.
/// A. van Oosterom and J. Strackee, *The solid angle of a plane triangle*, IEEE Trans. Biomed. Eng. 30 (1983), eq. (8).
pub fn solid_angle(triangle: &[DVec3; 3], point: DVec3) -> f64 {
    let [a, b, c] = triangle.map(|p| p - point);
    let [la, lb, lc] = [a.length(), b.length(), c.length()];
    let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    a.dot(b.cross(c)).atan2(below) / (2.0 * std::f64::consts::PI)
}

/// A shell and where its triangles meet.
struct Shell<'a> {
    triangles: &'a [[DVec3; 3]],
    faces: Vec<Face>,
    /// For each triangle that others meet, these others.
    met: HashMap<u32, Vec<(u32, Meeting)>>,
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

impl<'a> Shell<'a> {
    fn new(triangles: &'a [[DVec3; 3]], on: f64) -> Self {
        let faces: Vec<Face> = triangles.iter().map(|&t| Face::new(t)).collect();
        let mut met: HashMap<u32, Vec<(u32, Meeting)>> = HashMap::default();
        Tree::new(triangles).touching_pairs(|m, n| {
            let (a, b) = (&faces[m as usize], &faces[n as usize]);
            if beside(a, b, on) || beside(b, a, on) {
                return;
            }
            for (m, n, a, b) in [(m, n, a, b), (n, m, b, a)] {
                let found = meeting(a, b, on);
                if found != Meeting::None {
                    met.entry(m).or_default().push((n, found));
                }
            }
        });
        Shell { triangles, faces, met, on }
    }

    /// The triangles that no other meets, in groups connected by edges that only two triangles use.
    fn patches(&self) -> Vec<Vec<u32>> {
        let edges = self.edges();
        let mut sets = Sets::new(self.triangles.len());
        for uses in edges.chunk_by(|a, b| a.0 == b.0) {
            if let [(_, a), (_, b)] = uses
                && !self.met.contains_key(a)
                && !self.met.contains_key(b)
            {
                sets.join(*a as usize, *b as usize);
            }
        }
        let mut at: HashMap<usize, usize> = HashMap::default();
        let mut patches: Vec<Vec<u32>> = Vec::new();
        for n in (0..self.triangles.len()).filter(|&n| !self.met.contains_key(&(n as u32))) {
            let patch = *at.entry(sets.find(n)).or_insert_with(|| {
                patches.push(Vec::new());
                patches.len() - 1
            });
            patches[patch].push(n as u32);
        }
        patches
    }

    /// The uses of all edges, sorted: lower and higher point, and triangle.
    fn edges(&self) -> Vec<([u32; 2], u32)> {
        let mut numbers: HashMap<[u64; 3], u32> = HashMap::default();
        let mut number = |p: DVec3| {
            let next = numbers.len() as u32;
            *numbers.entry((p + 0.0).to_array().map(f64::to_bits)).or_insert(next)
        };
        let mut edges = Vec::with_capacity(3 * self.triangles.len());
        for (n, t) in self.triangles.iter().enumerate() {
            let [a, b, c] = t.map(&mut number);
            edges.extend([[a, b], [b, c], [c, a]].map(|[p, q]| ([p.min(q), p.max(q)], n as u32)));
        }
        edges.sort_unstable();
        edges
    }

    /// The sides of a part with this middle of triangle `n`; `own` are the triangles that lie there, itself too. None if there is doubt.
    fn sides(&self, middle: DVec3, n: u32, own: &[u32]) -> Option<Sides> {
        let normal = self.faces[n as usize].normal;
        let sheets: f64 = own.iter().map(|&m| self.faces[m as usize].normal.dot(normal).signum()).sum();
        let others = self.triangles.iter().enumerate().filter(|(m, _)| !own.contains(&(*m as u32)));
        let mean: f64 = others.map(|(_, t)| solid_angle(t, middle)).sum();
        let whole = |w: f64| ((w - w.round()).abs() < 0.05).then_some(w.round() as i32);
        Some(Sides { behind: whole(mean + 0.5 * sheets)?, before: whole(mean - 0.5 * sheets)? })
    }

    /// The parts into which others divide triangle `n`.
    fn parts(&self, n: u32) -> Vec<Vec<DVec3>> {
        let face = &self.faces[n as usize];
        let mut parts = vec![face.corners.to_vec()];
        for (m, meeting) in self.met.get(&n).into_iter().flatten() {
            let other = &self.faces[*m as usize];
            let around = |ends: &[DVec3]| {
                let (lo, hi) = ends.iter().fold((ends[0], ends[0]), |(a, b), p| (a.min(*p), b.max(*p)));
                [lo - self.on, hi + self.on]
            };
            match meeting {
                Meeting::None => {}
                Meeting::Cut(ends) => cut(&mut parts, ends[0], other.normal, around(ends), self.on),
                Meeting::Cover => {
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
        if patches.len().saturating_mul(self.triangles.len()) > BUDGET {
            return None;
        }
        let area = |n: u32| {
            let [a, b, c] = self.triangles[n as usize];
            (b - a).cross(c - a).length_squared()
        };
        for patch in patches {
            let largest = patch.iter().copied().max_by(|&a, &b| area(a).total_cmp(&area(b)))?;
            let [a, b, c] = self.triangles[largest as usize];
            let sides = self.sides((a + b + c) / 3.0, largest, &[largest])?;
            let whole = patch.iter().map(|&n| self.triangles[n as usize]);
            made.add(whole, sides, sides.is_surface(), (sides.behind == 0) != inverted);
        }
        let mut met: Vec<u32> = self.met.keys().copied().collect();
        met.sort_unstable();
        let mut spent = 0;
        for n in met {
            for part in self.parts(n) {
                spent += self.triangles.len();
                let middle = part.iter().sum::<DVec3>() / part.len() as f64;
                let holds = |m: u32| self.faces[m as usize].inward(middle).iter().all(|&d| d > 0.0);
                let covering = self.met[&n].iter().filter(|(_, found)| *found == Meeting::Cover).map(|(m, _)| *m);
                let own: Vec<u32> = covering.filter(|&m| holds(m)).chain([n]).collect();
                let sides = self.sides(middle, n, &own)?;
                let first = own.iter().all(|&m| m >= n);
                let wall = sides.is_wall() && own.len() > 1;
                let turn = !wall && (sides.behind == 0) != inverted;
                let fan = (1..part.len() - 1).map(|i| [part[0], part[i], part[i + 1]]);
                made.add(fan, sides, wall || (sides.is_surface() && first), turn);
            }
            if spent > BUDGET {
                return None;
            }
        }
        Some(made)
    }
}

/// Does `b` lie off the plane of `a`, all on one side, but for corners that they share? Most neighbours do.
fn beside(a: &Face, b: &Face, on: f64) -> bool {
    let mut sides = [false; 2];
    for p in b.corners.iter().filter(|p| !a.corners.contains(p)) {
        let height = a.height(*p);
        if height.abs() <= on {
            return false;
        }
        sides[usize::from(height > 0.0)] = true;
    }
    sides[0] != sides[1]
}

/// Volumes enclosed by closed triangles, computed along x, y and z.
fn volumes(triangles: &[[DVec3; 3]], origin: DVec3) -> DVec3 {
    let one = |[a, b, c]: &[DVec3; 3]| (b - a).cross(c - a) * ((*a - origin) + (*b - origin) + (*c - origin)) / 6.0;
    triangles.iter().map(one).sum()
}

/// Look at a closed shell.
#[must_use]
pub fn look(triangles: &[[DVec3; 3]], [lo, hi]: [DVec3; 2]) -> Found {
    let on = ON * lo.abs().max(hi.abs()).max_element();
    let shell = Shell::new(triangles, on);
    let many = || shell.edges().chunk_by(|a, b| a.0 == b.0).find(|uses| uses.len() > 2).map(|uses| uses[0].1);
    let Some(n) = shell.met.keys().min().copied().or_else(many) else { return Found::Simple };
    let place = triangles[n as usize][0];
    let origin = (lo + hi) * 0.5;
    let inverted = volumes(triangles, origin).x < 0.0;
    match shell.resolved(inverted) {
        Some(made) if !made.differs => Found::Simple,
        Some(made) if is_closed(&made.surface, origin, (hi - lo).element_product()) => {
            let Made { surface, forward, backward, walls, .. } = made;
            Found::Resolved(Resolved {
                surface,
                place,
                both_ways: forward && backward,
                touches: many().is_some(),
                walls,
            })
        }
        _ => Found::Doubtful(place),
    }
}

/// Do the volumes of some triangles along the axes agree, to a share of that of their box?
fn is_closed(triangles: &[[DVec3; 3]], origin: DVec3, box_volume: f64) -> bool {
    let along = volumes(triangles, origin);
    !triangles.is_empty() && along.max_element() - along.min_element() <= SPREAD * box_volume
}
