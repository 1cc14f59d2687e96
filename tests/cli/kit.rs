//! Running the command in a directory of its own.

pub mod trace;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::atomic::{AtomicUsize, Ordering};

/// The program under test.
pub fn program() -> &'static Path {
    Path::new(env!("CARGO_BIN_EXE_voidage"))
}

/// A file that ships with the tests.
pub fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/fixtures").join(name)
}

/// A directory that disappears with its owner.
pub struct Scratch(pub PathBuf);

impl Scratch {
    pub fn new() -> Self {
        static COUNT: AtomicUsize = AtomicUsize::new(0);
        let name = format!("voidage-test-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let path = std::env::temp_dir().join(name);
        std::fs::create_dir(&path).expect("a new directory");
        Scratch(path)
    }

    pub fn file(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    /// Writes a file, and tells its path.
    pub fn write(&self, name: &str, contents: &[u8]) -> PathBuf {
        let path = self.file(name);
        std::fs::write(&path, contents).expect("written");
        path
    }

    /// Names of everything in it, sorted.
    pub fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(&self.0).expect("readable");
        let mut names: Vec<_> =
            entries.map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// Run the command.
pub fn voidage(arguments: &[&dyn AsRef<std::ffi::OsStr>]) -> Output {
    let mut command = Command::new(program());
    command.args(arguments.iter().map(|a| a.as_ref()));
    command.output().expect("the program runs")
}

/// `voidage solve CASE -o DIR` with more arguments, in a scratch directory that holds the case.
pub fn solve(at: &Scratch, case: &str, dir: &str, more: &[&str]) -> Output {
    let path = at.file("case.toml");
    std::fs::write(&path, case).expect("a case file");
    let mut command = Command::new(program());
    command.arg("solve").arg(path).arg("-o").arg(at.file(dir)).args(more);
    command.output().expect("the program runs")
}

/// The same, which must succeed.
pub fn solved(at: &Scratch, case: &str, dir: &str, more: &[&str]) -> Output {
    let output = solve(at, case, dir, more);
    assert!(output.status.success(), "{}", stderr(&output));
    output
}

/// Values of an array.
pub fn array(path: &Path) -> Vec<f64> {
    voidage::files::npy::read(path).expect("an array").1
}

pub fn json(path: &Path) -> serde_json::Value {
    serde_json::from_slice(&std::fs::read(path).expect("a file")).expect("JSON")
}

pub fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

pub fn stdout(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}
