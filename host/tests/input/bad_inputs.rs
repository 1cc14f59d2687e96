//! The collection of bad inputs.

use std::path::Path;

use super::{is_sound, volume};
use voidage::geometry::read::read;

/// Cases whose volume is not the signed volume of the triangles as they stand: it is meant within a domain, or of a union.
const OTHER_VOLUME: [&str; 2] = ["bin_outside_domain.stl", "asc_multi_solid_overlap.stl"];
/// Cases that the fixtures leave out for their size; tests above generate the like.
const GENERATED: [&str; 4] =
    ["asc_name_10kB.stl", "asc_utf16.stl", "asc_multi_solid_same_name.stl", "random_bytes_5000.stl"];
/// Cases whose volume is known although the manifest leaves open whether they are read.
const WARNED: [&str; 5] = [
    "asc_missing_normal.stl",
    "asc_comment_lines.stl",
    "asc_binary_appended.stl",
    "obj_two_vertex_face.obj",
    "asc_garbage_after_end.stl",
];

#[test]
fn bad_inputs_behave_as_their_manifest_says() {
    let dir = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/fixtures/bad_inputs");
    if !dir.exists() && std::env::var("CI").as_deref() != Ok("true") {
        println!("SKIPPED: the package of this crate alone does not hold {}", dir.display());
        return;
    }
    let manifest: serde_json::Value =
        serde_json::from_slice(&std::fs::read(dir.join("manifest.json")).unwrap()).unwrap();
    let mut counts = std::collections::BTreeMap::new();
    for case in manifest["files"].as_array().unwrap() {
        let file = case["file"].as_str().unwrap();
        // Special files have tests of their own.
        if case["bytes"].is_null() || GENERATED.contains(&file) {
            continue;
        }
        let words: Vec<&str> =
            case["message_should_mention"].as_array().unwrap().iter().map(|word| word.as_str().unwrap()).collect();
        let expect = case["expect"].as_str().unwrap();
        let outcome = outcome(&dir.join(file), expect, case["solid_volume"].as_f64(), &words);
        *counts.entry((expect.to_string(), outcome)).or_insert(0) += 1;
    }
    assert_eq!(counts.values().sum::<i32>(), 129);
    let count = |expect: &str, outcome| counts.get(&(expect.to_string(), outcome)).copied().unwrap_or(0);
    assert_eq!(count("ok", "refused") + count("ok", "warned"), 0, "{counts:?}");
    assert_eq!(count("error", "read") + count("error", "warned"), 0, "{counts:?}");
}

fn outcome(path: &Path, expect: &str, solid_volume: Option<f64>, words: &[&str]) -> &'static str {
    let file = path.file_name().unwrap().to_str().unwrap();
    let is_geometry = file.starts_with("geo_");
    match read(path) {
        Err(error) => {
            let message = error.to_string();
            assert!(matches!(expect, "error" | "warn_or_error"), "{message}");
            assert!(!is_geometry, "{message}");
            for word in words.iter().chain([&file]) {
                assert!(message.to_lowercase().contains(&word.to_lowercase()), "no `{word}` in: {message}");
            }
            "refused"
        }
        Ok(mesh) => {
            is_sound(&mesh);
            assert_ne!(expect, "error", "{file} was read");
            let expected = solid_volume.or(WARNED.contains(&file).then_some(2.0));
            if let Some(expected) = expected.filter(|_| !is_geometry && !OTHER_VOLUME.contains(&file)) {
                let volume = volume(&mesh) * if file == "bin_units_mm.stl" { 1e-9 } else { 1.0 };
                assert!((volume - expected).abs() <= 1e-5 * expected.abs() + 1e-30, "{file}: {volume}");
            }
            // Silence is right only where reading found nothing odd.
            let must_warn = expect == "warn_or_error" && !is_geometry && file != "bin_huge_3e38.stl";
            assert!(!must_warn || !mesh.warnings.is_empty(), "{file} was read without a warning");
            if mesh.warnings.is_empty() { "read" } else { "warned" }
        }
    }
}
