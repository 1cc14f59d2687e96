//! Pressures in kPa, temperatures in °C, gas constants in kJ are doubted; cases without units are not.

use crate::kit::{Scratch, fixture, solve, solved, stderr, stdout, voidage};
use std::fs;
use std::path::Path;

/// A tube of gas with a state, a side and more.
fn case(gas: &str, state: &str, side: &str, output: &str) -> String {
    format!(
        "[grid]\nx = {{ points = [0, 1], cells = [8] }}\n[gas]\nmodel = \"ideal\"\ngamma = 1.4\n{gas}\n[initial]\nuniform = {{ {state} }}\n\
         [boundary]\nx_min = \"wall\"\nx_max = {side}\n[time]\nmax_steps = 1\n[output]\n{output}\n"
    )
}

/// What is said of it.
fn said(gas: &str, state: &str, side: &str, output: &str) -> String {
    let at = Scratch::new();
    stderr(&solved(&at, &case(gas, state, side, output), "out", &[]))
}

const AIR: &str = "gas_constant = 287";

#[test]
fn kilopascals_in_a_case_with_temperatures_are_doubted() {
    let wall = "\"wall\"";
    let text = said(AIR, "T = 288, p = 101.325", wall, "");
    let place = "case.toml: line 8, column 26: key initial.uniform.p: 101.325 Pa is less than a hundredth of";
    let mark = "\n   8 | uniform = { T = 288, p = 101.325 }\n     |                          ^^^^^^^\n";
    assert!(text.contains(place) && text.contains(mark), "{text}");
    assert!(text.contains("not in kPa or bar"), "{text}");
    let text = said(AIR, "T = 288, p = 101325", "{ type = \"outlet\", p = 1.013 }", "");
    assert!(text.contains("key boundary.x_max.p: 1.013 Pa"), "{text}");
    let refused = case(AIR, "T = 288, p = 101325", "{ type = \"wall\", p = 3 }", "");
    let text = stderr(&solve(&Scratch::new(), &refused, "out", &[]));
    assert!(text.contains("is not a key of this type (wall)") && !text.contains("3 Pa"), "{text}");
    let text = said("", "rho = 1.2, p = 101325", wall, "ambient = 101.325");
    assert!(text.contains("key output.ambient: 101.325 is less than a hundredth of the lowest pressure"), "{text}");
    let text = said("", "rho = 1.2, p = 101325", wall, "ambient = 1013250");
    assert!(text.contains("key output.ambient: 1013250 is more than the highest pressure"), "{text}");
    let text = said("", "rho = 1.2, p = 100000", wall, "ambient = 101325");
    assert!(!text.contains("ambient"), "{text}");
}

/// Colours are given in kPa, pressures of states in Pa.
#[test]
fn colours_in_pascals_are_doubted() {
    let air = |range: &str| {
        said(
            AIR,
            "T = 288, p = 101325",
            "\"wall\"",
            &format!("formats = [\"png\"]\nrange = {{ overpressure = {range} }}"),
        )
    };
    let text = air("[0, 3e5]");
    let words = "key output.range.overpressure: 300000 kPa is a hundred times the highest pressure of the case, 101325 Pa, or more; these ends are in kPa";
    assert!(text.contains(words), "{text}");
    assert!(!air("[-0.5, 2]").contains("overpressure") && !air("[-100, 9000]").contains("overpressure"));
}

/// A density in g/cm³ or in g/m³ makes gas that no case means.
#[test]
fn densities_in_grams_are_doubted() {
    let text = said(AIR, "rho = 0.0012, p = 101325", "\"wall\"", "");
    let words =
        "key initial.uniform.rho: at 101325 Pa a density of 0.0012 is that of gas of 294207 K; densities are in kg/m³";
    assert!(text.contains(words), "{text}");
    let text = said(AIR, "rho = 1225, p = 101325", "\"wall\"", "");
    assert!(text.contains("is that of gas of 0.2882 K; densities are in kg/m³"), "{text}");
    for (gas, state) in [(AIR, "rho = 1.225, p = 101325"), (AIR, "rho = 0.2, p = 8e5"), ("", "rho = 1225, p = 101325")]
    {
        let text = said(gas, state, "\"wall\"", "");
        assert!(!text.contains("densities"), "{text}");
    }
}

#[test]
fn temperatures_in_celsius_are_doubted() {
    let text = said(AIR, "T = 15, p = 101325", "\"wall\"", "");
    assert!(text.contains("key initial.uniform.T: 15 K is -258.15 °C; temperatures are in K, not in °C"), "{text}");
    let text = said(AIR, "T = 15, p = 1.01325", "\"wall\"", "");
    assert!(text.contains("not in °C") && text.contains("not in kPa or bar"), "{text}");
}

