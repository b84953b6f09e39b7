//! Fields that are read, but that no check uses yet.

use super::machine_file::{AxisTable, MachineFile};
use super::value::Num;

/// Names of such fields that the file gives, such as `axes.X.force_curve`.
pub(crate) fn list(file: &MachineFile) -> Vec<String> {
    let mut names = Vec::new();
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

/// A jerk of 0 says that there is no limit: nothing is left to check.
fn has_jerk(table: &AxisTable) -> bool {
    let positive = |jerk: Option<&Num<_>>| jerk.is_some_and(|jerk| jerk.value > 0.0);
    positive(table.jerk_mm_s3.as_ref()) || positive(table.jerk_deg_s3.as_ref())
}
