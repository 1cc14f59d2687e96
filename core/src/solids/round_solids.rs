//! Solids in the caller's memory, as bodies of a layer.
//!
//! Each solid's shares are added up. Where only one has a share, that is exact. Where several have one and GJK proves that no two of them
//! meet, the sum is exact too; elsewhere what they have in common is measured by sections, or if they are too many, their union is
//! subdivided in that cell or face, and the result is bounds.

use super::round_shape::RoundShape;
use crate::convex::gjk::{Intersection, intersect};
use crate::convex::support::Support;
use crate::grid::Grid;
use crate::grid::bounds::Bounds;
use crate::grid::cell_range::{CellRange, RangeKind};
use crate::grid::fields::{Fields, Layer, accumulate};
use crate::number::aabb::Aabb;
use crate::number::axis::Axis;
use crate::number::real::{Real, Vector};
use crate::solids::quadric::{AsQuadric, QuadricSolid, share_of_union};
use crate::subdivide::{QueryCount, Subdividable, SubdivisionMemory, SubdivisionRule, TooLittleMemory, share};
use crate::surface::OtherBodies;

/// Shares that leave 0 to 1 by more than this are not believed: the solid is subdivided in that layer.
const BELIEVED: f64 = 1e-9;

/// What is so near a cell counts as reaching its sides, in cells.
const NEAR: f64 = 1.0 / 1024.0;

/// A solid known by formula.
#[derive(Clone, Debug)]
pub struct RoundSolid<V: Vector> {
    shape: RoundShape<V>,
    formula: QuadricSolid,
    bounds: Aabb<V>,
}

impl<V: Vector> RoundSolid<V> {
    /// None if a length leaves the range in which it can be computed, or nothing of it is solid.
    #[must_use]
    pub fn new(shape: RoundShape<V>) -> Option<Self> {
        if !shape.extent().is_finite() {
            return None;
        }
        Some(RoundSolid { shape, formula: shape.quadric()?, bounds: Subdividable::bounds(&shape) })
    }

    /// The shape.
    #[must_use]
    pub const fn shape(&self) -> &RoundShape<V> {
        &self.shape
    }
}

/// Lengths of the memory for some solids; all must be met.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RoundNeeded {
    /// Of sums and of owners: cells and faces of a layer.
    pub places: usize,
    /// Of the list of shapes near a place.
    pub near: usize,
    /// Of the candidates of a subdivision.
    pub candidates: usize,
    /// Of its facets.
    pub facets: usize,
}

/// The caller's memory; what it holds does not matter.
#[derive(Debug)]
pub struct RoundMemory<'m, V: Vector> {
    /// Sums of the shares of cells, x, y and z faces of a layer.
    pub sums: &'m mut [V::Scalar],
    /// Whose share a sum is.
    pub owners: &'m mut [u32],
    /// The shapes near a cell that several share.
    pub near: &'m mut [RoundShape<V>],
    /// For the subdivision of such a cell.
    pub lists: SubdivisionMemory<'m, V>,
}

/// Owners of a place: 0 for none, the largest number for several; else the index of the only solid that has a share, plus one.
const NOBODY: u32 = 0;
const SEVERAL: u32 = u32::MAX;

/// Cells and faces of the smallest grids that a divided cell becomes.
const LEAST_PLACES: usize = 4 * 4 + 2 + 2;

/// Solids by formula, as bodies beside those of triangles.
#[derive(Debug)]
pub struct RoundSolids<'m, V: Vector> {
    solids: &'m [RoundSolid<V>],
    rule: SubdivisionRule<V::Scalar>,
    memory: RoundMemory<'m, V>,
    queries: QueryCount,
}

impl<V: Vector> RoundSolids<'_, V> {
    /// Memory for [`RoundSolids::new`], for so many solids in the layers of a grid.
    #[must_use]
    pub fn needed(grid: &Grid<V::Scalar>, solids: usize) -> RoundNeeded {
        RoundNeeded {
            places: Fields::<u8>::needed(grid).max(LEAST_PLACES),
            near: solids,
            candidates: solids.saturating_mul(8).saturating_add(64),
            facets: solids.saturating_mul(16).saturating_add(64),
        }
    }
}

