//! Patches of a case: where they stand, what they let pass, and what is said of those that cannot be.

use crate::kit::{Scratch, array, json, solve, solved, stderr};
use std::fs;

/// A chamber of 2 × 1 × 1 m with some patches.
fn chamber(patches: &str, initial: &str, more: &str) -> String {
    let grid = "x = { points = [0, 2], cells = [20] }\ny = { points = [0, 1], cells = [10] }\nz = { points = [0, 1], cells = [10] }";
    let sides: String = ["x", "y", "z"].map(|a| format!("{a}_min = \"wall\"\n{a}_max = \"wall\"\n")).concat();
    format!(
        "[grid]\n{grid}\n[gas]\nmodel = \"ideal\"\ngamma = 1.4\n[initial]\nuniform = {{ {initial} }}\n[boundary]\n{sides}{patches}\n{more}"
    )
}

#[test]
fn a_vent_lets_pressure_out() {
    let at = Scratch::new();
    let vent =
        "[[boundary.patch]]\nside = \"x_max\"\nmin = [0, 0.2, 0.3]\nmax = [9, 0.6, 0.5]\ntype = \"outlet\"\np = 1e5\n";
    let case = chamber(vent, "rho = 1.2, p = 1.5e5", "[time]\nend = 0.004\n");
    solved(&at, &case, "out", &["-q"]);
    let report = json(&at.file("out/report.json"));
    assert_eq!(report["patches"][0]["side"], "x_max");
    assert_eq!(report["patches"][0]["type"], "outlet");
    assert_eq!(report["patches"][0]["faces"], 8);
    let number = |v: &serde_json::Value| v.as_f64().expect("a number");
    assert!((number(&report["patches"][0]["area"]) - 0.08).abs() < 1e-12);
    assert!(number(&report["mass_drift"]).abs() < 1e-13 && number(&report["energy_drift"]).abs() < 1e-13);
    assert!(number(&report["mass"]) < 0.995 * 2.4, "{}", report["mass"]);
    // Gas runs towards the vent and nowhere else through that side.
    let [u, p] = ["u", "p"].map(|f| array(&at.file(&format!("out/final/{f}.npy"))));
    let cell = |i: usize, j: usize, k: usize| (k * 10 + j) * 20 + i;
    assert!(u[cell(19, 3, 4)] > 50.0 && u[cell(19, 9, 9)] < 5.0, "{} {}", u[cell(19, 3, 4)], u[cell(19, 9, 9)]);
    assert!(p[cell(19, 3, 4)] < 1.4e5 && p[cell(19, 3, 4)] < p[cell(17, 3, 4)], "{}", p[cell(19, 3, 4)]);
    // The same vent on another side: the same mass, to rounding; the resumed run gives the same bits.
    fs::remove_dir_all(at.file("out")).expect("removed");
    solved(&at, &case.replace("end = 0.004", "end = 0.004\nmax_steps = 7"), "out", &["-q"]);
    solved(&at, &case, "out", &["-q", "--resume"]);
    assert_eq!(json(&at.file("out/report.json"))["mass"], report["mass"]);
    let other = solve(&at, &case.replace("0.6, 0.5", "0.7, 0.5"), "out", &["-q", "--resume"]);
    assert!(stderr(&other).contains("its boundary differs"), "{}", stderr(&other));
}

/// Faces count whose middles a box holds; that their area is another one than that of the box is told, and what overpressures are counted from.
#[test]
fn a_vent_between_planes_is_told() {
    let at = Scratch::new();
    let said = |from: f64, more: &str| {
        let (low, high) = (from, from + 0.5);
        let vent = format!(
            "[[boundary.patch]]\nside = \"x_max\"\nmin = [0, {low}, {low}]\nmax = [2, {high}, {high}]\ntype = \"outlet\"\np = 1e5\n\
             [time]\nmax_steps = 1\n[output]\n{more}\n"
        );
        stderr(&solved(&at, &chamber(&vent, "rho = 1.2, p = 1e5", ""), "out", &["--force"]))
    };
    let told = said(0.25, "");
    assert!(told.contains("boundary.patch[0]") && told.contains("0.36 m²") && told.contains("0.25 m²"), "{told}");
    assert!(!said(0.2, "").contains("m² of the side"));
    let low = |more: &str| {
        let case = chamber(
            "",
            "rho = 1.2, p = 1e5 }\nregions = [{ max = [1], p = 5e4 }]\n#",
            "[time]\nmax_steps = 1\n[output]\n",
        );
        stderr(&solved(&at, &format!("{case}{more}"), "out", &["--force"]))
    };
    assert!(low("maxima = {}").contains("counted from 50000 Pa"), "{}", low("maxima = {}"));
    assert!(!low("maxima = {}\nambient = 1e5").contains("counted from") && !low("").contains("counted from"));
}

