//! Comparing porosity fields, with the place of the worst difference.

use voidage::porosity::FieldSet;

/// Largest difference of two field sets and where it is.
#[must_use]
pub fn largest_difference(a: &FieldSet, b: &FieldSet) -> (f64, String) {
    let mut worst = (0.0, String::new());
    for (name, a, b) in [("v", &a.v, &b.v), ("x", &a.x, &b.x), ("y", &a.y, &b.y), ("z", &a.z, &b.z)] {
        assert_eq!(a.len(), b.len(), "field {name}");
        for (n, (p, q)) in a.iter().zip(b).enumerate() {
            let d = (p - q).abs();
            if !(d <= worst.0) {
                worst = (d, format!("{name}[{n}]: {p} and {q}"));
            }
        }
    }
    worst
}

/// Assert that two field sets agree.
///
/// # Panics
/// If they differ by more than `tol` anywhere.
pub fn assert_close(a: &FieldSet, b: &FieldSet, tol: f64, what: &str) {
    let (worst, place) = largest_difference(a, b);
    assert!(worst <= tol, "{what}: {worst:e} at {place}");
}