impl<'m, V: Vector> RoundSolids<'m, V> {
    /// Solids in layers of `grid`, the rule by which cells that they share are subdivided, and memory as [`RoundSolids::needed`] tells.
    ///
    /// # Errors
    /// [`TooLittleMemory`] if that does not hold all solids, or the places of a layer.
    pub fn new(
        grid: &Grid<V::Scalar>,
        solids: &'m [RoundSolid<V>],
        rule: SubdivisionRule<V::Scalar>,
        memory: RoundMemory<'m, V>,
    ) -> Result<Self, TooLittleMemory> {
        let facets = solids.iter().map(|s| s.shape.facet_count()).sum();
        let (lists, places) = (&memory.lists, Self::needed(grid, 0).places);
        let few_places = memory.sums.len() < places || memory.owners.len() < places;
        let few_lists = lists.candidates.len() < solids.len() || lists.facets.len() < facets;
        if few_places || few_lists || memory.near.len() < solids.len() || solids.len() >= SEVERAL as usize {
            return Err(TooLittleMemory { candidates: solids.len(), facets });
        }
        Ok(RoundSolids { solids, rule, memory, queries: QueryCount::default() })
    }

    /// Queries of GJK so far.
    #[must_use]
    pub fn queries(&self) -> QueryCount {
        self.queries
    }

    /// Adds the union of all solids to the places of some kinds in the layer or plane `k`.
    fn add_places(&mut self, grid: &Grid<V::Scalar>, k: usize, kinds: &[RangeKind], layer: &mut Layer<V::Scalar>) {
        let places = Places::of(grid);
        let RoundMemory { sums, owners, .. } = &mut self.memory;
        let (Some(sums), Some(owners)) = (sums.get_mut(..places.end()), owners.get_mut(..places.end())) else {
            // Of a larger grid than the memory is made for nothing is known.
            for &kind in kinds {
                let (_, sum) = match kind {
                    RangeKind::Cells => layer.cells_mut(),
                    RangeKind::Faces(axis) => layer.faces_mut(axis),
                };
                sum.iter_mut().for_each(|sum| *sum += V::Scalar::ONE);
            }
            return;
        };
        sums.fill(V::Scalar::ZERO);
        owners.fill(NOBODY);
        let mut doubtful = false;
        for (n, solid) in (1_u32..).zip(self.solids) {
            let mut visit = |kind, at, share: f64| {
                let at = places.first(kind) + at;
                if let (Some(sum), Some(owner)) = (sums.get_mut(at), owners.get_mut(at)) {
                    *sum += V::Scalar::from_f64(share);
                    *owner = if *owner == NOBODY || *owner == n { n } else { SEVERAL };
                }
            };
            let worst = match kinds {
                [RangeKind::Faces(_)] => {
                    solid.formula.plane(grid, k, &mut visit);
                    0.0
                }
                _ => solid.formula.layer(grid, k, kinds.len() > 1, &mut visit),
            };
            if !(worst <= BELIEVED) {
                doubtful = true;
                claim(grid, k, &places, kinds, &solid.bounds, owners);
            }
        }
        for &kind in kinds {
            self.add_kind(grid, k, kind, &places, doubtful, layer);
        }
    }

