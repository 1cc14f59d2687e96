//! The case file of a study: scenes × grids × methods × threads.
//!
//! ```toml
//! title = "A ball"
//! repeats = 5                       # default 3
//! threads = [1, 2]                  # default [1]
//! areas = false                     # default true
//!
//! [[scene]]
//! name = "ball"
//! files = ["ball.stl"]              # SCENE files beside the case; and, or instead, solids as in a scene file:
//! exact = 4.1887902047863905        # solid volume [m³] in every grid; without, the reference is the sum over the surface
//! probe = { cell = [0, 0, 0], beta_v = 1.0 }
//! [[scene.solid]]
//! name = "ball"
//! shape = "sphere"
//! center = [0, 0, 0]
//! radius = 1
//!
//! [[grid]]                          # as in a grid file
//! origin = [-2, -2, -2]
//! spacing = [0.1, 0.1, 0.1]
//! cells = [40, 40, 40]
//!
//! [[method]]
//! name = "certified"
//! method = "gjk"                    # method, leaf, tol, depth: as on the command line
//! leaf = "plane"
//! tol = 1e-4
//! depth = 6
//! ```

use crate::error::{Error, Result};
use crate::geometry::scene::table::{self, StrictTable};
use crate::geometry::scene::{self, SceneSolid};
use crate::grid::Edges;
use crate::keys::Source;
use crate::porosity::{Leaf, Method, Options};
use clap::ValueEnum;
use std::path::{Path, PathBuf};
use toml::de::DeValue;

/// A study.
#[derive(Debug, Clone)]
pub struct StudyCase {
    /// Head of its tables.
    pub title: String,
    /// Runs of each, of which the median time counts.
    pub repeats: usize,
    /// Numbers of threads.
    pub threads: Vec<usize>,
    /// Compute faces, too.
    pub areas: bool,
    /// What is measured.
    pub subjects: Vec<Subject>,
    /// On what.
    pub grids: Vec<Edges>,
    /// How.
    pub recipes: Vec<Recipe>,
}

/// A scene of a study.
#[derive(Debug, Clone)]
pub struct Subject {
    /// Its name in tables.
    pub name: String,
    /// SCENE files.
    pub files: Vec<PathBuf>,
    /// Solids of its own.
    pub solids: Vec<SceneSolid>,
    /// Solid volume in every grid, if it is known.
    pub exact: Option<f64>,
    /// A cell to look at.
    pub probe: Option<ProbeCell>,
}

/// A cell whose porosity is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProbeCell {
    /// Which, from 0.
    pub cell: [usize; 3],
    /// Its open fraction.
    pub beta_v: f64,
}

/// A way to compute the porosity.
#[derive(Debug, Clone)]
pub struct Recipe {
    /// Its name in tables.
    pub name: String,
    /// What it computes and how far.
    pub options: Options,
}

/// No case file is larger, in bytes.
const LARGEST_FILE: u64 = 1 << 26;

/// Most times a run is repeated, and most threads it gets.
const MOST: usize = 1024;

/// Read a case file; the scenes it names are not opened.
///
/// # Errors
/// As [`scene::read`].
pub fn read(path: &Path) -> Result<StudyCase> {
    parse(path, &table::read_text(path, LARGEST_FILE)?)
}

