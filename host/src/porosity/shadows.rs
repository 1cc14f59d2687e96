//! Passages that no face of the grid sees blocked: shadows of the solids in every cell.

use super::cell_triangles::CellTriangles;
use super::fields::FieldSet;
use crate::geometry::bodies::Bodies;
use crate::geometry::facets;
use glam::DVec3;
use rayon::prelude::*;
use std::sync::{Mutex, PoisonError};
use voidage_core::grid::Grid;
use voidage_core::grid::fields::ShapeMismatch;
use voidage_core::surface::layer::{KnownSurface, LayerError, Layers, OpenLayer, ShadowReport};
use voidage_core::surface::shadow::{ShadowEdge, ShadowFace, ShadowMemory, ShadowSlices};

/// Shadows of the union of bodies in the cells of a grid, `nx*ny*nz`, x fastest.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Shadows {
    /// Along x, y and z, which share of the lines through the cell meets solid in it or a blocked side of it.
    pub tau: [Vec<f64>; 3],
    /// Where in the cell that surface stands, from its middle, −½ at the low side, ½ at the high one; along x, y and z. Zero where no more is blocked than a
    /// side of the cell shows.
    pub place: [Vec<f64>; 3],
    /// The cells that may block more than their faces show, by their numbers in the grid, in ascending order.
    pub(super) standing: Vec<usize>,
    /// By how much a share may be off where a curved solid stands as facets.
    pub doubt: f64,
    /// Cells whose shadow is an estimate, or that hold more surface than there is room for: then in its place stands what their faces show.
    pub inexact: ShadowReport,
    /// Hidden passages along x, y and z.
    pub hidden: [HiddenPassages; 3],
    /// What stands in the cells that hide something.
    pub(super) triangles: CellTriangles,
}

/// Cells that are blocked across an axis by more than [`HIDDEN`] of their section beyond what either of their two faces shows, both of which
/// are open.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct HiddenPassages {
    /// How many.
    pub cells: usize,
    /// The first, as i, j, k from 0.
    pub first: Option<[usize; 3]>,
}

/// Blockage of its section that makes a cell between two open faces a hidden passage.
pub const HIDDEN: f64 = 0.95;

/// How far the outline of facets may be from that of a curved solid, as a share of the narrowest cell that is not thin. A shadow in a cell may have two such
/// outlines.
const FACETS_MISS: f64 = 2.5e-4;

/// Of cells narrower than this share of the usual ones no notice is taken: one thin layer would have all solids made of thousands of facets, everywhere.
const THIN: f64 = 0.25;

/// A cell may be divided if along one axis it blocks this share of its section beyond what its faces show: a wall that divides it does.
pub(super) const LEAST_HIDDEN: f64 = 0.25;

/// How far the outline of facets may be from that of a curved solid on a grid, if so many facets may be.
pub(super) fn facets_miss(grid: &Grid<f64>) -> f64 {
    FACETS_MISS * narrowest(grid).max(THIN * usual_width(grid))
}

/// Of the middle ones of the widths along each axis the smallest.
fn usual_width(grid: &Grid<f64>) -> f64 {
    let middle = |axis: usize| {
        let mut widths: Vec<f64> = grid.edges(axis).windows(2).map(|ends| ends[1] - ends[0]).collect();
        let half = widths.len() / 2;
        *widths.select_nth_unstable_by(half, f64::total_cmp).1
    };
    middle(0).min(middle(1)).min(middle(2))
}

/// By how much shadows that are estimates may be off.
const ESTIMATE_MISSES: f64 = 1e-3;

/// By how much a share may be off in cells whose shadows are not exact.
fn doubt_of(inexact: ShadowReport) -> f64 {
    match inexact {
        ShadowReport { too_full: 1.., .. } => 1.0,
        ShadowReport { estimated: 1.., .. } => ESTIMATE_MISSES,
        _ => 0.0,
    }
}

/// The cells of both.
fn both(a: ShadowReport, b: ShadowReport) -> ShadowReport {
    ShadowReport { estimated: a.estimated + b.estimated, too_full: a.too_full + b.too_full }
}

/// Width of the narrowest cell along any axis.
fn narrowest(grid: &Grid<f64>) -> f64 {
    let widths = |axis: usize| grid.edges(axis).windows(2).map(|ends| ends[1] - ends[0]);
    (0..3).flat_map(widths).fold(f64::INFINITY, f64::min)
}

