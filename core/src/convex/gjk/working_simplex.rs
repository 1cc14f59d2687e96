//! The simplex that a search moves through the Minkowski difference.

use super::pair::Probe;
use crate::convex::simplex::{NearestPoint, OriginSide, Simplex, nearest, side};
use crate::number::real::{Real, Vector};

/// Up to four points of the difference, the newest first, each with the pair of points it is the difference of.
///
/// Pairs stay where they were written; only the numbers of their slots are moved with the differences, which is less to copy.
pub(super) struct WorkingSimplex<V> {
    /// The differences; of these, `count` are in use.
    pub w: [V; 4],
    pub count: usize,
    /// Where the pair of each difference is kept; a permutation of all four.
    slot: [usize; 4],
    pairs: [(V, V); 4],
}

impl<V: Vector> WorkingSimplex<V> {
    #[inline(always)]
    pub fn new() -> Self {
        WorkingSimplex { w: [V::ZERO; 4], count: 0, slot: [0, 1, 2, 3], pairs: [(V::ZERO, V::ZERO); 4] }
    }

    /// Adds a point in front. Of four, the last one is forgotten.
    #[inline(always)]
    pub fn push(&mut self, found: &Probe<V>) {
        let [p, q, r, free] = self.slot;
        self.pairs[free & 3] = (found.a.point, found.b.point);
        self.w = [found.w, self.w[0], self.w[1], self.w[2]];
        self.slot = [free, p, q, r];
        self.count = (self.count + 1).min(4);
    }

    /// Puts the points in another order, given by their old positions, and keeps the first `count` of them.
    #[inline(always)]
    fn reorder(&mut self, order: [usize; 4], count: usize) {
        self.w = order.map(|i| self.w[i & 3]);
        self.slot = order.map(|i| self.slot[i & 3]);
        self.count = count;
    }

    /// The pair of points that a difference comes from.
    #[inline(always)]
    pub fn pair(&self, index: usize) -> (V, V) {
        self.pairs[self.slot[index & 3] & 3]
    }

    /// All four pairs.
    #[inline(always)]
    pub fn simplex(&self) -> Simplex<V> {
        Simplex { a: self.slot.map(|s| self.pairs[s & 3].0), b: self.slot.map(|s| self.pairs[s & 3].1) }
    }

    /// One of the points is `w`.
    #[inline(always)]
    pub fn holds(&self, w: V) -> bool {
        let [p, q, r, s] = self.w.map(|p| p == w);
        self.count > 0 && p || self.count > 1 && q || self.count > 2 && r || self.count > 3 && s
    }

    /// Four points, proved to hold the origin inside; see [`side`] for `slack`.
    #[inline(always)]
    pub fn holds_origin(&self, slack: V::Scalar) -> bool {
        self.count == 4 && side(self.w, slack) == OriginSide::Inside
    }

    /// Where the boolean search looks next: keeps the vertex, edge or face that the origin lies beyond, and returns a direction from it
    /// away from the origin, at right angles to it. None if four points hold the origin inside.
    #[inline(always)]
    pub fn step(&mut self, slack: V::Scalar) -> Option<V> {
        let mut behind = None;
        if self.count == 4 {
            match side(self.w, slack) {
                OriginSide::Inside => return None,
                OriginSide::Beyond(dropped) => {
                    match dropped {
                        1 => self.reorder([0, 2, 3, 1], 3),
                        2 => self.reorder([0, 1, 3, 2], 3),
                        _ => self.count = 3,
                    }
                    behind = Some(self.w[3]);
                }
            }
        }
        Some(match self.count {
            1 => self.w[0],
            2 => across_line(self.w[0], self.w[1]),
            _ => self.step_from_triangle(behind),
        })
    }

    /// [`WorkingSimplex::step`] from a triangle; `behind` is the vertex dropped last, which lies on the other side of it than the origin.
    #[inline(always)]
    fn step_from_triangle(&mut self, behind: Option<V>) -> V {
        let [a, b, c, _] = self.w;
        let (ab, ac) = (b - a, c - a);
        let normal = ab.cross(ac);
        if ab.cross(normal).dot(a) < V::Scalar::ZERO {
            self.count = 2;
            return across_line(a, b);
        }
        if normal.cross(ac).dot(a) < V::Scalar::ZERO {
            self.reorder([0, 2, 1, 3], 2);
            return across_line(a, c);
        }
        let ahead = match behind {
            Some(behind) => normal.dot(behind - a),
            None => normal.dot(a),
        };
        if ahead < V::Scalar::ZERO { -normal } else { normal }
    }

    /// Keeps the vertices that carry the point nearest to the origin, and returns that point with their weights. The origin is taken not to be
    /// inside four points.
    #[inline(always)]
    pub fn shrink_to_nearest(&mut self) -> NearestPoint<V> {
        let nearest = nearest(self.w, self.count);
        self.reorder(nearest.order, nearest.count);
        nearest
    }
}

/// From the origin towards the line through two points, at right angles to it; if the line holds the origin, some direction across it.
#[inline(always)]
fn across_line<V: Vector>(a: V, b: V) -> V {
    let e = b - a;
    let towards = e.cross(a.cross(e));
    if towards == V::ZERO { across(e) } else { towards }
}

/// Some vector at right angles to another: its product with the coordinate axis least along it.
#[inline(always)]
pub(super) fn across<V: Vector>(e: V) -> V {
    e.cross(e.least_axis())
}
