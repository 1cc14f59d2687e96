//! The flows of a study: built-in problems with exact solutions on finer and finer grids, by schemes whose lists multiply out.
//!
//! In reading order: [`exact`], [`problems`], [`lines`], [`planes`]; [`keys`], [`runs`].

pub mod exact;
pub mod keys;
pub mod lines;
pub mod planes;
pub mod problems;
pub mod runs;
