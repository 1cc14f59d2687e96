//! The pages of keys in `docs` and the parser say the same: each key of a file stands in a table and in an example, and no other does.

use crate::kit::trace::tables;
use crate::kit::{Scratch, solve, stderr, voidage};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use voidage::command::solve::case::Case;
use voidage::geometry::scene::shape::{EVERY, SHAPES};
use voidage::grid::file::{GridTable, Segments};

/// A page of `docs`.
pub fn page(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs").join(name);
    fs::read_to_string(path).expect("a page")
}

/// Rows of the tables of a page by the names in the comment `<!-- WHAT: name name -->` above each: first cell, whole row.
pub fn rows(text: &str, what: &str) -> BTreeMap<String, BTreeMap<String, String>> {
    let mut found: BTreeMap<String, BTreeMap<String, String>> = BTreeMap::new();
    let mark = format!("<!-- {what}: ");
    for part in text.split(&mark).skip(1) {
        let (names, rest) = part.split_once(" -->").expect("an end of the comment");
        let lines = rest.lines().skip_while(|l| !l.starts_with('|')).take_while(|l| l.starts_with('|'));
        let rows: BTreeMap<String, String> = lines.skip(2).map(row).collect();
        for name in names.split(' ') {
            assert!(found.insert(name.to_owned(), rows.clone()).is_none(), "{name} has two tables");
        }
    }
    found
}

/// The name in the first cell of a row, and the row.
fn row(line: &str) -> (String, String) {
    let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
    assert!(cells.iter().all(|c| !c.is_empty()), "an empty cell: {line}");
    (cells[0].trim_matches('`').to_owned(), line.to_owned())
}

/// Blocks of a page by their language: `toml scene`.
fn examples(text: &str, language: &str) -> Vec<String> {
    let begin = format!("```{language}\n");
    text.split(&begin).skip(1).map(|part| part.split("```").next().unwrap_or("").to_owned()).collect()
}

/// The keys that tables of a page name are `keys`, and words that a key may hold stand in its row.
fn assert_documented(page: &str, prefix: &str, keys: &BTreeMap<String, BTreeMap<String, Vec<&'static str>>>) {
    let tables = rows(page, "keys");
    let own: BTreeSet<&String> =
        tables.keys().filter(|t| *t == prefix || t.starts_with(&format!("{prefix}."))).collect();
    assert_eq!(own, keys.keys().collect(), "tables of {prefix}");
    for (table, keys) in keys {
        let rows = &tables[table];
        assert_eq!(rows.keys().collect::<BTreeSet<_>>(), keys.keys().collect(), "keys of {table}");
        for (key, words) in keys {
            for word in words {
                assert!(rows[key].contains(&format!("`{word}`")), "{table}.{key} does not name {word}");
            }
        }
    }
}

/// Every key of the tables of a page stands in one of its examples.
fn assert_shown(page: &str) {
    let blocks: String = page.split("```toml").skip(1).filter_map(|part| part.split("```").next()).collect();
    let words: BTreeSet<&str> = blocks.split(|c: char| !(c.is_alphanumeric() || c == '_')).collect();
    for (table, keys) in rows(page, "keys") {
        for key in keys.keys() {
            assert!(words.contains(&key[..]), "{table}.{key} stands in no example");
        }
    }
}

#[test]
fn keys_of_cases() {
    let mut found = tables::<Case>("case");
    found.retain(|table, _| table != "case.grid");
    assert_documented(&page("case.md"), "case", &found);
    assert_shown(&page("case.md"));
}

#[test]
fn keys_of_grids() {
    let mut found = tables::<GridTable>("grid");
    found.extend(tables::<Segments>("grid.x"));
    assert_documented(&page("grid.md"), "grid", &found);
    assert_shown(&page("grid.md"));
}

