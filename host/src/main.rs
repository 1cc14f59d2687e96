//! The command `voidage`.
fn main() {}
