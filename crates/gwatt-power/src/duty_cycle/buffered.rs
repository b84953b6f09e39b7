//! What is kept of a move until it is its turn.

use super::Track;
use super::rating::Place;
use super::span::Late;
use super::spindle_load::Levels;
use super::terms::Terms;
use crate::model::PowerModel;
use crate::trace::{Line, Slice};

/// One move that waits for its neighbours or for the spindle, by track.
#[derive(Debug, Clone, Default)]
pub(crate) struct Buffered(Vec<Own>);

/// What one track is to take.
#[derive(Debug, Clone, Default)]
struct Own {
    slices: Vec<Slice>,
    /// What may come when the move is over at the largest overrides, of a bound.
    late: Vec<Late>,
    /// Instead of slices: no more power than this, and what the slices come from.
    line: Option<(f64, Line)>,
    /// Of a bound over all lower overrides what else it has to know.
    terms: Terms,
    /// What the step of speed before the last piece adds.
    step: Added,
}

/// A power that comes on top for so long at most.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Added {
    pub more_w: f64,
    pub lasts_s: f64,
}

impl Buffered {
    pub fn clear(&mut self) {
        for own in &mut self.0 {
            own.slices.clear();
            own.late.clear();
            own.line = None;
            own.terms = Terms::default();
            own.step = Added::default();
        }
    }

    fn own(&mut self, track: usize) -> Option<&mut Own> {
        if track >= self.0.len() {
            self.0.resize_with(track + 1, Own::default);
        }
        self.0.get_mut(track)
    }

    #[inline]
    pub fn push(&mut self, track: usize, slice: Slice) {
        if let Some(own) = self.own(track) {
            own.slices.push(slice);
        }
    }

    /// What may come when the move is over at the largest overrides.
    pub(super) fn push_late(&mut self, track: usize, slice: Slice) {
        if let Some(own) = self.own(track) {
            let slower = false;
            own.late.push(Late { slice, slower });
        }
    }

    /// The same of places that are passed more slowly then.
    pub(super) fn push_passed(&mut self, track: usize, slices: impl Iterator<Item = Slice>) {
        if let Some(own) = self.own(track) {
            let slower = true;
            own.late.extend(slices.map(|slice| Late { slice, slower }));
        }
    }

    /// Takes the last seconds.
    pub(super) fn take_end(&mut self, track: usize, lasts_s: f64) -> Vec<Slice> {
        let Some(Own { slices, .. }) = self.own(track) else {
            return Vec::new();
        };
        let (mut taken, mut left_s) = (Vec::new(), lasts_s);
        while left_s > 0.0
            && let Some(slice) = slices.pop()
        {
            let [rest, end] = slice.cut(slice.duration_s - left_s);
            left_s -= slice.duration_s;
            slices.extend(rest);
            taken.extend(end);
        }
        taken.reverse();
        taken
    }

    /// Takes the first seconds.
    pub(super) fn take_start(&mut self, track: usize, lasts_s: f64) -> Vec<Slice> {
        let Some(Own { slices, .. }) = self.own(track) else {
            return Vec::new();
        };
        let (mut taken, mut left_s) = (Vec::new(), lasts_s);
        let mut rest = None;
        let mut count = 0;
        for slice in &*slices {
            if left_s <= 0.0 {
                break;
            }
            let [start, after] = slice.cut(left_s);
            left_s -= slice.duration_s;
            taken.extend(start);
            rest = after;
            count += 1;
        }
        slices.splice(..count, rest);
        taken
    }

    /// Puts slices before the others.
    pub(super) fn put_first(&mut self, track: usize, first: impl Iterator<Item = Slice>) {
        if let Some(own) = self.own(track) {
            own.slices.splice(..0, first);
        }
    }

    /// A line with no more power than `most_w`, for a track of stores alone.
    pub fn push_line(&mut self, track: usize, most_w: f64, line: Line) {
        if let Some(own) = self.own(track) {
            own.line = Some((most_w, line));
        }
    }

    /// What else a bound has to know.
    pub(super) fn terms(&mut self, track: usize) -> Option<&mut Terms> {
        self.own(track).map(|own| &mut own.terms)
    }

    /// What the step of speed before the last piece adds.
    pub(super) fn step(&mut self, track: usize) -> Option<&mut Added> {
        self.own(track).map(|own| &mut own.step)
    }

    /// The largest power of the slices of a track from one on.
    pub fn peak_w(&self, track: usize, from: usize) -> f64 {
        let slices = self.slices(track).iter().skip(from);
        slices.fold(0.0, |most, slice| {
            crate::demand::larger(most, slice.peak_w())
        })
    }

    /// The slices of one track.
    pub fn slices(&self, track: usize) -> &[Slice] {
        self.0.get(track).map_or(&[], |own| &own.slices)
    }
}

