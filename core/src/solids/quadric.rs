//! Solid fractions of cells and faces of solids known by formula, layer by layer, exact to rounding: cylinder, cone, ball, capsule,
//! ellipsoid.
//!
//! Every face is cut by a solid in a region bounded by straight pieces and arcs of conics; its area has a closed form, and so has the flux
//! through it of a field that is tangent to the curved surface and has divergence 1. The sum of these fluxes is the volume in the cell.
//! Where the lines of the grid pierce a solid is computed once for each line, from the same numbers for all faces around it. All is
//! computed in `f64`, whatever the scalar of the grid.
//!
//! ```
//! use glam::DVec3;
//! use voidage_core::grid::{Grid, cell_range::RangeKind};
//! use voidage_core::solids::quadric::QuadricSolid;
//!
//! let edges = [0.0, 1.0, 2.0];
//! let grid = Grid::new(&edges, &edges, &edges)?;
//! let ball = QuadricSolid::ball(DVec3::ONE, 0.75).ok_or("no ball")?;
//! let mut volume = 0.0;
//! for k in 0..2 {
//!     ball.layer(&grid, k, true, &mut |kind, _, share| volume += if kind == RangeKind::Cells { share } else { 0.0 });
//! }
//! assert!((volume - 4.0 / 3.0 * core::f64::consts::PI * 0.75_f64.powi(3)).abs() < 1e-15);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A file uses only those above it in this list:
//!
//! 1. `twofold`: differences that keep their rounding errors; `anchor`: where an axis is counted from; `arc`: the lens between an arc of a conic and its chord
//! 2. `wall`: curved surfaces: lines through them, conics in planes
//! 3. `end_line`, `outline`: what a solid has of a rectangle; `ends`: flat ends; `solid_angle`: of sections of a ball; `cone`: fluxes through those of a cone
//! 4. `part`: one curved surface between flat ends, its fluxes and its volume in a cell; `window`: the cells it may reach
//! 5. `aligned`: the shares of a pipe along an axis of the grid in a layer; `spread`: those of any part
//! 6. `solid`: what callers use; `shapes`: the shapes that GJK knows, as such solids
//! 7. `tangent`: planes between which a part lies in a box
//! 8. `balls`: the union of balls; `slice`: what several parts have in common of a rectangle in a plane; `concave`: bounds of concave functions;
//!    `polygon`, `moving`, `panels`: polygons in planes that rise, and the volumes that they pass through; `third`: what an ellipse leaves of them; `sample`: what planes tell of a body; `crossing`: what
//!    two or three pipes have in common of a box, by planes along two axes; `upright`: two pipes along axes of the grid; `shared`: what several solids share of a cell or face

mod aligned;
mod anchor;
mod arc;
mod balls;
mod concave;
mod cone;
mod crossing;
mod end_line;
mod ends;
mod moving;
mod outline;
mod panels;
mod part;
mod polygon;
mod sample;
mod shapes;
mod shared;
mod slice;
mod solid;
mod solid_angle;
mod spread;
mod tangent;
mod third;
mod twofold;
mod upright;
mod wall;
mod window;

pub use shapes::AsQuadric;
pub use shared::{excess, share_of_union};
pub use solid::QuadricSolid;
pub use spread::{FaceBetween, FacesBetween};
