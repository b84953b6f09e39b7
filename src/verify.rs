//! The predicted power of a program, for laying a recording over it.
//!
//! Input: a program. Output: a [`Curve`] of what all converters draw together at 100 %
//! override, without servo factors, with the line of each piece.

use std::io::{self, Read, Seek};

use crate::identify::overlay::{Curve, PowerTrace};
use crate::machine::Machine;
use crate::pipeline::{Failure, Options, SeriesSink, series};
use crate::power::Instant;

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
) -> Result<Curve, Failure> {
    let first = log.time_s.first().copied().unwrap_or_default();
    let lasts_s = log.time_s.last().map_or(0.0, |last| last - first);
    let step_s = (log.step_s() / 4.0).max(lasts_s / ROWS).max(STEP_S);
    let mut points = Points {
        with_regeneration: has_regeneration(log),
        points: Vec::new(),
    };
    series(input, machine, options, step_s, &mut points)?;
    let points = points.points;
    // At both ends the axes stand; a spindle may turn at one of them.
    let ends = [points.first(), points.last()];
    let rest_w = ends.into_iter().flatten().map(|(_, w, _)| *w);
    let rest_w = rest_w.fold(f64::INFINITY, f64::min);
    let mut curve = Curve::new(if rest_w.is_finite() { rest_w } else { 0.0 });
    for (time_s, power_w, line) in points {
        curve.push(time_s, power_w, line);
    }
    Ok(curve)
}

struct Points {
    with_regeneration: bool,
    points: Vec<(f64, f64, u64)>,
}

impl SeriesSink for Points {
    fn row(&mut self, time_s: f64, line: u64, instant: &Instant) -> io::Result<()> {
        let drawn_w: f64 = instant.bus_w.iter().sum();
        let fed_back_w: f64 = instant.regen_w.iter().sum();
        let power_w = if self.with_regeneration {
            drawn_w - fed_back_w
        } else {
            drawn_w
        };
        self.points.push((time_s, power_w, line));
        Ok(())
    }
}
