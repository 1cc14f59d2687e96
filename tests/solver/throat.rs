//! Sudden changes of open area at any speed: the stationary wave, and slabs in a fast stream.

use proptest::prelude::*;
use voidage::flow::{Flow, Treatment};
use voidage_core::flow::porosity::throat::ThroatGas;
use voidage_core::flow::{Boundary, Gas, Primitive};
use voidage_core::number::real::Real;
use voidage_tests::effort::some;

/// Total enthalpy; of an isothermal gas the Bernoulli sum in its place.
fn enthalpy(gas: Gas<f64>, w: &Primitive<f64, 1>) -> f64 {
    let kinetic = 0.5 * w.velocity[0] * w.velocity[0];
    match gas {
        Gas::Isothermal { sound_speed } => kinetic + sound_speed * sound_speed * w.density.ln(),
        _ => kinetic + gas.gamma() / (gas.gamma() - 1.0) * w.pressure / w.density,
    }
}

/// What a throat kept badly, in rounding errors of the scalar: mass flux, total enthalpy, entropy; and whether it chokes.
#[derive(Clone, Copy, Debug, Default)]
struct Kept {
    mass: f64,
    enthalpy: f64,
    entropy: f64,
    chokes: bool,
}

/// Carries a stream of density 1 and unit sound speed through a throat, `k` times narrower than itself, and asks what it kept. The
/// stream stays on its side of the sonic point, or the throat is sonic.
fn through_throat<R: Real>(gas: [Gas<R>; 1], wide: Gas<f64>, k: f64, mach: f64) -> Kept {
    let gamma = wide.gamma();
    let one = Primitive { density: R::ONE, velocity: [R::from_f64(mach)], pressure: R::from_f64(1.0 / gamma) };
    let at = ThroatGas::new(gas[0]).carry(&one, R::from_f64(k), R::ONE);
    let to_wide = |w: &Primitive<R, 1>| Primitive {
        density: w.density.to_f64(),
        velocity: w.velocity.map(R::to_f64),
        pressure: w.pressure.to_f64(),
    };
    // As the scalar holds them.
    let (w, t, k, passing) = (to_wide(&one), to_wide(&at.state), R::from_f64(k).to_f64(), at.passing.to_f64());
    let place = format!("{wide:?}, k = {k}, Mach {mach}: {at:?}");
    assert!(t.density > 0.0 && t.pressure > 0.0 && t.velocity[0].is_finite() && t.velocity[0] > 0.0, "{place}");
    let entropy = |w: &Primitive<f64, 1>| w.pressure.ln() - gamma * w.density.ln();
    // A temperature is known to a rounding error, a density to n/2 = 1/(γ − 1) of them.
    let powers = 1.0 + if gamma > 1.0 { 1.0 / (gamma - 1.0) } else { 0.0 };
    let size = 1.0 + t.density.ln().abs() + t.pressure.ln().abs();
    let (before, after) = (enthalpy(wide, &w), enthalpy(wide, &t));
    let scale = 0.5 * mach * mach + before.abs().max(1.0);
    let local = t.velocity[0] / (gamma * t.pressure / t.density).sqrt();
    let eps = R::EPSILON.to_f64();
    let chokes = passing < k;
    // At the sonic point both roots meet: there a Mach number is known to the root of the rounding error of a density.
    let near = 8.0 * (eps * powers).sqrt();
    if chokes {
        assert!((local - 1.0).abs() < 64.0 * eps * powers, "{place}: Mach {local}");
    } else if mach > 1.0 {
        // A contraction slows a supersonic stream, an expansion speeds it up; neither passes the sonic point.
        assert!(local > 1.0 - near, "{place}: Mach {local}");
        assert!(
            if k >= 1.0 { local <= mach * (1.0 + near) } else { local >= mach * (1.0 - near) },
            "{place}: Mach {local}"
        );
    } else {
        assert!(local < 1.0 + near, "{place}: Mach {local}");
        assert!(
            if k >= 1.0 { local >= mach * (1.0 - near) } else { local <= mach * (1.0 + near) },
            "{place}: Mach {local}"
        );
    }
    Kept {
        mass: (t.density * t.velocity[0] / (passing * w.velocity[0]) - 1.0).abs() / eps,
        // The change of temperature is solved for: in a stream that cools to a small share t, t is known to 1/t rounding errors.
        enthalpy: (after - before).abs()
            / (scale * eps * powers * (w.pressure / w.density / (t.pressure / t.density)).max(1.0)),
        entropy: (entropy(&t) - entropy(&w)).abs() / (eps * size * powers),
        chokes,
    }
}

