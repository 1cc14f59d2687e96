//! Forces on single solids, against the force on all and against what each feels alone.

use crate::kit::{Scratch, array, json, solve, solved, stderr};
use std::collections::BTreeMap;
use std::fs;

/// The columns of `log.csv` by their names.
fn log(at: &Scratch, dir: &str) -> BTreeMap<String, Vec<f64>> {
    let text = fs::read_to_string(at.file(dir).join("log.csv")).expect("a log");
    let mut lines = text.lines();
    let names: Vec<String> = lines.next().expect("a head").split(',').map(str::to_owned).collect();
    let rows: Vec<Vec<f64>> = lines.map(|l| l.split(',').map(|x| x.parse().expect("a number")).collect()).collect();
    names.into_iter().enumerate().map(|(n, name)| (name, rows.iter().map(|r| r[n]).collect())).collect()
}

fn cube(name: &str, low: [f64; 3], side: f64) -> String {
    let high = low.map(|x| x + side);
    format!("[[solid]]\nname = \"{name}\"\nshape = \"box\"\nmin = {low:?}\nmax = {high:?}\n")
}

/// A stream of air along x through a box of 2.4 × 0.8 × 0.8 m.
fn case(u: f64, more: &str) -> String {
    format!(
        r#"
[grid]
x = {{ points = [0, 2.4], cells = [24] }}
y = {{ points = [0, 0.8], cells = [8] }}
z = {{ points = [0, 0.8], cells = [8] }}
[porosity]
scene = "scene.toml"
[gas]
model = "ideal"
gamma = 1.4
[initial]
uniform = {{ rho = 1.2, u = {u}, p = 1e5 }}
[boundary]
x_min = {{ type = "far-field", rho = 1.2, u = {u}, p = 1e5 }}
x_max = {{ type = "far-field", rho = 1.2, u = {u}, p = 1e5 }}
y_min = "wall"
y_max = "wall"
z_min = "wall"
z_max = "wall"
{more}
"#
    )
}

const AXES: [&str; 3] = ["x", "y", "z"];

/// Solids across the planes of the grid, touching and overlapping each other, with drag of what is hidden in cells; a porous screen askew to the grid.
#[test]
fn forces_on_solids_add_up_to_the_force_on_all() {
    let at = Scratch::new();
    let scene = [
        cube("tank", [0.53, 0.21, 0.17], 0.31),
        cube("lid", [0.81, 0.33, 0.3], 0.14),
        cube("bar", [1.43, 0.405, 0.0], 0.05),
        cube("pole", [1.61, 0.3, 0.3], 0.2),
        "[[solid]]\nname = \"screen\"\nshape = \"box\"\nmin = [1.8, -1, -1]\nmax = [2.1, 2, 2]\nporosity = 0.5\n\
         rotate = { axis = [0.2, 0.3, 1], angle = 35 }\n"
            .to_owned(),
    ];
    fs::write(at.file("scene.toml"), scene.concat()).expect("written");
    let more = "[drag]\nlaw = \"bluff\"\n[time]\nmax_steps = 40\n[output]\nformats = []\n";
    let paper = "[scheme]\npressure = \"paper\"\n";
    for (names, scheme) in
        [("[\"*\"]", ""), ("[\"tank\", \"bar\"]", ""), ("[\"lid\"]", ""), ("[\"*\"]", paper), ("[\"bar\"]", paper)]
    {
        solved(&at, &case(40.0, &format!("{more}forces = {names}\n{scheme}")), names, &["-q", "--force"]);
        let log = log(&at, names);
        let steps = log["time"].len();
        assert_eq!(steps, 41);
        for axis in AXES {
            let all = &log[&format!("force_{axis}")];
            let parts: Vec<&Vec<f64>> =
                log.iter().filter(|(n, _)| n.ends_with(&format!(" force_{axis}"))).map(|(_, v)| v).collect();
            assert!(parts.len() >= 2);
            for step in 0..steps {
                let sum: f64 = parts.iter().map(|p| p[step]).sum();
                let size: f64 = parts.iter().map(|p| p[step].abs()).sum::<f64>() + 1.0;
                assert!((sum - all[step]).abs() < 1e-12 * size, "{names} {axis} {step}: {sum} {}", all[step]);
            }
        }
        let report = json(&at.file(names).join("report.json"));
        let last = report["forces"].as_array().expect("forces").iter();
        for solid in last {
            let name = solid["name"].as_str().expect("a name");
            for (a, axis) in AXES.iter().enumerate() {
                let logged = *log[&format!("{name} force_{axis}")].last().expect("a line");
                assert_eq!(solid["force"][a].as_f64().expect("a number"), logged, "{name}");
            }
        }
        // Resumed with no step left, nothing changes.
        solved(&at, &case(40.0, &format!("{more}forces = {names}\n{scheme}")), names, &["-q", "--resume"]);
        assert_eq!(json(&at.file(names).join("report.json"))["forces"], report["forces"], "{names}");
    }
}