/// The gas constant of a mole makes air 35 times too dense.
#[test]
fn the_gas_constant_of_a_mole_is_doubted() {
    for r in ["8.314", "8314.46", "8.31"] {
        let text = said(&format!("gas_constant = {r}"), "T = 288, p = 101325", "\"wall\"", "");
        assert!(text.contains(&format!("key gas.gas_constant: {r} is that of a mole of any gas")), "{text}");
    }
    for (constant, state) in [("gas_constant = 8.4", "T = 288, p = 101325"), ("gas_constant = 8.314", "T = 1, p = 1")] {
        let text = said(constant, state, "\"wall\"", "");
        assert!(!text.contains("mole"), "{text}");
    }
}

#[test]
fn a_gas_constant_in_kilojoules_is_doubted() {
    let text = said("gas_constant = 0.287", "T = 288, p = 101325", "\"wall\"", "");
    assert!(text.contains("key gas.gas_constant: 0.287 beside initial.uniform.T") && text.contains("kJ"), "{text}");
}

#[test]
fn pressures_of_their_own_units_are_not() {
    let wall = "\"wall\"";
    for (gas, state) in [
        ("", "rho = 1, p = 1"),
        ("", "rho = 1, p = 0.01"),
        ("", "rho = 1.2, p = 100"),
        ("gas_constant = 1", "T = 1, p = 1"),
        ("gas_constant = 1", "T = 300, p = 300"),
        (AIR, "T = 288, p = 101325"),
        (AIR, "T = 220, p = 1197"),
    ] {
        let text = said(gas, state, wall, "");
        assert!(!text.contains("Pa"), "{gas} {state}: {text}");
    }
    let text = said("", "rho = 1, p = 1", wall, "ambient = 0.02");
    assert!(!text.contains("ambient"), "{text}");
}

#[test]
fn pressures_of_no_explosion_are_doubted() {
    let wall = "\"wall\"";
    let and_a_ball = "\"wall\"\n[[initial.regions]]\ncenter = [0.5]\nradius = 0.3\nrho = 1\np = 8e9";
    for (gas, state, more) in
        [(AIR, "T = 288, p = 8e9", wall), (AIR, "rho = 1, p = 8e9", wall), ("", "rho = 1.2, p = 1e5", and_a_ball)]
    {
        let text = said(gas, state, more, "");
        let words = "p: 8e9 Pa is 78954 times the atmosphere's 101325 Pa;";
        assert!(text.contains(words) && text.contains("check the exponent"), "{text}");
    }
    for state in ["rho = 1.2, p = 9e7", "rho = 1, p = 1e9"] {
        let text = said("", state, wall, "");
        assert!(!text.contains("check the exponent"), "{state}: {text}");
    }
}

/// A unit that was asked for and makes all of a plant smaller than a hand, or larger than a town.
#[test]
fn sizes_by_a_given_unit_are_doubted() {
    let (at, skid) = (Scratch::new(), fixture("cad_skid.stl"));
    let inspect = |more: &[&str]| {
        let mut all: Vec<&dyn AsRef<std::ffi::OsStr>> = vec![&"inspect", &skid];
        all.extend(more.iter().map(|m| m as &dyn AsRef<std::ffi::OsStr>));
        stderr(&voidage(&all))
    };
    let text = inspect(&["--unit", "mm"]);
    assert!(
        text.contains("its size is 0.008369 × 0.0046 × 0.0036 m with the unit \"mm\", small for a plant"),
        "{text}"
    );
    assert!(text.contains("check that, --unit here, porosity.unit in a case"), "{text}");
    for unit in [&[][..], &["--unit", "m"], &["--unit", "cm"], &["--unit", "ft"]] {
        let text = inspect(unit);
        assert!(!text.contains("for a plant"), "{unit:?}: {text}");
    }
    let points = "v 0 0 0\nv 4e6 0 0\nv 0 4e6 0\nv 0 0 4e6\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    fs::write(at.file("large.obj"), points).expect("a file");
    fs::write(at.file("small.obj"), points.replace("e6", "e-3")).expect("a file");
    let said = |name: &str, unit: &[&str]| {
        let path = at.file(name);
        let mut all: Vec<&dyn AsRef<std::ffi::OsStr>> = vec![&"inspect", &path];
        all.extend(unit.iter().map(|m| m as &dyn AsRef<std::ffi::OsStr>));
        stderr(&voidage(&all))
    };
    let text = said("large.obj", &["--unit", "cm"]);
    assert!(text.contains("its size is 40000 × 40000 × 40000 m with the unit \"cm\", large for a plant"), "{text}");
    assert!(!said("small.obj", &[]).contains("for a plant"));
}

