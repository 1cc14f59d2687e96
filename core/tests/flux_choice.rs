//! Steps compiled for one Riemann solver and one gas: the bits of the step that knows all of them, and a refusal of what is not in it.

use voidage_core::flow::riemann::{Hllc, HllcLowMach, Hlle, Riemann, Rusanov};
use voidage_core::flow::{
    AnyFlux, AnyGas, Barotropic, Boundary, Error, Fields, FieldsMut, FluxChoice, Gas, Mesh, MixedGas, OneFlux,
    Primitive, Problem, Scheme, WithEnergy,
};

const N: usize = 6;
const COUNT: usize = N * N;

const GASES: [Gas<f64>; 4] = [
    Gas::Ideal { gamma: 1.4 },
    Gas::Isothermal { sound_speed: 1.2 },
    Gas::Isentropic { gamma: 1.4, density: 1.0, pressure: 1.0 },
    Gas::Mixed { gammas: [1.2, 1.5] },
];

type Bits = [[u64; COUNT]; 5];

/// The bits of all cells after two steps of a shear layer.
fn two_steps<F: FluxChoice>(gas: Gas<f64>, riemann: Riemann) -> Result<Bits, Error> {
    let widths = [1.0; N];
    let wall = [Boundary::Wall; 2];
    let problem =
        Problem::new(Mesh::new([&widths; 2])?, gas, [wall; 2])?.with_scheme(Scheme { riemann, ..Scheme::default() });
    let (mut old, mut new) = ([[0.0; COUNT]; 5], [[0.0; COUNT]; 5]);
    let energy = if gas.has_energy() { COUNT } else { 0 };
    let capacity = if gas.is_mixed() { COUNT } else { 0 };
    for cell in 0..COUNT {
        let velocity = [if cell / N < N / 2 { 0.3 } else { -0.1 }, 0.2 * (cell % N) as f64 / N as f64];
        let u = gas.conserved(&Primitive { density: 1.0 + 0.1 * (cell % 3) as f64, velocity, pressure: 1.0 });
        let [d, x, y, e, c] = &mut old;
        c[cell] = if gas.is_mixed() { 2.0 + (cell % 4) as f64 } else { 0.0 };
        FieldsMut { density: d, momentum: [x, y], energy: e, capacity: c }.set(cell, &u);
    }
    let mut scratch = vec![0.0; problem.scratch_len()];
    for _ in 0..2 {
        let ([d, x, y, e, c], [nd, nx, ny, ne, nc]) = (&old, &mut new);
        let mut to =
            FieldsMut { density: nd, momentum: [nx, ny], energy: &mut ne[..energy], capacity: &mut nc[..capacity] };
        let from = Fields { density: d, momentum: [x, y], energy: &e[..energy], capacity: &c[..capacity] };
        problem.step_by::<F>(&from, &mut to, 0.1, &mut [0; COUNT], &mut scratch)?;
        old = new;
    }
    Ok(old.map(|field| field.map(f64::to_bits)))
}

fn one_is_as_all<F: FluxChoice>(riemann: Riemann, (energy, mixed): (bool, bool)) {
    for gas in GASES {
        for asked in [Riemann::Hllc, Riemann::HllcLowMach, Riemann::Hlle, Riemann::Rusanov] {
            let found = two_steps::<F>(gas, asked);
            if asked == riemann && gas.has_energy() == energy && gas.is_mixed() == mixed {
                assert_eq!(found, two_steps::<AnyGas>(gas, asked), "{asked:?} {gas:?}");
            } else {
                assert_eq!(found, Err(Error::OtherFlux), "{asked:?} {gas:?}");
            }
        }
    }
}

#[test]
fn a_step_for_one_flux_is_the_step_for_all_and_no_other() {
    one_is_as_all::<OneFlux<Hllc, WithEnergy>>(Riemann::Hllc, (true, false));
    one_is_as_all::<OneFlux<HllcLowMach, WithEnergy>>(Riemann::HllcLowMach, (true, false));
    one_is_as_all::<OneFlux<Hlle, WithEnergy>>(Riemann::Hlle, (true, false));
    one_is_as_all::<OneFlux<Rusanov, WithEnergy>>(Riemann::Rusanov, (true, false));
    one_is_as_all::<OneFlux<Hllc, Barotropic>>(Riemann::Hllc, (false, false));
    one_is_as_all::<OneFlux<HllcLowMach, Barotropic>>(Riemann::HllcLowMach, (false, false));
    one_is_as_all::<OneFlux<Hlle, Barotropic>>(Riemann::Hlle, (false, false));
    one_is_as_all::<OneFlux<Rusanov, Barotropic>>(Riemann::Rusanov, (false, false));
    one_is_as_all::<OneFlux<Hllc, MixedGas>>(Riemann::Hllc, (true, true));
    one_is_as_all::<OneFlux<HllcLowMach, MixedGas>>(Riemann::HllcLowMach, (true, true));
    one_is_as_all::<OneFlux<Hlle, MixedGas>>(Riemann::Hlle, (true, true));
    one_is_as_all::<OneFlux<Rusanov, MixedGas>>(Riemann::Rusanov, (true, true));
}

#[test]
fn mixed_gases_are_not_among_those_of_any_flux() {
    for gas in GASES {
        let (all, one_gamma) = (two_steps::<AnyGas>(gas, Riemann::Hllc), two_steps::<AnyFlux>(gas, Riemann::Hllc));
        assert_eq!(one_gamma, if gas.is_mixed() { Err(Error::OtherFlux) } else { all });
    }
}

#[test]
fn the_fluxes_differ() {
    let all = [Riemann::Hllc, Riemann::HllcLowMach, Riemann::Hlle, Riemann::Rusanov];
    let found = all.map(|riemann| two_steps::<AnyFlux>(GASES[0], riemann).expect("a step"));
    for (n, bits) in found.iter().enumerate() {
        assert!(found.iter().skip(n + 1).all(|other| other != bits), "{:?} is another one, too", all[n]);
    }
    assert!(found[0].iter().flatten().all(|&bits| f64::from_bits(bits).is_finite()));
}
