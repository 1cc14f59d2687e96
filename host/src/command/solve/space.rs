//! Where the open fractions of a case come from: a scene through the porosity stage, a directory of arrays, or nowhere.

use super::arrays;
use super::case::{CaseFile, Paths, PorosityKeys};
use crate::command::cli::SceneArgs;
use crate::command::progress::Progress;
use crate::command::stages;
use crate::error::Result;
use crate::grid::Edges;
use crate::porosity::{FieldSet, Options};

/// Open fractions of all cells and of the faces of the axes that flow.
#[derive(Debug, Clone)]
pub struct Space<const D: usize> {
    /// `beta_v`.
    pub volume: Vec<f64>,
    /// `beta_x`, `beta_y`, `beta_z` of the axes that flow.
    pub faces: [Vec<f64>; D],
}

/// The open fractions of a case; none where all of the space is open.
///
/// # Errors
/// The scene cannot be measured, or an array is missing or wrong.
pub fn load<const D: usize>(
    file: &CaseFile,
    edges: &Edges,
    live: [usize; D],
    progress: &mut Progress,
) -> Result<Option<Space<D>>> {
    let keys = &file.case.porosity;
    check(file, keys)?;
    let space = match (&keys.scene, &keys.from) {
        (Some(scene), None) => from_scene(file, scene, edges, live, progress)?,
        (None, Some(dir)) => {
            let dir = file.resolve(dir);
            let read = |name: &str, shape| arrays::read(&dir.join(format!("beta_{name}.npy")), shape, arrays::fraction);
            let cells = edges.cells();
            let faces: Vec<Vec<f64>> = live
                .iter()
                .map(|&d| read(["x", "y", "z"][d], std::array::from_fn(|a| cells[a] + usize::from(a == d))))
                .collect::<Result<_>>()?;
            let mut faces = faces.into_iter();
            Space { volume: read("v", cells)?, faces: std::array::from_fn(|_| faces.next().unwrap_or_default()) }
        }
        (None, None) => return Ok(None),
        (Some(_), Some(_)) => return Err(file.wrong("porosity", "takes scene or from, not both")),
    };
    let open = space.volume.iter().chain(space.faces.iter().flatten()).all(|&b| b == 1.0);
    Ok(if open { None } else { Some(space) })
}

/// The one place where a scene becomes open fractions.
fn from_scene<const D: usize>(
    file: &CaseFile,
    scene: &Paths,
    edges: &Edges,
    live: [usize; D],
    progress: &mut Progress,
) -> Result<Space<D>> {
    let keys = &file.case.porosity;
    let Paths(paths) = scene;
    if paths.is_empty() {
        return Err(file.wrong("porosity.scene", "names no file"));
    }
    let scene = SceneArgs { scene: paths.iter().map(|p| file.resolve(p)).collect(), unit: keys.unit };
    // The flow has a grid of its own; that of a scene file is for the scene alone.
    let (bodies, _) = stages::load(&scene, progress)?;
    let usual = Options::default();
    let options = Options { tol: keys.tol.unwrap_or(usual.tol), depth: keys.depth.unwrap_or(usual.depth), ..usual };
    let FieldSet { v, x, y, z } = stages::measure(&bodies, edges, options, progress)?.beta;
    let faces = [x, y, z];
    Ok(Space { volume: v.to_vec(), faces: live.map(|d| faces[d].to_vec()) })
}

fn check(file: &CaseFile, keys: &PorosityKeys) -> Result<()> {
    file.demand("porosity.tol", keys.tol, |t| (0.0..=1.0).contains(&t), "needs a fraction from 0 to 1")?;
    file.demand("porosity.jump", keys.jump, |j| j > 0.0, "needs a positive number or inf")?;
    if keys.depth.is_some_and(|d| d > 10) {
        return Err(file.wrong("porosity.depth", "is at most 10"));
    }
    let of_scene = [("unit", keys.unit.is_some()), ("tol", keys.tol.is_some()), ("depth", keys.depth.is_some())];
    match of_scene.iter().find(|(_, given)| *given && keys.scene.is_none()) {
        Some((key, _)) => Err(file.wrong(&format!("porosity.{key}"), "goes with porosity.scene")),
        None => Ok(()),
    }
}
