//! Triangles whose boxes touch, in pairs, near a box or along a line: a tree of boxes over the triangles.

use crate::geometry::repair::face::bounds;
use crate::geometry::repair::frame::Turned;
use glam::DVec3;

/// Triangles in a leaf, at most.
const LEAF: usize = 4;

/// A slope that no line leaves a box by.
const LEAST_SLOPE: f64 = 1e-200;

/// A box around a run of triangles, and its halves.
#[derive(Debug, Clone, Copy)]
struct Node {
    min: DVec3,
    max: DVec3,
    first: u32,
    end: u32,
    /// Number of its first half; the second follows. None in a leaf.
    halves: Option<u32>,
}

impl Node {
    fn touches(&self, other: &Node) -> bool {
        self.min.cmple(other.max).all() && self.max.cmpge(other.min).all()
    }
}

/// Boxes around triangles, halved by the triangles' middles, along the axis along which these are farthest apart.
#[derive(Debug)]
pub struct Tree {
    nodes: Vec<Node>,
    /// Triangles in the order of the leaves, with their boxes.
    members: Vec<(u32, [DVec3; 2])>,
    /// The boxes stand along the axes of this frame, if not along those of space.
    frame: Option<Turned>,
}

impl Tree {
    /// Of some triangles, in boxes along the axes.
    #[must_use]
    pub fn new(triangles: &[[DVec3; 3]]) -> Self {
        Self::of_boxes(triangles.iter().map(bounds), None)
    }

    /// Of some triangles, in boxes along their own main directions where these are much smaller, and then larger by a margin.
    #[must_use]
    pub fn turned(triangles: &[[DVec3; 3]], margin: f64) -> Self {
        match Turned::of(triangles) {
            None => Self::new(triangles),
            Some(frame) => {
                let around = |t: &[DVec3; 3]| {
                    let [lo, hi] = bounds(&t.map(|p| frame.point(p)));
                    [lo - margin, hi + margin]
                };
                Self::of_boxes(triangles.iter().map(around), Some(frame))
            }
        }
    }

