//! A directory in which a run has been: what of it stays, what another run may take, and what one that goes on finds again.

use crate::kit::{Scratch, array, json, program, solve, solved, stderr, stdout};
use std::fs;
use std::process::Command;

/// A tube of ten cells under a piston of gas; `more` are keys of `[output]`.
fn tube(time: &str, more: &str) -> String {
    format!(
        "[grid]\nx = {{ points = [0, 1], cells = [10] }}\n[gas]\nmodel = \"ideal\"\ngamma = 1.4\ngas_constant = 287\n\
         [initial]\nuniform = {{ rho = 1.2, p = 1e5 }}\nregions = [{{ max = [0.3], p = 2e5 }}]\n\
         [boundary]\nx_min = \"wall\"\nx_max = {{ type = \"outlet\", p = 1e5 }}\n[time]\n{time}\n[output]\n{more}\n"
    )
}

/// The steps of a table.
fn steps(at: &Scratch, table: &str) -> Vec<usize> {
    let text = fs::read_to_string(at.file("out").join(table)).expect("a table");
    text.lines().skip(1).map(|line| line.split(',').next().expect("a step").parse().expect("a number")).collect()
}

#[test]
fn a_run_does_not_write_over_its_beginning() {
    let at = Scratch::new();
    solved(&at, &tube("max_steps = 2", "formats = [\"npy\"]\nevery = 1e-5"), "out", &["-q"]);
    for from in ["out/final", "out/frames/0001"] {
        let case = tube("max_steps = 2", "formats = [\"npy\"]")
            .replace("uniform = {", "from = \"FROM\" #")
            .replace("FROM", from);
        let case = case.lines().filter(|line| !line.starts_with("regions")).collect::<Vec<_>>().join("\n");
        let refused = solve(&at, &case, "out", &["--force"]);
        assert_eq!(refused.status.code(), Some(1));
        assert!(
            stderr(&refused).contains("key initial.from: would be replaced by the results"),
            "{}",
            stderr(&refused)
        );
        solved(&at, &case, "other", &["-q", "--force"]);
    }
    fs::create_dir(at.file("taken")).expect("made");
    fs::write(at.file("taken/final"), "mine").expect("written");
    let refused = solve(&at, &tube("max_steps = 2", ""), "taken", &[]);
    assert!(stderr(&refused).contains("taken/final: is a file"), "{}", stderr(&refused));
    assert!(!at.file("taken/log.csv").exists());
}

/// The frames of a run that has not ended do not stand among those of the one that takes its place.
#[test]
fn frames_of_another_run_are_put_aside() {
    let at = Scratch::new();
    let output = "formats = [\"vtr\"]\nevery = 1e-4\nmaxima = {}";
    solved(&at, &tube("end = 1e-3", output), "out", &["-q"]);
    fs::remove_file(at.file("out/report.json")).expect("as if the run had been killed");
    let text = stderr(&solved(&at, &tube("end = 1e-4", "formats = [\"vtr\"]"), "out", &[]));
    assert!(
        text.contains("its last state is kept in checkpoint_before.bin, its frames and tables beside it as *_before"),
        "{text}"
    );
    let count = |dir: &str| fs::read_dir(at.file("out").join(dir)).expect("frames").count();
    assert_eq!([count("frames"), count("frames_before")], [2, 11]);
    assert!(!at.file("out/maxima").exists());
    // What was put aside is put aside until the next time.
    fs::remove_file(at.file("out/report.json")).expect("as if the run had been killed");
    solved(&at, &tube("end = 1e-4", ""), "out", &["-q"]);
    assert_eq!(count("frames_before"), 2);
}

/// A frame that shows the end alone is none of a run that goes on.
#[test]
fn a_longer_end_gives_the_frames_of_one_run() {
    let at = Scratch::new();
    let times = |dir: &str| {
        let list = fs::read_to_string(at.file(dir).join("flow.pvd")).expect("a list");
        list.lines()
            .filter_map(|line| line.split("timestep=\"").nth(1)?.split('"').next()?.parse().ok())
            .collect::<Vec<f64>>()
    };
    let output = "formats = [\"vtr\"]\nevery = 0.001";
    solved(&at, &tube("end = 0.0015", output), "out", &["-q"]);
    assert_eq!(times("out"), [0.0, 0.001, 0.0015]);
    solved(&at, &tube("end = 0.003", output), "out", &["-q", "--resume"]);
    assert_eq!(times("out").len(), 4);
    assert!((times("out")[2] - 0.002).abs() < 1e-15 && times("out")[3] == 0.003, "{:?}", times("out"));
}

/// The last step has its line, also where nothing is left to do.
#[test]
fn the_last_line_stays() {
    let at = Scratch::new();
    solved(&at, &tube("max_steps = 25", "log_every = 10"), "out", &["-q"]);
    let log = fs::read(at.file("out/log.csv")).expect("a log");
    assert_eq!(steps(&at, "log.csv"), [0, 10, 20, 25]);
    solved(&at, &tube("max_steps = 25", "log_every = 10"), "out", &["-q", "--resume"]);
    assert!(fs::read(at.file("out/log.csv")).expect("a log") == log);
}

/// The lines until a step that cannot be done are there.
#[test]
fn lines_before_trouble_are_written() {
    let at = Scratch::new();
    // Gravity that empties the top until floors stop the run.
    let case = tube("max_steps = 4000", "formats = []").replace("[time]", "[gravity]\ng = [1e7, 0, 0]\n[time]");
    let case = case.replace("x_max = { type = \"outlet\", p = 1e5 }", "x_max = \"wall\"");
    let stopped = solve(&at, &case, "out", &["-q"]);
    let text = stderr(&stopped);
    assert_eq!(stopped.status.code(), Some(1), "{text}");
    let step: usize =
        text.split("step ").nth(1).and_then(|t| t.split([',', ':']).next()?.parse().ok()).expect("a step");
    let last = *steps(&at, "log.csv").last().expect("a line");
    assert!(last + 1 >= step && step > 1, "{last} of {step}: {text}");
}