/// Gas is blown through a nozzle in one wall and leaves through an opening in the opposite one: in the end as much as the nozzle gives.
#[test]
fn a_nozzle_blows_what_it_should() {
    let at = Scratch::new();
    let patches = "[[boundary.patch]]\nside = \"x_min\"\nmin = [-9, 0.3, 0.3]\nmax = [9, 0.7, 0.7]\ntype = \"inlet\"\nrho = 1.2\nu = 20\n\
                   [[boundary.patch]]\nside = \"x_max\"\nmax = [9, 0.5, 1]\ntype = \"outlet\"\np = 1e5\n";
    solved(&at, &chamber(patches, "rho = 1.2, p = 1e5", "[time]\nend = 0.15\n"), "out", &["-q"]);
    let [rho, u] = ["rho", "u"].map(|f| array(&at.file(&format!("out/final/{f}.npy"))));
    let nozzle: Vec<usize> = (3..7).flat_map(|k| (3..7).map(move |j| (k * 10 + j) * 20)).collect();
    let mean = nozzle.iter().map(|&c| u[c]).sum::<f64>() / 16.0;
    assert!((mean / 20.0 - 1.0).abs() < 0.05, "{mean} m/s");
    let wall = (0..10).map(|j| u[j * 20].abs()).fold(0.0, f64::max);
    assert!(wall < 10.0, "{wall} m/s beside the wall");
    assert!(rho.iter().all(|r| (r / 1.2 - 1.0).abs() < 0.1));
}

#[test]
fn patches_that_cannot_be_are_told() {
    let says = |patch: &str, words: &str| {
        let at = Scratch::new();
        let patch = format!("[[boundary.patch]]\n{patch}\n");
        let output = solve(&at, &chamber(&patch, "rho = 1.2, p = 1e5", "[time]\nmax_steps = 1\n"), "out", &[]);
        assert!(stderr(&output).contains(words), "{patch}: {}", stderr(&output));
        let report = fs::read_to_string(at.file("out/report.json")).unwrap_or_default();
        assert!(!report.contains("\"area\": -0"), "{patch}: {report}");
        output.status.code()
    };
    assert_eq!(says("type = \"wall\"", "boundary.patch[0]: needs a side: x_min, x_max"), Some(1));
    assert_eq!(says("side = \"x_mid\"\ntype = \"wall\"", "x_mid"), Some(1));
    assert_eq!(says("side = \"x_min\"", "boundary.patch[0]: needs a type"), Some(1));
    assert_eq!(says("side = \"x_min\"\ntype = \"outlet\"", "an outlet needs p"), Some(1));
    assert_eq!(says("side = \"x_min\"\ntype = \"wall\"\np = 1", "is not a key of this type (wall)"), Some(1));
    assert_eq!(
        says("side = \"x_min\"\ntype = \"wall\"\nradius = 1", "boundary.patch[0].radius: is not known here"),
        Some(1)
    );
    assert_eq!(says("side = \"x_min\"\ntype = \"periodic\"", "a part of a side cannot be periodic"), Some(1));
    let nothing = "side = \"x_min\"\ntype = \"zero-gradient\"\nmin = [0, 3, 0]";
    assert_eq!(
        says(nothing, "key boundary.patch[0]: covers the middle of no face of its side: it has no effect"),
        Some(0)
    );
    let twice = "side = \"x_min\"\ntype = \"zero-gradient\"\n[[boundary.patch]]\nside = \"x_min\"\ntype = \"wall\"";
    assert_eq!(
        says(twice, "key boundary.patch[0]: covers the middle of no face of its side, or later patches"),
        Some(0)
    );
}

/// Two numbers are x and y, also for a patch on a side across x: that is told.
#[test]
fn a_box_of_two_numbers_is_told() {
    let at = Scratch::new();
    let patch = |min: &str, max: &str| {
        let vent =
            format!("[[boundary.patch]]\nside = \"x_max\"\nmin = {min}\nmax = {max}\ntype = \"outlet\"\np = 1e5\n");
        stderr(&solved(&at, &chamber(&vent, "rho = 1.2, p = 1e5", "[time]\nmax_steps = 1\n"), "out", &["--force"]))
    };
    let told = patch("[0.2, 0.2]", "[9, 0.8]");
    assert!(told.contains("boundary.patch[0]: its box has numbers along x and y alone: along z it reaches"), "{told}");
    let silent = patch("[0, 0.2, 0.2]", "[9, 0.8, 0.8]");
    assert!(!silent.contains("its box has numbers"), "{silent}");
}

