//! `voidage docs`: the pages, where the program is.

use crate::kit::{stderr, stdout, voidage};
use crate::reference::page;

const NAMES: [&str; 7] = ["scene", "grid", "case", "outputs", "resistance", "study", "stress"];

#[test]
fn lists_the_pages() {
    let said = stdout(&voidage(&[&"docs"]));
    let listed: Vec<&str> = said.lines().filter_map(|l| l.strip_prefix("  ")?.split(' ').next()).collect();
    assert_eq!(listed, NAMES, "{said}");
}

/// Every line of a page but its comments, by its name or that of its file.
#[test]
fn prints_a_page() {
    for name in NAMES {
        let file = format!("{name}.md");
        let said = stdout(&voidage(&[&"docs", &name]));
        assert_eq!(said, stdout(&voidage(&[&"docs", &file])));
        let lines = |text: &str| -> Vec<String> {
            text.lines().filter(|l| !l.is_empty() && !l.starts_with("<!--")).map(str::to_owned).collect()
        };
        assert_eq!(lines(&said), lines(&page(&file)), "{name}");
        assert!(!said.contains("<!--") && !said.contains("\n\n\n"), "{name}");
    }
}

#[test]
fn tells_which_page_may_be_meant() {
    let output = voidage(&[&"docs", &"cases"]);
    assert_eq!(output.status.code(), Some(2));
    let said = stderr(&output);
    assert_eq!(
        said,
        "error: there is no page cases: scene, grid, case, outputs, resistance, study, stress; did you mean case?\n"
    );
    let elsewhere = stderr(&voidage(&[&"docs", &"link.md"]));
    assert!(elsewhere.contains("docs/link.md in the repository"), "{elsewhere}");
    assert!(!page("link.md").is_empty());
}
