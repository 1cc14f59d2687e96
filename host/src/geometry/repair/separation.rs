//! Pairs of triangles that may meet, where boxes along the axes tell little: a fan of needles around one corner, the strips of a turned cylinder.
//!
//! A set of triangles is divided by a plane through a side of one of them, upright on it: a fan and the strips of a cylinder are cut through their axis. What
//! lies above the plane and what lies below are never looked at together; each half is divided on, and both are looked at with the few across the plane.
//!
//! **Why two triangles on two sides of a plane are clear.** The corners of the upper one are higher than [`CLEAR`] tolerances, but for one at most, which is
//! in the plane within a tolerance; those of the lower one are as deep. Heights are good to a small part of a tolerance. So they share no side. If one of them
//! has no corner in the plane, they are far apart. If both have the same corner there, the one has no other point as low as that, the other none as high:
//! the corner is all that they have in common. If they have different corners there, what of each is within a tolerance of the plane is but a tip around its
//! corner, smaller than the triangle by [`CLEAR`]; the corners are farther apart than that (`FAR`).
//!
//! The rules of [`near`](crate::geometry::repair::face::near) and [`meeting`](crate::geometry::repair::face::meeting) say the same. A cut is found where a part
//! of a straight line in the one triangle lies within all sides of the other, seen along its normal, and within tolerances of its plane. Both triangles would come
//! as near to each other there. If they share a corner in the plane between them, the line begins in it and ends in the opposite side; what is within the two
//! sides at that corner is a cone with its tip there, which holds the end of the line if it holds any of it; but the cone lies on one side of the plane and
//! the end on the other. In one plane, two triangles without common inner points are beyond a side of one of them.

use crate::geometry::repair::face::{CLEAR, Face, bounds};
use glam::DVec3;
use std::ops::Range;

/// Corners in a plane are one, or farther apart than this share of the size of all.
const FAR: f64 = 1e-3;

/// So many different corners in a plane at most; triangles with others count as lying across it.
const CORNERS: usize = 8;

/// Sets of so many triangles are not divided.
const LEAF: usize = 16;

/// Planes that are tried for one division, …
const TRIES: usize = 12;

/// … each on so many triangles.
const SAMPLE: usize = 48;

/// A plane must tell apart one of so many pairs, else all pairs are looked at.
const LEAST_SHARE: usize = 16;

/// Where a triangle lies.
#[derive(Clone, Copy, PartialEq)]
enum Place {
    Above,
    Across,
    Below,
}

/// A plane through a side of a triangle, upright on it.
struct Plane<'a> {
    face: &'a Face,
    side: usize,
    /// The corners in it of triangles above and below.
    corners: [DVec3; CORNERS],
    count: usize,
}

impl<'a> Plane<'a> {
    /// Through the longest side.
    fn new(face: &'a Face) -> Self {
        let length = |side: usize| face.corners[side].distance_squared(face.corners[(side + 1) % 3]);
        let side = (0..3).max_by(|&a, &b| length(a).total_cmp(&length(b))).unwrap_or(0);
        Plane { face, side, corners: [DVec3::ZERO; CORNERS], count: 0 }
    }

    /// May a corner lie in the plane?
    fn takes(&mut self, p: DVec3, far: f64) -> bool {
        let known = &self.corners[..self.count];
        if known.contains(&p) {
            return true;
        }
        let is_new = self.count < CORNERS && known.iter().all(|q| q.distance(p) > far);
        if is_new {
            self.corners[self.count] = p;
            self.count += 1;
        }
        is_new
    }
}

/// How many triangles of a set lie above a plane, across it and below.
type Counts = [usize; 3];

/// Pairs of two sets that a plane tells apart.
fn told_apart(first: Counts, second: Counts) -> usize {
    first[0] * second[2] + first[2] * second[0]
}

/// Is it small enough to look at all pairs of two sets, or of one?
fn is_leaf([s, t]: &[Range<usize>; 2]) -> bool {
    s.len() * t.len() <= LEAF * LEAF
}

