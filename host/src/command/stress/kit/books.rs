//! What a flow must keep, and states that make none.

use crate::command::stress::kit::random::Random;
use crate::command::stress::kit::truth::larger;
use crate::flow::{Flow, Treatment};
use crate::grid::Edges;
use crate::porosity::FieldSet;
use voidage_core::flow::{Conserved, Error as FlowError};

/// The content of a flow at its beginning.
#[derive(Debug, Clone, Copy)]
pub struct Books<const D: usize>(Conserved<f64, D>);

impl<const D: usize> Books<D> {
    /// Now.
    #[must_use]
    pub fn open(flow: &Flow<f64, D>) -> Self {
        Books(flow.content())
    }

    /// Mass and energy that neither came in nor were there before, as shares of what was there or passed a side, whichever is more.
    #[must_use]
    pub fn lost(&self, flow: &Flow<f64, D>) -> f64 {
        let (now, before) = (flow.content(), self.0);
        let share = |of: fn(&Conserved<f64, D>) -> f64| {
            let inflow: Vec<f64> = flow.total.inflow.iter().flatten().map(of).collect();
            let most = inflow.iter().fold(of(&before), |most, x| most.max(x.abs()));
            ((of(&now) - of(&before) - inflow.iter().sum::<f64>()) / most).abs()
        };
        larger(share(|u| u.density), share(|u| u.energy))
    }
}

/// Cells whose density or pressure is not positive and finite, or whose velocity is not finite.
#[must_use]
pub fn unphysical<const D: usize>(flow: &Flow<f64, D>) -> f64 {
    let physical = |cell: usize| {
        let w = flow.get(cell);
        let gas = w.density > 0.0 && w.pressure > 0.0 && w.density.is_finite() && w.pressure.is_finite();
        gas && w.velocity.iter().all(|u| u.is_finite())
    };
    (0..flow.len()).filter(|&cell| !physical(cell)).count() as f64
}

/// Bits of the state; one zero for both.
#[must_use]
pub fn bits<const D: usize>(flow: &Flow<f64, D>) -> Vec<u64> {
    let state = &flow.state;
    let all = state.density.iter().chain(state.momentum.iter().flat_map(|m| m.iter())).chain(state.energy.iter());
    all.map(|x| (x + 0.0).to_bits()).collect()
}

/// How many bits differ.
#[must_use]
pub fn differ(a: &[u64], b: &[u64]) -> f64 {
    (a.len().abs_diff(b.len()) + a.iter().zip(b).filter(|(a, b)| a != b).count()) as f64
}

/// A plane flow on the x and y axes of fractions, which have one cell along z.
///
/// # Errors
/// Fractions that do not fit.
pub fn plane_porosity(flow: &mut Flow<f64, 2>, edges: &Edges, open: &FieldSet) -> Result<(), FlowError> {
    debug_assert_eq!(edges.cells()[2], 1);
    flow.set_porosity(open.v.to_vec(), [open.x.to_vec(), open.y.to_vec()], Treatment::default()).map(|_| ())
}

/// Random open fractions of cells and faces for a flow of `n` cells.
///
/// # Errors
/// The flow refuses them.
pub fn set_random_porosity<const D: usize>(
    flow: &mut Flow<f64, D>,
    n: [usize; D],
    random: &mut Random,
) -> Result<(), FlowError> {
    let volume = (0..flow.len()).map(|_| random.fraction()).collect();
    let faces = std::array::from_fn(|d| (0..face_count(n, d)).map(|_| random.fraction()).collect());
    flow.set_porosity(volume, faces, Treatment::default()).map(|_| ())
}

/// Faces of every axis: as many as a mesh of `n` cells has normal to axis `d`.
#[must_use]
pub fn face_count<const D: usize>(n: [usize; D], d: usize) -> usize {
    (0..D).map(|axis| n[axis] + usize::from(axis == d)).product()
}
