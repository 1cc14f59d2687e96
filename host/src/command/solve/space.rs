//! Where the open fractions of a case come from: a scene through the porosity stage, a directory of arrays, or nowhere.

use super::arrays;
use super::case::{LawName, Paths, PorosityKeys};
use super::case_file::CaseFile;
use super::coarse;
use super::solids::{self, Measured, OTHERS};
use crate::command::cli::SceneArgs;
use crate::command::obstacles::{Wanted, obstacles, warn_of_gratings, warn_of_no_force};
use crate::command::progress::Progress;
use crate::command::stages;
use crate::command::streams::{INPUT, is_stream};
use crate::error::{Error, Result};
use crate::geometry::bodies::{Bodies, Body, OwnDrag};
use crate::geometry::scene::is_scene;
use crate::grid::{AXES, Edges};
use crate::keys::reader::nearest;
use crate::porosity::drag::{DragCoefficients, DragLaw};
use crate::porosity::throat::{Faces, LoweredSide};
use crate::porosity::{FieldSet, Options};
use crate::words::counted;
use std::path::{Path, PathBuf};

/// Open fractions of all cells and of the faces of the axes that flow.
#[derive(Debug, Clone)]
pub struct Space<const D: usize> {
    /// `beta_v`.
    pub volume: Vec<f64>,
    /// `beta_x`, `beta_y`, `beta_z` of the axes that flow.
    pub faces: [Vec<f64>; D],
    /// `cr` of the axes that flow, by the law of the case.
    pub drag: Option<[Vec<f64>; D]>,
    /// Faces in sides of the grid that obstacles with gas all around have lowered.
    pub surrounded: Vec<LoweredSide>,
    /// The solids; none where the open fractions come from files.
    pub scene: Option<SceneBodies>,
}

/// A cell that is open by less is solid: unions of solids are known to some 1e-12 of a cell, and what rounding leaves of one would be a pocket of gas.
const DUST: f64 = 1e-9;

/// Where the low and the high face of a cell along an axis stand among those of that axis.
fn faces_of(cell: usize, axis: usize, cells: [usize; 3]) -> [usize; 2] {
    let shape = std::array::from_fn(|a| cells[a] + usize::from(a == axis));
    let low = arrays::index(cell, cells);
    let mut high = low;
    high[axis] += 1;
    [low, high].map(|face| arrays::position(face, shape))
}

/// Closes cells that rounding has left open, with all their faces, given as [`Space`] has them; returns how many cells and how many faces.
pub fn close_dust<const D: usize>(
    (volume, faces): (&mut [f64], &mut [Vec<f64>; D]),
    cells: [usize; 3],
    live: [usize; D],
) -> [usize; 2] {
    let mut closed = [0, 0];
    for (n, open) in volume.iter_mut().enumerate().filter(|(_, open)| **open > 0.0 && **open < DUST) {
        *open = 0.0;
        closed[0] += 1;
        for (faces, &axis) in faces.iter_mut().zip(&live) {
            for face in faces_of(n, axis, cells) {
                let open = std::mem::replace(&mut faces[face], 0.0);
                closed[1] += usize::from(open > 0.0);
            }
        }
    }
    closed
}

/// The solids of a scene, and how they are measured.
#[derive(Debug, Clone)]
pub struct SceneBodies {
    /// The solids.
    pub bodies: Bodies,
    /// How their volumes are found.
    pub options: Options,
}

/// The open fractions of a case, none where all of the space is open; and what the solids whose forces are asked for have alone.
///
/// # Errors
/// The scene cannot be measured, or an array is missing or wrong.
pub fn load<const D: usize>(
    file: &CaseFile,
    edges: &Edges,
    live: [usize; D],
    progress: &mut Progress,
) -> Result<(Option<Space<D>>, Vec<Measured<D>>)> {
    let keys = &file.case.porosity;
    check(file, keys)?;
    let (space, solids) = match (&keys.scene, &keys.from) {
        (Some(scene), None) => from_scene(file, scene, edges, live, progress)?,
        (None, Some(dir)) => {
            let dir = file.fields("porosity.from", dir, edges)?;
            let read = |name: &str, shape| {
                file.array("porosity.from", &dir.join(format!("beta_{name}.npy")), shape, arrays::fraction)
            };
            let cells = edges.cells();
            let faces: Vec<Vec<f64>> = live
                .iter()
                .map(|&d| read(AXES[d], std::array::from_fn(|a| cells[a] + usize::from(a == d))))
                .collect::<Result<_>>()?;
            let mut faces = faces.into_iter();
            let faces = std::array::from_fn(|_| faces.next().unwrap_or_default());
            warn_of_coefficients(file, &dir, edges, live, progress);
            let volume = read("v", cells)?;
            warn_of_open_solid(file, (&volume, &faces), cells, live, progress);
            (Space { volume, faces, drag: None, surrounded: Vec::new(), scene: None }, Vec::new())
        }
        (None, None) => return Ok((None, Vec::new())),
        (Some(_), Some(_)) => return Err(file.wrong("porosity", "takes scene or from, not both")),
    };
    let resists = space.drag.iter().flatten().flatten().any(|&cr| cr > 0.0);
    let open = !resists && space.volume.iter().chain(space.faces.iter().flatten()).all(|&b| b == 1.0);
    Ok((if open { None } else { Some(space) }, solids))
}

