//! The voltage of the bus next to the rows of a series.

use crate::machine::Machine;
use crate::power::{BusVoltages, Instant, PowerModel};

/// How far apart powers are taken as changing evenly, s, and how often at most between rows.
const STEP_S: f64 = 2e-3;
const STEPS_MAX: f64 = 64.0;

/// Buses that are followed from row to row.
#[derive(Debug)]
pub(super) struct SeriesVolts {
    buses: BusVoltages,
    /// When the row before was, by the motion's own time, where nothing jumps in between.
    before_s: Option<f64>,
    /// The state then, and room for the next one.
    before: Instant,
    next: Instant,
}

impl SeriesVolts {
    /// `None` where the machine limits no voltage.
    pub fn new(machine: &Machine, model: &PowerModel) -> Option<Self> {
        Some(Self {
            buses: BusVoltages::new(machine, model)?,
            before_s: None,
            before: Instant::default(),
            next: Instant::default(),
        })
    }

    /// What comes next may jump.
    pub fn jump(&mut self) {
        self.before_s = None;
    }

    /// Follows the powers up to a row at `t`, and puts the voltages into it; `at` gives the
    /// state at instants in between.
    pub fn row(&mut self, t: f64, row: &mut Instant, at: impl Fn(f64, &mut Instant)) {
        if let Some(before_s) = self.before_s {
            let steps = ((t - before_s) / STEP_S).ceil().clamp(1.0, STEPS_MAX);
            let step_s = (t - before_s) / steps;
            for step in 1..steps as u32 {
                at(before_s + f64::from(step) * step_s, &mut self.next);
                self.buses.pass(step_s, &self.before, &self.next);
                std::mem::swap(&mut self.before, &mut self.next);
            }
            self.buses.pass(step_s, &self.before, row);
        }
        self.before_s = Some(t);
        self.before.clone_from(row);
        self.buses.show(row);
    }
}
