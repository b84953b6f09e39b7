//! The moves of the drilling cycles.

use super::Siemens;
use super::cycle::Levels;
use super::cycle_call::{Call, Kind};
use crate::control::{Control, Run};
use crate::modal::{Feed, NumberText};
use crate::special::Turning;
use gwatt_machine::units::{MM_PER_INCH, SECONDS_PER_MINUTE};
use gwatt_motion::{ActionKind, MoveKind};

/// Strokes of a deep hole that one call may make.
const STROKES_MAX: usize = 10_000;

/// Pitch of metric coarse threads by their size ("CYCLE84", MPIT 3 to 48).
const PITCHES: [(f64, f64); 19] = [
    (3.0, 0.5),
    (4.0, 0.7),
    (5.0, 0.8),
    (6.0, 1.0),
    (7.0, 1.0),
    (8.0, 1.25),
    (10.0, 1.5),
    (12.0, 1.75),
    (14.0, 2.0),
    (16.0, 2.0),
    (18.0, 2.5),
    (20.0, 2.5),
    (22.0, 2.5),
    (24.0, 3.0),
    (27.0, 3.0),
    (30.0, 3.5),
    (36.0, 4.0),
    (42.0, 4.5),
    (48.0, 5.0),
];

impl Control<'_> {
    /// Moves the axis of the hole.
    fn plunge(
        &mut self,
        state: &mut Siemens,
        kind: MoveKind,
        levels: &Levels,
        to: f64,
        run: &mut Run<'_, '_>,
    ) {
        let target = self.target_at(state, &[(levels.axis, to)]);
        self.siemens_go(state, run, kind, &target, None);
    }

    /// The same at a feed of the cycle, program units a minute.
    fn plunge_at(
        &mut self,
        state: &mut Siemens,
        feed: Option<f64>,
        levels: &Levels,
        to: f64,
        run: &mut Run<'_, '_>,
    ) {
        let Some(value) = feed.filter(|value| *value > 0.0) else {
            return self.plunge(state, MoveKind::Feed, levels, to, run);
        };
        let mm_per_unit = self.modal.mm_per_unit;
        let feed = Feed {
            value,
            mm_per_unit,
            text: NumberText::default(),
            expression: NumberText::default(),
        };
        let before = self.modal.feed.replace(feed);
        self.plunge(state, MoveKind::Feed, levels, to, run);
        self.modal.feed = before;
    }

    /// A dwell: seconds, or revolutions where negative ("CYCLE82", DTB).
    fn cycle_wait(&self, time: Option<f64>, run: &mut Run<'_, '_>) {
        let seconds = match time {
            Some(time) if time < 0.0 && self.modal.spindle_rpm > 0.0 => {
                -time * 60.0 / self.modal.spindle_rpm
            }
            Some(time) => time.abs(),
            None => 0.0,
        };
        if seconds > 0.0 && seconds <= 1e9 {
            self.dwell(run, seconds);
        }
    }

    /// "Drilling, centering (CYCLE81)", "Drilling, counterboring (CYCLE82)".
    pub(super) fn cycle_drill(
        &mut self,
        state: &mut Siemens,
        levels: Levels,
        call: &Call,
        run: &mut Run<'_, '_>,
    ) {
        self.plunge(state, MoveKind::Rapid, &levels, levels.safe, run);
        self.plunge(state, MoveKind::Feed, &levels, levels.depth, run);
        self.cycle_wait(call.value(6), run);
        self.plunge(state, MoveKind::Rapid, &levels, levels.retract, run);
    }

    /// "Deep-hole drilling (CYCLE83)": FDEP, FDPR the first depth, DAM what each
    /// stroke is shorter, DTB and DTS dwells, FRF the feed of the first, VARI 1
    /// out of the hole, else by _VRT.
    pub(super) fn deep_hole(
        &mut self,
        state: &mut Siemens,
        levels: Levels,
        call: &Call,
        run: &mut Run<'_, '_>,
    ) {
        let unit = self.unit_of(levels.axis);
        let value = |place| call.value(place).map(|value| value * unit);
        let first = value(7)
            .filter(|below| *below != 0.0)
            .map(f64::abs)
            .or(value(6).map(|depth| (depth - levels.reference) * levels.sign));
        let less = value(8).unwrap_or(0.0);
        let total = (levels.depth - levels.reference) * levels.sign;
        let least = value(14).unwrap_or(0.0).abs();
        let (Some(first), true) = (first.filter(|first| *first > 0.0), less >= 0.0) else {
            let message = "CYCLE83 without a first depth, or with a factor (DAM below 0)";
            run.report
                .error("cycle", message, call.span)
                .help("write FDEP or FDPR, and DAM from 0 on");
            return;
        };
        let chips_out = call.value(12).unwrap_or(0.0) != 0.0;
        let factor = call.value(11).filter(|factor| *factor > 0.0).unwrap_or(1.0);
        let feed = self
            .modal
            .feed
            .map(|feed| feed.value * feed.mm_per_unit / self.modal.mm_per_unit);
        let back = value(15).filter(|back| *back > 0.0).unwrap_or(unit);
        // The clearance before the last depth ("CYCLE83": 0.6 mm to a depth of
        // 30 mm, then a fiftieth, 7 mm at most).
        let clearance = match value(17).filter(|clearance| *clearance > 0.0) {
            Some(clearance) => clearance,
            None if total <= 30.0 => 0.6,
            None => (total / 50.0).min(7.0),
        };
        self.plunge(state, MoveKind::Rapid, &levels, levels.safe, run);
        let (mut reached, mut stroke, mut last) = (first.min(total), first, false);
        for count in 0..=STROKES_MAX {
            if count == STROKES_MAX {
                run.report
                    .error("cycle", "CYCLE83 with more than 10000 strokes", call.span)
                    .help("write a larger first depth");
                return;
            }
            let level = levels.reference + levels.sign * reached;
            let share = if count == 0 { factor } else { 1.0 };
            self.plunge_at(state, feed.map(|feed| feed * share), &levels, level, run);
            self.cycle_wait(call.value(9), run);
            if reached >= total {
                break;
            }
            if chips_out {
                self.plunge(state, MoveKind::Rapid, &levels, levels.safe, run);
                self.cycle_wait(call.value(10), run);
                let near = level - levels.sign * clearance;
                if (near - levels.safe) * levels.sign > 0.0 {
                    self.plunge(state, MoveKind::Rapid, &levels, near, run);
                }
            } else {
                self.plunge(
                    state,
                    MoveKind::Feed,
                    &levels,
                    level - levels.sign * back,
                    run,
                );
            }
            // Shorter by DAM while it stays longer than DAM; the last two alike.
            if stroke - less >= less && less > 0.0 {
                stroke -= less;
            } else if less > 0.0 {
                stroke = less;
            }
            stroke = stroke.max(least);
            let left = total - reached;
            if last {
                stroke = left;
            } else if left > stroke && left < 2.0 * stroke {
                stroke = left / 2.0;
                last = true;
            }
            reached = (reached + stroke).min(total);
        }
        self.plunge(state, MoveKind::Rapid, &levels, levels.retract, run);
    }

    /// A pitch in the unit that `_PITA` names; 0 is that of the program.
    fn pitch_mm(&self, pitch: f64, unit: f64) -> f64 {
        match unit {
            1.0 => pitch,
            2.0 => MM_PER_INCH / pitch,
            3.0 => pitch * MM_PER_INCH,
            _ => pitch * self.modal.mm_per_unit,
        }
    }

    /// "Rigid tapping (CYCLE84)", "Tapping with compensating chuck (CYCLE840)":
    /// the axis follows the spindle, pitch times speed.
    pub(super) fn tap(
        &mut self,
        state: &mut Siemens,
        levels: Levels,
        call: &Call,
        run: &mut Run<'_, '_>,
    ) {
        let rigid = call.kind == Kind::Tap;
        let [size, pitch] = if rigid { [8, 9] } else { [10, 11] };
        let signed = call.value(size);
        let size = signed.map(f64::abs).filter(|size| *size > 0.0);
        let standard_mm = size.and_then(|size| {
            let found = PITCHES
                .iter()
                .find(|(known, _)| (*known - size).abs() < 1e-9)?;
            Some(found.1)
        });
        let unit = call.value(if rigid { 14 } else { 13 });
        let pitch = call.value(pitch).filter(|pitch| *pitch != 0.0);
        let left_hand = pitch.or(signed).is_some_and(|pitch| pitch < 0.0);
        let pitch = pitch.map(f64::abs);
        let pitch_mm = pitch.map(|pitch| self.pitch_mm(pitch, unit.unwrap_or(0.0)));
        let speed = |place| call.value(place).map(f64::abs).filter(|speed| *speed > 0.0);
        let spindle = Some(self.followed_rpm()).filter(|rpm| *rpm > 0.0);
        let speed_in = if rigid { speed(11) } else { None }.or(spindle);
        let speed_out = if rigid { speed(12) } else { None }.or(speed_in);
        let (Some(pitch_mm), Some(speed_in), Some(speed_out)) =
            (pitch_mm.or(standard_mm), speed_in, speed_out)
        else {
            let message = "a tapping cycle without its pitch (MPIT 3 to 48 or PIT) or speed";
            run.report
                .error("cycle", message, call.span)
                .help("write MPIT or PIT, and the speed (SST, or S before)");
            return;
        };
        if !state.feed_factor.is_normal() {
            return;
        }
        let sign = if left_hand { -1.0 } else { 1.0 };
        let speeds = [speed_in * sign, -speed_out * sign];
        self.plunge(state, MoveKind::Rapid, &levels, levels.safe, run);
        // Overrides do not act on tapping.
        let factor = std::mem::replace(&mut state.feed_factor, 1.0);
        let after = self.tap_begins(rigid, call, run);
        for (rpm, to) in speeds.into_iter().zip([levels.depth, levels.safe]) {
            if rigid {
                self.tap_turns(rpm, run);
            }
            self.special.speed_mm_s = Some(pitch_mm * rpm.abs() / SECONDS_PER_MINUTE);
            self.plunge(state, MoveKind::Tap, &levels, to, run);
            if to == levels.depth {
                self.cycle_wait(call.value(6), run);
            }
            if !rigid && to == levels.depth {
                self.cycle_turns(self.special.spindle.reversed(), run);
            }
        }
        self.special.speed_mm_s = None;
        state.feed_factor = factor;
        if rigid {
            self.tap_turns(0.0, run);
            let own = [speed_in, speed_out].map(|rpm| rpm.max(self.spindle.left_rpm));
            self.spindle.left_rpm = own[0].max(own[1]);
            self.tell_spindle(run);
        }
        self.plunge(state, MoveKind::Rapid, &levels, levels.retract, run);
        if let Some(after) = after {
            self.cycle_turns(after, run);
        }
    }

    /// How the spindle turns after a tap (SDAC); `None`: as before. A rigid one begins with an
    /// oriented stop, the other needs a spindle that turns.
    fn tap_begins(&mut self, rigid: bool, call: &Call, run: &mut Run<'_, '_>) -> Option<Turning> {
        let after = match call.value(if rigid { 7 } else { 8 }) {
            Some(3.0) => Some(Turning::Clockwise),
            Some(4.0) => Some(Turning::CounterClockwise),
            Some(5.0) => Some(Turning::Stopped),
            _ => None,
        };
        if rigid {
            if after.is_some() {
                self.cycle_turns(Turning::Stopped, run);
            }
            return after;
        }
        let turns = |turning: &Turning| *turning != Turning::Stopped;
        let before = Some(self.special.spindle).filter(turns);
        let into = before.or(after.filter(turns)).unwrap_or(Turning::Clockwise);
        if before.is_none() {
            self.cycle_turns(into, run);
        }
        Some(after.unwrap_or(into))
    }

    /// A cycle turns the spindle or stops it. Whether the path goes on meanwhile is not known,
    /// as for M words of others.
    fn cycle_turns(&mut self, turning: Turning, run: &mut Run<'_, '_>) {
        self.special.spindle = turning;
        self.note_spindle(run);
        if self.machine.spindle.is_some() {
            run.act(ActionKind::Other, turning.other_word());
        }
    }

    /// "Boring 1 (CYCLE85)": in at FFR, out at RFF. CYCLE89: both at F.
    pub(super) fn cycle_bore(
        &mut self,
        state: &mut Siemens,
        levels: Levels,
        call: &Call,
        run: &mut Run<'_, '_>,
    ) {
        self.plunge(state, MoveKind::Rapid, &levels, levels.safe, run);
        let [feed_in, feed_out] = [7, 8].map(|place| call.value(place).filter(|_| call.feeds));
        self.plunge_at(state, feed_in, &levels, levels.depth, run);
        self.cycle_wait(call.value(6), run);
        self.plunge_at(state, feed_out, &levels, levels.safe, run);
        self.plunge(state, MoveKind::Rapid, &levels, levels.retract, run);
    }

    /// "Boring 2 (CYCLE86)": SDIR turns the spindle, and after an oriented stop the tool moves
    /// aside by RPA, RPO and RPAP before it goes out.
    pub(super) fn bore_aside(
        &mut self,
        state: &mut Siemens,
        levels: Levels,
        call: &Call,
        run: &mut Run<'_, '_>,
    ) {
        let [first, second, normal] = self.modal.plane;
        let here = state.program_place(&self.position.at);
        let turning = match call.value(7) {
            Some(3.0) => Turning::Clockwise,
            Some(4.0) => Turning::CounterClockwise,
            // Left out: as before, or as it is used to.
            _ if self.special.spindle == Turning::Stopped => Turning::Clockwise,
            _ => self.special.spindle,
        };
        self.cycle_turns(turning, run);
        self.plunge(state, MoveKind::Rapid, &levels, levels.safe, run);
        self.plunge(state, MoveKind::Feed, &levels, levels.depth, run);
        self.cycle_wait(call.value(6), run);
        self.cycle_turns(Turning::Stopped, run);
        let by = |place| call.value(place).unwrap_or(0.0) * self.modal.mm_per_unit;
        let aside = [
            (first, here[first] + by(8)),
            (second, here[second] + by(9)),
            (normal, levels.depth + by(10)),
        ];
        let target = self.target_at(state, &aside);
        self.siemens_go(state, run, MoveKind::Rapid, &target, None);
        self.plunge(state, MoveKind::Rapid, &levels, levels.safe, run);
        let over = [
            (first, here[first]),
            (second, here[second]),
            (normal, levels.retract),
        ];
        let target = self.target_at(state, &over);
        self.siemens_go(state, run, MoveKind::Rapid, &target, None);
    }
}
