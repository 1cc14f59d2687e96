//! Bounds of the fractions of a grid from round bodies of five kinds, by subdivision.
#![no_std]
#![no_main]

use core::hint::black_box;
use voidage_core::grid::Grid;
use voidage_core::grid::cell_range::{CellRange, RangeKind};
use voidage_core::solids::RoundShape;
use voidage_core::subdivide::{Candidate, LeafRule, SubdivisionMemory, SubdivisionRule, subdivide};
use voidage_size::{Real, Vector, any, program};

fn shares() -> Option<Real> {
    let (edges, bodies) = black_box(([0.0; 9], [RoundShape::<Vector>::default(); 2]));
    let grid = Grid::new(&edges, &edges, &edges).ok()?;
    let (mut candidates, mut facets) = ([Candidate::default(); 64], [0; 8]);
    let mut memory = SubdivisionMemory { candidates: &mut candidates, facets: &mut facets };
    let rule = SubdivisionRule { leaf: LeafRule::Plane, depth: black_box(3), tol: any() };
    let mut sum = 0.0;
    for kind in [RangeKind::Cells, RangeKind::Faces(0), RangeKind::Faces(1), RangeKind::Faces(2)] {
        let all = CellRange::all(&grid, kind);
        subdivide(&grid, kind, all, &bodies, rule, &mut memory, |_, share| sum += share.upper).ok()?;
    }
    Some(sum)
}

program!(shares);
