//! What a convex solid has of a rectangle in a grid plane: straight pieces along the rectangle's sides and along flat ends, arcs between.

use super::arc::{Conic, Moments, area_of_lens, lens};
use super::end_line::EndLine;
use super::wall::{Ellipse, Span};
use crate::number::plane::{P2, cross, on_way, sub};
use heapless::Vec;

/// A rectangle in a plane; coordinates are relative to the part's origin.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rectangle {
    pub u: P2,
    pub v: P2,
}

/// Corners of a rectangle that two half planes cut: each takes away one and adds two at most.
const MAX_CORNERS: usize = 6;

/// A corner, and on which line the side after it lies: sides of the rectangle 0 to 3, ends 4 and 5.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Corner {
    pub at: P2,
    pub side: u8,
}

/// A rectangle cut by half planes.
pub(super) type Corners = Vec<Corner, MAX_CORNERS>;

impl Rectangle {
    /// Its middle.
    #[inline(always)]
    pub fn middle(&self) -> P2 {
        [(self.u[0] + self.u[1]) * 0.5, (self.v[0] + self.v[1]) * 0.5]
    }

    /// Does a point lie inside?
    #[inline(always)]
    pub fn is_about(&self, [u, v]: P2) -> bool {
        self.u[0] < u && u < self.u[1] && self.v[0] < v && v < self.v[1]
    }

    /// Counter-clockwise, from the lowest corner.
    #[inline]
    pub fn corners(&self) -> Corners {
        let [[u0, u1], [v0, v1]] = [self.u, self.v];
        let mut corners = Corners::new();
        for (at, side) in [([u0, v0], 0), ([u1, v0], 1), ([u1, v1], 2), ([u0, v1], 3)] {
            let _ = corners.push(Corner { at, side });
        }
        corners
    }

    /// Its sides, as the outline of all of it.
    pub fn sides(&self) -> Vec<Piece, 4> {
        let corners = self.corners();
        let mut sides = Vec::new();
        for (n, corner) in corners.iter().enumerate() {
            let to = corners.get(n + 1).or(corners.first()).map_or(corner.at, |c| c.at);
            let _ = sides.push(Piece { from: corner.at, to, joined: true, side: corner.side });
        }
        sides
    }
}

/// The part of a polygon where a linear function is not negative. The sides along it get the number `side`.
pub(super) fn cut(corners: &Corners, line: &EndLine, side: u8) -> Corners {
    let mut kept = Corners::new();
    for (n, corner) in corners.iter().enumerate() {
        let next = corners.get(n + 1).or(corners.first()).copied().unwrap_or_default();
        let (here, there) = (line.at(corner.at), line.at(next.at));
        let inside = here >= 0.0;
        if inside {
            let _ = kept.push(*corner);
        }
        if inside != (there >= 0.0) {
            let at = crossing(corner.at, next.at, line, here / (here - there));
            let _ = kept.push(Corner { at, side: if inside { side } else { corner.side } });
        }
    }
    if kept.len() < 3 { Corners::new() } else { kept }
}

/// Where a side meets a line, `part` of the way along it. On a side along an axis the line itself tells: beside a ball's centre, where line and
/// side may meet far closer to it than the side's ends lie, all digits of that distance count.
fn crossing(from: P2, to: P2, line: &EndLine, part: f64) -> P2 {
    let mut at = on_way(from, to, part);
    for (across, along) in [(0, 1), (1, 0)] {
        if from[across] == to[across] {
            let aside = line.constant + line.slope[across] * (from[across] - line.shift[across]);
            let place = line.shift[along] - aside / line.slope[along];
            let (lo, hi) = (from[along].min(to[along]), from[along].max(to[along]));
            if lo <= place && place <= hi {
                at[along] = place;
            }
        }
    }
    at
}

/// By how much boxes around polygons are enlarged.
const MARGIN: f64 = 1.001;

/// A chord that rounding may have made, where the ellipse is the unit circle: as long as √ε, which a line has inside that touches it but for ε. Less
/// than its square, the share of the ellipse beyond such a chord, is lost.
const SHORT: f64 = 1.5e-8;

/// Width and height of a polygon.
fn size(corners: &Corners) -> P2 {
    let (mut lo, mut hi) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for corner in corners {
        for k in 0..2 {
            (lo[k], hi[k]) = (lo[k].min(corner.at[k]), hi[k].max(corner.at[k]));
        }
    }
    sub(hi, lo)
}

