//! Pictures of fields, from the pixel upwards.
//!
//! In reading order: `accents`, `font`, [`canvas`], [`colour`], [`ticks`], [`heatmap`], [`figure`], [`png`]; [`chart`].

mod accents;
pub mod canvas;
pub mod chart;
pub mod colour;
pub mod figure;
mod font;
pub mod heatmap;
pub mod png;
pub mod ticks;
