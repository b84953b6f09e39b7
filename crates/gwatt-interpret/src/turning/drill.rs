//! G83 to G85 along Z and G87 to G89 along X ("Canned Cycle for Drilling
//! (G80-G89)" of lathes): R is a distance from where the cycle begins, and the
//! tool comes back to there, in G-code systems B and C to R under G99.
//!
//! Haas ("G81 Drill Canned Cycle" to "G89", lathe operator's manual 96-8900): all along Z, R is
//! the place of the R plane.

use super::state::Hole;
use super::words::turning_needs;
use super::{X, Z};
use crate::control::{Control, Run};
use crate::special::Turning as Spin;
use gwatt_machine::{ALL_AXES, AxisSet, AxisValues};
use gwatt_motion::ActionKind;
use gwatt_motion::MoveKind::{Feed, Rapid, Tap};

/// Why it is not known how far its pecks return.
const BY_RETURN: &str = "how far its pecks return is a parameter of the control: say \
                         pecks_return_to_r under [language] of the machine file";
/// Why a hole that ends at R is not written out.
const ENDS_AT_R: &str = "it returns to R (G99), where the holes after it begin";
/// Dwells are in milliseconds unless they have a point.
const MILLISECOND_S: f64 = 1e-3;
/// The way out of G85 and G89 is this much faster.
const OUT_FACTOR: f64 = 2.0;

