//! `voidage solve` with cases that are wrong: the error names the file, the key or cell, and the reason; nothing is left.

use crate::kit::{Scratch, array, solve, solved, stderr};
use std::fs;
use voidage::files::npy;

const CASE: &str = r#"
[grid]
x = { points = [0, 1], cells = [4] }
y = [0, 0.5, 1]
[gas]
model = "ideal"
gamma = 1.4
[initial]
uniform = { rho = 1, u = 0.5, p = 1 }
[boundary]
x_min = { type = "inlet", rho = 1, u = 0.5 }
x_max = { type = "outlet", p = 1 }
y_min = { type = "wall" }
y_max = { type = "wall" }
[time]
end = 0.1
"#;

/// The case with one text replaced fails with exit code 1 and a message that holds all `words`.
fn fails(from: &str, to: &str, words: &[&str]) {
    let at = Scratch::new();
    assert!(CASE.contains(from), "'{from}' is not in the case");
    let output = solve(&at, &CASE.replacen(from, to, 1), "out", &[]);
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "'{to}' is accepted: {said}");
    for word in [&["case.toml: "], words].concat() {
        assert!(said.contains(word), "'{word}' expected of '{to}': {said}");
    }
    assert_eq!(at.names(), ["case.toml"], "'{to}' leaves something");
}

#[test]
fn the_case_itself_is_right() {
    let at = Scratch::new();
    solved(&at, CASE, "out", &["-q"]);
    // The same cells, whose size is one number.
    let equal = "origin = [0, 0]\ncells = [2, 2]\nspacing = 0.5\n";
    let listed = "x = [0, 0.5, 1]\ny = [0, 0.5, 1]\n";
    let of = |grid: &str| CASE.replace("x = { points = [0, 1], cells = [4] }\ny = [0, 0.5, 1]\n", grid);
    solved(&at, &of(equal), "one", &["-q"]);
    solved(&at, &of(listed), "each", &["-q"]);
    let edges = |out: &str| fs::read(at.file(out).join("final/edges.json")).expect("edges");
    assert_eq!(edges("one"), edges("each"));
}

#[test]
fn keys() {
    fails(
        "[time]",
        "[tine]",
        &["line 15, column 2: key tine: is not known here; did you mean time?", "\n  15 | [tine]\n     |  ^^^^"],
    );
    fails(
        "gamma",
        "gama",
        &["line 7, column 1: key gas.gama: is not known here; did you mean gamma? (known: model, gamma"],
    );
    fails("end = 0.1", "end = 0.1\nstop = 2", &["line 17, column 1: key time.stop", "(known: end, max_steps)"]);
    fails("rho = 1, u = 0.5, p = 1", "density = 1, p = 1", &["line 9, column 13: key initial.uniform.density"]);
    fails("[time]", "[[boundary.patches]]\nside = \"x_min\"\n[time]", &["boundary.patches", "did you mean patch?"]);
    fails("cells = [4]", "cells = [4], ratio = [1]", &["key grid.x.ratio", "did you mean ratios?"]);
    fails("x = { points = [0, 1], cells = [4] }", "x = \"a\"", &["key grid.x: takes a list of edges, or { points"]);
    let mark = "\n   7 | gamma = \"1.4\"\n     |         ^^^^^";
    fails("gamma = 1.4", "gamma = \"1.4\"", &["line 7, column 9: key gas.gamma: takes a number, not a text", mark]);
    fails("gamma = 1.4", "gamma 1.4", &["line 7"]);
    let unknown = "key gas.model: \"real\" is not known: ideal, isothermal, isentropic";
    fails("model = \"ideal\"", "model = \"real\"", &["line 6, column 9", unknown]);
    fails("model = \"ideal\"", "model = \"idael\"", &["did you mean ideal?"]);
    fails(
        "type = \"outlet\"",
        "type = \"exit\"",
        &["line 12", "key boundary.x_max.type: \"exit\" is not known: inlet, far-field"],
    );
    fails(
        "y_min = { type = \"wall\" }",
        "y_min = \"wal\"",
        &["key boundary.y_min.type: \"wal\" is not known", "did you mean wall?"],
    );
    fails(
        "y_min = { type = \"wall\" }",
        "y_min = 3",
        &["key boundary.y_min: takes a word or a table with any of type, rho,", "not a whole number"],
    );
    fails("end = 0.1", "", &["line 15, column 1: key time: needs end or max_steps"]);
    fails("gamma = 1.4", "", &["line 5, column 1: key gas.gamma: is missing"]);
    fails(
        "gamma = 1.4",
        "gamma = 1.4\nsound_speed = 1",
        &["line 8", "key gas.sound_speed: is not a key of this model (ideal)"],
    );
    fails("end = 0.1", "max_steps = -3", &["key time.max_steps: takes a whole number from 0, not -3"]);
    fails("end = 0.1", "max_steps = 3.5", &["key time.max_steps: takes a whole number, not 3.5"]);
    fails("end = 0.1", "end = 1e999", &["line 16, column 7: 1e999 is too large for a number"]);
    fails("[time]", "[gravity]\ng = [0, -9.81]\n[time]", &["key gravity.g: takes 3 values, not 2"]);
    fails(
        "[time]",
        "[porosity]\nscene = 3\n[time]",
        &["key porosity.scene: takes a path or a list of paths, not a whole"],
    );
    fails("[time]", "[[solid]]\nshape = 3\n[time]", &["key solid: is not known here"]);
}