/// A leg that goes askew through a wall of the domain feels the pressure above the ambient one on its section there, and a brace between two walls nothing.
#[test]
fn what_goes_askew_through_walls_feels_its_section() {
    let at = Scratch::new();
    let leg = "[[solid]]\nname = \"leg\"\nshape = \"cylinder\"\nfrom = [1.17, 0.26, -0.4]\nto = [1.13, 0.54, 0.4]\nradius = 0.047\n";
    let brace = "[[solid]]\nname = \"brace\"\nshape = \"box\"\nmin = [0.5, -0.5, 0.41]\nmax = [0.56, 1.5, 0.47]\n\
                 rotate = { axis = \"z\", angle = 27 }\n";
    fs::write(at.file("scene.toml"), [leg, brace].concat()).expect("written");
    let more = "[time]\nmax_steps = 1\n[output]\nformats = []\nambient = 4e4\nforces = [\"leg\", \"brace\"]\n";
    solved(&at, &case(0.0, more), "out", &["-q"]);
    let log = log(&at, "out");
    let way = [-0.04, 0.28, 0.8_f64];
    let cosine = way[2] / way.iter().map(|x| x * x).sum::<f64>().sqrt();
    let along_z = -6e4 * std::f64::consts::PI * 0.047 * 0.047 / cosine;
    for (name, axis, force) in [
        ("leg", "x", 0.0),
        ("leg", "y", 0.0),
        ("leg", "z", along_z),
        ("brace", "x", 0.0),
        ("brace", "y", 0.0),
        ("brace", "z", 0.0),
    ] {
        let found = log[&format!("{name} force_{axis}")][0];
        assert!((found - force).abs() < 1e-6, "{name} along {axis}: {found} N, not {force}");
    }
}

/// Gas at rest pushes no solid, wherever it stands.
#[test]
fn a_cube_in_gas_at_rest_feels_nothing() {
    let at = Scratch::new();
    for (n, low) in [[0.8, 0.3, 0.3], [0.77, 0.28, 0.31], [0.05, 0.21, 0.43]].into_iter().enumerate() {
        fs::write(at.file("scene.toml"), cube("a", low, 0.2) + &cube("b", [1.51, 0.33, 0.3], 0.23)).expect("written");
        let more = "[time]\nmax_steps = 3\n[output]\nformats = []\nambient = 1\nforces = [\"a\", \"b\"]\n";
        let dir = format!("out{n}");
        solved(&at, &case(0.0, more), &dir, &["-q"]);
        // Some 1e5 Pa on faces of 0.04 m².
        for (name, values) in log(&at, &dir).iter().filter(|(name, _)| name.contains(" force_")) {
            assert!(values.iter().all(|f| f.abs() < 1e-9), "{name}: {values:?}");
        }
    }
}

/// Solids in cells side by side, whose faces are lowered for what stands between them: gas of one pressure pushes none of them, and where two
/// pressures meet at a thin wall the wall feels the difference, not what stands beside it.
#[test]
fn a_face_lowered_to_a_throat_belongs_to_the_solid_that_lowers_it() {
    let at = Scratch::new();
    let pipe = |name: &str, x: f64| {
        format!(
            "[[solid]]\nname = \"{name}\"\nshape = \"cylinder\"\nfrom = [{x}, 0, 0.45]\nto = [{x}, 0.8, 0.45]\nradius = 0.04\n"
        )
    };
    let ball = |name: &str, x: f64| {
        format!("[[solid]]\nname = \"{name}\"\nshape = \"sphere\"\ncenter = [{x}, 0.25, 0.25]\nradius = 0.04\n")
    };
    let row = [
        pipe("a", 0.55),
        pipe("b", 0.65),
        pipe("c", 0.85),
        ball("d", 1.95),
        ball("e", 2.05),
        cube("f", [2.11, 0.22, 0.21], 0.05),
    ];
    let beam = "[[solid]]\nname = \"behind\"\nshape = \"box\"\nmin = [1.31, 0, 0.41]\nmax = [1.39, 0.8, 0.49]\n";
    let wall = "[[solid]]\nname = \"wall\"\nshape = \"box\"\nmin = [1.245, -1, -1]\nmax = [1.255, 2, 2]\n";
    let scene = row.concat() + wall + &pipe("before", 1.14) + beam;
    fs::write(at.file("scene.toml"), scene).expect("written");
    let more = |initial: &str| {
        format!("{initial}[time]\nmax_steps = 2\n[output]\nformats = []\nambient = 1\nforces = [\"*\"]\n")
    };
    solved(&at, &case(0.0, &more("")), "rest", &["-q"]);
    let rest = log(&at, "rest");
    let forces: Vec<_> = rest.iter().filter(|(name, _)| name.contains(" force_")).collect();
    assert_eq!(forces.len(), 30);
    for (name, values) in forces {
        assert!(values.iter().all(|f| f.abs() < 1e-8), "{name}: {values:?}");
    }
    // The wall and the beam behind it stand in the middle of their cells; both lower the face towards the middle of the grid.
    for (edge, pushed, area) in [(1.2, "wall", 0.64), (1.3, "behind", 0.064)] {
        let high = format!("[[initial.regions]]\nmin = [0, 0, 0]\nmax = [{edge}, 0.8, 0.8]\np = 2e5\nrho = 1.2\n");
        let dir = format!("edge {edge}");
        solved(&at, &case(0.0, &more(&high)), &dir, &["-q"]);
        let log = log(&at, &dir);
        for name in ["a", "b", "c", "d", "e", "f", "wall", "before", "behind"] {
            let wanted = if name == pushed { 1e5 * area } else { 0.0 };
            let found = log[&format!("{name} force_x")][0];
            assert!((found - wanted).abs() < 1e-8 * 6.4e4, "edge {edge}, {name}: {found} N");
        }
    }
}

