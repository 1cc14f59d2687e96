//! `voidage porosity`.

use crate::kit::{Scratch, array, fixture, json, stderr, stdout, voidage};
use std::fs;
use voidage::files::npy;

#[test]
fn a_run_with_everything() {
    let out = Scratch::new();
    let [npy_dir, vtr, png, report] = ["npy", "out.vtr", "out.png", "report.json"].map(|n| out.file(n));
    let output = voidage(&[
        &"porosity",
        &fixture("cad_skid.stl"),
        &"--cells",
        &"40x26x22",
        &"--npy",
        &npy_dir,
        &"-o",
        &vtr,
        &"--compress",
        &"--png",
        &png,
        &"--report",
        &report,
        &"--bounds-fields",
        &"-v",
    ]);
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(stdout(&output).contains("solid volume  9.166567214"), "{}", stdout(&output));
    assert_eq!(out.names(), ["npy", "out.png", "out.vtr", "report.json"]);
    let (shape, beta) = npy::read(&npy_dir.join("beta_v.npy")).expect("an array");
    assert_eq!(shape, [40, 26, 22]);
    assert_eq!(npy::read(&npy_dir.join("beta_y_upper.npy")).expect("an array").0, [40, 27, 22]);
    let report = json(&report);
    assert_eq!(report["grid"]["cells"], serde_json::json!([40, 26, 22]));
    assert_eq!(report["bodies"], 123);
    assert!(report["max_gap"].as_f64().expect("a gap") <= 1e-4);
    assert!(report["seconds"]["porosity"].as_f64().is_some());
    let cells = &report["cells"];
    let count = |k: &str| cells[k].as_u64().expect("a count") as usize;
    assert_eq!(count("open") + count("cut") + count("closed"), beta.len());
    assert_eq!(count("closed"), beta.iter().filter(|&&b| b == 0.0).count());
}

/// Where cells have bounds, so has the volume: the sums of theirs, which hold the truth.
#[test]
fn the_solid_volume_has_the_bounds_of_its_cells() {
    let at = Scratch::new();
    let ball = "[[solid]]\nshape = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\n[grid]\norigin = [-2, -2, -2]\nspacing = [0.5, 0.5, 1]\ncells = [8, 8, 4]\n";
    fs::write(at.file("ball.toml"), ball).expect("written");
    let (scene, report, arrays) = (at.file("ball.toml"), at.file("report.json"), at.file("npy"));
    let run = |more: &[&dyn AsRef<std::ffi::OsStr>]| {
        let mut all: Vec<&dyn AsRef<std::ffi::OsStr>> =
            vec![&"porosity", &scene, &"--report", &report, &"--npy", &arrays];
        all.extend(more);
        let output = voidage(&all);
        assert!(output.status.success(), "{}", stderr(&output));
        (stdout(&output), json(&report)["solid_volume_bounds"].clone())
    };
    let (told, bounds) = run(&[&"--method", &"gjk", &"--depth", &"2", &"--bounds-fields"]);
    let [low, high] = [0, 1].map(|n| bounds[n].as_f64().expect("a number"));
    let sum = |name: &str| {
        npy::read(&arrays.join(name)).expect("an array").1.iter().map(|open| (1.0 - open) * 0.25).sum::<f64>()
    };
    assert!(
        (low - sum("beta_v_upper.npy")).abs() < 1e-12 && (high - sum("beta_v_lower.npy")).abs() < 1e-12,
        "{bounds}"
    );
    let truth = 4.0 / 3.0 * std::f64::consts::PI;
    assert!(low < truth && truth < high && high - low < 0.5, "{bounds}");
    assert!(told.contains(" ± ") && !run(&[&"--bounds-fields"]).0.contains(" ± "), "{told}");
    assert!(run(&[]).1.is_null());
}

