//! The grid, and triangles sorted into its layers.

use glam::{DVec3, Vec3};
use voidage_core::grid::{Grid, Located};
use voidage_core::number::real::{Real, Vector};
use voidage_core::surface::bins::{Group, Surface};
use voidage_core::surface::layer::{LayerMemory, LayerOptions, LayerSlices, Layers, OpenLayer};
use voidage_core::surface::shadow::{Shadow, ShadowEdge, ShadowMemory};
use voidage_core::surface::surface_area::{CellSurface, SurfaceArea};
use voidage_core::surface::union::{UnionBuffers, UnionMemory};

fn asked<V: Vector>(edges: &[V::Scalar], triangles: &[[V; 3]], at: usize, r: V::Scalar) -> usize {
    let rest = edges.get(at..).unwrap_or(edges);
    let Ok(grid) = Grid::new(edges, rest, edges) else { return 1 };
    let cell = grid.cell_box([at, at, at]).map_or(0, |cell| usize::from(cell.is_empty()));
    let place = match grid.locate(at, r) {
        Located::Below => 1,
        Located::Cell(i) => i,
        Located::Above => 2,
    };
    let face = grid.face_shape(at)[0] ^ grid.edges(at).len() ^ usize::from(grid.bounds().is_empty());
    cell ^ place ^ face ^ sorted(&grid, triangles, at)
}

fn sorted<V: Vector>(grid: &Grid<V::Scalar>, triangles: &[[V; 3]], at: usize) -> usize {
    let (mut numbers, mut groups) = ([0; 99], [Group::default(); 9]);
    let bodies = [Surface::new(triangles), Surface::sheet(triangles)];
    let needed = Layers::needed(grid, &bodies);
    match Layers::new(grid, &bodies, LayerOptions::default(), &mut numbers, &mut groups) {
        Ok(layers) => layers.memory_needed().numbers ^ layers.bodies_in(at) ^ cut(grid, at) ^ porous(grid, &layers, at),
        Err(_) => needed.numbers,
    }
}

fn cut<R: Real>(grid: &Grid<R>, at: usize) -> usize {
    let (mut reals, mut flags, mut field) = ([R::ZERO; 99], [0; 99], [R::ZERO; 99]);
    let memory = LayerMemory::<R::Vector>::new(grid, &mut reals, &mut flags, &mut [], &mut [], UnionMemory::default());
    let slices = LayerSlices::of_fields(grid, at, &mut field, [&mut [], &mut [], &mut []]);
    usize::from(memory.is_ok()) ^ usize::from(slices.is_ok())
}

/// The fractions of a layer, with memory for unions of a few pieces.
fn porous<V: Vector>(grid: &Grid<V::Scalar>, layers: &Layers<V>, at: usize) -> usize {
    let zero = V::Scalar::ZERO;
    let (mut reals, mut flags, mut numbers, mut groups) = ([zero; 999], [0; 999], [0; 99], [Group::default(); 9]);
    let mut buffers = UnionBuffers::<V::Scalar, 8>::default();
    let union = buffers.memory();
    let Ok(mut memory) = LayerMemory::new(grid, &mut reals, &mut flags, &mut numbers, &mut groups, union) else { return 1 };
    let mut fields = [[zero; 99]; 12];
    let mut slices = fields.iter_mut().map(|f| f.as_mut_slice());
    let mut next = || -> Option<LayerSlices<V::Scalar>> {
        let (cell, x, y, z) = (slices.next()?, slices.next()?, slices.next()?, slices.next()?);
        LayerSlices::of_fields(grid, at, cell, [x, y, z]).ok()
    };
    let (Some(beta), Some(low), Some(high)) = (next(), next(), next()) else { return 2 };
    let porosity = layers.layer(at, beta, Some([low, high]), &mut memory).map_or(3, |report| report.divided);
    let (open, mut areas, mut cells) = ([V::Scalar::HALF; 99], [[SurfaceArea::default(); 99]; 2], [CellSurface::default(); 99]);
    let of = |count: usize| open.get(..count).unwrap_or(&open);
    let known = OpenLayer { cell: of(at), x: of(at + 1), y: of(at + 2), z: of(at), top: of(at) };
    let [union, sum] = areas.each_mut().map(|a| a.get_mut(..at).unwrap_or_default());
    let cells = cells.get_mut(..at).unwrap_or_default();
    let areas = layers.surface_areas(at, &known, [union, sum], cells, &mut memory).map_or(4, |report| report.unproved);
    porosity ^ areas ^ shadowed(layers, &known, at)
}

fn shadowed<V: Vector>(layers: &Layers<V>, open: &OpenLayer<V::Scalar>, at: usize) -> usize {
    let (mut edges, mut crossed, mut lists) = ([ShadowEdge::default(); 99], [0; 33], [0; 99]);
    let lists = lists.get_mut(..layers.shadow_lists_needed(at)).unwrap_or_default();
    let memory = ShadowMemory { edges: &mut edges, crossed: &mut crossed, lists };
    let mut found = [Shadow::default(); 99];
    layers.shadows(at, open, found.get_mut(..at).unwrap_or_default(), memory).unwrap_or(5)
}

/// In double precision.
#[unsafe(no_mangle)]
pub extern "C" fn nopanic_layers_f64(edges: &[f64; 9], n: usize, triangles: &[[DVec3; 3]; 9], r: f64) -> usize {
    asked(edges.get(..n).unwrap_or(edges), triangles.get(n..).unwrap_or(triangles), n, r)
}

/// In single precision.
#[unsafe(no_mangle)]
pub extern "C" fn nopanic_layers_f32(edges: &[f32; 9], n: usize, triangles: &[[Vec3; 3]; 9], r: f32) -> usize {
    asked(edges.get(..n).unwrap_or(edges), triangles.get(n..).unwrap_or(triangles), n, r)
}
