//! Pipes, suffixes, directories that are made, a full disk.

use crate::kit::{Scratch, fixture, json, program, stderr, stdout, voidage};
use std::fs::{self, File};
use std::io::Write;
use std::process::{Command, Output, Stdio};

/// Runs the command with `input` at its standard input.
fn piped(arguments: &[&str], input: &[u8], at: &Scratch) -> Output {
    let mut command = Command::new(program());
    command.args(arguments).current_dir(&at.0).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("the program runs");
    let mut pipe = child.stdin.take().expect("a pipe");
    let input = input.to_owned();
    let writer = std::thread::spawn(move || drop(pipe.write_all(&input))); // it may be closed early
    let output = child.wait_with_output().expect("the program ends");
    writer.join().expect("written");
    output
}

const SCENE: &str = "[[solid]]\nshape = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\n";

#[test]
fn a_surface_through_a_pipe() {
    let at = Scratch::new();
    let mesh = fixture("cad_skid.stl");
    let bytes = fs::read(&mesh).expect("a fixture");
    let summary = |text: String| text.lines().filter(|l| !l.starts_with("time")).map(str::to_owned).collect::<Vec<_>>();
    let through = piped(&["porosity", "-", "--spacing", "0.5"], &bytes, &at);
    assert!(through.status.success(), "{}", stderr(&through));
    assert_eq!(summary(stdout(&through)), summary(stdout(&voidage(&[&"porosity", &mesh, &"--spacing", &"0.5"]))));
    let scene = piped(&["porosity", "-", "--spacing", "0.5"], SCENE.as_bytes(), &at);
    assert!(stdout(&scene).contains("bodies        1 "), "{}", stderr(&scene));
    let grid = "x = [-2, 2]\ny = [-2, 2]\nz = [-2, 2]\n";
    let by_grid = piped(&["porosity", mesh.to_str().expect("a path"), "--grid", "-", "-q"], grid.as_bytes(), &at);
    assert!(by_grid.status.success(), "{}", stderr(&by_grid));
    for (arguments, words) in [
        (&["porosity", "-", "--grid", "-"][..], "- stands for the scene and --grid"),
        (&["porosity", "-", "--zones", "-", "--report", "r.json"], "- stands for the scene and --zones"),
        (&["porosity", "-", "-"], "- stands for one file of a scene"),
    ] {
        let twice = piped(arguments, SCENE.as_bytes(), &at);
        let said = stderr(&twice);
        assert!(twice.status.code() == Some(2) && said.contains("the standard input can be read once"), "{said}");
        assert!(said.contains(words), "{said}");
    }
    let wrong = piped(&["porosity", "-"], b"nothing of use\n", &at);
    assert_eq!(wrong.status.code(), Some(1));
    assert!(stderr(&wrong).contains("standard input: is neither"), "{}", stderr(&wrong));
    let empty = piped(&["inspect", "-"], b"", &at);
    assert!(stderr(&empty).contains("standard input: is empty"), "{}", stderr(&empty));
    assert!(at.names().is_empty());
}

/// Zones need no name; without one they are counted.
#[test]
fn zones_through_a_pipe() {
    let at = Scratch::new();
    fs::write(at.file("ball.toml"), SCENE).expect("a scene");
    let corner = "min = [0, 0, 0]\nmax = [1, 1, 1]\n";
    let zones = format!("[[zone]]\n{corner}[[zone]]\nname = \"corner\"\n{corner}[[zone]]\n{corner}");
    let arguments = ["porosity", "ball.toml", "--spacing", "0.5", "--zones", "-", "--report", "report.json", "-q"];
    let run = piped(&arguments, zones.as_bytes(), &at);
    assert!(run.status.success(), "{}", stderr(&run));
    let report = json(&at.file("report.json"));
    let rows = report["obstacles"]["congestion"].as_array().expect("a table");
    let names: Vec<&str> = rows.iter().filter_map(|row| row["zone"].as_str()).collect();
    assert_eq!(names, ["zone 1", "corner", "zone 3"]);
    let wrong = piped(&arguments, b"[[zone]]\nmin = [0, 0, 0]\n", &at);
    assert!(
        stderr(&wrong).contains("standard input: line 1, column 1: zone 1: key max is missing"),
        "{}",
        stderr(&wrong)
    );
}