/// A straight piece of an outline; without `joined`, an arc leads to it from the piece before.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub from: P2,
    pub to: P2,
    pub joined: bool,
    /// As that of a [`Corner`].
    pub side: u8,
}

/// The straight pieces of an outline, in order.
pub(super) type Pieces = Vec<Piece, MAX_CORNERS>;

/// What a solid has of a rectangle.
#[derive(Clone, Copy, Debug)]
pub(super) enum Region<'p> {
    Empty,
    /// All of it.
    Whole,
    /// An ellipse inside it.
    Ellipse(Ellipse),
    /// A polygon with arcs between some of its corners, and whether one of these may go more than half around an ellipse.
    Pieces(&'p [Piece], bool),
}

/// Straight pieces of an outline, side by side.
struct Outline<'p> {
    pieces: &'p mut Pieces,
    /// The first side has a piece that begins in its corner.
    from_corner: bool,
    /// The side before has a piece that ends in its corner.
    to_corner: bool,
    first: bool,
}

impl<'p> Outline<'p> {
    /// In memory that holds nothing yet.
    fn new(pieces: &'p mut Pieces) -> Self {
        Outline { pieces, from_corner: false, to_corner: false, first: true }
    }

    /// What there is inside of the next side.
    #[inline(always)]
    fn add(&mut self, side: u8, found: Option<Side>) {
        if let Some(Side { from, to, from_corner, to_corner }) = found {
            let _ = self.pieces.push(Piece { from, to, joined: from_corner && self.to_corner, side });
            self.from_corner |= self.first && from_corner;
            self.to_corner = to_corner;
        } else {
            self.to_corner = false;
        }
        self.first = false;
    }

    /// All pieces; the first side comes after the last.
    #[inline(always)]
    fn close(self) -> &'p [Piece] {
        if self.from_corner
            && self.to_corner
            && let Some(first) = self.pieces.first_mut()
        {
            first.joined = true;
        }
        self.pieces
    }
}

/// Triangles that share a corner, and lenses beside them: area, and first moments about that corner.
struct Fan {
    base: P2,
    /// The corner before, from the base.
    last: P2,
    total: Moments,
}

impl Fan {
    /// The triangle of the base, the corner before and this one.
    #[inline(always)]
    fn add(&mut self, corner: P2) {
        let (a, b) = (self.last, sub(corner, self.base));
        let triangle = cross(a, b) * 0.5;
        self.total.area += triangle;
        for k in 0..2 {
            self.total.first[k] += triangle * (a[k] + b[k]) / 3.0;
        }
        self.last = b;
    }

    /// A lens whose moments are about a point.
    #[inline(always)]
    fn add_lens(&mut self, about: P2, lens: &Moments) {
        let shift = sub(about, self.base);
        self.total.area += lens.area;
        for k in 0..2 {
            self.total.first[k] += lens.first[k] + shift[k] * lens.area;
        }
    }
}

/// What a plane cuts out of a curved surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Section {
    pub conic: Conic,
    /// All that is inside, if it is an ellipse with an inside.
    pub ellipse: Option<Ellipse>,
}

/// Do spans miss all sides of a rectangle, in the order of its corners?
#[inline(always)]
fn apart(rectangle: &Rectangle, spans: &[Span; 4]) -> bool {
    let misses = |s: &Span, [lo, hi]: P2| !(s.lo < hi && s.hi > lo);
    misses(&spans[0], rectangle.u)
        && misses(&spans[2], rectangle.u)
        && misses(&spans[1], rectangle.v)
        && misses(&spans[3], rectangle.v)
}

impl Section {
    /// Is it certain that nothing lies in a rectangle, by the spans as in [`Section::region`]?
    #[inline(always)]
    pub fn misses(&self, rectangle: &Rectangle, spans: &[Span; 4]) -> bool {
        apart(rectangle, spans) && !self.ellipse.is_some_and(|e| rectangle.is_about(e.center))
    }

