//! `voidage inspect`.

use crate::kit::{fixture, stderr, stdout, voidage};
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
    // Two triangles, each with its back.
    assert_eq!(file("geo_double_sheet.stl", "sheets"), 2);
    assert_eq!(file("asc_multi_solid.stl", "solids"), 2);
}

#[test]
fn every_warning_is_in_the_json() {
    let report = inspect("bad_inputs/geo_open_missing_face.stl");
    let warnings = report["warnings"].as_array().expect("warnings");
    assert!(warnings.iter().any(|w| w.as_str().is_some_and(|w| w.contains("open: 4 boundary edges"))), "{warnings:?}");
}
