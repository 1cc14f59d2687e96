//! Properties of the solver, driven by tests, seeded random input and the fuzzer.

use crate::euler::space::{layer, open_fractions};
use voidage::flow::{Field, Flow, Scalar, Treatment};
use voidage_core::flow::{Boundary, Gas, Limiter, PressureForm, Primitive, Riemann};
use voidage_core::number::real::Real;

/// A source of numbers: bytes while they last, then a generator seeded by them.
pub struct Source<'a> {
    bytes: &'a [u8],
    seed: u64,
}

impl<'a> Source<'a> {
    /// From bytes.
    pub fn new(bytes: &'a [u8]) -> Self {
        Source { bytes, seed: bytes.len() as u64 }
    }

    /// From a seed.
    pub fn seeded(seed: u64) -> Self {
        Source { bytes: &[], seed }
    }

    /// The next 16 bits.
    pub fn bits(&mut self) -> u16 {
        if let [a, b, rest @ ..] = self.bytes {
            self.bytes = rest;
            let word = u16::from_le_bytes([*a, *b]);
            self.seed = self.seed.rotate_left(7) ^ u64::from(word);
            return word;
        }
        self.seed = self.seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.seed;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z >> 40) as u16
    }

    /// A number in [0, 1].
    pub fn unit(&mut self) -> f64 {
        f64::from(self.bits()) / 65535.0
    }

    /// A number of any size between two, evenly in its logarithm.
    pub fn scale(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.unit())
    }

    /// One of a few.
    pub fn pick<T: Copy>(&mut self, of: &[T]) -> T {
        of[usize::from(self.bits()) % of.len()]
    }

    /// An open fraction: often 0, 1 or tiny.
    pub fn fraction(&mut self) -> f64 {
        match self.bits() % 8 {
            0 => 0.0,
            1 | 2 => 1.0,
            3 => self.scale(1e-12, 1.0),
            _ => self.unit(),
        }
    }
}

/// A gas of a random kind.
pub fn gas<R: Real>(s: &mut Source<'_>) -> Gas<R> {
    let gamma = R::from_f64(s.pick(&[1.4, 5.0 / 3.0, 1.01, 1.1, 2.0]));
    match s.bits() % 3 {
        0 => Gas::Isothermal { sound_speed: R::from_f64(s.scale(0.1, 1e3)) },
        1 => Gas::Isentropic { gamma, density: R::ONE, pressure: R::from_f64(s.scale(1e-2, 1e5)) },
        _ => Gas::Ideal { gamma },
    }
}

/// Random open fractions of a mesh: volumes, faces.
pub fn porosity<R: Real, const D: usize>(s: &mut Source<'_>, n: [usize; D]) -> (Vec<R>, [Vec<R>; D]) {
    let cells: usize = n.iter().product();
    let volume = (0..cells).map(|_| R::from_f64(s.fraction())).collect();
    let faces = std::array::from_fn(|d| {
        let count: usize = (0..D).map(|a| n[a] + usize::from(a == d)).product();
        (0..count).map(|_| R::from_f64(s.fraction())).collect()
    });
    if D > 1 && s.bits().is_multiple_of(4) { porous_layer(s, n) } else { (volume, faces) }
}

/// Open fractions of a porous layer between two planes askew to the grid, in cells as wide as high.
fn porous_layer<R: Real, const D: usize>(s: &mut Source<'_>, n: [usize; D]) -> (Vec<R>, [Vec<R>; D]) {
    let normal: [f64; D] = std::array::from_fn(|_| 2.0 * s.unit() - 1.0);
    let offset = (0..D).map(|d| normal[d] * s.unit() * n[d] as f64).sum::<f64>();
    let (thickness, share) = (s.scale(0.1, 10.0), s.pick(&[0.2, 0.5, 0.9, 0.97]));
    let open =
        open_fractions(n, [0.0; D], 1.0, |low, high| share * layer(normal, [offset, offset + thickness], low, high));
    let to = |fractions: Vec<f64>| fractions.into_iter().map(R::from_f64).collect();
    (to(open.volume), open.faces.map(to))
}

/// Any step from a finite physical state ends in one: never a NaN, never a negative density or pressure, never a panic,
/// whatever the porosity, drag, boundaries and step.
pub fn step_stays_physical<R: Scalar, const D: usize>(s: &mut Source<'_>) {
    let n: [usize; D] = std::array::from_fn(|_| 1 + usize::from(s.bits() % 6));
    let gas = gas::<R>(s);
    of_gas_stays_physical(s, n, gas);
}

/// The same of a gas of two ratios of specific heats, and of no cell the ratio leaves the bounds.
pub fn mixed_step_stays_physical<R: Scalar, const D: usize>(s: &mut Source<'_>) {
    let n: [usize; D] = std::array::from_fn(|_| 1 + usize::from(s.bits() % 6));
    let gammas = [s.pick(&[1.01, 1.1, 1.3]), s.pick(&[1.3, 1.4, 5.0 / 3.0, 2.0])];
    of_gas_stays_physical(s, n, Gas::Mixed { gammas: gammas.map(R::from_f64) });
}

