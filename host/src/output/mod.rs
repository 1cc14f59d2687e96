//! Results on disk: arrays, ParaView files, pictures, the report.
//!
//! Every writer checks its lengths, writes beside the target and renames ([`atomically`]), so that an existing file is
//! either untouched or replaced as a whole. Fields are x fastest: cell `(k*ny + j)*nx + i`.
//!
//! In reading order: [`atomic`], `bytes`; [`npy`], [`vtr`], [`report`]; then pictures from the pixel upwards:
//! `font`, [`canvas`], [`colour`], [`ticks`], [`heatmap`], [`figure`], [`png`]; [`chart`].

pub mod atomic;
pub(crate) mod bytes;
pub mod canvas;
pub mod chart;
pub mod colour;
pub mod figure;
mod font;
pub mod heatmap;
pub mod npy;
pub mod png;
pub mod report;
pub mod ticks;
pub mod vtr;

pub use atomic::{atomically, check_target, discard_unfinished, together};
