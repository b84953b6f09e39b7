//! What moves ask of the converters.

use super::{ConverterPower, FIT_TOLERANCE, PowerModel};
use crate::arc_circle::Circle;
use crate::axis::AxisPower;
use crate::demand::{Demand, Totals, Want};
use crate::spindle_share::SpindleShare;
use crate::{arc, independent, straight};
use gwatt_machine::{AxisSet, Machine};
use gwatt_motion::Move;
use gwatt_plan::{PathFigures, Plan, Trajectory};

impl PowerModel {
    /// Takes over the data of a machine.
    #[must_use]
    pub fn new(machine: &Machine) -> Self {
        let axes = std::array::from_fn(|i| {
            machine.axes[i]
                .as_ref()
                .map_or(AxisPower::ABSENT, AxisPower::new)
        });
        let converters = (0..machine.converters.len())
            .map(|index| ConverterPower::new(machine, index, &axes))
            .collect();
        Self { axes, converters }
    }

    /// Largest power of a converter in W, margin taken off; infinite for a
    /// converter that does not exist.
    #[must_use]
    pub fn limit_w(&self, converter: usize) -> f64 {
        self.converters
            .get(converter)
            .map_or(f64::INFINITY, |converter| converter.limit_w)
    }

    /// Largest power that may be fed into a converter in W, margin taken off.
    #[must_use]
    pub fn regen_limit_w(&self, converter: usize) -> Option<f64> {
        self.converters.get(converter)?.regen_limit_w
    }

    /// Whether every converter stays within its limits.
    #[must_use]
    #[inline]
    pub fn fits(&self, demand: &Demand) -> bool {
        demand.load_ratio <= 1.0 + FIT_TOLERANCE
    }

    /// The peaks, and if wanted the energy, of a planned move.
    ///
    /// A move from an unknown start gets its robust bound; its energy is that
    /// of the axes at rest.
    #[must_use]
    pub fn demand(&self, mv: &Move, plan: &Plan, want: Want) -> Demand {
        let mut demand = Demand::NONE;
        for (index, converter) in self.converters.iter().enumerate() {
            demand.add(index, converter, self.totals(converter, mv, plan, want));
        }
        demand
    }

    /// The share of one converter.
    #[inline]
    fn totals(&self, converter: &ConverterPower, mv: &Move, plan: &Plan, want: Want) -> Totals {
        let active = AxisSet(mv.moving.0 & converter.axes.0);
        match &plan.trajectory {
            Trajectory::Path(profile) => {
                let idle_w = converter.idle_w(mv, &self.axes, active);
                match &mv.arc {
                    Some(arc) => {
                        let circle = Circle::new(self, converter, mv, arc, idle_w);
                        arc::totals(&circle, profile, want)
                    }
                    None => straight::totals(self, converter, mv, profile, idle_w, want),
                }
            }
            Trajectory::Axes(profiles) => {
                let idle_w = converter.idle_w(mv, &self.axes, active);
                independent::totals(self, converter, mv, profiles, idle_w, want)
            }
            Trajectory::Rest => {
                let idle_w = converter.idle_w(mv, &self.axes, AxisSet::default());
                Totals::at_rest(idle_w, plan.duration_s, want)
            }
            Trajectory::Unknown(motion) => {
                let idle_w = converter.idle_w(mv, &self.axes, AxisSet::default());
                let mut totals =
                    self.robust_totals(converter, mv, &motion.bound, &motion.accel_mm_s2);
                totals.energy_j = Totals::at_rest(idle_w, plan.duration_s, want).energy_j;
                totals
            }
        }
    }
}

impl PowerModel {
    /// The load ratio of a demand of the axes with the spindle next to them, at a
    /// speed of the path of `speed_mm_s`.
    #[must_use]
    pub fn load_with_spindle(&self, demand: &Demand, share: &SpindleShare, speed_mm_s: f64) -> f64 {
        let fed = self.converters.iter().position(|it| it.feeds_spindle);
        let Some(index) = fed else {
            return demand.load_ratio;
        };
        let cutting_w = if share.cutting_w_s_mm > 0.0 {
            share.cutting_w_s_mm * speed_mm_s
        } else {
            0.0
        };
        let mut both = *demand;
        both.add_spindle(index, self, [share.drawn_w + cutting_w, share.fed_back_w]);
        both.load_ratio
    }

    /// A bound of the demand of a path, if it stays below what is of interest:
    /// then the path need not be looked at more closely.
    #[inline]
    pub(crate) fn below_floor(
        &self,
        mv: &Move,
        figures: &PathFigures,
        want: Want,
    ) -> Option<Demand> {
        let extremes = [figures.top_speed_mm_s, figures.accel_mm_s2];
        let [peak_w, regen_w] = self.ceiling_w(mv, extremes)?;
        if want.energy {
            return None;
        }
        Demand::below_floor(peak_w, regen_w, want)
    }

    /// Whether a path needs no closer look: at a speed and an acceleration (mm/s,
    /// mm/s²) of at most these its peaks are of no interest.
    #[inline]
    pub(crate) fn is_below_floor(&self, mv: &Move, extremes: [f64; 2], want: Want) -> bool {
        self.ceiling_w(mv, extremes)
            .is_some_and(|peaks_w| want.passes(peaks_w))
    }

    /// The same for a straight path, closer and at a higher cost; false for an arc.
    pub(crate) fn is_straight_below_floor(
        &self,
        mv: &Move,
        extremes: [f64; 2],
        want: Want,
    ) -> bool {
        let [converter] = self.converters.as_slice() else {
            return false;
        };
        if mv.arc.is_some() || want.floor_w == f64::NEG_INFINITY {
            return false;
        }
        let idle_w = converter.idle_w(mv, &self.axes, mv.moving);
        want.passes(straight::bound_w(self, converter, mv, extremes, idle_w))
    }

    /// Upper bounds of the power that a path draws and feeds back, W, if there is
    /// one quickly.
    #[inline]
    fn ceiling_w(&self, mv: &Move, extremes: [f64; 2]) -> Option<[f64; 2]> {
        let [converter] = self.converters.as_slice() else {
            return None;
        };
        let idle_w = converter.idle_w(mv, &self.axes, mv.moving);
        Some(converter.ceiling.of(&self.axes, mv, extremes, idle_w))
    }
}