#[test]
fn cases_through_a_pipe() {
    let at = Scratch::new();
    let case = stdout(&voidage(&[&"solve", &"--template"])).replace("end = 0.006", "max_steps = 1");
    let run = piped(&["solve", "-", "-o", "out", "-q"], case.as_bytes(), &at);
    assert!(run.status.success() && at.file("out/report.json").is_file(), "{}", stderr(&run));
    assert_eq!(piped(&["solve", "-"], case.as_bytes(), &at).status.code(), Some(2));
    let wrong = piped(&["solve", "-", "-o", "other"], b"[gas]\nmodel = 3\n", &at);
    assert!(stderr(&wrong).contains("standard input: line 2, column 9: key gas.model"), "{}", stderr(&wrong));
    let study = stdout(&voidage(&[&"study", &"--template"])).replace("repeats = 3", "repeats = 1");
    let run = piped(&["study", "-", "-q"], study.as_bytes(), &at);
    assert!(stdout(&run).starts_with("# A ball and a pipe"), "{}", stderr(&run));
}

/// A file of the run at the standard output is that file and nothing else.
#[test]
fn outputs_through_a_pipe() {
    let at = Scratch::new();
    fs::write(at.file("scene.toml"), SCENE).expect("written");
    let run = |arguments: &[&str]| {
        let output = piped(&[&["porosity", "scene.toml", "--spacing", "0.5"], arguments].concat(), b"", &at);
        assert!(output.status.success(), "{}", stderr(&output));
        output
    };
    let report = run(&["--report", "-"]);
    let value: serde_json::Value = serde_json::from_slice(&report.stdout).expect("JSON alone");
    assert_eq!(value["bodies"], 1);
    assert!(stderr(&report).contains("solid volume"), "{}", stderr(&report));
    assert!(run(&["--png", "-"]).stdout.starts_with(b"\x89PNG"));
    let fields = run(&["-o", "-"]).stdout;
    run(&["-o", "fields.vtr"]);
    // The command stands in the file.
    let whole = fs::read(at.file("fields.vtr")).expect("a file");
    assert!(fields.starts_with(b"<?xml") && fields.ends_with(b"</VTKFile>\n") && fields.len() + 100 > whole.len());
}

#[test]
fn the_suffix_tells_the_format() {
    let at = Scratch::new();
    fs::write(at.file("scene.toml"), SCENE).expect("written");
    let run = |arguments: &[&str]| {
        piped(&[&["porosity", "scene.toml", "--spacing", "0.5", "-q"], arguments].concat(), b"", &at)
    };
    for (name, start) in [("a/b.vtr", &b"<?xml"[..]), ("a/c/d.png", b"\x89PNG"), ("e/f.json", b"{")] {
        let output = run(&["-o", name]);
        assert!(output.status.success(), "{}", stderr(&output));
        assert!(fs::read(at.file(name)).expect("a file").starts_with(start), "{name}");
    }
    for (arguments, words) in [
        (
            &["-o", "out.vtu"][..],
            "out.vtu: the suffix tells no format; known are .vtr (fields for ParaView), .png (picture), .json",
        ),
        (&["-o", "out"], "out: the suffix tells no format"),
        (&["--png", "out.jpg"], "out.jpg: --png writes .png, not .jpg"),
        (&["--report", "out.yaml"], "out.yaml: --report writes .json, not .yaml"),
        (&["-o", "a.png", "--png", "b.png"], "b.png: --png and -o ask for the same"),
        (&["--slice", "x=0"], "--slice cuts a picture: give --png"),
        (&["--slice", "x=9", "--png", "a.png"], "--slice x=9: the grid reaches from"),
        (&["--slice", "x=1e17", "--png", "a.png"], "--slice x=1e17: the grid reaches from"),
        (&["--slice", "q=9", "--png", "a.png"], "the axis is x, y or z"),
        (&["--show", "a_w", "--png", "a.png"], "did you mean a_x? (known: beta_v, a_x, "),
        (&["--show", "s", "--resistance"], "--show s: give --png"),
        (&["--show", "s", "--png", "a.png"], "--show s: give --resistance"),
        (&["--show", "cr_x", "--png", "a.png", "--resistance"], "--show cr_x: give --drag"),
    ] {
        let output = run(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(stderr(&output).contains(words), "{words}: {}", stderr(&output));
    }
    assert_eq!(at.names(), ["a", "e", "scene.toml"]);
    let cut = |slice: &str| {
        let output = run(&["--png", "cut.png", "--slice", slice]);
        assert!(output.status.success(), "{}", stderr(&output));
        fs::read(at.file("cut.png")).expect("a picture")
    };
    assert!(cut("x=-0.9") != cut("x=0") && cut("x=0,y=0.9") != cut("x=0,y=0"));
}

/// What cannot be written is an error, be it a summary, the help or the version.
#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_at_the_standard_output() {
    let at = Scratch::new();
    fs::write(at.file("scene.toml"), SCENE).expect("written");
    let calls: [&[&str]; 7] = [
        &["porosity", "scene.toml"],
        &["porosity", "scene.toml", "--report", "-"],
        &["inspect", "scene.toml"],
        &["porosity", "--help"],
        &["--version"],
        &["man"],
        &["solve", "--template"],
    ];
    for arguments in calls {
        let full = File::create("/dev/full").expect("writable");
        let output =
            Command::new(program()).args(arguments).current_dir(&at.0).stdout(full).output().expect("the program runs");
        assert_eq!(output.status.code(), Some(1), "{arguments:?}");
        assert!(stderr(&output).contains("cannot write to standard output"), "{arguments:?}: {}", stderr(&output));
    }
}

