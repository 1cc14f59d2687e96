//! Gas flow through porosity fields: `voidage solve`.
//!
//! In reading order: [`output_keys`], [`case`], [`places`] and [`case_file`], the file as typed; `arrays`, [`regions`], [`mixture`], [`space`],
//! [`open_parts`], [`state`], [`inlet`], [`sides`], `cut_off`, [`region_report`], [`units`] and [`setup`], from the case to a flow; [`charges`], where its blast begins; [`limits`], how far it goes; [`frames`], [`pictures`], [`maxima`], [`monitors`], [`force`], [`solids`],
//! [`force_peaks`], [`table`], [`series`], [`checkpoint`], [`lock`], [`report`], what it writes; [`stepping`], each
//! step; [`refine`], the same case on half the cells; [`run`].

mod arrays;
pub mod case;
pub mod case_file;
pub mod charges;
pub mod checkpoint;
mod coarse;
mod cut_off;
pub mod force;
pub mod force_peaks;
pub mod frames;
pub mod inlet;
pub mod limits;
pub mod lock;
pub mod maxima;
pub mod mixture;
pub mod monitors;
pub mod open_parts;
pub mod output_keys;
pub mod pictures;
pub mod places;
pub mod ranges;
pub mod refine;
pub mod region_report;
pub mod regions;
pub mod report;
pub mod run;
pub mod series;
pub mod setup;
pub mod sides;
pub mod solids;
pub mod space;
pub mod state;
pub mod stepping;
mod strong_drag;
pub mod table;
pub mod units;
