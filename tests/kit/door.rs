//! Property of the core's porosity of layers: whatever triangles, memory and indices it is given, it does not panic, and its bounds are in
//! order and hold its values.

use crate::random::Random;
use std::array::from_fn;
use voidage_core::grid::Grid;
use voidage_core::grid::fields::{Fields, Layer};
use voidage_core::number::real::{Real, Vector};
use voidage_core::surface::bins::{Group, Surface};
use voidage_core::surface::cells::{Scratch, add_body};
use voidage_core::surface::layer::{LayerMemory, LayerOptions, LayerSlices, Layers};
use voidage_core::surface::union::{UnionBuffers, UnionMemory};
use voidage_core::surface::z_faces::{Side, add_section};

/// Coordinates that break arithmetic.
const EXTREME: [f64; 14] = [
    0.0,
    -0.0,
    1.0,
    1e-300,
    -1e-310,
    1e-40,
    1e30,
    -1e30,
    3e38,
    1e300,
    f64::MAX,
    f64::MIN_POSITIVE,
    f64::NAN,
    f64::INFINITY,
];

/// A coordinate of one of five kinds: on a lattice, anywhere, off a lattice by rounding, extreme, now and then extreme.
fn coordinate(random: &mut Random, kind: usize) -> f64 {
    match kind {
        0 => random.below(9) as f64 / 4.0 - 0.5,
        1 => random.between(-0.5, 1.5),
        2 => random.below(5) as f64 / 4.0 + random.between(-1e-9, 1e-9) * 10_f64.powi(-(random.below(7) as i32)),
        3 => EXTREME[random.below(12)],
        _ if random.below(6) == 0 => EXTREME[random.below(EXTREME.len())],
        _ => random.unit(),
    }
}

/// Some triangles: a closed tetrahedron, or any.
fn solid<V: Vector>(random: &mut Random) -> Vec<[V; 3]> {
    let kind = random.below(5);
    let mut point = || V::from_array(from_fn(|_| V::Scalar::from_f64(coordinate(random, kind))));
    let corner: [V; 4] = from_fn(|_| point());
    let any: Vec<[V; 3]> = (0..8).map(|_| from_fn(|_| point())).collect();
    match random.below(12) {
        count @ 0..8 => any[..count].to_vec(),
        _ => [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].map(|t| t.map(|n: usize| corner[n])).to_vec(),
    }
}

fn edges<R: Real>(random: &mut Random) -> Vec<R> {
    let n = random.below(6);
    let (first, size) = [(0.0, 1e-30), (1e6, 1.0), (-1e15, 1e15), (0.0, 1.0), (0.0, 1.0), (0.0, 1.0)][random.below(6)];
    (0..=n).map(|i| R::from_f64(first + size * i as f64 / n as f64)).collect()
}

/// All of a length, or less.
fn cut(random: &mut Random, length: usize) -> usize {
    if random.below(3) == 0 { random.below(length + 1) } else { length }
}

/// One body by itself, in a layer and with triangles that may not be there.
fn one_body<V: Vector>(random: &mut Random, grid: &Grid<V::Scalar>, solid: &[[V; 3]]) {
    let (zero, length) = (V::Scalar::ZERO, Fields::<u8>::needed(grid));
    let (mut lower, mut sum, mut flags) = (vec![zero; length], vec![zero; length], vec![0; length]);
    let mut scratch = vec![zero; Scratch::needed(grid)];
    let lower = Fields::within(grid, &mut lower).expect("room");
    let (sum, flags) = (Fields::within(grid, &mut sum).expect("room"), Fields::within(grid, &mut flags).expect("room"));
    let mut layer = Layer::new(lower, sum, flags).expect("fields of one grid");
    let mut scratch = Scratch::new(grid, &mut scratch).expect("room");
    let ids: Vec<u32> = (0..random.below(9)).map(|_| random.below(10) as u32).collect();
    let (k, side) = (random.below(7), if random.below(2) == 0 { Side::Above } else { Side::Below });
    let cells = add_body(grid, k, solid, &ids, &mut scratch, &mut layer);
    let faces = add_section(grid, k, side, solid, &ids, &mut scratch, &mut layer);
    let [_, _, nz] = grid.cells();
    assert!(k < nz || cells.is_err());
    assert!(k <= nz || faces.is_err());
    assert!(cells.is_err() || ids.iter().all(|&id| (id as usize) < solid.len()));
}

