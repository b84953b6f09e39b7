//! Follows through the blocks by which kinds of numbers the places of axes were stated.

use super::point_kinds::Kind;
use crate::code::{GCode, Motion};
use crate::control::{Control, Run};
use crate::letters::bit;
use crate::places::STANDSTILL_MM;
use gwatt_machine::{ALL_AXES, Point};

/// Where the kinds meet.
const MIXED_POINTS: &str = "mixed-points";

/// What a block does with its words of lengths.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Use {
    Move,
    /// G53.
    MoveInMachine,
    /// G92 and its like: the places are called by them.
    Name,
    /// G52, G10: the places are called further on by them.
    Shift,
    /// A canned cycle of mills, with its levels.
    Cycle,
    /// A cycle of lathes, a pocket.
    Shape,
}

impl Control<'_> {
    /// Follows the kinds through a block whose words are sorted.
    pub(super) fn follow_points(&mut self, run: &mut Run<'_, '_>) {
        let known = self.dialect().point_is_known;
        if !self.position.points.begun || known || self.dialect().point != Some(Point::Calculator) {
            return;
        }
        let usage = self.usage(run);
        self.change_origins(run);
        let absolute = absolute(self, run);
        let levels = self.modal.plane[2];
        let lengths = b"IJKR".map(|letter| (!self.counts(letter, run)).then_some(letter));
        let here = self.position.program();
        let points = &mut self.position.points;
        for (kind, here) in points.places.iter_mut().zip(here) {
            if *kind == Kind::Zero && here.abs() > STANDSTILL_MM {
                *kind = Kind::Pointed;
            }
        }
        let mut way = Kind::Zero;
        for (axis, _) in run.words.axes() {
            let letter = ALL_AXES[axis].letter();
            let Some(word) = run.words.word(letter, run.block) else {
                continue;
            };
            let kind = points.of(word, run.report.text);
            let incremental = !absolute || run.words.incremental & bit(letter) != 0;
            match usage {
                Use::Name | Use::Shift => points.rename(axis, kind, usage == Use::Shift),
                Use::MoveInMachine => way = way.with(points.go_to_machine(axis, kind)),
                Use::Cycle if axis == levels => points.levels = points.levels.with(kind),
                Use::Shape => {
                    // It leads back to where it began.
                    points.go(axis, kind, true);
                    points.levels = points.levels.with(points.places[axis]);
                }
                Use::Move | Use::Cycle => way = way.with(points.go(axis, kind, incremental)),
            }
        }
        if matches!(usage, Use::Cycle | Use::Shape) {
            for letter in lengths.into_iter().flatten() {
                if let Some(word) = run.words.word(letter, run.block) {
                    points.levels = points.levels.with(points.of(word, run.report.text));
                }
            }
            let depth = points.places[levels].with(points.levels);
            points.places[levels] = depth;
            // The moves from level to level are others than those from hole to hole.
            if depth == Kind::Both || usage == Use::Shape {
                way = depth;
            }
        }
        if way != Kind::Both || usage == Use::Move && is_arc(self, run) {
            return;
        }
        self.position.points.apart = true;
        let message = "how far the axes go here depends on what numbers without a decimal point \
                       mean: it is taken as not known; write decimal_point under [language] in \
                       the machine file";
        let whole = run.whole();
        run.report.note_once(MIXED_POINTS, message, whole);
    }

    /// What a block does with its words of lengths.
    fn usage(&mut self, run: &Run<'_, '_>) -> Use {
        let mut cycle = self.special.active;
        for (code, ..) in &run.words.g {
            match code {
                GCode::SetOffset => return Use::Name,
                GCode::Scaling(false) if run.words.has_axes() => return Use::Name,
                GCode::LocalOffset | GCode::DataSetting => return Use::Shift,
                GCode::MachineCoordinates => return Use::MoveInMachine,
                GCode::Turning(_) | GCode::Pocket(_) => return Use::Shape,
                GCode::Motion(Motion::Special(number)) => cycle = *number,
                GCode::Motion(_) => cycle = 0,
                _ => {}
            }
        }
        let levels = &mut self.position.points.levels;
        match cycle {
            0 => {
                *levels = Kind::Zero;
                Use::Move
            }
            _ if self.dialect().lathe.is_some() => Use::Shape,
            _ => Use::Cycle,
        }
    }

    /// Words by which the places of the program are called otherwise: what is between is
    /// known, or not compared at all.
    fn change_origins(&mut self, run: &Run<'_, '_>) {
        let offsets = self.position.offsets();
        let changes = |code: &GCode| match code {
            GCode::WorkOffset(system) => u16::from(*system) != offsets.system,
            GCode::Units { mm_per_unit } => *mm_per_unit != self.modal.mm_per_unit,
            GCode::ClearOffset { .. }
            | GCode::RestoreOffset
            | GCode::FurtherOffset
            | GCode::Polar(true)
            | GCode::Rotation(true)
            | GCode::Scaling(true)
            | GCode::Mirror(true) => true,
            _ => false,
        };
        let all = run.words.g.iter().any(|(code, ..)| changes(code))
            || self.dialect().lathe.is_some() && run.words.has(b'T');
        let length = |code: &GCode| matches!(code, GCode::ToolLength(_));
        let along = !self.tools.unknown() && run.words.g.iter().any(|(code, ..)| length(code));
        let normal = self.modal.plane[2];
        let points = &mut self.position.points;
        for axis in self
            .machine
            .axis_set
            .iter()
            .filter(|axis| all || along && *axis == normal)
        {
            points.places[axis] = points.seen_from_elsewhere(axis);
        }
    }
}

/// Whether words of axes are places in the block.
fn absolute(control: &Control<'_>, run: &Run<'_, '_>) -> bool {
    let mut codes = run.words.g.iter();
    let here = codes.find_map(|(code, ..)| match code {
        GCode::Absolute(absolute) => Some(*absolute),
        _ => None,
    });
    here.unwrap_or(control.modal.absolute)
}

/// Whether the block is an arc: what it is made of has to agree on the control, by which
/// one of the meanings is excluded.
fn is_arc(control: &Control<'_>, run: &Run<'_, '_>) -> bool {
    let mut codes = run.words.g.iter();
    let here = codes.find_map(|(code, ..)| match code {
        GCode::Motion(motion) => Some(*motion),
        _ => None,
    });
    let motion = here.unwrap_or(control.modal.motion);
    matches!(motion, Motion::ArcCw | Motion::ArcCcw)
        && [b'I', b'J', b'K', b'R']
            .iter()
            .any(|letter| run.words.has(*letter))
}
