//! The machine file as it is written: names here are the names in the file.
//!
//! Every field is optional to serde; what is required, and what may be given
//! in one way only, is checked where the machine is assembled, so that all
//! mistakes of a file are reported at once.

use schemars::JsonSchema;
use serde::Deserialize;

use super::controller_file::{CompensationTable, DistanceName, PointName};
use super::levels::LevelsTable;
use super::offsets::OffsetsTable;
use super::outputs::OutputsTable;
use super::value::{
    At, AtLeastOne, Fraction, Letter, NotNegative, Number, OneOrMany, Part, PerAxis, Positive,
    RapidPercent, ResponseTime, Share,
};

/// A machine whose drives share a power converter.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "gwatt machine file")]
pub(crate) struct MachineFile {
    /// Version of this format: 1.
    #[schemars(required)]
    pub(crate) schema: Option<At<u32>>,
    /// What reports call the machine.
    #[schemars(required)]
    pub(crate) name: Option<At<String>>,
    /// A built-in controller profile, or a profile file relative to this file.
    #[schemars(required)]
    pub(crate) controller: Option<At<String>>,
    /// The converter; several as `[[converter]]`, each with `name` and `axes`.
    #[schemars(required)]
    pub(crate) converter: Option<OneOrMany<ConverterTable>>,
    /// How the path is followed.
    pub(crate) path: Option<At<PathTable>>,
    /// Parameters of the control that change how programs are read.
    pub(crate) language: Option<At<OwnLanguageTable>>,
    /// Work offsets that the control keeps, by the words that select them.
    pub(crate) offsets: Option<At<OffsetsTable>>,
    /// Analog outputs of the control that act on the motion.
    pub(crate) outputs: Option<At<OutputsTable>>,
    /// The axes by letter; at least one.
    #[schemars(required)]
    pub(crate) axes: Option<At<PerAxis<At<AxisTable>>>>,
    /// The spindle.
    pub(crate) spindle: Option<At<SpindleTable>>,
    /// Tools with what cutting takes.
    pub(crate) tool: Option<Vec<At<ToolTable>>>,
    /// What program words switch on and off.
    pub(crate) load: Option<Vec<At<LoadTable>>>,
    /// Limits for combinations of axes.
    pub(crate) preset: Option<Vec<At<PresetTable>>>,
    /// Words that select accelerations or rapid speeds.
    pub(crate) levels: Option<Vec<At<LevelsTable>>>,
    /// Margin, overrides and floors.
    pub(crate) limits: Option<At<LimitsTable>>,
}

/// The converter (power supply) of the drives.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ConverterTable {
    /// Its name; required if there are several.
    pub(crate) name: Option<At<String>>,
    /// The axes it feeds; required if there are several converters.
    pub(crate) axes: Option<At<Vec<At<Letter>>>>,
    /// Peak power in W.
    #[schemars(required)]
    pub(crate) peak_power_w: Option<Positive>,
    /// Largest power that may be fed back in W; absent: no limit.
    pub(crate) regen_power_w: Option<NotNegative>,
    /// What is drawn at all times in W; default 0.
    pub(crate) base_load_w: Option<NotNegative>,
    /// Whether fed-back power feeds the other axes; default false.
    pub(crate) credit_regen: Option<bool>,
    /// Continuous power (RMS) in W.
    pub(crate) continuous_power_w: Option<Positive>,
    /// Window of the continuous power in s; default 180.
    pub(crate) window_s: Option<Positive>,
    /// Powers that are permitted for a time.
    pub(crate) overload: Option<Vec<At<OverloadTable>>>,
    /// Whether peaks beyond the converter's power may come from the capacitance
    /// and go into it, within the voltages; default false.
    pub(crate) credit_capacitance: Option<bool>,
    /// Capacitance of the DC bus in F.
    pub(crate) capacitance_f: Option<Positive>,
    /// Nominal voltage of the DC bus in V.
    pub(crate) bus_nominal_v: Option<Positive>,
    /// Lowest permitted voltage in V.
    pub(crate) bus_min_v: Option<Positive>,
    /// Highest permitted voltage in V.
    pub(crate) bus_max_v: Option<Positive>,
    /// Power that the braking resistor gives off for ever, in W.
    pub(crate) brake_power_w: Option<NotNegative>,
    /// Energy that the braking resistor takes in one go beyond that, in J.
    pub(crate) brake_energy_j: Option<NotNegative>,
}

/// A power that is permitted for a time.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct OverloadTable {
    /// The power in W.
    #[schemars(required)]
    pub(crate) power_w: Option<Positive>,
    /// For how long, in s.
    #[schemars(required)]
    pub(crate) seconds: Option<Positive>,
    /// How often, in s.
    #[schemars(required)]
    pub(crate) every_s: Option<Positive>,
}

