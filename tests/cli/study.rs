//! `voidage study`.

use crate::kit::{Scratch, stderr, stdout, voidage};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use voidage::command::cli::TalkArgs;
use voidage::command::progress::Progress;

fn example(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/study").join(name)
}

type Row = BTreeMap<String, String>;

/// The rows of a study, each as a map from column to text.
fn rows(case: &Path) -> Vec<Row> {
    let dir = Scratch::new();
    let out = dir.file("out");
    let output = voidage(&[&"study", &case, &"-q", &"-o", &out]);
    assert!(output.status.success(), "{}", stderr(&output));
    let text = fs::read_to_string(out.join("study.csv")).expect("a table");
    let markdown = fs::read_to_string(out.join("study.md")).expect("a table");
    assert_eq!(&fs::read(out.join("study.png")).expect("a picture")[1..4], b"PNG");
    let mut lines = text.lines().map(cells);
    let head = lines.next().expect("names of columns");
    let rows: Vec<Row> = lines.map(|line| head.iter().cloned().zip(line).collect()).collect();
    let (_, points) = markdown.split_once("## All points").expect("a table of all points");
    assert_eq!(points.lines().filter(|l| l.starts_with("| ")).count(), rows.len() + 2, "{markdown}");
    rows
}

/// The cells of a line of CSV.
fn cells(line: &str) -> Vec<String> {
    let (mut cells, mut quoted) = (vec![String::new()], false);
    for c in line.chars() {
        match c {
            '"' => quoted = !quoted,
            ',' if !quoted => cells.push(String::new()),
            c => cells.last_mut().expect("one at least").push(c),
        }
    }
    cells
}

fn number(row: &Row, column: &str) -> f64 {
    row[column].parse().unwrap_or_else(|_| panic!("{column}: {row:?}"))
}

/// The paper's Fig. 4: by every method each probe is what counting says, except where a leaf counts too much.
#[test]
fn cube_positions() {
    let rows = rows(&example("cube_positions.toml"));
    assert_eq!(rows.len(), 4 * 4);
    for row in &rows {
        assert!((number(row, "beta_v") - number(row, "beta_v_exact")).abs() < 1e-9, "{row:?}");
        assert!(number(row, "error").abs() < 1e-9, "{row:?}");
        assert!(number(row, "seconds") >= number(row, "fastest"), "{row:?}");
    }
}

const CASE: &str = r#"
title = "Two bricks, a pipe | and a \"name, with marks\""
repeats = 1
threads = [1, 2]
[[scene]]
name = "bricks, two"
[[scene.solid]]
name = "brick"
shape = "box"
min = [0.05, 0.05, 0.05]
max = [0.45, 0.45, 0.45]
array = { count = [2, 1, 1], step = [0.2, 0.2, 0.2] }
[[scene]]
name = "from a file"
files = ["scene.toml"]
exact = 0.064
[[grid]]
origin = [0, 0, 0]
spacing = [0.1, 0.1, 0.1]
cells = [10, 10, 10]
[[grid]]
x = [0, 0.5, 1]
y = [0, 0.5, 1]
z = [0, 0.5, 1]
[[method]]
name = "surface"
method = "surface"
[[method]]
name = "auto"
"#;

#[test]
fn every_scene_grid_method_and_number_of_threads_is_a_row() {
    let dir = Scratch::new();
    let brick = "[[solid]]\nname = \"b\"\nshape = \"box\"\nmin = [0.1, 0.1, 0.1]\nmax = [0.5, 0.5, 0.5]\n";
    fs::write(dir.file("scene.toml"), brick).expect("written");
    let case = dir.file("case.toml");
    fs::write(&case, CASE).expect("written");
    let rows = rows(&case);
    assert_eq!(rows.len(), 2 * 2 * 2 * 2);
    // Two cubes of 0.4 that share 0.2 × 0.4 × 0.4.
    let expected = |scene: &str| if scene == "from a file" { 0.064 } else { 2.0 * 0.064 - 0.032 };
    for row in &rows {
        assert!((number(row, "solid_volume") - expected(&row["scene"])).abs() < 1e-12, "{row:?}");
        assert!(number(row, "error").abs() < 1e-12 && number(row, "cell_error") < 1e-12, "{row:?}");
    }
    assert_eq!(rows.iter().filter(|r| r["threads"] == "2" && r["cells"] == "2x2x2").count(), 4);
    let printed = stdout(&voidage(&[&"study", &case, &"-q"]));
    assert!(
        printed.starts_with("# Two bricks, a pipe") && printed.contains("| bricks, two | 2 | 10x10x10 |"),
        "{printed}"
    );
}

