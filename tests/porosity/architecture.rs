//! What uses what, file by file, and what is called what: as the sources of core and host say.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Modules of the core from the bottom up. The flow uses scalars only, and no geometry uses the flow.
const CORE: [&str; 7] = ["number", "flow", "convex", "grid", "surface", "subdivide", "solids"];

/// Those of the host likewise.
const HOST: [&str; 12] =
    ["error", "text", "words", "huge", "keys", "grid", "geometry", "porosity", "flow", "files", "picture", "command"];

#[test]
fn modules_import_downwards_only() {
    for (package, order) in [("core", &CORE[..]), ("host", &HOST[..])] {
        let sources = Sources::read(package);
        let place = |module: &Module| {
            let first = module.first().expect("lib.rs imports nothing");
            order.iter().position(|r| r == first).unwrap_or_else(|| panic!("{package}: the order lacks {first}"))
        };
        let arrows = sources.arrows();
        assert!(arrows.len() > 50, "imports were seen");
        for (from, to) in arrows {
            assert!(place(&to) <= place(&from), "{package}: {} uses {}", name(&from), name(&to));
            assert!(package == "host" || to[0] != "flow" || from[0] == "flow", "core: {} uses the flow", name(&from));
        }
    }
}

/// A recursion through a function pointer is no circle of imports, and this does not see it. There is one: a cell whose union is not proved
/// is divided, and each part is measured as a layer of its own, whose cells may be divided again. `cell_unions` calls the layers by the
/// pointer `FindParts`; depth, effort and memory end it.
#[test]
fn no_files_use_each_other_in_a_circle() {
    let mut found = String::new();
    for package in ["core", "host"] {
        for circle in circles(&Sources::read(package).arrows()) {
            let files: Vec<String> = circle.iter().map(|m| format!("{package}/{}", name(m))).collect();
            let _ = writeln!(found, "{}", files.join(" "));
        }
    }
    assert!(found.is_empty(), "files that use each other:\n{found}");
}

/// A library is no terminal: what is below the command knows of none, nor of what users type.
#[test]
fn only_the_command_speaks_to_a_terminal() {
    for (module, text) in &Sources::read("host").files {
        if module.first().is_some_and(|first| first == "command") {
            continue;
        }
        for word in ["clap", "indicatif", "ctrlc", "stdout(", "stderr(", "println!(", "std::env", "command::"] {
            assert!(!text.contains(word), "{} names {word}", name(module));
        }
    }
}

/// The table of ARCHITECTURE.md: every path exists, every name stands in a file of its row.
#[test]
fn the_page_that_says_where_things_are_is_right() {
    let top = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let page = std::fs::read_to_string(top.join("ARCHITECTURE.md")).expect("the page");
    let (_, table) = page.split_once("## Where to look for").expect("the table");
    let (table, _) = table.split_once("\n## ").expect("a section after it");
    let quoted = |cell: &str| -> Vec<String> { cell.split('`').skip(1).step_by(2).map(str::to_owned).collect() };
    let (mut paths, mut found) = (0, String::new());
    for row in table.lines().filter(|line| line.starts_with("| ")).skip(1) {
        let cells: Vec<&str> = row.split('|').collect();
        let files = quoted(cells[2]);
        let mut text = String::new();
        for file in &files {
            match std::fs::read_to_string(top.join(file)) {
                Ok(source) => text += &source,
                Err(_) if top.join(file).is_dir() => {}
                Err(_) => drop(writeln!(found, "no {file}")),
            }
        }
        let words: BTreeSet<&str> = text.split(|c: char| !(c.is_alphanumeric() || c == '_')).collect();
        for name in quoted(cells[3]).iter().filter(|name| !words.contains(name.as_str())) {
            let _ = writeln!(found, "no {name} in {files:?}");
        }
        paths += files.len();
    }
    assert!(paths > 100, "{paths} paths were seen");
    assert!(found.is_empty(), "the table of ARCHITECTURE.md is wrong:\n{found}");
}

/// Types of the same name in different files, each with its reason.
const SHARED_NAMES: [(&str, &str); 4] = [
    ("Error", "that of the flow is a value without text; that of the host names file, place and reason"),
    ("Fields", "fields of a gas and of a layer"),
    ("Mesh", "cells of a flow; triangles of a file"),
    ("Report", "of a step; of a run"),
];

