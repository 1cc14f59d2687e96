//! Slips of the pen: what was given in place of what, what stands twice, what is missing; each is told, at its line if it is in a file.

use crate::kit::{Scratch, fixture, json, program, solve, solved, stderr, stdout, voidage};
use std::fs;
use std::process::{Command, Output};

/// The command with arguments, in the directory.
fn run(at: &Scratch, arguments: &[&str]) -> Output {
    Command::new(program()).args(arguments).current_dir(&at.0).output().expect("the program runs")
}

/// It fails with this exit code and these words.
fn fails(output: &Output, code: i32, words: &[&str]) {
    let said = stderr(output);
    assert_eq!(output.status.code(), Some(code), "{words:?}: {said}");
    words.iter().for_each(|words| assert!(said.contains(words), "'{words}' expected: {said}"));
}

const BOX: &str = "[[solid]]\nname = \"box\"\nshape = \"box\"\nmin = [0, 0, 0]\nmax = [0.5, 0.5, 0.5]\n";

const GRID: &str = "[grid]\nx = { points = [0, 1], cells = [4] }\ny = { points = [0, 1], cells = [4] }\nz = { points = [0, 1], cells = [4] }\n";
const GAS: &str = "[gas]\nmodel = \"ideal\"\ngamma = 1.4\n";
const INITIAL: &str = "[initial]\nuniform = { rho = 1, p = 1 }\n";
const WALLS: &str = "[boundary]\nx_min = \"wall\"\nx_max = \"wall\"\ny_min = \"wall\"\ny_max = \"wall\"\nz_min = \"wall\"\nz_max = \"wall\"\n";
const TIME: &str = "[time]\nmax_steps = 1\n";

/// Points of probes and pictures have no place along axes that a case leaves out.
#[test]
fn points_leave_out_axes_of_one_cell() {
    let at = Scratch::new();
    let grid = "[grid]\nx = { points = [0, 1], cells = [8] }\n";
    let uniform = "[initial]\nuniform = { rho = 1, p = 1 }\nregions = [{ max = [0.5], p = 2, rho = 1 }]\n";
    let sides = "[boundary]\nx_min = \"wall\"\nx_max = \"wall\"\n";
    let probes = |point: &str, out: &str| {
        let output = format!("[output]\nslice = {point}\nprobes = [{{ at = {point} }}]\n");
        let run = solve(&at, &[grid, GAS, uniform, "[time]\nmax_steps = 5\n", sides, &output].concat(), out, &[]);
        assert!(run.status.success(), "{}", stderr(&run));
        fs::read_to_string(at.file(out).join("probes.csv")).expect("a table")
    };
    let short = probes("[0.55]", "one");
    assert!(short.lines().count() > 5);
    assert_eq!(short, probes("[0.55, 0.5, 0]", "three"));
}

#[test]
fn what_a_case_lacks_has_a_place() {
    let at = Scratch::new();
    let parts = [GRID, GAS, INITIAL, TIME, WALLS];
    for (left_out, words) in [
        (0, "case.toml: line 14, column 15: grid is missing; the file ends here\n"),
        (1, "case.toml: line 15, column 15: gas is missing; the file ends here\n"),
        (2, "case.toml: line 16, column 15: initial is missing; the file ends here\n"),
        (3, "case.toml: line 16, column 15: time is missing; the file ends here\n"),
        (
            4,
            "case.toml: line 11, column 14: key boundary.x_min: is missing: a table with type, or a word such as \"wall\"; the file ends here\n",
        ),
    ] {
        let text: String = (0..5).filter(|n| *n != left_out).map(|n| parts[n]).collect();
        fails(&solve(&at, &text, "out", &[]), 1, &[words, " ^\n"]);
    }
}

