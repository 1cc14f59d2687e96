//! Planes whose flow is kept.

use crate::kit::{Scratch, json, solve, solved, stderr};
use std::fs;

/// A stream along x through a channel of 2 x 1 x 1, with a box in it or without, and planes.
fn case(scene: &str, monitors: &str) -> String {
    format!(
        "[grid]\nx = {{ points = [0, 2], cells = [20] }}\ny = {{ points = [0, 1], cells = [8] }}\nz = {{ points = [0, 1], cells = [1] }}\n{scene}\
         [gas]\nmodel = \"ideal\"\ngamma = 1.4\n[initial]\nuniform = {{ rho = 1.2, u = 10, p = 1e5 }}\n\
         [boundary]\nx_min = {{ type = \"inlet\", rho = 1.2, u = 10 }}\nx_max = {{ type = \"outlet\", p = 1e5 }}\n\
         y_min = \"wall\"\ny_max = \"wall\"\n[time]\nmax_steps = 4\n[output]\nformats = []\nambient = 9e4\nmonitors = [{monitors}]\n"
    )
}

/// The last line of the table by columns.
fn last(at: &Scratch) -> impl Fn(&str) -> f64 {
    let text = fs::read_to_string(at.file("out/monitors.csv")).expect("a table");
    let head: Vec<String> = text.lines().next().expect("a head").split(',').map(str::to_owned).collect();
    let line: Vec<String> = text.lines().last().expect("a line").split(',').map(str::to_owned).collect();
    move |column| line[head.iter().position(|h| h == column).expect(column)].parse().expect("a number")
}

#[test]
fn a_stream_passes_every_plane() {
    let at = Scratch::new();
    let planes = "{ x = 0 }, { name = \"middle\", x = 1.04 }, { name = \"out\", x = 2 }, \
                  { name = \"part\", x = 0.5, min = [9, 0.25], max = [9, 0.75] }, { name = \"across\", y = 0.5 }";
    solved(&at, &case("", planes), "out", &[]);
    let value = last(&at);
    for name in ["monitor 1", "middle", "out"] {
        let near = |column: &str, truth: f64| {
            let found = value(&format!("{name} {column}"));
            assert!((found - truth).abs() < 1e-9 * truth, "{name} {column}: {found}");
        };
        near("mass_flow", 12.0);
        near("volume_flow", 10.0);
        near("overpressure", 1e4);
        near("largest_overpressure", 1e4);
    }
    assert!((value("part mass_flow") - 6.0).abs() < 1e-8 && value("across mass_flow").abs() < 1e-9);
    let report = json(&at.file("out/report.json"));
    let of = |n: usize, key: &str| report["monitors"][n][key].as_f64().expect("a number");
    assert_eq!([of(1, "at"), of(1, "area"), of(3, "area")], [1.0, 1.0, 0.5]);
    assert!((of(4, "area") - 2.0).abs() < 1e-14);
    assert_eq!(report["monitors"][4]["axis"], "y");
    assert_eq!(of(3, "faces"), 4.0);
    assert_eq!(fs::read_to_string(at.file("out/monitors.csv")).expect("a table").lines().count(), 1 + 5);
}

/// Solids narrow a plane; one that they close altogether is told.
#[test]
fn solids_close_faces() {
    let at = Scratch::new();
    let solid = "[[solid]]\nshape = \"box\"\nmin = [0.9, -1, -1]\nmax = [1.2, 0.5, 2]\n";
    fs::write(at.file("box.toml"), solid).expect("a file");
    let planes = "{ name = \"gap\", x = 1 }, { name = \"wall\", x = 1, max = [9, 0.5] }";
    let text = stderr(&solved(&at, &case("[porosity]\nscene = \"box.toml\"\n", planes), "out", &[]));
    assert!(text.contains("key output.monitors[1]: \"wall\" has no open face: nothing passes it"), "{text}");
    let report = json(&at.file("out/report.json"));
    assert_eq!(report["monitors"][0]["area"].as_f64(), Some(0.5));
    assert_eq!(report["monitors"][1]["faces"].as_u64(), Some(0));
    let table = fs::read_to_string(at.file("out/monitors.csv")).expect("a table");
    assert!(table.lines().skip(1).all(|line| line.ends_with(",0,0,,")), "{table}");
}

/// A wall at a side of the domain closes its faces; a patch in it is open.
#[test]
fn nothing_passes_a_wall_of_the_domain() {
    let at = Scratch::new();
    let planes = "{ name = \"floor\", y = 0 }, { name = \"roof\", y = 1 }, { name = \"above\", y = 0.125 }, { name = \"in\", x = 0 }";
    let vent = "[[boundary.patch]]\nside = \"y_max\"\nmin = [0.5]\nmax = [0.9]\ntype = \"outlet\"\np = 1e5\n[time]";
    let text = stderr(&solved(&at, &case("", planes).replace("[time]", vent), "out", &[]));
    let told = "key output.monitors[0]: \"floor\" has no open face, it lies on a wall of the domain: nothing passes it";
    assert!(text.contains(told) && !text.contains("\"roof\" has"), "{text}");
    let report = json(&at.file("out/report.json"));
    let of = |key: &str| [0, 1, 2, 3].map(|n| report["monitors"][n][key].as_f64().expect("a number"));
    assert_eq!(of("faces"), [0.0, 4.0, 20.0, 8.0]);
    for (area, truth) in of("area").into_iter().zip([0.0, 0.4, 2.0, 1.0]) {
        assert!((area - truth).abs() < 1e-12 && area.is_sign_positive(), "{area} m², not {truth}");
    }
}