/// How the path is followed.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct PathTable {
    /// `exact-stop` overrides the program's G64; absent: the controller's mode.
    pub(crate) mode: Option<PathModeName>,
    /// Straight rapids, or each axis for itself; absent: the controller's.
    pub(crate) rapid: Option<RapidName>,
    /// Over how long the drives spread a step of speed at a corner, in s; default
    /// 0.01, or what follows for axes that give `position_gain_1_s`.
    pub(crate) response_time_s: Option<ResponseTime>,
    /// Largest F of a cutting move in mm/min: one in a program counts as it, and none above
    /// it is written; default: none is known.
    pub(crate) max_feed_mm_min: Option<Positive>,
    /// Machine coordinates, in mm or degrees, from which on in positive direction nothing
    /// stands in the way of the axes: there `--allow straighten` may write rapids of axes that
    /// move each for itself as lines.
    pub(crate) clearance: Option<PerAxis<Number>>,
}

/// Parameters of the control that change how programs are read; what is absent
/// is as in the controller profile.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct OwnLanguageTable {
    /// What a number without a decimal point means.
    pub(crate) decimal_point: Option<PointName>,
    /// Whether words of X are diameters.
    pub(crate) diameter: Option<bool>,
    /// The F in force at power-on, in mm/min (SINUMERIK: setting data 42110): where moves come
    /// before any F, none above it is written for them.
    pub(crate) power_on_feed_mm_min: Option<Positive>,
    /// Whether G83 and G87 of a lathe come out to R after each peck (Fanuc: parameter 5101
    /// bit RTR).
    pub(crate) pecks_return_to_r: Option<bool>,
    /// How far G73 and G83 stay off the last depth, in mm (Fanuc: parameters 5114 and 5115).
    pub(crate) peck_clearance_mm: Option<Positive>,
    /// How arc centres I J K are meant at power-on.
    pub(crate) arc_centre: Option<DistanceName>,
    /// How G41 and G42 shift the path.
    pub(crate) cutter_compensation: Option<CompensationTable>,
    /// G and M words that move no axis and raise no limit on this machine, besides those of
    /// the profile, such as "M101" or a remap "M428". What one switches on is a [[load]].
    pub(crate) ignored: Option<Vec<At<String>>>,
    /// Extended commands of a printer that move nothing and set nothing, besides those of
    /// the profile; `*` at the end stands for anything.
    pub(crate) ignored_macros: Option<Vec<At<String>>>,
    /// Commands of a printer whose moves are not known, besides those of the profile: every
    /// axis counts at its full speed and acceleration, and its place is not known
    /// afterwards. They must leave feed and modes as they are.
    pub(crate) unknown_moves: Option<Vec<At<String>>>,
}

/// What happens at the joint of two blocks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum PathModeName {
    ExactStop,
    LookAhead,
}

/// How rapids run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum RapidName {
    Linear,
    Independent,
}

/// Whether an axis slides or turns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum KindName {
    Linear,
    Rotary,
}

/// An axis: speed, acceleration and mass, each in one of its forms.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct AxisTable {
    /// Slides or turns; default: A, B and C turn, all others slide.
    pub(crate) kind: Option<At<KindName>>,
    /// Linear: rapid speed in mm/min; caps feeds too.
    pub(crate) rapid_mm_min: Option<Positive>,
    /// Linear: speed on the way to the reference point (G28, homing) in mm/min; default: the
    /// rapid speed.
    pub(crate) reference_mm_min: Option<Positive>,
    /// Linear: machine coordinate of the reference point (G28, homing) in mm; default: not
    /// known. Then G28 of a mill or lathe is taken to go to machine zero, with a note; after
    /// homing (G28 of a printer, grbl's $H) the next move counts at full speed and
    /// acceleration.
    pub(crate) reference_mm: Option<Number>,
    /// The same as `reference_mm_min`, by an earlier name.
    pub(crate) home_mm_min: Option<Positive>,
    /// The same as `reference_mm`, by an earlier name.
    pub(crate) home_mm: Option<Number>,
    /// Rotary: speed on the way to the reference point in degrees/min; default: the rapid speed.
    pub(crate) reference_deg_min: Option<Positive>,
    /// Rotary: machine coordinate of the reference point in degrees; default: not known.
    pub(crate) reference_deg: Option<Number>,
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
    /// Linear: moved mass in kg, drive included.
    pub(crate) mass_kg: Option<Positive>,
    /// Total inertia in kg·m²: at the motor with `lead_mm` or `gear_ratio`,
    /// else at the rotary table.
    pub(crate) inertia_kg_m2: Option<Positive>,
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

