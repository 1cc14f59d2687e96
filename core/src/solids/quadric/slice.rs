//! What several convex parts have in common of a rectangle in a plane: its area, by rows.
//!
//! In a row, at a height `v`, each part has a span along `u`; what all have in common reaches from the greatest of their low ends to the least of
//! their high ends. High ends are concave functions of the height, low ends convex ones, so the length in common, where negative too, is
//! concave: Newton's method from outside and secants from inside close in on the heights between which it is positive.
//!
//! Between two rows, the integral over any of the high ends less that over any of the low ends is an upper bound of the area, and the
//! trapezoid of the two lengths a lower one. Where one wall is proved to be the innermost on its side all the way (its tangents stay
//! within the chords of the others), the integral over it is the area itself, in closed form: a trapezoid and the lens of an arc.

use super::arc::{Conic, area_of_lens};
use super::end_line::EndLine;
use super::part::Part;
use super::twofold::{Twofold, difference};
use super::wall::{Curved, Lines, Span, Wall};
use crate::number::axis::Axis;
use crate::number::plane::P2;
use crate::number::real::Real;
use core::cell::Cell;
use heapless::Vec;

/// Most rows between two others.
const MOST_STEPS: usize = 240;

/// Most rows that wait to be reached.
const MOST_WAITING: usize = 22;

/// Most parts that are looked at together.
pub(super) const MOST_PARTS: usize = 6;

/// A rectangle across an axis, and how closely its area is wanted.
#[derive(Clone, Copy, Debug)]
pub(super) struct Window {
    /// The axis that it is across.
    pub n: Axis,
    pub u: P2,
    pub v: P2,
    /// Bounds of the area this close will do.
    pub enough: f64,
}

/// Farther than any arc between rows reaches from its chord; its square is finite.
const ANY_REACH: f64 = 1e150;

/// Lengths of rows, and what their tangents tell, are off by this share of them.
const ROUNDED_LENGTH: f64 = 64.0 * f64::EPSILON;

/// Bounds that say nothing.
const UNKNOWN: P2 = [f64::NEG_INFINITY, f64::INFINITY];

/// What some parts have in common in a plane, by lower and upper bounds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Common {
    pub area: P2,
    /// From the highest of the parts' lowest rows to the lowest of their highest ones: negative if no row meets all of them. A concave
    /// function of where the plane is.
    pub height: P2,
    /// The greatest length that a row has in common, negative if there is a gap in all of them: concave, too. Infinite bounds where no row
    /// meets all parts, where none could be computed, or where there certainly is an area.
    pub length: P2,
}

/// Which function bounds a row: a wall by its number, an end by its number, or the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Boundary {
    Wall(u8),
    End(u8),
    Window,
}

/// A side of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Low,
    High,
}

/// A curved surface in the plane.
struct WallInPlane<'a> {
    curved: &'a Curved,
    /// Of a cylinder that rows do not run along: how they lie to it, and its radius.
    cylinder: Option<(Lines, f64)>,
    /// The plane's coordinate, and the conic that it cuts out, from the part's origin.
    h: Twofold,
    conic: Conic,
    /// The part's origin in the plane.
    origin: P2,
}

/// The line of a flat end that bounds rows on one side: `u = at + slope (v − from)`.
#[derive(Clone, Copy)]
struct LineOfEnd {
    side: Side,
    at: f64,
    from: f64,
    slope: f64,
}

/// Up to `N` parts in a plane.
pub(super) struct Slice<'a, const N: usize> {
    window: Window,
    walls: Vec<WallInPlane<'a>, N>,
    ends: Vec<LineOfEnd, { 2 * MOST_PARTS }>,
    /// Heights between which rows meet all parts.
    rows: P2,
    /// Lengths that rounding may make.
    noise: f64,
    /// Ends of rows closer than this length count as one. Raised while an area is measured in which two curves stay closer than any number of rows
    /// can tell.
    tie: Cell<f64>,
}

/// A row: the spans of the walls, and what they have in common.
#[derive(Clone, Copy)]
struct Row<const N: usize> {
    v: f64,
    spans: [Span; N],
    low: f64,
    high: f64,
    left: Boundary,
    right: Boundary,
}

impl<const N: usize> Row<N> {
    fn length(&self) -> f64 {
        self.high - self.low
    }
}