/// Says that gas passes cells that are solid, by faces that are open.
fn warn_of_open_solid<const D: usize>(
    file: &CaseFile,
    (volume, faces): (&[f64], &[Vec<f64>; D]),
    cells: [usize; 3],
    live: [usize; D],
    progress: &mut Progress,
) {
    let is_passed = |cell: usize| {
        live.iter()
            .zip(faces)
            .any(|(&axis, faces)| faces_of(cell, axis, cells).into_iter().any(|face| faces[face] >= DUST))
    };
    let mut passed = (0..volume.len()).filter(|&cell| volume[cell] == 0.0 && is_passed(cell));
    if let Some(first) = passed.next() {
        let count = counted(passed.count() + 1, "cell is solid but has", "cells are solid but have");
        let at = arrays::index(first, cells);
        let reason =
            format!("{count} open faces, the first at {at:?}: gas passes there; faces of solid cells are closed");
        progress.warn(file.remark("porosity.from", reason));
    }
}

/// Says that arrays of resistance lie beside those of porosity, and that nothing takes them.
fn warn_of_coefficients<const D: usize>(
    file: &CaseFile,
    dir: &Path,
    edges: &Edges,
    live: [usize; D],
    progress: &mut Progress,
) {
    let name = |axis: usize| format!("cr_{}.npy", AXES[axis]);
    let resists = |axis: &usize| {
        let read = file.array("porosity.from", &dir.join(name(*axis)), edges.cells(), |_| None);
        read.is_ok_and(|cr| cr.iter().any(|&cr| cr > 0.0))
    };
    if given_otherwise(file) {
        return;
    }
    if let Some(axis) = live.into_iter().find(resists) {
        let reason = format!("{} lies there, too, and exerts no force: [drag] from takes it", name(axis));
        progress.warn(file.remark("porosity.from", reason));
    }
}

/// The files of a scene, from where the case lies.
fn scene_files(file: &CaseFile, Paths(paths): &Paths) -> Result<SceneArgs> {
    if paths.is_empty() {
        return Err(file.wrong("porosity.scene", "names no file"));
    }
    if let Some(n) = paths.iter().position(|path| path.as_os_str().is_empty()) {
        let key = if paths.len() == 1 { "porosity.scene".to_owned() } else { format!("porosity.scene[{n}]") };
        return Err(file.wrong(&key, "is an empty text in place of a file"));
    }
    file.distinct("porosity.scene", paths)?;
    paths.iter().filter(|path| !is_stream(path)).try_for_each(|path| {
        match file.existing("porosity.scene", path)? {
            path if path.is_dir() => {
                Err(file.wrong("porosity.scene", format!("{}: is a directory, not a file", path.display())))
            }
            _ => Ok(()),
        }
    })?;
    if file.case.porosity.unit.is_some() && paths.iter().all(|path| is_scene(path)) {
        let reason =
            "is of STL and OBJ files: a scene is in metres, and there each solid of shape \"file\" takes a unit";
        return Err(file.wrong("porosity.unit", reason));
    }
    if paths.iter().any(|path| is_stream(path)) && file.path == Path::new(INPUT) {
        return Err(file.wrong("porosity.scene", "the standard input can be read once, and the case came from it"));
    }
    let place = |path: &PathBuf| if is_stream(path) { path.clone() } else { file.resolve(path) };
    Ok(SceneArgs { scene: paths.iter().map(place).collect(), unit: file.case.porosity.unit })
}

