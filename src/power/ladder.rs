//! Limits over time that the bound over all overrides does not settle: the program is
//! looked at with its knobs at some lower overrides, at more of them the nearer a limit is.
//!
//! Between two overrides o₁ < o₂ nothing lasts longer than by `o₂/o₁`: what uses up a limit
//! there is no more than the larger of both times that, the powers of the one with the
//! durations of the other. Where that keeps the limit nothing in between need be looked
//! at; else what lies in the middle is, until both are next to each other.
//!
//! Input: what was found at the largest overrides. Output: settings of the knobs to look
//! at, then the worst of each limit.

use super::assess::Assessor;
use super::demand::Want;
use super::watch::{Measure, Rating};
use crate::interpret::{Action, Move};
use crate::machine::{Machine, OverrideAt};

/// Shares of the largest overrides that are looked at first, down to the lowest.
const FIRST: [f64; 8] = [0.64, 0.41, 0.26, 0.17, 0.11, 0.07, 0.045, 0.03];
/// Two that differ by less than this stand next to each other.
const NEAR: f64 = 1.015;
/// So many are looked at, at most, and so many at a time.
const POINTS_MAX: usize = 160;
const AT_ONCE: usize = 24;

/// Ways to turn the knobs of feed and rapid: the powers of a share that each stands at.
/// Together, each alone, and one less than the other.
const WAYS: [[f64; 2]; 5] = [[1.0, 1.0], [1.0, 0.0], [0.0, 1.0], [1.0, 0.3], [0.3, 1.0]];

/// One setting and what was found there, by limit.
#[derive(Debug, Clone)]
struct Rung {
    share: f64,
    found: Option<Vec<Rating>>,
}

/// The settings that have been looked at.
#[derive(Debug)]
pub struct Ladder {
    /// By way, from the largest on down.
    rungs: [([f64; 2], Vec<Rung>); 5],
    /// At the largest overrides.
    largest: Vec<Rating>,
    /// Nominal voltages by limit, V.
    nominal_v: Vec<f64>,
    machine: Machine,
    asked: Vec<[usize; 2]>,
    points: usize,
}

impl Ladder {
    /// Nothing has been looked at but the largest overrides.
    #[must_use]
    pub fn new(machine: &Machine, largest: &[Rating]) -> Self {
        let nominal_v = |rating: &Rating| {
            let converter = machine.converters.get(rating.converter);
            let capacitor = converter.and_then(|converter| converter.ratings.capacitor);
            capacitor.map_or(0.0, |capacitor| capacitor.nominal_v)
        };
        let rungs = WAYS.map(|way| {
            let first = FIRST.map(|share| Rung { share, found: None });
            let top = Rung {
                share: 1.0,
                found: Some(largest.to_vec()),
            };
            (way, std::iter::once(top).chain(first).collect())
        });
        Self {
            rungs,
            nominal_v: largest.iter().map(nominal_v).collect(),
            largest: largest.to_vec(),
            machine: machine.clone(),
            asked: Vec::new(),
            points: 0,
        }
    }

    /// The machine with its knobs where they are to be looked at next; none where all is
    /// settled.
    #[must_use]
    pub fn ask(&mut self) -> Vec<Machine> {
        self.asked.clear();
        if !(0..self.largest.len()).any(|limit| self.is_open(limit)) {
            return Vec::new();
        }
        self.refine();
        let mut machines = Vec::new();
        for (line, (way, rungs)) in self.rungs.iter().enumerate() {
            for (place, rung) in rungs.iter().enumerate() {
                if rung.found.is_none() && self.asked.len() < AT_ONCE && self.points < POINTS_MAX {
                    self.asked.push([line, place]);
                    self.points += 1;
                    machines.push(at(&self.machine, *way, rung.share));
                }
            }
        }
        machines
    }

    /// Takes what was found there.
    pub fn take(&mut self, found: &[Vec<Rating>]) {
        for ([line, place], found) in self.asked.drain(..).zip(found) {
            let rung = self.rungs.get_mut(line);
            if let Some(rung) = rung.and_then(|(_, rungs)| rungs.get_mut(place)) {
                rung.found = Some(found.clone());
            }
        }
    }

    /// Puts settings between those that leave something open.
    fn refine(&mut self) {
        let open: Vec<usize> = (0..self.largest.len())
            .filter(|limit| self.is_open(*limit))
            .collect();
        let mut middles = Vec::new();
        for (line, (_, rungs)) in self.rungs.iter().enumerate() {
            for pair in rungs.windows(2) {
                let [upper, lower] = pair else { continue };
                let doubtful = open.iter().any(|limit| !self.is_kept(*limit, upper, lower));
                if doubtful && upper.found.is_some() && lower.found.is_some() {
                    middles.push((line, (upper.share * lower.share).sqrt()));
                }
            }
        }
        for (line, share) in middles {
            if let Some((_, rungs)) = self.rungs.get_mut(line) {
                rungs.push(Rung { share, found: None });
                rungs.sort_by(|a, b| b.share.total_cmp(&a.share));
            }
        }
    }

