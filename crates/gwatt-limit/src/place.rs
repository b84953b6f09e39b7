//! Where a block stands.

/// Where a line stands: which text, and its number there from 1.
pub type Place = (u16, u64);
