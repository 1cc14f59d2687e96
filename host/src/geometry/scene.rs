//! Scene files: solids by formula, by points or from files, placed, repeated, each with its own porosity.
//!
//! ```toml
//! [[solid]]
//! name = "pipe"
//! shape = "cylinder"
//! from = [0.0, 0.0, 0.0]
//! to = [10.0, 0.0, 0.0]
//! radius = 0.15
//! array = { count = [1, 8, 2], step = [0.0, 0.5, 3.0] }
//!
//! [[solid]]
//! name = "grating"
//! shape = "file"
//! path = "grating.stl"
//! unit = "mm"
//! porosity = 0.6
//! rotate = { axis = [0, 0, 1], angle = 30 }
//! translate = [0, 0, 3]
//! ```
//!
//! Lengths are in metres; a name may be left out. A solid is turned about its own centre (see [`shape::Shape::centre`]), then moved, then repeated. Every key
//! must be known. In reading order: [`table`], [`hull`], [`placement`], [`shape`], [`load`].

pub mod hull;
pub mod load;
pub mod placement;
pub mod shape;
pub mod table;

use crate::error::{Error, Result};
use crate::geometry::bodies::OwnDrag;
use crate::grid::Edges;
use crate::keys::Source;
use placement::{MOST_COPIES, Placement};
use shape::Shape;
use std::path::{Path, PathBuf};
use table::StrictTable;

/// A scene file.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// The file.
    pub path: PathBuf,
    /// Its solids in file order.
    pub solids: Vec<SceneSolid>,
    /// Its grid, if it has one.
    pub grid: Option<Edges>,
}

/// A solid of a scene: a shape, placed and repeated.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneSolid {
    /// Its name.
    pub name: String,
    /// An error about it, without a reason yet: where it stands, by its `path` if it is from a file.
    pub place: Error,
    /// What it is.
    pub shape: Shape,
    /// Its own open fraction: 0 is solid.
    pub porosity: f64,
    /// Its drag, if it is given.
    pub drag: OwnDrag,
    /// Where it and its copies are.
    pub placement: Placement,
}

/// No solid has a larger drag coefficient.
pub const MOST_CD: f64 = 1e6;

/// No scene file is larger, in bytes.
const LARGEST_FILE: u64 = 1 << 28;

/// Is a SCENE argument a scene file?
#[must_use]
pub fn is_scene(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml"))
}

/// Read a scene file; the files it names are not opened.
///
/// # Errors
/// A file that cannot be read, a key that is wrong, missing or not known: with the line, the solid and the reason.
pub fn read(path: &Path) -> Result<Scene> {
    parse(path, &table::read_text(path, LARGEST_FILE)?)
}

/// Read the text of a scene file; `path` names it in messages.
///
/// # Errors
/// As [`read`].
pub fn parse(path: &Path, text: &str) -> Result<Scene> {
    let source = Source::new(path, text);
    let table = source.toml()?;
    let mut keys = StrictTable::new(&source, "", 0..0, table.get_ref());
    keys.is_a("a scene")?;
    not_beside_a_scene(path, &keys)?;
    let solids = solids(&mut keys)?;
    let grid = keys.grid("grid")?;
    keys.finish()?;
    if solids.is_empty() {
        return Err(Error::file(path, "a scene without solids: it needs at least one [[solid]]"));
    }
    Ok(Scene { path: path.to_owned(), solids, grid })
}

/// Files that stand beside a scene: what they are, a key that only they have, and how the commands take them.
const BESIDE: [(&str, &str, &str); 7] = [
    ("a grid", "x", GRID_FILE),
    ("a grid", "y", GRID_FILE),
    ("a grid", "z", GRID_FILE),
    ("a grid", "origin", GRID_FILE),
    ("a grid", "spacing", GRID_FILE),
    ("a grid", "cells", GRID_FILE),
    ("a list of zones", "zone", "voidage porosity takes it by --zones"),
];

/// How a grid file is taken.
const GRID_FILE: &str = "voidage porosity takes it by --grid, [grid] file = \"FILE\" of a case names it";

/// Refuses a file of another kind that has no solids.
fn not_beside_a_scene(path: &Path, keys: &StrictTable) -> Result<()> {
    match BESIDE.iter().find(|(_, key, _)| keys.has(key)).filter(|_| !keys.has("solid")) {
        Some((kind, key, taken)) => {
            Err(Error::file(path, format!("this is {kind}, not a scene: it has the key {key}; {taken}")))
        }
        None => Ok(()),
    }
}

/// The tables `[[solid]]` of a scene.
///
/// # Errors
/// As [`read`].
pub fn solids(keys: &mut StrictTable) -> Result<Vec<SceneSolid>> {
    let mut total = 0;
    let tables = keys.tables("solid")?.into_iter();
    let counted = tables.map(|table| {
        let (solid, table) = solid(table)?;
        total += solid.placement.copies();
        let few = total <= MOST_COPIES;
        if few { Ok(solid) } else { Err(table.fail(format!("more than {MOST_COPIES} solids in one scene"))) }
    });
    counted.collect()
}

fn solid(mut keys: StrictTable<'_>) -> Result<(SceneSolid, StrictTable<'_>)> {
    let name = keys.named()?;
    let shape = Shape::read(&mut keys)?;
    let porosity = keys.get("porosity", table::fraction)?.unwrap_or(0.0);
    let drag =
        OwnDrag { cd: keys.get("cd", table::up_to(MOST_CD))?, cr: keys.get("cr", table::up_to(table::LARGEST))? };
    if drag.cd.is_some() && drag.cr.is_some() {
        return Err(keys
            .fail("takes cd, the drag coefficient of its frontal area, or cr, the resistance of the whole, not both"));
    }
    if drag.cd.is_some() && porosity > 0.0 {
        return Err(keys.wrong("cd", "is of solid obstacles; the resistance of a porous one is cr"));
    }
    let placement = Placement::read(&mut keys)?;
    keys.finish()?;
    Ok((SceneSolid { name, place: keys.place("path"), shape, porosity, drag, placement }, keys))
}
