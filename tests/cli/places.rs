//! Where results go: not over what they are made of, nor where another run writes.

use crate::kit::{Scratch, fixture, program, stderr, voidage};
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
