//! Macros of the machine, of which nothing is known, and what they leave unstated.

use super::position::Mover;
use super::state::Unstated;
use crate::code::Motion;
use crate::control::{Control, Run};
use crate::facts::SETS_UNKNOWN;
use crate::knob::KnobState;
use crate::places::EXTRUDER;
use gwatt_machine::{ALL_AXES, ExtruderMode};
use gwatt_syntax::source::Span;

impl Control<'_> {
    /// A macro of which only the machine knows what it does: it may move anywhere, heat, and
    /// leave another feed, other modes and the limits of the machine file.
    pub(super) fn unknown_macro(&mut self, run: &mut Run<'_, '_>, span: Span) {
        let factors = &mut self.printer;
        factors.feed_factor = factors.feed_factor.max(1.0);
        factors.flow = factors.flow.max(1.0);
        run.facts.fixed = Some(SETS_UNKNOWN);
        self.unknown_moves(run, span, Mover::File);
        self.modal.feed = None;
        self.modal.motion = Motion::None;
        self.printer.unstated = Unstated::of(true, true);
        self.settle();
    }

    /// A file or a macro of the machine, under whose limits its own moves run too: those of the
    /// machine file count, or those in force where they are higher.
    pub(super) fn may_set_limits(&mut self, run: &mut Run<'_, '_>, span: Span) {
        run.facts.turns_knob = true;
        self.limits_at_least(&KnobState::new(self.machine));
        let name = String::from_utf8_lossy(span.of(run.report.text)).into_owned();
        let message = format!(
            "what {name} sets only the machine knows: until the program sets them after it, limits \
             count as the machine file gives them, or as before where that is more; a file \
             {name}.gcode in the program's folder says what it does"
        );
        run.report.note_once("macro-settings", &message, span);
    }

    /// Limits that are those in force or these: the higher ones count.
    pub(super) fn limits_at_least(&mut self, other: &KnobState) {
        self.knobs.raise_to(self.machine, other);
        self.corners_at_least(other.corner);
        self.settle();
    }

    /// G90 or G91.
    pub(crate) fn distance_stated(&mut self) {
        let follows = ExtruderMode::Follows;
        let unstated = &mut self.printer.unstated;
        unstated.distance = false;
        unstated.extruder &= self.machine.controller.language.printer.extruder_mode != follows;
        self.extruder_mode(None);
        self.settle();
    }

    /// M82 or M83.
    pub(crate) fn extruder_stated(&mut self, absolute: bool) {
        self.printer.unstated.extruder = false;
        self.extruder_mode(Some(absolute));
        self.settle();
    }

    /// Reports words of axes of which nobody knows whether they are absolute; true if it did.
    #[cold]
    pub(crate) fn refuses_unstated(&mut self, run: &mut Run<'_, '_>) -> bool {
        let mode = self.machine.controller.language.printer.extruder_mode;
        let unstated = self.printer.unstated;
        let words: arrayvec::ArrayVec<_, { gwatt_machine::AXES }> = run.words.axes().collect();
        for (axis, _) in words {
            let missing = if axis != EXTRUDER || mode == ExtruderMode::Either {
                unstated.distance.then_some("G90 or G91")
            } else {
                None
            };
            let own = unstated.extruder && (mode != ExtruderMode::Either || self.modal.absolute);
            let missing = missing.or((axis == EXTRUDER && own).then_some("M82 or M83"));
            let Some(missing) = missing else { continue };
            let letter = ALL_AXES[axis].letter();
            let message = format!(
                "whether {} is absolute is not known after a macro of the machine",
                char::from(letter)
            );
            let help = format!(
                "write {missing} after the macro, or the macro's commands into a file of its name; \
                 if it leaves feed and modes as they are, list it in `unknown_moves` under \
                 [language] of the machine file"
            );
            let span = run.words.span(letter, run.block);
            run.report.error("unstated-mode", message, span).help(help);
            // Once is enough.
            self.printer.unstated = Unstated::default();
            self.settle();
            return true;
        }
        false
    }

    /// Whether a macro has left modes that are not stated yet.
    #[inline]
    pub(crate) fn has_unstated(&self) -> bool {
        self.printer.adjusts && self.printer.unstated.any()
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::execute;
    use gwatt_motion::Step;

    /// How many moves the lines make, and what is said of them.
    fn moves(controller: &str, language: &str, lines: &[&str]) -> (usize, Vec<&'static str>) {
        let rest = format!("[language]\n{language}\n");
        let (steps, diagnostics) = execute(controller, &rest, lines);
        let moves = steps.iter().filter(|step| matches!(step, Step::Move(_)));
        let rules = diagnostics.list.iter().map(|it| it.rule).collect();
        (moves.count(), rules)
    }

    const MACRO: [&str; 2] = ["unknown-moves", "macro-settings"];

    /// The firmware's own meaning of a word, its text included, gives way to the machine file's.
    #[test]
    fn a_macro_in_place_of_a_word_counts_as_one() {
        for word in [
            "T0",
            "T1",
            "M900 K0.1",
            "M73 P5",
            "M117 Layer 3",
            "M106 S255",
            "M600",
            "G28",
        ] {
            let name = word.split(' ').next().unwrap();
            let list = format!("unknown_macros = [\"{name}\"]");
            let (count, rules) = moves("klipper", &list, &[word]);
            assert_eq!(count, 1, "{word}");
            assert!(
                MACRO.iter().all(|rule| rules.contains(rule)),
                "{word}: {rules:?}"
            );
            let list = format!("unknown_moves = [\"{name}\"]");
            let (count, rules) = moves("klipper", &list, &[word, "G1 X5 F600"]);
            assert_eq!(count, 2, "{word}");
            assert!(
                rules.contains(&"unknown-moves") && !rules.contains(&"unstated-mode"),
                "{word}"
            );
        }
        let plain = ["T0", "M900 K0.1", "M73 P5", "M117 Layer 3", "M106 S255"];
        assert_eq!(moves("klipper", "", &plain).0, 0);
    }

    /// A word of motion that is a macro is none of motion any more.
    #[test]
    fn a_macro_in_place_of_g1() {
        let (count, rules) = moves(
            "klipper",
            "unknown_macros = [\"G1\"]",
            &["G0 X5 F600", "G1 X9"],
        );
        assert_eq!(count, 2);
        assert!(MACRO.iter().all(|rule| rules.contains(rule)), "{rules:?}");
    }

    #[test]
    fn what_the_machine_file_passes_over_moves_nothing() {
        let passed = "ignored = [\"M600\"]\nignored_macros = [\"T1\", \"PRINT_*\"]";
        let lines = ["M600", "T1", "PRINT_START A=1", "G1 X5 F600"];
        assert_eq!(moves("klipper", passed, &lines).0, 1);
        // A whole name says more than a beginning, wherever it stands.
        let own = "unknown_macros = [\"SET_LED_PARK\", \"SET_GCODE_OFFSET\"]";
        assert_eq!(moves("klipper", own, &["SET_LED_PARK"]).0, 1);
        assert_eq!(moves("klipper", own, &["SET_GCODE_OFFSET Z=1"]).0, 1);
        assert_eq!(moves("klipper", own, &["SET_LED_X"]).0, 0);
    }

    /// The tool after one that a macro changes to is another one.
    #[test]
    fn a_tool_after_a_macro_of_a_tool() {
        assert_eq!(
            moves("marlin", "unknown_macros = [\"T1\"]", &["T1", "T0"]).0,
            2
        );
    }

    /// X homes; X goes to where Z is probed, and from there to anywhere.
    #[test]
    fn what_homing_moves_besides() {
        let rest = "[language]\nhome_moves = [[\"Z\"], [\"X\", \"Y\"]]\n";
        let (steps, diagnostics) = execute("klipper", rest, &["G28", "G1 X5 F600"]);
        let moves: Vec<_> = steps
            .iter()
            .filter_map(|step| match step {
                Step::Move(mv) => Some(mv.unknown_start),
                Step::Action(_) => None,
            })
            .collect();
        assert_eq!(moves.len(), 3);
        assert!(moves.iter().all(|unknown| !unknown.is_empty()), "{moves:?}");
        assert!(diagnostics.list.iter().any(|it| it.rule == "home"));
    }
}
