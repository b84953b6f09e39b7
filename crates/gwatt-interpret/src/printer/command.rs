//! What a command does: which of its readers takes it, in which order.

use super::early::rises;
use super::left_out::{note_levelling, note_uncounted};
use super::line::{Head, Parameters, Text, has, holds_word, value};
use super::position::Mover;
use super::second_drive::{SECOND_CARRIAGE, refuse_second_drive};
use super::verify_checksum;
use crate::code::{GCode, Motion};
use crate::control::{Control, Run};
use crate::report::Report;
use crate::tools::ToolLength;
use gwatt_machine::Command;
use gwatt_motion::{ActionKind, Step};
use gwatt_syntax::source::Span;

/// Most commands that a line may hold.
const COMMANDS: usize = 32;

impl Control<'_> {
    /// Executes a line of commands. Nothing that it does remains if it has an
    /// error.
    pub(crate) fn command_line(&mut self, run: &mut Run<'_, '_>) {
        let before = run.steps.len();
        let errors = run.report.diagnostics.errors;
        run.facts.executed = true;
        // Klipper: no command has such a name; texts copied from printer.cfg have comments of this
        // kind. Older versions take a word after it for the command.
        if self.names_parameters() && self.is_hash_comment(run.report.text) {
            return;
        }
        let mut text = Text::new(run.report.text, run.block.text_end as usize);
        if let Some(star) = text.checksum {
            run.facts.checksum = true;
            verify_checksum(star, &self.machine.controller, &mut run.report);
        }
        for index in 0..COMMANDS {
            let so_far = run.steps.len();
            let pending = self.printer.pending;
            let acts_early = self.machine.controller.language.printer.early_limits;
            let early = !pending.is_empty() && acts_early;
            let limits = early.then(|| self.knobs.clone());
            let factors = [self.printer.feed_factor, self.printer.flow];
            let next = self.one_command(run, text, index > 0);
            self.loads.settle(run.steps.iter().skip(so_far));
            let moves = |steps: &[Step]| steps.iter().any(|step| matches!(step, Step::Move(_)));
            // The firmware waits for the axes before it runs a file that may set limits.
            let own = run.steps.get(so_far..).unwrap_or_default();
            let limits = limits.filter(|before| *before != self.knobs && !moves(own));
            if let Some(before) = limits {
                for (limits, factor) in rises(self.machine, pending, &before, &self.knobs) {
                    run.act(ActionKind::EarlyLimits(limits), factor);
                }
            }
            if early && !self.printer.stands {
                self.early_factors(run, factors);
            }
            let (earlier, own) = run.steps.split_at_checked(so_far).unwrap_or_default();
            if index > 0 && moves(own) && earlier.get(before..).is_some_and(moves) {
                run.facts.fixed = Some("its line holds several commands that move");
            }
            let Some(next) = next.filter(|_| run.report.diagnostics.errors == errors) else {
                break;
            };
            text = text.from(next);
        }
        if run.report.diagnostics.errors != errors {
            run.steps.truncate(before);
        }
    }

    /// Executes the first command of `text`; gives the place of the next.
    fn one_command(
        &mut self,
        run: &mut Run<'_, '_>,
        text: Text<'_>,
        further: bool,
    ) -> Option<usize> {
        let (head, at) = text.head();
        let (letter, number, span) = match head {
            Head::Code(letter, number, span) => (letter, number, span),
            Head::Tool(span) => {
                let klipper = self.names_parameters();
                let mover = if klipper {
                    Mover::File
                } else {
                    Mover::Firmware
                };
                self.unknown_moves(run, span, mover);
                return None;
            }
            Head::Name(name, span) => {
                self.named(run, text, name, span, at);
                return None;
            }
            Head::Odd(name, span) if self.lists(name) => {
                self.named(run, text, name, span, at);
                return None;
            }
            Head::Odd(..) | Head::Other => {
                self.not_a_command(run);
                return None;
            }
        };
        // Bambu Lab's M1006 plays notes, with M among their letters.
        let sounds = (letter, number) == (b'M', 10060) && self.passes(letter, number);
        if sounds || Text::is_text(letter, number) {
            if self.unknown_word(letter, number) {
                self.code(run, (letter, number, span), &Parameters::new());
                return None;
            }
            // RepRapFirmware runs stop.g or sleep.g (GCodes2.cpp, cases 0 and 1).
            if !self.one_a_line() && number <= 10 && !self.is_listed(letter, number) {
                self.unknown_moves(run, span, Mover::File);
            }
            text_command(run, number);
            return None;
        }
        let (parameters, next) = match text.parameters(at) {
            Ok(found) => found,
            // Whatever its arguments, the profile says what it does.
            Err(_) if self.is_listed(letter, number) && self.one_a_line() => {
                (Parameters::new(), None)
            }
            Err(odd) => {
                let homes = (letter, number) == (b'G', 280) && !self.names_parameters();
                if let Some(flags) = text.axis_flags(at).filter(|_| homes) {
                    self.code(run, (letter, number, span), &flags);
                    return None;
                }
                odd_text(&mut run.report, odd);
                return None;
            }
        };
        if further && self.one_a_line() {
            if !self.changes_nothing(letter, number) {
                run.report
                    .error(
                        "two-commands",
                        "this controller reads one command a line",
                        span,
                    )
                    .help("write it on a line of its own");
            }
            return next;
        }
        self.code(run, (letter, number, span), &parameters);
        // M900 has M among its parameters on Bambu Lab's printers.
        next.filter(|_| !(self.one_a_line() && (letter, number) == (b'M', 9000)))
    }

    /// Whether a line begins with `#` and names no command after it.
    fn is_hash_comment(&self, text: &[u8]) -> bool {
        let Some(rest) = text.trim_ascii_start().strip_prefix(b"#") else {
            return false;
        };
        let letters = rest
            .trim_ascii_start()
            .split(|byte| !byte.is_ascii_alphabetic() && *byte != b'_');
        let first = letters.into_iter().next().unwrap_or_default();
        !(holds_word(rest) || first.contains(&b'_') || self.lists(first))
    }

    fn one_a_line(&self) -> bool {
        !self.machine.controller.language.printer.several_commands
    }

    /// Klipper: what stands between blanks is one parameter.
    pub(super) fn names_parameters(&self) -> bool {
        self.machine.controller.language.printer.velocity_limit
    }

    /// Text without a command that can be read.
    fn not_a_command(&mut self, run: &mut Run<'_, '_>) {
        for issue in &run.block.issues {
            let found = issue.diagnostic(run.line, run.report.text);
            run.report.diagnostics.push(found);
        }
        if run.block.issues.is_empty() && !run.block.words.is_empty() {
            let block = run.block;
            self.words(run, block);
        }
    }

    /// Whether the profile says what the command does, whatever follows it.
    fn is_listed(&self, letter: u8, number: u16) -> bool {
        let printer = &self.machine.controller.language.printer;
        let listed = |list: &[Command]| list.iter().any(|one| one.is_code(letter, number));
        let unknown = listed(&printer.unknown_moves) || listed(&printer.unknown_macros);
        let ignored = self.passes(letter, number) || listed(&printer.ignored_macros);
        ignored || unknown || listed(&printer.shifts) || listed(&printer.optional_part)
    }

    /// Whether it moves in a way that only the machine knows, as one of its macros: that counts
    /// before what the firmware makes of the word.
    pub(super) fn unknown_word(&self, letter: u8, number: u16) -> bool {
        let printer = &self.machine.controller.language.printer;
        let lists = [&printer.unknown_moves, &printer.unknown_macros];
        lists
            .into_iter()
            .flatten()
            .any(|one| one.is_code(letter, number))
    }

    /// Whether the profile says that a word moves nothing. `M862.3` is one of
    /// `M862`.
    fn passes(&self, letter: u8, number: u16) -> bool {
        let language = &self.machine.controller.language;
        match letter {
            b'G' => language.ignored_g.contains(&number),
            b'M' => language.ignored_m.contains(&(number / 10)),
            _ => false,
        }
    }

    /// A second command that this controller does not see, and that would
    /// change nothing if it did.
    fn changes_nothing(&self, letter: u8, number: u16) -> bool {
        if letter == b'M' {
            return self.passes(letter, number) || number == 300;
        }
        match (self.rules.g_code)(number) {
            Some(GCode::Absolute(absolute)) => absolute == self.modal.absolute,
            Some(GCode::Units { mm_per_unit }) => mm_per_unit == self.modal.mm_per_unit,
            Some(GCode::Plane(plane)) => plane == self.modal.plane,
            Some(GCode::CompensationOff | GCode::ToolLength(ToolLength::Off)) => true,
            _ => false,
        }
    }

    /// A word with its parameters.
    fn code(
        &mut self,
        run: &mut Run<'_, '_>,
        (letter, number, span): (u8, u16, Span),
        parameters: &Parameters,
    ) {
        let action = f64::from(number) / 10.0;
        if letter == b'M' {
            self.switch_printer_loads(run, action, parameters, span);
        }
        let printer = &self.machine.controller.language.printer;
        let listed = |list: &[Command]| list.iter().any(|one| one.is_code(letter, number));
        let unknown = self.unknown_word(letter, number);
        let shifts = listed(&printer.shifts) && !unknown;
        if unknown && letter == b'T' {
            self.printer.several_tools |= number > 0;
            // The next T changes the tool, whichever it names.
            self.printer.tool = u32::MAX;
        }
        let map = (letter, number) == (b'G', 290) && printer.height_map;
        if map && value(parameters, b'S').is_some_and(|s| matches!(s, 1.0..=3.0)) {
            note_levelling(run, span);
            self.shift_axes(&Parameters::new());
            run.act(ActionKind::MayStop, 0.0);
        } else if !unknown && (self.passes(letter, number) || listed(&printer.ignored_macros)) {
            note_uncounted(run, letter, number, span);
            run.act(ActionKind::Other, action);
        } else if shifts {
            self.shift_axes(parameters);
            run.act(ActionKind::Other, action);
        } else if (letter, number) == (b'M', 6050)
            && listed(&printer.unknown_moves)
            && value(parameters, b'S').is_some_and(|mode| mode >= 2.0)
        {
            // Duplication and mirrored duplication.
            refuse_second_drive(run, SECOND_CARRIAGE, span);
        } else if listed(&printer.unknown_moves) {
            self.listed_moves(run, (letter, number, span));
            if has(parameters, b'F') {
                // Whether it stays in force, firmwares see differently.
                self.modal.feed = None;
            }
        } else if unknown {
            let name = span.of(run.report.text);
            if self.has_file(name) {
                self.macro_file(run, name, span);
            } else {
                self.unknown_macro(run, span);
            }
        } else if printer
            .optional_part
            .first()
            .is_some_and(|one| one.is_code(letter, number))
        {
            self.begin_optional(run, span);
        } else if listed(&printer.optional_part) {
            self.end_optional(run, span);
        } else if letter == b'T' {
            self.tool(run, number, span);
        } else if self.limits_other_tool((letter, number), parameters) {
            let before = self.knobs.clone();
            self.known_command(run, (letter, number, span), parameters);
            self.limits_at_least(&before);
        } else {
            self.known_command(run, (letter, number, span), parameters);
        }
    }

    fn known_command(
        &mut self,
        run: &mut Run<'_, '_>,
        head: (u8, u16, Span),
        parameters: &Parameters,
    ) {
        let klipper = self.names_parameters() && unknown_to_klipper(run, head);
        if !klipper && !self.own_command(run, head, parameters) {
            self.ordinary(run, head, parameters);
        }
    }

    /// Whether limits are those of a tool that is not in use (Marlin: T of M201 and M203): they may
    /// hold later, so that the higher ones count.
    fn limits_other_tool(&self, head: (u8, u16), parameters: &Parameters) -> bool {
        let tool = value(parameters, b'T').filter(|_| matches!(head, (b'M', 2010 | 2030)));
        tool.is_some_and(|tool| tool != f64::from(self.printer.tool))
    }

    /// Commands that printers alone have, or read in their own way.
    fn own_command(
        &mut self,
        run: &mut Run<'_, '_>,
        (letter, number, span): (u8, u16, Span),
        parameters: &Parameters,
    ) -> bool {
        match (letter, number) {
            (b'G', 100 | 110) => self.retract_or_set(run, number, parameters, span),
            (b'G', 530 | 921..=923) => {
                // Where machine zero lies may have been lost.
                self.ordinary(run, (letter, number, span), parameters);
                self.shift_axes(&Parameters::new());
            }
            // A spline to where the axes stand, or a word that is not known: nothing moves.
            // What a line of axes alone means after it, firmwares see differently.
            (b'G', 50) if parameters.is_empty() => {
                self.modal.motion = Motion::None;
                run.act(ActionKind::MayStop, 0.0);
            }
            (b'G', 280) => self.home(run, parameters, span),
            (b'G', 600) => self.save_position(run, parameters, span),
            (b'G', 610) if self.one_a_line() => {
                self.return_to_position(run, parameters, span);
            }
            (b'G', 800) => {
                self.modal.motion = Motion::None;
                self.unknown_moves(run, span, Mover::Firmware);
            }
            (b'M', 20) => {
                // RepRapFirmware stops here; the others do not know it.
                run.facts.boundary = true;
                run.act(ActionKind::Stop, 2.0);
            }
            (b'M', 300) => run.act(ActionKind::Other, 30.0),
            (b'M', 920) => self.steps_per_unit(run, parameters),
            (b'M', 1040 | 1060 | 1070 | 1090 | 1400 | 1410 | 1900 | 1910 | 3030 | 5680) => {
                run.act(ActionKind::Other, f64::from(number) / 10.0);
            }
            (b'M', 1200) => self.push_state(run, span),
            (b'M', 1210) => self.pop_state(run, span),
            (b'M', 2000) => self.volumetric(run, parameters, span),
            (b'M', 2010) if parameters.is_empty() => {}
            (b'M', 2030) => self.speed_caps(run, parameters, span),
            (b'M', 2040) if self.machine.controller.language.printer.velocity_limit => {
                let least = match (value(parameters, b'P'), value(parameters, b'T')) {
                    (Some(print), Some(travel)) => Some(print.min(travel)),
                    _ => None,
                };
                let accel = value(parameters, b'S').or(least);
                self.limit_velocity(run, None, accel, span);
            }
            (b'M', 2040) => return self.path_limits(run, parameters, span),
            (b'M', 2050 | 5660) => {
                self.corner_limits(run, parameters, number, span);
                if self.one_a_line() {
                    self.least_speeds(parameters);
                }
            }
            (b'M', 2070) => self.set_retract(run, parameters, span),
            (b'M', 2080) => self.set_recover(run, parameters, span),
            (b'M', 2090) => {
                if value(parameters, b'S') != Some(0.0) && !parameters.is_empty() {
                    refuse(run, span, "M209 turns moves of the extruder into retracts");
                }
            }
            (b'M', 2200) => self.feed_percent(run, parameters, span),
            (b'M', 2210) => self.flow_percent(run, parameters, span),
            (b'M', 5010) => self.restore_settings(run, span),
            (b'M', 980) => {
                let message = "M98 runs a macro file, which is not read";
                let help = "write its blocks in place of it";
                run.report
                    .error("unsupported-code", message, span)
                    .help(help);
            }
            (b'M', 990) => refuse(run, span, "M99 belongs to a macro file"),
            (b'G', 650..=670) => refuse(run, span, "a macro call is nothing that printers know"),
            (b'M', 5020) => refuse(
                run,
                span,
                "M502 loads settings that the machine file does not describe",
            ),
            _ => return false,
        }
        true
    }
}

