//! The road of subdivision by GJK, layer by layer.
//!
//! Bodies known by formula, those of triangles that are certified to be convex, and, by the paper's leaves, other closed surfaces triangle
//! by triangle. Their union enters a layer as one interval a cell and face, beside what the surfaces of other bodies give.

use super::{Leaf, Method, Options};
use crate::geometry::bodies::{Bodies, Body, Doubt};
use crate::geometry::form::Form;
use glam::DVec3;
use rustc_hash::FxHashMap as HashMap;
use std::ops;
use voidage_core::convex::polytope::{Facet, Polytope, facets};
use voidage_core::convex::shape::{Capsule, Cone, Cylinder, Ellipsoid, Hull, Sphere};
use voidage_core::convex::support::Transformed;
use voidage_core::grid::Grid;
use voidage_core::grid::cell_range::{CellRange, RangeKind};
use voidage_core::grid::fields::Layer;
use voidage_core::number::aabb::Aabb;
use voidage_core::subdivide::{
    self, ActiveFacets, Bounds, Candidate, ClosedSurface, Columns, LocalPlanes, Occupancy, QueryCount, Subdividable,
    SubdivisionMemory, SubdivisionRule, WarmStart, share, slab_margin, subdivide,
};
use voidage_core::surface::OtherBodies;

/// A body in its place, convex but for the last kind.
#[derive(Debug, Clone, Copy)]
pub enum Convex<'a> {
    /// A ball.
    Sphere(Sphere<DVec3>),
    /// An ellipsoid, turned and moved.
    Ellipsoid(Transformed<Ellipsoid<DVec3>>),
    /// A cylinder with flat ends.
    Cylinder(Cylinder<DVec3>),
    /// A segment with a radius.
    Capsule(Capsule<DVec3>),
    /// A cone with a flat base.
    Cone(Cone<DVec3>),
    /// A hull and its facets.
    Polytope(Polytope<'a, DVec3>),
    /// A closed surface.
    Mesh(ClosedSurface<'a, DVec3>),
}

/// The same expression for the shape of any kind.
macro_rules! of_shape {
    ($body:expr, $shape:ident => $value:expr) => {
        match $body {
            Convex::Sphere($shape) => $value,
            Convex::Ellipsoid($shape) => $value,
            Convex::Cylinder($shape) => $value,
            Convex::Capsule($shape) => $value,
            Convex::Cone($shape) => $value,
            Convex::Polytope($shape) => $value,
            Convex::Mesh($shape) => $value,
        }
    };
}

impl Subdividable for Convex<'_> {
    type Vector = DVec3;
    fn bounds(&self) -> Aabb<DVec3> {
        of_shape!(self, s => Subdividable::bounds(s))
    }
    fn facet_count(&self) -> usize {
        of_shape!(self, s => Subdividable::facet_count(s))
    }
    fn occupancy(
        &self,
        cell: &Aabb<DVec3>,
        near: &[u32],
        active: &mut ActiveFacets,
        warm: &mut WarmStart<DVec3>,
        count: &mut QueryCount,
    ) -> Occupancy {
        of_shape!(self, s => s.occupancy(cell, near, active, warm, count))
    }
    fn local_planes(&self, cell: &Aabb<DVec3>, near: &[u32]) -> Option<LocalPlanes<f64>> {
        of_shape!(self, s => s.local_planes(cell, near))
    }
    fn share_bounds(&self, cell: &Aabb<DVec3>, near: &[u32], columns: &Columns<f64>) -> Bounds<f64> {
        of_shape!(self, s => s.share_bounds(cell, near, columns))
    }
}

/// Vertices and facets of bodies made of triangles.
#[derive(Debug, Default)]
struct Faceted {
    vertices: Vec<DVec3>,
    facets: Vec<Facet<DVec3>>,
}

/// Which body takes which road, and the memory of those that take this one.
#[derive(Debug, Default)]
pub struct Roads {
    /// One entry a body: by formula or facets, or by its surface.
    convex: Vec<Option<Known>>,
}

