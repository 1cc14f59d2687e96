//! The case file of a study: scenes × grids × methods × threads.
//!
//! ```toml
//! title = "A ball"
//! repeats = 5                       # default 3
//! threads = [1, 2]                  # default [1]
//! areas = false                     # default true
//! refine = [1, 2, 4]                # each cell of each grid into so many along each axis; default [1]
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
//! depth = [4, 6]                    # lists multiply out
//! ```

use super::flows::keys::{FlowRecipe, flow_recipes};
use super::recipe::{Recipe, recipes};
use super::scaling::{ScalingRecipe, scaling_recipe};
use super::values::{few, some};
use crate::command::stages::room_for;
use crate::error::{Result, said};
use crate::geometry::scene::table::{self, StrictTable};
use crate::geometry::scene::{self, SceneSolid};
use crate::geometry::unit::Unit;
use crate::grid::Edges;
use crate::keys::{Source, first_repeated};
use crate::porosity::Method;
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
    /// Flows.
    pub flows: Vec<FlowRecipe>,
    /// Scenes that grow.
    pub scalings: Vec<ScalingRecipe>,
    /// Measure what is left out.
    pub left_out: bool,
    /// What readers should know.
    pub note: Option<String>,
    /// Shortened by [`StudyCase::quick`].
    pub is_quick: bool,
}

/// Grids that a quick study has, and steps of what grows.
const QUICK: usize = 2;

impl StudyCase {
    /// The same for a first look: one run of each, one number of threads, the two smallest grids and steps.
    #[must_use]
    pub fn quick(mut self) -> Self {
        let count = |grid: &Edges| grid.cells().iter().map(|&n| n as f64).product::<f64>();
        self.repeats = 1;
        self.threads.truncate(1);
        self.grids.sort_by(|a, b| count(a).total_cmp(&count(b)));
        self.grids.truncate(QUICK);
        for scaling in &mut self.scalings {
            scaling.counts.sort_unstable();
            scaling.counts.truncate(QUICK);
        }
        let flows = std::mem::take(&mut self.flows);
        let coarse = |flow: &FlowRecipe| {
            let finer = flows.iter().filter(|f| f.name == flow.name && f.choice.cells < flow.choice.cells);
            finer.count() < QUICK
        };
        self.flows = flows.iter().filter(|flow| coarse(flow)).cloned().collect();
        self.is_quick = true;
        self
    }

    /// The grids by their cells, `10x10x10`; where several have as many, all but the first with a number.
    #[must_use]
    pub fn grid_names(&self) -> Vec<String> {
        let cells: Vec<[usize; 3]> = self.grids.iter().map(Edges::cells).collect();
        let name = |(n, own): (usize, &[usize; 3])| match cells[..n].iter().filter(|c| *c == own).count() {
            0 => joined(*own),
            before => format!("{} ({})", joined(*own), before + 1),
        };
        cells.iter().enumerate().map(name).collect()
    }

    /// How many points of porosity it has, and what they cost by [`cost`].
    #[must_use]
    pub fn plan(&self) -> (usize, f64) {
        let pairs = self.grids.iter().flat_map(|grid| self.recipes.iter().map(move |recipe| (grid, recipe)));
        let costs: f64 = pairs.map(|(grid, recipe)| cost(grid, recipe, self.repeats)).sum();
        let often = self.subjects.len() * self.threads.len();
        (often * self.grids.len() * self.recipes.len(), often as f64 * costs)
    }
}

/// `10x10x10`.
#[must_use]
pub fn joined(cells: [usize; 3]) -> String {
    cells.map(|n| n.to_string()).join("x")
}

/// What a point costs, roughly: cells, and those that subdivision makes of the cells at surfaces.
#[must_use]
pub fn cost(edges: &Edges, recipe: &Recipe, repeats: usize) -> f64 {
    let cells: f64 = edges.cells().iter().map(|&n| n as f64).product();
    let parts = if recipe.options.method == Method::Gjk { 4_f64.powi(recipe.options.depth as i32) } else { 1.0 };
    (cells + 6.0 * cells.powf(2.0 / 3.0) * parts) * repeats as f64
}

/// A scene of a study.
#[derive(Debug, Clone)]
pub struct Subject {
    /// Its name in tables.
    pub name: String,
    /// SCENE files.
    pub files: Vec<PathBuf>,
    /// Unit of STL and OBJ files among them; metres without one.
    pub unit: Option<Unit>,
    /// Solids of its own.
    pub solids: Vec<SceneSolid>,
    /// Solid volume in every grid, if it is known.
    pub exact: Option<f64>,
    /// A cell to look at.
    pub probe: Option<ProbeCell>,
    /// Times of others.
    pub published: Vec<Published>,
}

/// A time that others have published for a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Published {
    /// Who, and what by.
    pub by: String,
    /// On so many cells.
    pub cells: [usize; 3],
    /// In seconds, on their machine.
    pub seconds: f64,
}

/// A cell whose porosity is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProbeCell {
    /// Which, from 0.
    pub cell: [usize; 3],
    /// Its open fraction.
    pub beta_v: f64,
}

/// No case file is larger, in bytes.
const LARGEST_FILE: u64 = 1 << 26;

/// The text of a case file.
///
/// # Errors
/// As [`table::read_text`].
pub fn text(path: &Path) -> Result<String> {
    Source::no_geometry(path, "a study")?;
    table::read_text(path, LARGEST_FILE)
}

