//! How each body is measured, and bodies that enter a layer beside surfaces.
//!
//! By `auto`, bodies of triangles go by their surface and solids by formula by closed forms ([`super::formulas`]). By `gjk`, convex bodies are
//! subdivided, as in the paper. What enters beside surfaces is the union of each kind, as one interval a cell and face.

use super::convex::{Convex, Known, faceted, is_closed, round};
use super::formulas::{self, FormulaMemory, FormulaSolid};
use super::snap::ToPlanes;
use super::{Leaf, Method, Options};
use crate::geometry::bodies::{Bodies, Body, Doubt};
use crate::geometry::form::Form;
use glam::DVec3;
use rayon::prelude::*;
use std::ops;
use voidage_core::grid::Grid;
use voidage_core::grid::cell_range::{CellRange, RangeKind};
use voidage_core::grid::fields::Layer;
use voidage_core::number::aabb::Aabb;
use voidage_core::subdivide::{
    self, Bounds, Candidate, ClosedSurface, QueryCount, Subdividable, SubdivisionMemory, SubdivisionRule, share,
    slab_margin, subdivide,
};
use voidage_core::surface::{OtherBodies, PlanarPart};

/// How each body is measured: subdivided if its entry in `convex` is some, by closed form if `formulas` lists it, else by its surface.
#[derive(Debug, Default)]
pub struct Roads {
    /// One entry a body: what is subdivided.
    convex: Vec<Option<Known>>,
    /// The solids measured by closed forms, each with the number of its body, without what others hold.
    formulas: Vec<FormulaSolid>,
    /// The bodies that these are of, by ascending numbers.
    by_formula: Vec<usize>,
}

impl Roads {
    /// Choose for every body; `triangles` are those of `bodies`, or a copy with corners moved.
    #[must_use]
    pub fn choose(grid: &Grid<f64>, bodies: &Bodies, triangles: &[[DVec3; 3]], options: Options) -> Self {
        let planes = ToPlanes::new(grid);
        let known = |body: &Body| match (&body.form, options.method) {
            _ if body.doubt != Doubt::None => None,
            // Planes are measured by their surface: exact, and cheaper than any subdivision.
            (_, Method::Auto | Method::Surface) if !body.triangles.is_empty() => None,
            (_, Method::Surface) => None,
            (Some(form), _) if body.triangles.is_empty() => round(&planes.form(form)).map(Known::Round),
            (_, Method::Auto | Method::Gjk) => {
                let own = &triangles[body.triangles.clone()];
                let closed = || options.leaf != Leaf::Plane && !body.sheet && is_closed(own);
                faceted(body, own)
                    .map(Known::Faceted)
                    .or_else(|| closed().then(|| Known::Closed(body.triangles.clone())))
            }
        };
        let mut convex: Vec<Option<Known>> = bodies.bodies.par_iter().map(known).collect();
        let mut formulas = Vec::new();
        for (body, known) in convex.iter_mut().enumerate() {
            match (known.as_ref(), &bodies.bodies[body].form) {
                // Whatever the method: no other measures it.
                (_, Some(form @ Form::Torus(_))) => {
                    if let Form::Torus(shape) = planes.form(form) {
                        formulas.extend(FormulaSolid::torus(body, &shape));
                    }
                }
                (Some(Known::Round(shape)), _) if options.method == Method::Auto => {
                    if let Some(form) = FormulaSolid::new(body, *shape) {
                        formulas.push(form);
                        *known = None;
                    }
                }
                _ => {}
            }
        }
        let by_formula = formulas.iter().map(|f| f.body).collect();
        let mut formulas = formulas::without_nested(formulas, |body| bodies.bodies[body].porosity);
        formulas::find_partners(&mut formulas);
        Roads { convex, formulas, by_formula }
    }

    /// Does a body go by its surface?
    #[must_use]
    pub fn by_surface(&self, body: usize) -> bool {
        self.convex.get(body).is_none_or(|known| known.is_none()) && self.by_formula.binary_search(&body).is_err()
    }

