//! What a caller may get wrong.

use core::fmt;

/// A broken contract.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Error {
    /// A slice does not fit the mesh.
    ShapeMismatch {
        /// Length by the mesh.
        expected: usize,
        /// Length given.
        found: usize,
    },
    /// An axis is periodic on one side only.
    HalfPeriodic {
        /// The axis.
        axis: usize,
    },
    /// A width of a cell that is not positive and finite.
    Width {
        /// The axis.
        axis: usize,
        /// The cell along it.
        cell: usize,
    },
    /// A patch names no axis of the mesh, stands on a periodic side, is periodic itself, or is one of a line of cells.
    Patch {
        /// Its number among those given.
        number: usize,
    },
    /// More faces than a `usize` can count, or more cells than clusters of them can name.
    TooManyCells,
    /// The porosity was prepared for another mesh, or for one with other periodic axes.
    OtherMesh,
    /// A number of the gas is not positive and finite, or its ratio of specific heats is not above 1; what a side feeds is not between those of a
    /// mixed gas.
    Gas,
    /// The step is compiled for another Riemann solver or another kind of gas.
    OtherFlux,
    /// A reservoir beside a mixed gas: it feeds gas of one ratio of specific heats.
    MixedReservoir,
    /// Watched cells whose indices do not ascend.
    WatchedOrder {
        /// The first among them that is below the one before it.
        number: usize,
    },
    /// What stands outside a side is no state of the gas: a density or pressure that is not positive, or a number that is not finite.
    Side {
        /// The axis of the side.
        axis: usize,
    },
    /// A step that is negative or not finite, a CFL number that is not positive or, where steps are to be stable, is above 1, or an end of a run that is
    /// NaN or lies before the time reached.
    Step,
    /// A stable step that is too short to advance the time.
    Stalled,
    /// An open fraction of a cell that is not from 0 to 1, but for rounding.
    CellFraction {
        /// The flat index of the cell.
        cell: usize,
    },
    /// An open fraction of a face that is not from 0 to 1, but for rounding.
    FaceFraction {
        /// The axis that the face is across.
        axis: usize,
        /// Its flat index among the faces across that axis.
        face: usize,
    },
    /// A coefficient of drag that is negative or not finite.
    Drag {
        /// The axis along which it acts.
        axis: usize,
        /// The flat index of the cell.
        cell: usize,
    },
    /// A cell outside the physical set (density or pressure not positive, or not finite; of a mixed gas a capacity out of its bounds).
    Unphysical {
        /// Its flat index.
        cell: usize,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::ShapeMismatch { expected, found } => {
                write!(f, "a slice has {found} entries where the mesh asks for {expected}")
            }
            Error::HalfPeriodic { axis } => write!(f, "axis {axis} is periodic on one side only"),
            Error::Width { axis, cell } => {
                write!(f, "the width of cell {cell} along axis {axis} is not positive and finite")
            }
            Error::Patch { number } => {
                write!(f, "patch {number} stands on no side of two or three axes that could be a part of it")
            }
            Error::TooManyCells => f.write_str("the mesh has too many cells"),
            Error::OtherMesh => f.write_str("the porosity was prepared for another mesh or other periodic axes"),
            Error::Gas => f.write_str(
                "a number of the gas is not positive and finite, or its ratio of specific heats is not above 1",
            ),
            Error::OtherFlux => f.write_str("the step is compiled for another Riemann solver or another kind of gas"),
            Error::MixedReservoir => {
                f.write_str("a reservoir has no place beside a gas of several ratios of specific heats")
            }
            Error::Side { axis } => write!(f, "what stands outside a side of axis {axis} is no state of the gas"),
            Error::Step => f.write_str(
                "the step is negative or not finite, the CFL number is not above 0 and at most 1, or the end of the run is not a number or lies before the time reached",
            ),
            Error::Drag { axis, cell } => {
                write!(f, "a coefficient of drag along axis {axis} in cell {cell} is negative or not finite")
            }
            Error::Stalled => f.write_str("a stable step is too short to advance the time"),
            Error::CellFraction { cell } => write!(f, "the open fraction of cell {cell} is not from 0 to 1"),
            Error::FaceFraction { axis, face } => {
                write!(f, "the open fraction of face {face} across axis {axis} is not from 0 to 1")
            }
            Error::WatchedOrder { number } => {
                write!(f, "watched cell {number} has a lower index than the one before it")
            }
            Error::Unphysical { cell } => {
                write!(f, "the density or pressure of cell {cell} is not positive, or its state is not finite")
            }
        }
    }
}

impl core::error::Error for Error {}

/// Refuses a length that is not the one expected.
pub(in crate::flow) fn fits(expected: usize, found: usize) -> Result<(), Error> {
    if expected == found { Ok(()) } else { Err(Error::ShapeMismatch { expected, found }) }
}
