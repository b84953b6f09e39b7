//! The table of an axis as it is written.

use schemars::JsonSchema;
use serde::Deserialize;

use super::part_tables::{ScrewTable, WheelTable};
use super::value::{
    At, AtLeastOne, Fraction, NotNegative, Number, Part, Positive, ResponseTime, Share,
};
use crate::axis::AxisKind;

/// An axis: speed, acceleration and mass, each in one of its forms.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct AxisTable {
    /// Slides or turns; default: A, B and C turn, all others slide.
    pub(crate) kind: Option<At<AxisKind>>,
    /// Linear: rapid speed in mm/min; caps feeds too.
    pub(crate) rapid_mm_min: Option<Positive>,
    /// Linear: largest speed of the axis in a feed in mm/min; default: none is known.
    pub(crate) max_feed_mm_min: Option<Positive>,
    /// Linear: speed on the way to the reference point (G28, homing) in mm/min; default: the
    /// rapid speed.
    pub(crate) reference_mm_min: Option<Positive>,
    /// Linear: machine coordinate of the reference point (G28, homing) in mm; default: not
    /// known. Then G28 of a mill or lathe is taken to go to machine zero, with a note; after
    /// homing (G28 of a printer, grbl's $H) the next move counts at full speed and
    /// acceleration.
    pub(crate) reference_mm: Option<Number>,
    /// Linear: machine coordinates of further points in mm: those of G30 from the second on
    /// (Fanuc's parameters 1241 to 1243), or the fixed points of SINUMERIK's G75 from the first
    /// on (MD30600); default: not known.
    #[schemars(length(max = 4))]
    pub(crate) further_reference_mm: Option<At<Vec<Number>>>,
    /// The same as `reference_mm_min`, by an earlier name.
    pub(crate) home_mm_min: Option<Positive>,
    /// The same as `reference_mm`, by an earlier name.
    pub(crate) home_mm: Option<Number>,
    /// Rotary: largest speed of the axis in a feed in degrees/min; default: none is known.
    pub(crate) max_feed_deg_min: Option<Positive>,
    /// Rotary: speed on the way to the reference point in degrees/min; default: the rapid speed.
    pub(crate) reference_deg_min: Option<Positive>,
    /// Rotary: machine coordinate of the reference point in degrees; default: not known.
    pub(crate) reference_deg: Option<Number>,
    /// Rotary: machine coordinates of further points in degrees, see `further_reference_mm`.
    #[schemars(length(max = 4))]
    pub(crate) further_reference_deg: Option<At<Vec<Number>>>,
    /// Rotary: rapid speed in degrees/min.
    pub(crate) rapid_deg_min: Option<Positive>,
    /// Largest speed of the motor (of the table without `gear_ratio`) in 1/min.
    pub(crate) max_speed_rpm: Option<Positive>,
    /// Linear: acceleration in mm/s².
    pub(crate) accel_mm_s2: Option<Positive>,
    /// Rotary: acceleration in degrees/s².
    pub(crate) accel_deg_s2: Option<Positive>,
    /// Time from rest to the largest speed in s.
    pub(crate) accel_time_s: Option<Positive>,
    /// Linear: moved mass in kg, drive included (what is given as `rotor_kg_m2`, `screw`,
    /// `pulley` or `pinion` is added).
    pub(crate) mass_kg: Option<Positive>,
    /// Total inertia in kg·m²: at the motor with `lead_mm` or `gear_ratio`,
    /// else at the rotary table (what is given as `rotor_kg_m2` and so on is added).
    pub(crate) inertia_kg_m2: Option<Positive>,
    /// Linear: mass of all that slides in kg, without the drive: table, workpiece, slide.
    /// `rotor_kg_m2` and `screw`, `pulley` or `pinion` are added.
    pub(crate) moved_mass_kg: Option<Positive>,
    /// Rotary: inertia of table and workpiece in kg·m², without the drive; `rotor_kg_m2` is
    /// added.
    pub(crate) moved_inertia_kg_m2: Option<Positive>,
    /// Inertia of the motor's rotor in kg·m², with coupling and brake; 0 for a linear motor.
    pub(crate) rotor_kg_m2: Option<NotNegative>,
    /// Linear: the screw, as a solid cylinder of steel.
    pub(crate) screw: Option<At<ScrewTable>>,
    /// Linear: the pulleys of a toothed belt.
    pub(crate) pulley: Option<At<WheelTable>>,
    /// Linear: the pinion of a rack.
    pub(crate) pinion: Option<At<WheelTable>>,
    /// Linear: Coulomb friction in N; default 0.
    pub(crate) coulomb_n: Option<NotNegative>,
    /// Coulomb friction torque in N·m, on the side of the inertia; default 0.
    pub(crate) friction_nm: Option<NotNegative>,
    /// Linear: viscous friction in N·s/m; default 0.
    pub(crate) viscous_n_s_m: Option<NotNegative>,
    /// Viscous friction in N·m·s/rad, on the side of the inertia; default 0.
    pub(crate) viscous_nm_s_rad: Option<NotNegative>,
    /// Linear: force needed to move in + direction besides friction, in N.
    pub(crate) gravity_n: Option<Number>,
    /// Torque needed to move in + direction besides friction, in N·m, on the
    /// side of the inertia.
    pub(crate) gravity_nm: Option<Number>,
    /// Copper loss in W per N² (rotary: W per (N·m)²); default 0.
    pub(crate) copper_w_n2: Option<NotNegative>,
    /// Copper loss in W per (N·m)², on the side of the inertia; default 0.
    pub(crate) copper_w_nm2: Option<NotNegative>,
    /// Linear, motor side: travel per screw revolution in mm.
    pub(crate) lead_mm: Option<Positive>,
    /// Motor revolutions per screw or table revolution; default 1.
    pub(crate) gear_ratio: Option<Positive>,
    /// Mechanical by electrical power, 0 to 1; default 1.
    pub(crate) efficiency: Option<Share>,
    /// Linear: jerk limit in mm/s³: speed follows S-curves; 0: none.
    pub(crate) jerk_mm_s3: Option<NotNegative>,
    /// Rotary: jerk limit in degrees/s³: speed follows S-curves; 0: none.
    pub(crate) jerk_deg_s3: Option<NotNegative>,
    /// Linear: largest force of the drive over the speed, straight between the
    /// points, the first at speed 0, the last at the rapid speed or beyond. What
    /// friction and weight leave of it limits the acceleration at each speed.
    pub(crate) force_curve: Option<Vec<At<ForcePointTable>>>,
    /// Largest torque of the motor (of the table without `gear_ratio`) over its
    /// speed, straight between the points, the first at speed 0, the last at the
    /// rapid speed or beyond. What friction and weight leave of it limits the
    /// acceleration at each speed.
    pub(crate) torque_curve: Option<Vec<At<TorquePointTable>>>,
    /// Gain of the position loop in 1/s. With it the file describes how the drive
    /// follows, and the servo factors come from that.
    pub(crate) position_gain_1_s: Option<Positive>,
    /// Bandwidth of the velocity loop in Hz, at the mass of the file; needed with
    /// `position_gain_1_s`.
    pub(crate) velocity_bandwidth_hz: Option<Positive>,
    /// Reset time of the velocity loop in s; without it the loop is proportional.
    pub(crate) velocity_integral_time_s: Option<ResponseTime>,
    /// Share of the commanded speed that is fed forward, 0 to 1; default 0.
    pub(crate) velocity_feedforward: Option<Fraction>,
    /// Share of the commanded acceleration that is fed forward, 0 to 1; default 0.
    pub(crate) acceleration_feedforward: Option<Fraction>,
    /// How far real acceleration exceeds the command when driving; default 1, or
    /// what follows from `position_gain_1_s`, with which it is not to be given.
    pub(crate) servo_factor_motor: Option<AtLeastOne>,
    /// The same when braking; default 1.
    pub(crate) servo_factor_regen: Option<AtLeastOne>,
    /// Friction of the warm machine by that of the cold one; default 1.
    pub(crate) friction_min_ratio: Option<Share>,
    /// By what share the mass may be more or less than it says: peaks hold for all of
    /// them; default: that of `[limits]`.
    pub(crate) mass_error: Option<Part>,
    /// The same of friction.
    pub(crate) friction_error: Option<Part>,
    /// How the load follows the position command.
    pub(crate) response: Option<At<ResponseTable>>,
    /// Filter of the position command that makes the axes answer alike.
    pub(crate) correction: Option<At<CorrectionTable>>,
}

