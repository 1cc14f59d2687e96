//! Runs that stop and go on: at a number of steps, by Ctrl-C, by a kill. They end with the same bits as a run that never stopped.

use crate::kit::{Scratch, json, program, solve, solved, stderr};
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use voidage::command::solve::checkpoint::{gas_numbers, scheme_numbers, side_numbers};
use voidage::voidage_core::flow::{Boundary, Gas, Limiter, PressureForm, Primitive, Riemann, Scheme};

/// Everything at once: inlet, porosity with jumps and small cells, drag, gravity, frames, probes.
fn wind(time: &str, output: &str) -> String {
    format!(
        r#"
[grid]
x = {{ points = [-2.05, 9.95], cells = [24] }}
y = {{ points = [-1, 5], cells = [12] }}
z = {{ points = [-1, 5], cells = [18] }}
[porosity]
scene = '{}'
[gas]
model = "ideal"
gamma = 1.4
[initial]
uniform = {{ rho = 1.2, u = 20, p = 1e5 }}
[boundary]
x_min = {{ type = "inlet", rho = 1.2, u = 20 }}
x_max = {{ type = "outlet", p = 1e5 }}
y_min = {{ type = "wall" }}
y_max = {{ type = "far-field", rho = 1.2, u = 20, p = 1e5 }}
z_min = {{ type = "wall" }}
z_max = {{ type = "zero-gradient" }}
[drag]
cr = [0.1, 0, 0.2]
linear = [0, 1, 0]
[gravity]
g = [0, 0, -9.81]
[time]
{time}
[output]
every = 0.004
maxima = {{ threshold = 20 }}
probes = [{{ name = "P", at = [5, 2, 4.5] }}]
{output}
"#,
        Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/channel/cube.stl").display()
    )
}

/// All that a run leaves, apart from what names the time it took.
fn results(at: &Scratch, dir: &str) -> Vec<(String, Vec<u8>)> {
    let mut all = Vec::new();
    let final_fields = ["rho", "u", "v", "w", "p"].map(|f| format!("final/{f}.npy"));
    let tables = ["log.csv", "probes.csv", "flow.pvd"].map(str::to_owned);
    let maxima = ["overpressure", "impulse", "arrival", "dynamic_pressure"].map(|f| format!("maxima/{f}.npy"));
    let frames = (0..4).map(|n| format!("frames/flow_{n:04}.vtr"));
    for name in final_fields.into_iter().chain(tables).chain(maxima).chain(frames) {
        all.push((name.clone(), fs::read(at.file(dir).join(&name)).expect("a file")));
    }
    all
}

fn assert_same(at: &Scratch, a: &str, b: &str) {
    for ((name, one), (_, other)) in results(at, a).iter().zip(&results(at, b)) {
        assert!(one == other, "{name} of {a} and {b} differ");
    }
}

#[test]
fn two_halves_are_a_whole_with_any_number_of_threads() {
    let at = Scratch::new();
    let whole = wind("end = 0.012", "");
    solved(&at, &whole, "one", &["-q", "--threads", "1"]);
    solved(&at, &whole, "three", &["-q", "--threads", "3"]);
    assert_same(&at, "one", "three");
    solved(&at, &wind("end = 0.012\nmax_steps = 13", ""), "parts", &["-q", "--threads", "2"]);
    solved(&at, &wind("end = 0.012\nmax_steps = 20", ""), "parts", &["-q", "--threads", "1", "--resume"]);
    solved(&at, &whole, "parts", &["-q", "--threads", "3", "--resume"]);
    assert_same(&at, "one", "parts");
    // A run that has ended is read again, and ends alike.
    solved(&at, &whole, "parts", &["-q", "--resume"]);
    assert_same(&at, "one", "parts");
}