/// A rod of a millimetre beside a wall that closes a face of its cell has its own drag, and across a seam of a periodic axis nothing is pushed at rest.
#[test]
fn drag_goes_by_volume_and_seams_have_two_sides() {
    let at = Scratch::new();
    let rod = "[[solid]]\nname = \"rod\"\nshape = \"cylinder\"\nfrom = [1.15, 0, 0.45]\nto = [1.15, 0.8, 0.45]\nradius = 0.004\n";
    let wall = "[[solid]]\nname = \"wall\"\nshape = \"box\"\nmin = [1.21, -1, -1]\nmax = [1.22, 2, 2]\n";
    let more =
        "[drag]\nlaw = \"bluff\"\n[time]\nmax_steps = 1\n[output]\nformats = []\nambient = 1e5\nforces = [\"*\"]\n";
    let drag = |scene: &str, dir: &str| {
        fs::write(at.file("scene.toml"), scene).expect("written");
        let upward = case(0.0, more)
            .replace("uniform = { rho = 1.2, u = 0, p = 1e5 }", "uniform = { rho = 1.2, w = 20, p = 1e5 }");
        assert!(upward.contains("w = 20"));
        solved(&at, &upward, dir, &["-q"]);
        log(&at, dir)["rod force_z"][0]
    };
    let (alone, beside) = (drag(rod, "alone"), drag(&(rod.to_owned() + wall), "beside"));
    assert!(alone > 1e-3 && (beside / alone - 1.0).abs() < 1e-6, "{alone} N alone, {beside} N beside the wall");

    let seam = cube("a", [-0.05, 0.2, 0.2], 0.1) + &cube("b", [2.31, 0.22, 0.24], 0.07);
    fs::write(at.file("scene.toml"), seam).expect("written");
    let far = "{ type = \"far-field\", rho = 1.2, u = 0, p = 1e5 }";
    let ring = case(0.0, "[time]\nmax_steps = 1\n[output]\nformats = []\nambient = 1\nforces = [\"*\"]\n")
        .replace(far, "\"periodic\"");
    assert!(ring.contains("periodic"));
    solved(&at, &ring, "ring", &["-q"]);
    for (name, values) in log(&at, "ring").iter().filter(|(name, _)| name.starts_with("b force_")) {
        assert!(values.iter().all(|f| f.abs() < 1e-8), "{name}: {values:?}");
    }
}

/// A blast in front of a pipe, all mirrored about a plane through the middle of a row of cells: the pipe, which stands in those cells, is not pushed
/// aside, whichever faces are lowered and whichever cells are merged.
#[test]
fn a_mirrored_blast_pushes_nothing_aside() {
    let at = Scratch::new();
    let pipe = "[[solid]]\nname = \"tank\"\nshape = \"cylinder\"\nfrom = [1.2, 0.4, 0]\nto = [1.2, 0.4, 0.53]\nradius = 0.17\n";
    let thin =
        "[[solid]]\nname = \"rod\"\nshape = \"cylinder\"\nfrom = [0.9, 0.4, 0]\nto = [0.9, 0.4, 0.6]\nradius = 0.02\n";
    fs::write(at.file("scene.toml"), pipe.to_owned() + thin).expect("written");
    let blast = "[[initial.regions]]\ncenter = [0.5, 0.4, 0.4]\nradius = 0.2\np = 8e5\nrho = 2\n";
    let more = format!("{blast}[time]\nend = 1.5e-3\n[output]\nformats = []\nforces = [\"*\"]\n");
    let odd =
        case(0.0, &more).replace("y = { points = [0, 0.8], cells = [8] }", "y = { points = [0, 0.8], cells = [7] }");
    assert!(odd.contains("cells = [7]"));
    solved(&at, &odd, "out", &["-q"]);
    let log = log(&at, "out");
    for name in ["tank", "rod"] {
        let most = |axis: &str| log[&format!("{name} force_{axis}")].iter().fold(0.0_f64, |m, f| m.max(f.abs()));
        assert!(most("x") > 10.0, "{name}: {} N", most("x"));
        assert!(most("y") < 1e-6 * most("x"), "{name}: {} N aside of {} N", most("y"), most("x"));
    }
}

