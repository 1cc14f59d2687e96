//! The same bits along every axis, mirrored, permuted, over open porosity, for any number of threads, at rest.

use voidage::flow::{Flow, Scalar, Treatment};
use voidage_core::flow::{Boundary, Gas, Limiter, PressureForm, Primitive, Riemann};
use voidage_tests::euler::property::{Source, bits, porosity, step_stays_physical};

const IDEAL: Gas<f64> = Gas::Ideal { gamma: 1.4 };

/// A blast in a line of `m` cells along `axis`, uniform across; density, axial velocity and pressure along it.
fn line<R: Scalar, const D: usize>(axis: usize, mirrored: bool) -> Vec<[u64; 3]> {
    let m = 40;
    let mut n = [2; D];
    n[axis] = m;
    let gas = Gas::Ideal { gamma: R::from_f64(1.4) };
    let mut boundaries = [[Boundary::Periodic; 2]; D];
    boundaries[axis] =
        if mirrored { [Boundary::ZeroGradient, Boundary::Wall] } else { [Boundary::Wall, Boundary::ZeroGradient] };
    let mut flow: Flow<R, D> = Flow::uniform(n, [R::from_f64(0.025); D], gas, boundaries);
    let stride: usize = n[..axis].iter().product();
    let along = |cell: usize| cell / stride % m;
    for cell in 0..flow.len() {
        let i = if mirrored { m - 1 - along(cell) } else { along(cell) };
        let mut velocity = [R::ZERO; D];
        velocity[axis] = R::from_f64(if mirrored { -0.3 } else { 0.3 } * (i as f64 * 0.2).sin());
        let density = R::from_f64(1.0 + 0.5 * (i as f64 * 0.7).cos());
        let pressure = R::from_f64(if i < 9 { 10.0 } else { 0.1 });
        flow.set(cell, &Primitive { density, velocity, pressure });
    }
    for _ in 0..30 {
        flow.step(R::from_f64(0.002)).unwrap();
    }
    (0..flow.len())
        .filter(|c| c % stride == 0 && (c / stride) / m == 0)
        .map(|c| if mirrored { (m - 1 - along(c)) * stride } else { c })
        .map(|c| {
            let w = flow.get(c);
            let sign = if mirrored { -R::ONE } else { R::ONE };
            [w.density, sign * w.velocity[axis], w.pressure].map(|x| (x + R::ZERO).to_f64().to_bits())
        })
        .collect()
}

#[test]
fn axes_are_alike_and_mirrored_to_the_bit() {
    let x = line::<f64, 1>(0, false);
    assert!(x.iter().any(|s| s[1] != 0));
    for axis in 0..3 {
        assert_eq!(line::<f64, 3>(axis, false), x, "axis {axis}");
        assert_eq!(line::<f64, 3>(axis, true), x, "axis {axis} mirrored");
    }
    for axis in 0..2 {
        assert_eq!(line::<f64, 2>(axis, false), x);
        assert_eq!(line::<f64, 2>(axis, true), x);
    }
    let single = line::<f32, 1>(0, false);
    for axis in 0..3 {
        assert_eq!(line::<f32, 3>(axis, false), single);
    }
}

/// A random flow in a block of cells with random porosity and drag.
#[derive(Clone, Copy)]
struct Block {
    n: [usize; 3],
    sides: Boundary<f64, 3>,
    /// Faces and volumes are open or hardly so, and small cells have many equal neighbours.
    alike: bool,
    seed: u64,
    riemann: Riemann,
    gas: Gas<f64>,
    steps: usize,
}

/// A gas of two ratios of specific heats.
const MIXED: Gas<f64> = Gas::Mixed { gammas: [1.2, 1.67] };