impl<'a> WallInPlane<'a> {
    fn new(part: &'a Part, n: Axis, coordinate: f64) -> Self {
        let ([u, v], curved) = (n.others(), &part.curved);
        let cylinder = match curved.wall {
            Wall::Cylinder { radius } => curved.lines(u).map(|lines| (lines, radius)),
            _ => None,
        };
        let h = difference(coordinate, part.origin[n]);
        WallInPlane { curved, cylinder, h, conic: curved.conic(n, h), origin: [part.origin[u], part.origin[v]] }
    }

    #[inline(always)]
    fn span(&self, u_axis: Axis, v: f64) -> Span {
        let place = [difference(v, self.origin[1]), self.h];
        let span = match &self.cylinder {
            Some((lines, radius)) => lines.span(*radius, place),
            None => self.curved.span(u_axis, place),
        };
        Span { lo: span.lo + self.origin[0], hi: span.hi + self.origin[0] }
    }

    /// By how much its side moves as rows rise, in a point of it.
    #[inline(always)]
    fn slope(&self, side: Side, [u, v]: P2) -> f64 {
        let [gu, gv] = self.conic.gradient([u - self.origin[0], v - self.origin[1]]);
        // Outward on its side, whatever rounding makes of it.
        -gv / match side {
            Side::High if gu > 0.0 => gu,
            Side::High => 0.0,
            Side::Low if gu < 0.0 => gu,
            Side::Low => -0.0,
        }
    }
}

impl<'a, const N: usize> Slice<'a, N> {
    /// Of a plane at a coordinate.
    pub fn new(parts: impl Iterator<Item = &'a Part>, window: Window, coordinate: f64) -> Self {
        let size = |x: P2| x[0].abs().max(x[1].abs());
        let far = size(window.u).max(size(window.v)).max(coordinate.abs());
        let mut slice =
            Slice { window, walls: Vec::new(), ends: Vec::new(), rows: window.v, noise: 0.0, tie: Cell::new(0.0) };
        let mut reach = far;
        for part in parts {
            let wall = WallInPlane::new(part, window.n, coordinate);
            let origin = wall.origin;
            reach = reach.max(size(origin)).max(part.origin[window.n].abs());
            for end in part.ends.iter().flatten() {
                slice.add_end(&end.line(window.n, coordinate), origin);
            }
            let [first, last] = part.curved.rows(window.n, wall.h);
            slice.narrow(origin[1] + first, origin[1] + last);
            let _ = slice.walls.push(wall);
        }
        slice.noise = 8.0 * f64::EPSILON * reach;
        slice.tie = Cell::new(slice.noise.max(window.enough / (16.0 * (window.v[1] - window.v[0]))));
        slice
    }

    fn narrow(&mut self, first: f64, last: f64) {
        let [a, b] = &mut self.rows;
        (*a, *b) = (a.max(first), b.min(last));
    }

    /// A flat end bounds rows on one side, or the heights of rows.
    fn add_end(&mut self, line: &EndLine, origin: P2) {
        let [du, dv] = [self.window.u, self.window.v].map(|[lo, hi]| hi - lo);
        let [along, up] = line.slope;
        let [u0, v0] = [line.shift[0] + origin[0], line.shift[1] + origin[1]];
        if along.abs() * du > 1e-14 * up.abs() * dv {
            let side = if along > 0.0 { Side::Low } else { Side::High };
            let _ = self.ends.push(LineOfEnd { side, at: u0 - line.constant / along, from: v0, slope: -up / along });
        } else if up != 0.0 {
            let middle = (self.window.u[0] + self.window.u[1]) * 0.5;
            let v = v0 - (line.constant + along * (middle - u0)) / up;
            if up > 0.0 { self.narrow(v, f64::INFINITY) } else { self.narrow(f64::NEG_INFINITY, v) }
        } else if !(line.constant >= 0.0) {
            self.narrow(f64::INFINITY, f64::NEG_INFINITY);
        }
    }