/// Commands with free text: stops, and those that do nothing.
fn text_command(run: &mut Run<'_, '_>, number: u16) {
    let stops = number <= 10;
    run.facts.boundary |= stops;
    let kind = if stops {
        ActionKind::Stop
    } else {
        ActionKind::Other
    };
    run.act(kind, f64::from(number) / 10.0);
}

/// Words that Klipper does not know: it goes on without them.
fn unknown_to_klipper(run: &mut Run<'_, '_>, (letter, number, span): (u8, u16, Span)) -> bool {
    match (letter, number) {
        (b'M', 2000) => {
            let message = "Klipper does not know M200 and goes on without it: E stays a length";
            run.report.note_once("volumetric", message, span);
        }
        (b'G', 300 | 540..=593 | 600 | 610) => {
            refuse(
                run,
                span,
                "Klipper does not know this word, and goes on without it",
            );
        }
        _ => return false,
    }
    true
}

/// Refuses a command by name.
pub(super) fn refuse(run: &mut Run<'_, '_>, span: Span, message: &str) {
    run.report
        .error("unsupported-code", message, span)
        .help("nothing is estimated for a program with motion that is not understood");
}

/// What stands where a parameter should: an expression, or text.
fn odd_text(report: &mut Report<'_, '_>, odd: Span) {
    if odd.of(report.text).contains(&b'{') {
        report
            .error("expression", "expressions in `{ }` are not supported", odd)
            .help("write the number itself");
        return;
    }
    report
        .error("unknown-text", "this is no parameter of the command", odd)
        .help("parameters are a letter and a number each; put other text after `;`");
}
