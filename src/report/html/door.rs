//! Leaves out samples that lie on a line between others.
//!
//! The swinging door (E. H. Bristol, 1990): from the last sample that was kept, each
//! further one leaves a range of slopes within which a straight line passes all of them
//! near enough. The sample before the first that fits in no more is kept.

use crate::machine::AXES;

/// Values of a sample.
pub(super) const VALUES: usize = AXES + 6;
/// The places of the base load and of moves from an unknown start among the values of a sample.
pub(super) const BASE: usize = AXES + 4;
pub(super) const UNKNOWN: usize = AXES + 5;

/// Values at an instant: what is drawn and fed back, then the axes, the spindle, cutting,
/// what is left (the base load and switched loads), and what moves from an unknown start may draw.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Sample {
    /// In s.
    pub time_s: f64,
    /// In W.
    pub values_w: [f64; VALUES],
}

/// Values that are kept where they turn: what is drawn and what is fed back.
const TURNING: usize = 2;

/// The door.
#[derive(Debug, Default)]
pub(super) struct Door {
    /// How far a line may pass a sample, W.
    apart_w: f64,
    kept: Option<Sample>,
    /// The last sample, and the one before it.
    last: Option<Sample>,
    before: Option<Sample>,
    /// The slopes that are left, W/s; none where nothing lies on a line with the last.
    slopes: Option<[[f64; 2]; VALUES]>,
}

impl Door {
    /// A door that lets a line pass a sample at `apart_w`.
    pub fn new(apart_w: f64) -> Self {
        Self {
            apart_w,
            ..Self::default()
        }
    }

    /// Takes the next sample, and hands over the one that is kept, if any.
    pub fn add(&mut self, sample: &Sample) -> Option<Sample> {
        let Some(kept) = self.kept else {
            self.keep(*sample);
            return Some(*sample);
        };
        let Some(last) = self.last else {
            self.slopes = self.narrowed(&kept, sample);
            self.pass(sample);
            return None;
        };
        let turns = self
            .before
            .is_some_and(|before| self.turns(&before, &last, sample));
        if !turns && let Some(slopes) = self.narrowed(&kept, sample) {
            self.slopes = Some(slopes);
            self.pass(sample);
            return None;
        }
        self.keep(last);
        self.slopes = self.narrowed(&last, sample);
        self.before = Some(last);
        self.last = Some(*sample);
        Some(last)
    }

    /// The last sample, at the end.
    pub fn finish(&mut self) -> Option<Sample> {
        self.kept = None;
        self.last.take()
    }

    fn keep(&mut self, sample: Sample) {
        self.slopes = Some([[f64::NEG_INFINITY, f64::INFINITY]; VALUES]);
        self.kept = Some(sample);
    }

    fn pass(&mut self, sample: &Sample) {
        self.before = self.last.or(self.kept);
        self.last = Some(*sample);
    }

    /// The door after a sample; `None` where the line to it does not pass.
    fn narrowed(&self, kept: &Sample, sample: &Sample) -> Option<[[f64; 2]; VALUES]> {
        let lasts_s = sample.time_s - kept.time_s;
        let mut slopes = self.slopes.filter(|_| lasts_s > 0.0)?;
        let pairs = kept.values_w.iter().zip(sample.values_w);
        for ((from, to), [low, high]) in pairs.zip(&mut slopes) {
            let slope = (to - from) / lasts_s;
            if slope < *low || slope > *high {
                return None;
            }
            let apart = self.apart_w / lasts_s;
            *low = low.max(slope - apart);
            *high = high.min(slope + apart);
        }
        Some(slopes)
    }

    /// Whether the power turns at `last`.
    fn turns(&self, before: &Sample, last: &Sample, next: &Sample) -> bool {
        (0..TURNING).any(|which| {
            let at = |sample: &Sample| sample.values_w[which];
            let (rise, fall) = (at(last) - at(before), at(next) - at(last));
            rise * fall < 0.0 && rise.abs().max(fall.abs()) > 1e-3 * self.apart_w
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn through(values: &[(f64, f64)]) -> Vec<(f64, f64)> {
        let mut door = Door::new(1.0);
        let mut kept = Vec::new();
        for (time_s, power_w) in values {
            let sample = Sample {
                time_s: *time_s,
                values_w: std::array::from_fn(|it| if it == 0 { *power_w } else { 0.0 }),
            };
            kept.extend(door.add(&sample));
        }
        kept.extend(door.finish());
        kept.into_iter()
            .map(|it| (it.time_s, it.values_w[0]))
            .collect()
    }

    #[test]
    fn a_line_keeps_its_ends() {
        let line: Vec<_> = (0..100)
            .map(|i| (f64::from(i), 3.0 * f64::from(i)))
            .collect();
        assert_eq!(through(&line), [(0.0, 0.0), (99.0, 297.0)]);
    }

    #[test]
    fn jumps_and_peaks_stay() {
        let jump = [
            (0.0, 0.0),
            (1.0, 0.0),
            (1.0, 500.0),
            (2.0, 500.0),
            (3.0, 500.0),
        ];
        assert_eq!(
            through(&jump),
            [(0.0, 0.0), (1.0, 0.0), (1.0, 500.0), (3.0, 500.0)]
        );
        let peak = [(0.0, 0.0), (1.0, 0.5), (2.0, 0.0), (3.0, 0.0)];
        assert!(through(&peak).contains(&(1.0, 0.5)));
    }

    /// No sample is farther from what is drawn than is allowed.
    #[test]
    fn all_samples_are_near() {
        let wave: Vec<_> = (0..2000)
            .map(|i| (f64::from(i) * 1e-2, 100.0 * libm::sin(f64::from(i) * 1e-2)))
            .collect();
        let kept = through(&wave);
        assert!(kept.len() < 200, "{}", kept.len());
        for (time_s, power_w) in wave {
            let next = kept.iter().position(|it| it.0 >= time_s).unwrap();
            let (b, a) = (kept[next], kept[next.saturating_sub(1)]);
            let share = if b.0 > a.0 {
                (time_s - a.0) / (b.0 - a.0)
            } else {
                1.0
            };
            let drawn_w = a.1 + share * (b.1 - a.1);
            assert!((drawn_w - power_w).abs() < 1.001, "{time_s}");
        }
    }
}
