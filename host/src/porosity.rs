//! Porosity fields of bodies on a grid: the layers of [`voidage_core`] in threads, unions where bodies share cells.
//!
//! A layer of cells depends on no other, and what a thread writes depends only on the layer: the bits are the same for
//! any number of threads.

mod bins;
pub mod convex;
mod fields;
mod layers;
mod levels;
pub mod snap;
mod unions;

use crate::geometry::bodies::Bodies;
pub use crate::huge::HugeVec;
use bins::Bins;
use convex::Roads;
pub use fields::FieldSet;
use glam::DVec3;
use layers::{Summary, Target, Worker};
pub use levels::levels;
use rayon::prelude::*;
use serde::Serialize;
use voidage_core::grid::Grid;
use voidage_core::subdivide;

/// How volumes are found.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Method {
    /// The cheapest for every body: sums over its surface, if it has triangles, else subdivision.
    #[default]
    Auto,
    /// Sums over the surface: exact for any closed surface of triangles
    Surface,
    /// Subdivision by GJK, as in the paper: bounds; by leaf plane for convex bodies, by the others for any that close
    Gjk,
}

/// What becomes of the smallest parts of a cell that a body still cuts.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Leaf {
    /// Touched counts as solid: the paper's rule, which finds too much
    Solid,
    /// Touched counts half
    Half,
    /// Bounded by planes and points: certified, of second order
    #[default]
    Plane,
}

impl Leaf {
    /// How deep a subdivision goes unless another depth is asked for: the paper's, or far enough for the default tolerance.
    #[must_use]
    pub fn depth(self) -> u32 {
        if self == Leaf::Plane { 6 } else { 3 }
    }
}

impl From<Leaf> for subdivide::Leaf {
    fn from(leaf: Leaf) -> Self {
        match leaf {
            Leaf::Solid => subdivide::Leaf::Solid,
            Leaf::Half => subdivide::Leaf::Half,
            Leaf::Plane => subdivide::Leaf::Plane,
        }
    }
}

/// What to compute and how far to refine.
#[derive(Debug, Clone, Copy)]
pub struct Options {
    /// Unions are found exactly; where one has no proof, divide the cell until its bounds are this close.
    pub tol: f64,
    /// How often a cell whose union has no proof may be divided by 2 along each axis.
    pub depth: u32,
    /// Keep lower and upper bounds of all fields.
    pub bounds: bool,
    /// Compute the faces; without, their fields stay empty.
    pub areas: bool,
    /// How volumes are found.
    pub method: Method,
    /// What ends a subdivision by GJK.
    pub leaf: Leaf,
}

impl Options {
    /// Where between its bounds a value lies: in the middle; by the paper's rule at the solid end.
    fn solid_end(&self) -> f64 {
        if self.leaf == Leaf::Solid { 1.0 } else { 0.5 }
    }
}

impl Default for Options {
    fn default() -> Self {
        Options { tol: 1e-4, depth: 6, bounds: false, areas: true, method: Method::Auto, leaf: Leaf::Plane }
    }
}

/// Cells by kind.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct CellCounts {
    /// No solid.
    pub open: usize,
    /// Partly solid, or with surface inside.
    pub cut: usize,
    /// All solid.
    pub closed: usize,
    /// Of the cut cells: shared by several bodies, so that their union had to be found.
    pub ambiguous: usize,
}

/// How often GJK was asked.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Gjk {
    /// Queries.
    pub queries: u64,
    /// Of these, without an answer: work, not error.
    pub undecided: u64,
}

/// Where a body's surface fails to close.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Leak {
    /// The body.
    pub body: usize,
    /// How far the worst row ends from zero, as a fraction of a face.
    pub fraction: f64,
    /// Its layer of cells.
    pub layer: usize,
}

/// Porosities of a grid.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Porosity {
    /// Open fractions: 1 open, 0 blocked.
    pub beta: FieldSet,
    /// Lower and upper bounds of the same, if asked for.
    pub bounds: Option<[FieldSet; 2]>,
    /// Cells by kind.
    pub cells: CellCounts,
    /// Solid volume within the grid.
    pub solid_volume: f64,
    /// Largest distance of the bounds of any cell or face.
    pub max_gap: f64,
    /// Cells divided because their union had no proof at once.
    pub divided: usize,
    /// By how much a body's own share of a cell left 0..1: surface that crosses itself.
    pub winding: f64,
    /// Sheets that block nothing, for they lie in no plane of the grid.
    pub sheets_off_planes: snap::OffPlanes,
    /// Bodies that went by subdivision, of all.
    pub subdivided: usize,
    /// Queries of GJK.
    pub gjk: Gjk,
    /// Bodies whose rows did not return to zero, worst first, one entry a body.
    pub leaks: Vec<Leak>,
}

/// Bytes that the fields of a grid take, with what one thread needs beside them.
#[must_use]
pub fn memory(grid: &Grid<f64>, bodies: &Bodies, options: Options) -> usize {
    let faces = if options.areas { [0, 1, 2].map(|a| grid.face_shape(a).iter().product()).iter().sum() } else { 0 };
    // Of several levels, one joins the others, and one is remembered for the next.
    let sets = if options.bounds { 3 } else { 1 } * levels(bodies).len().min(3);
    size_of::<f64>().saturating_mul(sets * (grid.cell_count() + faces) + Worker::needed(grid))
}