/// A message names none of the program's own types.
#[test]
fn files_of_other_commands() {
    let at = Scratch::new();
    let said = |name: &str, arguments: &[&dyn AsRef<std::ffi::OsStr>]| {
        let output = crate::kit::voidage(arguments);
        assert_eq!(output.status.code(), Some(1), "{name}");
        stderr(&output)
    };
    let solid = "[[solid]]\nshape = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\n";
    let study =
        "[[method]]\nmethod = \"auto\"\n[[scene]]\nfiles = [\"a.stl\"]\n[[grid]]\nx = [0, 1]\ny = [0, 1]\nz = [0, 1]\n";
    for (name, text) in [("case.toml", CASE), ("scene.toml", solid), ("study.toml", study)] {
        fs::write(at.file(name), text).expect("written");
    }
    let [case, scene, study] = ["case.toml", "scene.toml", "study.toml"].map(|name| at.file(name));
    for (text, words) in [
        (said("a", &[&"porosity", &case]), "case.toml: this is a case, not a scene: it has the key gas; voidage solve"),
        (said("b", &[&"porosity", &study]), "study.toml: this is a study, not a scene"),
        (
            said("c", &[&"solve", &scene]),
            "scene.toml: this is a scene, not a case: it has the key solid; voidage porosity",
        ),
        (said("d", &[&"solve", &study]), "study.toml: this is a study, not a case"),
        (said("e", &[&"study", &case]), "case.toml: this is a case, not a study"),
        (said("f", &[&"porosity", &scene, &"--grid", &case]), "case.toml: line 2, column 2: this file holds a [grid]"),
    ] {
        assert!(text.contains(words), "'{words}' expected: {text}");
    }
    // A case names itself, a study and a picture in place of a scene.
    fs::write(at.file("picture.stl"), b"\x89PNG\r\n\x1a\n, and what follows").expect("written");
    for (named, place, words) in [
        ("\"own.toml\"", "key porosity.scene: ", "own.toml: this is a case, not a scene: it has the key gas"),
        (
            "[\"scene.toml\", \"study.toml\"]",
            "key porosity.scene[1]: ",
            "study.toml: this is a study, not a scene: it has the key method",
        ),
        ("\"picture.stl\"", "key porosity.scene: ", "picture.stl: "),
    ] {
        let own = at.file("own.toml");
        fs::write(&own, CASE.replace("[gas]", &format!("[porosity]\nscene = {named}\n[gas]"))).expect("written");
        let text = said(named, &[&"solve", &own, &"-o", &at.file("out")]);
        let begin = text.find("own.toml: line 6, column ").expect("the line of the case");
        let (key, file) = (text.find(place).expect(place), text.rfind(words).expect(words));
        assert!(begin < key && key < file && text.contains("\n   6 | scene = "), "{text}");
    }
    fs::write(&scene, format!("{solid}[[grid]]\nx = [0, 1]\n")).expect("written");
    let text = said("g", &[&"porosity", &scene]);
    assert!(text.contains("line 5, column 1: grid takes one table [grid]"), "{text}");
    fs::write(&scene, format!("{solid}[grid]\nx = [0, 1]\n")).expect("written");
    let text = said("h", &[&"porosity", &scene]);
    assert!(text.contains("a grid needs all of x, y, z: only that of a case of voidage solve may lack some"), "{text}");
    fs::write(at.file("case.toml"), CASE.replace("[grid]", "[[grid]]")).expect("written");
    let text = said("i", &[&"solve", &case]);
    assert!(text.contains("a case has one table [grid]"), "{text}");
}

