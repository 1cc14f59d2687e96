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
    assert_eq!(markdown.lines().filter(|l| l.starts_with("| ")).count(), rows.len() + 2, "{markdown}");
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
fn wrong_cases_say_where() {
    let dir = Scratch::new();
    fs::write(dir.file("scene.toml"), "").expect("written");
    let case = dir.file("case.toml");
    let changed = [
        ("threads = [1, 2]", "threads = []", "at least one threads"),
        ("threads = [1, 2]", "threads = [0]", "line 4, column 11: threads [0] must be at least 1"),
        ("threads = [1, 2]", "threads = [99999]", "at most 1024"),
        ("repeats = 1", "repeat = 1", "line 3, column 1: key repeat is not known here; did you mean repeats?"),
        ("method = \"surface\"", "method = \"magic\"", "\"magic\" is not known: auto, surface, gjk"),
        ("exact = 0.064", "exact = nan", "exact takes a finite number"),
        ("exact = 0.064", "probe = { cell = [1, 1, 2], beta_v = 1 }", "outside of the grid 2x2x2"),
        ("exact = 0.064", "probe = { cell = [1, 1, -2], beta_v = 1 }", "cell [2] takes a whole number"),
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
    for name in ["cube_positions.toml", "shapes.toml", "spheres.toml", "platform.toml"] {
        let case = voidage::command::study::case::read(&example(name)).unwrap_or_else(|e| panic!("{e}"));
        for subject in &case.subjects {
            let mut quiet = Progress::new(&TalkArgs { quiet: true, verbose: false });
            let bodies = voidage::command::study::measure::bodies(&example(name), subject, &mut quiet);
            let bodies = bodies.unwrap_or_else(|e| panic!("{e}"));
            assert!(!bodies.bodies.is_empty() && bodies.warnings.is_empty(), "{:?}", bodies.warnings);
        }
    }
}
