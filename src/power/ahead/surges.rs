//! Pieces of plans at lower overrides: which of them may have to be sped up or braked
//! where they need not at the largest. See `pace`.

use super::Ahead;
use super::pace::{Course, Pace, Past};
use super::runs::Runs;
use crate::machine::{CornerRule, LookAhead};
use crate::plan::lookahead::{Element, Piece, Planned};
use crate::power::demand::{Demand, Want};
use crate::power::model::PowerModel;
use crate::power::piece::piece_demand;
use crate::power::surge::{Surge, surge_demand};

/// What is known of the path before and behind a piece.
#[derive(Debug)]
pub(super) struct Surges {
    past: Past,
    pub runs: Runs,
    /// The machine without losses in copper, once it is needed.
    lossless: Option<Box<PowerModel>>,
    /// Of the acceleration that is certain: kinks may take of it.
    ramp_share: f64,
    path_accel_mm_s2: f64,
}

impl Surges {
    pub fn new(rules: &LookAhead) -> Self {
        let ramp_share = match rules.corner {
            CornerRule::LinuxCnc { kink_ratio, .. } => 1.0 - kink_ratio,
            _ => 1.0,
        };
        Self {
            past: Past::default(),
            runs: Runs::default(),
            lossless: None,
            ramp_share,
            path_accel_mm_s2: rules.path_accel_mm_s2,
        }
    }

    /// Adds an element, and gives what is asked of it.
    #[inline]
    pub fn push(&mut self, number: u64, element: &Element<u64>) -> Pace {
        let top_mm_s = element.top_mm_s();
        let asked_mm_s = if element.rapid {
            element.speed_mm_s
        } else {
            element.feed_mm_s
        };
        let accel = element.accel_mm_s2.min(element.drive_accel_mm_s2);
        let accel = accel.min(self.path_accel_mm_s2);
        let mut pace = Pace {
            rapid: element.rapid,
            asked2: asked_mm_s * asked_mm_s,
            cap2: top_mm_s * top_mm_s,
            before2: 0.0,
            own2: 2.0 * self.ramp_share * accel * element.length_mm,
        };
        self.runs.push(number, &mut pace);
        pace
    }

    /// Whether nothing but one knob has a say at a speed, squared.
    pub fn are_one(&self, rapid: bool, speed2: f64) -> bool {
        self.runs.are_one(rapid) && !self.past.is_mixed(rapid, speed2)
    }
}

impl Ahead {
    /// What a final piece may ask for at lower overrides, if it may do so and that is
    /// of interest.
    #[inline]
    pub(super) fn surge(&mut self, model: &PowerModel, planned: &Planned<u64>) -> Option<Demand> {
        let surges = self.surges.as_mut()?;
        let open = self.open.get(planned.tag)?;
        let straight = match planned.piece {
            Piece::Along { .. } => open.mv.arc.is_none(),
            Piece::Joined { .. } => true,
            Piece::Blend(_) => false,
        };
        let top_mm_s = planned.top_speed_mm_s();
        // The drives' mean over a step takes in what is around a shorter ramp as well.
        let response_s = self.steps.as_ref().map_or(0.0, |steps| steps.response_s());
        let course = Course {
            start2: planned.speeds2.start,
            end2: planned.speeds2.end,
            top2: top_mm_s * top_mm_s,
            ramp2: 2.0 * planned.accel_mm_s2 * planned.length_mm,
            plain: straight && planned.section.is_none(),
            brief_mm_s: planned.accel_mm_s2 * response_s,
        };
        let turned = model.loses_in_turns(&open.mv).then(|| {
            // Turned more gently an axis loses less of what it feeds back.
            let lossless = &mut surges.lossless;
            let lossless = lossless.get_or_insert_with(|| Box::new(model.lossless()));
            let want = Want {
                energy: false,
                ..open.want
            };
            piece_demand(lossless, &open.mv, planned, want)
        });
        surges.runs.forget(planned.first);
        let rises2 = surges.past.pass(&open.pace, &course);
        let falls2 = surges.runs.falls2(planned.tag, &open.pace, &course);
        // Slower, friction takes less of what is fed back.
        let slows = straight && course.brakes() && model.has_viscous(&open.mv);
        if rises2.is_none() && falls2.is_none() && !slows {
            return turned;
        }
        let mut surge = Surge {
            rises_mm_s: rises2.map(f64::sqrt),
            falls_mm_s: falls2.map(f64::sqrt),
            accel_mm_s2: planned.accel_mm_s2,
        };
        let want = Want {
            energy: false,
            ..open.want
        };
        let surges = surge.rises_mm_s.is_some() || surge.falls_mm_s.is_some();
        if surges && matches!(planned.piece, Piece::Along { .. }) {
            self.follow_surge(model, planned.tag, &surge);
        }
        if slows {
            surge.falls_mm_s = Some(top_mm_s);
        }
        let open = self.open.get(planned.tag)?;
        let extremes = [surge.speed_mm_s(), surge.accel_mm_s2];
        if straight && model.is_straight_below_floor(&open.mv, extremes, want) {
            return turned;
        }
        let mut demand = surge_demand(model, &open.mv, planned, surge, want);
        if let Some(turned) = &turned {
            demand.include(turned);
        }
        Some(demand)
    }
}
