//! Time and error of subdivision by GJK: `cargo bench -p voidage-benches --bench subdivide`.
//!
//! One line a case: medians of the computation alone on one thread and on two, the solid found against the truth, the largest gap.
//! Finer tolerances than 1e-4 are left out: the faces that touch a ball need ever smaller parts, and 1e-5 takes hours. Solids by formula
//! need none of this (bench `solids`).

use std::f64::consts::PI;
use voidage::geometry::bodies::Bodies;
use voidage::geometry::form::Form;
use voidage::grid::Edges;
use voidage::porosity::{Leaf, Method, Options};
use voidage_benches::porosity_seconds;
use voidage_tests::solids::{formulas, scene, sixteen_balls, sixteen_spheres, volume};

const RUNS: usize = 5;

fn main() {
    println!("{:40} {:>9} {:>9} {:>9} {:>9} {:>9}", "case", "1 thread", "2", "solid", "max gap", "queries");
    let unit = Edges::cube(0.0, 1.0, 100);
    let solids = sixteen_spheres();
    let (spheres, truth) = (scene(&solids), solids.iter().map(|s| volume(s)).sum::<f64>());
    let gjk = Options { method: Method::Gjk, depth: 3, ..Options::default() };
    for (name, leaf) in [("solid", Leaf::Solid), ("half", Leaf::Half), ("plane", Leaf::Plane)] {
        let name = format!("16 spheres of 362 points, {name}, depth 3");
        case(&name, &spheres, &unit, Options { leaf, ..gjk }, truth);
    }
    let balls: Vec<Form> = sixteen_balls().into_iter().map(Form::Sphere).collect();
    let truth = 16.0 * 4.0 / 3.0 * PI * 0.11_f64.powi(3);
    case("16 balls, solid, depth 3", &formulas(&balls), &unit, Options { leaf: Leaf::Solid, ..gjk }, truth);
    for tol in [1e-3, 1e-4] {
        let name = format!("16 balls, plane, tol {tol:e}");
        case(&name, &formulas(&balls), &unit, Options { tol, method: Method::Gjk, ..Options::default() }, truth);
    }
}

fn case(name: &str, bodies: &Bodies, edges: &Edges, options: Options, truth: f64) {
    let (one, _) = porosity_seconds(bodies, edges, 1, RUNS, options);
    let (two, result) = porosity_seconds(bodies, edges, 2, RUNS, options);
    println!(
        "{name:40} {:>7.1}ms {:>7.1}ms {:>8.3}% {:>9.1e} {:>9}",
        one * 1e3,
        two * 1e3,
        (result.solid_volume / truth - 1.0) * 100.0,
        result.max_gap,
        result.gjk.queries
    );
}