/// A run in the background that writes a checkpoint after every step.
fn background(at: &Scratch, dir: &str, more: &[&str]) -> Child {
    let mut command = Command::new(program());
    command
        .arg("solve")
        .arg(at.file("case.toml"))
        .arg("-o")
        .arg(at.file(dir))
        .args(["-q", "--threads", "2"])
        .args(more);
    command.stderr(Stdio::piped()).spawn().expect("the program runs")
}

/// Waits until the log shows that steps were done.
fn wait_for_steps(at: &Scratch, dir: &str, lines: usize) {
    let begin = Instant::now();
    let count = || fs::read_to_string(at.file(dir).join("log.csv")).map_or(0, |t| t.lines().count());
    while count() < lines {
        assert!(begin.elapsed() < Duration::from_secs(100), "no step was done");
        std::thread::sleep(Duration::from_millis(1));
    }
}

#[test]
#[cfg(unix)]
fn ctrl_c_leaves_a_checkpoint() {
    let at = Scratch::new();
    let whole = wind("end = 0.012", "checkpoint_every = 0");
    solved(&at, &whole, "whole", &["-q"]);
    // Far away, so that the run cannot end before it is asked to.
    fs::write(at.file("case.toml"), wind("end = 1000", "checkpoint_every = 0")).expect("a case");
    let child = background(&at, "stopped", &[]);
    wait_for_steps(&at, "stopped", 6);
    let killed = Command::new("kill").arg("-INT").arg(child.id().to_string()).status().expect("kill runs");
    assert!(killed.success());
    let output = child.wait_with_output().expect("the program ends");
    assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
    assert!(stderr(&output).contains("error: interrupted at step"), "{}", stderr(&output));
    assert!(!at.file("stopped/final").exists() && at.file("stopped/checkpoint.bin").exists());
    let log = fs::read_to_string(at.file("stopped/log.csv")).expect("a log");
    let reached: f64 =
        log.lines().last().and_then(|l| l.split(',').nth(1)).and_then(|t| t.parse().ok()).expect("a time");
    assert!(reached > 0.0);
    if reached < 0.012 {
        solved(&at, &whole, "stopped", &["-q", "--resume"]);
        assert_same(&at, "whole", "stopped");
    }
}

/// Two signals at once, as shells and supervisors send them, are one: the run ends in good order, with its last state.
#[test]
#[cfg(unix)]
fn two_signals_at_once_cost_no_checkpoint() {
    let at = Scratch::new();
    fs::write(at.file("case.toml"), wind("end = 1000", "checkpoint_every = 1000")).expect("a case");
    let child = background(&at, "stopped", &[]);
    // The first checkpoint is that of the beginning; the next one would come after a quarter of an hour.
    let begin = Instant::now();
    while fs::read(at.file("stopped/checkpoint.bin")).is_err() {
        assert!(begin.elapsed() < Duration::from_secs(100), "no checkpoint was written");
        std::thread::sleep(Duration::from_millis(1));
    }
    let first = fs::read(at.file("stopped/checkpoint.bin")).expect("a checkpoint");
    std::thread::sleep(Duration::from_millis(300));
    for signal in ["-INT", "-TERM", "-INT"] {
        assert!(Command::new("kill").arg(signal).arg(child.id().to_string()).status().expect("kill runs").success());
    }
    let output = child.wait_with_output().expect("the program ends");
    assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
    assert!(stderr(&output).contains("interrupted at step"), "{}", stderr(&output));
    assert!(fs::read(at.file("stopped/checkpoint.bin")).expect("a checkpoint") != first);
    solved(&at, &wind("max_steps = 1", ""), "stopped", &["-q", "--resume"]);
}

