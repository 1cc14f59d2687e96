//! Pictures of fields, from the pixel upwards.
//!
//! In reading order: `font`, [`canvas`], [`colour`], [`ticks`], [`heatmap`], [`figure`], [`png`]; [`chart`].

pub mod canvas;
pub mod chart;
pub mod colour;
pub mod figure;
mod font;
pub mod heatmap;
pub mod png;
pub mod ticks;
