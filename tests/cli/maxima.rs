//! Largest values over time and forces on solids, against what they must be.

use crate::kit::{Scratch, array, json, solve, solved, stderr};
use std::fs;

/// Lines of `log.csv` as numbers.
fn log(at: &Scratch, dir: &str) -> Vec<Vec<f64>> {
    let text = fs::read_to_string(at.file(dir).join("log.csv")).expect("a log");
    text.lines().skip(1).map(|l| l.split(',').map(|x| x.parse().expect("a number")).collect()).collect()
}

/// Columns of the forces.
const FORCE: std::ops::Range<usize> = 10..13;

/// Gas that is stopped by a wall: the pressure at the wall and the speed of the shock that runs back, by the conditions of Rankine and Hugoniot
/// (Toro, eq. 4.6 and ch. 3.1.3).
fn stopped(gamma: f64, rho: f64, p: f64, u: f64) -> (f64, f64) {
    let (a, b) = (2.0 / ((gamma + 1.0) * rho), (gamma - 1.0) / (gamma + 1.0) * p);
    let (mut low, mut high) = (p, 1e3 * p);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if (middle - p) * (a / (middle + b)).sqrt() < u { low = middle } else { high = middle }
    }
    let sound = (gamma * p / rho).sqrt();
    let mach = ((gamma + 1.0) / (2.0 * gamma) * (low / p) + (gamma - 1.0) / (2.0 * gamma)).sqrt();
    (low, mach * sound - u)
}

/// A stream meets a block that fills the end of a channel of 0.5 m: force, overpressure, arrival, impulse.
#[test]
fn a_stream_against_a_block() {
    let at = Scratch::new();
    fs::write(at.file("scene.toml"), "[[solid]]\nshape = \"box\"\nmin = [0.8, -1, -1]\nmax = [2, 2, 2]\n")
        .expect("written");
    let (gamma, rho, p, u) = (1.4, 1.2, 1e5, 100.0);
    let case = format!(
        r#"
[grid]
x = {{ points = [0, 1], cells = [200] }}
y = [0, 0.25, 0.5]
[porosity]
scene = "scene.toml"
[gas]
model = "ideal"
gamma = {gamma}
[initial]
uniform = {{ rho = {rho}, u = {u}, p = {p} }}
[boundary]
x_min = {{ type = "far-field", rho = {rho}, u = {u}, p = {p} }}
x_max = "wall"
y_min = "wall"
y_max = "wall"
[time]
end = 0.0015
[output]
maxima = {{ threshold = 2e4 }}
probes = [{{ name = "wall", at = [0.799, 0.1, 0.1] }}, {{ name = "far", at = [0.5, 0.1, 0.1] }}]
"#
    );
    let never = "key output.maxima.threshold: an overpressure of";
    let text = stderr(&solved(&at, &case, "out", &[]));
    assert!(!text.contains(never), "{text}");
    let text = stderr(&solved(&at, &case.replace("2e4", "2e6"), "never", &[]));
    assert!(text.contains(&format!("{never} 2000000 Pa was met in no cell: arrival.npy holds NaN alone")), "{text}");
    let (wall, speed) = stopped(gamma, rho, p, u);
    assert!((wall / 1.489e5 - 1.0).abs() < 1e-3 && speed > 250.0 && speed < 340.0, "{wall} Pa, {speed} m/s");
    // The block's face is 0.5 m high, and a metre deep as there is no z; after a few steps the shock has left it.
    let area = 0.5;
    for line in log(&at, "out").iter().filter(|l| l[1] > 2e-4) {
        let [x, y, z] = [0, 1, 2].map(|a| line[FORCE][a]);
        let truth = (wall - p) * area;
        assert!((x / truth - 1.0).abs() < 5e-3, "{x} N at {} s, not {truth}", line[1]);
        assert!(y.abs() < 1e-6 * x && z == 0.0, "{y}, {z}");
    }
    let maxima = &json(&at.file("out/report.json"))["maxima"];
    assert_eq!((maxima["ambient"].as_f64(), maxima["threshold"].as_f64()), (Some(p), Some(2e4)));
    let end = 0.0015;
    // The cell at the wall overshoots in the first steps, where the shock has no width yet.
    for (probe, away, error) in [(0, 0.8 - 0.7975, 0.05), (1, 0.8 - 0.5025, 0.01)] {
        let number = |key: &str| maxima["probes"][probe][key].as_f64().expect("a number");
        assert!((number("overpressure") / (wall - p) - 1.0).abs() < error, "{maxima}");
        // The moment is that of the middle of the cell, to a cell.
        let arrival = away / speed;
        assert!((number("arrival") - arrival).abs() < 0.005 / speed, "{maxima}, arrival {arrival}");
        assert!((number("impulse") / ((wall - p) * (end - arrival)) - 1.0).abs() < 0.02, "{maxima}");
        assert!((number("dynamic_pressure") / (0.5 * rho * u * u) - 1.0).abs() < 0.02, "{maxima}");
    }
    // Nothing is told of the inside of the block.
    let over = array(&at.file("out/maxima/overpressure.npy"));
    assert!((0..400).all(|c| over[c].is_nan() == (c % 200 >= 160)));
}

