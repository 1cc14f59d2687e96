//! The stage of obstacles, shared by `porosity` and `solve`: what stands between the faces of cells, and what it resists.

use super::progress::Progress;
use crate::geometry::bodies::{Bodies, Body, SolidSummary};
use crate::grid::AXES;
use crate::picture::ticks::number as short;
use crate::picture::ticks::part;
use crate::porosity::divided::{ClosedCells, DividedCells, Division};
use crate::porosity::drag::{DragCoefficients, DragLaw, ObstacleDrag, drag, fill_a_cell};
use crate::porosity::resistance::{Resistance, resistance, shadows, unseen_frontal_area};
use crate::porosity::shadows::{HIDDEN, Shadows};
use crate::porosity::snap;
use crate::porosity::throat::{self, Faces, LoweredSide};
use crate::porosity::{Options, Porosity, levels};
use crate::words::counted;
use voidage_core::grid::Grid;
use voidage_core::surface::layer::ShadowReport;

/// What is asked for.
#[derive(Debug, Clone, Copy)]
pub struct Wanted {
    /// The obstacles of every cell.
    pub resistance: bool,
    /// Their drag.
    pub drag: Option<(DragLaw, DragCoefficients)>,
    /// What faces mean.
    pub faces: Faces,
    /// Warnings of what a flow does not see: hidden passages, even if nothing else needs their search, and area without force.
    pub warning: bool,
}

/// What was found.
#[derive(Debug, Default)]
pub struct Obstacles {
    /// The obstacles of every cell.
    pub resistance: Option<Resistance>,
    /// Frontal area along x, y and z in m² that no face shows, if the obstacles are known and warnings wanted.
    pub unseen: [f64; 3],
    /// Their drag.
    pub drag: Option<ObstacleDrag>,
    /// Faces lowered to what passes.
    pub lowered_faces: usize,
    /// Faces closed beside cells that thin walls divide.
    pub closed_faces: usize,
    /// Lowered faces in sides of the grid whose obstacles have gas all around.
    pub surrounded: Vec<LoweredSide>,
    /// Cells with gas on two sides of what stands in them, hidden passages not counted again.
    pub divided: DividedCells,
}

/// Find what is wanted; with [`Faces::Throat`] the faces of `result` are lowered.
pub fn obstacles(
    grid: &Grid<f64>,
    bodies: &Bodies,
    result: &mut Porosity,
    options: Options,
    wanted: Wanted,
    progress: &mut Progress,
) -> Obstacles {
    let mut found = Obstacles::default();
    if wanted.resistance || wanted.drag.is_some() {
        let obstacles = progress.stage("resistance", |_| resistance(grid, bodies, result, options));
        warn_of_doubt(bodies, &obstacles, progress);
        if wanted.warning {
            found.unseen = unseen_frontal_area(grid, &result.beta, &obstacles, wanted.faces);
        }
        found.resistance = Some(obstacles);
    }
    let shadows = match &found.resistance {
        Some(of_solids) if levels(bodies) == [0.0] => of_solids.shadows.clone(),
        None if !wanted.warning && wanted.faces == Faces::Plane => return found,
        _ => progress.stage("shadows", |_| shadows(grid, bodies, result, options)),
    };
    // The drag is that of the cell's own surface: it asks for faces as they are.
    if let (Some(law), Some(obstacles)) = (wanted.drag, &found.resistance) {
        let drag = progress.stage("drag", |_| drag(grid, bodies, (result, obstacles), options, law));
        if drag.capped > 0 {
            progress.warn(format!(
                "drag: in {} (counted once for each axis) a row of obstacles blocks more than 95 % of the section; the law is used at 95 %",
                counted(drag.capped, "cell", "cells")
            ));
        }
        if drag.unproved > 0 {
            progress.warn(format!(
                "drag: in parts of {} that bodies of different C_D share it is not known for certain what one hides of another; each counts there with all its frontal area",
                counted(drag.unproved, "cell", "cells")
            ));
        }
        found.drag = Some(drag);
        warn_of_gratings(bodies, progress);
        warn_of_partly_filled(grid, bodies, progress);
        warn_of_tight(grid, bodies, options, progress);
    }
    let (lowered, closed) = progress.stage("divided", |_| {
        let division = Division::find(grid, bodies, &result.beta, &shadows);
        match wanted.faces {
            Faces::Plane => (0, ClosedCells { left: division.told(grid, &result.beta, Some(&shadows)), faces: 0 }),
            Faces::Throat => {
                let sides = throat::lowered_sides(grid, &result.beta, &shadows);
                let sides = throat::seen_from_within(grid, bodies, options, sides);
                found.surrounded = division.surrounded(grid, &result.beta, sides);
                (throat::lower(grid, result, &shadows), division.close(grid, result, &shadows))
            }
        }
    });
    if wanted.faces == Faces::Plane {
        warn_of_hidden_passages(bodies, &shadows, progress);
    }
    if closed.faces > 0 {
        let faces = counted(closed.faces, "face is", "faces are");
        progress.say(format!("thin walls    {faces} closed beside cells that walls divide"));
    }
    warn_of_divided_cells(bodies, (closed.left, wanted.faces), progress);
    (found.lowered_faces, found.closed_faces, found.divided) = (lowered, closed.faces, closed.left);
    found
}

