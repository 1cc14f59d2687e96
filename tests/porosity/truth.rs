//! Every mesh with ground truth. The process skid and the analytic boxes ship with the tests; the other meshes are shared
//! data and are skipped, loudly, where they are absent.

use std::path::Path;
use voidage::geometry::bodies::Bodies;
use voidage::geometry::read;
use voidage::porosity::{Options, porosity};
use voidage_tests::truth::{Truth, fixture, shared};

/// Cells and faces of every set, unions included, are exact to rounding.
const EXACT: f64 = 1e-9;

/// Faces in the plane of a wall.
const WALL: f64 = 1e-9;

fn check(mesh: &Path, set: &Path) {
    let mut bodies = Bodies::default();
    bodies.add(&read::read(mesh).expect("a mesh"), 1.0).expect("bodies");
    let truth = Truth::read(set);
    let edges = truth.edges();
    let p = porosity(&edges.grid(None).expect("a grid"), &bodies, Options::default());
    let d = truth.compare(&p.beta);
    let name = set.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
    println!("{name:45} cell {:.1e} face {:.1e} wall {:.1e} gap {:.1e}", d.cell, d.face, d.wall, p.max_gap);
    // Where a union found no proof, the result says how far off it can be.
    let allowed = EXACT.max(p.max_gap);
    assert!(d.cell <= allowed && d.face <= allowed && d.wall <= WALL, "{name}: {d:?}");
    assert!(p.cells.ambiguous > 0 || p.max_gap == 0.0, "{name}: a gap without an overlap");
    assert!(p.max_gap <= 1e-4, "{name}: gap {}", p.max_gap);
}

#[test]
fn fixtures() {
    for (mesh, sets) in [
        ("cad_skid.stl", &["cad_skid.stl.npz", "cad_skid.stl_stretched.npz"][..]),
        (
            "analytic_boxes_aligned.stl",
            &[
                "analytic_boxes_aligned.stl.npz",
                "analytic_boxes_aligned.stl_coarse.npz",
                "analytic_boxes_aligned.stl_offset.npz",
            ],
        ),
    ] {
        for set in sets {
            check(&fixture(mesh), &fixture(set));
        }
    }
}

#[test]
fn shared_meshes() {
    let Some(corpus) = shared("corpus") else { return };
    let text = std::fs::read_to_string(corpus.join("ground_truth/index.json")).expect("an index");
    let index: Vec<serde_json::Value> = serde_json::from_str(&text).expect("JSON");
    assert!(index.len() >= 30);
    for entry in index {
        let name = |key: &str| entry[key].as_str().expect("a name").to_owned();
        check(&corpus.join("meshes").join(name("mesh")), &corpus.join("ground_truth").join(name("npz")));
    }
}

#[test]
fn all_solids_of_a_file_are_read() {
    let Some(corpus) = shared("corpus") else { return };
    let mesh = read::read(&corpus.join("meshes/cad_skid_ascii_multisolid.stl")).expect("a mesh");
    assert_eq!(mesh.solids.len(), 89);
    assert_eq!(mesh.triangles.len(), 19660);
    assert_eq!(mesh.solids[0].name, "main_beam");
}
