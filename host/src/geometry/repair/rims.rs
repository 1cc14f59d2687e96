//! What to do where a surface is open.
//!
//! A T-junction leaves edges without a partner although the surface closes: the loose edges cancel along their line. A
//! real hole is closed by a cap, a fan from the middle of its rim, so that no row of cells leaks; a lone
//! sheet becomes a sheet with two sides, which has no volume.

use crate::geometry::repair::sets::Sets;
use glam::DVec3;
use rustc_hash::FxHashMap as HashMap;

/// A rim whose integrals are below this share of its own size cancels.
const CANCELS: f64 = 1e-5;

/// So does one that is off by the rounding of its corners, unless it gapes: only a slit stays below this share.
const GAPES: f64 = 1e-2;

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
    let mut at = HashMap::default();
    let mut rims: Vec<Rim> = Vec::new();
    for (n, edge) in boundary.iter().enumerate() {
        let rim = *at.entry(sets.find(n)).or_insert_with(|| {
            rims.push(Rim { edges: Vec::new() });
            rims.len() - 1
        });
        rims[rim].edges.push(*edge);
    }
    rims
}

impl Rim {
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
