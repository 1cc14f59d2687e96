//! The layers of the core and of the host: a module uses only modules above it.

use std::path::Path;

/// Rooms of the core from the bottom up; `a/b.rs` counts as `a`. The flow uses scalars only, and no geometry uses the flow.
const CORE: [&str; 6] = ["number", "flow", "convex", "grid", "surface", "subdivide"];

/// Modules of the host likewise.
const HOST: [&str; 9] = ["error", "huge", "grid", "geometry", "porosity", "flow", "files", "picture", "command"];

#[test]
fn modules_import_downwards_only() {
    check("../core/src", &CORE);
    check("../host/src", &HOST);
}

fn check(source: &str, order: &[&str]) {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join(source);
    let place = |module: &str| order.iter().position(|m| *m == module);
    let mut checked = 0;
    for (at, module) in order.iter().enumerate() {
        let text = text_of(&source, module);
        for line in text.lines().filter(|l| !l.trim_start().starts_with("//")) {
            for used in line.split("crate::").skip(1) {
                let name: String = used.chars().take_while(|c| c.is_ascii_alphanumeric() || *c == '_').collect();
                if name == *module {
                    continue;
                }
                assert!(name != "flow" || source.ends_with("host/src"), "{module} uses the flow");
                let below = place(&name).unwrap_or_else(|| panic!("{module} uses {name}, which the list lacks"));
                assert!(below < at, "{module} uses {name}, which stands above it");
                checked += 1;
            }
        }
    }
    assert!(checked > 10, "imports were seen");
    let listed = std::fs::read_to_string(source.join("lib.rs")).expect("lib.rs");
    for line in listed.lines().filter_map(|l| l.strip_prefix("pub mod ")) {
        let name = line.trim_end_matches(';');
        assert!(place(name).is_some(), "module {name} is missing in the order");
    }
}

/// A module's file and those in its folder, whichever it has.
fn text_of(source: &Path, module: &str) -> String {
    let mut text = std::fs::read_to_string(source.join(format!("{module}.rs"))).unwrap_or_default();
    let mut folders = vec![source.join(module)];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).into_iter().flatten() {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else {
                text += &std::fs::read_to_string(path).expect("a part of a module");
            }
        }
    }
    assert!(!text.is_empty(), "{module} has no file");
    text
}

/// Every file of a room in which files import downwards only: its path within the crate, as `flow::kernel::rows`.
fn files_of(folder: &Path, module: &str, files: &mut Vec<(String, String)>) {
    let text = std::fs::read_to_string(folder.with_extension("rs")).expect("a module");
    files.push((module.to_owned(), text));
    for entry in std::fs::read_dir(folder).into_iter().flatten() {
        let path = entry.expect("an entry").path();
        let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
        if path.extension().is_some_and(|e| e == "rs") {
            files_of(&path.with_extension(""), &format!("{module}::{name}"), files);
        }
    }
}

/// The paths below `crate::` that a text imports, lists in braces taken apart.
fn imports(text: &str) -> Vec<String> {
    let mut all = Vec::new();
    for statement in text.split("\nuse crate::").skip(1).filter_map(|rest| rest.split_once(';')) {
        let statement: String = statement.0.split_whitespace().collect();
        match statement.split_once('{') {
            None => all.push(statement),
            Some((prefix, list)) => all.extend(list.trim_end_matches('}').split(',').map(|n| format!("{prefix}{n}"))),
        }
    }
    all
}

#[test]
fn files_of_the_flow_import_without_circles() {
    let mut files = Vec::new();
    files_of(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../core/src/flow"), "flow", &mut files);
    // A room's own file names its parts and takes them up; it imports none of them.
    let place = |import: &str| {
        let within = |m: &str| import == m || import.strip_prefix(m).is_some_and(|rest| rest.starts_with("::"));
        (0..files.len()).filter(|&f| within(&files[f].0)).max_by_key(|&f| files[f].0.len())
    };
    let uses: Vec<Vec<usize>> = files.iter().map(|f| imports(&f.1).iter().filter_map(|i| place(i)).collect()).collect();
    assert!(uses.iter().map(Vec::len).sum::<usize>() > 50, "imports were seen");
    // What imports nothing that is left is taken away until nothing is left.
    let mut left: Vec<usize> = (0..files.len()).collect();
    while !left.is_empty() {
        let before = left.len();
        let now = left.clone();
        left.retain(|&f| uses[f].iter().any(|u| *u != f && now.contains(u)));
        let names: Vec<&str> = left.iter().map(|&f| files[f].0.as_str()).collect();
        assert!(left.len() < before, "these import one another: {names:?}");
    }
}
