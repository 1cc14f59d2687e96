//! Where results go: not over what they are made of, nor where another run writes.

use crate::kit::{Scratch, fixture, program, solve, solved, stderr, voidage};
use std::fs;
use std::process::Command;
use std::time::{Duration, Instant};

#[test]
fn a_report_does_not_replace_the_scene() {
    let at = Scratch::new();
    let scene = at.file("in.json");
    fs::copy(fixture("cad_skid.stl"), &scene).expect("a copy");
    let before = fs::read(&scene).expect("a file");
    let out = voidage(&[&"inspect", &scene, &"--report", &scene]);
    assert_eq!(out.status.code(), Some(2));
    assert!(stderr(&out).contains("the report would replace a file of the scene"), "{}", stderr(&out));
    assert!(fs::read(&scene).expect("a file") == before);
}

/// Two outputs of one file are one, however its path is written, and also where nothing is there yet.
#[test]
#[cfg(unix)]
fn two_outputs_do_not_share_a_file() {
    let (at, skid) = (Scratch::new(), fixture("cad_skid.stl"));
    fs::create_dir(at.file("sub")).expect("a directory");
    for name in ["a", "b"] {
        std::os::unix::fs::symlink("behind", at.file(name)).expect("a link");
    }
    std::os::unix::fs::symlink("sub", at.file("other")).expect("a link");
    for (report, picture, is_one) in [
        ("new", "sub/../new", true),
        ("new", "absent/../new", true),
        ("sub/x", "other/./x", true),
        ("a", "b", true),
        ("sub/x", "other/y", false),
        ("sub/x", "x", false),
    ] {
        let out = voidage(&[
            &"porosity",
            &skid,
            &"--cells",
            &"4x4x4",
            &"--npy",
            &at.file("sub"),
            &"--report",
            &at.file(report),
            &"--png",
            &at.file(picture),
        ]);
        let refused = stderr(&out).contains("an output would replace another file of this run");
        assert_eq!(refused, is_one, "{report}, {picture}: {}", stderr(&out));
    }
}

const TUBE: &str = "[grid]\nx = { points = [0, 1], cells = [1000] }\n[gas]\nmodel = \"ideal\"\ngamma = 1.4\n[initial]\n\
    uniform = { rho = 1, p = 1 }\n[boundary]\nx_min = \"wall\"\nx_max = \"wall\"\n[time]\nend = 1e6\n";

#[test]
fn a_case_without_a_suffix_needs_another_directory() {
    let at = Scratch::new();
    let case = at.file("case");
    fs::write(&case, TUBE).expect("a file");
    let here = Command::new(program()).args(["solve", "case"]).current_dir(&at.0).output().expect("a run");
    let text = stderr(&here);
    assert!(text.contains("a directory of the name of the case itself: give -o DIR"), "{text}");
    for dir in [case.clone(), case.join("x"), case.join("x/y")] {
        let text = stderr(&voidage(&[&"solve", &case, &"-o", &dir]));
        assert!(text.contains("case: cannot create the directory of -o: there is a file of that name"), "{text}");
    }
    let text = stderr(&voidage(&[&"solve", &case, &"-o", &"-"]));
    assert!(text.contains("-o takes a directory, not the standard output"), "{text}");
}

#[test]
fn arrays_do_not_go_to_the_standard_output() {
    let out = voidage(&[&"porosity", &fixture("cad_skid.stl"), &"--npy", &"-"]);
    assert_eq!(out.status.code(), Some(2));
    assert!(stderr(&out).contains("--npy takes a directory"), "{}", stderr(&out));
}

#[test]
fn arrays_of_an_earlier_run_are_told() {
    let (at, skid) = (Scratch::new(), fixture("cad_skid.stl"));
    let dir = at.file("out");
    let run = |cells: &str, more: &[&str]| {
        let mut arguments: Vec<&dyn AsRef<std::ffi::OsStr>> =
            vec![&"porosity", &skid, &"--cells", &cells, &"--npy", &dir];
        more.iter().for_each(|option| arguments.push(option));
        stderr(&voidage(&arguments))
    };
    assert!(!run("4x4x4", &["--bounds-fields"]).contains("earlier run"));
    let text = run("5x5x5", &[]);
    assert!(
        text.contains("beta_v_lower.npy, beta_v_upper.npy") && text.contains("of an earlier run are still there"),
        "{text}"
    );
}

