//! Machines of tests, from the text of their files.

use std::fmt::Write as _;

use gwatt::machine::Machine;

/// The machine of a file, which is valid.
#[track_caller]
pub(crate) fn machine_from(text: &str) -> Machine {
    match Machine::from_toml("test.toml", text) {
        Ok((machine, _)) => machine,
        Err(found) => panic!("{found:?}\n{text}"),
    }
}

/// The tables of linear axes that are alike: rapid in mm/min, acceleration in mm/s², mass in kg.
/// `more` are further lines of each.
pub(crate) fn linear_axes(letters: &str, [rapid, accel, mass]: [f64; 3], more: &str) -> String {
    let mut text = String::new();
    for letter in letters.chars() {
        let _ = write!(
            text,
            "[axes.{letter}]\nkind = \"linear\"\nrapid_mm_min = {rapid:?}\naccel_mm_s2 = {accel:?}\n\
             mass_kg = {mass:?}\n{more}\n"
        );
    }
    text
}

/// The tables of rotary axes that are alike: rapid in °/min, acceleration in °/s², inertia in
/// kg·m².
pub(crate) fn rotary_axes(letters: &str, [rapid, accel, inertia]: [f64; 3]) -> String {
    let mut text = String::new();
    for letter in letters.chars() {
        let _ = write!(
            text,
            "[axes.{letter}]\nkind = \"rotary\"\nrapid_deg_min = {rapid:?}\n\
             accel_deg_s2 = {accel:?}\ninertia_kg_m2 = {inertia:?}\n"
        );
    }
    text
}
