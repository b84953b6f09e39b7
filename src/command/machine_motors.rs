//! `gwatt machine motors`.

use anyhow::Result;
use gwatt::machine::{Motor, motors};

use super::output::print;

/// Lists the motors with their figures and documents.
pub fn run() -> Result<()> {
    print(|out| {
        for series in motors() {
            writeln!(out, "{}", series.description)?;
            writeln!(
                out,
                "  {:<14}{:>14}{:>10}{:>10}{:>10}{:>10}",
                "", "rotor kg m2", "N m", "peak N m", "rated rpm", "max rpm"
            )?;
            for motor in &series.motors {
                writeln!(out, "  {}", row(motor).trim_end())?;
            }
            writeln!(out, "  from: {}\n        {}\n", series.document, series.url)?;
        }
        writeln!(
            out,
            "For `gwatt machine new`: --motor NAME, or motor=NAME of an --axis. The torque of \
             steppers is that\nat standstill. Rotors are without coupling and brake."
        )
    })
}

fn row(motor: &Motor) -> String {
    let optional = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |it| it.to_string());
    format!(
        "{:<14}{:>14}{:>10}{:>10}{:>10}{:>10}",
        motor.name,
        motor.rotor_kg_m2,
        motor.continuous_nm,
        optional(motor.peak_nm),
        optional(motor.rated_rpm),
        optional(motor.max_rpm)
    )
}
