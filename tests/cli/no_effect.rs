//! What a case asks for in solids changes nothing, and is told.

use crate::kit::{Scratch, array, json, solve, solved, stderr, voidage};
use std::fs;

/// A box from 0.2 to 0.6 on a grid of 10 x 10 cells, with a key of `[initial]`, sides and more.
fn case(region: &str, patch: &str, output: &str) -> String {
    format!(
        "[grid]\nx = {{ points = [0, 1], cells = [10] }}\ny = {{ points = [0, 1], cells = [10] }}\n[porosity]\nscene = \"box.toml\"\n\
         [gas]\nmodel = \"ideal\"\ngamma = 1.4\n[initial]\nuniform = {{ rho = 1, p = 1 }}\nregions = [{region}]\n\
         [boundary]\nx_min = \"wall\"\nx_max = \"wall\"\ny_min = \"wall\"\ny_max = \"wall\"\n{patch}[time]\nmax_steps = 2\n[output]\n{output}\n"
    )
}

const BOX: &str = "[[solid]]\nshape = \"box\"\nmin = [0, 0.2, -1]\nmax = [0.6, 0.6, 2]\n";

#[test]
fn regions_in_solids_are_named() {
    for (region, words) in [
        (
            "{ min = [0.3, 0.3], max = [0.5, 0.5], p = 2 }",
            Some("key initial.regions[0]: lies wholly in solid: it has no effect"),
        ),
        (
            "{ center = [0.4, 0.4], radius = 0.03, p = 2 }",
            Some("key initial.regions[0]: lies wholly in solid: it has no effect"),
        ),
        (
            "{ min = [0.4, 0.3], max = [0.7, 0.5], p = 2 }",
            Some("key initial.regions[0]: is 33.33 % open, the rest is solid"),
        ),
        ("{ min = [0.7, 0.3], max = [0.9, 0.5], p = 2 }", None),
    ] {
        let at = Scratch::new();
        fs::write(at.file("box.toml"), BOX).expect("a file");
        let text = stderr(&solved(&at, &case(region, "", ""), "out", &[]));
        match words {
            Some(words) => assert!(
                text.contains(&format!("case.toml: line 11, column 12: {words}"))
                    && !text.contains("smaller than a cell"),
                "{region}: {text}"
            ),
            None => assert!(!text.contains("regions"), "{region}: {text}"),
        }
        let report = json(&at.file("out/report.json"));
        let [volume, open] = ["volume", "open_volume"].map(|key| report["regions"][0][key].as_f64().expect("a number"));
        let share = match words {
            None => 1.0,
            Some(words) if words.contains("33.33") => 1.0 / 3.0,
            Some(_) => 0.0,
        };
        assert!((open - share * volume).abs() <= 1e-12 && volume > 0.0, "{region}: {open} of {volume}");
    }
}

#[test]
fn patches_behind_solids_are_named() {
    let at = Scratch::new();
    fs::write(at.file("box.toml"), BOX).expect("a file");
    let patch = "[[boundary.patch]]\nside = \"x_min\"\nmin = [0, 0.3]\nmax = [0, 0.5]\ntype = \"outlet\"\np = 1\n";
    let text = stderr(&solved(&at, &case("", patch, ""), "out", &[]));
    assert!(text.contains("key boundary.patch[0]: covers faces that solids close: it has no effect"), "{text}");
}

#[test]
fn probes_in_solids_have_no_values() {
    let at = Scratch::new();
    fs::write(at.file("box.toml"), BOX).expect("a file");
    let output =
        "maxima = {}\nprobes = [{ name = \"in\", at = [0.45, 0.45, 0] }, { name = \"beside\", at = [0.85, 0.85, 0] }]";
    let text = stderr(&solved(&at, &case("", "", output), "out", &[]));
    let words = "key output.probes[0].at: the cell of the point [0.45, 0.45, 0.0] of \"in\" is solid: it has no values";
    assert!(text.contains(words) && !text.contains("of \"beside\""), "{text}");
    let report = json(&at.file("out/report.json"));
    let probes = &report["maxima"]["probes"];
    assert!(probes[0]["overpressure"].is_null() && probes[1]["overpressure"].is_number(), "{probes}");
    let table = fs::read_to_string(at.file("out/probes.csv")).expect("a table");
    let last = table.lines().last().expect("a line");
    assert!(last.contains(",,,,,,1,"), "{last}");
    assert_eq!(last.split(',').count(), table.lines().next().expect("a head").split(',').count());
}