    /// The row at a height; none where rounding lets a span vanish.
    fn row(&self, v: f64) -> Option<Row<N>> {
        let Window { n, u: [u0, u1], .. } = self.window;
        let [u_axis, _] = n.others();
        let beyond = 4.0 * (u1 - u0);
        let mut row =
            Row { v, spans: [Span::ALL; N], low: u0, high: u1, left: Boundary::Window, right: Boundary::Window };
        for (number, (wall, into)) in self.walls.iter().zip(&mut row.spans).enumerate() {
            let span = wall.span(u_axis, v);
            if !(span.lo <= span.hi) {
                return None;
            }
            let span = Span { lo: span.lo.max(u0 - beyond), hi: span.hi.min(u1 + beyond) };
            *into = span;
            if span.lo > row.low {
                (row.low, row.left) = (span.lo, Boundary::Wall(number as u8));
            }
            if span.hi < row.high {
                (row.high, row.right) = (span.hi, Boundary::Wall(number as u8));
            }
        }
        for (number, end) in self.ends.iter().enumerate() {
            let u = end.at + end.slope * (v - end.from);
            match end.side {
                Side::Low if u > row.low => (row.low, row.left) = (u, Boundary::End(number as u8)),
                Side::High if u < row.high => (row.high, row.right) = (u, Boundary::End(number as u8)),
                _ => {}
            }
        }
        Some(row)
    }

    /// The row at an end of the heights, or close by.
    fn end_row(&self, v: f64, inward: f64) -> Option<Row<N>> {
        let mut step = 0.0;
        for _ in 0..12 {
            if let Some(row) = self.row(v + inward * step) {
                return Some(row);
            }
            step = (step * 8.0).max(self.noise);
        }
        None
    }

    /// Where a boundary stands in a row.
    fn place(&self, row: &Row<N>, side: Side, boundary: Boundary) -> f64 {
        let window = self.window.u;
        match boundary {
            Boundary::Window => window[usize::from(side == Side::High)],
            Boundary::Wall(n) => row.spans.get(usize::from(n)).map_or(f64::NAN, |s| match side {
                Side::Low => s.lo,
                Side::High => s.hi,
            }),
            Boundary::End(n) => self.ends.get(usize::from(n)).map_or(f64::NAN, |e| e.at + e.slope * (row.v - e.from)),
        }
    }

    /// By how much a boundary moves as rows rise; infinite where a wall turns, not a number where it has no tangent.
    fn slope(&self, row: &Row<N>, side: Side, boundary: Boundary) -> f64 {
        match boundary {
            Boundary::Window => 0.0,
            Boundary::End(n) => self.ends.get(usize::from(n)).map_or(f64::NAN, |e| e.slope),
            Boundary::Wall(n) => {
                let u = self.place(row, side, boundary);
                self.walls.get(usize::from(n)).map_or(f64::NAN, |wall| wall.slope(side, [u, row.v]))
            }
        }
    }

    /// The slope of the length in common, of a concave function: any that holds on one side.
    fn rise(&self, row: &Row<N>) -> f64 {
        self.slope(row, Side::High, row.right) - self.slope(row, Side::Low, row.left)
    }

    /// What all parts have in common.
    pub fn common(&self) -> Common {
        let [first, last] = self.rows;
        let width = self.window.u[1] - self.window.u[0];
        let rounded = |[low, high]: P2| {
            [low - self.noise - ROUNDED_LENGTH * low.abs(), high + self.noise + ROUNDED_LENGTH * high.abs()]
        };
        let mut found = Common { area: [0.0; 2], height: rounded([last - first; 2]), length: UNKNOWN };
        if !(first < last) {
            return found;
        }
        let (Some(a), Some(b)) = (self.end_row(first, 1.0), self.end_row(last, -1.0)) else {
            found.area[1] = (last - first) * width;
            return found;
        };
        // What the rows beside the ends may hold that were left out.
        let room = ((a.v - first) + (last - b.v)).max(0.0) * width + self.noise * (last - first + width);
        let (peak, most) = self.peak(&a, &b, self.tie.get());
        if peak.length() > 0.0 {
            let ((from, before), (to, behind)) = (self.begin(a, peak), self.begin(b, peak));
            let (below, above) = (self.area(from, peak), self.area(peak, to));
            found.area = [(below[0] + above[0] - room).max(0.0), below[1] + above[1] + before + behind + room];
            if found.area[0] > 0.0 {
                return found;
            }
            // Of all rows, those too that `begin` has left out.
            let (peak, most) = self.peak(&a, &b, f64::INFINITY);
            found.length = rounded([peak.length(), most]);
        } else {
            found.area[1] = if most > 0.0 { most * (last - first) + room } else { 0.0 };
            found.length = rounded([peak.length(), most]);
        }
        found
    }

