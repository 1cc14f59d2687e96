//! The stages that the commands share: scene → bodies, bodies and grid → porosity, each with its warnings.

use crate::command::cli::{DEEPEST, SceneArgs};
use crate::command::progress::Progress;
use crate::command::streams::{INPUT, is_stream, read_input};
use crate::error::{Error, Result};
use crate::geometry::bodies::{Bodies, Body, Diagnosis, SolidSummary};
use crate::geometry::form::Form;
use crate::geometry::read;
use crate::geometry::scene;
use crate::geometry::unit::Unit;
use crate::grid::{self, AXES, Edges};
use crate::picture::ticks::{measure as number, number as short, number_to};
use crate::porosity::snap::{self, OffPlanes};
use crate::porosity::{self, Leaf, Method, Options, Porosity};
use crate::text;
use crate::words::{counted, either};
use glam::DVec3;
use std::path::Path;
use voidage_core::grid::{Grid, Located};

/// Read all files of a scene into bodies, in metres; and the grid that a scene file carries, if one does, or that there are two.
///
/// # Errors
/// The first file that cannot be read or holds nothing solid.
pub fn load(args: &SceneArgs, progress: &mut Progress) -> Result<(Bodies, Result<Option<Edges>>)> {
    let scale = args.unit.unwrap_or(Unit::M).metres();
    let (mut bodies, mut grid, mut in_metres) = (Bodies::default(), Ok(None), Vec::new());
    if args.scene.iter().filter(|path| is_stream(path)).count() > 1 {
        return Err(Error::usage("the standard input can be read once: - stands for one file of a scene"));
    }
    for (n, path) in args.scene.iter().enumerate() {
        if args.scene[..n].contains(path) {
            progress.warn(format!("{}: is given twice: once would do", path.display()));
        }
        let (path, piped) = match is_stream(path) {
            true => (Path::new(INPUT), Some(read_input()?)),
            false => (path.as_path(), None),
        };
        let is_piped_scene = piped.as_deref().is_some_and(read::is_scene);
        if scene::is_scene(path) || is_piped_scene {
            let found = progress.stage("read", |_| match piped {
                Some(bytes) => text::of_bytes(path, bytes).and_then(|text| scene::parse(path, &text)),
                None => scene::read(path),
            })?;
            progress.stage("bodies", |_| scene::load::add(&found, &mut bodies))?;
            grid = match (grid, found.grid) {
                (Ok(Some(_)), Some(_)) => Err(Error::file(path, "a second scene with a [grid]: leave one of them out")),
                (before, own) => before.map(|grid| grid.or(own)),
            };
            in_metres.push(path);
            continue;
        }
        let mesh = progress.stage("read", |_| match piped {
            Some(bytes) => read::from_bytes(path, bytes),
            None => read::read(path).map_err(|error| grid_in_place_of(path).unwrap_or(error)),
        })?;
        mesh.warnings.iter().for_each(|w| progress.warn(w.as_str()));
        progress.stage("bodies", |_| bodies.add(&mesh, scale))?;
        let size = bodies.diagnoses.last().filter(|_| args.unit.is_none()).and_then(Diagnosis::too_large_for_metres);
        if let Some(size) = size {
            let path = path.display();
            progress.warn(format!(
                "{path}: {size}, give --unit mm, in a case porosity.unit = \"mm\", in a scene of a study unit = \"mm\""
            ));
        }
    }
    // Beside files that have none of their own the unit is for these.
    for path in in_metres.iter().filter(|_| args.unit.is_some() && in_metres.len() == args.scene.len()) {
        progress.warn(format!(
            "{}: a scene is in metres, and its solids of files have a unit each: the unit of STL and OBJ files does not change them",
            path.display()
        ));
    }
    warn_of_unit(args, &bodies, progress);
    bodies.warnings.iter().for_each(|w| progress.warn(w.as_str()));
    Ok((bodies, grid))
}

/// What is wrong with a file that is no geometry but a grid in JSON.
fn grid_in_place_of(path: &Path) -> Option<Error> {
    let is_json = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("json"));
    grid::file::read(path, &mut Vec::new()).ok().filter(|_| is_json)?;
    Some(Error::file(path, "this is a grid, not a geometry: voidage porosity takes it by --grid"))
}

/// Sizes in m of all that is read in a unit of its own: less is likely a file in metres, more is no plant.
const LIKELY: [f64; 2] = [0.05, 2e4];

