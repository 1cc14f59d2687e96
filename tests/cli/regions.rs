//! What a region holds does not depend on the grid: mass and energy at the beginning against closed forms.

use crate::kit::{Scratch, array, json, solve, solved, stderr};
use std::f64::consts::PI;
use std::fs;

/// Mass and energy of the first line of the log of a case, and its report.
fn begin(grid: &str, axes: &str, initial: &str) -> (f64, f64, serde_json::Value) {
    let at = Scratch::new();
    let sides: String = axes.chars().map(|a| format!("{a}_min = \"wall\"\n{a}_max = \"wall\"\n")).collect();
    let case = format!(
        "[grid]\n{grid}\n[gas]\nmodel = \"ideal\"\ngamma = 1.4\n[initial]\n{initial}\n[boundary]\n{sides}[time]\nmax_steps = 1\n"
    );
    solved(&at, &case, "out", &["-q"]);
    let log = fs::read_to_string(at.file("out/log.csv")).expect("a log");
    let first: Vec<f64> =
        log.lines().nth(1).expect("a line").split(',').map(|x| x.parse().expect("a number")).collect();
    (first[3], first[4], json(&at.file("out/report.json")))
}

/// Density and pressure of the gas around and in the region.
const STATES: [[f64; 2]; 2] = [[1.2, 1e5], [0.3, 8e5]];

/// Checks the content of a space of volume `space`, of which the region takes `volume`.
fn holds(grid: &str, axes: &str, region: &str, space: f64, volume: f64) -> serde_json::Value {
    let [[rho, p], [rho_in, p_in]] = STATES;
    let initial =
        format!("uniform = {{ rho = {rho}, p = {p} }}\nregions = [{{ {region}, rho = {rho_in}, p = {p_in} }}]");
    let (mass, energy, report) = begin(grid, axes, &initial);
    let exact = [space * rho + volume * (rho_in - rho), (space * p + volume * (p_in - p)) / 0.4];
    for (found, exact, of_region) in [(mass, exact[0], volume * rho), (energy, exact[1], volume * p / 0.4)] {
        assert!((found - exact).abs() < 1e-10 * of_region, "{grid} {region}: {found}, not {exact}");
    }
    let told = report["regions"][0]["volume"].as_f64().expect("a volume");
    assert!((told / volume - 1.0).abs() < 1e-10, "{grid} {region}: {told}, not {volume}");
    report
}

#[test]
fn a_ball_holds_the_same_on_any_grid() {
    let ball = "center = [0.513, 0.48, 0.471], radius = 0.37";
    let volume = 4.0 / 3.0 * PI * 0.37_f64.powi(3);
    let even = |n: usize| ["x", "y", "z"].map(|a| format!("{a} = {{ points = [0, 1], cells = [{n}] }}")).join("\n");
    let stretched = "x = { points = [0, 0.4, 1], cells = [9, 6], ratios = [1, 3] }\ny = { points = [0, 1], cells = [5] }\n\
                     z = { points = [0, 1], cells = [23] }";
    for grid in [even(2), even(7), even(16), stretched.to_owned()] {
        holds(&grid, "xyz", ball, 1.0, volume);
    }
    let report = holds(&even(10), "xyz", ball, 1.0, volume);
    let cells = report["regions"][0]["cells_per_radius"].as_f64().expect("a number");
    assert!((cells - 3.7).abs() < 1e-9, "{cells}");
    // Smaller than a cell, wherever in it.
    let small = "center = [0.31, 0.29, 0.33], radius = 0.04";
    holds(&even(4), "xyz", small, 1.0, 4.0 / 3.0 * PI * 0.04_f64.powi(3));
}

#[test]
fn a_disc_an_interval_and_a_box_hold_the_same_on_any_grid() {
    for n in [3, 10, 31] {
        let plane =
            format!("x = {{ points = [-1, 1], cells = [{n}] }}\ny = {{ points = [0, 2], cells = [{}] }}", n + 2);
        holds(&plane, "xy", "center = [0.1, 0.9], radius = 0.6", 4.0, PI * 0.36);
        // One that the domain cuts in halves.
        holds(&plane, "xy", "center = [0.1, 0], radius = 0.6", 4.0, 0.5 * PI * 0.36);
        holds(&plane, "xy", "min = [-0.43, 0.77], max = [0.2]", 4.0, 0.63 * 1.23);
        let line = format!("x = {{ points = [0, 1], cells = [{n}] }}");
        holds(&line, "x", "center = [0.4], radius = 0.21", 1.0, 0.42);
        holds(&line, "x", "min = [0.77]", 1.0, 0.23);
    }
}

#[test]
fn regions_that_meet_inside_a_cell_share_it() {
    let at = Scratch::new();
    let case = |regions: &str| {
        format!(
            "[grid]\nx = {{ points = [0, 1], cells = [5] }}\n[gas]\nmodel = \"ideal\"\ngamma = 1.4\n[initial]\nregions = [{regions}]\n\
             [boundary]\nx_min = \"wall\"\nx_max = \"wall\"\n[time]\nmax_steps = 1\n[output]\nevery = 1\nformats = [\"npy\"]\n"
        )
    };
    solved(&at, &case("{ max = [0.45], rho = 1, p = 1, u = 4 }, { min = [0.45], rho = 3, p = 2, u = 0 }"), "out", &["-q"]);
    let [rho, u, p] = ["rho", "u", "p"].map(|f| array(&at.file(&format!("out/frames/0000/{f}.npy"))));
    // A quarter of the third cell is of the first state. Momentum 1/4 · 4; energy 1/4 (2.5 + 8) + 3/4 · 5 less the kinetic 1/2 · 1/2.5.
    let exact = [(rho, 2.5), (u, 0.4), (p, 0.4 * (0.25 * 10.5 + 0.75 * 5.0 - 0.2))];
    for (values, exact) in exact {
        assert!((values[2] - exact).abs() < 1e-12, "{values:?}, not {exact}");
    }
    let refused = solve(&at, &case("{ max = [0.45], rho = 1, p = 1 }"), "none", &["-q"]);
    assert_eq!(refused.status.code(), Some(1));
    assert!(stderr(&refused).contains("cell [2, 0, 0] at [0.5, 0.5, 0.5] is in no region"), "{}", stderr(&refused));
}