/// A file that may not grow any further is an error as a full disk is, and leaves nothing half-written.
#[test]
#[cfg(target_os = "linux")]
fn a_limit_on_the_size_of_files() {
    let at = Scratch::new();
    fs::write(at.file("scene.toml"), SCENE).expect("written");
    for (n, output) in [["--npy", "."], ["-o", "out.vtr"]].into_iter().enumerate() {
        let mut shell = Command::new("sh");
        shell.args(["-c", "ulimit -f 8; exec \"$0\" \"$@\""]).arg(program());
        shell.args(["porosity", "scene.toml", "--cells", "30x30x30"]).args(output).current_dir(&at.0);
        let output = shell.output().expect("the program runs");
        assert_eq!(output.status.code(), Some(1), "{n}: {}", stderr(&output));
        assert!(stderr(&output).contains("cannot write: File too large"), "{}", stderr(&output));
        assert_eq!(at.names(), ["scene.toml"]);
    }
}

/// The standard output that is closed, or can only be read, takes no result; without one to print it is not needed.
#[cfg(target_os = "linux")]
#[test]
fn a_closed_standard_output_is_an_error() {
    let at = Scratch::new();
    fs::write(at.file("scene.toml"), SCENE).expect("written");
    let run = |stream: &str, arguments: &[&str]| {
        let line = format!("exec \"$0\" \"$@\" {stream}");
        let mut shell = Command::new("sh");
        shell.args(["-c", &line]).arg(program()).args(arguments).current_dir(&at.0).output().expect("the program runs")
    };
    let calls: [&[&str]; 8] = [
        &["porosity", "scene.toml"],
        &["porosity", "scene.toml", "--report", "-"],
        &["inspect", "scene.toml"],
        &["docs", "case"],
        &["--help"],
        &["--version"],
        &["completions", "bash"],
        &["solve", "--template"],
    ];
    for arguments in calls {
        for (stream, reason) in [(">&-", "it is closed"), ("1</dev/null", "Bad file descriptor")] {
            let output = run(stream, arguments);
            let words = format!("error: cannot write to standard output: {reason}");
            assert_eq!(output.status.code(), Some(1), "{stream} {arguments:?}");
            assert!(stderr(&output).contains(&words), "{stream} {arguments:?}: {}", stderr(&output));
        }
        assert_eq!(run(">/dev/null", arguments).status.code(), Some(0), "{arguments:?}");
    }
    let quiet = run(">&-", &["porosity", "scene.toml", "-q", "--npy", "beta"]);
    assert_eq!(quiet.status.code(), Some(0), "{}", stderr(&quiet));
    assert!(at.file("beta").join("beta_v.npy").is_file());
}

#[test]
fn the_version_tells_the_build() {
    let text = stdout(&voidage(&[&"--version"]));
    for word in [env!("CARGO_PKG_VERSION"), "commit ", "features cli pictures scene serde", "target   "] {
        assert!(text.contains(word), "{word}: {text}");
    }
    assert!(text.lines().last().is_some_and(|l| l.contains(std::env::consts::ARCH)), "{text}");
}

