//! Limits over time that the bound over all overrides does not settle: the square of feed
//! and rapid overrides is divided into ranges, each with a bound of its own, until the
//! limit is kept in all of them.
//!
//! In a range nothing is drawn but what the bound at its larger ends has (see
//! `watch/terms`), and nothing lasts longer than by the ratio of its ends: the smaller it
//! is the nearer the bound comes to what some setting in it has. A limit that is missed at
//! some setting is not kept; nor is one that the bound of the smallest ranges does not
//! keep, or that takes more ranges than are looked at.
//!
//! Input: what was found at the largest overrides. Output: ranges to look at, then the
//! worst of each limit.

use super::assess::Assessor;
use super::demand::Want;
use super::duty_cycle::{Measure, Rating};
use gwatt_machine::{Machine, OverrideAt};
use gwatt_motion::{Action, Move};

/// Where all settings are divided first, of one knob and of two.
const FIRST: [f64; 10] = [1.0, 0.64, 0.41, 0.26, 0.17, 0.11, 0.07, 0.045, 0.03, 0.0];
const FIRST_OF_TWO: [f64; 6] = [1.0, 0.64, 0.41, 0.17, 0.05, 0.0];
/// Where a range that reaches down to 0 is divided, as a share of its larger end.
const DOWN: f64 = 0.4;
/// Unless that lies below this: programs would last for ever there, and nothing but what is
/// drawn at rest makes a difference.
const LOWEST: f64 = 2e-3;
/// A range is not divided where its ends differ by less than this.
const NEAR: f64 = 1.015;
/// A side is divided alone where its ends differ by this power more than those of the
/// other one.
const LONGER: f64 = 1.5;
/// So many are looked at, at most, of a program of so many moves at most, and so many at a
/// time.
const RANGES_MAX: usize = 640;
const MOVES_MAX: u64 = 150_000;
const RANGES_MIN: usize = 32;
const AT_ONCE: usize = 64;

/// Which knobs matter: that of feeds, that of rapids.
pub type Knobs = [bool; 2];

/// Settings to look at.
#[derive(Debug, Default)]
pub struct Lower {
    /// The machine with its knobs in ranges.
    pub machines: Vec<Machine>,
    /// Which of the limits are watched there.
    pub watched: Vec<bool>,
    /// What is drawn and fed back at most at any setting, W: no smaller peak matters, and no
    /// limit sees more.
    pub peaks_w: [f64; 2],
}

impl Lower {
    /// Whether there is nothing to look at.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.machines.is_empty()
    }
}

/// Shares of the largest overrides, from the lower to the upper one.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Range {
    feed: [f64; 2],
    rapid: [f64; 2],
}

/// What a range has left open.
#[derive(Debug, Clone)]
struct Open {
    range: Range,
    /// How far each limit is used up by its bound; 0 where that keeps it.
    used: Vec<f64>,
}

/// The settings that have been looked at.
#[derive(Debug)]
pub struct Ladder {
    /// At the largest overrides.
    largest: Vec<Rating>,
    /// Of each limit the worst setting that was looked at.
    worst: Vec<Rating>,
    /// What came of each limit.
    verdicts: Vec<Verdict>,
    open: Vec<Open>,
    asked: Vec<Range>,
    /// Which limits are watched there: those that are open, and those that are missed, whose
    /// worst setting is shown.
    watched: Vec<bool>,
    left: usize,
    machine: Machine,
    /// What the program draws and feeds back at most at any setting, W.
    peaks_w: [f64; 2],
}

/// What came of a limit.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Verdict {
    /// It is kept everywhere, or missed at the largest.
    Known,
    /// It is kept everywhere, since nothing draws or feeds back so much.
    Beyond,
    /// Ranges are looked at.
    Open,
    /// Some setting misses it.
    Missed,
    /// The smallest of ranges does not keep it, or there are too many: so far its bound
    /// goes.
    TooNear(f64),
}

impl Open {
    /// How far the worst of the limits that are open is used up.
    fn worst(&self, verdicts: &[Verdict]) -> f64 {
        let open = self.used.iter().zip(verdicts);
        let open = open.filter(|(_, verdict)| **verdict == Verdict::Open);
        open.fold(0.0, |worst, (used, _)| worst.max(*used))
    }
}

impl Range {
    /// All settings of the knobs that matter.
    fn all(knobs: Knobs) -> Self {
        let [feed, rapid] = knobs.map(|turns| if turns { [0.0, 1.0] } else { [1.0, 1.0] });
        Self { feed, rapid }
    }

    /// The same in parts; none where it is small.
    fn parts(&self) -> Vec<Self> {
        let whole = |side: [f64; 2]| side == [0.0, 1.0];
        match [whole(self.feed), whole(self.rapid)] {
            [false, false] => self.halves(),
            [true, true] => grid(&FIRST_OF_TWO, &FIRST_OF_TWO),
            [true, false] => grid(&FIRST, &[self.rapid[1], self.rapid[0]]),
            [false, true] => grid(&[self.feed[1], self.feed[0]], &FIRST),
        }
    }