#[test]
fn any_number_of_threads_writes_the_same_bytes() {
    let run = |threads: &str| {
        let out = Scratch::new();
        let (npy_dir, vtr) = (out.file("npy"), out.file("skid.vtr"));
        let output = voidage(&[
            &"porosity",
            &fixture("cad_skid.stl"),
            &"--spacing",
            &"0.2",
            &"--threads",
            &threads,
            &"--npy",
            &npy_dir,
            &"-o",
            &vtr,
            &"-q",
        ]);
        assert!(output.status.success() && output.stdout.is_empty(), "{}", stderr(&output));
        let fields = ["beta_v", "beta_x", "beta_y", "beta_z"]
            .map(|f| fs::read(npy_dir.join(format!("{f}.npy"))).expect("a field"));
        // The command line is in the file; the numbers behind it must agree.
        let picture = fs::read(vtr).expect("a file");
        let appended = picture.windows(12).position(|w| w == b"AppendedData").expect("appended data");
        (fields, picture[appended..].to_vec())
    };
    let one = run("1");
    for threads in ["2", "7"] {
        let other = run(threads);
        assert!(one.0 == other.0, "{threads} threads: arrays");
        assert!(one.1.len().abs_diff(other.1.len()) <= 8, "{threads} threads: picture");
    }
}

#[test]
fn units_scale_the_geometry() {
    let volume = |unit: &str| {
        let out = Scratch::new();
        let report = out.file("r.json");
        let output = voidage(&[
            &"porosity",
            &fixture("analytic_boxes_aligned.stl"),
            &"--cells",
            &"8x8x8",
            &"--unit",
            &unit,
            &"--report",
            &report,
        ]);
        assert!(output.status.success(), "{}", stderr(&output));
        json(&report)["solid_volume"].as_f64().expect("a volume")
    };
    let metres = volume("m");
    for (unit, length) in [("mm", 0.001), ("cm", 0.01), ("in", 0.0254), ("ft", 0.3048_f64)] {
        let expected = metres * length.powi(3);
        assert!((volume(unit) - expected).abs() < 1e-12 * expected, "{unit}");
    }
}

#[test]
fn grid_files_of_every_form() {
    let out = Scratch::new();
    let forms = [
        ("edges.toml", "x = [0, 1, 2.5, 4]\ny = [0, 4]\nz = [0.0, 4.0]\n", [3, 1, 1]),
        ("edges.json", "{\"nx\": 3, \"x\": [0, 1, 2, 4], \"y\": [0, 4], \"z\": [0, 4], \"uniform\": null}", [3, 1, 1]),
        ("marked.json", "\u{feff}{\"x\": [0, 4], \"y\": [0, 4], \"z\": [0, 4]}", [1, 1, 1]),
        ("uniform.toml", "origin = [0, 0, 0]\nspacing = [1, 2, 4]\ncells = [4, 2, 1]\n", [4, 2, 1]),
        (
            "segments.toml",
            "x = { points = [0, 2, 4], cells = [2, 4], ratios = [1, -2] }\ny = { points = [0, 4], cells = [3] }\nz = [0, 4]\n",
            [6, 3, 1],
        ),
    ];
    for (name, text, cells) in forms {
        let (grid, npy_dir) = (out.file(name), out.file("npy"));
        fs::write(&grid, text).expect("written");
        let output =
            voidage(&[&"porosity", &fixture("analytic_boxes_aligned.stl"), &"--grid", &grid, &"--npy", &npy_dir]);
        assert!(output.status.success(), "{name}: {}", stderr(&output));
        assert!(!stderr(&output).contains("key"), "{name}: {}", stderr(&output));
        assert_eq!(npy::read(&npy_dir.join("beta_v.npy")).expect("an array").0, cells, "{name}");
    }
}

#[test]
fn cells_of_a_segment_grow_by_one_factor() {
    let out = Scratch::new();
    let file = out.file("grid.toml");
    let (n, mut warnings) = (100, Vec::new());
    for ratio in [1.000_001, 1.0 + 1e-10, 1.0 - 3e-12, 1.5, -7.0, 1e10] {
        let x = format!("x = {{ points = [0, 100], cells = [{n}], ratios = [{ratio}] }}\ny = [0, 1]\nz = [0, 1]\n");
        fs::write(&file, x).expect("written");
        let edges = voidage::grid::file::read(&file, &mut warnings).expect("a grid").0;
        let widths: Vec<f64> = edges[0].windows(2).map(|e| e[1] - e[0]).collect();
        let last_by_first = if ratio < 0.0 { -1.0 / ratio } else { ratio };
        let factor = f64::powf(last_by_first, 1.0 / f64::from(n - 1));
        // Edges are rounded to 1e-14, and their exponents before that.
        let rounding = 1e-13 * (1.0 + last_by_first.ln().abs());
        for pair in widths.windows(2) {
            assert!((pair[1] - factor * pair[0]).abs() < rounding, "{ratio}: {pair:?}");
        }
    }
}

