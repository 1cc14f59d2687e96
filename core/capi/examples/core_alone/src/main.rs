//! Porosity of two boxes made of triangles, ten steps of gas through it, and the distance of two bodies, by `voidage-core` alone.

use glam::DVec3;
use std::error::Error;
use voidage_core::convex::{self, AnyBody, Clearance, shape::Capsule};
use voidage_core::flow::{
    Boundary, Fields, FieldsMut, Fractions, Gas, Merging, Mesh, Prepared, Primitive, Problem, Treatment, cluster_scratch, prepare,
};
use voidage_core::grid::Grid;
use voidage_core::number::aabb::Aabb;
use voidage_core::surface::bins::Surface;
use voidage_core::surface::layer::{LayerMemory, LayerOptions, LayerSlices, Layers};
use voidage_core::surface::union::{UnionBuffers, UnionMemory};

const CELLS: [usize; 3] = [12, 6, 6];
const COUNT: usize = CELLS[0] * CELLS[1] * CELLS[2];

type Answer<T = ()> = Result<T, Box<dyn Error>>;

/// Twelve triangles, counter-clockwise seen from outside.
fn cuboid(low: [f64; 3], high: [f64; 3]) -> [[DVec3; 3]; 12] {
    const OF: [[usize; 3]; 12] = [
        [0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4],
        [2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6], [1, 3, 5], [3, 7, 5],
    ];
    let corner = |n: usize| DVec3::from_array([0, 1, 2].map(|axis| if n >> axis & 1 == 1 { high[axis] } else { low[axis] }));
    OF.map(|triangle| triangle.map(corner))
}

/// Open fractions of cells, x, y and z faces.
type Beta = [Vec<f64>; 4];

// docs: porosity
fn porosity(grid: &Grid<f64>, bodies: &[Surface<DVec3>]) -> Answer<Beta> {
    // Triangles sorted by layer, in memory of yours; then memory for one layer at a time.
    let needed = Layers::needed(grid, bodies);
    let (mut ids, mut groups) = (vec![0; needed.numbers], vec![Default::default(); needed.groups]);
    let layers = Layers::new(grid, bodies, LayerOptions::default(), &mut ids, &mut groups)?;
    let needed = layers.memory_needed();
    let (mut reals, mut flags) = (vec![0.0; needed.reals], vec![0; needed.flags]);
    let (mut numbers, mut parts) = (vec![0; needed.numbers], vec![Default::default(); needed.groups]);
    let mut union = UnionBuffers::<f64, 64>::default();
    let union: UnionMemory<f64> = union.memory();
    let mut memory = LayerMemory::new(grid, &mut reals, &mut flags, &mut numbers, &mut parts, union)?;

    let faces = |axis| vec![0.0; grid.face_shape(axis).iter().product()];
    let (mut v, mut x, mut y, mut z) = (vec![0.0; grid.cell_count()], faces(0), faces(1), faces(2));
    let mut solid = 0.0;
    for k in 0..grid.cells()[2] {
        let slices = LayerSlices::of_fields(grid, k, &mut v, [&mut x, &mut y, &mut z])?;
        solid += layers.layer(k, slices, None, &mut memory)?.solid_volume;
    }
    println!("solid volume {solid:.15}");
    Ok([v, x, y, z])
}
// docs: end

/// The flow's unknowns.
#[derive(Clone)]
struct State {
    density: Vec<f64>,
    momentum: [Vec<f64>; 3],
    energy: Vec<f64>,
}

impl State {
    fn new() -> Self {
        let zero = || vec![0.0; COUNT];
        State { density: zero(), momentum: [zero(), zero(), zero()], energy: zero() }
    }

    fn view(&self) -> Fields<'_, f64, 3> {
        let momentum = self.momentum.each_ref().map(|m| &m[..]);
        Fields { density: &self.density, momentum, energy: &self.energy, capacity: &[] }
    }

    fn view_mut(&mut self) -> FieldsMut<'_, f64, 3> {
        let State { density, momentum, energy } = self;
        FieldsMut { density, momentum: momentum.each_mut().map(|m| &mut m[..]), energy, capacity: &mut [] }
    }
}

