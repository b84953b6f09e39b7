//! Names of path modes and of the ways of rapids.

use crate::{PathMode, RapidPath};
use schemars::JsonSchema;
use serde::Deserialize;

/// What happens at the joint of two blocks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum PathModeName {
    ExactStop,
    LookAhead,
}

/// How rapids run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum RapidName {
    Linear,
    Independent,
}

/// Path mode of its name.
pub(crate) fn path_mode(name: PathModeName) -> PathMode {
    match name {
        PathModeName::ExactStop => PathMode::ExactStop,
        PathModeName::LookAhead => PathMode::LookAhead,
    }
}

/// Rapid path of its name.
pub(crate) fn rapid_path(name: RapidName) -> RapidPath {
    match name {
        RapidName::Linear => RapidPath::Linear,
        RapidName::Independent => RapidPath::Independent,
    }
}
