//! Random scenes of boxes against their oracle: `boxes FIRST COUNT [random|parts]`, seeds from FIRST on. Prints those that fail, and totals.

use rayon::prelude::*;
use voidage_tests::boxes::{Family, Visited, bounds_hold};

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (first, count, family) = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [first, count] | [first, count, "random"] => (first, count, Family::Random),
        [first, count, "parts"] => (first, count, Family::Parts),
        _ => panic!("boxes FIRST COUNT [random|parts]"),
    };
    let [first, count]: [u64; 2] = [first, count].map(|n| n.parse().expect("a number"));
    let found: Vec<_> = (first..first + count)
        .into_par_iter()
        .map(|seed| bounds_hold(family, seed).inspect_err(|text| println!("{text}")))
        .collect();
    let visited: Vec<_> = found.iter().flatten().collect();
    let of = |what: fn(&Visited) -> bool| visited.iter().filter(|v| what(v)).count();
    println!(
        "{family:?} seeds {first}..{}: {} wrong; {} defined, {} exact, {} with both orientations, {} hollow, {} with \
         surface twice, {} with T-junctions, {} far, {} in doubt",
        first + count,
        found.len() - visited.len(),
        of(|v| v.defined),
        of(|v| v.exact),
        of(|v| v.flipped),
        of(|v| v.hollow),
        of(|v| v.doubled),
        of(|v| v.t_junctions),
        of(|v| v.far),
        of(|v| v.doubtful)
    );
    assert!(visited.len() == found.len(), "values outside their bounds");
}
