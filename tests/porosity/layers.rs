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