#[test]
fn an_exact_volume_that_the_scene_does_not_hold_is_told_once() {
    let dir = Scratch::new();
    let brick = "[[solid]]\nname = \"b\"\nshape = \"box\"\nmin = [0.1, 0.1, 0.1]\nmax = [0.5, 0.5, 0.5]\n";
    fs::write(dir.file("scene.toml"), brick).expect("written");
    let case = dir.file("case.toml");
    let told = |exact: &str| {
        fs::write(&case, CASE.replace("exact = 0.064", &format!("exact = {exact}"))).expect("written");
        let said = stderr(&voidage(&[&"study", &case]));
        said.matches("but the scene holds 0.064").count()
    };
    assert_eq!([told("0.064"), told("0.0640000000000001"), told("0.06400001"), told("0.05")], [0, 0, 1, 1]);
}

#[test]
fn wrong_cases_say_where() {
    let dir = Scratch::new();
    fs::write(dir.file("scene.toml"), "").expect("written");
    let case = dir.file("case.toml");
    let changed = [
        ("threads = [1, 2]", "threads = []", "threads is an empty list"),
        ("threads = [1, 2]", "threads = [0]", "line 4, column 12: threads[0] must be at least 1"),
        ("threads = [1, 2]", "threads = [99999]", "at most 1024"),
        ("repeats = 1", "repeat = 1", "line 3, column 1: key repeat is not known here; did you mean repeats?"),
        ("method = \"surface\"", "method = \"magic\"", "\"magic\" is not known: auto, surface, gjk"),
        ("exact = 0.064", "exact = nan", "exact takes a number within ±1e30, not nan"),
        (
            "exact = 0.064",
            "probe = { cell = [1, 1, 2], beta_v = 1 }",
            "probe: cell is no cell of the grid 2x2x2; cells are counted from 0",
        ),
        (
            "exact = 0.064",
            "probe = { cell = [1, 1, -2], beta_v = 1 }",
            "cell[2] takes a whole number from 0 on, not -2",
        ),
        ("name = \"auto\"", "name = \"surface\"", "column 8: method 2: name is that of another table before"),
        ("files = [\"scene.toml\"]", "files = [\"absent.toml\"]", "absent.toml: cannot open"),
        ("files = [\"scene.toml\"]", "", "needs files or [[scene.solid]]"),
        ("shape = \"box\"", "shape = \"bix\"", "line 9, column 9: solid \"brick\": shape \"bix\" is not known"),
        ("z = [0, 0.5, 1]", "z = [0, 0.5, 0.5]", "z[2]"),
    ];
    for (from, to, words) in changed {
        let text = CASE.replacen(from, to, 1);
        assert_ne!(text, CASE);
        fs::write(&case, text).expect("written");
        let out = dir.file("out");
        let output = voidage(&[&"study", &case, &"-o", &out]);
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{to}: {said}");
        assert!(said.contains(words) && said.contains(".toml: "), "{words}: {said}");
        assert!(!out.exists(), "{to}");
    }
}