/// Two cubes 14 cells apart, for six steps, which reach two cells each: each as alone.
#[test]
fn two_cubes_apart_feel_what_each_feels_alone() {
    let at = Scratch::new();
    let cubes = [cube("front", [0.33, 0.28, 0.31], 0.22), cube("back", [1.93, 0.28, 0.31], 0.22)];
    let run = |dir: &str, scene: &str, names: &str| {
        fs::write(at.file("scene.toml"), scene).expect("written");
        let more = format!("[time]\nmax_steps = 6\n[output]\nformats = []\nforces = {names}\n");
        solved(&at, &case(30.0, &more), dir, &["-q"]);
        log(&at, dir)
    };
    let both = run("both", &cubes.concat(), "[\"front\", \"back\"]");
    let alone = [run("a", &cubes[0], "[\"front\"]"), run("b", &cubes[1], "[\"back\"]")];
    for (name, alone) in ["front", "back"].into_iter().zip(&alone) {
        for axis in AXES {
            let column = format!("{name} force_{axis}");
            let (f, g) = (&both[&column], &alone[&format!("force_{axis}")]);
            assert_eq!(f.len(), g.len());
            let most = g.iter().fold(1.0, |m: f64, x| m.max(x.abs()));
            for (a, b) in f.iter().zip(g) {
                assert!((a - b).abs() < 1e-9 * most, "{column}: {a} {b}");
            }
        }
        assert!(both[&format!("{name} force_x")].iter().any(|f| f.abs() > 1.0), "{name} feels something");
    }
    assert!(both["others force_x"].iter().all(|f| *f == 0.0));
}

/// Copies of an array and parts of a file go by the name of their solid; a part may be asked for by its own.
#[test]
fn copies_and_parts_are_one_solid() {
    let at = Scratch::new();
    let rack = cube("rack", [0.53, 0.21, 0.17], 0.2) + "array = { count = [2, 1, 2], step = [0.5, 0, 0.3] }\n";
    let parts = "o a\nv 1.6 .2 .2\nv 1.8 .2 .2\nv 1.6 .4 .2\nv 1.6 .2 .4\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n\
                 o b\nv 1.6 .5 .2\nv 1.8 .5 .2\nv 1.6 .7 .2\nv 1.6 .5 .4\nf 5 7 6\nf 5 6 8\nf 5 8 7\nf 6 7 8\n";
    fs::write(at.file("parts.obj"), parts).expect("written");
    let file = "[[solid]]\nname = \"tanks\"\nshape = \"file\"\npath = \"parts.obj\"\n";
    fs::write(at.file("scene.toml"), rack + file).expect("written");
    let run = |names: &str, dir: &str| {
        let more = format!("[time]\nmax_steps = 20\n[output]\nformats = []\nforces = {names}\n");
        solved(&at, &case(40.0, &more), dir, &["-q"]);
        log(&at, dir)
    };
    let all = run("[\"*\"]", "all");
    let last = |log: &BTreeMap<String, Vec<f64>>, name: &str| *log[&format!("{name} force_x")].last().expect("a line");
    assert!(last(&all, "rack") > 1.0 && last(&all, "tanks") > 0.1, "both feel the stream");
    assert_eq!(all.keys().filter(|k| k.ends_with(" force_x")).count(), 3, "rack, tanks, others: {:?}", all.keys());
    let parts = run("[\"tanks/a\", \"tanks\"]", "parts");
    assert_eq!(run("[\"tanks\", \"tanks/a\"]", "turned"), parts, "in whatever order they are asked for");
    let sum = last(&parts, "tanks/a") + last(&parts, "tanks");
    assert!((sum - last(&all, "tanks")).abs() < 1e-9 * sum.abs() && last(&parts, "tanks/a") != 0.0, "{sum}");
    assert!((last(&parts, "others") - last(&all, "rack")).abs() < 1e-9 * last(&all, "rack").abs());
}

