//! The figures of several ways through a program as one: of each the worst.

use std::cmp::Ordering;

use super::over_time::OverTime;
use super::{Certificate, Summary, Unfit};
use crate::power::Measure;

/// The place of the worst of these summaries: the one with the most moves that do not
/// fit, then the one that draws the most.
pub(super) fn worst(summaries: &[Summary]) -> usize {
    let order = |a: &Summary, b: &Summary| {
        let by_fit = a.fits().cmp(&b.fits()).reverse();
        by_fit
            .then(a.unfit_count.cmp(&b.unfit_count))
            .then(a.peak_w.total_cmp(&b.peak_w))
    };
    let mut worst = 0;
    for (place, summary) in summaries.iter().enumerate() {
        if summaries
            .get(worst)
            .is_some_and(|it| order(summary, it) == Ordering::Greater)
        {
            worst = place;
        }
    }
    worst
}

/// The figures of several ways as one; `None` where there is no way.
pub(super) fn worst_of(mut summaries: Vec<Summary>) -> Option<Summary> {
    let place = worst(&summaries);
    let mut all = (place < summaries.len()).then(|| summaries.swap_remove(place))?;
    for other in &summaries {
        all.worsen(other);
    }
    Some(all)
}

impl Summary {
    /// Takes what is worse in another way through the same program.
    pub(super) fn worsen(&mut self, other: &Self) {
        self.lines = self.lines.max(other.lines);
        self.moves = self.moves.max(other.moves);
        for (own, turns) in self.knobs.iter_mut().zip(other.knobs) {
            *own |= turns;
        }
        self.duration_s = self.duration_s.max(other.duration_s);
        if other.peak_w > self.peak_w {
            (self.peak_w, self.peak_line) = (other.peak_w, other.peak_line);
        }
        if other.regen_w > self.regen_w {
            (self.regen_w, self.regen_line) = (other.regen_w, other.regen_line);
        }
        self.energy_j = match (self.energy_j, other.energy_j) {
            (Some(own), Some(other)) => Some(own.max(other)),
            (own, _) => own,
        };
        let added = merge(&mut self.unfit, &other.unfit);
        self.unfit_count = (self.unfit_count + added).max(other.unfit_count);
        self.unfit
            .sort_by(|a, b| (&a.file, a.line).cmp(&(&b.file, b.line)));
        self.unfit.truncate(Self::KEPT);
        merge(&mut self.worst, &other.worst);
        self.worst.sort_by(|a, b| b.overload.total_cmp(&a.overload));
        self.worst.truncate(super::totals::WORST);
        for found in &other.over_time {
            self.rate_worse(found);
        }
        for (own, other) in self.lower.iter_mut().zip(&other.lower) {
            for (own, other) in own.iter_mut().zip(other) {
                *own = own.or_worse(other);
            }
        }
        if other.certificate == Some(Certificate::Robust) {
            self.certificate = other.certificate;
        }
        self.ahead |= other.ahead;
        for note in &other.notes {
            if !self.notes.contains(note) {
                self.notes.push(note.clone());
            }
        }
    }

    /// Takes what was found about a limit over time, where it is worse.
    fn rate_worse(&mut self, found: &OverTime) {
        let same = |own: &&mut OverTime| {
            own.rating.converter == found.rating.converter
                && own.rating.measure == found.rating.measure
        };
        let Some(own) = self.over_time.iter_mut().find(same) else {
            return self.over_time.push(found.clone());
        };
        let beyond = |it: &OverTime| {
            let over = it.rating.value - it.rating.limit;
            if it.rating.measure == Measure::LowestVoltage {
                -over
            } else {
                over
            }
        };
        let bounds = [own.rating.bound, found.rating.bound].into_iter().flatten();
        let bound = bounds.reduce(if found.rating.measure == Measure::LowestVoltage {
            f64::min
        } else {
            f64::max
        });
        if -beyond(found) < -beyond(own) {
            *own = found.clone();
        }
        own.rating.bound = bound;
    }
}

/// Adds moves that do not fit, by line; the worst of each stays. How many runs came in
/// addition.
fn merge(own: &mut Vec<Unfit>, others: &[Unfit]) -> u64 {
    let mut added = 0;
    for other in others {
        let same = |it: &&mut Unfit| {
            it.line == other.line && it.file == other.file && it.kind == other.kind
        };
        match own.iter_mut().find(same) {
            Some(known) if known.overload >= other.overload => {}
            Some(known) => *known = other.clone(),
            None => {
                added += other.runs;
                own.push(other.clone());
            }
        }
    }
    added
}