#[test]
fn each_type_has_a_name_of_its_own() {
    let mut places: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for package in ["core", "host"] {
        for (module, text) in &Sources::read(package).files {
            for line in text.lines() {
                for word in ["pub struct ", "pub enum ", "pub trait ", "pub type "] {
                    // Associated types are indented, as are items within functions and macros.
                    let Some(rest) = line.strip_prefix(word) else { continue };
                    let name: String = rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
                    places.entry(name).or_default().push(format!("{package}/{}", self::name(module)));
                }
            }
        }
    }
    assert!(places.len() > 100, "types were seen");
    let mut found = String::new();
    for (name, places) in places.iter().filter(|(_, places)| places.len() > 1) {
        if !SHARED_NAMES.iter().any(|(known, _)| known == name) {
            let _ = writeln!(found, "{name}: {}", places.join(", "));
        }
    }
    assert!(found.is_empty(), "names that are used twice:\n{found}");
}

/// The harness of the core is off, as there is nothing in it.
#[test]
fn the_core_has_no_tests_that_never_run() {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR")).join("../core");
    assert!(std::fs::read_to_string(manifest.join("Cargo.toml")).expect("a manifest").contains("[lib]\ntest = false"));
    let mut waiting = vec![manifest.join("src")];
    while let Some(path) = waiting.pop() {
        if path.is_dir() {
            waiting.extend(std::fs::read_dir(&path).expect("a directory").map(|e| e.expect("an entry").path()));
        } else {
            let text = std::fs::read_to_string(&path).expect("a source");
            assert!(!text.contains("#[test]"), "{}: a test that never runs", path.display());
        }
    }
}

/// A module by its path from the root of its package; that of `lib.rs` is empty.
type Module = Vec<String>;

fn name(module: &Module) -> String {
    format!("{}.rs", module.join("/"))
}

/// The files of a package, without comments and tests.
struct Sources {
    files: BTreeMap<Module, String>,
}

impl Sources {
    fn read(package: &str) -> Self {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(package).join("src");
        let mut files = BTreeMap::new();
        let mut waiting: Vec<PathBuf> = vec![root.clone()];
        while let Some(path) = waiting.pop() {
            if path.is_dir() {
                waiting.extend(std::fs::read_dir(&path).expect("a directory").map(|e| e.expect("an entry").path()));
                continue;
            }
            let inner = path.strip_prefix(&root).expect("inside").with_extension("");
            let mut module: Module = inner.iter().map(|part| part.to_string_lossy().into_owned()).collect();
            assert!(
                module.last().is_some_and(|last| last != "mod"),
                "{}: modules are `a.rs` beside `a/`",
                path.display()
            );
            if module == ["main"] {
                continue;
            }
            module.retain(|part| part != "lib");
            files.insert(module, code(&std::fs::read_to_string(&path).expect("a source")));
        }
        Sources { files }
    }

    /// Which file uses which other.
    fn arrows(&self) -> BTreeSet<(Module, Module)> {
        let doors: BTreeMap<&Module, Vec<Import>> = self.files.iter().map(|(m, text)| (m, imports(text))).collect();
        let mut arrows = BTreeSet::new();
        for (module, text) in &self.files {
            let own = doors[module].iter().filter(|i| !(i.public && self.is_below(module, &i.path)));
            let named = own.map(|i| i.path.clone()).chain(inline_paths(text));
            for path in named {
                if let Some(file) = self.resolve(&doors, module, &path, 0)
                    && file != *module
                    && !module.is_empty()
                {
                    arrows.insert((module.clone(), file));
                }
            }
        }
        arrows
    }

    /// Whether a path leads to a module within this one: a door that shows what is behind it.
    fn is_below(&self, module: &Module, path: &[String]) -> bool {
        path.first().is_some_and(|first| self.files.contains_key(&[&module[..], std::slice::from_ref(first)].concat()))
    }

    /// The file where the item of a path is defined, doors followed; none outside of the package.
    fn resolve(
        &self,
        doors: &BTreeMap<&Module, Vec<Import>>,
        from: &Module,
        path: &[String],
        depth: usize,
    ) -> Option<Module> {
        let mut rest = path;
        let mut at: Module = from.clone();
        match rest.first()?.as_str() {
            "crate" => at.clear(),
            "self" => {}
            "super" => drop(at.pop()),
            _ if self.is_below(from, path) => at.push(rest[0].clone()),
            _ => return None,
        }
        rest = &rest[1..];
        while let Some(next) = rest.first() {
            if next == "super" {
                at.pop();
            } else {
                at.push(next.clone());
                if !self.files.contains_key(&at) {
                    at.pop();
                    // Children see what their parent imports for itself, too.
                    let door = doors[&at].iter().find(|i| i.name == *next);
                    return match door {
                        Some(door) if depth < 8 => self.resolve(doors, &at, &door.path, depth + 1),
                        _ => Some(at),
                    };
                }
            }
            rest = &rest[1..];
        }
        self.files.contains_key(&at).then_some(at)
    }
}

