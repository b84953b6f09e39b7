//! The power model: a machine's coefficients, and the demand of a move.
//!
//! Input: a [`Machine`] once, then moves with their plans. Output: [`Demand`].

mod demand;

use super::axis::AxisPower;
use super::demand::{Demand, Totals, larger};
use super::upper_bound::UpperBound;
use gwatt_machine::{AXES, AxisSet, Machine};
use gwatt_motion::Move;

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