/// What is wrong with a file as a whole, told at the key that names it; what is wrong at a place in a file stays there.
fn at_its_key(file: &CaseFile, files: &SceneArgs, error: Error) -> Error {
    let is_whole = error.place.is_none() && error.excerpt.is_none();
    let names_it = |path: &PathBuf| Some(path) == error.path.as_ref();
    match files.scene.iter().position(names_it).filter(|_| is_whole) {
        Some(_) if files.scene.len() == 1 => file.wrong("porosity.scene", error.to_string()),
        Some(n) => file.wrong(&format!("porosity.scene[{n}]"), error.to_string()),
        None => error,
    }
}

/// The one place where a scene becomes open fractions.
fn from_scene<const D: usize>(
    file: &CaseFile,
    scene: &Paths,
    edges: &Edges,
    live: [usize; D],
    progress: &mut Progress,
) -> Result<(Space<D>, Vec<Measured<D>>)> {
    let keys = &file.case.porosity;
    // The flow has a grid of its own; that of a scene file is for the scene alone.
    let files = scene_files(file, scene)?;
    let (bodies, _) = stages::load(&files, progress).map_err(|error| at_its_key(file, &files, error))?;
    let usual = Options::default();
    let options = Options { tol: keys.tol.unwrap_or(usual.tol), depth: keys.depth.unwrap_or(usual.depth), ..usual };
    let (left_out, with_surface) = (file.case.grid.left_out(), Options { resistance: true, ..options });
    let mut result = stages::measure(&bodies, edges, left_out, with_surface, progress)?;
    let (wanted, faces) = (wanted_solids(file, &bodies)?, keys.faces.unwrap_or(Faces::Throat));
    if wanted.is_empty() && !file.case.output.forces.is_empty() {
        let reason = "no solid of the scene has a name: the force on all of them is told as that on others";
        progress.warn(file.remark("output.forces", reason));
    }
    let solids = match file.case.output.forces.is_empty() {
        true => Vec::new(),
        false => progress.stage("solids", |_| solids::measure(&bodies, &wanted, edges, live, (options, faces)))?,
    };
    let absent: Vec<String> = solids.iter().filter_map(Measured::absent).collect();
    if !absent.is_empty() {
        let names = absent.join(", ");
        let reason = format!("{names}: without a part in the grid that no other name has: all forces on them are 0");
        progress.warn(file.remark("output.forces", reason));
    }
    if let Some(coarse) = coarse::coarse(&bodies, &wanted, edges, &live) {
        progress.warn(file.remark("output.forces", coarse));
    }
    let (grid, law) = (edges.grid(None)?, law(file)?);
    let silent = file.case.drag.law == Some(LawName::None) || given_otherwise(file);
    let has_own = |body: &Body| body.drag != OwnDrag::default();
    let any_has_own = bodies.bodies.iter().any(has_own);
    // Solids with a drag of their own need no law; the others have none by this one.
    let no_drag = DragCoefficients { round: 0.0, sharp: 0.0 };
    let own = (any_has_own && law.is_none() && !given_otherwise(file)).then_some((DragLaw::Bluff, no_drag));
    if given_otherwise(file) && any_has_own {
        progress
            .warn(file.remark("drag", "its cr or from stands in place of the cd and cr that solids of the scene have"));
    }
    let wanted = Wanted { resistance: law.is_none() && !silent, drag: law.or(own), faces, warning: true };
    let found = obstacles(&grid, &bodies, &mut result, options, wanted, progress);
    // What has a drag of its own has told what it resists; of the others it is asked.
    let all_have_one = bodies.bodies.iter().all(|body| body.porosity > 0.0 || has_own(body));
    if let Some(resistance) = found.resistance.as_ref().filter(|_| law.is_none() && !silent && !all_have_one) {
        warn_of_no_force(&bodies, (resistance, found.unseen), progress);
    }
    if !silent && wanted.drag.is_none() {
        warn_of_gratings(&bodies, progress);
    }
    let drag = found.drag.map(|drag| live.map(|d| drag.cr[d].clone()));
    let FieldSet { v, x, y, z } = result.beta;
    let faces = [x, y, z];
    let faces = live.map(|d| faces[d].to_vec());
    let (surrounded, scene) = (found.surrounded, Some(SceneBodies { bodies, options }));
    Ok((Space { volume: v.to_vec(), faces, drag, surrounded, scene }, solids))
}

