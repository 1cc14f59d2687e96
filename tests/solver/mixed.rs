//! Gases of two ratios of specific heats side by side: contacts, shocks, hot balls, porous space.

use voidage::flow::{Flow, Scalar, Treatment};
use voidage_core::flow::{Boundary, Gas, Limiter, Primitive, Riemann};
use voidage_tests::euler::property::Source;

const SOLVERS: [Riemann; 4] = [Riemann::Hllc, Riemann::HllcLowMach, Riemann::Hlle, Riemann::Rusanov];
const LIMITERS: [Limiter; 6] = [
    Limiter::Steep,
    Limiter::MonotonizedCentral,
    Limiter::VanLeer,
    Limiter::Minmod,
    Limiter::Unlimited,
    Limiter::FirstOrder,
];

/// Burnt and fresh gas.
const GAMMAS: [f64; 2] = [1.2, 1.67];

fn mixed<R: Scalar>() -> Gas<R> {
    Gas::Mixed { gammas: GAMMAS.map(R::from_f64) }
}

/// A uniform stream at a Mach number of about `mach`, whose density and γ differ at random from cell to cell.
fn stream<R: Scalar, const D: usize>(n: [usize; D], mach: f64, seed: u64) -> Flow<R, D> {
    let width = std::array::from_fn(|d| R::from_f64(0.1 + 0.02 * d as f64));
    let mut flow: Flow<R, D> = Flow::uniform(n, width, mixed(), [[Boundary::Periodic; 2]; D]);
    let mut s = Source::seeded(seed);
    let velocity = std::array::from_fn(|d| R::from_f64(mach * [1.0, -0.6, 0.3][d]));
    for cell in 0..flow.len() {
        // Blocks of pure gas and cells of any mixture.
        let share = [0.0, 1.0, s.unit(), 0.0, 1.0][cell / 3 % 5];
        let gamma = GAMMAS[0] + share * (GAMMAS[1] - GAMMAS[0]);
        let density = R::from_f64(s.scale(0.1, 10.0));
        flow.set_mixed(cell, &Primitive { density, velocity, pressure: R::ONE }, R::from_f64(gamma));
    }
    flow
}

/// The largest error of pressure and velocity against those of the first cell at the beginning, over the pressure and the speed of sound.
fn unevenness<R: Scalar, const D: usize>(flow: &Flow<R, D>, stream: &Primitive<R, D>) -> f64 {
    let of_cell = |cell: usize| {
        let w = flow.get(cell);
        let u = (0..D).map(|d| (w.velocity[d] - stream.velocity[d]).abs().to_f64());
        u.fold((w.pressure / stream.pressure - R::ONE).abs().to_f64(), f64::max)
    };
    (0..flow.len()).map(of_cell).fold(0.0, f64::max)
}

fn stays_even<R: Scalar, const D: usize>(n: [usize; D], most: f64) {
    for riemann in SOLVERS {
        for limiter in LIMITERS {
            for mach in [0.0, 0.2, 3.0] {
                let mut flow = stream::<R, D>(n, mach, 7);
                (flow.scheme.riemann, flow.scheme.limiter) = (riemann, limiter);
                let begin = flow.get(0);
                for _ in 0..40 {
                    let dt = flow.stable_dt(R::from_f64(0.8)).unwrap();
                    flow.step(dt).unwrap();
                }
                let error = unevenness(&flow, &begin);
                eprintln!("{D} {riemann:?} {limiter:?} {mach}: {error:.1e} first {} fl {} {:?}", flow.total.first_order, flow.total.floored,
                (0..flow.len()).map(|c| flow.gas_at(c).gamma().to_f64()).fold([9.0f64,0.0],|[a,b],x|[a.min(x),b.max(x)]));
                assert!(error <= most, "{riemann:?} {limiter:?} Mach {mach}: {error:e}");
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
    stays_even::<f32, 2>([11, 9], 1e-3);
}
