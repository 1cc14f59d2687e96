//! What the user typed.

use crate::command::solve::ranges::{DRAG_COEFFICIENT, QUANTITY, SIGNED};
use crate::command::version::VERSION;
use crate::geometry::unit::Unit;
use crate::grid::AXES;
use crate::porosity::drag::{DragCoefficients, DragLaw};
use crate::porosity::throat::Faces;
use crate::porosity::{Leaf, Method};
use clap::builder::PossibleValue;
use clap::{Args, Parser, Subcommand, ValueEnum};
use glam::DVec3;
use std::path::PathBuf;

/// Volume and area porosity of real geometry on structured grids.
#[derive(Debug, Parser)]
#[command(name = "voidage", version = VERSION, about, max_term_width = 100, after_help = FIRST_STEPS)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// Below the list of commands.
const FIRST_STEPS: &str = "First steps: voidage porosity FILE.stl --png FILE.png
             voidage porosity --template-scene > scene.toml
             voidage solve --template > case.toml
Every key of these files: voidage docs scene, voidage docs case";

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Compute the porosity of a scene on a grid
    Porosity(Box<PorosityArgs>),
    /// Say what is in a file: bodies, closure, orientation, overlaps, units, thin parts
    Inspect(InspectArgs),
    /// Error against run time, for scenes, grids and methods of a case file
    Study(StudyArgs),
    /// Run the program against hard cases whose truth is known: a line a case, exit code 1 if one fails
    Stress(StressArgs),
    /// Flow a gas through a porous space, as a case file says
    Solve(SolveArgs),
    /// Print a page of the manual: every key of every file, every field of every output; without a name, the list of pages
    Docs {
        /// The page, such as case or scene
        page: Option<String>,
    },
    /// Print a completion script for a shell
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
    /// Print the manual page (roff): `voidage man | man -l -`
    Man,
}

impl ValueEnum for Unit {
    fn value_variants<'a>() -> &'a [Self] {
        &Unit::ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.name()).help(match self {
            Unit::M => "Metres",
            Unit::Mm => "Millimetres",
            Unit::Cm => "Centimetres",
            Unit::In => "Inches",
            Unit::Ft => "Feet",
        }))
    }
}

impl ValueEnum for Method {
    fn value_variants<'a>() -> &'a [Self] {
        &[Method::Auto, Method::Surface, Method::Gjk]
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let (name, help) = match self {
            Method::Auto => (
                "auto",
                "The cheapest for every body: sums over its surface, if it has triangles, else closed forms: exact",
            ),
            Method::Surface => ("surface", "Sums over the surface: exact for any closed surface of triangles"),
            Method::Gjk => (
                "gjk",
                "Subdivision by GJK, as in the paper: bounds; by leaf plane for convex bodies, by the others for any that close",
            ),
        };
        Some(PossibleValue::new(name).help(help))
    }
}

impl ValueEnum for Faces {
    fn value_variants<'a>() -> &'a [Self] {
        &[Faces::Plane, Faces::Throat]
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let (name, help) = match self {
            Faces::Plane => ("plane", "What is open in its plane: exact, but a wall between two planes is not seen"),
            Faces::Throat => ("throat", "What can pass: a wall is tight wherever it lies"),
        };
        Some(PossibleValue::new(name).help(help))
    }
}

impl ValueEnum for DragLaw {
    fn value_variants<'a>() -> &'a [Self] {
        &[DragLaw::Bluff, DragLaw::Pdr]
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let (name, help) = match self {
            DragLaw::Bluff => ("bluff", "C_D times the frontal area density: sparse obstacles"),
            DragLaw::Pdr => ("pdr", "With the speed-up between rows of obstacles, as PDRsetFields of OpenFOAM v1912"),
        };
        Some(PossibleValue::new(name).help(help))
    }
}

impl ValueEnum for Leaf {
    fn value_variants<'a>() -> &'a [Self] {
        &[Leaf::Solid, Leaf::Half, Leaf::Plane]
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let (name, help) = match self {
            Leaf::Solid => ("solid", "Touched counts as solid: the paper's rule, which finds too much"),
            Leaf::Half => ("half", "Touched counts half"),
            Leaf::Plane => ("plane", "Bounded by planes and points: certified, of second order"),
        };
        Some(PossibleValue::new(name).help(help))
    }
}

/// The scene, of `porosity` and `inspect`.
#[derive(Debug, Clone, Args)]
pub struct SceneArgs {
    /// STL, OBJ or scene (TOML) files; their bodies form one scene; - is the standard input
    #[arg(required = true, value_name = "SCENE")]
    pub scene: Vec<PathBuf>,
    /// Unit of the coordinates of STL and OBJ files (default: m)
    #[arg(long)]
    pub unit: Option<Unit>,
}