    /// What lies in a rectangle and inside all ends. `spans` are those of the lines along its sides, in the order of [`Rectangle::corners`];
    /// `ends` are lines of flat ends, with what tells of the number of one which chord the end's disc has on it; `pieces` is memory that holds nothing
    /// yet.
    #[inline]
    pub fn region<'p>(
        &self,
        rectangle: &Rectangle,
        spans: &[Span; 4],
        (ends, chord_of): (&[Option<EndLine>; 2], impl Fn(usize) -> Option<[P2; 2]>),
        pieces: &'p mut Pieces,
    ) -> Region<'p> {
        let [[u0, u1], [v0, v1]] = [rectangle.u, rectangle.v];
        let mut corners = None;
        let mut chords = [None; 2];
        for ((number, end), chord) in ends.iter().enumerate().zip(&mut chords) {
            let Some(line) = end else { continue };
            let values = [[u0, v0], [u1, v0], [u1, v1], [u0, v1]].map(|p| line.at(p));
            if values.iter().all(|&l| l >= 0.0) {
                continue;
            }
            if values.iter().all(|&l| l <= 0.0) {
                return Region::Empty;
            }
            let before = corners.take().unwrap_or_else(|| rectangle.corners());
            corners = Some(cut(&before, line, 4 + number as u8));
            *chord = chord_of(number);
        }
        if corners.is_none() {
            let whole = spans[0].covers(u0, u1)
                && spans[2].covers(u0, u1)
                && spans[1].covers(v0, v1)
                && spans[3].covers(v0, v1);
            if whole {
                return Region::Whole;
            }
            if apart(rectangle, spans) {
                return self.ellipse_in(rectangle);
            }
        }
        let Some(corners) = corners else { return self.pieces_of_rectangle(rectangle, spans, pieces) };
        let lines = ends.iter().flatten();
        self.pieces((&corners, rectangle, lines), pieces, |corner, to| match corner.side {
            0 => clip::<0, true>(corner.at, to, spans[0]),
            1 => clip::<1, true>(corner.at, to, spans[1]),
            2 => clip::<0, false>(corner.at, to, spans[2]),
            3 => clip::<1, false>(corner.at, to, spans[3]),
            n => on_chord(corner.at, to, chords[usize::from(n == 5)]),
        })
    }

    /// As [`Section::pieces`], of a rectangle that no end cuts.
    #[inline(always)]
    fn pieces_of_rectangle<'p>(&self, rectangle: &Rectangle, spans: &[Span; 4], pieces: &'p mut Pieces) -> Region<'p> {
        let [[u0, u1], [v0, v1]] = [rectangle.u, rectangle.v];
        let mut outline = Outline::new(pieces);
        outline.add(0, clip::<0, true>([u0, v0], [u1, v0], spans[0]));
        outline.add(1, clip::<1, true>([u1, v0], [u1, v1], spans[1]));
        outline.add(2, clip::<0, false>([u1, v1], [u0, v1], spans[2]));
        outline.add(3, clip::<1, false>([u0, v1], [u0, v0], spans[3]));
        let ellipse = self.ellipse.filter(|e| rectangle.is_about(e.center));
        self.bounded_by(outline, ellipse, || [u1 - u0, v1 - v0])
    }

    /// The straight pieces of a polygon inside the conic, of each side what `inside` tells; or the whole conic. The polygon is what `lines` leave of a
    /// rectangle.
    pub fn pieces<'p, 'l>(
        &self,
        (corners, rectangle, mut lines): (&Corners, &Rectangle, impl Iterator<Item = &'l EndLine>),
        pieces: &'p mut Pieces,
        inside: impl Fn(&Corner, P2) -> Option<Side>,
    ) -> Region<'p> {
        let mut outline = Outline::new(pieces);
        for (n, corner) in corners.iter().enumerate() {
            let next = corners.get(n + 1).or(corners.first()).map_or(corner.at, |c| c.at);
            outline.add(corner.side, inside(corner, next));
        }
        // By the lines: the sides of the polygon between corners that all but coincide have no direction.
        let ellipse =
            self.ellipse.filter(|e| rectangle.is_about(e.center) && lines.all(|line| line.at(e.center) > 0.0));
        self.bounded_by(outline, ellipse, || size(corners))
    }

    /// What lies inside an outline along a polygon of this width and height, which is about the centre of `ellipse`, if of any.
    ///
    /// An arc of more than half an ellipse and its chord have the centre between them, so it lies in the polygon. Where all pieces are so short that only
    /// rounding makes them, the polygon is about all of the ellipse and touches it.
    #[inline(always)]
    fn bounded_by<'p>(&self, outline: Outline<'p>, ellipse: Option<Ellipse>, size: impl Fn() -> P2) -> Region<'p> {
        let Some(ellipse) = ellipse else {
            return if outline.pieces.is_empty() { Region::Empty } else { Region::Pieces(outline.close(), false) };
        };
        let (pieces, size) = (outline.close(), size());
        if self.is_point(pieces) && self.fits(size) {
            return Region::Ellipse(ellipse);
        }
        if pieces.is_empty() { Region::Empty } else { Region::Pieces(pieces, self.half_fits(size)) }
    }

    /// Do all pieces lie in what is a point, but for rounding?
    fn is_point(&self, pieces: &[Piece]) -> bool {
        let Some(first) = pieces.first() else { return true };
        pieces.iter().all(|piece| [piece.from, piece.to].iter().all(|&p| self.is_short(sub(p, first.from), 2.0)))
    }

    /// Is a chord of an ellipse at most some [`SHORT`] long, where the ellipse is the unit circle?
    #[inline(always)]
    fn is_short(&self, chord: P2, some: f64) -> bool {
        let Conic { size, factor, tau, .. } = self.conic;
        self.conic.form(chord) * (size * factor) <= tau * (SHORT * SHORT * some * some)
    }

    /// Does half of the ellipse fit a polygon of this width and height? Not if the conic is none.
    fn half_fits(&self, size: P2) -> bool {
        let [width, height] = size.map(|x| x * MARGIN);
        self.ellipse.is_some_and(|e| e.area * 0.5 <= width * height && self.conic.is_within([width, height]))
    }

    /// The whole conic, if it is an ellipse about a point of a rectangle.
    fn ellipse_in(&self, rectangle: &Rectangle) -> Region<'static> {
        let Some(ellipse) = self.ellipse else { return Region::Empty };
        let [[u0, u1], [v0, v1]] = [rectangle.u, rectangle.v];
        if rectangle.is_about(ellipse.center) && self.fits([u1 - u0, v1 - v0]) {
            Region::Ellipse(ellipse)
        } else {
            Region::Empty
        }
    }

    /// Is an ellipse no larger than a box of this size, but for rounding? Of a plane that touches a cone along a line rounding may make an ellipse of
    /// any size.
    fn fits(&self, size: P2) -> bool {
        self.conic.is_within(size.map(|x| x * (0.5 * MARGIN)))
    }

    /// Area of a region, and its first moments about the middle of the rectangle.
    #[inline]
    pub fn moments(&self, region: &Region, rectangle: &Rectangle) -> Moments {
        let [[u0, u1], [v0, v1]] = [rectangle.u, rectangle.v];
        let middle = rectangle.middle();
        match region {
            Region::Empty => Moments::default(),
            Region::Whole => Moments { area: (u1 - u0) * (v1 - v0), first: [0.0; 2] },
            Region::Ellipse(ellipse) => {
                Moments { area: ellipse.area, first: sub(ellipse.center, middle).map(|c| c * ellipse.area) }
            }
            Region::Pieces(pieces, about) => self.moments_of(pieces, *about, middle, (u1 - u0) + (v1 - v0)),
        }
    }

    /// Area of a region alone.
    #[inline]
    pub fn area(&self, region: &Region, rectangle: &Rectangle) -> f64 {
        let [du, dv] = [rectangle.u, rectangle.v].map(|[lo, hi]| hi - lo);
        match region {
            Region::Empty => 0.0,
            Region::Whole => du * dv,
            Region::Ellipse(ellipse) => ellipse.area,
            Region::Pieces(pieces, about) => self.area_of(pieces, *about, du + dv),
        }
    }

    /// As [`Section::moments_of`].
    fn area_of(&self, pieces: &[Piece], about: bool, reach: f64) -> f64 {
        let (Some((first, others)), Some(last)) = (pieces.split_first(), pieces.last()) else { return 0.0 };
        let arc = |p: P2, q: P2| {
            let turn = self.conic.turn(p, q);
            match self.ellipse {
                Some(ellipse) if about && self.is_major_if(turn, p, q) => {
                    ellipse.area - area_of_lens([q, p], self.conic.turn(q, p), &self.conic, reach)
                }
                _ => area_of_lens([p, q], turn, &self.conic, reach),
            }
        };
        let mut total = if first.joined { 0.0 } else { arc(last.to, first.from) };
        let mut before = first.to;
        for piece in others {
            if !piece.joined {
                total += arc(before, piece.from);
                total += cross(sub(before, first.from), sub(piece.from, first.from)) * 0.5;
            }
            total += cross(sub(piece.from, first.from), sub(piece.to, first.from)) * 0.5;
            before = piece.to;
        }
        total
    }

    /// `about` as that of [`Region::Pieces`].
    fn moments_of(&self, pieces: &[Piece], about: bool, middle: P2, reach: f64) -> Moments {
        let (Some((first, others)), Some(last)) = (pieces.split_first(), pieces.last()) else {
            return Moments::default();
        };
        // The first piece makes no triangle with its own beginning.
        let mut fan = Fan { base: first.from, last: sub(first.to, first.from), total: Moments::default() };
        if !first.joined {
            fan.add_lens(last.to, &self.arc(last.to, first.from, about, reach));
        }
        let mut before = first.to;
        for piece in others {
            // A piece that is joined begins where the one before ended.
            if !piece.joined {
                fan.add_lens(before, &self.arc(before, piece.from, about, reach));
                fan.add(piece.from);
            }
            fan.add(piece.to);
            before = piece.to;
        }
        let Fan { base, mut total, .. } = fan;
        for k in 0..2 {
            total.first[k] += (base[k] - middle[k]) * total.area;
        }
        total
    }

    /// Does the arc from `p` to `q` go more than half around an ellipse, where one may?
    #[inline(always)]
    pub fn is_major(&self, p: P2, q: P2) -> bool {
        self.is_major_if(self.conic.turn(p, q), p, q)
    }

    /// The same, by what [`Conic::turn`] tells. Of a short chord rounding decides which way it turns, as at a corner on the surface; and of an outline
    /// that is more than a point no arc is long that has a short chord, since the chord cuts off all the rest.
    #[inline(always)]
    fn is_major_if(&self, turn: f64, p: P2, q: P2) -> bool {
        turn < 0.0 && self.conic.factor > 0.0 && !self.is_short(sub(q, p), 1.0)
    }

    /// What lies between the arc from `p` to `q` and its chord, moments about `p`. `about` as that of [`Region::Pieces`].
    fn arc(&self, p: P2, q: P2, about: bool, reach: f64) -> Moments {
        let turn = self.conic.turn(p, q);
        if about && self.is_major_if(turn, p, q) {
            let Some(ellipse) = self.ellipse else { return Moments::default() };
            let rest = lens([q, p], self.conic.turn(q, p), &self.conic, reach);
            let first =
                |k: usize| ellipse.area * (ellipse.center[k] - p[k]) - rest.first[k] - rest.area * (q[k] - p[k]);
            return Moments { area: ellipse.area - rest.area, first: [first(0), first(1)] };
        }
        lens([p, q], turn, &self.conic, reach)
    }
}

