//! Units of measure: motion in mm (or degrees) and seconds, power in SI.
//!
//! Names carry their unit as a suffix on plain `f64`; the constants here are
//! the only places where one unit becomes another.

/// Millimetres in one inch, exact by definition.
pub const MM_PER_INCH: f64 = 25.4;
/// Metres in one millimetre: joins motion in mm to power in SI.
pub const M_PER_MM: f64 = 1e-3;
/// Radians in one degree: joins rotary motion to power in SI.
pub const RAD_PER_DEG: f64 = std::f64::consts::PI / 180.0;
/// Radians per second in one revolution per minute.
pub const RAD_S_PER_RPM: f64 = std::f64::consts::TAU / SECONDS_PER_MINUTE;
/// Seconds in one minute: feeds are given per minute.
pub const SECONDS_PER_MINUTE: f64 = 60.0;
