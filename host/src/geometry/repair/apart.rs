//! Closed surfaces that were joined to one because they touch, and of which another body holds only some.

use crate::geometry::repair::closed::{Closed, just_within};
use crate::geometry::repair::edges::{ends, key, without_opposites};
use crate::geometry::repair::junctions::{corners_on, parts_of};
use crate::geometry::repair::overlap::contains;
use crate::geometry::repair::rims::rims;
use crate::geometry::repair::sets::Sets;
use crate::geometry::repair::weld::{Indexed, edges_of};
use glam::DVec3;

/// So many times at most a triangle is looked at from a point: beyond, a surface stays as it was joined.
const LOOKS: usize = 20_000_000;

/// Triangles lie in one plane if the sine of the angle between them is no larger: single precision turns them by less.
const FLAT: f64 = 1e-5;

/// Up to so many triangles of a surface each corner is asked for the edges that it lies on.
const SMALL: usize = 4000;

/// A closed surface in pieces: what is connected by edges that leave no choice.
pub struct Pieces<'a> {
    mesh: &'a Indexed,
    /// Its own triangles, then those of walls.
    members: Vec<u32>,
    /// So many are its own.
    own: usize,
    /// Positions in `members`.
    pieces: Vec<Vec<usize>>,
    volume: f64,
    rounding: f64,
}

impl<'a> Pieces<'a> {
    /// Of the triangles `own` of a surface of a `volume`, and the `walls` in it. None if it is one piece.
    #[must_use]
    pub fn new(mesh: &'a Indexed, [own, walls]: [&[u32]; 2], volume: f64, rounding: f64) -> Option<Self> {
        let members = [own, walls].concat();
        let pieces = pieces(mesh, &members, rounding);
        (pieces.len() > 1).then_some(Pieces { mesh, members, own: own.len(), pieces, volume, rounding })
    }

    /// What another part holds of it, and what it does not. None unless there are some of its own triangles on both sides, and each closes by itself and
    /// looks the same way as the whole.
    #[must_use]
    pub fn held_by(&self, other: &Closed) -> Option<Vec<Vec<u32>>> {
        if self.pieces.len().saturating_mul(other.triangles.len()) > LOOKS {
            return None;
        }
        let (mut two, mut has_own) = ([Vec::new(), Vec::new()], [false; 2]);
        for piece in &self.pieces {
            let inner = self.triangles(piece).iter().find_map(|t| just_within(t, self.volume));
            let side = usize::from(!inner.is_some_and(|p| other.winds_around(p)));
            has_own[side] |= piece.iter().any(|&m| m < self.own);
            two[side].extend(piece.iter().map(|&m| self.members[m]));
        }
        two.iter_mut().for_each(|members| members.sort_unstable());
        let looks_alike = |members: &Vec<u32>| {
            let shell = Closed::new(self.mesh.corners(members));
            !shell.is_sheet() && shell.volume * self.volume > 0.0
        };
        let apart = has_own == [true; 2] && two.iter().all(|m| looks_alike(m) && self.closes(m));
        apart.then(|| two.to_vec())
    }

    /// Its pieces, if each closes by itself and some look inward, others outward, beside each other or one within the other: then they are no one surface.
    /// None otherwise; pieces in the same place may be the two sides of one body.
    #[must_use]
    pub fn opposite(&self) -> Option<Vec<Vec<u32>>> {
        let all: Vec<Vec<u32>> = self.pieces.iter().map(|p| p.iter().map(|&m| self.members[m]).collect()).collect();
        let shells = self.pieces.iter().map(|piece| Closed::new(self.triangles(piece)));
        let (outward, inward): (Vec<Closed>, Vec<Closed>) =
            shells.filter(|shell| !shell.is_sheet()).partition(|shell| shell.volume > 0.0);
        let is_clear = |a: &Closed, b: &Closed| !a.overlaps(b) || contains(a, b) || contains(b, a);
        let all_clear = || outward.iter().all(|a| inward.iter().all(|b| is_clear(a, b)));
        let is_few = outward.len().saturating_mul(inward.len()).saturating_mul(self.members.len()) <= LOOKS;
        let apart = !outward.is_empty() && !inward.is_empty() && is_few && all_clear();
        (apart && all.iter().all(|members| self.closes(members))).then_some(all)
    }

