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

/// A number as a message writes it: very large and very small ones by a power of ten.
#[must_use]
pub fn written(x: f64) -> String {
    match x.abs() {
        _ if x.is_nan() => "nan".to_owned(),
        size if size == 0.0 || (1e-4..1e6).contains(&size) || size.is_infinite() => format!("{x}"),
        _ => format!("{x:e}"),
    }
}