#[test]
fn a_finished_run_is_kept() {
    let at = Scratch::new();
    let case = falling(-1.0, 3).replace("checkpoint_every = 0", "every = 0.001\nformats = [\"npy\"]");
    solved(&at, &case, "out", &["-q"]);
    let density = || fs::read(at.file("out/final/rho.npy")).expect("an array");
    let before = density();
    let refused = solve(&at, &case.replace("[-1,", "[-2,"), "out", &["-q"]);
    assert_eq!(refused.status.code(), Some(1));
    assert!(stderr(&refused).contains("out: holds a finished run: --force replaces it"), "{}", stderr(&refused));
    assert!(density() == before);
    solved(&at, &case, "out", &["-q", "--resume"]);
    fs::write(at.file("out/frames/notes.txt"), "mine").expect("written");
    fs::create_dir(at.file("out/frames/0099")).expect("a frame of the run before");
    solved(&at, &case.replace("[-1,", "[-2,"), "out", &["-q", "--force"]);
    assert!(density() != before);
    assert!(at.file("out/frames/notes.txt").is_file() && !at.file("out/frames/0099").exists());
    // A run that did not finish may begin anew.
    fs::remove_file(at.file("out/report.json")).expect("removed");
    solved(&at, &case, "out", &["-q"]);
}

/// Without a terminal a line tells from time to time how far the run is.
#[test]
#[cfg(unix)]
fn progress_without_a_terminal() {
    let at = Scratch::new();
    fs::write(at.file("case.toml"), wind("end = 1000", "")).expect("a case");
    let mut command = Command::new(program());
    command.arg("solve").arg(at.file("case.toml")).arg("-o").arg(at.file("out")).args(["--threads", "1"]);
    let begin = Instant::now();
    let mut child = command.stderr(Stdio::piped()).stdout(Stdio::null()).spawn().expect("the program runs");
    let pipe = child.stderr.take().expect("a pipe");
    let line = BufReader::new(pipe).lines().map_while(Result::ok).find(|line| line.starts_with("step "));
    assert!(begin.elapsed() >= Duration::from_secs(10), "{line:?} after {:?}", begin.elapsed());
    assert!(line.as_ref().is_some_and(|l| l.contains("  t = ") && l.ends_with(" left")), "{line:?}");
    child.kill().expect("killed");
    child.wait().expect("gone");
}

#[test]
#[cfg(unix)]
fn a_kill_leaves_the_last_checkpoint() {
    let at = Scratch::new();
    let whole = wind("end = 0.012", "checkpoint_every = 0");
    solved(&at, &whole, "whole", &["-q"]);
    let mut child = background(&at, "killed", &[]);
    for lines in [3, 8, 14] {
        wait_for_steps(&at, "killed", lines);
        child.kill().expect("killed"); // SIGKILL
        child.wait().expect("gone");
        child = background(&at, "killed", &["--resume"]);
    }
    assert!(child.wait_with_output().expect("the program ends").status.success());
    assert_same(&at, "whole", "killed");
    // A finished run that goes on is not finished: no report says so.
    let done = fs::read_to_string(at.file("killed/log.csv")).expect("a log").lines().count();
    assert!(at.file("killed/report.json").exists());
    fs::write(at.file("case.toml"), wind("end = 1000", "")).expect("a case");
    let mut child = background(&at, "killed", &["--resume"]);
    wait_for_steps(&at, "killed", done + 2);
    child.kill().expect("killed");
    child.wait().expect("gone");
    assert!(!at.file("killed/report.json").exists());
}

