//! Reference cases: a few small ones of our own beside the tests, all of them if a directory is named.

use std::path::Path;
use voidage_tests::euler::cases;

#[test]
fn cases_beside_the_tests() {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/euler");
    let (passed, failed) = cases::run_directory(&directory, None).unwrap();
    assert!(passed >= 8 && failed == 0, "{passed} passed, {failed} failed");
}
