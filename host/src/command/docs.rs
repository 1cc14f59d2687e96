//! Pages of the manual, as they stand in `docs`: they are where the program is.

use crate::command::progress::print;
use crate::error::{Error, Result};
use crate::keys::reader::meant;

/// A page: its name, what it is about, its text.
type Page = (&'static str, &'static str, &'static str);

macro_rules! page {
    ($name:literal, $about:literal) => {
        ($name, $about, include_str!(concat!(env!("VOIDAGE_DOCS"), "/", $name, ".md")))
    };
}

/// The pages, in the order in which one needs them.
pub const PAGES: [Page; 7] = [
    page!("scene", "solids: every key of a scene file"),
    page!("grid", "grids: every key, in files and in tables"),
    page!("case", "gas flow: every key of a case file"),
    page!("outputs", "every file that is written, field by field"),
    page!("resistance", "obstacles smaller than a cell: definitions, laws, what they were measured against"),
    page!("study", "error against run time: every key of a study, and ten studies"),
    page!("stress", "hard cases whose truth is known, and what they measure"),
];

/// Pages that stand in the repository alone.
const ELSEWHERE: [&str; 2] = ["link", "numbers"];

/// Prints the page of that name; without one, which pages there are.
///
/// # Errors
/// There is none of that name, with exit code 2; the standard output takes no more.
pub fn docs(name: Option<&str>) -> Result<()> {
    let Some(name) = name else { return print(list().as_bytes()) };
    let asked = name.strip_suffix(".md").unwrap_or(name);
    match PAGES.iter().find(|(page, _, _)| *page == asked) {
        Some((_, _, text)) => print(readable(text).as_bytes()),
        None if ELSEWHERE.contains(&asked) => Err(Error::usage(format!(
            "the page {asked} is for readers of the source: docs/{asked}.md in the repository"
        ))),
        None => {
            let names = PAGES.map(|(page, _, _)| page);
            let reason = format!("there is no page {name}: {}{}", names.join(", "), meant(asked, &names));
            Err(Error::usage(reason))
        }
    }
}

/// The pages, a line each.
fn list() -> String {
    let lines = PAGES.map(|(page, about, _)| format!("  {page:<12}{about}\n"));
    format!("voidage docs PAGE prints one of these, in Markdown:\n\n{}", lines.concat())
}

/// A page without the comments that only its tests read.
fn readable(text: &str) -> String {
    let mut blank = false;
    let comment = |line: &&str| !(line.starts_with("<!--") && line.ends_with("-->"));
    // Where a comment stood between two empty lines, one of them is enough.
    let kept = text
        .lines()
        .filter(comment)
        .filter(|line| !(std::mem::replace(&mut blank, line.is_empty()) && line.is_empty()));
    kept.flat_map(|line| [line, "\n"]).collect()
}