    /// The first row found that has more than `enough` in common; if there is none, one that has nearly as much as any. And a length that no row
    /// exceeds.
    fn peak(&self, a: &Row<N>, b: &Row<N>, enough: f64) -> (Row<N>, f64) {
        let (mut a, mut b) = (*a, *b);
        let mut best = if a.length() > b.length() { a } else { b };
        let mut most = self.window.u[1] - self.window.u[0];
        for turn in 0..60 {
            let width = b.v - a.v;
            let (lengths, rises) = ([a.length(), b.length()], [self.rise(&a), self.rise(&b)]);
            let (at, tangents) = below_tangents(lengths, rises, width);
            // Rows along a pipe but for rounding pass it by as much as 10¹⁶ lengths: what rounding leaves of these tells nothing.
            let sizes = lengths[0].abs() + lengths[1].abs() + rises[0].abs().min(rises[1].abs()) * width;
            most = most.min(tangents + ROUNDED_LENGTH * sizes);
            let close = 0.25 * most.abs().max(self.tie.get());
            if best.length() > enough || most - best.length() <= close || !(width > self.noise) {
                break;
            }
            let at = if turn % 4 == 3 { 0.5 * width } else { at.limited(0.02 * width, 0.98 * width) };
            let Some(row) = self.row(a.v + at) else { break };
            if row.length() > best.length() {
                best = row;
            }
            let rise = self.rise(&row);
            match rise {
                _ if rise > 0.0 => a = row,
                _ if rise <= 0.0 => b = row,
                _ => break,
            }
        }
        (best, most.max(best.length()))
    }

    /// Closes in on where the length in common begins, from a row at the end: a row where it is not negative, and what may lie beyond that.
    fn begin(&self, end: Row<N>, peak: Row<N>) -> (Row<N>, f64) {
        let (mut outer, mut inner) = (end, peak);
        if outer.length() >= -self.noise {
            return (outer, 0.0);
        }
        let all = self.window.u[1] - self.window.u[0];
        let mut lost = all * (inner.v - outer.v).abs();
        for _ in 0..60 {
            let width = inner.v - outer.v;
            // Between both it is not above the inner one's tangent.
            let more = -self.rise(&inner) * width;
            let most = if more <= 0.0 { inner.length() } else { (inner.length() + more).min(all) };
            lost = width.abs() * most;
            if lost <= self.window.enough / 64.0 || width.abs() <= self.noise {
                break;
            }
            // Newton from outside stays outside, the secant comes out inside.
            let newton = outer.v - outer.length() / self.rise(&outer);
            let within = |v: f64| (v - outer.v) * width > 0.0 && (inner.v - v) * width > 0.0;
            let next = if within(newton) { newton } else { outer.v + width * 0.5 };
            if let Some(row) = self.row(next) {
                if row.length() <= 0.0 { outer = row } else { inner = row }
            }
            let secant = outer.v - (inner.v - outer.v) * (outer.length() / (inner.length() - outer.length()));
            if (secant - outer.v) * (inner.v - secant) > 0.0
                && let Some(row) = self.row(secant)
            {
                if row.length() < 0.0 { outer = row } else { inner = row }
            }
        }
        (inner, lost)
    }

    /// Bounds of the area between two rows with something in common, in either order.
    fn area(&self, from: Row<N>, to: Row<N>) -> P2 {
        let [from, to] = if from.v <= to.v { [from, to] } else { [to, from] };
        let tie = self.tie.get();
        let mut found = self.in_panels(from, to);
        for _ in 0..5 {
            if found.is_ok() {
                break;
            }
            self.tie.set(self.tie.get() * 64.0);
            found = self.in_panels(from, to);
        }
        self.tie.set(tie);
        found.unwrap_or_else(|bounds| bounds)
    }

    /// The same, from low to high; as an error if that needs too many rows.
    fn in_panels(&self, mut a: Row<N>, last: Row<N>) -> Result<P2, P2> {
        let all = last.v - a.v;
        let mut waiting: Vec<Row<N>, MOST_WAITING> = Vec::new();
        let _ = waiting.push(last);
        let (mut lower, mut upper) = (0.0, 0.0);
        let (mut steps, mut early) = (0, false);
        let enough = (0.5 * self.window.enough).max((0.25 * self.noise).max(4.0 * (self.tie.get() - self.noise)) * all);
        while let Some(b) = waiting.last().copied() {
            let width = b.v - a.v;
            let ([low, high], at) = self.between(&a, &b);
            let within = |at: f64| at.max(a.v + self.noise).min(b.v - self.noise);
            let at = at.filter(|_| (high - low) * all > enough * width && width > 4.0 * self.noise);
            early |= at.is_some() && (steps > MOST_STEPS || waiting.is_full());
            match at.filter(|_| !early).and_then(|at| self.row(within(at))) {
                Some(row) => {
                    steps += 1;
                    let _ = waiting.push(row);
                }
                None => {
                    (lower, upper) = (lower + low, upper + high);
                    a = b;
                    let _ = waiting.pop();
                }
            }
        }
        if early { Err([lower, upper]) } else { Ok([lower, upper]) }
    }