/// Porosities of `bodies` on `grid`; runs in the current rayon pool.
#[must_use]
pub fn porosity(grid: &Grid<f64>, bodies: &Bodies, options: Options) -> Porosity {
    porosity_watched(grid, bodies, options, &|| ())
}

/// As [`porosity`]; `layer_done` is called after each layer of cells, from any thread, once for each of the [`levels`].
#[must_use]
pub fn porosity_watched(
    grid: &Grid<f64>,
    bodies: &Bodies,
    options: Options,
    layer_done: &(dyn Fn() + Sync),
) -> Porosity {
    let moved = snap::into_planes(grid, bodies);
    let triangles = moved.as_deref().unwrap_or(&bodies.triangles);
    let levels = levels(bodies);
    let roads = Roads::choose(bodies, triangles, options);
    let mut last: Option<Union> = None;
    let unions = levels.iter().map(|&level| {
        let found = union(grid, bodies, triangles, &roads, level, last.as_ref(), options, layer_done);
        last = (levels.last() != Some(&level)).then(|| found.clone());
        found.porosity
    });
    let joined = levels::join(&levels, unions);
    Porosity { sheets_off_planes: snap::sheets_off_planes(grid, bodies, triangles), ..joined }
}

/// Porosities of the union up to a level, and the totals of its layers.
#[derive(Clone)]
struct Union {
    level: f64,
    porosity: Porosity,
    layers: Vec<Summary>,
}

impl Union {
    /// May bodies above this level, up to another, change a layer? Bodies in the layers beside it count as well: they may touch.
    fn may_change(&self, grid: &Grid<f64>, bodies: &Bodies, level: f64, k: usize) -> bool {
        let edges = grid.edges(2);
        let (below, above) = (edges[k.saturating_sub(1)], edges[(k + 2).min(edges.len() - 1)]);
        let mut added = bodies.bodies.iter().filter(|b| b.porosity > self.level && b.porosity <= level);
        added.any(|b| b.bounds[0].z <= above && b.bounds[1].z >= below)
    }

    fn copy_layer(&self, k: usize, target: &mut Target) -> Summary {
        self.porosity.beta.copy_layer(k, &mut target.beta);
        for (from, into) in self.porosity.bounds.iter().flatten().zip(target.bounds.iter_mut().flatten()) {
            from.copy_layer(k, into);
        }
        self.layers[k].copied()
    }
}

/// Porosities of the union of all bodies up to a level, as if they were solid; `last` is that up to the level before.
fn union(
    grid: &Grid<f64>,
    bodies: &Bodies,
    triangles: &[[DVec3; 3]],
    roads: &Roads,
    level: f64,
    last: Option<&Union>,
    options: Options,
    layer_done: &(dyn Fn() + Sync),
) -> Union {
    let counts = |body: usize| bodies.bodies[body].porosity <= level;
    let convex = roads.road(triangles, options, counts);
    let bins = Bins::new(grid, bodies, triangles, |body| counts(body) && roads.by_surface(body));
    let mut beta = FieldSet::new(grid, options.areas);
    let mut bounds = options.bounds.then(|| [FieldSet::new(grid, options.areas), FieldSet::new(grid, options.areas)]);
    let summaries: Vec<Summary> = targets(grid, &mut beta, bounds.as_mut())
        .into_par_iter()
        .enumerate()
        .map_init(
            || Worker::new(grid, options),
            |worker, (k, mut target)| {
                let same = last.filter(|last| !last.may_change(grid, bodies, level, k));
                let summary = match same {
                    Some(last) => last.copy_layer(k, &mut target),
                    None => worker.layer(grid, &bins, &convex, k, target),
                };
                layer_done();
                summary
            },
        )
        .collect();
    let total = summaries.iter().fold(Summary::default(), Summary::join);
    let porosity = Porosity {
        beta,
        bounds,
        cells: total.cells,
        solid_volume: total.volume,
        max_gap: total.max_gap,
        divided: total.divided,
        winding: total.winding,
        sheets_off_planes: snap::OffPlanes::default(),
        subdivided: roads.subdivided(),
        gjk: Gjk { queries: total.tally.queries, undecided: total.tally.undecided },
        leaks: worst_leaks(bodies.bodies.len(), &summaries),
    };
    Union { level, porosity, layers: summaries }
}

/// Where each layer writes.
fn targets<'a>(grid: &Grid<f64>, beta: &'a mut FieldSet, bounds: Option<&'a mut [FieldSet; 2]>) -> Vec<Target<'a>> {
    let beta = beta.layers(grid);
    match bounds {
        None => beta.into_iter().map(|beta| Target { beta, bounds: None }).collect(),
        Some([low, high]) => {
            let bounds = low.layers(grid).into_iter().zip(high.layers(grid));
            beta.into_iter().zip(bounds).map(|(beta, (l, h))| Target { beta, bounds: Some([l, h]) }).collect()
        }
    }
}

fn worst_leaks(bodies: usize, summaries: &[Summary]) -> Vec<Leak> {
    let mut worst: Vec<Option<Leak>> = vec![None; bodies];
    for (layer, summary) in summaries.iter().enumerate() {
        for &(body, fraction) in &summary.leaks {
            let body = body as usize;
            if worst[body].is_none_or(|l| l.fraction < fraction) {
                worst[body] = Some(Leak { body, fraction, layer });
            }
        }
    }
    let mut leaks: Vec<Leak> = worst.into_iter().flatten().collect();
    leaks.sort_by(|a, b| b.fraction.total_cmp(&a.fraction).then(a.body.cmp(&b.body)));
    leaks
}
