//! The validated machine: what the rest of gwatt reads.

use std::collections::BTreeMap;

use super::axis::{AXES, Axis, AxisId, AxisSet, AxisValues};
use super::controller::{Controller, PathMode, RapidPath, SpindleWait};
use super::response::Responses;

/// A machine: its axes, converters and limits, all values checked.
#[derive(Debug, Clone, PartialEq)]
pub struct Machine {
    /// The name in the file.
    pub name: String,
    /// What its controller reads and plans, and the words that it takes.
    pub controller: Controller,
    /// Axes by `AxisId as usize`; `None` where the machine has none.
    pub axes: [Option<Axis>; AXES],
    /// The axes that exist.
    pub axis_set: AxisSet,
    /// At least one; several where groups of axes have converters of their own.
    pub converters: Vec<Converter>,
    /// Which motors move which axes.
    pub kinematics: Kinematics,
    /// How the path is followed; from `[path]`, else from the controller.
    pub path: Path,
    /// Force or torque over speed of the axes for which it is given.
    pub force_curves: Vec<(AxisId, Vec<ForcePoint>)>,
    /// What the mass (of rotary axes: inertia) is the sum of, of axes whose drives are
    /// described by parts.
    pub mass_parts: Vec<(AxisId, Vec<MassPart>)>,
    /// How loads follow commands, of the axes for which it is given.
    pub responses: Responses,
    /// The spindle, if described.
    pub spindle: Option<Spindle>,
    /// Tools with what cutting takes.
    pub tools: Vec<CuttingTool>,
    /// What program words switch on and off.
    pub loads: Vec<Load>,
    /// Work offsets that the control keeps, by the number of the system (G54 is 1, G59.3 is
    /// 9); `None` where none are given. Machine coordinates of its zero.
    pub offsets: [Option<AxisValues>; 9],
    /// The same of further systems (G54.1, G154), by their P.
    pub further_offsets: BTreeMap<u16, AxisValues>,
    /// Where G28 and G30 lead, by axis, in machine coordinates, on controls that keep these
    /// points among their parameters; `None` where it is not given.
    pub points: [[Option<f64>; AXES]; 2],
    /// Limits for combinations of axes.
    pub presets: Vec<Preset>,
    /// Margin, overrides and floors.
    pub limits: Limits,
}

impl Limits {
    /// Whether lower overrides count than those at which peaks are taken.
    #[must_use]
    pub fn counts_lower(&self) -> bool {
        self.override_at.is_none() || self.override_from.is_some()
    }

    /// The least shares of these that feeds and rapids stand at.
    #[must_use]
    pub fn least_shares(&self) -> [f64; 2] {
        self.override_from.unwrap_or_default()
    }
}

/// A converter (power supply) and the axes it feeds.
#[derive(Debug, Clone, PartialEq)]
pub struct Converter {
    /// Its name; empty when there is only one without a name.
    pub name: String,
    /// The axes it feeds; all of them when there is only one.
    pub axes: AxisSet,
    /// Peak power in W, margin not taken off.
    pub peak_power_w: f64,
    /// Largest power that may be fed back in W; `None`: no limit.
    pub regen_power_w: Option<f64>,
    /// What is drawn at all times in W.
    pub base_load_w: f64,
    /// Whether fed-back power feeds the other axes.
    pub credit_regen: bool,
    /// What it bears over time.
    pub ratings: Ratings,
}

/// What a converter bears over time, margins not taken off. What is not given is
/// not checked.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Ratings {
    /// Power that it may deliver for ever, as RMS over a window.
    pub continuous: Option<Continuous>,
    /// Powers that are permitted for a time, from the largest on.
    pub overload: Vec<Overload>,
    /// The DC bus, where capacitance and nominal voltage are given.
    pub capacitor: Option<Capacitor>,
    /// Whether a peak beyond the converter's own may come from the capacitor, or
    /// go into it: then peaks are judged by the voltage.
    pub credit_capacitance: bool,
    /// The braking resistor.
    pub brake: Option<Brake>,
}

impl Ratings {
    /// Whether peaks that are drawn may come from the capacitor.
    #[must_use]
    pub fn credits_low(&self) -> bool {
        self.credit_capacitance && self.capacitor.is_some_and(|bus| bus.min_v.is_some())
    }

    /// Whether peaks that are fed back may go into the capacitor.
    #[must_use]
    pub fn credits_high(&self) -> bool {
        self.credit_capacitance && self.capacitor.is_some_and(|bus| bus.max_v.is_some())
    }
}

