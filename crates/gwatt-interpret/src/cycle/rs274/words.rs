//! The words of a canned cycle of RS274/NGC.

use super::Hole;
use crate::control::{Control, Run};
use gwatt_machine::ALL_AXES;

impl Control<'_> {
    /// Reads the words of a cycle. `same`: the cycle of the block before;
    /// `series`: any cycle.
    pub(super) fn rs274_words(
        &mut self,
        number: u16,
        same: bool,
        series: bool,
        run: &mut Run<'_, '_>,
    ) -> Option<Hole> {
        let normal = self.modal.plane[2];
        let letter = ALL_AXES[normal].letter();
        let held = self.special.held.clone();
        let depth = run.words.take(letter).or(held.bottom.filter(|_| same));
        let level = run.words.take(b'R').or(held.r.filter(|_| same));
        let Some(level) = level else {
            run.cycle_needs("R", number);
            return None;
        };
        let Some(depth) = depth else {
            run.cycle_needs((letter as char).encode_utf8(&mut [0; 4]), number);
            return None;
        };
        self.special.held.r = Some(level);
        self.special.held.bottom = Some(depth);
        let (mut r, mut bottom) = (level, depth);
        if !self.modal.absolute {
            // From where the series began: R, and from there the depth.
            let initial_mm = self.initial_level(normal, !series);
            let offset_mm = self.position.absolute(normal, 0.0);
            r += (initial_mm - offset_mm) / self.modal.mm_per_unit;
            bottom += r;
        }
        if r < bottom {
            run.cycle_value(b'R', "R is below the bottom of the hole");
            return None;
        }
        let mut r_mm = self.level(normal, r);
        let initial_mm = self.initial_level(normal, !series);
        if (r_mm - initial_mm).abs() < 1e-9 {
            // The same but for rounding.
            r_mm = initial_mm;
        }
        let mut hole = Hole {
            number,
            r,
            bottom,
            r_mm,
            clear_mm: 0.0,
            dwell_s: 0.0,
            peck: 0.0,
            shift_mm: [0.0; 2],
            middle: 0.0,
        };
        self.rs274_own_words(&mut hole, same, run)?;
        Some(hole)
    }

    /// Reads what only some cycles have; `same`: the cycle of the block before.
    fn rs274_own_words(
        &mut self,
        hole: &mut Hole,
        same: bool,
        run: &mut Run<'_, '_>,
    ) -> Option<()> {
        let normal = self.modal.plane[2];
        let held = self.special.held.clone();
        match hole.number {
            730 | 830 => {
                let Some(peck) = run.words.take(b'Q').or(held.q.filter(|_| same)) else {
                    run.cycle_needs("Q", hole.number);
                    return None;
                };
                if peck <= 0.0 {
                    run.cycle_value(b'Q', "Q must be greater than 0");
                    return None;
                }
                self.special.held.q = Some(peck);
                hole.peck = peck;
            }
            740 | 820 | 840 | 860 | 880 | 890 => {
                let tap = matches!(hole.number, 740 | 840);
                let dwell = run
                    .words
                    .take(b'P')
                    .or(held.dwell_s.filter(|_| same || tap));
                let Some(dwell_s) = dwell.or(tap.then_some(0.0)) else {
                    run.cycle_needs("P", hole.number);
                    return None;
                };
                if !(0.0..=1e9).contains(&dwell_s) {
                    run.cycle_value(b'P', "the dwell is negative or beyond reason");
                    return None;
                }
                self.special.held.dwell_s = Some(dwell_s);
                hole.dwell_s = dwell_s;
            }
            870 => {
                let mut given = [0.0; 3];
                for (index, letter) in [(0, b'I'), (1, b'J'), (2, b'K')] {
                    let word = run.words.take(letter);
                    let Some(value) = word.or(held.ijk[index].filter(|_| same)) else {
                        run.cycle_needs("I, J and K", hole.number);
                        return None;
                    };
                    self.special.held.ijk[index] = Some(value);
                    given[index] = value;
                }
                let [first, second, _] = self.modal.plane;
                hole.shift_mm = [first, second].map(|axis| given[axis] * self.modal.mm_per_unit);
                hole.middle = given[normal]
                    + if self.modal.absolute {
                        0.0
                    } else {
                        hole.bottom
                    };
            }
            _ => {}
        }
        Some(())
    }
}
