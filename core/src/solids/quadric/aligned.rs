//! A pipe along an axis of the grid in a layer of cells: all its sections across that axis are the same, so that one is computed for each line of cells
//! along it.
//!
//! What a cell has of the section, times what it has of the pipe's length, is its share of the pipe. So are the shares of faces beside the pipe, of
//! which the lines around the section tell.

use super::outline::Rectangle;
use super::part::{FaceFlux, Part, Plane};
use super::twofold::{Twofold, difference};
use super::wall::{Span, Wall};
use super::window::reached;
use crate::number::axis::Axis;
use crate::number::plane::P2;
use crate::number::real::Real;
use core::ops::Range;

/// What is told of a cell: shares of it, of its low faces, and of its high x and y faces.
#[derive(Clone, Copy)]
pub(super) struct Shares {
    pub cell: f64,
    pub low: [f64; 3],
    pub high: [f64; 2],
}

impl Shares {
    pub const WHOLE: Self = Shares { cell: 1.0, low: [1.0; 3], high: [1.0; 2] };
}

/// A pipe along an axis of the grid.
pub(super) struct AlignedPipe<'a> {
    part: &'a Part,
    along: Axis,
    /// Where it begins and ends along that axis; both places belong to it.
    ends: P2,
    /// Any plane across it.
    section: Plane,
}

/// What lines of cells along the pipe have of its section: shares of areas across it, and of the sides of these.
struct Section {
    area: f64,
    u: P2,
    v: P2,
}

impl Section {
    /// By the share of the area; sides and lines as those of [`AlignedPipe::share`].
    fn new(area: f64, [u, v]: [[Twofold; 2]; 2], [u_lines, v_lines]: [[Span; 2]; 2]) -> Self {
        let share = |line: &Span, sides: &[Twofold; 2]| line.share_of([sides[0].value, sides[1].value]);
        Section {
            area,
            u: [share(&u_lines[0], &u), share(&u_lines[1], &u)],
            v: [share(&v_lines[0], &v), share(&v_lines[1], &v)],
        }
    }
}

impl<'a> AlignedPipe<'a> {
    /// None if it is no cylinder, or not along an axis.
    pub fn new(part: &'a Part) -> Option<Self> {
        let along = part.xi;
        if !matches!(part.curved.wall, Wall::Cylinder { .. }) || part.curved.across[along] != 0.0 {
            return None;
        }
        let mut ends = [f64::NEG_INFINITY, f64::INFINITY];
        for end in part.ends.iter().flatten() {
            let at = end.center[along];
            if end.inward[along] > 0.0 { ends[0] = ends[0].max(at) } else { ends[1] = ends[1].min(at) }
        }
        let section = part.plane_with([None; 2], along, part.origin[along]);
        Some(AlignedPipe { part, along, ends, section })
    }

    /// Tells what cells `cells[n]` along each axis `n` have of it, by edges of the grid: their indices, whether each is the last of these along its
    /// axis, and shares; of a cell without a share those of its faces may be left out where they are 0. `recall` tells the share of its section that cells
    /// along z have, by their indices along x and y, or computes it if it is not known. Returns by how much the worst share left 0 to 1.
    pub fn tell<R: Real>(
        &self,
        edges: [&[R]; 3],
        cells: &[Range<usize>; 3],
        recall: &mut impl FnMut([usize; 2], &dyn Fn() -> f64) -> f64,
        tell: &mut impl FnMut([usize; 3], [bool; 3], &Shares),
    ) -> f64 {
        let n = self.along;
        let [u, v] = n.others();
        let mut worst = 0.0_f64;
        let from_origin = |axis: Axis, at: usize| {
            difference(edges[axis].get(at).map_or(f64::NAN, |e| e.to_f64()), self.part.origin[axis])
        };
        let [u_line, v_line] = [u, v].map(|m| move |at: Twofold| self.line(m, at));
        let mut at = [0; 3];
        let mut high = from_origin(v, cells[v].start);
        let mut upper = u_line(high);
        for b in cells[v].clone() {
            let (low, lower) = (high, upper);
            high = from_origin(v, b + 1);
            upper = u_line(high);
            let run = self.run([low, high], [lower, upper]);
            let row = limited(reached(edges[u], run), &cells[u]);
            let inside = lower.intersection(upper);
            let mut right: Option<(Twofold, Span)> = None;
            for a in row.clone() {
                let x = [right.map_or_else(|| from_origin(u, a), |r| r.0), from_origin(u, a + 1)];
                let section = if inside.covers(x[0].value, x[1].value) {
                    right = None;
                    Section { area: 1.0, u: [1.0; 2], v: [1.0; 2] }
                } else {
                    let v_lines = [right.map_or_else(|| v_line(x[0]), |r| r.1), v_line(x[1])];
                    right = Some((x[1], v_lines[1]));
                    let (sides, lines) = ([x, [low, high]], [[lower, upper], v_lines]);
                    let share = || self.share(sides, lines);
                    let share = if n == Axis::Z { recall([a, b], &share) } else { share() };
                    Section::new(share, sides, lines)
                };
                worst = if section.area.is_nan() { f64::INFINITY } else { worst.max(section.area - 1.0) };
                worst = worst.max(-section.area);
                (at[u], at[v]) = (a, b);
                for c in cells[n].clone() {
                    at[n] = c;
                    let last = |axis: Axis, of: &Range<usize>| at[axis] + 1 == of.end;
                    let mut ends = [false; 3];
                    (ends[n], ends[u], ends[v]) = (last(n, &cells[n]), last(u, &row), last(v, &cells[v]));
                    let [Some(z0), Some(z1)] = [c, c + 1].map(|c| edges[n].get(c).map(|e| e.to_f64())) else { break };
                    tell(at, ends, &self.shares(&section, [z0, z1]));
                }
            }
        }
        worst
    }