/// Read the text of a case file, which `path` names in messages; the scenes it names are not opened.
///
/// # Errors
/// As [`scene::read`].
pub fn parse(path: &Path, text: &str) -> Result<StudyCase> {
    let source = Source::new(path, text);
    let table = source.toml()?;
    let mut keys = StrictTable::new(&source, "", 0..0, table.get_ref());
    keys.is_a("a study")?;
    let title = keys.get("title", table::text)?.unwrap_or_default();
    let repeats = keys.get("repeats", few)?.unwrap_or(3);
    let threads = keys.get("threads", some(few))?.unwrap_or_else(|| vec![1]);
    let areas = keys.get("areas", table::truth)?.unwrap_or(true);
    let refine = keys.get("refine", some(few))?.unwrap_or_else(|| vec![1]);
    let left_out = keys.get("left_out", table::truth)?.unwrap_or(false);
    let note = keys.get("note", table::text)?;
    let mut named = |key| keys.tables(key).and_then(StrictTable::with_names_of_their_own);
    let (scenes, methods, scalings) = (named("scene")?, named("method")?, named("scaling")?);
    let flows = keys.tables("flow")?.into_iter().map(flow_recipes).collect::<Result<Vec<_>>>()?.concat();
    let scalings = scalings.into_iter().map(scaling_recipe).collect::<Result<Vec<_>>>()?;
    let own_grids = keys.grids("grid")?;
    let grids: Vec<Edges> = own_grids.iter().flat_map(|g| refine.iter().map(|&n| g.refined(n))).collect();
    let subjects = scenes.into_iter().map(|k| subject(k, path, &grids)).collect::<Result<Vec<_>>>()?;
    let recipes = methods.into_iter().map(|k| recipes(k, areas)).collect::<Result<Vec<_>>>()?.concat();
    for edges in &grids {
        let grid = edges.grid(None).map_err(|e| keys.wrong("refine", e))?;
        room_for(grid.cell_count().saturating_mul(POROSITY_BYTES)).map_err(|e| keys.wrong("grid", e.reason))?;
    }
    keys.finish()?;
    if let Some(n) = first_repeated(&own_grids) {
        return Err(source.at_key(&format!("grid[{n}]"), "is the same as one before"));
    }
    let is_quick = false;
    let case = StudyCase {
        title,
        repeats,
        threads,
        areas,
        subjects,
        grids,
        recipes,
        flows,
        scalings,
        left_out,
        note,
        is_quick,
    };
    check_complete(&source, &case)?;
    Ok(case)
}

/// Bytes that the porosities of a cell and its faces take, those of the exact result beside them.
const POROSITY_BYTES: usize = 2 * 4 * size_of::<f64>();

/// A study needs something to do.
fn check_complete(source: &Source, case: &StudyCase) -> Result<()> {
    let StudyCase { subjects, grids, recipes, .. } = case;
    let others = !(case.flows.is_empty() && case.scalings.is_empty());
    let bare = subjects.is_empty() && grids.is_empty() && recipes.is_empty();
    for (what, missing) in [("scene", subjects.is_empty()), ("grid", grids.is_empty()), ("method", recipes.is_empty())]
    {
        if missing && !(bare && others) {
            let or = if bare { "; or flows, [[flow]], or scenes that grow, [[scaling]], alone" } else { "" };
            return Err(source.at_end(format!("a study needs at least one {what}, a table [[{what}]]{or}")));
        }
    }
    Ok(())
}

fn subject(mut keys: StrictTable, path: &Path, grids: &[Edges]) -> Result<Subject> {
    let name = keys.named()?;
    let beside = path.parent().unwrap_or(Path::new(""));
    let there = |value: &DeValue| existing(beside, value);
    let files = keys.get("files", some(there))?.unwrap_or_default();
    let unit = keys.get("unit", table::unit)?;
    let solids = scene::solids(&mut keys)?;
    let exact = keys.get("exact", table::positive)?;
    let probe = keys.table("probe")?.map(|mut k| probe(&mut k, grids)).transpose()?;
    let published = keys.tables("published")?.into_iter().map(published).collect::<Result<_>>()?;
    keys.finish()?;
    if files.is_empty() && solids.is_empty() {
        return Err(keys.fail("needs files or [[scene.solid]]"));
    }
    Ok(Subject { name, files, unit, solids, exact, probe, published })
}

fn published(mut keys: StrictTable) -> Result<Published> {
    let published = Published {
        by: keys.need("by", table::text)?,
        cells: keys.need("cells", table::three(table::count))?,
        seconds: keys.need("seconds", table::positive)?,
    };
    keys.finish()?;
    Ok(published)
}

/// The file of that name in a directory.
fn existing(directory: &Path, value: &DeValue) -> std::result::Result<PathBuf, String> {
    let name = table::text(value)?;
    let path = directory.join(&name);
    match std::fs::metadata(&path) {
        _ if name.is_empty() => Err("is an empty text in place of a file".to_owned()),
        Err(e) => Err(format!("{}: cannot open: {}", path.display(), said(&e))),
        Ok(_) => Ok(path),
    }
}

/// A cell of all `grids`.
fn probe(keys: &mut StrictTable, grids: &[Edges]) -> Result<ProbeCell> {
    let probe = ProbeCell {
        cell: keys.need("cell", table::three(table::index))?,
        beta_v: keys.need("beta_v", table::fraction)?,
    };
    keys.finish()?;
    match grids.iter().map(Edges::cells).find(|cells| (0..3).any(|a| probe.cell[a] >= cells[a])) {
        None => Ok(probe),
        Some([nx, ny, nz]) => {
            Err(keys.wrong("cell", format!("is no cell of the grid {nx}x{ny}x{nz}; cells are counted from 0")))
        }
    }
}
