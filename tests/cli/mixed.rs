//! Burnt gas beside fresh gas in a case: what it holds, what is written of it, what goes on after a stop, and what is refused.

use crate::kit::{Scratch, array, json, solve, solved, stderr, voidage};
use std::f64::consts::PI;
use std::fs;

const TWO: [f64; 2] = [1.25, 1.4];

/// A ball of burnt gas in a chamber of 1 m, on `n` cells along each axis.
fn chamber(n: usize, ball: &str, more: &str) -> String {
    let axes = ["x", "y", "z"];
    let grid = axes.map(|a| format!("{a} = {{ points = [0, 1], cells = [{n}] }}\n")).concat();
    let sides = axes.map(|a| format!("{a}_min = \"wall\"\n{a}_max = \"wall\"\n")).concat();
    format!(
        "[grid]\n{grid}[gas]\nmodel = \"ideal\"\ngamma = 1.4\ngas_constant = 287\n[initial]\nuniform = {{ rho = 1.2, p = 1e5 }}\n\
         regions = [{{ center = [0.513, 0.48, 0.471], radius = 0.31, {ball} }}]\n[boundary]\n{sides}{more}"
    )
}

/// A line of `log.csv` as numbers.
fn log_line(at: &Scratch, dir: &str, line: usize) -> Vec<f64> {
    let text = fs::read_to_string(at.file(dir).join("log.csv")).expect("a log");
    text.lines().nth(line).expect("a line").split(',').map(|x| x.parse().expect("a number")).collect()
}

/// The ball holds p V/(γ − 1) on any grid, and the chamber keeps what it held.
#[test]
fn a_ball_of_burnt_gas_holds_its_energy_on_any_grid() {
    let volume = 4.0 / 3.0 * PI * 0.31f64.powi(3);
    let [burnt, fresh] = TWO.map(|gamma| 1.0 / (gamma - 1.0));
    for (state, density, pressure) in
        [("rho = 0.3, p = 8e5, gamma = 1.25", 0.3, 8e5), ("gamma = 1.25, T = 2000", 1e5 / (287.0 * 2000.0), 1e5)]
    {
        let exact = [1.2 + volume * (density - 1.2), 1e5 * fresh + volume * (pressure * burnt - 1e5 * fresh)];
        for n in [3, 8, 13] {
            let at = Scratch::new();
            solved(&at, &chamber(n, state, "[time]\nmax_steps = 6\n"), "out", &["-q"]);
            let begin = log_line(&at, "out", 1);
            for (found, exact) in [(begin[3], exact[0]), (begin[4], exact[1])] {
                assert!((found / exact - 1.0).abs() < 1e-11, "{state} {n}: {found}, not {exact}");
            }
            let report = json(&at.file("out/report.json"));
            let drift = |name: &str| report[name].as_f64().expect("a number").abs();
            assert!(drift("mass_drift") < 1e-13 && drift("energy_drift") < 1e-13, "{report}");
            // Gases of one pressure have it in the cells that hold both.
            let gamma = array(&at.file("out/final/gamma.npy"));
            assert!(gamma.iter().all(|g| (TWO[0]..=TWO[1]).contains(g)));
        }
    }
}

#[test]
fn gases_of_one_pressure_rest_side_by_side() {
    let at = Scratch::new();
    solved(&at, &chamber(9, "rho = 0.2, gamma = 1.25", "[time]\nmax_steps = 20\n"), "out", &["-q"]);
    let [rho, p, gamma] = ["rho", "p", "gamma"].map(|name| array(&at.file(&format!("out/final/{name}.npy"))));
    assert!(p.iter().all(|p| (p / 1e5 - 1.0).abs() < 1e-14));
    assert!((0..rho.len()).any(|c| rho[c] < 0.21 && gamma[c] < 1.2501));
    assert!((0..rho.len()).any(|c| gamma[c] > 1.26 && gamma[c] < 1.39), "no cell holds both");
    // Density and γ follow the same shares.
    for c in 0..rho.len() {
        let share = (rho[c] - 1.2) / (0.2 - 1.2);
        let capacity = 2.5 + share * (4.0 - 2.5);
        assert!((1.0 / (gamma[c] - 1.0) - capacity).abs() < 1e-9, "{c}: {} {}", rho[c], gamma[c]);
    }
}