impl Control<'_> {
    pub(super) fn drill(&mut self, number: u16, run: &mut Run<'_, '_>) {
        let axis = self.axis_of_hole(number);
        let before = self.special.active;
        if before != number {
            // The initial level stays from one cycle to the next.
            let goes_on = matches!(before, 810..=890) && self.axis_of_hole(before) == axis;
            let begin = if goes_on {
                self.turning.hole.begin
            } else {
                self.position.at[axis]
            };
            self.special.active = number;
            self.turning.hole = Hole {
                begin,
                ..Hole::default()
            };
        }
        if !self.drill_words(number, axis, run) {
            return;
        }
        let by = if self.dialect().holes_along_z {
            b'L'
        } else {
            b'K'
        };
        let repeats = run.words.take(by).unwrap_or(1.0);
        let mut place = self.position.at;
        let Some(unknown) = self.targets(run, false, &mut place) else {
            return;
        };
        let hole = self.turning.hole;
        let Some(bottom) = hole.bottom else {
            let what = if axis == X { "X" } else { "Z" };
            turning_needs(what, number, run);
            return;
        };
        if repeats == 0.0 {
            return;
        }
        if repeats != 1.0 {
            let whole = run.whole();
            run.report
                .error(
                    "cycle-repeats",
                    "repeats of a drilling cycle of a lathe are not supported",
                    whole,
                )
                .help("write the places out");
            return;
        }
        // At the initial level, or at the R of the hole before.
        place[axis] = self.position.at[axis];
        self.go(run, Rapid, &place, unknown, None);
        let level = hole.begin + hole.level;
        let initial = self.special.to_initial;
        place[axis] = if initial { hole.begin } else { level };
        if self.dialect().holes_along_z && matches!(number, 860..=880) {
            return self.bore_and_stop(number, [level, bottom], place, run);
        }
        self.bore(number, axis, [level, bottom], place, run);
        if !initial {
            run.facts.guessed = Some(ENDS_AT_R);
        }
        if initial || self.position.at[axis] != level {
            self.part(run, Rapid, &place);
        }
    }

    /// The axis along which a cycle drills.
    fn axis_of_hole(&self, number: u16) -> usize {
        if number >= 870 && !self.dialect().holes_along_z {
            X
        } else {
            Z
        }
    }

    /// Takes the words of the hole; its axis is not a place any more.
    fn drill_words(&mut self, number: u16, axis: usize, run: &mut Run<'_, '_>) -> bool {
        if let Some(level) = self.plain_length(b'R', run) {
            let from = if self.dialect().holes_along_z {
                self.position.absolute(axis, 0.0) - self.turning.hole.begin
            } else {
                0.0
            };
            self.turning.hole.level = from + level;
        }
        let letter = ALL_AXES[axis].letter();
        let incremental = run.words.incremental & super::bit(letter) != 0 || !self.modal.absolute;
        if let Some(value) = run.words.take(letter) {
            let mm = self.length_mm(axis, value);
            let hole = &self.turning.hole;
            // An incremental depth counts from R on.
            let bottom = if incremental {
                hole.begin + hole.level + mm
            } else {
                self.position.absolute(axis, mm)
            };
            self.turning.hole.bottom = Some(bottom);
        }
        if let Some(peck) = self.fine_length(b'Q', run) {
            self.turning.hole.peck = Some(peck.abs()).filter(|peck| *peck > 0.0);
        }
        let point = run
            .words
            .word(b'P', run.block)
            .is_some_and(|word| word.number.of(run.report.text).contains(&b'.'));
        if let Some(dwell) = run.words.take(b'P') {
            let dwell_s = dwell * if point { 1.0 } else { MILLISECOND_S };
            if !(0.0..=1e9).contains(&dwell_s) {
                turning_needs("a dwell from 0 to 1e9 s", number, run);
                return false;
            }
            self.turning.hole.dwell_s = dwell_s;
        }
        true
    }

    /// From the level R to the bottom and out again.
    fn bore(
        &mut self,
        number: u16,
        axis: usize,
        [level, bottom]: [f64; 2],
        mut place: AxisValues,
        run: &mut Run<'_, '_>,
    ) {
        let hole = self.turning.hole;
        let mut to = |control: &mut Self, run: &mut Run<'_, '_>, kind, at| {
            place[axis] = at;
            control.part(run, kind, &place);
        };
        to(self, run, Rapid, level);
        match number {
            830 | 870 => {
                let inward = (bottom - level).signum();
                let off = self.machine.controller.language.peck_clearance_mm;
                let mut depth = level;
                if let Some(peck) = hole.peck {
                    if !self.machine.controller.language.pecks_return_to_r {
                        self.note_pecks(run);
                    }
                    while (bottom - depth) * inward > peck + 1e-9 && run.within_limits() {
                        depth += inward * peck;
                        to(self, run, Feed, depth);
                        to(self, run, Rapid, level);
                        to(self, run, Rapid, depth - inward * off.min(peck));
                    }
                }
                to(self, run, Feed, bottom);
                self.wait(hole.dwell_s, run);
            }
            810 | 820 => {
                to(self, run, Feed, bottom);
                self.wait(hole.dwell_s, run);
            }
            840 | 880 => {
                to(self, run, Tap, bottom);
                let into = self.special.spindle;
                run.spin(Spin::Stopped);
                self.wait(hole.dwell_s, run);
                run.spin(into.reversed());
                to(self, run, Tap, level);
                run.spin(into);
            }
            _ => {
                to(self, run, Feed, bottom);
                self.wait(hole.dwell_s, run);
                let feed = self.modal.feed;
                let faster = !self.dialect().holes_along_z;
                if let Some(feed) = self.modal.feed.as_mut().filter(|_| faster) {
                    feed.value *= OUT_FACTOR;
                }
                to(self, run, Feed, level);
                self.modal.feed = feed;
            }
        }
    }

    /// G86 to G88 of Haas: the spindle stops at the bottom; after G87 and G88 the operator
    /// retracts the tool to somewhere. `end`: where the cycle ends.
    fn bore_and_stop(
        &mut self,
        number: u16,
        [level, bottom]: [f64; 2],
        end: AxisValues,
        run: &mut Run<'_, '_>,
    ) {
        let turning = self.special.spindle;
        let mut place = end;
        place[Z] = level;
        self.part(run, Rapid, &place);
        place[Z] = bottom;
        self.part(run, Feed, &place);
        self.wait(self.turning.hole.dwell_s, run);
        run.spin(Spin::Stopped);
        if number == 860 {
            self.part(run, Rapid, &end);
            run.spin(turning);
            return;
        }
        run.act(ActionKind::Stop, 0.0);
        run.spin(turning);
        self.position.unknown.insert(Z);
        self.go(run, Rapid, &end, AxisSet(1 << Z), None);
    }

    fn wait(&self, dwell_s: f64, run: &mut Run<'_, '_>) {
        if dwell_s > 0.0 {
            self.dwell(run, dwell_s);
        }
    }

    fn note_pecks(&self, run: &mut Run<'_, '_>) {
        let whole = run.whole();
        let message = if self.dialect().holes_along_z {
            "G83 is taken to come out to R after each peck and to stay 1 mm off the last depth: \
             Settings 52 and 22 of the control; say pecks_return_to_r = true and peck_clearance_mm \
             under [language] of the machine file"
        } else {
            "G83 and G87 are taken to come out to R after each peck and to stay 1 mm off the \
             last depth, which are parameters of the control (5101 bit RTR, 5114): say \
             pecks_return_to_r = true and peck_clearance_mm under [language] of the machine file"
        };
        run.facts.guessed = Some(BY_RETURN);
        run.report.note_once("peck-clearance", message, whole);
    }
}
