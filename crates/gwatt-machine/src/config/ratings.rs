//! What a converter bears over time.

use super::findings::Findings;
use super::machine_file::ConverterTable;
use super::value::{At, Num};
use crate::model::{Brake, Capacitor, Continuous, Overload, Ratings};

/// Window of the continuous power if the file does not say: three minutes.
const DEFAULT_WINDOW_S: f64 = 180.0;

/// Makes the ratings of a converter's table.
pub(crate) fn of(findings: &mut Findings<'_>, table: &At<ConverterTable>) -> Ratings {
    let (table_span, table) = (&table.span, &table.value);
    let ordered = voltages(findings, table);
    let continuous = table.continuous_power_w.as_ref().map(|power| Continuous {
        power_w: power.value,
        window_s: table
            .window_s
            .as_ref()
            .map_or(DEFAULT_WINDOW_S, |window| window.value),
    });
    let capacitor = match (&table.capacitance_f, &table.bus_nominal_v) {
        (Some(capacitance), Some(nominal)) => Some(Capacitor {
            capacitance_f: capacitance.value,
            nominal_v: nominal.value,
            min_v: table.bus_min_v.as_ref().map(|volts| volts.value),
            max_v: table.bus_max_v.as_ref().map(|volts| volts.value),
        }),
        _ => None,
    };
    if ordered {
        unused(findings, table, capacitor.is_some());
    }
    let credit_capacitance = table.credit_capacitance == Some(true);
    if credit_capacitance && capacitor.is_none_or(|bus| bus.min_v.is_none()) {
        let message = "`credit_capacitance` without the capacitance and its voltages";
        let help = "give `capacitance_f`, `bus_nominal_v` and `bus_min_v`";
        findings.error("machine-converter", table_span, message, Some(help.into()));
    }
    Ratings {
        continuous,
        overload: overload(findings, table),
        capacitor,
        credit_capacitance,
        brake: brake(table),
    }
}

/// The entries of the overload curve, from the largest power on.
fn overload(findings: &mut Findings<'_>, table: &ConverterTable) -> Vec<Overload> {
    let mut entries = Vec::new();
    for entry in table.overload.iter().flatten() {
        if let (Some(power), Some(seconds), Some(every)) = (
            &entry.value.power_w,
            &entry.value.seconds,
            &entry.value.every_s,
        ) {
            entries.push(Overload {
                power_w: power.value,
                seconds: seconds.value,
                every_s: every.value,
            });
            if table.continuous_power_w.is_none() && entries.len() == 1 {
                let message =
                    "`overload` without `continuous_power_w`: all power counts as overload";
                let help = "give the power that the converter delivers continuously";
                findings.warning("machine-converter", &entry.span, message, Some(help.into()));
            }
        }
    }
    entries.sort_by(|a, b| b.power_w.total_cmp(&a.power_w));
    entries
}

/// Without an energy it takes none beyond its power; without a power it gives
/// nothing off.
fn brake(table: &ConverterTable) -> Option<Brake> {
    let power_w = table.brake_power_w.as_ref().map(|power| power.value);
    let energy_j = table.brake_energy_j.as_ref().map(|energy| energy.value);
    (power_w.is_some() || energy_j.is_some()).then(|| Brake {
        power_w: power_w.unwrap_or(0.0),
        energy_j: energy_j.unwrap_or(0.0),
    })
}

/// Voltages that cannot be checked.
fn unused(findings: &mut Findings<'_>, table: &ConverterTable, bus: bool) {
    let limits = [
        ("bus_min_v", table.bus_min_v.as_ref()),
        ("bus_max_v", table.bus_max_v.as_ref()),
    ];
    for (name, limit) in limits {
        let Some(limit) = limit else { continue };
        if !bus {
            let message = format!("`{name}` is not checked: it takes the capacitance of the bus");
            let help = "give `capacitance_f` and `bus_nominal_v`";
            findings.warning("machine-converter", &limit.span, message, Some(help.into()));
        } else if name == "bus_max_v" && table.regen_power_w.is_none() {
            let message =
                "`bus_max_v` is not checked: without `regen_power_w` any power can be fed back";
            let help = "give the largest power that converter or braking resistor take";
            findings.warning("machine-converter", &limit.span, message, Some(help.into()));
        }
    }
}

/// Whether the voltages of the DC bus are in order.
fn voltages(findings: &mut Findings<'_>, table: &ConverterTable) -> bool {
    fn above<A, B>(
        findings: &mut Findings<'_>,
        low: (&str, Option<&Num<A>>),
        high: (&str, Option<&Num<B>>),
    ) -> bool {
        if let (Some(a), Some(b)) = (low.1, high.1)
            && a.value >= b.value
        {
            let message = format!("`{}` is not below `{}`", low.0, high.0);
            findings.error("machine-converter", &a.span, message, None);
            return true;
        }
        false
    }
    let min = ("bus_min_v", table.bus_min_v.as_ref());
    let nominal = ("bus_nominal_v", table.bus_nominal_v.as_ref());
    let max = ("bus_max_v", table.bus_max_v.as_ref());
    let found = above(findings, min, nominal) | above(findings, nominal, max);
    !(found || above(findings, min, max))
}
