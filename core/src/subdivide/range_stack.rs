//! The explicit stack of a depth-first bisection, which stands for recursion: ranges of cells or faces still to be visited.

use heapless::Vec;

use crate::grid::cell_range::CellRange;

/// Most ranges on the stack. The walk is depth first, and each bisection pops one range and pushes two. A side of fewer than 2³² cells is
/// single after 32 bisections, so at most 96 of them lie below each other, and each leaves one range behind: 96, and the one at hand.
pub const MAX_RANGES: usize = 3 * 32 + 1;

/// A stack of ranges, each with what is known of it. If only halves of the range popped last are pushed, there is always a place for them.
#[derive(Clone, Debug)]
pub struct RangeStack<T> {
    items: Vec<(CellRange, T), MAX_RANGES>,
}

impl<T: Copy> RangeStack<T> {
    /// A stack of one range.
    pub fn new(range: CellRange, known: T) -> Self {
        let mut items = Vec::new();
        let pushed = items.push((range, known)).is_ok();
        debug_assert!(pushed, "an empty stack has a place");
        RangeStack { items }
    }

    /// How many ranges it holds.
    pub fn len(&self) -> usize {
        self.items.len()
    }

    /// Holds no range.
    pub fn is_empty(&self) -> bool {
        self.items.is_empty()
    }

    /// Takes out the range pushed last.
    pub fn pop(&mut self) -> Option<(CellRange, T)> {
        self.items.pop()
    }

    /// Pushes the halves of the range popped last, cut across its longest side, the lower half on top. Pushes nothing and returns false
    /// for a single cell or face, for an empty range, and for one popped elsewhere if the stack has no place for two more.
    pub fn push_halves(&mut self, range: CellRange, known: T) -> bool {
        if range.is_empty() {
            return false;
        }
        let (axis, length) = range.longest_side();
        if length <= 1 {
            return false;
        }
        let [low, high] = range.halves(axis);
        self.items.extend_from_slice(&[(high, known), (low, known)]).is_ok()
    }
}
