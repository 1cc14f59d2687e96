//! The coordinate axes, as indices that cannot leave an array of three.

use core::ops::{Index, IndexMut};

/// A coordinate axis: indexes arrays that hold one item for each of the three, always within bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Axis {
    X,
    Y,
    Z,
}

impl Axis {
    /// All three in order.
    pub const ALL: [Axis; 3] = [Axis::X, Axis::Y, Axis::Z];

    /// By its number; none beyond 2.
    #[inline(always)]
    pub const fn new(number: usize) -> Option<Self> {
        match number {
            0 => Some(Axis::X),
            1 => Some(Axis::Y),
            2 => Some(Axis::Z),
            _ => None,
        }
    }

    /// The two axes after this one, so that all three turn to the right.
    #[inline(always)]
    pub const fn others(self) -> [Axis; 2] {
        match self {
            Axis::X => [Axis::Y, Axis::Z],
            Axis::Y => [Axis::Z, Axis::X],
            Axis::Z => [Axis::X, Axis::Y],
        }
    }
}

impl<T> Index<Axis> for [T; 3] {
    type Output = T;
    #[inline(always)]
    fn index(&self, axis: Axis) -> &T {
        &self[axis as usize]
    }
}

impl<T> IndexMut<Axis> for [T; 3] {
    #[inline(always)]
    fn index_mut(&mut self, axis: Axis) -> &mut T {
        &mut self[axis as usize]
    }
}