/// A text where a table has only its `type`.
#[test]
fn sides_by_a_word() {
    let at = Scratch::new();
    solved(&at, CASE, "tables", &["-q"]);
    let words = CASE.replace("{ type = \"wall\" }", "\"wall\"");
    assert_ne!(words, CASE);
    solved(&at, &words, "words", &["-q"]);
    let read = |dir: &str| fs::read(at.file(&format!("{dir}/final/p.npy"))).expect("an array");
    assert!(read("tables") == read("words"));
    fails("x_max = { type = \"outlet\", p = 1 }", "x_max = \"outlet\"", &["key boundary.x_max: an outlet needs p"]);
}

#[test]
fn numbers() {
    fails("gamma = 1.4", "gamma = 1", &["key gas.gamma: needs a number above 1 and up to 100, not 1"]);
    fails("end = 0.1", "end = -1", &["key time.end: needs a number from 1e-30 to 1e30, not -1"]);
    fails("end = 0.1", "max_steps = 1e4", &["max_steps: takes a whole number, not 10000.0: without a point"]);
    fails("end = 0.1", "end = nan", &["key time.end", "not nan"]);
    fails("[time]", "[scheme]\ncfl = -0.5\n[time]", &["key scheme.cfl: needs a number from 1e-6 to 1, not -0.5"]);
    fails("[time]", "[scheme]\ncfl = 2\n[time]", &["key scheme.cfl"]);
    fails("[time]", "[scheme]\norder = 3\n[time]", &["key scheme.order: is 1 or 2, not 3"]);
    fails("[time]", "[gravity]\ng = [0, 0, -9.81]\n[time]", &["key gravity.g: acts along z, which has one cell"]);
    fails("[time]", "[drag]\ncr = [-1, 0, 0]\n[time]", &["key drag.cr[0]: needs a number from 0 to 1e30, not -1"]);
    fails("y = [0, 0.5, 1]", "y = [0, 0.5, 0.5]", &["y[2]: edge 0.5 does not lie above"]);
    fails("y = [0, 0.5, 1]", "y = [0, nan, 1]", &["y[1]: edge nan is not finite"]);
    let equal = |keys: &str| format!("[grid]\norigin = [0, 0]\ncells = [4, 2]\nspacing = {keys}\n[gas]");
    let edges = "[grid]\nx = { points = [0, 1], cells = [4] }\ny = [0, 0.5, 1]\n[gas]";
    fails(edges, &equal("-1"), &["line 5, column 11: key grid.spacing: takes a finite number above 0, not -1"]);
    fails(edges, &equal("[1, nan]"), &["key grid.spacing[1]: takes a finite number above 0, not NaN"]);
    fails(edges, &equal("\"1\""), &["key grid.spacing: takes a number, or a list of one for each axis, not a text"]);
    fails(edges, &equal("[1]"), &["key grid.spacing: has 1 numbers, but cells has 2: one for each axis"]);
    fails("cells = [4]", "cells = [0]", &["key grid.x: a segment needs at least one cell"]);
    fails("end = 0.1", "end = 0.1\n[output]\nevery = 1e-20", &["key output.every: makes more than"]);
    fails(
        "end = 0.1",
        "end = 0.1\n[output]\nprobes = [{ name = \"A\", at = [2, 0, 0] }]",
        &["probes[0].at", "outside the grid"],
    );
}