// docs: flow
fn ten_steps(grid: &Grid<f64>, [v, x, y, z]: Beta) -> Answer<[Vec<f64>; 5]> {
    let widths = [0, 1, 2].map(|axis| grid.edges(axis).windows(2).map(|e| e[1] - e[0]).collect::<Vec<_>>());
    let mesh = Mesh::new(widths.each_ref().map(|w| &w[..]))?;
    let fractions = Fractions { volume: v, faces: [x, y, z], flags: vec![0; COUNT] };
    let space: Prepared<_, _, Vec<u32>, 3> = prepare(&mesh, [false; 3], fractions, Treatment::default(), |cells| Merging {
        list: vec![0; cells],
        parent: vec![0; cells],
        scratch: vec![0.0; cluster_scratch(cells)],
    })?;
    let (gas, wall) = (Gas::Ideal { gamma: 1.4 }, [Boundary::Wall; 2]);
    let wind = Primitive { density: 1.0, velocity: [0.5, 0.0, 0.0], pressure: 1.0 };
    let ends = [Boundary::FarField(wind), Boundary::Outlet { pressure: 1.0 }];
    let problem = Problem::new(mesh, gas, [ends, wall, wall])?.with_porosity(space.view())?;

    let (mut old, mut new) = (State::new(), State::new());
    let rest = gas.conserved(&Primitive { density: 1.0, velocity: [0.0; 3], pressure: 1.0 });
    (0..COUNT).for_each(|cell| old.view_mut().set(cell, &rest));
    let (mut marks, mut scratch) = (vec![0; COUNT], vec![0.0; problem.scratch_len()]);
    let mut rate = problem.start(&mut old.view_mut())?;
    for _ in 0..10 {
        rate = problem.step(&old.view(), &mut new.view_mut(), 0.5 / rate, &mut marks, &mut scratch)?.rate;
        std::mem::swap(&mut old, &mut new);
    }
    let state: Vec<Primitive<f64, 3>> = (0..COUNT).filter_map(|c| old.view().get(c)).map(|u| gas.primitive(&u)).collect();
    let velocity = |axis: usize| state.iter().map(|w| w.velocity[axis]).collect();
    let (rho, p) = (state.iter().map(|w| w.density).collect(), state.iter().map(|w| w.pressure).collect());
    Ok([rho, velocity(0), velocity(1), velocity(2), p])
}
// docs: end

/// One number for all bits of some results.
fn mix(hash: &mut u64, values: &[f64]) {
    values.iter().for_each(|value| *hash = hash.rotate_left(7) ^ value.to_bits());
}

fn main() -> Answer {
    let edges = CELLS.map(|n| (0..=n).map(|i| 0.25 * i as f64).collect::<Vec<_>>());
    let grid = Grid::new(&edges[0], &edges[1], &edges[2])?;
    let boxes = [cuboid([0.8, 0.35, 0.35], [1.6, 1.1, 1.1]), cuboid([1.3, 0.6, 0.2], [1.9, 0.9, 1.3])];
    let bodies = boxes.each_ref().map(|b| Surface::new(b));
    let beta = porosity(&grid, &bodies)?;
    let mut hash = 0;
    beta.iter().for_each(|field| mix(&mut hash, field));
    ten_steps(&grid, beta)?.iter().for_each(|field| mix(&mut hash, field));

    // docs: bodies
    let rod = AnyBody::new(Capsule { from: DVec3::ZERO, to: DVec3::new(1.0, 2.0, 3.0), radius: 0.25 })?;
    let block = AnyBody::new(Aabb { min: DVec3::new(2.0, 0.0, 0.0), max: DVec3::new(3.0, 1.0, 1.0) })?;
    let Clearance::Apart { distance, a, b, .. } = convex::distance(&rod, &block) else { return Err("they meet".into()) };
    // docs: end
    mix(&mut hash, &[distance]);
    mix(&mut hash, &a.to_array());
    mix(&mut hash, &b.to_array());
    println!("hash {hash:016X}");
    Ok(())
}
