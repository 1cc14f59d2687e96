//! The C functions, called as a C program would.

mod bodies;
mod flow;
mod hostile;
mod kit;
mod porosity;
mod text;
