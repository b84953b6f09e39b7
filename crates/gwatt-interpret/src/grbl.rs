//! grbl's lines that begin with `$` ("Commands", "Configuration v1.1"), and what it takes out
//! of others before it reads them.

use super::code::Motion;
use super::control::{Control, Run};
use super::report::Report;
use crate::rules::Macros;
use gwatt_machine::units::SECONDS_PER_MINUTE;
use gwatt_machine::{CornerRule, LaserMode};
use gwatt_motion::{ActionKind, FeedMode};
use gwatt_syntax::{Block, Issue, IssueKind, MAX_ISSUES};

/// Commands that show something or unlock, and move nothing.
const IDLE: [&str; 6] = ["$X", "$$", "$#", "$G", "$I", "$N"];
/// Settings that change no move: pulses, reports, limit switches, homing, the
/// scale of the spindle, travel.
const IDLE_SETTINGS: [u32; 22] = [
    0, 1, 4, 5, 6, 10, 13, 20, 21, 22, 24, 25, 26, 27, 30, 31, 130, 131, 132, 133, 134, 135,
];

/// Relative difference of figures that are the same in other units.
const ROUNDING: f64 = 1e-9;

/// What a byte asks of grbl at once; `?` only asks for its state.
fn realtime(byte: u8) -> Option<&'static str> {
    match byte {
        b'!' => Some("`!` is grbl's feed hold"),
        b'~' => Some("`~` is grbl's cycle start"),
        0x18 => Some("the byte 0x18 is grbl's reset"),
        _ => None,
    }
}