/// Names of the solids whose forces are asked for; `*` stands for all.
fn wanted_solids(file: &CaseFile, bodies: &Bodies) -> Result<Vec<String>> {
    let mut names: Vec<String> = Vec::new();
    let all = solids::names(bodies);
    let known = |name: &str| all.iter().any(|own| own.contains(&name));
    file.distinct("output.forces", &file.case.output.forces)?;
    for (n, name) in file.case.output.forces.iter().enumerate() {
        let more: Vec<&str> = match &name[..] {
            "*" => all.iter().map(|[_, solid]| *solid).filter(|name| !name.is_empty()).collect(),
            "" => return Err(file.wrong(&format!("output.forces[{n}]"), "is an empty text in place of a name")),
            name if known(name) => vec![name],
            name => {
                let names: Vec<&str> = all.iter().flatten().copied().filter(|name| !name.is_empty()).collect();
                let is_end = |own: &&&str| own.rsplit('/').next() == Some(name);
                let near = nearest(name, &names).or_else(|| names.iter().find(is_end).copied());
                let near = near.map_or_else(String::new, |near| format!("; did you mean {near}?"));
                return Err(file.wrong(&format!("output.forces[{n}]"), format!("no solid is called \"{name}\"{near}")));
            }
        };
        for name in more {
            if name == OTHERS {
                let reason = format!("\"{OTHERS}\" heads the columns of all other solids: give this one another name");
                return Err(file.wrong(&format!("output.forces[{n}]"), reason));
            }
            if !names.iter().any(|known| known == name) {
                names.push(name.to_owned());
            }
        }
    }
    Ok(names)
}

/// Is there a resistance that needs no law?
pub fn given_otherwise(file: &CaseFile) -> bool {
    let keys = &file.case.drag;
    keys.cr.is_some() || keys.from.is_some()
}

/// Does a law give solids a drag?
pub fn has_law(file: &CaseFile) -> bool {
    matches!(file.case.drag.law, Some(LawName::Bluff | LawName::Pdr))
}

/// The law of `[drag]` and its coefficients.
fn law(file: &CaseFile) -> Result<Option<(DragLaw, DragCoefficients)>> {
    let keys = &file.case.drag;
    let given = [("drag.cd", keys.cd), ("drag.cd_round", keys.cd_round), ("drag.cd_sharp", keys.cd_sharp)];
    let law = match keys.law {
        None | Some(LawName::None) => {
            return match given.iter().find(|(_, value)| value.is_some()) {
                Some((key, _)) => Err(file.wrong(key, "goes with drag.law = \"bluff\" or \"pdr\"")),
                None => Ok(None),
            };
        }
        Some(LawName::Bluff) => DragLaw::Bluff,
        Some(LawName::Pdr) => DragLaw::Pdr,
    };
    if given_otherwise(file) {
        return Err(file.wrong("drag", "takes law, or cr or from, not both"));
    }
    let usual = DragCoefficients::default();
    let of = |shape: Option<f64>, usual: f64| shape.or(keys.cd).unwrap_or(usual);
    let cd = DragCoefficients { round: of(keys.cd_round, usual.round), sharp: of(keys.cd_sharp, usual.sharp) };
    Ok(Some((law, cd)))
}

fn check(file: &CaseFile, keys: &PorosityKeys) -> Result<()> {
    let given = [
        ("porosity.unit", keys.unit.is_some()),
        ("porosity.tol", keys.tol.is_some()),
        ("porosity.depth", keys.depth.is_some()),
        ("porosity.faces", keys.faces.is_some()),
        ("drag.law", file.case.drag.law.is_some()),
        ("drag.cd", file.case.drag.cd.is_some()),
        ("drag.cd_round", file.case.drag.cd_round.is_some()),
        ("drag.cd_sharp", file.case.drag.cd_sharp.is_some()),
        ("output.forces", !file.case.output.forces.is_empty()),
    ];
    match given.iter().find(|(_, given)| *given && keys.scene.is_none()) {
        Some((key, _)) => Err(file.wrong(key, "goes with porosity.scene: it is about the solids of a scene")),
        None => law(file).map(drop),
    }?;
    let treated = [("porosity.jump", keys.jump.is_some()), ("porosity.merge", keys.merge.is_some())];
    match treated.iter().find(|(_, given)| *given && keys.scene.is_none() && keys.from.is_none()) {
        Some((key, _)) => Err(file.wrong(key, "goes with porosity.scene or porosity.from: without them all is open")),
        None => Ok(()),
    }
}