/// Every solid with its volume and its areas; groups of an OBJ keep their names.
#[test]
fn solids_are_told_one_by_one() {
    let at = Scratch::new();
    let cube = |lo: f64, first: usize| {
        let corner = |n: usize| [n & 1, n >> 1 & 1, n >> 2].map(|b| lo + b as f64);
        let corners: String = (0..8)
            .map(|n| {
                let [x, y, z] = corner(n);
                format!("v {x} {y} {z}\n")
            })
            .collect();
        let faces = [[1, 3, 4, 2], [5, 6, 8, 7], [1, 2, 6, 5], [3, 7, 8, 4], [1, 5, 7, 3], [2, 4, 8, 6]];
        let faces: String =
            faces.map(|f| format!("f {}\n", f.map(|n: usize| (n + first).to_string()).join(" "))).concat();
        (corners, faces)
    };
    let (one, other) = (cube(0.0, 0), cube(5.0, 8));
    fs::write(at.file("two.obj"), format!("{}g tank\n{}{}g pump house\n{}", one.0, one.1, other.0, other.1))
        .expect("written");
    let pipe = "[[solid]]\nname = \"pipe\"\nshape = \"cylinder\"\nfrom = [0, 0, 3]\nto = [4, 0, 3]\nradius = 0.5\narray = { count = [1, 2, 1], step = [0, 2, 0] }\n";
    fs::write(at.file("scene.toml"), format!("{pipe}{SCENE}")).expect("written");
    let output = voidage(&[
        &"porosity",
        &at.file("two.obj"),
        &at.file("scene.toml"),
        &"--spacing",
        &"1",
        &"--report",
        &at.file("r.json"),
        &"-q",
    ]);
    assert!(output.status.success(), "{}", stderr(&output));
    let report = json(&at.file("r.json"));
    let solids = report["solids"].as_array().expect("solids");
    let names: Vec<&str> = solids.iter().filter_map(|s| s["name"].as_str()).collect();
    assert_eq!(names, ["pipe", "solid 2", "tank", "pump house"]);
    let pi = std::f64::consts::PI;
    // Frontal area by axis, wetted area, volume; two pipes of length 4 and radius 1/2 with flat ends, a ball of radius 1.
    let truth = [
        ([0.5 * pi, 8.0, 8.0], 8.0 * pi + pi, 2.0 * pi),
        ([pi, pi, pi], 4.0 * pi, 4.0 / 3.0 * pi),
        ([1.0; 3], 6.0, 1.0),
        ([1.0; 3], 6.0, 1.0),
    ];
    for (solid, (frontal, wetted, volume)) in solids.iter().zip(truth) {
        let number = |v: &serde_json::Value| v.as_f64().expect("a number");
        let pairs = (0..3).map(|a| (number(&solid["frontal_area"][a]), frontal[a]));
        for (found, exact) in pairs.chain([(number(&solid["wetted_area"]), wetted), (number(&solid["volume"]), volume)])
        {
            assert!((found / exact - 1.0).abs() < 6e-4, "{found}, not {exact}: {solid}");
        }
    }
}

/// Where the standard error takes no more, the run goes on: nobody reads it.
#[cfg(target_os = "linux")]
#[test]
fn a_full_standard_error_is_no_failure() {
    let full = || fs::OpenOptions::new().write(true).open("/dev/full").expect("a device");
    let run = |arguments: &[&str]| {
        let mut command = Command::new(program());
        command.args(arguments).stderr(full()).output().expect("the program runs").status.code()
    };
    assert_eq!(run(&["inspect", "no.stl"]), Some(1));
    assert_eq!(run(&["docs", "no"]), Some(2));
    let scene = fixture("cad_skid.stl");
    let scene = scene.to_str().expect("a path");
    assert_eq!(run(&["porosity", scene, "--spacing", "0.5", "-v"]), Some(0));
    assert_eq!(run(&["porosity", scene, "--spacing", "0.5", "--no-such"]), Some(2));
}

