//! A case file of `voidage solve`: reading it, errors that name its keys, paths that count from its directory.

use super::case::Case;
use super::{arrays, places, ranges};
use crate::command::streams::{INPUT, text_of};
use crate::error::{Error, Result};
use crate::files::npy;
use crate::grid::Edges;
use crate::grid::file;
use crate::keys::reader::misfit;
use crate::keys::source::another;
use crate::keys::value::Value;
use crate::keys::{self, PlacedValue, Source};
use std::collections::HashSet;
use std::path::{Path, PathBuf};

/// A case file with its place, for errors and for the paths in it.
#[derive(Debug, Clone)]
pub struct CaseFile {
    /// Where it is.
    pub path: PathBuf,
    /// Its text.
    text: String,
    /// What it says.
    pub case: Case,
}

fn parse(source: &Source) -> Result<Case> {
    let table = source.toml()?;
    let node = PlacedValue::of_table(table.get_ref(), 0..0).map_err(|e| misfit(source, e))?;
    if let Value::Table(entries) = &node.value {
        let of = |key: &str| entries.iter().find(|e| e.key == key);
        if let Some((_, reason)) = another("a case", |key| of(key).is_some()) {
            return Err(Error::file(source.path, reason));
        }
        if let Some(entry) = of("region").or_else(|| of("regions")) {
            let reason = format!("key {}: regions stand in the table initial: [[initial.regions]]", entry.key);
            return Err(misfit(source, (entry.span.clone(), reason)));
        }
        if let Some(entry) = of("grid").filter(|e| matches!(e.node.value, Value::List(_))) {
            let reason = "a case has one table [grid]; tables [[grid]] belong to a study";
            return Err(misfit(source, (entry.span.clone(), reason.into())));
        }
    }
    places::check(&node).and_then(|()| ranges::check(&node, "")).map_err(|wrong| misfit(source, wrong))?;
    keys::read(source, &PlacedValue { span: None, ..node }, "")
}

impl CaseFile {
    /// Reads a case.
    ///
    /// # Errors
    /// The file cannot be read, is not TOML, holds a key that is not known or a value of the wrong type.
    pub fn read(path: &Path) -> Result<Self> {
        Source::no_geometry(path, "a case")?;
        let piped = text_of(path)?;
        let path = if piped.is_some() { Path::new(INPUT) } else { path };
        let text = match piped {
            Some(text) => text,
            None => crate::text::read(path)?,
        };
        let case = parse(&Source::new(path, &text))?;
        Ok(CaseFile { path: path.to_owned(), text, case })
    }

    /// A path of the case file, which counts from the file's own directory.
    #[must_use]
    pub fn resolve(&self, path: &Path) -> PathBuf {
        self.path.parent().map_or_else(|| path.to_owned(), |dir| dir.join(path))
    }

    /// The file or directory that a key names.
    ///
    /// # Errors
    /// It is not there.
    pub fn existing(&self, key: &str, path: &Path) -> Result<PathBuf> {
        let path = self.resolve(path);
        match path.exists() {
            true => Ok(path),
            false => Err(self.wrong(key, format!("{}: cannot open: No such file or directory", path.display()))),
        }
    }

    /// The values of an array in the directory that a key names.
    ///
    /// # Errors
    /// Those of the array, at the key.
    pub fn array(
        &self,
        key: &str,
        path: &Path,
        shape: [usize; 3],
        wrong: impl Fn(f64) -> Option<String>,
    ) -> Result<Vec<f64>> {
        arrays::read(path, shape, wrong).map_err(|e| self.wrong(key, e.to_string()))
    }

    /// The directory of fields that a key names, checked against the grid of the case if it says on which one the fields stand.
    ///
    /// # Errors
    /// It is not there, or its fields are of another grid.
    pub fn fields(&self, key: &str, dir: &Path, edges: &Edges) -> Result<PathBuf> {
        let dir = self.existing(key, dir)?;
        let path = dir.join(npy::EDGES);
        if path.exists() {
            let theirs = file::read(&path, &mut Vec::new()).map_err(|e| self.wrong(key, e.to_string()))?;
            if let Some(difference) = edges.differ_from(&theirs) {
                let reason = format!(
                    "{}: the arrays beside it are of another grid: {difference}; if they are of this one, remove the file",
                    path.display()
                );
                return Err(self.wrong(key, reason));
            }
        }
        Ok(dir)
    }

    /// An error at a key.
    #[must_use]
    pub fn wrong(&self, key: &str, reason: impl Into<String>) -> Error {
        Source::new(&self.path, &self.text).at_key(key, reason)
    }

    /// A warning about a key, with the place that an error would have.
    #[must_use]
    pub fn remark(&self, key: &str, reason: impl Into<String>) -> String {
        self.wrong(key, reason).to_string()
    }

    /// No two values of the list at `key` are equal.
    ///
    /// # Errors
    /// The second of two that are.
    pub fn distinct<T: PartialEq>(&self, key: &str, values: &[T]) -> Result<()> {
        match keys::first_repeated(values) {
            Some(n) => Err(self.wrong(&format!("{key}[{n}]"), "stands in this list before")),
            None => Ok(()),
        }
    }

    /// `name` heads columns of a table, and is none of the `others`, which it joins.
    ///
    /// # Errors
    /// It is one, or cannot head a column.
    pub fn column_name(&self, key: &str, name: &str, others: &mut HashSet<String>) -> Result<()> {
        if name.is_empty() {
            return Err(self.wrong(key, "is empty: give a name, or leave the key out"));
        }
        if name.contains(['\n', '\r']) {
            return Err(self.wrong(key, "needs a name in one line"));
        }
        match others.insert(name.to_owned()) {
            true => Ok(()),
            false => Err(self.wrong(key, format!("\"{name}\" is the name of another"))),
        }
    }

    /// Cell edges along x, y, z.
    ///
    /// # Errors
    /// No grid.
    pub fn edges(&self, warnings: &mut Vec<String>) -> Result<Edges> {
        match self.case.grid.elsewhere() {
            Some(file) => file::read(&self.existing("grid.file", file)?, warnings),
            None => self.case.grid.clone().edges(&Source::new(&self.path, &self.text), "grid.", true),
        }
    }
}
