//! Axes: their names, and what gwatt knows of each.

use super::servo::Servo;
use schemars::JsonSchema;
use serde::Deserialize;

/// Number of axis letters that a program can move.
pub const AXES: usize = 10;

/// One value for each axis, indexed by `AxisId as usize`; mm or degrees.
pub type AxisValues = [f64; AXES];

/// An axis letter. `E` is the extruder of a printer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs, reason = "the letters say it")]
pub enum AxisId {
    X,
    Y,
    Z,
    A,
    B,
    C,
    U,
    V,
    W,
    E,
}

/// All axis letters, in the order in which reports list them.
pub const ALL_AXES: [AxisId; AXES] = [
    AxisId::X,
    AxisId::Y,
    AxisId::Z,
    AxisId::A,
    AxisId::B,
    AxisId::C,
    AxisId::U,
    AxisId::V,
    AxisId::W,
    AxisId::E,
];

impl AxisId {
    /// The axis of an upper-case letter.
    #[must_use]
    pub fn from_letter(letter: u8) -> Option<Self> {
        ALL_AXES.into_iter().find(|axis| axis.letter() == letter)
    }

    /// The letter, in upper case.
    #[must_use]
    pub fn letter(self) -> u8 {
        b"XYZABCUVWE"[self as usize]
    }
}

/// A set of axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub struct AxisSet(pub u16);

impl AxisSet {
    /// True when the axis is in the set.
    #[must_use]
    pub fn contains(self, axis: usize) -> bool {
        self.0 & (1 << axis) != 0
    }

    /// Adds an axis.
    pub fn insert(&mut self, axis: usize) {
        self.0 |= 1 << axis;
    }

    /// True for the set without axes.
    #[must_use]
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Indices of the axes in the set, ascending.
    pub fn iter(self) -> impl Iterator<Item = usize> {
        let mut rest = self.0;
        std::iter::from_fn(move || {
            (rest != 0).then(|| {
                let axis = rest.trailing_zeros() as usize;
                rest &= rest - 1;
                axis
            })
        })
    }
}

impl std::fmt::Display for AxisSet {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.iter()
            .try_for_each(|axis| write!(f, "{}", ALL_AXES[axis].letter() as char))
    }
}

/// Whether an axis slides or turns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum AxisKind {
    /// Positions in mm; mass in kg, forces in N.
    Linear,
    /// Positions in degrees; inertia in kg·m², torques in N·m.
    Rotary,
}

/// How many reference points an axis has after the first.
pub const FURTHER_REFERENCES: usize = 4;

/// One axis, load side, in the program's units of motion (mm or degrees) and
/// SI for mass and force. For rotary axes read: degrees for mm, kg·m² for kg,
/// N·m for N.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axis {
    /// Slides or turns.
    pub kind: AxisKind,
    /// Rapid speed in mm/s or degrees/s; caps feeds too.
    pub rapid_mm_s: f64,
    /// Largest speed of the axis in a feed, mm/s or degrees/s; infinite where none is known.
    pub max_feed_mm_s: f64,
    /// Speed on the way to the reference point (G28, homing) in mm/s or degrees/s; infinite
    /// where it is not given: that of rapids.
    pub reference_mm_s: f64,
    /// Machine coordinate of the reference point; `None` where it is not given.
    pub reference_mm: Option<f64>,
    /// The same of further points: those of G30 from the second on, or the fixed points of
    /// SINUMERIK's G75 from the first on.
    pub further_reference_mm: [Option<f64>; FURTHER_REFERENCES],
    /// Acceleration limit in mm/s² or degrees/s².
    pub accel_mm_s2: f64,
    /// Jerk limit in mm/s³ or degrees/s³; 0: none.
    pub jerk_mm_s3: f64,
    /// Mass in kg, or inertia in kg·m².
    pub mass_kg: f64,
    /// Coulomb friction in N or N·m, not negative.
    pub coulomb_n: f64,
    /// Viscous friction in N·s/m or N·m·s/rad, not negative.
    pub viscous_n_s_m: f64,
    /// Force needed to move in + direction, besides friction; either sign.
    pub gravity_n: f64,
    /// Motoring power is divided by it, regenerated power multiplied; (0, 1].
    pub efficiency: f64,
    /// Copper loss: watts per N² (or per (N·m)²).
    pub copper_w_n2: f64,
    /// How far real acceleration exceeds the command when driving; ≥ 1.
    pub servo_factor_motor: f64,
    /// The same when braking; ≥ 1.
    pub servo_factor_regen: f64,
    /// How the drive follows, where the file says so: both factors come from it.
    pub servo: Option<Servo>,
    /// Friction of the warm machine by that of the cold one, for
    /// regenerative peaks; (0, 1].
    pub friction_min_ratio: f64,
    /// By what share the mass may be more or less than it says; [0, 1).
    pub mass_error: f64,
    /// The same of friction.
    pub friction_error: f64,
    /// Metres in one mm, or radians in one degree: motion to SI.
    pub si_per_unit: f64,
}
