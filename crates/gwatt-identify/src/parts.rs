//! Axes whose masses are sums of parts: what is identified is the sum.

use std::f64::consts::PI;

use toml_edit::{Item, TableLike, value};

/// Fields that an identified mass takes the place of.
const PARTS: [&str; 6] = [
    "moved_mass_kg",
    "moved_inertia_kg_m2",
    "rotor_kg_m2",
    "screw",
    "pulley",
    "pinion",
];
/// Fields that need the lead, which stays.
const AT_MOTOR: [&str; 6] = [
    "max_speed_rpm",
    "friction_nm",
    "viscous_nm_s_rad",
    "gravity_nm",
    "copper_w_nm2",
    "torque_curve",
];

/// Takes the parts out of the table of an axis; the travel of a revolution stays as `lead_mm`
/// where something at the motor needs it (`rotary`: the figures do).
pub(crate) fn take_out(table: &mut dyn TableLike, rotary: bool) {
    let Some(lead) = lead_mm(table) else {
        for key in PARTS {
            table.remove(key);
        }
        return;
    };
    for key in PARTS {
        table.remove(key);
    }
    let needed = rotary || AT_MOTOR.iter().any(|key| table.contains_key(key));
    if needed && !table.contains_key("lead_mm") {
        table.insert("lead_mm", value(lead));
    }
}

/// Travel of a revolution, where a part says it.
fn lead_mm(table: &dyn TableLike) -> Option<f64> {
    let field = |part: &str, key: &str| number(table.get(part)?.as_table_like()?.get(key)?);
    let around = |part: &str| {
        let by_teeth = || Some(field(part, "teeth")? * field(part, "pitch_mm")? / PI);
        let diameter = field(part, "diameter_mm").or_else(by_teeth)?;
        Some(PI * diameter)
    };
    field("screw", "lead_mm")
        .or_else(|| around("pulley"))
        .or_else(|| around("pinion"))
}

fn number(item: &Item) -> Option<f64> {
    let whole = || item.as_integer().map(|number| number as f64);
    item.as_float().or_else(whole)
}
