//! The voltage of the bus below the power, in the still picture.

use std::fmt::Write as _;

use super::voltage::Voltage;
use crate::report::chart::{Frame, Scale, grid};
use crate::report::quantity::three_digits;

/// How high its panel is.
pub(super) const PANEL: f64 = 120.0;
/// The lowest voltage, and the highest.
const COLOURS: [&str; 2] = ["#1f5fa8", "#b3500a"];
const LIMIT: &str = "#b00020";

/// What the panel is called: the figures of the report.
pub(super) fn name(voltages: &[Voltage<'_>]) -> String {
    let titles: Vec<String> = voltages.iter().map(Voltage::title).collect();
    format!("Bus voltage: {}", titles.join("; "))
}

/// The panel of one program, under this name.
pub(super) fn panel(name: &str, voltages: &[Voltage<'_>], frame: &Frame, time: &Scale) -> String {
    let (least_v, most_v) = extent(voltages);
    let room = 0.1 * (most_v - least_v).max(1.0);
    let value = Scale::new(least_v - room, most_v + room, frame.bottom, frame.top);
    let mut text = grid(name, frame, time, &value);
    let mut nominal = Vec::new();
    for voltage in voltages {
        let curve = voltage.curve;
        if !nominal.contains(&curve.nominal_v.to_bits()) {
            nominal.push(curve.nominal_v.to_bits());
            let label = format!("nominal {} V", three_digits(curve.nominal_v));
            line(
                &mut text,
                ("#777777", "2 3"),
                frame,
                value.at(curve.nominal_v),
                &label,
            );
        }
        let which = if voltage.is_lowest() {
            "lowest"
        } else {
            "highest"
        };
        let label = format!("{which} permitted {} V", three_digits(curve.limit_v));
        line(
            &mut text,
            (LIMIT, "6 4"),
            frame,
            value.at(curve.limit_v),
            &label,
        );
        let colour = COLOURS[usize::from(!voltage.is_lowest())];
        if let Some(volts) = voltage.beyond_v() {
            let y = height(volts, frame, &value);
            let label = if volts.is_finite() {
                format!("{which} of the report {} V", three_digits(volts))
            } else {
                format!("{which} of the report: no end")
            };
            line(&mut text, (colour, "1 3"), frame, y, &label);
        }
        outline(&mut text, colour, voltage, frame, (time, &value));
    }
    text
}

/// From the lowest to the highest voltage of all that is drawn.
fn extent(voltages: &[Voltage<'_>]) -> (f64, f64) {
    let extents = voltages.iter().map(Voltage::extent_v);
    let [least, most] = extents.fold([f64::INFINITY, f64::NEG_INFINITY], |own, other| {
        [own[0].min(other[0]), own[1].max(other[1])]
    });
    (least, most)
}

/// Where a voltage stands; one that has no end at the edge.
fn height(volts: f64, frame: &Frame, value: &Scale) -> f64 {
    if volts.is_finite() {
        value.at(volts)
    } else {
        frame.top
    }
}

/// A line from side to side with what it stands for.
fn line(text: &mut String, (colour, dashes): (&str, &str), frame: &Frame, y: f64, label: &str) {
    let _ = writeln!(
        text,
        "<path d=\"M{} {y:.2}H{}\" stroke=\"{colour}\" stroke-dasharray=\"{dashes}\"/>\
         <text x=\"{}\" y=\"{:.2}\" text-anchor=\"end\" fill=\"{colour}\" \
         stroke=\"white\" stroke-width=\"3\" paint-order=\"stroke\">{label}</text>",
        frame.left,
        frame.right,
        frame.right - 4.0,
        y - 4.0,
    );
}

/// The curve; bounds are dashed.
fn outline(
    text: &mut String,
    colour: &str,
    voltage: &Voltage<'_>,
    frame: &Frame,
    (time, value): (&Scale, &Scale),
) {
    let spans = &voltage.curve.spans;
    let mut before = None;
    for run in spans.chunk_by(|a, b| a.bound == b.bound) {
        let mut path = String::new();
        for span in before.into_iter().chain(run) {
            let letter = if path.is_empty() { 'M' } else { 'L' };
            let [from, to] = [span.from_s, span.to_s].map(|it| time.at(it));
            let y = height(span.volts, frame, value);
            let _ = write!(path, "{letter}{from:.2} {y:.2}");
            if to > from {
                let _ = write!(path, "H{to:.2}");
            }
        }
        let bound = run.first().is_some_and(|span| span.bound);
        let dashes = if bound {
            " stroke-dasharray=\"4 3\""
        } else {
            ""
        };
        let _ = writeln!(
            text,
            "<path d=\"{path}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.5\"{dashes}/>"
        );
        before = run.last();
    }
}