/// What a conic has of a polygon's side, and whether that begins and ends at its corners.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side {
    pub from: P2,
    pub to: P2,
    pub from_corner: bool,
    pub to_corner: bool,
}

/// What a span has of a side along a coordinate, upwards or downwards.
#[inline(always)]
fn clip<const ALONG: usize, const UP: bool>(from: P2, to: P2, span: Span) -> Option<Side> {
    let [low, high] = if UP { [from, to] } else { [to, from] };
    let (covers_lo, covers_hi) = (span.lo <= low[ALONG], span.hi >= high[ALONG]);
    let (a, b) = (if covers_lo { low[ALONG] } else { span.lo }, if covers_hi { high[ALONG] } else { span.hi });
    if !(a < b) {
        return None;
    }
    let (mut lower, mut upper) = (low, high);
    (lower[ALONG], upper[ALONG]) = (a, b);
    Some(if UP {
        Side { from: lower, to: upper, from_corner: covers_lo, to_corner: covers_hi }
    } else {
        Side { from: upper, to: lower, from_corner: covers_hi, to_corner: covers_lo }
    })
}

/// What a chord has of a side that lies on its line.
pub(super) fn on_chord(from: P2, to: P2, chord: Option<[P2; 2]>) -> Option<Side> {
    let chord = chord?;
    let d = sub(to, from);
    let square = d[0] * d[0] + d[1] * d[1];
    let place = |p: P2| {
        let e = sub(p, from);
        e[0] * d[0] + e[1] * d[1]
    };
    let [mut near, mut far] = chord;
    if place(near) > place(far) {
        (near, far) = (far, near);
    }
    let (from_corner, to_corner) = (place(near) <= 0.0, place(far) >= square);
    if !(place(near) < square && place(far) > 0.0) {
        return None;
    }
    let (from, to) = (if from_corner { from } else { near }, if to_corner { to } else { far });
    Some(Side { from, to, from_corner, to_corner })
}
