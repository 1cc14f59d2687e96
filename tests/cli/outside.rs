//! What lies outside the grid is said by name; what is flush with it is not outside.

use crate::kit::{Scratch, solved, stderr, voidage};
use std::fs;

const GRID: &str = "[grid]\norigin = [0, 0, 0]\nspacing = [0.1, 0.1, 0.1]\ncells = [10, 10, 10]\n";

fn said(solids: &str) -> String {
    let dir = Scratch::new();
    let scene = dir.file("scene.toml");
    fs::write(&scene, format!("{solids}{GRID}")).expect("written");
    let output = voidage(&[&"porosity", &scene, &"--tol", &"0.5", &"--depth", &"1"]);
    assert!(output.status.success(), "{}", stderr(&output));
    stderr(&output)
}

fn cylinder(name: &str, from: [f64; 3], to: [f64; 3], radius: f64) -> String {
    format!("[[solid]]\nname = \"{name}\"\nshape = \"cylinder\"\nfrom = {from:?}\nto = {to:?}\nradius = {radius}\n")
}

#[test]
fn a_solid_flush_with_the_grid_is_within() {
    for radius in [0.5, 0.3] {
        let text = said(&cylinder("pipe", [0.0, 0.5, 0.5], [1.0, 0.5, 0.5], radius));
        assert!(!text.contains("beyond the grid"), "{text}");
    }
    let ring =
        said("[[solid]]\nshape = \"torus\"\ncenter = [0.5, 0.5, 0.1]\naxis = [0, 0, 1]\nradius = 0.4\ntube = 0.1\n");
    assert!(!ring.contains("beyond the grid"), "{ring}");
    let askew = said(&cylinder("pipe", [0.0, 0.5, 0.3], [1.0, 0.5, 0.3], 0.3));
    assert!(!askew.contains("beyond the grid"), "{askew}");
    let beyond = said(&cylinder("pipe", [0.0, 0.5, 0.5], [1.0 + 1e-9, 0.5, 0.5], 0.3));
    assert!(beyond.contains("extends beyond the grid"), "{beyond}");
}

#[test]
fn solids_outside_are_named() {
    let inside = cylinder("inner", [0.2, 0.5, 0.5], [0.8, 0.5, 0.5], 0.1);
    let text = said(&(inside.clone() + &cylinder("stray", [2.0, 0.5, 0.5], [3.0, 0.5, 0.5], 0.1)));
    assert!(text.contains("solid \"stray\": outside the grid"), "{text}");
    assert!(!text.contains("inner"), "{text}");
    let many: String = (0..7).map(|n| cylinder(&format!("s{n}"), [2.0, 0.5, 0.5], [3.0, 0.5, 0.5], 0.1)).collect();
    let text = said(&(inside + &many));
    assert!(text.contains("solid \"s4\" and 2 more: outside the grid"), "{text}");
}

/// Copies of an array are counted.
#[test]
fn copies_outside_are_told() {
    let ball = "[[solid]]\nname = \"ball\"\nshape = \"sphere\"\ncenter = [0.5, 0.5, 0.5]\nradius = 0.1\n";
    let text = said(&format!("{ball}array = {{ count = [3, 1, 1], step = [0.9, 0, 0] }}\n"));
    assert!(text.contains("2 of the 3 copies of solid \"ball\": outside the grid"), "{text}");
    let text = said(&format!("{ball}array = {{ count = [3, 1, 1], step = [0.2, 0, 0] }}\n"));
    assert!(!text.contains("outside the grid"), "{text}");
    let text = said(&format!("{ball}translate = [5, 0, 0]\narray = {{ count = [2, 1, 1], step = [2, 0, 0] }}\n"));
    assert!(text.contains("outside the grid") && !text.contains("copies"), "{text}");
}

/// One cell that the user gave is not one that the case left out.
#[test]
fn axes_that_are_left_out_are_told() {
    let at = Scratch::new();
    let ball = "[[solid]]\nshape = \"sphere\"\ncenter = [0.5, 0.5, 0.5]\nradius = 2\n";
    fs::write(at.file("ball.toml"), ball).expect("written");
    let said = |grid: &str| {
        let case = format!(
            "[grid]\nx = {{ points = [-4, 4], cells = [8] }}\n{grid}[porosity]\nscene = \"ball.toml\"\n[gas]\nmodel = \"ideal\"\n\
             gamma = 1.4\n[initial]\nuniform = {{ rho = 1, p = 1 }}\n[boundary]\nx_min = \"wall\"\nx_max = \"wall\"\n\
             [time]\nmax_steps = 1\n"
        );
        stderr(&solved(&at, &case, "out", &["--force"]))
    };
    assert!(said("").contains("(one cell along y, z, which the case leaves out)"), "{}", said(""));
    assert!(said("y = [0, 1]\n").contains("(one cell along z, which the case leaves out)"));
    let text = said("y = [0, 1]\nz = [0, 1]\n");
    assert!(text.contains("extends beyond the grid") && !text.contains("leaves out"), "{text}");
}

#[test]
fn regions_outside_are_named() {
    let case = |region: &str| {
        format!(
            "[grid]\nx = {{ points = [0, 1], cells = [10] }}\n[gas]\nmodel = \"ideal\"\ngamma = 1.4\n\
             [initial]\nuniform = {{ rho = 1, p = 1 }}\nregions = [{region}]\n\
             [boundary]\nx_min = {{ type = \"wall\" }}\nx_max = {{ type = \"wall\" }}\n[time]\nmax_steps = 1\n"
        )
    };
    for (region, words) in [
        ("{ min = [1.5], rho = 2, p = 1 }", Some("key initial.regions[0]: lies outside the grid")),
        ("{ center = [-1.0], radius = 0.5, rho = 2, p = 1 }", Some("key initial.regions[0]: lies outside the grid")),
        ("{ min = [0.51], max = [0.54], rho = 2, p = 1 }", Some("key initial.regions[0]: is smaller than a cell")),
        ("{ min = [0.5], rho = 2, p = 1 }", None),
    ] {
        let at = Scratch::new();
        let text = stderr(&solved(&at, &case(region), "out", &[]));
        match words {
            Some(words) => assert!(text.contains(words), "{region}: {text}"),
            None => assert!(!text.contains("regions"), "{region}: {text}"),
        }
    }
}

/// Files that lie outside the grid are named beside scenes.
#[test]
fn files_outside_the_grid_are_named_beside_scenes() {
    let at = Scratch::new();
    let cube = "[[solid]]\nname = \"box\"\nshape = \"box\"\nmin = [0, 0, 0]\nmax = [0.5, 0.5, 0.5]\n";
    let scene = at.write("scene.toml", [cube, GRID].concat().as_bytes());
    let far = "v 9 9 9\nv 10 9 9\nv 9 10 9\nv 9 9 10\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
    let far = at.write("far.obj", far.as_bytes());
    let said = stderr(&voidage(&[&"porosity", &scene, &far]));
    assert!(said.contains("far.obj: outside the grid"), "{said}");
    let file = "[[solid]]\nname = \"moved\"\nshape = \"file\"\npath = \"far.obj\"\ntranslate = [-8.9, -8.9, -8.9]\n";
    let moved = at.write("moved.toml", [GRID, file].concat().as_bytes());
    let said = stderr(&voidage(&[&"porosity", &moved]));
    assert!(!said.contains("outside the grid"), "{said}");
}