/// What goes to the terminal.
#[derive(Debug, Clone, Args)]
pub struct TalkArgs {
    /// Only errors
    #[arg(short, long, conflicts_with = "verbose")]
    pub quiet: bool,
    /// Also the time of every stage
    #[arg(short, long)]
    pub verbose: bool,
}

/// Arguments of `voidage porosity`.
#[derive(Debug, Clone, Args)]
pub struct PorosityArgs {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Print a commented scene that runs, and do nothing else
    #[arg(long, exclusive = true)]
    pub template_scene: bool,
    /// Grid file (TOML or JSON): edges x, y, z; or origin, spacing, cells; - is the standard input
    #[arg(long, value_name = "FILE", conflicts_with_all = ["cells", "spacing", "bounds"])]
    pub grid: Option<PathBuf>,
    /// Number of cells, such as 99x99x63
    #[arg(long, value_name = "NXxNYxNZ", value_parser = parse_cells, conflicts_with = "spacing", allow_hyphen_values = true)]
    pub cells: Option<[usize; 3]>,
    /// Edge length of cubic cells in metres (default: 1/64 of the longest side of the scene, or of --bounds)
    #[arg(long, value_name = "D", value_parser = parse_spacing, allow_negative_numbers = true)]
    pub spacing: Option<f64>,
    /// The grid's box in metres (default: the scene's box and a margin of one cell)
    #[arg(long, value_name = "X0,Y0,Z0,X1,Y1,Z1", value_parser = parse_bounds, allow_hyphen_values = true)]
    pub bounds: Option<[DVec3; 2]>,
    /// How volumes are found
    #[arg(long, value_enum, default_value_t = Method::Auto)]
    pub method: Method,
    /// Where bodies overlap and their union has no proof, divide cells until the bounds are this close; 0 asks for the last digit and may take hours
    #[arg(long, value_name = "T", default_value_t = 1e-4, value_parser = parse_tol, allow_negative_numbers = true)]
    pub tol: f64,
    /// How often a cell without a proof may be divided by two (default: 6; 3 with --leaf solid or half)
    #[arg(long, value_name = "N", value_parser = parse_depth, allow_negative_numbers = true)]
    pub depth: Option<u32>,
    /// What becomes of parts still cut when a subdivision by GJK ends
    #[arg(long, value_enum, default_value_t = Leaf::Plane)]
    pub leaf: Leaf,
    /// Also certified lower and upper bounds of all fields; with --npy or -o FILE.vtr
    #[arg(long)]
    pub bounds_fields: bool,
    /// Only the volume porosity
    #[arg(long)]
    pub no_areas: bool,
    /// What the open fraction of a face means
    #[arg(long, value_enum, default_value_t = Faces::Plane, conflicts_with = "no_areas")]
    pub faces: Faces,
    /// Also the obstacles in every cell: frontal area density a_x, a_y, a_z and wetted area density s in 1/m, hydraulic diameter d_h and mean obstacle size l_obs in m, shadows tau_x, tau_y, tau_z
    #[arg(long, conflicts_with = "no_areas")]
    pub resistance: bool,
    /// Also their resistance cr_x, cr_y, cr_z in 1/m, as solve takes it, and ct_x, ct_y, ct_z; goes with all of --resistance
    #[arg(long, value_name = "LAW", value_enum, conflicts_with = "no_areas")]
    pub drag: Option<DragLaw>,
    /// Drag coefficient: a number, or round=NUMBER,sharp=NUMBER (default: round=1.2,sharp=2)
    #[arg(long, value_name = "CD", requires = "drag", value_parser = parse_cd, allow_hyphen_values = true)]
    pub cd: Option<DragCoefficients>,
    /// Zones of the report's table of congestion (TOML tables "zone" with min, max in metres and, if you like, name; default: the whole grid); with --report; - is the standard input
    #[arg(long, value_name = "FILE", conflicts_with = "no_areas")]
    pub zones: Option<PathBuf>,
    /// Number of threads (default: all cores)
    #[arg(long, value_name = "N", value_parser = parse_threads, allow_negative_numbers = true)]
    pub threads: Option<u16>,
    /// Write fields for ParaView (.vtr), a picture (.png) or a report (.json), by the suffix; - is the standard output, as it is for all files
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Compress the .vtr file (zlib)
    #[arg(long)]
    pub compress: bool,
    /// Write beta_v.npy, beta_x.npy, beta_y.npy, beta_z.npy into this directory
    #[arg(long, value_name = "DIR")]
    pub npy: Option<PathBuf>,
    /// Where the picture is cut, such as x=1.5 or x=1.5,z=0 (default: where the porosity shows most)
    #[arg(long, value_name = "AXIS=M", value_parser = parse_slice, value_delimiter = ',', allow_hyphen_values = true)]
    pub slice: Vec<(usize, f64)>,
    /// Draw slices of the volume porosity, or of what --show names
    #[arg(long, value_name = "FILE.png")]
    pub png: Option<PathBuf>,
    /// What the picture shows: beta_v, or a field of --resistance or --drag such as a_x, s, tau_z, cr_x
    #[arg(long, value_name = "FIELD", default_value = "beta_v")]
    pub show: String,
    /// Write a report
    #[arg(long, value_name = "FILE.json")]
    pub report: Option<PathBuf>,
    /// What goes to the terminal.
    #[command(flatten)]
    pub talk: TalkArgs,
}

