//! Extended commands: a name, then `KEY=value`.
//!
//! Source: Klipper documentation, "G-Codes". `RepRapFirmware` has `if`,
//! `while`, `var` and the like at the beginning of a line (Duet documentation,
//! "Meta commands"); they are refused by name.

use super::kept::Back;
use super::left_out::{note_advance, note_levelling};
use super::line::{Parameters, Text};
use super::position::Mover;
use super::second_drive::{refuse_second_drive, second_drive};
use crate::control::{Control, Run};
use crate::flow::library;
use crate::jump::Transfer;
use crate::places::EXTRUDER;
use gwatt_machine::{Command, QueueEffect};
use gwatt_motion::ActionKind;
use gwatt_syntax::source::Span;

/// Words of `RepRapFirmware`'s conditional language.
const META: [&str; 11] = [
    "if", "elif", "else", "while", "break", "continue", "var", "global", "set", "abort", "skip",
];

impl Control<'_> {
    /// Executes an extended command.
    pub(super) fn named(
        &mut self,
        run: &mut Run<'_, '_>,
        text: Text<'_>,
        name: &[u8],
        span: Span,
        at: usize,
    ) {
        let printer = &self.machine.controller.language.printer;
        let listed = |list: &[Command]| list.iter().any(|one| one.is_macro(name));
        let whole = |list: &[Command]| {
            let mut names = list.iter().filter(|one| matches!(one, Command::Macro(_)));
            names.any(|one| one.is_macro(name))
        };
        // A name says more than the beginning of one.
        let unknown = whole(&printer.unknown_moves) || whole(&printer.unknown_macros);
        let unknown = unknown && !whole(&printer.ignored_macros);
        let upper = name.to_ascii_uppercase();
        let upper = upper.as_slice();
        if let Some(what) = second_drive(text, upper, at) {
            return refuse_second_drive(run, what, span);
        }
        let shifts = listed(&printer.shifts);
        let moves = shifts && text.argument(at, "MOVE").is_some_and(|value| value != b"0");
        if listed(&printer.ignored_macros) && !unknown {
            match upper {
                b"SET_PRESSURE_ADVANCE" => note_advance(run, span),
                b"BED_MESH_PROFILE" => {
                    note_levelling(run, span);
                    self.shift_axes(&Parameters::new());
                }
                _ => {}
            }
            self.act_by_name(run, name);
        } else if moves || listed(&printer.unknown_moves) {
            let mover = if listed(&printer.may_heat) {
                Mover::File
            } else {
                Mover::Firmware
            };
            self.unknown_moves(run, span, mover);
        } else if shifts {
            self.shift_axes(&Parameters::new());
            self.act_by_name(run, name);
        } else if listed(&printer.unknown_macros) && !self.has_file(name) {
            self.unknown_macro(run, span);
        } else if !(printer.velocity_limit && self.klipper(run, text, upper, span, at)) {
            self.macro_file(run, name, span);
        }
    }

    /// Reports a command, by whether the axes move on at it.
    fn act_by_name(&self, run: &mut Run<'_, '_>, name: &[u8]) {
        let kind = match self.machine.controller.queue.effect_of_name(name) {
            Some(QueueEffect::Stop) => ActionKind::Rest,
            Some(QueueEffect::Pass | QueueEffect::Join) => ActionKind::Other,
            Some(QueueEffect::StopOnChange) | None => ActionKind::MayStop,
        };
        run.act(kind, 0.0);
    }

    /// Whether the profile or the machine file says what a command of this name does.
    pub(super) fn lists(&self, name: &[u8]) -> bool {
        let printer = &self.machine.controller.language.printer;
        let lists = [
            &printer.ignored_macros,
            &printer.unknown_moves,
            &printer.unknown_macros,
        ];
        lists.into_iter().flatten().any(|one| one.is_macro(name))
    }

    /// A name that the profile does not know: what its file says, if there is one.
    pub(super) fn macro_file(&mut self, run: &mut Run<'_, '_>, name: &[u8], span: Span) {
        if self.has_file(name) {
            let name = String::from_utf8_lossy(name).to_ascii_uppercase();
            self.transfer = Some(Transfer::Macro(name));
            run.facts.transfers = true;
        } else {
            refuse_name(run, &name.to_ascii_uppercase(), span);
        }
    }

    /// Whether a file says what the macro of this name does.
    pub(super) fn has_file(&self, name: &[u8]) -> bool {
        let plain = |byte: &u8| byte.is_ascii_alphanumeric() || *byte == b'_';
        let files = library::macro_files(&String::from_utf8_lossy(name).to_ascii_uppercase());
        name.iter().all(plain)
            && !is_meta(name)
            && library::find_named(&self.printer.sub_paths, &files).is_some()
    }

    /// Klipper's commands that set something; false for others.
    fn klipper(
        &mut self,
        run: &mut Run<'_, '_>,
        text: Text<'_>,
        name: &[u8],
        span: Span,
        at: usize,
    ) -> bool {
        let state = || text.argument(at, "NAME").unwrap_or(b"default").to_vec();
        match name {
            b"SET_VELOCITY_LIMIT" => {
                const KEYS: [&str; 5] = [
                    "VELOCITY",
                    "ACCEL",
                    "SQUARE_CORNER_VELOCITY",
                    "MINIMUM_CRUISE_RATIO",
                    "ACCEL_TO_DECEL",
                ];
                let [velocity, accel, corner, ratio, to_decel] =
                    KEYS.map(|key| text.number_argument(at, key));
                let (Ok(velocity), Ok(accel), Ok(corner), Ok(ratio), Ok(to_decel)) =
                    (velocity, accel, corner, ratio, to_decel)
                else {
                    Self::bad_value(
                        run,
                        span,
                        "write numbers after VELOCITY, ACCEL and the like",
                    );
                    return true;
                };
                self.limit_velocity(run, velocity, accel, span);
                let ratio = ratio.or_else(|| {
                    let [x, y, ..] = self.knobs.feed_accel_mm_s2;
                    let most = self.knobs.path_accel_mm_s2[0].min(x.max(y));
                    let asked = to_decel.map(|accel| 1.0 - (accel / most).min(1.0));
                    // Versions from August 2025 on do not read it: the faster of both counts.
                    asked.map(|asked| asked.min(self.cruise_ratio()))
                });
                if corner.is_some() || ratio.is_some() {
                    self.limit_corners(run, corner, ratio, span);
                }
                return true;
            }
            b"RESET_VELOCITY_LIMIT" => {
                self.reset_velocity(run);
                return true;
            }
            b"SET_RETRACTION" => self.set_retraction(run, text, span, at),
            b"SAVE_GCODE_STATE" => self.save_state(run, state(), span),
            b"RESTORE_GCODE_STATE" => {
                let moves = text.argument(at, "MOVE").is_some_and(|value| value != b"0");
                let back = match text.number_argument(at, "MOVE_SPEED") {
                    _ if !moves => Back::No,
                    Ok(None) => Back::AtFeed,
                    Ok(Some(speed)) if speed > 0.0 => Back::At(speed),
                    _ => {
                        Self::bad_value(run, span, "write a speed above 0");
                        return true;
                    }
                };
                self.restore_state(run, &state(), back, span);
            }
            b"SET_HEATER_TEMPERATURE" => self.set_heater(run, text, at, span),
            b"SET_FAN_SPEED" => self.set_fan(run, text, at, span),
            b"TURN_OFF_HEATERS" => self.turn_off_heaters(),
            b"SET_EXTRUDER_ROTATION_DISTANCE" => {
                if let Ok(Some(distance)) = text.number_argument(at, "DISTANCE") {
                    self.steps_of(run, EXTRUDER, distance, span);
                }
            }
            b"ACTIVATE_EXTRUDER" => {
                // Another extruder has another place, and begins with M221 S100.
                self.position.unknown.insert(EXTRUDER);
                self.printer.flow = self.printer.flow.max(1.0);
                self.settle();
                run.facts.boundary = true;
            }
            _ => return false,
        }
        self.act_by_name(run, name);
        true
    }

    /// `SET_RETRACTION`: lengths in mm, speeds in mm/s.
    fn set_retraction(&mut self, run: &mut Run<'_, '_>, text: Text<'_>, span: Span, at: usize) {
        let mut retract = self.printer.retract;
        let fields = [
            ("RETRACT_LENGTH", &mut retract.length_mm),
            ("RETRACT_SPEED", &mut retract.speed_mm_s),
            ("UNRETRACT_EXTRA_LENGTH", &mut retract.extra_mm),
            ("UNRETRACT_SPEED", &mut retract.recover_mm_s),
        ];
        for (key, field) in fields {
            match text.number_argument(at, key) {
                Ok(None) => {}
                Ok(Some(value)) => *field = value,
                Err(_) => return Self::bad_value(run, span, "write numbers after the keys"),
            }
        }
        self.take_retract(run, retract, span);
        self.printer.retracted = false;
    }
}

/// Whether it is a word of `RepRapFirmware`'s conditional language.
fn is_meta(name: &[u8]) -> bool {
    let mut words = META.iter();
    words.any(|word| word.as_bytes().eq_ignore_ascii_case(name))
}

fn refuse_name(run: &mut Run<'_, '_>, name: &[u8], span: Span) {
    let shown = gwatt_syntax::diagnostic::excerpt(span.of(run.report.text), 60);
    if is_meta(name) {
        let message = format!("`{shown}`: branches, loops and variables are not supported");
        run.report
            .error("meta-command", message, span)
            .help("write the blocks out in the order in which they are executed");
        return;
    }
    let message = format!("`{shown}` is a macro or a command that this profile does not know");
    run.report.error("unknown-macro", message, span).help(format!(
        "write what it comes to into a file {shown}.gcode in the program's folder or one given by \
         --sub-path; or in the machine file, under [language], list it in `ignored_macros` if it \
         moves nothing and sets nothing, or in `unknown_moves` if it moves and leaves feed and \
         modes as they are, or in `unknown_macros` if nothing is known of it"
    ));
}
