//! How much a test does: all of it where changes land (`.ci/run` sets `VOIDAGE_CASES=all`), a part at a desk.

fn all() -> bool {
    std::env::var("VOIDAGE_CASES").as_deref() == Ok("all")
}

/// How many of `n` random cases run: all of them with `VOIDAGE_CASES=all`, else the first quarter.
#[must_use]
pub fn cases(n: usize) -> usize {
    if all() { n } else { n.div_ceil(4) }
}

/// Those of a list that run: all of them with `VOIDAGE_CASES=all`, else the first of every three.
pub fn some<T: Copy>(list: &[T]) -> impl Iterator<Item = T> {
    list.iter().copied().step_by(if all() { 1 } else { 3 })
}
