//! The predicted power of a program, for laying a recording over it.
//!
//! Input: a program. Output: a [`Prediction`]: what all converters draw together at 100 %
//! override, without servo factors, with the line of each piece, and what axes do.

use std::io::{self, Read, Seek};

use crate::identify::overlay::{AxisCurve, Curve, PowerTrace};
use crate::machine::{Axis, AxisId, Machine};
use crate::pipeline::{Failure, Options, SeriesSink, series};
use crate::power::{AxisInstant, Instant};

/// Rows of the prediction at most, about.
const ROWS: f64 = 2e6;
/// The shortest step, s.
const STEP_S: f64 = 5e-4;

/// Whether a recording counts what is fed back as negative power.
#[must_use]
pub fn has_regeneration(log: &PowerTrace) -> bool {
    let (least, most) = log
        .power_w
        .iter()
        .fold((0.0_f64, 0.0_f64), |(least, most), w| {
            (least.min(*w), most.max(*w))
        });
    least < -0.02 * most
}

/// What is predicted.
#[derive(Debug)]
pub struct Prediction {
    /// Of the whole machine.
    pub curve: Curve,
    /// Of the axes that the recording has a power of, with points at the same times.
    pub axes: Vec<AxisCurve>,
    /// The first line that moves from an unknown start: there the curve is the most that may be
    /// drawn, and those of axes have no points.
    pub unknown_line: Option<u64>,
}

/// The prediction for a recording: so fine that it can be compared with it, and with what is
/// fed back where the recording has it.
///
/// # Errors
/// See [`Failure`].
pub fn predicted<R: Read + Seek + Send>(
    input: R,
    machine: &Machine,
    options: &Options,
    log: &PowerTrace,
) -> Result<Prediction, Failure> {
    let first = log.time_s.first().copied().unwrap_or_default();
    let lasts_s = log.time_s.last().map_or(0.0, |last| last - first);
    let step_s = (log.step_s() / 4.0).max(lasts_s / ROWS).max(STEP_S);
    let axes = log.axes.iter().filter_map(|own| {
        let id = AxisId::from_letter(u8::try_from(own.letter).ok()?)?;
        let axis = machine.axes.get(id as usize)?.as_ref()?;
        let curve = AxisCurve {
            letter: own.letter,
            ..AxisCurve::default()
        };
        Some(AxisPoints {
            index: id as usize,
            axis,
            curve,
        })
    });
    let mut points = Points {
        with_regeneration: has_regeneration(log),
        whole: Vec::new(),
        axes: axes.collect(),
        unknown_line: None,
    };
    series(input, machine, options, step_s, &mut points)?;
    let Points {
        whole,
        axes,
        unknown_line,
        ..
    } = points;
    // At both ends the axes stand; a spindle may turn at one of them.
    let ends = [whole.first(), whole.last()];
    let rest_w = ends.into_iter().flatten().map(|(_, w, _)| *w);
    let rest_w = rest_w.fold(f64::INFINITY, f64::min);
    let mut curve = Curve::new(if rest_w.is_finite() { rest_w } else { 0.0 });
    for (time_s, power_w, line) in whole {
        curve.push(time_s, power_w, line);
    }
    Ok(Prediction {
        curve,
        axes: axes.into_iter().map(|it| it.curve).collect(),
        unknown_line,
    })
}

/// By how much the power of an axis grows, W, where its acceleration is twice as large; the loss
/// in the copper grows with the square of the force, so this is the least. 0 where it draws
/// nothing.
fn drawn_for_acceleration_w(axis: &Axis, at: &AxisInstant) -> f64 {
    if at.power_w <= 0.0 {
        return 0.0;
    }
    let unit = axis.si_per_unit;
    let force_n = axis.mass_kg * at.accel_mm_s2 * unit;
    let mechanical_w = force_n * at.velocity_mm_s * unit;
    let copper_w = 2.0 * axis.copper_w_n2 * at.force_n * force_n;
    (mechanical_w / axis.efficiency + copper_w).max(0.0)
}

struct Points<'m> {
    with_regeneration: bool,
    whole: Vec<(f64, f64, u64)>,
    axes: Vec<AxisPoints<'m>>,
    unknown_line: Option<u64>,
}

struct AxisPoints<'m> {
    index: usize,
    axis: &'m Axis,
    curve: AxisCurve,
}

impl SeriesSink for Points<'_> {
    fn row(&mut self, time_s: f64, line: u64, instant: &Instant) -> io::Result<()> {
        let drawn_w: f64 = instant.bus_w.iter().sum();
        let fed_back_w: f64 = instant.regen_w.iter().sum();
        let power_w = if self.with_regeneration {
            drawn_w - fed_back_w
        } else {
            drawn_w
        };
        self.whole.push((time_s, power_w, line));
        if self.unknown_line.is_none() && !instant.unknown_axes.is_empty() {
            self.unknown_line = Some(line);
        }
        for own in &mut self.axes {
            let at = instant.axes.get(own.index);
            if let Some(at) = at.filter(|at| !at.power_w.is_nan()) {
                own.curve.power.push(time_s, at.power_w, line);
                let accel_w = drawn_for_acceleration_w(own.axis, at);
                own.curve.accel.push(time_s, accel_w, line);
            }
        }
        Ok(())
    }
}
