//! Files on disk: arrays, ParaView files, JSON; whole or not at all.
//!
//! Every writer checks its lengths, writes beside the target and renames ([`atomically`]), so that an existing file is
//! either untouched or replaced as a whole. Fields are x fastest: cell `(k*ny + j)*nx + i`.
//!
//! In reading order: [`whole`], `bytes`; [`npy`], [`vtr`], `json`, `csv`.

pub(crate) mod bytes;
#[cfg(feature = "cli")]
pub mod csv;
#[cfg(feature = "cli")]
pub mod json;
pub mod npy;
pub mod vtr;
pub mod whole;

pub use whole::{atomically, check_takes_files, check_target, destination, discard_unfinished, together, written};