/// On half the cells a vent may have another area: then that is told beside the comparison.
#[test]
fn a_vent_that_differs_on_half_the_cells_is_told() {
    let at = Scratch::new();
    let case = |from: f64, to: f64| {
        let sides = ["x_min", "x_max", "y_min", "y_max"].map(|side| format!("{side} = \"wall\"\n")).concat();
        format!(
            "[grid]\nx = {{ points = [0, 1], cells = [20] }}\ny = {{ points = [0, 1], cells = [20] }}\n[gas]\nmodel = \"ideal\"\ngamma = 1.4\n[initial]\n\
             uniform = {{ rho = 1.2, p = 1.2e5 }}\n[boundary]\n{sides}[[boundary.patch]]\nside = \"x_max\"\nmin = [0, {from}]\nmax = [1, {to}]\n\
             type = \"outlet\"\np = 1e5\n[time]\nmax_steps = 2\n[output]\nformats = []\n"
        )
    };
    let told = stderr(&solved(&at, &case(0.45, 0.55), "other", &["--refine-check"]));
    assert!(
        told.contains("boundary.patch[0]: has 0.1 m² on the cells of the case and 0.2 m² on half of them"),
        "{told}"
    );
    let patch = &json(&at.file("other/report.json"))["refine_check"]["patches"][0];
    assert!((patch["coarse"].as_f64().expect("an area") - 0.2).abs() < 1e-12, "{patch}");
    let silent = stderr(&solved(&at, &case(0.4, 0.6), "same", &["--refine-check"]));
    assert!(!silent.contains("on half of them"), "{silent}");
}

/// An inlet that gives no pressure starts from that of the gas beside it, not from that of the whole side.
#[test]
fn an_inlet_starts_from_the_gas_beside_it() {
    let at = Scratch::new();
    let inlet = "[[boundary.patch]]\nside = \"x_min\"\nmin = [0, 0, 0]\nmax = [2, 0.4, 1]\ntype = \"inlet\"\nu = 5\nrho = 1.2\n\
                 [time]\nmax_steps = 1\n[output]\nmonitors = [{ name = \"M\", x = 0, max = [9, 0.4] }]\n";
    let case = chamber(inlet, "rho = 1.2, p = 1e5 }\nregions = [{ min = [0, 0.5], p = 8e5 }]\n#", "");
    solved(&at, &case, "out", &["-q"]);
    let text = fs::read_to_string(at.file("out/monitors.csv")).expect("a table");
    let mass: f64 = text.lines().last().and_then(|l| l.split(',').nth(2)?.parse().ok()).expect("a number");
    // 1.2 kg/m³ at 5 m/s through 0.4 m²; gas at rest lets in half of that at first.
    assert!((1.1..2.5).contains(&mass), "{mass}");
}

/// An inlet that nothing is left of stays as it is, and is told.
#[test]
fn an_inlet_without_open_faces_is_told() {
    let at = Scratch::new();
    let wall = "[[boundary.patch]]\nside = \"x_min\"\nmin = [0, 0, 0]\nmax = [2, 1, 1]\ntype = \"wall\"\n[time]\nmax_steps = 40\n";
    let case = chamber(wall, "rho = 1.2, p = 1e5", "[output]\nformats = []\n");
    let case = case.replace("x_min = \"wall\"", "x_min = { type = \"inlet\", u = 5, rho = 1.2, relax = 1e-6 }");
    let text = stderr(&solved(&at, &case, "out", &[]));
    assert!(text.contains("key boundary.x_min: solids or patches cover all of this inlet: nothing enters"), "{text}");
    let p = array(&at.file("out/final/p.npy"));
    assert!(p.iter().all(|p| (p - 1e5).abs() < 1e-6));
}

/// An upright patch with one pressure under gravity is told, as a whole side is.
#[test]
fn level_pressures_of_patches_are_told() {
    let at = Scratch::new();
    let vent = "[[boundary.patch]]\nside = \"x_max\"\nmin = [0, 0, 0]\nmax = [2, 1, 1]\ntype = \"outlet\"\np = 1e5\n\
                [gravity]\ng = [0, 0, -9.81]\n[time]\nmax_steps = 1\n";
    let text = stderr(&solved(&at, &chamber(vent, "rho = 1.2, p = 1e5", ""), "out", &[]));
    assert!(text.contains("key boundary.patch[0]: has one pressure at all heights"), "{text}");
}

/// Sides of an axis of one cell are sides like any other: a type, and its keys alone.
#[test]
fn sides_of_an_axis_of_one_cell_are_checked() {
    let at = Scratch::new();
    let said = |side: &str| {
        let case = chamber("[time]\nmax_steps = 1\n", "rho = 1.2, p = 1e5", "")
            .replace("z = { points = [0, 1], cells = [10] }", "z = { points = [0, 1], cells = [1] }")
            .replace("z_min = \"wall\"", side);
        stderr(&solve(&at, &case, "out", &["-q", "--force"]))
    };
    assert!(
        said("z_min = { p = 3e5 }").contains("key boundary.z_min: needs a type"),
        "{}",
        said("z_min = { p = 3e5 }")
    );
    let wall = said("z_min = { type = \"wall\", T = 3 }");
    assert!(wall.contains("key boundary.z_min.T: is not a key of this type (wall)"), "{wall}");
    assert_eq!(said("z_min = \"wall\""), "");
}
