//! The machine file as it is written: names here are the names in the file.
//!
//! Every field is optional to serde; what is required, and what may be given
//! in one way only, is checked where the machine is assembled, so that all
//! mistakes of a file are reported at once.

use schemars::JsonSchema;
use serde::Deserialize;

pub(crate) use super::axis_table::{
    AxisTable, CorrectionTable, ForcePointTable, ResponseTable, RootTable, TorquePointTable,
};
use super::controller_file::{CompensationTable, DistanceName, FeedName, UnitsName};
use super::levels::LevelsTable;
use super::look_ahead::LookAheadTable;
use super::offsets::OffsetsTable;
use super::outputs::OutputsTable;
use super::printer_table::RetractTable;
use super::value::{
    At, AtLeastOne, Fraction, Letter, NotNegative, Number, OneOrMany, Part, PerAxis, Positive,
    RapidPercent, ResponseTime, Share,
};
use crate::controller::{
    ArcWithoutCenter, PathMode, PowerOnMotion, RapidPath, TapFeed, ToolChange, TypeTwo,
};
use crate::dialect::{InverseAngles, Point};

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
    /// Whether each axis has a motor of its own; default "cartesian".
    pub(crate) kinematics: Option<At<KinematicsName>>,
    /// How the path is followed.
    pub(crate) path: Option<At<PathTable>>,
    /// How corners are run through, where that is not as in the controller profile.
    pub(crate) look_ahead: Option<At<LookAheadTable>>,
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

/// Which motors move which axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(crate) enum KinematicsName {
    /// Each axis has its own.
    Cartesian,
    /// Two motors move X and Y together: their powers count by the robust bound.
    Corexy,
    /// The same with X and Z.
    Corexz,
}

/// The converter (power supply) of the drives.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ConverterTable {
    /// Its name; required if there are several.
    pub(crate) name: Option<At<String>>,
    /// The axes it feeds; required if there are several converters.
    pub(crate) axes: Option<At<Vec<At<Letter>>>>,
    /// What the supply of the drives delivers at most, in W: see its data sheet or label.
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
    pub(crate) mode: Option<PathMode>,
    /// Straight rapids, or each axis for itself; absent: the controller's.
    pub(crate) rapid: Option<RapidPath>,
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
    /// Printers: accelerations along the path in mm/s² when a program begins, as M204 sets
    /// them; default: none but those of the axes.
    pub(crate) accel_mm_s2: Option<At<PathAccelTable>>,
    /// Whether the laser mode of a control that has one is on (grbl: $32): S in a block that moves
    /// stops nothing then; default: not known, so that both cases are counted.
    pub(crate) laser_mode: Option<At<bool>>,
    /// The shortest time in s that the path of a block may take at its F for the control to
    /// keep that (Marlin: M205 B); default: as in the controller profile.
    pub(crate) shortest_at_feed_s: Option<NotNegative>,
}

/// Accelerations along the path in mm/s², by what moves.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct PathAccelTable {
    /// Of moves that extrude (M204 P).
    pub(crate) print: Option<Positive>,
    /// Of moves that do not (M204 T).
    pub(crate) travel: Option<Positive>,
    /// Of the extruder alone (M204 R).
    pub(crate) retract: Option<Positive>,
}

