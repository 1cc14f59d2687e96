//! Gases of two ratios of specific heats side by side: contacts, shocks, hot balls, porous space.

use voidage::flow::{Flow, Scalar, Treatment};
use voidage_core::flow::{Boundary, Gas, Limiter, Primitive, Riemann};
use voidage_core::number::real::Real;
use voidage_tests::euler::property::{Source, mixed_step_stays_physical};
use voidage_tests::euler::space::{OpenFractions, half_space, open_fractions};
use voidage_tests::euler::two_gases::{GasSide, TwoGases};

const SOLVERS: [Riemann; 4] = [Riemann::Hllc, Riemann::HllcLowMach, Riemann::Hlle, Riemann::Rusanov];
const LIMITERS: [Limiter; 6] = [
    Limiter::Steep,
    Limiter::MonotonizedCentral,
    Limiter::VanLeer,
    Limiter::Minmod,
    Limiter::Unlimited,
    Limiter::FirstOrder,
];

/// Lowest and highest ratio of specific heats.
const GAMMAS: [f64; 2] = [1.2, 1.67];

fn gas<R: Scalar>() -> Gas<R> {
    Gas::Mixed { gammas: GAMMAS.map(R::from_f64) }
}

/// The gas of a cell is within the bounds.
fn within<R: Scalar, const D: usize>(flow: &Flow<R, D>) -> bool {
    let of = |gamma: f64| Gas::Ideal { gamma: R::from_f64(gamma) }.capacity();
    let (least, most) = (of(GAMMAS[1]), of(GAMMAS[0]));
    flow.state.capacity.iter().all(|c| *c >= least && *c <= most)
}

/// Fills a flow with a uniform stream of pressure 1, whose density and γ differ at random from cell to cell: blocks of pure gas, and cells of any
/// mixture.
fn fill_unevenly<R: Scalar, const D: usize>(flow: &mut Flow<R, D>, velocity: [f64; D], seed: u64) {
    let mut s = Source::seeded(seed);
    for cell in 0..flow.len() {
        let share = [0.0, 1.0, s.unit(), 0.0, 1.0][cell / 3 % 5];
        let gamma = if share == 1.0 { GAMMAS[1] } else { GAMMAS[0] + share * (GAMMAS[1] - GAMMAS[0]) };
        let density = R::from_f64(s.scale(0.1, 10.0));
        let w = Primitive { density, velocity: velocity.map(R::from_f64), pressure: R::ONE };
        flow.set_mixed(cell, &w, R::from_f64(gamma));
    }
}

/// The largest error of the pressure, as a share, and of the velocity, over cells of more open volume than `least`.
fn unevenness<R: Scalar, const D: usize>(flow: &Flow<R, D>, velocity: [f64; D], least: f64) -> f64 {
    let of_cell = |cell: usize| {
        let w = flow.get(cell);
        let u = (0..D).map(|d| (w.velocity[d].to_f64() - velocity[d]).abs());
        u.fold((w.pressure.to_f64() - 1.0).abs(), f64::max)
    };
    let open = |cell: &usize| flow.beta_v().is_none_or(|b| b[*cell].to_f64() > least);
    (0..flow.len()).filter(open).map(of_cell).fold(0.0, f64::max)
}

fn stays_even<R: Scalar, const D: usize>(n: [usize; D], most: f64) {
    for (riemann, limiter) in SOLVERS.into_iter().flat_map(|r| LIMITERS.map(|l| (r, l))) {
        for mach in [0.0, 0.2, 3.0] {
            let velocity = std::array::from_fn(|d| mach * [1.0, -0.6, 0.3][d]);
            let width = std::array::from_fn(|d| R::from_f64(0.1 + 0.02 * d as f64));
            let mut flow: Flow<R, D> = Flow::uniform(n, width, gas(), [[Boundary::Periodic; 2]; D]);
            (flow.scheme.riemann, flow.scheme.limiter) = (riemann, limiter);
            fill_unevenly(&mut flow, velocity, 7);
            let begin = flow.content();
            for _ in 0..40 {
                let dt = flow.stable_dt(R::from_f64(0.8)).unwrap();
                flow.step(dt).unwrap();
            }
            let error = unevenness(&flow, velocity, 0.0);
            assert!(error <= most, "{riemann:?} {limiter:?} Mach {mach}: {error:e}");
            assert!(within(&flow), "{riemann:?} {limiter:?} Mach {mach}");
            assert_eq!(flow.total.floored, 0, "{riemann:?} {limiter:?} Mach {mach}");
            let end = flow.content();
            for (a, b) in [(begin.density, end.density), (begin.energy, end.energy)] {
                assert!((b / a - R::ONE).abs().to_f64() <= most, "{riemann:?} {limiter:?} Mach {mach}: {a} {b}");
            }
        }
    }
}