/// Keys about what a case does not have: treatments of porosity, drag along an axis of one cell, pictures.
#[test]
fn keys_of_what_is_not_there_are_named() {
    let at = Scratch::new();
    fs::write(at.file("box.toml"), BOX).expect("a file");
    let whole = case("", "", "");
    for (porosity, words) in [
        ("jump = 0.5", "key porosity.jump: goes with porosity.scene or porosity.from: without them all is open"),
        ("merge = false", "key porosity.merge: goes with porosity.scene or porosity.from"),
        ("scene = \"box.toml\"\n[drag]\ncr = [0, 0, 5]", "key drag.cr: acts only along z, which has one cell"),
        ("scene = \"box.toml\"\n[drag]\nlinear = [0, 0, 5]", "key drag.linear: acts only along z, which has one cell"),
    ] {
        let text = stderr(&solve(&at, &whole.replace("scene = \"box.toml\"", porosity), "out", &[]));
        assert!(text.contains(words), "{text}");
    }
    let drawn = stderr(&solved(&at, &case("", "", "slice = [0.5, 0.5]\nformats = [\"png\"]"), "out", &["--force"]));
    assert!(!drawn.contains("pictures"), "{drawn}");
    let text = stderr(&solved(&at, &case("", "", "range = { speed = [0, 9] }"), "out", &["--force"]));
    assert!(text.contains("key output.range: is of pictures: formats has no png"), "{text}");
}

#[test]
fn ends_of_a_box_in_the_wrong_order_are_refused() {
    let at = Scratch::new();
    fs::write(at.file("box.toml"), BOX).expect("a file");
    let text = stderr(&solve(&at, &case("{ min = [0.5, 0.5], max = [0.2, 0.6], p = 2 }", "", ""), "out", &[]));
    assert!(
        text.contains("key initial.regions[0].max: must not lie below min: along x it is 0.2, and min is 0.5"),
        "{text}"
    );
}

/// What solids resist by themselves is in fields only with a law; where no fields are asked for, nothing is missing.
#[test]
fn fields_without_the_drag_of_solids_say_so() {
    let at = Scratch::new();
    let solid =
        |x: u32, keys: &str| format!("[[solid]]\nshape = \"box\"\nmin = [{x}, 0, 0]\nmax = [{x}.5, 1, 1]\n{keys}\n");
    let scene = at.file("scene.toml");
    let run = |keys: [&str; 3], more: &[&str]| {
        let solids: String = keys.iter().zip(0..).map(|(keys, x)| solid(x, keys)).collect();
        fs::write(&scene, solids).expect("a scene");
        let mut all: Vec<&dyn AsRef<std::ffi::OsStr>> = vec![&"porosity", &scene, &"--cells", &"4x4x4"];
        all.extend(more.iter().map(|m| m as &dyn AsRef<std::ffi::OsStr>));
        let output = voidage(&all);
        assert!(output.status.success(), "{}", stderr(&output));
        stderr(&output)
    };
    let (npy, report) = (at.file("npy").display().to_string(), at.file("r.json").display().to_string());
    let vtr = at.file("f.vtr").display().to_string();
    let grating = "porosity = 0.5\ncr = 4";
    let cr = [grating, "", grating];
    for (keys, more, words) in [
        (cr, ["--npy", &npy], "scene.toml: cr of 2 solids are written only with --drag LAW"),
        ([grating, "cd = 1", ""], ["-o", &vtr], "scene.toml: cr and cd of 2 solids are written only with --drag LAW"),
        (["", "cd = 1", ""], ["--npy", &npy], "scene.toml: cd of 1 solid is written only with --drag LAW"),
    ] {
        let said = run(keys, &more);
        assert_eq!(said.matches(words).count(), 1, "{said}");
    }
    for (keys, more) in [
        (cr, &["--report", &report][..]),
        (cr, &["--npy", &npy, "--drag", "bluff", "--cd", "0"]),
        (cr, &["--npy", &npy, "--no-areas"]),
        (["", "", ""], &["--npy", &npy]),
    ] {
        let said = run(keys, more);
        assert!(!said.contains("only with --drag"), "{more:?}: {said}");
    }
}

/// Sides that solids close, frames of no format, an `initial.uniform` that is no rest under gravity.
#[test]
fn what_a_case_asks_for_in_vain_is_told() {
    let told = |side: &str, output: &str, gravity: &str| {
        let at = Scratch::new();
        fs::write(at.file("box.toml"), BOX.replace("0.2", "-1").replace("0.6, 0.6", "0.6, 2")).expect("a file");
        let text = case("", gravity, output).replace("x_min = \"wall\"", &format!("x_min = {side}"));
        (stderr(&solved(&at, &text, "out", &[])), at)
    };
    let closed = "key boundary.x_min: solids close all faces of this side: no gas passes it";
    let (text, at) = told("{ type = \"outlet\", p = 1 }", "", "");
    assert!(text.contains(closed), "{text}");
    let (text, _) = told("\"wall\"", "formats = []\nevery = 0.01", "[gravity]\ng = [0, -9.81, 0]\n");
    assert!(!text.contains(closed), "{text}");
    assert!(text.contains("key output.every: is of frames: formats is empty, and none is written"), "{text}");
    let words = "key initial.uniform: the state is the same at all heights, which is no rest under gravity: the gas begins to swing, as from one end \
                 to the other of the domain its weight makes 9.81 Pa for each kg/m³";
    assert!(text.contains(words), "{text}");
    // Where there is no gas the arrays say so.
    let open = array(&at.file("out/final/beta_v.npy"));
    assert_eq!(open.iter().filter(|open| **open == 0.0).count(), 60);
}

