//! Words that save and restore the state, and switch outputs.

use super::{Saved, Switches};
use crate::control::{Control, Run};
use crate::modal::{Feed, NumberText};
use crate::tool_table::Tool;
use gwatt_motion::ActionKind;
use gwatt_syntax::source::Span;

impl Control<'_> {
    /// Executes one of these words; false if it is none of them here.
    pub(crate) fn state_word(&mut self, number: u16, span: Span, run: &mut Run<'_, '_>) -> bool {
        if self.is_ignored(number) || !self.is_state_word(number) {
            return false;
        }
        match number {
            190 => {
                for letter in [b'R', b'Q', b'P'] {
                    run.words.take(letter);
                }
                self.switches.switch(number);
            }
            480 | 490 => {
                self.switches.feed_override = number == 480;
                self.switches.speed_override = number == 480;
            }
            520 if self.adapts(span, run) => return true,
            500..=530 => self.override_word(number, span, run),
            610 => {
                self.load_tool(number, span, run);
                run.facts.boundary = true;
                run.act(ActionKind::ToolChange, f64::from(number) / 10.0);
                return true;
            }
            660..=680 if self.output_knob(number, span, run) => return true,
            620..=680 => self.input_output(number, span, run),
            _ => self.saving(number, span, run),
        }
        run.act(ActionKind::Other, f64::from(number) / 10.0);
        true
    }

    /// Whether this control has the M word (number × 10), and it is of this file.
    pub(crate) fn is_state_word(&self, number: u16) -> bool {
        (self.rules.is_state_word)(number)
    }

    fn override_word(&mut self, number: u16, span: Span, run: &mut Run<'_, '_>) {
        let on = run.words.take(b'P').is_none_or(|value| value != 0.0);
        match number {
            500 => self.switches.feed_override = on,
            510 => self.switches.speed_override = on,
            520 => {
                if on {
                    run.report
                        .error(
                            "adaptive-feed",
                            "under M52 a signal from outside sets the speed",
                            span,
                        )
                        .help("if it never raises it, list M52 under `ignored` in the controller profile");
                }
                self.switches.adaptive_feed = on;
            }
            _ => self.switches.feed_hold = on,
        }
    }

    /// M62 to M68. What is wired to them the program does not know.
    fn input_output(&mut self, number: u16, span: Span, run: &mut Run<'_, '_>) {
        let channel = |letter: u8, run: &mut Run<'_, '_>| {
            run.words
                .take(letter)
                .filter(|value| *value >= 0.0 && value.fract() == 0.0)
        };
        let fine = match number {
            620..=650 => channel(b'P', run).is_some(),
            660 => {
                let both = [channel(b'P', run), channel(b'E', run)];
                for letter in [b'L', b'Q'] {
                    run.words.take(letter);
                }
                self.input = None;
                if self.is_on_way_back() {
                    let message = "M66 between G40 and the move that takes the tool back: \
                                   where that begins, LinuxCNC and its rs274 do not agree";
                    run.report
                        .error("compensation", message, span)
                        .help("write a move in the plane after G40 first");
                    return;
                }
                both[0].is_some() != both[1].is_some()
            }
            _ => {
                run.words.take(b'Q');
                channel(b'E', run).is_some()
            }
        };
        if !fine {
            run.report
                .error(
                    "input-output",
                    "an input or output without its number",
                    span,
                )
                .help("M62 to M65 take P, M66 P or E, M67 and M68 E and Q");
        } else if number != 660 {
            let message = "what is wired to the outputs is not known: \
                           they are taken to change no motion";
            run.report.note_once("outputs", message, span);
        }
    }

    /// M70 to M73.
    fn saving(&mut self, number: u16, span: Span, run: &mut Run<'_, '_>) {
        run.facts.boundary = true;
        match number {
            700 | 730 => {
                let saved = Saved {
                    modal: self.modal.clone(),
                    system: self.position.offsets().system,
                    tool_length: self.has_tool_length(),
                    spindle: self.spindle,
                    switches: self.switches,
                    on_return: number == 730,
                };
                if let Some(level) = self.saved.last_mut() {
                    *level = Some(Box::new(saved));
                }
            }
            710 => {
                if let Some(level) = self.saved.last_mut() {
                    *level = None;
                }
            }
            _ => match self.saved.last().cloned().flatten() {
                Some(saved) => {
                    self.restore(&saved);
                    self.settle_debts(span, run);
                }
                None => run
                    .report
                    .error("saved-state", "M72, but no state has been saved", span)
                    .help("save it by M70 or M73 before, in the same subprogram"),
            },
        }
    }

    /// A subprogram is entered: it has a state of its own to save.
    pub(crate) fn enter_level(&mut self) {
        self.saved.push(None);
    }

    /// A subprogram returns, which restores what its M73 has saved.
    pub(crate) fn leave_level(&mut self) {
        if self.saved.len() < 2 {
            return;
        }
        if let Some(Some(saved)) = self.saved.pop()
            && saved.on_return
        {
            self.restore(&saved);
        }
    }

    /// Actions of a restored state, which the next block reports.
    pub(crate) fn settle_debts(&mut self, span: Span, run: &mut Run<'_, '_>) {
        run.facts.boundary = true;
        for (kind, value) in self.pending_actions.drain(..) {
            run.act(kind, value);
        }
        if let Some(reason) = self.lost.take() {
            run.report
                .error("saved-state", reason, span)
                .help("write the words that are meant after M72, or after the call");
        }
    }

    pub(crate) fn has_tool_length(&self) -> bool {
        self.position
            .offsets()
            .tool
            .iter()
            .any(|value| *value != 0.0)
    }

    /// What M72 does: `LinuxCNC` executes the words that lead back. F it writes
    /// with one decimal, S with none.
    fn restore(&mut self, saved: &Saved) {
        let now = std::mem::replace(&mut self.modal, saved.modal.clone());
        self.modal.motion = now.motion;
        let in_unit = |feed: &Option<Feed>, unit: f64| {
            feed.map_or(0.0, |feed| feed.value * feed.mm_per_unit / unit)
        };
        let unit = saved.modal.mm_per_unit;
        let [value, before] = [&saved.modal, &now].map(|modal| in_unit(&modal.feed, unit));
        if value == before {
            self.modal.feed = now.feed.filter(|_| now.feed_mode == saved.modal.feed_mode);
        } else {
            let text = format!("{value:.1}");
            self.modal.feed = (value > 0.0).then(|| Feed {
                value: text.parse().unwrap_or(value),
                mm_per_unit: unit,
                text: NumberText::new(text.as_bytes()),
                expression: NumberText::default(),
            });
        }
        if saved.modal.spindle_rpm == now.spindle_rpm {
            self.modal.spindle_rpm = now.spindle_rpm;
        } else {
            self.modal.spindle_rpm = saved.modal.spindle_rpm.round_ties_even();
            self.pending_actions
                .push((ActionKind::SpindleSpeed, self.modal.spindle_rpm));
        }
        match (saved.spindle.surface_mm_min, self.spindle.surface_mm_min) {
            (Some(_), None) => {
                self.lost = Some("G96 cannot be restored: its S is lost");
                self.pending_actions.push((ActionKind::Other, 72.0));
            }
            (None, Some(_)) => self.spindle.surface_mm_min = None,
            _ => {}
        }
        let tool = if saved.tool_length {
            // G43, of the tool that is loaded now.
            self.tools.find(self.tools.loaded).unwrap_or_default()
        } else {
            Tool::default()
        };
        let length = self.tool_offsets_mm(&tool);
        let changes = saved.tool_length != self.has_tool_length();
        self.position.change(|offsets| {
            offsets.select(saved.system);
            if changes {
                offsets.tool = length;
            }
        });
        self.restore_switches(saved.switches);
        self.note_bent();
        if now.path_mode != saved.modal.path_mode {
            self.pending_actions.push((ActionKind::PathMode, 0.0));
        }
    }

    /// Spindle and coolant.
    fn restore_switches(&mut self, saved: Switches) {
        let now = self.switches;
        let mut words: arrayvec::ArrayVec<(u16, ActionKind), 4> = arrayvec::ArrayVec::new();
        if saved.spindle != now.spindle {
            words.push((saved.spindle * 10, ActionKind::Spindle));
        }
        if saved.mist && !now.mist {
            words.push((70, ActionKind::Coolant));
        }
        if saved.flood && !now.flood {
            words.push((80, ActionKind::Coolant));
        }
        if !saved.mist && !saved.flood && (now.mist || now.flood) {
            words.push((90, ActionKind::Coolant));
        }
        self.switches = Switches {
            spindle: now.spindle,
            mist: now.mist,
            flood: now.flood,
            ..saved
        };
        for (number, kind) in words {
            let value = f64::from(number) / 10.0;
            self.switches.switch(number);
            self.switch_loads(value);
            self.pending_actions.push((kind, value));
        }
    }
}