    /// Of some boxes, numbered in their order.
    #[must_use]
    pub fn of_boxes(boxes: impl Iterator<Item = [DVec3; 2]>, frame: Option<Turned>) -> Self {
        let mut members: Vec<_> = (0..).zip(boxes).collect();
        let mut nodes = vec![node(&members, 0)];
        let mut next = 0;
        while next < nodes.len() {
            let Node { first, end, .. } = nodes[next];
            let (first, end) = (first as usize, end as usize);
            if end - first > LEAF {
                // Boxes longer than the room between their middles would not be told apart along their length.
                let middles = members[first..end].iter().map(|(_, [lo, hi])| *lo + *hi);
                let (lo, hi) = middles.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), p| (a.min(p), b.max(p)));
                let size = hi - lo;
                let axis = (0..3).max_by(|&a, &b| size[a].total_cmp(&size[b])).unwrap_or(0);
                let middle = (first + end) / 2;
                let at = |m: &(u32, [DVec3; 2])| m.1[0][axis] + m.1[1][axis];
                members[first..end]
                    .select_nth_unstable_by(middle - first, |a, b| at(a).total_cmp(&at(b)).then(a.0.cmp(&b.0)));
                nodes[next].halves = Some(nodes.len() as u32);
                nodes.push(node(&members[first..middle], first));
                nodes.push(node(&members[middle..end], middle));
            }
            next += 1;
        }
        Tree { nodes, members, frame }
    }

    /// Visit every pair of triangles whose boxes touch, once.
    pub fn touching_pairs(&self, mut visit: impl FnMut(u32, u32)) {
        self.some_touching_pairs(usize::MAX, &mut visit);
    }

    /// The same, but for pairs beyond `most` or a few more. Returns whether all were visited.
    pub fn some_touching_pairs(&self, most: usize, visit: &mut impl FnMut(u32, u32)) -> bool {
        let mut visited = 0;
        let mut pairs = vec![(0_u32, 0_u32)];
        while let Some((a, b)) = pairs.pop() {
            let (p, q) = (&self.nodes[a as usize], &self.nodes[b as usize]);
            match (p.halves, q.halves) {
                (Some(h), Some(_)) if a == b => pairs.extend([(h, h), (h, h + 1), (h + 1, h + 1)]),
                _ if !p.touches(q) => {}
                (None, None) if visited > most => return false,
                (None, None) => visited += self.leaves(p, q, a == b, visit),
                (Some(h), other) if other.is_none() || p.end - p.first >= q.end - q.first => {
                    pairs.extend([(h, b), (h + 1, b)]);
                }
                (_, h) => pairs.extend(h.into_iter().flat_map(|h| [(a, h), (a, h + 1)])),
            }
        }
        true
    }

    /// Visit the triangles whose boxes touch the box `lo..hi`.
    pub fn touching(&self, [lo, hi]: [DVec3; 2], mut visit: impl FnMut(u32)) {
        let [lo, hi] = self.frame.as_ref().map_or([lo, hi], |frame| frame.around([lo, hi]));
        let touches = |[min, max]: [DVec3; 2]| (min.cmple(hi).all() && max.cmpge(lo).all()).then_some(0.0);
        self.visit(touches, |n, _| {
            visit(n);
            f64::INFINITY
        });
    }

    /// Visit the triangles whose boxes, grown by a margin, a line from a point in a direction of length 1 meets, and how far from the point it enters
    /// them, the near ones first. Each visit tells how far the line goes on. Returns how many boxes were looked at.
    pub fn along(&self, from: DVec3, direction: DVec3, margin: f64, visit: impl FnMut(u32, f64) -> f64) -> usize {
        let [from, direction] =
            self.frame.as_ref().map_or([from, direction], |f| [f.point(from), f.direction(direction)]);
        // Without a slope along an axis the line is within a box along it everywhere or nowhere, as with next to none.
        let inverse = DVec3::from_array(direction.to_array().map(|d| if d == 0.0 { LEAST_SLOPE } else { d })).recip();
        let enters = |[min, max]: [DVec3; 2]| {
            let (low, high) = ((min - margin - from) * inverse, (max + margin - from) * inverse);
            let (near, far) = (low.min(high), low.max(high));
            let first = near.x.max(near.y).max(near.z).max(-margin);
            let last = far.x.min(far.y).min(far.z);
            (first <= last).then_some(first)
        };
        self.visit(enters, visit)
    }

    /// Visit the triangles whose boxes are wanted, with how far away they are, the near ones first. Each visit tells from which distance on no more are
    /// wanted. Returns how many boxes were looked at.
    fn visit(&self, distance: impl Fn([DVec3; 2]) -> Option<f64>, mut visit: impl FnMut(u32, f64) -> f64) -> usize {
        let of_node = |n: u32| distance([self.nodes[n as usize].min, self.nodes[n as usize].max]).map(|d| (n, d));
        let (mut last, mut looked_at) = (f64::INFINITY, 0);
        let mut open: Vec<(u32, f64)> = of_node(0).into_iter().collect();
        while let Some((n, away)) = open.pop() {
            if away > last {
                continue;
            }
            looked_at += 1;
            let node = &self.nodes[n as usize];
            if let Some(half) = node.halves {
                let halves = [half, half + 1].map(of_node);
                let [a, b] = if halves[0].map(|h| h.1) < halves[1].map(|h| h.1) { [1, 0] } else { [0, 1] };
                open.extend([halves[a], halves[b]].into_iter().flatten());
                continue;
            }
            for (n, bounds) in &self.members[node.first as usize..node.end as usize] {
                if let Some(away) = distance(*bounds).filter(|away| *away <= last) {
                    last = visit(*n, away);
                }
            }
        }
        looked_at
    }

    /// Returns the number of pairs visited.
    fn leaves(&self, p: &Node, q: &Node, same: bool, visit: &mut impl FnMut(u32, u32)) -> usize {
        let mut visited = 0;
        for m in p.first..p.end {
            let (a, [a_min, a_max]) = &self.members[m as usize];
            let others = if same { m + 1 } else { q.first } as usize..q.end as usize;
            for (b, [b_min, b_max]) in &self.members[others] {
                if a_min.cmple(*b_max).all() && a_max.cmpge(*b_min).all() {
                    visit(*a, *b);
                    visited += 1;
                }
            }
        }
        visited
    }
}