/// A unit that was asked for makes the whole of the STL and OBJ files smaller than any plant, or larger.
fn warn_of_unit(args: &SceneArgs, bodies: &Bodies, progress: &mut Progress) {
    let (Some(unit), files) = (args.unit, &bodies.diagnoses) else { return };
    let Some([lo, hi]) = files.iter().map(|d| d.bounds).reduce(|[a, b], [c, d]| [a.min(c), b.max(d)]) else { return };
    let (size, [least, most]) = (hi - lo, LIKELY);
    let word = match size.max_element() {
        largest if largest < least => "small",
        largest if largest > most => "large",
        _ => return,
    };
    let by = size.to_array().map(short).join(" × ");
    progress.warn(format!(
        "{}: its size is {by} m with the unit \"{}\", {word} for a plant: check that, --unit here, porosity.unit in a case",
        bodies.files(),
        unit.name()
    ));
}

/// The command as typed.
#[must_use]
pub fn command_line() -> String {
    let arguments = std::env::args_os().skip(1).map(|a| a.to_string_lossy().into_owned());
    std::iter::once("voidage".to_owned()).chain(arguments).collect::<Vec<_>>().join(" ")
}

/// As many threads as asked for, or as there are cores.
///
/// # Errors
/// The system refuses them.
pub fn threads(count: Option<u16>) -> Result<rayon::ThreadPool> {
    let count = count.map_or(0, usize::from);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build();
    pool.map_err(|e| Error::new(format!("cannot start {}: {e}", counted(count, "thread", "threads"))))
}

/// Porosity of bodies on a grid, with a warning for whatever makes it less certain. `left_out` are the axes that a case leaves out.
///
/// # Errors
/// The edges are no grid, or one beyond memory.
pub fn measure(
    bodies: &Bodies,
    edges: &Edges,
    left_out: [bool; 3],
    options: Options,
    progress: &mut Progress,
) -> Result<Porosity> {
    let grid = edges.grid(None)?;
    warn_if_outside(bodies, edges, left_out, &grid, progress);
    warn_if_coarse(bodies, edges, progress);
    warn_if_in_one_cell(bodies, &grid, progress);
    room_for(porosity::memory(&grid, bodies, options))?;
    let layers = edges.cells()[2] * porosity::levels(bodies).len();
    let result = progress.stage("porosity", |p| {
        let bar = p.bar("porosity", layers);
        porosity::porosity_watched(&grid, bodies, options, &|| bar.step())
    });
    if result.cells.open == 0 && result.cells.cut == 0 {
        progress.warn(format!("{}: every cell is closed: nothing is open in the whole grid", bodies.files()));
    }
    report_leaks(bodies, &result, progress);
    report_sheets(bodies, result.sheets_off_planes, progress);
    if options.leaf != Leaf::Plane && result.subdivided == 0 {
        progress.warn("--leaf has no effect: no body can be subdivided");
    }
    if options.method == Method::Gjk && result.subdivided < bodies.bodies.len() {
        let why = match options.leaf {
            Leaf::Plane => ["is not convex, or not surely so", "are not convex, or not surely so"],
            _ => ["does not close edge by edge, or is a sheet", "do not close edge by edge, or are sheets"],
        };
        let (count, all) = (bodies.bodies.len() - result.subdivided, bodies.bodies.len());
        let (all, why) = (counted(all, "body", "bodies"), either(count, why[0], why[1]));
        let exactly = if options.leaf == Leaf::Plane { ", exactly" } else { "" };
        progress
            .warn(format!("{count} of {all} {why}: measured by {} surface{exactly}", either(count, "its", "their")));
    }
    if options.leaf == Leaf::Plane && result.max_gap > options.tol.max(ROUNDING) {
        let deeper = result.subdivided + result.divided > 0 && options.depth < DEEPEST;
        progress.warn(format!(
            "the bounds of some values remain {:.1e} apart, more than tol, {:.1e}{}",
            result.max_gap,
            options.tol,
            if deeper { "; a larger depth may narrow them" } else { "" }
        ));
    }
    Ok(result)
}

/// Subdivision by GJK takes convex solids; a torus is none.
///
/// # Errors
/// The first solid that is none, by its name.
pub fn need_convex(bodies: &Bodies) -> Result<()> {
    let bent =
        |s: &SolidSummary| bodies.bodies[s.bodies.clone()].iter().any(|b| matches!(b.form, Some(Form::Torus(_))));
    match bodies.solids.iter().find(|s| bent(s)) {
        None => Ok(()),
        Some(solid) => Err(Error::new(format!(
            "{}: solid \"{}\": a {} is not convex, as --method gjk needs solids to be: use --method auto",
            solid.scene, solid.name, solid.shape
        ))),
    }
}

