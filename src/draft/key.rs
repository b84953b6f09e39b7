//! What can be said of an axis.

/// How an axis moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// It slides: X, Y, Z, U, V, W.
    Slide,
    /// It turns: A, B, C.
    Turn,
    /// It pushes filament: E of printers.
    Extruder,
}

/// A figure of an axis: how it is given, what it is, and the least that it may be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Key {
    /// As it is given.
    pub name: &'static str,
    /// What it is, for people.
    pub what: &'static str,
    /// Whether it may be 0.
    pub may_be_zero: bool,
    /// Axes that have it.
    pub forms: &'static [Form],
}

use Form::{Extruder, Slide, Turn};

const LENGTH: &[Form] = &[Slide, Extruder];
const ALL: &[Form] = &[Slide, Turn, Extruder];

const fn key(
    name: &'static str,
    what: &'static str,
    may_be_zero: bool,
    forms: &'static [Form],
) -> Key {
    Key {
        name,
        what,
        may_be_zero,
        forms,
    }
}

/// All figures of an axis, but for what drives it.
pub const KEYS: [Key; 17] = [
    key("rapid_mm_min", "rapid speed in mm/min", false, LENGTH),
    key(
        "rapid_deg_min",
        "rapid speed in degrees/min",
        false,
        &[Turn],
    ),
    key("accel_mm_s2", "acceleration in mm/s2", false, LENGTH),
    key("accel_deg_s2", "acceleration in degrees/s2", false, &[Turn]),
    key(
        "table_kg",
        "mass of what slides, in kg: table, slide, head",
        false,
        &[Slide],
    ),
    key(
        "workpiece_kg",
        "mass of the heaviest workpiece or tool on it, in kg",
        true,
        &[Slide],
    ),
    key(
        "table_kg_m2",
        "inertia of what turns, about its axis, in kg m2: table, chuck",
        false,
        &[Turn],
    ),
    key(
        "workpiece_kg_m2",
        "inertia of the heaviest workpiece on it, about the axis, in kg m2",
        true,
        &[Turn],
    ),
    key(
        "rotor_kg_m2",
        "rotor inertia in kg m2, coupling and brake included",
        true,
        ALL,
    ),
    key(
        "gear_ratio",
        "motor revolutions per revolution of the screw, wheel or table",
        false,
        ALL,
    ),
    key(
        "guide_friction",
        "coefficient of friction of its guides",
        true,
        &[Slide],
    ),
    key("coulomb_n", "friction in N", true, LENGTH),
    key("friction_nm", "friction at the axis, in N m", true, &[Turn]),
    key(
        "counterweight_kg",
        "what balances its weight, in kg",
        true,
        &[Slide],
    ),
    key(
        "efficiency",
        "mechanical by electrical power, above 0 to 1",
        false,
        ALL,
    ),
    key("jerk_mm_s3", "jerk in mm/s3", true, LENGTH),
    key("jerk_deg_s3", "jerk in degrees/s3", true, &[Turn]),
];

impl Form {
    /// The form of an axis with this letter; `None` for other letters.
    #[must_use]
    pub fn of(letter: char) -> Option<Self> {
        match letter {
            'X' | 'Y' | 'Z' | 'U' | 'V' | 'W' => Some(Slide),
            'A' | 'B' | 'C' => Some(Turn),
            'E' => Some(Extruder),
            _ => None,
        }
    }

    /// The figures without which nothing is known of it.
    #[must_use]
    pub fn needed(self) -> &'static [&'static str] {
        match self {
            Slide => &["rapid_mm_min", "accel_mm_s2", "table_kg"],
            Turn => &["rapid_deg_min", "accel_deg_s2", "table_kg_m2"],
            Extruder => &["rapid_mm_min", "accel_mm_s2"],
        }
    }
}