/// The whole of two neighbouring ranges.
fn joined(a: &Range<usize>, b: &Range<usize>) -> Range<usize> {
    a.start..b.end
}

/// Triangles that are divided.
struct Division<'a> {
    faces: &'a [Face],
    boxes: Vec<[DVec3; 2]>,
    /// Their numbers. Sets are ranges of it.
    order: Vec<u32>,
    on: f64,
    far: f64,
}

impl<'a> Division<'a> {
    fn new(faces: &'a [Face], on: f64) -> Self {
        let boxes: Vec<[DVec3; 2]> = faces.iter().map(|face| bounds(&face.corners)).collect();
        let [lo, hi] = around(boxes.iter());
        Division { faces, boxes, order: (0..faces.len() as u32).collect(), on, far: FAR * lo.distance(hi) }
    }

    fn members(&self, set: &Range<usize>) -> impl Iterator<Item = usize> {
        self.order[set.clone()].iter().map(|&n| n as usize)
    }

    /// So many members of a set, spread over it by the golden ratio, which no order of a file repeats; some more than once.
    fn spread(&self, set: &Range<usize>, count: usize) -> impl Iterator<Item = usize> {
        let (first, len) = (set.start, set.len() as u64);
        let at = move |i: u64| first + (((i.wrapping_mul(0x9e37_79b9) & 0xffff_ffff) * len) >> 32) as usize;
        (1..=count as u64).map(move |i| self.order[at(i)] as usize)
    }

    fn place(&self, n: usize, plane: &mut Plane) -> Place {
        let (mut above, mut below, mut corner) = (0, 0, None);
        for p in self.faces[n].corners {
            let height = plane.face.depth(plane.side, p);
            above += usize::from(height > CLEAR * self.on);
            below += usize::from(height < -CLEAR * self.on);
            if height.abs() <= self.on {
                corner = Some(p);
            }
        }
        let on_one_side = match (above.max(below), corner) {
            (3, _) => true,
            (2, Some(p)) => plane.takes(p, self.far),
            _ => false,
        };
        match on_one_side {
            false => Place::Across,
            true if above > below => Place::Above,
            true => Place::Below,
        }
    }

    fn count(&self, members: impl Iterator<Item = usize>, plane: &mut Plane) -> Counts {
        let mut counts = [0; 3];
        members.for_each(|n| counts[self.place(n, plane) as usize] += 1);
        counts
    }