/// Power that may be delivered for ever.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Continuous {
    /// Root of the mean square in W.
    pub power_w: f64,
    /// Over how long, in s.
    pub window_s: f64,
}

/// A power that is permitted for a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overload {
    /// In W.
    pub power_w: f64,
    /// For how long, in s.
    pub seconds: f64,
    /// Within what time, in s.
    pub every_s: f64,
}

/// The capacitor of a DC bus.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Capacitor {
    /// In F.
    pub capacitance_f: f64,
    /// The voltage that the converter keeps, in V.
    pub nominal_v: f64,
    /// Lowest permitted voltage in V.
    pub min_v: Option<f64>,
    /// Highest permitted voltage in V.
    pub max_v: Option<f64>,
}

impl Capacitor {
    /// Energy between the nominal and another voltage in J, not signed.
    #[must_use]
    pub fn energy_j(&self, volts: f64) -> f64 {
        let squares = (self.nominal_v - volts) * (self.nominal_v + volts);
        (0.5 * self.capacitance_f * squares).abs()
    }
}

/// A braking resistor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Brake {
    /// Power that it gives off for ever, in W.
    pub power_w: f64,
    /// Energy that it takes in one go beyond that, in J.
    pub energy_j: f64,
}

/// How the machine follows a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Path {
    /// `Some(ExactStop)` overrides the program's G64; `Some(Blend)` is the mode
    /// at power-on; `None`: the controller's.
    pub mode: Option<PathMode>,
    /// Straight rapids, or each axis for itself.
    pub rapid: RapidPath,
    /// Over how long the drives spread a step of speed at a corner, s.
    pub response_time_s: f64,
    /// Largest F of a cutting move, mm/s; infinite where none is known.
    pub max_feed_mm_s: f64,
    /// Machine coordinates from which on, in positive direction, nothing stands in the way
    /// of the axes, mm or degrees; `None` for axes without such a place.
    pub clearance_mm: [Option<f64>; AXES],
    /// Accelerations along the path when a program begins, mm/s²: of moves that extrude, of
    /// others, and of the extruder alone (M204 P, T and R); infinite without one.
    pub accel_mm_s2: [f64; 3],
}

impl Machine {
    /// The largest path speed of a feed along a straight way, mm/s: the control's own largest,
    /// and such that no axis is faster than its own (Fanuc's parameters 1422 and 1430). On a
    /// way that only turns it is in degrees/s.
    #[must_use]
    pub fn max_feed_mm_s(&self, start: &AxisValues, end: &AxisValues, length_mm: f64) -> f64 {
        let mut most = self.path.max_feed_mm_s;
        for axis in self.axis_set.iter() {
            let own = self.axes[axis].map_or(f64::INFINITY, |data| data.max_feed_mm_s);
            let way = (end[axis] - start[axis]).abs();
            if own < f64::INFINITY && way > 0.0 {
                most = most.min(own * length_mm / way);
            }
        }
        most
    }
}

impl Path {
    /// Whether the axes of a move stay beyond the clearance wherever each of them is between
    /// `start` and `end`; false without one.
    #[must_use]
    pub fn is_clear(&self, moving: AxisSet, start: &AxisValues, end: &AxisValues) -> bool {
        let mut clear = false;
        for (axis, clearance_mm) in self.clearance_mm.iter().enumerate() {
            let Some(clearance_mm) = clearance_mm else {
                continue;
            };
            // A place that is not known is not clear.
            if ![start[axis], end[axis]].iter().all(|at| at >= clearance_mm) {
                return false;
            }
            clear = true;
        }
        clear && !moving.is_empty()
    }
}

/// The spindle's data, SI.
#[derive(Debug, Clone, PartialEq)]
pub struct Spindle {
    /// Inertia at the spindle in kg·m².
    pub inertia_kg_m2: f64,
    /// Friction torque in N·m.
    pub friction_nm: f64,
    /// Largest speed in 1/min.
    pub max_rpm: f64,
    /// Speed up to which the torque is constant, in 1/min; 0: not given.
    pub base_rpm: f64,
    /// Time to `max_rpm` in s; `None` where the torque curve gives it.
    pub accel_time_s: Option<f64>,
    /// The largest torque over speed, ascending from rest, straight between the
    /// points; empty where `accel_time_s` gives it.
    pub torque_curve: Vec<TorquePoint>,
    /// Time to full acceleration in s.
    pub jerk_time_s: f64,
    /// Mechanical by electrical power; (0, 1].
    pub efficiency: f64,
    /// What its drive draws as long as it is switched on, in W.
    pub base_load_w: f64,
    /// Largest electrical power that its drive draws, in W; `None`: no limit.
    pub peak_power_w: Option<f64>,
    /// Largest electrical power that its drive feeds back; `None`: no limit.
    pub regen_power_w: Option<f64>,
    /// What waits for the speed.
    pub wait: SpindleWait,
    /// Index of its converter.
    pub converter: usize,
    /// What cutting takes at the spindle with a tool that `Machine::tools` does
    /// not have, W.
    pub cutting_power_w: f64,
}

