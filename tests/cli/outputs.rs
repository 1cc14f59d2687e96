//! The page of outputs and what runs write say the same: each field and column stands in a table, and no other does.

use crate::kit::{Scratch, fixture, json, solved, stderr, voidage};
use crate::reference::{page, rows};
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;

/// Names of the first column of a table of the page.
fn documented(table: &str) -> BTreeSet<String> {
    rows(&page("outputs.md"), "fields")[table].keys().cloned().collect()
}

/// Tables whose keys are names of stages, not fields.
const STAGES: [&str; 2] = ["seconds", "stages"];

/// The fields of a report: `a.b`, and `a[].b` for those of the tables in a list.
fn fields(value: &Value, path: &str, found: &mut BTreeSet<String>) {
    let list = |v: &Value| v.as_array().is_some_and(|items| items.iter().any(Value::is_object));
    match value {
        Value::Object(table) if !STAGES.contains(&path) => {
            let prefix = if path.is_empty() { String::new() } else { format!("{path}.") };
            table.iter().for_each(|(key, v)| fields(v, &format!("{prefix}{key}"), found));
        }
        Value::Array(items) if list(value) => items.iter().for_each(|v| fields(v, &format!("{path}[]"), found)),
        _ => drop(found.insert(path.to_owned())),
    }
}

/// Each stage that a report has a time of stands in the row of the table.
fn assert_stages(table: &str, reports: &[Value]) {
    let rows = &rows(&page("outputs.md"), "fields")[table];
    for (field, stages) in STAGES.iter().flat_map(|field| reports.iter().map(move |report| (field, &report[*field]))) {
        for stage in stages.as_object().into_iter().flatten().map(|(stage, _)| stage) {
            assert!(
                rows[*field].contains(&format!("`{stage}`")),
                "{table}: {field} has a stage {stage}: {}",
                rows[*field]
            );
        }
    }
}

/// All that reports say is in the table, and what is in the table some report says.
fn assert_told(table: &str, reports: &[Value]) {
    assert_stages(table, reports);
    let mut found = BTreeSet::new();
    reports.iter().for_each(|report| fields(report, "", &mut found));
    let page = documented(table);
    let missing: Vec<_> = found.difference(&page).collect();
    assert!(missing.is_empty(), "{table}: not in docs/outputs.md: {missing:?}");
    let idle: Vec<_> = page.difference(&found).collect();
    assert!(idle.is_empty(), "{table}: in docs/outputs.md, but in no report: {idle:?}");
}

/// A cube, one of whose edges has a corner on one side of it that is not on the other, and lies a little off it.
fn cracked() -> String {
    let [a, b, c, d] = ["0 0 0", "1 0 0", "1 1 0", "0 1 0"];
    let [e, f, g, h] = ["0 0 1", "1 0 1", "1 1 1", "0 1 1"];
    let middle = "0.5 0 1.000005";
    let quads = [[a, d, c, b], [a, b, f, e], [b, c, g, f], [c, d, h, g], [d, a, e, h]];
    let halves = quads.iter().flat_map(|&[p, q, r, s]| [[p, q, r], [p, r, s]]);
    let top = [[e, middle, h], [middle, g, h], [middle, f, g]];
    let facet = |corners: [&str; 3]| {
        let vertices = corners.map(|p| format!("vertex {p}\n")).concat();
        format!("facet normal 0 0 0\nouter loop\n{vertices}endloop\nendfacet\n")
    };
    format!("solid cracked\n{}endsolid cracked\n", halves.chain(top).map(facet).collect::<String>())
}

const SCENE: &str = "[[solid]]\nshape = \"cylinder\"\nfrom = [0, 0, 0]\nto = [2, 0, 0]\nradius = 0.3\n";

#[test]
fn reports_of_porosity_and_inspect() {
    let at = Scratch::new();
    fs::write(at.file("scene.toml"), SCENE).expect("written");
    let run = |name: &str, arguments: &[&dyn AsRef<std::ffi::OsStr>]| {
        let report = at.file(name);
        let mut all: Vec<&dyn AsRef<std::ffi::OsStr>> = arguments.to_vec();
        all.extend([&"--report" as &dyn AsRef<std::ffi::OsStr>, &report, &"-q"]);
        let output = voidage(&all);
        assert!(output.status.success(), "{}", stderr(&output));
        json(&report)
    };
    let skid = fixture("cad_skid.stl");
    let crack = at.file("cracked.stl");
    fs::write(&crack, cracked()).expect("written");
    let of_file = at.file("of_file.toml");
    fs::write(&of_file, "[[solid]]\nshape = \"file\"\npath = \"cracked.stl\"\n").expect("written");
    let scene = at.file("scene.toml");
    assert_told(
        "porosity",
        &[
            run("a.json", &[&"porosity", &skid, &scene, &"--spacing", &"0.3", &"--drag", &"pdr"]),
            run("b.json", &[&"porosity", &crack, &"--cells", &"6x6x6", &"--bounds-fields", &"--npy", &at.file("npy")]),
            run("d.json", &[&"porosity", &of_file, &"--cells", &"6x6x6"]),
        ],
    );
    assert_told("inspect", &[run("c.json", &[&"inspect", &skid, &scene])]);
}