#[test]
fn what_a_grid_file_says_twice_is_warned_of() {
    let out = Scratch::new();
    let grid = out.file("grid.json");
    fs::write(&grid, "{\"x\": [0, 1], \"y\": [0, 1], \"z\": [0, 1], \"origin\": [5, 5, 5]}").expect("written");
    let output = voidage(&[&"porosity", &fixture("analytic_boxes_aligned.stl"), &"--grid", &grid]);
    let message = stderr(&output);
    assert!(message.contains("grid.json: x, y, z are given; origin"), "{message}");
}

/// A box that has not numbers enough for its cells is told as it was given.
#[test]
fn a_box_too_far_from_the_origin_for_its_cells_is_told() {
    let scene = fixture("analytic_boxes_aligned.stl");
    for more in [["--cells", "64x4x4"], ["--spacing", "0.015625"]] {
        let mut all: Vec<&dyn AsRef<std::ffi::OsStr>> =
            vec![&"porosity", &scene, &"--bounds", &"1e15,0,0,1000000000000001,1,1"];
        all.extend(more.iter().map(|m| m as &dyn AsRef<std::ffi::OsStr>));
        let output = voidage(&all);
        let told =
            "grid: the box reaches from (1e15, 0, 0) to (1.000000000000001e15, 1, 1): it is too small, or too far";
        assert!(output.status.code() == Some(2) && stderr(&output).contains(told), "{}", stderr(&output));
    }
}

#[test]
fn errors_name_file_place_and_reason() {
    let out = Scratch::new();
    let grids = [
        ("x = [0, 2, 1]\ny = [0, 1]\nz = [0, 1]\n", "x[2]: edge 1 does not lie above the one before it, 2"),
        ("x = [0]\ny = [0, 1]\nz = [0, 1]\n", "key x: needs at least two edges"),
        ("x = [0, nan]\ny = [0, 1]\nz = [0, 1]\n", "x[1]: edge nan is not finite"),
        ("x = [0, 1]\ny = [0, 1]\nz = [0, \n", "line"),
        ("x = [0, 1]\n", "needs all of x, y, z"),
        (
            "x = [0, 1]\norigin = [0, 0, 0]\nspacing = [1, 1, 1]\ncells = [1, 1, 1]\n",
            "line 2, column 10: key origin: does not go with edges: a grid is x, y, z or origin, spacing, cells",
        ),
        ("x = [0, 1]\ny = [0, 1e300]\nz = [0, 1]\n", "key y: is too large: it reaches over 1e300 m"),
        ("x = [0, 1e300]\ny = []\nz = [1, 0]\n", "key x: is too large: it reaches over 1e300 m"),
        (
            "x = [0, 1e-320]\ny = [0, 1]\nz = [0, 1]\n",
            "key x: cells are too small to be computed with: the smallest is 1e-320 m wide",
        ),
        (
            "x = [0, 1]\ny = [0, 1]\nz = { points = [0, 1], cells = [1000], ratios = [1e300] }\n",
            "key z: cells are too small to be computed with",
        ),
        (
            "origin = [0, 0, 0]\nspacing = [1, 1, 1]\ncells = [10, 10, 4000000000]\n",
            "key cells: 10 × 10 × 4000000000 cells",
        ),
        ("[1, 2]", "a grid is a table"),
        ("cells = [3, 3, 3]\n", "needs x, y, z or origin, spacing, cells; origin, spacing are missing"),
        (
            "X = [0, 1]\ny = [0, 1]\nz = [0, 1]\n",
            "line 1, column 1: key X is not known here; did you mean x?\n   1 | X = [0, 1]\n     | ^\n",
        ),
        (
            "origin = [0, 0, 0]\nspacng = [1, 1, 1]\ncells = [1, 1, 1]\n",
            "line 2, column 1: key spacng is not known here; did you mean spacing?\n   2 | spacng = [1, 1, 1]\n     | ^^^^^^\n",
        ),
        ("x = { points = [0, 1], cells = [0] }\ny = [0, 1]\nz = [0, 1]\n", "key x: a segment needs at least one cell"),
    ];
    for (text, reason) in grids {
        let grid = out.file(if text.starts_with('[') { "bad.toml.json" } else { "bad.toml" });
        fs::write(&grid, text).expect("written");
        let output = voidage(&[&"porosity", &fixture("analytic_boxes_aligned.stl"), &"--grid", &grid]);
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{text}: {message}");
        assert!(message.contains("bad.toml") && message.contains(reason), "{text}: {message}");
    }
}

