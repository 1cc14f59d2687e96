//! Which of some vertices is farthest along a direction, by looking at all of them.

use crate::number::real::{Real, Vector};

/// The greatest of four values and its position, the first of equals. By selections instead of branches, two at a time.
#[inline(always)]
fn top<R: Real>(of: [R; 4]) -> (R, u32) {
    let (pq, rs) = (of[1] > of[0], of[3] > of[2]);
    let low = if pq { of[1] } else { of[0] };
    let high = if rs { of[3] } else { of[2] };
    if high > low { (high, 2 + u32::from(rs)) } else { (low, u32::from(pq)) }
}

/// The position of the item for which `along` is greatest, the first of equals; 0 of none. A chain of one comparison for every four items.
#[inline(always)]
pub(super) fn farthest<T: Copy, R: Real>(items: &[T], along: impl Fn(T) -> R) -> u32 {
    let (mut best, mut index) = (-R::INFINITY, 0);
    let mut fours = items.chunks_exact(4);
    let mut first = 0;
    for four in &mut fours {
        if let [p, q, r, s] = *four {
            let (top, which) = top([along(p), along(q), along(r), along(s)]);
            index = if top > best { first + which } else { index };
            best = if top > best { top } else { best };
        }
        first += 4;
    }
    for &item in fours.remainder() {
        let there = along(item);
        index = if there > best { first } else { index };
        best = if there > best { there } else { best };
        first += 1;
    }
    index
}

/// The index of the vertex farthest along a direction, the first of equals; 0 of none.
#[inline(always)]
pub(super) fn scan<V: Vector>(vertices: &[V], direction: V) -> u32 {
    farthest(vertices, |v| v.dot(direction))
}
