//! What to do where a surface is open.
//!
//! A T-junction leaves edges without a partner although the surface closes: the loose edges cancel along their line. A
//! real hole is closed by a cap, a fan from the middle of its rim, so that no row of cells leaks; a lone
//! sheet becomes a sheet with two sides, which has no volume.

use crate::geometry::repair::sets::Sets;
use glam::DVec3;
use rustc_hash::FxHashMap as HashMap;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// A rim whose integrals are below this share of its own size cancels.
const CANCELS: f64 = 1e-5;

/// So does one that is off by the rounding of its corners, unless it gapes: only a slit stays below this share.
const GAPES: f64 = 1e-2;

/// Corners off their plane by less than this share of the rim's size lie in it.
const PLANE: f64 = 1e-6;

/// Loose edges around a hole in a surface, or along a T-junction.
#[derive(Debug, Clone)]
pub struct Rim {
    /// Directed edges of the surface around it.
    pub edges: Vec<[u32; 2]>,
}

/// Group loose edges into rims that share no vertex.
#[must_use]
pub fn rims(boundary: &[[u32; 2]]) -> Vec<Rim> {
    let mut index = HashMap::default();
    let mut sets = Sets::new(boundary.len());
    for (n, edge) in boundary.iter().enumerate() {
        for v in edge {
            let other = *index.entry(*v).or_insert(n);
            sets.join(n, other);
        }
    }
    let rim = |group: Vec<usize>| Rim { edges: group.into_iter().map(|n| boundary[n]).collect() };
    sets.groups().into_iter().map(rim).collect()
}

/// The triangles around some corners in fans that share edges there, by a corner and another end of an edge at it.
type Fans = HashMap<[u32; 2], usize>;

/// Edges of a rim from one corner that it passes more than once to the next.
struct Chain {
    edges: Vec<[u32; 2]>,
    length: f64,
}

impl Chain {
    fn begins(&self) -> [u32; 2] {
        self.edges.first().copied().unwrap_or_default()
    }

    fn ends(&self) -> [u32; 2] {
        self.edges.last().copied().unwrap_or_default()
    }
}

impl Rim {
    /// Rims that touch neither themselves nor each other but in corners: at a corner that the rim passes several times one hole ends where another
    /// fan of the surface begins, and of the ways to go on from there the shortest way round is a rim. `triangles`: the surface around it.
    #[must_use]
    pub fn apart(self, triangles: impl Iterator<Item = [u32; 3]>, points: &[DVec3]) -> Vec<Rim> {
        let mut next: HashMap<u32, Vec<u32>> = HashMap::default();
        let mut balance: HashMap<u32, i32> = HashMap::default();
        for &[a, b] in &self.edges {
            next.entry(a).or_default().push(b);
            *balance.entry(a).or_default() += 1;
            *balance.entry(b).or_default() -= 1;
        }
        let is_junction = |v: u32| next.get(&v).is_some_and(|ends| ends.len() > 1);
        if balance.values().any(|&b| b != 0) || !next.keys().any(|&v| is_junction(v)) {
            return vec![self];
        }
        let chains = chains(&self.edges, &next, points, is_junction);
        let fans = fans(triangles, is_junction);
        let mut starting: HashMap<u32, Vec<usize>> = HashMap::default();
        for (n, chain) in chains.iter().enumerate() {
            starting.entry(chain.begins()[0]).or_default().push(n);
        }
        let goes_on = |from: usize, to: usize| {
            let ([before, v], [_, after]) = (chains[from].ends(), chains[to].begins());
            let (own, other) = (fans.get(&[v, before]), fans.get(&[v, after]));
            own.is_none() || own != other
        };
        let mut used = vec![false; chains.len()];
        let mut rims = Vec::new();
        let mut left = Vec::new();
        for first in 0..chains.len() {
            if used[first] {
                continue;
            }
            let way = shortest_way_round(first, &chains, &starting, &used, goes_on);
            match way.is_empty() {
                true => left.push(first),
                false => rims.push(Rim { edges: way.iter().flat_map(|&n| chains[n].edges.iter().copied()).collect() }),
            }
            way.into_iter().for_each(|n| used[n] = true);
        }
        left.retain(|&n| !used[n]);
        if !left.is_empty() {
            rims.push(Rim { edges: left.iter().flat_map(|&n| chains[n].edges.iter().copied()).collect() });
        }
        rims
    }