impl Shadows {
    /// Of bodies in layers, whose open fractions and surface are known.
    #[must_use]
    pub fn of_layers(
        grid: &Grid<f64>,
        (bodies, layers): (&Bodies, &Layers<DVec3>),
        beta: &FieldSet,
        known: &[KnownSurface<f64>],
    ) -> Self {
        let [nx, ny, nz] = grid.cells();
        let fields = || [0; 3].map(|_| vec![0.0; nx * ny * nz]);
        let (mut tau, mut place) = (fields(), fields());
        let mut slices: Vec<ShadowSlices<f64>> = Vec::with_capacity(nz);
        let [mut share_x, mut share_y, mut share_z] = tau.each_mut().map(|field| field.chunks_exact_mut(nx * ny));
        let [mut place_x, mut place_y, mut place_z] = place.each_mut().map(|field| field.chunks_exact_mut(nx * ny));
        while let (Some(x), Some(y), Some(z)) = (share_x.next(), share_y.next(), share_z.next()) {
            let place = [&mut place_x, &mut place_y, &mut place_z].map(|field| field.next().unwrap_or_default());
            slices.push(ShadowSlices { share: [x, y, z], place });
        }
        let buffers = Mutex::new(Vec::new());
        let layer = |(k, slices): (usize, ShadowSlices<f64>)| {
            let mut own = buffers.lock().unwrap_or_else(PoisonError::into_inner).pop().unwrap_or_else(Buffers::new);
            let inexact = own.layer(layers, k, (&beta.open_layer(grid, k), known[k]), slices);
            buffers.lock().unwrap_or_else(PoisonError::into_inner).push(own);
            inexact
        };
        let inexact = slices.into_par_iter().enumerate().map(layer).reduce(ShadowReport::default, both);
        let wanted = facets_miss(grid);
        let miss = bodies.bodies.iter().map(|body| facets::miss_of_body(body, wanted)).fold(0.0, f64::max);
        let doubt = (2.0 * miss / narrowest(grid) + doubt_of(inexact)).min(1.0);
        let kept: Vec<_> = known.iter().map(|(kept, _)| *kept).collect();
        let standing = kept.iter().enumerate().flat_map(|(k, kept)| {
            let with_front = kept.cells.iter().filter(|own| own.area.frontal != [0.0; 3]);
            with_front.map(move |own| k * nx * ny + own.cell as usize)
        });
        let standing = standing.collect();
        let mut found = Shadows { tau, place, standing, doubt, inexact, ..Shadows::default() };
        found.find_hidden(grid, beta);
        // What hides nearly all of a section is a wall.
        let hiding = found.hiding(grid, beta).into_iter().map(|(cell, hidden)| (cell, hidden <= HIDDEN));
        found.triangles = CellTriangles::of(bodies, &kept, nx * ny, hiding);
        found
    }

    /// Of nothing, in so many cells.
    pub(super) fn none(cells: usize) -> Self {
        let fields = || [0; 3].map(|_| vec![0.0; cells]);
        Shadows { tau: fields(), place: fields(), standing: (0..cells).collect(), ..Shadows::default() }
    }

    /// Adds other shadows, weighted. What stands in a cell stands where the heavier of both does.
    pub(super) fn add(&mut self, weight: f64, other: &Self) {
        for axis in 0..3 {
            let into = self.tau[axis].iter_mut().zip(&mut self.place[axis]);
            for ((tau, place), (&more, &there)) in into.zip(other.tau[axis].iter().zip(&other.place[axis])) {
                if there != 0.0 && (*place == 0.0 || weight * more > *tau) {
                    *place = there;
                }
                *tau += weight * more;
            }
        }
        let [a, b] = [self.inexact, other.inexact];
        let (estimated, too_full) = (a.estimated.max(b.estimated), a.too_full.max(b.too_full));
        self.inexact = ShadowReport { estimated, too_full };
        self.doubt = self.doubt.max(other.doubt);
    }

    /// Counts the hidden passages, now that the faces are known.
    pub(super) fn find_hidden(&mut self, grid: &Grid<f64>, beta: &FieldSet) {
        self.hidden = [0, 1, 2].map(|axis| self.hidden_along(grid, axis, beta));
    }

    /// The cells that hide [`LEAST_HIDDEN`] or more, and those around them in which something stands, without closed ones, in ascending order, with the largest
    /// share of its section that each hides along an axis.
    pub(super) fn hiding(&self, grid: &Grid<f64>, beta: &FieldSet) -> Vec<(usize, f64)> {
        let standing = self.standing.iter().filter(|n| beta.v[**n] > 0.0);
        let mut found: Vec<(usize, f64)> = standing.map(|&n| (n, self.largest_hidden(grid, beta, n))).collect();
        let enough: Vec<usize> = found.iter().filter(|(_, hidden)| *hidden >= LEAST_HIDDEN).map(|(n, _)| *n).collect();
        let mut is_near = vec![false; if enough.is_empty() { 0 } else { grid.cell_count() }];
        enough.into_iter().flat_map(|n| around(grid, n)).flatten().for_each(|n| is_near[n] = true);
        found.retain(|(n, _)| is_near.get(*n) == Some(&true));
        found
    }

    fn hidden_along(&self, grid: &Grid<f64>, axis: usize, beta: &FieldSet) -> HiddenPassages {
        let tau = &self.tau[axis];
        let mut found = HiddenPassages::default();
        for &n in self.standing.iter().filter(|n| tau[**n] > HIDDEN) {
            // A closed face shows all there can be.
            if hidden_share(grid, axis, tau[n], beta, n) > HIDDEN {
                found.cells += 1;
                found.first = found.first.or_else(|| Some(place_of_cell(grid, n)));
            }
        }
        found
    }