#[test]
fn frames_probes_and_reports_know_gamma() {
    let at = Scratch::new();
    let more = "[time]\nmax_steps = 5\n[output]\nformats = [\"vtr\", \"npy\", \"png\"]\nmaxima = {}\n\
                probes = [{ name = \"in\", at = [0.5, 0.5, 0.5] }, { name = \"out\", at = [0.95, 0.95, 0.95] }]\n";
    let case = chamber(8, "rho = 0.3, p = 2e5, gamma = 1.25", more);
    solved(&at, &case, "out", &["-q", "--refine-check"]);
    let report = json(&at.file("out/report.json"));
    assert_eq!(report["gas"]["gammas"], serde_json::json!([1.25, 1.4]));
    assert_eq!(report["gas"]["gamma"], 1.4);
    assert!(report["refine_check"]["peaks"][0]["overpressure"]["coarse"].as_f64().expect("a number") > 0.0);
    let probes = fs::read_to_string(at.file("out/probes.csv")).expect("a table");
    let mut lines = probes.lines();
    let head = "step,time,in rho,in u,in v,in w,in p,in gamma,out rho,out u,out v,out w,out p,out gamma";
    assert_eq!(lines.next(), Some(head));
    let first: Vec<&str> = lines.next().expect("a line").split(',').collect();
    assert_eq!(first.len(), 14);
    let gamma = |column: usize| first[column].parse::<f64>().expect("a number");
    assert!((gamma(7) - 1.25).abs() < 1e-15 && (gamma(13) - 1.4).abs() < 1e-15, "{first:?}");
    let frame = fs::read(at.file("out/frames/flow_0000.vtr")).expect("a frame");
    assert!(frame.windows(12).any(|w| w == b"Name=\"gamma\""));
    assert_eq!(array(&at.file("out/frames/0000/gamma.npy")).len(), 512);

    // A run that begins from these results has the same gases; one with a single gas leaves no array of the other behind.
    let again = case
        .split("regions")
        .next()
        .expect("a part")
        .replace("uniform = { rho = 1.2, p = 1e5 }\n", "from = \"out/final\"\n");
    let rest = &case[case.find("[boundary]").expect("sides")..];
    solved(&at, &format!("{again}{rest}"), "next", &["-q"]);
    let of = |dir: &str| array(&at.file(&format!("{dir}/frames/0000/gamma.npy")));
    assert_eq!(of("next"), array(&at.file("out/final/gamma.npy")));
    solved(&at, &case.replace(", gamma = 1.25", ""), "out", &["-q", "--force"]);
    assert!(!at.file("out/final/gamma.npy").exists());
    let head = fs::read_to_string(at.file("out/probes.csv")).expect("a table");
    assert!(!head.contains("gamma"));
}

/// Everything at once: burnt gas from an inlet and a patch, solids with jumps and small cells, drag, gravity.
fn burner(time: &str, gamma: &str) -> String {
    format!(
        "[grid]\nx = {{ points = [0, 2], cells = [24] }}\ny = {{ points = [0, 1], cells = [14] }}\nz = {{ points = [0, 1], cells = [12] }}\n\
         [porosity]\nscene = \"scene.toml\"\n[gas]\nmodel = \"ideal\"\ngamma = 1.4\ngas_constant = 287\n\
         [initial]\nuniform = {{ T = 288, p = 1e5 }}\nregions = [{{ center = [0.6, 0.4, 0.5], radius = 0.3, T = 1800, p = 3e5, gamma = 1.25 }}]\n\
         [boundary]\nx_min = {{ type = \"inlet\", T = 1500, u = 40, gamma = {gamma} }}\nx_max = {{ type = \"outlet\", p = 1e5 }}\n\
         y_min = \"wall\"\ny_max = {{ type = \"far-field\", T = 288, p = 1e5 }}\nz_min = \"wall\"\nz_max = \"wall\"\n\
         [[boundary.patch]]\nside = \"z_min\"\nmin = [0.2, 0.2]\nmax = [0.5, 0.6]\ntype = \"inlet\"\nT = 900\nw = 20\ngamma = 1.33\n\
         [drag]\ncr = [0.5, 0, 0.2]\n[gravity]\ng = [0, -9.81, 0]\n[time]\n{time}\n\
         [output]\nmaxima = {{}}\nprobes = [{{ name = \"P\", at = [1.5, 0.5, 0.5] }}]\n"
    )
}

const SCENE: &str = "[[solid]]\nshape = \"box\"\nmin = [1.03, 0.22, 0]\nmax = [1.31, 0.7, 0.63]\n\
                     [[solid]]\nshape = \"cylinder\"\nfrom = [0.3, 0.8, -1]\nto = [0.4, 0.8, 2]\nradius = 0.11\n";

/// The bits of the last state, and of the tables.
fn results(at: &Scratch, dir: &str) -> Vec<Vec<u8>> {
    let names = ["final/rho.npy", "final/u.npy", "final/p.npy", "final/gamma.npy", "log.csv", "probes.csv"];
    names.iter().map(|name| fs::read(at.file(dir).join(name)).expect("a file")).collect()
}

