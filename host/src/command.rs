//! The command `voidage`: what the user typed, and what is done about it.
//!
//! In reading order: [`version`], [`interrupt`], [`cli`], [`progress`], [`streams`], [`template`], [`docs`]; [`stages`], [`obstacles`]; [`riemann`] and [`triangulated`],
//! which `study` and `stress` share; [`porosity`], [`inspect`], [`solve`], [`study`], [`stress`].

pub mod cli;
pub mod docs;
pub mod inspect;
pub mod interrupt;
pub mod obstacles;
pub mod porosity;
pub mod progress;
pub mod riemann;
pub mod solve;
pub mod stages;
pub mod streams;
pub mod stress;
pub mod study;
pub mod template;
pub mod triangulated;
pub mod version;