    /// A box around the corners.
    #[must_use]
    pub fn bounds(&self, points: &[DVec3]) -> [DVec3; 2] {
        let corners = self.edges.iter().flatten().map(|&v| points[v as usize]);
        corners.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[lo, hi], p| [lo.min(p), hi.max(p)])
    }

    /// Do its corners lie in one plane? Then a plane cap is what is missing, most likely. Corners may be off by `rounding`.
    #[must_use]
    pub fn is_plane(&self, points: &[DVec3], rounding: f64) -> bool {
        let (middle, [lo, hi]) = (self.middle(points), self.bounds(points));
        let seen = |v: u32| points[v as usize] - middle;
        let normal = self.edges.iter().map(|&[a, b]| seen(a).cross(seen(b))).sum::<DVec3>().normalize_or_zero();
        let off = PLANE * (hi - lo).max_element() + rounding;
        normal != DVec3::ZERO && self.edges.iter().all(|&[a, _]| normal.dot(seen(a)).abs() <= off)
    }

    /// Do its edges cancel as a chain, so that the surface is closed in space though not in its edges?
    ///
    /// A chain that cancels has no integral of any 1-form; a few cubic forms (k·p)³ (m·dp) with fixed odd directions tell.
    /// Corners may be off by `rounding`.
    #[must_use]
    pub fn cancels(&self, points: &[DVec3], rounding: f64) -> bool {
        let corners = || self.edges.iter().flatten().map(|&v| points[v as usize]);
        let (lo, hi) = corners().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), p| (a.min(p), b.max(p)));
        let size = (hi - lo).max_element();
        if !(size > 0.0) {
            return true;
        }
        let limit = CANCELS + (rounding / size).min(GAPES);
        let unit = |v: u32| (points[v as usize] - lo) / size;
        let mut angle = 0.3_f64;
        (0..8).all(|_| {
            angle += 2.399_963;
            let (k, m) = (
                DVec3::new(angle.cos(), (1.7 * angle).sin(), (2.3 * angle).cos()),
                DVec3::new((1.3 * angle).sin(), angle.cos(), (0.7 * angle).sin()),
            );
            let integral: f64 = self
                .edges
                .iter()
                .map(|&[a, b]| {
                    let (p, q) = (unit(a), unit(b));
                    let (s, t) = (k.dot(p), k.dot(q));
                    m.dot(q - p) * (s * s * s + s * s * t + s * t * t + t * t * t) * 0.25
                })
                .sum();
            integral.abs() < limit
        })
    }

    /// Triangles that close the hole.
    #[must_use]
    pub fn cap(&self, points: &[DVec3]) -> Vec<[DVec3; 3]> {
        let p = |v: u32| points[v as usize];
        if let [[a, b], [c, d], [e, f]] = self.edges[..] {
            // Three edges in a ring: the missing triangle itself.
            if b == c && d == e && f == a {
                return vec![[p(a), p(e), p(c)]];
            }
            if b == e && f == c && d == a {
                return vec![[p(a), p(c), p(e)]];
            }
        }
        let middle = self.middle(points);
        self.edges.iter().map(|&[a, b]| [p(b), p(a), middle]).collect()
    }

    /// Mean of the rim's corners.
    #[must_use]
    pub fn middle(&self, points: &[DVec3]) -> DVec3 {
        let sum: DVec3 = self.edges.iter().map(|e| points[e[0] as usize]).sum();
        sum / self.edges.len().max(1) as f64
    }
}

/// The edges of a rim from corner to corner of those that it passes more than once.
fn chains(
    edges: &[[u32; 2]],
    next: &HashMap<u32, Vec<u32>>,
    points: &[DVec3],
    is_junction: impl Fn(u32) -> bool,
) -> Vec<Chain> {
    let from_junctions = edges.iter().filter(|[a, _]| is_junction(*a));
    let chain = |&first: &[u32; 2]| {
        let mut edges = vec![first];
        let mut end = first[1];
        while !is_junction(end) {
            let Some(&after) = next.get(&end).and_then(|ends| ends.first()) else { break };
            edges.push([end, after]);
            end = after;
        }
        let length = edges.iter().map(|&[a, b]| points[a as usize].distance(points[b as usize])).sum();
        Chain { edges, length }
    };
    from_junctions.map(chain).collect()
}

/// The fans around those corners that are wanted.
fn fans(triangles: impl Iterator<Item = [u32; 3]>, wanted: impl Fn(u32) -> bool) -> Fans {
    let mut spokes: Fans = HashMap::default();
    let mut pairs = Vec::new();
    for [a, b, c] in triangles {
        for (v, x, y) in [(a, b, c), (b, c, a), (c, a, b)].into_iter().filter(|&(v, ..)| wanted(v)) {
            let mut number = |other: u32| {
                let count = spokes.len();
                *spokes.entry([v, other]).or_insert(count)
            };
            pairs.push((number(x), number(y)));
        }
    }
    let mut sets = Sets::new(spokes.len());
    pairs.into_iter().for_each(|(x, y)| sets.join(x, y));
    spokes.values_mut().for_each(|n| *n = sets.find(*n));
    spokes
}

/// The chains of the shortest way from the end of a chain back to its beginning over chains that are not yet used, itself first; none if there is none.
fn shortest_way_round(
    first: usize,
    chains: &[Chain],
    starting: &HashMap<u32, Vec<usize>>,
    used: &[bool],
    goes_on: impl Fn(usize, usize) -> bool,
) -> Vec<usize> {
    // Lengths are not negative, so their bits are in their order.
    let mut waiting = BinaryHeap::from([Reverse((chains[first].length.to_bits(), first))]);
    let mut reached: HashMap<usize, (f64, usize)> = HashMap::default();
    while let Some(Reverse((length, at))) = waiting.pop() {
        let length = f64::from_bits(length);
        if reached.get(&at).is_some_and(|&(known, _)| known < length) {
            continue;
        }
        let onward = starting.get(&chains[at].ends()[1]).into_iter().flatten().copied();
        for to in onward.filter(|&to| !used[to] && goes_on(at, to)) {
            if to == first {
                let mut way = vec![at];
                while let Some(&(_, before)) =
                    reached.get(way.last().unwrap_or(&first)).filter(|_| way.last() != Some(&first))
                {
                    way.push(before);
                }
                way.reverse();
                return way;
            }
            let longer = length + chains[to].length;
            if reached.get(&to).is_none_or(|&(known, _)| longer < known) {
                reached.insert(to, (longer, at));
                waiting.push(Reverse((longer.to_bits(), to)));
            }
        }
    }
    Vec::new()
}
