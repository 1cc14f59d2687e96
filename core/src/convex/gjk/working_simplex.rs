//! The simplex that a search moves through the Minkowski difference.

use super::pair::Probe;
use crate::convex::simplex::{NearestPoint, OriginSide, Simplex, nearest, side};
use crate::number::real::{Real, Vector};

/// The pairs of points that the differences of a [`WorkingSimplex`] come from, each in a slot.
///
/// A slot is known at run time only, which keeps the pairs in memory. In one value with the simplex they would keep its differences there too,
/// and the search would take a third longer.
pub(super) struct SupportPairs<V>([(V, V); 4]);

impl<V: Vector> SupportPairs<V> {
    #[inline(always)]
    pub fn new() -> Self {
        SupportPairs([(V::ZERO, V::ZERO); 4])
    }
}

/// Up to four points of the difference, the newest first.
///
/// Their pairs stay in the slots where they were written; only the numbers of the slots move with the differences, which is less to copy.
pub(super) struct WorkingSimplex<V> {
    /// The differences; of these, `count` are in use.
    pub w: [V; 4],
    pub count: usize,
    /// Where the pair of each difference is kept; a permutation of all four.
    slot: [usize; 4],
}

impl<V: Vector> WorkingSimplex<V> {
    #[inline(always)]
    pub fn new() -> Self {
        WorkingSimplex { w: [V::ZERO; 4], count: 0, slot: [0, 1, 2, 3] }
    }

    /// Adds a point in front. Of four, the last one is forgotten.
    #[inline(always)]
    pub fn push(&mut self, found: &Probe<V>, pairs: &mut SupportPairs<V>) {
        let [p, q, r, free] = self.slot;
        pairs.0[free & 3] = (found.a.point, found.b.point);
        self.w = [found.w, self.w[0], self.w[1], self.w[2]];
        self.slot = [free, p, q, r];
        self.count = (self.count + 1).min(4);
    }

    /// Puts the points in another order, given by their old positions, and keeps the first `count` of them. The order is known when the program
    /// is built, so that the points can stay in registers.
    #[inline(always)]
    fn reorder<const A: usize, const B: usize, const C: usize, const D: usize>(&mut self, count: usize) {
        self.w = [self.w[A], self.w[B], self.w[C], self.w[D]];
        self.slot = [self.slot[A], self.slot[B], self.slot[C], self.slot[D]];
        self.count = count;
    }

    /// The pair of points that a difference comes from.
    #[inline(always)]
    pub fn pair(&self, index: usize, pairs: &SupportPairs<V>) -> (V, V) {
        pairs.0[self.slot[index & 3] & 3]
    }

    /// All four pairs.
    #[inline(always)]
    pub fn simplex(&self, pairs: &SupportPairs<V>) -> Simplex<V> {
        Simplex { a: self.slot.map(|s| pairs.0[s & 3].0), b: self.slot.map(|s| pairs.0[s & 3].1) }
    }

    /// One of the points is `w`.
    #[inline(always)]
    pub fn holds(&self, w: V) -> bool {
        let n = self.count;
        n > 0 && self.w[0] == w || n > 1 && self.w[1] == w || n > 2 && self.w[2] == w || n > 3 && self.w[3] == w
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
                        1 => self.reorder::<0, 2, 3, 1>(3),
                        2 => self.reorder::<0, 1, 3, 2>(3),
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
            self.reorder::<0, 2, 1, 3>(2);
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
        self.w = nearest.order.map(|i| self.w[i & 3]);
        self.slot = nearest.order.map(|i| self.slot[i & 3]);
        self.count = nearest.count;
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