/// What cutting with a tool takes at the spindle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cutting {
    /// This power in W, at any feed.
    Power(f64),
    /// This force in N at the speed of the feed: specific cutting force times
    /// width and depth of cut, `P = kc·ae·ap·vf`.
    Force(f64),
}

/// A tool, as far as it draws power.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CuttingTool {
    /// Its T number.
    pub number: f64,
    /// What cutting with it takes.
    pub cutting: Cutting,
}

/// A point of a spindle's torque curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TorquePoint {
    /// Speed in 1/min.
    pub rpm: f64,
    /// Largest torque there in N·m.
    pub torque_nm: f64,
}

/// A part of an axis that moves with it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MassPart {
    /// What it is.
    pub name: &'static str,
    /// What it adds to the mass in kg; of a rotary axis to the inertia in kg·m².
    pub mass_kg: f64,
    /// Where it turns: the inertia of one about its own shaft in kg·m².
    pub inertia_kg_m2: Option<f64>,
    /// How many of them there are.
    pub count: f64,
}

/// Which motors move which axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Kinematics {
    /// Each axis has its own.
    #[default]
    Cartesian,
    /// Two motors move X and Y together.
    CoreXy,
    /// Two motors move X and Z together.
    CoreXz,
}

impl Kinematics {
    /// Whether motors move two axes together, so that one may drive while the other brakes: the
    /// robust bound of the axes alone covers what they draw.
    #[must_use]
    pub fn shares_motors(self) -> bool {
        self != Self::Cartesian
    }
}

/// A point of an axis' force curve, load side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ForcePoint {
    /// Speed in mm/s, or degrees/s.
    pub speed_mm_s: f64,
    /// Largest force there in N, or torque in N·m.
    pub force_n: f64,
}

/// A load that program words switch.
#[derive(Debug, Clone, PartialEq)]
pub struct Load {
    /// Words that switch it on: letter and number.
    pub on: Vec<(u8, f64)>,
    /// Words that switch it off.
    pub off: Vec<(u8, f64)>,
    /// What it draws in W.
    pub power_w: f64,
    /// Index of its converter.
    pub converter: usize,
}

/// Limits that hold when exactly these axes start together.
#[derive(Debug, Clone, PartialEq)]
pub struct Preset {
    /// The combination.
    pub axes: AxisSet,
    /// Largest axis speeds in mm/s (infinite where not given).
    pub speed_mm_s: AxisValues,
    /// Largest axis accelerations in mm/s² (infinite where not given).
    pub accel_mm_s2: AxisValues,
    /// Whether any speed, and any acceleration, is given.
    pub has_speed: bool,
    /// See `has_speed`.
    pub has_accel: bool,
}

/// Overrides as factors; 1 = 100 %.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OverrideAt {
    /// Of feeds.
    pub feed: f64,
    /// Of rapids.
    pub rapid: f64,
    /// Of the spindle.
    pub spindle: f64,
}

/// Margin, overrides and floors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Share of the peak power that is kept free; [0, 1).
    pub margin: f64,
    /// Largest feed override as a factor; 1 = 100 %.
    pub feed_override_max: f64,
    /// Largest rapid override as a factor; (0, 1].
    pub rapid_override_max: f64,
    /// Largest spindle override as a factor.
    pub spindle_override_max: f64,
    /// The overrides stand at these values: lower ones do not count, and times are
    /// taken there as well. No machine file says so; a run may ask for it.
    pub override_at: Option<OverrideAt>,
    /// With that: feeds and rapids stand anywhere between these shares of it and it itself.
    pub override_from: Option<[f64; 2]>,
    /// No cutting feed is lowered below this, mm/s; 0: no floor.
    pub min_feed_mm_s: f64,
    /// Nor below this share of min(F, axis-limited speed); 0: no floor.
    pub min_feed_ratio: f64,
}