/// Solids that lie outside the grid, all or one of them: said, with columns of zeros.
#[test]
fn solids_outside_the_grid_keep_their_columns() {
    let at = Scratch::new();
    let far = cube("far", [10.0, 0.0, 0.0], 1.0);
    let near = cube("near", [0.8, 0.3, 0.3], 0.2);
    for (scene, names) in [(far.clone(), "[\"*\"]"), (far.clone(), "[\"far\"]"), (far + &near, "[\"*\"]")] {
        fs::write(at.file("scene.toml"), scene).expect("written");
        let more = format!("[time]\nmax_steps = 2\n[output]\nformats = []\nforces = {names}\n");
        let output = solved(&at, &case(40.0, &more), "out", &["--force"]);
        let said = stderr(&output);
        assert!(
            said.contains("solid \"far\": without a part in the grid that no other name has: all forces on them are 0"),
            "{said}"
        );
        assert!(!said.contains("solid \"near\":"), "{said}");
        let log = log(&at, "out");
        for name in ["far", "others"] {
            for axis in AXES {
                assert_eq!(log[&format!("{name} force_{axis}")], [0.0; 3]);
            }
        }
        let report = json(&at.file("out/report.json"));
        let far = report["forces"].as_array().expect("forces").iter().find(|f| f["name"] == "far").expect("far");
        assert_eq!((&far["force"], &far["largest"]), (&serde_json::json!([0.0, 0.0, 0.0]), &serde_json::json!(0.0)));
    }
}

/// The largest forces over a run are those of its log, with their signs and times; of a run that was resumed they are those of the whole.
#[test]
fn largest_forces_over_the_run() {
    let at = Scratch::new();
    fs::write(at.file("scene.toml"), cube("tank", [0.53, 0.21, 0.17], 0.31)).expect("written");
    let wall = "x_min = { type = \"far-field\", rho = 1.2, u = 40, p = 1e5 }";
    let run = |steps: usize, log_every: usize, dir: &str, more: &[&str]| {
        let output = format!(
            "[time]\nmax_steps = {steps}\n[output]\nformats = []\nlog_every = {log_every}\nforces = [\"tank\"]\n"
        );
        let text = case(40.0, &output);
        assert!(text.contains(wall));
        solved(&at, &text.replace(wall, "x_min = \"wall\""), dir, more);
        json(&at.file(dir).join("report.json"))["forces"].clone()
    };
    let whole = run(60, 1, "whole", &["-q"]);
    let log = log(&at, "whole");
    let tank = &whole[0];
    for (a, axis) in AXES.iter().enumerate() {
        let forces = &log[&format!("tank force_{axis}")];
        let most = forces.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
        let first = forces.iter().position(|f| f.abs() == most).expect("one");
        assert_eq!(tank["peak"][a].as_f64(), Some(forces[first]), "{axis}");
        assert_eq!(tank["peak_time"][a].as_f64(), Some(log["time"][first]), "{axis}");
    }
    let sizes: Vec<f64> = (0..log["time"].len())
        .map(|n| AXES.map(|axis| log[&format!("tank force_{axis}")][n].powi(2)).iter().sum::<f64>().sqrt())
        .collect();
    let most = sizes.iter().copied().fold(0.0, f64::max);
    let first = sizes.iter().position(|s| *s == most).expect("one");
    assert!(first > 0 && first < 60, "the largest force is neither the first nor the last: {first}");
    assert_eq!((tank["largest"].as_f64(), tank["largest_time"].as_f64()), (Some(most), Some(log["time"][first])));
    // Lines of the log that are left out do not hide a peak, nor does a run that stops on the way.
    assert_eq!(run(60, 50, "seldom", &["-q"]), whole);
    run(first + 5, 1, "resumed", &["-q"]);
    assert_eq!(run(60, 1, "resumed", &["-q", "--resume"]), whole);
}

