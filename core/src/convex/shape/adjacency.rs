//! Where on a hull the farthest vertex can be: by the direction's sector, else along edges.
//!
//! Directions are sorted by where they leave a cube, each face of which is cut four by four. A sector is the cone of its four corners, so a
//! vertex that is not as far as some other one along all four is not the farthest along any direction in it. The few that remain are the
//! sector's candidates. Where they are too many to list, a climb along edges finds the vertex, and a look at all vertices proves it.

use heapless::Vec;

use super::scan::scan;
use crate::convex::support::magnitude;
use crate::number::real::{Real, Vector};

/// Which vertices of a hull share an edge, and which can be farthest.
#[derive(Clone, Debug, PartialEq)]
pub struct Adjacency<'a> {
    offsets: &'a [u32],
    neighbours: &'a [u32],
    sectors: [Sector; SECTORS],
    /// Address and number of the vertices it was made for.
    vertices: (usize, usize),
}

/// The vertices of a hull that can be farthest along the directions of a sector.
#[derive(Clone, Debug, PartialEq)]
struct Sector {
    /// A vertex that is far along all of them, where a climb may start.
    start: u32,
    /// All that can be farthest, the farthest along the middle first; then that one again, up to a multiple of four. Empty if they are too many.
    candidates: Vec<u32, LISTED>,
}

/// Most candidates of a sector that are listed, a multiple of four: a round hull of some hundred vertices has ten.
const LISTED: usize = 16;

/// Four times four on each face of the cube.
const SECTORS: usize = 6 * 16;

/// Rounding of a vertex along a corner of the cube, in units of ε times the largest coordinate: twice three terms of two roundings, and a margin.
const CORNER_ROUNDINGS: f64 = 16.0;

impl<'a> Adjacency<'a> {
    /// The neighbours of vertex `i` are `neighbours[offsets[i]..offsets[i + 1]]`; so `offsets` is one longer than `vertices`. Wrong or missing
    /// edges cost time, not truth. Looks at each vertex some hundred times.
    pub fn new<V: Vector>(vertices: &'a [V], offsets: &'a [u32], neighbours: &'a [u32]) -> Self {
        let extent = vertices.iter().fold(V::Scalar::ZERO, |m, &v| m.max(magnitude(v)));
        let margin = V::Scalar::from_f64(CORNER_ROUNDINGS) * (extent + V::Scalar::MIN_POSITIVE) * V::Scalar::EPSILON;
        let sectors = core::array::from_fn(|i| Sector::new(vertices, i, margin));
        Adjacency { offsets, neighbours, sectors, vertices: identity(vertices) }
    }

    /// Whether it was made for these very vertices, which its lifetime keeps as they were.
    pub(super) fn belongs_to<V: Vector>(&self, vertices: &[V]) -> bool {
        self.vertices == identity(vertices)
    }

    /// All vertices that can be farthest along a direction, if they are few.
    #[inline(always)]
    pub(super) fn candidates<V: Vector>(&self, direction: V) -> Option<&[u32]> {
        let candidates = self.sectors.get(sector(direction))?.candidates.as_slice();
        (!candidates.is_empty()).then_some(candidates)
    }

    /// A vertex that is far along a direction.
    #[inline(always)]
    pub(super) fn start<V: Vector>(&self, direction: V) -> u32 {
        self.sectors.get(sector(direction)).map_or(0, |sector| sector.start)
    }

    #[inline(always)]
    pub(super) fn of(&self, vertex: u32) -> &'a [u32] {
        let i = vertex as usize;
        match (self.offsets.get(i), self.offsets.get(i.wrapping_add(1))) {
            (Some(&lo), Some(&hi)) => self.neighbours.get(lo as usize..hi as usize).unwrap_or(&[]),
            _ => &[],
        }
    }
}

fn identity<V>(vertices: &[V]) -> (usize, usize) {
    (vertices.as_ptr().addr(), vertices.len())
}

impl Sector {
    /// The sector of a number; `margin` covers the rounding of two vertices along a corner, in their unit times the cube's.
    fn new<V: Vector>(vertices: &[V], sector: usize, margin: V::Scalar) -> Self {
        let (middle, corners) = cone::<V>(sector);
        let middle = scan(vertices, middle);
        let mut found = Sector { start: middle, candidates: Vec::new() };
        // The best along the corners first: they rule most others out.
        let best = corners.map(|corner| scan(vertices, corner));
        let firsts = core::iter::once(middle).chain(best);
        let all_listed = firsts.chain(0..vertices.len() as u32).all(|i| found.offer(vertices, i, &corners, margin));
        found.start = found.candidates.first().copied().unwrap_or(middle);
        if !all_listed {
            found.candidates.clear();
        }
        while !found.candidates.len().is_multiple_of(4) && found.candidates.push(found.start).is_ok() {}
        found
    }

    /// Lists a vertex unless a listed one is farther, and drops those it is farther than itself; false if the list is full.
    fn offer<V: Vector>(&mut self, vertices: &[V], i: u32, corners: &[V; 4], margin: V::Scalar) -> bool {
        let at = |i: u32| vertices.get(i as usize).copied().unwrap_or(V::ZERO);
        let v = at(i);
        let reach = corners.map(|corner| v.dot(corner));
        let beyond = |p: [V::Scalar; 4], q: [V::Scalar; 4]| p.iter().zip(q).all(|(&p, q)| p > q + margin);
        let reach_of = |j: u32| corners.map(|corner| at(j).dot(corner));
        if self.candidates.iter().any(|&j| at(j) == v || beyond(reach_of(j), reach)) {
            return true;
        }
        self.candidates.retain(|&j| !beyond(reach, reach_of(j)));
        self.candidates.push(i).is_ok()
    }
}

/// Number of a direction's sector: the face of the cube, and a quarter along each of its axes. Comparisons of doubles and signs are exact.
#[inline(always)]
fn sector<V: Vector>(direction: V) -> usize {
    let zero = V::Scalar::ZERO;
    let [x, y, z] = direction.to_array();
    let [ax, ay, az] = [x.abs(), y.abs(), z.abs()];
    let face = usize::from(!(ax >= ay && ax >= az)) << usize::from(az > ay);
    let [out, u, v] = [[x, y, z], [y, z, x], [z, x, y]][face % 3];
    let reach = out.abs();
    let quarter = |t: V::Scalar| usize::from(t + t > -reach) + usize::from(t > zero) + usize::from(t + t > reach);
    (2 * face + usize::from(out > zero)) << 4 | quarter(u) << 2 | quarter(v)
}

/// The middle of a sector, and the four corners it is the cone of.
fn cone<V: Vector>(sector: usize) -> (V, [V; 4]) {
    let one = V::Scalar::ONE;
    let out = if sector >> 4 & 1 == 1 { one } else { -one };
    let at = |bits: usize, along: f64| V::Scalar::from_f64(0.5 * ((bits & 3) as f64 + along) - 1.0);
    let point = |along_u: f64, along_v: f64| {
        let (u, v) = (at(sector >> 2, along_u), at(sector, along_v));
        match sector >> 5 {
            0 => V::new(out, u, v),
            1 => V::new(v, out, u),
            _ => V::new(u, v, out),
        }
    };
    (point(0.5, 0.5), [point(0.0, 0.0), point(0.0, 1.0), point(1.0, 0.0), point(1.0, 1.0)])
}