impl Track {
    /// Takes its share of a move, with what comes on top. Where the power changes
    /// nothing but means, and that is plain, only these are passed on; of a line that
    /// is bounded only the time counts then.
    pub fn take_kept(
        &mut self,
        index: usize,
        model: &PowerModel,
        kept: &mut Buffered,
        spindle: &mut Levels<'_>,
        place: Place,
    ) {
        let terms = kept.0.get(index).map(|own| own.terms);
        let terms = terms.filter(|_| self.bounds);
        let terms = terms.map(|terms| terms.raised(spindle.lasting_w()).capped(self.most_w));
        if let Some(terms) = &terms {
            self.limits.begin(terms, self.time_s, place);
            if let Some(apart) = &terms.apart {
                let rest_w = terms.rest_w - spindle.lasting_w() + spindle.largest_w();
                self.limits.apart(apart, rest_w, self.time_s, place);
                self.time_s += apart.duration_s;
            }
        }
        let largest_w = spindle.largest_w();
        self.take_slices(index, model, kept, spindle, place);
        if let Some(terms) = &terms {
            let late = kept.0.get(index).map_or(&[][..], |own| &own.late);
            for late in late {
                let slice = self.capped(&late.slice.raised(largest_w));
                self.limits
                    .late(&Late { slice, ..*late }, self.time_s, place);
            }
            self.limits.end(terms, self.time_s, place);
        }
    }

    fn take_slices(
        &mut self,
        index: usize,
        model: &PowerModel,
        kept: &mut Buffered,
        spindle: &mut Levels<'_>,
        place: Place,
    ) {
        let Some(Own { slices, line, .. }) = kept.0.get_mut(index) else {
            return;
        };
        let steady = spindle
            .steady_w()
            .map(|more_w| (more_w, self.limits.calm_w()));
        if let Some((most_w, line)) = line {
            if let Some((more_w, calm_w)) = steady
                && *most_w + more_w <= calm_w
            {
                let before_s = self.time_s;
                self.time_s = line.durations_s().fold(before_s, |time, own| time + own);
                let lasts_s = self.time_s - before_s;
                self.limits.pass((*most_w + more_w) * lasts_s, lasts_s);
                return;
            }
            if let Some(tracer) = self.tracer(model) {
                tracer.line_slices(line, &mut |slice| slices.push(slice));
            }
        }
        if let Some((more_w, calm_w)) = steady {
            let raised = slices.iter().map(|slice| slice.raised(more_w));
            if raised.clone().all(|slice| slice.keeps_below(calm_w)) {
                for slice in raised {
                    self.limits.take_calm(&slice, self.time_s, place);
                    self.time_s += slice.duration_s;
                }
                return;
            }
        }
        for slice in &*slices {
            spindle.add(slice, &mut |slice| self.take(slice, place));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::duty_cycle::limits::Limits;
    use crate::duty_cycle::{Level, Track};
    use crate::trace::Flow;
    use gwatt_machine::Machine;

    const MACHINE: &str = "schema = 1\nname = \"test\"\ncontroller = \"iso\"\n[converter]\n\
        peak_power_w = 3000\ncontinuous_power_w = 1000\nwindow_s = 5\n\
        overload = [{ power_w = 2000, seconds = 1, every_s = 3 }, { power_w = 3000, seconds = 1, every_s = 2 }]\n\
        capacitance_f = 0.1\nbus_nominal_v = 500\nbus_min_v = 400\n\
        [axes.X]\nrapid_mm_min = 30000\naccel_mm_s2 = 2000\nmass_kg = 700\n";

    /// Powers around all limits: what is found is the same, to the last bit.
    #[test]
    fn what_changes_nothing_is_passed() {
        let (machine, _) = Machine::from_toml("test.toml", MACHINE).expect("a machine");
        let model = PowerModel::new(&machine);
        let track = || Track {
            converter: 0,
            flow: Flow::Drawn,
            limits: Limits::drawn(&machine.converters[0], 0.0, 3000.0),
            time_s: 0.0,
            bounds: false,
            ends: false,
            most_w: f64::INFINITY,
        };
        let (mut quick, mut general) = (track(), track());
        let mut seed = 1_u32;
        let mut next = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(seed >> 8) / f64::from(1 << 24)
        };
        for line in 1..=3000 {
            // Some moves far below the limits, some near, and some above.
            let most_w = [600.0, 1400.0, 2400.0, 3600.0][(next() * 4.0) as usize];
            let mut kept = Buffered::default();
            for _ in 0..3 {
                let [from_w, to_w] = [next(), next()].map(|share| share * most_w);
                kept.push(0, Slice::linear(1e-3 + 0.2 * next(), from_w, to_w));
            }
            let level = Level {
                duration_s: 1.0,
                drawn_w: 300.0 * next(),
                fed_back_w: 0.0,
                lasting_w: 0.0,
            };
            let levels = [level];
            let place = Place { line, text: 0 };
            let mut spindle = Levels::new(&levels, &general, 0);
            for slice in kept.slices(0) {
                spindle.add(slice, &mut |slice| general.take(slice, place));
            }
            let mut spindle = Levels::new(&levels, &quick, 0);
            quick.take_kept(0, &model, &mut kept, &mut spindle, place);
            assert_eq!(quick.time_s, general.time_s);
            assert_eq!(
                quick.limits.ratings(0, false),
                general.limits.ratings(0, false)
            );
        }
        let used = quick.limits.ratings(0, false);
        assert!(used.iter().all(|rating| rating.value > 0.0), "{used:?}");
        let voltage = used.last().expect("a voltage").value;
        assert!(voltage < 500.0, "{voltage}");
    }
}
