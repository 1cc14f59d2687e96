//! Solid shares of cells and faces, as bounds, by depth-first subdivision of a grid against bodies.
//!
//! A range of cells is asked of every body that may reach it: open, cut or closed ([`Subdividable::occupancy`]). Bodies that do not reach it
//! leave the list; one body that holds it closes it; a range that is cut is bisected, down to single cells. A cell is divided into eight
//! parts, a face into four, down to `depth`. As one list holds all bodies, their union is counted once. Each part takes over from its parent
//! the bodies that cut it, their facets that do, and the last separating axis.
//!
//! [`LeafRule`] decides what a smallest part counts as. With [`LeafRule::Solid`], the rule of the paper, parts of size δ overstate the
//! volume by (δ/2)∮(|n_x|+|n_y|+|n_z|)dS in all; [`LeafRule::Plane`] measures them, with an error of second order.
//!
//! ```
//! use glam::DVec3;
//! use voidage_core::convex::shape::Sphere;
//! use voidage_core::grid::{Grid, cell_range::{CellRange, RangeKind}};
//! use voidage_core::subdivide::{Candidate, LeafRule, SubdivisionMemory, SubdivisionRule, subdivide};
//!
//! let edges = [0.0, 1.0, 2.0];
//! let grid = Grid::new(&edges, &edges, &edges).unwrap();
//! let balls = [Sphere { center: DVec3::ONE, radius: 1.0 }, Sphere { center: DVec3::ONE, radius: 0.5 }];
//! let rule = SubdivisionRule { leaf: LeafRule::Plane, depth: 6, tol: 1e-3 };
//! let (mut candidates, mut facets) = ([Candidate::default(); 128], [0; 16]);
//! let mut memory = SubdivisionMemory { candidates: &mut candidates, facets: &mut facets };
//!
//! let mut solid = [0.0; 8];
//! subdivide(&grid, RangeKind::Cells, CellRange::all(&grid, RangeKind::Cells), &balls, rule, &mut memory, |range, share| {
//!     for k in range.lo[2]..range.hi[2] {
//!         for j in range.lo[1]..range.hi[1] {
//!             for i in range.lo[0]..range.hi[0] {
//!                 solid[grid.cell_index([i, j, k].map(|n| n as usize))] = (share.lower + share.upper) / 2.0;
//!             }
//!         }
//!     }
//! })
//! .unwrap();
//! // An eighth of a ball in each cell; the smaller ball lies in the larger one.
//! assert!(solid.iter().all(|s| (s - std::f64::consts::PI / 6.0).abs() < 1e-3));
//! ```
//!
//! A file uses only those above it in this list:
//!
//! 1. `chord_bounds`: bounds of a convex body's share of a box, from chords
//! 2. `range_stack`: the explicit stack of ranges
//! 3. `rule`: when to stop
//! 4. `occupancy`: open, cut or closed, and what a query hands on
//! 5. `memory`: the lists of bodies and facets
//! 6. `local_planes`: a polytope's planes near a box
//! 7. `place`: how a box lies to a convex body
//! 8. `mesh`: the same for a closed surface
//! 9. `parts`: the parts of a box
//! 10. `subdivision`: the walk

use crate::grid::Grid;
use crate::grid::cell_range::{CellRange, RangeKind};
use crate::number::aabb::Aabb;
use subdivision::{Filtered, Subdivision};

mod chord_bounds;
mod local_planes;
mod memory;
mod mesh;
mod occupancy;
mod parts;
mod place;
mod range_stack;
mod rule;
mod subdivision;

pub use crate::grid::bounds::Bounds;
pub use chord_bounds::{Columns, MAX_PARTS};
pub use local_planes::{LocalPlanes, MAX_PLANES, PlaneDistances};
pub use memory::{Candidate, SubdivisionMemory, TooLittleMemory};
pub use mesh::{ClosedSurface, slab_margin};
pub use occupancy::{ActiveFacets, Occupancy, QueryCount, WarmStart};
pub use place::{BodyScalar, Subdividable};
pub use range_stack::{MAX_RANGES, RangeStack};
pub use rule::{LeafRule, MAX_DEPTH, SubdivisionRule};

/// Finds the solid share of the cells or faces of `range`, and hands what is not open to `fill`, each cell once at most: ranges all closed, or
/// single cells or faces with bounds. What of `range` lies outside the grid is left out.
///
/// # Errors
/// [`TooLittleMemory`] if the memory does not hold a list of all bodies.
pub fn subdivide<B: Subdividable>(
    grid: &Grid<BodyScalar<B>>,
    kind: RangeKind,
    range: CellRange,
    bodies: &[B],
    rule: SubdivisionRule<BodyScalar<B>>,
    memory: &mut SubdivisionMemory<B::Vector>,
    fill: impl FnMut(CellRange, Bounds<BodyScalar<B>>),
) -> Result<QueryCount, TooLittleMemory> {
    let mut subdivision = Subdivision::new(bodies, rule, memory, QueryCount::default());
    let list = subdivision.all_candidates()?;
    let range = range.intersection(CellRange::all(grid, kind));
    if !range.is_empty() {
        subdivision.visit(grid, kind, range, list, fill);
    }
    Ok(subdivision.count)
}

/// The solid share of one box, which may be a face: a box without thickness along one axis. Queries are added to `count`.
///
/// # Errors
/// [`TooLittleMemory`] if the memory does not hold a list of all bodies.
pub fn share<B: Subdividable>(
    cell: &Aabb<B::Vector>,
    bodies: &[B],
    rule: SubdivisionRule<BodyScalar<B>>,
    memory: &mut SubdivisionMemory<B::Vector>,
    count: &mut QueryCount,
) -> Result<Bounds<BodyScalar<B>>, TooLittleMemory> {
    let mut subdivision = Subdivision::new(bodies, rule, memory, *count);
    let list = subdivision.all_candidates()?;
    let bounds = match subdivision.filter(cell, list) {
        Filtered::Open => Bounds::OPEN,
        Filtered::Closed => Bounds::CLOSED,
        Filtered::Cut(list) => subdivision.refine(cell, list),
    };
    *count = subdivision.count;
    Ok(bounds)
}
