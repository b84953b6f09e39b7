//! `accel_mm_s2` under `[path]`: what M204 sets, as it is when a program begins.

use super::findings::Findings;
use super::machine_file::PathTable;
use super::value::Positive;
use crate::controller::Controller;
use crate::knob::KnobArgument;

/// Accelerations along the path of moves that extrude, of others, and of the extruder alone,
/// mm/s²; infinite where none is given.
pub(crate) fn take(
    findings: &mut Findings<'_>,
    table: &PathTable,
    controller: &Controller,
) -> [f64; 3] {
    let none = [f64::INFINITY; 3];
    let Some(given) = &table.accel_mm_s2 else {
        return none;
    };
    // A program that sets another one has to be followed.
    let knobs = &controller.knobs;
    let letters = knobs.iter().find_map(|knob| match &knob.argument {
        KnobArgument::Path(letters) if knob.code == Some((b'M', 2040)) => Some(letters),
        _ => None,
    });
    let Some(letters) = letters else {
        let message = format!(
            "accelerations along the path belong to printers with M204, not to `{}`",
            controller.name
        );
        let help = Some("give those of the axes".to_owned());
        findings.error("machine-kind", &given.span, message, help);
        return none;
    };
    let value = |number: Option<&Positive>| number.map_or(f64::INFINITY, |number| number.value);
    let found = [
        given.value.print.as_ref(),
        given.value.travel.as_ref(),
        given.value.retract.as_ref(),
    ]
    .map(value);
    if found[2].is_finite() && !letters.contains(&b'R') {
        let message = format!(
            "M204 of `{}` has no R: `retract` acts on nothing",
            controller.name
        );
        findings.error("machine-kind", &given.span, message, None);
    }
    found
}