/// A source without its comments and its tests, which stand at its end.
fn code(text: &str) -> String {
    let text = text.split("#[cfg(test)]").next().unwrap_or(text);
    let without = |line: &str| match line.trim_start().starts_with("//") {
        true => String::new(),
        false => line.split(" // ").next().unwrap_or(line).to_owned() + "\n",
    };
    text.lines().map(without).collect()
}

/// A path that a `use` brings in, and the name that it gets.
struct Import {
    path: Vec<String>,
    name: String,
    public: bool,
}

fn imports(text: &str) -> Vec<Import> {
    let mut all = Vec::new();
    let mut rest = text;
    while let Some(at) = rest.find("use ") {
        let line = &rest[rest[..at].rfind('\n').map_or(0, |n| n + 1)..at];
        let visible = line.trim();
        rest = &rest[at + 4..];
        if !(visible.is_empty() || visible.starts_with("pub")) {
            continue;
        }
        let Some((tree, after)) = rest.split_once(';') else { break };
        let tree: String = tree.split_whitespace().collect::<Vec<_>>().join(" ");
        expand(&[], &tree, &mut |path, name| {
            all.push(Import { path, name, public: !visible.is_empty() });
        });
        rest = after;
    }
    all
}

/// Each path of a `use` tree.
fn expand(before: &[String], tree: &str, found: &mut impl FnMut(Vec<String>, String)) {
    let tree = tree.trim();
    if let Some((head, list)) = tree.split_once('{') {
        let mut path = before.to_vec();
        path.extend(head.split("::").map(str::trim).filter(|p| !p.is_empty()).map(str::to_owned));
        let list = list.strip_suffix('}').expect("a closed list");
        let (mut depth, mut start) = (0, 0);
        for (at, c) in list.char_indices().chain([(list.len(), ',')]) {
            match c {
                '{' => depth += 1,
                '}' => depth -= 1,
                ',' if depth == 0 => {
                    if !list[start..at].trim().is_empty() {
                        expand_dyn(&path, &list[start..at], found);
                    }
                    start = at + 1;
                }
                _ => {}
            }
        }
        return;
    }
    let (path, alias) = tree.split_once(" as ").map_or((tree, None), |(path, alias)| (path, Some(alias)));
    let mut whole = before.to_vec();
    whole.extend(path.split("::").map(str::trim).filter(|p| !matches!(*p, "" | "*")).map(str::to_owned));
    if whole.len() > before.len() && whole.last().is_some_and(|l| l == "self") && !before.is_empty() {
        whole.pop();
    }
    let name = alias.map_or_else(|| whole.last().cloned().unwrap_or_default(), str::to_owned);
    found(whole, name);
}

/// As [`expand`]; the recursion would make types without end.
fn expand_dyn(before: &[String], tree: &str, found: &mut dyn FnMut(Vec<String>, String)) {
    expand(before, tree, &mut |path, name| found(path, name));
}

/// Paths within expressions, signatures and types.
fn inline_paths(text: &str) -> Vec<Vec<String>> {
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let mut paths = Vec::new();
    for statement in text.split('\n').filter(|l| !l.trim_start().trim_start_matches("pub ").starts_with("use ")) {
        let mut rest = statement;
        while let Some(at) = rest.find("::") {
            let begin = rest[..at].rfind(|c| !is_word(c)).map_or(0, |n| n + 1);
            let path_end = rest[begin..].find(|c: char| !is_word(c) && c != ':').map_or(rest.len(), |n| begin + n);
            let parts = rest[begin..path_end].split("::").filter(|p| !p.is_empty());
            let path: Vec<String> = parts.map(str::to_owned).collect();
            if !path.is_empty() {
                paths.push(path);
            }
            rest = &rest[path_end.max(at + 2)..];
        }
    }
    paths
}

/// Groups of files each of which uses, by way of others, all of its group.
fn circles(arrows: &BTreeSet<(Module, Module)>) -> Vec<BTreeSet<Module>> {
    let nodes: BTreeSet<&Module> = arrows.iter().flat_map(|(a, b)| [a, b]).collect();
    let reached = |from: &Module| {
        let (mut seen, mut waiting) = (BTreeSet::new(), vec![from.clone()]);
        while let Some(at) = waiting.pop() {
            for (_, to) in arrows.iter().filter(|(a, _)| *a == at) {
                if seen.insert(to.clone()) {
                    waiting.push(to.clone());
                }
            }
        }
        seen
    };
    let all: BTreeMap<&Module, BTreeSet<Module>> = nodes.iter().map(|n| (*n, reached(n))).collect();
    let mut groups = BTreeSet::new();
    for (node, seen) in &all {
        let group: BTreeSet<Module> = seen.iter().filter(|other| all[other].contains(*node)).cloned().collect();
        if group.len() > 1 {
            groups.insert(group);
        }
    }
    groups.into_iter().collect()
}
