//! T-junctions: an edge on one side of which the surface has more corners than on the other.
//!
//! Such a surface closes in space, and its triangles have no partners by their edges. So the triangles at the edge are cut at the corners that lie on it;
//! then the surface closes in its edges as well, and where parts touch, or have two sides, it can be told what belongs together.

use crate::geometry::repair::edges::{EdgeUses, Use, balance, ends, key};
use crate::geometry::repair::weld::{Indexed, edges_of};
use glam::DVec3;
use rustc_hash::{FxHashMap as HashMap, FxHashSet as HashSet};

/// Two edges at a corner run straight on if the cosine of their angle is below this.
const STRAIGHT: f64 = -1.0 + 1e-8;

/// An edge with corners within: the lower end first.
pub type EdgeCorners = HashMap<u64, Vec<u32>>;

/// Cuts triangles at the corners on their edges, those within `rounding` of them. Returns how many edges had no partner for that.
/// `two_sided`: is a triangle the back of another?
pub fn cut(mesh: &mut Indexed, alive: &mut Vec<bool>, uses: &EdgeUses, two_sided: bool, rounding: f64) -> usize {
    let odd: Vec<u64> = uses.each().filter(|uses| is_odd(mesh, uses)).map(|uses| uses[0].0).collect();
    // Of double-sided parts most whole edges have the right partners, and cutting them would join what is apart.
    let cut = if two_sided { odd.clone() } else { beside(&odd, uses) };
    let corners = corners_on(mesh, &cut, &straight(mesh, &odd), rounding);
    if corners.is_empty() {
        return 0;
    }
    let has_corners = |t: [u32; 3]| edges_of(t).iter().any(|&[a, b]| corners.contains_key(&key(a, b)));
    let triangles = mesh.triangles.iter().copied().enumerate();
    let cut: Vec<(usize, [u32; 3])> = triangles.filter(|&(n, t)| alive[n] && has_corners(t)).collect();
    for (n, triangle) in cut {
        let mut pieces = Vec::new();
        divide(triangle, edges_of(triangle).map(|edge| within(&corners, edge)), &mut pieces);
        alive[n] = !pieces.is_empty();
        for (i, piece) in pieces.into_iter().enumerate() {
            if i == 0 {
                mesh.triangles[n] = piece;
            } else {
                mesh.sources.push(mesh.source(n as u32));
                mesh.triangles.push(piece);
                alive.push(true);
            }
        }
    }
    let parts = corners.keys().flat_map(|&edge| parts_of(&corners, edge));
    let mut involved: Vec<u64> = parts.filter(|e| odd.binary_search(e).is_ok()).collect();
    involved.extend(corners.keys());
    involved.sort_unstable();
    involved.dedup();
    involved.len()
}

/// These edges, and those that run from an end of one to an end of another: of parts that touch, some triangles may pair along the whole edge and
/// others along its pieces.
fn beside(odd: &[u64], uses: &EdgeUses) -> Vec<u64> {
    let corners: HashSet<u32> = odd.iter().flat_map(|&edge| ends(edge)).collect();
    let all = uses.each().map(|uses| uses[0].0);
    all.filter(|&edge| ends(edge).iter().all(|v| corners.contains(v))).collect()
}

/// An odd number of different triangles at an edge, or more that run it one way than the other: there is one without a partner.
fn is_odd(mesh: &Indexed, uses: &[(u64, Use)]) -> bool {
    if balance(uses) != 0 {
        return true;
    }
    if let [(_, a), (_, b)] = uses {
        return mesh.are_same(a.triangle, b.triangle);
    }
    let corners = |u: &Use| mesh.sorted(u.triangle);
    let mut all: Vec<[u32; 3]> = uses.iter().map(|(_, u)| corners(u)).collect();
    all.sort_unstable();
    all.dedup();
    all.len() % 2 == 1
}

/// Corners at which two of these edges run straight on.
fn straight(mesh: &Indexed, edges: &[u64]) -> Vec<u32> {
    let both_ways = |&edge: &u64| {
        let [a, b] = ends(edge);
        [(a, b), (b, a)]
    };
    let mut ways: Vec<(u32, u32)> = edges.iter().flat_map(both_ways).collect();
    ways.sort_unstable();
    let runs_on = |around: &&[(u32, u32)]| {
        let from = mesh.points[around[0].0 as usize];
        let directions: Vec<DVec3> =
            around.iter().map(|&(_, to)| (mesh.points[to as usize] - from).normalize_or_zero()).collect();
        (0..directions.len()).any(|i| directions[..i].iter().any(|d| d.dot(directions[i]) < STRAIGHT))
    };
    ways.chunk_by(|a, b| a.0 == b.0).filter(runs_on).map(|around| around[0].0).collect()
}

