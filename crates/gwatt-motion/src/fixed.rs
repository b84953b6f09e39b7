//! Why the words of a move are not changed, where more than the interpreter has to know.

/// The move is part of a canned cycle.
pub const CYCLE: &str = "it is part of a canned cycle";
/// The move is part of a turning cycle.
pub const TURNING_CYCLE: &str = "it is part of a turning cycle";