/// Drag is a force: gas of one speed through cells that drag, in a closed form.
#[test]
fn drag_is_a_force() {
    let at = Scratch::new();
    let case = "[grid]\nx = { points = [0, 2], cells = [8] }\ny = { points = [0, 3], cells = [4] }\n\
                [gas]\nmodel = \"ideal\"\ngamma = 1.4\n[initial]\nuniform = { rho = 1.2, u = 4, v = 3, p = 1e5 }\n\
                [boundary]\nx_min = \"periodic\"\nx_max = \"periodic\"\ny_min = \"periodic\"\ny_max = \"periodic\"\n\
                [drag]\ncr = [0.5, 0, 0]\nlinear = [0, 2, 0]\n[time]\nmax_steps = 3\n";
    solved(&at, case, "out", &["-q"]);
    let lines = log(&at, "out");
    // ½ cr ρ |u| u V along x, linear ρ v V along y, in 2 × 3 × 1 m³.
    let first = &lines[0][FORCE];
    assert!(
        (first[0] - 0.5 * 0.5 * 1.2 * 5.0 * 4.0 * 6.0).abs() < 1e-9 && (first[1] - 2.0 * 1.2 * 3.0 * 6.0).abs() < 1e-9
    );
    // What the gas loses is what the obstacles take in a step: along y its speed falls as e^(-2t), whatever it does along x.
    assert_eq!(lines.len(), 4);
    for n in 1..lines.len() {
        let [before, now] = [n - 1, n].map(|n| 3.0 * (-2.0 * lines[n][1]).exp());
        let taken = 1.2 * 6.0 * (before - now) / lines[n][2];
        assert!((lines[n][FORCE][1] / taken - 1.0).abs() < 1e-9, "line {n}: {} N of {taken}", lines[n][FORCE][1]);
    }
}

/// Gas at rest presses on all sides alike; its weight is no force on a room without solids.
#[test]
fn gas_at_rest_pushes_nothing() {
    let at = Scratch::new();
    fs::write(at.file("scene.toml"), "[[solid]]\nshape = \"sphere\"\ncenter = [0.5, 0.5, 0.4]\nradius = 0.23\n")
        .expect("written");
    let case = |porosity: &str, gravity: f64| {
        format!(
            "[grid]\norigin = [0, 0, 0]\nspacing = [0.1, 0.1, 0.1]\ncells = [10, 10, 10]\n{porosity}\n\
             [gas]\nmodel = \"ideal\"\ngamma = 1.4\n[initial]\nuniform = {{ rho = 1.2, p = 1e5 }}\n\
             [boundary]\nx_min = \"wall\"\nx_max = \"wall\"\ny_min = \"wall\"\ny_max = \"wall\"\nz_min = \"wall\"\nz_max = \"wall\"\n\
             [gravity]\ng = [0, 0, {gravity}]\n[time]\nmax_steps = 12\n"
        )
    };
    let largest =
        |dir: &str| log(&at, dir).iter().flat_map(|l| l[FORCE].to_vec()).fold(0.0, |m: f64, f| m.max(f.abs()));
    solved(&at, &case("[porosity]\nscene = \"scene.toml\"", 0.0), "still", &["-q"]);
    // A pressure of 1e5 Pa on sides of 1 m².
    assert!(largest("still") < 1e-9 * 1e5, "{} N", largest("still"));
    solved(&at, &case("", -9.81), "weight", &["-q"]);
    assert_eq!(largest("weight"), 0.0);
    // With a solid in it, the pressure that builds up below bears it: less than the weight of all the gas while it begins to move.
    solved(&at, &case("[porosity]\nscene = \"scene.toml\"", -9.81), "falling", &["-q"]);
    let last = log(&at, "falling").pop().expect("lines");
    let weight = 1.2 * 9.81;
    assert!(last[12].abs() > 1e-3 && last[12].abs() < weight && last[10].abs() < 1e-6 * weight, "{last:?}");
}