fn warn_of_doubt(bodies: &Bodies, found: &Resistance, progress: &mut Progress) {
    let (totals, files) = (&found.totals, bodies.files());
    if totals.unproved > 0 {
        progress.warn(format!(
            "{files}: the surface of the union is not known for certain in {}; up to {:.1e} m² of wetted area in one of them",
            counted(totals.unproved, "cell", "cells"),
            totals.max_doubt
        ));
    }
    let ShadowReport { estimated, too_full } = found.shadows.inexact;
    if estimated > 0 {
        progress.warn(format!(
            "{files}: {} outlines that cross so often that the shadow is an estimate, to a thousandth of the section",
            counted(estimated, "cell holds", "cells hold")
        ));
    }
    if too_full > 0 {
        progress.warn(format!(
            "{files}: {} too much surface for a shadow; what the faces show stands in its place",
            counted(too_full, "cell holds", "cells hold")
        ));
    }
}

/// What blocks a cell between two open faces is not seen by the flow.
fn warn_of_hidden_passages(bodies: &Bodies, shadows: &Shadows, progress: &mut Progress) {
    for (axis, hidden) in AXES.into_iter().zip(shadows.hidden) {
        let Some([i, j, k]) = hidden.first else { continue };
        progress.warn(format!(
            "{}: {} blocked along {axis} by more than {:.0} % between two faces that show next to nothing of it, the first at cell {i}, {j}, {k} \
             (counted from 0): gas passes through; with throat faces such walls are tight",
            bodies.files(),
            counted(hidden.cells, "cell is", "cells are"),
            HIDDEN * 100.0
        ));
    }
}

/// A cell has one state: the gas on both sides of what divides it is one.
fn warn_of_divided_cells(bodies: &Bodies, (divided, faces): (DividedCells, Faces), progress: &mut Progress) {
    let Some([i, j, k]) = divided.first else { return };
    let cure = match faces {
        Faces::Plane => "with throat faces such walls are tight",
        Faces::Throat => "a way through it may be narrower than a sixth of a cell, and smaller cells would tell",
    };
    progress.warn(format!(
        "{}: {} divided by a wall thinner than a cell that no face closes, the first at cell {i}, {j}, {k} (counted from 0): gas passes through; {cure}",
        bodies.files(),
        counted(divided.cells, "cell is", "cells are")
    ));
}

/// How many others a sentence about the first of them is about.
fn and_more(others: usize) -> String {
    if others > 0 { format!(" and {others} more") } else { String::new() }
}

/// Say which porous solids slow nothing down.
pub fn warn_of_gratings(bodies: &Bodies, progress: &mut Progress) {
    let free = |b: &&Body| b.porosity > 0.0 && b.porosity < 1.0 && b.drag.cr.is_none();
    let mut gratings = bodies.bodies.iter().filter(free);
    if let Some(first) = gratings.next() {
        let others = and_more(gratings.count());
        progress.warn(format!(
            "{}: \"{}\"{others} with a porosity, but without cr: the gas passes with no loss but that of narrower faces; cr = … of the solid \
             gives a loss of ½ ρ cr |u| u a metre, u in the pores",
            bodies.files(),
            first.name
        ));
    }
}

