//! The G and M words: which modal group each belongs to, and the names of
//! those that are refused.
//!
//! Groups follow RS274/NGC (LinuxCNC G-code reference, "Modal Groups").

use super::tools::ToolLength;
use gwatt_machine::{Language, PowerOnMotion};

/// What the motion words mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Motion {
    /// G80, and the state before the first motion word.
    None,
    /// G0.
    Rapid,
    /// G1.
    Linear,
    /// G2.
    ArcCw,
    /// G3.
    ArcCcw,
    /// A word that makes several moves, or moves that no word may change:
    /// canned cycles, threads, probing. Number × 10.
    Special(u16),
}

impl Motion {
    /// What is in force before the first motion word, as far as it is known.
    #[must_use]
    pub fn at_power_on(language: &Language) -> Self {
        match language.power_on_motion {
            PowerOnMotion::None | PowerOnMotion::Unknown => Self::None,
            PowerOnMotion::Rapid => Self::Rapid,
            PowerOnMotion::Feed => Self::Linear,
        }
    }

    /// The digit after G; `None` where no word may be written.
    #[must_use]
    pub fn digit(self) -> Option<u8> {
        match self {
            Self::None | Self::Special(_) => None,
            Self::Rapid => Some(b'0'),
            Self::Linear => Some(b'1'),
            Self::ArcCw => Some(b'2'),
            Self::ArcCcw => Some(b'3'),
        }
    }
}

/// A G word that gwatt knows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum GCode {
    Motion(Motion),
    Dwell,
    Plane([usize; 3]),
    Units {
        mm_per_unit: f64,
    },
    Reference,
    CompensationOff,
    ToolLength(ToolLength),
    /// G41, G42; `by_diameter`: G41.1 and G42.1.
    CompensationOn {
        left: bool,
        by_diameter: bool,
    },
    MachineCoordinates,
    WorkOffset(u8),
    PathMode,
    Absolute(bool),
    ArcAbsolute(bool),
    SetOffset,
    ClearOffset {
        forget: bool,
    },
    RestoreOffset,
    /// G28.1 and G30.1.
    SaveReference,
    /// G10.
    DataSetting,
    /// G52.
    LocalOffset,
    /// G54.1 P, Haas' G154 P.
    FurtherOffset,
    /// G7 (true) and G8.
    Diameter(bool),
    /// G96 and G97.
    SurfaceSpeed,
    /// G16 (true) and G15.
    Polar(bool),
    /// G68 (true) and G69.
    Rotation(bool),
    /// G51 (true) and G50.
    Scaling(bool),
    /// G51.1 (true) and G50.1.
    Mirror(bool),
    FeedMode(super::FeedMode),
    MirrorX,
    /// G31 of Fanuc and Haas: a feed that a signal ends.
    Skip,
    /// G12 (true) and G13 of Haas.
    Pocket(bool),
    /// G70 to G72.2 of `LinuxCNC`; number × 10.
    LatheCycle(u16),
    /// G70 to G76 of a lathe; number × 10 in systems A and B.
    Turning(u16),
    /// G98 (true): canned cycles return to the initial level; G99: to R.
    Retract(bool),
    /// G65, G66 and G67.
    MacroCall,
    /// A word of SINUMERIK alone.
    Siemens(super::siemens::code::Code),
    /// A word of OSP alone.
    Osp(super::osp::code::OspCode),
    Ignored,
    /// Exact stop in this block.
    ExactOnce,
}

impl GCode {
    /// The modal group, as a bit; words of one group exclude each other.
    pub(super) fn group(self) -> u32 {
        1 << match self {
            // G80 may stand next to the word that takes over.
            Self::Motion(Motion::None) => 24,
            Self::Motion(_) => 0,
            Self::Plane(_) => 1,
            Self::Absolute(_) => 2,
            Self::ArcAbsolute(_) => 3,
            Self::FeedMode(_) => 4,
            Self::Units { .. } => 5,
            Self::CompensationOff | Self::CompensationOn { .. } => 6,
            Self::ToolLength(_) => 7,
            Self::WorkOffset(_) | Self::FurtherOffset => 8,
            Self::PathMode => 9,
            Self::Dwell => 10,
            Self::MachineCoordinates => 11,
            Self::Reference
            | Self::Skip
            | Self::SetOffset
            | Self::ClearOffset { .. }
            | Self::RestoreOffset
            | Self::SaveReference
            | Self::DataSetting
            | Self::LatheCycle(_)
            | Self::Pocket(_)
            | Self::Turning(_)
            | Self::LocalOffset => 12,
            // As in group 0 of Fanuc it may stand next to any other.
            Self::Ignored | Self::ExactOnce => 13,
            Self::MirrorX => 14,
            Self::Diameter(_) => 15,
            Self::SurfaceSpeed => 16,
            Self::Polar(_) => 17,
            Self::Rotation(_) => 18,
            Self::Scaling(_) => 19,
            Self::Mirror(_) => 20,
            Self::MacroCall => 21,
            Self::Retract(_) => 22,
            Self::Siemens(code) => code.group(),
            Self::Osp(code) => code.group(),
        }
    }
}

/// What a dialect makes of a G word.
pub(crate) enum Own {
    Code(GCode),
    /// It does not have it.
    Missing,
    /// What the family makes of it.
    Common,
}
