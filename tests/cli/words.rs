//! What the command says: places of what is wrong, numbers with their nouns, digits that are known, what an interrupt leaves.

use crate::kit::{Scratch, program, solve, solved, stderr, stdout, voidage};
use std::fs;
use std::process::{Command, Output, Stdio};
use std::sync::mpsc::channel;
use std::time::Duration;
use voidage::command::cli::TalkArgs;
use voidage::command::progress::{Heartbeat, Progress};
use voidage::picture::ticks::part;

/// `voidage porosity` of a ball with more arguments.
fn ball(at: &Scratch, arguments: &[&str]) -> Output {
    let scene = at.file("ball.toml");
    fs::write(&scene, "[[solid]]\nshape = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\n").expect("a scene");
    let mut command = Command::new(program());
    command.arg("porosity").arg(scene).args(arguments).output().expect("the program runs")
}

#[test]
fn grids_in_json_have_lines() {
    let at = Scratch::new();
    let grid = at.file("grid.json");
    let said = |text: &str| {
        fs::write(&grid, text).expect("a grid");
        stderr(&ball(&at, &["--grid", grid.to_str().expect("a path")]))
    };
    let begin = "{\n  \"x\": [-2, 2],\n  \"y\": [-2, 2],\n";
    for (rest, place) in [
        ("  \"z\": [-2, 2],\n  \"y\": [0, 1]\n}", "grid.json: line 5, column 3: key y is given twice in this table"),
        (
            "  \"z\": {\"points\": [0, 1], \"cells\": [2], \"points\": [0]}\n}",
            "grid.json: line 4, column 41: key points is given twice in this table",
        ),
        ("  \"z\": [-2, \"ä\"]\n}", "grid.json: line 4, column 13: key z[1]: takes a number, not a text"),
        ("  \"z\": [2, -2]\n}", "grid.json: line 4, column 12: key z[1]: edge -2 does not lie above"),
        (
            "  \"z\": [-2, 2]\n  \"w\": 3\n}",
            "grid.json: line 5, column 3: this is no JSON: a comma is missing here, or the `}` of the table before\n",
        ),
        ("  \"zz\": [-2, 2]}", "grid.json: line 4, column 3: key zz is not known here; did you mean z?"),
        (
            "  \"z\": [-2, 2], \"q\\\"\": [[], {}, null, true, -1e2]}",
            "grid.json: line 4, column 17: key q\": not known",
        ),
        (
            "  \"z\": [-2,",
            "grid.json: line 4, column 11: this is no JSON: the text ends too early: a bracket or a quote",
        ),
        (
            "  \"z\": [-2, NaN]\n}",
            "grid.json: line 4, column 13: this is no JSON: no value stands here: numbers are written as",
        ),
        (
            "  \"z\": [-2, 2,]\n}",
            "grid.json: line 4, column 15: this is no JSON: no comma may stand before this bracket",
        ),
        (
            "  \"z\": [-2 2]\n}",
            "grid.json: line 4, column 12: this is no JSON: a comma is missing here, or the `]` of the list",
        ),
        ("  \"z\" [-2, 2]\n}", "grid.json: line 4, column 7: this is no JSON: a colon is missing behind this key"),
        ("  z: [-2, 2]\n}", "grid.json: line 4, column 3: this is no JSON: a key in quotes is missing here"),
        ("  \"z\": [-2, 2]\n}\n}", "grid.json: line 6, column 1: this is no JSON: something stands behind its end"),
        ("  \"z\": [-2, 1e999]\n}", "this is no JSON: this number is too large"),
    ] {
        let text = said(&format!("{begin}{rest}"));
        assert!(text.contains(place) && text.contains('^'), "{place}: {text}");
    }
    let whole = said(&format!("{begin}  \"z\" : {{ \"points\":[-2.0,2e0] ,\"cells\":[ 4 ]}}\n}}\n"));
    assert!(whole.is_empty(), "{whole}");
    // JSON has no comments: what other programs write beside the edges is passed over there.
    let beside = said(&format!("{begin}  \"z\": [-2, 2],\n  \"comment\": \"by hand\",\n  \"nx\": 1\n}}\n"));
    assert!(beside.is_empty(), "{beside}");
}

