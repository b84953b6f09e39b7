//! Moves that a firmware makes of itself, and positions that it keeps.

use super::command::note_levelling;
use super::line::{Parameters, has, value};
use crate::interpret::execute::{Control, Run};
use crate::interpret::modal::Feed;
use crate::interpret::motion::EXTRUDER;
use crate::interpret::moves::{ActionKind, MoveKind};
use crate::machine::{ALL_AXES, AxisId, AxisSet, AxisValues};
use crate::source::Span;
use crate::units::SECONDS_PER_MINUTE;

/// Most positions and states that a program may keep.
const KEPT: usize = 64;

/// A position that G60 keeps.
#[derive(Debug, Clone, Copy)]
pub(super) struct SavedPosition {
    at: AxisValues,
    unknown: AxisSet,
}

/// Whether a state takes the axes back to its position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Back {
    No,
    /// At the feed in force.
    AtFeed,
    /// At this speed, mm/s.
    At(f64),
}

/// What `SAVE_GCODE_STATE` keeps.
#[derive(Debug, Clone, Copy)]
pub(super) struct SavedState {
    position: SavedPosition,
    offsets: AxisValues,
    absolute: bool,
    extruder_absolute: bool,
    feed: Option<Feed>,
    feed_factor: f64,
    flow: f64,
}

