//! Which program this is: version, commit, features, target.

use serde::Serialize;

/// For `voidage --version`.
pub const VERSION: &str = concat!(
    env!("CARGO_PKG_VERSION"),
    "\ncommit   ",
    env!("VOIDAGE_COMMIT"),
    "\nfeatures ",
    env!("VOIDAGE_FEATURES"),
    "\ntarget   ",
    env!("VOIDAGE_TARGET")
);

/// For reports.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Build {
    commit: &'static str,
    features: &'static str,
    target: &'static str,
}

/// This one.
pub const BUILD: Build =
    Build { commit: env!("VOIDAGE_COMMIT"), features: env!("VOIDAGE_FEATURES"), target: env!("VOIDAGE_TARGET") };
