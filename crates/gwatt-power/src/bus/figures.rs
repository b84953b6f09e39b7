//! What the spindle adds to the figures of a move: power, cutting, energy, and
//! the time that passes.

use super::SpindleBus;
use super::follow::Followed;
use crate::cutting::Taken;
use crate::demand::{Demand, Want};
use crate::{Assessment, Certificate};
use gwatt_motion::Move;
use gwatt_plan::blended_speed;

/// How far the time of a move that is planned ahead may be off, as a share and
/// in s: plans keep within 2 % of recorded runs, and controllers take some
/// cycles between words.
const AHEAD_SHARE: f64 = 0.03;
const AHEAD_S: f64 = 0.01;

impl SpindleBus<'_> {
    /// Adds the motor between two powers, base load and cutting to a demand;
    /// `idle_w`: what is drawn anyhow.
    pub(super) fn add(
        &self,
        demand: &mut Demand,
        [largest, least]: [f64; 2],
        idle_w: f64,
        cutting_w: f64,
    ) {
        let index = self.spindle.converter;
        let base_w = self.spindle.base_load_w;
        let credit = self.credits();
        let by = if credit {
            // What is drawn anyhow is taken off already, as far as it goes.
            let spare = if demand.spindle_converter_w[1] > 0.0 {
                0.0
            } else {
                idle_w
            };
            let credited_w = self.credited_w();
            [largest + base_w + cutting_w, -least - credited_w - spare]
        } else {
            [largest.max(0.0) + base_w + cutting_w, (-least).max(0.0)]
        };
        demand.add_spindle(index, &self.model, by);
    }

    pub(super) fn credits(&self) -> bool {
        let converter = self.model.converters.get(self.spindle.converter);
        converter.is_some_and(|converter| converter.credit_regen)
    }

    /// What its drive takes of what is fed back, W: its base load, while it is switched
    /// on.
    pub(super) fn credited_w(&self) -> f64 {
        if self.credits() && self.switched_on {
            self.spindle.base_load_w
        } else {
            0.0
        }
    }

    /// What the converter of the spindle draws besides the axes that move.
    pub(super) fn idle_w(&self, mv: &Move) -> f64 {
        let converter = self.model.converters.get(self.spindle.converter);
        converter.map_or(0.0, |converter| {
            converter.idle_w(mv, &self.model.axes, mv.moving)
        })
    }

    /// Whether a bound reaches what is of interest.
    pub(super) fn reaches(
        &self,
        demand: &Demand,
        extremes: [f64; 2],
        cutting_w: f64,
        want: Want,
    ) -> bool {
        let mut bound = *demand;
        self.add(&mut bound, extremes, 0.0, cutting_w);
        bound.spindle_converter_w[0] > want.floor_w
            || bound.spindle_converter_w[1] > want.regen_floor_w
    }

    /// What cutting takes during a move.
    pub(super) fn taken(&self, mv: &Move) -> Taken {
        let turns = self.direction != 0.0 || self.tap_rpm.is_some();
        if !turns && self.before_w.is_none() {
            return Taken::default();
        }
        self.cutting.of_move(mv.kind)
    }

    /// The electrical power of cutting during a move at most; what follows the
    /// feed goes into its share.
    pub(super) fn cut(&self, mv: &Move, judged: &mut Assessment) -> f64 {
        let taken = self.taken(mv);
        let efficiency = self.spindle.efficiency;
        let constant_w = taken.power_w / efficiency;
        if taken.force_n == 0.0 {
            return constant_w;
        }
        let per_speed = taken.force_n * 1e-3 / efficiency;
        judged.spindle.cutting_w_s_mm = per_speed;
        let top_mm_s = if !mv.unknown_start.is_empty() {
            mv.feed_mm_s * self.overrides[0].feed
        } else if judged.certificate == Certificate::Robust {
            blended_speed(self.machine, mv, self.overrides[0])
        } else {
            judged.top_speed_mm_s
        };
        constant_w + per_speed * top_mm_s
    }

    /// Adds the spindle's energy during a move.
    pub(super) fn count_energy(
        &self,
        mv: &Move,
        judged: &mut Assessment,
        followed: Option<&Followed>,
    ) {
        let duration_s = judged.duration_s;
        let [net_j, drawn_j] = followed.and_then(|it| it.energy_j).unwrap_or_else(|| {
            let span = self.states[1].span(&self.motor, duration_s);
            [span.energy_j, span.drawn_j]
        });
        let motor_j = if self.credits() { net_j } else { drawn_j };
        let constant_w = self.taken(mv).power_w / self.spindle.efficiency;
        let cutting_j = constant_w * duration_s + judged.spindle.cutting_w_s_mm * mv.length_mm;
        judged.demand.energy_j += motor_j + self.spindle.base_load_w * duration_s + cutting_j;
    }

    /// Lets the time of a move pass.
    pub(super) fn move_on(&mut self, mv: &Move, judged: &Assessment, followed: bool) {
        self.handed += 1;
        // A move that follows the surface has left the spindle where it ends.
        if !followed {
            let mut time_s = self.time_of(mv, judged);
            if self.before_w.is_some() {
                time_s[0] = 0.0;
            }
            self.states[0].pass(time_s);
            if let Some(slower) = &mut self.slower {
                slower.pass(mv, time_s);
            }
            self.states[1].pass([judged.duration_s; 2]);
        }
        if self.queue.is_empty() && self.reserve_w != [0.0; 2] {
            self.reserve();
        }
    }

    /// How long a move takes at the largest overrides, at least and at most.
    pub(super) fn time_of(&self, mv: &Move, judged: &Assessment) -> [f64; 2] {
        if judged.certificate == Certificate::Planned {
            let off_s = if judged.ahead {
                AHEAD_SHARE * judged.fastest_s + AHEAD_S
            } else {
                0.0
            };
            let [least, most] = [judged.fastest_s - off_s, judged.fastest_s + off_s];
            return [least.max(0.0), most];
        }
        let most = if judged.ahead || !mv.unknown_start.is_empty() {
            f64::INFINITY
        } else {
            judged.fastest_s
        };
        let speed_mm_s = blended_speed(self.machine, mv, self.overrides[0]);
        let known = mv.length_mm > 0.0 && mv.unknown_start.is_empty();
        let least = if known {
            mv.length_mm / speed_mm_s
        } else {
            0.0
        };
        [least.min(most), most]
    }

    /// What is drawn and fed back at most as long as no command comes.
    pub(super) fn reserve(&mut self) {
        let [mut largest_w, mut least_w] = self.states[0].henceforth(&self.motor);
        if let Some(slower) = &self.slower {
            let [most_w, lowest_w] = slower.henceforth(&self.motor);
            (largest_w, least_w) = (largest_w.max(most_w), least_w.min(lowest_w));
        }
        self.reserve_w = if self.surface.is_some() && self.direction != 0.0 {
            [f64::INFINITY; 2]
        } else {
            let base_w = self.spindle.base_load_w;
            let taken = self.cutting.largest();
            let drawn_w = largest_w.max(0.0) + base_w + taken.power_w / self.spindle.efficiency;
            if taken.force_n > 0.0 {
                [f64::INFINITY; 2]
            } else {
                [drawn_w, (-least_w).max(0.0)]
            }
        };
    }
}
