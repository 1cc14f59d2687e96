//! One file of boxes against coordinate compression: however they touch, and in whatever order their triangles come.

use rayon::prelude::*;
use voidage_tests::boxes::{Visited, bounds_hold};

/// Every value of random scenes lies within its bounds; where all boxes look the same way and have one side, the bounds are one value
/// nearly everywhere.
#[test]
fn random_boxes() {
    let run = |seed: u64| bounds_hold(seed).unwrap_or_else(|text| panic!("{text}"));
    let visited: Vec<Visited> = (0..3000).into_par_iter().map(run).collect();
    let count = |what: fn(&Visited) -> bool| visited.iter().filter(|v| what(v)).count();
    let one_way = count(|v| v.defined && !v.two_sided && !v.flipped);
    let exact = count(|v| v.defined && !v.two_sided && !v.flipped && v.exact);
    assert!(one_way > 1100 && exact * 100 >= one_way * 98, "{exact} exact of {one_way}");
    let doubt = count(|v| v.two_sided && v.doubtful) * 100;
    assert!(doubt <= count(|v| v.two_sided) * 3, "{doubt} in doubt");
    assert!(count(|v| v.doubled && v.exact) > 200, "double-sided scenes");
    assert!(count(|v| v.t_junctions) > 20 && count(|v| v.far) > 300, "T-junctions, offsets");
    assert!(count(|v| v.flipped) > 30, "scenes of both orientations");
    assert!(count(|v| v.hollow) > 5, "cavities");
}