/// Ask for the memory of the fields before work begins: a failure half way could not be reported.
///
/// # Errors
/// There is none.
pub fn room_for(bytes: usize) -> Result<()> {
    Vec::<u8>::new().try_reserve_exact(bytes).map_err(|_| {
        Error::new(format!("the fields of this grid need {:.1} GB of memory: take fewer cells", bytes as f64 * 1e-9))
    })
}

/// The sums over surfaces measure only what has one.
///
/// # Errors
/// The first solid that has none.
pub fn need_surfaces(bodies: &Bodies) -> Result<()> {
    match bodies.solids.iter().find(|s| bodies.bodies[s.bodies.clone()].iter().any(|b| b.triangles.is_empty())) {
        None => Ok(()),
        Some(solid) => Err(Error::new(format!(
            "{}: solid \"{}\": a {} has no triangles to be measured by its surface; --method auto takes its formula",
            solid.scene, solid.name, solid.shape
        ))),
    }
}

/// Geometry outside the grid does not count; say so.
pub fn warn_if_outside(bodies: &Bodies, edges: &Edges, left_out: [bool; 3], grid: &Grid<f64>, progress: &mut Progress) {
    let ([lo, hi], Some([min, max])) = (edges.bounds(), bodies.bounds()) else { return };
    // Digits by the size of each: a stray corner far away must not leave none of the grid.
    let extent = |p: DVec3, q: DVec3| {
        let fine = 1e-6 * (q - p);
        let digits = |v: f64, fine: f64| number_to(if v.abs() < fine { 0.0 } else { v }, fine);
        let point = |p: DVec3| format!("({})", [0, 1, 2].map(|n| digits(p[n], fine[n])).join(", "));
        format!("{} to {}", point(p), point(q))
    };
    let unit_cells: Vec<&str> = (0..3).filter(|&a| left_out[a]).map(|a| AXES[a]).collect();
    let within = match unit_cells.is_empty() {
        true => extent(lo, hi),
        false => {
            format!("{} (one cell along {}, which the case leaves out)", extent(lo, hi), unit_cells.join(", "))
        }
    };
    // What is flush with the grid but for rounding is within.
    let near = snap::near(grid);
    // The ends of a curved solid are rounded away from it, those of a torus by most.
    let rounded = |b: &Body| if b.form.is_some() { (b.bounds[1] - b.bounds[0]) * 1e-11 } else { DVec3::ZERO };
    let room = |b: &Body| near + b.single_error() + rounded(b);
    let beyond = |b: &Body| {
        let room = room(b);
        (b.bounds[0] + room).cmplt(lo).any() || (b.bounds[1] - room).cmpgt(hi).any()
    };
    let outside = |[min, max]: [DVec3; 2]| (min - near).cmpgt(hi).any() || (max + near).cmplt(lo).any();
    if !((min + near).cmplt(hi).all() && (max - near).cmpgt(lo).all()) {
        let (place, faces) = match outside([min, max]) {
            true => ("lies outside", ""),
            false => ("touches from outside", ", but faces in that side may be closed"),
        };
        let (files, geometry) = (bodies.files(), extent(min, max));
        progress
            .warn(format!("{files}: the geometry, {geometry}, {place} the grid, {within}: every cell is open{faces}"));
        return;
    }
    if bodies.bodies.iter().any(beyond) {
        progress.warn(format!(
            "{}: the geometry, {}, extends beyond the grid, {}; only what is inside counts",
            bodies.files(),
            extent(min, max),
            within
        ));
    }
    let solid = |s: &SolidSummary| {
        let own = &bodies.bodies[s.bodies.clone()];
        let copies = own.chunks((own.len() / s.copies.max(1)).max(1));
        match copies.filter(|copy| copy.iter().all(|body| outside(body.bounds))).count() {
            _ if outside(s.bounds) => Some(format!("solid \"{}\"", s.name)),
            0 => None,
            count => Some(format!("{count} of the {} copies of solid \"{}\"", s.copies, s.name)),
        }
    };
    let solids = bodies.solids.iter().filter_map(solid);
    // A file of a scene is told by its solid, which may have moved it.
    let of_solid = |d: &Diagnosis| {
        let next = bodies.solids.partition_point(|solid| solid.bodies.start <= d.body_range.start);
        next > 0 && !d.body_range.is_empty() && bodies.solids[next - 1].bodies.end >= d.body_range.end
    };
    let files = bodies.diagnoses.iter().filter(|d| outside(d.bounds) && !of_solid(d)).map(|d| d.file.clone());
    let names: Vec<String> = solids.chain(files).collect();
    if let Some(names) = listed(&names) {
        progress.warn(format!("{names}: outside the grid, {within}, and without effect"));
    }
}