#[derive(Debug)]
enum Known {
    Round(Convex<'static>),
    Faceted(Faceted),
    /// A run of triangles.
    Closed(ops::Range<usize>),
}

/// Bodies with more triangles than this stay with their surface: the certificate takes time in proportion to the square.
const MOST_FACETS: usize = 20_000;

impl Roads {
    /// Choose for every body; `triangles` are those of `bodies`, or a copy with corners moved.
    #[must_use]
    pub fn choose(bodies: &Bodies, triangles: &[[DVec3; 3]], options: Options) -> Self {
        let known = |body: &Body| match (&body.form, options.method) {
            _ if body.doubt != Doubt::None => None,
            // Planes are measured by their surface: exact, and cheaper than any subdivision.
            (_, Method::Auto | Method::Surface) if !body.triangles.is_empty() => None,
            (_, Method::Surface) => None,
            (Some(form), _) if body.triangles.is_empty() => round(form).map(Known::Round),
            (_, Method::Auto | Method::Gjk) => {
                let own = &triangles[body.triangles.clone()];
                let closed = || options.leaf != Leaf::Plane && !body.sheet && is_closed(own);
                faceted(body, own)
                    .map(Known::Faceted)
                    .or_else(|| closed().then(|| Known::Closed(body.triangles.clone())))
            }
        };
        use rayon::prelude::*;
        Roads { convex: bodies.bodies.par_iter().map(known).collect() }
    }

    /// Does a body go by its surface?
    #[must_use]
    pub fn by_surface(&self, body: usize) -> bool {
        self.convex.get(body).is_none_or(|known| known.is_none())
    }

    /// How many bodies go by subdivision.
    #[must_use]
    pub fn subdivided(&self) -> usize {
        self.convex.iter().flatten().count()
    }

    /// The bodies that go by subdivision, of those that are `wanted`.
    #[must_use]
    pub fn road<'a>(
        &'a self,
        triangles: &'a [[DVec3; 3]],
        options: Options,
        wanted: impl Fn(usize) -> bool,
    ) -> Road<'a> {
        let known = self.convex.iter().enumerate().filter(|(body, _)| wanted(*body));
        let bodies: Vec<_> = known.filter_map(|(_, known)| known.as_ref().map(|k| k.body(triangles))).collect();
        Road::new(bodies, options)
    }
}

impl Known {
    fn body<'a>(&'a self, triangles: &'a [[DVec3; 3]]) -> Convex<'a> {
        match self {
            Known::Round(body) => *body,
            Known::Closed(run) => Convex::Mesh(ClosedSurface::new(&triangles[run.clone()])),
            Known::Faceted(f) => Convex::Polytope(Polytope::new(Hull::new(&f.vertices), &f.facets)),
        }
    }
}

/// A body without triangles; none if it should have some.
fn round(form: &Form) -> Option<Convex<'static>> {
    Some(match form {
        Form::Sphere(s) => Convex::Sphere(*s),
        Form::Ellipsoid(s) => Convex::Ellipsoid(*s),
        Form::Cylinder(s) => Convex::Cylinder(*s),
        Form::Capsule(s) => Convex::Capsule(*s),
        Form::Cone(s) => Convex::Cone(*s),
        Form::Box(_) | Form::Hull(_) => return None,
    })
}

/// The body as a polytope, if it is certified to be one.
fn faceted(body: &Body, triangles: &[[DVec3; 3]]) -> Option<Faceted> {
    if body.sheet || body.cavities > 0 || triangles.len() > MOST_FACETS {
        return None;
    }
    let mut seen = HashMap::default();
    let mut vertices = Vec::new();
    for &p in triangles.iter().flatten() {
        seen.entry(p.to_array().map(|x| (x + 0.0).to_bits())).or_insert_with(|| vertices.push(p));
    }
    let mut planes = vec![Facet::none(); triangles.len()];
    let count = facets(&vertices, triangles, &mut planes).ok()?;
    planes.truncate(count);
    Some(Faceted { vertices, facets: planes })
}

/// Has every edge its reverse?
fn is_closed(triangles: &[[DVec3; 3]]) -> bool {
    let bits = |p: DVec3| p.to_array().map(|x| (x + 0.0).to_bits());
    let mut open = HashMap::default();
    for [a, b, c] in triangles.iter().map(|t| t.map(bits)) {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *open.entry((from.min(to), from.max(to))).or_insert(0_i64) += if from < to { 1 } else { -1 };
        }
    }
    open.values().all(|&count| count == 0)
}

