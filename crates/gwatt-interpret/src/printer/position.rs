//! Moves that a firmware makes of itself: homing, probing, tool changes.

use super::left_out::note_levelling;
use super::line::Parameters;
use crate::control::{Control, Run};
use crate::facts::{OWN_MOVES, RUNS_A_FILE};
use crate::places::EXTRUDER;
use gwatt_machine::{AxisId, AxisSet};
use gwatt_motion::ActionKind;
use gwatt_syntax::source::Span;

/// Marlin's words (number × 10) that the firmware waits for once they have moved: probing,
/// levelling, calibration.
const WAITED_FOR: [u16; 11] = [290, 300, 310, 320, 330, 340, 350, 382, 383, 384, 385];

/// Whose the moves of a command are that only the machine knows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Mover {
    /// The firmware's, under the limits in force.
    Firmware,
    /// The same, which it waits for.
    FirmwareWaiting,
    /// Those of a file or a macro of the machine, which may set limits of its own.
    File,
}

impl Control<'_> {
    /// Moves of a word that the profile or the machine file lists under `unknown_moves`.
    pub(super) fn listed_moves(
        &mut self,
        run: &mut Run<'_, '_>,
        (letter, number, span): (u8, u16, Span),
    ) {
        let printer = &self.machine.controller.language.printer;
        let marlin = !printer.several_commands && !printer.velocity_limit;
        let is_file = printer
            .may_heat
            .iter()
            .any(|one| one.is_code(letter, number));
        let mover = if is_file {
            Mover::File
        } else if marlin && letter == b'G' && WAITED_FOR.contains(&number) {
            Mover::FirmwareWaiting
        } else {
            Mover::Firmware
        };
        self.unknown_moves(run, span, mover);
    }

    /// Moves that only the machine knows: every axis at its full speed and
    /// acceleration, and from then on in an unknown place.
    pub(super) fn unknown_moves(&mut self, run: &mut Run<'_, '_>, span: Span, mover: Mover) {
        if mover == Mover::File {
            self.may_heat(run, span);
        }
        let name = String::from_utf8_lossy(span.of(run.report.text)).into_owned();
        let message = format!(
            "{name} moves in a way that only the machine knows: \
             every axis counts at its full speed and acceleration"
        );
        run.report.note_once("unknown-moves", &message, span);
        note_levelling_if(run, &name, span);
        if mover == Mover::File {
            self.may_set_limits(run, span);
            run.facts.fixed.get_or_insert(RUNS_A_FILE);
        } else {
            run.facts.own_feed = Some(OWN_MOVES);
        }
        // From rest to rest, or no moves at all.
        let rests = mover == Mover::FirmwareWaiting && self.printer.stands;
        self.at_full_speed(run, self.machine.axis_set);
        self.printer.stands = rests;
        let end = if rests {
            ActionKind::Rest
        } else {
            ActionKind::MayStop
        };
        run.act(end, 0.0);
    }

    /// G28: each group of axes from an unknown place to its endstops.
    ///
    /// The axes stand before and after each of these moves: an endstop ends it, and where
    /// that is becomes the position.
    ///
    /// Source: Marlin G28 (no axis: all of X Y Z), Klipper G28, `RepRapFirmware` G28.
    pub(super) fn home(&mut self, run: &mut Run<'_, '_>, parameters: &Parameters, span: Span) {
        run.facts.reference = Some(1);
        run.facts.homes = true;
        let mut named = AxisSet::default();
        for parameter in parameters {
            if let Some(axis) = AxisId::from_letter(parameter.letter) {
                named.insert(axis as usize);
            }
        }
        named.0 &= self.machine.axis_set.0 & !(1 << EXTRUDER);
        if named.is_empty() {
            named = AxisSet(self.machine.axis_set.0 & !(1 << EXTRUDER));
        }
        let mut left = named;
        let groups = self
            .machine
            .controller
            .language
            .printer
            .home_together
            .clone();
        for group in groups.into_iter().chain([AxisSet(u16::MAX)]) {
            let group = AxisSet(group.0 & left.0);
            left.0 &= !group.0;
            if !group.is_empty() {
                self.home_group(run, group);
            }
        }
        for axis in named.iter() {
            let home = self.machine.axes[axis].and_then(|data| data.reference_mm);
            self.position.home(axis, home.unwrap_or(0.0));
            if home.is_none() {
                self.position.unknown.insert(axis);
                let message = "without `reference_mm` of its axis in the machine file, where G28 ends \
                               is not known: the power of the next moves counts from anywhere, \
                               their time from 0";
                run.report.note_once("home", message, span);
            }
        }
        // Homing makes the machine coordinate known; how far the program's are from it is not.
        self.position.unknown.0 |= named.0 & self.printer.shifted.0;
        self.home_moves(run, span);
        self.printer.stands = true;
    }

    /// What homing moves besides the axes that it homes.
    fn home_moves(&mut self, run: &mut Run<'_, '_>, span: Span) {
        let machine = self.machine;
        for group in &machine.controller.language.printer.home_moves {
            let group = AxisSet(group.0 & machine.axis_set.0);
            if group.is_empty() {
                continue;
            }
            self.home_group(run, group);
            self.position.unknown.0 |= group.0;
            let message = "G28 moves axes besides homing them (`home_moves` of the machine file): the \
                           power of the next moves counts from anywhere";
            run.report.note_once("home", message, span);
        }
    }

    fn home_group(&mut self, run: &mut Run<'_, '_>, group: AxisSet) {
        let speeds = group
            .iter()
            .filter_map(|axis| Some(self.machine.axes[axis].as_ref()?.reference_mm_s));
        let feed_mm_s = speeds.fold(0.0, f64::max);
        let mut end = self.position.at;
        for axis in group.iter() {
            end[axis] = self.machine.axes[axis]
                .and_then(|data| data.reference_mm)
                .unwrap_or(0.0);
        }
        run.act(ActionKind::Rest, 0.0);
        self.go_at(run, &end, group, Some(feed_mm_s));
        run.act(ActionKind::Rest, 0.0);
    }

    /// The coordinates shift: the next absolute move of the axes named, of all
    /// without names, comes from an unknown place.
    pub(super) fn shift_axes(&mut self, parameters: &Parameters) {
        let mut named = AxisSet::default();
        for parameter in parameters {
            if let Some(axis) = AxisId::from_letter(parameter.letter) {
                named.insert(axis as usize);
            }
        }
        named.0 &= self.machine.axis_set.0;
        if named.is_empty() {
            named = self.machine.axis_set;
        }
        self.position.unknown.0 |= named.0;
        self.printer.shifted.0 |= named.0;
    }

    /// T0 to T9: another tool than the one in use comes by unknown moves.
    pub(super) fn tool(&mut self, run: &mut Run<'_, '_>, number: u16, span: Span) {
        let tool = u32::from(number / 10);
        run.facts.boundary = true;
        run.act(ActionKind::ToolSelect, f64::from(tool));
        if tool != self.printer.tool {
            self.printer.tool = tool;
            self.printer.several_tools = true;
            self.listed_moves(run, (b'T', number, span));
        }
    }
}

