//! Porosity of a grid from bodies of triangles, overlaps counted once.
#![no_std]
#![no_main]

use core::hint::black_box;
use voidage_core::grid::Grid;
use voidage_core::surface::bins::{Group, Surface};
use voidage_core::surface::layer::{LayerMemory, LayerOptions, LayerSlices, Layers};
use voidage_core::surface::union::UnionBuffers;
use voidage_size::{Real, point, program};

fn porosity() -> Option<Real> {
    let (edges, triangles) = black_box(([0.0; 9], [[point(); 3]; 12]));
    let grid = Grid::new(&edges, &edges, &edges).ok()?;
    let bodies = [Surface::new(&triangles), Surface::new(&triangles)];
    let (mut numbers, mut groups) = ([0; 99], [Group::default(); 99]);
    let layers = Layers::new(&grid, &bodies, LayerOptions::default(), &mut numbers, &mut groups).ok()?;
    let (mut reals, mut flags, mut numbers, mut groups) = ([0.0; 9999], [0; 999], [0; 999], [Group::default(); 99]);
    let mut union = UnionBuffers::<Real, 8>::default();
    let mut memory = LayerMemory::new(&grid, &mut reals, &mut flags, &mut numbers, &mut groups, union.memory()).ok()?;
    let (mut v, mut x, mut y, mut z) = ([0.0; 512], [0.0; 576], [0.0; 576], [0.0; 576]);
    let mut solid = 0.0;
    for k in 0..8 {
        let slices = LayerSlices::of_fields(&grid, k, &mut v, [&mut x, &mut y, &mut z]).ok()?;
        solid += layers.layer(k, slices, None, &mut memory).ok()?.solid_volume;
    }
    black_box((&v, &x, &y, &z));
    Some(solid)
}

program!(porosity);
