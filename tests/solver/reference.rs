//! Reference cases: a few small ones of our own beside the tests, all of them if a directory is named.

use std::path::Path;
use voidage_tests::euler::cases;

fn all_pass(directory: &str, least: usize) {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures").join(directory);
    let (passed, failed) = cases::run_directory(&directory, None).unwrap();
    assert!(passed >= least && failed == 0, "{passed} passed, {failed} failed");
}

#[test]
fn cases_beside_the_tests() {
    all_pass("euler", 8);
}

#[test]
fn walls_beside_the_tests() {
    all_pass("walls", 9);
}
