//! Paths that the tool cannot follow, and what is said about them.

mod report;

/// Why a move cannot be compensated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Fault {
    ShortEntry,
    EntryArc,
    ArcFirst,
    SmallArc,
    NoCorner,
    LineToArc,
    ArcToLine,
    ArcToArc,
    SameCenter,
    LineGouges,
    ArcGouges,
    NoArc,
    ArcAfterExit,
    InverseTime,
    UnknownStart,
    TooMany,
    Idle,
    NothingBetween,
    Intersection,
    OtherMotion,
    NoFirstMove,
    NoSecondMove,
    CornerPlane,
    LargeCorner,
    NoBend,
    ChamferAtArc,
}