/// Arguments of `voidage solve`.
#[derive(Debug, Args)]
pub struct SolveArgs {
    /// Case file (TOML): grid, porosity, gas, initial, boundary, drag, gravity, scheme, time, output
    #[arg(value_name = "CASE.toml", required = true)]
    pub case: Option<PathBuf>,
    /// Print a commented case that runs, and do nothing else
    #[arg(long, exclusive = true)]
    pub template: bool,
    /// Directory for results and checkpoints (default: the case's name without .toml, here)
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Replace the results of a finished run in that directory
    #[arg(long, conflicts_with = "resume")]
    pub force: bool,
    /// Run the case on half the cells along each axis as well, and tell the largest values of both side by side
    #[arg(long)]
    pub refine_check: bool,
    /// Number of threads (default: all cores)
    #[arg(long, value_name = "N", value_parser = parse_threads, allow_negative_numbers = true)]
    pub threads: Option<u16>,
    /// Go on from the checkpoint in the output directory
    #[arg(long)]
    pub resume: bool,
    /// What goes to the terminal.
    #[command(flatten)]
    pub talk: TalkArgs,
}

/// Arguments of `voidage inspect`.
#[derive(Debug, Args)]
pub struct InspectArgs {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Print JSON instead of a table
    #[arg(long)]
    pub json: bool,
    /// Write the JSON to a file
    #[arg(long, value_name = "FILE.json")]
    pub report: Option<PathBuf>,
    /// What goes to the terminal.
    #[command(flatten)]
    pub talk: TalkArgs,
}

/// Arguments of `voidage study`.
#[derive(Debug, Args)]
pub struct StudyArgs {
    /// The case file (TOML): scenes, grids, methods, threads
    #[arg(value_name = "CASE.toml", required = true)]
    pub case: Option<PathBuf>,
    /// Print a commented case that runs, and do nothing else
    #[arg(long, exclusive = true)]
    pub template: bool,
    /// Write tables, pictures and a page into this directory (default: print the table); a study that was interrupted goes on there
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// A first look: one run of each (short flows: 0.02 s of runs), one number of threads, the two smallest grids
    #[arg(long)]
    pub quick: bool,
    /// Measure anew what that directory keeps from before, and replace a finished study of another case in it
    #[arg(long, requires = "output")]
    pub force: bool,
    /// What goes to the terminal.
    #[command(flatten)]
    pub talk: TalkArgs,
}

/// Arguments of `voidage stress`.
#[derive(Debug, Args)]
pub struct StressArgs {
    /// Only the cases of this name, or whose name begins so: flow, geometry/needles; may be repeated; one that takes long runs by its whole name
    #[arg(long, value_name = "NAME")]
    pub only: Vec<String>,
    /// Also what takes long: more pairs, steps and bodies, and the cases that need many
    #[arg(long)]
    pub long: bool,
    /// Hand the cases spoiled results: each of them must fail, or it judges nothing
    #[arg(long)]
    pub spoil: bool,
    /// Print the table of cases, and run none
    #[arg(long, conflicts_with_all = ["long", "json", "threads", "spoil"])]
    pub list: bool,
    /// Write the outcomes as JSON; - is the standard output
    #[arg(long, value_name = "FILE.json")]
    pub json: Option<PathBuf>,
    /// Number of cases at a time, each on one thread (default: all cores)
    #[arg(long, value_name = "N", value_parser = parse_threads, allow_negative_numbers = true)]
    pub threads: Option<u16>,
    /// What goes to the terminal.
    #[command(flatten)]
    pub talk: TalkArgs,
}