#[test]
fn checkpoints_that_do_not_fit_are_refused() {
    let at = Scratch::new();
    let case = wind("max_steps = 2", "");
    let refused = |case: &str, words: &str| {
        let output = solve(&at, case, "out", &["--resume"]);
        assert_eq!(output.status.code(), Some(1), "{words}");
        assert!(stderr(&output).contains(words), "'{words}' expected: {}", stderr(&output));
    };
    refused(&case, "there is no checkpoint to resume from");
    solved(&at, &case, "out", &["-q"]);
    for (from, to, part) in [
        ("cells = [18]", "cells = [17]", "its grid differs"),
        ("gamma = 1.4", "gamma = 1.3", "its gas differs"),
        ("u = 20, p = 1e5 }\n[boundary]", "u = 21, p = 1e5 }\n[boundary]", "its initial state differs"),
        ("outlet\", p = 1e5", "outlet\", p = 2e5", "its boundary differs"),
        ("cr = [0.1, 0, 0.2]", "cr = [0.2, 0, 0.1]", "its drag differs"),
        ("-9.81", "-9.8", "its gravity differs"),
        ("[time]", "[scheme]\ncfl = 0.5\n[time]", "its scheme differs"),
        ("scene = '", "jump = 0.2\nscene = '", "its treatment of the porosity differs"),
        ("threshold = 20", "threshold = 30", "its output.maxima differs"),
        ("[output]\n", "[output]\nambient = 5\n", "its output.ambient differs"),
        ("maxima = { threshold = 20 }", "", "knows other largest values over time"),
    ] {
        assert!(case.contains(from), "{from}");
        refused(&case.replacen(from, to, 1), part);
    }
    let path = at.file("out/checkpoint.bin");
    let whole = fs::read(&path).expect("a checkpoint");
    // The eighth byte is the version of the layout.
    for (length, flip, words) in [
        (whole.len(), 5000, "its checksum is wrong"),
        (whole.len(), 7, "is no checkpoint of this version"),
        (whole.len() - 9, 0, "damaged"),
        (4, 0, "no checkpoint"),
        (0, 0, "is empty (0 bytes): there is nothing to resume from"),
    ] {
        let mut bytes = whole[..length].to_vec();
        if flip > 0 {
            bytes[flip] ^= 1;
        }
        fs::write(&path, bytes).expect("a checkpoint");
        refused(&case, words);
    }
    fs::write(&path, &whole).expect("a checkpoint");
    let columns =
        |table: &str, key: &str| format!("{table}: has other columns than output.{key} asks for now: leave that");
    refused(&case.replace("name = \"P\"", "name = \"Q\""), &columns("probes.csv", "probes"));
    refused(&case.replace("[output]", "[output]\nforces = [\"*\"]"), &columns("log.csv", "forces"));
    // What decides neither the flow nor the columns may change.
    let other = "every = 1\nformats = [\"npy\"]\nlog_every = 3\ncheckpoint_every = 5\nslice = [1, 1, 1]\nrange = { speed = [0, 9] }";
    solved(&at, &format!("title = \"T\"\n{}", case.replace("every = 0.004", other)), "out", &["--resume", "-q"]);
    solved(&at, &case, "out", &["--resume", "-q"]);
}

/// Gas, half of it thin and cold, falls against `gravity`, at last faster than the energy of the cold half allows.
fn falling(gravity: f64, steps: usize) -> String {
    format!(
        r#"
[grid]
x = {{ points = [0, 1], cells = [32] }}
[gas]
model = "ideal"
gamma = 1.4
[initial]
uniform = {{ rho = 1, u = 0, p = 1 }}
regions = [{{ min = [0.5], rho = 1e-9, p = 1e-15 }}]
[boundary]
x_min = {{ type = "periodic" }}
x_max = {{ type = "periodic" }}
[gravity]
g = [{gravity}, 0, 0]
[time]
max_steps = {steps}
[output]
checkpoint_every = 0
"#
    )
}

#[test]
fn floors_are_booked_and_the_state_before_the_first_one_stays() {
    let at = Scratch::new();
    solved(&at, &falling(-40.0, 3), "out", &["-q"]);
    let report = json(&at.file("out/report.json"));
    assert!(report["floors"].as_u64().expect("a count") > 0, "no floor was visited");
    let changed = report["floor_change"]["momentum"][0].as_f64().expect("a momentum");
    assert!(changed > 0.0 && changed < 1e-7, "{changed}");
    let log = fs::read_to_string(at.file("out/log.csv")).expect("a log");
    let last: Vec<f64> = log.lines().last().expect("lines").split(',').map(|x| x.parse().expect("a number")).collect();
    assert_eq!((last[6], last[8]), (report["floors"].as_f64().expect("a count"), changed));
    // The state before the first floor takes the place of the last one, and the run ends as it did.
    let results = || ["rho", "u", "p"].map(|f| fs::read(at.file(&format!("out/final/{f}.npy"))).expect("a file"));
    let (before, checkpoint) = (results(), at.file("out/checkpoint_before_floors.bin"));
    fs::copy(&checkpoint, at.file("out/checkpoint.bin")).expect("a copy");
    solved(&at, &falling(-40.0, 3), "out", &["-q", "--resume"]);
    assert!(results() == before);
    assert_eq!(fs::read_to_string(at.file("out/log.csv")).expect("a log"), log);
    // A new run without floors leaves no copy of an old one behind.
    solved(&at, &falling(-1.0, 3), "out", &["-q", "--force"]);
    assert!(!checkpoint.exists() && json(&at.file("out/report.json"))["floors"] == 0);
}

