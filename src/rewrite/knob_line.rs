//! Lines that turn a knob, such as `G131 = 70` or `M201 X500 Y500`.

use super::number::decimal;
use crate::machine::{ALL_AXES, Axis, AxisValues, KnobArgument, Machine};

/// The words that give a knob these values for the machine's axes; `None` when
/// its form cannot say it.
fn words(machine: &Machine, index: usize, values: &AxisValues) -> Option<String> {
    let knob = machine.controller.knobs.get(index)?;
    let mut axes = machine.axis_set.iter();
    let first = values[axes.next()?];
    let uniform = axes.all(|axis| values[axis] == first);
    match &knob.argument {
        KnobArgument::Assign if knob.is_named_for_all() => {
            // No blanks: NC I's words end at one.
            uniform.then(|| format!("{}={}", knob.name, decimal(first, false)))
        }
        KnobArgument::Assign if uniform => {
            Some(format!("{} = {}", knob.name, decimal(first, false)))
        }
        KnobArgument::Assign => {
            let other = machine.controller.knob_by_axis(index)?;
            words(machine, other, values)
        }
        KnobArgument::Axes => {
            let mut text = knob.name.clone();
            for axis in machine.axis_set.iter() {
                text.push(' ');
                text.push(ALL_AXES[axis].letter() as char);
                text.push_str(&decimal(values[axis], false));
            }
            Some(text)
        }
        KnobArgument::Index => {
            let written = machine.axis_set.iter().map(|axis| {
                let letter = ALL_AXES[axis].letter() as char;
                format!("{}[{letter}]={}", knob.name, decimal(values[axis], false))
            });
            Some(written.collect::<Vec<_>>().join(" "))
        }
        KnobArgument::Output(number) if uniform => Some(format!(
            "{} E{number} Q{}",
            knob.name,
            decimal(first, false)
        )),
        KnobArgument::Level => {
            let level = knob.levels.as_ref()?.list.get(first as usize)?;
            Some(level.text().to_owned())
        }
        KnobArgument::Dynamics | KnobArgument::Output(_) | KnobArgument::Path(_) => None,
        KnobArgument::Value => Some(format!("{}{}", knob.name, decimal(first, false))),
    }
}

/// The lines that do so: one, or more where it would act too early, or where the axes wait
/// until it acts.
pub(crate) fn lines(machine: &Machine, index: usize, values: &AxisValues) -> Option<Vec<String>> {
    let knob = machine.controller.knobs.get(index)?;
    if knob.argument == KnobArgument::Dynamics {
        return Some(dynamics(machine, &knob.name, values));
    }
    let words = words(machine, index, values)?;
    let lines = [knob.barrier.clone(), Some(words), knob.wait.clone()];
    Some(lines.into_iter().flatten().collect())
}

/// A line for each of NC I's path axes that has a limit of jerk, of which `percent` are taken:
/// with the machine's own accelerations, since the command gives all three.
fn dynamics(machine: &Machine, name: &str, percent: &AxisValues) -> Vec<String> {
    let path_axes = machine.axes.iter().zip(percent).take(3).enumerate();
    let line = |(number, (axis, percent)): (usize, (&Option<Axis>, &f64))| {
        let own = axis.as_ref().filter(|own| own.jerk_mm_s3 > 0.0)?;
        let accel = decimal(own.accel_mm_s2, false);
        let jerk = decimal(own.jerk_mm_s3 * percent / 100.0, false);
        Some(format!("{name}( {number}; {accel}; {accel}; {jerk} )#"))
    };
    path_axes.filter_map(line).collect()
}

/// The line that sets an analog output of `LinuxCNC` as soon as the axes stand.
pub(super) fn at_once(number: u16, value: f64) -> String {
    format!("M68 E{number} Q{}", decimal(value, false))
}
