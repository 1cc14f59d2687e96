//! Surface that is there more than once: repeated triangles, repeated shells, and the backs of double-sided surfaces.

use crate::geometry::repair::closed::signed_volume;
use crate::geometry::repair::edges::{EdgeUses, balance, key};
use crate::geometry::repair::rims::rims;
use crate::geometry::repair::sets::{Sets, by_number};
use crate::geometry::repair::shells::Shell;
use crate::geometry::repair::weld::{Indexed, edges_of};
use glam::DVec3;
use rustc_hash::{FxHashMap as HashMap, FxHashSet as HashSet};

/// A triangle's corners from the lowest on: equal for equal triangles of one orientation.
fn from_lowest(t: [u32; 3]) -> [u32; 3] {
    let lowest = (0..3).min_by_key(|&i| t[i]).unwrap_or(0);
    [t[lowest], t[(lowest + 1) % 3], t[(lowest + 2) % 3]]
}

/// Drop repeated triangles, by clusters that share edges, where that leaves the surface no more open than before; a repeat
/// that closes another part stays. `edges`: those of the triangles that are `alive`. Returns the numbers dropped of triangles without a back, and of those of
/// surfaces with two sides.
pub fn drop_repeats(mesh: &Indexed, alive: &mut [bool], edges: &EdgeUses) -> [usize; 2] {
    if !edges.any_same(mesh, true) {
        return [0; 2];
    }
    let mut first: HashMap<[u32; 3], u32> = HashMap::default();
    first.reserve(mesh.triangles.len());
    let mut repeats = Vec::new();
    for (n, &t) in mesh.triangles.iter().enumerate().filter(|&(n, _)| alive[n]) {
        if *first.entry(from_lowest(t)).or_insert(n as u32) != n as u32 {
            repeats.push(n as u32);
        }
    }
    let mut dropped = [0; 2];
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
            for n in cluster {
                alive[n as usize] = false;
                dropped[usize::from(first.contains_key(&back(mesh.triangles[n as usize])))] += 1;
            }
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
    sets.groups().into_iter().map(|group| group.into_iter().map(|m| members[m]).collect()).collect()
}

/// The triangle seen from behind, corners from the lowest on.
fn back([a, b, c]: [u32; 3]) -> [u32; 3] {
    from_lowest([a, c, b])
}

/// Is one of some triangles the back of another?
#[must_use]
pub fn hold_backs(mesh: &Indexed, triangles: impl Iterator<Item = u32> + Clone) -> bool {
    let corners = triangles.map(|n| from_lowest(mesh.triangles[n as usize]));
    let all: HashSet<[u32; 3]> = corners.clone().collect();
    corners.into_iter().any(|t| all.contains(&back(t)))
}

/// A surface with rims is a body with holes if their caps are below this share of its area, else a sheet. It matters where both its
/// sides are there: of a body one side is enough, a sheet has two.
const HOLES: f64 = 0.1;

/// What a shell is to the others.
#[derive(Debug)]
struct Seen {
    /// It is closed, or but for holes.
    closes: bool,
    volume: f64,
}

impl Seen {
    fn new(mesh: &Indexed, shell: &Shell, rounding: f64) -> Self {
        let corners = |&n: &u32| mesh.triangles[n as usize].map(|v| mesh.points[v as usize]);
        let mut triangles: Vec<[DVec3; 3]> = shell.triangles.iter().map(corners).collect();
        let whole = area(&triangles);
        let mut open = 0.0;
        for rim in rims(&shell.boundary).iter().filter(|rim| !rim.cancels(&mesh.points, rounding)) {
            let cap = rim.cap(&mesh.points);
            open += area(&cap);
            triangles.extend(cap);
        }
        let volume = signed_volume(&triangles, triangles.first().map_or(DVec3::ZERO, |t| t[0]));
        Seen { closes: open <= HOLES * whole, volume }
    }
}

/// Area of some triangles.
fn area(triangles: &[[DVec3; 3]]) -> f64 {
    triangles.iter().map(|[a, b, c]| (b - a).cross(c - a).length() * 0.5).sum()
}

/// Shells that say nothing that others do not.
#[derive(Debug, Default)]
pub struct Redundant {
    /// One entry a shell.
    pub shells: Vec<bool>,
    /// Triangles of those that repeat others.
    pub repeated: usize,
    /// Triangles of those that are the backs of others.
    pub doubled: usize,
}

