//! Fractions of the cells and faces of a grid from one body of triangles.
#![no_std]
#![no_main]

use core::hint::black_box;
use voidage_core::grid::Grid;
use voidage_core::grid::fields::{Fields, Layer};
use voidage_core::surface::cells::{Scratch, add_body};
use voidage_core::surface::z_faces::{Side, add_section};
use voidage_size::{Real, point, program};

fn fractions() -> Option<Real> {
    let (edges, triangles, ids) = black_box(([0.0; 9], [[point(); 3]; 12], [0_u32; 12]));
    let grid = Grid::new(&edges, &edges, &edges).ok()?;
    let (mut lower, mut sum, mut flags, mut scratch) = ([0.0; 272], [0.0; 272], [0; 272], [0.0; 224]);
    let mut scratch = Scratch::new(&grid, &mut scratch).ok()?;
    let mut solid = 0.0;
    for k in 0..8 {
        lower.fill(0.0);
        sum.fill(0.0);
        flags.fill(0);
        let within = Fields::within(&grid, &mut lower).ok()?;
        let mut layer =
            Layer::new(within, Fields::within(&grid, &mut sum).ok()?, Fields::within(&grid, &mut flags).ok()?).ok()?;
        let defects = add_body(&grid, k, &triangles, &ids, &mut scratch, &mut layer).ok()?;
        solid += defects.leak + add_section(&grid, k, Side::Above, &triangles, &ids, &mut scratch, &mut layer).ok()?;
        black_box(&lower);
    }
    Some(solid)
}

program!(fractions);