/// How the load of an axis follows its position command: gain 1, times zeros,
/// by poles, after a delay. An empty table: at once.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ResponseTable {
    /// Gain of the position loop in 1/s: a pole.
    pub(crate) position_gain_1_s: Option<Positive>,
    /// Bandwidth of the velocity loop in Hz: a pair of poles, damping 0.7071.
    pub(crate) velocity_bandwidth_hz: Option<Positive>,
    /// Zeros: anti-resonances.
    pub(crate) zeros: Option<Vec<At<RootTable>>>,
    /// Poles, besides those of the loops given by gain or bandwidth.
    pub(crate) poles: Option<Vec<At<RootTable>>>,
    /// Poles from force or torque to the load's acceleration: resonances.
    pub(crate) force_poles: Option<Vec<At<RootTable>>>,
    /// Dead time in ms; default 0.
    pub(crate) delay_ms: Option<NotNegative>,
}

/// A pair of zeros or poles, or a single real one.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct RootTable {
    /// Of a pair: its frequency in Hz.
    pub(crate) frequency_hz: Option<Positive>,
    /// Of a pair: its damping ratio.
    pub(crate) damping: Option<Number>,
    /// Of a single one: its time constant in s.
    pub(crate) time_constant_s: Option<Number>,
}

/// A digital filter of the position command.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct CorrectionTable {
    /// Its sampling period in ms.
    #[schemars(required)]
    pub(crate) period_ms: Option<Positive>,
    /// Second-order sections, each `[b0, b1, b2, a1, a2]`.
    #[schemars(required)]
    pub(crate) sections: Option<Vec<At<Vec<Number>>>>,
}

/// A point of a force curve.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ForcePointTable {
    /// Speed in mm/min.
    #[schemars(required)]
    pub(crate) speed_mm_min: Option<NotNegative>,
    /// Largest force there in N.
    #[schemars(required)]
    pub(crate) force_n: Option<Positive>,
}

/// A point of a torque curve.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct TorquePointTable {
    /// Speed in 1/min.
    #[schemars(required)]
    pub(crate) rpm: Option<NotNegative>,
    /// Largest torque there in N·m.
    #[schemars(required)]
    pub(crate) torque_nm: Option<Positive>,
}