/// What a first user types in a state or a region, and the sentence that helps.
#[test]
fn slips_in_states_and_regions() {
    let uniform = "{ rho = 1, u = 0.5, p = 1 }\n[boundary]";
    let velocity =
        "is not known here; did you mean u, v, w, the velocities along x, y, z? (known: rho, T, u, v, w, p, gamma)";
    let words =
        &["line 9, column 22: key initial.uniform.velocity: ", velocity, "\n     |                      ^^^^^^^^\n"];
    for value in ["[1, 0, 0]", "\"1 m/s\"", "1"] {
        fails(uniform, &format!("{{ rho = 1, velocity = {value}, p = 1 }}\n[boundary]"), words);
    }
    fails(uniform, "{ density = 1, p = 1 }\n[boundary]", &["uniform.density: is not known here; did you mean rho?"]);
    fails(uniform, "{ rho = 1, u = [1, 0], p = 1 }\n[boundary]", &["uniform.u: takes a number, not a list", "^^^^^^"]);
    let no_table = "key initial.uniform: takes a table with any of rho, T, u, v, w, p, gamma, not a text";
    fails(uniform, "\"rest\"\n[boundary]", &["line 9, column 11: ", no_table]);
    let region = |keys: &str| format!("{{ rho = 1, p = 1 }}\nregions = [{{ {keys} }}]\n[boundary]");
    let mark = "\n     |            ^^^^";
    for (keys, words) in [
        ("radius = 0.2, p = 2", &["line 10, column 12: key initial.regions[0]: a ball needs a center", mark][..]),
        ("center = [0.5], p = 2", &["line 10, column 12: key initial.regions[0]: a ball needs a radius", mark]),
        (
            "center = [0.5], radius = 0, p = 2",
            &["key initial.regions[0].radius: needs a number from 1e-30 to 1e30, not 0"],
        ),
        ("center = [0.5], radius = 0.2, max = [1], p = 2", &["key initial.regions[0].max: is of a box", "^^^"]),
        (
            "center = [0.5], radius = 0.2",
            &["line 10, column 12: key initial.regions[0]: has no state", "rho, T, u, v", mark],
        ),
        ("min = [0.5]", &["key initial.regions[0]: has no state and would change nothing: it needs any of rho, T"]),
        ("centre = [0.5], radius = 0.2, p = 2", &["key initial.regions[0].centre", "did you mean center?"]),
        (
            "type = \"wall\", p = 2",
            &["key initial.regions[0].type: is not known here", "(known: rho, T, u, v, w, p, gamma, min, max"],
        ),
    ] {
        fails(uniform, &region(keys), words);
    }
    fails(
        "[boundary]",
        "[[region]]\nmin = [0.5]\np = 2\n[boundary]",
        &["key region: regions stand in", "[[initial.regions]]"],
    );
    fails(
        "uniform = { rho = 1, u = 0.5, p = 1 }",
        "rho = 1\np = 1",
        &["line 9, column 1: key initial.rho: the state everywhere stands in initial.uniform"],
    );
    fails(
        uniform,
        &region("min = [0.5], u = 1e30"),
        &["cell [2, 0, 0]", "p = 0.0: rounding leaves no pressure beside a kinetic energy of 5.0e59 J/m³"],
    );
    fails("y_min = { type = \"wall\" }", "y_min = { type = \"outflow\", p = 1 }", &["did you mean outlet?"]);
}

/// Pictures are cut within the grid, whether any are drawn or not.
#[test]
fn a_slice_outside_the_grid() {
    let end = "end = 0.1";
    for (point, place, range) in [
        ("[5, 0.5, 0.5]", "output.slice[0]: x = 5", "from 0 to 1 along x"),
        ("[0.5, -0.1, 0.5]", "output.slice[1]: y = -0.1", "from 0 to 1 along y"),
        ("[0.5, 0.5, 1.5]", "output.slice[2]: z = 1.5", "from 0 to 1 along z"),
    ] {
        for formats in ["", "formats = [\"png\"]\n"] {
            let output = format!("{end}\n[output]\n{formats}slice = {point}\n");
            fails(end, &output, &[place, &format!("the grid reaches {range}"), "slice = ["]);
        }
    }
    for (point, words) in [
        ("[0.5, 0.5, nan]", "output.slice[2]: is not a number"),
        ("[0.5]", "output.slice: needs a place along y, where the grid has "),
        ("[]", "output.slice: needs one to three numbers, not 0"),
    ] {
        fails(end, &format!("{end}\n[output]\nslice = {point}\n"), &[words]);
    }
}

