//! Positions and states that a program keeps and comes back to.

use super::line::{Parameters, has, value};
use super::state::{SavedPosition, SavedState};
use crate::control::{Control, Run};
use crate::places::{EXTRUDER, Z};
use gwatt_machine::units::SECONDS_PER_MINUTE;
use gwatt_machine::{ALL_AXES, AxisSet};
use gwatt_motion::ActionKind;
use gwatt_syntax::source::Span;

/// Most positions and states that a program may keep.
const KEPT: usize = 64;

/// Whether a state takes the axes back to its position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Back {
    No,
    /// At the feed in force.
    AtFeed,
    /// At this speed, mm/s.
    At(f64),
}

impl Control<'_> {
    /// G60 S: keeps the position.
    ///
    /// Source: Marlin G60.
    pub(super) fn save_position(
        &mut self,
        run: &mut Run<'_, '_>,
        parameters: &Parameters,
        span: Span,
    ) {
        let slot = slot(parameters);
        let saved = self.saved_position();
        let positions = &mut self.printer.positions;
        positions.retain(|(other, _)| *other != slot);
        if positions.len() >= KEPT {
            return Self::bad_value(run, span, "a program may keep 64 positions");
        }
        positions.push((slot, saved));
        run.act(ActionKind::Other, 0.0);
    }

    fn saved_position(&self) -> SavedPosition {
        SavedPosition {
            at: self.position.at,
            unknown: self.position.unknown,
        }
    }

    /// G61 S: back to it; axes that are named, to as far from it as they say; none: Z first where
    /// that rises, then the others, then Z.
    ///
    /// Source: Marlin G61 (`G61.cpp`, `do_blocking_move_to`).
    pub(super) fn return_to_position(
        &mut self,
        run: &mut Run<'_, '_>,
        parameters: &Parameters,
        span: Span,
    ) {
        let slot = slot(parameters);
        let found = self
            .printer
            .positions
            .iter()
            .find(|(other, _)| *other == slot);
        let Some((_, saved)) = found.copied() else {
            run.report
                .error(
                    "no-such-position",
                    "G61 to a position that G60 has not kept",
                    span,
                )
                .help("write G60 before it, with the same S");
            return;
        };
        let letters = ALL_AXES
            .iter()
            .filter(|axis| has(parameters, axis.letter()))
            .fold(0, |set: u16, axis| set | 1 << *axis as usize);
        let all = self.machine.axis_set.0 & !(1 << EXTRUDER);
        let feed = value(parameters, b'F').filter(|feed| *feed > 0.0);
        let feed = feed.map(|feed| feed * self.modal.mm_per_unit / SECONDS_PER_MINUTE);
        let mut saved = saved;
        let named = AxisSet(letters & all);
        for axis in named.iter() {
            let by = value(parameters, ALL_AXES[axis].letter()).unwrap_or(0.0);
            saved.at[axis] += by * self.modal.mm_per_unit;
        }
        if named.is_empty() {
            self.go_back_in_turn(run, &saved, AxisSet(all), feed);
        } else {
            self.go_back(run, &saved, named, feed);
        }
        if letters & 1 << EXTRUDER != 0 {
            // E only takes the number back, as G92 does.
            self.position.unknown.insert(EXTRUDER);
        }
    }

    /// The axes to a kept position, Z while the others stand, above them.
    fn go_back_in_turn(
        &mut self,
        run: &mut Run<'_, '_>,
        saved: &SavedPosition,
        axes: AxisSet,
        feed_mm_s: Option<f64>,
    ) {
        let unknown = AxisSet(saved.unknown.0 | self.position.unknown.0);
        let z = AxisSet(axes.0 & 1 << Z);
        if unknown.contains(Z) || z.is_empty() {
            return self.go_back(run, saved, axes, feed_mm_s);
        }
        let others = AxisSet(axes.0 & !z.0);
        let rises = saved.at[Z] > self.position.at[Z];
        let turns = if rises { [z, others] } else { [others, z] };
        for axes in turns {
            let here = &self.position.at;
            if axes
                .iter()
                .any(|axis| saved.at[axis] != here[axis] || unknown.contains(axis))
            {
                self.go_back(run, saved, axes, feed_mm_s);
            }
        }
    }

    /// A straight line of `axes` to a kept position.
    fn go_back(
        &mut self,
        run: &mut Run<'_, '_>,
        saved: &SavedPosition,
        axes: AxisSet,
        feed_mm_s: Option<f64>,
    ) {
        run.facts.own_feed = Some("it returns to a position that was kept");
        let unknown = AxisSet((saved.unknown.0 | self.position.unknown.0) & axes.0);
        let mut end = self.position.at;
        for axis in axes.iter() {
            end[axis] = saved.at[axis];
        }
        let feed_mm_s = feed_mm_s.map(|feed| feed * self.printer.feed_factor.max(1.0));
        self.go_at(run, &end, unknown, feed_mm_s);
        self.position.unknown.0 |= saved.unknown.0 & axes.0;
    }

    /// `SAVE_GCODE_STATE`.
    pub(super) fn save_state(&mut self, run: &mut Run<'_, '_>, name: Vec<u8>, span: Span) {
        let full = self.printer.states.len() >= KEPT && !self.printer.states.contains_key(&name);
        if full || name.len() > 256 {
            return Self::bad_value(run, span, "a program may keep 64 states by short names");
        }
        let state = SavedState {
            position: self.saved_position(),
            offsets: *self.position.shifts(),
            absolute: self.modal.absolute,
            extruder_absolute: self.printer.extruder_absolute,
            unstated: self.printer.unstated,
            feed: self.modal.feed,
            feed_factor: self.printer.feed_factor,
            flow: self.printer.flow,
        };
        self.printer.states.insert(name, state);
        run.facts.boundary = true;
        run.act(ActionKind::Other, 0.0);
    }

    /// `RESTORE_GCODE_STATE`; with `back` at this speed to its position, if
    /// there is one.
    ///
    /// Source: Klipper, "G-Codes", `[gcode_move]`: everything but the place of
    /// the extruder.
    pub(super) fn restore_state(
        &mut self,
        run: &mut Run<'_, '_>,
        name: &[u8],
        back: Back,
        span: Span,
    ) {
        let Some(saved) = self.printer.states.get(name).copied() else {
            run.report
                .error("no-such-state", "a state that was not saved", span)
                .help("write SAVE_GCODE_STATE before it, with the same NAME");
            return;
        };
        run.facts.boundary = true;
        let mut offsets = saved.offsets;
        offsets[EXTRUDER] += self.position.at[EXTRUDER] - saved.position.at[EXTRUDER];
        self.position.set_shifts(&offsets);
        self.position.unknown.0 |= saved.position.unknown.0;
        self.modal.absolute = saved.absolute;
        self.printer.extruder_absolute = saved.extruder_absolute;
        self.printer.unstated = saved.unstated;
        self.extruder_mode(None);
        self.modal.feed = saved.feed;
        self.printer.feed_factor = saved.feed_factor;
        self.printer.flow = saved.flow;
        self.settle();
        if back != Back::No {
            let speed_mm_s = match back {
                Back::At(speed_mm_s) => Some(speed_mm_s),
                _ => None,
            };
            let axes = AxisSet(self.machine.axis_set.0 & !(1 << EXTRUDER));
            self.go_back(run, &saved.position, axes, speed_mm_s);
        }
        run.act(ActionKind::Other, 61.0);
    }

    /// M120 and M121 of `RepRapFirmware`: feed and modes, in a stack.
    pub(super) fn push_state(&mut self, run: &mut Run<'_, '_>, span: Span) {
        let depth = self.stacked();
        self.save_state(run, stack_name(depth), span);
    }

    pub(super) fn pop_state(&mut self, run: &mut Run<'_, '_>, span: Span) {
        let name = stack_name(self.stacked().wrapping_sub(1));
        let Some(saved) = self.printer.states.remove(&name) else {
            run.report
                .error("no-such-state", "M121 without an M120 before it", span)
                .help("write M120 before it");
            return;
        };
        run.facts.boundary = true;
        self.modal.absolute = saved.absolute;
        self.printer.extruder_absolute = saved.extruder_absolute;
        self.printer.unstated = saved.unstated;
        self.extruder_mode(None);
        self.modal.feed = saved.feed;
        self.settle();
        run.act(ActionKind::Other, 0.0);
    }

    fn stacked(&self) -> usize {
        let names = self.printer.states.keys();
        names.filter(|name| name.first() == Some(&b' ')).count()
    }
}

/// The name of a level of the stack, which no state of a program can have.
fn stack_name(level: usize) -> Vec<u8> {
    format!(" {level}").into_bytes()
}

fn slot(parameters: &Parameters) -> u32 {
    value(parameters, b'S').unwrap_or(0.0).clamp(0.0, 1e6) as u32
}
