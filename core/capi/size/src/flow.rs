//! Ten steps of a flow, along one axis and along three.

use crate::{Real, any};
use core::hint::black_box;
use voidage_core::flow::{
    Boundary, Conserved, Error, Fields, FieldsMut, FluxChoice, Fractions, Gas, Merging, Mesh, Prepared, Primitive,
    Problem, Scheme, Treatment, cluster_scratch, prepare, scratch_needed,
};

/// Cells along an axis.
const N: usize = 8;

fn gas_and_scheme() -> (Gas<Real>, Scheme) {
    black_box((Gas::Ideal { gamma: any() }, Scheme::default()))
}

struct State<const D: usize, const COUNT: usize> {
    density: [Real; COUNT],
    momentum: [[Real; COUNT]; D],
    energy: [Real; COUNT],
}

impl<const D: usize, const COUNT: usize> State<D, COUNT> {
    fn new() -> Self {
        State { density: [1.0; COUNT], momentum: [[0.0; COUNT]; D], energy: [2.5; COUNT] }
    }

    fn view(&self) -> Fields<'_, Real, D> {
        let momentum = self.momentum.each_ref().map(|m| &m[..]);
        Fields { density: &self.density, momentum, energy: &self.energy, capacity: &[] }
    }

    fn view_mut(&mut self) -> FieldsMut<'_, Real, D> {
        let momentum = self.momentum.each_mut().map(|m| &mut m[..]);
        FieldsMut { density: &mut self.density, momentum, energy: &mut self.energy, capacity: &mut [] }
    }
}

/// Ten steps; the density that is left in the first cell.
fn steps<F: FluxChoice, const D: usize, const COUNT: usize, const SCRATCH: usize>(
    problem: &Problem<'_, Real, D>,
) -> Result<Real, Error> {
    let (mut old, mut new) = (State::<D, COUNT>::new(), State::<D, COUNT>::new());
    let (mut marks, mut scratch) = ([0; COUNT], [0.0; SCRATCH]);
    let mut rate = problem.start(&mut old.view_mut())?;
    for _ in 0..10 {
        rate = problem.step_by::<F>(&old.view(), &mut new.view_mut(), 0.5 / rate, &mut marks, &mut scratch)?.rate;
        core::mem::swap(&mut old, &mut new);
    }
    Ok(old.view().get(0).map_or(0.0, |u: Conserved<Real, D>| u.density))
}

/// Along one axis, in open space.
pub fn line<F: FluxChoice>() -> Option<Real> {
    let widths = black_box([0.1; N]);
    let (gas, scheme) = gas_and_scheme();
    let problem =
        Problem::new(Mesh::new([&widths]).ok()?, gas, black_box([[Boundary::Wall; 2]])).ok()?.with_scheme(scheme);
    steps::<F, 1, N, { scratch_needed([N]) }>(&problem).ok()
}

/// Along three axes, in a porous space with small cells.
pub fn space<F: FluxChoice>() -> Option<Real> {
    const COUNT: usize = N * N * N;
    const FACES: usize = (N + 1) * N * N;
    let widths = black_box([0.1; N]);
    let (mut v, [mut x, mut y, mut z], mut flags) = black_box(([0.5; COUNT], [[0.5; FACES]; 3], [0; COUNT]));
    let mesh = Mesh::new([&widths; 3]).ok()?;
    let fractions =
        Fractions { volume: &mut v[..], faces: [&mut x[..], &mut y[..], &mut z[..]], flags: &mut flags[..] };
    let (mut list, mut parent, mut scratch) = ([0; COUNT], [0; COUNT], [0.0; cluster_scratch(COUNT)]);
    let space: Prepared<_, _, _, 3> = prepare(&mesh, [false; 3], fractions, Treatment::default(), |_| Merging {
        list: &mut list[..],
        parent: &mut parent[..],
        scratch: &mut scratch[..],
    })
    .ok()?;
    let (gas, scheme) = gas_and_scheme();
    let wind = Primitive { density: any(), velocity: [any(), 0.0, 0.0], pressure: any() };
    let sides = black_box([
        [Boundary::FarField(wind), Boundary::Outlet { pressure: 1.0 }],
        [Boundary::Wall; 2],
        [Boundary::Wall; 2],
    ]);
    let problem = Problem::new(mesh, gas, sides).ok()?.with_scheme(scheme).with_porosity(space.view()).ok()?;
    steps::<F, 3, COUNT, { scratch_needed([N; 3]) }>(&problem).ok()
}