/// Nothing is said of the cases that ship, nor of the template.
#[test]
fn the_examples_are_not_doubted() {
    let at = Scratch::new();
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    fs::copy(examples.join("channel/cube.stl"), at.file("cube.stl")).expect("a copy");
    let read = |name: &str| fs::read_to_string(examples.join(name)).expect("an example");
    let template = stdout(&voidage(&[&"solve", &"--template"]));
    for (n, case) in [read("channel/channel.toml"), read("sod.toml"), template].into_iter().enumerate() {
        assert!(case.contains("\n[time]\n"));
        let short = case.replace("\n[time]\n", "\n[time]\nmax_steps = 0\n");
        let text = stderr(&solved(&at, &short, &format!("out{n}"), &[]));
        assert!(!text.contains("pressures are in Pa") && !text.contains("output.ambient"), "{text}");
        assert!(!text.contains("check the"), "{text}");
    }
}

/// A unit is of STL and OBJ files: beside a scene it is for these, and for a scene alone it has no effect.
#[test]
fn a_unit_is_doubted_where_it_has_no_effect() {
    let (at, skid) = (Scratch::new(), fixture("cad_skid.stl"));
    let ball = at.write("ball.toml", b"[[solid]]\nshape = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\n");
    let words = "ball.toml: a scene is in metres";
    let alone = stderr(&voidage(&[&"inspect", &ball, &"--unit", &"cm"]));
    assert_eq!(alone.matches(words).count(), 1, "{alone}");
    for scene in [[&ball, &skid], [&skid, &ball]] {
        let text = stderr(&voidage(&[&"inspect", scene[0], scene[1], &"--unit", &"cm"]));
        assert!(!text.contains(words), "{text}");
    }
}

/// Velocities and temperatures that no gas has are doubted, where a case is in SI units.
#[test]
fn velocities_and_temperatures_of_no_explosion_are_doubted() {
    let inlet = |u: &str| format!("{{ type = \"inlet\", rho = 1.2, u = {u} }}");
    let air = "T = 288, p = 101325";
    for (gas, state, side, words) in [
        (
            AIR,
            air,
            inlet("-2e4"),
            "key boundary.x_max.u: -20000 m/s is faster than the gas of any explosion: check the exponent",
        ),
        ("", "rho = 1.2, p = 1e5, u = 3e5", "\"wall\"".into(), "key initial.uniform.u: 300000 m/s is faster"),
        (
            AIR,
            "T = 288e3, p = 101325",
            "\"wall\"".into(),
            "key initial.uniform.T: 288000 K is hotter than the gas of any explosion",
        ),
    ] {
        let text = said(gas, state, &side, "");
        assert!(text.contains(words), "{text}");
    }
    for (gas, state, side) in [
        (AIR, air, inlet("-5e3")),
        (AIR, "T = 9e4, p = 101325", "\"wall\"".into()),
        ("", "rho = 1, p = 1, u = 3e4", "\"wall\"".into()),
        ("gas_constant = 1", "T = 2e5, p = 2e5", "\"wall\"".into()),
    ] {
        let text = said(gas, state, &side, "");
        assert!(!text.contains("check the exponent"), "{state}: {text}");
    }
}

/// A ratio of specific heats of no gas is doubted, and frames that come after the end.
#[test]
fn ratios_and_frames_of_no_use_are_doubted() {
    let air = "rho = 1.2, p = 1e5";
    let of_gamma = |gamma: &str| {
        let case = case("", air, "\"wall\"", "").replace("gamma = 1.4", &format!("gamma = {gamma}"));
        stderr(&solved(&Scratch::new(), &case, "out", &[]))
    };
    let text = of_gamma("14");
    assert!(text.contains("key gas.gamma: 14 is the ratio of specific heats of no gas"), "{text}");
    assert!(!of_gamma("1.67").contains("specific heats"));
    let of_every = |every: &str| {
        let case = case("", air, "\"wall\"", &format!("every = {every}")).replace("max_steps = 1", "end = 0.001");
        stderr(&solved(&Scratch::new(), &case, "out", &[]))
    };
    let text = of_every("5");
    assert!(text.contains("key output.every: 5 s is after the end, 0.001 s"), "{text}");
    assert!(!of_every("0.001").contains("output.every"));
}