/// The flow in a block whose axes are exchanged and then turned around, told in the frame of the block.
fn turned_block(block: Block, order: [usize; 3], turned: [bool; 3]) -> Vec<[u64; 6]> {
    let Block { n, sides, alike, seed, riemann, gas, steps } = block;
    let mut s = Source::seeded(seed);
    let mut s = move || s.unit();
    let cells = n.iter().product();
    let data: Vec<[f64; 9]> = (0..cells).map(|_| std::array::from_fn(|_| s())).collect();
    let some = |x: f64| if alike { 1.0 } else { 0.3 + 0.7 * x };
    let volumes: Vec<f64> = (0..cells).map(|_| if s() < 0.1 { 1e-9 } else { some(s()) }).collect();
    let faces: [Vec<f64>; 3] = std::array::from_fn(|d| {
        let count: usize = (0..3).map(|a| n[a] + usize::from(a == d)).product();
        (0..count).map(|_| if s() < 0.1 { 0.0 } else { some(s()) }).collect()
    });
    // Axis a of the new mesh is axis order[a] of the old.
    let m = order.map(|a| n[a]);
    let place = |at: [usize; 3], size: [usize; 3]| {
        let mut old = [0; 3];
        for a in 0..3 {
            old[order[a]] = if turned[a] { size[a] - 1 - at[a] } else { at[a] };
        }
        old
    };
    let old_cell = |new: usize| {
        let old = place([new % m[0], new / m[0] % m[1], new / m[0] / m[1]], m);
        (old[2] * n[1] + old[1]) * n[0] + old[0]
    };
    let volume: Vec<f64> = (0..cells).map(|c| volumes[old_cell(c)]).collect();
    let face: [Vec<f64>; 3] = std::array::from_fn(|a| {
        let size: [usize; 3] = std::array::from_fn(|b| m[b] + usize::from(a == b));
        let d = order[a];
        (0..size.iter().product::<usize>())
            .map(|f| {
                let old = place([f % size[0], f / size[0] % size[1], f / size[0] / size[1]], size);
                let stride: [usize; 3] = std::array::from_fn(|b| n[b] + usize::from(b == d));
                faces[d][(old[2] * stride[1] + old[1]) * stride[0] + old[0]]
            })
            .collect()
    });
    let sign = |a: usize| if turned[a] { -1.0 } else { 1.0 };
    let mut flow = Flow::uniform(m, [0.1; 3], gas, [[sides; 2]; 3]);
    flow.scheme.riemann = riemann;
    flow.set_porosity(volume, face, Treatment::default()).unwrap();
    flow.set_drag(
        std::array::from_fn(|a| (0..cells).map(|c| 100.0 * data[old_cell(c)][5 + order[a]]).collect()),
        [vec![], vec![], vec![]],
    )
    .expect("drag");
    for c in 0..cells {
        let d = data[old_cell(c)];
        let velocity = std::array::from_fn(|a| sign(a) * (d[1 + order[a]] - 0.5));
        flow.set_mixed(c, &Primitive { density: 0.5 + d[0], velocity, pressure: 0.1 + 3.0 * d[4] }, 1.2 + 0.47 * d[8]);
    }
    for _ in 0..steps {
        flow.step(0.004).unwrap();
    }
    let mut out = vec![[0; 6]; cells];
    for c in 0..cells {
        let w = flow.get(c);
        let mut velocity = [0.0; 3];
        for a in 0..3 {
            velocity[order[a]] = sign(a) * w.velocity[a];
        }
        let gamma = flow.gas_at(c).gamma();
        out[old_cell(c)] =
            [w.density, velocity[0], velocity[1], velocity[2], w.pressure, gamma].map(|x| (x + 0.0).to_bits());
    }
    out
}