/// The keys that the reader of a file knows at the place of the key `zzz`: the message about it lists them.
fn known(command: &str, text: &str) -> BTreeSet<String> {
    let at = Scratch::new();
    let file = at.file("file.toml");
    fs::write(&file, text).expect("written");
    let said = stderr(&voidage(&[&command, &file]));
    let list = said.split_once("(known: ").and_then(|(_, rest)| rest.split_once(')')).map(|(list, _)| list);
    list.unwrap_or_else(|| panic!("no list of keys: {said}")).split(", ").map(str::to_owned).collect()
}

fn names(keys: &BTreeMap<String, String>) -> BTreeSet<String> {
    keys.keys().cloned().collect()
}

#[test]
fn keys_of_scenes() {
    let page = page("scene.md");
    let tables = rows(&page, "keys");
    assert_eq!(names(&tables["scene"]), known("inspect", "zzz = 1"));
    assert_eq!(names(&tables["solid"]), EVERY.iter().map(|k| (*k).to_owned()).collect());
    let solid = "[[solid]]\nshape = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\n";
    let rotate = format!("{solid}rotate = {{ axis = \"x\", angle = 1, zzz = 1 }}");
    assert_eq!(names(&tables["solid.rotate"]), known("inspect", &rotate));
    let array = format!("{solid}array = {{ count = [1, 1, 1], step = [1, 1, 1], zzz = 1 }}");
    assert_eq!(names(&tables["solid.array"]), known("inspect", &array));
    for (shape, needed, optional) in SHAPES {
        let keys = [needed, optional].concat().iter().map(|k| (*k).to_owned()).collect();
        let table = tables.get(shape);
        assert_eq!(names(table.unwrap_or_else(|| panic!("no table of {shape}"))), keys, "{shape}");
        assert!(tables["solid"]["shape"].contains(&format!("`{shape}`")), "{shape}");
    }
    assert_eq!(tables.len(), 4 + SHAPES.len(), "a table of a shape that is not known");
    assert_shown(&page);
}

#[test]
fn keys_of_studies() {
    let page = page("study.md");
    let tables = rows(&page, "keys");
    let method = "[[method]]\nmethod = \"auto\"\n";
    assert_eq!(names(&tables["study"]), known("study", "zzz = 1"));
    let scene = "[[scene]]\nsolid = [{ shape = \"sphere\", center = [0, 0, 0], radius = 1 }]\n";
    assert_eq!(names(&tables["study.scene"]), known("study", &format!("{scene}zzz = 1")));
    let probe = format!("{scene}probe = {{ cell = [0, 0, 0], beta_v = 1, zzz = 1 }}");
    assert_eq!(names(&tables["study.scene.probe"]), known("study", &probe));
    assert_eq!(names(&tables["study.method"]), known("study", &format!("{method}zzz = 1")));
    let published = format!("{scene}published = [{{ by = \"a\", cells = [1, 1, 1], seconds = 1, zzz = 1 }}]");
    assert_eq!(names(&tables["study.scene.published"]), known("study", &published));
    let flow = "[[flow]]\nproblem = \"sod\"\ncells = 10\nzzz = 1";
    assert_eq!(names(&tables["study.flow"]), known("study", flow));
    let scaling = "[[scaling]]\nalong = \"cells\"\ncounts = 10\nzzz = 1";
    assert_eq!(names(&tables["study.scaling"]), known("study", scaling));
    assert_eq!(tables.len(), 7);
    assert_shown(&page);
}

/// An example runs, or fails for nothing but a file that it names and that is not there.
fn assert_runs(what: &str, output: &std::process::Output) {
    let said = stderr(output);
    let absent = ["deck.stl", "fields", "before/final", "grid.toml"].iter().any(|name| said.contains(name));
    assert!(output.status.success() || (absent && said.contains("No such file or directory")), "{what}\n{said}");
}

