//! Streams that choke: nothing passes more than the narrowest open area lets through at the speed of sound, and no reservoir gives more than it holds.

use voidage::flow::{Flow, Treatment};
use voidage_core::flow::{Boundary, Gas, Primitive};

const GAMMA: f64 = 1.4;
const IDEAL: Gas<f64> = Gas::Ideal { gamma: GAMMA };

/// Mach number, pressure and temperature (p/ρ) at rest of a stream, if it came there at constant entropy.
fn at_rest(w: &Primitive<f64, 1>) -> [f64; 3] {
    let mach = w.velocity[0] / (GAMMA * w.pressure / w.density).sqrt();
    let rise = 1.0 + 0.5 * (GAMMA - 1.0) * mach * mach;
    [mach, w.pressure * rise.powf(GAMMA / (GAMMA - 1.0)), w.pressure / w.density * rise]
}

/// Mass flux over that of a sonic stream with the same state at rest.
fn share_of_choked(mach: f64) -> f64 {
    mach * ((1.0 + 0.5 * (GAMMA - 1.0) * mach * mach) / (0.5 * (GAMMA + 1.0))).powf(-3.0)
}

/// A shock of Mach number `fast` comes to layers of open fraction `layer`, a cell each. Of the steady stream before them its mass flux over what chokes in the
/// narrowest of them, and its pressure; the pressure a tenth of the duct behind them. Pressures are over that before the shock.
fn at_layers(fast: f64, layer: &[f64], cells: usize) -> [f64; 3] {
    let c = GAMMA.sqrt();
    let still = Primitive { density: 1.0, velocity: [0.0], pressure: 1.0 };
    let behind = Primitive {
        density: (GAMMA + 1.0) * fast * fast / ((GAMMA - 1.0) * fast * fast + 2.0),
        velocity: [2.0 / (GAMMA + 1.0) * c * (fast - 1.0 / fast)],
        pressure: 1.0 + 2.0 * GAMMA / (GAMMA + 1.0) * (fast * fast - 1.0),
    };
    let sides = [[Boundary::FarField(behind), Boundary::ZeroGradient]];
    let mut flow: Flow<f64, 1> = Flow::uniform([cells], [3.0 / cells as f64], IDEAL, sides);
    let (mut volume, mut faces) = (vec![1.0; cells], vec![1.0; cells + 1]);
    for (i, &open) in layer.iter().enumerate() {
        let cell = cells / 2 + i;
        (volume[cell], faces[cell], faces[cell + 1]) = (open, open.min(faces[cell]), open);
    }
    flow.set_porosity(volume, [faces], Treatment::default()).unwrap();
    flow.fill(|[x]| if x < 1.0 { behind } else { still });
    flow.run(0.8, 1.5 / (fast * c)).unwrap();
    let before = flow.get(cells / 2 - cells / 30);
    let narrowest = layer.iter().copied().fold(1.0, f64::min);
    [share_of_choked(at_rest(&before)[0]) / narrowest, before.pressure, flow.get(cells / 2 + cells / 10).pressure]
}

#[test]
fn a_layer_one_cell_thick_chokes_as_a_thick_one() {
    for open in [0.1, 0.3, 0.7] {
        let thick = at_layers(1.5, &[open; 4], 300);
        for cells in [100, 300] {
            let (thin, most) = (at_layers(1.5, &[open], cells), 1.5 / cells as f64);
            assert!((thin[0] - 1.0).abs() < most, "{open}, {cells} cells: {thin:?} of what chokes");
            assert!((thin[1] / thick[1] - 1.0).abs() < most, "{open}, {cells} cells: pressures {thin:?} and {thick:?}");
        }
    }
    // The narrowest part is one cell, in the middle or beside others.
    for layer in [&[0.8, 0.5, 0.2, 0.5, 0.8][..], &[0.3, 0.31], &[0.5, 0.3], &[0.3, 0.9]] {
        let [share, ..] = at_layers(1.5, layer, 300);
        assert!((share - 1.0).abs() < 0.005, "{layer:?}: {share} of what chokes");
    }
}

