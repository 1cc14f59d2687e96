//! Porosity of files on disk: reading, threads, writing. The mathematics is in [`voidage_core`].
//!
//! Data flows one way: [`geometry`] → [`grid`] → [`porosity`] → [`flow`] → [`files`], [`picture`]; [`command`] shows the stages in order.
#![forbid(unsafe_code)]

pub mod command;
pub mod error;
pub mod files;
pub mod flow;
pub mod geometry;
pub mod grid;
pub mod huge;
pub mod picture;
pub mod porosity;
