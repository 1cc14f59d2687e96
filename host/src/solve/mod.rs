//! Gas flow through porosity fields.

pub mod flow;
