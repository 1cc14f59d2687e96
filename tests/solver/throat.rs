//! Sudden changes of open area at any speed: the stationary wave, and slabs in a fast stream.

use voidage::flow::{Flow, Treatment};
use voidage_core::flow::porosity::throat::ThroatGas;
use voidage_core::flow::{Boundary, Gas, Primitive};

/// Total enthalpy; of an isothermal gas the Bernoulli sum in its place.
fn enthalpy(gas: Gas<f64>, w: &Primitive<f64, 1>) -> f64 {
    let kinetic = 0.5 * w.velocity[0] * w.velocity[0];
    match gas {
        Gas::Isothermal { sound_speed } => kinetic + sound_speed * sound_speed * w.density.ln(),
        _ => kinetic + gas.gamma() / (gas.gamma() - 1.0) * w.pressure / w.density,
    }
}

#[test]
fn a_fast_stream_keeps_mass_enthalpy_entropy_and_branch_through_any_throat() {
    let gammas = [1.01, 1.1, 1.3, 1.4, 5.0 / 3.0, 2.0, 3.0];
    let isothermal = Gas::Isothermal { sound_speed: 1.0 };
    let barotropic = Gas::Isentropic { gamma: 1.4, density: 1.0, pressure: 1.0 / 1.4 };
    let (mut passed, mut choked) = (0, 0);
    for gas in gammas.map(|gamma| Gas::Ideal { gamma }).into_iter().chain([isothermal, barotropic]) {
        let gamma = gas.gamma();
        for k in [0.01, 0.05, 0.3, 0.51, 0.9, 0.999, 1.001, 1.1, 1.5, 2.0, 3.0, 10.0, 20.0, 100.0] {
            for mach in [1.0001_f64, 1.01, 1.2, 1.7, 2.4, 3.0, 4.35, 5.0, 10.0, 30.0, 100.0, 1e3, 1e4, 1e6] {
                let w = Primitive { density: 1.0_f64, velocity: [mach], pressure: 1.0 / gamma };
                let at = ThroatGas::new(gas).carry(&w, k, 1.0);
                let t = at.state;
                let place = format!("{gas:?}, k = {k}, Mach {mach}: {at:?}");
                assert!(t.density > 0.0 && t.pressure > 0.0 && t.velocity[0].is_finite(), "{place}");
                let scale = 0.5 * mach * mach + 1.0;
                assert!((enthalpy(gas, &t) - enthalpy(gas, &w)).abs() < 1e-11 * scale, "{place}");
                assert!((t.density * t.velocity[0] / (at.passing * mach) - 1.0).abs() < 1e-12, "{place}");
                let entropy = (t.pressure * gamma).ln() - gamma * t.density.ln();
                assert!(entropy.abs() < 1e-10 * (1.0 + t.density.ln().abs() + t.pressure.ln().abs()), "{place}");
                let local = t.velocity[0] / (gamma * t.pressure / t.density).sqrt();
                if at.passing < k {
                    choked += 1;
                    assert!((local - 1.0).abs() < 1e-12, "{place}");
                } else {
                    passed += 1;
                    // A contraction slows a supersonic stream, an expansion speeds it up; neither passes the sonic point.
                    assert!(local > 1.0 - 1e-6 && (local <= mach) == (k >= 1.0), "{place}: Mach {local}");
                }
            }
        }
    }
    println!("{passed} passed, {choked} choked");
    assert!(passed > 1000 && choked > 300);
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