#[test]
fn states_and_sides() {
    fails("x = {", "file = \"grid.toml\"\nx = {", &["key grid.file: a grid is either here or in another file"]);
    let uniform = "rho = 1, u = 0.5, p = 1 }\n[boundary]";
    fails(
        uniform,
        "rho = -1, p = 1 }\n[boundary]",
        &["key initial.uniform.rho: needs a number from 1e-30 to 1e30, not -1"],
    );
    fails(
        uniform,
        "rho = 1, p = nan }\n[boundary]",
        &["key initial.uniform.p: needs a number from 1e-30 to 1e30, not nan"],
    );
    fails(
        uniform,
        "T = 0, p = 1 }\n[boundary]",
        &["key initial.uniform.T: needs a number from 1e-30 to 1e30, not 0", " ^\n"],
    );
    let outlet = "{ type = \"outlet\", p = 1 }";
    fails(outlet, "{ type = \"outlet\", p = -1 }", &["line 12", "boundary.x_max", "not -1"]);
    fails(
        outlet,
        "{ type = \"far-field\", T = -1, p = 1 }",
        &["line 12", "boundary.x_max.T: needs a number from 1e-30 to 1e30, not -1"],
    );
    fails(uniform, "rho = 1 }\n[boundary]", &["key initial.uniform: p is missing"]);
    fails(uniform, "rho = 1, p = 1, w = 3 }\n[boundary]", &["key initial.uniform.w: axis z has one cell"]);
    fails(uniform, "T = 300, p = 1 }\n[boundary]", &["T needs gas.gas_constant"]);
    fails(
        uniform,
        "rho = 1, p = 1, min = [0] }\n[boundary]",
        &["key initial.uniform.min: is not known here (known: rho, T, u, v, w, p, gamma)\n"],
    );
    fails(
        "uniform = { rho = 1, u = 0.5, p = 1 }",
        "regions = [{ max = [0.6], rho = 1, p = 1 }]",
        &["key initial: cell [2, 0, 0] at [0.625, 0.25, 0.5] is in no region"],
    );
    fails("x_max = { type = \"outlet\", p = 1 }", "", &["key boundary.x_max: is missing"]);
    fails("outlet\", p = 1", "outlet\"", &["key boundary.x_max: an outlet needs p"]);
    fails("outlet\", p = 1", "outlet\", p = 1, u = 2", &["key boundary.x_max.u: is not a key of this type (outlet)"]);
    fails(
        "inlet\", rho = 1, u = 0.5",
        "inlet\", rho = 1, u = -2",
        &["key boundary.x_min.u: must point into the domain"],
    );
    fails("inlet\", rho = 1, u = 0.5", "inlet\", u = 2", &["key boundary.x_min: rho or T is missing"]);
    fails(
        "y_min = { type = \"wall\" }",
        "y_min = { type = \"periodic\" }",
        &["key boundary.y_min: an axis is periodic on both"],
    );
    fails("y_min", "z_min = { type = \"outlet\", p = 1 }\ny_min", &["key boundary.z_min: the axis has one cell"]);
    fails("y_min = { type", "y_min = { kind", &["key boundary.y_min.kind: is not known here"]);
}

