//! Any triangles: seeded runs of the properties that the fuzzer drives, and its findings.

use voidage_tests::dirty::{
    any_file_is_measured_or_refused, any_scene_is_measured_or_refused, any_sizes_are_measured,
    any_triangles_are_measured, scenes_of_solids_are_measured_or_refused,
};
use voidage_tests::random::Random;

#[test]
fn random_triangles() {
    for seed in 0..1000 {
        let mut random = Random::new(seed);
        let count = 6 * (1 + random.below(40));
        let bytes: Vec<u8> = (0..count).map(|_| random.bits() as u8).collect();
        any_triangles_are_measured(&bytes);
    }
}

#[test]
fn random_sizes() {
    for seed in 0..1000 {
        let mut random = Random::new(seed);
        let count = 18 * (1 + random.below(20));
        let bytes: Vec<u8> = (0..count).map(|_| random.bits() as u8).collect();
        any_sizes_are_measured(&bytes);
    }
}

#[test]
fn random_scenes() {
    for seed in 0..500 {
        let mut random = Random::new(seed);
        let count = 1 + 28 * (1 + random.below(4));
        let bytes: Vec<u8> = (0..count).map(|_| random.bits() as u8).collect();
        scenes_of_solids_are_measured_or_refused(&bytes);
    }
}

#[test]
fn findings() {
    let dir = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("regressions");
    for (name, property) in [
        ("triangles", any_triangles_are_measured as fn(&[u8])),
        ("mesh_file", any_file_is_measured_or_refused),
        ("scene_file", any_scene_is_measured_or_refused),
        ("scene", scenes_of_solids_are_measured_or_refused),
    ] {
        let Ok(entries) = std::fs::read_dir(dir.join(name)) else { continue };
        for entry in entries {
            let path = entry.expect("an entry").path();
            println!("{}", path.display());
            property(&std::fs::read(path).expect("readable"));
        }
    }
}