/// TOML has comments: a key that a grid does not have is told there, whatever it is.
#[test]
fn other_keys_of_a_grid_in_toml_are_told() {
    let at = Scratch::new();
    let grid = at.file("grid.toml");
    let all = "x = [-2, 2]\ny = [-2, 2]\nz = [-2, 2]\n";
    for (key, said) in [
        ("comment", "key comment: not known, ignored; a comment begins with #"),
        ("name", "key name: not known, ignored"),
        ("nx", "key nx: not known, ignored"),
        ("remark", "key remark: not known, ignored"),
    ] {
        fs::write(&grid, format!("{all}{key} = \"by hand\"\n")).expect("a grid");
        let output = ball(&at, &["--grid", grid.to_str().expect("a path")]);
        let text = stderr(&output);
        assert!(output.status.success() && text.contains("grid.toml: line 4, column 1: "), "{text}");
        assert!(text.contains(said), "{text}");
    }
}

#[test]
fn a_number_goes_with_its_noun() {
    let at = Scratch::new();
    let one = stdout(&ball(&at, &["--cells", "1x1x1", "--method", "gjk"]));
    for words in ["1 × 1 × 1 = 1 cell\n", "bodies        1 (0 triangles)", "subdivided    1 body, queries of GJK: "] {
        assert!(one.contains(words), "'{words}' expected: {one}");
    }
    let two = stdout(&ball(&at, &["--cells", "2x1x1"]));
    assert!(two.contains("2 × 1 × 1 = 2 cells\n"), "{two}");
    // One triangle turned of a tetrahedron.
    let faces = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\n";
    for (last, words) in [
        ("f 2 4 3\n", "1 triangle had the wrong orientation (winding) and was turned"),
        ("f 2 3 4\nf 2 3 4\n", "1 triangle repeats others (duplicate surface) and was dropped"),
        ("f 2 3 4\nf 2 3 3\n", "1 degenerate triangle (no area) is ignored"),
        ("", "the surface is open: 3 boundary edges around 1 hole, closed with a cap"),
    ] {
        fs::write(at.file("corner.obj"), format!("{faces}{last}")).expect("a file");
        let text = stderr(&voidage(&[&"inspect", &at.file("corner.obj")]));
        assert!(text.contains(words), "'{words}' expected: {text}");
    }
}

/// Of areas the digits are told that are known, fewer where facets stand for a ball, and rounding is 0.
#[test]
fn areas_have_the_digits_that_are_known() {
    assert_eq!(
        [part(8e-16, 12.5, 6), part(2.345_678_9, 12.5, 6), part(-123_456.789, 2e5, 3)],
        ["0", "2.34568", "-123457"]
    );
    let at = Scratch::new();
    let line = |output: &Output| {
        let text = stdout(output);
        text.lines().find(|line| line.starts_with("frontal area")).expect("a line").to_owned()
    };
    let round = line(&ball(&at, &["--spacing", "0.3", "--resistance"]));
    assert_eq!(round, "frontal area  3.14, 3.14, 3.14 m² along x, y, z; wetted 12.6 m²");
    // A box of 1 by 2 by 3, turned about z by 30°; its ends lie in planes of the grid, which are faces and no part of a cell.
    let scene = "[[solid]]\nshape = \"box\"\nmin = [0, 0, 0]\nmax = [1, 2, 3]\nrotate = { axis = \"z\", angle = 30 }\n";
    fs::write(at.file("box.toml"), scene).expect("a scene");
    let flat = line(&voidage(&[&"porosity", &at.file("box.toml"), &"--spacing", &"0.5", &"--resistance"]));
    assert_eq!(flat, "frontal area  6.69615, 5.59808, 0 m² along x, y, z; wetted 22 m²");
}

/// A long title is cut, the time behind it is not: frames of gas at rest differ in nothing else.
#[test]
fn the_time_stands_behind_a_long_title() {
    let at = Scratch::new();
    let title = "wind ".repeat(100);
    let case = format!(
        "title = \"{title}\"\n[grid]\nx = [0, 1, 2]\ny = [0, 1, 2]\n[gas]\nmodel = \"ideal\"\ngamma = 1.4\n[initial]\nuniform = {{ rho = 1, p = 1 }}\n\
         [boundary]\nx_min = \"wall\"\nx_max = \"wall\"\ny_min = \"wall\"\ny_max = \"wall\"\n[time]\nend = 1\n[output]\nformats = [\"png\"]\n\
         range = {{ speed = [0, 1], overpressure = [0, 1] }}\n"
    );
    solved(&at, &case, "out", &["-q"]);
    let picture = |n: usize| fs::read(at.file(&format!("out/frames/speed_{n:04}.png"))).expect("a picture");
    assert!(picture(0) != picture(1));
}

