//! The output files of `voidage porosity`: whether they may be written, and what is in them.

use super::report::Report;
use crate::command::cli::PorosityArgs;
use crate::command::obstacles::Obstacles;
use crate::command::progress::{Progress, print};
use crate::command::streams::{
    OutputFormat, check_directory, check_place, check_suffix, is_stream, make_place, replaces,
};
use crate::error::{Error, Result};
use crate::files::npy;
use crate::files::vtr::{CellField, NamedField, Vtr};
use crate::grid::{AXES, Edges};
use crate::keys::reader::not_known;
use crate::picture::png;
use crate::porosity::Porosity;
use crate::porosity::drag::ObstacleDrag;
use crate::porosity::resistance::Resistance;
use crate::words::written;
use std::path::{Path, PathBuf};

/// The arguments with what `-o` asks for in the place that its suffix tells.
///
/// # Errors
/// A suffix that is not known, or two outputs of one format.
pub(super) fn by_suffix(args: &PorosityArgs) -> Result<PorosityArgs> {
    let mut args = args.clone();
    let Some(path) = args.output.take() else { return Ok(args) };
    let (place, option) = match OutputFormat::of(&path)? {
        OutputFormat::Fields => (&mut args.output, "-o"),
        OutputFormat::Picture => (&mut args.png, "--png"),
        OutputFormat::Report => (&mut args.report, "--report"),
    };
    match place.replace(path) {
        None => Ok(args),
        Some(other) => Err(Error::usage(format!("{}: {option} and -o ask for the same", other.display()))),
    }
}

/// Outputs must have a place, and none may replace a file of the scene, the grid or another output.
///
/// # Errors
/// The first that has none, or would.
pub(super) fn check(args: &PorosityArgs) -> Result<()> {
    let arrays = arrays(args);
    let files = [&args.output, &args.png, &args.report].into_iter().flatten();
    let outputs: Vec<&Path> = arrays.iter().chain(files).map(|p| p.as_path()).collect();
    args.npy.iter().try_for_each(|dir| check_directory("--npy", dir))?;
    if args.png.is_none() && !args.slice.is_empty() {
        return Err(Error::usage("--slice cuts a picture: give --png FILE.png"));
    }
    check_inputs(args)?;
    check_use(args)?;
    check_show(args)?;
    args.png.iter().try_for_each(|path| check_suffix("--png", path, "png"))?;
    args.report.iter().try_for_each(|path| check_suffix("--report", path, "json"))?;
    if outputs.iter().filter(|path| is_stream(path)).count() > 1 {
        return Err(Error::usage("two outputs to -: the standard output takes one"));
    }
    for (n, output) in outputs.iter().enumerate() {
        check_place(output)?;
        let inputs = args.scene.scene.iter().chain(&args.grid).chain(&args.zones).map(|p| p.as_path());
        if inputs.chain(outputs[..n].iter().copied()).any(|other| replaces(output, other)) {
            return Err(Error::usage(format!(
                "{}: an output would replace another file of this run",
                output.display()
            )));
        }
    }
    Ok(())
}

/// The standard input can be read once.
fn check_inputs(args: &PorosityArgs) -> Result<()> {
    let scenes = args.scene.scene.iter().map(|path| ("the scene", path));
    let others = [("--grid", &args.grid), ("--zones", &args.zones)];
    let all = scenes.chain(others.into_iter().filter_map(|(what, path)| Some((what, path.as_ref()?))));
    let mut piped: Vec<&str> = all.filter(|(_, path)| is_stream(path)).map(|(what, _)| what).collect();
    // Two files of one scene are refused where it is read.
    piped.dedup();
    if piped.len() < 2 {
        return Ok(());
    }
    let reason = format!("the standard input can be read once: - stands for {}", piped.join(" and "));
    Err(Error::usage(reason))
}

/// What is asked for must go to some file.
fn check_use(args: &PorosityArgs) -> Result<()> {
    let fields = args.npy.is_some() || args.output.is_some();
    if args.bounds_fields && !fields {
        return Err(Error::usage("--bounds-fields makes fields: give --npy DIR or -o FILE.vtr"));
    }
    if args.compress && args.output.is_none() {
        return Err(Error::usage("--compress packs the fields for ParaView: give -o FILE.vtr"));
    }
    if args.zones.is_some() && args.report.is_none() {
        return Err(Error::usage("--zones makes a table of the report: give --report FILE.json"));
    }
    Ok(())
}

