//! Names of columns: what was recorded, in which unit.

use std::f64::consts::PI;

use super::header_name::plain;

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quantity {
    /// Time, s.
    Time,
    /// Force of the drive, N, or torque, N·m.
    Force,
    /// Force or torque that was added to excite a closed loop.
    Excitation,
    /// Position command.
    Command,
    /// Position of the load (or of the motor's encoder).
    Position,
    /// Its speed.
    Velocity,
    /// Its acceleration.
    Acceleration,
    /// Electrical power of the drive, W.
    Power,
}

/// Whether a column is about sliding or turning.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// m, N.
    Linear,
    /// rad, N·m.
    Rotary,
    /// Neither: time and power.
    Neither,
}

/// A column's meaning: quantity, kind, and the factor that makes SI of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Meaning {
    /// What it holds.
    pub quantity: Quantity,
    /// Sliding or turning.
    pub kind: Kind,
    /// Factor to SI.
    pub to_si: f64,
}

const DEG: f64 = PI / 180.0;
/// Units by quantity: suffix, kind, factor.
type Units = &'static [(&'static str, Kind, f64)];

const TIME: Units = &[
    ("s", Kind::Neither, 1.0),
    ("ms", Kind::Neither, 1e-3),
    ("us", Kind::Neither, 1e-6),
];
const FORCE: Units = &[
    ("n", Kind::Linear, 1.0),
    ("kn", Kind::Linear, 1e3),
    ("nm", Kind::Rotary, 1.0),
    ("mnm", Kind::Rotary, 1e-3),
];
const POSITION: Units = &[
    ("m", Kind::Linear, 1.0),
    ("mm", Kind::Linear, 1e-3),
    ("um", Kind::Linear, 1e-6),
    ("rad", Kind::Rotary, 1.0),
    ("deg", Kind::Rotary, DEG),
    ("rev", Kind::Rotary, 2.0 * PI),
];
const VELOCITY: Units = &[
    ("m_s", Kind::Linear, 1.0),
    ("mm_s", Kind::Linear, 1e-3),
    ("mm_min", Kind::Linear, 1e-3 / 60.0),
    ("m_min", Kind::Linear, 1.0 / 60.0),
    ("rad_s", Kind::Rotary, 1.0),
    ("deg_s", Kind::Rotary, DEG),
    ("rpm", Kind::Rotary, 2.0 * PI / 60.0),
];
const ACCELERATION: Units = &[
    ("m_s2", Kind::Linear, 1.0),
    ("mm_s2", Kind::Linear, 1e-3),
    ("g", Kind::Linear, 9.806_65),
    ("rad_s2", Kind::Rotary, 1.0),
    ("deg_s2", Kind::Rotary, DEG),
];
const POWER: Units = &[("w", Kind::Neither, 1.0), ("kw", Kind::Neither, 1e3)];

/// Words by quantity, the longest first where one begins another.
const WORDS: &[(&str, Quantity, Units)] = &[
    ("position_command", Quantity::Command, POSITION),
    ("command_position", Quantity::Command, POSITION),
    ("load_position", Quantity::Position, POSITION),
    ("load_velocity", Quantity::Velocity, VELOCITY),
    ("load_acceleration", Quantity::Acceleration, ACCELERATION),
    ("load_accel", Quantity::Acceleration, ACCELERATION),
    ("acceleration", Quantity::Acceleration, ACCELERATION),
    ("accel", Quantity::Acceleration, ACCELERATION),
    ("velocity", Quantity::Velocity, VELOCITY),
    ("speed", Quantity::Velocity, VELOCITY),
    ("position", Quantity::Position, POSITION),
    ("command", Quantity::Command, POSITION),
    ("reference", Quantity::Command, POSITION),
    ("excitation", Quantity::Excitation, FORCE),
    ("torque", Quantity::Force, FORCE),
    ("force", Quantity::Force, FORCE),
    ("power", Quantity::Power, POWER),
    ("time", Quantity::Time, TIME),
    ("t", Quantity::Time, TIME),
];

