//! The ways to compute of a study: the lists of a table `[[method]]` multiply out.

use super::values::{choice, depth, product, some, varied, word};
use crate::error::Result;
use crate::geometry::scene::table::{self, StrictTable};
use crate::porosity::{Leaf, Method, Options};
use clap::ValueEnum;

/// What numbers are computed with.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum Precision {
    /// Double precision.
    #[default]
    F64,
    /// Single precision.
    F32,
}

impl Precision {
    /// As in the file.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Precision::F64 => "f64",
            Precision::F32 => "f32",
        }
    }
}

/// A way to compute the porosity.
#[derive(Debug, Clone)]
pub struct Recipe {
    /// Its name in tables: that of its table, and what varies within it.
    pub name: String,
    /// The name without depth and tolerance: those who share it have one colour in a picture.
    pub family: String,
    /// What it computes and how far.
    pub options: Options,
    /// In which numbers.
    pub precision: Precision,
}

impl Recipe {
    /// The point of the paper: what is touched at depth 3 counts as solid.
    #[must_use]
    pub fn is_the_papers(&self) -> bool {
        let Options { method, leaf, depth, .. } = self.options;
        (method, leaf, depth) == (Method::Gjk, Leaf::Solid, Leaf::Solid.depth())
    }
}

/// The recipes of a table, in the order of its lists.
///
/// # Errors
/// A value that is none, or lists that leave nothing.
pub fn recipes(mut keys: StrictTable, areas: bool) -> Result<Vec<Recipe>> {
    let name = keys.named()?;
    let methods = keys.get("method", some(choice::<Method>))?.unwrap_or_else(|| vec![Method::default()]);
    let given = keys.get("leaf", some(choice::<Leaf>))?;
    if given.is_some() && !methods.contains(&Method::Gjk) {
        return Err(keys.fail("leaf has no effect: it is of the method gjk, which subdivides bodies"));
    }
    let leaves = given.unwrap_or_else(|| vec![Leaf::default()]);
    let depths = keys.get("depth", some(depth))?;
    let tols = keys.get("tol", some(table::fraction))?.unwrap_or_else(|| vec![Options::default().tol]);
    let precisions = keys.get("precision", some(choice::<Precision>))?.unwrap_or_else(|| vec![Precision::F64]);
    keys.finish()?;
    let mut all: Vec<Recipe> = Vec::new();
    for (&method, &leaf, &precision) in product(&methods, &leaves, &precisions) {
        // Without subdivision no part is left to be judged.
        let leaf = if method == Method::Gjk { leaf } else { Leaf::Plane };
        if precision == Precision::F32 && (method == Method::Gjk || leaf != Leaf::Plane) {
            continue;
        }
        for (&depth, &tol, ()) in product(depths.as_deref().unwrap_or(&[leaf.depth()]), &tols, &[()]) {
            let mut parts = vec![
                (methods.len(), word(method)),
                (if method == Method::Gjk { leaves.len() } else { 1 }, format!("{} leaf", word(leaf))),
                (precisions.len(), precision.name().to_owned()),
            ];
            let family = varied(&name, &parts);
            parts.push((depths.as_ref().map_or(1, Vec::len), format!("depth {depth}")));
            parts.push((tols.len(), format!("tol {tol:e}")));
            let options = Options { tol, depth, areas, method, leaf, ..Options::default() };
            let recipe = Recipe { name: varied(&name, &parts), family, options, precision };
            if all.iter().all(|r| r.name != recipe.name) {
                all.push(recipe);
            }
        }
    }
    if all.is_empty() {
        return Err(keys.fail("nothing is left: f32 is computed by the methods auto (leaf plane) and surface"));
    }
    Ok(all)
}
