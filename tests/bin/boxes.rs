//! Random scenes of boxes against their oracle: `boxes FIRST COUNT [random|parts|mixed|turned|room|stack]`, seeds from FIRST on. Prints those that fail, and totals.

use rayon::prelude::*;
use voidage_tests::boxes::{self, Family, Visited};
use voidage_tests::random::Random;
use voidage_tests::turned::{self, Turned};

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (first, count, family) = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [first, count] => (first, count, "random"),
        [first, count, family @ ("random" | "parts" | "mixed" | "turned" | "room" | "stack")] => (first, count, family),
        _ => panic!("boxes FIRST COUNT [random|parts|mixed|turned|room|stack]"),
    };
    let [first, count]: [u64; 2] = [first, count].map(|n| n.parse().expect("a number"));
    match family {
        "random" => along_axes(Family::Random, first, count),
        "parts" => along_axes(Family::Parts, first, count),
        "mixed" => along_axes(Family::Mixed, first, count),
        "turned" => turned(first, count, Turned::boxes),
        "room" => turned(first, count, Turned::room),
        _ => turned(first, count, Turned::stack),
    }
}

/// What is found for so many seeds; those that fail are printed.
fn all<T: Send>(first: u64, count: u64, one: impl Fn(u64) -> Result<T, String> + Sync) -> Vec<T> {
    let found: Vec<_> =
        (first..first + count).into_par_iter().map(|seed| one(seed).inspect_err(|text| println!("{text}"))).collect();
    let wrong = found.iter().filter(|found| found.is_err()).count();
    assert!(wrong == 0, "seeds {first}..{}: values of {wrong} scenes outside their bounds", first + count);
    found.into_iter().flatten().collect()
}

fn along_axes(family: Family, first: u64, count: u64) {
    let visited = all(first, count, |seed| boxes::bounds_hold(family, seed));
    let of = |what: fn(&Visited) -> bool| visited.iter().filter(|v| what(v)).count();
    println!(
        "{family:?} seeds {first}..{}: 0 wrong; {} defined, {} exact, {} with both orientations, {} hollow, {} with \
         surface twice, {} with T-junctions, {} far, {} in doubt",
        first + count,
        of(|v| v.defined),
        of(|v| v.exact),
        of(|v| v.flipped),
        of(|v| v.hollow),
        of(|v| v.doubled),
        of(|v| v.t_junctions),
        of(|v| v.far),
        of(|v| v.doubtful)
    );
}

/// Boxes that are turned, with backs and without.
fn turned(first: u64, count: u64, make: fn(&mut Random) -> Turned) {
    let seen = all(first, count, |seed| turned::bounds_hold(seed, make));
    let of = |what: fn(&turned::Seen) -> bool| seen.iter().filter(|s| what(s)).count();
    println!(
        "turned seeds {first}..{}: 0 wrong; {} exact, {} with backs everywhere, {} of them exact, {} in doubt",
        first + count,
        of(|s| s.exact),
        of(|s| s.doubled),
        of(|s| s.doubled && s.exact),
        of(|s| s.doubtful)
    );
}
