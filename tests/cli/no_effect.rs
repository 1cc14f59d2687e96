//! What a case asks for in solids changes nothing, and is told.

use crate::kit::{Scratch, json, solve, solved, stderr, voidage};
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