    fn halves(&self) -> Vec<Self> {
        let [feed, rapid] = [self.feed, self.rapid].map(|[lower, upper]| {
            if upper > lower * NEAR && upper > LOWEST {
                libm::log(upper / lower)
            } else {
                0.0
            }
        });
        let halves = |[lower, upper]: [f64; 2], divide: bool| {
            let middle = if lower > 0.0 {
                (lower * upper).sqrt()
            } else {
                upper * DOWN
            };
            if divide {
                vec![upper, middle, lower]
            } else {
                vec![upper, lower]
            }
        };
        if feed == 0.0 && rapid == 0.0 {
            return Vec::new();
        }
        let feeds = halves(self.feed, feed > 0.0 && rapid <= LONGER * feed);
        let rapids = halves(self.rapid, rapid > 0.0 && feed <= LONGER * rapid);
        grid(&feeds, &rapids)
    }
}

/// The ranges between neighbours, from the largest on down.
fn grid(feeds: &[f64], rapids: &[f64]) -> Vec<Range> {
    let sides = |ends: &[f64]| -> Vec<[f64; 2]> {
        let pairs = ends.windows(2).filter_map(|pair| match pair {
            [upper, lower] => Some([*lower, *upper]),
            _ => None,
        });
        pairs.collect()
    };
    let rapids = sides(rapids);
    let pairs = sides(feeds).into_iter().flat_map(|feed| {
        let rapids = rapids.iter();
        rapids.map(move |rapid| Range {
            feed,
            rapid: *rapid,
        })
    });
    pairs.collect()
}

impl Ladder {
    /// Nothing has been looked at but the largest overrides, of a program of so many moves
    /// that draws and feeds back so much at any setting.
    #[must_use]
    pub fn new(
        machine: &Machine,
        largest: &[Rating],
        moves: u64,
        knobs: Knobs,
        peaks_w: [f64; 2],
    ) -> Self {
        let one = machine.converters.len() == 1;
        let verdict = |rating: &Rating| {
            if rating.bound.is_none() {
                Verdict::Known
            } else if one && is_beyond(rating, peaks_w) {
                Verdict::Beyond
            } else {
                Verdict::Open
            }
        };
        let most = (MOVES_MAX / moves.max(1)) as usize;
        Self {
            largest: largest.to_vec(),
            worst: largest.to_vec(),
            verdicts: largest.iter().map(verdict).collect(),
            open: vec![Open {
                range: Range::all(knobs),
                used: vec![f64::INFINITY; largest.len()],
            }],
            asked: Vec::new(),
            watched: vec![true; largest.len()],
            left: most.clamp(RANGES_MIN, RANGES_MAX),
            machine: machine.clone(),
            peaks_w,
        }
    }

    /// The ranges that are to be looked at next, and the limits that are open; none where all
    /// is settled.
    #[must_use]
    pub fn ask(&mut self) -> Lower {
        self.asked.clear();
        self.settle();
        let verdicts = &self.verdicts;
        let worst = |open: &Open| open.worst(verdicts);
        self.open.sort_by(|a, b| worst(b).total_cmp(&worst(a)));
        let mut rest = Vec::new();
        for open in std::mem::take(&mut self.open) {
            let parts = if self.asked.len() < AT_ONCE && self.left > 0 {
                open.range.parts()
            } else {
                Vec::new()
            };
            if parts.is_empty() {
                rest.push(open);
            }
            self.left = self.left.saturating_sub(parts.len());
            self.asked.extend(parts);
        }
        self.open = rest;
        let watched = |verdict: &Verdict| matches!(verdict, Verdict::Open | Verdict::Missed);
        self.watched = self.verdicts.iter().map(watched).collect();
        let machines = self.asked.iter();
        Lower {
            machines: machines.map(|range| within(&self.machine, range)).collect(),
            watched: self.watched.clone(),
            peaks_w: self.peaks_w,
        }
    }

    /// Leaves aside what leaves no limit open, and limits that nothing leaves open.
    fn settle(&mut self) {
        let Self { open, verdicts, .. } = self;
        open.retain(|open| open.worst(verdicts) > 0.0);
        for (limit, verdict) in verdicts.iter_mut().enumerate() {
            let used = |open: &Open| open.used.get(limit).is_some_and(|used| *used > 0.0);
            if *verdict == Verdict::Open && !open.iter().any(used) {
                *verdict = Verdict::Known;
            }
        }
    }

