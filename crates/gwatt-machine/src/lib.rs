#![doc = include_str!("../README.md")]
//!
//! # Units
//!
//! Motion is in mm (or degrees) and seconds, power in SI; names carry their unit
//! as a suffix. [`units`] has the few factors between them.

pub mod units;

mod axis;
pub mod builtin;
mod config;
mod controller;
mod dialect;
mod family;
mod knob;
mod levels;
mod look_ahead;
mod model;
mod motors;
mod printer;
mod queue;
mod response;
mod servo;

pub use axis::{ALL_AXES, AXES, Axis, AxisId, AxisKind, AxisSet, AxisValues, FURTHER_REFERENCES};
pub use builtin::builtin_controller;
pub use config::{Loaded, controller_schema, schema};
pub use controller::*;
pub use dialect::*;
pub use family::{Family, FamilyFacts, LevelWords, LowerOf, TurningPlane};
pub use knob::*;
pub use levels::*;
pub use look_ahead::*;
pub use model::*;
pub use motors::{Motor, MotorKind, MotorSeries, motor, motors};
pub use printer::*;
pub use queue::*;
pub use response::*;
pub use servo::{Servo, servo_factor, servo_response_s};
