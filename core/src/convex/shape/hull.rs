//! The convex hull of some points, by all of them or by those that can be farthest.

use super::adjacency::Adjacency;
use super::flat::Vertices;
use super::scan::{farthest, scan};
use crate::convex::support::{ScalarOf, Support, SupportPoint, magnitude};
use crate::number::aabb::Aabb;
use crate::number::real::{Real, Vector};

/// Up to this many vertices all are scanned, which is as fast as a climb along edges and needs no second look; a hull of more is climbed.
const CLIMBED: usize = 64;

/// The convex hull of some points; they may repeat, lie inside, in a plane or on a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hull<'a, V: Vector> {
    vertices: &'a [V],
    adjacency: Option<&'a Adjacency<'a>>,
    center: V,
    extent: V::Scalar,
}

impl<'a, V: Vector> Hull<'a, V> {
    /// Looks at each point once. Of no points, or of points that are not finite, queries are left undecided.
    pub fn new(vertices: &'a [V]) -> Self {
        let mut bounds = Aabb::empty();
        let mut poison = if vertices.is_empty() { V::Scalar::INFINITY } else { V::Scalar::ZERO };
        for &v in vertices {
            bounds = bounds.union(Aabb { min: v, max: v });
            poison += magnitude(v) * V::Scalar::ZERO;
        }
        let center = bounds.min * V::Scalar::HALF + bounds.max * V::Scalar::HALF;
        let extent = bounds.min.abs().max(bounds.max.abs()).norm_max() + poison;
        Hull { vertices, adjacency: None, center, extent }
    }

    /// Looks at candidates only, or climbs along edges, instead of scanning all vertices. An adjacency made for other vertices is not used.
    #[must_use]
    pub fn with_adjacency(self, adjacency: &'a Adjacency<'a>) -> Self {
        Hull { adjacency: Some(adjacency).filter(|adjacency| adjacency.belongs_to(self.vertices)), ..self }
    }

    /// The points.
    pub fn vertices(&self) -> &'a [V] {
        self.vertices
    }

    #[inline(always)]
    fn found(&self, index: u32) -> SupportPoint<V> {
        SupportPoint { point: self.vertices.get(index as usize).copied().unwrap_or(self.center), index }
    }

    #[inline(always)]
    fn along(&self, direction: V, index: u32) -> V::Scalar {
        self.vertices.get(index as usize).map_or(-V::Scalar::INFINITY, |v| v.dot(direction))
    }

    /// The farthest of some vertices.
    #[inline(always)]
    fn farthest_of(&self, candidates: &[u32], direction: V) -> u32 {
        let at = farthest(candidates, |candidate| self.along(direction, candidate));
        candidates.get(at as usize).copied().unwrap_or(0)
    }

    /// The greatest coordinate along a direction; four chains, so that it runs as fast as the additions allow.
    #[inline(always)]
    fn reach(&self, direction: V) -> V::Scalar {
        let mut best = [-V::Scalar::INFINITY; 4];
        let mut chunks = self.vertices.chunks_exact(4);
        for four in &mut chunks {
            if let [p, q, r, s] = *four {
                let along = [p.dot(direction), q.dot(direction), r.dot(direction), s.dot(direction)];
                for (best, along) in best.iter_mut().zip(along) {
                    *best = if along > *best { along } else { *best };
                }
            }
        }
        let rest = chunks.remainder().iter().fold(-V::Scalar::INFINITY, |m, v| m.max(v.dot(direction)));
        best.into_iter().fold(rest, Real::max)
    }

    /// A vertex that is farther than all its neighbours.
    #[inline(always)]
    fn climb(&self, adjacency: &Adjacency<'a>, direction: V, start: u32) -> u32 {
        let mut index = self.farthest_of(&[adjacency.start(direction), start], direction);
        let mut best = self.along(direction, index);
        loop {
            // Selections, as in `scan`.
            let from = index;
            for &n in adjacency.of(from) {
                let there = self.along(direction, n);
                index = if there > best { n } else { index };
                best = if there > best { there } else { best };
            }
            if index == from {
                return index;
            }
        }
    }
}

impl<V: Vector> Support for Hull<'_, V> {
    type Vector = V;
    #[inline(always)]
    fn support(&self, direction: V, start: u32) -> SupportPoint<V> {
        self.found(match self.adjacency {
            Some(adjacency) => match adjacency.candidates(direction) {
                Some(candidates) => self.farthest_of(candidates, direction),
                None if self.vertices.len() > CLIMBED => self.climb(adjacency, direction, start),
                None => scan(self.vertices, direction),
            },
            None => scan(self.vertices, direction),
        })
    }
    #[inline(always)]
    fn farther(&self, direction: V, found: u32) -> Option<SupportPoint<V>> {
        let climbed = self.vertices.len() > CLIMBED && self.adjacency?.candidates(direction).is_none();
        let least = self.along(direction, found);
        (climbed && self.reach(direction) > least).then(|| self.found(scan(self.vertices, direction)))
    }
    #[inline(always)]
    fn center(&self) -> V {
        self.center
    }
    #[inline(always)]
    fn extent(&self) -> ScalarOf<Self> {
        self.extent
    }
}

impl<V: Vector> Vertices for Hull<'_, V> {
    fn count(&self) -> usize {
        self.vertices.len()
    }
    fn vertex(&self, index: usize) -> V {
        self.vertices.get(index).or(self.vertices.last()).copied().unwrap_or(V::ZERO)
    }
}