#[test]
fn a_fast_stream_leaves_a_layer_one_cell_thick_as_a_thick_one() {
    let (thin, thick) = (at_layers(3.0, &[0.1], 300), at_layers(3.0, &[0.1; 3], 300));
    // Behind it gas expands faster than sound, up to a shock.
    for (thin, thick) in thin.iter().zip(&thick) {
        assert!((thin / thick - 1.0).abs() < 0.02, "{thin}, not {thick}");
    }
}

/// A duct between a reservoir of density and pressure at rest and an outlet of pressure 1, full of still gas of a temperature p/ρ at first: what streams
/// in it after a long time.
fn fed_duct([density, pressure]: [f64; 2], temperature: f64) -> Primitive<f64, 1> {
    let sides = [[Boundary::Reservoir { density, pressure }, Boundary::Outlet { pressure: 1.0 }]];
    let mut flow: Flow<f64, 1> = Flow::uniform([50], [0.04], IDEAL, sides);
    flow.fill(|_| Primitive { density: 1.0 / temperature, velocity: [0.0], pressure: 1.0 });
    flow.run(0.8, 150.0).unwrap();
    flow.get(10)
}

#[test]
fn a_reservoir_feeds_what_it_holds_whatever_the_gas_inside_was() {
    // Reservoir pressures, and temperatures of the gas inside over that of the reservoir.
    for (pressure, temperature) in
        [(1.0066, 1.2), (1.0066, 5.0), (1.0066, 0.3), (1.5, 1.0), (4.0, 1.0), (5.0, 3.0), (10.0, 1.0)]
    {
        let place = format!("reservoir of {pressure}, gas of temperature {temperature}");
        let w = fed_duct([pressure, pressure], temperature);
        let [mach, rest_pressure, rest_temperature] = at_rest(&w);
        assert!((rest_pressure / pressure - 1.0).abs() < 2e-4, "{place}: {rest_pressure} at rest");
        assert!((rest_temperature - 1.0).abs() < 2e-4, "{place}: temperature {rest_temperature} at rest");
        let expected = if pressure < 1.8929 { (5.0 * (pressure.powf(1.0 / 3.5) - 1.0)).sqrt() } else { 1.0 };
        assert!((mach - expected).abs() < 0.012, "{place}: Mach {mach}, not {expected}");
    }
}

#[test]
fn gas_in_balance_with_a_reservoir_stays_at_rest_to_the_bit() {
    for gas in
        [IDEAL, Gas::Isothermal { sound_speed: 1.0 }, Gas::Isentropic { gamma: 1.3, density: 1.0, pressure: 1.0 }]
    {
        let sides = [[Boundary::Reservoir { density: 1.0, pressure: 1.0 }, Boundary::Wall]];
        let mut flow: Flow<f64, 1> = Flow::uniform([20], [0.1], gas, sides);
        let still = Primitive { density: 1.0, velocity: [0.0], pressure: 1.0 };
        flow.fill(|_| still);
        flow.run(0.8, 3.0).unwrap();
        assert!((0..20).all(|cell| flow.get(cell) == still), "{gas:?}");
    }
}

#[test]
fn reservoirs_of_other_gases_feed_what_they_hold() {
    for (gas, expected) in [
        (Gas::Isothermal { sound_speed: 1.0 }, (2.0 * 1.2_f64.ln()).sqrt()),
        (Gas::Isentropic { gamma: 1.4, density: 1.0, pressure: 1.0 }, (7.0 * (1.2_f64.powf(2.0 / 7.0) - 1.0)).sqrt()),
    ] {
        let density = if gas.gamma() == 1.0 { 1.2 } else { 1.2_f64.powf(1.0 / 1.4) };
        let sides = [[Boundary::Reservoir { density, pressure: 1.2 }, Boundary::Outlet { pressure: 1.0 }]];
        let mut flow: Flow<f64, 1> = Flow::uniform([50], [0.04], gas, sides);
        flow.fill(|_| Primitive { density: 1.0, velocity: [0.0], pressure: 1.0 });
        flow.run(0.8, 150.0).unwrap();
        let velocity = flow.get(10).velocity[0];
        assert!((velocity / expected - 1.0).abs() < 1e-3, "{gas:?}: {velocity}, not {expected}");
    }
}