/// Parameters of the control that change how programs are read; what is absent
/// is as in the controller profile.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct OwnLanguageTable {
    /// Unit of lengths when a program begins.
    pub(crate) units: Option<UnitsName>,
    /// The tolerance of rounded corners when a program begins, as P of G64 gives it, in mm.
    pub(crate) power_on_tolerance_mm: Option<NotNegative>,
    /// Printers: G10 and G11 until the program sets them.
    pub(crate) retract: Option<At<RetractTable>>,
    /// Printers: axes that each G28 moves besides those that it homes, each group together, at
    /// the speeds of homing; where they end is not known (Klipper: `[safe_z_home]`).
    pub(crate) home_moves: Option<At<Vec<Vec<At<Letter>>>>>,
    /// What a number without a decimal point means.
    pub(crate) decimal_point: Option<Point>,
    /// Whether words of X are diameters.
    pub(crate) diameter: Option<bool>,
    /// What F means at power-on, before a G word of the program says so (SINUMERIK: machine data
    /// 20150\[14\]).
    pub(crate) feed: Option<FeedName>,
    /// The motion word in force at power-on (Fanuc: parameter 3402 bit G01; SINUMERIK: machine
    /// data 20150).
    pub(crate) power_on_motion: Option<PowerOnMotion>,
    /// The F in force at power-on, in mm/min (SINUMERIK: setting data 42110): where moves come
    /// before any F, none above it is written for them.
    pub(crate) power_on_feed_mm_min: Option<Positive>,
    /// Whether the tool changes before or after the motion of a block that has M6 in it, which
    /// the builder of the machine decides on many controls.
    pub(crate) tool_change: Option<ToolChange>,
    /// Whether words for the spindle (M3, M4, M5, S) act before the motion of their block, which the
    /// builder of the machine decides on many controls; otherwise both orders count.
    pub(crate) spindle_before_motion: Option<bool>,
    /// The axes that M6 sends to their reference points by itself, such as \["Z"\]; \[\] where it
    /// moves none.
    pub(crate) tool_change_moves: Option<Vec<At<String>>>,
    /// Whether G83 and G87 of a lathe come out to R after each peck (Fanuc: parameter 5101
    /// bit RTR).
    pub(crate) pecks_return_to_r: Option<bool>,
    /// How far G73 and G83 stay off the last depth, in mm (Fanuc: parameters 5114 and 5115).
    pub(crate) peck_clearance_mm: Option<Positive>,
    /// How far the tool goes off after a pass of G71 and G72 of a lathe that gives no R, in mm
    /// (Fanuc: parameter 5133; Haas: Setting 73).
    pub(crate) escape_mm: Option<NotNegative>,
    /// How far it goes back after a peck of G74 and G75 of a lathe that gives no R, in mm
    /// (Fanuc: parameter 5139; Haas: Setting 22).
    pub(crate) groove_return_mm: Option<NotNegative>,
    /// How G71 and G72 of a lathe go from pass to pass where the first block of the contour
    /// names X and Z (type II) and the contour has no pocket: as in type I, or along the contour
    /// up to the pass before; default: as the profile says, else not known.
    pub(crate) type_2: Option<TypeTwo>,
    /// How arc centres I J K are meant at power-on.
    pub(crate) arc_centre: Option<DistanceName>,
    /// What a block with axes under G2 or G3 is that has neither a centre nor a radius (Fanuc:
    /// parameter 3403 bit CIR); default: as the profile says.
    pub(crate) arc_without_center: Option<ArcWithoutCenter>,
    /// How many times as fast as the way in the return of a rigid tap is (Haas: Setting 130;
    /// Fanuc: parameter 5211, as a factor; Mitsubishi: #1172); default 1.
    pub(crate) tap_return_factor: Option<AtLeastOne>,
    /// What F of G74 and G84 of a mill is where the program does not say so (Mitsubishi: #8159;
    /// Mazak: F94 bit 6); default: as the profile says.
    pub(crate) tap_feed: Option<TapFeed>,
    /// What ATAN\[…\]/\[…\] and ASIN\[…\] of macros give for negative angles (Fanuc: parameter
    /// 6004 bit NAT).
    pub(crate) inverse_angles: Option<InverseAngles>,
    /// How G41 and G42 shift the path.
    pub(crate) cutter_compensation: Option<CompensationTable>,
    /// G and M words that move no axis and raise no limit on this machine, besides those of
    /// the profile, such as "M101" or a remap "M428". What one switches on is a [[load]].
    pub(crate) ignored: Option<Vec<At<String>>>,
    /// Extended commands of a printer that move nothing and set nothing, besides those of
    /// the profile; `*` at the end stands for anything.
    pub(crate) ignored_macros: Option<Vec<At<String>>>,
    /// Commands of a printer whose moves are not known, besides those of the profile, or G and M
    /// words of the builder of a machine: every axis counts at its full speed and acceleration,
    /// and its place is not known afterwards. They must leave feed and modes as they are.
    pub(crate) unknown_moves: Option<Vec<At<String>>>,
    /// Macros of a printer of which nothing is known, besides those of the profile: they may
    /// move, heat, and leave another feed and other modes and limits.
    pub(crate) unknown_macros: Option<Vec<At<String>>>,
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
    /// Word or words that switch it off; needed but where all of `on` switch it off by the
    /// value 0.
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
