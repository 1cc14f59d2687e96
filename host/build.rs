//! What `voidage --version` tells of the build: commit, features, target; and where the pages are that `voidage docs` prints.
//!
//! The commit is recorded in release builds only: it would have every commit compile a developer's build anew.

use std::path::{Path, PathBuf};
use std::process::Command;

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    let release = variable("PROFILE") == "release";
    let commit = if release { commit() } else { None };
    println!("cargo:rustc-env=VOIDAGE_COMMIT={}", commit.unwrap_or_else(|| "not recorded".to_owned()));
    println!("cargo:rustc-env=VOIDAGE_TARGET={}", variable("TARGET"));
    println!("cargo:rustc-env=VOIDAGE_DOCS={}", pages().display());
    let features: Vec<&str> =
        ["cli", "pictures", "scene", "serde"].into_iter().filter(|name| has_feature(name)).collect();
    println!("cargo:rustc-env=VOIDAGE_FEATURES={}", features.join(" "));
}

/// The directory of the pages. In a package it is `docs`; in a clone that is a link, which some systems write as a file.
fn pages() -> PathBuf {
    let root = PathBuf::from(variable("CARGO_MANIFEST_DIR"));
    let own = root.join("docs");
    if own.is_dir() { own } else { root.join("../docs") }
}

fn variable(name: &str) -> String {
    std::env::var(name).unwrap_or_default()
}

fn has_feature(name: &str) -> bool {
    std::env::var_os(format!("CARGO_FEATURE_{}", name.to_uppercase())).is_some()
}

/// Of a package by the file that cargo puts there, of a clone by git.
fn commit() -> Option<String> {
    let root = variable("CARGO_MANIFEST_DIR");
    if let Ok(text) = std::fs::read_to_string(Path::new(&root).join(".cargo_vcs_info.json")) {
        let (_, rest) = text.split_once("\"sha1\": \"")?;
        return rest.get(..12).map(str::to_owned);
    }
    for file in ["HEAD", "logs/HEAD"] {
        if let Some(path) = git(&root, &["rev-parse", "--git-path", file]) {
            println!("cargo:rerun-if-changed={}", Path::new(&root).join(path).display());
        }
    }
    git(&root, &["rev-parse", "--short=12", "HEAD"])
}

/// What git answers in one line, if there is a git and a repository.
fn git(directory: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").arg("-C").arg(directory).args(arguments).output().ok()?;
    let line = String::from_utf8(output.stdout).ok()?.trim().to_owned();
    (output.status.success() && !line.is_empty()).then_some(line)
}