/// `--show` names a field that will be there, and a picture to show it in.
fn check_show(args: &PorosityArgs) -> Result<()> {
    let (show, wants) = (&args.show[..], args.resistance || args.drag.is_some());
    let of_drag = DRAG.contains(&show);
    let wrong = |reason: String| Err(Error::usage(format!("--show {show}: {reason}")));
    match show {
        BETA => Ok(()),
        _ if !of_drag && !OBSTACLES.contains(&show) => {
            let known: Vec<&str> = [BETA].into_iter().chain(OBSTACLES).chain(DRAG).collect();
            wrong(not_known(show, &known))
        }
        _ if args.png.is_none() => wrong("give --png FILE.png".into()),
        _ if of_drag && args.drag.is_none() => wrong("give --drag LAW, which finds it".into()),
        _ if !wants => wrong("give --resistance, which finds it".into()),
        _ => Ok(()),
    }
}

/// What a picture shows unless told otherwise.
const BETA: &str = "beta_v";

/// Unit of a field of `--resistance` or `--drag`.
fn unit_of(field: &str) -> &'static str {
    match field {
        "d_h" | "l_obs" => "m",
        _ if field.starts_with("tau") => "–",
        _ => "1/m",
    }
}

/// Names of the arrays of open fractions, by fields and ends of their names.
fn fractions<'a>(fields: &'a [&str], suffixes: &'a [&str]) -> impl Iterator<Item = String> + 'a {
    suffixes.iter().flat_map(move |suffix| fields.iter().map(move |field| format!("beta_{field}{suffix}")))
}

/// Ends of names: of a value, and of its bounds.
const SUFFIXES: [&str; 3] = ["", "_lower", "_upper"];

/// Cells, and faces across each axis.
const FRACTIONS: [&str; 4] = ["v", "x", "y", "z"];

/// The arrays that `--npy` writes.
fn arrays(args: &PorosityArgs) -> Vec<PathBuf> {
    let suffixes = if args.bounds_fields { &SUFFIXES[..] } else { &SUFFIXES[..1] };
    let fields = if args.no_areas { &FRACTIONS[..1] } else { &FRACTIONS[..] };
    let wants = args.resistance || args.drag.is_some();
    let obstacles = OBSTACLES.iter().filter(|_| wants).chain(DRAG.iter().filter(|_| args.drag.is_some()));
    let names: Vec<String> = fractions(fields, suffixes).chain(obstacles.map(|name| (*name).to_owned())).collect();
    let files = names.iter().map(|name| format!("{name}.npy")).chain([npy::EDGES.to_owned()]);
    args.npy.iter().flat_map(|dir| files.clone().map(move |file| dir.join(file))).collect()
}

/// Write all that was asked for.
///
/// # Errors
/// The first file that cannot be written.
pub(super) fn write(
    args: &PorosityArgs,
    (edges, through): (&Edges, [Option<f64>; 3]),
    (result, obstacles): (&Porosity, &Obstacles),
    about: &Report,
    progress: &mut Progress,
) -> Result<()> {
    if let Some(dir) = &args.npy {
        let all = [fields(edges, result), obstacle_fields(edges, obstacles)].concat();
        progress.stage("npy", |_| npy::write_fields(dir, edges, &all))?;
        warn_of_older(dir, &all, progress);
    }
    if let Some(path) = &args.output {
        progress.stage("vtr", |_| write_vtr(path, args.compress, edges, (result, obstacles), about))?;
    }
    if let Some(path) = &args.png {
        let name = |p: &PathBuf| p.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
        let title = args.scene.scene.iter().map(name).collect::<Vec<_>>().join(" + ");
        progress.warn_of_title(&title);
        let (grid, edges) = (edges, edges.0.each_ref().map(|e| &e[..]));
        progress.stage("png", |_| {
            let shown = obstacle_fields(grid, obstacles).into_iter().find(|(name, ..)| *name == args.show);
            let canvas = match shown {
                Some((name, _, values)) => {
                    let name = format!("{name}, {}", unit_of(&name));
                    png::picture_of((&name, values), &title, edges, "m", through)
                }
                None => png::picture(&title, edges, "m", &result.beta.v, through),
            };
            let canvas = canvas.map_err(|reason| Error::file(path, reason))?;
            if !is_stream(path) {
                return make_place(path).and_then(|()| canvas.write(path));
            }
            let mut bytes = Vec::new();
            canvas.encode(&mut bytes).map_err(|e| Error::new(format!("cannot draw the picture: {e}")))?;
            print(&bytes)
        })?;
    }
    Ok(())
}

/// Fields that an earlier run has left beside those of this one may be of another grid.
fn warn_of_older(dir: &Path, written: &[(String, [usize; 3], &[f64])], progress: &mut Progress) {
    let obstacles = OBSTACLES.iter().chain(&DRAG).map(|name| (*name).to_owned());
    let all = FRACTIONS.iter().flat_map(|field| fractions(std::slice::from_ref(field), &SUFFIXES)).chain(obstacles);
    let older: Vec<String> = all
        .filter(|name| !written.iter().any(|(other, ..)| other == name))
        .map(|name| format!("{name}.npy"))
        .filter(|name| dir.join(name).exists())
        .collect();
    if !older.is_empty() {
        progress.warn(format!("{}: {} of an earlier run are still there", dir.display(), older.join(", ")));
    }
}

