//! What the cases share: random numbers, solids, truths by closed forms and by counting, and the calls of the program.
//!
//! Nothing but [`doors`] asks the program for a result.

pub mod books;
pub mod boxes;
pub mod doors;
pub mod random;
pub mod truth;
