//! What a run of `voidage porosity` tells of itself: the JSON of `--report` and the lines on the terminal.

use super::solids::{SolidReport, solids};
use crate::command::cli::PorosityArgs;
use crate::command::obstacles::{Obstacles, digits_of_areas};
use crate::command::progress::Progress;
use crate::command::stages::command_line;
use crate::command::version::{BUILD, Build};
use crate::geometry::bodies::Bodies;
use crate::grid::Edges;
use crate::picture::ticks::{measure, part, plain_to};
use crate::porosity::congestion::Congestion;
use crate::porosity::divided::DividedCells;
use crate::porosity::drag::{DragCoefficients, DragLaw};
use crate::porosity::resistance::{Resistance, Totals};
use crate::porosity::shadows::{HiddenPassages, Shadows};
use crate::porosity::{self, Leaf, Porosity};
use crate::words::counted;
use glam::DVec3;
use serde::Serialize;
use std::collections::BTreeMap;
use voidage_core::grid::Grid;

/// What `--report` writes.
#[derive(Debug, Clone, Serialize)]
pub(super) struct Report {
    pub(super) version: &'static str,
    build: Build,
    pub(super) command: String,
    grid: GridReport,
    /// Of the union, within the grid in m³.
    solid_volume: f64,
    /// Least and most of the same in m³, with `--bounds-fields`.
    #[serde(skip_serializing_if = "Option::is_none")]
    solid_volume_bounds: Option<[f64; 2]>,
    bodies: usize,
    triangles: usize,
    roads: RoadReport,
    cells: porosity::CellCounts,
    max_gap: f64,
    divided: usize,
    leaks: Vec<porosity::Leak>,
    sheets_off_planes: porosity::snap::OffPlanes,
    /// Of scene files, and of other files by name.
    solids: Vec<SolidReport>,
    warnings: Vec<String>,
    skipped: Vec<&'static str>,
    seconds: BTreeMap<&'static str, f64>,
    gjk: porosity::Gjk,
    /// Digits of areas that are known, for the terminal.
    #[serde(skip)]
    digits: i32,
    /// Areas in m², with `--resistance`.
    #[serde(skip_serializing_if = "Option::is_none")]
    obstacles: Option<ObstacleReport>,
}

/// Totals of the obstacles, and what stands between faces that do not see it.
#[derive(Debug, Clone, Serialize)]
struct ObstacleReport {
    #[serde(flatten)]
    totals: Totals,
    /// Along x, y and z.
    hidden_passages: [HiddenPassages; 3],
    /// Others with gas on two sides of a wall.
    divided_cells: DividedCells,
    /// Cells that hold too much surface for a shadow.
    unproved_shadows: usize,
    /// Faces lowered to what passes, with `--faces throat`.
    lowered_faces: usize,
    /// Others closed beside cells that thin walls divide.
    closed_faces: usize,
    /// With `--drag`.
    #[serde(skip_serializing_if = "Option::is_none")]
    drag: Option<DragReport>,
    /// By zone and size.
    congestion: Vec<Congestion>,
}

/// How frontal area became resistance.
#[derive(Debug, Clone, Copy, Serialize)]
struct DragReport {
    law: DragLaw,
    cd: DragCoefficients,
    /// Bodies taken for round.
    round_bodies: usize,
    /// Bodies taken for sharp.
    sharp_bodies: usize,
    /// Cells and axes where the blockage of a row was limited to 0.95.
    capped: usize,
    /// Cells that bodies of different C_D share in parts of which each counts with all its frontal area.
    unproved: usize,
}

/// Bounds of the solid volume within this share of it are as close as it is written.
const EXACT: f64 = 1e-9;

impl ObstacleReport {
    fn new(args: &PorosityArgs, (found, obstacles): (&Resistance, &Obstacles), congestion: Vec<Congestion>) -> Self {
        let drag = args.drag.zip(obstacles.drag.as_ref()).map(|(law, drag)| DragReport {
            law,
            cd: args.cd.unwrap_or_default(),
            round_bodies: drag.bodies[0],
            sharp_bodies: drag.bodies[1],
            capped: drag.capped,
            unproved: drag.unproved,
        });
        let Shadows { hidden, inexact, .. } = &*found.shadows;
        ObstacleReport {
            totals: found.totals,
            hidden_passages: *hidden,
            divided_cells: obstacles.divided,
            unproved_shadows: inexact.estimated + inexact.too_full,
            lowered_faces: obstacles.lowered_faces,
            closed_faces: obstacles.closed_faces,
            drag,
            congestion,
        }
    }
}

/// How many bodies took which road.
#[derive(Debug, Clone, Serialize)]
struct RoadReport {
    /// Sums over surfaces: exact.
    surface: usize,
    /// Closed forms of solids by formula: exact.
    formula: usize,
    /// Subdivision by GJK: bounds.
    subdivision: usize,
    /// Of the latter, the rule at its end.
    leaf: Leaf,
}