impl Control<'_> {
    pub(super) fn is_grbl(&self) -> bool {
        self.rules.macros == Macros::OWords && self.machine.controller.language.loose_o_words
    }

    /// M2 and M30 reset these modes; grbl then goes on with what follows (`gcode.c`, "Program
    /// flow").
    pub(super) fn reset_modes(&mut self, run: &mut Run<'_, '_>) {
        self.goes_on = true;
        let modal = &mut self.modal;
        (modal.motion, modal.plane, modal.absolute) = (Motion::Linear, [0, 1, 2], true);
        (modal.feed_mode, modal.feed_mode_word) = (FeedMode::PerMinute, 940);
        let whole = run.whole();
        self.select_system(1, whole, run);
        self.special.turn_spindle(50);
        for number in [50, 90] {
            self.switch_loads(f64::from(number) / 10.0);
            self.switches.switch(number);
        }
        // grblHAL: "the end of a program restores" its profile of accelerations.
        for knob in &self.machine.controller.knobs {
            if let Some(levels) = &knob.levels {
                self.knobs.select(self.machine, knob, Some(levels.power_on));
                run.facts.turns_knob = true;
            }
        }
    }

    /// Whether a line is a command of grbl.
    pub(super) fn is_dollar(&self, text: &[u8]) -> bool {
        self.is_grbl() && text.trim_ascii_start().starts_with(b"$")
    }

    /// Reads a block that is more than plain words: without what grbl takes out of a line
    /// before it reads it (`protocol.c`, `serial.c`).
    pub(super) fn line_of_grbl(&mut self, block: &mut Block, report: &mut Report<'_, '_>) -> bool {
        let issues = block.issues.len();
        if !self.is_grbl() || issues == 0 || issues >= MAX_ISSUES {
            return self.macro_words(block, report);
        }
        let text = report.text;
        for issue in &block.issues {
            let found = issue.span.of(text).iter().find_map(|byte| realtime(*byte));
            if let Some(what) = found.filter(|_| issue.kind == IssueKind::UnknownText) {
                let message = format!("{what}, which acts when it arrives, not where it stands");
                report
                    .error("real-time", message, issue.span)
                    .help("take it out of the program");
                return false;
            }
        }
        // A comment that is not closed ends with its line.
        let open = |issue: &Issue| issue.kind == IssueKind::UnclosedComment;
        let end = block.text_end;
        if let Some(comment) = block.issues.iter().find(|issue| open(issue)) {
            block.text_end = comment.span.start;
            block.issues.retain(|issue| !open(issue));
        }
        let asks = |issue: &Issue| {
            let bytes = issue.span.of(text);
            issue.kind == IssueKind::UnknownText && bytes.iter().all(|byte| *byte == b'?')
        };
        if block.issues.iter().all(asks) {
            block.issues.clear();
        }
        let transfers = !block.issues.is_empty() && self.macro_words(block, report);
        block.text_end = end;
        transfers
    }

    /// Executes it.
    pub(super) fn dollar(&mut self, run: &mut Run<'_, '_>) {
        run.facts.executed = true;
        self.begun = true;
        let line = run.report.text.trim_ascii();
        let end = line.iter().position(|byte| matches!(byte, b'(' | b';'));
        let command = line.get(..end.unwrap_or(line.len())).unwrap_or_default();
        let command = String::from_utf8_lossy(command).to_ascii_uppercase();
        let command = command.trim_end();
        if command == "$H" {
            return self.home_all(run);
        }
        if IDLE.contains(&command) {
            return;
        }
        let whole = run.whole();
        let setting = command.strip_prefix('$').and_then(|it| it.split_once('='));
        let number = setting.and_then(|(number, _)| number.trim().parse().ok());
        let value = setting.and_then(|(_, value)| value.trim().parse::<f64>().ok());
        match number {
            Some(number) if IDLE_SETTINGS.contains(&number) => {}
            Some(number) if value.is_some_and(|value| self.is_covered(number, value)) => {
                let message = "settings count as the machine file has them: it has no less";
                run.report.note_once("setting", message, whole);
            }
            Some(number) => {
                let message =
                    format!("${number} is a setting that may change how the machine moves");
                run.report.error("setting", message, whole).help(
                    "send settings apart from the program, and put what they say into the \
                     machine file",
                );
            }
            None => {
                let message = format!("{command} is a command of grbl that gwatt does not follow");
                run.report
                    .error("setting", message, whole)
                    .help("send it apart from the program");
            }
        }
    }

    /// Whether what a setting permits is no more than what the machine file does: grbl may take
    /// it or, while it moves, refuse it.
    fn is_covered(&self, number: u32, value: f64) -> bool {
        let axis = |first: u32| {
            let index = usize::try_from(number - first).ok()?;
            self.machine.axes.get(index)?.as_ref()
        };
        let most = match number {
            // Laser mode: 1 is on.
            32 => {
                return match self.machine.controller.queue.laser_mode {
                    LaserMode::Off => value == 0.0,
                    LaserMode::On => value == 1.0,
                    LaserMode::Unknown => matches!(value, 0.0 | 1.0),
                };
            }
            11 => match self
                .machine
                .controller
                .planner
                .look_ahead
                .map(|it| it.corner)
            {
                Some(CornerRule::JunctionDeviation { deviation_mm, .. }) => Some(deviation_mm),
                _ => None,
            },
            110..=115 => axis(110).map(|data| data.rapid_mm_s * SECONDS_PER_MINUTE),
            120..=125 => axis(120).map(|data| data.accel_mm_s2),
            _ => None,
        };
        most.is_some_and(|most| (0.0..=most * (1.0 + ROUNDING)).contains(&value))
    }

    /// `$H`: from anywhere to the limit switches, at a speed of the settings. All axes
    /// count as moving at once.
    fn home_all(&mut self, run: &mut Run<'_, '_>) {
        let whole = run.whole();
        let axes = || {
            self.machine
                .axis_set
                .iter()
                .map(|axis| self.machine.axes[axis].as_ref())
        };
        let square = |speed_mm_s: f64| speed_mm_s * speed_mm_s;
        let squares = axes().map(|data| data.map_or(0.0, |it| square(it.reference_mm_s)));
        let speed_mm_s = squares.sum::<f64>().sqrt();
        if speed_mm_s.is_infinite() {
            let message = "without `reference_mm_min` of its axes in the machine file, how fast $H homes \
                           is not known: every axis counts at its full speed and acceleration";
            run.report.note_once("unknown-moves", message, whole);
        }
        run.facts.reference = Some(1);
        run.facts.boundary = true;
        run.facts.fixed = Some("it homes the axes");
        let all = self.machine.axis_set;
        let end = self.position.at;
        // grbl takes $H only while it is idle, and goes on once the axes stand.
        run.act(ActionKind::Rest, 0.0);
        self.go_at(run, &end, all, Some(speed_mm_s));
        for axis in all.iter() {
            let reference_mm = self.machine.axes[axis]
                .as_ref()
                .and_then(|data| data.reference_mm);
            if let Some(reference_mm) = reference_mm {
                self.position.home(axis, reference_mm);
            } else {
                self.position.unknown.insert(axis);
                let message = "without `reference_mm` of its axis in the machine file, where $H ends is \
                               not known: the power of the next moves counts from anywhere";
                run.report.note_once("home", message, whole);
            }
        }
        run.act(ActionKind::Rest, 0.0);
    }
}