    /// How many bodies go by closed forms.
    #[must_use]
    pub fn by_formula(&self) -> usize {
        self.by_formula.len()
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
        let formulas = self.formulas.iter().filter(|f| wanted(f.body)).map(|f| (f.bounds, f)).collect();
        Road { formulas, ..Road::new(bodies, options) }
    }
}

/// Bodies under one rule.
#[derive(Debug)]
pub struct Road<'a> {
    bodies: Vec<(Aabb<DVec3>, Convex<'a>)>,
    /// With their boxes, as most solids are far from what is looked at.
    formulas: Vec<(Aabb<DVec3>, &'a FormulaSolid)>,
    rule: SubdivisionRule<f64>,
}

/// A thread's memory for subdivision.
#[derive(Debug, Default)]
pub struct Lists {
    candidates: Vec<Candidate<DVec3>>,
    facets: Vec<u32>,
    /// Of surfaces, those in a layer.
    triangles: Vec<[DVec3; 3]>,
    formulas: FormulaMemory,
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
        Road { bodies, formulas: Vec::new(), rule }
    }

    /// Holds no body.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.bodies.is_empty() && self.formulas.is_empty()
    }

    /// The bodies and a thread's memory for them, as the layers of a grid in the core take them.
    pub fn with<'r>(&'r self, grid: &'r Grid<'r, f64>, lists: &'r mut Lists) -> RoadWithLists<'r, 'a> {
        RoadWithLists { road: self, grid, lists, tally: QueryCount::default(), shared: 0 }
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
        let margin = 2.0 * slab_margin(&Aabb { min, max });
        let [below, above] = [grid.edges(2)[planes[0]] - margin, grid.edges(2)[planes[1]] + margin];
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
        let bodies = runs.into_iter().map(part).collect();
        let found = work(&Road { bodies, formulas: Vec::new(), rule: self.rule }, lists);
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
    /// Cells of the whole grid in which solids by formula meet.
    shared: usize,
}

impl RoadWithLists<'_, '_> {
    /// How often GJK was asked for shares of the cells and faces of the whole grid.
    #[must_use]
    pub fn tally(&self) -> QueryCount {
        self.tally
    }

    /// In how many cells of the whole grid solids by formula meet.
    #[must_use]
    pub fn shared(&self) -> usize {
        self.shared
    }

    /// Add what goes by closed forms; by subdivision where that fails.
    fn add_formulas(&mut self, grid: &Grid<f64>, part: formulas::LayerPart, layer: &mut Layer<f64>) {
        let [below, above] = part.planes().map(|n| grid.edges(2)[n]);
        let [x, y] = [0, 1].map(|axis| grid.ends(axis));
        let near = |Aabb { min, max }: &Aabb<DVec3>| {
            let z = min.z <= above && max.z >= below;
            z && min.x <= x[1] && max.x >= x[0] && min.y <= y[1] && max.y >= y[0]
        };
        let formulas = self.road.formulas.iter().filter(|(bounds, _)| near(bounds));
        let mut solids: Vec<&FormulaSolid> = formulas.map(|(_, f)| *f).collect();
        let mut subdivided: Vec<Convex> = Vec::new();
        let mut memory = std::mem::take(&mut self.lists.formulas);
        memory.shared = 0;
        memory.keeps = (0..3).all(|axis| std::ptr::eq(grid.edges(axis), self.grid.edges(axis)));
        let mut tally = QueryCount::default();
        while !solids.is_empty() {
            let doubtful = formulas::add(&solids, grid, part, &mut memory, layer, self.road.rule.tol);
            if doubtful.is_empty() {
                break;
            }
            subdivided.extend(doubtful.iter().filter_map(|&n| solids[n].convex()));
            let mut n = 0;
            solids.retain(|_| {
                n += 1;
                !doubtful.contains(&(n - 1))
            });
        }
        self.shared += if self.is_whole(grid) { memory.shared } else { 0 };
        self.lists.formulas = memory;
        if !subdivided.is_empty() {
            let options = self.road.rule;
            let bodies = subdivided.into_iter().map(|b| (Subdividable::bounds(&b), b)).collect();
            let road = Road { bodies, formulas: Vec::new(), rule: options };
            let all = [RangeKind::Cells, RangeKind::Faces(0), RangeKind::Faces(1), RangeKind::Faces(2)];
            let wanted = match part {
                formulas::LayerPart::Layer(_, true) => &all[..],
                formulas::LayerPart::Layer(_, false) => &all[..1],
                formulas::LayerPart::Plane(_) => &all[3..],
            };
            let mut with = road.with(self.grid, self.lists);
            with.add_between(grid, part.planes(), wanted, layer);
            tally = tally + with.tally;
        }
        self.count(grid, tally);
    }