    /// Adds the places of one kind. With `doubtful` sums are not believed where several have a share.
    fn add_kind(
        &mut self,
        grid: &Grid<V::Scalar>,
        k: usize,
        kind: RangeKind,
        places: &Places,
        doubtful: bool,
        layer: &mut Layer<V::Scalar>,
    ) {
        let (row, first) = (places.row(kind), places.first(kind));
        let count = match kind {
            RangeKind::Cells => layer.cells_mut().0.len(),
            RangeKind::Faces(axis) => layer.faces_mut(axis).0.len(),
        };
        for at in 0..count {
            let (Some(&sum), Some(&owner)) = (self.memory.sums.get(first + at), self.memory.owners.get(first + at))
            else {
                continue;
            };
            if owner == NOBODY {
                continue;
            }
            let mut found = Bounds { lower: sum, upper: sum };
            if owner == SEVERAL {
                let place = box_of(grid, kind, [at % row, at / row, k]);
                found = place.map_or(Bounds::UNKNOWN, |place| self.union(&place, sum, doubtful));
            }
            let (lower, sum) = match kind {
                RangeKind::Cells => layer.cells_mut(),
                RangeKind::Faces(axis) => layer.faces_mut(axis),
            };
            let (Some(lower), Some(sum)) = (lower.get_mut(at), sum.get_mut(at)) else { continue };
            if found.lower == found.upper {
                accumulate(found.lower, lower, sum);
            } else {
                (*lower, *sum) = (lower.max(found.lower), *sum + found.upper);
            }
        }
    }

    /// Bounds of the union of all solids in a cell or face, of which several have a share and `sum` in all.
    fn union(&mut self, place: &Aabb<V>, sum: V::Scalar, doubtful: bool) -> Bounds<V::Scalar> {
        let Self { solids, rule, memory, queries } = self;
        let mut count = 0;
        for solid in solids.iter().filter(|s| s.bounds.touches(*place)) {
            let Some(slot) = memory.near.get_mut(count) else { return Bounds::UNKNOWN };
            *slot = solid.shape;
            count += 1;
        }
        let near = memory.near.get(..count).unwrap_or_default();
        if !doubtful && all_apart(near, queries) {
            return Bounds { lower: sum, upper: sum };
        }
        if !doubtful && let Some(found) = by_sections(solids, place, sum, *rule) {
            return found;
        }
        let Ok(found) = share(place, near, *rule, &mut memory.lists, queries) else { return Bounds::UNKNOWN };
        // The sum limits the union, unless it contradicts by rounding.
        if !doubtful && sum < found.upper && sum >= found.lower { Bounds { upper: sum, ..found } } else { found }
    }
}

/// Bounds of the union of solids that have `sum` in all of a cell or face, by what they have in common; none if these are not close.
fn by_sections<V: Vector>(
    solids: &[RoundSolid<V>],
    place: &Aabb<V>,
    sum: V::Scalar,
    rule: SubdivisionRule<V::Scalar>,
) -> Option<Bounds<V::Scalar>> {
    let real = V::Scalar::from_f64;
    let [min, max] = [place.min, place.max].map(|p| p.to_array().map(Real::to_f64));
    let sides = Axis::ALL.map(|n| [min[n], max[n]]);
    let near = solids.iter().filter(|s| s.bounds.touches(*place)).map(|s| &s.formula);
    // Shares were rounded, and their sum.
    let rounded = real(8.0) * V::Scalar::EPSILON * sum;
    let sum = Bounds { lower: (sum - rounded).to_f64(), upper: (sum + rounded).to_f64() };
    let found = share_of_union(near, sides, sum, rule.tol.to_f64(), usize::MAX)?;
    let bounds = Bounds { lower: real(found.lower), upper: real(found.upper) };
    (bounds.upper - bounds.lower <= real(2.0) * rule.tol).then_some(bounds)
}

/// Is every pair of these shapes proved apart by GJK? False at the first pair that overlaps or is undecided.
fn all_apart<V: Vector>(shapes: &[RoundShape<V>], queries: &mut QueryCount) -> bool {
    let mut rest = shapes;
    while let Some((a, others)) = rest.split_first() {
        for b in others {
            queries.queries += 1;
            match intersect(a, b, None) {
                Intersection::Apart { .. } => {}
                Intersection::Overlapping { .. } => return false,
                Intersection::Undecided { .. } => {
                    queries.undecided += 1;
                    return false;
                }
            }
        }
        rest = others;
    }
    true
}