/// Memory for unions, some of it short.
fn short_of<'a, R: Real>(random: &mut Random, memory: UnionMemory<'a, R>) -> UnionMemory<'a, R> {
    let UnionMemory { pieces, split_pieces, order, nodes, parts, fragments, pending, octants, near } = memory;
    let mut cut = |length: usize| cut(random, length);
    UnionMemory {
        pieces: {
            let n = cut(pieces.len());
            &mut pieces[..n]
        },
        split_pieces: {
            let n = cut(split_pieces.len());
            &mut split_pieces[..n]
        },
        order: {
            let n = cut(order.len());
            &mut order[..n]
        },
        nodes: {
            let n = cut(nodes.len());
            &mut nodes[..n]
        },
        parts: {
            let n = cut(parts.len());
            &mut parts[..n]
        },
        fragments: {
            let n = cut(fragments.len());
            &mut fragments[..n]
        },
        pending: {
            let n = cut(pending.len());
            &mut pending[..n]
        },
        octants,
        near,
    }
}

/// A scene from a seed; whether it came as far as its layers.
pub fn never_panics<V: Vector>(seed: u64) -> bool {
    let random = &mut Random::new(seed);
    let lists: [Vec<V::Scalar>; 3] = from_fn(|_| edges(random));
    let Ok(grid) = Grid::new(&lists[0], &lists[1], &lists[2]) else { return false };
    let solids: Vec<Vec<[V; 3]>> = (0..1 + random.below(4)).map(|_| solid(random)).collect();
    one_body(random, &grid, &solids[0]);
    let mut surface = |s| if random.below(9) == 0 { Surface::sheet(s) } else { Surface::new(s) };
    let bodies: Vec<Surface<V>> = solids.iter().map(|s| surface(s)).collect();
    let options = LayerOptions {
        tol: V::Scalar::from_f64([1e-4, 0.0, f64::NAN, 0.1][random.below(4)]),
        depth: random.below(3) as u32,
        areas: random.below(4) > 0,
        solid_end: V::Scalar::HALF,
    };
    let needed = Layers::needed(&grid, &bodies);
    let (mut ids, mut groups) =
        (vec![0; cut(random, needed.numbers)], vec![Group::default(); cut(random, needed.groups)]);
    match Layers::new(&grid, &bodies, options, &mut ids, &mut groups) {
        Ok(layers) => all_layers(random, &grid, &layers, options.areas),
        Err(_) => false,
    }
}

/// All layers of a scene, in memory that may be short.
fn all_layers<V: Vector>(random: &mut Random, grid: &Grid<V::Scalar>, layers: &Layers<V>, areas: bool) -> bool {
    let needed = layers.memory_needed();
    let (mut reals, mut flags) = (vec![V::Scalar::ONE; cut(random, needed.reals)], vec![9; cut(random, needed.flags)]);
    let (mut numbers, mut groups) =
        (vec![5; cut(random, needed.numbers)], vec![Group::default(); cut(random, needed.groups)]);
    let mut union = Box::new(UnionBuffers::<V::Scalar, 24>::default());
    let union = short_of(random, union.memory());
    let memory = LayerMemory::new(grid, &mut reals, &mut flags, &mut numbers, &mut groups, union);
    let Ok(mut memory) = memory else { return false };
    let set = || {
        let faces = |axis| vec![V::Scalar::TWO; if areas { grid.face_shape(axis).iter().product() } else { 0 }];
        [vec![V::Scalar::TWO; grid.cell_count()], faces(0), faces(1), faces(2)]
    };
    let [mut value, mut lower, mut upper] = [set(), set(), set()];
    let [nx, ny, nz] = grid.cells();
    for k in 0..nz {
        let [value, lower, upper] = [&mut value, &mut lower, &mut upper]
            .map(|[v, x, y, z]| LayerSlices::of_fields(grid, k, v, [x, y, z]).expect("fields of the grid"));
        let kinds = layers.layer(k, value, Some([lower, upper]), &mut memory).expect("a layer").cells;
        assert_eq!(kinds.open + kinds.cut + kinds.closed, nx * ny);
    }
    let slack = V::Scalar::EPSILON * V::Scalar::TWO;
    for ((value, lower), upper) in value.iter().flatten().zip(lower.iter().flatten()).zip(upper.iter().flatten()) {
        assert!(V::Scalar::ZERO <= *lower && *upper <= V::Scalar::ONE, "{lower} {upper}");
        assert!(*lower <= *value + slack && *value <= *upper + slack, "{value} in {lower}..{upper}");
    }
    true
}