/// Arrays of the same shape on cells of another size are refused; where nothing says on which they stand, they are taken.
#[test]
fn arrays_know_their_grid() {
    let at = Scratch::new();
    let block = "[[solid]]\nshape = \"box\"\nmin = [0.42, 0, 0]\nmax = [0.58, 0.63, 1]\n";
    fs::write(at.file("block.toml"), block).expect("a scene");
    let grid = |x: &str| format!("x = {x}\ny = {{ points = [0, 1], cells = [4] }}\nz = [0, 1]\n");
    let even = grid("{ points = [0, 1], cells = [10] }");
    fs::write(at.file("grid.toml"), &even).expect("a grid");
    let measure = |grid: &str, dir: &str| {
        let scene = at.file("block.toml");
        let out =
            voidage(&[&"porosity", &scene, &"--grid", &at.file(grid), &"--drag", &"bluff", &"--npy", &at.file(dir)]);
        assert!(out.status.success(), "{}", stderr(&out));
    };
    measure("grid.toml", "fields");
    let case = |grid: &str, initial: &str, from: &str| {
        format!(
            "[grid]\n{grid}{from}[gas]\nmodel = \"ideal\"\ngamma = 1.4\n[initial]\n{initial}\n[boundary]\nx_min = \"wall\"\nx_max = \"wall\"\n\
             y_min = \"wall\"\ny_max = \"wall\"\n[time]\nmax_steps = 1\n[output]\nformats = []\n"
        )
    };
    let (uniform, last) = ("uniform = { rho = 1, p = 1 }", "from = \"first/final\"");
    let (space, drag) = ("[porosity]\nfrom = \"fields\"\n", "[drag]\nfrom = \"fields\"\n");
    solved(&at, &case(&even, uniform, space), "first", &[]);
    let edges = "[0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1]";
    let same = grid(edges);
    let twice = grid("{ points = [0, 2], cells = [10] }");
    let moved = grid(&edges.replace("0.3", "0.301"));
    for (initial, from, key, dir) in [
        (uniform, space, "porosity.from", "fields"),
        (uniform, drag, "drag.from", "fields"),
        (last, "", "initial.from", "first/final"),
    ] {
        solved(&at, &case(&same, initial, from), "again", &["--force"]);
        for (other, difference) in [
            (&twice, "cell 0 along x reaches from 0 to 0.1, and here from 0 to 0.2"),
            (&moved, "cell 2 along x reaches from 0.2 to 0.3, and here from 0.2 to 0.301"),
            (&even.replace("cells = [4]", "cells = [5]"), "4 cells along y, and here 5"),
        ] {
            let said = stderr(&solve(&at, &case(other, initial, from), "again", &["--force"]));
            let beside = format!(
                "{dir}/edges.json: the arrays beside it are of another grid: {difference}; if they are of this"
            );
            assert!(said.contains(&format!("key {key}: ")) && said.contains(&beside), "{said}");
        }
        fs::remove_file(at.file(dir).join("edges.json")).expect("it was there");
        solved(&at, &case(&twice, initial, from), "again", &["--force"]);
        measure("grid.toml", "fields");
    }
    // What overpressures are counted from is chance there.
    for (output, told) in [("maxima = {}", true), ("maxima = {}\nambient = 1", false), ("", false)] {
        let said = stderr(&solved(&at, &(case(&even, last, "") + output), "again", &["--force"]));
        assert_eq!(said.contains("the lowest pressure of initial.from"), told, "{said}");
    }
    // It is a grid file, to the last digit.
    let thirds = grid("{ points = [0, 1], cells = [3] }");
    fs::write(at.file("thirds.toml"), thirds).expect("a grid");
    measure("thirds.toml", "thirds");
    measure("thirds/edges.json", "copy");
    for name in ["beta_v.npy", "beta_x.npy", "edges.json"] {
        let [first, second] = ["thirds", "copy"].map(|dir| fs::read(at.file(dir).join(name)).expect("a file"));
        assert!(first == second, "{name}");
    }
}

