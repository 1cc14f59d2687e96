//! Random scenes of boxes against their oracle: `boxes FIRST COUNT`, seeds from FIRST on. Prints those that fail, and totals.

use rayon::prelude::*;
use voidage_tests::boxes::bounds_hold;

fn main() {
    let numbers: Vec<u64> = std::env::args().skip(1).map(|a| a.parse().expect("a number")).collect();
    let [first, count] = numbers[..] else { panic!("boxes FIRST COUNT") };
    let found: Vec<_> = (first..first + count)
        .into_par_iter()
        .map(|seed| bounds_hold(seed).inspect_err(|text| println!("{text}")))
        .collect();
    let visited: Vec<_> = found.iter().flatten().collect();
    let of = |what: fn(&voidage_tests::boxes::Visited) -> bool| visited.iter().filter(|v| what(v)).count();
    println!(
        "seeds {first}..{}: {} wrong; {} defined, {} exact, {} with both orientations, {} hollow, {} with \
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