/// A case of one axis, with its gas and its initial state.
fn tube(gas: &str, state: &str, more: &str) -> String {
    format!(
        "[grid]\nx = {{ points = [0, 1], cells = [8] }}\n[gas]\n{gas}\n[initial]\nuniform = {{ {state} }}\n\
         [boundary]\nx_min = \"wall\"\nx_max = \"wall\"\n[time]\nmax_steps = 2\n{more}"
    )
}

fn columns(path: &std::path::Path) -> BTreeSet<String> {
    let text = fs::read_to_string(path).expect("a table");
    text.lines().next().expect("a head").split(',').map(str::to_owned).collect()
}

#[test]
fn reports_and_tables_of_solve() {
    let at = Scratch::new();
    fs::write(
        at.file("scene.toml"),
        "[[solid]]\nname = \"NAME\"\nshape = \"box\"\nmin = [0.5, 0, 0]\nmax = [0.7, 1, 1]\n",
    )
    .expect("written");
    let ideal = "model = \"ideal\"\ngamma = 1.4\ngas_constant = 287";
    let more = "[porosity]\nscene = \"scene.toml\"\n[output]\nprobes = [{ name = \"NAME\", at = [0.1, 0, 0] }]\nmonitors = [{ name = \"NAME\", x = 0.3 }]\nmaxima = {}\nforces = [\"*\"]\n";
    let burnt = "[output]\nprobes = [{ name = \"NAME\", at = [0.1, 0, 0] }]\n";
    let isentropic = "model = \"isentropic\"\ngamma = 1.4\nrho = 1.2\np = 1e5";
    let cases = [
        ("ideal", tube(ideal, "T = 300, p = 1e5", more)),
        ("burnt", tube(ideal, "T = 300, p = 1e5, gamma = 1.3", burnt)),
        ("isothermal", tube("model = \"isothermal\"\nsound_speed = 340", "rho = 1.2", "")),
        ("isentropic", tube(isentropic, "rho = 1.2", "")),
    ];
    let with_sides = "[grid]\nx = { points = [0, 1], cells = [8] }\ny = { points = [0, 1], cells = [8] }\n[gas]\nmodel = \"ideal\"\ngamma = 1.4\n\
         [initial]\nuniform = { rho = 1.2, p = 1e5 }\nregions = [{ center = [0.5, 0.5], radius = 0.2, p = 2e5 }]\n\
         [boundary]\nx_min = \"wall\"\nx_max = \"wall\"\ny_min = \"wall\"\ny_max = \"wall\"\n\
         [[boundary.patch]]\nside = \"x_min\"\ntype = \"zero-gradient\"\n[time]\nend = 1\nmax_steps = 2\n[output]\nformats = [\"png\"]\n";
    let cases = cases.into_iter().chain([("sides", with_sides.to_owned())]);
    let reports: Vec<Value> = cases
        .map(|(name, case)| {
            let check: &[&str] = if name == "sides" { &["-q", "--refine-check"] } else { &["-q"] };
            solved(&at, &case, name, check);
            json(&at.file(name).join("report.json"))
        })
        .collect();
    assert_told("solve", &reports);
    for report in &reports {
        let seconds = |field: &str| report[field].as_f64().expect("seconds");
        let stages: f64 =
            ["setup", "steps", "output"].iter().map(|s| report["stages"][s].as_f64().expect("seconds")).sum();
        assert!(
            seconds("seconds") > 0.0 && stages > seconds("seconds") && seconds("seconds_in_all") >= stages,
            "{report}"
        );
    }
    assert_eq!(columns(&at.file("ideal/log.csv")), documented("log"));
    assert_eq!(columns(&at.file("burnt/probes.csv")), documented("probes"));
    let of_two = "NAME gamma".to_owned();
    let of_one: BTreeSet<String> = documented("probes").into_iter().filter(|column| *column != of_two).collect();
    assert_eq!(columns(&at.file("ideal/probes.csv")), of_one);
    assert_eq!(columns(&at.file("ideal/monitors.csv")), documented("monitors"));
}

#[test]
fn tables_of_studies() {
    let at = Scratch::new();
    let template = String::from_utf8(voidage(&[&"study", &"--template"]).stdout).expect("UTF-8");
    let points = template.replace("repeats = 3", "repeats = 1\nleft_out = true");
    let more = "[[flow]]\nproblem = \"sod\"\ncells = [10, 20]\n[[scaling]]\nalong = \"bodies\"\ncounts = [1, 2]\n";
    fs::write(at.file("study.toml"), format!("{points}\n{more}")).expect("written");
    let output = voidage(&[&"study", &at.file("study.toml"), &"-o", &at.file("out"), &"-q"]);
    assert!(output.status.success(), "{}", stderr(&output));
    for table in ["study", "study_flows", "study_scaling", "study_left_out"] {
        assert_eq!(columns(&at.file("out").join(format!("{table}.csv"))), documented(table));
    }
    assert_told("study_json", &[json(&at.file("out/study.json"))]);
}

#[test]
fn outcomes_of_stress() {
    let at = Scratch::new();
    let file = at.file("stress.json");
    let output = voidage(&[&"stress", &"--only", &"geometry/nano", &"--json", &file, &"-q"]);
    assert!(output.status.success(), "{}", stderr(&output));
    assert_told("stress_json", &[json(&file)]);
}
