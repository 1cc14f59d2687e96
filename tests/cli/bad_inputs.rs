//! Files as they come: 143 good, odd and broken ones with the behaviour each must meet.

use crate::kit::{Scratch, fixture, stderr, voidage};
use serde_json::Value;
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};
use voidage::files::npy;

/// What a case expects, by the words of its manifest.
struct Case<'a> {
    file: &'a str,
    expect: &'a str,
    volume: Option<f64>,
    words: Vec<&'a str>,
}

/// Files that a repository does not keep: odd names, links, a pipe.
#[cfg(unix)]
fn make_special(dir: &Path) {
    let good = dir.join("ref_ok_binary.stl");
    fs::create_dir(dir.join("directory.stl")).expect("a directory");
    for name in ["unreadable.stl", "name with spaces & (brackets) ü.stl", "UPPER.STL", "no_extension"] {
        fs::copy(&good, dir.join(name)).expect("a copy");
    }
    use std::os::unix::fs::{PermissionsExt, symlink};
    fs::set_permissions(dir.join("unreadable.stl"), fs::Permissions::from_mode(0o000)).expect("no permissions");
    symlink("does_not_exist.stl", dir.join("dangling_symlink.stl")).expect("a link");
    symlink("ref_ok_binary.stl", dir.join("symlink_ok.stl")).expect("a link");
    let made = std::process::Command::new("mkfifo").arg(dir.join("fifo.stl")).status();
    assert!(made.is_ok_and(|s| s.success()), "mkfifo");
}

#[test]
#[cfg(unix)]
fn every_case_of_the_manifest() {
    let dir = Scratch::new();
    for entry in fs::read_dir(fixture("bad_inputs")).expect("fixtures") {
        let entry = entry.expect("an entry");
        if entry.path().is_file() {
            fs::copy(entry.path(), dir.0.join(entry.file_name())).expect("a copy");
        }
    }
    make_special(&dir.0);
    let text = fs::read_to_string(fixture("bad_inputs/manifest.json")).expect("a manifest");
    let manifest: Value = serde_json::from_str(&text).expect("JSON");
    let grid = dir.file("grid.json");
    fs::write(&grid, grid_of(&manifest["test_grid"])).expect("written");
    let cases = manifest["files"]
        .as_array()
        .or_else(|| manifest.as_object().and_then(|o| o.values().find_map(Value::as_array)));
    let mut failures = String::new();
    let mut count = 0;
    for value in cases.expect("cases") {
        let case = Case {
            file: value["file"].as_str().expect("a name"),
            expect: value["expect"].as_str().expect("an expectation"),
            volume: value["solid_volume"].as_f64(),
            words: value["message_should_mention"]
                .as_array()
                .expect("words")
                .iter()
                .filter_map(Value::as_str)
                .collect(),
        };
        // Who runs as root can read everything.
        if case.file == "unreadable.stl" && fs::read(dir.file(case.file)).is_ok() {
            continue;
        }
        count += 1;
        let out = Scratch::new();
        for problem in check(&case, &dir, &grid, &out) {
            let _ = writeln!(failures, "{} ({}): {problem}", case.file, case.expect);
        }
    }
    assert!(failures.is_empty(), "\n{failures}");
    assert!(count >= 140, "{count} cases");
}

fn grid_of(value: &Value) -> String {
    let pick = |key: &str, a: usize| value[key][a].as_f64().expect("a number");
    let axes = [0, 1, 2].map(|a| {
        let edges: Vec<f64> =
            (0..=pick("n", a) as usize).map(|i| pick("origin", a) + pick("spacing", a) * i as f64).collect();
        format!("\"{}\": {edges:?}", ["x", "y", "z"][a])
    });
    format!("{{{}}}", axes.join(", "))
}

fn check(case: &Case, dir: &Scratch, grid: &Path, out: &Scratch) -> Vec<String> {
    let path = if case.file.starts_with('/') { case.file.into() } else { dir.file(case.file) };
    let (npy_dir, report) = (out.file("npy"), out.file("report.json"));
    let begin = Instant::now();
    let output = voidage(&[&"porosity", &path, &"--grid", &grid, &"--npy", &npy_dir, &"--report", &report]);
    let mut problems = Vec::new();
    let mut require = |good: bool, what: String| {
        if !good {
            problems.push(what);
        }
    };
    // Generous: the limit is a second, but machines that test are busy.
    require(begin.elapsed() < Duration::from_secs(5), format!("took {:?}", begin.elapsed()));
    let message = stderr(&output);
    let base = Path::new(case.file).file_name().map_or(case.file.into(), |n| n.to_string_lossy());
    let named = message.contains(&*base);
    let passed = output.status.success();
    require(!message.contains("panicked"), message.clone());
    require(passed || output.status.code() == Some(1), format!("exit {:?}", output.status.code()));
    let refused = !passed && named && out.names().is_empty();
    let volume = passed.then(|| measured(&npy_dir, &report, &mut require));
    let close = |v: f64| {
        let tolerance = if case.file.contains("noise") { 1e-5 } else { 1e-6 };
        case.volume.is_none_or(|w| (v - w).abs() <= tolerance * w || (w == 0.0 && v < 1e-9))
    };
    let exact = volume.is_some_and(close);
    match case.expect {
        "error" => require(refused, format!("not refused: {message}")),
        "ok" => require(exact && !named, format!("volume {volume:?}, wanted {:?}: {message}", case.volume)),
        "ok_or_warn" => require(exact, format!("volume {volume:?}, wanted {:?}: {message}", case.volume)),
        "warn" => require(exact && named, format!("volume {volume:?}, wanted {:?}: {message}", case.volume)),
        "warn_or_error" => require(refused || (exact && named), format!("volume {volume:?}: {message}")),
        other => require(false, format!("unknown expectation {other}")),
    }
    if !passed || case.expect.starts_with("warn") {
        let lower = message.to_lowercase();
        for word in &case.words {
            require(lower.contains(&word.to_lowercase()), format!("does not mention {word}: {message}"));
        }
    }
    problems
}

/// The reported volume; every field must be finite and within 0..1.
fn measured(npy_dir: &Path, report: &Path, require: &mut impl FnMut(bool, String)) -> f64 {
    for field in ["beta_v", "beta_x", "beta_y", "beta_z"] {
        let (_, values) = npy::read(&npy_dir.join(format!("{field}.npy"))).expect("an array");
        require(values.iter().all(|b| (0.0..=1.0).contains(b)), format!("{field} leaves 0..1"));
    }
    let report: Value = serde_json::from_slice(&fs::read(report).expect("a report")).expect("JSON");
    report["solid_volume"].as_f64().expect("a volume")
}
