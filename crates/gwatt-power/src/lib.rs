#![doc = include_str!("../README.md")]
//!
//! # From plans to demand
//!
//! Input: the machine, moves and their plans. Output: [`Demand`], the peaks
//! drawn and fed back, and the energy. [`PowerModel`] evaluates one plan;
//! [`Assessor`] takes the moves of a program in order, plans them together where the
//! controller does, and holds limits over time against what they draw.
//!
//! The power of converter c is its base load, the switched loads and the sum
//! over its axes (see [`electrical_w`]). Where it credits regeneration the sum is the
//! plain sum; where not, only motoring axes count towards the peak and the
//! energy, and only regenerating ones towards the regenerative peak.

mod assess;
mod assessment;
mod lookahead;
mod alone;
mod arc;
mod arc_circle;
mod arc_energy;
mod arc_piece;
mod axis;
mod bus;
mod spindle_share;
mod blend;
mod upper_bound;
mod changing;
mod circle;
mod cruise;
mod cutting;
mod demand;
mod drive_law;
mod effect;
mod observer;
mod pending;
mod idle;
mod independent;
mod instant;
mod interval;
mod joining;
mod knob;
mod override_steps;
mod late;
mod line;
mod model;
mod motion;
mod piece;
mod polynomial;
mod quadrants;
mod quadrature;
#[cfg(test)]
mod random;
mod robust;
#[cfg(test)]
mod sample;
mod search;
mod slower;
mod overlap;
mod overlap_lower;
mod spindle;
mod spindle_lower;
mod spindle_state;
mod spindle_trace;
mod surface_speed;
mod surge;
mod parabolic_blend;
mod tandem_energy;
mod straight;
mod axis_bound;
mod stray;
mod steps;
mod stretch;
mod trace;
mod duty_cycle;
mod bus_voltage;
mod voltages;

pub use assess::Assessor;
pub use assessment::{Assessment, Certificate, Loads};
pub use axis::electrical_w;
pub use bus::Turning;
pub use bus_voltage::BusVoltages;
pub use demand::{Demand, Want};
pub use drive_law::DriveLaw;
pub use duty_cycle::{Measure, Rating, VoltageCurve, VoltageSpan};
pub use effect::{Effect, Switched};
pub use instant::{AxisInstant, Instant, SpindleInstant};
pub use line::plans_lines;
pub use lookahead::{Role, joint, role};
pub use model::PowerModel;
pub use motion::Motion;
pub use override_steps::{Knobs, Ladder, Lower};
pub use spindle::{RunPhase, SpindlePower, SpindleRun, spindle_run};
pub use spindle_share::SpindleShare;
pub use spindle_trace::{SpindleSpan, SpindleTrace};
pub use trace::{Flow, Slice};
pub use voltages::Durations;
