//! Porosity fields of bodies on a grid: the layers of [`voidage_core`] in threads, unions where bodies share cells.
//!
//! A layer of cells depends on no other, and what a thread writes depends only on the layer: the bits are the same for
//! any number of threads.
//!
//! In reading order: `options`, `result`, `fields`; `snap`, `local`, corners in planes and far origins; [`convex`], `formulas`, `road`, how each body
//! is measured; `targets`, `worker`, the core's layers in a thread's memory; `levels`, `windows`, `doubt`, porous and doubtful bodies; `solid_layers`, `curved_cells`, `surface_layers`,
//! `patch`, `cell_triangles`, [`surface_fields`], [`shadows`], the surface in cells; `solid`, [`resistance`], [`drag`], [`rod`], [`congestion`], [`throat`], [`divided`], what follows from it.

mod cell_triangles;
pub mod congestion;
pub mod convex;
mod curved_cells;
pub mod divided;
mod doubt;
pub mod drag;
mod fields;
mod formulas;
mod levels;
mod local;
mod options;
mod patch;
pub mod resistance;
mod result;
mod road;
pub mod rod;
pub mod shadows;
pub mod snap;
mod solid;
mod solid_layers;
pub mod surface_fields;
mod surface_layers;
mod targets;
pub mod throat;
mod windows;
mod worker;

use crate::geometry::bodies::{self, Bodies, Doubt};
pub use crate::huge::HugeVec;
pub use fields::FieldSet;
use glam::DVec3;
use levels::RunningSum;
pub use levels::levels;
pub use options::{Leaf, Method, Options};
use rayon::prelude::*;
pub use result::{CellCounts, Gjk, Leak, Porosity};
use road::{Road, Roads};
use std::sync::Arc;
use surface_layers::finish;
use targets::targets;
use voidage_core::grid::Grid;
use voidage_core::surface::bins::{Group, Surface};
use voidage_core::surface::error::is_computable;
use voidage_core::surface::layer::Layers;
use windows::{batches, windows};
use worker::{Summary, Target, WantedOfLayer, Workers};

/// Bytes that the fields of a grid take, with the lists of triangles by layer and what one thread needs beside them.
#[must_use]
pub fn memory(grid: &Grid<f64>, bodies: &Bodies, options: Options) -> usize {
    let faces = if options.areas { [0, 1, 2].map(|a| grid.face_shape(a).iter().product()).iter().sum() } else { 0 };
    // Of several levels, there are the sum, the union that stands and that of all; and each place has a number of half the size.
    let several = levels(bodies) != [0.0];
    let sets = if options.bounds { 3 } else { 1 } * if several { 3 } else { 1 } + usize::from(several);
    // Tall triangles are listed in every layer that they reach.
    let (surfaces, _) = surfaces(bodies, |_, body| &bodies.triangles[body.triangles.clone()]);
    let lists = Layers::needed(grid, &surfaces);
    let listed = size_of::<u32>() * lists.numbers + size_of::<Group<DVec3>>() * lists.groups;
    size_of::<f64>().saturating_mul(sets * (grid.cell_count() + faces)) + worker::memory_of_a_thread(grid) + listed
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
    let Some(sure) = doubt::without_perhaps(bodies) else { return measured(grid, bodies, options, layer_done) };
    let bounded = Options { bounds: true, resistance: false, ..options };
    let mut found = measured(grid, bodies, bounded, layer_done);
    doubt::open_upwards(&mut found, measured(grid, &sure, bounded, &|| ()));
    found.bounds = found.bounds.filter(|_| options.bounds);
    found
}

/// Porosities of bodies, all of them solid.
fn measured(grid: &Grid<f64>, bodies: &Bodies, options: Options, layer_done: &(dyn Fn() + Sync)) -> Porosity {
    let moved = snap::into_planes(grid, bodies);
    let triangles = moved.as_deref().unwrap_or(&bodies.triangles);
    let sheets_off_planes = snap::sheets_off_planes(grid, bodies, triangles);
    let found = match local::from_corner(grid, bodies, triangles) {
        Some((edges, seen)) => {
            let near = edges.grid(None).expect("edges apart stay apart");
            in_frame(&near, &seen, &seen.triangles, options, layer_done)
        }
        None => in_frame(grid, bodies, triangles, options, layer_done),
    };
    Porosity { sheets_off_planes, ..found }
}

/// Porosities of bodies with corners in the planes of the grid.
fn in_frame(
    grid: &Grid<f64>,
    bodies: &Bodies,
    triangles: &[[DVec3; 3]],
    options: Options,
    layer_done: &(dyn Fn() + Sync),
) -> Porosity {
    let roads = Roads::choose(grid, bodies, triangles, options);
    let boxes = bodies.bodies.iter().map(|body| snap::reach(grid, body)).collect();
    let mut joined = joined(&Scene { grid, bodies, boxes, triangles, roads, options }, &levels(bodies), layer_done);
    doubt::allow_for_rounding(grid, bodies, options, &mut joined);
    doubt::widen_unknown(grid, bodies, options, &mut joined);
    doubt::widen(grid, bodies, options, &mut joined);
    joined
}

