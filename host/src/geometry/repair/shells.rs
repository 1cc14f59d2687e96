//! Triangles to shells: which belong together, which way round, and where the surface is open.
//!
//! Two triangles are neighbours across an edge that they run in opposite directions. Where more than two meet, parts of an
//! assembly touch; each triangle then takes the neighbour nearest in the file, because exporters write part by part.

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
}

/// One triangle's use of an edge: the triangle and whether it runs from the lower to the higher vertex.
#[derive(Clone, Copy)]
struct Use {
    triangle: u32,
    up: bool,
}

/// Uses of edges, sorted by edge and then by triangle. An edge is its lower vertex, then its higher one.
struct Edges(Vec<(u64, Use)>);

fn key(a: u32, b: u32) -> u64 {
    u64::from(a.min(b)) << 32 | u64::from(a.max(b))
}

impl Edges {
    fn new(mesh: &Indexed, alive: &[bool]) -> Self {
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
    fn of(&self, edge: u64) -> &[(u64, Use)] {
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
fn balance(uses: &[(u64, Use)]) -> i64 {
    uses.iter().map(|(_, u)| if u.up { 1 } else { -1 }).sum()
}

/// Drop repeated triangles, by clusters that share edges, where that leaves the surface no more open than before; a repeat
/// that closes another part stays. Returns the number dropped.
pub fn drop_repeats(mesh: &Indexed, alive: &mut [bool]) -> usize {
    let mut first: HashMap<[u32; 3], u32> = HashMap::default();
    first.reserve(mesh.triangles.len());
    let mut repeats = Vec::new();
    for (n, &t) in mesh.triangles.iter().enumerate().filter(|&(n, _)| alive[n]) {
        let lowest = (0..3).min_by_key(|&i| t[i]).unwrap_or(0);
        let key = [t[lowest], t[(lowest + 1) % 3], t[(lowest + 2) % 3]];
        if *first.entry(key).or_insert(n as u32) != n as u32 {
            repeats.push(n as u32);
        }
    }
    if repeats.is_empty() {
        return 0;
    }
    let edges = Edges::new(mesh, alive);
    let mut dropped = 0;
    for cluster in clusters(mesh, &repeats) {
        let mut change: HashMap<u64, i64> = HashMap::default();
        for &n in &cluster {
            for [a, b] in edges_of(mesh.triangles[n as usize]) {
                *change.entry(key(a, b)).or_default() += if a < b { 1 } else { -1 };
            }
        }
        let (mut before, mut after) = (0, 0);
        for (edge, less) in change {
            let up = balance(edges.of(edge));
            before += up.abs();
            after += (up - less).abs();
        }
        if after <= before {
            cluster.iter().for_each(|&n| alive[n as usize] = false);
            dropped += cluster.len();
        }
    }
    dropped
}

/// Groups of some triangles connected through edges.
fn clusters(mesh: &Indexed, members: &[u32]) -> Vec<Vec<u32>> {
    let mut sets = Sets::new(members.len());
    let mut owner: HashMap<u64, usize> = HashMap::default();
    for (m, &n) in members.iter().enumerate() {
        for [a, b] in edges_of(mesh.triangles[n as usize]) {
            let other = *owner.entry(key(a, b)).or_insert(m);
            sets.join(m, other);
        }
    }
    let mut groups: HashMap<usize, Vec<u32>> = HashMap::default();
    for (m, &n) in members.iter().enumerate() {
        groups.entry(sets.find(m)).or_default().push(n);
    }
    let mut groups: Vec<_> = groups.into_values().collect();
    groups.sort();
    groups
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

/// The two triangles of a plain edge.
fn plain(uses: &[(u64, Use)]) -> Option<Link> {
    match uses {
        [(_, p), (_, q)] if p.triangle != q.triangle => Some(Link { a: p.triangle, b: q.triangle, same: p.up == q.up }),
        _ => None,
    }
}

/// Pair the uses of one edge that is not plain: opposite directions first, the least `strangeness` first, nearest in the file
/// first; what is left is boundary.
fn pair(
    uses: &[(u64, Use)],
    mut strangeness: impl FnMut(u32, u32) -> u8,
    links: &mut Vec<Link>,
    mut lonely: impl FnMut(Use),
) {
    let mut free = vec![true; uses.len()];
    for same in [false, true] {
        let mut candidates = Vec::new();
        for (m, (_, p)) in uses.iter().enumerate() {
            // A long list would cost its square; its far ends are not neighbours anyway.
            for (n, (_, q)) in uses.iter().enumerate().skip(m + 1).take(64) {
                if (p.up == q.up) == same && p.triangle != q.triangle {
                    candidates.push((strangeness(p.triangle, q.triangle), p.triangle.abs_diff(q.triangle), m, n));
                }
            }
        }
        candidates.sort_unstable();
        // Turning triangles over is for plain edges only: at an edge of many, an odd one out is a loose flap.
        for (_, _, m, n) in candidates.into_iter().filter(|_| !same || uses.len() == 2) {
            if free[m] && free[n] {
                (free[m], free[n]) = (false, false);
                links.push(Link { a: uses[m].1.triangle, b: uses[n].1.triangle, same });
            }
        }
    }
    for (m, &(_, u)) in uses.iter().enumerate() {
        if free[m] {
            lonely(u);
        }
    }
}

/// Split a mesh into shells and turn their triangles to agree with each other; `mesh` is changed where triangles turn.
/// `solid_of` tells which named solid a triangle came from: at edges of many, a solid's triangles belong together, and so do
/// those that plain edges connect.
pub fn shells(mesh: &mut Indexed, alive: &[bool], solid_of: impl Fn(u32) -> usize) -> Vec<Shell> {
    let count = mesh.triangles.len();
    let mut links = Vec::with_capacity(count * 3 / 2);
    let mut lonely = Vec::new();
    let edges = Edges::new(mesh, alive);
    let mut connected = Sets::new(count);
    for link in edges.each().filter_map(plain) {
        connected.join(link.a as usize, link.b as usize);
        links.push(link);
    }
    for uses in edges.each().filter(|uses| plain(uses).is_none()) {
        let edge = uses[0].0;
        let strangeness = |a: u32, b: u32| {
            let strange = connected.find(a as usize) != connected.find(b as usize);
            u8::from(solid_of(a) != solid_of(b)) * 2 + u8::from(strange)
        };
        pair(uses, strangeness, &mut links, |u| lonely.push((u.triangle, edge)));
    }
    let turn = orientations(count, &links);
    for (t, turn) in mesh.triangles.iter_mut().zip(&turn) {
        if turn.turned {
            t.swap(1, 2);
        }
    }
    let mut position = HashMap::default();
    let mut shells: Vec<Shell> = Vec::new();
    for n in (0..count).filter(|&n| alive[n]) {
        let at = *position.entry(turn[n].root).or_insert_with(|| {
            shells.push(Shell::default());
            shells.len() - 1
        });
        shells[at].triangles.push(n as u32);
        shells[at].turned += usize::from(turn[n].turned);
    }
    for link in &links {
        let (a, b) = (&turn[link.a as usize], &turn[link.b as usize]);
        if (a.turned != b.turned) != link.same {
            shells[position[&a.root]].one_sided = true;
        }
    }
    for (n, edge) in lonely {
        let directed = edges_of(mesh.triangles[n as usize]).into_iter().find(|&[a, b]| key(a, b) == edge);
        shells[position[&turn[n as usize].root]].boundary.extend(directed);
    }
    shells
}

#[derive(Clone, Copy)]
struct Turn {
    root: u32,
    turned: bool,
}

/// Flood each connected set from its first triangle. The minority is what turns.
fn orientations(count: usize, links: &[Link]) -> Vec<Turn> {
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
    let mut turn: Vec<Option<Turn>> = vec![None; count];
    for root in 0..count {
        if turn[root].is_some() {
            continue;
        }
        turn[root] = Some(Turn { root: root as u32, turned: false });
        let mut members = vec![root];
        let mut next = 0;
        while let Some(&n) = members.get(next) {
            next += 1;
            let turned = turn[n].is_some_and(|t| t.turned);
            for &(m, same) in &neighbours[first[n]..first[n + 1]] {
                if turn[m as usize].is_none() {
                    turn[m as usize] = Some(Turn { root: root as u32, turned: turned != same });
                    members.push(m as usize);
                }
            }
        }
        let turned = members.iter().filter(|&&n| turn[n].is_some_and(|t| t.turned)).count();
        if 2 * turned > members.len() {
            members.iter().filter_map(|&n| turn[n].as_mut().map(|t| t.turned ^= true)).for_each(drop);
        }
    }
    turn.into_iter().map(|t| t.unwrap_or(Turn { root: 0, turned: false })).collect()
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