/// A tube between air at rest and an outlet: the stream has the speed of the steady expansion between both pressures.
#[test]
fn a_reservoir_feeds_what_the_pressure_inside_draws() {
    let at = Scratch::new();
    let case = |state: &str| {
        format!(
            "[grid]\nx = {{ points = [0, 1], cells = [8] }}\n[gas]\nmodel = \"ideal\"\ngamma = 1.4\ngas_constant = 1\n[initial]\nuniform = {{ {state} }}\n\
             [boundary]\nx_min = {{ type = \"reservoir\", T = 1, p = 1.05 }}\nx_max = {{ type = \"outlet\", p = 1 }}\n[time]\nend = 60\n"
        )
    };
    solved(&at, &case("rho = 1, p = 1"), "out", &["-q"]);
    let exact = (7.0 * (1.0 - (1.0_f64 / 1.05).powf(0.4 / 1.4))).sqrt();
    for u in crate::kit::array(&at.file("out/final/u.npy")) {
        assert!((u / exact - 1.0).abs() < 1e-3, "{u}, not {exact}");
    }
    let refused = |from: &str, to: &str, words: &str| {
        let text = stderr(&solve(&at, &case("rho = 1, p = 1").replace(from, to), "other", &[]));
        assert!(text.contains(words), "'{words}' expected: {text}");
    };
    refused("p = 1.05", "p = 1.05, u = 1", "key boundary.x_min.u: is not a key of this type (reservoir)");
    refused(", p = 1.05", "", "key boundary.x_min: p is missing");
    refused("uniform = { rho = 1", "uniform = { gamma = 1.3, rho = 1", "key boundary.x_min: a reservoir is of one gas");
    refused("\"reservoir\"", "\"reservior\"", "did you mean reservoir?");
    refused("\"reservoir\"", "\"stagnation\"", "did you mean reservoir?");
    for word in ["open", "vent", "atmosphere"] {
        refused("\"reservoir\"", &format!("\"{word}\""), "did you mean outlet?");
    }
}

#[test]
fn coefficients_of_no_law_are_refused() {
    let at = Scratch::new();
    let case = "[grid]\nx = [0, 1, 2]\n[gas]\nmodel = \"ideal\"\ngamma = 1.4\n[initial]\nuniform = { rho = 1, p = 1 }\n\
                [boundary]\nx_min = \"wall\"\nx_max = \"wall\"\n[time]\nmax_steps = 1\n[drag]\n";
    for key in ["cd", "cd_round", "cd_sharp"] {
        let text = stderr(&solve(&at, &format!("{case}{key} = 2\n"), "out", &[]));
        let words = format!("key drag.{key}: goes with porosity.scene");
        assert!(text.contains(&words) && text.contains("line 14, column "), "{text}");
    }
}

/// What a run of one session took, and one that had nothing left to do.
#[test]
fn times_of_sessions() {
    let at = Scratch::new();
    let case = |end: &str| {
        format!(
            "[grid]\nx = {{ points = [0, 1], cells = [8] }}\n[gas]\nmodel = \"ideal\"\ngamma = 1.4\n[initial]\nuniform = {{ rho = 1, p = 1 }}\n\
             [boundary]\nx_min = \"wall\"\nx_max = \"wall\"\n[time]\nmax_steps = {end}\n"
        )
    };
    let first = stdout(&solved(&at, &case("2"), "out", &[]));
    assert!(first.contains(" s of stepping, ") && !first.contains("session"), "{first}");
    let again = stdout(&solved(&at, &case("2"), "out", &["--resume"]));
    assert!(again.contains("no step was left to do") && !again.contains("updates/s"), "{again}");
    let more = stdout(&solved(&at, &case("3"), "out", &["--resume"]));
    assert!(more.contains("s of stepping in this session (1 step), "), "{more}");
}