/// A block in a ring of moving gas, open in part or altogether, and another with a resistance of its own in the same cells: each takes what its
/// resistance does, and both together what the gas loses.
#[test]
fn a_resistance_of_its_own_is_a_force_on_the_solid() {
    let at = Scratch::new();
    let block = |name: &str, [from, to]: [f64; 2], more: &str| {
        format!("[[solid]]\nname = \"{name}\"\nshape = \"box\"\nmin = [{from}, -1, -1]\nmax = [{to}, 2, 2]\n{more}\n")
    };
    let case = "[grid]\nx = { points = [0, 3], cells = [30] }\ny = { points = [0, 1], cells = [2] }\n[porosity]\nscene = \"scene.toml\"\n\
         [gas]\nmodel = \"ideal\"\ngamma = 1.4\n[initial]\nuniform = { rho = 1.2, p = 1e5, u = 30 }\n[boundary]\nx_min = \"periodic\"\n\
         x_max = \"periodic\"\ny_min = \"wall\"\ny_max = \"wall\"\n[time]\nend = 0.01\n[output]\nformats = []\nforces = [\"g\", \"h\"]\n";
    let forces = |scene: &str, dir: &str| {
        fs::write(at.file("scene.toml"), scene).expect("written");
        let output = solve(&at, case, dir, &["-q"]);
        assert!(output.status.success() && !stderr(&output).contains("without a part"), "{}", stderr(&output));
        let log = log(&at, dir);
        ["force_x", "g force_x", "h force_x", "others force_x"].map(|name| log[name].clone())
    };
    let sum = |of: &[f64]| of.iter().sum::<f64>();
    for (n, porosity) in [0.999, 1.0].into_iter().enumerate() {
        let more = |cr: f64| format!("porosity = {porosity}\ncr = {cr}");
        // Half a cell of each in the cell from 1.5 to 1.6.
        let scene = block("g", [1.0, 1.55], &more(20.0)) + &block("h", [1.55, 2.0], &more(5.0));
        let [all, g, h, others] = forces(&scene, &format!("out{n}"));
        assert!(sum(&all) > 100.0 && sum(&others).abs() < 1e-9 * sum(&all), "{} {}", sum(&all), sum(&others));
        assert!((sum(&g) + sum(&h) - sum(&all)).abs() < 1e-9 * sum(&all));
        let ratio = sum(&g) / sum(&h);
        // 0.55 · 20 against 0.45 · 5, and the gas comes slower to the second.
        assert!(ratio > 4.0 && ratio < 8.0, "porosity {porosity}: {ratio}");
    }
    // In the same cells the forces are as the resistances.
    let scene = block("g", [1.0, 2.0], "porosity = 1\ncr = 20") + &block("h", [1.0, 2.0], "porosity = 1\ncr = 5");
    let [all, g, h, _] = forces(&scene, "same");
    assert!((g[3] / h[3] - 4.0).abs() < 1e-9 && (g[3] + h[3] - all[3]).abs() < 1e-9 * all[3], "{} {}", g[3], h[3]);
}

#[test]
fn a_solid_that_is_not_there_is_told() {
    let at = Scratch::new();
    fs::write(at.file("scene.toml"), cube("a", [0.8, 0.3, 0.3], 0.2)).expect("written");
    let output = solve(&at, &case(0.0, "[time]\nmax_steps = 1\n[output]\nforces = [\"b\"]\n"), "out", &["-q"]);
    let text = stderr(&output);
    assert!(!output.status.success() && text.contains("output.forces[0]") && text.contains("\"b\""), "{text}");
}

/// Gas sloshes in a ring with a bar in one of its cells: what its momentum loses the bar feels, in both forms of the pressure.
#[test]
fn a_bar_in_a_ring_takes_what_the_gas_loses() {
    let at = Scratch::new();
    let bar = "[[solid]]\nname = \"bar\"\nshape = \"box\"\nmin = [0.42, 0.2, -1.0]\nmax = [0.48, 0.6, 2.0]\n";
    fs::write(at.file("scene.toml"), bar).expect("written");
    for (pressure, faces) in [("paper", "throat"), ("paper", "plane"), ("geometric", "throat"), ("geometric", "plane")]
    {
        let case = format!(
            "[grid]\nx = {{ points = [0, 1], cells = [10] }}\ny = [0, 1]\nz = [0, 1]\n[porosity]\nscene = \"scene.toml\"\n\
             faces = \"{faces}\"\n[gas]\nmodel = \"ideal\"\ngamma = 1.4\n[initial]\nuniform = {{ rho = 1.2, p = 1e5 }}\n\
             regions = [{{ max = [0.3], p = 2e5 }}]\n[boundary]\nx_min = \"periodic\"\nx_max = \"periodic\"\n[drag]\nlaw = \"none\"\n\
             [scheme]\npressure = \"{pressure}\"\n[time]\nmax_steps = 5\n[output]\nformats = [\"npy\"]\nforces = [\"*\"]\nambient = 1e5\n"
        );
        let dir = format!("{pressure} {faces}");
        solved(&at, &case, &dir, &["-q"]);
        let [rho, u] = ["rho", "u"].map(|name| array(&at.file(&dir).join(format!("final/{name}.npy"))));
        // The bar takes 0.6 × 0.4 of its cell.
        let open = |cell: usize| if cell == 4 { 1.0 - 0.6 * 0.4 } else { 1.0 };
        let lost = -(0..10).map(|cell| 0.1 * open(cell) * rho[cell] * u[cell]).sum::<f64>();
        let log = log(&at, &dir);
        let taken = |column: &str| (1..6).map(|n| log["dt"][n] * log[column][n]).sum::<f64>();
        for column in ["force_x", "bar force_x"] {
            assert!((taken(column) - lost).abs() < 1e-10, "{dir}: {column} takes {} of {lost}", taken(column));
        }
        // No wall of its own in any face: nothing to take.
        assert_eq!(lost.abs() < 1e-9, dir == "geometric plane", "{dir}: {lost}");
    }
}