#[test]
fn lists_of_a_case_hold_nothing_twice() {
    let at = Scratch::new();
    fs::write(at.file("box.toml"), BOX).expect("a scene");
    let case = |more: &str| [GRID, GAS, INITIAL, WALLS, TIME, more].concat();
    for (more, words) in [
        (
            "[porosity]\nscene = \"box.toml\"\n[output]\nforces = [\"box\", \"box\"]\n",
            "output.forces[1]: stands in this list before",
        ),
        ("[porosity]\nscene = [\"box.toml\", \"box.toml\"]\n", "porosity.scene[1]: stands in this list before"),
        ("[porosity]\nscene = \"\"\n", "porosity.scene: is an empty text in place of a file"),
        ("[porosity]\nscene = \".\"\n", ": is a directory, not a file"),
        ("[output]\nformats = [\"vtr\", \"npy\", \"vtr\"]\n", "output.formats[2]: stands in this list before"),
        (
            "[porosity]\nscene = \"box.toml\"\nunit = \"mm\"\n",
            "porosity.unit: is of STL and OBJ files: a scene is in metres",
        ),
    ] {
        fails(&solve(&at, &case(more), "out", &[]), 1, &["case.toml: line ", words, "^"]);
    }
    fs::write(at.file("box.toml"), BOX.replace("0.5", "1")).expect("a scene");
    let output = solve(&at, &case("[porosity]\nscene = \"box.toml\"\n"), "out", &[]);
    fails(&output, 1, &["line 19, column 1: key porosity: the solids fill the whole grid: there is no gas to flow"]);
}

/// Units of others in a scene: radians, and millimetres that fill the whole grid.
#[test]
fn angles_in_radians_and_pipes_in_millimetres_are_told() {
    let at = Scratch::new();
    let said = |solid: &str| {
        let grid = "[grid]\norigin = [0, 0, 0]\nspacing = [0.5, 0.5, 0.5]\ncells = [4, 4, 4]\n";
        fs::write(at.file("s.toml"), format!("{grid}[[solid]]\nname = \"one\"\n{solid}\n")).expect("a scene");
        stderr(&run(&at, &["porosity", "s.toml"]))
    };
    let bend = |angle: &str| {
        said(&format!(
            "shape = \"torus\"\ncenter = [1, 1, 1]\naxis = \"z\"\nstart = \"x\"\nradius = 0.5\ntube = 0.1\nangle = {angle}"
        ))
    };
    assert!(bend("1.5708").contains("\"one\": angle: 1.5708 is 90° in radians"), "{}", bend("1.5708"));
    assert!(!bend("90").contains("radians") && !bend("2").contains("radians"));
    let block = "shape = \"box\"\nmin = [0.6, 0.6, 0.6]\nmax = [1.2, 1.3, 1.4]\nrotate = { axis = \"z\", angle = ";
    assert!(said(&format!("{block}0.785 }}")).contains("rotate.angle: 0.785 is 45° in radians"));
    let pipe = "shape = \"cylinder\"\nfrom = [-100, 1, 1]\nto = [200, 1, 1]\nradius = 100";
    assert!(said(pipe).contains("every cell is closed"), "{}", said(pipe));
    // A file in millimetres, as it is and with its unit.
    let large = POINTS.map(|p| p.map(|x| if x == "1" { "1500" } else { x }));
    fs::write(at.file("part.stl"), format!("solid part\n{}endsolid part\n", facets(large, &FACES))).expect("a file");
    let file = "shape = \"file\"\npath = \"part.stl\"\n";
    let hint = "\"one\": part.stl: its size, 1500.000000 × 1500.000000 × 1500.000000, would be in metres; if these are millimetres, give unit = \"mm\"";
    assert!(said(file).contains(hint), "{}", said(file));
    let text = said(&format!("{file}unit = \"mm\""));
    assert!(!text.contains("millimetres"), "{text}");
    // In a scene of a study, too: its volume is that of a tetrahedron of 1.5 m.
    let study = "[[scene]]\nfiles = \"part.stl\"\nUNITexact = 0.5625\n[[method]]\nmethod = \"auto\"\n\
                 [[grid]]\nx = [-1, 2]\ny = [-1, 2]\nz = [-1, 2]\n";
    for (unit, told) in [("", true), ("unit = \"mm\"\n", false)] {
        fs::write(at.file("study.toml"), study.replace("UNIT", unit)).expect("a study");
        let said = stderr(&run(&at, &["study", "study.toml", "-o", "study", "--force"]));
        assert_eq!(said.contains("millimetres"), told, "{said}");
        assert_eq!(said.contains("0.5625"), told, "{said}");
    }
    // A name heads columns and stands in lines.
    let named = said(
        "shape = \"sphere\"\ncenter = [1, 1, 1]\nradius = 0.3\n[[solid]]\nname = \"two\\nlines\"\nshape = \"sphere\"\n\
                      center = [1, 1, 1]\nradius = 0.3",
    );
    assert!(named.contains("name needs a name in one line"), "{named}");
}