/// Bodies under one rule.
#[derive(Debug)]
pub struct Road<'a> {
    bodies: Vec<(Aabb<DVec3>, Convex<'a>)>,
    rule: SubdivisionRule<f64>,
}

/// A thread's memory for subdivision.
#[derive(Debug, Default)]
pub struct Lists {
    candidates: Vec<Candidate<DVec3>>,
    facets: Vec<u32>,
    /// Of surfaces, those in a layer.
    triangles: Vec<[DVec3; 3]>,
}

impl Lists {
    /// Enough for some bodies at once; as much for the same bodies whatever was there before, so that the bits are the same.
    fn memory(&mut self, bodies: &[Convex]) -> SubdivisionMemory<'_, DVec3> {
        let facets: usize = bodies.iter().map(Subdividable::facet_count).sum();
        let (candidates, facets) = (8 * bodies.len() + 1024, 8 * facets + (1 << 14));
        self.candidates.resize(self.candidates.len().max(candidates), Candidate::default());
        self.facets.resize(self.facets.len().max(facets), 0);
        SubdivisionMemory { candidates: &mut self.candidates[..candidates], facets: &mut self.facets[..facets] }
    }
}

/// The lists were made for the bodies they are used with.
const FITS: &str = "lists hold all bodies";

impl<'a> Road<'a> {
    /// Some bodies.
    #[must_use]
    pub fn new(bodies: Vec<Convex<'a>>, options: Options) -> Self {
        let rule = SubdivisionRule { leaf: options.leaf.into(), depth: options.depth, tol: options.tol };
        let bodies = bodies.into_iter().map(|b| (Subdividable::bounds(&b), b)).collect();
        Road { bodies, rule }
    }

    /// Holds no body.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.bodies.is_empty()
    }

    /// The bodies and a thread's memory for them, as the layers of a grid in the core take them.
    pub fn with<'r>(&'r self, grid: &'r Grid<'r, f64>, lists: &'r mut Lists) -> RoadWithLists<'r, 'a> {
        RoadWithLists { road: self, grid, lists, tally: QueryCount::default() }
    }

    /// Work with what lies between two z planes of the grid: the bodies that do, and of surfaces the triangles.
    fn between<T>(
        &self,
        grid: &Grid<f64>,
        planes: [usize; 2],
        lists: &mut Lists,
        work: impl FnOnce(&Road, &mut Lists) -> T,
    ) -> T {
        let end = |axis: usize| [grid.edges(axis)[0], grid.edges(axis)[grid.cells()[axis]]];
        let [x, y, z] = [0, 1, 2].map(end);
        let [min, max] = [0, 1].map(|n| DVec3::new(x[n], y[n], z[n]));
        let room = 2.0 * slab_margin(&Aabb { min, max });
        let [below, above] = [grid.edges(2)[planes[0]] - room, grid.edges(2)[planes[1]] + room];
        let mut triangles = std::mem::take(&mut lists.triangles);
        triangles.clear();
        let near = self.bodies.iter().filter(|(b, _)| b.min.z <= above && b.max.z >= below);
        let runs: Vec<_> = near
            .map(|(bounds, body)| {
                let first = triangles.len();
                if let Convex::Mesh(mesh) = body {
                    let meets = |t: &&[DVec3; 3]| t.iter().any(|p| p.z >= below) && t.iter().any(|p| p.z <= above);
                    triangles.extend(mesh.triangles().iter().filter(meets));
                }
                (*bounds, *body, first..triangles.len())
            })
            .collect();
        let part = |(bounds, body, run): (Aabb<DVec3>, Convex<'a>, ops::Range<usize>)| match body {
            Convex::Mesh(_) => {
                let mesh = ClosedSurface::new(&triangles[run]);
                (Subdividable::bounds(&mesh), Convex::Mesh(mesh))
            }
            _ => (bounds, body),
        };
        let found = work(&Road { bodies: runs.into_iter().map(part).collect(), ..*self }, lists);
        lists.triangles = triangles;
        found
    }

    fn places(
        &self,
        grid: &Grid<f64>,
        places: RangeKind,
        k: usize,
        lists: &mut Lists,
        lower: &mut [f64],
        sum: &mut [f64],
    ) -> QueryCount {
        let [row, _, _] = match places {
            RangeKind::Cells => grid.cells(),
            RangeKind::Faces(axis) => grid.face_shape(axis),
        };
        let only = CellRange { lo: [0, 0, k as u32], hi: [u32::MAX, u32::MAX, k as u32 + 1] };
        let touched = |bounds: &Aabb<DVec3>| CellRange::touching(grid, places, bounds).intersection(only);
        let reaching = self.bodies.iter().map(|(bounds, body)| (touched(bounds), *body));
        let (ranges, bodies): (Vec<_>, Vec<_>) = reaching.filter(|(range, _)| !range.is_empty()).unzip();
        let Some(range) = ranges.into_iter().reduce(CellRange::union) else { return QueryCount::default() };
        let mut memory = lists.memory(&bodies);
        let fill = |range: CellRange, bounds: Bounds<f64>| {
            for j in range.lo[1]..range.hi[1] {
                for at in (range.lo[0]..range.hi[0]).map(|i| j as usize * row + i as usize) {
                    lower[at] = lower[at].max(bounds.lower);
                    sum[at] += bounds.upper;
                }
            }
        };
        subdivide(grid, places, range, &bodies, self.rule, &mut memory, fill).expect(FITS)
    }
}

