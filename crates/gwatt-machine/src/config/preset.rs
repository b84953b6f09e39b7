//! Presets: limits for combinations of axes.

use super::findings::Findings;
use super::machine_file::{MachineFile, PresetTable};
use super::value::{At, PerAxis, Positive};
use crate::axis::{AXES, Axis, AxisSet, AxisValues};
use crate::model::Preset;
use crate::units::SECONDS_PER_MINUTE;

/// Makes the presets of their tables.
pub(crate) fn presets(
    findings: &mut Findings<'_>,
    file: &MachineFile,
    axes: &[Option<Axis>; AXES],
    machine_axes: AxisSet,
) -> Vec<Preset> {
    let mut list: Vec<Preset> = Vec::new();
    for (index, table) in file.preset.iter().flatten().enumerate() {
        let Some(letters) = &table.value.axes else {
            continue;
        };
        let mut set = AxisSet::default();
        for letter in &letters.value {
            let axis = letter.value.axis();
            let name = axis.letter() as char;
            if !machine_axes.contains(axis as usize) {
                let message = format!("the machine has no axis {name}");
                findings.error("machine-preset", &letter.span, message, None);
            } else if set.contains(axis as usize) {
                let message = format!("axis {name} is named twice");
                findings.error("machine-preset", &letter.span, message, None);
            }
            set.insert(axis as usize);
        }
        if set.is_empty() {
            findings.error(
                "machine-preset",
                &letters.span,
                "a preset without axes",
                None,
            );
        } else if list.iter().any(|other| other.axes == set) {
            let message = format!("a second preset for the axes {set}");
            let help = Some("keep one of the two".to_owned());
            findings.error("machine-preset", &letters.span, message, help);
        }
        let preset = preset(findings, table, set, axes);
        if !set.is_empty()
            && !preset.has_speed
            && !preset.has_accel
            && !findings.refused_in(&format!("preset.{index}"))
        {
            let message = "a preset that limits nothing";
            let help = Some("give `speed_mm_min` or `accel_mm_s2`".to_owned());
            findings.error("machine-preset", &table.span, message, help);
        }
        list.push(preset);
    }
    list
}

fn preset(
    findings: &mut Findings<'_>,
    table: &At<PresetTable>,
    set: AxisSet,
    axes: &[Option<Axis>; AXES],
) -> Preset {
    let PresetTable {
        speed_mm_min,
        accel_mm_s2,
        ..
    } = &table.value;
    let speed_mm_s = values(findings, speed_mm_min.as_ref(), set, |axis| {
        axes[axis].map(|axis| axis.rapid_mm_s * SECONDS_PER_MINUTE)
    })
    .map(|speed| speed / SECONDS_PER_MINUTE);
    let accel = values(findings, accel_mm_s2.as_ref(), set, |axis| {
        axes[axis].map(|axis| axis.accel_mm_s2)
    });
    let has = |values: &AxisValues| values.iter().any(|value| value.is_finite());
    Preset {
        axes: set,
        has_speed: has(&speed_mm_s),
        has_accel: has(&accel),
        speed_mm_s,
        accel_mm_s2: accel,
    }
}

/// Values by axis, infinite where none is given; `limit` is the axis' own.
fn values(
    findings: &mut Findings<'_>,
    given: Option<&PerAxis<Positive>>,
    set: AxisSet,
    limit: impl Fn(usize) -> Option<f64>,
) -> AxisValues {
    let mut values = [f64::INFINITY; AXES];
    for (axis, number) in given.iter().flat_map(|given| given.iter()) {
        let name = axis.letter() as char;
        if set.is_empty() {
            // Reported already.
            continue;
        }
        if !set.contains(axis as usize) {
            let message = format!("axis {name} is not in this preset's `axes`");
            findings.error("machine-preset", &number.span, message, None);
        } else if let Some(limit) = limit(axis as usize)
            && number.value > limit * (1.0 + 1e-9)
        {
            let message = format!("above the limit of axis {name}, {limit:.0}: it has no effect");
            findings.warning("machine-preset", &number.span, message, None);
        }
        values[axis as usize] = number.value;
    }
    values
}