#[test]
fn slips_in_studies_have_lines() {
    let at = Scratch::new();
    fs::write(at.file("box.toml"), BOX).expect("a scene");
    let study = "threads = [1]\n[[scene]]\nfiles = [\"box.toml\"]\n[[method]]\ntol = 1e-3\n\
                 [[grid]]\norigin = [0, 0, 0]\nspacing = [0.5, 0.5, 0.5]\ncells = [2, 2, 2]\n";
    let grid = &study[study.find("[[grid]]").expect("a grid")..];
    for (from, to, words) in [
        ("[1]", "[1, 2, 1]", "line 1, column 18: threads[2] stands in this list before"),
        ("threads = [1]", "refine = [2, 2]", "line 1, column 14: refine[1] stands in this list before"),
        ("1e-3", "[1e-3, 0.001]", "line 5, column 14: method 1: tol[1] stands in this list before"),
        (
            "\"box.toml\"",
            "\"box.toml\", \"box.toml\"",
            "line 3, column 22: scene 1: files[1] stands in this list before",
        ),
        ("\"box.toml\"", "\"none.stl\"", "line 3, column 10: scene 1: files[0] none.stl: cannot open: No such file"),
        ("\"box.toml\"", "\"\"", "line 3, column 10: scene 1: files[0] is an empty text in place of a file"),
        ("\"box.toml\"", "", "line 3, column 9: scene 1: files is an empty list"),
        ("[[method]]", "exact = 0\n[[method]]", "line 4, column 9: scene 1: exact must be positive, not 0"),
        (
            "[[method]]",
            "probe = { cell = [2, 0, 0], beta_v = 1 }\n[[method]]",
            "line 4, column 18: scene 1: probe: cell is no cell of the grid 2x2x2; cells are counted from 0",
        ),
        ("[[method]]", "name = \"\"\n[[method]]", "line 4, column 8: scene 1: name is empty"),
        (grid, "", "line 5, column 11: a study needs at least one grid, a table [[grid]]; the file ends here"),
        (grid, &[grid, grid].concat(), "key grid[1]: is the same as one before"),
    ] {
        fs::write(at.file("study.toml"), study.replace(from, to)).expect("a study");
        fails(&run(&at, &["study", "study.toml"]), 1, &["study.toml: ", words, "^"]);
    }
}

/// What a long measurement of the scene would only delay is told before the scene is read.
#[test]
fn slips_of_outputs_are_told_first() {
    let at = Scratch::new();
    let case = [GRID, GAS, INITIAL, WALLS, TIME, "[porosity]\nscene = \"not there.toml\"\n[output]\n"].concat();
    for (more, words) in [
        (
            "probes = [{ name = \"a\", at = [0, 0, 0] }, { name = \"a\", at = [0, 0, 0] }]",
            "probes[1].name: \"a\" is the name of another",
        ),
        ("probes = [{ at = [0, 0, 50] }]", "probes[0].at[2]: \"probe 1\": z = 50 is outside the grid"),
        ("probes = [{ name = \"a\", at = [0, nan, 0] }]", "probes[0].at[1]: \"a\": is not a number"),
        ("probes = [{ name = \"\", at = [0, 0, 0] }]", "probes[0].name: is empty: give a name"),
        ("monitors = [{ x = 50 }]", "monitors[0].x: the grid reaches from 0 to 1 along x"),
        ("monitors = [{ x = 0, min = [1], max = [0] }]", "monitors[0].max: must not lie below min"),
        ("range = { speed = [3, 1] }", "range.speed: needs two numbers, the lower one first"),
        ("formats = [\"png\", \"png\"]", "formats[1]: stands in this list before"),
        ("", "key porosity.scene: "),
    ] {
        let key = if more.is_empty() { String::new() } else { "key output.".to_owned() };
        fails(
            &solve(&at, &format!("{case}{more}"), "out", &[]),
            1,
            &["case.toml: line ", &format!("{key}{words}"), "^"],
        );
    }
}

