//! Where on a hull the farthest vertex can be: by the direction's sector, else along edges.
//!
//! Directions are sorted by where they leave a cube, each face of which is cut four by four. A sector is the cone of its four corners, so a
//! vertex that is not as far as some other one along all four is not the farthest along any direction in it. The few that remain are the
//! sector's candidates. Where they are too many to list, a climb along edges finds the vertex, and a look at all vertices proves it.

use super::magnitude;
use crate::number::real::{Real, Vector};

/// Which vertices of a hull share an edge, and which can be farthest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adjacency<'a> {
    offsets: &'a [u32],
    neighbours: &'a [u32],
    sectors: [Sector; SECTORS],
    /// Address and number of the vertices it was made for.
    vertices: (usize, usize),
}

/// What a sector can see of a hull.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Sector {
    /// The farthest vertex along the middle, then the other candidates; repeated up to a multiple of four.
    list: [u32; LISTED],
    /// How much of the list is in use; 0 if there were too many.
    count: u32,
}

/// Candidates of a sector that can be listed: a round hull of some hundred vertices has ten.
const LISTED: usize = 16;

/// Four times four on each face of the cube.
const SECTORS: usize = 6 * 16;

/// Rounding of a vertex along a corner of the cube, in units of ε times the largest coordinate: twice three terms of two roundings, and room.
const CORNER_ROUNDINGS: f64 = 16.0;

impl<'a> Adjacency<'a> {
    /// The neighbours of vertex `i` are `neighbours[offsets[i]..offsets[i + 1]]`; so `offsets` is one longer than `vertices`. Wrong or missing
    /// edges cost time, not truth. Looks at each vertex some hundred times.
    pub fn new<V: Vector>(vertices: &'a [V], offsets: &'a [u32], neighbours: &'a [u32]) -> Self {
        let extent = vertices.iter().fold(V::Scalar::ZERO, |m, &v| m.max(magnitude(v)));
        let room = V::Scalar::from_f64(CORNER_ROUNDINGS) * (extent + V::Scalar::MIN_POSITIVE) * V::Scalar::EPSILON;
        let mut sectors = [Sector { list: [0; LISTED], count: 0 }; SECTORS];
        for (i, sector) in sectors.iter_mut().enumerate() {
            *sector = Sector::new(vertices, i, room);
        }
        Adjacency { offsets, neighbours, sectors, vertices: identity(vertices) }
    }

    /// Whether it was made for these very vertices, which its lifetime keeps as they were.
    pub(super) fn belongs_to<V: Vector>(&self, vertices: &[V]) -> bool {
        self.vertices == identity(vertices)
    }

    /// All vertices that can be farthest along a direction, if they are few.
    #[inline(always)]
    pub(super) fn candidates<V: Vector>(&self, direction: V) -> Option<&[u32]> {
        let sector = self.sectors.get(sector(direction))?;
        let list = sector.list.get(..sector.count as usize)?;
        (!list.is_empty()).then_some(list)
    }

    /// A vertex that is far along a direction.
    #[inline(always)]
    pub(super) fn start<V: Vector>(&self, direction: V) -> u32 {
        self.sectors.get(sector(direction)).map_or(0, |sector| sector.list[0])
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
    /// `room` covers what rounding does to two vertices along a corner.
    fn new<V: Vector>(vertices: &[V], sector: usize, room: V::Scalar) -> Self {
        let (middle, corners) = cone::<V>(sector);
        let middle = super::hull::scan(vertices, middle);
        let mut found = Sector { list: [middle; LISTED], count: 0 };
        // The best along the corners first: they rule most others out.
        let best = corners.map(|corner| super::hull::scan(vertices, corner));
        let firsts = core::iter::once(middle).chain(best);
        for i in firsts.chain(0..vertices.len() as u32) {
            if found.offer(vertices, i, &corners, room).is_none() {
                found.count = 0;
                return found;
            }
        }
        found.count = found.count.next_multiple_of(4).min(LISTED as u32);
        found
    }

    /// Lists a vertex unless another one is farther, and drops those it is farther than itself; nothing if the list is full.
    fn offer<V: Vector>(&mut self, vertices: &[V], i: u32, corners: &[V; 4], room: V::Scalar) -> Option<()> {
        let at = |i: u32| vertices.get(i as usize).copied().unwrap_or(V::ZERO);
        let v = at(i);
        let reach = corners.map(|corner| v.dot(corner));
        let beyond = |p: [V::Scalar; 4], q: [V::Scalar; 4]| p.iter().zip(q).all(|(&p, q)| p > q + room);
        let listed = self.list.get(..self.count as usize)?;
        if listed.iter().any(|&j| at(j) == v || beyond(corners.map(|corner| at(j).dot(corner)), reach)) {
            return Some(());
        }
        let mut kept = 0;
        for n in 0..self.count as usize {
            let j = *self.list.get(n)?;
            if !beyond(reach, corners.map(|corner| at(j).dot(corner))) {
                *self.list.get_mut(kept)? = j;
                kept += 1;
            }
        }
        *self.list.get_mut(kept)? = i;
        // What is not in use repeats the first.
        let first = self.list[0];
        self.list.iter_mut().skip(kept + 1).for_each(|unused| *unused = first);
        self.count = kept as u32 + 1;
        Some(())
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
