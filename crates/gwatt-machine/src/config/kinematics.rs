//! `kinematics`: whether each axis has a motor of its own.

use super::findings::Findings;
use super::machine_file::{KinematicsName, MachineFile};
use crate::axis::{AXES, Axis, AxisId};
use crate::model::{Converter, ForcePoint, Kinematics};

/// Relative difference of figures that are the same in other units.
const ROUNDING: f64 = 1e-9;

/// The kinematics of a file. Two axes that two motors move together have to be alike: only then
/// the robust bound of the axes covers what the motors draw.
pub(crate) fn take(
    findings: &mut Findings<'_>,
    file: &MachineFile,
    axes: &[Option<Axis>; AXES],
    force_curves: &[(AxisId, Vec<ForcePoint>)],
    converters: &[Converter],
) -> Kinematics {
    let Some(given) = &file.kinematics else {
        return Kinematics::Cartesian;
    };
    let (kinematics, pair) = match given.value {
        KinematicsName::Cartesian => return Kinematics::Cartesian,
        KinematicsName::Corexy => (Kinematics::CoreXy, [AxisId::X, AxisId::Y]),
        KinematicsName::Corexz => (Kinematics::CoreXz, [AxisId::X, AxisId::Z]),
    };
    let letters = pair.map(|id| char::from(id.letter()));
    let [Some(first), Some(second)] = pair.map(|id| axes[id as usize].as_ref()) else {
        // What a table lacks is reported there.
        let is_described = |id: &AxisId| {
            let mut tables = file.axes.iter().flat_map(|axes| axes.value.iter());
            tables.any(|(other, _)| other == *id)
        };
        if pair.iter().all(is_described) {
            return kinematics;
        }
        let message = format!(
            "the axes {} and {} share their motors",
            letters[0], letters[1]
        );
        let help = Some("describe both of them".to_owned());
        findings.error("machine-kinematics", &given.span, message, help);
        return kinematics;
    };
    let curve = |id: AxisId| force_curves.iter().find(|(axis, _)| *axis == id);
    let curves = pair.map(|id| curve(id).map(|(_, points)| points));
    let differs =
        differs(first, second).or((curves[0] != curves[1]).then_some("torque or force curve"));
    if let Some(what) = differs {
        let message = format!(
            "{} and {} share their motors, but their {what} differs",
            letters[0], letters[1]
        );
        let help = "give both the larger figure, and each the rotors of both motors: what the \
                    motors draw is then covered by what the axes draw at most";
        findings.error(
            "machine-kinematics",
            &given.span,
            message,
            Some(help.to_owned()),
        );
    }
    let feeds_back = converters.iter().find(|converter| {
        converter.regen_power_w.is_some()
            && pair.iter().any(|id| converter.axes.contains(*id as usize))
    });
    if feeds_back.is_some() {
        let message = "what motors feed back that move two axes together is not known: \
                       `regen_power_w` cannot be checked";
        let help = Some("leave `regen_power_w` out".to_owned());
        findings.error("machine-kinematics", &given.span, message, help);
    }
    kinematics
}

/// A figure of an axis, with its name.
type Named = (&'static str, fn(&Axis) -> f64);

/// What differs between two axes that share their motors.
fn differs(first: &Axis, second: &Axis) -> Option<&'static str> {
    let figures: [Named; 13] = [
        ("rapid speed", |axis| axis.rapid_mm_s),
        ("acceleration", |axis| axis.accel_mm_s2),
        ("jerk", |axis| axis.jerk_mm_s3),
        ("mass", |axis| axis.mass_kg),
        ("friction", |axis| axis.coulomb_n),
        ("viscous friction", |axis| axis.viscous_n_s_m),
        ("weight", |axis| axis.gravity_n),
        ("efficiency", |axis| axis.efficiency),
        ("copper loss", |axis| axis.copper_w_n2),
        ("servo factor", |axis| axis.servo_factor_motor),
        ("mass error", |axis| axis.mass_error),
        ("friction error", |axis| axis.friction_error),
        ("kind", |axis| axis.si_per_unit),
    ];
    figures
        .into_iter()
        .find(|(_, figure)| {
            let [first, second] = [figure(first), figure(second)];
            (first - second).abs() > ROUNDING * first.abs().max(second.abs())
        })
        .map(|(name, _)| name)
}
