//! A block of a canned cycle apart from the way to its hole.

/// A block of a cycle with the way to its hole on lines of their own.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Placed {
    /// The way.
    pub way: Vec<u8>,
    /// The block, and what comes after it.
    pub block: Vec<u8>,
}

impl Placed {
    /// The lines, with others between the way and the block where there is a way.
    #[must_use]
    pub fn around(self, between: &[u8]) -> Vec<u8> {
        let mut lines = self.way;
        if !lines.is_empty() {
            lines.extend_from_slice(between);
        }
        lines.extend(self.block);
        lines
    }
}