/// The same space by other bodies differs in the last bits of its porosity; the flow does not care, though its numbers lie on limits of the solver.
#[test]
fn the_last_bits_of_the_porosity_do_not_matter() {
    let at = Scratch::new();
    let solid = "[[solid]]\nshape = \"box\"\nmin = [0.33, 0.45, 0.17]\nmax = [0.62, 0.79, 0.48]\n";
    let ball = "[[solid]]\nshape = \"sphere\"\ncenter = [0.45, 0.6, 0.3]\nradius = 0.08\n";
    let axis = "{ points = [0, 1], cells = [12] }";
    let run = |scene: String, dir: &str| {
        fs::write(at.file("scene.toml"), scene).expect("written");
        let sides: String = ["x", "y", "z"].map(|a| format!("{a}_min = \"wall\"\n{a}_max = \"wall\"\n")).concat();
        let case = format!(
            "[grid]\nx = {axis}\ny = {axis}\nz = {axis}\n[porosity]\nscene = \"scene.toml\"\n[gas]\nmodel = \"ideal\"\ngamma = 1.4\n\
             [initial]\nuniform = {{ rho = 1.2, p = 1e5, u = 30, v = 12, w = 7 }}\n[boundary]\n{sides}[drag]\nlaw = \"none\"\n\
             [time]\nmax_steps = 25\n[output]\nformats = []\nambient = 9e4\n"
        );
        solved(&at, &case, dir, &["-q"]);
        log(&at, dir)
    };
    let one = run(solid.to_owned(), "one");
    for (scene, dir) in [(solid.to_owned() + ball, "ball inside"), (solid.repeat(2), "twice")] {
        let other = run(scene, dir);
        for axis in AXES.map(|axis| format!("force_{axis}")) {
            for (a, b) in one[&axis].iter().zip(&other[&axis]) {
                assert!((a - b).abs() < 1e-6, "{dir}, {axis}: {a} {b}");
            }
        }
    }
}

/// Names with commas and quotes head columns in quotes (RFC 4180): those of solids, which stand in another file, of probes and of planes.
#[test]
fn names_with_commas_head_columns() {
    let at = Scratch::new();
    let scene = cube("tank, north", [0.53, 0.21, 0.17], 0.31) + &cube("3\\\" pipe", [1.43, 0.4, 0.0], 0.2);
    fs::write(at.file("scene.toml"), scene).expect("written");
    let output = "[output]\nformats = []\nforces = [\"*\"]\nprobes = [{ name = \"a, b\", at = [2, 0.1, 0.1] }]\n\
                  monitors = [{ name = 'the \"end\"', x = 2.4 }]\n";
    let more = |steps: usize| format!("[time]\nmax_steps = {steps}\n{output}");
    solved(&at, &case(40.0, &more(2)), "out", &["-q"]);
    solved(&at, &case(40.0, &more(4)), "out", &["-q", "--resume"]);
    let table = |name: &str| fs::read_to_string(at.file("out").join(name)).expect("a table");
    for (name, columns) in [
        ("log.csv", &["\"tank, north force_x\"", "\"3\"\" pipe force_y\"", "others force_z"][..]),
        ("probes.csv", &["\"a, b rho\"", "\"a, b p\""]),
        ("monitors.csv", &["\"the \"\"end\"\" mass_flow\""]),
    ] {
        let text = table(name);
        let mut lines = text.lines();
        let head = lines.next().expect("a head");
        columns.iter().for_each(|column| assert!(format!(",{head},").contains(&format!(",{column},")), "{head}"));
        let (mut cells, mut quoted) = (1, false);
        for c in head.chars() {
            quoted ^= c == '"';
            cells += usize::from(c == ',' && !quoted);
        }
        assert_eq!(lines.clone().count(), 5, "{name}");
        assert!(lines.all(|line| line.split(',').count() == cells), "{text}");
    }
    assert_eq!(json(&at.file("out/report.json"))["forces"][0]["name"], "tank, north");
}

/// Solids without names have a force all together; an empty name is none.
#[test]
fn solids_without_names_are_told_together() {
    let at = Scratch::new();
    let corners = [[1.0, 0.2, 0.2], [1.4, 0.6, 0.6]];
    let side = |axis: usize, high: usize| {
        let point = |u: usize, v: usize| {
            let mut p = [0.0; 3];
            (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) =
                (corners[high][axis], corners[u][(axis + 1) % 3], corners[v][(axis + 2) % 3]);
            p
        };
        let [a, b, c, d] = [point(0, 0), point(1, 0), point(1, 1), point(0, 1)];
        if high == 1 { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] }
    };
    let facets = (0..6).flat_map(|n| side(n / 2, n % 2));
    let facet = |[a, b, c]: [[f64; 3]; 3]| {
        let vertex = |p: [f64; 3]| format!("vertex {} {} {}\n", p[0], p[1], p[2]);
        format!("facet normal 0 0 0\nouter loop\n{}{}{}endloop\nendfacet\n", vertex(a), vertex(b), vertex(c))
    };
    fs::write(at.file("box.stl"), format!("solid\n{}endsolid\n", facets.map(facet).collect::<String>()))
        .expect("a file");
    let of = |forces: &str| {
        let more = format!("[time]\nmax_steps = 3\n[output]\nformats = []\nforces = [{forces}]\n");
        solve(&at, &case(20.0, &more).replace("scene.toml", "box.stl"), "out", &["--force"])
    };
    let done = of("\"*\"");
    assert!(done.status.success() && stderr(&done).contains("no solid of the scene has a name"), "{}", stderr(&done));
    let columns = log(&at, "out");
    assert_eq!(columns["others force_x"], columns["force_x"]);
    assert!(columns["force_x"].last().expect("a line").abs() > 0.1);
    assert!(stderr(&of("\"\"")).contains("is an empty text in place of a name"), "{}", stderr(&of("\"\"")));
}

