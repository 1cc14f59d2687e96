//! The command, as from a shell.

mod bad_inputs;
mod drag;
mod forces;
mod inspect;
mod kit;
mod maxima;
mod monitors;
mod no_effect;
mod outputs;
mod outside;
mod packages;
mod patches;
mod places;
mod planes;
mod porosity;
mod readme;
mod reference;
mod regions;
mod scene;
mod solve;
mod solve_errors;
mod solve_resume;
mod streams;
mod stress;
mod study;
mod units;
