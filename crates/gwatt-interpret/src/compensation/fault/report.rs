//! How faults are reported.

use super::Fault;
use crate::control::Run;

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
                "lead out with a straight move after G40",
            ),
            _ => self.other_words(),
        }
    }

    /// The same of what is no matter of the corners.
    fn other_words(self) -> (&'static str, &'static str) {
        match self {
            Self::InverseTime => (
                "inverse-time feed (G93) under cutter compensation is not supported",
                "write the feed per minute: G94",
            ),
            Self::UnknownStart => (
                "cutter compensation begins at a position that is not known",
                "move the axes of the plane to a known position first, or give --start X0,Y0,Z0",
            ),
            Self::Idle => (
                "the control does not look this far ahead for the corner: blocks without motion \
                 in the plane of the compensation come before it",
                "take them together, or write them outside of the compensation",
            ),
            Self::NothingBetween => (
                "the compensation ends with no move in the plane after the one that began it",
                "write the contour between G41 or G42 and G40",
            ),
            Self::Intersection => ("an outside corner with an arc under G451", "write G450"),
            Self::OtherMotion => (
                "this motion under cutter compensation: the controller stops here",
                "switch the compensation off before: G40",
            ),
            Self::TooMany => (
                "more than a thousand steps without motion in the plane of the compensation",
                "switch the compensation off before: G40",
            ),
            _ => self.corner_words(),
        }
    }

    /// Message and help of a chamfer or a rounded corner.
    fn corner_words(self) -> (&'static str, &'static str) {
        match self {
            Self::NoFirstMove => (
                "a chamfer or a rounded corner after a block that is not one feed move",
                "write it in the block of a G1, G2 or G3, without M words that stop",
            ),
            Self::NoSecondMove => (
                "after a chamfer or a rounded corner comes no feed move",
                "write the second move, G1, G2 or G3, in the next block",
            ),
            Self::CornerPlane => (
                "a chamfer or a rounded corner where a move leaves the plane",
                "write both moves in the plane of G17, G18 or G19",
            ),
            Self::LargeCorner => (
                "a chamfer or a rounded corner that does not fit between its moves",
                "make it smaller",
            ),
            Self::NoBend => (
                "a chamfer or a rounded corner where the path goes straight on or back",
                "take it out",
            ),
            _ => (
                "a chamfer where an arc begins or ends",
                "write the chamfer as a move of its own",
            ),
        }
    }

    /// Whether it is one of a chamfer or a rounded corner.
    fn is_of_corner(self) -> bool {
        matches!(
            self,
            Self::NoFirstMove
                | Self::NoSecondMove
                | Self::CornerPlane
                | Self::LargeCorner
                | Self::NoBend
                | Self::ChamferAtArc
        )
    }

    /// Reports the fault at the block that shows it.
    pub(crate) fn report(self, run: &mut Run<'_, '_>) {
        let (message, help) = self.words();
        let span = run.whole();
        let rule = if self.is_of_corner() {
            "corner-word"
        } else {
            "compensation"
        };
        run.report.error(rule, message, span).help(help);
    }
}
