//! The columns of a schedule of several drives.

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Quantity {
    Time,
    Drive,
    Position,
    Speed,
    Accel,
    Jerk,
    Power,
    Period,
}

/// Which rows a column is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Of {
    Linear,
    Rotary,
    Spindle,
    /// Rows for all drives.
    All,
}

/// A column.
#[derive(Debug)]
pub(super) struct Column {
    pub(super) name: &'static str,
    pub(super) quantity: Quantity,
    pub(super) of: &'static [Of],
}

const EVERY: &[Of] = &[Of::Linear, Of::Rotary, Of::Spindle, Of::All];
const LINEAR: &[Of] = &[Of::Linear];
const ROTARY: &[Of] = &[Of::Rotary];
const SPINDLE: &[Of] = &[Of::Spindle];

/// All of them.
pub(super) static COLUMNS: [Column; 15] = [
    column("time_s", Quantity::Time, EVERY),
    column("drive", Quantity::Drive, EVERY),
    column("position_mm", Quantity::Position, LINEAR),
    column("position_deg", Quantity::Position, ROTARY),
    column("speed_mm_min", Quantity::Speed, LINEAR),
    column("speed_deg_min", Quantity::Speed, ROTARY),
    column("speed_rpm", Quantity::Speed, SPINDLE),
    column("accel_mm_s2", Quantity::Accel, LINEAR),
    column("accel_deg_s2", Quantity::Accel, ROTARY),
    column("accel_rpm_s", Quantity::Accel, SPINDLE),
    column("jerk_mm_s3", Quantity::Jerk, LINEAR),
    column("jerk_deg_s3", Quantity::Jerk, ROTARY),
    column("jerk_rpm_s2", Quantity::Jerk, SPINDLE),
    column("power_w", Quantity::Power, EVERY),
    column("period_ms", Quantity::Period, &[Of::All]),
];

const fn column(name: &'static str, quantity: Quantity, of: &'static [Of]) -> Column {
    Column { name, quantity, of }
}

impl Column {
    pub(super) fn named(name: &str) -> Option<&'static Self> {
        let same = |column: &&Self| column.name.eq_ignore_ascii_case(name);
        COLUMNS.iter().find(same)
    }
}