/// One value in place of a list, lists that are too short, a directory without what it should hold.
#[test]
fn lists_are_asked_for_in_brackets() {
    let at = Scratch::new();
    let others = [GAS, INITIAL, WALLS, TIME].concat();
    let uniform =
        |spacing: &str, cells: &str| format!("[grid]\norigin = [0, 0, 0]\nspacing = {spacing}\ncells = {cells}\n");
    for (grid, words) in [
        (
            uniform("0.5", "[2, 2, 2]").replace("[0, 0, 0]", "0"),
            "key grid.origin: takes a list, in brackets, not a whole number",
        ),
        (uniform("[0.5, 0.5, 0.5]", "8"), "key grid.cells: takes a list, in brackets, not a whole number"),
        (uniform("[0.5, 0.5, 0.5]", "[2, 2, 2, 2]"), "key grid.cells: takes 1 to 3 numbers, one for each axis, not 4"),
        (format!("{GRID}[output]\nformats = \"vtr\"\n"), "key output.formats: takes a list, in brackets, not a text"),
        (format!("{GRID}[drag]\nfrom = \".\"\n"), "key drag.from: "),
    ] {
        fails(&solve(&at, &format!("{grid}{others}"), "out", &[]), 1, &["case.toml: line ", words, "^"]);
    }
    fs::write(at.file("box.toml"), format!("{BOX}{}", uniform("[0.5, 0.5, 0.5]", "[2, 2]"))).expect("a scene");
    fails(&run(&at, &["porosity", "box.toml"]), 1, &["key grid.cells: takes 3 numbers, one for each axis, not 2", "^"]);
}