#[test]
#[cfg(unix)]
fn an_interrupt_tells_what_is_written() {
    let at = Scratch::new();
    let mut command = Command::new(program());
    command.args(["porosity", "-", "-o", "out.vtr"]).current_dir(&at.0);
    // It waits for a scene that does not come.
    let child = command.stdin(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the program runs");
    std::thread::sleep(Duration::from_millis(500));
    assert!(Command::new("kill").arg("-INT").arg(child.id().to_string()).status().expect("kill runs").success());
    let mut child = child;
    let pipe = child.stdin.take();
    let output = child.wait_with_output().expect("the program ends");
    drop(pipe);
    assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
    assert!(stderr(&output).contains("error: interrupted: no file was written"), "{}", stderr(&output));
    assert!(at.names().is_empty());
}

/// A long point of a study is not silent, and small points do not tell how long large ones take.
#[test]
fn a_study_tells_how_far_it_is() {
    let (tell, told) = channel();
    let beat = Heartbeat::new(Duration::from_millis(5), move |time| {
        let _ = tell.send(time); // the test has heard enough
    });
    let times: Vec<Duration> = told.iter().take(3).collect();
    drop(beat);
    assert!(times[0] >= Duration::from_millis(5) && times.is_sorted());
    let at = Scratch::new();
    let study = "[[scene]]\nsolid = [{ shape = \"sphere\", center = [0, 0, 0], radius = 1 }]\n[[method]]\nmethod = \"auto\"\n\
                 [[grid]]\nx = { points = [-2, 2], cells = [4] }\ny = { points = [-2, 2], cells = [4] }\nz = { points = [-2, 2], cells = [4] }\n\
                 [[grid]]\nx = { points = [-2, 2], cells = [40] }\ny = { points = [-2, 2], cells = [40] }\nz = { points = [-2, 2], cells = [40] }\n";
    fs::write(at.file("study.toml"), study).expect("a study");
    let text = stdout(&voidage(&[&"study", &at.file("study.toml"), &"-o", &at.file("out")]));
    assert!(text.contains("[1/2] "), "{text}");
}

/// Memory is asked for before a study begins, at the key that asks for too much.
#[test]
fn a_study_that_needs_too_much_memory_is_refused() {
    let at = Scratch::new();
    let scene = "[[scene]]\n[[scene.solid]]\nshape = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\n[[method]]\n";
    let cells =
        |n: usize| format!("[[grid]]\norigin = [-1, -1, -1]\nspacing = [0.1, 0.1, 0.1]\ncells = [{n}, {n}, {n}]\n");
    for (text, key) in [
        (format!("refine = 1024\n{scene}{}", cells(64)), "grid"),
        (format!("{scene}{}", cells(1500)), "grid"),
        ("[[flow]]\nproblem = \"vortex\"\ncells = 100000\n".to_owned(), "cells"),
    ] {
        fs::write(at.file("study.toml"), &text).expect("written");
        let output = voidage(&[&"study", &at.file("study.toml"), &"-o", &at.file("out")]);
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{text}: {said}");
        assert!(said.contains(key) && said.contains("GB of memory"), "{text}: {said}");
    }
}

/// The standard output takes one thing.
#[test]
fn two_outputs_to_the_standard_output_are_refused() {
    let at = Scratch::new();
    let output = ball(&at, &["--png", "-", "--report", "-"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("two outputs to -"), "{}", stderr(&output));
}

/// Forces have four digits, and no exponent where none is needed.
#[test]
fn forces_are_written_as_numbers_are() {
    let at = Scratch::new();
    fs::write(
        at.file("box.toml"),
        "[[solid]]\nname = \"tank\"\nshape = \"box\"\nmin = [0.5, 0, 0]\nmax = [0.75, 1, 1]\n",
    )
    .expect("a scene");
    let case = "[grid]\nx = { points = [0, 1], cells = [8] }\n[porosity]\nscene = \"box.toml\"\n[drag]\nlaw = \"none\"\n\
                [gas]\nmodel = \"ideal\"\ngamma = 1.4\n\
                [initial]\nuniform = { rho = 1.2, p = 1e5 }\nregions = [{ max = [0.5], p = 112345.6 }]\n\
                [boundary]\nx_min = \"wall\"\nx_max = \"wall\"\n[time]\nmax_steps = 0\n[output]\nforces = [\"tank\"]\n";
    let said = stdout(&solved(&at, case, "out", &[]));
    assert!(said.contains("\nforce         (12350, 0, 0) N on tank; largest 12350 N at t = 0 s\n"), "{said}");
}

/// Where there is no terminal a line about a long stage tells how much of it is done, if that is counted, whoever prints it; of stages within each
/// other it is about the innermost.
#[test]
fn a_long_stage_tells_how_much_is_done() {
    let mut progress = Progress::new(&TalkArgs { quiet: false, verbose: false });
    let time = Duration::from_secs(21);
    let said = progress.stage("setup", |p| {
        let outer = p.so_far("setup");
        let inner = p.stage("porosity", |p| {
            let (bar, inner) = (p.bar("porosity", 40), p.so_far("porosity"));
            let before = inner(time);
            (0..11).for_each(|_| bar.step());
            [outer(time), before, inner(time)]
        });
        (inner, outer(time))
    });
    let line = |words: &str| Some(format!("{words}: 21 s so far"));
    assert_eq!(said.0, [None, line("porosity 0 %"), line("porosity 27 %")]);
    assert_eq!(said.1, line("setup"), "the bar of a stage that is over is not that of the next");
}

/// Cells that rounding leaves no width are told by the keys that ask for them.
#[test]
fn widths_lost_in_rounding_are_told_by_their_keys() {
    let at = Scratch::new();
    let said = |text: &str| {
        let grid = at.write("grid.toml", text.as_bytes());
        stderr(&ball(&at, &["--grid", grid.to_str().expect("a path")]))
    };
    let text = said("origin = [1e17, 0, 0]\nspacing = [1, 1, 1]\ncells = [4, 4, 4]\n");
    let words = "grid.toml: line 2, column 12: key spacing[0]: a step of 1 is lost in rounding at coordinates around origin[0] = 1e17";
    assert!(text.contains(words) && !text.contains("x["), "{text}");
    let text = said("x = { points = [1e17, 1.00000000000000016e17], cells = [40] }\ny = [0, 1]\nz = [0, 1]\n");
    let words = "line 1, column 5: key x: of the 40 cells between the points 1e17 and 1.0000000000000002e17 some have a width that is lost";
    assert!(text.contains(words), "{text}");
    let text = said("x = { points = [0, 1], cells = [40], ratios = [1e300] }\ny = [0, 1]\nz = [0, 1]\n");
    assert!(!text.contains("x["), "{text}");
}

/// A grid or a list of zones where a scene is asked for is called by its name.
#[test]
fn grids_and_zones_are_no_scenes() {
    let at = Scratch::new();
    for (name, text, words) in [
        (
            "g.toml",
            "origin = [0, 0, 0]\nspacing = [1, 1, 1]\ncells = [4, 4, 4]\n",
            "g.toml: this is a grid, not a scene: it has the key origin;",
        ),
        (
            "h.toml",
            "x = [0, 1]\ny = [0, 1]\nz = [0, 1]\n",
            "h.toml: this is a grid, not a scene: it has the key x; voidage porosity takes it by --grid",
        ),
        (
            "g.json",
            "{\"x\": [0, 1],\n\"y\": [0, 1],\n\"z\": [0, 1]}\n",
            "g.json: this is a grid, not a geometry: voidage porosity takes it by --grid",
        ),
        (
            "z.toml",
            "[[zone]]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n",
            "z.toml: this is a list of zones, not a scene: it has the key zone; voidage porosity takes it by --zones",
        ),
    ] {
        for command in ["inspect", "porosity"] {
            let output = voidage(&[&command, &at.write(name, text.as_bytes())]);
            assert!(output.status.code() == Some(1) && stderr(&output).contains(words), "{}", stderr(&output));
        }
    }
}

#[test]
fn a_cone_with_its_apex_at_the_base_is_to_be_turned() {
    let at = Scratch::new();
    let inspect = |radii: &str| {
        let text = format!("[[solid]]\nshape = \"cone\"\nfrom = [0, 0, 0]\nto = [0, 0, 1]\n{radii}\n");
        stderr(&voidage(&[&"inspect", &at.write("cone.toml", text.as_bytes())]))
    };
    let text = inspect("radius = 0\ntop_radius = 1");
    assert!(text.contains("line 5, column 10: ") && text.contains("radius must be positive, not 0"), "{text}");
    assert!(text.contains("a cone has its apex at to; swap from and to"), "{text}");
    for radii in ["radius = 0", "radius = -1\ntop_radius = 1", "radius = 0\ntop_radius = 0"] {
        let text = inspect(radii);
        assert!(text.contains("radius must be positive") && !text.contains("swap"), "{text}");
    }
}

#[test]
fn compression_needs_what_it_packs() {
    let at = Scratch::new();
    let png = at.file("p.png").display().to_string();
    for more in [&["--compress"][..], &["--compress", "-o", &png]] {
        let output = ball(&at, more);
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        let words = "--compress packs the fields for ParaView: give -o FILE.vtr";
        assert!(stderr(&output).contains(words), "{}", stderr(&output));
    }
}
