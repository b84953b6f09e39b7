//! The power model: a machine's coefficients, and the demand of a move.
//!
//! Input: a [`Machine`] once, then moves with their plans. Output: [`Demand`].

use super::axis::AxisPower;
use super::bus::SpindleShare;
use super::demand::{Demand, Totals, Want, larger};
use super::upper_bound::UpperBound;
use super::{arc, independent, straight};
use gwatt_machine::{AXES, AxisSet, Machine};
use gwatt_motion::Move;
use gwatt_plan::{PathFigures, Plan, Trajectory};

/// How far a ratio may exceed 1 by rounding alone.
const FIT_TOLERANCE: f64 = 1e-9;

/// The coefficients of a machine, for [`PowerModel::demand`].
#[derive(Debug, Clone)]
pub struct PowerModel {
    /// Axes by index; axes that the machine has not are all zero.
    pub(super) axes: [AxisPower; AXES],
    /// The converters, in the machine's order.
    pub(super) converters: Vec<ConverterPower>,
}

/// The coefficients of one converter.
#[derive(Debug, Clone)]
pub(super) struct ConverterPower {
    /// The axes it feeds.
    pub axes: AxisSet,
    /// Of these, axes whose power is not linear in speed.
    pub curved: AxisSet,
    /// Of these, axes whose peaks are not those of the command.
    pub factored: AxisSet,
    /// Of these, axes that draw power while they hold their weight.
    pub holding: AxisSet,
    /// A quick upper bound.
    ceiling: UpperBound,
    /// Whether it feeds the spindle.
    pub feeds_spindle: bool,
    /// Whether fed-back power feeds the other axes.
    pub credit_regen: bool,
    /// What is drawn at all times in W.
    base_w: f64,
    /// Switched loads: bit in `Move::loads`, W.
    loads: Vec<(u32, f64)>,
    /// Largest power in W, margin taken off.
    limit_w: f64,
    /// Largest power that may be fed back in W, margin taken off.
    regen_limit_w: Option<f64>,
    /// Which of these limits a move must keep by itself: not where the capacitor
    /// takes peaks, which is judged over time.
    by_move: ByMove,
}

/// Which limits of power each move must keep by itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct ByMove {
    peak: bool,
    regen: bool,
}

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
                    Some(arc) => arc::totals(self, converter, mv, arc, profile, idle_w, want),
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
    pub(super) fn below_floor(
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
    pub(super) fn is_below_floor(&self, mv: &Move, extremes: [f64; 2], want: Want) -> bool {
        self.ceiling_w(mv, extremes)
            .is_some_and(|peaks_w| want.passes(peaks_w))
    }

    /// The same for a straight path, closer and at a higher cost; false for an arc.
    pub(super) fn is_straight_below_floor(
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

impl ConverterPower {
    /// Takes over the data of converter `index`.
    fn new(machine: &Machine, index: usize, axes: &[AxisPower; AXES]) -> Self {
        let converter = &machine.converters[index];
        let share = 1.0 - machine.limits.margin;
        let ratings = &converter.ratings;
        let fed = AxisSet(converter.axes.0 & machine.axis_set.0);
        let select = |test: fn(&AxisPower) -> bool| {
            let mut set = AxisSet::default();
            fed.iter()
                .filter(|&axis| test(&axes[axis]))
                .for_each(|axis| set.insert(axis));
            set
        };
        Self {
            axes: fed,
            curved: select(AxisPower::is_curved),
            factored: select(AxisPower::has_factors),
            holding: select(|axis| axis.holding_w() > 0.0),
            ceiling: UpperBound::new(axes, fed),
            feeds_spindle: machine.spindle.as_ref().map(|it| it.converter) == Some(index),
            credit_regen: converter.credit_regen,
            base_w: converter.base_load_w,
            loads: machine
                .loads
                .iter()
                .take(u32::BITS as usize)
                .enumerate()
                .filter(|(_, load)| load.converter == index)
                .map(|(bit, load)| (1 << bit, load.power_w))
                .collect(),
            by_move: ByMove {
                peak: !ratings.credits_low(),
                regen: !ratings.credits_high(),
            },
            limit_w: share * converter.peak_power_w,
            regen_limit_w: converter.regen_power_w.map(|power| share * power),
        }
    }

    /// Largest power in W, margin taken off.
    pub fn limit_w(&self) -> f64 {
        self.limit_w
    }

    /// What is drawn besides the axes in `active`: base load, switched loads
    /// and what the other axes lose while they hold their weight, in W.
    #[inline]
    pub fn idle_w(&self, mv: &Move, axes: &[AxisPower; AXES], active: AxisSet) -> f64 {
        let mut power = self.base_w;
        if mv.loads != 0 {
            for &(bit, power_w) in &self.loads {
                if mv.loads & bit != 0 {
                    power += power_w;
                }
            }
        }
        for axis in AxisSet(self.holding.0 & !active.0).iter() {
            power += axes[axis].holding_w();
        }
        power
    }
}

impl Demand {
    /// Adds what one converter is asked; the one closest to its limits is
    /// the one that is reported.
    #[inline]
    pub(super) fn add(&mut self, index: usize, converter: &ConverterPower, totals: Totals) {
        let regen_ratio = match converter.regen_limit_w {
            Some(limit) if totals.regen_w > 0.0 && converter.by_move.regen => {
                totals.regen_w / limit
            }
            _ => 0.0,
        };
        let ratio = if converter.by_move.peak {
            (totals.peak_w / converter.limit_w).max(regen_ratio)
        } else {
            regen_ratio
        };
        if ratio > self.load_ratio {
            self.load_ratio = ratio;
            self.converter = index;
            self.peak_w = totals.peak_w;
            self.regen_w = totals.regen_w;
        }
        self.energy_j += totals.energy_j;
        if converter.feeds_spindle {
            self.spindle_converter_w = [totals.peak_w, totals.regen_w];
        }
    }

    /// Adds what the spindle asks of its converter: `drawn_w` on top of the peak,
    /// `fed_back_w` on top of the power that is fed back; either may be negative.
    pub(super) fn add_spindle(&mut self, index: usize, model: &PowerModel, by: [f64; 2]) {
        let [peak_w, regen_w] = self.spindle_converter_w;
        self.set_spindle(index, model, [peak_w + by[0], (regen_w + by[1]).max(0.0)]);
    }

    /// Sets what axes and spindle together ask of the spindle's converter.
    pub(super) fn set_spindle(&mut self, index: usize, model: &PowerModel, peaks: [f64; 2]) {
        let Some(converter) = model.converters.get(index) else {
            return;
        };
        let regen_ratio = match converter.regen_limit_w {
            Some(limit) if peaks[1] > 0.0 => peaks[1] / limit,
            _ => 0.0,
        };
        let ratio = (peaks[0] / converter.limit_w).max(regen_ratio);
        self.spindle_converter_w = peaks;
        if model.converters.len() == 1 || ratio > self.load_ratio {
            self.load_ratio = ratio;
            self.converter = index;
            [self.peak_w, self.regen_w] = peaks;
        } else if self.converter == index {
            // The spindle took off some of what loads it most; the other power may
            // still have grown.
            self.peak_w = larger(self.peak_w, peaks[0]);
            self.regen_w = larger(self.regen_w, peaks[1]);
        }
    }
}
