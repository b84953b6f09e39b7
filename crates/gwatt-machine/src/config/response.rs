//! Responses and correction filters of the axes.

use super::findings::Findings;
use super::machine_file::{AxisTable, CorrectionTable, ResponseTable, RootTable};
use super::value::At;
use crate::axis::AxisId;
use crate::response::{CommandFilter, Response, ResponseRoot, Responses};

/// Roots, and sections, that an axis may have.
const ROOTS_MAX: usize = 32;
/// Coefficients of a section.
const SECTION: usize = 5;
/// Damping of a velocity loop of which only the bandwidth is known.
const LOOP_DAMPING: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Takes over what the table of an axis says.
pub(crate) fn take(
    findings: &mut Findings<'_>,
    id: AxisId,
    table: &AxisTable,
    responses: &mut Responses,
) {
    if let Some(table) = &table.response
        && let Some(found) = response(findings, &table.value)
    {
        responses.follow.push((id, found));
    }
    if let Some(table) = &table.correction
        && let Some(found) = correction(findings, &table.value)
    {
        responses.corrections.push((id, found));
    }
}

fn response(findings: &mut Findings<'_>, table: &ResponseTable) -> Option<Response> {
    let zeros = roots(findings, table.zeros.as_deref(), None);
    let poles = roots(findings, table.poles.as_deref(), Some("`poles`"));
    let force = roots(
        findings,
        table.force_poles.as_deref(),
        Some("`force_poles`"),
    );
    let (zeros, mut poles, force_poles) = (zeros?, poles?, force?);
    poles.extend(
        table
            .position_gain_1_s
            .as_ref()
            .map(|gain| ResponseRoot::Single {
                time_constant_s: 1.0 / gain.value,
            }),
    );
    poles.extend(
        table
            .velocity_bandwidth_hz
            .as_ref()
            .map(|hz| ResponseRoot::Pair {
                frequency_hz: hz.value,
                damping: LOOP_DAMPING,
            }),
    );
    Some(Response {
        zeros,
        poles,
        force_poles,
        delay_s: table.delay_ms.as_ref().map_or(0.0, |ms| ms.value * 1e-3),
    })
}

/// The roots of a list; `stable` names those that must decay.
fn roots(
    findings: &mut Findings<'_>,
    list: Option<&[At<RootTable>]>,
    stable: Option<&str>,
) -> Option<Vec<ResponseRoot>> {
    let list = list.unwrap_or_default();
    let mut roots = Vec::new();
    let mut fits = true;
    for (index, At { value: table, span }) in list.iter().enumerate() {
        let pair = table.frequency_hz.as_ref().zip(table.damping.as_ref());
        let incomplete = table.frequency_hz.is_some() != table.damping.is_some();
        let root = match (pair, &table.time_constant_s) {
            (Some((hz, damping)), None) => Some(ResponseRoot::Pair {
                frequency_hz: hz.value,
                damping: damping.value,
            }),
            (None, Some(time)) if !incomplete && time.value != 0.0 => Some(ResponseRoot::Single {
                time_constant_s: time.value,
            }),
            _ => None,
        };
        let Some(root) = root.filter(|_| index < ROOTS_MAX) else {
            let message = if index < ROOTS_MAX {
                "a root is a pair or a single one".to_owned()
            } else {
                format!("more than {ROOTS_MAX} roots")
            };
            let help = "give frequency_hz and damping, or time_constant_s".to_owned();
            findings.error("machine-response", span, message, Some(help));
            fits = false;
            continue;
        };
        let decays = match root {
            ResponseRoot::Pair { damping, .. } => damping > 0.0,
            ResponseRoot::Single { time_constant_s } => time_constant_s > 0.0,
        };
        if let Some(name) = stable.filter(|_| !decays) {
            let message = format!("{name}: this would swing up for ever");
            let help = "poles have a damping, or a time constant, above 0".to_owned();
            findings.error("machine-response", span, message, Some(help));
            fits = false;
        }
        roots.push(root);
    }
    fits.then_some(roots)
}

fn correction(findings: &mut Findings<'_>, table: &CorrectionTable) -> Option<CommandFilter> {
    let (period, list) = (table.period_ms.as_ref()?, table.sections.as_ref()?);
    let mut sections = Vec::new();
    let mut fits = true;
    for (index, At { value, span }) in list.iter().enumerate() {
        let mut section = [0.0; SECTION];
        for (slot, number) in section.iter_mut().zip(value) {
            *slot = number.value;
        }
        let [b0, b1, b2, a1, a2] = section;
        let (message, help) = if value.len() != SECTION || index >= ROOTS_MAX {
            let message = format!("a section has {} numbers", value.len());
            (message, "write [b0, b1, b2, a1, a2], at most 32 of them")
        } else if !(a2.abs() < 1.0 && a1.abs() < 1.0 + a2) {
            let message = "this section is not stable".to_owned();
            (message, "|a2| < 1 and |a1| < 1 + a2 must hold")
        } else if ((b0 + b1 + b2) / (1.0 + a1 + a2) - 1.0).abs() > 1e-6 {
            let message = "this section changes the size of the path".to_owned();
            (
                message,
                "b0 + b1 + b2 must be 1 + a1 + a2: its gain at rest is 1",
            )
        } else {
            sections.push(section);
            continue;
        };
        findings.error("machine-response", span, message, Some(help.to_owned()));
        fits = false;
    }
    fits.then_some(CommandFilter {
        period_s: period.value * 1e-3,
        sections,
    })
}