/// Which shells repeat others, or are the backs of double-sided surfaces. A closed surface and its own reverse are that surface, once:
///
/// - a shell of negative volume is redundant if each of its triangles is the back of one of closed shells of positive volume;
/// - an open one, if each of its triangles or their backs belong to closed shells;
/// - any, if all its triangles belong to one closed shell of as many triangles.
///
/// Corners may be off by `rounding`.
#[must_use]
pub fn redundant(mesh: &Indexed, shells: &[Shell], owners: &Twins, rounding: f64) -> Redundant {
    let mut found = Redundant { shells: vec![false; shells.len()], ..Redundant::default() };
    if owners.is_empty() {
        return found;
    }
    let corners = |n: u32| from_lowest(mesh.triangles[n as usize]);
    let others = |key: [u32; 3], own: usize| {
        let owners = owners.get(&key).map_or(&[][..], |o| o);
        owners.iter().copied().filter(move |&s| s != own)
    };
    let shared =
        |s: usize, n: u32| others(corners(n), s).next().is_some() || others(back(corners(n)), s).next().is_some();
    let candidates: Vec<usize> =
        (0..shells.len()).filter(|&s| shells[s].triangles.iter().all(|&n| shared(s, n))).collect();
    let mut seen: HashMap<usize, Seen> = HashMap::default();
    for &s in &candidates {
        let of_shell = shells[s].triangles.iter();
        let beside = of_shell.flat_map(|&n| others(corners(n), s).chain(others(back(corners(n)), s)));
        for s in beside.chain([s]) {
            seen.entry(s).or_insert_with(|| Seen::new(mesh, &shells[s], rounding));
        }
    }
    for kind in [Kind::Back, Kind::Open, Kind::Same] {
        for &s in &candidates {
            // Where parts overlap it is not known whose triangles they are.
            if !matches!(kind, Kind::Same) && shells[s].guessed {
                continue;
            }
            let kept = |o: &usize| !found.shells[*o] && seen[o].closes;
            let own = &shells[s].triangles;
            let has_back = |&n: &u32| others(back(corners(n)), s).any(|o| kept(&o) && seen[&o].volume > 0.0);
            let has_any = |&n: &u32| others(corners(n), s).chain(others(back(corners(n)), s)).any(|o| kept(&o));
            let holds = |o: usize| {
                let same = |&n: &u32| others(corners(n), s).any(|p| p == o);
                shells[o].triangles.len() == own.len() && own.iter().all(same)
            };
            let redundant = !found.shells[s]
                && match kind {
                    Kind::Back => seen[&s].closes && seen[&s].volume < 0.0 && own.iter().all(has_back),
                    Kind::Open => !seen[&s].closes && own.iter().all(has_any),
                    Kind::Same => own.first().is_some_and(|&n| others(corners(n), s).any(|o| kept(&o) && holds(o))),
                };
            if redundant {
                // Of a surface with two sides the backs are dropped, whichever of its copies they are.
                let has_two_sides = |n: u32| owners.contains_key(&back(corners(n)));
                let repeats = own.iter().filter(|&&n| !has_two_sides(n)).count();
                found.repeated += repeats;
                found.doubled += own.len() - repeats;
                found.shells[s] = true;
            }
        }
    }
    found
}

/// Which shells have two sides: shells that are `redundant` hold the backs of all their triangles.
#[must_use]
pub fn have_two_sides(mesh: &Indexed, shells: &[Shell], owners: &Twins, redundant: &[bool]) -> Vec<bool> {
    let has_back = |&n: &u32| {
        let of_back = owners.get(&back(from_lowest(mesh.triangles[n as usize])));
        of_back.is_some_and(|shells| shells.iter().any(|&s| redundant[s]))
    };
    shells.iter().map(|shell| redundant.contains(&true) && shell.triangles.iter().all(has_back)).collect()
}

