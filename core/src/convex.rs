//! Convex bodies: do two meet, how far apart are they, with proof.
//!
//! Bodies of a kind known at run time are [`AnyBody`]; [`meets`] and [`distance`] take two of them:
//!
//! ```
//! use glam::DVec3;
//! use voidage_core::convex::{self, AnyBody, Clearance, exact::Contact, shape::{Capsule, Hull}};
//!
//! let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
//! let bodies = [
//!     AnyBody::new(Hull::new(&corners))?,
//!     AnyBody::new(Capsule { from: DVec3::new(3.0, 0.0, 0.0), to: DVec3::new(3.0, 4.0, 0.0), radius: 0.5 })?,
//! ];
//! assert_eq!(convex::meets(&bodies[0], &bodies[1]).contact(), Some(Contact::Disjoint));
//! let Clearance::Apart { distance, .. } = convex::distance(&bodies[0], &bodies[1]) else { panic!("they are apart") };
//! assert!((distance - 1.5).abs() < 1e-14);
//! # Ok::<(), convex::BodyError>(())
//! ```
//!
//! Bodies of kinds known when the program is built go to [`gjk::intersect`] and [`gjk::distance`], and if given by vertices to [`exact::contact`].
//!
//! A file uses only those above it in this list:
//!
//! 1. [`support`]: support mappings, and bodies made of bodies; `opaque`: a body behind a pointer
//! 2. [`shape`]: points, segments, triangles, boxes, balls, cylinders, cones, hulls
//! 3. [`sat`]: triangle against box
//! 4. [`simplex`]: where the origin lies in a simplex, with proof
//! 5. [`gjk`]: do two bodies meet, and how far apart are they
//! 6. [`exact`]: the same without rounding, for bodies given by vertices
//! 7. [`containment`]: is a box inside a body
//! 8. `any_body`, `query`: the same questions of bodies of any kind
//! 9. [`chord`]: where a line enters and leaves a body, its flat sides and reach
//! 10. [`polytope`]: a hull that knows its facets

mod any_body;
pub mod chord;
pub mod containment;
pub mod exact;
pub mod gjk;
mod opaque;
pub mod polytope;
mod query;
pub mod sat;
pub mod shape;
pub mod simplex;
pub mod support;

pub use any_body::{AnyBody, AnyShape, BodyError};
pub use query::{BodyQuery, Clearance, Meeting, MeetingProof, SeparationProof, distance, meets};
