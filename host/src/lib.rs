//! Porosity of files on disk: reading, threads, writing. The mathematics is in [`voidage_core`].
//!
//! Data flows one way: [`input`], [`scene`] → [`bodies`], [`grid`] → [`porosity`] → [`output`]; [`run`] shows the stages in order.
#![forbid(unsafe_code)]

pub mod bodies;
pub mod cli;
pub mod error;
pub mod grid;
pub mod input;
pub mod inspect;
pub mod interrupt;
pub mod output;
pub mod porosity;
pub mod progress;
pub mod run;
pub mod scene;
pub mod solve;
pub mod study;
pub mod values;