/// Probing commands switch the correction of the bed on.
fn note_levelling_if(run: &mut Run<'_, '_>, name: &str, span: Span) {
    let name = name.to_ascii_uppercase();
    if name == "G29" || name == "G32" || name.starts_with("BED_MESH") {
        note_levelling(run, span);
    }
}

#[cfg(test)]
mod tests {
    use crate::printer::testing::execute;
    use gwatt_motion::{ActionKind, Step};

    /// What comes last in a program on Marlin.
    fn last(lines: &[&str]) -> Option<ActionKind> {
        let (steps, found) = execute("marlin", "", lines);
        assert_eq!(found.errors, 0, "{:?}", found.list);
        steps.iter().rev().find_map(|step| match step {
            Step::Action(action) => Some(action.kind),
            Step::Move(_) => None,
        })
    }

    #[test]
    fn probing_ends_at_rest_where_it_begins_so() {
        assert_eq!(last(&["G28", "G29"]), Some(ActionKind::Rest));
        assert_eq!(last(&["G28", "G29", "G30"]), Some(ActionKind::Rest));
        // It may move nothing, and the move before it goes on then.
        let moving = last(&["G28", "G1 X5 F600", "G29"]);
        assert_eq!(moving, Some(ActionKind::MayStop));
        // The firmware does not wait for these.
        for word in ["G42 I3 J3", "G26", "M600"] {
            assert_eq!(last(&["G28", word]), Some(ActionKind::MayStop), "{word}");
        }
    }
}