    /// The largest share of its section that the n-th cell blocks along an axis beyond what its faces show.
    pub(super) fn largest_hidden(&self, grid: &Grid<f64>, beta: &FieldSet, n: usize) -> f64 {
        let along = |axis: usize| hidden_share(grid, axis, self.tau[axis][n], beta, n);
        along(0).max(along(1)).max(along(2))
    }
}

/// A cell and those around it, x fastest; none beyond the grid.
pub fn around(grid: &Grid<f64>, n: usize) -> [Option<usize>; 27] {
    let ([i, j, k], [nx, ny, nz]) = (place_of_cell(grid, n), grid.cells());
    std::array::from_fn(|place| {
        let (i, j, k) = (i + place % 3, j + place / 3 % 3, k + place / 9);
        let is_inside = (1..=nx).contains(&i) && (1..=ny).contains(&j) && (1..=nz).contains(&k);
        is_inside.then(|| ((k - 1) * ny + (j - 1)) * nx + (i - 1))
    })
}

/// Positions of the low and the high face of a cell along an axis.
pub fn faces_of_cell(grid: &Grid<f64>, axis: usize, [i, j, k]: [usize; 3]) -> [usize; 2] {
    let [nx, ny, _] = grid.face_shape(axis);
    let low = (k * ny + j) * nx + i;
    [low, low + [1, nx, nx * ny][axis]]
}

/// The same of the n-th cell.
pub(super) fn faces_of_nth_cell(grid: &Grid<f64>, axis: usize, n: usize) -> [usize; 2] {
    let [nx, ny, _] = grid.cells();
    match axis {
        0 => [n + n / nx, n + n / nx + 1],
        1 => [n + n / (nx * ny) * nx, n + n / (nx * ny) * nx + nx],
        _ => [n, n + nx * ny],
    }
}

/// All cells of a grid, x fastest.
pub fn cells(grid: &Grid<f64>) -> impl Iterator<Item = [usize; 3]> {
    let [nx, ny, nz] = grid.cells();
    (0..nz).flat_map(move |k| (0..ny).flat_map(move |j| (0..nx).map(move |i| [i, j, k])))
}

/// Where the n-th of them is.
#[must_use]
pub fn place_of_cell(grid: &Grid<f64>, n: usize) -> [usize; 3] {
    let [nx, ny, _] = grid.cells();
    [n % nx, n / nx % ny, n / (nx * ny)]
}

/// The share of its section that the n-th cell, of shadow `tau`, blocks along an axis beyond what either of its two faces shows.
fn hidden_share(grid: &Grid<f64>, axis: usize, tau: f64, beta: &FieldSet, n: usize) -> f64 {
    let ([low, high], faces) = (faces_of_nth_cell(grid, axis, n), beta.faces(axis));
    tau - (1.0 - faces[low].min(faces[high]))
}

/// Faces that a cell may hold at first, and at most; so many edges, too, seen along one axis. Curved solids are thousands of facets.
const FACES: usize = 1 << 12;
const MOST_FACES: usize = 1 << 18;

/// A thread's memory.
struct Buffers {
    edges: Vec<ShadowEdge<f64>>,
    places: Vec<u32>,
    lists: Vec<u32>,
    faces: Vec<ShadowFace<f64>>,
}

impl Buffers {
    fn new() -> Self {
        let mut new = Buffers { edges: Vec::new(), places: Vec::new(), lists: Vec::new(), faces: Vec::new() };
        new.make_room(FACES);
        new
    }

    /// Room for so many faces in a cell.
    fn make_room(&mut self, faces: usize) {
        self.edges.resize(3 * faces, ShadowEdge::default());
        self.places.resize(2 * faces, 0);
        self.faces.resize(faces, ShadowFace::default());
    }

    /// The shadows of layer `k`; how many of its cells have none that is exact.
    fn layer(
        &mut self,
        layers: &Layers<DVec3>,
        k: usize,
        (open, known): (&OpenLayer<f64>, KnownSurface<f64>),
        mut into: ShadowSlices<f64>,
    ) -> ShadowReport {
        loop {
            let Buffers { edges, places, lists, faces } = self;
            let memory = ShadowMemory { edges, places, lists, faces };
            match layers.shadows(k, open, known, into.reborrow(), memory) {
                Err(LayerError::Shape(ShapeMismatch { expected, found })) if found == self.lists.len() => {
                    self.lists.resize(expected.max(2 * found), 0);
                }
                // The layer again, with more room: what it holds does not depend on what thread had it.
                Ok(ShadowReport { too_full: 1.., .. }) if self.faces.len() < MOST_FACES => {
                    self.make_room(4 * self.faces.len());
                }
                inexact => return inexact.expect("slices of a layer fit its grid"),
            }
        }
    }
}