#[test]
fn misuse_exits_with_two() {
    let mesh = fixture("analytic_boxes_aligned.stl");
    let calls: [&[&str]; 10] = [
        &["--cells", "2000000000x1x1"],
        &["--cells", "10x10"],
        &["--cells", "0x1x1"],
        &["--cells", "100000x100000x100000"],
        &["--spacing", "-1"],
        &["--spacing", "1e-300"],
        &["--bounds", "0,0,0,1,1,0"],
        &["--tol", "7"],
        &["--threads", "0"],
        &["--unit", "furlong"],
    ];
    for call in calls {
        let mut arguments: Vec<&dyn AsRef<std::ffi::OsStr>> = vec![&"porosity", &mesh];
        arguments.extend(call.iter().map(|a| a as &dyn AsRef<std::ffi::OsStr>));
        let output = voidage(&arguments);
        assert_eq!(output.status.code(), Some(2), "{call:?}: {}", stderr(&output));
    }
    assert_eq!(voidage(&[&"porosity"]).status.code(), Some(2));
    // A negative number is a value that is wrong, not an option that is not known.
    for (option, reason) in
        [("--tol", "needs a fraction from 0 to 1"), ("--depth", "needs a whole number from 0 to 10")]
    {
        let message = stderr(&voidage(&[&"porosity", &mesh, &option, &"-1"]));
        assert!(message.contains(reason), "{option}: {message}");
    }
}

#[test]
fn a_leaf_without_a_subdivision_is_said() {
    let mesh = fixture("analytic_boxes_aligned.stl");
    let told = |more: &[&str]| {
        let mut arguments: Vec<&dyn AsRef<std::ffi::OsStr>> = vec![&"porosity", &mesh, &"--cells", &"4x4x4"];
        arguments.extend(more.iter().map(|a| a as &dyn AsRef<std::ffi::OsStr>));
        stderr(&voidage(&arguments)).contains("--leaf has no effect")
    };
    assert!(told(&["--leaf", "solid"]));
    assert!(!told(&["--leaf", "solid", "--method", "gjk"]) && !told(&[]));
}

#[test]
fn a_target_that_cannot_be_written_is_named() {
    let out = Scratch::new();
    std::fs::write(out.file("no"), "a file").expect("written");
    let target = out.file("no/such/place.vtr");
    let output = voidage(&[&"porosity", &fixture("analytic_boxes_aligned.stl"), &"--cells", &"4x4x4", &"-o", &target]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("place.vtr"), "{}", stderr(&output));
    assert_eq!(out.names(), ["no"]);
}

/// Before any work: the mesh, which is missing, is not even looked for.
#[test]
#[cfg(target_os = "linux")]
fn a_directory_that_takes_no_file_is_found_first() {
    let output = voidage(&[&"porosity", &"missing.stl", &"--cells", &"4x4x4", &"-o", &"/proc/place.vtr"]);
    assert_eq!(output.status.code(), Some(1));
    let said = stderr(&output);
    assert!(said.contains("/proc/place.vtr") && !said.contains("missing.stl"), "{said}");
}

#[test]
fn control_characters_of_names_do_not_reach_the_terminal() {
    let output = voidage(&[&"porosity", &"red\u{1b}[31m.stl", &"--cells", &"4x4x4"]);
    let said = stderr(&output);
    assert!(said.contains("red\\u{1b}[31m.stl") && !said.contains('\u{1b}'), "{said:?}");
}

/// Killed at any moment, a run leaves either no file of the final name or a whole one.
#[test]
#[cfg(unix)]
fn a_killed_run_leaves_nothing_that_looks_whole() {
    for delay in [5, 20, 40, 80, 160] {
        let out = Scratch::new();
        let npy_dir = out.file("npy");
        fs::create_dir(&npy_dir).expect("a directory");
        let mut child = std::process::Command::new(crate::kit::program())
            .args(["porosity", "--cells", "150x100x80", "-q", "--npy"])
            .arg(&npy_dir)
            .arg(fixture("cad_skid.stl"))
            .spawn()
            .expect("the program runs");
        std::thread::sleep(std::time::Duration::from_millis(delay));
        child.kill().expect("killed");
        child.wait().expect("gone");
        for (name, shape) in [("beta_v", [150, 100, 80]), ("beta_x", [151, 100, 80])] {
            let path = npy_dir.join(format!("{name}.npy"));
            if path.exists() {
                let (found, values) = npy::read(&path).expect("a whole file");
                assert_eq!(found, shape);
                assert_eq!(values.len(), shape.iter().product::<usize>());
            }
        }
    }
}

