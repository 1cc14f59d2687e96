//! What the packages hold when they are published.

use crate::kit::Scratch;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Files of a package, as cargo lists them.
fn listed(package: &str) -> BTreeSet<String> {
    let target = Scratch::new();
    let mut command = Command::new(env!("CARGO"));
    command.args(["package", "--list", "--allow-dirty", "--offline", "-p", package]);
    command.current_dir(repository()).env("CARGO_TARGET_DIR", &target.0);
    let output = command.output().expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("UTF-8").lines().map(str::to_owned).collect()
}

fn repository() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}

#[test]
fn packages_hold_licences_and_a_page_of_their_own() {
    for (package, directory, source) in
        [("voidage-core", "core", "src/surface/layer.rs"), ("voidage", "host", "src/command/template/case.toml")]
    {
        let files = listed(package);
        for name in ["Cargo.toml", "README.md", "LICENSE-MIT", "LICENSE-APACHE", "src/lib.rs", source] {
            assert!(files.contains(name), "{package} lacks {name}: {files:?}");
        }
        assert!(files.iter().all(|f| !f.contains("target/") && !f.ends_with(".npy")), "{package}: {files:?}");
        let read = |path: &str| fs::read_to_string(repository().join(path)).expect("a file");
        for licence in ["LICENSE-MIT", "LICENSE-APACHE"] {
            assert!(read(&format!("{directory}/{licence}")) == read(licence), "{directory}/{licence} is another");
        }
        let page = read(&format!("{directory}/README.md"));
        assert!(page.starts_with(&format!("# {package}\n")), "{package}: its page is about something else");
        // What is beside the package is not in it.
        assert!(
            !page.contains("](../") && !page.contains("](docs") && !page.contains("](host"),
            "{package}: broken links"
        );
        let manifest = read(&format!("{directory}/Cargo.toml"));
        for field in ["description", "documentation", "license", "readme = \"README.md\"", "keywords", "categories"] {
            assert!(manifest.contains(field), "{package} does not tell {field}");
        }
    }
}

/// Targets of the links in a page that are files, without what stands behind #.
fn targets(text: &str) -> Vec<String> {
    // What stands between fences is code, not links.
    let text: String = text.split("```").step_by(2).collect();
    let targets = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    let files = targets.filter_map(|target| target.split('#').next()).filter(|file| !file.is_empty());
    files.filter(|file| !file.contains("://")).map(str::to_owned).collect()
}

/// The pages that the program prints are in its package, and so is what they link to.
#[test]
fn the_package_holds_the_pages() {
    let files = listed("voidage");
    let pages: Vec<&String> = files.iter().filter(|f| f.starts_with("docs/") && f.matches('/').count() == 1).collect();
    let names = voidage::command::docs::PAGES.map(|(name, _, _)| format!("docs/{name}.md"));
    assert_eq!(pages.into_iter().collect::<BTreeSet<_>>(), names.iter().collect());
    for page in names {
        let text = fs::read_to_string(repository().join(&page)).expect("a page");
        for target in targets(&text) {
            let inside = target.strip_prefix("../").map_or(format!("docs/{target}"), str::to_owned);
            assert!(files.contains(&inside), "{page}: {target} is not in the package");
        }
    }
}

/// Links of the pages of the repository lead somewhere.
#[test]
fn links_of_the_pages_lead_to_files() {
    let docs = fs::read_dir(repository().join("docs")).expect("pages").map(|e| e.expect("an entry").path());
    let pages = ["README.md", "CONTRIBUTING.md", "ARCHITECTURE.md", "SECURITY.md"].map(|name| repository().join(name));
    let mut seen = 0;
    for page in docs.filter(|p| p.extension().is_some_and(|e| e == "md")).chain(pages) {
        let text = fs::read_to_string(&page).expect("a page");
        for target in targets(&text) {
            seen += 1;
            assert!(page.with_file_name(&target).exists(), "{}: {target} leads nowhere", page.display());
        }
    }
    assert!(seen > 10, "links were seen");
}