/// Columns go on at the same places or not at all.
#[test]
fn places_are_kept() {
    let at = Scratch::new();
    let with = |more: &str, steps: usize, flags: &[&str]| {
        solve(&at, &tube(&format!("max_steps = {steps}"), &format!("formats = []\n{more}")), "out", flags)
    };
    let refused = |more: &str, what: &str| {
        let text = stderr(&with(more, 9, &["--resume"]));
        assert!(text.contains(&format!("of a run with other {what}")), "{text}");
    };
    // The planes at the end and one cell before it see the same cell.
    assert!(with("monitors = [{ name = \"M\", x = 1 }]", 3, &[]).status.success());
    refused("monitors = [{ name = \"M\", x = 0.9 }]", "output.monitors");
    // Probes that rest for a while go on where they were.
    assert!(with("probes = [{ name = \"P\", at = [0.1] }]", 3, &["--force"]).status.success());
    assert!(with("", 5, &["--resume"]).status.success());
    refused("probes = [{ name = \"P\", at = [0.8] }]", "output.probes");
    assert!(with("probes = [{ name = \"P\", at = [0.1] }]", 7, &["--resume"]).status.success());
    assert_eq!(steps(&at, "probes.csv"), [0, 1, 2, 3, 6, 7]);
    // Whether the temperature or the density of an inlet is given decides what it feeds later.
    let inlet = |state: &str| {
        tube("max_steps = 3", "")
            .replace("x_min = \"wall\"", &format!("x_min = {{ type = \"inlet\", u = 9, {state} }}"))
    };
    solved(&at, &inlet("rho = 1.2"), "inlet", &["-q"]);
    let same = 2e5 / (287.0 * 1.2);
    let text = stderr(&solve(&at, &inlet(&format!("T = {same}")), "inlet", &["--resume"]));
    assert!(text.contains("its boundary differs"), "{text}");
}

/// What acted on walls in the last step is known of each cell, whatever else was watched then.
#[test]
fn forces_stay_without_the_planes() {
    let at = Scratch::new();
    fs::write(
        at.file("box.toml"),
        "[[solid]]\nname = \"B\"\nshape = \"box\"\nmin = [0.52, -1, -1]\nmax = [0.78, 2, 2]\n",
    )
    .expect("a file");
    let case = |monitors: &str| {
        tube("max_steps = 12", &format!("formats = []\nforces = [\"B\"]\n{monitors}"))
            .replace("[gas]", "[porosity]\nscene = \"box.toml\"\n[gas]")
    };
    solved(&at, &case("monitors = [{ x = 0.2 }]"), "out", &["-q"]);
    let force = || json(&at.file("out/report.json"))["forces"][0].clone();
    let before = force();
    solved(&at, &case(""), "out", &["-q", "--resume"]);
    assert_eq!(before, force());
}

/// Without a directory in the beginning: of two runs one writes, the other is told.
#[test]
fn a_finished_run_is_not_replaced_by_one_that_began_before_its_end() {
    let at = Scratch::new();
    let case = |name: &str, cells: usize| {
        let file = at.file(name);
        fs::write(&file, tube("max_steps = 3", "").replace("cells = [10]", &format!("cells = [{cells}]")))
            .expect("a case");
        file
    };
    let run = |file: &std::path::Path| {
        let mut command = Command::new(program());
        command.arg("solve").arg(file).arg("-o").arg(at.file("out")).arg("-q");
        command.stderr(std::process::Stdio::piped()).spawn().expect("started")
    };
    let both = [run(&case("a.toml", 10)), run(&case("b.toml", 4000))];
    let done = both.map(|child| child.wait_with_output().expect("ended"));
    assert_eq!(done.iter().filter(|out| out.status.success()).count(), 1, "{done:?}");
    let cells = [10, 4000][usize::from(done[1].status.success())];
    assert_eq!(array(&at.file("out/final/rho.npy")).len(), cells);
}

/// A run that its steps stop before the end that its case asks for says so, and in its report; one that goes on to the end does not any more.
#[test]
fn an_end_that_is_not_reached_is_told() {
    let at = Scratch::new();
    let run = |time: &str, more: &[&str]| {
        let done = solved(&at, &tube(time, "formats = []"), "out", more);
        let (said, report) = (stdout(&done), json(&at.file("out/report.json")));
        let warnings = report["warnings"].to_string();
        (said, stderr(&done), warnings, report["end_not_reached"].as_f64())
    };
    let (said, warned, kept, end) = run("end = 1e-3\nmax_steps = 2", &[]);
    assert!(said.contains(" s, stopped by max_steps before the end at 0.001 s"), "{said}");
    let words = "key time.max_steps: the run stopped after 2 steps at t = ";
    assert!(warned.contains(words) && warned.contains(" s: time.end, 0.001 s, was not reached"), "{warned}");
    assert!(kept.contains(words) && end == Some(1e-3), "{kept}");
    for (time, more) in [("end = 1e-3\nmax_steps = 2000", &["--resume"][..]), ("max_steps = 2", &["--force"])] {
        let (said, warned, kept, end) = run(time, more);
        let all = said + &warned + &kept;
        assert!(!all.contains("stopped by") && !all.contains("not reached") && end.is_none(), "{all}");
    }
}
