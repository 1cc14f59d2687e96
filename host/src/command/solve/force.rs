//! The force of the gas on all that stands in it.
//!
//! Walls inside a cell and in its faces have the vector area A⁻β⁻ − A⁺β⁺ along an axis, β⁻ and β⁺ being the open fractions of the two faces of area A:
//! by Gauss' theorem the surface of the gas is closed. The pressure of the cell acts on them; it is counted from that of the surroundings, so that what
//! leans on a wall of the domain feels the difference alone. Obstacles that the cells do not resolve feel their drag,
//! β_v ρ (a_i + ½ CR_i |u|) u_i V. Walls of the domain do not count.

use crate::flow::Flow;
use rayon::prelude::*;

/// Force on all solids along x, y and z; per metre of the axes that do not flow. The same bits for any number of threads.
pub fn force<const D: usize>(flow: &Flow<f64, D>, live: [usize; D], ambient: f64) -> [f64; 3] {
    let Some(solids) = Solids::of(flow) else { return [0.0; 3] };
    let n = flow.cells()[0];
    let rows: Vec<[f64; D]> = (0..flow.len() / n)
        .into_par_iter()
        .map(|row| {
            let mut sum = [0.0; D];
            (row * n..(row + 1) * n).for_each(|cell| solids.add(flow, cell, ambient, &mut sum));
            sum
        })
        .collect();
    let mut force = [0.0; 3];
    for (d, axis) in live.into_iter().enumerate() {
        force[axis] = rows.iter().fold(0.0, |sum, row| sum + row[d]);
    }
    force
}

/// What the gas pushes.
pub(super) struct Solids<'a, const D: usize> {
    beta_v: Option<&'a [f64]>,
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
        let beta_v = flow.beta_v();
        let nothing = beta_v.is_none() && drag.iter().flatten().all(|c| c.is_empty());
        (!nothing).then_some(Solids { beta_v, faces, drag })
    }

    /// Adds the force on what is in a cell and in its faces.
    fn add(&self, flow: &Flow<f64, D>, cell: usize, ambient: f64, sum: &mut [f64; D]) {
        let open = self.beta_v.map_or(1.0, |b| b[cell]);
        if open == 0.0 {
            return;
        }
        let at = flow.coordinates(cell);
        let (over, drag) = (flow.get(cell).pressure - ambient, self.drag(flow, cell));
        for d in 0..D {
            sum[d] += over * self.wall(flow, d, at);
            sum[d] += drag[d];
        }
    }

    /// Vector area of the walls in a cell and in its faces along an axis.
    pub(super) fn wall(&self, flow: &Flow<f64, D>, d: usize, at: [usize; D]) -> f64 {
        let Some(faces) = self.faces[d] else { return 0.0 };
        let [low, high] = [0, 1].map(|side| faces[flow.face(d, at, side)]);
        (low - high) * flow.area(d, at)
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