/// What all unions have in common: the bodies, their triangles as they are measured, and how each body is measured.
struct Scene<'a> {
    grid: &'a Grid<'a, f64>,
    bodies: &'a Bodies,
    /// Around each body.
    boxes: Vec<[DVec3; 2]>,
    triangles: &'a [[DVec3; 3]],
    roads: Roads,
    options: Options,
}

/// Porosities of solids of some levels: the unions up to the first and up to the last on the whole grid, those between where they change anything.
fn joined(scene: &Scene, levels: &[f64], layer_done: &(dyn Fn() + Sync)) -> Porosity {
    let grid = scene.grid;
    let whole = |level| Extent { grid: *grid, level, near: None };
    let mut union = union(scene, &whole(levels[0]), None, layer_done);
    if levels == [0.0] {
        return union.porosity;
    }
    let mut sum = RunningSum::new(grid, levels, &union.porosity);
    let between = 1..levels.len().max(2) - 1;
    let tasks: Vec<_> =
        between.clone().flat_map(|k| windows(grid, scene.bodies, levels[k]).into_iter().map(move |w| (k, w))).collect();
    for batch in batches(grid, &tasks) {
        let found = batch.par_iter().map(|(k, window)| {
            let larger = window.with_margin(grid);
            let (inner, outer) = (window.bounds(grid), larger.bounds(grid));
            let near = [0, 1].map(|n| inner[n].lerp(outer[n], BESIDE));
            let extent = Extent { grid: larger.grid(grid), level: levels[*k], near: Some(near) };
            (*k, window, larger, self::union(scene, &extent, None, &|| ()).porosity)
        });
        for (k, window, larger, found) in found.collect::<Vec<_>>() {
            sum.replace(&mut union.porosity, k, [window, &larger], &found);
            union.porosity.add_work(&found);
        }
    }
    between.flat_map(|_| 0..grid.cells()[2]).for_each(|_| layer_done());
    let last = levels[1..].last().map(|&last| self::union(scene, &whole(last), Some(&union), layer_done).porosity);
    let mut total = sum.finish(&union.porosity, last.as_ref().unwrap_or(&union.porosity));
    [Some(&union.porosity), last.as_ref()].into_iter().flatten().for_each(|union| total.add_work(union));
    total
}

/// What ends so near a window, in cells, may lie in the planes that bound it.
const BESIDE: f64 = 1.0 / 64.0;

/// A part of the grid, or all of it, and up to which porosity solids count there.
struct Extent<'a> {
    grid: Grid<'a, f64>,
    level: f64,
    /// Bodies that do not touch this box do not count; none for the whole grid.
    near: Option<[DVec3; 2]>,
}

impl Extent<'_> {
    fn counts(&self, scene: &Scene, body: usize) -> bool {
        let [low, high] = scene.boxes[body];
        let touches = |[lo, hi]: [DVec3; 2]| low.cmple(hi).all() && high.cmpge(lo).all();
        scene.bodies.bodies[body].porosity <= self.level && self.near.is_none_or(touches)
    }
}

/// Porosities of the union up to a level, and the totals of its layers.
struct Union {
    level: f64,
    porosity: Porosity,
    layers: Vec<Summary>,
}

impl Union {
    /// May bodies above this level, up to another, change a layer? Bodies in the layers beside it count as well: they may touch.
    fn may_change(&self, scene: &Scene, level: f64, k: usize) -> bool {
        let edges = scene.grid.edges(2);
        let (below, above) = (edges[k.saturating_sub(1)], edges[(k + 2).min(edges.len() - 1)]);
        let bodies = scene.bodies.bodies.iter().zip(&scene.boxes);
        let mut added = bodies.filter(|(body, _)| body.porosity > self.level && body.porosity <= level);
        added.any(|(_, [lo, hi])| lo.z <= above && hi.z >= below)
    }

    fn copy_layer(&self, k: usize, target: &mut Target) -> Summary {
        self.porosity.beta.copy_layer(k, &mut target.beta);
        for (from, into) in self.porosity.bounds.iter().flatten().zip(target.bounds.iter_mut().flatten()) {
            from.copy_layer(k, into);
        }
        self.layers[k].copied()
    }
}