    /// Counts the queries of the whole grid, not those of divided cells.
    fn count(&mut self, grid: &Grid<f64>, found: QueryCount) {
        if self.is_whole(grid) {
            self.tally = self.tally + found;
        }
    }

    /// Is it the whole grid, not a divided cell?
    fn is_whole(&self, grid: &Grid<f64>) -> bool {
        grid.cells() == self.grid.cells() && grid.bounds() == self.grid.bounds()
    }

    /// Add to some places of a layer what lies between two z planes.
    fn add_between(&mut self, grid: &Grid<f64>, planes: [usize; 2], wanted: &[RangeKind], layer: &mut Layer<f64>) {
        if self.road.bodies.is_empty() {
            return;
        }
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
        self.count(grid, found);
    }
}

impl OtherBodies<DVec3> for RoadWithLists<'_, '_> {
    fn is_empty(&self) -> bool {
        self.road.is_empty()
    }

    fn boxes(&self) -> impl Iterator<Item = Aabb<DVec3>> {
        let formulas = self.road.formulas.iter().map(|(bounds, _)| *bounds);
        self.road.bodies.iter().map(|(bounds, _)| *bounds).chain(formulas)
    }

    fn add(&mut self, grid: &Grid<f64>, k: usize, areas: bool, layer: &mut Layer<f64>) {
        let all = [RangeKind::Cells, RangeKind::Faces(0), RangeKind::Faces(1), RangeKind::Faces(2)];
        self.add_between(grid, [k, k + 1], if areas { &all } else { &all[..1] }, layer);
        self.add_formulas(grid, formulas::LayerPart::Layer(k, areas), layer);
    }

    fn add_plane(&mut self, grid: &Grid<f64>, plane: usize, layer: &mut Layer<f64>) {
        self.add_between(grid, [plane, plane], &[RangeKind::Faces(2)], layer);
        self.add_formulas(grid, formulas::LayerPart::Plane(plane), layer);
    }

    const UNITES: bool = true;

    fn union_with(
        &mut self,
        cell: Aabb<DVec3>,
        bodies: &[PlanarPart<f64>],
        wanted: [bool; 7],
    ) -> Option<[Bounds<f64>; 7]> {
        let is_subdivided = self.road.bodies.iter().any(|(bounds, _)| bounds.touches(cell));
        let near = self.road.formulas.iter().filter(|(bounds, _)| bounds.touches(cell));
        let solids: Vec<&FormulaSolid> = near.map(|(_, f)| *f).collect();
        (!is_subdivided).then(|| formulas::union_with(&solids, bodies, (cell, wanted), self.road.rule.tol))
    }

    fn reach(&mut self, cell: Aabb<DVec3>) -> bool {
        let margin = cell.size() * MARGIN;
        let cell = Aabb { min: cell.min - margin, max: cell.max + margin };
        let mut formulas = self.road.formulas.iter().filter(|(bounds, _)| bounds.touches(cell)).map(|(_, f)| f);
        if formulas.clone().any(|f| f.torus_may_reach(cell)) {
            return true;
        }
        let formulas = formulas.by_ref().filter_map(|f| f.convex());
        let near = self.road.bodies.iter().filter(|(bounds, _)| bounds.touches(cell));
        let bodies: Vec<_> = near.map(|(_, body)| *body).chain(formulas).collect();
        let rule = SubdivisionRule { leaf: subdivide::LeafRule::Half, depth: 0, tol: 1.0 };
        !bodies.is_empty()
            && share(&cell, &bodies, rule, &mut self.lists.memory(&bodies), &mut QueryCount::default()).expect(FITS)
                != Bounds::OPEN
    }
}

/// What is so near a cell counts as reaching its sides, in cells.
const MARGIN: f64 = 1.0 / 1024.0;
