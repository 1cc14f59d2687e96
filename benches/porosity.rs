//! Time and error of porosity fields: `cargo bench -p voidage-benches --bench porosity`.
//!
//! One line a case: medians over several runs, on one thread and on all. Meshes that do not ship are measured where the
//! shared corpus is present.

use std::path::Path;
use voidage::geometry::bodies::Bodies;
use voidage::geometry::read;
use voidage::grid::{Edges, GridSpec, edges};
use voidage::porosity::Options;
use voidage_benches::porosity_seconds;
use voidage_tests::solids::{scene, sixteen_spheres};
use voidage_tests::truth::{Truth, fixture, shared};

const RUNS: usize = 9;

fn main() {
    println!("{:34} {:>15} {:>9} {:>9} {:>9} {:>9}", "case", "cells", "1 thread", "all", "max error", "max gap");
    let unit = Edges::cube(0.0, 1.0, 100);
    case("16 spheres of 362 points", &scene(&sixteen_spheres()), &unit, None);
    let skid = read(&fixture("cad_skid.stl"));
    let truth = Truth::read(&fixture("cad_skid.stl.npz"));
    case("cad_skid", &skid, &truth.edges(), Some(&truth));
    let fine = edges(&GridSpec::Cells([400, 260, 220], None), skid.bounds(), &mut Vec::new()).expect("a grid");
    case("cad_skid, fine", &skid, &fine, None);
    if let Some(corpus) = shared("corpus") {
        let huldra = read(&corpus.join("meshes/huldra_psup_region.stl"));
        let truth = Truth::read(&corpus.join("ground_truth/huldra_psup_region.stl.npz"));
        case("huldra_psup_region", &huldra, &truth.edges(), Some(&truth));
    }
}

fn read(path: &Path) -> Bodies {
    let mut bodies = Bodies::default();
    bodies.add(&read::read(path).expect("a mesh"), 1.0).expect("bodies");
    bodies
}

fn case(name: &str, bodies: &Bodies, edges: &Edges, truth: Option<&Truth>) {
    let [nx, ny, nz] = edges.cells();
    let runs = if nx * ny * nz > 10_000_000 { 3 } else { RUNS };
    let (one, _) = porosity_seconds(bodies, edges, 1, runs, Options::default());
    let (all, result) = porosity_seconds(bodies, edges, 0, runs, Options::default());
    let error = truth.map_or_else(|| "-".to_owned(), |t| format!("{:.1e}", t.compare(&result.beta).worst()));
    println!(
        "{name:34} {:>15} {:>7.1}ms {:>7.1}ms {error:>9} {:>9.1e}",
        format!("{nx}x{ny}x{nz}"),
        one * 1e3,
        all * 1e3,
        result.max_gap
    );
}