/// Porosities of the union of all bodies up to a level, as if they were solid; `last` is that of fewer bodies.
fn union(scene: &Scene, extent: &Extent, last: Option<&Union>, layer_done: &(dyn Fn() + Sync)) -> Union {
    let Scene { bodies, triangles, roads, options, .. } = scene;
    let Extent { grid, level, .. } = extent;
    let counts = |body: usize| extent.counts(scene, body);
    let convex = roads.road(triangles, *options, counts);
    let (surfaces, broken) = surfaces(bodies, |number, body| {
        let by_surface = counts(number) && roads.by_surface(number);
        if by_surface { &triangles[body.triangles.clone()] } else { &[] }
    });
    let needed = Layers::needed(grid, &surfaces);
    let (mut numbers, mut groups) = (vec![0; needed.numbers], vec![Group::default(); needed.groups]);
    let layers = Layers::new(grid, &surfaces, (*options).into(), &mut numbers, &mut groups).expect("memory as needed");
    let workers = Workers::new();
    let mut beta = FieldSet::new(grid, options.areas);
    let mut bounds = options.bounds.then(|| [FieldSet::new(grid, options.areas), FieldSet::new(grid, options.areas)]);
    let with_surface = with_surface(scene, &convex);
    let wanted = if with_surface { WantedOfLayer::FractionsAndSurface } else { WantedOfLayer::Fractions };
    let same = |k: usize| last.filter(|last| !last.may_change(scene, *level, k));
    let mut summaries: Vec<Summary> = targets(grid, &mut beta, bounds.as_mut(), wanted)
        .into_par_iter()
        .enumerate()
        .map(|(k, mut target)| {
            let summary = match same(k) {
                Some(last) => last.copy_layer(k, &mut target),
                None => workers.layer(grid, &layers, &convex, k, target),
            };
            layer_done();
            summary
        })
        .collect();
    if let Some(first) = summaries.first_mut() {
        first.leaks.extend(broken.into_iter().map(|body| (body, f64::INFINITY)));
    }
    let mut total = summaries.iter().fold(Summary::default(), Summary::join);
    // What was copied from fewer bodies is as wide as it was there.
    let measured = summaries.iter().enumerate().filter(|(k, _)| same(*k).is_none());
    let leaks = measured.flat_map(|(k, s)| s.leaks.iter().map(move |&(body, fraction)| (body, k, fraction)));
    let apart = doubt::widen_leaking(grid, bodies, options.areas, leaks, &mut bounds);
    total.max_gap = (total.max_gap + apart).min(1.0);
    let surface = with_surface.then(|| Arc::new(finish(grid, (bodies, &layers), &beta, &mut summaries)));
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
        by_formula: roads.by_formula(),
        gjk: Gjk { queries: total.tally.queries, undecided: total.tally.undecided },
        leaks: worst_leaks(bodies.bodies.len(), &summaries),
        surface,
    };
    Union { level: *level, porosity, layers: summaries }
}

/// Are areas and shadows of surface asked for, and those of the bodies whose porosity is found? Bodies by formula have them as facets, and those
/// of which nothing is known have none.
fn with_surface(scene: &Scene, beside: &Road) -> bool {
    let Scene { bodies, options, .. } = scene;
    let all_known = bodies.bodies.iter().all(|b| b.doubt == Doubt::None);
    options.resistance && options.areas && beside.is_empty() && all_known && levels(bodies) == [0.0]
}

/// The surfaces of all bodies, made of the triangles that `own` gives for a body's number, and which of them are broken: those with a
/// coordinate that is no number, which some scale or turn has made too large: of these nothing can be said.
fn surfaces<'a>(
    bodies: &Bodies,
    own: impl Fn(usize, &bodies::Body) -> &'a [[DVec3; 3]],
) -> (Vec<Surface<'a, DVec3>>, Vec<usize>) {
    let mut broken = Vec::new();
    let surface = |(number, body): (usize, &bodies::Body)| {
        let mut own = own(number, body);
        if !own.iter().flatten().all(|&p| is_computable(p)) {
            broken.push(number);
            own = &[];
        }
        if body.sheet { Surface::sheet(own) } else { Surface::new(own) }
    };
    (bodies.bodies.iter().enumerate().map(surface).collect(), broken)
}

fn worst_leaks(bodies: usize, summaries: &[Summary]) -> Vec<Leak> {
    let mut worst: Vec<Option<Leak>> = vec![None; bodies];
    for (layer, summary) in summaries.iter().enumerate() {
        for &(body, fraction) in &summary.leaks {
            if worst[body].is_none_or(|l| l.fraction < fraction) {
                worst[body] = Some(Leak { body, fraction, layer });
            }
        }
    }
    let mut leaks: Vec<Leak> = worst.into_iter().flatten().collect();
    leaks.sort_by(|a, b| b.fraction.total_cmp(&a.fraction).then(a.body.cmp(&b.body)));
    leaks
}
