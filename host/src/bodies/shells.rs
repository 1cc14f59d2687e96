//! Triangles to shells: which belong together, which way round, and where the surface is open.
//!
//! Two triangles are neighbours across an edge that only they use; they should run it in opposite directions, and a minority of
//! triangles that do not is turned. Edges used more often are the matter of [`super::join`].

use super::join::{Joined, join};
use super::weld::Indexed;
use rustc_hash::FxHashMap as HashMap;

/// A set of triangles connected through edges.
#[derive(Debug, Clone, Default)]
pub struct Shell {
    /// Positions in the mesh's triangle list, in file order.
    pub triangles: Vec<u32>,
    /// Directed edges without a partner.
    pub boundary: Vec<[u32; 2]>,
    /// Triangles that were turned to agree with the others.
    pub turned: usize,
    /// It cannot be oriented (as a Möbius strip).
    pub one_sided: bool,
    /// Shells that share a number overlap where they share edges: which triangles belong to which is a guess.
    pub cluster: usize,
    /// It is one of those, or overlaps itself so.
    pub guessed: bool,
}

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
pub struct Edges(Vec<(u64, Use)>);

/// An edge: its lower vertex, then its higher one.
pub fn key(a: u32, b: u32) -> u64 {
    u64::from(a.min(b)) << 32 | u64::from(a.max(b))
}

impl Edges {
    /// Of the triangles that are `alive`.
    #[must_use]
    pub fn new(mesh: &Indexed, alive: &[bool]) -> Self {
        let mut uses = Vec::with_capacity(mesh.triangles.len() * 3);
        for (n, &t) in mesh.triangles.iter().enumerate().filter(|&(n, _)| alive[n]) {
            uses.extend(edges_of(t).map(|[a, b]| (key(a, b), Use { triangle: n as u32, up: a < b })));
        }
        uses.sort_unstable_by_key(|&(edge, u)| (edge, u.triangle, u.up));
        Edges(uses)
    }

    /// The uses of each edge in turn.
    fn each(&self) -> impl Iterator<Item = &[(u64, Use)]> {
        self.0.chunk_by(|a, b| a.0 == b.0)
    }

    /// The uses of one edge.
    #[must_use]
    pub fn of(&self, edge: u64) -> &[(u64, Use)] {
        let first = self.0.partition_point(|u| u.0 < edge);
        let count = self.0[first..].partition_point(|u| u.0 == edge);
        &self.0[first..first + count]
    }
}

/// The directed edges of a triangle.
pub fn edges_of(t: [u32; 3]) -> [[u32; 2]; 3] {
    [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]]
}

/// How many more times an edge is run upwards than downwards.
pub fn balance(uses: &[(u64, Use)]) -> i64 {
    uses.iter().map(|(_, u)| if u.up { 1 } else { -1 }).sum()
}

/// Disjoint sets with path halving.
#[derive(Debug)]
pub struct Sets(Vec<usize>);

impl Sets {
    /// `n` sets of one element each.
    #[must_use]
    pub fn new(n: usize) -> Self {
        Sets((0..n).collect())
    }

    /// The representative of an element's set: its lowest element.
    pub fn find(&mut self, mut a: usize) -> usize {
        while self.0[a] != a {
            self.0[a] = self.0[self.0[a]];
            a = self.0[a];
        }
        a
    }

    /// Make two sets one.
    pub fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.find(a), self.find(b));
        let (low, high) = (a.min(b), a.max(b));
        self.0[high] = low;
    }
}

/// Neighbours across edges. `same` tells that both run the edge the same way: one of them is the wrong way round.
struct Link {
    a: u32,
    b: u32,
    same: bool,
}

/// The two triangles of a plain edge, unless they are the same or each other's reverse.
fn plain(mesh: &Indexed, uses: &[(u64, Use)]) -> Option<Link> {
    let [(_, p), (_, q)] = uses else { return None };
    let corners = |u: &Use| mesh.triangles[u.triangle as usize];
    let apart = corners(p).iter().any(|v| !corners(q).contains(v));
    apart.then_some(Link { a: p.triangle, b: q.triangle, same: p.up == q.up })
}