/// Every gas, in the wanted precision and in double.
fn gases<R: Real>() -> Vec<([Gas<R>; 1], Gas<f64>)> {
    let r = R::from_f64;
    let ideal = (0..=24).map(|i| 1.01 + (5.0 / 3.0 - 1.01) * f64::from(i) / 24.0).chain([1.4, 5.0 / 3.0, 2.0, 3.0]);
    let ideal = ideal.map(|gamma| {
        let gamma = r(gamma);
        ([Gas::Ideal { gamma }], Gas::Ideal { gamma: gamma.to_f64() })
    });
    let isothermal = ([Gas::Isothermal { sound_speed: R::ONE }], Gas::Isothermal { sound_speed: 1.0 });
    let pressure = R::ONE / r(1.4);
    let isentropic = |gamma: R| Gas::Isentropic { gamma, density: R::ONE, pressure };
    let wide = Gas::Isentropic { gamma: r(1.4).to_f64(), density: 1.0, pressure: pressure.to_f64() };
    ideal.chain([isothermal, ([isentropic(r(1.4))], wide)]).collect()
}

/// The worst over a grid of all that a stream may meet.
fn any_throat<R: Real>() {
    let (mut passed, mut choked, mut worst) = (0, 0, Kept::default());
    for (gas, wide) in gases::<R>() {
        // Evenly in the logarithm, and close to 1, where roots meet.
        let close = [-1e-2, -1e-3, -1e-6, 1e-6, 1e-3, 1e-2].map(|x| 1.0 + x);
        let ratios = (0..=48).map(|i| 10f64.powf(-2.0 + f64::from(i) / 12.0)).chain(close);
        for k in ratios {
            let machs = (-24..=48).map(|i| 10f64.powf(f64::from(i) / 8.0)).chain(close).filter(|m| *m != 1.0);
            for mach in machs {
                let kept = through_throat(gas, wide, k, mach);
                (passed, choked) = if kept.chokes { (passed, choked + 1) } else { (passed + 1, choked) };
                worst.mass = worst.mass.max(kept.mass);
                worst.enthalpy = worst.enthalpy.max(kept.enthalpy);
                worst.entropy = worst.entropy.max(kept.entropy);
            }
        }
    }
    println!("{passed} passed, {choked} choked; kept badly, in rounding errors: {worst:?}");
    assert!(passed > 100_000 && choked > 10_000);
    assert!(worst.mass < 64.0 && worst.enthalpy < 64.0 && worst.entropy < 64.0, "{worst:?}");
}

#[test]
fn a_stream_keeps_mass_enthalpy_entropy_and_branch_through_any_throat() {
    any_throat::<f64>();
    any_throat::<f32>();
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 20_000, failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn any_fast_stream_converges_in_any_throat(gamma in 1.01..5.0 / 3.0, k in -2.0..2.0, mach in 0.0..6.0) {
        let (k, mach) = (10f64.powf(k), 10f64.powf(mach));
        let wide = |gamma: f64| Gas::Ideal { gamma };
        let double = through_throat([Gas::Ideal { gamma }], wide(gamma), k, mach);
        let single = through_throat([Gas::Ideal { gamma: gamma as f32 }], wide(f64::from(gamma as f32)), k, mach);
        for kept in [double, single] {
            prop_assert!(kept.mass < 64.0 && kept.enthalpy < 64.0 && kept.entropy < 64.0, "{kept:?}");
        }
    }
}