#[test]
fn a_stop_and_threads_do_not_change_the_bits() {
    let at = Scratch::new();
    fs::write(at.file("scene.toml"), SCENE).expect("written");
    let whole = burner("end = 0.002", "1.3");
    solved(&at, &whole, "one", &["-q", "--threads", "1"]);
    let report = json(&at.file("one/report.json"));
    assert_eq!(report["gas"]["gammas"], serde_json::json!([1.25, 1.4]));
    let number = |name: &str| report[name].as_f64().expect("a number").abs();
    assert!(number("mass_drift") < 1e-13 && report["floors"] == 0, "{report}");
    assert!(report["porosity"]["merged_cells"].as_u64() > Some(0), "{report}");
    solved(&at, &whole, "two", &["-q", "--threads", "2"]);
    assert!(results(&at, "two") == results(&at, "one"), "two threads");
    solved(&at, &burner("end = 0.002\nmax_steps = 17", "1.3"), "stopped", &["-q"]);
    solved(&at, &whole, "stopped", &["-q", "--resume"]);
    assert!(results(&at, "stopped") == results(&at, "one"), "resumed");
    let other = solve(&at, &burner("end = 0.003", "1.31"), "stopped", &["-q", "--resume"]);
    assert!(stderr(&other).contains("its boundary differs"), "{}", stderr(&other));
    let other =
        solve(&at, &burner("end = 0.003", "1.3").replace("gamma = 1.25", "gamma = 1.24"), "stopped", &["--resume"]);
    assert!(stderr(&other).contains("its gas differs"), "{}", stderr(&other));
}

/// The burnt gas of an inlet drives the fresh gas out.
#[test]
fn an_inlet_of_burnt_gas_fills_a_channel() {
    let at = Scratch::new();
    let case = "[grid]\nx = { points = [0, 1], cells = [40] }\n[gas]\nmodel = \"ideal\"\ngamma = 1.4\n[initial]\nuniform = { rho = 1.2, u = 50, p = 1e5 }\n\
                [boundary]\nx_min = { type = \"inlet\", rho = 0.3, u = 50, gamma = 1.25 }\nx_max = { type = \"outlet\", p = 1e5 }\n[time]\nend = 0.04\n";
    solved(&at, case, "out", &["-q"]);
    let [rho, gamma] = ["rho", "gamma"].map(|name| array(&at.file(&format!("out/final/{name}.npy"))));
    assert!(gamma.iter().all(|g| (g - 1.25).abs() < 1e-6), "{gamma:?}");
    assert!(rho.iter().all(|rho| (rho / 0.3 - 1.0).abs() < 0.02), "{rho:?}");
}

#[test]
fn what_cannot_be_is_refused() {
    let right = chamber(4, "p = 2e5, gamma = 1.25", "[time]\nmax_steps = 1\n");
    let isentropic = "model = \"isentropic\"\nrho = 1.2\np = 1e5\ngamma = 1.4";
    let wrong = [
        ("gamma = 1.25", "gamma = 1", "initial.regions[0].gamma: needs a number above 1 and up to 100, not 1"),
        ("gamma = 1.25", "gamma = inf", "initial.regions[0].gamma: needs a number above 1 and up to 100, not inf"),
        (
            "rho = 1.2, p = 1e5",
            "rho = 1.2, p = 1e5, gamma = 0.9",
            "initial.uniform.gamma: needs a number above 1 and up to 100, not 0.9",
        ),
        (
            "x_max = \"wall\"",
            "x_max = { type = \"outlet\", p = 1e5, gamma = 1.3 }",
            "boundary.x_max.gamma: is not a key of this type (outlet)",
        ),
        (
            "x_max = \"wall\"",
            "x_max = { type = \"wall\", gamma = 1.3 }",
            "boundary.x_max.gamma: is not a key of this type (wall)",
        ),
        ("gamma = 1.25", "gama = 1.25", "initial.regions[0].gama: is not known here; did you mean gamma?"),
        (
            "model = \"ideal\"\ngamma = 1.4\ngas_constant = 287",
            isentropic,
            "gamma: goes with the gas model ideal, not with isentropic",
        ),
    ];
    for (from, to, words) in wrong {
        let at = Scratch::new();
        assert!(right.contains(from), "{from}");
        let output = solve(&at, &right.replace(from, to), "out", &[]);
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{to}: {said}");
        assert!(said.contains(words) && said.contains("case.toml") && said.contains('^'), "{to}: {said}");
    }
    let at = Scratch::new();
    fs::write(at.file("study.toml"), "[[flow]]\nproblem = \"sod\"\ncells = 10\ngamma = 1.3\n").expect("written");
    let output = voidage(&[&"study", &at.file("study.toml"), &"-o", &at.file("out")]);
    assert!(!output.status.success() && stderr(&output).contains("gamma"), "{}", stderr(&output));
}
