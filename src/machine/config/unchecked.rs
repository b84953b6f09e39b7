//! Fields that are read, but that no check uses yet.

use super::machine_file::{AxisTable, ConverterTable, MachineFile};
use super::value::Num;

/// Names of such fields that the file gives, such as `converter.overload`.
pub(crate) fn list(file: &MachineFile) -> Vec<String> {
    let mut names = Vec::new();
    for table in file.converter.iter().flat_map(|tables| &tables.0) {
        converter(&table.value, &mut names);
    }
    for (axis, table) in file.axes.iter().flat_map(|axes| axes.value.iter()) {
        if has_jerk(&table.value) {
            let unit = if table.value.jerk_deg_s3.is_some() {
                "deg"
            } else {
                "mm"
            };
            names.push(format!("axes.{}.jerk_{unit}_s3", axis.letter() as char));
        }
        let curves = [
            ("force_curve", table.value.force_curve.is_some()),
            ("torque_curve", table.value.torque_curve.is_some()),
        ];
        for (key, _) in curves.into_iter().filter(|(_, given)| *given) {
            names.push(format!("axes.{}.{key}", axis.letter() as char));
        }
    }
    names
}

fn converter(table: &ConverterTable, names: &mut Vec<String>) {
    let given = [
        ("continuous_power_w", table.continuous_power_w.is_some()),
        ("window_s", table.window_s.is_some()),
        ("overload", table.overload.is_some()),
        ("capacitance_f", table.capacitance_f.is_some()),
        ("bus_nominal_v", table.bus_nominal_v.is_some()),
        ("bus_min_v", table.bus_min_v.is_some()),
        ("bus_max_v", table.bus_max_v.is_some()),
        ("brake_power_w", table.brake_power_w.is_some()),
        ("brake_energy_j", table.brake_energy_j.is_some()),
    ];
    for (key, _) in given.into_iter().filter(|(_, given)| *given) {
        let name = format!("converter.{key}");
        if !names.contains(&name) {
            names.push(name);
        }
    }
}

/// A jerk of 0 says that there is no limit: nothing is left to check.
fn has_jerk(table: &AxisTable) -> bool {
    let positive = |jerk: Option<&Num<_>>| jerk.is_some_and(|jerk| jerk.value > 0.0);
    positive(table.jerk_mm_s3.as_ref()) || positive(table.jerk_deg_s3.as_ref())
}
