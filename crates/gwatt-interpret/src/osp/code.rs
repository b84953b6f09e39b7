//! Codes that only this language has.

/// A G word that only this language has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum OspCode {
    /// G15 (modal) and G16 (in one block): a work coordinate system.
    System { once: bool },
    /// G71: the level that M53 returns to.
    ReturnLevel,
}

impl OspCode {
    /// The modal group, see [`GCode::group`].
    pub(crate) fn group(self) -> u32 {
        match self {
            Self::System { .. } => 8,
            Self::ReturnLevel => 12,
        }
    }
}