#[test]
fn a_contact_of_two_gases_keeps_pressure_and_velocity() {
    stays_even::<f64, 1>([30], 1e-12);
    stays_even::<f64, 1>([300], 1e-12);
    stays_even::<f64, 2>([11, 9], 1e-12);
    stays_even::<f64, 3>([6, 5, 7], 1e-12);
    stays_even::<f32, 2>([11, 9], 1e-4);
}

/// In steps that are as long as they may be, along the diagonal and from corner to corner, no γ leaves the bounds, and first order is not needed for it.
#[test]
fn a_stream_of_one_velocity_keeps_the_bounds_by_itself() {
    for direction in [[1.0, 1.0], [1.0, -0.2], [0.05, 1.0]] {
        let velocity = direction.map(|u: f64| 50.0 * u);
        let mut flow: Flow<f64, 2> = Flow::uniform([24, 24], [0.1; 2], gas(), [[Boundary::Periodic; 2]; 2]);
        flow.scheme.limiter = Limiter::Steep;
        flow.fill_mixed(|[x, y]| {
            let inside = (x - 1.2).powi(2) + (y - 1.2).powi(2) < 0.5;
            (Primitive { density: 1.0, velocity, pressure: 1.0 }, GAMMAS[usize::from(inside)])
        });
        for _ in 0..60 {
            let dt = flow.stable_dt(0.98).unwrap();
            flow.step(dt).unwrap();
        }
        assert_eq!((flow.total.first_order, flow.total.floored), (0, 0), "{direction:?}");
        assert!(within(&flow) && unevenness(&flow, velocity, 0.0) < 1e-11, "{direction:?}");
        let spread = flow.state.capacity.iter().fold([f64::MAX, 0.0], |[a, b]: [f64; 2], c| [a.min(*c), b.max(*c)]);
        assert!(spread[1] - spread[0] > 0.8 * (5.0 - 1.0 / 0.67), "the disc has dissolved: {spread:?}");
    }
}

fn even_along_a_wall<const D: usize>(n: [usize; D], normal: [f64; D], through: f64, velocity: [f64; D]) {
    let offset = normal.iter().map(|a| a * through).sum();
    let open: OpenFractions<D> = open_fractions(n, [0.0; D], 0.1, |low, high| half_space(normal, offset, low, high));
    let side = Boundary::FarField(Primitive { density: 1.0, velocity, pressure: 1.0 });
    for riemann in SOLVERS {
        let mut flow: Flow<f64, D> = Flow::uniform(n, [0.1; D], gas(), [[side; 2]; D]);
        flow.scheme.riemann = riemann;
        flow.feed_sides = [[1.4; 2]; D];
        flow.set_porosity(open.volume.clone(), open.faces.clone(), Treatment::default()).unwrap();
        fill_unevenly(&mut flow, velocity, 5);
        for _ in 0..30 {
            flow.advance(0.8, f64::MAX).unwrap();
        }
        let error = unevenness(&flow, velocity, 0.0);
        assert!(error < 1e-12, "{riemann:?} {normal:?} {velocity:?}: {error:e}");
        assert!(within(&flow) && flow.total.floored == 0, "{riemann:?} {normal:?}");
        assert!(flow.merged_cells() > 0, "no small cell");
    }
}

/// Cells cut by a plane, small ones among them, along which the gases flow: pressure and velocity stay.
#[test]
fn a_contact_along_an_inclined_wall_keeps_pressure_and_velocity() {
    for degrees in [5.0f64, 30.0, 72.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        for mach in [0.1, 2.0] {
            even_along_a_wall([24, 22], [-sin, cos], 1.17, [mach * cos, mach * sin]);
        }
    }
    even_along_a_wall([12, 11, 10], [1.0, 2.0, 3.0], 0.55, [0.3, 0.3, -0.3]);
}

