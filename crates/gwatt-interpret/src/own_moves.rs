//! Moves that a machine makes of itself: at a tool change, and by words of its builder.

use super::control::{Control, Run};
use super::facts::MOVES_OF_ITSELF;
use super::letters::AXIS_LETTERS;
use gwatt_machine::AxisSet;
use gwatt_motion::{ActionKind, MoveKind};
use gwatt_syntax::source::Span;

impl Control<'_> {
    /// M6 sends the axes that the machine file names to their reference points, straight from
    /// where they are; one that is there stays. Where the control keeps such points itself, they
    /// end in an unknown place.
    pub(super) fn tool_change_moves(&mut self, span: Span, run: &mut Run<'_, '_>) {
        let language = &self.machine.controller.language;
        let Some(named) = language.tool_change_moves else {
            if language.tool_change.is_none() {
                let message = "M6 is taken to move no axis: tool_change_moves under [language] of \
                               the machine file names those that it moves";
                run.report.note_once("tool-change-moves", message, span);
            }
            return;
        };
        let named = AxisSet(named.0 & self.machine.axis_set.0);
        if named.is_empty() {
            return;
        }
        run.facts.boundary = true;
        if self.rules.places_in_parameters {
            // LinuxCNC: to zero of the machine, or to wherever the INI file says.
            run.facts.fixed.get_or_insert(MOVES_OF_ITSELF);
            return self.at_full_speed(run, named);
        }
        let (place, unknown) = self.reference_point(1, named, span, run);
        let mut end = self.position.at;
        for axis in named.iter() {
            end[axis] = place[axis];
        }
        if unknown.is_empty() && end == self.position.at {
            return;
        }
        // Axes that have gone before the change are commanded too.
        if run.words.present & AXIS_LETTERS == 0 {
            run.facts.reference = Some(1);
        } else {
            run.facts.fixed.get_or_insert(MOVES_OF_ITSELF);
        }
        self.go(run, MoveKind::Rapid, &end, unknown, None);
    }

    /// These axes at their full speed and acceleration, and from then on in an unknown place.
    pub(crate) fn at_full_speed(&mut self, run: &mut Run<'_, '_>, axes: AxisSet) {
        run.facts.boundary = true;
        let end = self.position.at;
        self.go_at(run, &end, axes, Some(f64::INFINITY));
        self.position.unknown.0 |= axes.0;
    }

    /// Whether a word (number × 10) is one whose moves the machine file does not describe.
    pub(super) fn moves_of_itself(&self, letter: u8, number: u16) -> bool {
        let moving = &self.machine.controller.language.unknown_moves;
        moving.contains(&(letter, number))
    }

    /// A word of the machine's builder that moves axes: each at its full speed and acceleration,
    /// and from then on in an unknown place.
    pub(super) fn builder_moves(&mut self, number: u16, span: Span, run: &mut Run<'_, '_>) {
        let name = String::from_utf8_lossy(span.of(run.report.text)).into_owned();
        if run.words.has_axes() {
            let message = format!("the block moves axes next to {name}, whose moves are not known");
            let help = "write it on a line of its own";
            run.report.error("unknown-moves", message, span).help(help);
            return;
        }
        let message = format!(
            "{name} moves in a way that the machine file does not describe: every axis counts at \
             its full speed and acceleration"
        );
        run.report.note_once("unknown-moves", &message, span);
        run.facts.fixed = Some(MOVES_OF_ITSELF);
        self.forget_way_back();
        self.at_full_speed(run, self.machine.axis_set);
        run.act(ActionKind::Other, f64::from(number) / 10.0);
        // Its arguments.
        run.words.unused = 0;
    }
}