/// The larger examples are too slow for every run of the tests; they must at least be read.
#[test]
fn examples_are_read() {
    let names =
        ["cube_positions", "shapes", "spheres", "platform", "skid", "solids", "unions", "precision", "flow", "growth"];
    for name in names.map(|name| format!("{name}.toml")) {
        let name = &name[..];
        let text = fs::read_to_string(example(name)).expect("a study");
        let case = voidage::command::study::case::parse(&example(name), &text).unwrap_or_else(|e| panic!("{e}"));
        for subject in &case.subjects {
            let mut quiet = Progress::new(&TalkArgs { quiet: true, verbose: false });
            let bodies = voidage::command::study::measure::bodies(&example(name), subject, &mut quiet);
            let bodies = bodies.unwrap_or_else(|e| panic!("{e}"));
            assert!(!bodies.bodies.is_empty() && bodies.warnings.is_empty(), "{:?}", bodies.warnings);
        }
    }
}

const LISTS: &str = r#"
title = "Lists"
repeats = 3
refine = [1, 2]
[[scene]]
name = "ball"
exact = 0.5235987755982988
[[scene.solid]]
shape = "sphere"
center = [0.5, 0.5, 0.5]
radius = 0.5
[[grid]]
origin = [-0.1, -0.1, -0.1]
spacing = [0.3, 0.3, 0.3]
cells = [4, 4, 4]
[[method]]
name = "exact"
precision = ["f64", "f32"]
[[method]]
name = "gjk"
method = "gjk"
leaf = ["solid", "half"]
depth = [1, 2, 3]
"#;

/// Lists multiply out; a finer depth errs less; the paper's point is named; single precision errs by its rounding.
#[test]
fn lists_multiply_out_and_errors_are_told() {
    let dir = Scratch::new();
    let case = dir.file("case.toml");
    fs::write(&case, LISTS).expect("written");
    let rows = rows(&case);
    assert_eq!(rows.len(), 2 * (2 + 2 * 3));
    let find = |method: &str, cells: &str| {
        let found = rows.iter().find(|r| r["method"] == method && r["cells"] == cells);
        found.unwrap_or_else(|| panic!("{method} on {cells}"))
    };
    for cells in ["4x4x4", "8x8x8"] {
        assert!(number(find("exact, f64", cells), "error").abs() < 1e-13);
        assert_eq!(find("exact, f64", cells)["cells_from"], "auto (itself)");
        let single = find("exact, f32", cells);
        let (error, cell) = (number(single, "error").abs(), number(single, "cell_error"));
        assert!(0.0 < error && error < 1e-5 && 0.0 < cell && cell < 1e-3, "{single:?}");
        let errors = [1, 2, 3].map(|depth| number(find(&format!("gjk, solid leaf, depth {depth}"), cells), "error"));
        assert!(errors[0] > errors[1] && errors[1] > errors[2] && errors[2] > 0.02, "{errors:?}");
        assert_eq!(find("gjk, solid leaf, depth 3", cells)["paper"], "true");
        assert_eq!(find("gjk, half leaf, depth 3", cells)["paper"], "false");
    }
    assert!(rows.iter().any(|r| r["front"] == "true"));
    for row in &rows {
        let times = ["fastest", "seconds", "slowest"].map(|c| number(row, c));
        assert!(times[0] <= times[1] && times[1] <= times[2], "{row:?}");
        assert!(number(row, "cell_error") >= number(row, "cell_error_mean"), "{row:?}");
        assert!(number(row, "face_error") >= number(row, "face_error_mean"), "{row:?}");
        assert_eq!(number(row, "uncertainty"), 0.0);
    }
}

