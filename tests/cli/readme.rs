//! What the README says is what holds: the output of its first command, the oldest compiler.

use crate::kit::{Scratch, program, solve, stderr, stdout};
use std::path::Path;
use std::process::Command;

fn repository() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}

fn readme() -> String {
    std::fs::read_to_string(repository().join("README.md")).expect("the README")
}

/// The first command prints what stands below it, the time aside.
#[test]
fn the_first_command_prints_what_the_readme_says() {
    let text = readme();
    let (commands, rest) = text.split_once("<!-- end -->").expect("the end of the commands");
    let command = commands.lines().find_map(|l| l.strip_prefix("cargo run --release -- ")).expect("a command");
    let block = rest.split_once("```text\n").and_then(|(_, b)| b.split_once("```")).expect("a block").0;
    let at = Scratch::new();
    let fixtures = repository().canonicalize().expect("a path").join("tests/fixtures/");
    let command = command.replace("tests/fixtures/", fixtures.to_str().expect("a path in UTF-8"));
    let output =
        Command::new(program()).args(command.split(' ')).current_dir(&at.0).output().expect("the program runs");
    assert!(output.status.success(), "{}", stderr(&output));
    let lines = |text: &str| -> Vec<String> {
        text.lines().map(|l| if l.starts_with("time ") { "time".into() } else { l.to_owned() }).collect()
    };
    assert_eq!(lines(&stdout(&output)), lines(block));
}

/// The scene and the case of the README run as they stand there, and have nothing to warn of.
#[test]
fn the_scene_and_the_case_of_the_readme_run() {
    let (text, at) = (readme(), Scratch::new());
    let blocks: Vec<&str> = text.split("```toml\n").skip(1).filter_map(|part| part.split("```").next()).collect();
    let [scene, case] = blocks[..] else { panic!("{} blocks of TOML", blocks.len()) };
    std::fs::write(at.file("rack.toml"), scene).expect("a scene");
    let output = Command::new(program())
        .args(["porosity", "rack.toml", "--png", "rack.png"])
        .current_dir(&at.0)
        .output()
        .expect("the program runs");
    assert!(output.status.success() && output.stderr.is_empty(), "{}", stderr(&output));
    // The same case on cells of twice the size, which the grating fills, and not to its end.
    std::fs::write(at.file("rack.toml"), scene.replace("[2.9, 0, 0]", "[2.8, 0, 0]")).expect("a scene");
    let coarse = case.replace("[0.1, 0.1, 0.1]", "[0.2, 0.2, 0.2]").replace("[40, 20, 20]", "[20, 10, 10]");
    let short = coarse.replace("end = 0.01", "max_steps = 2");
    assert!(short.contains("max_steps") && coarse != case, "{case}");
    let output = solve(&at, &short, "blast", &[]);
    assert!(output.status.success() && output.stderr.is_empty(), "{}", stderr(&output));
    for name in ["flow.pvd", "probes.csv", "maxima/arrival.npy", "frames/pressure_0001.png", "report.json"] {
        assert!(at.file("blast").join(name).is_file(), "{name}");
    }
}

/// The oldest compiler is the same wherever it is named.
#[test]
fn the_oldest_compiler_is_named_alike() {
    let oldest = env!("CARGO_PKG_RUST_VERSION");
    assert!(readme().contains(&format!("With Rust {oldest} or later")), "{oldest}");
}
