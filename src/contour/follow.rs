//! One axis: from its command to where the load is, and to the force for it.
//!
//! The command is sampled and filtered; the drive interpolates it in a straight
//! line from sample to sample, one period late. The load follows by the axis'
//! transfer function, exactly: a ramp is the integral of a held slope.

use crate::identify::tune::{Biquad, Cascade};
use crate::identify::{Factor, Measured, Sampled, Simulation, TransferFunction, roots};
use crate::machine::{Axis, CommandFilter, Response, ResponseRoot};

/// Longer delays are a mistake, s.
const DELAY_MAX_S: f64 = 1.0;
/// Slower than this the friction has no direction, m/s or rad/s.
const STANDSTILL: f64 = 1e-7;

/// Why an axis cannot be followed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum NoFollow {
    /// More zeros than poles.
    NotProper,
    /// The delay is out of range.
    Delay,
    /// Figures that no system has.
    Degenerate,
}

/// An axis at work.
#[derive(Debug, Clone)]
pub(super) struct Follow {
    motion: Path,
    /// To the acceleration that the drive's force makes of the mass.
    accel: Path,
    /// Where the load is, mm.
    load: f64,
    period_s: f64,
    mass: [f64; 4],
    si_per_unit: f64,
    axis: Axis,
}

/// What an axis does at a sample.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Followed {
    /// Of the load, mm.
    pub position: f64,
    /// Of the drive, N or N·m.
    pub force: f64,
    /// Electrical, W.
    pub power: f64,
}

/// A filter, its slope from sample to sample, and a transfer function.
#[derive(Debug, Clone)]
struct Path {
    filter: Cascade,
    before: f64,
    period_s: f64,
    simulation: Simulation,
    /// The last inputs, as many as the delay needs.
    past: Vec<f64>,
    keep: usize,
}

impl Path {
    /// At rest at `start`.
    fn new(
        transfer: &TransferFunction,
        measured: Measured,
        sections: &[Biquad],
        period_s: f64,
        start: f64,
    ) -> Option<Self> {
        let sampled = Sampled::new(transfer, measured, period_s)?;
        Some(Self {
            filter: Cascade::at_rest(sections, start),
            before: start,
            period_s,
            simulation: Simulation::new(sampled),
            past: Vec::new(),
            keep: (transfer.delay_s / period_s) as usize + 3,
        })
    }

    fn step(&mut self, input: f64) -> f64 {
        let now = self.filter.step(input);
        let slope = (now - self.before) / self.period_s;
        self.before = now;
        if self.past.len() == self.keep {
            self.past.remove(0);
        }
        self.past.push(slope);
        let last = self.past.len() - 1;
        self.simulation.step(&self.past, last)
    }
}

impl Follow {
    /// An axis that stands at `start` (mm); without a filter, as if there were
    /// none.
    pub fn new(
        axis: &Axis,
        response: &Response,
        filter: Option<&CommandFilter>,
        period_s: f64,
        start: f64,
    ) -> Result<Self, NoFollow> {
        let transfer = TransferFunction::from(response);
        if transfer.zero_count() > transfer.order() {
            return Err(NoFollow::NotProper);
        }
        if transfer.delay_s > DELAY_MAX_S {
            return Err(NoFollow::Delay);
        }
        let sections = sections(filter);
        // Acceleration by force is Π zeros/Π force poles by the mass: to the
        // force, the zeros of the response fall out.
        let force_poles: Vec<Factor> = response.force_poles.iter().map(Factor::from).collect();
        let mut to_force = TransferFunction {
            zeros: force_poles,
            ..transfer.clone()
        };
        if !has_force_poles(response) {
            to_force.zeros.clear();
        }
        let path = |transfer: &TransferFunction, measured, start| {
            Path::new(transfer, measured, &sections, period_s, start).ok_or(NoFollow::Degenerate)
        };
        Ok(Self {
            // The integral's differences are the load's mean speeds.
            motion: path(&transfer, Measured::Velocity, start)?,
            accel: path(&to_force, Measured::Direct, 0.0)?,
            load: start,
            period_s,
            mass: [
                axis.mass_kg,
                axis.viscous_n_s_m,
                axis.coulomb_n,
                axis.gravity_n,
            ],
            si_per_unit: axis.si_per_unit,
            axis: *axis,
        })
    }

    /// The next sample: position (mm) and speed of the command.
    pub fn step(&mut self, [position, velocity]: [f64; 2]) -> Followed {
        let speed = self.motion.step(position);
        self.load += speed * self.period_s;
        let v = speed * self.si_per_unit;
        let a = self.accel.step(velocity) * self.si_per_unit;
        let [m, b, coulomb, weight] = self.mass;
        let rubbing = if v.abs() > STANDSTILL {
            coulomb * v.signum()
        } else {
            0.0
        };
        let force = m * a + b * v + rubbing + weight;
        Followed {
            position: self.load,
            force,
            power: crate::power::electrical_w(&self.axis, v, force),
        }
    }
}

/// Whether the loop is slow enough for the resonances of the drive to be taken
/// into the force: else it would be without bounds.
pub(super) fn has_force_poles(response: &Response) -> bool {
    let degree = |roots: &[ResponseRoot]| {
        roots
            .iter()
            .map(|r| Factor::from(r).degree())
            .sum::<usize>()
    };
    degree(&response.force_poles) <= degree(&response.poles)
}

fn sections(filter: Option<&CommandFilter>) -> Vec<Biquad> {
    let sections = filter.iter().flat_map(|filter| &filter.sections);
    sections.map(|section| Biquad::of(*section)).collect()
}

/// By how much a response and its filter are late, and how long they take to
/// settle to a ten-thousandth, s.
pub(super) fn times(response: &Response, filter: Option<&CommandFilter>) -> [f64; 2] {
    const SETTLED: f64 = 9.2;
    let transfer = TransferFunction::from(response);
    let mut late = transfer.delay_s;
    let mut slowest = f64::INFINITY;
    for pole in &transfer.poles {
        late += pole.lag_s();
        slowest = slowest.min(match *pole {
            Factor::Pair {
                omega_rad_s: w,
                damping: d,
            } if d < 1.0 => d * w,
            Factor::Pair {
                omega_rad_s: w,
                damping: d,
            } => w / (d + (d * d - 1.0).sqrt()),
            Factor::Real { time_constant_s } => 1.0 / time_constant_s,
        });
    }
    if let Some(filter) = filter {
        for [.., a1, a2] in &filter.sections {
            for pole in roots(&[*a2, *a1, 1.0]).unwrap_or_default() {
                let decay = -libm::log(pole.norm().max(1e-12)) / filter.period_s;
                slowest = slowest.min(decay);
                late += 1.0 / decay;
            }
            late += 2.0 * filter.period_s;
        }
    }
    [late, SETTLED / slowest]
}