#[test]
fn slabs_in_a_fast_stream_conserve_mass_and_energy() {
    for gas in [Gas::Ideal { gamma: 1.4 }, Gas::Ideal { gamma: 5.0 / 3.0 }, Gas::Isothermal { sound_speed: 1.0 }] {
        for beta in [0.5, 0.05] {
            for mach in [10.0_f64, 100.0, 1e4] {
                let n = 60;
                let speed: f64 = mach * f64::sqrt(gas.gamma());
                let w = Primitive { density: 1.0, velocity: [speed], pressure: 1.0 };
                let ends = [Boundary::FarField(w), Boundary::ZeroGradient];
                let mut flow: Flow<f64, 1> = Flow::uniform([n], [1.0 / n as f64], gas, [ends]);
                let volume: Vec<f64> = (0..n).map(|i| if (20..40).contains(&i) { beta } else { 1.0 }).collect();
                let face = |i: usize| volume[i.saturating_sub(1)].min(volume[i.min(n - 1)]);
                let faces = (0..=n).map(face).collect();
                flow.set_porosity(volume.clone(), [faces], Treatment::default()).unwrap();
                flow.fill(|_| w);
                let before = flow.content();
                flow.run(0.8, 4.0 / speed).unwrap();
                let (after, place) = (flow.content(), format!("{gas:?}, beta {beta}, Mach {mach}"));
                assert_eq!(flow.total.floored, 0, "{place}");
                let entered = |side: usize| flow.total.inflow[0][side];
                let mass = after.density - before.density - entered(0).density - entered(1).density;
                assert!(mass.abs() < 1e-13 * before.density.max(entered(0).density), "{place}: {mass:e}");
                let energy = after.energy - before.energy - entered(0).energy - entered(1).energy;
                assert!(energy.abs() <= 1e-13 * entered(0).energy.max(before.energy), "{place}: {energy:e}");
            }
        }
    }
}

/// What a slug of another density does to the pressure while it passes a layer: the largest deviation in dynamic pressures of the stream.
fn slug_through_a_layer(open_share: f64, density: f64, mach: f64) -> f64 {
    const N: usize = 100;
    let u = mach * 1.4f64.sqrt();
    let open = |i: usize| if (40..50).contains(&i) { open_share } else { 1.0 };
    let far = Boundary::FarField(Primitive { density: 1.0, velocity: [u], pressure: 1.0 });
    let mut flow: Flow<f64, 1> = Flow::uniform([N], [1.0 / N as f64], Gas::Ideal { gamma: 1.4 }, [[far, far]]);
    let faces = (0..=N).map(|f| open(f.min(N - 1)).min(open(f.max(1) - 1))).collect();
    flow.set_porosity((0..N).map(open).collect(), [faces], Treatment::default()).unwrap();
    assert!(flow.jump_faces() == 2);
    for i in 0..N {
        let density = if (20..35).contains(&i) { density } else { 1.0 };
        flow.set(i, &Primitive { density, velocity: [u / open(i)], pressure: 1.0 });
    }
    let mut most = 0.0f64;
    while flow.time < 0.6 / u {
        flow.advance(0.8, f64::MAX).unwrap();
        // The layer's own pressure comes up at first.
        if flow.time > 0.05 / u {
            most = (0..N).map(|i| (flow.get(i).pressure - 1.0).abs() / (0.5 * u * u)).fold(most, f64::max);
        }
    }
    most
}

/// The pressure in a layer is lower by what Bernoulli's law takes, of the gas that is there. Where the flux of the slug's mass was a mean of both sides, a slug
/// of a quarter or of four times the density made sound of 500 dynamic pressures at Mach 0.001, of 50 at Mach 0.01.
#[test]
fn gas_of_another_density_passes_a_layer_without_noise() {
    for open in [0.5, 0.2] {
        for density in [0.1, 0.5, 4.0] {
            for mach in some(&[0.002, 0.01, 0.03]) {
                let found = slug_through_a_layer(open, density, mach);
                let bernoulli = (1.0 / (open * open) - 1.0) * f64::max(density, 1.0);
                println!(
                    "open {open}, density {density}, Mach {mach}: {found:.3} q, by Bernoulli's law {bernoulli:.3} q"
                );
                assert!(
                    found < (1.04 + 4.0 * mach) * bernoulli,
                    "open {open}, density {density}, Mach {mach}: {found} q"
                );
            }
        }
    }
}