/// Words in capitals, one value in place of a list of one, a probe far off, a law without a scene, a bend along its own axis.
#[test]
fn slips_that_one_can_mend_from_the_message() {
    let at = Scratch::new();
    let case = [GRID, GAS, INITIAL, WALLS, TIME].concat();
    for (more, words) in [
        (
            "[scheme]\nriemann = \"HLLC\"\n",
            "\"HLLC\" is not known: hllc, hllc-low-mach, hlle, rusanov; did you mean hllc?",
        ),
        ("[drag]\nlaw = \"PDR\"\n", "\"PDR\" is not known: none, bluff, pdr; did you mean pdr?"),
        ("[drag]\nlaw = \"pdr\"\n", "key drag.law: goes with porosity.scene: it is about the solids of a scene"),
        (
            "[output]\nprobes = [{ name = \"far\", at = [0, 0, 50] }]\n",
            "key output.probes[0].at[2]: \"far\": z = 50 is outside the grid: the grid reaches from 0 to 1 along z",
        ),
    ] {
        fails(&solve(&at, &format!("{case}{more}"), "out", &[]), 1, &["case.toml: line ", words, "^"]);
    }
    let bend = "[[solid]]\nshape = \"torus\"\ncenter = [0, 0, 0]\naxis = \"z\"\nradius = 1\ntube = 0.1\nangle = 90\n";
    for start in ["\"z\"", "[0, 0, -1e-3]"] {
        fs::write(at.file("bend.toml"), format!("{bend}start = {start}\n")).expect("a scene");
        let words = "line 8, column 9: solid 1: start points along the axis: a bend begins where start points away from the axis";
        fails(&run(&at, &["porosity", "bend.toml"]), 1, &[words, "^"]);
    }
    fs::write(at.file("box.toml"), BOX).expect("a scene");
    let study = "repeats = 1\nthreads = 1\n[[scene]]\nfiles = \"box.toml\"\n[[method]]\n[[grid]]\norigin = [0, 0, 0]\n\
                 spacing = [0.5, 0.5, 0.5]\ncells = [2, 2, 2]\n[[flow]]\nproblem = \"sod\"\ncells = [20, 40]\n";
    fs::write(at.file("study.toml"), study).expect("a study");
    let shouted = study.replace("\"sod\"", "\"SOD\"");
    fs::write(at.file("shouted.toml"), shouted).expect("a study");
    fails(&run(&at, &["study", "shouted.toml"]), 1, &["inclined-wall; did you mean sod?", "^^^^^"]);
    let output = run(&at, &["study", "study.toml", "-o", "study", "-q"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let page = fs::read_to_string(at.file("study").join("study.md")).expect("a page");
    assert!(page.contains("- It is ") && page.contains(" (sod).") && !page.contains("- From "), "{page}");
}

/// A geometry in place of a case, a case in place of a geometry.
#[test]
fn files_of_another_kind() {
    let at = Scratch::new();
    fs::copy(fixture("cad_skid.stl"), at.file("skid.stl")).expect("a copy");
    fs::write(at.file("case.toml"), [GRID, GAS, INITIAL, WALLS, TIME].concat()).expect("a case");
    for (arguments, kind) in [
        (&["solve", "skid.stl"][..], "not a case"),
        (&["study", "skid.stl"], "not a study"),
        (&["porosity", "skid.stl", "--grid", "skid.stl"], "not a grid"),
        (&["porosity", "skid.stl", "--report", "r.json", "--zones", "skid.stl"], "not a list of zones"),
    ] {
        fails(
            &run(&at, arguments),
            1,
            &["skid.stl: this is a geometry, ", kind, "voidage porosity and inspect read it"],
        );
    }
    for arguments in [&["porosity", "case.toml"], &["inspect", "case.toml"]] {
        fails(&run(&at, arguments), 1, &["case.toml: this is a case, not a scene", "voidage solve reads it"]);
    }
    fails(
        &run(&at, &["porosity", "skid.stl", "--grid", "/dev/null"]),
        1,
        &["is a device or a pipe, not a regular file"],
    );
}

#[test]
fn values_that_begin_with_a_minus() {
    let at = Scratch::new();
    fs::write(at.file("box.toml"), BOX).expect("a scene");
    for (options, words) in [
        (
            &["--cells", "-1x1x1"][..],
            "'--cells <NXxNYxNZ>': '-1' is no number that fits here: whole numbers from 1 such as 99x99x63",
        ),
        (&["--drag", "pdr", "--cd", "-3"], "'--cd <CD>': '-3' is no drag coefficient: needs a number from 0 to 1e6"),
        (&["--drag", "pdr", "--cd", "1e300"], "needs a number from 0 to 1e6"),
        (&["--drag", "pdr", "--cd", "round=1,round=2"], "round is given twice"),
        (&["--unit", "-mm"], "unexpected argument '-m' found"),
        (&["--spacing", "1e-300"], "needs a length from 1e-30 to 1e30"),
        (&["--bounds", "0,0,0,1,1,1e300"], "needs coordinates within ±1e30, and x0,y0,z0 below x1,y1,z1"),
        (&["--slice", "x=1e300", "--png", "p.png"], "needs a coordinate in metres, within ±1e30"),
        (&["--spacing", "1e-9"], "grid: 500000002 × 500000002 × 500000002 cells are too many"),
    ] {
        let output = run(&at, &[&["porosity", "box.toml"], options].concat());
        fails(&output, 2, &[words]);
        assert!(!stderr(&output).contains("tip:"), "{}", stderr(&output));
    }
    let output = run(&at, &["porosity", "box.toml", "--cells", "4x4x4", "--leaf", "half"]);
    assert!(stderr(&output).contains("--leaf has no effect: it is of --method gjk"), "{}", stderr(&output));
    let help = stdout(&run(&at, &["porosity", "--help"])).split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(help.contains("1/64 of the longest side of the scene, or of --bounds"), "{help}");
    fails(&run(&at, &["stress", "--only", ""]), 2, &["no case is called \"\""]);
}

/// A scene that no grid of numbers fits around is told as such.
#[test]
fn scenes_too_far_away_for_a_grid() {
    let at = Scratch::new();
    for (center, radius) in [("1e20", "1"), ("1e30", "1")] {
        let text = format!("[[solid]]\nshape = \"sphere\"\ncenter = [{center}, 0, 0]\nradius = {radius}\n");
        fs::write(at.file("scene.toml"), text).expect("a scene");
        let output = run(&at, &["porosity", "scene.toml", "--cells", "4x4x4"]);
        fails(&output, 1, &["the scene reaches from (", "too far from the origin for its size"]);
    }
    for (radius, words) in
        [("1e60", "takes a number within ±1e30, not 1e60"), ("1e-60", "must be at least 1e-30, not 1e-60")]
    {
        let text = format!("[[solid]]\nshape = \"sphere\"\ncenter = [0, 0, 0]\nradius = {radius}\n");
        fs::write(at.file("scene.toml"), text).expect("a scene");
        fails(&run(&at, &["porosity", "scene.toml"]), 1, &["scene.toml: line 4, column 10: ", words]);
    }
}

/// Corners of a tetrahedron as facets of an STL file.
fn facets(points: [[&str; 3]; 4], faces: &[[usize; 3]]) -> String {
    let corner = |n: &usize| format!("vertex {}\n", points[*n].join(" "));
    let facet = |face: &[usize; 3]| {
        let corners: String = face.iter().map(corner).collect();
        format!("facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n")
    };
    faces.iter().map(facet).collect()
}

const POINTS: [[&str; 3]; 4] = [["0", "0", "0"], ["1", "0", "0"], ["0", "1", "0"], ["0", "0", "1"]];
const FACES: [[usize; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

#[test]
fn marks_in_geometry_stand_under_what_is_wrong() {
    let at = Scratch::new();
    let mut points = POINTS;
    points[2][1] = "1e300";
    fs::write(at.file("far.stl"), format!("solid\n{}endsolid\n", facets(points, &FACES))).expect("a file");
    let words = [
        "far.stl: line 5, column 10: `1e300` is no coordinate: it is beyond 1e60",
        "   5 | vertex 0 1e300 0\n     |          ^^^^^\n",
    ];
    fails(&run(&at, &["inspect", "far.stl"]), 1, &words);
    fs::write(at.file("bad.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 \\\n 3\nf 1/7 2 99/1/1\n").expect("a file");
    let words = ["bad.obj: line 6, column 9: index 99, but there are 3 vertices", "^^^^^^\n"];
    fails(&run(&at, &["inspect", "bad.obj"]), 1, &words);
}

#[test]
fn names_in_latin_1_stay_readable() {
    let at = Scratch::new();
    let text = format!("solid Beh?lter\n{}endsolid\n", facets(POINTS, &FACES));
    let bytes: Vec<u8> = text.bytes().map(|byte| if byte == b'?' { 0xE4 } else { byte }).collect();
    fs::write(at.file("tank.stl"), bytes).expect("a file");
    let output = run(&at, &["inspect", "tank.stl", "--report", "r.json"]);
    assert!(output.status.success(), "{}", stderr(&output));
    assert_eq!(json(&at.file("r.json"))["bodies"][0]["name"], "Behälter");
}

/// Triangles that are there twice count once in the area, and what is open because it is a sheet is told as a sheet alone.
#[test]
fn surface_counts_and_is_told_once() {
    let at = Scratch::new();
    let area = |name: &str, faces: &[[usize; 3]]| {
        fs::write(at.file(name), format!("solid\n{}endsolid\n", facets(POINTS, faces))).expect("a file");
        let output = voidage(&[&"inspect", &at.file(name), &"--report", &at.file("r.json")]);
        (json(&at.file("r.json"))["files"][0]["area"].as_f64().expect("an area"), stderr(&output))
    };
    let (once, said) = area("once.stl", &FACES);
    assert!((once - (1.5 + 0.75_f64.sqrt())).abs() < 1e-12 && said.is_empty(), "{once} {said}");
    let (twice, said) = area("twice.stl", &[&FACES[..], &FACES[1..3]].concat());
    assert!((twice - once).abs() < 1e-12 && said.contains("2 triangles repeat others"), "{twice} {said}");
    let (sheet, said) = area("sheet.stl", &FACES[..1]);
    assert!((sheet - 0.5).abs() < 1e-12, "{sheet}");
    assert!(said.contains("1 sheet has no thickness") && said.lines().count() == 1, "{said}");
}

/// Texts that are no TOML, and what is said of them: never the words of the reader of TOML.
#[test]
fn broken_texts_are_told_in_the_words_of_their_writer() {
    let solid = "[[solid]]\nshape = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\n";
    let no_value = "this is no value: numbers are written as 2.5 or 1e-3";
    let backslash = "a backslash means something else in double quotes";
    let key = "a key or a name is missing here";
    for (line, said) in [
        ("radius 2", "`=` and a value are missing behind this key"),
        ("name: \"a\"", "between a key and its value stands `=`, not `:`"),
        ("// a remark", "a comment begins with #"),
        ("name = \"a\" // a remark", "a comment begins with #"),
        ("; a remark", "a comment begins with #"),
        ("<<<<<<< HEAD", "this cannot be read: a line is a key with a value"),
        ("}", "this cannot be read: a line is a key with a value"),
        ("]", "this bracket has no partner"),
        ("[solid]]", "solid stands here as [solid] and before in line 1 as [[solid]]"),
        ("[grid]]", "nothing may follow the head of a table on its line but a comment"),
        ("[[solid]", "`]]` is missing"),
        ("[]", key),
        ("[a..b]", key),
        ("= 3", key),
        ("gr\u{f6}sse = 3", "this cannot stand in a key"),
        ("porosity\u{a0}= 1", "this cannot stand in a key"),
        ("porosity = 0,5", "decimals are written with a point"),
        ("drag = { cd = 2, cr = 101325,0 }", "decimals are written with a point"),
        ("porosity = 0.5.5", no_value),
        ("porosity = 1.5e3.2", no_value),
        ("porosity = 50%", no_value),
        ("porosity = 0b12", "this is no number"),
        ("porosity = 0o9", "this is no number"),
        ("porosity = null", no_value),
        ("porosity = Infinity", no_value),
        ("porosity = 1979-13-01", no_value),
        ("porosity = +-1", "a number has one sign at most"),
        ("porosity = 1_", "`_` may only stand between digits"),
        ("porosity = 0x10", "porosity takes a number in decimal digits"),
        ("name = \"a\\q\"", backslash),
        ("name = \"C:\\Users\"", backslash),
        ("name = \"\\U00110000\"", backslash),
        ("name = \"\"\"abc", "has no three at its end"),
        ("name = '''abc", "has no three at its end"),
        ("name = \"a\nb\"", "line 5, column 10: this text has no closing quote"),
        ("translate = [,1, 2, 3]", "one comma is too many in this list"),
        ("translate = [1,, 2, 3]", "one comma is too many in this list"),
        ("translate = [1, 2, 3\nname = 1", "a comma is missing here, or the `]` of the list before"),
        ("translate = (1, 2, 3)", "lists stand in brackets: `[1, 2, 3]`"),
        ("translate = {1, 2, 3}", "lists stand in brackets, `[1, 2, 3]`"),
        ("name = \"a\"\rcd = 1", "lines end in a carriage return alone"),
    ] {
        let at = Scratch::new();
        std::fs::write(at.file("s.toml"), format!("{solid}{line}\n")).expect("a scene");
        let output = voidage(&[&"inspect", &at.file("s.toml")]);
        let told = stderr(&output);
        let first = told.lines().next().unwrap_or("");
        assert!(output.status.code() == Some(1) && first.contains(said), "{line}\n{told}");
        assert!(first.contains("line 5, column ") || first.contains("line 6, column 1:"), "{line}\n{told}");
        for word in ["expected", "invalid", "float", "unquoted", "unicode", "inline", "array"] {
            assert!(!first.contains(word), "{line}\n{told}");
        }
    }
}

/// What a grid gets wrong is told where it stands.
#[test]
fn axes_of_a_grid_are_told_at_their_line() {
    for (x, said) in [
        ("[]", "line 3, column 5: key grid.x: needs at least two edges"),
        (
            "{ points = [4, 0], cells = [2] }",
            "line 3, column 5: key grid.x: points must ascend: 0 does not lie above 4",
        ),
        ("{ points = [0, nan], cells = [2] }", "points must ascend: nan does not lie above 0"),
        (
            "{ points = [0, 1], cells = [-8] }",
            "line 3, column 5: key grid.x: a segment needs at least one cell, not -8",
        ),
    ] {
        let (at, grid) = (Scratch::new(), format!("\n[grid]\nx = {x}\n"));
        let told = stderr(&solve(&at, &[&grid, GAS, INITIAL, WALLS, TIME].concat(), "out", &[]));
        assert!(told.contains(said), "{told}");
    }
    for wrong in ["0", "-10"] {
        let cells = format!("\n[grid]\norigin = [0, 0, 0]\nspacing = [1, 1, 1]\ncells = [10, 10, {wrong}]\n");
        let told = stderr(&solve(&Scratch::new(), &[&cells, GAS, INITIAL, WALLS, TIME].concat(), "out", &[]));
        let said = format!("line 5, column 18: key grid.cells[2]: must be at least 1, not {wrong}");
        assert!(told.contains(&said), "{told}");
    }
}

/// Tables of a list that are one table, as the head of a list has two pairs of brackets.
#[test]
fn one_table_in_place_of_a_list() {
    let patch = "[boundary.patch]\nside = \"x_max\"\ntype = \"wall\"\n";
    let told = stderr(&solve(&Scratch::new(), &[GRID, GAS, INITIAL, WALLS, patch, TIME].concat(), "out", &[]));
    assert!(told.contains("key boundary.patch: takes a list: each of its tables has a head"), "{told}");
    assert!(told.contains("[[boundary.patch]]"), "{told}");
    let probe = "[output]\nprobes = { at = [0, 0, 0] }\n";
    let told = stderr(&solve(&Scratch::new(), &[GRID, GAS, INITIAL, WALLS, TIME, probe].concat(), "out", &[]));
    assert!(told.contains("key output.probes: takes a list, in brackets, not a table"), "{told}");
}

/// Numbers of the command line are told their range in words.
#[test]
fn whole_numbers_of_the_command_line_have_a_range() {
    let sphere = "[[solid]]\nshape = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\n";
    let at = Scratch::new();
    fs::write(at.file("s.toml"), sphere).expect("a scene");
    for (option, value, range) in [
        ("--threads", "0", "from 1 to 1024"),
        ("--threads", "two", "from 1 to 1024"),
        ("--threads", "99999", "from 1 to 1024"),
        ("--depth", "-1", "from 0 to 10"),
        ("--depth", "11", "from 0 to 10"),
    ] {
        let output = run(&at, &["porosity", "s.toml", option, value]);
        let told = stderr(&output);
        assert!(output.status.code() == Some(2), "{told}");
        assert!(told.contains(&format!("needs a whole number {range}")) && !told.contains("digit"), "{told}");
    }
    // The grid around a scene is in round numbers whatever room the box of a round solid has.
    let told = stderr(&run(&at, &["porosity", "s.toml", "--slice", "x=9", "--png", "s.png"]));
    assert!(told.contains("the grid reaches from -1.03125 to 1.03125 along x"), "{told}");
    let told = stderr(&run(&at, &["solve", "."]));
    assert!(told.contains(".: is a directory, not a file"), "{told}");
    let told = stderr(&run(&at, &["solve", "no.toml"]));
    assert!(told.contains("No such file or directory\n"), "{told}");
}

/// JSON where only TOML is read is called by its name.
#[test]
fn json_is_called_by_its_name() {
    let at = Scratch::new();
    std::fs::write(at.file("s.json"), "{\"solid\": []}").expect("a file");
    std::fs::write(at.file("s.toml"), "\n {\"solid\": []}").expect("a file");
    let told = stderr(&voidage(&[&"inspect", &at.file("s.toml")]));
    assert!(told.contains("line 2, column 2: this is JSON; scenes, cases and studies are TOML"), "{told}");
    let told = stderr(&voidage(&[&"solve", &at.file("s.json")]));
    assert!(told.contains("line 1, column 1: this is JSON"), "{told}");
}

/// A run that cannot go on tells its time in few digits.
#[test]
fn small_times_are_short() {
    let at = Scratch::new();
    let case = [GRID, GAS, INITIAL, WALLS, TIME]
        .concat()
        .replace("p = 1 ", "p = 1e30 ")
        .replace("max_steps = 1", "end = 1e-25");
    let said = stdout(&solved(&at, &case, "out", &[]));
    assert!(said.contains("to t = 1e-25 s"), "{said}");
}

/// What stands beside a directory that is to be made is no hindrance, whatever its name; and where a picture is cut is looked at before anything is written.
#[test]
fn outputs_go_where_they_can() {
    let at = Scratch::new();
    at.write("scene.toml", [BOX, GRID].concat().as_bytes());
    fs::create_dir(at.file("voidage")).expect("a directory");
    let output = run(&at, &["porosity", "scene.toml", "--npy", "made/fields", "-q"]);
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(at.file("made/fields/beta_v.npy").exists());
    let arguments = ["porosity", "scene.toml", "--npy", "late", "--png", "late.png", "--slice", "x=99", "-q"];
    fails(&run(&at, &arguments), 2, &["--slice x=99: "]);
    assert!(!at.file("late").exists() && !at.file("late.png").exists());
}

/// A link to a file that is not there yet is followed.
#[cfg(unix)]
#[test]
fn links_to_nothing_are_followed() {
    let at = Scratch::new();
    at.write("scene.toml", [BOX, GRID].concat().as_bytes());
    fs::create_dir(at.file("there")).expect("a directory");
    std::os::unix::fs::symlink("there/report.json", at.file("link.json")).expect("a link");
    let output = run(&at, &["porosity", "scene.toml", "--report", "link.json", "-q"]);
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(at.file("there/report.json").is_file());
    assert!(fs::symlink_metadata(at.file("link.json")).expect("the link").is_symlink());
}

/// An inlet whose gas has no way out does not meet its velocity, and says so.
#[test]
fn an_inlet_without_a_way_out_says_so() {
    let at = Scratch::new();
    let grid = "[grid]\nx = { points = [0, 1], cells = [10] }\n";
    let gas = "[initial]\nuniform = { rho = 1.2, p = 1e5 }\n[time]\nend = 0.2\n";
    let run = |x_max: &str| {
        let sides = format!("[boundary]\nx_min = {{ type = \"inlet\", rho = 1.2, u = 50 }}\nx_max = {x_max}\n");
        let output = solve(&at, &[grid, GAS, gas, &sides].concat(), "out", &["--force"]);
        assert!(output.status.success(), "{}", stderr(&output));
        stderr(&output)
    };
    let said = run("\"wall\"");
    assert!(said.contains("boundary.x_min: the gas enters at ") && said.contains("has no way out"), "{said}");
    let said = run("{ type = \"outlet\", p = 1e5 }");
    assert!(!said.contains("has no way out"), "{said}");
}
