//! Volume and area porosity of real geometry on structured grids.
//!
//! The crate is `no_std`, allocates nothing, holds no `unsafe` code and works in `f32` and `f64` from one text.
//! A module uses only those above it in this list:
//!
//! 1. [`real`]: the two scalars and their vectors
//! 2. [`aabb`]: axis-aligned boxes
//! 3. [`support`]: support mappings, and bodies made of bodies
//! 4. [`shape`]: convex bodies
//! 5. [`sat`]: triangle against box
//! 6. [`simplex`]: where the origin lies in a simplex, with proof
//! 7. [`gjk`]: do two bodies meet, and how far apart are they
//! 8. [`exact`]: the same without rounding, for bodies given by vertices
//! 9. [`contain`]: is a box inside a body
//! 10. [`convex`]: chords, flat sides and reach of convex bodies
//! 11. [`polytope`]: a hull that knows its facets
//! 12. [`columns`]: bounds of a body's share of a box, from chords
//! 13. [`classify`]: where a cell or face lies to a body
//! 14. [`mesh`]: the same for a closed surface of triangles
//! 15. [`clip`]: convex polygons cut by planes
//! 16. [`grid`]: cells, faces, index order
//! 17. [`subdivide`]: cells and faces of convex bodies, by subdivision
//! 18. [`layer`]: solid fractions of one layer of cells, as bounds that bodies share
//! 19. [`surface`]: cells, x and y faces of a layer from a triangulated surface
//! 20. [`section`]: its z faces
//! 21. [`overlap`]: the exact union of bodies in a cell
//!
//! Beside the geometry, and using none of it, stands the flow:
//!
//! - [`pdr`]: the Euler equations in a porous space; it sees porosity only as slices
#![cfg_attr(not(feature = "std"), no_std)]
#![forbid(unsafe_code)]

pub mod aabb;
pub mod classify;
pub mod clip;
pub mod columns;
pub mod contain;
pub mod convex;
pub mod exact;
pub mod gjk;
pub mod grid;
pub mod layer;
pub mod mesh;
pub mod overlap;
pub mod pdr;
pub mod polytope;
pub mod real;
pub mod sat;
pub mod section;
pub mod shape;
pub mod simplex;
pub mod subdivide;
pub mod support;
pub mod surface;
