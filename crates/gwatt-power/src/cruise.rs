//! Cruises at lower overrides.
//!
//! Input: a move and its largest speed. Output: what it draws and feeds back at most
//! while it cruises at any speed up to that.
//!
//! While axes speed up or brake, a lower override only cuts the ramps short: each of
//! their states is one of the largest override as well. A cruise is not. Without
//! viscous friction and copper loss its power is in proportion to the speed, and largest
//! at the top. With them it is convex in the speed: most may be drawn next to rest,
//! where a weight that is let down feeds nothing back, and most be fed back in between.
//! Where a blend turns, the robust bound counts for what such a weight feeds back.

use super::axis::Side;
use super::blend::BLENDED;
use super::demand::{Demand, Totals, Want, larger};
use super::interval::{Interval, Ramp};
use super::model::{ConverterPower, PowerModel};
use super::surge::{Surge, surge_demand};
use arrayvec::ArrayVec;
use gwatt_machine::{AXES, AxisSet};
use gwatt_motion::Move;
use gwatt_plan::PathShares;
use gwatt_plan::lookahead::{Piece, Planned};

impl PowerModel {
    /// The demand of cruises at `top_mm_s` and below; `None` where they have no more than
    /// the fastest one. Of an arc the instants next to rest alone.
    #[must_use]
    pub fn cruises(&self, mv: &Move, top_mm_s: f64) -> Option<Demand> {
        let curved = |converter: &ConverterPower| AxisSet(mv.moving.0 & converter.curved.0);
        let known = mv.unknown_start.is_empty() && mv.length_mm > 0.0;
        if !known || self.converters.iter().all(|own| curved(own).is_empty()) {
            return None;
        }
        let mut demand = Demand::NONE;
        for (index, converter) in self.converters.iter().enumerate() {
            let active = AxisSet(mv.moving.0 & converter.axes.0);
            let mut totals = Totals::new(converter.idle_w(mv, &self.axes, active));
            if mv.arc.is_some() {
                self.creep(active, mv, &mut totals);
            } else {
                self.cruise(converter, active, mv, top_mm_s, &mut totals);
            }
            demand.add(index, converter, totals);
        }
        Some(demand)
    }

    /// A demand with the [cruises](Self::cruises).
    #[must_use]
    pub fn with_cruises(&self, mut demand: Demand, mv: &Move, top_mm_s: f64) -> Demand {
        if let Some(cruises) = self.cruises(mv, top_mm_s) {
            demand.include(&cruises);
        }
        demand
    }

    /// What a piece of plan that turns may feed back at lower speeds, where that may be
    /// more.
    pub(super) fn turned_down(&self, mv: &Move, planned: &Planned<u64>) -> Option<Demand> {
        if !matches!(planned.piece, Piece::Blend(_)) {
            return None;
        }
        // Slower, viscous friction takes less of what braking feeds back.
        let brakes = !planned.speeds2.are_one() && self.has_viscous(mv);
        if !brakes && !self.lets_down(BLENDED) {
            return None;
        }
        let surge = Surge {
            rises_mm_s: Some(planned.top_speed_mm_s()),
            falls_mm_s: None,
            accel_mm_s2: if brakes {
                planned.largest_accel_mm_s2()
            } else {
                0.0
            },
            section: None,
        };
        let turned = surge_demand(self, mv, planned, surge, Want::PEAKS);
        Some(self.fed_back(mv, &turned))
    }

    /// Whether one of these axes has a weight that its friction does not hold, and feeds
    /// back out of proportion to its speed.
    fn lets_down(&self, axes: AxisSet) -> bool {
        axes.iter().any(|axis| {
            let own = &self.axes[axis];
            let held = own.coulomb * own.friction_factor(Side::Regen);
            own.is_curved() && own.gravity.abs() > held
        })
    }

    /// Of a demand what is fed back alone; of several converters all of it.
    fn fed_back(&self, mv: &Move, whole: &Demand) -> Demand {
        let [converter] = self.converters.as_slice() else {
            return *whole;
        };
        let mut totals = Totals::new(converter.idle_w(mv, &self.axes, mv.moving));
        totals.raise_regen(whole.regen_w);
        let mut demand = Demand::NONE;
        demand.add(0, converter, totals);
        demand
    }

    /// Next to rest friction and weight cost copper loss alone.
    fn creep(&self, active: AxisSet, mv: &Move, totals: &mut Totals) {
        let ways = PathShares::of(mv, [0.0, mv.length_mm]).along;
        let powers = active.iter().map(|axis| {
            let signs = [(1.0, ways.positive[axis]), (-1.0, ways.negative[axis])];
            let taken = signs.into_iter().filter(|(_, share)| *share > 0.0);
            taken.fold(0.0, |most, (sign, _)| {
                larger(most, self.axes[axis].power(Side::Motor, 0.0, 0.0, sign))
            })
        });
        totals.raise_peak(totals.idle_w + powers.sum::<f64>());
    }

    /// All speeds on a straight path.
    fn cruise(
        &self,
        converter: &ConverterPower,
        active: AxisSet,
        mv: &Move,
        top_mm_s: f64,
        totals: &mut Totals,
    ) {
        let per_length = top_mm_s / mv.length_mm;
        let ramps: ArrayVec<Ramp<'_>, AXES> = active
            .iter()
            .map(|axis| {
                let power = &self.axes[axis];
                Ramp {
                    axis: power,
                    start: 0.0,
                    end: (mv.end[axis] - mv.start[axis]) * power.si_per_unit * per_length,
                    accel: 0.0,
                }
            })
            .collect();
        let cruise = Interval {
            credit_regen: converter.credit_regen,
            curved: true,
            idle_w: totals.idle_w,
            ramps: &ramps,
            duration_s: 0.0,
        };
        cruise.evaluate(Want::PEAKS, totals);
    }
}
