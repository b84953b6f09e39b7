//! How the drives of axes follow, and the factors that come from it.

use std::ops::Range;

use super::findings::Findings;
use super::machine_file::{AxisTable, MachineFile};
use super::value::Num;
use crate::axis::{AXES, Axis, AxisId, AxisSet};
use crate::model::Converter;
use crate::servo::{Servo, servo_factor, servo_response_s};

const RULE: &str = "machine-servo";
/// The shortest and the longest time that a machine file may give, s.
const RESPONSE_S: [f64; 2] = [0.001, 1.0];

/// What the table of an axis says of its drive; nothing if it says nothing, or what
/// does not go together.
pub(crate) fn take(findings: &mut Findings<'_>, id: AxisId, table: &AxisTable) -> Option<Servo> {
    let letter = id.letter() as char;
    let (gain, hz) = (&table.position_gain_1_s, &table.velocity_bandwidth_hz);
    let needs = |findings: &mut Findings<'_>, span: &Range<usize>, given: &str, missing: &str| {
        if !findings.is_refused(&format!("axes.{letter}.{missing}")) {
            let message = format!("`{given}` needs `{missing}`");
            let help = format!("give both, or set servo_factor_motor and _regen of axis {letter}");
            findings.error("machine-missing", span, message, Some(help));
        }
    };
    let (gain, hz) = match (gain, hz) {
        (Some(gain), Some(hz)) => (gain, hz),
        (Some(gain), None) => {
            needs(
                findings,
                &gain.span,
                "position_gain_1_s",
                "velocity_bandwidth_hz",
            );
            return None;
        }
        (None, _) => {
            if let Some((span, key)) = without_gain(table) {
                needs(findings, &span, key, "position_gain_1_s");
            }
            return None;
        }
    };
    for (factor, key) in [
        (&table.servo_factor_motor, "servo_factor_motor"),
        (&table.servo_factor_regen, "servo_factor_regen"),
    ] {
        if let Some(factor) = factor {
            let message = format!("`{key}` and `position_gain_1_s` say the same twice");
            let help = "keep the factors, or the servo from which they would follow".to_owned();
            findings.error(RULE, &factor.span, message, Some(help));
        }
    }
    let or = |number: Option<f64>, default: f64| number.unwrap_or(default);
    Some(Servo {
        position_gain_1_s: gain.value,
        velocity_bandwidth_hz: hz.value,
        velocity_integral_time_s: or(
            table.velocity_integral_time_s.as_ref().map(|it| it.value),
            f64::INFINITY,
        ),
        velocity_feedforward: or(table.velocity_feedforward.as_ref().map(|it| it.value), 0.0),
        acceleration_feedforward: or(
            table.acceleration_feedforward.as_ref().map(|it| it.value),
            0.0,
        ),
    })
}

/// The first field that says nothing without the gain of the position loop.
fn without_gain(table: &AxisTable) -> Option<(Range<usize>, &'static str)> {
    fn given<B>(
        number: Option<&Num<B>>,
        key: &'static str,
    ) -> Option<(Range<usize>, &'static str)> {
        number.map(|it| (it.span.clone(), key))
    }
    given(
        table.velocity_bandwidth_hz.as_ref(),
        "velocity_bandwidth_hz",
    )
    .or_else(|| {
        given(
            table.velocity_integral_time_s.as_ref(),
            "velocity_integral_time_s",
        )
    })
    .or_else(|| given(table.velocity_feedforward.as_ref(), "velocity_feedforward"))
    .or_else(|| {
        given(
            table.acceleration_feedforward.as_ref(),
            "acceleration_feedforward",
        )
    })
}

/// Works out the servo factors of the axes that describe their servos: one for all
/// that share a converter, since it bears what they draw together.
pub(crate) fn factors(
    findings: &mut Findings<'_>,
    file: &MachineFile,
    axes: &mut [Option<Axis>; AXES],
    converters: &[Converter],
) {
    let mut swinging = AxisSet::default();
    for converter in converters {
        let mut servos: Vec<(Servo, f64)> = Vec::new();
        for index in converter.axes.iter() {
            let Some(axis) = axes.get(index).and_then(Option::as_ref) else {
                continue;
            };
            let Some(servo) = axis.servo else { continue };
            let own = (servo, axis.mass_error);
            if !servos.contains(&own) {
                if servo_factor(&[own]).is_none() {
                    swinging.insert(index);
                    continue;
                }
                servos.push(own);
            }
        }
        let factor = match servos.as_slice() {
            [] => continue,
            servos => servo_factor(servos),
        };
        let Some(factor) = factor else { continue };
        for index in converter.axes.iter() {
            if let Some(axis) = axes.get_mut(index).and_then(Option::as_mut)
                && axis.servo.is_some()
            {
                axis.servo_factor_motor = factor;
                axis.servo_factor_regen = factor;
            }
        }
    }
    for (id, table) in file.axes.iter().flat_map(|axes| axes.value.iter()) {
        if swinging.contains(id as usize)
            && let Some(gain) = &table.value.position_gain_1_s
        {
            let letter = id.letter() as char;
            let message = format!("the servo of axis {letter} oscillates and does not settle");
            let help = "give a lower gain, a larger bandwidth or a longer integral time";
            findings.error(RULE, &gain.span, message, Some(help.to_owned()));
        }
    }
}

/// The time over which drives spread a step of speed, s: that of the quickest servo that
/// is described, and `otherwise_s` for axes of which nothing is known.
pub(crate) fn response_s(axes: &[Option<Axis>; AXES], otherwise_s: f64) -> f64 {
    let [shortest, longest] = RESPONSE_S;
    let own = |axis: &Axis| {
        let servo = axis.servo.map(|servo| (servo, axis.mass_error));
        // What does not settle was reported.
        let found = servo.and_then(|servo| servo_response_s(&[servo]));
        found.map_or(otherwise_s, |found| found.max(shortest))
    };
    axes.iter().flatten().map(own).fold(longest, f64::min)
}
