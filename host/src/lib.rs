//! Porosity of files on disk: reading, threads, writing. The mathematics is in [`voidage_core`].
#![forbid(unsafe_code)]

pub mod error;
pub mod input;
pub mod output;
pub mod solve;