#[test]
fn floors_that_matter_stop_the_run() {
    let at = Scratch::new();
    let output = solve(&at, &falling(-1e9, 3), "out", &["-q"]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    let text = stderr(&output);
    for part in [
        "step 1, t = ",
        "floors have changed",
        "of its mass",
        "of its momentum",
        "of its energy",
        "cell [",
        "rho = ",
        "p = ",
    ] {
        assert!(text.contains(part), "{part} in {text}");
    }
    assert!(text.trim_end().ends_with("checkpoint.bin") && !at.file("out/final").exists(), "{text}");
}

/// A run that has not ended is put aside when another takes its place, and can be taken up again; one that has ended is not.
#[test]
fn a_checkpoint_is_put_aside() {
    let at = Scratch::new();
    solved(&at, &falling(-1.0, 3), "out", &["-q"]);
    let [now, before, report] =
        ["checkpoint.bin", "checkpoint_before.bin", "report.json"].map(|n| at.file("out").join(n));
    let kept = fs::read(&now).expect("a checkpoint");
    // As if the run had been killed at its last step.
    let finished = fs::read(&report).expect("a report");
    // A case that is wrong leaves all as it is, even with --force.
    let wrong = falling(-1.0, 5) + "ambient = -1\n";
    assert_eq!(solve(&at, &wrong, "out", &["--force"]).status.code(), Some(1));
    assert!(fs::read(&report).expect("a report") == finished);
    fs::remove_file(&report).expect("a report");
    assert_eq!(solve(&at, &wrong, "out", &[]).status.code(), Some(1));
    assert!(fs::read(&now).expect("a checkpoint") == kept && !before.exists());
    let text = stderr(&solved(&at, &falling(-1.0, 5), "out", &[]));
    assert!(text.contains("held a run that had not ended; its last state is kept in checkpoint_before.bin"), "{text}");
    assert!(fs::read(&before).expect("kept") == kept && fs::read(&now).expect("a new one") != kept);
    // A finished run that is replaced on demand leaves what was put aside before.
    let text = stderr(&solved(&at, &falling(-1.0, 4), "out", &["--force"]));
    assert!(!text.contains("not ended") && fs::read(&before).expect("kept") == kept, "{text}");
    // With its table it is a checkpoint as any other.
    let [rho, log] = ["final/rho.npy", "log.csv"].map(|name| at.file("out").join(name));
    let last = [&rho, &log].map(|path| fs::read(path).expect("a file"));
    fs::copy(&before, &now).expect("a copy");
    fs::rename(at.file("out/log_before.csv"), &log).expect("the table that was kept");
    assert_ne!(fs::read(&log).expect("a table"), last[1]);
    solved(&at, &falling(-1.0, 4), "out", &["-q", "--resume"]);
    assert!([&rho, &log].map(|path| fs::read(path).expect("a file")) == last);
}

/// What replaces a finished run leaves nothing of it; tables that belong to no run are kept; the last step has its line.
#[test]
fn a_run_stands_alone_in_its_directory() {
    let at = Scratch::new();
    let case = |more: &str| {
        "[grid]\nx = { points = [0, 1], cells = [10] }\n[gas]\nmodel = \"ideal\"\ngamma = 1.4\n[initial]\nuniform = { rho = 1.2, p = 1e5 }\n\
         [boundary]\nx_min = \"wall\"\nx_max = \"wall\"\n[time]\nmax_steps = 5\n[output]\nlog_every = 3\n"
            .to_owned()
            + more
    };
    let more = "maxima = {}\nformats = [\"vtr\"]\nprobes = [{ at = [0.5] }]\nmonitors = [{ x = 0.5 }]\n";
    fs::create_dir(at.file("out")).expect("made");
    fs::write(at.file("out/log.csv"), "mine\n").expect("written");
    let first = stderr(&solved(&at, &case(more), "out", &[]));
    assert!(first.contains("held tables of no run; they are kept as log_before.csv"), "{first}");
    assert_eq!(fs::read_to_string(at.file("out/log_before.csv")).expect("kept"), "mine\n");
    let log = fs::read_to_string(at.file("out/log.csv")).expect("a log");
    let steps: Vec<&str> = log.lines().skip(1).filter_map(|line| line.split(',').next()).collect();
    assert_eq!(steps, ["0", "3", "5"]);
    fs::write(at.file("out/maxima/notes.txt"), "mine\n").expect("written");
    solved(&at, &case("formats = []\n"), "out", &["--force"]);
    for left in ["maxima/overpressure.npy", "maxima/maxima.vtr", "probes.csv", "monitors.csv", "flow.pvd"] {
        assert!(!at.file("out").join(left).exists(), "{left}");
    }
    assert!(at.file("out/maxima/notes.txt").exists());
    // A run that goes on has no line of a step that was its last.
    solved(&at, &case("formats = []\n").replace("max_steps = 5", "max_steps = 7"), "out", &["--resume", "-q"]);
    let log = fs::read_to_string(at.file("out/log.csv")).expect("a log");
    let steps: Vec<&str> = log.lines().skip(1).filter_map(|line| line.split(',').next()).collect();
    assert_eq!(steps, ["0", "3", "6", "7"]);
}

/// A number that changed would make every checkpoint that exists one of another case.
#[test]
fn kinds_keep_their_numbers() {
    assert_eq!(gas_numbers(&Gas::Ideal { gamma: 1.4 }), [0.0, 1.4]);
    assert_eq!(gas_numbers(&Gas::Mixed { gammas: [1.25, 1.4] }), [3.0, 1.25, 1.4]);
    assert_eq!(gas_numbers(&Gas::Isothermal { sound_speed: 340.0 }), [1.0, 340.0]);
    assert_eq!(gas_numbers(&Gas::Isentropic { gamma: 1.4, density: 1.2, pressure: 1e5 }), [2.0, 1.4, 1.2, 1e5]);
    let w = Primitive { density: 1.0, velocity: [2.0, 3.0], pressure: 4.0 };
    let sides = [
        Boundary::Periodic,
        Boundary::Wall,
        Boundary::ZeroGradient,
        Boundary::FarField(w),
        Boundary::Inlet(w),
        Boundary::Outlet { pressure: 1.0 },
        Boundary::Reservoir { density: 1.0, pressure: 2.0 },
    ];
    for (kind, side) in sides.iter().enumerate() {
        assert_eq!(side_numbers(side)[0], kind as f64, "{side:?}");
    }
    assert_eq!(side_numbers(&sides[3])[1..], [1.0, 2.0, 3.0, 4.0]);
    let scheme = Scheme { riemann: Riemann::Rusanov, limiter: Limiter::Minmod, pressure: PressureForm::Paper };
    assert_eq!(scheme_numbers(&scheme), [2.0, 4.0, 1.0]);
    let usual = Scheme { riemann: Riemann::Hllc, limiter: Limiter::FirstOrder, pressure: PressureForm::Geometric };
    assert_eq!(scheme_numbers(&usual), [0.0; 3]);
}
