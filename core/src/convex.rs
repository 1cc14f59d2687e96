//! Convex bodies: do two meet, how far apart are they, with proof.
//!
//! A file uses only those above it in this list:
//!
//! 1. [`support`]: support mappings, and bodies made of bodies
//! 2. [`shape`]: points, segments, triangles, boxes, balls, cylinders, cones, hulls
//! 3. [`sat`]: triangle against box
//! 4. [`simplex`]: where the origin lies in a simplex, with proof
//! 5. [`gjk`]: do two bodies meet, and how far apart are they
//! 6. [`exact`]: the same without rounding, for bodies given by vertices
//! 7. [`containment`]: is a box inside a body
//! 8. [`chord`]: where a line enters and leaves a body, its flat sides and reach
//! 9. [`polytope`]: a hull that knows its facets

pub mod chord;
pub mod containment;
pub mod exact;
pub mod gjk;
pub mod polytope;
pub mod sat;
pub mod shape;
pub mod simplex;
pub mod support;