/// Split a mesh into shells and turn their triangles to agree with each other; `mesh` is changed where triangles turn.
/// `solid_of` tells which named solid a triangle came from: at edges of many, a solid's triangles belong together.
pub fn shells(mesh: &mut Indexed, alive: &[bool], solid_of: impl Fn(u32) -> usize) -> Vec<Shell> {
    let count = mesh.triangles.len();
    let mut edges = Edges::new(mesh, alive);
    let links: Vec<Link> = edges.each().filter_map(|uses| plain(mesh, uses)).collect();
    let mut sets = Sets::new(count);
    links.iter().for_each(|link| sets.join(link.a as usize, link.b as usize));
    let turned = orientations(count, &links);
    for (t, _) in mesh.triangles.iter_mut().zip(&turned).filter(|&(_, &turned)| turned) {
        t.swap(1, 2);
    }
    edges.0.iter_mut().for_each(|(_, u)| u.up ^= turned[u.triangle as usize]);
    let many = edges.each().filter(|uses| plain(mesh, uses).is_none());
    let Joined { lonely, guessed } = join(mesh, many, &mut sets, solid_of);
    let mut position = HashMap::default();
    let mut shells: Vec<Shell> = Vec::new();
    for n in (0..count).filter(|&n| alive[n]) {
        let at = *position.entry(sets.find(n)).or_insert_with(|| {
            shells.push(Shell::default());
            shells.len() - 1
        });
        shells[at].triangles.push(n as u32);
        shells[at].turned += usize::from(turned[n]);
    }
    for link in links.iter().filter(|l| (turned[l.a as usize] != turned[l.b as usize]) != l.same) {
        shells[position[&sets.find(link.a as usize)]].one_sided = true;
    }
    for (n, edge) in lonely {
        let directed = edges_of(mesh.triangles[n as usize]).into_iter().find(|&[a, b]| key(a, b) == edge);
        shells[position[&sets.find(n as usize)]].boundary.extend(directed);
    }
    let mut clusters = Sets::new(shells.len());
    for [a, b] in guessed {
        let [a, b] = [a, b].map(|n| position[&sets.find(n as usize)]);
        (shells[a].guessed, shells[b].guessed) = (true, true);
        clusters.join(a, b);
    }
    shells.iter_mut().enumerate().for_each(|(s, shell)| shell.cluster = clusters.find(s));
    shells
}

/// Which triangles must turn: each connected set is flooded from its first triangle, and the minority turns.
fn orientations(count: usize, links: &[Link]) -> Vec<bool> {
    let mut first = vec![0_usize; count + 1];
    links.iter().flat_map(|l| [l.a, l.b]).for_each(|n| first[n as usize + 1] += 1);
    (0..count).for_each(|n| first[n + 1] += first[n]);
    let mut neighbours = vec![(0_u32, false); first[count]];
    let mut next = first.clone();
    for l in links {
        for (n, other) in [(l.a, l.b), (l.b, l.a)] {
            neighbours[next[n as usize]] = (other, l.same);
            next[n as usize] += 1;
        }
    }
    let (mut turned, mut seen) = (vec![false; count], vec![false; count]);
    let mut members = Vec::new();
    for root in 0..count {
        if seen[root] {
            continue;
        }
        seen[root] = true;
        members.clear();
        members.push(root);
        let mut next = 0;
        while let Some(&n) = members.get(next) {
            next += 1;
            for &(m, same) in &neighbours[first[n]..first[n + 1]] {
                let m = m as usize;
                if !seen[m] {
                    (seen[m], turned[m]) = (true, turned[n] != same);
                    members.push(m);
                }
            }
        }
        if 2 * members.iter().filter(|&&n| turned[n]).count() > members.len() {
            members.iter().for_each(|&n| turned[n] ^= true);
        }
    }
    turned
}

/// Sum of the imbalances of all edges of a mesh: 0 if every edge is run as often one way as the other.
#[must_use]
pub fn unmatched_edges(mesh: &Indexed, alive: &[bool]) -> u64 {
    Edges::new(mesh, alive).each().map(|uses| balance(uses).unsigned_abs()).sum()
}

/// The points on edges that are not run as often one way as the other.
#[must_use]
pub fn unmatched_points(mesh: &Indexed, alive: &[bool]) -> Vec<bool> {
    let mut unmatched = vec![false; mesh.points.len()];
    for uses in Edges::new(mesh, alive).each().filter(|uses| balance(uses) != 0) {
        for v in [uses[0].0 >> 32, uses[0].0 & 0xffff_ffff] {
            unmatched[v as usize] = true;
        }
    }
    unmatched
}