/// Which of some corners lie within which edges, from their lower end to their higher one.
pub fn corners_on(mesh: &Indexed, edges: &[u64], corners: &[u32], rounding: f64) -> EdgeCorners {
    let mut found = EdgeCorners::default();
    // In order along the axis on which they spread most, so that an edge looks only at those beside it.
    let places = || corners.iter().map(|&v| mesh.points[v as usize]);
    let spread = places().fold(DVec3::NEG_INFINITY, DVec3::max) - places().fold(DVec3::INFINITY, DVec3::min);
    let axis = (0..3).max_by(|&a, &b| spread[a].total_cmp(&spread[b])).unwrap_or(0);
    let mut in_order: Vec<(f64, u32)> = corners.iter().map(|&v| (mesh.points[v as usize][axis], v)).collect();
    in_order.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    for &edge in edges {
        let [a, b] = ends(edge);
        let (p, q) = (mesh.points[a as usize], mesh.points[b as usize]);
        let (lo, hi) = (p.min(q) - rounding, p.max(q) + rounding);
        let first = in_order.partition_point(|c| c.0 < lo[axis]);
        let along = (q - p).normalize_or_zero();
        let length = p.distance(q);
        let mut inner: Vec<(f64, u32)> = Vec::new();
        for &(_, v) in in_order[first..].iter().take_while(|c| c.0 <= hi[axis]) {
            let m = mesh.points[v as usize];
            if v == a || v == b || m.cmplt(lo).any() || m.cmpgt(hi).any() {
                continue;
            }
            let t = (m - p).dot(along);
            let clear = 4.0 * rounding;
            if t > clear && t < length - clear && (m - p - along * t).length() <= rounding {
                inner.push((t, v));
            }
        }
        if !inner.is_empty() {
            inner.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
            found.insert(edge, inner.into_iter().map(|(_, v)| v).collect());
        }
    }
    found
}

/// The parts of an edge between the corners within it.
pub fn parts_of(corners: &EdgeCorners, edge: u64) -> impl Iterator<Item = u64> {
    let ([low, high], inner) = (ends(edge), corners.get(&edge).map_or(&[][..], |inner| inner));
    let starts = std::iter::once(low).chain(inner.iter().copied());
    starts.zip(inner.iter().copied().chain([high])).map(|(a, b)| key(a, b))
}

/// The corners within a directed edge, in its direction.
fn within(corners: &EdgeCorners, [a, b]: [u32; 2]) -> Vec<u32> {
    let mut inner = corners.get(&key(a, b)).cloned().unwrap_or_default();
    if a > b {
        inner.reverse();
    }
    inner
}

/// Divides a triangle at the corners on its edges, which are those from each of its corners on. A triangle and its reverse are divided alike:
/// the edge of the lowest numbers first, at the corner next to its lower end.
fn divide([a, b, c]: [u32; 3], on: [Vec<u32>; 3], pieces: &mut Vec<[u32; 3]>) {
    let [ab, bc, ca] = on;
    let edges = [(a, b, !ab.is_empty()), (b, c, !bc.is_empty()), (c, a, !ca.is_empty())];
    let next = (0..3).filter(|&i| edges[i].2).min_by_key(|&i| key(edges[i].0, edges[i].1));
    let (p, q, r, pq, qr, rp) = match next {
        None => {
            if a != b && b != c && c != a {
                pieces.push([a, b, c]);
            }
            return;
        }
        Some(0) => (a, b, c, ab, bc, ca),
        Some(1) => (b, c, a, bc, ca, ab),
        Some(_) => (c, a, b, ca, ab, bc),
    };
    let at = if p < q { 0 } else { pq.len() - 1 };
    divide([p, pq[at], r], [pq[..at].to_vec(), Vec::new(), rp], pieces);
    divide([pq[at], q, r], [pq[at + 1..].to_vec(), qr, Vec::new()], pieces);
}