#[derive(Debug, Clone, Serialize)]
struct GridReport {
    cells: [usize; 3],
    bounds: [DVec3; 2],
    unit: &'static str,
}

impl Report {
    pub(super) fn new(
        args: &PorosityArgs,
        (grid, edges): (&Grid<f64>, &Edges),
        bodies: &Bodies,
        result: &Porosity,
        (obstacles, congestion): (&Obstacles, Vec<Congestion>),
    ) -> Self {
        let mut skipped = Vec::new();
        if result.subdivided == 0 && result.gjk.queries == 0 {
            skipped.push("gjk: sums over triangles and closed forms are exact and cheaper");
        }
        if args.no_areas {
            skipped.push("area porosities: --no-areas");
        }
        if !args.bounds_fields {
            skipped.push("bound fields: not asked for (--bounds-fields)");
        }
        if obstacles.resistance.is_none() {
            skipped.push("frontal and wetted areas, walls between planes: not asked for (--resistance)");
        }
        if result.cells.ambiguous == 0 {
            skipped.push("unions: there is none to find in any cell");
        }
        Report {
            version: env!("CARGO_PKG_VERSION"),
            build: BUILD,
            command: command_line(),
            grid: GridReport { cells: edges.cells(), bounds: edges.bounds(), unit: "m" },
            solid_volume: result.solid_volume,
            solid_volume_bounds: result.solid_volume_bounds(grid),
            bodies: bodies.bodies.len(),
            triangles: bodies.triangles.len(),
            roads: RoadReport {
                surface: bodies.bodies.len() - result.subdivided - result.by_formula,
                formula: result.by_formula,
                subdivision: result.subdivided,
                leaf: args.leaf,
            },
            cells: result.cells,
            max_gap: result.max_gap,
            divided: result.divided,
            leaks: result.leaks.clone(),
            sheets_off_planes: result.sheets_off_planes,
            solids: Vec::new(),
            warnings: Vec::new(),
            skipped,
            seconds: BTreeMap::new(),
            gjk: result.gjk,
            digits: digits_of_areas(bodies),
            obstacles: obstacles
                .resistance
                .as_ref()
                .map(|found| ObstacleReport::new(args, (found, obstacles), congestion)),
        }
    }

    /// With what only a file asks for, the solids one by one, and what only the end of the run knows: warnings and the seconds of every stage.
    pub(super) fn finished(self, bodies: &Bodies, progress: &Progress) -> Self {
        let (seconds, warnings) = (progress.seconds.clone(), progress.warnings.clone());
        Report { solids: solids(bodies), seconds, warnings, ..self }
    }

    /// A few lines for the terminal.
    pub(super) fn summary(&self, progress: &Progress) {
        let [nx, ny, nz] = self.grid.cells;
        let c = self.cells;
        progress.say(format!("grid          {nx} × {ny} × {nz} = {}", counted(nx * ny * nz, "cell", "cells")));
        let triangles = counted(self.triangles, "triangle", "triangles");
        progress.say(format!("bodies        {} ({triangles})", self.bodies));
        if self.roads.subdivision > 0 {
            let bodies = counted(self.roads.subdivision, "body", "bodies");
            progress.say(format!("subdivided    {bodies}, queries of GJK: {}", self.gjk.queries));
        }
        let volume = self.solid_volume;
        let apart = self.solid_volume_bounds.map_or(0.0, |[low, high]| (volume - low).max(high - volume));
        let apart =
            if apart > EXACT * volume { format!(" ± {}", plain_to(apart, 0.1 * apart)) } else { String::new() };
        progress.say(format!("solid volume  {}{apart} m³", measure(volume)));
        progress.say(format!(
            "cells         {} open, {} cut, {} closed; {} with a union of bodies to find",
            c.open, c.cut, c.closed, c.ambiguous
        ));
        if let Some(ObstacleReport { totals, .. }) = &self.obstacles {
            let Totals { frontal_area: [x, y, z], wetted_area, .. } = *totals;
            // The frontal areas of any surface come to half of it or more.
            let in_planes = 2.0 * (x + y + z) < wetted_area * (1.0 - EXACT);
            let [x, y, z, wetted] = [x, y, z, wetted_area].map(|area| part(area, wetted_area, self.digits));
            let note = if in_planes { " with that in planes of the grid, which has no frontal area here" } else { "" };
            progress.say(format!("frontal area  {x}, {y}, {z} m² along x, y, z; wetted {wetted} m²{note}"));
        }
        progress.say(format!(
            "largest gap   {}",
            if self.max_gap > 0.0 { format!("{:.1e}", self.max_gap) } else { "0".into() }
        ));
        progress.say(format!("time          {:.3} s", progress.elapsed()));
    }
}