/// What is finished is kept; another case begins anew where the one before was not finished, `--force` always.
#[test]
fn an_interrupted_study_goes_on() {
    let dir = Scratch::new();
    let (case, out) = (dir.file("case.toml"), dir.file("out"));
    fs::write(&case, LISTS).expect("written");
    let run = |more: &[&str]| {
        let mut all: Vec<&dyn AsRef<std::ffi::OsStr>> = vec![&"study", &case, &"-o", &out];
        all.extend(more.iter().map(|m| m as &dyn AsRef<std::ffi::OsStr>));
        let output = voidage(&all);
        assert!(output.status.success(), "{}", stderr(&output));
        (stdout(&output), stderr(&output))
    };
    let all = run(&[]).0;
    assert!(all.contains("[1/16") && all.contains("[16/16]"), "{all}");
    let whole = fs::read(out.join("study.csv")).expect("a table");
    // As if it had been stopped while the sixth point was written.
    let points = fs::read_to_string(out.join("points.jsonl")).expect("points");
    let lines: Vec<&str> = points.lines().collect();
    assert_eq!(lines.len(), 17);
    fs::write(out.join("points.jsonl"), format!("{}\n{}", lines[..6].join("\n"), &lines[6][..40])).expect("written");
    let rest = run(&[]).0;
    assert!(rest.contains("5 points are kept from before") && rest.contains("[6/16"), "{rest}");
    assert!(!rest.contains("[5/16"), "{rest}");
    let again = run(&[]).0;
    assert!(again.contains("16 points are kept") && !again.contains("/16"), "{again}");
    // The first five points are those of the first run, to the last digit of their times.
    let now = fs::read(out.join("study.csv")).expect("a table");
    let text = |bytes: &[u8]| {
        String::from_utf8_lossy(bytes)
            .lines()
            .take(6)
            .map(|l| l.rsplit_once(',').expect("a row").0.to_owned())
            .collect::<Vec<_>>()
    };
    assert_eq!(text(&whole), text(&now));
    assert!(run(&["--force"]).0.contains("[1/16"));
    fs::write(&case, LISTS.replace("repeats = 3", "repeats = 2")).expect("written");
    // As if the one before had not come to its end.
    let unfinish = || fs::remove_file(out.join("study.json")).expect("a report");
    unfinish();
    let (said, warned) = run(&[]);
    assert!(said.contains("[1/16") && warned.contains("of another case"), "{said}{warned}");
    unfinish();
    let (said, warned) = run(&["--quick"]);
    assert!(said.contains("[1/16") && warned.contains("--quick"), "{said}{warned}");
    assert_eq!(voidage(&[&"study", &case, &"--force"]).status.code(), Some(2));
}

/// Of a finished study nothing is replaced by another one, unless that is asked for; the same one may be run again.
#[test]
fn a_finished_study_is_not_replaced() {
    let dir = Scratch::new();
    let (case, out) = (dir.file("case.toml"), dir.file("out"));
    let run = |text: &str, more: &[&str]| {
        fs::write(&case, text).expect("written");
        let mut all: Vec<&dyn AsRef<std::ffi::OsStr>> = vec![&"study", &case, &"-q", &"-o", &out];
        all.extend(more.iter().map(|m| m as &dyn AsRef<std::ffi::OsStr>));
        voidage(&all)
    };
    assert!(run(LISTS, &["--quick"]).status.success());
    let tables = || ["study.csv", "study.md", "points.jsonl"].map(|name| fs::read(out.join(name)).expect("a file"));
    let before = tables();
    for (text, more) in [(LISTS.replace("repeats = 3", "repeats = 2"), &["--quick"][..]), (LISTS.to_owned(), &[])] {
        let refused = run(&text, more);
        let said = stderr(&refused);
        assert_eq!(refused.status.code(), Some(1), "{said}");
        assert!(
            said.contains("out: holds a finished study of another case") && said.contains("--force replaces it"),
            "{said}"
        );
    }
    assert!(before == tables());
    assert!(run(LISTS, &["--quick"]).status.success());
    assert!(before[2] == tables()[2]);
    let old = ["study_flows.csv", "study_left_out.csv", "study_scaling.svg", "study_flows.png"];
    old.iter().chain(&["mine.csv"]).for_each(|name| fs::write(out.join(name), "old").expect("written"));
    assert!(run(LISTS, &["--force"]).status.success());
    assert!(before[2] != tables()[2]);
    // What the study before has left would speak for this one; what is not of a study stays.
    assert!(
        old.iter().all(|name| !out.join(name).exists())
            && out.join("mine.csv").exists()
            && out.join("study.svg").exists()
    );
    // One of which everything is left out has no points, and is known again.
    let nothing = "title = \"none\"\nareas = false\n[[scene]]\nname = \"ring\"\n[[scene.solid]]\nshape = \"torus\"\ncenter = [0.5, 0.5, 0.5]\n\
        axis = [0, 0, 1]\nradius = 0.3\ntube = 0.1\n[[grid]]\norigin = [0, 0, 0]\nspacing = [0.1, 0.1, 0.1]\ncells = [10, 10, 10]\n\
        [[method]]\nname = \"leaf\"\nmethod = \"gjk\"\nleaf = \"plane\"\n";
    for more in [&["--force"][..], &[]] {
        let output = run(nothing, more);
        assert!(output.status.success(), "{}", stderr(&output));
        let points = fs::read_to_string(out.join("points.jsonl")).expect("a file");
        assert!(points.lines().count() == 1 && !out.join("study.csv").exists() && !out.join("study.svg").exists());
    }
}

