//! Solid fractions of cells and faces of tori and of parts of them, pipe bends, layer by layer.
//!
//! A torus is no quadric: its sections are quartics, whose areas have no closed form. They are integrated line by line, to rounding in
//! nearly all faces, with what each may be off by; sections across the axis and flat ends are exact. Volumes are fluxes of a field around the axis, tangent
//! to the torus. All is computed in `f64`, whatever the scalar of the grid.
//!
//! ```
//! use glam::DVec3;
//! use voidage_core::grid::{Grid, cell_range::RangeKind};
//! use voidage_core::solids::torus::{TorusShape, TorusSolid};
//!
//! let edges = [0.0, 0.5, 1.0];
//! let grid = Grid::new(&edges, &edges, &edges)?;
//! let (radius, tube, angle) = (0.6, 0.2, 90.0);
//! let center = DVec3::new(0.1, 0.1, 0.5);
//! let bend = TorusShape { center, axis: DVec3::Z, start: DVec3::X, radius, tube, angle };
//! let bend = TorusSolid::new(&bend).ok_or("no bend")?;
//! let mut volume = 0.0;
//! for k in 0..2 {
//!     bend.layer(&grid, k, true, &mut |kind, _, share, _| {
//!         volume += if kind == RangeKind::Cells { share / 8.0 } else { 0.0 };
//!     });
//! }
//! // Pappus: the disc's area times the way of its centre.
//! let pi = core::f64::consts::PI;
//! assert!((volume - pi * tube * tube * pi / 2.0 * radius).abs() < 1e-13);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A file uses only those above it in this list:
//!
//! 1. `roots`: of functions of one variable
//! 2. `ring`: a torus between ends, and what lines have of it; `disc`: what a disc has of a polygon
//! 3. `touching`: where lines of a plane touch a torus
//! 4. `section`: what a torus has of a rectangle
//! 5. `solid`: what callers use; `tangent`: planes between which it lies in a box

mod disc;
mod ring;
mod roots;
mod section;
mod solid;
mod tangent;
mod touching;

pub use solid::{TorusShape, TorusSolid};