#[test]
fn exchanged_and_turned_axes_give_the_same_bits() {
    for riemann in [Riemann::Hllc, Riemann::HllcLowMach, Riemann::Hlle, Riemann::Rusanov] {
        for (seed, alike, gas) in [
            (0, false, IDEAL),
            (1, false, IDEAL),
            (2, true, IDEAL),
            (3, true, IDEAL),
            (4, false, MIXED),
            (5, true, MIXED),
        ] {
            let block = Block { n: [5, 6, 7], sides: Boundary::Wall, alike, seed, riemann, gas, steps: 8 };
            let plain = [false; 3];
            let reference = turned_block(block, [0, 1, 2], plain);
            for order in [[1, 0, 2], [2, 1, 0], [0, 2, 1], [1, 2, 0], [2, 0, 1]] {
                assert!(turned_block(block, order, plain) == reference, "{riemann:?} {order:?} seed {seed}");
            }
            for turned in [[true, false, false], [false, true, false], [false, false, true], [true; 3]] {
                let same = turned_block(block, [1, 2, 0], turned) == reference;
                assert!(same, "{riemann:?} {turned:?} seed {seed}");
            }
        }
    }
}

/// Layers of many cells are swept in tiles of rows; with the shortest axis first there is one tile only.
#[test]
fn layers_in_tiles_give_the_bits_of_one() {
    for (seed, sides, gas) in
        [(0, Boundary::Wall, MIXED), (1, Boundary::Periodic, IDEAL), (2, Boundary::ZeroGradient, MIXED)]
    {
        let block = Block { n: [280, 29, 3], sides, alike: false, seed, riemann: Riemann::Hllc, gas, steps: 3 };
        let whole = turned_block(block, [2, 1, 0], [false; 3]);
        for order in [[0, 1, 2], [1, 0, 2]] {
            assert!(turned_block(block, order, [false; 3]) == whole, "{sides:?} {order:?} {gas:?}");
        }
    }
}

fn rest<R: Scalar, const D: usize>(seed: u64, gas: Gas<R>, riemann: Riemann) {
    let mut s = Source::seeded(seed);
    let n: [usize; D] = std::array::from_fn(|d| 5 + d);
    let (volume, faces) = porosity::<R, D>(&mut s, n);
    let mut flow: Flow<R, D> = Flow::uniform(n, [R::from_f64(0.37); D], gas, [[Boundary::Wall; 2]; D]);
    flow.scheme.riemann = riemann;
    flow.set_porosity(volume, faces, Treatment::default()).unwrap();
    let p = R::from_f64(101325.0);
    for cell in 0..flow.len() {
        // Only HLLC keeps a jump of density where it stands; a barotropic gas has one density per pressure.
        let density = match gas.density(p) {
            Some(rho) => rho,
            None if riemann == Riemann::Hllc => R::from_f64(s.scale(0.1, 10.0)),
            None => R::from_f64(1.2),
        };
        flow.set(cell, &Primitive { density, velocity: [R::ZERO; D], pressure: p });
    }
    // The pressure must come back from the energy alike in all cells; round it once more until it does.
    let start = bits(&flow.state);
    for limiter in [Limiter::Steep, Limiter::AroraRoe, Limiter::MonotonizedCentral, Limiter::VanLeer] {
        for pressure in [PressureForm::Geometric, PressureForm::Paper] {
            flow.scheme.limiter = limiter;
            flow.scheme.pressure = pressure;
            for _ in 0..12 {
                let dt = flow.stable_dt(R::from_f64(0.8)).unwrap();
                if dt.is_finite() {
                    flow.step(dt).unwrap();
                }
            }
            assert!(bits(&flow.state) == start, "moved: {D}D seed {seed} {gas:?} {riemann:?} {limiter:?} {pressure:?}");
        }
    }
}

#[test]
fn gas_at_rest_stays_at_rest_to_the_bit_over_random_porosity() {
    for seed in 0..4 {
        for riemann in [Riemann::Hllc, Riemann::HllcLowMach, Riemann::Hlle, Riemann::Rusanov] {
            rest::<f64, 1>(seed, IDEAL, riemann);
            rest::<f64, 2>(seed, IDEAL, riemann);
            rest::<f64, 3>(seed, IDEAL, riemann);
            rest::<f64, 3>(seed, Gas::Isothermal { sound_speed: 340.0 }, riemann);
            rest::<f64, 2>(seed, Gas::Isentropic { gamma: 1.4, density: 1.2, pressure: 1e5 }, riemann);
            rest::<f32, 3>(seed, Gas::Ideal { gamma: 1.4 }, riemann);
        }
    }
}

