//! Names of columns as programs write them: `Position [mm]`, `Speed (1/min)`,
//! `Torque in Nm`.

/// Units as they are written, and their suffixes.
const UNITS: &[(&str, &str)] = &[
    ("mm/s²", "mm_s2"),
    ("mm/s^2", "mm_s2"),
    ("mm/s2", "mm_s2"),
    ("m/s²", "m_s2"),
    ("m/s^2", "m_s2"),
    ("m/s2", "m_s2"),
    ("rad/s²", "rad_s2"),
    ("rad/s^2", "rad_s2"),
    ("rad/s2", "rad_s2"),
    ("°/s²", "deg_s2"),
    ("deg/s²", "deg_s2"),
    ("deg/s^2", "deg_s2"),
    ("deg/s2", "deg_s2"),
    ("mm/s", "mm_s"),
    ("mm/min", "mm_min"),
    ("m/min", "m_min"),
    ("m/s", "m_s"),
    ("rad/s", "rad_s"),
    ("deg/s", "deg_s"),
    ("°/s", "deg_s"),
    ("1/min", "rpm"),
    ("r/min", "rpm"),
    ("rev/min", "rpm"),
    ("u/min", "rpm"),
    ("min-1", "rpm"),
    ("min^-1", "rpm"),
    ("n·m", "nm"),
    ("n.m", "nm"),
    ("n*m", "nm"),
    ("µm", "um"),
    ("μm", "um"),
    ("µs", "us"),
    ("μs", "us"),
    ("°", "deg"),
];

/// The suffix of a unit, by which names end: `m_s2` for `m/s²`. What is not known stays.
#[must_use]
pub fn suffix_of(unit: &str) -> String {
    let unit = unit.trim().to_lowercase();
    let known = UNITS.iter().find(|(written, _)| *written == unit);
    known.map_or(unit, |(_, suffix)| (*suffix).to_owned())
}

/// A name with its unit as a suffix: `position_mm` for `Position [mm]`.
#[must_use]
pub fn plain(name: &str) -> String {
    let name = name.trim();
    let split = [('[', ']'), ('(', ')')]
        .into_iter()
        .find_map(|(open, close)| {
            let (front, unit) = name.strip_suffix(close)?.rsplit_once(open)?;
            Some((front, unit))
        });
    let split = split.or_else(|| name.rsplit_once(" in "));
    let lower = |text: &str| text.trim().to_lowercase().replace([' ', '-', '.'], "_");
    match split {
        Some((front, unit)) => format!("{}_{}", lower(front), suffix_of(unit)),
        None => lower(name),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_in_brackets_is_a_suffix() {
        for (written, name) in [
            ("Position [mm]", "position_mm"),
            (" Speed (1/min) ", "speed_rpm"),
            ("X Position [µm]", "x_position_um"),
            ("Torque in Nm", "torque_nm"),
            ("accel [m/s²]", "accel_m_s2"),
            ("velocity_mm_s", "velocity_mm_s"),
            ("Torque [%]", "torque_%"),
        ] {
            assert_eq!(plain(written), name);
        }
    }
}
