//! G73 and G83 of mills: the pecks (Fanuc operator's manual for machining centres, "High-speed
//! Peck Drilling Cycle", "Peck Drilling Cycle"; Haas mill operator's manual 96-8000, "G73" and
//! "G83": pecks that become smaller by I, J and K, and returns to R by K next to Q).

use super::hole::{Hole, Pecks};
use crate::control::{Control, Run};
use gwatt_machine::AxisValues;
use gwatt_motion::MoveKind;

impl Control<'_> {
    /// The words of G73 and G83 that say how deep pecks are in a hole of this depth.
    pub(super) fn iso_peck_words(
        &mut self,
        number: u16,
        depth_mm: f64,
        run: &mut Run<'_, '_>,
    ) -> Option<Pecks> {
        let unit = self.modal.mm_per_unit;
        let by_ijk = self.machine.controller.language.pecks_by_ijk;
        if by_ijk {
            for (held, letter) in self.special.held.pecks.iter_mut().zip([b'I', b'J', b'K']) {
                *held = run.words.take(letter).or(*held);
            }
        }
        let [i, j, k] = if by_ijk {
            self.special
                .held
                .pecks
                .map(|value| value.map(|it| it.abs() * unit))
        } else {
            [None; 3]
        };
        if let (Some(first_mm), Some(less_mm), Some(least_mm)) = (i, j, k) {
            if first_mm == 0.0 || least_mm == 0.0 {
                run.cycle_value(b'K', "the pecks have no depth");
                return None;
            }
            return Some(Pecks {
                first_mm,
                less_mm,
                least_mm,
                out_after_mm: None,
            });
        }
        let depth = depth_mm / unit;
        self.special.held.q = self.cycle_q(Some(depth), run).or(self.special.held.q);
        let Some(q) = self.special.held.q.filter(|q| *q != 0.0) else {
            let needed = if by_ijk { "Q, or I, J and K" } else { "Q" };
            run.cycle_needs(needed, number);
            return None;
        };
        let pecks = Pecks::equal(q.abs() * unit);
        match [i, j, k] {
            [None, None, None] => Some(pecks),
            [None, None, Some(out_after_mm)] if number == 730 && out_after_mm > 0.0 => {
                Some(Pecks {
                    out_after_mm: Some(out_after_mm),
                    ..pecks
                })
            }
            _ => {
                let letter = [(b'I', i), (b'J', j), (b'K', k)];
                let given = letter.iter().find(|(_, value)| value.is_some());
                let message = "I, J and K go together, without Q; K alone goes with Q in G73";
                run.cycle_value(given.map_or(b'K', |(letter, _)| *letter), message);
                None
            }
        }
    }

    /// The pecks of G73 and G83, and the way out; false when they are too many.
    pub(super) fn iso_pecks(
        &mut self,
        hole: &Hole,
        place: &mut AxisValues,
        run: &mut Run<'_, '_>,
    ) -> bool {
        use MoveKind::{Feed, Rapid};
        let normal = self.modal.plane[2];
        let mut to = |control: &mut Self, run: &mut Run<'_, '_>, kind, level_mm| {
            place[normal] = level_mm;
            control.part(run, kind, place);
        };
        let off_mm = self.machine.controller.language.peck_clearance_mm;
        let mut peck_mm = hole.pecks.first_mm;
        let mut depth_mm = hole.r_mm;
        let mut since_out_mm = 0.0;
        loop {
            let next_mm = depth_mm - peck_mm;
            if next_mm <= hole.bottom_mm + 1e-9 {
                break;
            }
            if !run.within_limits() {
                return false;
            }
            depth_mm = next_mm;
            since_out_mm += peck_mm;
            to(self, run, Feed, depth_mm);
            let clears = hole.pecks.out_after_mm;
            if hole.number == 830 || clears.is_some_and(|after| since_out_mm >= after - 1e-9) {
                to(self, run, Rapid, hole.r_mm);
                since_out_mm = 0.0;
            }
            to(self, run, Rapid, (depth_mm + off_mm).min(hole.r_mm));
            peck_mm = hole.pecks.next(peck_mm);
        }
        to(self, run, Feed, hole.bottom_mm);
        self.iso_wait(hole, run);
        to(self, run, Rapid, hole.clear_mm);
        true
    }
}
