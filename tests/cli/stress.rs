//! `voidage stress`.

use crate::kit::{Scratch, json, stderr, stdout, voidage};
use crate::reference::page;

/// Rows of the table of cases.
fn rows(text: &str) -> Vec<&str> {
    text.lines().filter(|line| line.starts_with("| `")).collect()
}

#[test]
fn the_manual_lists_the_cases() {
    let printed = stdout(&voidage(&[&"stress", &"--list"]));
    let page = page("stress.md");
    let (_, table) = page.split_once("<!-- cases -->").expect("the mark of the table");
    let (table, _) = table.split_once("<!-- end -->").expect("the end of the table");
    assert!(rows(&printed).len() > 30, "{printed}");
    assert_eq!(rows(table), rows(&printed));
}

#[test]
fn cases_pass_and_are_told() {
    let at = Scratch::new();
    let file = at.file("deep/stress.json");
    let output = voidage(&[&"stress", &"--only", &"geometry/giga", &"--only", &"flow/near", &"--json", &file]);
    let said = stdout(&output);
    assert_eq!(output.status.code(), Some(0), "{said}{}", stderr(&output));
    let lines: Vec<&str> = said.lines().collect();
    assert!(lines[0].starts_with("pass  geometry/giga") && lines[0].contains("≤ 1e-12"), "{said}");
    assert!(lines[1].starts_with("pass  flow/near-vacuum"), "{said}");
    assert!(lines[2].starts_with("2 cases, 2 passed, 0 failed, "), "{said}");
    let told = json(&file);
    assert_eq!((told["passed"].as_u64(), told["failed"].as_u64()), (Some(2), Some(0)), "{told}");
    let criterion = &told["cases"][0]["criteria"][0];
    assert!(
        criterion["measured"].as_f64() <= criterion["at_most"].as_f64() && criterion["at_least"].is_null(),
        "{told}"
    );
    let piped = voidage(&[&"stress", &"--only", &"geometry/giga", &"--json", &"-"]);
    let told: serde_json::Value = serde_json::from_slice(&piped.stdout).expect("nothing but JSON");
    assert_eq!(told["cases"][0]["name"], "geometry/giga");
    assert!(stderr(&piped).contains("pass  geometry/giga"), "lines go beside it");
}

#[test]
fn names_that_are_not_known_are_refused_with_those_that_are() {
    let output = voidage(&[&"stress", &"--only", &"flow/needles"]);
    assert_eq!(output.status.code(), Some(2));
    let said = stderr(&output);
    assert!(said.contains("no case is called \"flow/needles\"") && said.contains("geometry/needles"), "{said}");
    let listed = stdout(&voidage(&[&"stress", &"--list", &"--only", &"gjk"]));
    assert!(rows(&listed).iter().all(|row| row.starts_with("| `gjk/")) && rows(&listed).len() > 5, "{listed}");
}

/// With spoiled results a case fails, and the command says so by its exit code. Of all cases `.ci/run fault` shows it.
#[test]
fn spoiled_results_make_it_fail() {
    let only = ["geometry/giga", "flow/near"];
    let output = voidage(&[&"stress", &"--spoil", &"--only", &only[0], &"--only", &only[1]]);
    let said = stdout(&output);
    assert_eq!(output.status.code(), Some(1), "{said}{}", stderr(&output));
    assert!(said.contains("2 cases, 0 passed, 2 failed, "), "cases that judge nothing:\n{said}");
    assert!(stderr(&output).contains("2 of 2 cases failed: "), "{}", stderr(&output));
}