/// Several bodies within a single cell of many: one of the two is likely in another unit; say so.
fn warn_if_in_one_cell(bodies: &Bodies, grid: &Grid<f64>, progress: &mut Progress) {
    let Some([lo, hi]) = bodies.bounds().filter(|_| bodies.bodies.len() > 1 && grid.cell_count() > 1) else { return };
    let along = |axis: usize| match (grid.locate(axis, lo[axis]), grid.locate(axis, hi[axis])) {
        (Located::Cell(a), Located::Cell(b)) if a == b => Some(grid.edges(axis)[a + 1] - grid.edges(axis)[a]),
        _ => None,
    };
    if let (Some(x), Some(y), Some(z)) = (along(0), along(1), along(2)) {
        let [size, cell] = [(hi - lo).to_array(), [x, y, z]].map(|all| all.map(short).join(" × "));
        progress.warn(format!(
            "{}: all of the geometry, {size} m, lies within one cell of {cell} m: are both in metres?",
            bodies.files()
        ));
    }
}

/// A step of single-precision coordinates wider than this share of a cell is told.
const COARSE: f64 = 0.05;

/// Coordinates that a file holds in steps not far below the size of a cell, or above it; say so.
fn warn_if_coarse(bodies: &Bodies, edges: &Edges, progress: &mut Progress) {
    let widths = [0, 1, 2].map(|axis| edges.widths(axis).into_iter().fold(f64::INFINITY, f64::min));
    let (mut worst, widths) = (0.0_f64, DVec3::from_array(widths));
    for body in &bodies.bodies {
        worst = worst.max((2.0 * body.single_error() / widths).max_element());
    }
    if worst > COARSE {
        progress.warn(format!(
            "{}: coordinates in single precision so far from the origin have steps of {} of a cell: what is smaller is lost, and corners within half a step of a \
             plane of the grid are put into it; write the geometry nearer to the origin, or in double precision (OBJ, ASCII STL)",
            bodies.files(),
            number_to(worst, 0.01)
        ));
    }
}

/// Names that a sentence holds at most.
const MOST_NAMES: usize = 5;

/// Names in a sentence, the first few of many; none if there are none.
fn listed(names: &[String]) -> Option<String> {
    let shown = names[..names.len().min(MOST_NAMES)].join(", ");
    match names.len() {
        0 => None,
        n if n > MOST_NAMES => Some(format!("{shown} and {} more", n - MOST_NAMES)),
        _ => Some(shown),
    }
}

/// Bounds this close are one value.
const ROUNDING: f64 = 1e-9;

/// A row that misses zero by more than this fraction of a face deserves a warning; less is cracks of `f32` corners.
const LEAK_TO_WARN: f64 = 1e-6;

fn report_leaks(bodies: &Bodies, result: &Porosity, progress: &mut Progress) {
    let leaks: Vec<_> = result.leaks.iter().filter(|l| l.fraction > LEAK_TO_WARN).collect();
    if let Some(worst) = leaks.first() {
        let body = &bodies.bodies[worst.body];
        let files = bodies.files();
        progress.warn(format!(
            "{files}: the surface of {} leaks: in layer {} of body {} \"{}\" (both counted from 0) a row ends {:.3e} of a face away from zero",
            counted(leaks.len(), "body", "bodies"),
            worst.layer,
            worst.body,
            body.name,
            worst.fraction
        ));
    }
    if result.winding > WINDING_TO_WARN {
        let files = bodies.files();
        progress.warn(format!(
            "{files}: a surface crosses itself (self-intersection): it encloses a cell {:.3} times too often or too seldom; such values were limited to 0..1",
            result.winding
        ));
    }
}

fn report_sheets(bodies: &Bodies, off: OffPlanes, progress: &mut Progress) {
    if off.sheets > 0 {
        progress.warn(format!(
            "{}: of {} without thickness, {} nothing with {} m² in all, which lie in no plane of the grid",
            bodies.files(),
            counted(bodies.bodies.iter().filter(|b| b.sheet).count(), "sheet", "sheets"),
            counted(off.sheets, "blocks", "block"),
            number(off.area)
        ));
    }
}

/// A body whose own share leaves 0..1 by more than this crosses itself.
const WINDING_TO_WARN: f64 = 1e-6;