#[test]
fn examples_run() {
    let at = Scratch::new();
    for block in examples(&page("grid.md"), "toml grid") {
        fs::write(at.file("grid.toml"), &block).expect("written");
        let fixture = crate::kit::fixture("analytic_boxes_aligned.stl");
        let output = voidage(&[&"porosity", &fixture, &"--grid", &at.file("grid.toml")]);
        assert!(output.status.success() && !stderr(&output).contains("ignored"), "{block}\n{}", stderr(&output));
    }
    fs::remove_file(at.file("grid.toml")).expect("removed");
    for block in examples(&page("scene.md"), "toml scene") {
        fs::write(at.file("scene.toml"), &block).expect("written");
        assert_runs(&block, &voidage(&[&"porosity", &at.file("scene.toml"), &"--spacing", &"0.2"]));
    }
    for block in examples(&page("study.md"), "toml study") {
        fs::write(at.file("study.toml"), &block).expect("written");
        assert_runs(&block, &voidage(&[&"study", &at.file("study.toml")]));
    }
    let cases = examples(&page("case.md"), "toml case");
    assert!(!cases.is_empty());
    for block in &cases {
        let output = solve(&at, block, "out", &["-q"]);
        assert!(output.status.success(), "{block}\n{}", stderr(&output));
    }
    let parts = [examples(&page("case.md"), "toml case-part"), examples(&page("grid.md"), "toml case-part")].concat();
    assert!(parts.len() > 4);
    for (n, block) in parts.iter().enumerate() {
        assert_runs(block, &solve(&at, &with_part(BASE, block), &format!("part{n}"), &["-q"]));
    }
}

const BASE: &str = r#"
[grid]
x = [0, 1, 2]
y = [0, 1, 2]
z = [0, 1, 2]
[gas]
model = "ideal"
gamma = 1.4
[initial]
uniform = { rho = 1, p = 1 }
[boundary]
x_min = "wall"
x_max = "wall"
y_min = "wall"
y_max = "wall"
z_min = "wall"
z_max = "wall"
[time]
max_steps = 2
"#;

/// A case with some of its tables replaced.
fn with_part(base: &str, part: &str) -> String {
    let mut whole: toml::Table = base.parse().expect("TOML");
    whole.extend(part.parse::<toml::Table>().expect("TOML"));
    whole.to_string()
}

/// What `--template` prints runs as it is, and the case with the scene in it.
#[test]
fn templates_run() {
    let at = Scratch::new();
    let print = |arguments: &[&dyn AsRef<std::ffi::OsStr>], name: &str| {
        let output = voidage(arguments);
        assert!(output.status.success() && output.stderr.is_empty(), "{}", stderr(&output));
        fs::write(at.file(name), &output.stdout).expect("written");
        String::from_utf8(output.stdout).expect("UTF-8")
    };
    print(&[&"porosity", &"--template-scene"], "scene.toml");
    let output = voidage(&[&"porosity", &at.file("scene.toml"), &"--npy", &at.file("fields")]);
    assert!(output.status.success() && output.stderr.is_empty(), "{}", stderr(&output));
    print(&[&"study", &"--template"], "study.toml");
    let output = voidage(&[&"study", &at.file("study.toml"), &"-o", &at.file("study"), &"-q"]);
    assert!(output.status.success() && output.stderr.is_empty(), "{}", stderr(&output));
    let case = print(&[&"solve", &"--template"], "template.toml").replace("end = 0.006", "end = 0.0004");
    let open = solve(&at, &case, "open", &["-q"]);
    assert!(open.status.success() && open.stderr.is_empty(), "{}", stderr(&open));
    let with = case.replace("# [porosity]\n# scene", "[porosity]\nscene");
    assert_ne!(with, case);
    let output = solve(&at, &with, "with", &["-q"]);
    assert!(output.status.success() && output.stderr.is_empty(), "{}", stderr(&output));
    assert_eq!(voidage(&[&"solve", &"--template", &"case.toml"]).status.code(), Some(2));
}