impl Control<'_> {
    /// Moves that only the firmware knows: every axis at its full speed and
    /// acceleration, and from then on in an unknown place.
    pub(super) fn unknown_moves(&mut self, run: &mut Run<'_, '_>, span: Span) {
        let name = String::from_utf8_lossy(span.of(run.report.text)).into_owned();
        let message = format!(
            "{name} moves in a way that only the firmware knows: \
             every axis counts at its full speed and acceleration"
        );
        run.report.note_once("unknown-moves", &message, span);
        note_levelling_if(run, &name, span);
        run.facts.boundary = true;
        let all = self.machine.axis_set;
        let end = self.position.at;
        self.go_at(run, MoveKind::Feed, &end, all, None, Some(f64::INFINITY));
        self.position.unknown.0 |= all.0;
        run.act(ActionKind::Other, 0.0);
    }

    /// G28: each group of axes from an unknown place to its endstops.
    ///
    /// Source: Marlin G28 (no axis: all of X Y Z), Klipper G28.
    pub(super) fn home(&mut self, run: &mut Run<'_, '_>, parameters: &Parameters, span: Span) {
        run.facts.reference = true;
        run.facts.fixed = Some("it homes the axes");
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
            let home = self.machine.axes[axis].and_then(|data| data.home_mm);
            self.position.home(axis, home.unwrap_or(0.0));
            if home.is_none() {
                self.position.unknown.insert(axis);
                let message = "without `home_mm` of its axis in the machine file, where G28 ends \
                               is not known: the next moves count from anywhere";
                run.report.note_once("home", message, span);
            }
        }
    }

    fn home_group(&mut self, run: &mut Run<'_, '_>, group: AxisSet) {
        let speeds = group
            .iter()
            .filter_map(|axis| Some(self.machine.axes[axis].as_ref()?.home_mm_s));
        let feed_mm_s = speeds.fold(0.0, f64::max);
        let mut end = self.position.at;
        for axis in group.iter() {
            end[axis] = self.machine.axes[axis]
                .and_then(|data| data.home_mm)
                .unwrap_or(0.0);
        }
        self.go_at(run, MoveKind::Feed, &end, group, None, Some(feed_mm_s));
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
    }

    /// T0 to T9: another tool than the one in use comes by unknown moves.
    pub(super) fn tool(&mut self, run: &mut Run<'_, '_>, number: u16, span: Span) {
        let tool = u32::from(number / 10);
        run.facts.boundary = true;
        run.act(ActionKind::ToolSelect, f64::from(tool));
        if tool != self.printer.tool {
            self.printer.tool = tool;
            self.unknown_moves(run, span);
        }
    }

    /// G10 and G11: retract and recover; with other values G10 sets a tool or
    /// an offset.
    ///
    /// Sources: Marlin G10, G11 (S1: a longer retract); Duet documentation G10
    /// (P, R, S: temperatures; L2, L20 and axes: offsets).
    pub(super) fn retract_or_set(
        &mut self,
        run: &mut Run<'_, '_>,
        number: u16,
        parameters: &Parameters,
        span: Span,
    ) {
        let settings = parameters
            .iter()
            .any(|one| one.letter != b'S' || one.value.is_some_and(|value| value > 1.0));
        if number == 110 {
            return self.recover(run, span);
        }
        if !settings {
            return self.retract(run, span);
        }
        let axes = parameters
            .iter()
            .any(|one| AxisId::from_letter(one.letter).is_some());
        if axes || has(parameters, b'L') {
            self.shift_axes(parameters);
        }
        let heats = [b'S', b'R'].map(|letter| value(parameters, letter));
        if heats.iter().any(Option::is_some) {
            self.switch_printer_loads(run, 568.0, parameters, span);
        }
        run.act(ActionKind::Other, 10.0);
    }

    fn retract(&mut self, run: &mut Run<'_, '_>, span: Span) {
        if self.printer.retracted || !self.may_retract(run, span) {
            return;
        }
        let retract = self.printer.retract;
        self.printer.retracted = true;
        self.slide(run, EXTRUDER, -retract.length_mm, retract.speed_mm_s);
        self.printer.lifted_mm = retract.lift_mm;
        self.slide(run, 2, retract.lift_mm, f64::INFINITY);
    }

    fn recover(&mut self, run: &mut Run<'_, '_>, span: Span) {
        if !self.printer.retracted || !self.may_retract(run, span) {
            return;
        }
        let retract = self.printer.retract;
        self.printer.retracted = false;
        let lifted = std::mem::take(&mut self.printer.lifted_mm);
        self.slide(run, 2, -lifted, f64::INFINITY);
        let length = retract.length_mm + retract.extra_mm;
        self.slide(run, EXTRUDER, length, retract.recover_mm_s);
    }

    fn may_retract(&self, run: &mut Run<'_, '_>, span: Span) -> bool {
        run.facts.fixed = Some("it retracts filament");
        if self.machine.axes[EXTRUDER].is_none() {
            run.report
                .error("no-such-axis", "the machine has no E axis", span)
                .help("choose a machine with it, or describe it in the machine file: [axes.E]");
            return false;
        }
        if !self.printer.retract_given {
            let retract = &self.printer.retract;
            let message = format!(
                "G10 and G11 count with the profile's retract: {} mm at {} mm/s",
                retract.length_mm, retract.speed_mm_s
            );
            run.report.note_once("retract-default", &message, span);
        }
        true
    }

    /// Moves one axis by `by_mm`; its program coordinate stays.
    fn slide(&mut self, run: &mut Run<'_, '_>, axis: usize, by_mm: f64, speed_mm_s: f64) {
        if by_mm == 0.0 || self.machine.axes[axis].is_none() {
            return;
        }
        let mut end = self.position.at;
        end[axis] += by_mm;
        let speed_mm_s = speed_mm_s * self.printer.feed_factor.max(1.0);
        let none = AxisSet::default();
        self.go_at(run, MoveKind::Feed, &end, none, None, Some(speed_mm_s));
        self.position.shift(axis, by_mm);
    }

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
        run.act(ActionKind::Other, 60.0);
    }

    fn saved_position(&self) -> SavedPosition {
        SavedPosition {
            at: self.position.at,
            unknown: self.position.unknown,
        }
    }

    /// G61 S: back to it, all axes but the extruder, or those that are named.
    ///
    /// Source: Marlin G61.
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
        let chosen = if letters & all == 0 {
            all
        } else {
            letters & all
        };
        let feed = value(parameters, b'F').filter(|feed| *feed > 0.0);
        let feed = feed.map(|feed| feed * self.modal.mm_per_unit / SECONDS_PER_MINUTE);
        self.go_back(run, &saved, AxisSet(chosen), feed);
        if letters & 1 << EXTRUDER != 0 {
            // E only takes the number back, as G92 does.
            self.position.unknown.insert(EXTRUDER);
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
        run.facts.fixed = Some("it returns to a position that was kept");
        let unknown = AxisSet((saved.unknown.0 | self.position.unknown.0) & axes.0);
        let mut end = self.position.at;
        for axis in axes.iter() {
            end[axis] = saved.at[axis];
        }
        let feed_mm_s = feed_mm_s.map(|feed| feed * self.printer.feed_factor.max(1.0));
        self.go_at(run, MoveKind::Feed, &end, unknown, None, feed_mm_s);
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
            offsets: *self.position.offsets(),
            absolute: self.modal.absolute,
            extruder_absolute: self.printer.extruder_absolute,
            feed: self.modal.feed,
            feed_factor: self.printer.feed_factor,
            flow: self.printer.flow,
        };
        self.printer.states.insert(name, state);
        run.facts.boundary = true;
        run.act(ActionKind::Other, 60.0);
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
        self.position.set_offsets(offsets);
        self.position.unknown.0 |= saved.position.unknown.0;
        self.modal.absolute = saved.absolute;
        self.printer.extruder_absolute = saved.extruder_absolute;
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
        self.extruder_mode(None);
        self.modal.feed = saved.feed;
        run.act(ActionKind::Other, 121.0);
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

/// Probing commands switch the correction of the bed on.
fn note_levelling_if(run: &mut Run<'_, '_>, name: &str, span: Span) {
    let name = name.to_ascii_uppercase();
    if name == "G29" || name == "G32" || name.starts_with("BED_MESH") {
        note_levelling(run, span);
    }
}
