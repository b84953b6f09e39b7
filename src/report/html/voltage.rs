//! The voltage of the bus, as the page and the still picture draw it.
//!
//! A curve is what the limits over time are worked out from at the largest overrides. Where the
//! report has a worse voltage, at lower overrides or on another way through the program, that
//! is a line of its own: nothing that is drawn is better than the report.

use serde_json::{Value, json};

use super::columns::{column, figure, known, time};
use super::shares::PageSeries;
use super::shown::{Found, Page};
use crate::machine::Machine;
use crate::pipeline::{OverTime, Summary};
use crate::power::{Measure, VoltageCurve, VoltageSpan};
use crate::report::over_time;
use crate::report::quantity::three_digits;

/// A curve, and what the report says of it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Voltage<'a> {
    pub curve: &'a VoltageCurve,
    pub found: Option<&'a OverTime>,
    /// The converter's name; empty where there is one only.
    pub converter: &'a str,
}

/// A program, or a machine of two, with its figures.
fn side<'a>(page: &Page<'a>, after: bool) -> (Option<&'a PageSeries>, &'a Machine, &'a Summary) {
    let series = if after { page.after } else { page.before };
    match page.found {
        Found::Report(summary) => (series, page.machine, summary),
        Found::Limit { summary, .. } if after => (series, page.machine, &summary.after),
        Found::Limit { summary, .. } => (series, page.machine, &summary.before),
        Found::Diff(compared) if after => (series, compared.other, compared.summaries[1]),
        Found::Diff(compared) => (series, page.machine, compared.summaries[0]),
    }
}

/// The voltages of a program; none where nothing limits them, or where its motion is not at
/// hand.
pub(super) fn voltages<'a>(page: &Page<'a>, after: bool) -> Vec<Voltage<'a>> {
    let (series, machine, summary) = side(page, after);
    let curves = series.map_or(&[][..], |series| &series.voltages);
    let several = machine.converters.len() > 1;
    let with_report = |curve: &'a VoltageCurve| {
        let same = |found: &&OverTime| {
            let rating = &found.rating;
            rating.converter == curve.converter && rating.measure == curve.measure
        };
        let converter = machine.converters.get(curve.converter).filter(|_| several);
        Voltage {
            curve,
            found: summary.over_time.iter().find(same),
            converter: converter.map_or("", |it| it.name.as_str()),
        }
    };
    curves.iter().map(with_report).collect()
}

/// From which powers on overload counts, W, and for how long that is permitted.
pub(super) fn overloads(page: &Page<'_>) -> Vec<(f64, String)> {
    let (_, _, summary) = side(page, page.has_two());
    let all = summary.over_time.iter();
    all.filter_map(over_time::overload).collect()
}

impl Voltage<'_> {
    pub fn is_lowest(&self) -> bool {
        self.curve.measure == Measure::LowestVoltage
    }

    /// The voltage of the report where it is worse than all of the curve, V.
    pub fn beyond_v(&self) -> Option<f64> {
        let value_v = self.found?.rating.value;
        let drawn_v = self.curve.worst_v();
        let worse = if self.is_lowest() {
            value_v < drawn_v
        } else {
            value_v > drawn_v
        };
        worse.then_some(value_v)
    }

    /// Lowest and highest voltage of all that is drawn, V.
    pub fn extent_v(&self) -> [f64; 2] {
        let curve = self.curve;
        let lines = [curve.nominal_v, curve.limit_v].into_iter();
        let lines = lines.chain(self.beyond_v());
        let volts = curve.spans.iter().map(|span| span.volts).chain(lines);
        let volts = volts.filter(|volts| volts.is_finite());
        volts.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], it| {
            [least.min(it), most.max(it)]
        })
    }

    /// What the report says of it, such as `lowest 544 V, at least 480 V`.
    pub fn title(&self) -> String {
        if let Some(found) = self.found {
            let title = found.title().replacen(" bus voltage", "", 1);
            return format!("{title} {}", over_time::figures(&found.rating));
        }
        let which = if self.is_lowest() {
            "lowest"
        } else {
            "highest"
        };
        format!("{which} {} V", three_digits(self.curve.worst_v()))
    }

    fn data(&self) -> Value {
        let VoltageCurve {
            nominal_v,
            limit_v,
            endless,
            ref spans,
            ..
        } = *self.curve;
        let each = |value: fn(&VoltageSpan) -> Value| column(spans.iter().map(value));
        let whole = spans.iter().all(|span| span.from_s >= span.to_s);
        json!({
            "converter": self.converter,
            "lowest": self.is_lowest(),
            "title": self.title(),
            "fits": self.found.is_none_or(|found| found.rating.fits()),
            "nominal_v": figure(nominal_v),
            "limit_v": figure(limit_v),
            "beyond_v": known(self.beyond_v(), figure),
            "endless": endless,
            "count": spans.len(),
            "from_s": each(|span| time(span.from_s)),
            "to_s": if whole { Value::Null } else { each(|span| time(span.to_s)) },
            "volts": each(|span| figure(span.volts)),
            "bound": each(|span| span.bound.into()),
        })
    }
}

/// The curves of both programs.
pub(super) fn data(page: &Page<'_>) -> Value {
    let of = |after: bool| -> Vec<Value> {
        let list = voltages(page, after);
        list.iter().map(Voltage::data).collect()
    };
    json!({
        "before": of(false),
        "after": if page.has_two() { of(true) } else { Vec::new() },
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::power::Rating;

    fn curve(measure: Measure, volts: f64) -> VoltageCurve {
        let span = |from_s: f64, volts: f64| VoltageSpan {
            from_s,
            to_s: from_s,
            volts,
            bound: false,
        };
        VoltageCurve {
            converter: 0,
            measure,
            nominal_v: 560.0,
            limit_v: 480.0,
            endless: false,
            spans: vec![span(0.0, 560.0), span(1.0, volts), span(2.0, 560.0)],
        }
    }

    fn found(measure: Measure, value: f64) -> OverTime {
        OverTime {
            rating: Rating {
                measure,
                converter: 0,
                value,
                limit: 480.0,
                time_s: 1.0,
                line: 1,
                text: 0,
                lasting: false,
                overrides: None,
                bound: None,
                any: true,
                looked_at: false,
            },
            converter: String::new(),
            file: String::new(),
            may_pause: false,
        }
    }

    /// What is drawn is never better than the report, and where the report is better than the
    /// curve the curve stays.
    #[test]
    fn a_worse_voltage_of_the_report_is_drawn() {
        for (measure, worse, better) in [
            (Measure::LowestVoltage, 470.0, 520.0),
            (Measure::HighestVoltage, 590.0, 550.0),
        ] {
            let curve = curve(measure, 500.0);
            let beyond = |value: f64| {
                let found = found(measure, value);
                let voltage = Voltage {
                    curve: &curve,
                    found: Some(&found),
                    converter: "",
                };
                (voltage.beyond_v(), voltage.data()["beyond_v"].clone())
            };
            assert_eq!(beyond(worse), (Some(worse), json!(worse as i64)));
            let own = curve.worst_v();
            assert_eq!(beyond(own), (None, Value::Null));
            assert_eq!(beyond(better).0, None);
        }
    }
}