#[test]
fn files() {
    let at = Scratch::new();
    let said = |case: &str| {
        let output = solve(&at, case, "out", &[]);
        assert_eq!(output.status.code(), Some(1));
        assert!(!at.file("out").exists());
        stderr(&output)
    };
    // A file of the scene that is not there, by the key and the line that name it.
    let scene = CASE.replace("[gas]", "[porosity]\nscene = \"no.stl\"\n[gas]");
    let text = said(&scene);
    let place = "case.toml: line 6, column 9: key porosity.scene: ";
    assert!(text.contains(place) && text.contains("no.stl: cannot open: No such file"), "{text}");
    assert!(text.contains("\n   6 | scene = \"no.stl\"\n     |         ^^^^^^^^\n"), "{text}");
    let both = CASE.replace("[gas]", "[porosity]\nscene = \"no.stl\"\nfrom = \"beta\"\n[gas]");
    assert!(said(&both).contains("key porosity: takes scene or from, not both"), "{}", said(&both));

    let from = CASE.replace("uniform = { rho = 1, u = 0.5, p = 1 }", "from = \"start\"");
    let (text, place) = (said(&from), "key initial.from: ");
    assert!(text.contains("line 9, column 8") && text.contains(place) && text.contains("start: cannot open"), "{text}");
    fs::create_dir(at.file("start")).expect("a directory");
    let text = said(&from);
    assert!(
        text.contains("line 9, column 8") && text.contains(place) && text.contains("start/rho.npy: cannot open"),
        "{text}"
    );
    let put = |name: &str, shape: [usize; 3], values: &[f64]| {
        npy::write(&at.file(&format!("start/{name}.npy")), shape, values).expect("an array");
    };
    for name in ["rho", "u", "v", "p"] {
        put(name, [4, 2, 1], &[1.0; 8]);
    }
    put("u", [2, 4, 1], &[1.0; 8]);
    assert!(said(&from).contains("start/u.npy: shape: [2, 4, 1] does not fit the grid, which needs [4, 2, 1]"));
    put("u", [4, 2, 1], &[1.0, 1.0, 1.0, 1.0, 1.0, f64::NAN, 1.0, 1.0]);
    assert!(said(&from).contains("start/u.npy: [1, 1, 0]: nan is not finite"), "{}", said(&from));
    put("u", [4, 2, 1], &[1.0; 8]);
    put("p", [4, 2, 1], &[1.0, 1.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0]);
    assert!(said(&from).contains("start/p.npy: [2, 0, 0]: 0 is not from 1e-30 to 1e30"), "{}", said(&from));
    put("p", [4, 2, 1], &[1.0; 8]);
    put("w", [4, 2, 1], &[0.1; 8]);
    assert!(said(&from).contains("start/w.npy: [0, 0, 0]: 0.1 flows along an axis of one cell"));
    fs::write(at.file("start/w.npy"), "no array").expect("a file");
    assert!(said(&from).contains("start/w.npy: header: this is not a NumPy"), "{}", said(&from));

    fs::create_dir(at.file("beta")).expect("a directory");
    npy::write(&at.file("beta/beta_v.npy"), [4, 2, 1], &[1.5; 8]).expect("an array");
    npy::write(&at.file("beta/beta_x.npy"), [5, 2, 1], &[1.0; 10]).expect("an array");
    npy::write(&at.file("beta/beta_y.npy"), [4, 2, 1], &[1.0; 8]).expect("an array");
    let beta = CASE.replace("[gas]", "[porosity]\nfrom = \"beta\"\n[gas]");
    assert!(said(&beta).contains("beta/beta_y.npy: shape: [4, 2, 1] does not fit the grid, which needs [4, 3, 1]"));
    npy::write(&at.file("beta/beta_y.npy"), [4, 3, 1], &[1.0; 12]).expect("an array");
    assert!(said(&beta).contains("beta/beta_v.npy: [0, 0, 0]: 1.5 is not within 0..1"), "{}", said(&beta));
}

#[test]
fn the_last_state_does_not_replace_the_first() {
    let at = Scratch::new();
    solved(&at, CASE, "out", &["-q"]);
    let before = array(&at.file("out/final/rho.npy"));
    let again = CASE.replace("uniform = { rho = 1, u = 0.5, p = 1 }", "from = \"out/final\"");
    let output = solve(&at, &again, "out", &[]);
    assert!(stderr(&output).contains("key initial.from: would be replaced"), "{}", stderr(&output));
    assert!(array(&at.file("out/final/rho.npy")) == before);
    solved(&at, &again, "further", &["-q"]);
}

/// A push beyond all measure: the step, the cell and its values are named, and the checkpoint before remains.
#[test]
fn a_flow_that_blows_up() {
    let at = Scratch::new();
    let case = CASE.replace("[time]", "[gravity]\ng = [1e30, 0, 0]\n[time]");
    let output = solve(&at, &case, "out", &[]);
    assert_eq!(output.status.code(), Some(1));
    let said = stderr(&output);
    for word in ["error: step ", "cell [", "rho = ", "u = ", "p = ", "the last good state is in", "checkpoint.bin"] {
        assert!(said.contains(word), "'{word}' expected: {said}");
    }
    assert!(at.file("out/checkpoint.bin").exists() && !at.file("out/final").exists());
}

#[test]
fn a_grid_beyond_memory() {
    let at = Scratch::new();
    let large = "origin = [0, 0]\nspacing = [1, 1]\ncells = [60000, 60000]";
    let case = CASE.replace("x = { points = [0, 1], cells = [4] }\ny = [0, 0.5, 1]", large);
    let output = solve(&at, &case, "out", &[]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("need 460.8 GB of memory"), "{}", stderr(&output));
}

#[test]
fn the_command_line() {
    let at = Scratch::new();
    let missing = crate::kit::voidage(&[&"solve", &at.file("no.toml")]);
    assert_eq!(missing.status.code(), Some(1));
    assert!(stderr(&missing).contains("no.toml: cannot read"), "{}", stderr(&missing));
    assert_eq!(crate::kit::voidage(&[&"solve"]).status.code(), Some(2));
    assert_eq!(crate::kit::voidage(&[&"solve", &"a.toml", &"--threads", &"0"]).status.code(), Some(2));
}