/// Says that the places which a box touches in the layer or plane `k` may have several owners.
fn claim<V: Vector>(
    grid: &Grid<V::Scalar>,
    k: usize,
    places: &Places,
    kinds: &[RangeKind],
    bounds: &Aabb<V>,
    owners: &mut [u32],
) {
    for &kind in kinds {
        let range = CellRange::touching(grid, kind, bounds);
        if k < range.lo[2] as usize || k >= range.hi[2] as usize {
            continue;
        }
        for j in range.lo[1]..range.hi[1] {
            let first = places.first(kind) + j as usize * places.row(kind);
            let run = first + range.lo[0] as usize..first + range.hi[0] as usize;
            owners.get_mut(run).unwrap_or_default().fill(SEVERAL);
        }
    }
}

/// The cell, or the face normal to an axis, of these numbers.
fn box_of<V: Vector>(grid: &Grid<V::Scalar>, kind: RangeKind, at: [usize; 3]) -> Option<Aabb<V>> {
    let (mut min, mut max) = ([V::Scalar::ZERO; 3], [V::Scalar::ZERO; 3]);
    for (axis, ((min, max), at)) in min.iter_mut().zip(&mut max).zip(at).enumerate() {
        let edges = grid.edges(axis);
        *min = *edges.get(at)?;
        *max = if kind == RangeKind::Faces(axis) { *min } else { *edges.get(at + 1)? };
    }
    Some(Aabb { min: V::from_array(min), max: V::from_array(max) })
}

/// Where cells, x, y and z faces of a layer begin in one list, and how long their rows are.
struct Places {
    first: [usize; 5],
    rows: [usize; 2],
}

impl Places {
    fn of<R: Real>(grid: &Grid<R>) -> Self {
        let [nx, ny, _] = grid.cells();
        let (x, y) = (nx * ny, nx * ny + (nx + 1) * ny);
        let z = y + nx * (ny + 1);
        Places { first: [0, x, y, z, z + nx * ny], rows: [nx, nx + 1] }
    }

    fn end(&self) -> usize {
        self.first[4]
    }

    fn first(&self, kind: RangeKind) -> usize {
        match kind {
            RangeKind::Cells => self.first[0],
            RangeKind::Faces(0) => self.first[1],
            RangeKind::Faces(1) => self.first[2],
            RangeKind::Faces(_) => self.first[3],
        }
    }

    /// Not zero: a grid has cells.
    fn row(&self, kind: RangeKind) -> usize {
        self.rows[usize::from(kind == RangeKind::Faces(0))].max(1)
    }
}

impl<V: Vector> OtherBodies<V> for RoundSolids<'_, V> {
    fn is_empty(&self) -> bool {
        self.solids.is_empty()
    }

    fn boxes(&self) -> impl Iterator<Item = Aabb<V>> {
        self.solids.iter().map(|s| s.bounds)
    }

    fn add(&mut self, grid: &Grid<V::Scalar>, k: usize, areas: bool, layer: &mut Layer<V::Scalar>) {
        let all = [RangeKind::Cells, RangeKind::Faces(0), RangeKind::Faces(1), RangeKind::Faces(2)];
        self.add_places(grid, k, if areas { &all } else { &all[..1] }, layer);
    }

    fn add_plane(&mut self, grid: &Grid<V::Scalar>, plane: usize, layer: &mut Layer<V::Scalar>) {
        self.add_places(grid, plane, &[RangeKind::Faces(2)], layer);
    }

    fn reach(&mut self, cell: Aabb<V>) -> bool {
        let margin = cell.size() * V::Scalar::from_f64(NEAR);
        let cell = Aabb { min: cell.min - margin, max: cell.max + margin };
        self.solids.iter().filter(|s| s.bounds.touches(cell)).any(|s| {
            self.queries.queries += 1;
            !matches!(intersect(&cell, &s.shape, None), Intersection::Apart { .. })
        })
    }
}
