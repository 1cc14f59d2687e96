//! The zones of `--zones`.

use crate::command::streams::{INPUT, text_of};
use crate::error::{Error, Result};
use crate::geometry::scene::table::{self, StrictTable};
use crate::grid::Edges;
use crate::keys::Source;
use crate::porosity::congestion::Zone;
use std::path::Path;
use voidage_core::number::aabb::Aabb;

/// No file of zones is larger, in bytes.
const LARGEST_FILE: u64 = 1 << 24;

/// The zones of a file; without one, the whole grid.
///
/// # Errors
/// A file that cannot be read, a key that is wrong, missing or not known, two zones of one name, a zone without extent or wholly outside the grid.
pub(super) fn read(path: Option<&Path>, edges: &Edges) -> Result<Vec<Zone>> {
    let whole = edges.bounds();
    let Some(path) = path else {
        return Ok(vec![Zone { name: "all".into(), bounds: Aabb { min: whole[0], max: whole[1] } }]);
    };
    Source::no_geometry(path, "a list of zones")?;
    let (path, text) = match text_of(path)? {
        Some(text) => (Path::new(INPUT), text),
        None => (path, table::read_text(path, LARGEST_FILE)?),
    };
    let source = Source::new(path, &text);
    let root = source.toml()?;
    let mut keys = StrictTable::new(&source, "", 0..0, root.get_ref());
    keys.is_a("a list of zones")?;
    let tables = StrictTable::with_names_of_their_own(keys.tables("zone")?)?;
    let zones: Vec<Zone> = tables.into_iter().map(|keys| zone(keys, whole)).collect::<Result<_>>()?;
    keys.finish()?;
    if zones.is_empty() { Err(Error::file(path, "no zones: it needs at least one [[zone]]")) } else { Ok(zones) }
}

fn zone(mut keys: StrictTable<'_>, [lowest, highest]: [glam::DVec3; 2]) -> Result<Zone> {
    let name = keys.named()?;
    let (min, max) = (keys.need("min", table::point)?, keys.need("max", table::point)?);
    keys.finish()?;
    if !min.cmplt(max).all() {
        return Err(keys.fail("min must lie below max along each axis"));
    }
    if !(min.cmplt(highest).all() && max.cmpgt(lowest).all()) {
        return Err(keys.fail(format!("lies outside the grid, {lowest} to {highest}")));
    }
    Ok(Zone { name, bounds: Aabb { min, max } })
}
