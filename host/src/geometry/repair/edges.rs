//! Which triangles use which edges.

use crate::geometry::repair::sets::by_number;
use crate::geometry::repair::weld::{Indexed, edges_of};

/// One triangle's use of an edge: the triangle and whether it runs from the lower to the higher vertex.
#[derive(Clone, Copy, Debug)]
pub struct Use {
    /// The triangle's number.
    pub triangle: u32,
    /// It runs from the lower vertex to the higher one.
    pub up: bool,
}

/// Uses of edges, sorted by edge and then by triangle.
#[derive(Debug)]
pub struct EdgeUses(Vec<(u64, Use)>);

/// An edge: its lower vertex, then its higher one.
pub fn key(a: u32, b: u32) -> u64 {
    u64::from(a.min(b)) << 32 | u64::from(a.max(b))
}

/// The lower and the higher vertex of an edge.
pub fn ends(edge: u64) -> [u32; 2] {
    [(edge >> 32) as u32, edge as u32]
}

impl EdgeUses {
    /// Of the triangles that are `alive`.
    #[must_use]
    pub fn new(mesh: &Indexed, alive: &[bool]) -> Self {
        let alive = mesh.triangles.iter().enumerate().filter(|&(n, _)| alive[n]);
        let sides =
            alive.flat_map(|(n, &t)| edges_of(t).map(|[a, b]| (key(a, b), Use { triangle: n as u32, up: a < b })));
        let lower = |edge: u64| ends(edge)[0] as usize;
        let mut uses = by_number(sides, mesh.points.len(), |&(edge, _)| lower(edge));
        let runs = uses.chunk_by_mut(|a, b| lower(a.0) == lower(b.0));
        // Those of one edge stay in the order of triangles, none of which has it twice.
        runs.for_each(|run| run.sort_by_key(|&(edge, _)| edge));
        EdgeUses(uses)
    }

    /// The uses of each edge in turn.
    pub fn each(&self) -> impl Iterator<Item = &[(u64, Use)]> {
        self.0.chunk_by(|a, b| a.0 == b.0)
    }

    /// Have any two triangles at one edge all corners in common, and run it the same way (`alike`) or opposite ways?
    #[must_use]
    pub fn any_same(&self, mesh: &Indexed, alike: bool) -> bool {
        self.each().any(|uses| match uses {
            [_] => false,
            [(_, a), (_, b)] => (a.up == b.up) == alike && mesh.are_same(a.triangle, b.triangle),
            _ => {
                let way = |(_, u): &(u64, Use)| (mesh.sum_of_corners(u.triangle), u.up);
                let mut ways: Vec<(u64, bool)> = uses.iter().map(way).collect();
                ways.sort_unstable();
                // Of equal triangles those that run the edge downwards come first.
                ways.windows(2).any(|w| w[0].0 == w[1].0 && (w[0].1 == w[1].1) == alike)
            }
        })
    }

    /// Turn all uses by some triangles.
    pub fn turn(&mut self, turned: impl Fn(u32) -> bool) {
        self.0.iter_mut().for_each(|(_, u)| u.up ^= turned(u.triangle));
    }

    /// Sum of the imbalances of all edges: 0 if every edge is run as often one way as the other.
    #[must_use]
    pub fn unmatched(&self) -> u64 {
        self.each().map(|uses| balance(uses).unsigned_abs()).sum()
    }

    /// Which of so many points lie on edges that are not run as often one way as the other.
    #[must_use]
    pub fn unmatched_points(&self, points: usize) -> Vec<bool> {
        let mut unmatched = vec![false; points];
        for uses in self.each().filter(|uses| balance(uses) != 0) {
            for v in ends(uses[0].0) {
                unmatched[v as usize] = true;
            }
        }
        unmatched
    }

    /// The uses of one edge.
    #[must_use]
    pub fn of(&self, edge: u64) -> &[(u64, Use)] {
        let first = self.0.partition_point(|u| u.0 < edge);
        let count = self.0[first..].partition_point(|u| u.0 == edge);
        &self.0[first..first + count]
    }
}

/// How many more times an edge is run upwards than downwards.
pub fn balance(uses: &[(u64, Use)]) -> i64 {
    uses.iter().map(|(_, u)| if u.up { 1 } else { -1 }).sum()
}

/// Edges without those that run back along others: there two sides of a sheet meet.
pub fn without_opposites(edges: impl Iterator<Item = [u32; 2]>) -> Vec<[u32; 2]> {
    let mut edges: Vec<(u64, bool)> = edges.map(|[a, b]| (key(a, b), a < b)).collect();
    edges.sort_unstable();
    let mut left = Vec::new();
    for uses in edges.chunk_by(|a, b| a.0 == b.0) {
        let ([a, b], up) = (ends(uses[0].0), uses.iter().filter(|(_, up)| *up).count());
        let down = uses.len() - up;
        let edge = if up > down { [a, b] } else { [b, a] };
        left.extend(std::iter::repeat_n(edge, up.abs_diff(down)));
    }
    left
}