/// With a frame after every step the largest values are those of the frames.
#[test]
fn peaks_are_those_of_finely_sampled_frames() {
    let at = Scratch::new();
    let every = 1e-5;
    let case = format!(
        r#"
[grid]
x = {{ points = [0, 1], cells = [24] }}
y = {{ points = [0, 1], cells = [18] }}
[gas]
model = "ideal"
gamma = 1.4
[initial]
uniform = {{ rho = 1.2, p = 1e5 }}
regions = [{{ center = [0.4, 0.5], radius = 0.2, p = 6e5 }}]
[boundary]
x_min = "wall"
x_max = "wall"
y_min = "wall"
y_max = {{ type = "far-field", rho = 1.2, p = 1e5 }}
[scheme]
careful_steps = 0
[time]
end = 6e-4
[output]
every = {every}
formats = ["npy"]
maxima = {{}}
"#
    );
    solved(&at, &case, "out", &["-q"]);
    let report = json(&at.file("out/report.json"));
    let times: Vec<f64> = report["frames"].as_array().expect("frames").iter().filter_map(|t| t.as_f64()).collect();
    assert_eq!(report["steps"], times.len() - 1, "a frame after every step");
    let read = |n: usize, field: &str| array(&at.file(&format!("out/frames/{n:04}/{field}.npy")));
    let over: Vec<Vec<f64>> = (0..times.len()).map(|n| read(n, "p").iter().map(|p| p - 1e5).collect()).collect();
    let dynamic = |n: usize| -> Vec<f64> {
        let [rho, u, v] = ["rho", "u", "v"].map(|f| read(n, f));
        (0..rho.len()).map(|c| 0.5 * rho[c] * (u[c] * u[c] + v[c] * v[c])).collect()
    };
    let dynamic: Vec<Vec<f64>> = (0..times.len()).map(dynamic).collect();
    let peak = |name: &str| array(&at.file(&format!("out/maxima/{name}.npy")));
    let [most, impulse, arrival, wind] = ["overpressure", "impulse", "arrival", "dynamic_pressure"].map(peak);
    let mut reached = 0;
    for cell in 0..most.len() {
        let of = |frames: &[Vec<f64>]| frames.iter().fold(f64::NEG_INFINITY, |m, f| m.max(f[cell]));
        assert_eq!(most[cell], of(&over), "cell {cell}");
        assert!((wind[cell] - of(&dynamic)).abs() <= 1e-12 * wind[cell], "cell {cell}");
        let (mut sum, mut largest) = (0.0, 0.0_f64);
        for n in 1..times.len() {
            sum += 0.5 * (times[n] - times[n - 1]) * (over[n - 1][cell] + over[n][cell]);
            largest = largest.max(sum);
        }
        assert!((impulse[cell] - largest).abs() < 1e-9 * 1e5 * 6e-4, "cell {cell}: {} {largest}", impulse[cell]);
        match (0..times.len()).find(|&n| over[n][cell] >= 1000.0) {
            None => assert!(arrival[cell].is_nan(), "cell {cell}"),
            Some(0) => assert_eq!(arrival[cell], 0.0),
            Some(n) => {
                reached += 1;
                let within = arrival[cell] > times[n - 1] - 1e-12 && arrival[cell] <= times[n] + 1e-12;
                assert!(within, "cell {cell}: {} between {} and {}", arrival[cell], times[n - 1], times[n]);
            }
        }
    }
    assert!(reached > 100, "{reached} cells were reached");
}

