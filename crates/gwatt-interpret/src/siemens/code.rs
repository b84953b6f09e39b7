//! Codes that only this language has.

/// A G word that only this language has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Code {
    /// G74 and G75.
    Reference,
    /// G9: exact stop in one block.
    ExactOnce,
    /// G96 and G961; the speed of the spindle follows the diameter.
    SurfaceSpeed { per_revolution: bool },
    /// G97 and G971.
    ConstantSpeed { per_revolution: bool },
    /// G110, G111 and G112.
    Pole(u8),
    /// G53 and G153.
    Suppress,
    /// G25 and G26.
    Limits,
    /// G450 (false) and G451: outside corners of the radius compensation.
    Intersects(bool),
    /// G63: tapping, in one block.
    Tapping,
}

impl Code {
    /// The modal group, see [`GCode::group`].
    pub(crate) fn group(self) -> u32 {
        match self {
            Self::SurfaceSpeed { .. } | Self::ConstantSpeed { .. } => 4,
            Self::Suppress => 11,
            Self::Reference => 12,
            Self::ExactOnce | Self::Tapping => 16,
            Self::Pole(_) => 17,
            Self::Limits => 18,
            Self::Intersects(_) => 19,
        }
    }
}
