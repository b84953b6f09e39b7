//! Paths that the tool cannot follow, and what is said about them.

use crate::interpret::execute::Run;

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
    OtherMotion,
}

impl Fault {
    /// Message and help. LinuxCNC stops at all of them but `ArcFirst`,
    /// `InverseTime`, `UnknownStart` and `TooMany`.
    fn words(self) -> (&'static str, &'static str) {
        const SMALLER: &str =
            "use a smaller tool, or round the corner by an arc larger than the tool";
        match self {
            Self::ShortEntry => (
                "the first move under cutter compensation is not longer than the tool's radius",
                "make the lead-in move in the plane longer",
            ),
            Self::EntryArc => (
                "no arc leads the tool from where it is to the side of this arc's end",
                "lead in with a straight move",
            ),
            Self::ArcFirst => (
                "the first move under cutter compensation must be straight here",
                "lead in with a straight move",
            ),
            Self::SmallArc => (
                "the arc's radius is not larger than the radius of the tool inside it",
                "use a smaller tool, or a larger arc",
            ),
            Self::NoCorner => (
                "an inside corner of zero degrees under cutter compensation",
                "the path goes back on itself: take the tool out another way",
            ),
            Self::LineToArc => (
                "the tool cannot reach this arc from the line before it without cutting into the part",
                SMALLER,
            ),
            Self::ArcToLine => (
                "the tool cannot reach this line from the arc before it without cutting into the part",
                SMALLER,
            ),
            Self::ArcToArc => (
                "the tool cannot reach this arc from the one before it without cutting into the part",
                SMALLER,
            ),
            Self::SameCenter => (
                "two arcs with the same centre meet in an inside corner",
                "check the centres of the arcs",
            ),
            Self::LineGouges => (
                "the line before this inside corner is too short for the tool",
                SMALLER,
            ),
            Self::ArcGouges => (
                "the arc before this inside corner is too short for the tool",
                SMALLER,
            ),
            Self::NoArc => (
                "the shifted arc's ends are not on one circle",
                "check the end point and the centre of the arc",
            ),
            Self::ArcAfterExit => (
                "the move that leaves cutter compensation must be straight",
                "lead out with a straight move behind G40",
            ),
            Self::InverseTime => (
                "inverse-time feed (G93) under cutter compensation is not supported",
                "write the feed per minute: G94",
            ),
            Self::UnknownStart => (
                "cutter compensation begins at a position that is not known",
                "move the axes of the plane to a known position first, or give --start X0,Y0,Z0",
            ),
            Self::OtherMotion => (
                "this motion under cutter compensation: the controller stops here",
                "switch the compensation off before: G40",
            ),
            Self::TooMany => (
                "more than a thousand steps without motion in the plane of the compensation",
                "switch the compensation off before: G40",
            ),
        }
    }

    /// Reports the fault at the block that shows it.
    pub(super) fn report(self, run: &mut Run<'_, '_>) {
        let (message, help) = self.words();
        let span = run.whole();
        run.report.error("compensation", message, span).help(help);
    }
}