    /// Where along `u` what lies between two lines along it may be.
    fn run(&self, [low, high]: [Twofold; 2], [lower, upper]: [Span; 2]) -> P2 {
        let u = self.along.others()[0];
        if low.value <= 0.0 && high.value >= 0.0 {
            return self.part.extent(u);
        }
        // The nearer line holds more.
        let (near, origin) = (if low.value > 0.0 { lower } else { upper }, self.part.origin[u]);
        [origin + near.lo, origin + near.hi]
    }

    /// What a line along an axis across it has inside.
    fn line(&self, m: Axis, at: Twofold) -> Span {
        let h = self.section.h;
        self.part.curved.span(m, if m == self.along.others()[0] { [at, h] } else { [h, at] })
    }

    /// The area that it has of a rectangle across it, by its sides from the origin of the part.
    pub fn area(&self, [x, y]: [P2; 2]) -> f64 {
        let [u, v] = self.along.others();
        let [x, y] = [x, y].map(|side| side.map(|value| Twofold { value, rest: 0.0 }));
        let lines = [y.map(|at| self.line(u, at)), x.map(|at| self.line(v, at))];
        let [long, wide] = [x, y].map(|[low, high]| high.value - low.value);
        self.share([x, y], lines) * (long * wide)
    }

    /// The share that it has of a rectangle across it, by the rectangle's sides along both axes and the lines along these.
    fn share(&self, [u, v]: [[Twofold; 2]; 2], [u_lines, v_lines]: [[Span; 2]; 2]) -> f64 {
        let sides = Rectangle { u: u.map(|x| x.value), v: v.map(|x| x.value) };
        let face = self.part.face(&self.section, &sides, &[u_lines[0], v_lines[1], u_lines[1], v_lines[0]]);
        let FaceFlux { area, whole, .. } = face;
        let all = (sides.u[1] - sides.u[0]) * (sides.v[1] - sides.v[0]);
        if whole { 1.0 } else { area / all }
    }

    /// Shares of the cell between two planes across the pipe.
    fn shares(&self, section: &Section, planes: P2) -> Shares {
        let n = self.along;
        let [u, v] = n.others();
        let long = Span { lo: self.ends[0], hi: self.ends[1] }.share_of(planes);
        let area = section.area.clamp(0.0, 1.0);
        let mut faces = [[0.0; 2]; 3];
        faces[n] = planes.map(|at| if self.ends[0] <= at && at <= self.ends[1] { area } else { 0.0 });
        (faces[u], faces[v]) = (section.v.map(|share| share * long), section.u.map(|share| share * long));
        let [[x0, x1], [y0, y1], [z0, _]] = faces;
        Shares { cell: area * long, low: [x0, y0, z0], high: [x1, y1] }
    }
}

/// What two ranges have in common.
fn limited(a: Range<usize>, b: &Range<usize>) -> Range<usize> {
    a.start.max(b.start)..a.end.min(b.end)
}