    /// Bounds of the area between two rows; and where to look next, unless the bounds are close.
    fn between(&self, a: &Row<N>, b: &Row<N>) -> (P2, Option<f64>) {
        let width = b.v - a.v;
        let trapezoid = (a.length().max(0.0) + b.length().max(0.0)) * 0.5 * width;
        let (high, no_proof) = self.innermost(a, b, Side::High);
        let (low, nor_there) = self.innermost(a, b, Side::Low);
        let integral = |side: Side, [one, other]: [Boundary; 2]| {
            let found = self.integral(a, b, side, one);
            match side {
                _ if one == other => found,
                Side::High => found.min(self.integral(a, b, side, other)),
                Side::Low => found.max(self.integral(a, b, side, other)),
            }
        };
        let upper = (integral(Side::High, high) - integral(Side::Low, low)).max(trapezoid);
        match no_proof.or(nor_there) {
            None => {
                // As if walls stood a little higher or lower.
                let moved = self.noise * ((b.high - a.high).abs() + (b.low - a.low).abs());
                ([(upper - 2.0 * (self.tie.get() * width + moved)).max(trapezoid), upper], None)
            }
            at => ([trapezoid, upper], at),
        }
    }

    /// The boundary that is innermost on a side of two rows, twice, or one for each row; and, unless it is proved to be so between them, where
    /// to look.
    fn innermost(&self, a: &Row<N>, b: &Row<N>, side: Side) -> ([Boundary; 2], Option<f64>) {
        let inner = |row: &Row<N>| if side == Side::High { (row.right, row.high) } else { (row.left, row.low) };
        let sign = if side == Side::High { 1.0 } else { -1.0 };
        let ((of_a, at_a), (of_b, at_b)) = (inner(a), inner(b));
        let counts = |row: &Row<N>, boundary: Boundary, best: f64| {
            sign * (self.place(row, side, boundary) - best) <= self.tie.get()
        };
        let chosen = if of_a == of_b || counts(b, of_a, at_b) {
            of_a
        } else if counts(a, of_b, at_a) {
            of_b
        } else {
            return ([of_a, of_b], Some(self.crossing(a, b, side, [of_a, of_b])));
        };
        // Straight sides lie within chords of concave ones if their ends do.
        let Boundary::Wall(_) = chosen else { return ([chosen; 2], None) };
        let width = b.v - a.v;
        // Written out: `map` of arrays, and `all` of a chain, call functions.
        let place = |row: &Row<N>, boundary: Boundary| sign * self.place(row, side, boundary);
        let own = [place(a, chosen), place(b, chosen)];
        let along = (own[1] - own[0]) / width;
        // How far its tangents, where they meet, are from its chord.
        let slope = |row: &Row<N>| sign * self.slope(row, side, chosen) - along;
        let (at, bulge) = below_tangents([0.0; 2], [slope(a), slope(b)], width);
        let within = |boundary: Boundary| {
            if boundary == chosen {
                return true;
            }
            let room = [place(a, boundary) - own[0], place(b, boundary) - own[1]];
            bulge <= room[0] + (room[1] - room[0]) * (at / width) + self.tie.get()
                || self.same(a, b, side, [chosen, boundary])
        };
        let mut ends = self.ends.iter().enumerate().filter(|(_, e)| e.side == side);
        let proved = (0..self.walls.len()).all(|n| within(Boundary::Wall(n as u8)))
            && ends.all(|(n, _)| within(Boundary::End(n as u8)))
            && within(Boundary::Window);
        ([chosen; 2], (!proved).then(|| a.v + at.limited(0.2 * width, 0.8 * width)))
    }

    /// By how much rounding may move a boundary in a row: as if the row were a little higher or lower.
    fn room(&self, row: &Row<N>, side: Side, boundary: Boundary) -> f64 {
        let [u, v] = [self.window.u, self.window.v].map(|[lo, hi]| hi - lo);
        let most = 8.0 * Real::sqrt(self.noise * (u + v));
        let steep = self.noise * self.slope(row, side, boundary).abs();
        self.tie.get() + if steep < most { steep } else { most }
    }

