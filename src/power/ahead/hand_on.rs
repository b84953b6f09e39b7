//! Moves that nothing can change any more, on their way out.

use super::Ahead;
use super::open::Open;
use crate::interpret::Move;
use crate::machine::Machine;
use crate::plan::{Overrides, blended_bound};
use crate::power::assessment::{Assessment, Certificate};
use crate::power::demand::Demand;
use crate::power::eye::Eye;
use crate::power::model::PowerModel;
use crate::power::robust::Part;

impl Ahead {
    /// Hands on the moves that are finished, and whose neighbours are. All, when
    /// nothing moves behind the last one.
    #[inline]
    pub fn hand_on(
        &mut self,
        machine: &Machine,
        model: &PowerModel,
        eye: &mut Eye,
        sink: &mut impl FnMut(&Move, &Assessment, &[u8]),
    ) {
        let nominal = self.nominal.as_ref();
        let nominal = nominal.map_or(u64::MAX, |nominal| nominal.next);
        let finished = self.largest.next.min(nominal);
        while let Some(front) = self.open.front() {
            if !front.moves {
                // Those that do not move are passed.
                self.first += 1;
                if let Some(open) = self.open.pop_front() {
                    eye.pass();
                    sink(&open.mv, &open.assessment, &open.text);
                    self.spare.push(open);
                }
                continue;
            }
            if self.first + 1 >= finished && !self.at_rest {
                return;
            }
            let next = match self.open.get(1) {
                Some(next) if next.moves => Some(1),
                _ => (2..self.open.len())
                    .find(|&next| self.open.get(next).is_some_and(|next| next.moves)),
            };
            let known = self.first < finished
                && match next {
                    Some(next) => self.first + (next as u64) < finished,
                    None => self.at_rest,
                };
            if !known {
                return;
            }
            let Some(mut open) = self.open.pop_front() else {
                return;
            };
            self.first += 1;
            let next = next
                .and_then(|next| self.open.get(next - 1))
                .map(|next| &**next)
                .filter(|_| !open.rests);
            let before = self.before.as_deref().filter(|before| !before.rests);
            let certain = |beside: Option<&Open>| beside.is_none_or(|beside| beside.certain);
            // What no piece speaks of is not known.
            let planned = !open.assessment.ahead || open.assessment.top_speed_mm_s > 0.0;
            if planned && open.certain && certain(before) && certain(next) {
                open.assessment.blended = !open.alone;
                if open.assessment.ahead {
                    eye.kept(model, &open.mv, &mut open.kept);
                } else {
                    eye.alone(machine, model, &open.mv, self.largest.overrides);
                }
            } else {
                let overrides = self.largest.overrides;
                open.bound([before, next], machine, model, eye, overrides);
            }
            sink(&open.mv, &open.assessment, &open.text);
            self.spare.extend(self.before.replace(open));
        }
        // What comes next begins at rest.
        if self.at_rest {
            self.spare.extend(self.before.take());
        }
    }
}

impl Open {
    /// Gives it the robust bound, with those before and behind it.
    fn bound(
        &mut self,
        [before, next]: [Option<&Self>; 2],
        machine: &Machine,
        model: &PowerModel,
        eye: &mut Eye,
        largest: Overrides,
    ) {
        let mut kept = std::mem::take(&mut self.kept);
        let mut demand = {
            let own = &*self;
            let beside = [before.unwrap_or(own), own, next.unwrap_or(own)];
            let bounds = beside.map(|open| blended_bound(machine, &open.mv, largest));
            let [first, own, last] = &bounds;
            let part = |bound, index: usize| Part {
                bound,
                accel_mm_s2: &beside[index].mv.accel_mm_s2,
            };
            let window = [part(first, 0), part(own, 1), part(last, 2)];
            eye.blended(machine, model, &self.mv, &window, &mut kept, largest);
            model.robust_over(&self.mv, &window, self.want)
        };
        // Chords of a small arc may ask for more than the axes' limits.
        demand.include(&self.assessment.demand);
        self.assessment.demand = Demand {
            energy_j: self.assessment.demand.energy_j,
            ..demand
        };
        self.assessment.certificate = Certificate::Robust;
    }
}
