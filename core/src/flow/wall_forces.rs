//! What the gas does in a step to the walls and obstacles of some cells.
//!
//! The momentum that the gas of a cell loses to the solids in it follows from the fluxes that the step has used, so that the forces on all solids and
//! the momentum through the sides of the domain balance the change of the gas to rounding. The pressure of the cell alone would not do: in slow flow a
//! wall that stops a stream u feels rho c u more than its cell.

/// What passes the faces of a cell and acts on its walls and obstacles, as a mean over a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellPush<R, const D: usize> {
    /// Along each axis, on what is closed of the low and of the high face and on the walls inside that run behind it: pressure times closed
    /// fraction, counted from [`WatchedWalls::reference`]. The force along axis d is (high − low) times the area of the cell normal to d; under gravity g
    /// less g_d times the mass of gas that the solids displace.
    pub sides: [[R; 2]; D],
    /// For the low and the high face of each axis, the force along x, y, z that the borders of porous bodies askew to the grid get at that face, beside that on what
    /// is closed of it, which is in `sides`: per area of the cell normal to the axis. What the high faces have counts, what the low ones have is taken off.
    pub along: [[[R; D]; 2]; D],
    /// Mass per time and area of the cell that passes its low and its high face upwards along each axis.
    pub mass: [[R; 2]; D],
    /// Momentum that the drag of the cell takes per time and volume of the cell, obstacles included.
    pub drag: [R; D],
}

/// Cells whose walls and faces are watched during a step, and where what acts and passes there goes.
#[derive(Debug)]
pub struct WatchedWalls<'w, R, const D: usize> {
    /// Flat indices of cells, ascending.
    pub cells: &'w [usize],
    /// As long as `cells`; those of the slab that is advanced are written.
    pub pushes: &'w mut [CellPush<R, D>],
    /// Pressure that all others are counted from.
    pub reference: R,
}