/// Arrays whose solid cells have open faces, and arrays of resistance that nothing takes.
#[test]
fn arrays_that_contradict_each_other_are_told() {
    let at = Scratch::new();
    fs::write(at.file("box.toml"), BOX.replace("[0, 0.2, -1]", "[0.2, 0.2, -1]")).expect("a file");
    let grid = "{\"x\": [0, 0.2, 0.4, 0.6, 0.8, 1], \"y\": [0, 0.2, 0.4, 0.6, 0.8, 1], \"z\": [0, 1]}";
    fs::write(at.file("grid.json"), grid).expect("a file");
    let (scene, grid, fields) = (at.file("box.toml"), at.file("grid.json"), at.file("fields"));
    let made = voidage(&[&"porosity", &scene, &"--grid", &grid, &"--npy", &fields]);
    assert!(made.status.success(), "{}", stderr(&made));
    let text =
        case("", "", "").replace("scene = \"box.toml\"", "from = \"fields\"").replace("cells = [10]", "cells = [5]");
    let said = |what: &str| stderr(&solved(&at, &text, what, &[]));
    let quiet = said("one");
    assert!(!quiet.contains("open faces") && !quiet.contains("cr_x.npy"), "{quiet}");
    let (_, mut x) = voidage::files::npy::read(&fields.join("beta_x.npy")).expect("an array");
    let closed = x.iter().position(|open| *open == 0.0).expect("a closed face");
    x[closed] = 1.0;
    voidage::files::npy::write(&fields.join("beta_x.npy"), [6, 5, 1], &x).expect("an array");
    let mut resistance = vec![0.0; 25];
    resistance[24] = 3.0;
    voidage::files::npy::write(&fields.join("cr_x.npy"), [5, 5, 1], &resistance).expect("an array");
    let text = said("two");
    let words = "key porosity.from: 1 cell is solid but has open faces, the first at [1, 1, 0]: gas passes there";
    assert!(text.contains(words), "{text}");
    assert!(
        text.contains("key porosity.from: cr_x.npy lies there, too, and exerts no force: [drag] from takes it"),
        "{text}"
    );
}

/// A grid in millimetres around a scene in metres; a unit that a grid has not; a file given twice.
#[test]
fn units_of_grids_and_files_given_twice() {
    let at = Scratch::new();
    let more = "[[solid]]\nshape = \"sphere\"\ncenter = [2, 2, 2]\nradius = 1\n";
    fs::write(at.file("box.toml"), format!("{BOX}{more}")).expect("a file");
    let grid = "origin = [-500, -500, -500]\nspacing = 1000\ncells = [4, 4, 4]\n";
    let said = |grid: &str| {
        fs::write(at.file("grid.toml"), grid).expect("a file");
        voidage(&[&"porosity", &at.file("box.toml"), &at.file("box.toml"), &"--grid", &at.file("grid.toml")])
    };
    let output = said(grid);
    let text = stderr(&output);
    assert!(output.status.success() && text.contains("box.toml: is given twice: once would do"), "{text}");
    assert!(
        text.contains("all of the geometry, 3 × 2.8 × 4 m, lies within one cell of 1000 × 1000 × 1000 m"),
        "{text}"
    );
    let refused = said(&format!("unit = \"mm\"\n{grid}"));
    assert_eq!(refused.status.code(), Some(1));
    assert!(stderr(&refused).contains("line 1, column 1: key unit is not known here: a grid is in metres"));
}

/// Faces lowered to a throat are known less well than all else where solids are round; a study of an empty grid says nothing of what to choose.
#[test]
fn less_than_the_tolerance_and_nothing_at_all_are_told() {
    let at = Scratch::new();
    let bars = "[[solid]]\nshape = \"sphere\"\ncenter = [0.53, 0.51, 0.47]\nradius = 0.21\n";
    fs::write(at.file("ball.toml"), bars).expect("a file");
    let of = |faces: &str| {
        let bounds = "0,0,0,1,1,1";
        stderr(&voidage(&[
            &"porosity",
            &at.file("ball.toml"),
            &"--cells",
            &"3x3x3",
            &"--bounds",
            &bounds,
            &"--faces",
            &faces,
        ]))
    };
    assert!(of("throat").contains("--faces throat: the bounds of some lowered faces are"), "{}", of("throat"));
    assert!(!of("plane").contains("apart"), "{}", of("plane"));
    let study = "[[scene]]\nname = \"ball\"\nfiles = [\"ball.toml\"]\n[[grid]]\norigin = [5, 5, 5]\nspacing = 0.1\ncells = [2, 2, 2]\n\
                 [[method]]\nname = \"exact\"\n";
    fs::write(at.file("study.toml"), study).expect("a file");
    let output = voidage(&[&"study", &at.file("study.toml"), &"-o", &at.file("out")]);
    assert!(output.status.success() && stderr(&output).contains("lies outside the grid"), "{}", stderr(&output));
    let page = fs::read_to_string(at.file("out/study.md")).expect("a page");
    assert!(page.contains("no solid lies in the grid") && !page.contains("no reason to choose"), "{page}");
}