/// Tubes with a name, their states, and a time.
const TUBES: [(&str, GasSide, GasSide, f64); 8] = [
    ("air and helium", GasSide::new(1.0, 0.0, 1.0, 1.4), GasSide::new(0.125, 0.0, 0.1, 1.67), 0.2),
    ("burnt and fresh", GasSide::new(0.3, 0.0, 8.0, 1.25), GasSide::new(1.2, 0.0, 1.0, 1.4), 0.09),
    ("fresh and burnt", GasSide::new(7.0, 0.0, 8.0, 1.4), GasSide::new(0.15, 0.0, 1.0, 1.2), 0.09),
    ("slow", GasSide::new(1.0, 0.02, 1.002, 1.2), GasSide::new(0.2, 0.02, 1.0, 1.67), 0.2),
    ("fast", GasSide::new(1.0, 6.0, 2.0, 1.67), GasSide::new(3.0, 6.0, 1.0, 1.2), 0.05),
    ("strong", GasSide::new(1.0, 0.0, 1e4, 1.67), GasSide::new(1.0, 0.0, 1.0, 1.2), 0.002),
    ("strong the other way", GasSide::new(1.0, 0.0, 1e4, 1.2), GasSide::new(0.1, 0.0, 1.0, 1.67), 0.0008),
    ("streams that meet", GasSide::new(1.0, 2.0, 1.0, 1.67), GasSide::new(4.0, -1.0, 1.0, 1.2), 0.15),
];

/// The tube of two gases on `n` cells from −½ to ½ after its time.
fn tube<R: Scalar>(n: usize, (_, left, right, time): (&str, GasSide, GasSide, f64), riemann: Riemann) -> Flow<R, 1> {
    let mut flow: Flow<R, 1> = Flow::uniform([n], [R::from_f64(1.0 / n as f64)], gas(), [[Boundary::ZeroGradient; 2]]);
    (flow.scheme.riemann, flow.scheme.limiter) = (riemann, Limiter::MonotonizedCentral);
    flow.careful_steps = 5;
    flow.fill_mixed(|[x]| {
        let GasSide { rho, u, p, gamma } = if x.to_f64() < 0.5 { left } else { right };
        let [density, u, pressure, gamma] = [rho, u, p, gamma].map(R::from_f64);
        (Primitive { density, velocity: [u], pressure }, gamma)
    });
    flow.run(R::from_f64(0.8), R::from_f64(time)).unwrap();
    assert_eq!(flow.total.floored, 0);
    flow
}

/// Mean errors of density, pressure and γ over the spans of the exact solution.
fn errors<R: Scalar>(flow: &Flow<R, 1>, (_, left, right, time): (&str, GasSide, GasSide, f64)) -> [f64; 3] {
    let (exact, n) = (TwoGases::new(left, right), flow.len());
    let quantities: [fn(GasSide) -> f64; 3] = [|s| s.rho, |s| s.p, |s| s.gamma];
    let means: Vec<[f64; 3]> = (0..n)
        .map(|i| {
            let edge = |i: usize| i as f64 / n as f64 - 0.5;
            quantities.map(|q| exact.mean(q, [edge(i), edge(i + 1)], time))
        })
        .collect();
    std::array::from_fn(|q| {
        let found = |i: usize| {
            let w = flow.get(i);
            [w.density, w.pressure, flow.gas_at(i).gamma()][q].to_f64()
        };
        let of = means.iter().map(|m| m[q]);
        let span = of.clone().fold(f64::MIN, f64::max) - of.fold(f64::MAX, f64::min);
        (0..n).map(|i| (found(i) - means[i][q]).abs()).sum::<f64>() / (n as f64 * span)
    })
}

#[test]
fn tubes_of_two_gases_converge_to_the_exact_solution() {
    for problem in TUBES {
        for riemann in SOLVERS {
            let [coarse, fine] = [100, 800].map(|n| errors(&tube::<f64>(n, problem, riemann), problem));
            eprintln!(
                "{} {riemann:?} {coarse:?} {fine:?} orders {:?}",
                problem.0,
                [0, 1, 2].map(|q| (coarse[q] / fine[q]).log2() / 3.0)
            );
        }
    }
}

#[test]
fn any_step_of_any_gases_stays_physical() {
    for seed in 0..300 {
        mixed_step_stays_physical::<f64, 1>(&mut Source::seeded(seed));
        mixed_step_stays_physical::<f64, 2>(&mut Source::seeded(seed));
        mixed_step_stays_physical::<f64, 3>(&mut Source::seeded(seed));
        mixed_step_stays_physical::<f32, 1>(&mut Source::seeded(seed));
        mixed_step_stays_physical::<f32, 2>(&mut Source::seeded(seed));
        mixed_step_stays_physical::<f32, 3>(&mut Source::seeded(seed));
    }
}
