//! What the mass of each axis is the sum of, as `machine check` shows it.

use std::fmt::Write as _;

use super::figure::round_to_digits;
use crate::machine::{AxisKind, Machine, MassPart};

/// One axis a line, of those whose drives are described by parts.
#[must_use]
pub fn mass_table(machine: &Machine) -> String {
    let mut text = String::new();
    for (id, parts) in &machine.mass_parts {
        let Some(Some(axis)) = machine.axes.get(*id as usize) else {
            continue;
        };
        let unit = match axis.kind {
            AxisKind::Linear => "kg",
            AxisKind::Rotary => "kg m2",
        };
        let shown: Vec<String> = parts.iter().map(one).collect();
        let (letter, sum) = (id.letter() as char, round_to_digits(axis.mass_kg, 4));
        let _ = writeln!(text, "  {letter}: {sum} {unit} = {}", shown.join(" + "));
    }
    text
}

fn one(part: &MassPart) -> String {
    let MassPart {
        name,
        mass_kg,
        inertia_kg_m2,
        count,
    } = part;
    let mass = round_to_digits(*mass_kg, 4);
    let times = if *count == 1.0 {
        String::new()
    } else {
        format!("{count} x ")
    };
    match inertia_kg_m2 {
        Some(inertia) => format!(
            "{mass} {name} ({times}{} kg m2)",
            round_to_digits(*inertia, 4)
        ),
        None => format!("{mass} {name}"),
    }
}