/// Pictures of a run: one range for all frames, known or given; walls of a grating show.
#[test]
fn pictures_have_one_range() {
    let at = Scratch::new();
    let template = crate::kit::stdout(&crate::kit::voidage(&[&"solve", &"--template"]));
    let case = template.replace("end = 0.006", "end = 0.0009").replace("every = 0.002", "every = 0.0003");
    let png = |dir: &str, name: &str| fs::read(at.file(&format!("{dir}/frames/{name}.png"))).expect("a picture");
    solved(&at, &case, "own", &["-q"]);
    solved(
        &at,
        &case.replace("[output]", "[output]\nrange = { speed = [0, 2000], overpressure = [0, 700] }"),
        "given",
        &["-q"],
    );
    assert!(!at.file("given/frames/slices").exists() && at.file("own/frames/slices/0003.npy").is_file());
    // At rest at the beginning: one colour, unless the range of the run is another than that of the frame.
    assert!(png("own", "speed_0000") != png("given", "speed_0000"));
    // In two parts the pictures are those of the whole.
    solved(&at, &case.replace("end = 0.0009", "end = 0.0009\nmax_steps = 12"), "parts", &["-q"]);
    solved(&at, &case, "parts", &["-q", "--resume"]);
    let frames = json(&at.file("own/report.json"))["frames"].as_array().expect("frames").len();
    assert_eq!(frames, 4);
    for name in (0..frames).flat_map(|n| [format!("speed_{n:04}"), format!("pressure_{n:04}")]) {
        assert!(png("own", &name) == png("parts", &name), "{name}");
    }
    fs::write(
        at.file("scene.toml"),
        "[[solid]]\nshape = \"box\"\nmin = [2, 0, 0]\nmax = [2.1, 2, 2]\nporosity = 0.6\n",
    )
    .expect("written");
    solved(&at, &case.replace("[gas]", "[porosity]\nscene = \"scene.toml\"\n[gas]"), "wall", &["-q"]);
    assert!(png("wall", "pressure_0000") != png("own", "pressure_0000"));
}

/// A blast in a closed box, on 16 cells along an axis and on 8.
const BLAST: &str = r#"
[grid]
x = { points = [0, 1], cells = [16] }
y = { points = [0, 1], cells = [16] }
[gas]
model = "ideal"
gamma = 1.4
[initial]
uniform = { rho = 1.2, p = 1e5 }
regions = [{ center = [0.3, 0.3], radius = 0.2, p = 5e5, rho = 1.2 }]
[boundary]
x_min = "wall"
x_max = "wall"
y_min = "wall"
y_max = "wall"
[time]
end = 1e-3
[output]
formats = []
probes = [{ name = "far", at = [0.9, 0.9, 0] }, { name = "near", at = [0.55, 0.3, 0] }]
"#;

/// The check tells what a run on half the cells finds by itself.
#[test]
fn half_the_cells_beside_all() {
    let at = Scratch::new();
    solved(&at, BLAST, "fine", &["-q", "--refine-check"]);
    let fine = json(&at.file("fine/report.json"));
    let coarse = BLAST.replace("cells = [16]", "cells = [8]").replace("formats", "maxima = {}\nformats");
    solved(&at, &coarse, "coarse", &["-q"]);
    let coarse = json(&at.file("coarse/report.json"));
    let check = &fine["refine_check"];
    assert_eq!(check["cells"], serde_json::json!([8, 8, 1]));
    assert_eq!(check["steps"], coarse["steps"]);
    let peaks = check["peaks"].as_array().expect("a list");
    assert_eq!(
        peaks.iter().map(|p| p["name"].as_str().expect("a name")).collect::<Vec<_>>(),
        ["outside the starting regions", "far", "near"]
    );
    // Cells of the coarse grid that the ball does not reach, in the cells of the fine one.
    let over = array(&at.file("fine/maxima/overpressure.npy"));
    let beside = |n: usize| {
        let (low, high) = ((n / 2) as f64 / 8.0, (n / 2 + 1) as f64 / 8.0);
        (low - 0.3).max(0.3 - high).max(0.0)
    };
    let outside = (0..256).filter(|c| beside(c % 16).hypot(beside(c / 16)) >= 0.2);
    let largest = outside.map(|c| over[c]).fold(0.0, f64::max);
    assert_eq!(peaks[0]["overpressure"]["fine"].as_f64(), Some(largest));
    // Before the blast meets a wall there is nowhere as much as in the ball at the beginning, where it is 4e5 Pa on any grid.
    solved(&at, &BLAST.replace("end = 1e-3", "end = 1e-4"), "short", &["-q", "--refine-check"]);
    let short = &json(&at.file("short/report.json"))["refine_check"]["peaks"][0]["overpressure"];
    for grid in ["fine", "coarse"] {
        assert!(short[grid].as_f64().is_some_and(|p| p > 2e4 && p < 3e5), "{short}");
    }
    for n in 0..2 {
        for key in ["overpressure", "impulse", "dynamic_pressure"] {
            let found = &peaks[n + 1][key];
            assert_eq!(found["fine"], fine["maxima"]["probes"][n][key], "{key}");
            assert_eq!(found["coarse"], coarse["maxima"]["probes"][n][key], "{key}");
            let [fine, coarse, change] = ["fine", "coarse", "change"].map(|k| found[k].as_f64().expect("a number"));
            assert!(fine != coarse && (change - (fine - coarse) / fine).abs() < 1e-12, "{key}");
            assert!(peaks[0][key]["fine"].as_f64().expect("a number") >= fine, "{key}");
        }
    }
}

