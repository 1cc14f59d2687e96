//! `voidage inspect`.

use crate::kit::{Scratch, fixture, stderr, stdout, voidage};
use serde_json::Value;

fn inspect(name: &str) -> Value {
    let output = voidage(&[&"inspect", &fixture(name), &"--json", &"-q"]);
    assert!(output.status.success(), "{}", stderr(&output));
    serde_json::from_slice(&output.stdout).expect("JSON")
}

#[test]
fn a_table_for_people() {
    let output = voidage(&[&"inspect", &fixture("cad_skid.stl")]);
    let text = stdout(&output);
    for row in ["triangles         78736", "bodies            123", "boundary edges    0", "9.263415382"] {
        assert!(text.contains(row), "{row}: {text}");
    }
}

/// Rims of sheets are closed, too, but nothing is capped: the row does not say so.
#[test]
fn rims_of_sheets_are_no_holes() {
    let at = Scratch::new();
    let sheet = at.write("sheet.obj", b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
    let output = voidage(&[&"inspect", &sheet]);
    let text = stdout(&output);
    assert!(text.contains("sheets            1") && text.contains("rims closed       "), "{text}");
    assert!(!(text + &stderr(&output)).contains("capped"), "{}", stderr(&output));
}

#[test]
fn numbers_for_machines() {
    let skid = inspect("cad_skid.stl");
    assert_eq!(skid["bodies"].as_array().expect("bodies").len(), 123);
    assert!(skid["overlapping_boxes"].as_u64().expect("a count") > 100);
    let file = |name: &str, key: &str| inspect(&format!("bad_inputs/{name}"))["files"][0][key].clone();
    assert_eq!(file("geo_open_missing_face.stl", "boundary_edges"), 4);
    assert_eq!(file("geo_open_missing_face.stl", "holes"), 1);
    assert_eq!(file("geo_flipped_one.stl", "turned"), 1);
    assert_eq!(file("geo_inside_out.stl", "inside_out"), 1);
    assert_eq!(file("geo_cavity.stl", "cavities"), 1);
    assert_eq!(file("geo_tjunction_crack.stl", "holes"), 0);
    assert_eq!(file("geo_duplicate_all.stl", "repeated"), 12);
    // Two triangles, each with its back: one sheet with two sides.
    assert_eq!(file("geo_double_sheet.stl", "sheets"), 1);
    assert_eq!(file("asc_multi_solid.stl", "solids"), 2);
}

#[test]
fn every_warning_is_in_the_json() {
    let report = inspect("bad_inputs/geo_open_missing_face.stl");
    let warnings = report["warnings"].as_array().expect("warnings");
    assert!(warnings.iter().any(|w| w.as_str().is_some_and(|w| w.contains("open: 4 boundary edges"))), "{warnings:?}");
}

#[test]
fn sizes_of_any_scale_have_their_digits() {
    let dir = crate::kit::Scratch::new();
    let scene = dir.file("grain.toml");
    let grain = "[[solid]]\nname = 'grain'\nshape = 'box'\nmin = [0, 0, 0]\nmax = [1e-7, 2e-7, 3e-7]\n";
    std::fs::write(&scene, grain).expect("written");
    let table = stdout(&voidage(&[&"inspect", &scene]));
    assert!(table.contains("6e-21") && table.contains("(0, 0, 0) to (1e-7, 2e-7, 3e-7)"), "{table}");
    let bar = dir.file("bar.obj");
    std::fs::write(&bar, "v 0 0 0\nv 10 0 0\nv 0 1e-6 0\nv 0 0 1e-6\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
        .expect("written");
    let table = stdout(&voidage(&[&"inspect", &bar]));
    assert!(table.contains("10 × 1e-6 × 1e-6 m"), "{table}");
    let summary = stdout(&voidage(&[&"porosity", &scene]));
    assert!(summary.contains("solid volume  6e-21 m³"), "{summary}");
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_is_told() {
    let full = std::fs::File::create("/dev/full").expect("writable");
    let mut command = std::process::Command::new(crate::kit::program());
    command.arg("inspect").arg(fixture("analytic_boxes_aligned.stl")).arg("--json").stdout(full);
    let output = command.output().expect("the program runs");
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("cannot write to standard output"), "{}", stderr(&output));
}