fn of_gas_stays_physical<R: Scalar, const D: usize>(s: &mut Source<'_>, n: [usize; D], gas: Gas<R>) {
    let cells: usize = n.iter().product();
    let base = (s.scale(1e-3, 1e3), s.scale(1e-3, 1e5));
    let state = |s: &mut Source<'_>| {
        let density = R::from_f64(base.0 * s.scale(1e-3, 1e3));
        let pressure = match gas {
            Gas::Ideal { .. } | Gas::Mixed { .. } => R::from_f64(base.1 * s.scale(1e-3, 1e3)),
            other => other.pressure(density, R::ZERO),
        };
        let c = (gas.gamma() * pressure / density).sqrt();
        let velocity = std::array::from_fn(|_| {
            R::from_f64(4.0 * s.unit() - 2.0) * c * R::from_f64(s.pick(&[0.0, 1e-3, 1.0, 3.0]))
        });
        Primitive { density, velocity, pressure }
    };
    let boundaries = std::array::from_fn(|_| {
        if s.bits().is_multiple_of(4) {
            return [Boundary::Periodic; 2];
        }
        std::array::from_fn(|_| {
            let w = state(s);
            match s.bits() % 6 {
                0 => Boundary::ZeroGradient,
                1 => Boundary::FarField(w),
                2 => Boundary::Inlet(w),
                3 => Boundary::Outlet { pressure: w.pressure },
                4 if !gas.is_mixed() => Boundary::Reservoir { density: w.density, pressure: w.pressure },
                _ => Boundary::Wall,
            }
        })
    });
    let widths = std::array::from_fn(|d| {
        let even = s.bits().is_multiple_of(2);
        (0..n[d]).map(|_| R::from_f64(if even { 0.1 } else { s.scale(1e-3, 1.0) })).collect()
    });
    let mut flow: Flow<R, D> = Flow::new(widths, gas, boundaries);
    flow.scheme.riemann = s.pick(&[Riemann::Hllc, Riemann::HllcLowMach, Riemann::Hlle, Riemann::Rusanov]);
    flow.scheme.limiter = s.pick(&[
        Limiter::AroraRoe,
        Limiter::MonotonizedCentral,
        Limiter::VanLeer,
        Limiter::Minmod,
        Limiter::Unlimited,
        Limiter::FirstOrder,
    ]);
    flow.scheme.pressure = s.pick(&[PressureForm::Geometric, PressureForm::Geometric, PressureForm::Paper]);
    if s.bits().is_multiple_of(3) {
        flow.gravity = std::array::from_fn(|_| R::from_f64(s.pick(&[0.0, -9.81, 3.0])));
    }
    if !s.bits().is_multiple_of(4) {
        let (volume, faces) = porosity(s, n);
        flow.set_porosity(volume, faces, Treatment::default()).expect("lengths fit");
    }
    if s.bits().is_multiple_of(2) {
        let coefficients = |s: &mut Source<'_>| -> [Vec<R>; D] {
            std::array::from_fn(|_| {
                if s.bits().is_multiple_of(3) {
                    return Vec::new();
                }
                (0..cells)
                    .map(|_| R::from_f64(if s.bits().is_multiple_of(3) { 0.0 } else { s.scale(1e-3, 1e12) }))
                    .collect()
            })
        };
        let (quadratic, linear) = (coefficients(s), coefficients(s));
        flow.set_drag(quadratic, linear).expect("drag");
    }
    for cell in 0..cells {
        let w = state(s);
        match gas {
            Gas::Mixed { gammas: [low, high] } => {
                let between = low + R::from_f64(s.unit()) * (high - low);
                let gamma = s.pick(&[low, high, between]);
                flow.set_mixed(cell, &w, gamma.limited(low, high));
            }
            _ => flow.set(cell, &w),
        }
    }
    for _ in 0..4 {
        let Ok(stable) = flow.stable_dt(R::from_f64(0.8)) else { panic!("refused its own state") };
        if !stable.is_finite() {
            return;
        }
        let dt = stable * R::from_f64(s.pick(&[1.0, 1.0, 0.1, 3.0]));
        if !(dt > R::ZERO) {
            return;
        }
        flow.step(dt).expect("contracts hold");
        for cell in 0..cells {
            let w = flow.get(cell);
            assert!(w.density > R::ZERO && w.density.is_finite(), "cell {cell}: {w:?}");
            assert!(w.pressure > R::ZERO && w.pressure.is_finite(), "cell {cell}: {w:?}");
            assert!(w.velocity.iter().all(|v| v.is_finite()), "cell {cell}: {w:?}");
        }
        if let Gas::Mixed { gammas } = gas {
            let [most, least] = gammas.map(|gamma| Gas::Ideal { gamma }.capacity());
            assert!(flow.state.capacity.iter().all(|c| *c >= least && *c <= most), "{:?}", flow.state.capacity);
        }
    }
}

/// The same from bytes: the first chooses precision and dimensions.
pub fn step_from_bytes(bytes: &[u8]) {
    let Some((first, rest)) = bytes.split_first() else { return };
    let mut s = Source::new(rest);
    match first % 6 {
        0 => step_stays_physical::<f64, 1>(&mut s),
        1 => step_stays_physical::<f64, 2>(&mut s),
        2 => step_stays_physical::<f64, 3>(&mut s),
        3 => step_stays_physical::<f32, 1>(&mut s),
        4 => step_stays_physical::<f32, 2>(&mut s),
        _ => step_stays_physical::<f32, 3>(&mut s),
    }
}

/// Bits of a field, for comparison.
pub fn bits<R: Scalar, const D: usize>(field: &Field<R, D>) -> Vec<u64> {
    let all = field.density.iter().chain(field.momentum.iter().flatten()).chain(&field.energy).chain(&field.capacity);
    // Adding zero makes one zero of both.
    all.map(|x| (*x + R::ZERO).to_f64().to_bits()).collect()
}