/// The spindle.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct SpindleTable {
    /// Inertia at the spindle in kg·m².
    #[schemars(required)]
    pub(crate) inertia_kg_m2: Option<Positive>,
    /// Friction torque in N·m; default 0.
    pub(crate) friction_nm: Option<NotNegative>,
    /// Largest speed in 1/min.
    #[schemars(required)]
    pub(crate) max_rpm: Option<Positive>,
    /// Speed up to which the torque is constant, in 1/min; 0: not given.
    pub(crate) base_rpm: Option<NotNegative>,
    /// Time from rest to `max_rpm` in s; from it comes the acceleration.
    pub(crate) accel_time_s: Option<Positive>,
    /// Instead of `accel_time_s` and `base_rpm`: the largest torque over the
    /// speed, straight between the points, the first at speed 0; the last holds
    /// beyond.
    pub(crate) torque_curve: Option<Vec<At<TorquePointTable>>>,
    /// Time to full acceleration in s; default 0.
    pub(crate) jerk_time_s: Option<NotNegative>,
    /// Mechanical by electrical power, 0 to 1; default 1.
    pub(crate) efficiency: Option<Share>,
    /// What the spindle's drive draws as long as it is switched on, in W;
    /// default 0.
    pub(crate) base_load_w: Option<NotNegative>,
    /// Largest electrical power that the spindle's drive draws, in W, base load
    /// included; absent: no limit.
    pub(crate) peak_power_w: Option<Positive>,
    /// Largest electrical power that the spindle's drive feeds back, in W;
    /// absent: no limit.
    pub(crate) regen_power_w: Option<Positive>,
    /// Whether feed moves wait for the speed; default as the controller has it.
    pub(crate) wait: Option<bool>,
    /// What cutting takes at the spindle in feed moves, with tools that have no
    /// `[[tool]]`, in W; default 0.
    pub(crate) cutting_power_w: Option<NotNegative>,
    /// The converter that feeds it; required if there are several.
    pub(crate) converter: Option<At<String>>,
}

/// What cutting with a tool takes at the spindle: a power, or the specific
/// cutting force with width and depth of cut.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ToolTable {
    /// Its T number.
    #[schemars(required)]
    pub(crate) number: Option<NotNegative>,
    /// The power in W, at any feed.
    pub(crate) cutting_power_w: Option<NotNegative>,
    /// Specific cutting force kc in N/mm²: the power is kc times width, depth
    /// and feed.
    pub(crate) kc_n_mm2: Option<Positive>,
    /// Width of cut in mm; with `kc_n_mm2`.
    pub(crate) width_mm: Option<Positive>,
    /// Depth of cut in mm; with `kc_n_mm2`.
    pub(crate) depth_mm: Option<Positive>,
}

/// A load that program words switch.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct LoadTable {
    /// Word or words that switch it on, such as `M8`. On a printer a word with a
    /// value (`M104 S200`, `M106 S255`) switches it off when the value is 0.
    #[schemars(required)]
    pub(crate) on: Option<OneOrMany<String>>,
    /// Word or words that switch it off.
    #[schemars(required)]
    pub(crate) off: Option<OneOrMany<String>>,
    /// What it draws in W.
    #[schemars(required)]
    pub(crate) power_w: Option<Positive>,
    /// The converter that feeds it; required if there are several.
    pub(crate) converter: Option<At<String>>,
}

/// Limits that hold when exactly these axes start together.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct PresetTable {
    /// The combination.
    #[schemars(required)]
    pub(crate) axes: Option<At<Vec<At<Letter>>>>,
    /// Largest speeds in mm/min (rotary: degrees/min).
    pub(crate) speed_mm_min: Option<PerAxis<Positive>>,
    /// Largest accelerations in mm/s² (rotary: degrees/s²).
    pub(crate) accel_mm_s2: Option<PerAxis<Positive>>,
}

/// Margin, overrides and floors.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct LimitsTable {
    /// Share of the peak power that is kept free; default 0.1.
    pub(crate) margin: Option<Part>,
    /// By what share the mass of each axis may be more or less than it says: peaks hold
    /// for all of them; default 0.
    pub(crate) mass_error: Option<Part>,
    /// The same of friction.
    pub(crate) friction_error: Option<Part>,
    /// Largest overrides that the operator may set.
    pub(crate) override_max_percent: Option<OverrideTable>,
    /// No cutting feed is lowered below this, in mm/min; default: no floor.
    pub(crate) min_feed_mm_min: Option<NotNegative>,
    /// Nor below this share of the programmed feed; default: no floor.
    pub(crate) min_feed_ratio: Option<Fraction>,
}

/// Largest overrides in percent; default 100.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct OverrideTable {
    /// Of the feed.
    pub(crate) feed: Option<AtLeastOne>,
    /// Of the rapids.
    pub(crate) rapid: Option<RapidPercent>,
    /// Of the spindle speed.
    pub(crate) spindle: Option<AtLeastOne>,
}
