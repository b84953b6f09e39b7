//! G74 and G75: pecking along Z or X, column by column ("End Face Peck Drilling
//! Cycle (G74)", "Outer Diameter/Internal Diameter Drilling Cycle (G75)").

use super::words::{note_parameter, turning_needs};
use super::{X, Z};
use crate::control::{Control, Run};
use gwatt_motion::MoveKind::{Feed, Rapid};

impl Control<'_> {
    pub(super) fn groove(&mut self, number: u16, run: &mut Run<'_, '_>) {
        if !Self::names_x_or_z(run) {
            if let Some(back) = self.plain_length(b'R', run) {
                self.turning.back = Some(back.abs());
            }
            return;
        }
        // G74 goes in along Z and steps along X, G75 the other way.
        let (deep, across) = if number == 740 { (Z, X) } else { (X, Z) };
        let mut step = [None; 3];
        for (axis, fanuc, haas) in [(X, b'P', b'I'), (Z, b'Q', b'K')] {
            let own = self.fine_length(fanuc, run);
            step[axis] = own.or_else(|| self.fine_length(haas, run)).map(f64::abs);
        }
        let clearance = if run.words.has(b'D') { b'D' } else { b'R' };
        let clearance = self.plain_length(clearance, run).unwrap_or(0.0).abs();
        let at = self.position.at;
        let targets = [self.take_target(X, run), None, self.take_target(Z, run)];
        let bottom = targets[deep].unwrap_or(at[deep]);
        let last = targets[across].unwrap_or(at[across]);
        if targets[deep].is_none() {
            let what = if deep == Z { "Z" } else { "X" };
            turning_needs(what, number, run);
            return;
        }
        let given = self.machine.controller.language.groove_return_mm;
        let back = self.turning.back.or(given);
        if back.is_none() {
            note_parameter(run);
        }
        let back = back.unwrap_or(0.0);
        let aside = (last - at[across]).signum() * clearance;
        let mut column = at[across];
        loop {
            self.pecks(deep, bottom, step[deep], back, run);
            if !run.within_limits() {
                return;
            }
            let mut place = self.position.at;
            if aside != 0.0 {
                place[across] -= aside;
                self.part(run, Rapid, &place);
            }
            place[deep] = at[deep];
            self.part(run, Rapid, &place);
            if column == last {
                break;
            }
            let next = step[across].filter(|step| *step > 0.0);
            let Some(next) = next else {
                let what = if across == X { "P" } else { "Q" };
                turning_needs(what, number, run);
                return;
            };
            column = toward(column, last, next);
            place[across] = column;
            self.part(run, Rapid, &place);
        }
        self.part(run, Rapid, &at);
    }

    /// Down to the bottom in steps, with a return after each but the last.
    fn pecks(
        &mut self,
        deep: usize,
        bottom: f64,
        step: Option<f64>,
        back: f64,
        run: &mut Run<'_, '_>,
    ) {
        let mut place = self.position.at;
        let begin = place[deep];
        let out = if begin >= bottom { back } else { -back };
        let mut depth = begin;
        loop {
            depth = match step {
                Some(step) if step > 0.0 => toward(depth, bottom, step),
                _ => bottom,
            };
            place[deep] = depth;
            self.part(run, Feed, &place);
            if depth == bottom || !run.within_limits() {
                return;
            }
            if out != 0.0 {
                place[deep] = depth + out;
                self.part(run, Rapid, &place);
            }
        }
    }
}

/// A step from `from` on, not beyond `to`.
fn toward(from: f64, to: f64, step: f64) -> f64 {
    let left = to - from;
    if left.abs() <= step * (1.0 + 1e-9) {
        to
    } else {
        from + step * left.signum()
    }
}
