//! The C functions, called as a C program would.

#![allow(clippy::useless_vec, reason = "what is handed over as a pointer lies in memory of its own")]

mod bodies;
mod flow;
mod hostile;
mod kit;
mod porosity;
mod text;