/// Gas at rest, 1 bar above the surroundings, in a closed box. What lies inside a cell beside a wall of the box has gas on all sides; what stands on the wall has
/// not, nor has a false floor, below which the flow has no gas.
#[test]
fn obstacles_just_above_a_wall_have_gas_below() {
    let at = Scratch::new();
    let solid = |name: &str, [a, b]: [[f64; 3]; 2]| {
        format!("[[solid]]\nname = \"{name}\"\nshape = \"box\"\nmin = {a:?}\nmax = {b:?}\n")
    };
    let bars = [
        solid("low", [[0.52, -1.0, 0.01], [0.57, 2.0, 0.06]]),
        solid("high", [[0.82, -1.0, 0.75], [0.87, 2.0, 0.78]]),
        solid("aside", [[1.0, 0.01, 0.32], [2.0, 0.03, 0.38]]),
        solid("end", [[2.32, 0.31, 0.3], [2.38, 0.38, 0.5]]),
        solid("kerb", [[1.52, -1.0, -1.0], [1.57, 2.0, 0.05]]),
    ];
    let floor = solid("floor", [[-1.0, -1.0, 0.01], [3.0, 3.0, 0.03]]);
    for (scene, wanted) in [
        (bars.concat(), &[("low", 0.0), ("high", 0.0), ("aside", 0.0), ("end", 0.0), ("kerb", -1e5 * 0.05 * 0.8)][..]),
        (floor, &[("floor", -1e5 * 2.4 * 0.8)]),
    ] {
        fs::write(at.file("scene.toml"), scene).expect("written");
        let more = "[time]\nmax_steps = 3\n[output]\nformats = []\nambient = 1e5\nforces = [\"*\"]\n";
        let box_of_gas = case(0.0, more).replace("u = 0, p = 1e5 }\n[boundary]", "u = 0, p = 2e5 }\n[boundary]");
        let walls = box_of_gas.replace("{ type = \"far-field\", rho = 1.2, u = 0, p = 1e5 }", "\"wall\"");
        solved(&at, &walls, "out", &["-q", "--force"]);
        let log = log(&at, "out");
        for (n, axis) in AXES.iter().enumerate() {
            let mut sum = 0.0;
            for (name, force) in wanted {
                let (own, force) = (&log[&format!("{name} force_{axis}")], if n == 2 { *force } else { 0.0 });
                assert!(own.iter().all(|f| (f - force).abs() < 1e-6), "{name} along {axis}: {own:?}, not {force}");
                sum += force;
            }
            let all = &log[&format!("force_{axis}")];
            assert!(all.iter().all(|f| (f - sum).abs() < 1e-6), "along {axis}: {all:?}, not {sum}");
        }
    }
}

/// Solids of which few cells tell the shape are named; wide ones, and plates across the stream, are not.
#[test]
fn loads_on_what_few_cells_resolve_are_told() {
    let at = Scratch::new();
    let pipe =
        |radius: f64| format!("shape = \"cylinder\"\nfrom = [1, -1, 0.4]\nto = [1, 2, 0.4]\nradius = {radius}\n");
    let plate = |high: f64| format!("shape = \"box\"\nmin = [1, 0, 0]\nmax = [1.01, 0.8, {high}]\n");
    for (shape, words) in [
        (pipe(0.06), Some("output.forces: \"it\" is 0.12 m wide, 1.2 cells")),
        (pipe(0.2), None),
        (plate(0.12), Some("output.forces: \"it\" is 0.12 m wide, 1.2 cells")),
        (plate(0.5), None),
    ] {
        fs::write(at.file("scene.toml"), format!("[[solid]]\nname = \"it\"\n{shape}")).expect("written");
        let case = case(0.0, "[time]\nmax_steps = 1\n[output]\nforces = [\"it\"]\n");
        let text = stderr(&solved(&at, &case, "out", &["--force"]));
        assert_eq!(words.is_none(), !text.contains("cells: loads"), "{shape}: {text}");
        assert!(words.is_none_or(|words| text.contains(words)), "{shape}: {text}");
    }
}