fn numbers<T: std::str::FromStr, const N: usize>(text: &str, separator: char) -> Result<[T; N], String> {
    let parts: Vec<&str> = text.split(separator).map(str::trim).collect();
    if parts.len() != N {
        return Err(format!("needs {N} numbers separated by '{separator}', not {}", parts.len()));
    }
    let values: Result<Vec<T>, String> =
        parts.iter().map(|p| p.parse().map_err(|_| format!("'{p}' is no number that fits here"))).collect();
    values?.try_into().map_err(|_| "wrong count".to_owned())
}

/// A whole number between two others.
fn whole<T: TryFrom<u32>>(text: &str, [low, high]: [u32; 2]) -> Result<T, String> {
    let number = text.parse().ok().filter(|n| (low..=high).contains(n));
    number.and_then(|n| T::try_from(n).ok()).ok_or_else(|| format!("needs a whole number from {low} to {high}"))
}

/// The largest depth that may be asked for.
pub const DEEPEST: u32 = 10;

fn parse_depth(text: &str) -> Result<u32, String> {
    whole(text, [0, DEEPEST])
}

fn parse_threads(text: &str) -> Result<u16, String> {
    whole(text, [1, 1024])
}

fn parse_cells(text: &str) -> Result<[usize; 3], String> {
    let wrong = |reason| format!("{reason}: whole numbers from 1 such as 99x99x63");
    let cells: [usize; 3] = numbers(&text.to_lowercase().replace('×', "x"), 'x').map_err(wrong)?;
    if cells.contains(&0) { Err("needs at least one cell along each axis".into()) } else { Ok(cells) }
}

/// What to do about a comma in a number.
fn decimal_comma(text: &str) -> &'static str {
    if text.contains(',') { "; decimals have a point, not a comma" } else { "" }
}

fn parse_spacing(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(d) if QUANTITY.holds(d) => Ok(d),
        _ => Err(format!("needs a length {QUANTITY}{}", decimal_comma(text))),
    }
}

fn parse_slice(text: &str) -> Result<(usize, f64), String> {
    let (axis, at) = text.split_once('=').ok_or(
        "needs an axis and a coordinate, such as x=1.5; decimals have a point, and a comma begins another slice",
    )?;
    let axis = AXES.iter().position(|name| *name == axis.trim()).ok_or("the axis is x, y or z")?;
    let at = at.trim().parse::<f64>().ok().filter(|x| SIGNED.holds(*x));
    let at = at.ok_or_else(|| format!("needs a coordinate in metres, {SIGNED}"))?;
    Ok((axis, at))
}

fn parse_tol(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(t) if (0.0..=1.0).contains(&t) => Ok(t),
        _ => Err("needs a fraction from 0 to 1".into()),
    }
}

fn parse_cd(text: &str) -> Result<DragCoefficients, String> {
    let number = |text: &str| match text.trim().parse::<f64>() {
        Ok(cd) if DRAG_COEFFICIENT.holds(cd) => Ok(cd),
        _ => Err(format!("'{text}' is no drag coefficient: needs a number {DRAG_COEFFICIENT}")),
    };
    if !text.contains('=') {
        return number(text).map(|cd| DragCoefficients { round: cd, sharp: cd });
    }
    let (mut round, mut sharp) = (None, None);
    for part in text.split(',') {
        let (key, value) = part.split_once('=').unwrap_or((part, ""));
        let place = match key.trim() {
            "round" => &mut round,
            "sharp" => &mut sharp,
            _ => return Err(format!("'{part}': needs a number, or round=NUMBER,sharp=NUMBER")),
        };
        if place.replace(number(value)?).is_some() {
            return Err(format!("{} is given twice", key.trim()));
        }
    }
    let usual = DragCoefficients::default();
    Ok(DragCoefficients { round: round.unwrap_or(usual.round), sharp: sharp.unwrap_or(usual.sharp) })
}

fn parse_bounds(text: &str) -> Result<[DVec3; 2], String> {
    let b: [f64; 6] = numbers(text, ',')?;
    let (lo, hi) = (DVec3::new(b[0], b[1], b[2]), DVec3::new(b[3], b[4], b[5]));
    if b.iter().all(|&x| SIGNED.holds(x)) && lo.cmplt(hi).all() {
        Ok([lo, hi])
    } else {
        Err(format!("needs coordinates {SIGNED}, and x0,y0,z0 below x1,y1,z1"))
    }
}
