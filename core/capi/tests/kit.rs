//! What the tests share: the functions of both precisions under one name, and calls with any arguments at all.

pub mod api;
pub mod calls;
