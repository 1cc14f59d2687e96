//! The JSON report.

use std::collections::BTreeMap;
use std::fs;

use super::Dir;
use voidage::files::json;

#[test]
fn the_report_is_indented_and_ends_its_last_line() {
    #[derive(serde::Serialize)]
    struct Report {
        version: &'static str,
        max_gap: f64,
        warnings: Vec<String>,
    }
    let dir = Dir::new("report");
    let path = dir.file("report.json");
    let report = Report { version: "0.1.0", max_gap: f64::NAN, warnings: vec!["open edge".into()] };
    json::write(&path, &report).unwrap();
    let expected = "{\n  \"version\": \"0.1.0\",\n  \"max_gap\": null,\n  \"warnings\": [\n    \"open edge\"\n  ]\n}\n";
    assert_eq!(fs::read_to_string(&path).unwrap(), expected);

    let keys_that_are_lists = BTreeMap::from([(vec![1], 1)]);
    assert!(json::write(&path, &keys_that_are_lists).is_err());
    assert_eq!((fs::read_to_string(&path).unwrap(), dir.names().len()), (expected.to_owned(), 1));
}
