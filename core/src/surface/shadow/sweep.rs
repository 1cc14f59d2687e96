//! A line that sweeps over the edges of outlines, and counts what lies between them.

use super::edge::{ShadowEdge, thickness};
use crate::number::real::Real;

/// A sweep takes so many steps, each once an edge that it passes, from one crossing to the next.
const MOST_STEPS: usize = 1 << 23;

/// On what is left then it stops so often, wherever crossings are.
const LINES: usize = 1024;

/// A line that sweeps over edges.
pub(super) struct Sweep<'m, R> {
    /// First those that are crossed, in their order; from `next` on those not met yet, by their low ends.
    pub edges: &'m mut [ShadowEdge<R>],
    /// So many edges are crossed.
    pub count: usize,
    pub next: usize,
    /// In how many solids lines begin before the first edge.
    pub starting: i32,
}

impl<R: Real> Sweep<'_, R> {
    /// The area that is covered or solid, and whether that is exact.
    pub fn shadow(&mut self) -> (R, bool) {
        let (mut steps, mut v, mut area) = (0_usize, R::ZERO, R::ZERO);
        // The places of the edges crossed so far are known at `v`.
        let mut known = true;
        while v < R::ONE {
            let nearest_end = self.drop_passed(v);
            let before = if known { self.count } else { 0 };
            let top = self.take_met(v, nearest_end);
            self.arrange(v, top, before);
            let stop = self.first_crossing(v, top);
            area += self.width(stop, top) * (stop - v);
            (v, known) = (stop, stop >= top);
            steps += self.count + 1;
            if steps > MOST_STEPS && v < R::ONE {
                return (area + self.along_lines(v), false);
            }
        }
        (area, true)
    }

    /// What is covered or solid beyond `v`, by its widths along evenly spaced lines.
    fn along_lines(&mut self, v: R) -> R {
        let (step, mut sum) = ((R::ONE - v) / R::from_usize(LINES), R::ZERO);
        for n in 0..LINES {
            let line = v + step * (R::from_usize(n) + R::HALF);
            self.drop_passed(line);
            self.take_met(line, R::INFINITY);
            self.arrange(line, line, 0);
            sum += self.width(line, line);
        }
        sum * step
    }

    /// The crossed edges, in their order.
    #[inline(always)]
    fn crossed(&self) -> &[ShadowEdge<R>] {
        self.edges.get(..self.count).unwrap_or_default()
    }

    /// Forget the edges that end at or before `v`; where the first of the others ends.
    fn drop_passed(&mut self, v: R) -> R {
        let (mut kept, mut nearest) = (0, R::INFINITY);
        for nth in 0..self.count {
            let Some(end) = self.edges.get(nth).map(|edge| edge.high[1]) else { continue };
            if end > v {
                nearest = nearest.smaller(end);
                if kept < nth {
                    self.copy(nth, kept);
                }
                kept += 1;
            }
        }
        self.count = kept;
        nearest
    }

    /// Cross the edges that begin at or before `v` and go on; where the first of all that are crossed ends or another one begins.
    fn take_met(&mut self, v: R, nearest_end: R) -> R {
        let mut top = nearest_end;
        while let Some(edge) = self.edges.get(self.next) {
            if !(edge.low[1] <= v) {
                return top.smaller(edge.low[1]);
            }
            if edge.high[1] > v {
                top = top.smaller(edge.high[1]);
                // There is room: no more are crossed than have been met.
                self.copy(self.next, self.count);
                self.count += 1;
            }
            self.next += 1;
        }
        top.smaller(R::ONE)
    }

    /// Copy an edge to the place of another.
    #[inline(always)]
    fn copy(&mut self, from: usize, to: usize) {
        let Some(&edge) = self.edges.get(from) else { return };
        if let Some(place) = self.edges.get_mut(to) {
            *place = edge;
        }
    }

    /// Find the places of the crossed edges at `v` and at `top`, and put them in order, as the line meets them just beyond `v`. Of the first ones, so many,
    /// the step before has ended at `v`.
    fn arrange(&mut self, v: R, top: R, known: usize) {
        let mut last = [-R::INFINITY; 2];
        for start in 0..self.count {
            let Some(edge) = self.edges.get_mut(start) else { continue };
            let low = if start < known { edge.step[1] } else { edge.at(v) };
            let step = [low, edge.at(top)];
            edge.step = step;
            if start > 0 && is_before(step, last) {
                self.move_down(start);
            } else {
                last = step;
            }
        }
    }

    /// Move a crossed edge before those among the ones before it that it is before.
    fn move_down(&mut self, start: usize) {
        let Some(&edge) = self.edges.get(start) else { return };
        let mut at = start;
        while let Some(before) = at.checked_sub(1) {
            if !self.edges.get(before).is_some_and(|other| is_before(edge.step, other.step)) {
                break;
            }
            self.copy(before, at);
            at = before;
        }
        if let Some(place) = self.edges.get_mut(at) {
            *place = edge;
        }
    }

    /// Where two neighbours first change places between `v` and `top`, or `top`.
    fn first_crossing(&self, v: R, top: R) -> R {
        let (mut stop, mut last) = (top, None);
        for &ShadowEdge { step: [b_low, b_top], .. } in self.crossed() {
            if let Some([a_low, a_top]) = last.replace([b_low, b_top]) {
                let (before, after) = (b_low - a_low, b_top - a_top);
                if before > thickness() && after < R::ZERO {
                    // Of edges nearly along the line the places differ by more than rounding where they cross but for rounding.
                    let crossing = (v + (top - v) * (before / (before - after))).max(v + R::EPSILON);
                    stop = stop.smaller(crossing);
                }
            }
        }
        stop
    }

    /// The mean width of what is covered or solid from where the edges were put in order to `stop`, where no edges have changed places.
    fn width(&self, stop: R, top: R) -> R {
        let (mut covering, mut starting, mut width) = (0_i32, self.starting, R::ZERO);
        let mut last = [R::ZERO; 2];
        let mut add = |here: [R; 2], more: [i32; 2]| {
            if covering > 0 || starting > 0 {
                width += ((here[0] - last[0]) + (here[1] - last[1])).max(R::ZERO) * R::HALF;
            }
            // There are fewer edges than would make them overflow.
            covering = covering.wrapping_add(more[0]);
            starting = starting.wrapping_add(more[1]);
            last = here;
        };
        for edge in self.crossed() {
            let end = if stop < top { edge.at(stop) } else { edge.step[1] };
            add([edge.step[0], end], [edge.covering, edge.starting]);
        }
        add([R::ONE; 2], [0; 2]);
        width
    }
}

/// Is one edge before another, by their places on two lines?
fn is_before<R: Real>(one: [R; 2], other: [R; 2]) -> bool {
    let apart = one[0] - other[0];
    if apart.abs() > thickness() { apart < R::ZERO } else { one[1] < other[1] }
}