    fn triangles(&self, piece: &[usize]) -> Vec<[DVec3; 3]> {
        self.mesh.corners(&piece.iter().map(|&m| self.members[m]).collect::<Vec<_>>())
    }

    /// Does a surface close, be it with T-junctions?
    fn closes(&self, members: &[u32]) -> bool {
        let edges = members.iter().flat_map(|&n| edges_of(self.mesh.triangles[n as usize]));
        rims(&without_opposites(edges)).iter().all(|rim| rim.cancels(&self.mesh.points, self.rounding))
    }
}

/// What of a surface is connected by edges of two triangles, or of four in one plane, two of them the backs of the others, cut at the corners on them; of
/// large surfaces at those that edges of more or fewer triangles have. Positions in `members`; none if there are no such corners.
fn pieces(mesh: &Indexed, members: &[u32], rounding: f64) -> Vec<Vec<usize>> {
    let keys = |n: u32| edges_of(mesh.triangles[n as usize]).map(|[a, b]| key(a, b));
    let mut edges: Vec<u64> = members.iter().flat_map(|&n| keys(n)).collect();
    edges.sort_unstable();
    let is_small = members.len() <= SMALL;
    let asked = edges.chunk_by(|a, b| a == b).filter(|uses| is_small || uses.len() != 2);
    let mut corners: Vec<u32> = asked.flat_map(|uses| ends(uses[0])).collect();
    if corners.is_empty() {
        return Vec::new();
    }
    corners.sort_unstable();
    corners.dedup();
    edges.dedup();
    let on_edges = corners_on(mesh, &edges, &corners, rounding);
    let mut uses: Vec<(u64, usize)> = Vec::new();
    for (m, &n) in members.iter().enumerate() {
        uses.extend(keys(n).into_iter().flat_map(|edge| parts_of(&on_edges, edge)).map(|part| (part, m)));
    }
    uses.sort_unstable();
    let mut sets = Sets::new(members.len());
    for uses in uses.chunk_by(|a, b| a.0 == b.0) {
        if let [(_, m), (_, n)] = uses {
            sets.join(*m, *n);
        } else if let &[(edge, a), (_, b), (_, c), (_, d)] = uses {
            let four = [a, b, c, d];
            let beside = four.map(|m| Beside::new(mesh, mesh.triangles[members[m] as usize], edge));
            for [i, j] in flat_pairs(&beside).into_iter().flatten() {
                sets.join(four[i], four[j]);
            }
        }
    }
    sets.groups()
}

/// A triangle at an edge.
struct Beside {
    /// Of length 1, or 0 if it has no area.
    normal: DVec3,
    /// From the edge to the corner farthest from it.
    off: DVec3,
}

impl Beside {
    fn new(mesh: &Indexed, triangle: [u32; 3], edge: u64) -> Self {
        let [start, end] = ends(edge).map(|v| mesh.points[v as usize]);
        let [a, b, c] = triangle.map(|v| mesh.points[v as usize]);
        let along = (end - start).normalize_or_zero();
        let offs = [a, b, c].map(|p| (p - start).reject_from_normalized(along));
        let off = offs.into_iter().max_by(|p, q| p.length_squared().total_cmp(&q.length_squared()));
        Beside { normal: (b - a).cross(c - a).normalize_or_zero(), off: off.unwrap_or(DVec3::ZERO) }
    }
}

/// Which of four triangles at an edge go on in each other; none unless all lie in one plane and two face one way, two the other.
fn flat_pairs(beside: &[Beside; 4]) -> Option<[[usize; 2]; 2]> {
    let first = &beside[0];
    let is_flat = |b: &Beside| b.normal != DVec3::ZERO && b.normal.cross(first.normal).length() <= FLAT;
    let goes_on =
        |i: usize, j: usize| beside[i].normal.dot(beside[j].normal) > 0.0 && beside[i].off.dot(beside[j].off) < 0.0;
    let opposite = |i: usize, j: usize| beside[i].normal.dot(beside[j].normal) < 0.0;
    let pairs = [[[0, 1], [2, 3]], [[0, 2], [1, 3]], [[0, 3], [1, 2]]];
    let found = || pairs.into_iter().find(|[[a, b], [c, d]]| goes_on(*a, *b) && goes_on(*c, *d) && opposite(*a, *c));
    beside.iter().all(is_flat).then(found).flatten()
}
