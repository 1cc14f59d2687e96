//! Commented files that run as they are: `--template` and `--template-scene`.

/// A scene of pipes, a grating and a beam, with its grid.
pub const SCENE: &str = include_str!("template/scene.toml");

/// A burst in a room.
pub const CASE: &str = include_str!("template/case.toml");

/// A ball and a pipe by two methods.
pub const STUDY: &str = include_str!("template/study.toml");
