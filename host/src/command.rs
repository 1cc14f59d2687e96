//! The command `voidage`: what the user typed, and what is done about it.
//!
//! In reading order: [`interrupt`], [`cli`], [`progress`]; [`stages`]; [`porosity`], [`inspect`], [`solve`], [`study`].

pub mod cli;
pub mod inspect;
pub mod interrupt;
pub mod obstacles;
pub mod porosity;
pub mod progress;
pub mod solve;
pub mod stages;
pub mod study;
