//! Pieces of plans at lower overrides: which of them may have to be sped up or braked
//! where they need not at the largest. See `pace`.

use super::pace::{Course, Pace, Past};
use super::runs::Runs;
use crate::model::PowerModel;
use crate::steps::Beyond;
use crate::surge::Surge;
use gwatt_machine::{CornerRule, LookAhead, Machine};
use gwatt_plan::Section;
use gwatt_plan::lookahead::{Element, Planned};

/// What is known of the path before and after a piece.
#[derive(Debug)]
pub(super) struct Surges {
    pub(super) past: Past,
    pub runs: Runs,
    /// With limits of jerk the speed, squared, that is not exceeded at the end of the
    /// last piece, mm²/s².
    reached2: f64,
    /// The speed, squared, of a blend that a slower move comes after, as far as that has not
    /// surely braked, mm²/s².
    late2: f64,
    /// The machine without losses in copper, once it is needed.
    lossless: Option<Box<PowerModel>>,
    /// Of the acceleration that is certain: kinks may take of it.
    ramp_share: f64,
    /// The least shares of the largest overrides that count: of feeds, of rapids.
    least_shares: [f64; 2],
    path_accel_mm_s2: f64,
    pub(super) runs_chords: bool,
    /// The move whose chords come, and Σ 2·a·L of those that have come.
    chords: (u64, f64),
}

impl Surges {
    pub fn new(machine: &Machine, rules: &LookAhead) -> Self {
        let ramp_share = match rules.corner {
            CornerRule::LinuxCnc { kink_ratio, .. } => 1.0 - kink_ratio,
            _ => 1.0,
        };
        Self {
            past: Past::default(),
            runs: Runs::default(),
            reached2: 0.0,
            late2: 0.0,
            lossless: None,
            ramp_share,
            least_shares: machine.limits.least_shares(),
            path_accel_mm_s2: rules.path_accel_mm_s2,
            runs_chords: rules.chords.is_some(),
            chords: (u64::MAX, 0.0),
        }
    }

    /// Adds an element, and gives what is asked of it.
    #[inline]
    pub fn push(&mut self, number: u64, element: &Element<u64>) -> Pace {
        let top_mm_s = element.top_mm_s();
        let asked_mm_s = if element.rapid {
            top_mm_s
        } else {
            element.feed_mm_s
        };
        let accel = element.accel_mm_s2.min(element.drive_accel_mm_s2);
        let accel = accel.min(self.path_accel_mm_s2);
        let (asked2, cap2) = (asked_mm_s * asked_mm_s, top_mm_s * top_mm_s);
        let least = self.least_shares[usize::from(element.rapid)];
        let mut pace = Pace {
            rapid: element.rapid,
            asked2,
            least2: if least > 0.0 {
                least * least * asked2
            } else {
                0.0
            },
            cap2,
            before2: 0.0,
            own2: 2.0 * self.ramp_share * accel * element.length_mm,
        };
        self.runs.push(number, &mut pace);
        pace
    }

    /// The last element is run as chords, which come to this Σ 2·a·L.
    pub fn run_chords(&mut self, pace: &mut Pace, chords2: f64) {
        self.runs.lengthen(chords2 - pace.own2);
        pace.own2 = chords2;
    }

    /// Takes the next piece of a move with its 2·a·L; gives how far on the move it ends,
    /// as Σ 2·a·L. Only chords are known one by one.
    pub(super) fn advance(&mut self, number: u64, pace: &Pace, ramp2: f64, is_chord: bool) -> f64 {
        if !is_chord {
            return pace.own2;
        }
        if self.chords.0 != number {
            self.chords = (number, 0.0);
        }
        self.chords.1 += ramp2;
        self.chords.1
    }

    /// The speed, squared, from which a piece may have to brake since the blend before it is
    /// passed at the pace of a faster move; `slows_after`: so it is with the one after this.
    pub(super) fn late2(&mut self, course: &Course, slows_after: bool) -> Option<f64> {
        let late2 = self.late2;
        self.late2 = if slows_after {
            course.end2
        } else {
            (late2 - course.ramp2).min(course.end2)
        };
        (late2 > 0.0).then(|| late2.min(course.start2))
    }

    /// The machine without losses in copper.
    pub(super) fn lossless(&mut self, model: &PowerModel) -> &PowerModel {
        let lossless = &mut self.lossless;
        lossless.get_or_insert_with(|| Box::new(model.lossless()))
    }

    /// A piece with limits of jerk: where other speeds are asked for, the curve that it
    /// is part of begins and ends elsewhere and has other limits. So it may be sped up
    /// and braked at any of its speeds, unless it is a curve for itself.
    #[cold]
    pub(super) fn free(&mut self, section: &Section, planned: &Planned<u64>) -> Option<Surge> {
        let [from_rest, to_rest] =
            [planned.speeds2.start, planned.speeds2.end].map(|end2| end2 == 0.0);
        let accel_mm_s2 = section.peak_accel_mm_s2();
        let cap2 = section.cap_mm_s() * section.cap_mm_s();
        let start2 = if from_rest { 0.0 } else { self.reached2 };
        let ramp2 = 2.0 * accel_mm_s2 * planned.length_mm;
        let end2 = cap2.min(start2 + ramp2);
        self.reached2 = end2;
        if from_rest && to_rest {
            return None;
        }
        let top2 = if to_rest {
            end2.min(0.5 * (start2 + ramp2))
        } else {
            end2
        };
        Some(Surge {
            rises_mm_s: Some(top2.sqrt()),
            falls_mm_s: Some(top2.sqrt()),
            accel_mm_s2,
            section: Some(*section),
        })
    }

    /// How far lower overrides may go beyond a piece: with limits of jerk the joint before it
    /// may be passed faster, and other chords may be steeper.
    pub fn beyond(&self, planned: &Planned<u64>) -> Beyond {
        let start2 = planned.speeds2.start;
        let mut beyond = Beyond::NONE;
        if planned.section.is_none() {
            beyond.ramp = (planned.slack.accel_mm_s2 / planned.accel_mm_s2).max(1.0);
        } else if start2 > 0.0 {
            let most2 = planned.slack.joint2.min(self.reached2);
            beyond.joint = (most2 / start2).sqrt().max(1.0);
        }
        beyond
    }

    /// Whether nothing but one knob has a say at a speed, squared.
    pub fn are_one(&self, rapid: bool, speed2: f64) -> bool {
        self.runs.are_one(rapid) && !self.past.is_mixed(rapid, speed2)
    }
}

impl Course {
    /// That of a piece; `straight`: it does not turn.
    pub(super) fn of(planned: &Planned<u64>, straight: bool, response_s: f64) -> Self {
        let top_mm_s = planned.top_speed_mm_s();
        Self {
            start2: planned.speeds2.start,
            end2: planned.speeds2.end,
            top2: top_mm_s * top_mm_s,
            ramp2: 2.0 * planned.accel_mm_s2 * planned.length_mm,
            plain: straight && planned.section.is_none(),
            // The drives' mean over a step takes in what is around a shorter ramp as well.
            brief_mm_s: planned.accel_mm_s2 * response_s,
        }
    }
}
