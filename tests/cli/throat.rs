//! `--faces throat` of solids that are porous themselves: a thin grating is one wherever it lies.

use crate::kit::{Scratch, array, json, solved, stderr, voidage};
use std::ffi::OsStr;
use std::fs;

fn panel(name: &str, x: [f64; 2], y: [f64; 2], porosity: f64) -> String {
    format!(
        "[[solid]]\nname = \"{name}\"\nshape = \"box\"\nmin = [{}, {}, 0]\nmax = [{}, {}, 1]\nporosity = {porosity}\n",
        x[0], y[0], x[1], y[1]
    )
}

/// Open fractions of the x faces of 5 × 4 × 4 cells of 0.2 × 0.25 × 0.25 m.
fn faces(at: &Scratch, scene: &str) -> Vec<f64> {
    fs::write(at.file("scene.toml"), scene).expect("written");
    let (scene, out) = (at.file("scene.toml"), at.file("out"));
    let mut given: Vec<&dyn AsRef<OsStr>> = vec![&"porosity", &scene, &"--npy", &out];
    for word in &["--cells", "5x4x4", "--bounds", "0,0,0,1,1,1", "--faces", "throat", "-q"] {
        given.push(word);
    }
    let output = voidage(&given);
    assert!(output.status.success(), "{}", stderr(&output));
    array(&at.file("out/beta_x.npy"))
}

#[test]
fn gratings_between_planes() {
    let at = Scratch::new();
    for porosity in [0.0, 0.001, 0.1, 0.5, 0.999] {
        // Nearer to the plane below, then to the one above.
        for (x, lowered) in [([0.22, 0.28], 1), ([0.31, 0.39], 2)] {
            let beta = faces(&at, &panel("grating", x, [0.0, 1.0], porosity));
            for (n, open) in beta.iter().enumerate() {
                let expected = if n % 6 == lowered { porosity } else { 1.0 };
                assert!((open - expected).abs() < 1e-12, "{porosity} {x:?}: face {n} is {open}, not {expected}");
            }
        }
    }
}

/// A wall before half of a grating, both in one row of cells: where both are, the wall's face is closed; a hole in the grating is open.
#[test]
fn a_wall_and_a_grating_in_one_cell() {
    let at = Scratch::new();
    let scene = panel("grating", [0.22, 0.24], [0.0, 0.875], 0.4) + &panel("wall", [0.36, 0.38], [0.0, 0.5], 0.0);
    let beta = faces(&at, &scene);
    let face = |i: usize, j: usize| beta[j * 6 + i];
    for j in 0..2 {
        assert_eq!(face(1, j).min(face(2, j)), 0.0, "row {j}");
    }
    // The grating alone, whole, and over half of the face.
    for (j, expected) in [(2, 0.4), (3, 0.7)] {
        assert!((face(1, j) - expected).abs() < 1e-12 && face(2, j) == 1.0, "row {j}: {} {}", face(1, j), face(2, j));
    }
}

/// A blast behind a thin grating does not ask where between two planes the grating stands.
#[test]
fn a_blast_behind_a_grating() {
    let at = Scratch::new();
    let behind = |x: f64, porosity: f64| {
        let scene = panel("grating", [x, x + 0.1], [0.0, 1.0], porosity);
        fs::write(at.file("scene.toml"), scene).expect("written");
        let case = "[grid]\nx = { points = [0, 6], cells = [30] }\ny = { points = [0, 1], cells = [4] }\nz = { points = [0, 1], cells = [4] }\n\
             [porosity]\nscene = \"scene.toml\"\n[gas]\nmodel = \"ideal\"\ngamma = 1.4\n\
             [initial]\nuniform = { rho = 1.2, p = 1e5 }\nregions = [{ min = [0, 0, 0], max = [1, 1, 1], p = 4e5 }]\n\
             [boundary]\nx_min = \"wall\"\nx_max = \"wall\"\ny_min = \"wall\"\ny_max = \"wall\"\nz_min = \"wall\"\nz_max = \"wall\"\n\
             [time]\nend = 0.012\n[output]\nformats = []\nforces = [\"grating\"]\nambient = 1e5\nmaxima = {}\n\
             probes = [{ name = \"behind\", at = [5.1, 0.5, 0.5] }]\n";
        solved(&at, case, &format!("{x}-{porosity}"), &["-q"]);
        let report = json(&at.file(&format!("{x}-{porosity}/report.json")));
        report["maxima"]["probes"][0]["overpressure"].as_f64().expect("a number")
    };
    let (in_plane, between, open) = (behind(4.0, 0.1), behind(4.05, 0.1), behind(4.0, 1.0));
    assert!((between / in_plane - 1.0).abs() < 0.05, "{in_plane} {between}");
    assert!(in_plane < 0.5 * open, "{in_plane} {open}");
    // Nearly a wall is no open space.
    assert!(behind(4.05, 0.001) < 0.1 * open);
}

/// A room with walls of a fifth of a cell, turned by 20°, keeps its gas: no wave comes out of it.
#[test]
fn a_turned_room_keeps_its_gas() {
    let at = Scratch::new();
    let (sin, cos) = f64::to_radians(20.0).sin_cos();
    // Half of the sides of a wall and its middle, from that of the room.
    let wall = |[a, b]: [f64; 2], [x, y]: [f64; 2]| {
        let (x, y) = (2.0 + cos * x - sin * y, 2.0 + sin * x + cos * y);
        format!(
            "[[solid]]\nshape = \"box\"\nmin = [{}, {}, -1]\nmax = [{}, {}, 2]\nrotate = {{ axis = [0, 0, 1], angle = 20 }}\n",
            x - a,
            y - b,
            x + a,
            y + b
        )
    };
    let along = [-0.9, 0.9].map(|x| wall([0.01, 0.91], [x, 0.0]) + &wall([0.91, 0.01], [0.0, x]));
    fs::write(at.file("scene.toml"), along.concat()).expect("written");
    let case = "[grid]\nx = { points = [0, 4], cells = [40] }\ny = { points = [0, 4], cells = [40] }\n[porosity]\nscene = \"scene.toml\"\n\
         [gas]\nmodel = \"ideal\"\ngamma = 1.4\n[initial]\nuniform = { rho = 1.2, p = 1e5 }\n\
         regions = [{ center = [2, 2], radius = 0.7, p = 3e5, rho = 3.6 }]\n[drag]\nlaw = \"none\"\n\
         [boundary]\nx_min = \"wall\"\nx_max = \"wall\"\ny_min = \"wall\"\ny_max = \"wall\"\n[time]\nend = 0.02\n[output]\nformats = []\nambient = 1e5\nmaxima = {}\n\
         probes = [{ name = \"inside\", at = [2, 2] }, { name = \"outside\", at = [0.5, 2] }, { name = \"corner\", at = [2.3, 3.6] }]\n";
    solved(&at, case, "run", &["-q"]);
    let report = json(&at.file("run/report.json"));
    let highest = |n: usize| report["maxima"]["probes"][n]["overpressure"].as_f64().expect("a number");
    assert!(highest(0) > 1e5, "{}", highest(0));
    for n in [1, 2] {
        assert!(highest(n) < 1e-6, "{n}: {}", highest(n));
    }
}