#[test]
fn completions_and_manual() {
    for shell in ["bash", "zsh", "fish"] {
        let output = voidage(&[&"completions", &shell]);
        assert!(output.status.success() && stdout(&output).contains("porosity"), "{shell}");
    }
    let output = voidage(&[&"man"]);
    let page = stdout(&output);
    for part in [".TH voidage", "voidage\\-porosity", "\\-\\-bounds\\-fields", "\\-\\-resume"] {
        assert!(page.contains(part), "{part}: {page}");
    }
}

/// The directories of all outputs are made; the one that --npy makes may hold the others.
#[test]
fn outputs_in_the_directory_of_the_arrays() {
    let out = Scratch::new();
    let dir = out.file("new");
    let skid = fixture("analytic_boxes_aligned.stl");
    let run = |vtr: &std::path::Path| {
        voidage(&[&"porosity", &skid, &"--cells", &"4x4x4", &"--npy", &dir, &"-o", &vtr, &"-q"])
    };
    let other = run(&out.file("other/one/out.vtr"));
    assert!(other.status.success() && out.file("other/one/out.vtr").is_file(), "{}", stderr(&other));
    let done = run(&dir.join("out.vtr"));
    assert!(done.status.success(), "{}", stderr(&done));
    assert!(dir.join("out.vtr").is_file() && dir.join("beta_z.npy").is_file());
    // The arrays themselves are outputs like any other.
    let twice = run(&dir.join("beta_v.npy"));
    assert_eq!(twice.status.code(), Some(2), "{}", stderr(&twice));
    assert!(stderr(&twice).contains("beta_v.npy: the suffix tells no format; known are .vtr"), "{}", stderr(&twice));
    let mesh = dir.join("beta_x.npy");
    fs::copy(&skid, &mesh).expect("copied");
    let over = voidage(&[&"porosity", &mesh, &"--cells", &"4x4x4", &"--npy", &dir]);
    assert_eq!(over.status.code(), Some(2), "{}", stderr(&over));
    assert_eq!(fs::read(&mesh).expect("readable"), fs::read(&skid).expect("readable"));
}

/// `--resistance`: six arrays more, of cells; what they mean together.
#[test]
fn resistance_writes_the_obstacles() {
    let dir = Scratch::new();
    let (npy, report) = (dir.file("npy"), dir.file("report.json"));
    let skid = fixture("cad_skid.stl");
    let all: [&dyn AsRef<std::ffi::OsStr>; 9] =
        [&"porosity", &skid, &"--cells", &"20x13x11", &"--resistance", &"--npy", &npy, &"--report", &report];
    let output = voidage(&all);
    assert!(output.status.success(), "{}", stderr(&output));
    let [beta, s, d_h, l_obs] = ["beta_v", "s", "d_h", "l_obs"].map(|name| array(&npy.join(format!("{name}.npy"))));
    assert_eq!(s.len(), 20 * 13 * 11);
    for (cell, (&s, &beta)) in s.iter().zip(&beta).enumerate() {
        if s > 0.0 {
            assert!((d_h[cell] * s - 4.0 * beta).abs() < 1e-12 && (l_obs[cell] * s - 4.0 * (1.0 - beta)).abs() < 1e-12);
        } else {
            assert_eq!([d_h[cell], l_obs[cell]], [0.0; 2]);
        }
    }
    let obstacles = &json(&report)["obstacles"];
    let wetted = obstacles["wetted_area"].as_f64().expect("a number");
    assert!((wetted - 228.608_4).abs() < 1e-3 && obstacles["unproved"] == 0, "{obstacles}");
    let refused = voidage(&[&"porosity" as &dyn AsRef<std::ffi::OsStr>, &skid, &"--resistance", &"--no-areas"]);
    assert_eq!(refused.status.code(), Some(2));
}
