//! The library: reading, repairing, writing.

mod bodies;
mod input;
mod output;
mod vessels;