    /// Takes what was found there of the limits that were watched.
    pub fn take(&mut self, found: &[Vec<Rating>]) {
        for (index, range) in std::mem::take(&mut self.asked).into_iter().enumerate() {
            let Some(found) = found.get(index) else {
                // Nobody has looked.
                let used = vec![f64::INFINITY; self.verdicts.len()];
                self.open.push(Open { range, used });
                continue;
            };
            let mut all_used = vec![0.0; self.verdicts.len()];
            let small = range.parts().is_empty();
            let limits = self.verdicts.iter_mut().zip(&mut self.worst);
            let limits = limits.zip(&mut all_used).zip(&self.watched);
            let limits = limits.filter_map(|(limit, watched)| watched.then_some(limit));
            for (((verdict, worst), used), rating) in limits.zip(found) {
                if rating.load_ratio() > worst.load_ratio() {
                    *worst = Rating {
                        overrides: within(&self.machine, &range).limits.override_at,
                        bound: None,
                        ..*rating
                    };
                }
                if !rating.keeps() {
                    *verdict = Verdict::Missed;
                } else if let Some(bound) = rating.bound
                    && *verdict == Verdict::Open
                {
                    if small {
                        *verdict = Verdict::TooNear(bound);
                    }
                    let bound = Rating {
                        value: bound,
                        ..*rating
                    };
                    *used = bound.load_ratio();
                }
            }
            self.open.push(Open {
                range,
                used: all_used,
            });
        }
        self.settle();
    }

    /// Of each limit the worst of all that was looked at; where that does not settle it, the
    /// bound.
    pub fn conclude<'a>(&self, ratings: impl Iterator<Item = &'a mut Rating>) {
        let found = self.verdicts.iter().zip(&self.worst).zip(&self.largest);
        for (rating, ((verdict, worst), largest)) in ratings.zip(found) {
            let Some(mut bound) = largest.bound else {
                continue;
            };
            if self.machine.converters.len() == 1
                && matches!(largest.measure, Measure::Continuous { .. })
            {
                bound = bound.min(self.peaks_w[0]);
            }
            let looked_at = Rating {
                bound: None,
                looked_at: true,
                ..*worst
            };
            *rating = match verdict {
                Verdict::Known | Verdict::Missed => looked_at,
                Verdict::Beyond => Rating {
                    bound: None,
                    ..*rating
                },
                Verdict::TooNear(bound) => Rating {
                    value: *bound,
                    any: true,
                    ..*rating
                },
                Verdict::Open => Rating {
                    value: bound,
                    any: true,
                    ..*rating
                },
            };
        }
    }
}

/// Whether a limit is kept by all that draws and feeds back no more than so much, W.
fn is_beyond(rating: &Rating, [drawn_w, fed_back_w]: [f64; 2]) -> bool {
    match rating.measure {
        Measure::Overload { above_w, .. } => drawn_w <= above_w,
        Measure::Continuous { .. } => drawn_w <= rating.limit,
        Measure::Brake { power_w } => fed_back_w <= power_w,
        Measure::LowestVoltage | Measure::HighestVoltage => false,
    }
}

/// A machine with its knobs somewhere in a range.
fn within(machine: &Machine, range: &Range) -> Machine {
    let mut machine = machine.clone();
    let limits = &machine.limits;
    let [feed, rapid] = [range.feed, range.rapid];
    machine.limits.override_at = Some(OverrideAt {
        feed: limits.feed_override_max * feed[1],
        rapid: limits.rapid_override_max * rapid[1],
        spindle: limits.spindle_override_max,
    });
    let least = [feed, rapid].map(|[lower, upper]| lower / upper);
    machine.limits.override_from = Some(least);
    machine
}

impl Assessor<'_> {
    /// Watches the program at lower overrides too, each by an assessor for itself, which
    /// watches some of the limits.
    #[must_use]
    pub fn with_lower(mut self, lower: Vec<Self>, at: &Lower) -> Self {
        self.lower = lower;
        let [floor_w, regen_floor_w] = at.peaks_w;
        let peaks = Want {
            energy: false,
            floor_w,
            regen_floor_w,
            accel: false,
        };
        for lower in &mut self.lower {
            lower.want = peaks;
            if let Some(watch) = &mut lower.observer.watch {
                watch.only(&at.watched);
                if let [_] = lower.model.converters.as_slice() {
                    watch.cap(at.peaks_w);
                }
            }
        }
        self
    }

    /// What was found at these.
    #[must_use]
    pub fn lower_ratings(&self) -> Vec<Vec<Rating>> {
        self.lower.iter().map(Self::ratings).collect()
    }

    #[cold]
    pub(super) fn push_lower(&mut self, mv: &Move, text: &[u8]) {
        for lower in &mut self.lower {
            lower.push(mv, text, &mut |_, _, _| {});
        }
    }

    pub(super) fn end_line_lower(&mut self, moved: bool) {
        self.end_line(moved, &mut |_, _, _| {});
    }

    pub(super) fn act_lower(&mut self, action: &Action) {
        for lower in &mut self.lower {
            lower.act(action, &mut |_, _, _| {});
        }
    }

    pub(super) fn finish_lower(&mut self) {
        for lower in &mut self.lower {
            lower.finish(&mut |_, _, _| {});
        }
    }
}
