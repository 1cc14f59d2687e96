//! How many cells solids are wide.

use super::solids::{self, OTHERS};
use crate::geometry::bodies::{Bodies, Body};
use crate::geometry::form::Form;
use crate::grid::Edges;
use crate::picture::ticks::number;
use crate::porosity::rod::Rod;
use voidage_core::surface::surface_area::SurfaceArea;

/// Solids with fewer cells across are coarse: what forces a blast has on them depends on where they stand among the planes of the grid.
pub const FEW_CELLS: f64 = 4.0;

/// Width of a body in m, and in cells, along the axes that flow: of a pipe its diameter, of others their second longest side. None where it is as wide as
/// may be, as what has its length alone along the axes that flow.
fn width(body: &Body, edges: &Edges, live: &[usize]) -> Option<[f64; 2]> {
    let [low, high] = body.bounds;
    let wide = match body.form_alone() {
        Some(Form::Sphere(_) | Form::Capsule(_) | Form::Cylinder(_) | Form::Cone(_) | Form::Torus(_)) => {
            Rod::of_body(body, &[], &SurfaceArea::default()).diameter
        }
        _ => {
            let mut sides: Vec<f64> = live.iter().map(|&axis| high[axis] - low[axis]).collect();
            sides.sort_by(|a, b| b.total_cmp(a));
            // An axis that does not flow is as long as the longest.
            *sides.get(live.len().checked_sub(2)?)?
        }
    };
    let middle = (low + high) * 0.5;
    let cell = live.iter().map(|&axis| {
        let (all, widths) = (&edges.0[axis], edges.widths(axis));
        widths[all.partition_point(|e| *e <= middle[axis]).saturating_sub(1).min(widths.len() - 1)]
    });
    Some([wide, wide / cell.fold(0.0, f64::max)])
}

/// Do many cells resolve a body?
pub fn is_resolved(body: &Body, edges: &Edges, live: &[usize]) -> bool {
    width(body, edges, live).is_none_or(|[_, cells]| cells >= FEW_CELLS)
}

/// Which of the names whose forces are asked for stand for bodies that few cells resolve, as a sentence; none if none do.
pub fn coarse(bodies: &Bodies, names: &[String], edges: &Edges, live: &[usize]) -> Option<String> {
    let of_bodies = solids::names(bodies);
    let widest = |name: &String| {
        let own = of_bodies.iter().zip(&bodies.bodies).filter(|(own, _)| own.contains(&&name[..]));
        let widths = own.map(|(_, body)| width(body, edges, live));
        widths.reduce(|a, b| Some([a?, b?]).map(|[a, b]| if a[1] >= b[1] { a } else { b })).flatten()
    };
    let is_coarse = |name: &&String| *name != OTHERS && widest(name).is_some_and(|[_, cells]| cells < FEW_CELLS);
    let mut all = names.iter().filter(is_coarse);
    let first = all.next()?;
    let [wide, cells] = widest(first)?;
    let others = match all.count() {
        0 => String::new(),
        count => format!(", and {count} more that few cells resolve"),
    };
    Some(format!(
        "\"{first}\" is {} m wide, {} cells{others}: loads of a blast on it depend on where it stands among the planes of the grid, up to a hundredfold at one \
         cell across, by half at three, by a tenth at eight",
        number(wide),
        number(cells)
    ))
}