fn open_equals_plain<R: Scalar, const D: usize>(form: PressureForm) {
    let n: [usize; D] = std::array::from_fn(|d| 9 - d);
    let make = |porous: bool| {
        let mut s = Source::seeded(7);
        let mut flow: Flow<R, D> = Flow::uniform(
            n,
            [R::from_f64(0.1); D],
            Gas::Ideal { gamma: R::from_f64(1.4) },
            [[Boundary::Wall, Boundary::ZeroGradient]; D],
        );
        flow.scheme.pressure = form;
        if porous {
            let faces = std::array::from_fn(|d| vec![R::ONE; (0..D).map(|a| n[a] + usize::from(a == d)).product()]);
            flow.set_porosity(vec![R::ONE; n.iter().product()], faces, Treatment::default()).unwrap();
        }
        for cell in 0..flow.len() {
            let w = Primitive {
                density: R::from_f64(0.3 + s.unit()),
                velocity: std::array::from_fn(|_| R::from_f64(s.unit() - 0.5)),
                pressure: R::from_f64(s.scale(0.1, 10.0)),
            };
            flow.set(cell, &w);
        }
        for _ in 0..20 {
            flow.step(R::from_f64(0.003)).unwrap();
        }
        bits(&flow.state)
    };
    assert!(make(false) == make(true), "{D}D {form:?}");
}

#[test]
fn open_porosity_equals_the_plain_kernel_to_the_bit() {
    for form in [PressureForm::Geometric, PressureForm::Paper] {
        open_equals_plain::<f64, 1>(form);
        open_equals_plain::<f64, 2>(form);
        open_equals_plain::<f64, 3>(form);
        open_equals_plain::<f32, 3>(form);
    }
}

#[test]
fn any_number_of_threads_and_a_restart_give_the_same_bits() {
    let run = |threads: usize, stop: bool| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let start = || {
                let mut s = Source::seeded(3);
                let n = [10, 9, 33];
                let (volume, faces) = porosity::<f64, 3>(&mut s, n);
                let sides = [[Boundary::Wall; 2], [Boundary::Wall; 2], [Boundary::Periodic; 2]];
                let mut flow: Flow<f64, 3> = Flow::uniform(n, [0.1; 3], IDEAL, sides);
                flow.set_porosity(volume, faces, Treatment::default()).unwrap();
                for cell in 0..flow.len() {
                    let w = Primitive {
                        density: s.scale(1e-3, 1.0),
                        velocity: std::array::from_fn(|_| 6.0 * s.unit() - 3.0),
                        pressure: s.scale(1e-4, 10.0),
                    };
                    flow.set(cell, &w);
                }
                flow
            };
            let mut flow = start();
            for step in 0..16 {
                if stop && step == 8 {
                    // What a checkpoint keeps: the state and the clock; everything else is made again.
                    let (state, clock) = (flow.state.clone(), flow.clock().unwrap());
                    flow = start();
                    flow.resume(state, clock).unwrap();
                }
                flow.step(2e-3).unwrap();
            }
            (bits(&flow.state), flow.total.first_order > 0)
        })
    };
    let one = run(1, false);
    assert!(one.1, "the fallback was not visited");
    for threads in 2..=4 {
        assert!(run(threads, false).0 == one.0, "{threads} threads");
    }
    assert!(run(1, true).0 == one.0, "restart");
}

#[test]
fn random_steps_stay_physical() {
    for seed in 0..400 {
        let mut s = Source::seeded(seed);
        step_stays_physical::<f64, 1>(&mut s);
        step_stays_physical::<f64, 2>(&mut s);
        step_stays_physical::<f64, 3>(&mut s);
        step_stays_physical::<f32, 1>(&mut s);
        step_stays_physical::<f32, 2>(&mut s);
        step_stays_physical::<f32, 3>(&mut s);
    }
}