/// The table of a run that was resumed is that of the whole run.
#[test]
fn a_resumed_run_goes_on_with_its_table() {
    let (at, planes) = (Scratch::new(), "{ x = 1 }");
    let short = case("", planes).replace("max_steps = 4", "max_steps = 2");
    solved(&at, &case("", planes), "whole", &[]);
    solved(&at, &short, "out", &[]);
    solved(&at, &case("", planes), "out", &["--resume"]);
    let read = |dir: &str| fs::read(at.file(&format!("{dir}/monitors.csv"))).expect("a table");
    assert!(read("whole") == read("out"));
}

#[test]
fn planes_that_are_none_are_refused() {
    for (planes, words) in [
        ("{ x = 3 }", "key output.monitors[0].x: "),
        ("{ z = 0.5 }", "key output.monitors[0].z: the axis has one cell"),
        ("{ x = 1, y = 0.5 }", "key output.monitors[0]: takes only one of x, y and z"),
        ("{ name = \"a\" }", "key output.monitors[0]: needs one of x, y and z"),
        (
            "{ name = \"a\", x = 1 }, { name = \"a\", x = 1 }",
            "key output.monitors[1].name: \"a\" is the name of another",
        ),
        ("{ name = \"a\\nb\", x = 1 }", "key output.monitors[0].name: needs a name in one line"),
        ("{ x = 1, min = [0, 1], max = [0, 0] }", "key output.monitors[0].max: must not lie below min: along y"),
    ] {
        let at = Scratch::new();
        let output = solve(&at, &case("", planes), "out", &[]);
        let text = stderr(&output);
        assert!(!output.status.success() && text.contains(words), "{planes}: {text}");
    }
}

/// What a run goes on with is of the places that its tables began with; monitors may begin and end with it.
#[test]
fn places_of_tables_stay_what_they_were() {
    let (at, plane) = (Scratch::new(), "{ name = \"m\", x = 1 }");
    let with = |planes: &str, probe: &str, steps: u32| {
        let probes = format!("probes = [{{ name = \"p\", at = [{probe}, 0.5] }}]\n");
        case("", planes).replace("max_steps = 4", &format!("max_steps = {steps}")) + &probes
    };
    solved(&at, &with(plane, "0.5", 2), "out", &[]);
    for (planes, probe, of) in
        [("{ name = \"m\", x = 1.2 }", "0.5", "output.monitors"), (plane, "1.5", "output.probes")]
    {
        let text = stderr(&solve(&at, &with(planes, probe, 4), "out", &["--resume"]));
        assert!(text.contains(&format!("checkpoint.bin: is of a run with other {of}: leave")), "{text}");
    }
    // Neither costs the run its state.
    solved(&at, &with("", "0.5", 3), "out", &["--resume"]);
    solved(&at, &with("{ x = 0.5 }, { x = 1.5 }", "0.5", 4), "begun", &[]);
    solved(&at, &with("", "0.5", 2), "late", &[]);
    solved(&at, &with("{ x = 0.5 }, { x = 1.5 }", "0.5", 4), "late", &["--resume"]);
    let table = |dir: &str| fs::read_to_string(at.file(&format!("{dir}/monitors.csv"))).expect("a table");
    let (begun, late) = (table("begun"), table("late"));
    assert_eq!((begun.lines().count(), late.lines().count()), (6, 3));
    assert_eq!(begun.lines().last(), late.lines().last());
}

/// Volume is that of the gas where it comes from: from beyond an inlet, and from the other end of a periodic axis.
#[test]
fn volumes_through_sides_are_of_the_gas_outside() {
    let at = Scratch::new();
    let planes = "{ name = \"in\", x = 0 }, { name = \"end\", x = 2 }";
    let hot = case("", planes).replace("\"inlet\", rho = 1.2", "\"inlet\", rho = 0.3");
    solved(&at, &hot, "out", &[]);
    let value = last(&at);
    let found = value("in volume_flow") / value("in mass_flow");
    assert!((found - 1.0 / 0.3).abs() < 1e-9, "{found}");
    // Four times the density comes around from the last tenth.
    let around = case("", planes)
        .replace("{ type = \"inlet\", rho = 1.2, u = 10 }", "\"periodic\"")
        .replace("{ type = \"outlet\", p = 1e5 }", "\"periodic\"")
        .replace("[boundary]", "regions = [{ min = [1.8], rho = 4.8 }]\n[boundary]");
    solved(&at, &around, "out", &["--force"]);
    let value = last(&at);
    for name in ["in", "end"] {
        let found = value(&format!("{name} volume_flow"));
        assert!((found - 10.0).abs() < 0.2, "{name}: {found}");
    }
    assert_eq!(value("in mass_flow"), value("end mass_flow"));
    assert_eq!(value("in overpressure"), value("end overpressure"));
}