/// Around round solids at the coordinates of a site a grid begins where the solids do, as it does around boxes.
#[test]
fn a_grid_around_pipes_at_a_site() {
    let at = Scratch::new();
    for shape in ["cylinder", "capsule", "cone", "sphere", "box"] {
        let keys = match shape {
            "sphere" => "center = [500002.0, 4000000.0, 0.0]\nradius = 2.0",
            "box" => "min = [500000.0, 3999998.0, -2.0]\nmax = [500004.0, 4000002.0, 2.0]",
            "capsule" => "from = [500002.0, 4000000.0, 0.0]\nto = [500002.0, 4000000.0, 0.001]\nradius = 1.9995",
            _ => "from = [500000.0, 4000000.0, 0.0]\nto = [500004.0, 4000000.0, 0.0]\nradius = 2.0",
        };
        fs::write(at.file("pipe.toml"), format!("[[solid]]\nshape = \"{shape}\"\n{keys}\n")).expect("a scene");
        let (scene, out) = (at.file("pipe.toml"), at.file("out"));
        let output = voidage(&[&"porosity", &scene, &"--spacing", &"0.5", &"--npy", &out]);
        assert!(output.status.success(), "{}", stderr(&output));
        let edges = crate::kit::json(&out.join("edges.json"));
        let begins = ["x", "y", "z"].map(|axis| edges[axis][0].as_f64().expect("a number"));
        let expected = if shape == "capsule" {
            [500_000.000_5 - 0.5, 3_999_998.000_5 - 0.5, -2.499_5]
        } else {
            [499_999.5, 3_999_997.5, -2.5]
        };
        assert!(begins.iter().zip(expected).all(|(found, truth)| (found - truth).abs() < 2e-9), "{shape}: {begins:?}");
        let counts = ["x", "y", "z"].map(|axis| edges[axis].as_array().expect("a list").len() - 1);
        assert_eq!(counts, [10; 3], "{shape}");
    }
}

/// While one run writes into a directory another is refused, and once it is gone another is not.
#[test]
fn one_run_at_a_time() {
    let at = Scratch::new();
    let (case, dir) = (at.file("case.toml"), at.file("out"));
    fs::write(&case, TUBE).expect("a file");
    let mut first = Command::new(program())
        .args([&"solve" as &dyn AsRef<std::ffi::OsStr>, &case, &"-q", &"-o", &dir].map(|a| a.as_ref().to_owned()))
        .spawn()
        .expect("a run");
    let begun = Instant::now();
    while !dir.join("log.csv").exists() {
        assert!(begun.elapsed() < Duration::from_secs(60), "the run does not begin");
        std::thread::sleep(Duration::from_millis(10));
    }
    let text = stderr(&voidage(&[&"solve", &case, &"-o", &dir, &"--force"]));
    first.kill().expect("a running program");
    first.wait().expect("an end");
    assert!(text.contains("another run writes there"), "{text}");
    fs::write(&case, TUBE.replace("end = 1e6", "max_steps = 1")).expect("a file");
    let out = voidage(&[&"solve", &case, &"-o", &dir]);
    assert!(out.status.success(), "{}", stderr(&out));
}

/// Names that no disk takes are refused before anything is read or computed.
#[cfg(unix)]
#[test]
fn names_that_are_too_long_are_refused_first() {
    let (at, skid) = (Scratch::new(), fixture("cad_skid.stl"));
    let long = "a".repeat(300);
    let name = |suffix: &str| at.file(&format!("{long}{suffix}"));
    let case = at.file("case.toml");
    fs::write(&case, TUBE.replace("end = 1e6", "max_steps = 1")).expect("a case");
    let study = at.file("study.toml");
    fs::write(&study, crate::kit::stdout(&voidage(&[&"study", &"--template"]))).expect("a study");
    let porosity =
        |option: &str, suffix: &str| voidage(&[&"porosity", &skid, &"--cells", &"4x4x4", &option, &name(suffix)]);
    for (output, bytes) in [
        (porosity("-o", ".vtr"), 304),
        (porosity("--png", ".png"), 304),
        (porosity("--report", ".json"), 305),
        (porosity("--npy", ""), 300),
        (voidage(&[&"porosity", &skid, &"--png", &name("").join("deep/p.png")]), 300),
        (voidage(&[&"inspect", &skid, &"--report", &name(".json")]), 305),
        (voidage(&[&"solve", &case, &"-o", &name("").join("deep")]), 300),
        (voidage(&[&"study", &study, &"--quick", &"-o", &name("")]), 300),
    ] {
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{said}");
        assert!(said.contains(&format!("cannot create: a name of {bytes} bytes is too long for this disk")), "{said}");
        assert!(output.stdout.is_empty(), "{}", crate::kit::stdout(&output));
    }
    assert_eq!(at.names(), ["case.toml", "study.toml"]);
}