    /// Whether a limit is kept between two settings.
    fn is_kept(&self, limit: usize, upper: &Rung, lower: &Rung) -> bool {
        let used = |rung: &Rung| {
            let found = rung.found.as_ref().and_then(|found| found.get(limit));
            found.map_or(f64::INFINITY, |rating| self.used(limit, rating))
        };
        used(upper).max(used(lower)) * (upper.share / lower.share) <= 1.0
    }

    /// How far a limit is used up, in what grows with time.
    fn used(&self, limit: usize, rating: &Rating) -> f64 {
        let share = match rating.measure {
            Measure::LowestVoltage | Measure::HighestVoltage => {
                let nominal_v = self.nominal_v.get(limit).copied().unwrap_or_default();
                let energy = |volts: f64| volts * volts - nominal_v * nominal_v;
                energy(rating.value) / energy(rating.limit)
            }
            Measure::Continuous { .. } => {
                let share = rating.value / rating.limit;
                share * share
            }
            Measure::Overload { .. } | Measure::Brake { .. } => rating.value / rating.limit,
        };
        if share.is_nan() { f64::INFINITY } else { share }
    }

    /// Whether a limit is left open by the bound, and nowhere seen to be missed or too
    /// near.
    fn is_open(&self, limit: usize) -> bool {
        let Some(largest) = self.largest.get(limit) else {
            return false;
        };
        let all = self.rungs.iter().flat_map(|(_, rungs)| rungs);
        let mut found = all.filter_map(|rung| rung.found.as_ref()?.get(limit));
        let missed = found.any(|rating| !rating.keeps());
        let mut pairs = self.rungs.iter().flat_map(|(_, rungs)| rungs.windows(2));
        let near = pairs.any(|pair| match pair {
            [upper, lower] => {
                let known = upper.found.is_some() && lower.found.is_some();
                let next_to = upper.share <= lower.share * NEAR;
                known && next_to && !self.is_kept(limit, upper, lower)
            }
            _ => false,
        });
        largest.bound.is_some() && !missed && !near
    }

    /// Of each limit the worst of all that was looked at; where that does not settle it, the
    /// bound.
    pub fn conclude<'a>(&self, ratings: impl Iterator<Item = &'a mut Rating>) {
        for (limit, rating) in ratings.enumerate() {
            let Some(bound) = rating.bound else {
                continue;
            };
            let mut worst = *rating;
            let mut settled = true;
            for (way, rungs) in &self.rungs {
                for rung in rungs.iter().skip(1) {
                    let found = rung.found.as_ref().and_then(|found| found.get(limit));
                    if let Some(found) = found
                        && found.load_ratio() > worst.load_ratio()
                    {
                        let machine = at(&self.machine, *way, rung.share);
                        worst = Rating {
                            overrides: machine.limits.override_at,
                            ..*found
                        };
                    }
                }
                let mut pairs = rungs.windows(2);
                settled &= pairs.all(|pair| match pair {
                    [upper, lower] => self.is_kept(limit, upper, lower),
                    _ => true,
                });
            }
            *rating = if settled || !worst.keeps() {
                Rating {
                    bound: None,
                    looked_at: true,
                    ..worst
                }
            } else {
                Rating {
                    value: bound,
                    any: true,
                    ..*rating
                }
            };
        }
    }
}

/// A machine where its knobs stand.
fn at(machine: &Machine, way: [f64; 2], share: f64) -> Machine {
    let mut machine = machine.clone();
    let limits = &machine.limits;
    let [feed, rapid] = way.map(|power| libm::pow(share, power));
    machine.limits.override_at = Some(OverrideAt {
        feed: limits.feed_override_max * feed,
        rapid: limits.rapid_override_max * rapid,
        spindle: limits.spindle_override_max,
    });
    machine
}

/// The lowest override that is looked at, as a share of the largest.
pub fn lowest_share() -> f64 {
    FIRST.into_iter().fold(1.0, f64::min)
}

impl Assessor<'_> {
    /// Watches the program at lower overrides too, each by an assessor for itself.
    #[must_use]
    pub fn with_lower(mut self, lower: Vec<Self>) -> Self {
        self.lower = lower;
        let watched = Want {
            energy: false,
            floor_w: f64::INFINITY,
            regen_floor_w: f64::INFINITY,
            accel: false,
        };
        for lower in &mut self.lower {
            lower.want = watched;
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
