//! Which triangles reach which layer of cells.

use crate::geometry::bodies::Bodies;
use glam::DVec3;
use voidage_core::grid::{Grid, Located};

/// Triangles sorted by layer, and by body within a layer.
#[derive(Debug)]
pub struct Bins<'a> {
    triangles: &'a [[DVec3; 3]],
    /// Per layer: the run of its groups.
    layers: Vec<std::ops::Range<usize>>,
    /// A body's triangles in a layer: body, first entry in `ids`, bounding box of those triangles.
    groups: Vec<Group>,
    ids: Vec<u32>,
}

/// A body's triangles in a layer.
#[derive(Debug, Clone)]
pub struct Group {
    /// The body.
    pub body: u32,
    ids: std::ops::Range<usize>,
    /// Lowest corner of those triangles.
    pub min: DVec3,
    /// Highest corner.
    pub max: DVec3,
    /// The body has no volume.
    pub sheet: bool,
}

impl<'a> Bins<'a> {
    /// Sort the triangles of the bodies that are `wanted`; `triangles` are those of `bodies`, or a copy with corners moved.
    #[must_use]
    pub fn new(
        grid: &Grid<f64>,
        bodies: &Bodies,
        triangles: &'a [[DVec3; 3]],
        wanted: impl Fn(usize) -> bool + Clone,
    ) -> Self {
        let all = bodies.bodies.iter().enumerate().filter(|(b, _)| wanted(*b));
        let runs = all.map(|(b, body)| (b as u32, body.triangles.clone()));
        let mut bins = Self::of(grid, triangles, runs.flat_map(|(b, run)| run.map(move |t| (b, t as u32))));
        bins.groups.iter_mut().for_each(|g| g.sheet = bodies.bodies[g.body as usize].sheet);
        bins
    }

    /// Sort some triangles, given as body and position, bodies in ascending order.
    pub fn of(
        grid: &Grid<f64>,
        triangles: &'a [[DVec3; 3]],
        members: impl Iterator<Item = (u32, u32)> + Clone,
    ) -> Self {
        let nz = grid.cells()[2];
        let span = |t: u32| layer_span(grid, &triangles[t as usize]);
        let mut first = vec![0_usize; nz + 1];
        for (_, t) in members.clone() {
            span(t).for_each(|k| first[k + 1] += 1);
        }
        for k in 0..nz {
            first[k + 1] += first[k];
        }
        let mut entries = vec![(0_u32, 0_u32); first[nz]];
        let mut next = first.clone();
        for (body, t) in members {
            for k in span(t) {
                entries[next[k]] = (body, t);
                next[k] += 1;
            }
        }
        let (mut groups, mut layers) = (Vec::new(), Vec::with_capacity(nz));
        for k in 0..nz {
            let begin = groups.len();
            let run = &entries[first[k]..first[k + 1]];
            let mut at = first[k];
            for same in run.chunk_by(|a, b| a.0 == b.0) {
                let corners = same.iter().flat_map(|&(_, t)| triangles[t as usize]);
                let (min, max) = corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), p| (a.min(p), b.max(p)));
                groups.push(Group { body: same[0].0, ids: at..at + same.len(), min, max, sheet: false });
                at += same.len();
            }
            layers.push(begin..groups.len());
        }
        Bins { triangles, layers, groups, ids: entries.into_iter().map(|(_, t)| t).collect() }
    }

    /// All triangles.
    #[must_use]
    pub fn triangles(&self) -> &'a [[DVec3; 3]] {
        self.triangles
    }

    /// The bodies that touch layer `k`, and which of their triangles do.
    pub fn layer(&self, k: usize) -> impl Iterator<Item = (u32, &[u32])> {
        self.groups(k).iter().map(|g| (g.body, self.ids(g)))
    }

    /// The bodies that touch layer `k`, with boxes.
    #[must_use]
    pub fn groups(&self, k: usize) -> &[Group] {
        &self.groups[self.layers[k].clone()]
    }

    /// The triangles of a group.
    #[must_use]
    pub fn ids(&self, group: &Group) -> &[u32] {
        &self.ids[group.ids.clone()]
    }
}

/// The layers whose closed slab a triangle touches; one beyond the grid's outer planes counts for none.
fn layer_span(grid: &Grid<f64>, triangle: &[DVec3; 3]) -> std::ops::Range<usize> {
    let [a, b, c] = triangle.map(|p| p.z);
    let (min, max) = (a.min(b).min(c), a.max(b).max(c));
    let edges = grid.edges(2);
    let last = edges.len() - 1;
    if !(min <= edges[last] && max >= edges[0]) {
        return 0..0;
    }
    let cell = |z| match grid.locate(2, z) {
        Located::Below => 0,
        Located::Cell(k) => k,
        Located::Above => last - 1,
    };
    let first = cell(min);
    // A corner on the plane below touches the layer below too.
    let first = if edges[first] == min { first.saturating_sub(1) } else { first };
    first..cell(max) + 1
}
