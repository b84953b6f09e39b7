//! G73 to G89 as Fanuc and Haas mills have them (Fanuc operator's manual for
//! machining centres, "Canned cycle for drilling"; Haas mill operator's manual,
//! "Canned cycles").
//!
//! Every cycle: rapid to the place, rapid to R, the hole, and back to the
//! initial level (G98) or to R (G99). What was written once holds until G80 or
//! a word of G0 to G3.

use super::hole::{Hole, Pecks};
use crate::control::{Control, Run};
use crate::own_state::OwnState;
use crate::special::Turning;
use gwatt_machine::{ALL_AXES, AxisSet, AxisValues};
use gwatt_motion::CYCLE as FIXED;
use gwatt_motion::{ActionKind, FeedMode, MoveKind};

impl Control<'_> {
    /// Whether a cycle is the first of its series, in which values are kept; H of a tap holds for
    /// its own cycle alone.
    fn begins_cycles(&mut self, number: u16) -> bool {
        let begins = self.special.active == 0;
        if begins {
            self.special.held = super::Held::default();
        } else if self.special.active != number {
            (self.special.held.tap_h, self.special.held.tap_j) = (None, None);
        }
        begins
    }

    /// A block of a canned cycle.
    pub(crate) fn iso_cycle(&mut self, number: u16, run: &mut Run<'_, '_>) {
        run.facts.fixed = Some(FIXED);
        run.facts.cycle = true;
        if !self.cycle_axes_fit(run) {
            return;
        }
        if self.feed_mode_is(FeedMode::InverseTime) {
            let whole = run.whole();
            run.report
                .error("cycle-g93", "a canned cycle under G93", whole)
                .help("write G94 before it");
            return;
        }
        // On a Haas the operator takes the tool out after G87, as after G88.
        let by_hand = number == 870 && self.dialect().bores_by_hand;
        let number = if by_hand { 880 } else { number };
        let [first, second, normal] = self.modal.plane;
        let begins = self.begins_cycles(number);
        let initial_mm = self.initial_level(normal, begins);
        self.special.active = number;
        let own = self.d_and_h(number, run);
        let own = own.and_then(|()| self.return_by_j(number, run));
        let Some(repeats) = own.and_then(|()| self.iso_repeats(number, run)) else {
            return;
        };
        let Some(mut hole) = self.iso_words(number, initial_mm, run) else {
            return;
        };
        let from = self.position.at;
        let mut place = from;
        let Some(unknown) = self.targets(run, false, &mut place) else {
            return;
        };
        let keeps = matches!(&self.own, OwnState::Osp(osp) if osp.only_keeps);
        if repeats == 0
            || keeps
            || self
                .feed_speed(run, &self.position.at, None, 1.0, true)
                .is_none()
        {
            // K0 and L0 only take the values over.
            return;
        }
        if repeats > 1 && self.polar.is_some() && !self.modal.absolute {
            let whole = run.whole();
            let message = "a cycle repeated by increments under G16";
            run.report
                .error("cycle-repeats", message, whole)
                .help("write a block for each hole");
            return;
        }
        let Some(clear_mm) = self.iso_clear(hole.r_mm, initial_mm, run) else {
            return;
        };
        hole.clear_mm = clear_mm;
        let step: [f64; 2] = if self.modal.absolute {
            [0.0; 2]
        } else {
            [first, second].map(|axis| place[axis] - from[axis])
        };
        for repeat in 0..repeats {
            let before = run.steps.len();
            if repeat > 0 {
                place[first] += step[0];
                place[second] += step[1];
            }
            place[normal] = self.position.at[normal];
            let unknown = if repeat == 0 {
                unknown
            } else {
                AxisSet::default()
            };
            self.go(run, MoveKind::Rapid, &place, unknown, None);
            if number == 870 {
                self.iso_back_bore(&hole, &place, run);
            } else if !self.iso_hole(&hole, &mut place, run) {
                return;
            }
            if !run.within_limits() || repeat > 0 && !self.count_repeated(before, run) {
                return;
            }
        }
    }

    /// The level that the cycle returns to.
    fn iso_clear(&mut self, r_mm: f64, initial_mm: f64, run: &mut Run<'_, '_>) -> Option<f64> {
        if self.rules.cycle_levels_by_m {
            return self.osp_clear(r_mm, run);
        }
        Some(if self.special.to_initial {
            initial_mm
        } else {
            r_mm
        })
    }

    /// The number of repeats: K on a Fanuc, L on a Haas and on older controls.
    fn iso_repeats(&self, number: u16, run: &mut Run<'_, '_>) -> Option<u64> {
        if run.words.has(b'L') {
            return run.repeats(b'L');
        }
        // K may be a shift outside of XY.
        let shifts = matches!(number, 760 | 870) && self.modal.plane[2] != 2;
        if shifts || self.machine.controller.language.cycles_repeat_by_l {
            return Some(1);
        }
        run.repeats(b'K')
    }

    /// Reads the words of a cycle.
    fn iso_words(&mut self, number: u16, initial_mm: f64, run: &mut Run<'_, '_>) -> Option<Hole> {
        let [first, second, normal] = self.modal.plane;
        let letter = ALL_AXES[normal].letter();
        let unit = self.modal.mm_per_unit;
        let offset_mm = self.position.absolute(normal, 0.0);
        let from_initial = initial_mm - offset_mm;
        let absolute = self.modal.absolute;
        if let Some(value) = run.words.take(b'R') {
            let base_mm = if absolute { 0.0 } else { from_initial };
            self.special.held.r = Some(base_mm + value * unit);
        }
        if self.special.held.r.is_none() && !self.rules.cycle_levels_by_m {
            // An R that was never given is an increment of nothing.
            self.special.held.r = Some(from_initial);
            let message =
                "a canned cycle without R: the hole begins at the level where it is called";
            let whole = run.whole();
            run.report.note_once("cycle-without-r", message, whole);
        }
        let Some(r) = self.special.held.r else {
            run.cycle_needs("R", number);
            return None;
        };
        if let Some(value) = run.words.take(letter) {
            let base_mm = if absolute { 0.0 } else { r };
            self.special.held.bottom = Some(base_mm + value * unit);
        }
        let Some(bottom) = self.special.held.bottom else {
            run.cycle_needs((letter as char).encode_utf8(&mut [0; 4]), number);
            return None;
        };
        if number != 870 && bottom > r {
            run.cycle_value(b'R', "R is below the bottom of the hole");
            return None;
        }
        let dwell_s = self.iso_dwell(number, run).ok()?;
        let mut hole = Hole {
            number,
            r_mm: self.position.absolute(normal, r),
            bottom_mm: self.position.absolute(normal, bottom),
            clear_mm: 0.0,
            dwell_s,
            peck_mm: 0.0,
            pecks: Pecks::default(),
            shift_mm: [0.0; 2],
        };
        if matches!(number, 730 | 830) {
            hole.pecks = self.iso_peck_words(number, (r - bottom).abs(), run)?;
            let message = format!(
                "G73 and G83 stay {} mm off the last depth: a parameter of the control, \
                 peck_clearance_mm in the controller profile",
                self.machine.controller.language.peck_clearance_mm
            );
            let whole = run.whole();
            run.report.note_once("peck-clearance", &message, whole);
        }
        if matches!(number, 740 | 840) {
            hole.peck_mm = self.tap_peck(run).unwrap_or(0.0).abs() * unit;
        }
        if matches!(number, 760 | 870) {
            for (slot, letter) in [(0, b'I'), (1, b'J'), (2, b'K')] {
                if slot == first || slot == second {
                    self.special.held.ijk[slot] =
                        run.words.take(letter).or(self.special.held.ijk[slot]);
                }
            }
            self.special.held.q = self.cycle_q(None, run).or(self.special.held.q);
            hole.shift_mm = self.iso_shift([first, second], number, run)?;
        }
        if !(hole.r_mm.abs() < 1e9 && hole.bottom_mm.abs() < 1e9) {
            run.cycle_value(letter, "the position is beyond any machine");
            return None;
        }
        Some(hole)
    }

    /// The dwell that counts for this cycle, if any; an error where it makes no
    /// sense. A number without a decimal point means milliseconds.
    fn iso_dwell(&mut self, number: u16, run: &mut Run<'_, '_>) -> Result<Option<f64>, ()> {
        let word = run.words.word(b'P', run.block);
        let own = run.words.take(b'P');
        if let (Some(value), Some(word)) = (own, word) {
            let point = word.number.of(run.report.text).contains(&b'.');
            let mut dwell = self.machine.controller.language.dwell.iter();
            let with_point = dwell.find(|(letter, _)| *letter == b'P');
            let unit_s = if point {
                with_point.map_or(1.0, |(_, unit_s)| *unit_s)
            } else {
                self.rules.whole_cycle_dwell_s
            };
            let seconds = value * unit_s;
            if !(0.0..=1e9).contains(&seconds) {
                run.cycle_value(b'P', "the dwell is negative or beyond reason");
                return Err(());
            }
            self.special.held.dwell_s = Some(seconds);
        }
        Ok(match number {
            740 | 760 | 820 | 840 | 880 | 890 => self.special.held.dwell_s,
            // Some controls wait here too, where P stands in the block.
            730 | 830 | 860 | 870 => self.special.held.dwell_s.filter(|_| own.is_some()),
            _ => None,
        })
    }

    /// The shift of G76 and G87: by I, J, K, or by Q in a direction that is a
    /// parameter of the control.
    fn iso_shift(&self, plane: [usize; 2], number: u16, run: &mut Run<'_, '_>) -> Option<[f64; 2]> {
        let held = &self.special.held;
        let unit = self.modal.mm_per_unit;
        let given = plane.map(|axis| held.ijk.get(axis).copied().flatten());
        if given != [None, None] {
            return Some(given.map(|value| value.unwrap_or(0.0) * unit));
        }
        let Some(q) = held.q else {
            run.cycle_needs("Q, or I and J", number);
            return None;
        };
        let letter = ALL_AXES[plane[0]].letter() as char;
        let whole = run.whole();
        let message = format!(
            "the direction of the shift Q is a parameter of the control: taken as +{letter}"
        );
        run.report.note_once("boring-shift", &message, whole);
        Some([q.abs() * unit, 0.0])
    }

    /// Whether the axis goes further than R at the end of a hole.
    fn retracts(&self, hole: &Hole) -> bool {
        let unsure = self.position.points.apart() && self.special.to_initial;
        hole.clear_mm != hole.r_mm || unsure
    }

    /// The moves at one place but those of G87; false when they are too many.
    fn iso_hole(&mut self, hole: &Hole, place: &mut AxisValues, run: &mut Run<'_, '_>) -> bool {
        use MoveKind::{Feed, Rapid};
        let normal = self.modal.plane[2];
        let mut to = |control: &mut Self, run: &mut Run<'_, '_>, kind, level_mm| {
            place[normal] = level_mm;
            control.part(run, kind, place);
        };
        let turning = self.special.spindle;
        if self.position.at[normal] != hole.r_mm || self.position.points.apart() {
            to(self, run, Rapid, hole.r_mm);
        }
        match hole.number {
            730 | 830 => {
                if !self.iso_pecks(hole, place, run) {
                    return false;
                }
            }
            740 | 840 => {
                if !self.iso_tap(hole, place, run) {
                    return false;
                }
                if self.retracts(hole) {
                    place[normal] = hole.clear_mm;
                    self.part(run, Rapid, place);
                }
            }
            850 | 890 => {
                to(self, run, Feed, hole.bottom_mm);
                self.iso_wait(hole, run);
                to(self, run, Feed, hole.r_mm);
                if self.retracts(hole) {
                    to(self, run, Rapid, hole.clear_mm);
                }
            }
            760 => {
                to(self, run, Feed, hole.bottom_mm);
                self.iso_wait(hole, run);
                run.spin(Turning::Stopped);
                let [first, second, _] = self.modal.plane;
                let mut shifted = *place;
                shifted[first] += hole.shift_mm[0];
                shifted[second] += hole.shift_mm[1];
                self.part(run, Rapid, &shifted);
                shifted[normal] = hole.clear_mm;
                self.part(run, Rapid, &shifted);
                place[normal] = hole.clear_mm;
                self.part(run, Rapid, place);
                run.spin(turning);
            }
            880 => {
                to(self, run, Feed, hole.bottom_mm);
                self.iso_wait(hole, run);
                run.spin(Turning::Stopped);
                run.act(ActionKind::Stop, 0.0);
                run.spin(turning);
                // The operator has retracted the tool to somewhere.
                self.position.unknown.insert(normal);
                place[normal] = hole.clear_mm;
                self.go(run, Rapid, place, AxisSet(1 << normal), None);
            }
            number => {
                to(self, run, Feed, hole.bottom_mm);
                self.iso_wait(hole, run);
                if number == 860 {
                    run.spin(Turning::Stopped);
                }
                to(self, run, Rapid, hole.clear_mm);
                if number == 860 {
                    run.spin(turning);
                }
            }
        }
        true
    }

    /// G87: down next to the hole's axis to R, then a bore upwards to Z.
    fn iso_back_bore(&mut self, hole: &Hole, place: &AxisValues, run: &mut Run<'_, '_>) {
        use MoveKind::{Feed, Rapid};
        if !self.special.to_initial {
            let whole = run.whole();
            run.report
                .error("cycle-word", "G87 cannot return to R (G99)", whole)
                .help("write G98: the way back is next to the hole, to the initial level");
            return;
        }
        let [first, second, normal] = self.modal.plane;
        let turning = self.special.spindle;
        let mut center = *place;
        let mut shifted = *place;
        shifted[first] += hole.shift_mm[0];
        shifted[second] += hole.shift_mm[1];
        run.spin(Turning::Stopped);
        self.part(run, Rapid, &shifted);
        shifted[normal] = hole.r_mm;
        self.part(run, Rapid, &shifted);
        center[normal] = hole.r_mm;
        self.part(run, Rapid, &center);
        run.spin(turning);
        center[normal] = hole.bottom_mm;
        self.part(run, Feed, &center);
        self.iso_wait(hole, run);
        run.spin(Turning::Stopped);
        shifted[normal] = hole.bottom_mm;
        self.part(run, Rapid, &shifted);
        shifted[normal] = hole.clear_mm;
        self.part(run, Rapid, &shifted);
        center[normal] = hole.clear_mm;
        self.part(run, Rapid, &center);
        run.spin(turning);
    }

    pub(super) fn iso_wait(&self, hole: &Hole, run: &mut Run<'_, '_>) {
        if let Some(dwell_s) = hole.dwell_s {
            self.dwell(run, dwell_s);
        }
    }
}