    /// Are two walls one curve between two rows? Conics that agree in five places do.
    fn same(&self, a: &Row<N>, b: &Row<N>, side: Side, two: [Boundary; 2]) -> bool {
        let close = |row: &Row<N>| {
            let [p, q] = two.map(|boundary| self.place(row, side, boundary));
            (p - q).abs() <= two.map(|boundary| self.room(row, side, boundary)).into_iter().fold(0.0, f64::max)
        };
        let width = b.v - a.v;
        close(a) && close(b) && [0.2, 0.5, 0.8].iter().all(|t| self.row(a.v + t * width).is_some_and(|r| close(&r)))
    }

    /// Where two boundaries of a side cross, of which each is innermost in one of two rows.
    fn crossing(&self, a: &Row<N>, b: &Row<N>, side: Side, [of_a, of_b]: [Boundary; 2]) -> f64 {
        let [first, last] = [a, b].map(|row| self.place(row, side, of_a) - self.place(row, side, of_b));
        let (mut lo, mut hi) = (a.v, b.v);
        let mut next = lo + (hi - lo) * (first / (first - last));
        let mut at = next;
        for step in 1..40 {
            // Newton's method, within what is known to hold the crossing; that halves where it takes long.
            at = if next > lo && next < hi && step % 6 != 0 { next } else { (lo + hi) * 0.5 };
            let (Some([p, rise]), Some([q, other])) = (self.at(at, side, of_a), self.at(at, side, of_b)) else { break };
            let d = p - q;
            if d.abs() <= 0.25 * self.tie.get() || !(hi - lo > self.noise) {
                break;
            }
            if d * first > 0.0 {
                lo = at
            } else {
                hi = at
            }
            next = at - d / (rise - other);
        }
        at
    }

    /// Where a boundary stands in a row, and by how much it moves as rows rise; none where rounding lets a span vanish.
    fn at(&self, v: f64, side: Side, boundary: Boundary) -> Option<P2> {
        match boundary {
            Boundary::Window => Some([self.window.u[usize::from(side == Side::High)], 0.0]),
            Boundary::End(n) => self.ends.get(usize::from(n)).map(|e| [e.at + e.slope * (v - e.from), e.slope]),
            Boundary::Wall(n) => {
                let (wall, [u_axis, _]) = (self.walls.get(usize::from(n))?, self.window.n.others());
                let span = wall.span(u_axis, v);
                let u = if side == Side::High { span.hi } else { span.lo };
                (span.lo <= span.hi).then(|| [u, wall.slope(side, [u, v])])
            }
        }
    }

    /// The integral over a boundary between two rows.
    fn integral(&self, a: &Row<N>, b: &Row<N>, side: Side, boundary: Boundary) -> f64 {
        let (p, q) = (self.place(a, side, boundary), self.place(b, side, boundary));
        let trapezoid = (p + q) * 0.5 * (b.v - a.v);
        let Boundary::Wall(n) = boundary else { return trapezoid };
        let Some(wall) = self.walls.get(usize::from(n)) else { return trapezoid };
        let (from, to) = ([p - wall.origin[0], a.v - wall.origin[1]], [q - wall.origin[0], b.v - wall.origin[1]]);
        let ends = if side == Side::High { [from, to] } else { [to, from] };
        let area = area_of_lens(ends, wall.conic.turn(ends[0], ends[1]), &wall.conic, ANY_REACH);
        if side == Side::High { trapezoid + area } else { trapezoid - area }
    }
}

/// The greatest value that a concave function can have on an interval of a width, from its values and slopes at the ends, and where; slopes
/// may be infinite, or not a number where they are not known.
fn below_tangents([p, q]: P2, [up, down]: P2, width: f64) -> (f64, f64) {
    if up <= 0.0 {
        (0.0, p)
    } else if down >= 0.0 {
        (width, q)
    } else if up.is_finite() && down.is_finite() {
        let at = ((q - p - down * width) / (up - down)).limited(0.0, width);
        // By the flatter tangent: rounding of `at` counts as often as that is steep, and the other may be steeper by many powers of ten.
        (at, if up <= -down { p + up * at } else { q + down * (at - width) })
    } else if down.is_finite() {
        (0.0, q - down * width)
    } else if up.is_finite() {
        (width, p + up * width)
    } else {
        (0.5 * width, f64::INFINITY)
    }
}