/// Groups of an OBJ that a scene names keep their names, as parts of the solid: those that `output.forces` takes.
#[test]
fn parts_of_a_file_are_told_one_by_one() {
    let at = Scratch::new();
    let half = |name: &str, y: f64, first: usize| {
        let [a, b, c, d] = [1, 2, 3, 4].map(|n| n + first);
        format!(
            "g {name}\nv 0 {y} 0\nv 1 {y} 0\nv 0 {} 0\nv 0 {y} 1\nf {a} {c} {b}\nf {a} {b} {d}\nf {a} {d} {c}\nf {b} {c} {d}\n",
            y + 1.0
        )
    };
    let two = half("tank", 0.0, 0) + &half("pump house", 2.0, 4) + &half("tank", 4.0, 8);
    fs::write(at.file("two.obj"), &two).expect("written");
    fs::write(at.file("bare.obj"), half("", 0.0, 0).replace("g \n", "")).expect("written");
    let file = |name: &str, path: &str, more: &str| {
        format!("[[solid]]\nname = \"{name}\"\nshape = \"file\"\npath = \"{path}\"\n{more}")
    };
    let copies = "translate = [0, 0, 5]\narray = { count = [2, 1, 1], step = [3, 0, 0] }\n";
    let scene = file("yard", "two.obj", "") + &file("rack", "two.obj", copies) + &file("bare", "bare.obj", "");
    fs::write(at.file("scene.toml"), scene + SCENE).expect("written");
    let output =
        voidage(&[&"porosity", &at.file("scene.toml"), &"--spacing", &"1", &"--report", &at.file("r.json"), &"-q"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let report = json(&at.file("r.json"));
    let solids = report["solids"].as_array().expect("solids");
    let names: Vec<&str> = solids.iter().filter_map(|s| s["name"].as_str()).collect();
    assert_eq!(names, ["yard", "rack", "bare", "solid 4"]);
    let parts = |n: usize| {
        let parts = solids[n]["parts"].as_array().map_or(&[][..], Vec::as_slice);
        let of = |p: &serde_json::Value| {
            (p["name"].as_str().expect("a name").to_owned(), p["volume"].as_f64().expect("a volume"))
        };
        parts.iter().map(of).collect::<Vec<_>>()
    };
    let told = |n: usize, truth: &[(&str, f64)]| {
        let found = parts(n);
        assert_eq!(found.iter().map(|p| &p.0[..]).collect::<Vec<_>>(), truth.iter().map(|p| p.0).collect::<Vec<_>>());
        assert!(found.iter().zip(truth).all(|(a, b)| (a.1 - b.1).abs() < 1e-12), "{found:?}");
    };
    told(0, &[("yard/tank", 1.0 / 3.0), ("yard/pump house", 1.0 / 6.0)]);
    let copy = |i: usize, part: &str| format!("rack[{i},0,0]/{part}");
    let of_copies = [copy(0, "tank"), copy(0, "pump house"), copy(1, "tank"), copy(1, "pump house")];
    told(1, &[0, 1, 2, 3].map(|n| (&of_copies[n][..], if n % 2 == 0 { 1.0 / 3.0 } else { 1.0 / 6.0 })));
    assert!(solids[2]["parts"].is_null() && solids[3]["parts"].is_null(), "what has no parts has no list of them");
    let part = &solids[0]["parts"][1];
    let wetted = 1.5 + 0.75_f64.sqrt();
    assert!((part["wetted_area"].as_f64().expect("an area") - wetted).abs() < 1e-12, "{part}");
    assert_eq!(part["bounds"], serde_json::json!([[0.0, 2.0, 0.0], [1.0, 3.0, 1.0]]));
}

/// A scene through a pipe, however its list of solids is written.
#[test]
fn scenes_through_a_pipe() {
    let at = Scratch::new();
    let grid = "[grid]\nx = { points = [0, 2], cells = [2] }\ny = { points = [0, 2], cells = [2] }\nz = { points = [0, 2], cells = [2] }\n";
    let list = format!("solid = [{{ shape = \"sphere\", center = [1, 1, 1], radius = 0.5 }}]\n{grid}");
    let spaced = format!("{grid}[[ solid ]]\nshape = \"sphere\"\ncenter = [1, 1, 1]\nradius = 0.5\n");
    for text in [list, spaced] {
        let output = piped(&["porosity", "-", "-q", "--report", "out.json"], text.as_bytes(), &at);
        assert!(output.status.success(), "{}", stderr(&output));
    }
    let mut foreign = b"# Beh\xE4lter\n[[solid]]\nshape = \"sphere\"\ncenter = [1, 1, 1]\nradius = 0.5\n".to_vec();
    foreign.extend(grid.as_bytes());
    let output = piped(&["porosity", "-"], &foreign, &at);
    assert!(stderr(&output).contains("line 1, column 6"), "{}", stderr(&output));
}