/// The box of some members, which begin at `first`.
fn node(members: &[(u32, [DVec3; 2])], first: usize) -> Node {
    let (min, max) =
        members.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), (_, [lo, hi])| (a.min(*lo), b.max(*hi)));
    Node { min, max, first: first as u32, end: (first + members.len()) as u32, halves: None }
}

#[cfg(test)]
mod tests {
    use super::Tree;
    use glam::{DMat3, DVec3};

    /// Long triangles along a turned lattice.
    fn lattice(turn: DMat3) -> Vec<[DVec3; 3]> {
        let mut found = Vec::new();
        for n in 0..200_u32 {
            let (i, j) = (f64::from(n % 10), f64::from(n / 10));
            let from = DVec3::new(0.3 * i, 0.1 * j, 0.05 * f64::from(n % 3));
            let along = if n % 2 == 0 { DVec3::X } else { DVec3::Y } * 2.0;
            let across = if n % 4 < 2 { DVec3::Z * 0.3 } else { DVec3::Z.cross(along) * 0.1 };
            found.push([from, from + along, from + along + across].map(|p| DVec3::new(500.0, 5800.0, 3.0) + turn * p));
        }
        found
    }

    #[test]
    fn what_a_line_meets_does_not_depend_on_the_frame() {
        let turns = [DMat3::IDENTITY, DMat3::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), 0.7)];
        for (n, turn) in turns.into_iter().enumerate() {
            let triangles = lattice(turn);
            let (plain, turned) = (Tree::new(&triangles), Tree::turned(&triangles, 1e-9));
            assert_eq!(turned.frame.is_some(), n == 1);
            let mut met = 0;
            for step in 0..200_u32 {
                let s = f64::from(step);
                let from = DVec3::new(500.0, 5800.0, 3.0) + turn * DVec3::new(1.5 + s.sin(), 1.0 + s.cos(), -0.2);
                let ends = turn * DVec3::new((3.0 * s).sin() * 0.4, (5.0 * s).cos() * 0.4, 1.0);
                let direction = ends.normalize();
                let passes = |[a, b, c]: &[DVec3; 3]| {
                    let [u, v, w] = [*a, *b, *c].map(|p| p - from);
                    let sides = [u.cross(v), v.cross(w), w.cross(u)].map(|side| side.dot(direction));
                    sides.iter().all(|s| *s > 0.0) || sides.iter().all(|s| *s < 0.0)
                };
                let found = |tree: &Tree| {
                    let mut found = Vec::new();
                    tree.along(from, direction, 0.0, |n, _| {
                        found.push(n);
                        f64::INFINITY
                    });
                    found.retain(|n| passes(&triangles[*n as usize]));
                    found.sort_unstable();
                    found
                };
                let all: Vec<u32> = (0..).zip(&triangles).filter(|(_, t)| passes(t)).map(|(n, _)| n).collect();
                assert_eq!(found(&plain), all);
                assert_eq!(found(&turned), all);
                met += all.len();
            }
            assert!(met > 50, "{met}");
            let pairs = |tree: &Tree| {
                let mut pairs = 0;
                tree.touching_pairs(|_, _| pairs += 1);
                pairs
            };
            assert!(pairs(&turned) <= pairs(&plain));
        }
    }
}