/// The fields of a result with names: base name, shape, values.
fn fields<'a>(edges: &Edges, result: &'a Porosity) -> Vec<(String, [usize; 3], &'a [f64])> {
    let [nx, ny, nz] = edges.cells();
    let [lower, upper] = [0, 1].map(|n| result.bounds.as_ref().map(|b| &b[n]));
    let sets = [("", Some(&result.beta)), ("_lower", lower), ("_upper", upper)];
    let mut all: Vec<(String, [usize; 3], &[f64])> = Vec::new();
    for (suffix, set) in sets.into_iter().filter_map(|(suffix, set)| Some((suffix, set?))) {
        all.push((format!("beta_v{suffix}"), [nx, ny, nz], &set.v));
        all.push((format!("beta_x{suffix}"), [nx + 1, ny, nz], &set.x));
        all.push((format!("beta_y{suffix}"), [nx, ny + 1, nz], &set.y));
        all.push((format!("beta_z{suffix}"), [nx, ny, nz + 1], &set.z));
    }
    all.retain(|(_, _, values)| !values.is_empty());
    all
}

/// Names of the arrays of `--resistance`.
const OBSTACLES: [&str; 9] = ["a_x", "a_y", "a_z", "s", "d_h", "l_obs", "tau_x", "tau_y", "tau_z"];

/// Names of the arrays of `--drag`.
const DRAG: [&str; 6] = ["cr_x", "cr_y", "cr_z", "ct_x", "ct_y", "ct_z"];

/// The obstacles and their drag with names, as [`fields`].
fn obstacle_fields<'a>(edges: &Edges, obstacles: &'a Obstacles) -> Vec<(String, [usize; 3], &'a [f64])> {
    let mut all: Vec<(&str, &[f64])> = Vec::new();
    if let Some(Resistance { a: [x, y, z], s, d_h, l_obs, shadows, .. }) = &obstacles.resistance {
        let [tau_x, tau_y, tau_z] = &shadows.tau;
        let values: [&[f64]; 9] = [x, y, z, s, d_h, l_obs, tau_x, tau_y, tau_z];
        all.extend(OBSTACLES.into_iter().zip(values));
    }
    if let Some(ObstacleDrag { cr, ct, .. }) = &obstacles.drag {
        all.extend(DRAG.into_iter().zip(cr.iter().chain(ct).map(|values| &values[..])));
    }
    all.into_iter().map(|(name, values)| (name.to_owned(), edges.cells(), values)).collect()
}

fn write_vtr(
    path: &Path,
    compress: bool,
    edges: &Edges,
    (result, obstacles): (&Porosity, &Obstacles),
    about: &Report,
) -> Result<()> {
    let [x, y, z] = &edges.0;
    let all = fields(edges, result);
    let beta = &result.beta;
    let mut cell = Vec::new();
    for (name, _, data) in all.iter().filter(|(name, ..)| name.starts_with("beta_v")) {
        cell.push(CellField::Values(NamedField { name, components: 1, data }));
    }
    if !beta.x.is_empty() {
        cell.push(CellField::LowFaces { name: "beta_f", faces: [&beta.x, &beta.y, &beta.z] });
    }
    let obstacles = obstacle_fields(edges, obstacles);
    for (name, _, data) in &obstacles {
        cell.push(CellField::Values(NamedField { name, components: 1, data }));
    }
    let staggered = all.iter().filter(|(name, ..)| !name.starts_with("beta_v"));
    let field_data = staggered.map(|(name, _, data)| NamedField { name, components: 1, data }).collect();
    let version = format!("voidage {}", about.version);
    let vtr =
        Vtr { x, y, z, cell, field_data, text: vec![("program", &version), ("command", &about.command)], compress };
    if !is_stream(path) {
        return make_place(path).and_then(|()| vtr.write(path));
    }
    let mut bytes = std::io::Cursor::new(Vec::new());
    vtr.write_to(&mut bytes).map_err(|e| Error::new(format!("cannot make the fields for ParaView: {e}")))?;
    print(&bytes.into_inner())
}

/// Where the picture is cut, by axis, if `--slice` says so.
///
/// # Errors
/// Outside the grid.
pub(super) fn slices(args: &PorosityArgs, edges: &Edges) -> Result<[Option<f64>; 3]> {
    let mut through = [None; 3];
    for &(axis, at) in &args.slice {
        if let Some(why) = edges.misses(axis, at) {
            return Err(Error::usage(format!("--slice {}={}: {why}", AXES[axis], written(at))));
        }
        if let Some(other) = through[axis].replace(at) {
            let (axis, other, at) = (AXES[axis], written(other), written(at));
            return Err(Error::usage(format!("--slice {axis}={other} and {axis}={at}: one plane across each axis")));
        }
    }
    Ok(through)
}
