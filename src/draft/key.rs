//! What can be said of an axis.

/// A figure of an axis: how it is given, what it is, and the least that it may be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Key {
    /// As it is given.
    pub name: &'static str,
    /// What it is, for people.
    pub what: &'static str,
    /// Whether it may be 0.
    pub may_be_zero: bool,
}

const fn key(name: &'static str, what: &'static str, may_be_zero: bool) -> Key {
    Key {
        name,
        what,
        may_be_zero,
    }
}

/// All figures of an axis, but for what drives it.
pub const KEYS: [Key; 11] = [
    key("rapid_mm_min", "rapid speed in mm/min", false),
    key("accel_mm_s2", "acceleration in mm/s2", false),
    key(
        "table_kg",
        "mass of what slides, in kg: table, slide, head",
        false,
    ),
    key(
        "workpiece_kg",
        "mass of the heaviest workpiece or tool on it, in kg",
        true,
    ),
    key(
        "rotor_kg_m2",
        "rotor inertia in kg m2, coupling and brake included",
        true,
    ),
    key(
        "gear_ratio",
        "motor revolutions per revolution of the screw or wheel",
        false,
    ),
    key(
        "guide_friction",
        "coefficient of friction of its guides",
        true,
    ),
    key("coulomb_n", "friction in N", true),
    key("counterweight_kg", "what balances its weight, in kg", true),
    key(
        "efficiency",
        "mechanical by electrical power, above 0 to 1",
        false,
    ),
    key("jerk_mm_s3", "jerk in mm/s3", true),
];
