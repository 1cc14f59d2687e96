//! What is said of the interface and how it is made.

use core::ffi::CStr;
use std::path::{Path, PathBuf};
use voidage_capi::status::{VDG_VERSION, vdg_status_text, vdg_version};

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

fn read(name: &str) -> String {
    std::fs::read_to_string(file(name)).expect(name)
}

/// Code without comments and without what rustfmt may put elsewhere.
fn bare(code: &str) -> String {
    let lines = code.lines().filter(|line| !line.trim_start().starts_with("//"));
    let text: String = lines.flat_map(str::chars).filter(|c| !c.is_whitespace()).collect();
    text.replace(",)", ")").replace(",}", "}")
}

#[test]
fn single_precision_is_the_text_of_double_precision() {
    let made = bare(&read("src/double.rs")).replace("f64", "f32").replace("fnvdg_", "fnvdgf_");
    assert!(made == bare(&read("src/single.rs")), "run python3 core/capi/single.py");
}

#[test]
fn every_function_is_in_the_header_and_in_both_precisions() {
    let header = read("include/voidage.h");
    let functions: Vec<String> = read("src/double.rs")
        .lines()
        .filter_map(|line| Some(line.strip_prefix("pub unsafe extern \"C\" fn ")?.split('(').next()?.to_owned()))
        .collect();
    assert!(functions.len() >= 15, "functions were seen");
    for name in functions {
        assert!(header.contains(&format!("{name}(")), "the header lacks {name}");
        assert!(header.contains(&format!("{}(", name.replace("vdg_", "vdgf_"))), "the header lacks {name} in float");
    }
}

#[test]
fn every_status_has_a_sentence() {
    let text = |code| unsafe { CStr::from_ptr(vdg_status_text(code)) }.to_str().expect("text").to_owned();
    let unknown = text(1000);
    let known: Vec<String> = (0..).map(text).take_while(|t| *t != unknown).collect();
    let header = read("include/voidage.h");
    assert_eq!(known.len(), header.matches("  VDG_STATUS_").count());
    let mut different = known.clone();
    different.sort();
    different.dedup();
    assert_eq!(different.len(), known.len());
    assert_eq!(text(-1), unknown);
    assert_eq!(text(i32::MIN), unknown);
}

#[test]
fn the_version_is_that_of_the_package() {
    let number = |part: &str| part.parse::<u32>().expect("a number");
    let [major, minor, patch] =
        [0, 1, 2].map(|n| number(env!("CARGO_PKG_VERSION").split('.').nth(n).expect("three parts")));
    assert_eq!(vdg_version(), 10000 * major + 100 * minor + patch);
    assert!(read("include/voidage.h").contains(&format!("#define VDG_VERSION {VDG_VERSION}\n")));
}

/// A block of an example, without the margin that all its lines have.
fn block(file: &str, name: &str) -> String {
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(file)).expect(file);
    let mark = |line: &str| line.trim_matches(|c| " /*!#".contains(c)).to_owned();
    let lines = text.lines().skip_while(|line| mark(line) != format!("docs: {name}")).skip(1);
    let lines: Vec<&str> = lines.take_while(|line| mark(line) != "docs: end").collect();
    let margin = lines.iter().filter(|l| !l.is_empty()).map(|l| l.len() - l.trim_start().len()).min().unwrap_or(0);
    lines.iter().map(|line| line.get(margin..).unwrap_or("")).collect::<Vec<_>>().join("\n")
}

#[test]
fn the_page_on_linking_shows_what_is_tested() {
    let page = std::fs::read_to_string(file("../../docs/link.md")).expect("docs/link.md");
    let mut blocks = 0;
    for part in page.split("<!-- ").skip(1) {
        let (mark, rest) = part.split_once(" -->\n").expect("the end of a mark");
        let (file, name) = mark.split_once(": ").expect("a file and a name");
        let shown = rest.split_once('\n').expect("a fence").1.split("\n```").next().expect("a block");
        assert_eq!(shown, block(file, name), "{mark}: python3 core/capi/docs.py");
        assert!(shown.lines().count() > 2, "{mark} shows something");
        blocks += 1;
    }
    assert!(blocks >= 13, "blocks were seen");
}
