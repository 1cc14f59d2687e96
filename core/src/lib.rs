//! Volume and area porosity of real geometry on structured grids.
//!
//! The crate is `no_std`, allocates nothing, holds no `unsafe` code and works in `f32` and `f64` from one text.
//! Seven rooms; one uses only those above it:
//!
//! 1. [`number`]: the two scalars, their vectors, boxes
//! 2. [`convex`]: convex bodies: do two meet (GJK), how far apart are they, with proof
//! 3. [`grid`]: cells, faces, index order; solid fractions of a layer, as bounds that bodies share
//! 4. [`quadric`]: fractions of cylinder, cone, ball, capsule, ellipsoid by closed forms
//! 5. [`surface`]: fractions from triangulated surfaces, overlaps counted once; its door is [`surface::layer`], with an example
//!    in [`surface`]
//! 6. [`subdivide`]: fractions of bodies by subdivision, GJK deciding
//! 7. [`flow`]: the Euler equations in a porous space; it uses [`number`] alone and sees porosity only as slices
//!
//! # Two convex bodies
//!
//! ```
//! use glam::DVec3;
//! use voidage_core::convex::{self, AnyBody, exact::Contact, shape::Cylinder};
//! use voidage_core::number::aabb::Aabb;
//!
//! let cell = AnyBody::new(Aabb { min: DVec3::ZERO, max: DVec3::ONE })?;
//! let pipe = AnyBody::new(Cylinder::new(DVec3::new(0.5, 0.5, -1.0), DVec3::new(0.5, 0.5, 2.0), 0.25))?;
//! assert_eq!(convex::meets(&cell, &pipe).contact(), Some(Contact::Overlapping));
//! # Ok::<(), convex::BodyError>(())
//! ```
#![cfg_attr(not(feature = "std"), no_std)]
#![forbid(unsafe_code)]

pub mod convex;
pub mod flow;
pub mod grid;
pub mod number;
pub mod quadric;
pub mod subdivide;
pub mod surface;
