//! Words of sentences for people.

/// A number with its noun: `1 body`, `2 bodies`.
#[must_use]
pub fn counted(n: usize, one: &str, many: &str) -> String {
    format!("{n} {}", either(n, one, many))
}

/// The words that go with a number: those of one, or those of several and of none.
#[must_use]
pub fn either<'a>(n: usize, one: &'a str, many: &'a str) -> &'a str {
    if n == 1 { one } else { many }
}