/// Without a region above the ambient pressure all cells count, and so they do where one fills the grid.
#[test]
fn all_cells_count_without_a_starting_region() {
    let at = Scratch::new();
    for (n, region) in
        ["center = [0.3, 0.3], radius = 0.2, u = 50", "min = [0, 0], max = [1, 1], p = 5e5"].iter().enumerate()
    {
        let case = BLAST.replace("center = [0.3, 0.3], radius = 0.2, p = 5e5, rho = 1.2", region);
        let case = case.replace("formats", "ambient = 1e5\nformats");
        let output = solved(&at, &case, &format!("out{n}"), &["--refine-check"]);
        let check = &json(&at.file(&format!("out{n}/report.json")))["refine_check"];
        assert_eq!(check["peaks"][0]["name"], "anywhere", "{region}");
        assert!(crate::kit::stdout(&output).contains("\n  anywhere    overpressure "), "{region}");
    }
}

/// What cannot be halved is refused before anything runs.
#[test]
fn cases_that_cannot_be_halved() {
    let at = Scratch::new();
    let few = BLAST.replace("y = { points = [0, 1], cells = [16] }", "y = { points = [0, 1], cells = [3] }");
    let output = solve(&at, &few, "few", &["--refine-check"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("fewer than 4 cells along y"), "{}", stderr(&output));
    let fields = BLAST.replace("[gas]", "[porosity]\nfrom = \"fields\"\n[gas]");
    let output = solve(&at, &fields, "fields", &["--refine-check"]);
    assert!(stderr(&output).contains("porosity.from") && !at.file("fields").exists(), "{}", stderr(&output));
}

/// A probe in a solid on either grid has no values there: that is said, and null in the report.
#[test]
fn probes_in_solids_of_either_grid() {
    let at = Scratch::new();
    // Fills cells 12 and 13 of the case, and 6 of half of them; and 9, which is half of 4.
    let solids = [[0.75, 0.875], [0.5625, 0.625]]
        .map(|[lo, hi]| format!("[[solid]]\nshape = \"box\"\nmin = [{lo}, -1, -1]\nmax = [{hi}, 2, 2]\n"));
    fs::write(at.file("walls.toml"), solids.concat()).expect("written");
    let probes = "{ name = \"both\", at = [0.8, 0.5, 0] }, { name = \"fine\", at = [0.6, 0.5, 0] }, { name = \"none\", at = [0.1, 0.5, 0] }";
    let case = BLAST.replace("[gas]", "[porosity]\nscene = \"walls.toml\"\nmerge = false\n[gas]");
    let (begin, _) = case.split_once("probes = ").expect("probes");
    let output = solved(&at, &format!("{begin}probes = [{probes}]\n"), "out", &["--refine-check"]);
    let said = crate::kit::stdout(&output);
    let line = |name: &str| said.lines().find(|l| l.trim_start().starts_with(name)).expect("a line").to_owned();
    assert!(!said.contains("NaN"), "{said}");
    assert_eq!(line("both").split_whitespace().collect::<Vec<_>>().join(" "), "both in a solid, on both grids");
    assert!(line("fine").contains("overpressure in a solid, ") && line("fine").contains("(–)"), "{}", line("fine"));
    assert!(line("none").contains(" %"), "{}", line("none"));
    let report = json(&at.file("out/report.json"));
    let [both, fine, none] = [1, 2, 3].map(|n| &report["refine_check"]["peaks"][n]["overpressure"]);
    assert!(both["fine"].is_null() && both["coarse"].is_null() && both["change"].is_null(), "{both}");
    assert!(fine["fine"].is_null() && fine["coarse"].is_number() && fine["change"].is_null(), "{fine}");
    assert!(none["fine"].is_number() && none["coarse"].is_number() && none["change"].is_number(), "{none}");
}
