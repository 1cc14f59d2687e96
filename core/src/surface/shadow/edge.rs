//! Edges of faces as seen along an axis: those between two faces that look the same way cancel, what is left are outlines.

use crate::number::real::Real;

/// Places closer than this, in ε, are one place.
const THICKNESS_IN_EPSILONS: f64 = 64.0;

/// An edge seen along the axis of a sweep. The default serves as memory.
#[derive(Clone, Copy, Debug, Default)]
pub struct ShadowEdge<R> {
    /// The end met first by the sweep: place along the sweeping line, and of the line.
    pub(super) low: [R; 2],
    pub(super) high: [R; 2],
    /// How many more faces cover the places beyond the edge.
    pub(super) covering: i32,
    /// In how many more solids lines begin there.
    pub(super) starting: i32,
    /// Its places along the line at the beginning and at the end of a step.
    pub(super) step: [R; 2],
}

impl<R: Real> ShadowEdge<R> {
    /// From `a` to `b`, with counts that hold if it leads upwards; none along the sweeping line.
    pub(super) fn new(a: [R; 2], b: [R; 2], [covering, starting]: [i32; 2]) -> Option<Self> {
        let step = [R::ZERO; 2];
        if a[1] < b[1] {
            Some(ShadowEdge { low: a, high: b, covering, starting, step })
        } else {
            (a[1] > b[1]).then_some(ShadowEdge { low: b, high: a, covering: -covering, starting: -starting, step })
        }
    }

    /// Place along the line that has come to `v`.
    pub(super) fn at(&self, v: R) -> R {
        if v >= self.high[1] {
            return self.high[0];
        }
        let along = ((v - self.low[1]) / (self.high[1] - self.low[1])).max(R::ZERO);
        self.low[0] + (self.high[0] - self.low[0]) * along
    }

    /// What lies beyond it, counted once for each solid in which lines begin there.
    pub(super) fn starting_area(&self) -> R {
        let beyond = R::ONE - (self.low[0] + self.high[0]) * R::HALF;
        let area = beyond * (self.high[1] - self.low[1]);
        if self.starting < 0 { -area } else { area }
    }

    /// Is it to be sorted after another?
    #[inline(always)]
    fn follows(&self, other: &Self) -> bool {
        if self.low[1] != other.low[1] {
            return self.low[1] > other.low[1];
        }
        if self.low[0] != other.low[0] {
            return self.low[0] > other.low[0];
        }
        if self.high[1] != other.high[1] {
            return self.high[1] > other.high[1];
        }
        self.high[0] > other.high[0]
    }
}

/// A place of a hash table that holds no edge.
const NO_EDGE: u32 = u32::MAX;

/// What the four coordinates of an edge are multiplied with, and their sum, to scatter it over a hash table.
const SCATTER: [f64; 5] =
    [0.754_877_666_246_693, 0.569_840_290_998_053, 0.426_040_474_321_852, 0.322_185_354_626_086, 1e9];

/// Drop the edges between two faces that look the same way, which are most of those of fine surfaces; how many others are left, before them. A table of
/// at least as many `places` finds edges with the same ends; without it nothing is dropped. Those left need not be all different.
pub(super) fn cancelled<R: Real>(edges: &mut [ShadowEdge<R>], places: &mut [u32]) -> usize {
    let size = (edges.len().saturating_mul(4) / 3).next_power_of_two();
    let Some(table) = places.get_mut(..size) else { return edges.len() };
    table.fill(NO_EDGE);
    let [a, b, c, d, all] = SCATTER;
    let mut kept = 0_usize;
    for n in 0..edges.len() {
        let Some(&edge) = edges.get(n) else { break };
        let ShadowEdge { low, high, .. } = edge;
        // In `f64`: of sums this large an `f32` has no low digits.
        let [u, v, w, x] = [low[0], low[1], high[0], high[1]].map(Real::to_f64);
        let mut at = ((u * a + v * b + w * c + x * d) * all) as usize & (size - 1);
        // A quarter of the table is empty.
        while let Some(place) = table.get_mut(at) {
            match edges.get_mut(*place as usize) {
                Some(other) if other.low == low && other.high == high => {
                    other.covering = other.covering.saturating_add(edge.covering);
                    other.starting = other.starting.saturating_add(edge.starting);
                    break;
                }
                Some(_) => at = (at + 1) & (size - 1),
                None => {
                    *place = kept as u32;
                    if let Some(place) = edges.get_mut(kept) {
                        *place = edge;
                    }
                    kept += 1;
                    break;
                }
            }
        }
    }
    let mut left = 0;
    for n in 0..kept {
        let Some(&edge) = edges.get(n) else { break };
        if (edge.covering, edge.starting) != (0, 0) {
            if let Some(place) = edges.get_mut(left) {
                *place = edge;
            }
            left += 1;
        }
    }
    left
}

/// Sort edges by their low ends and make one of those with the same ends; how many are left that count.
pub(super) fn joined<R: Real>(edges: &mut [ShadowEdge<R>]) -> usize {
    sort(edges);
    let (mut kept, mut open): (usize, Option<ShadowEdge<R>>) = (0, None);
    for n in 0..=edges.len() {
        let next = edges.get(n).copied();
        match (&mut open, next) {
            (Some(last), Some(edge)) if last.low == edge.low && last.high == edge.high => {
                last.covering = last.covering.saturating_add(edge.covering);
                last.starting = last.starting.saturating_add(edge.starting);
            }
            (last, _) => {
                if let Some(edge) = last.filter(|e| (e.covering, e.starting) != (0, 0)) {
                    if let Some(place) = edges.get_mut(kept) {
                        *place = edge;
                    }
                    kept += 1;
                }
                *last = next;
            }
        }
    }
    kept
}

/// Shell's sort, which needs no memory.
fn sort<R: Real>(edges: &mut [ShadowEdge<R>]) {
    let mut gap = edges.len() / 2;
    while gap > 0 {
        for start in gap..edges.len() {
            let Some(&edge) = edges.get(start) else { continue };
            let mut at = start;
            while let Some(&before) = at.checked_sub(gap).and_then(|n| edges.get(n)).filter(|e| e.follows(&edge)) {
                if let Some(place) = edges.get_mut(at) {
                    *place = before;
                }
                at -= gap;
            }
            if let Some(place) = edges.get_mut(at).filter(|_| at < start) {
                *place = edge;
            }
        }
        gap = if gap == 2 { 1 } else { gap * 5 / 11 };
    }
}

/// Places closer than this are one place.
pub(super) fn thickness<R: Real>() -> R {
    R::EPSILON * R::from_f64(THICKNESS_IN_EPSILONS)
}
