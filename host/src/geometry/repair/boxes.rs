//! Triangles whose boxes touch, in pairs: a tree of boxes in whole numbers, made in one sort and compared in a few instructions.

use crate::geometry::repair::face::bounds;
use glam::DVec3;

/// Bits of a coordinate.
const BITS: u32 = 20;

/// Largest coordinate.
const MOST: u32 = (1 << BITS) - 1;

/// Bits from one coordinate to the next: one more, to borrow from.
const FIELD: u32 = BITS + 1;

/// That bit of each coordinate.
const GUARDS: u64 = (1 << BITS | 1 << (FIELD + BITS)) | 1 << (2 * FIELD + BITS);

/// Triangles in a leaf, at most.
const LEAF: usize = 8;

/// Boxes tell enough if no more than so many pairs of leaves touch for each leaf. On an even surface a leaf touches some ten others.
const CROWD: usize = 32;

/// A box: three coordinates in each number.
#[derive(Clone, Copy)]
struct Block {
    low: u64,
    /// With all guards.
    high: u64,
}

/// Coordinates in one number.
fn packed([x, y, z]: [u32; 3]) -> u64 {
    u64::from(x) | u64::from(y) << FIELD | u64::from(z) << (2 * FIELD)
}

/// Coordinates out of one number, without guards.
fn unpacked(all: u64) -> [u32; 3] {
    [0, FIELD, 2 * FIELD].map(|shift| (all >> shift) as u32 & MOST)
}

impl Block {
    /// It touches nothing: as large a lowest coordinate has no box.
    const NONE: Block = Block { low: GUARDS, high: GUARDS };

    fn new(low: [u32; 3], high: [u32; 3]) -> Self {
        Block { low: packed(low), high: packed(high) | GUARDS }
    }

    /// A difference borrows its guard where it would be negative, and no more.
    fn touches(self, other: Block) -> bool {
        (self.high - other.low) & (other.high - self.low) & GUARDS == GUARDS
    }

    /// The box around two; the first is not [`NONE`](Self::NONE).
    fn around(self, other: Block) -> Block {
        if other.low == GUARDS {
            return self;
        }
        let both = |a: u64, b: u64, pick: fn(u32, u32) -> u32| {
            let (a, b) = (unpacked(a), unpacked(b));
            [0, 1, 2].map(|axis| pick(a[axis], b[axis]))
        };
        Block::new(both(self.low, other.low, u32::min), both(self.high, other.high, u32::max))
    }
}

/// A number whose every third bit is one of the ten lowest of another.
fn spread(n: u32) -> u64 {
    let mut n = u64::from(n & 0x3ff);
    for (shift, mask) in [(16, 0x0300_00ff), (8, 0x0300_f00f), (4, 0x030c_30c3), (2, 0x0924_9249)] {
        n = (n | n << shift) & mask;
    }
    n
}

/// Boxes around triangles, in a tree of halves.
pub struct Boxes {
    /// From the root on; the halves of number `n` have the numbers `2n` and `2n + 1`. As many leaves as other nodes, with the unused number 0.
    nodes: Vec<Block>,
    /// In the order of the leaves: the triangles' numbers …
    order: Vec<u32>,
    /// … and boxes.
    members: Vec<Block>,
}

impl Boxes {
    /// Of some triangles, fewer than 2³².
    #[must_use]
    pub fn new(triangles: &[[DVec3; 3]]) -> Self {
        let all = triangles
            .iter()
            .map(bounds)
            .fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[a, b], [lo, hi]| [a.min(lo), b.max(hi)]);
        let scale = f64::from(MOST) / (all[1] - all[0]).max_element();
        // Every step of it keeps the order of coordinates, also where all are equal (NaN becomes 0) or it is not finite: boxes that touch touch as blocks, too.
        let whole = |p: DVec3| ((p - all[0]) * scale).to_array().map(|c| (c as u32).min(MOST));
        let mut blocks = Vec::with_capacity(triangles.len());
        let mut keys: Vec<u64> = Vec::with_capacity(triangles.len());
        for (n, t) in triangles.iter().enumerate() {
            let [low, high] = bounds(t).map(whole);
            let [x, y, z] = [0, 1, 2].map(|axis| spread((low[axis] + high[axis]) >> (FIELD - 10)));
            keys.push((x | y << 1 | z << 2) << 32 | n as u64);
            blocks.push(Block::new(low, high));
        }
        keys.sort_unstable();
        let order: Vec<u32> = keys.iter().map(|&key| key as u32).collect();
        let members: Vec<Block> = order.iter().map(|&n| blocks[n as usize]).collect();
        let leaves = triangles.len().div_ceil(LEAF).next_power_of_two();
        let mut nodes = vec![Block::NONE; 2 * leaves];
        for (node, leaf) in nodes[leaves..].iter_mut().zip(members.chunks(LEAF)) {
            *node = leaf[1..].iter().fold(leaf[0], |a, b| a.around(*b));
        }
        for n in (1..leaves).rev() {
            nodes[n] = nodes[2 * n].around(nodes[2 * n + 1]);
        }
        Boxes { nodes, order, members }
    }

    /// The triangles' numbers in the order of the tree, by which pairs are told.
    pub fn order(&self) -> impl Iterator<Item = usize> {
        self.order.iter().map(|&n| n as usize)
    }

    /// Is something true of every pair of triangles whose boxes touch? It is asked once of each, and of some pairs whose boxes nearly touch. None if that is not
    /// known after many pairs, for boxes tell little.
    pub fn all_touching(&self, mut is_true: impl FnMut(usize, usize) -> bool) -> Option<bool> {
        let leaves = self.nodes.len() / 2;
        let mut left = CROWD * leaves;
        let mut open = vec![(1, 1)];
        while let Some((a, b)) = open.pop() {
            if a >= leaves {
                left = left.checked_sub(1)?;
                if !self.all_of_leaves([a - leaves, b - leaves], &mut is_true) {
                    return Some(false);
                }
                continue;
            }
            let mut push = |a: usize, b: usize| {
                if self.nodes[a].touches(self.nodes[b]) {
                    open.push((a, b));
                }
            };
            let (a, b) = (2 * a, 2 * b);
            push(a, b);
            push(a, b + 1);
            push(a + 1, b + 1);
            if a != b {
                push(a + 1, b);
            }
        }
        Some(true)
    }

    fn all_of_leaves(&self, [a, b]: [usize; 2], is_true: &mut impl FnMut(usize, usize) -> bool) -> bool {
        let members = |leaf: usize| &self.members[LEAF * leaf..self.members.len().min(LEAF * (leaf + 1))];
        let (first, others) = (LEAF * b, members(b));
        let around = self.nodes[self.nodes.len() / 2 + b];
        for (m, block) in members(a).iter().enumerate().filter(|(_, block)| block.touches(around)) {
            let skip = if a == b { m + 1 } else { 0 };
            for (n, other) in others[skip..].iter().enumerate() {
                if block.touches(*other) && !is_true(LEAF * a + m, first + skip + n) {
                    return false;
                }
            }
        }
        true
    }
}