/// Say which solids with a resistance of their own are tight and fill cells: there is no gas in these that it could act on.
fn warn_of_tight(grid: &Grid<f64>, bodies: &Bodies, options: Options, progress: &mut Progress) {
    let resists =
        |s: &&SolidSummary| bodies.bodies[s.bodies.clone()].iter().any(|b| b.drag.cr.is_some_and(|cr| cr > 0.0));
    let tight = bodies.solids.iter().filter(|s| s.porosity == 0.0).filter(resists);
    let mut filling = tight.filter(|s| fill_a_cell(grid, bodies, s.bodies.clone(), options));
    if let Some(first) = filling.next() {
        let others = and_more(filling.count());
        progress.warn(format!(
            "{}: \"{}\"{others} with a cr, but with porosity 0: it is tight, and where it fills whole cells its cr has no effect; give it a \
             porosity above 0",
            first.scene, first.name
        ));
    }
}

/// Say which porous solids with a resistance of their own fill cells in part: there the velocity is not that in their pores.
fn warn_of_partly_filled(grid: &Grid<f64>, bodies: &Bodies, progress: &mut Progress) {
    let resists = |b: &&Body| b.porosity > 0.0 && b.porosity < 1.0 && b.drag.cr.is_some_and(|cr| cr > 0.0);
    let near = snap::near(grid);
    // Of several sides the one that lies off by the largest share of the body: of a screen, one of those that the gas goes through.
    let between_planes = |b: &Body| {
        let sides = (0..3).flat_map(|axis| b.bounds.map(|corner| (axis, corner[axis])));
        let off = |(axis, at): (usize, f64)| (snap::nearest(grid, axis, at) - at).abs();
        let between = sides.filter(|&(axis, at)| {
            let is_within = grid.edges(axis).first() < Some(&at) && Some(&at) < grid.edges(axis).last();
            is_within && off((axis, at)) > near[axis]
        });
        let share = |side: (usize, f64)| off(side) / (b.bounds[1] - b.bounds[0])[side.0];
        between.min_by(|&a, &b| share(b).total_cmp(&share(a)))
    };
    let mut all = bodies.bodies.iter().filter(resists).filter_map(|b| Some((b, between_planes(b)?)));
    if let Some((first, (axis, at))) = all.next() {
        let others = and_more(all.count());
        progress.warn(format!(
            "{}: \"{}\"{others} with a porosity and a cr begins or ends between planes of the grid (at {} = {}): where it fills cells in \
             part it loses less than cr L / porosity²; its sides belong into planes of the grid",
            bodies.files(),
            first.name,
            AXES[axis],
            short(at)
        ));
    }
}

/// Digits of areas that are known: fewer where facets stand for round solids, whose width they miss by up to 4e-4.
#[must_use]
pub fn digits_of_areas(bodies: &Bodies) -> i32 {
    if bodies.bodies.iter().any(|body| body.triangles.is_empty()) { 3 } else { 6 }
}

/// A smaller share of the frontal area than this, without force, is not worth a word: the rims of bodies that are wider than cells.
const LEAST_UNSEEN: f64 = 0.02;

/// Say how much stands in the way of a flow and exerts no force.
pub fn warn_of_no_force(bodies: &Bodies, (found, unseen): (&Resistance, [f64; 3]), progress: &mut Progress) {
    if unseen.iter().zip(found.totals.frontal_area).any(|(unseen, all)| *unseen > LEAST_UNSEEN * all) {
        let [x, y, z] = unseen.map(|a| part(a, found.totals.wetted_area, digits_of_areas(bodies)));
        progress.warn(format!(
            "{}: {x}, {y}, {z} m² of frontal area along x, y, z lie inside cells, where faces show them at most in part, and no drag acts on them: [drag] law = \"pdr\" \
             or \"bluff\" gives them some, law = \"none\" says that it is meant so",
            bodies.files()
        ));
    }
}
