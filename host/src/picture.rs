//! Pictures of fields, from the pixel upwards.
//!
//! In reading order: `accents`, `alphabets`, `font`, [`canvas`], [`colour`], [`ticks`], [`heatmap`], [`figure`], [`png`]; [`svg`], [`axis`], [`panels`].

mod accents;
mod alphabets;
pub mod axis;
pub mod canvas;
pub mod colour;
pub mod figure;
mod font;
pub mod heatmap;
pub mod panels;
pub mod png;
pub mod svg;
pub mod ticks;

pub use font::not_drawn;