/// Read the text of a case file; `path` names it in messages.
///
/// # Errors
/// As [`read`].
pub fn parse(path: &Path, text: &str) -> Result<StudyCase> {
    let source = Source::new(path, text);
    let table = source.toml()?;
    let mut keys = StrictTable::new(&source, "", 0..0, table.get_ref());
    keys.is_a("a study")?;
    let title = keys.get("title", table::text)?.unwrap_or_default();
    let repeats = keys.get("repeats", few)?.unwrap_or(3);
    let threads = keys.get("threads", table::list(few))?.unwrap_or_else(|| vec![1]);
    let areas = keys.get("areas", table::truth)?.unwrap_or(true);
    let tables = (keys.tables("scene")?, keys.tables("method")?);
    let subjects = tables.0.into_iter().map(|k| subject(k, path)).collect::<Result<Vec<_>>>()?;
    let recipes = tables.1.into_iter().map(|k| recipe(k, areas)).collect::<Result<Vec<_>>>()?;
    let grids = keys.grids("grid")?;
    keys.finish()?;
    for (what, missing) in [
        ("scene", subjects.is_empty()),
        ("grid", grids.is_empty()),
        ("method", recipes.is_empty()),
        ("threads", threads.is_empty()),
    ] {
        if missing {
            return Err(Error::file(path, format!("a study needs at least one {what}")));
        }
    }
    for Subject { name, probe, .. } in &subjects {
        let outside = |g: &&Edges| probe.is_some_and(|p| (0..3).any(|a| p.cell[a] >= g.cells()[a]));
        if let Some(grid) = grids.iter().find(outside) {
            let [nx, ny, nz] = grid.cells();
            return Err(Error::file(
                path,
                format!("scene \"{name}\": the probe lies outside of the grid {nx}x{ny}x{nz}"),
            ));
        }
    }
    Ok(StudyCase { title, repeats, threads, areas, subjects, grids, recipes })
}

fn subject(mut keys: StrictTable, path: &Path) -> Result<Subject> {
    let name = keys.named()?;
    let beside = path.parent().unwrap_or(Path::new(""));
    let files = keys.get("files", table::list(table::text))?.unwrap_or_default();
    let files: Vec<PathBuf> = files.iter().map(|f| beside.join(f)).collect();
    let solids = scene::solids(&mut keys)?;
    let exact = keys.get("exact", table::number)?;
    let probe = keys.table("probe")?.map(|mut k| probe(&mut k)).transpose()?;
    keys.finish()?;
    if files.is_empty() && solids.is_empty() {
        return Err(keys.fail("needs files or [[scene.solid]]"));
    }
    Ok(Subject { name, files, solids, exact, probe })
}

fn probe(keys: &mut StrictTable) -> Result<ProbeCell> {
    let probe = ProbeCell {
        cell: keys.need("cell", table::three(table::index))?,
        beta_v: keys.need("beta_v", table::fraction)?,
    };
    keys.finish()?;
    Ok(probe)
}

fn recipe(mut keys: StrictTable, areas: bool) -> Result<Recipe> {
    let name = keys.named()?;
    let method = keys.get("method", choice::<Method>)?.unwrap_or_default();
    let leaf = keys.get("leaf", choice::<Leaf>)?.unwrap_or_default();
    let tol = keys.get("tol", table::fraction)?.unwrap_or(Options::default().tol);
    let depth = keys.get("depth", depth)?.unwrap_or(leaf.depth());
    keys.finish()?;
    Ok(Recipe { name, options: Options { tol, depth, bounds: false, areas, method, leaf } })
}

/// A number of repeats or threads.
fn few(value: &DeValue) -> std::result::Result<usize, String> {
    let n = table::count(value)?;
    if n <= MOST { Ok(n) } else { Err(format!("must be at most {MOST}, not {n}")) }
}

/// As on the command line.
fn depth(value: &DeValue) -> std::result::Result<u32, String> {
    let n = table::index(value)?;
    u32::try_from(n).ok().filter(|n| *n <= 10).ok_or_else(|| format!("must be at most 10, not {n}"))
}

/// One of the words of the command line.
fn choice<T: ValueEnum>(value: &DeValue) -> std::result::Result<T, String> {
    let word = table::text(value)?;
    T::from_str(&word, false).map_err(|_| {
        let all: Vec<String> =
            T::value_variants().iter().filter_map(|v| Some(v.to_possible_value()?.get_name().to_owned())).collect();
        format!("\"{word}\" is not known: {}", all.join(", "))
    })
}
