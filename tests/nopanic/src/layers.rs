//! The grid, and triangles sorted into its layers.

use glam::{DVec3, Vec3};
use voidage_core::grid::{Grid, Located};
use voidage_core::number::real::{Real, Vector};
use voidage_core::surface::bins::{Group, Surface};
use voidage_core::surface::layer::{
    AreaSlices, CellSides, KnownSurface, LayerMemory, LayerOptions, LayerSlices, Layers, OpenLayer,
};
use voidage_core::surface::shadow::{ShadowEdge, ShadowFace, ShadowMemory, ShadowSlices};
use voidage_core::surface::surface_area::{CellSurface, KeptPiece, KeptPieces, PieceMemory, SurfaceCell};
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
    let Ok(mut memory) = LayerMemory::new(grid, &mut reals, &mut flags, &mut numbers, &mut groups, union) else {
        return 1;
    };
    let mut fields = [[zero; 99]; 16];
    let mut slices = fields.iter_mut().map(|f| f.as_mut_slice());
    let mut next = || -> Option<LayerSlices<V::Scalar>> {
        let (cell, x, y, z) = (slices.next()?, slices.next()?, slices.next()?, slices.next()?);
        LayerSlices::of_fields(grid, at, cell, [x, y, z]).ok()
    };
    let (Some(beta), Some(low), Some(high), Some(again)) = (next(), next(), next(), next()) else { return 2 };
    let porosity = layers.layer(at, beta, Some([low, high]), &mut memory).map_or(3, |report| report.divided);
    let (mut union, mut sides) = ([SurfaceCell::default(); 99], [CellSides::default(); 99]);
    let mut cells = [CellSurface::default(); 99];
    let (mut numbers, mut pieces, mut corners) = ([0; 99], [KeptPiece::default(); 9], [[zero; 3]; 40]);
    let areas = AreaSlices {
        union: union.get_mut(..at).unwrap_or_default(),
        sides: sides.get_mut(..at).unwrap_or_default(),
        cells: cells.get_mut(..at).unwrap_or_default(),
        numbers: numbers.get_mut(..at).unwrap_or_default(),
        pieces: PieceMemory { pieces: &mut pieces, corners: &mut corners },
        fractions_known: at.is_multiple_of(2),
    };
    let found = layers.layer_and_areas(at, again, None, areas, &mut memory, |_, _| ());
    let (unproved, used) = found.map_or((4, 0), |(_, report)| (report.unproved, report.sides));
    let open = [V::Scalar::HALF; 99];
    let of = |count: usize| open.get(..count).unwrap_or(&open);
    let known = OpenLayer { cell: of(at), x: of(at + 1), y: of(at + 2), z: of(at), top: of(at) };
    let finished =
        layers.finish_areas(at, &known, sides.get(..used).unwrap_or_default(), union.get_mut(..at).unwrap_or_default());
    let kept = KeptPieces { cells: union.get(..at).unwrap_or_default(), pieces: &pieces, corners: &corners };
    let (weights, wanted) = ([[zero; 2]; 5], [true; 99]);
    let mut sums = [[[zero; 3]; 2]; 99];
    let sums = sums.get_mut(..at).unwrap_or_default();
    let all = layers.weighted_frontal_areas(at, &weights, sums);
    let wanted = (&weights[..], wanted.get(..at).unwrap_or_default());
    let visible = layers.visible_frontal_areas(at, wanted, sums, &mut memory);
    let weighted = usize::from(all.is_ok()) ^ visible.unwrap_or(1);
    porosity ^ weighted ^ unproved ^ usize::from(finished.is_ok()) ^ shadowed(layers, &known, (kept, sides.get(..used).unwrap_or_default()), at)
}

fn shadowed<V: Vector>(
    layers: &Layers<V>,
    open: &OpenLayer<V::Scalar>,
    surface: KnownSurface<V::Scalar>,
    at: usize,
) -> usize {
    let (mut edges, mut places, mut lists) = ([ShadowEdge::default(); 99], [0; 33], [0; 99]);
    let lists = lists.get_mut(..layers.shadow_lists_needed(at)).unwrap_or_default();
    let mut faces = core::array::from_fn::<_, 9, _>(|_| ShadowFace::default());
    let memory = ShadowMemory { edges: &mut edges, places: &mut places, lists, faces: &mut faces };
    let (mut share, mut place) = ([[V::Scalar::ZERO; 99]; 3], [[V::Scalar::ZERO; 99]; 3]);
    let mut slices = ShadowSlices {
        share: share.each_mut().map(|field| field.get_mut(..at).unwrap_or_default()),
        place: place.each_mut().map(|field| field.get_mut(..at).unwrap_or_default()),
    };
    layers.shadows(at, open, surface, slices.reborrow(), memory).map_or(5, |report| report.too_full)
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