/// Bodies and a thread's memory for them.
#[derive(Debug)]
pub struct RoadWithLists<'r, 'a> {
    road: &'r Road<'a>,
    /// The whole grid, not that of a divided cell.
    grid: &'r Grid<'r, f64>,
    lists: &'r mut Lists,
    tally: QueryCount,
}

impl RoadWithLists<'_, '_> {
    /// How often GJK was asked for shares of the cells and faces of the whole grid.
    #[must_use]
    pub fn tally(&self) -> QueryCount {
        self.tally
    }

    /// Add to some places of a layer what lies between two z planes.
    fn add_between(&mut self, grid: &Grid<f64>, planes: [usize; 2], wanted: &[RangeKind], layer: &mut Layer<f64>) {
        let found = self.road.between(grid, planes, self.lists, |road, lists| {
            let place = |&places: &RangeKind| {
                let (lower, sum) = match places {
                    RangeKind::Cells => layer.cells_mut(),
                    RangeKind::Faces(axis) => layer.faces_mut(axis),
                };
                road.places(grid, places, planes[0], lists, lower, sum)
            };
            wanted.iter().map(place).fold(QueryCount::default(), ops::Add::add)
        });
        if grid.cells() == self.grid.cells() && grid.bounds() == self.grid.bounds() {
            self.tally = self.tally + found;
        }
    }
}

impl OtherBodies<DVec3> for RoadWithLists<'_, '_> {
    fn is_empty(&self) -> bool {
        self.road.is_empty()
    }

    fn boxes(&self) -> impl Iterator<Item = Aabb<DVec3>> {
        self.road.bodies.iter().map(|(bounds, _)| *bounds)
    }

    fn add(&mut self, grid: &Grid<f64>, k: usize, areas: bool, layer: &mut Layer<f64>) {
        let all = [RangeKind::Cells, RangeKind::Faces(0), RangeKind::Faces(1), RangeKind::Faces(2)];
        self.add_between(grid, [k, k + 1], if areas { &all } else { &all[..1] }, layer);
    }

    fn add_plane(&mut self, grid: &Grid<f64>, plane: usize, layer: &mut Layer<f64>) {
        self.add_between(grid, [plane, plane], &[RangeKind::Faces(2)], layer);
    }

    fn reach(&mut self, cell: Aabb<DVec3>) -> bool {
        let room = cell.size() * ROOM;
        let cell = Aabb { min: cell.min - room, max: cell.max + room };
        let near = self.road.bodies.iter().filter(|(bounds, _)| bounds.touches(cell));
        let bodies: Vec<_> = near.map(|(_, body)| *body).collect();
        let rule = SubdivisionRule { leaf: subdivide::LeafRule::Half, depth: 0, tol: 1.0 };
        !bodies.is_empty()
            && share(&cell, &bodies, rule, &mut self.lists.memory(&bodies), &mut QueryCount::default()).expect(FITS)
                != Bounds::OPEN
    }
}

/// What is so near a cell counts as reaching its sides, in cells.
const ROOM: f64 = 1.0 / 1024.0;
