//! The command, as from a shell.

mod bad_inputs;
mod inspect;
mod kit;
mod porosity;
mod solve;
mod solve_errors;
mod solve_resume;