/// How a name was understood.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Reading {
    /// A quantity with its unit.
    Known(Meaning),
    /// A quantity, but no unit or one that it does not have.
    UnitInDoubt(Quantity),
    /// Something else.
    Other,
}

/// Reads a name such as `position_mm`, `torque_nm` or `x_velocity_mm_s`; an axis
/// letter may stand in front.
#[must_use]
pub fn read(name: &str) -> Reading {
    let name = plain(name);
    let bare = match name.split_once('_') {
        Some((letter, rest)) if letter.len() == 1 && letter != "t" => rest,
        _ => name.as_str(),
    };
    for (word, quantity, units) in WORDS {
        if bare == *word {
            return Reading::UnitInDoubt(*quantity);
        }
        let Some(unit) = bare
            .strip_prefix(word)
            .and_then(|rest| rest.strip_prefix('_'))
        else {
            continue;
        };
        if let Some((_, kind, to_si)) = units.iter().find(|(suffix, _, _)| *suffix == unit) {
            return Reading::Known(Meaning {
                quantity: *quantity,
                kind: *kind,
                to_si: *to_si,
            });
        }
        // `position_command_mm` is no position in units of command_mm.
        if WORDS.iter().all(|(other, _, _)| !unit.starts_with(other)) {
            return Reading::UnitInDoubt(*quantity);
        }
    }
    Reading::Other
}

/// The quantity of a word such as `torque`, without a unit.
#[must_use]
pub fn quantity_of(word: &str) -> Option<Quantity> {
    let word = word.to_ascii_lowercase();
    let found = WORDS.iter().find(|(known, _, _)| *known == word);
    found.map(|(_, quantity, _)| *quantity)
}

/// Kind and factor to SI of a unit, by its suffix.
#[must_use]
pub fn unit_of(quantity: Quantity, suffix: &str) -> Option<(Kind, f64)> {
    let (_, _, units) = WORDS.iter().find(|(_, known, _)| *known == quantity)?;
    let found = units.iter().find(|(known, _, _)| *known == suffix);
    found.map(|(_, kind, to_si)| (*kind, *to_si))
}

/// The axis letter in front of a name, upper case.
#[must_use]
pub fn axis_of(name: &str) -> Option<char> {
    let name = plain(name);
    let (letter, _) = name.split_once('_')?;
    let mut chars = letter.chars();
    let first = chars.next()?.to_ascii_uppercase();
    (chars.next().is_none() && "XYZABCUVWE".contains(first)).then_some(first)
}

/// The units that a quantity may have, for messages.
#[must_use]
pub fn units_of(quantity: Quantity) -> String {
    let units = WORDS.iter().find(|(_, q, _)| *q == quantity);
    let suffixes: Vec<&str> = units
        .map(|(_, _, units)| units.iter().map(|(suffix, _, _)| *suffix).collect())
        .unwrap_or_default();
    suffixes.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_tell_quantity_and_unit() {
        let known = |name: &str| match read(name) {
            Reading::Known(meaning) => Some((meaning.quantity, meaning.to_si)),
            _ => None,
        };
        assert_eq!(known("time_s"), Some((Quantity::Time, 1.0)));
        assert_eq!(known("Position_MM"), Some((Quantity::Position, 1e-3)));
        assert_eq!(known("x_velocity_mm_s"), Some((Quantity::Velocity, 1e-3)));
        assert_eq!(known("excitation_nm"), Some((Quantity::Excitation, 1.0)));
        assert_eq!(
            known("position_command_mm"),
            Some((Quantity::Command, 1e-3))
        );
        assert_eq!(read("torque"), Reading::UnitInDoubt(Quantity::Force));
        assert_eq!(
            read("position_inch"),
            Reading::UnitInDoubt(Quantity::Position)
        );
        assert_eq!(read("temperature_c"), Reading::Other);
        assert_eq!(axis_of("x_velocity_mm_s"), Some('X'));
        assert_eq!(axis_of("velocity_mm_s"), None);
    }
}