/// Doubts what belongs together where shells share edges and some of them are backs of others. A shell alone is beyond doubt, and so are parts that all
/// look outward, and closed shells each with its back; but in a surface that was `cut` at T-junctions only two shells that are each other's back.
pub fn doubt_backs(mesh: &Indexed, shells: &mut [Shell], owners: &Twins, cut: bool) {
    if owners.is_empty() {
        return;
    }
    let sets = by_edges(mesh, shells);
    let have_backs = have_backs(owners, shells.len());
    let backs_of = |n: u32| owners.get(&back(from_lowest(mesh.triangles[n as usize]))).map_or(&[][..], |o| o);
    for members in sets.groups() {
        let cluster = members[0];
        let outward = |s: usize| Seen::new(mesh, &shells[s], 0.0).volume > 0.0;
        let has_backs = members.iter().any(|&s| have_backs[s]) && !members.iter().all(|&s| outward(s));
        let closed = |s: usize| shells[s].boundary.is_empty();
        let is_back_of = |s: usize, of: usize| {
            let (own, other) = (&shells[s].triangles, &shells[of].triangles);
            closed(s) && closed(of) && own.len() == other.len() && own.iter().all(|&n| backs_of(n).contains(&of))
        };
        let is_behind = |s: usize| {
            let has_front = |&n: &u32| backs_of(n).iter().any(|&front| closed(front) && outward(front));
            shells[s].triangles.iter().all(has_front)
        };
        let beyond_doubt = match members[..] {
            [_] => true,
            [a, b] if cut => is_back_of(a, b) && is_back_of(b, a),
            _ => !cut && members.iter().all(|&s| outward(s) || is_behind(s)),
        };
        if has_backs && !beyond_doubt {
            for s in members {
                (shells[s].guessed, shells[s].cluster) = (true, cluster);
            }
        }
    }
}

/// Shells in sets of those that share edges.
fn by_edges(mesh: &Indexed, shells: &[Shell]) -> Sets {
    // An edge of several shells has both its ends at points of several.
    let (mut first, mut is_shared) = (vec![usize::MAX; mesh.points.len()], vec![false; mesh.points.len()]);
    for (s, shell) in shells.iter().enumerate() {
        for v in shell.triangles.iter().flat_map(|&n| mesh.triangles[n as usize]).map(|v| v as usize) {
            is_shared[v] |= first[v] != s && first[v] != usize::MAX;
            first[v] = s;
        }
    }
    let mut sets = Sets::new(shells.len());
    let mut owner: HashMap<u64, usize> = HashMap::default();
    for (s, shell) in shells.iter().enumerate() {
        let edges = shell.triangles.iter().flat_map(|&n| edges_of(mesh.triangles[n as usize]));
        for [a, b] in edges.filter(|edge| edge.iter().all(|&v| is_shared[v as usize])) {
            sets.join(*owner.entry(key(a, b)).or_insert(s), s);
        }
    }
    sets
}

/// How a shell may be redundant.
#[derive(Clone, Copy)]
enum Kind {
    Back,
    Open,
    Same,
}

/// The shells to which triangles belong that are there more than once, whichever way round; by corners from the lowest on.
pub type Twins = HashMap<[u32; 3], Vec<usize>>;

/// Which shells hold a triangle of which one of them holds the back.
fn have_backs(owners: &Twins, shells: usize) -> Vec<bool> {
    let mut found = vec![false; shells];
    for (_, shells) in owners.iter().filter(|&(&corners, _)| owners.contains_key(&back(corners))) {
        shells.iter().for_each(|&s| found[s] = true);
    }
    found
}

/// Which shells hold a triangle and its back.
#[must_use]
pub fn hold_own_backs(owners: &Twins, shells: usize) -> Vec<bool> {
    let mut found = vec![false; shells];
    for (&corners, shells) in owners {
        let of_back = owners.get(&back(corners)).map_or(&[][..], |o| o);
        shells.iter().filter(|s| of_back.contains(s)).for_each(|&s| found[s] = true);
    }
    found
}

/// The triangles that are there more than once.
#[must_use]
pub fn twins(mesh: &Indexed, shells: &[Shell]) -> Twins {
    let members = || shells.iter().enumerate().flat_map(|(s, shell)| shell.triangles.iter().map(move |&n| (s, n)));
    let mut all = by_number(members().map(|(_, n)| mesh.sorted(n)), mesh.points.len(), |corners| corners[0] as usize);
    all.chunk_by_mut(|a, b| a[0] == b[0]).for_each(<[_]>::sort_unstable);
    let twice: HashSet<[u32; 3]> = all.windows(2).filter(|w| w[0] == w[1]).map(|w| w[0]).collect();
    let mut owners = Twins::default();
    if !twice.is_empty() {
        for (s, n) in members().filter(|&(_, n)| twice.contains(&mesh.sorted(n))) {
            owners.entry(from_lowest(mesh.triangles[n as usize])).or_default().push(s);
        }
    }
    owners
}