    /// The plane of a few that tells most pairs of two sets apart, or of one.
    fn plane(&self, [s, t]: &[Range<usize>; 2]) -> Option<Plane<'a>> {
        let share = |face: &'a Face| {
            let mut plane = Plane::new(face);
            let first = self.count(self.spread(s, SAMPLE), &mut plane);
            let second = if s == t { first } else { self.count(self.spread(t, SAMPLE), &mut plane) };
            told_apart(first, second)
        };
        let tries = self.spread(s, TRIES / 2).chain(self.spread(t, TRIES).skip(TRIES / 2));
        let tried = tries.map(|n| &self.faces[n]).map(|face| (share(face), face));
        let best = tried.max_by_key(|(share, _)| *share)?;
        (best.0 * LEAST_SHARE >= SAMPLE * SAMPLE).then(|| Plane::new(best.1))
    }

    /// Puts a set in order: what is above a plane, across it, below.
    fn divide(&mut self, set: &Range<usize>, plane: &mut Plane) -> [Range<usize>; 3] {
        let (mut above, mut next, mut below) = (set.start, set.start, set.end);
        while next < below {
            match self.place(self.order[next] as usize, plane) {
                Place::Above => {
                    self.order.swap(above, next);
                    (above, next) = (above + 1, next + 1);
                }
                Place::Across => next += 1,
                Place::Below => {
                    below -= 1;
                    self.order.swap(next, below);
                }
            }
        }
        [set.start..above, above..below, below..set.end]
    }

    /// Those of a set whose boxes touch the box around another set, put first.
    fn touching(&mut self, set: Range<usize>, other: &Range<usize>) -> Range<usize> {
        let around = around(self.members(other).map(|n| &self.boxes[n]));
        let mut end = set.start;
        for at in set.clone() {
            if touch(&self.boxes[self.order[at] as usize], &around) {
                self.order.swap(end, at);
                end += 1;
            }
        }
        set.start..end
    }

    /// Is something true of all pairs of two sets, or of one, whose boxes touch?
    fn all_pairs(&self, [s, t]: &[Range<usize>; 2], is_true: &mut impl FnMut(usize, usize) -> bool) -> bool {
        let after = |at: usize| if s == t { at + 1..t.end } else { t.clone() };
        s.clone().all(|at| {
            let m = self.order[at] as usize;
            self.members(&after(at)).all(|n| !touch(&self.boxes[m], &self.boxes[n]) || is_true(m, n))
        })
    }

    /// Pairs of sets instead of two sets, or of one, that hold all its pairs that a plane does not tell apart. The last ones must be looked at first: each may put
    /// its own members into another order, and those before hold its sets as a whole. None if few pairs are told apart.
    fn parts(&mut self, [s, t]: [Range<usize>; 2]) -> Option<Vec<[Range<usize>; 2]>> {
        let mut plane = self.plane(&[s.clone(), t.clone()])?;
        let [above, across, below] = self.divide(&s, &mut plane);
        let lens = |set: [&Range<usize>; 3]| set.map(ExactSizeIterator::len);
        let first = lens([&above, &across, &below]);
        if s == t {
            let is_worth_it = told_apart(first, first) * LEAST_SHARE >= s.len() * s.len();
            let upper = joined(&above, &across);
            return is_worth_it.then(|| vec![[upper.clone(), upper], [below.clone(), below.clone()], [across, below]]);
        }
        let [over, between, under] = self.divide(&t, &mut plane);
        let second = lens([&over, &between, &under]);
        let is_worth_it = told_apart(first, second) * LEAST_SHARE >= s.len() * t.len();
        let with = |set: &Range<usize>, other: Range<usize>| [set.clone(), other];
        is_worth_it.then(|| {
            let halves =
                [with(&above, over), with(&above, between.clone()), with(&below, between), with(&below, under)];
            [&[[across, t]][..], &halves].concat()
        })
    }
}

/// The box around some.
fn around<'a>(boxes: impl Iterator<Item = &'a [DVec3; 2]>) -> [DVec3; 2] {
    boxes.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[a, b], [lo, hi]| [a.min(*lo), b.max(*hi)])
}

fn touch(a: &[DVec3; 2], b: &[DVec3; 2]) -> bool {
    a[0].cmple(b[1]).all() && a[1].cmpge(b[0]).all()
}

/// Is something true of every pair of triangles whose boxes touch and that no plane tells apart? It is asked once of each. Points closer than `on` to a plane
/// are on it. Two triangles that are told apart share no side, and neither cuts or covers the other.
///
/// What no plane divides is looked at pair by pair. Sets are ranges of one list, and a division leaves 15/16 of the pairs at most, so memory for sets that wait
/// grows with the logarithm of the number of triangles.
pub fn all_not_apart(faces: &[Face], on: f64, mut is_true: impl FnMut(usize, usize) -> bool) -> bool {
    let mut division = Division::new(faces, on);
    let mut open = vec![[0..faces.len(), 0..faces.len()]];
    while let Some([s, t]) = open.pop() {
        let pair = if s == t {
            [s, t]
        } else {
            let s = division.touching(s, &t);
            let t = division.touching(t, &s);
            [s, t]
        };
        let parts = if is_leaf(&pair) { None } else { division.parts(pair.clone()) };
        match parts {
            Some(parts) => open.extend(parts),
            None if division.all_pairs(&pair, &mut is_true) => {}
            None => return false,
        }
    }
    true
}
