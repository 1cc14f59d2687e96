//! The force of the gas on all that stands in it.
//!
//! Walls inside a cell and in its faces have the vector area A⁻β⁻ − A⁺β⁺ along an axis, β⁻ and β⁺ being the open fractions of the two faces of area A:
//! by Gauss' theorem the surface of the gas is closed. The pressure of the cell acts on them; it is counted from that of the surroundings, so that what
//! leans on a wall of the domain feels the difference alone. Obstacles that the cells do not resolve feel their drag,
//! β_v ρ (a_i + ½ CR_i |u|) u_i V. Walls of the domain do not count.

use crate::flow::Flow;
use rayon::prelude::*;

/// Cells are summed in portions of this size, whatever the number of threads.
const PORTION: usize = 4096;

/// The cells in which there is something to push; a flow keeps its space, so they are found once.
#[derive(Debug)]
pub struct Walls<const D: usize> {
    /// Cell, vector area of its walls, and whether something in it drags.
    cells: Vec<(usize, [f64; D], bool)>,
}

impl<const D: usize> Walls<D> {
    /// Of a flow.
    #[must_use]
    pub fn of(flow: &Flow<f64, D>) -> Self {
        let Some(solids) = Solids::of(flow) else { return Walls { cells: Vec::new() } };
        let pushed = |cell: usize| {
            let (at, drags) = (flow.coordinates(cell), solids.drags(cell));
            let walls = std::array::from_fn(|d| solids.wall(flow, d, at));
            (flow.open_volume(cell) > 0.0 && (drags || walls != [0.0; D])).then_some((cell, walls, drags))
        };
        Walls { cells: (0..flow.len()).into_par_iter().filter_map(pushed).collect() }
    }

    /// Force on all solids along x, y and z; per metre of the axes that do not flow. The same bits for any number of threads.
    #[must_use]
    pub fn force(&self, flow: &Flow<f64, D>, live: [usize; D], ambient: f64) -> [f64; 3] {
        let Some(solids) = Solids::of(flow) else { return [0.0; 3] };
        let of_portion = |cells: &[(usize, [f64; D], bool)]| {
            let mut sum = [0.0; D];
            for (cell, walls, drags) in cells {
                let over = flow.get(*cell).pressure - ambient;
                let drag = if *drags { solids.drag(flow, *cell) } else { [0.0; D] };
                (0..D).for_each(|d| sum[d] += over * walls[d] + drag[d]);
            }
            sum
        };
        let portions: Vec<[f64; D]> = self.cells.par_chunks(PORTION).map(of_portion).collect();
        let mut force = [0.0; 3];
        for (d, axis) in live.into_iter().enumerate() {
            force[axis] = portions.iter().fold(0.0, |sum, portion| sum + portion[d]);
        }
        force
    }
}

/// What the gas pushes.
pub(super) struct Solids<'a, const D: usize> {
    faces: [Option<&'a [f64]>; D],
    /// Quadratic and linear coefficients; empty where zero.
    drag: [[&'a [f64]; D]; 2],
}

impl<'a, const D: usize> Solids<'a, D> {
    /// Those of a flow; none if its space is open and nothing drags.
    pub(super) fn of(flow: &'a Flow<f64, D>) -> Option<Self> {
        let (mut faces, mut drag) = ([None; D], [[&[][..]; D]; 2]);
        faces.iter_mut().zip(flow.faces()).for_each(|(to, from)| *to = Some(from));
        drag.iter_mut().flatten().zip(flow.drag()).for_each(|(to, from)| *to = from);
        let nothing = flow.beta_v().is_none() && drag.iter().flatten().all(|c| c.is_empty());
        (!nothing).then_some(Solids { faces, drag })
    }

    /// Vector area of the walls in a cell and in its faces along an axis.
    pub(super) fn wall(&self, flow: &Flow<f64, D>, d: usize, at: [usize; D]) -> f64 {
        let Some(faces) = self.faces[d] else { return 0.0 };
        let [low, high] = [0, 1].map(|side| faces[flow.face(d, at, side)]);
        (low - high) * flow.area(d, at)
    }

    /// The closed fraction of a face of a cell.
    pub(super) fn closed(&self, flow: &Flow<f64, D>, d: usize, at: [usize; D], side: usize) -> f64 {
        self.faces[d].map_or(0.0, |faces| 1.0 - faces[flow.face(d, at, side)])
    }

    /// Something in a cell drags.
    pub(super) fn drags(&self, cell: usize) -> bool {
        self.drag.iter().flatten().any(|c| c.get(cell).is_some_and(|c| *c > 0.0))
    }

    /// Drag of what a cell does not resolve.
    pub(super) fn drag(&self, flow: &Flow<f64, D>, cell: usize) -> [f64; D] {
        let w = flow.get(cell);
        let speed = w.velocity.iter().fold(0.0, |s, u| s + u * u).sqrt();
        let volume = flow.open_volume(cell);
        std::array::from_fn(|d| {
            let [quadratic, linear] = [0, 1].map(|n| self.drag[n][d].get(cell).copied().unwrap_or(0.0));
            volume * w.density * (linear + 0.5 * quadratic * speed) * w.velocity[d]
        })
    }
}