/// Pictures have all panels, the floor and the legend; as SVG they are text that can be searched.
#[test]
fn pictures_say_what_they_show() {
    let dir = Scratch::new();
    let (case, out) = (dir.file("case.toml"), dir.file("out"));
    fs::write(&case, LISTS).expect("written");
    let output = voidage(&[&"study", &case, &"-q", &"-o", &out]);
    assert!(output.status.success(), "{}", stderr(&output));
    for name in ["study.svg", "study_cells.svg"] {
        let svg = fs::read_to_string(out.join(name)).expect("a picture");
        for words in
            ["ball", "gjk, solid leaf", "the paper&#39;s leaf", "exact to rounding", "run time, s", "slopes", "≤ 1e−13"]
        {
            assert!(svg.contains(&words.replace("&#39;", "'")), "{name} lacks {words}");
        }
        assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n") && !svg.contains("NaN") && !svg.contains("inf"));
    }
    assert!(fs::read_to_string(out.join("study.svg")).expect("a picture").contains("Pareto front"));
}

/// Tolerances and depths of one method share its colour; a tint of its own tells each, in the legend and in the picture. What a method cannot
/// measure is said on the page.
#[test]
fn tints_tell_tolerances_and_depths_apart() {
    let dir = Scratch::new();
    let (case, out) = (dir.file("case.toml"), dir.file("out"));
    let hollow =
        "[[scene.solid]]\nshape = \"torus\"\ncenter = [0.5, 0.5, 0.5]\naxis = \"z\"\nradius = 0.3\ntube = 0.1\n";
    let text = "repeats = 1\nrefine = [1, 2]\n[[scene]]\nname = \"ball\"\n[[scene.solid]]\nshape = \"sphere\"\ncenter = [0.5, 0.5, 0.5]\nradius = 0.4\n\
        [[grid]]\norigin = [0, 0, 0]\nspacing = [0.25, 0.25, 0.25]\ncells = [4, 4, 4]\n\
        [[method]]\nname = \"planes\"\nmethod = \"gjk\"\ntol = [1e-1, 1e-2, 1e-3]\n\
        [[method]]\nname = \"leaves\"\nmethod = \"gjk\"\nleaf = \"solid\"\ndepth = [1, 2]\n\
        [[method]]\nname = \"alone\"\n";
    fs::write(&case, format!("{text}[[scene]]\nname = \"ring\"\n{hollow}")).expect("written");
    let output = voidage(&[&"study", &case, &"-q", &"-o", &out]);
    assert!(output.status.success(), "{}", stderr(&output));
    let svg = fs::read_to_string(out.join("study.svg")).expect("a picture");
    for words in [">planes<", ">leaves<", ">alone<", ">tol 1e-1<", ">tol 1e-2<", ">tol 1e-3<", ">depth 1<", ">depth 2<"]
    {
        assert!(svg.contains(words), "{words}: {svg}");
    }
    // Within the rim of the colour of "planes": white, half and half, the colour itself.
    for (colour, tint) in
        [("the coarsest", "fill=\"#ffffff\""), ("between", "fill=\"#90aac9\""), ("the finest", "fill=\"#205493\"")]
    {
        assert!(svg.matches(tint).count() > 1, "{colour}: {svg}");
    }
    let left_out = "ring: method \"planes, tol 1e-1\" is left out: ";
    for (name, heading) in [("study.html", "<h2>What is not here</h2>"), ("study.md", "## What is not here\n")] {
        let page = fs::read_to_string(out.join(name)).expect("a page").replace("&quot;", "\"").replace("&#34;", "\"");
        assert!(page.contains(heading) && page.matches(left_out).count() == 1, "{page}");
    }
    // A study that lacks nothing says nothing of the kind.
    fs::write(&case, text.replace("\"gjk\"", "\"auto\"").replace("leaf = \"solid\"\n", "")).expect("written");
    let output = voidage(&[&"study", &case, &"-q", &"-o", &out, &"--force"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let page = fs::read_to_string(out.join("study.md")).expect("a page");
    assert!(!page.contains("What is not here"), "{page}");
}

const FLOWS: &str = r#"
title = "Flows & more"
note = "What <readers> should know."
repeats = 1
left_out = true
[[flow]]
name = "tube"
problem = "sod"
cells = [50, 100, 200]
order = [1, 2]
[[flow]]
problem = "slab"
cells = 20
[[flow]]
problem = "inclined-wall"
cells = [16, 24]
precision = ["f64", "f32"]
[[flow]]
problem = "nozzle"
cells = [20, 40]
[[flow]]
problem = "vortex"
cells = [16, 32]
[[scaling]]
name = "balls"
along = "overlaps"
counts = [2, 8, 27]
"#;

fn table(path: &Path) -> Vec<Row> {
    let text = fs::read_to_string(path).expect("a table");
    let mut lines = text.lines().map(cells);
    let head = lines.next().expect("names of columns");
    lines.map(|line| head.iter().cloned().zip(line).collect()).collect()
}

/// The time of a run of microseconds is noise: it is run more often than asked for, in a quick look as well.
#[test]
fn short_flows_are_run_until_their_time_counts() {
    let dir = Scratch::new();
    let (case, out) = (dir.file("case.toml"), dir.file("out"));
    fs::write(&case, "[[flow]]\nproblem = \"sod\"\ncells = [50, 100]\n").expect("written");
    let output = voidage(&[&"study", &case, &"--quick", &"-q", &"-o", &out]);
    assert!(output.status.success(), "{}", stderr(&output));
    for row in table(&out.join("study_flows.csv")) {
        let of = |column: &str| row[column].parse::<f64>().expect("a number");
        let enough = of("repeats") * of("slowest") >= 0.02;
        assert!(of("repeats") == 100.0 || enough, "{row:?}");
        assert!(of("fastest") <= of("seconds") && of("seconds") <= of("slowest"), "{row:?}");
    }
    let page = fs::read_to_string(out.join("study.md")).expect("a page");
    assert!(page.contains("of short flows as many as take 0.02 s"), "{page}");
}

/// Flows have the orders that theory says, what is exact stays so, and all of it stands in one page.
#[test]
fn flows_and_growing_scenes() {
    let dir = Scratch::new();
    let (case, out) = (dir.file("case.toml"), dir.file("out"));
    fs::write(&case, FLOWS).expect("written");
    let output = voidage(&[&"study", &case, &"-q", &"-o", &out]);
    assert!(output.status.success() && output.stderr.is_empty(), "{}", stderr(&output));
    let report = crate::kit::json(&out.join("study.json"));
    let order = |flow: &str| {
        let all = report["orders"].as_array().expect("orders");
        all.iter().find(|o| o["flow"] == flow).unwrap_or_else(|| panic!("{flow}"))["order"].as_f64().expect("a number")
    };
    // A contact converges with 1/2 at first order, shocks with 1.
    assert!((0.5..0.8).contains(&order("tube, order 1")), "{}", order("tube, order 1"));
    assert!((0.8..1.15).contains(&order("tube, order 2")), "{}", order("tube, order 2"));
    assert!(order("nozzle") > 1.8, "{}", order("nozzle"));
    assert!(order("vortex") > 1.0, "{}", order("vortex"));
    let flows = table(&out.join("study_flows.csv"));
    assert_eq!(flows.len(), 6 + 1 + 4 + 2 + 2);
    for row in &flows {
        let (error, single) = (number(row, "error"), row["precision"] == "f32");
        match &row["problem"][..] {
            "slab" | "inclined-wall" if !single => assert!(error < 1e-9, "{row:?}"),
            "inclined-wall" => assert!(error > 1e-9 && error < 2e-3, "{row:?}"),
            _ => assert!(error > 0.0 && error < 0.1, "{row:?}"),
        }
    }
    let grown = table(&out.join("study_scaling.csv"));
    let pairs: Vec<&str> = grown.iter().map(|r| &r["count"][..]).collect();
    assert_eq!(pairs, ["1", "12", "54"]);
    assert_eq!(grown.iter().map(|r| &r["bodies"][..]).collect::<Vec<_>>(), ["2", "8", "27"]);
    assert_eq!(table(&out.join("study_left_out.csv")).len(), 4);
    let page = fs::read_to_string(out.join("study.html")).expect("a page");
    assert!(page.starts_with("<!doctype html>") && page.ends_with("</body></html>\n"));
    for words in [
        "Flows &amp; more",
        "What &lt;readers&gt; should know.",
        "Orders of convergence",
        "Left out",
        "<svg ",
        "Exact to rounding on every grid",
    ] {
        assert!(page.contains(words), "{words}");
    }
    // It needs no other file.
    for word in ["<script", "<link", "src=", "href=", "url("] {
        assert!(!page.contains(word), "{word}");
    }
    assert!(out.join("study_flows.png").exists() && out.join("study_scaling.svg").exists());
}

#[test]
fn wrong_flows_say_where() {
    let dir = Scratch::new();
    let case = dir.file("case.toml");
    let changed = [
        ("problem = \"slab\"", "problem = \"slap\"", "sod, shu-osher, vortex, slab, nozzle, inclined-wall"),
        ("cells = 20", "cells = 3", "must be from 4 to 100000, not 3"),
        ("order = [1, 2]", "order = [1, 3]", "order[1] must be 1 or 2, not 3"),
        ("along = \"overlaps\"", "along = \"sides\"", "cells, triangles, bodies, overlaps, threads"),
        ("counts = [2, 8, 27]", "counts = []", "counts is an empty list"),
        ("counts = [2, 8, 27]", "counts = [200000]", "must be at most 100000"),
        ("[[scaling]]", "[[grid]]\nx = [0, 1]\ny = [0, 1]\nz = [0, 1]\n[[scaling]]", "at least one scene"),
    ];
    for (from, to, words) in changed {
        let text = FLOWS.replacen(from, to, 1);
        assert_ne!(text, FLOWS);
        fs::write(&case, text).expect("written");
        let output = voidage(&[&"study", &case]);
        assert_eq!(output.status.code(), Some(1), "{to}");
        assert!(stderr(&output).contains(words), "{words}: {}", stderr(&output));
    }
}

/// A study of one solid on two grids that have as many cells, and whose geometry is a file that a solid names.
#[test]
fn grids_of_as_many_cells_and_files_of_solids_are_told_apart() {
    let dir = Scratch::new();
    let surface = |size: f64| {
        let corners = |n: usize| [0, 1, 2].map(|axis| if n >> axis & 1 == 1 { size } else { 0.0 });
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let points: String = (0..8).map(corners).map(|[x, y, z]| format!("v {x} {y} {z}\n")).collect();
        let faces: String =
            faces.map(|f| f.map(|n| (n + 1).to_string()).join(" ")).map(|f| format!("f {f}\n")).concat();
        points + &faces
    };
    let grid = |size: f64| {
        let axis = format!("{{ points = [0, {size}], cells = [4] }}");
        format!("[[grid]]\nx = {axis}\ny = {axis}\nz = {axis}\n")
    };
    let scene = "repeats = 1\nthreads = [1]\n[[scene]]\nname = \"block\"\n[[scene.solid]]\nshape = \"file\"\npath = \"block.obj\"\n";
    let case = [scene, "[[method]]\nname = \"exact\"\n", &grid(2.0), &grid(0.5)].concat();
    let case = dir.write("case.toml", case.as_bytes());
    let out = dir.file("out");
    let study = || {
        let output = voidage(&[&"study", &case, &"-o", &out]);
        assert!(output.status.success(), "{}", stderr(&output));
        let text = fs::read_to_string(out.join("study.csv")).expect("a table");
        let mut lines = text.lines().map(cells);
        let head = lines.next().expect("names of columns");
        let rows: Vec<Row> = lines.map(|line| head.iter().cloned().zip(line).collect()).collect();
        let told = rows.iter().map(|row| (row["cells"].clone(), number(row, "solid_volume"))).collect::<Vec<_>>();
        (told, stdout(&output) + &stderr(&output))
    };
    dir.write("block.obj", surface(1.0).as_bytes());
    let wanted = |large: f64, small: f64| vec![("4x4x4".to_owned(), large), ("4x4x4 (2)".to_owned(), small)];
    assert_eq!(study().0, wanted(1.0, 0.125));
    let (again, said) = study();
    assert_eq!(again, wanted(1.0, 0.125));
    assert!(said.contains("2 points are kept from before"), "{said}");
    dir.write("block.obj", surface(0.25).as_bytes());
    let refused = stderr(&voidage(&[&"study", &case, &"-o", &out]));
    assert!(refused.contains("holds a finished study of another case, another geometry"), "{refused}");
    // As if the one before had not come to its end.
    fs::remove_file(out.join("study.json")).expect("a report");
    let (changed, said) = study();
    assert_eq!(changed, wanted(0.015625, 0.015625));
    assert!(said.contains("all is measured anew"), "{said}");
}

/// What would change nothing is refused; on a single grid there are no orders.
#[test]
fn keys_without_effect_are_refused() {
    let dir = Scratch::new();
    let case = dir.file("case.toml");
    let ball = "[[scene]]\nname = \"ball\"\n[[scene.solid]]\nshape = \"sphere\"\ncenter = [0.5, 0.5, 0.5]\nradius = 0.4\n\
        [[grid]]\norigin = [0, 0, 0]\nspacing = [0.25, 0.25, 0.25]\ncells = [4, 4, 4]\n";
    let sod = "[[flow]]\nproblem = \"sod\"\ncells = 20\norder = 1\nlimiter = \"mc\"\n";
    for (keys, words) in [
        (format!("{ball}[[method]]\nleaf = \"half\"\n"), "leaf has no effect: it is of the method gjk"),
        (sod.to_owned(), "limiter has no effect: order 1 has no slopes to limit"),
    ] {
        fs::write(&case, format!("repeats = 1\n{keys}")).expect("written");
        let output = voidage(&[&"study", &case]);
        assert!(!output.status.success() && stderr(&output).contains(words), "{keys}: {}", stderr(&output));
    }
    fs::write(&case, format!("repeats = 1\n{}", sod.replace("limiter = \"mc\"\n", ""))).expect("written");
    let output = voidage(&[&"study", &case]);
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(!stdout(&output).contains("Orders of convergence"), "of a single grid: {}", stdout(&output));
}
