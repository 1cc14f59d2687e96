//! Triangles whose boxes touch, in pairs, near a box or along a line: a tree of boxes over the triangles.

use crate::geometry::repair::face::bounds;
use glam::DVec3;

/// Triangles in a leaf, at most.
const LEAF: usize = 4;

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

/// Boxes around triangles, halved along their longest side by the triangles' middles.
#[derive(Debug)]
pub struct Tree {
    nodes: Vec<Node>,
    /// Triangles in the order of the leaves, with their boxes.
    members: Vec<(u32, [DVec3; 2])>,
}

impl Tree {
    /// Of some triangles.
    #[must_use]
    pub fn new(triangles: &[[DVec3; 3]]) -> Self {
        let mut members: Vec<_> = triangles.iter().enumerate().map(|(n, t)| (n as u32, bounds(t))).collect();
        let mut nodes = vec![node(&members, 0)];
        let mut next = 0;
        while next < nodes.len() {
            let Node { min, max, first, end, .. } = nodes[next];
            let (first, end) = (first as usize, end as usize);
            if end - first > LEAF {
                let size = max - min;
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
        Tree { nodes, members }
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
        let touches = |[min, max]: [DVec3; 2]| (min.cmple(hi).all() && max.cmpge(lo).all()).then_some(());
        self.visit(touches, |n, ()| visit(n));
    }

    /// Visit the triangles whose boxes, grown by a margin, a line from a point in a direction of length 1 meets, and how far from the point it enters
    /// them.
    pub fn along(&self, from: DVec3, direction: DVec3, margin: f64, visit: impl FnMut(u32, f64)) {
        let enters = |[min, max]: [DVec3; 2]| {
            let (mut first, mut last) = (-margin, f64::INFINITY);
            for axis in 0..3 {
                let (low, high) = (min[axis] - margin - from[axis], max[axis] + margin - from[axis]);
                if direction[axis] == 0.0 {
                    if low > 0.0 || high < 0.0 {
                        return None;
                    }
                } else {
                    let (a, b) = (low / direction[axis], high / direction[axis]);
                    (first, last) = (first.max(a.min(b)), last.min(a.max(b)));
                }
            }
            (first <= last).then_some(first)
        };
        self.visit(enters, visit);
    }

    /// Visit the triangles whose boxes are wanted, with what is wanted of them.
    fn visit<T>(&self, wanted: impl Fn([DVec3; 2]) -> Option<T>, mut visit: impl FnMut(u32, T)) {
        let mut open = vec![0_u32];
        while let Some(n) = open.pop() {
            let node = &self.nodes[n as usize];
            match node.halves {
                _ if wanted([node.min, node.max]).is_none() => {}
                Some(half) => open.extend([half, half + 1]),
                None => {
                    for (n, bounds) in &self.members[node.first as usize..node.end as usize] {
                        if let Some(found) = wanted(*bounds) {
                            visit(*n, found);
                        }
                    }
                }
            }
        }
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
