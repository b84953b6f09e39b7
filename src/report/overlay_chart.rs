//! A recording over its prediction as a picture: the whole of it, and around the block that
//! draws most above its prediction.
//!
//! The drawing holds no text of the user's.

use std::fmt::Write as _;
use std::io::{self, Write};

use super::chart::{Frame, Scale, grid};
use crate::identify::overlay::{Overlay, PowerTrace};

const WIDTH: f64 = 1100.0;
const LEFT: f64 = 90.0;
const RIGHT: f64 = 1080.0;
const TOP: f64 = 70.0;
const PANEL: f64 = 260.0;
const GAP: f64 = 70.0;
/// Parts of a panel, of which more would not be seen; each shows its least and its largest value.
const PARTS: usize = 1000;
/// Seconds before and after the worst block that are shown.
const AROUND_S: f64 = 0.5;
const COLOURS: [&str; 2] = ["#b3541e", "#1f5fa8"];
const NAMES: [&str; 2] = ["predicted", "measured"];

/// See the module.
#[derive(Debug)]
pub struct OverlayChart<'a> {
    overlay: &'a Overlay,
    log: &'a PowerTrace,
}

impl<'a> OverlayChart<'a> {
    /// A picture of this.
    #[must_use]
    pub fn new(overlay: &'a Overlay, log: &'a PowerTrace) -> Self {
        Self { overlay, log }
    }

    /// Draws it.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write(&self, mut out: impl Write) -> io::Result<()> {
        let excess = |a: f64, b: f64| a - b;
        let worst = self.overlay.blocks.iter().max_by(|a, b| {
            excess(a.measured_w, a.predicted_w).total_cmp(&excess(b.measured_w, b.predicted_w))
        });
        let height = TOP + 2.0 * (PANEL + GAP);
        writeln!(
            out,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height}\" \
             font-family=\"sans-serif\" font-size=\"13\">\n\
             <rect width=\"100%\" height=\"100%\" fill=\"white\"/>"
        )?;
        for (index, (name, colour)) in NAMES.into_iter().zip(COLOURS).enumerate() {
            let x = LEFT + 120.0 * index as f64;
            writeln!(
                out,
                "<rect x=\"{x}\" y=\"16\" width=\"14\" height=\"14\" fill=\"{colour}\"/>\
                 <text x=\"{}\" y=\"28\">{name}</text>",
                x + 20.0
            )?;
        }
        let times = &self.log.time_s;
        let [first, last] = [times.first(), times.last()].map(|t| t.copied().unwrap_or_default());
        out.write_all(
            self.panel("The whole recording", [first, last], TOP)
                .as_bytes(),
        )?;
        if let Some(worst) = worst {
            let name = format!(
                "Around line {}, which draws most above its prediction",
                worst.block
            );
            let around = [worst.start_s - AROUND_S, worst.start_s + 3.0 * AROUND_S];
            let around = [around[0].max(first), around[1].min(last)];
            out.write_all(self.panel(&name, around, TOP + PANEL + GAP).as_bytes())?;
        }
        writeln!(out, "</svg>")
    }

    /// A panel with what lies between two times.
    fn panel(&self, name: &str, [from, to]: [f64; 2], top: f64) -> String {
        let Self { overlay, log } = self;
        let begin = log.time_s.partition_point(|t| *t < from);
        let end = log.time_s.partition_point(|t| *t <= to);
        let of = |values: &'a [f64]| values.get(begin..end).unwrap_or_default();
        let curves = [of(&overlay.predicted_w), of(&log.power_w)];
        let all = curves.iter().flat_map(|curve| curve.iter());
        let (least, most) = all.fold((0.0_f64, 1.0_f64), |(least, most), w| {
            (least.min(*w), most.max(*w))
        });
        let bottom = top + PANEL;
        let time = Scale::new(from, to.max(from + 1e-9), LEFT, RIGHT);
        let value = Scale::new(least, most * 1.05, bottom, top);
        let frame = Frame {
            left: LEFT,
            right: RIGHT,
            top,
            bottom,
            unit: " W",
        };
        let mut text = grid(name, &frame, &time, &value);
        let times = of(&log.time_s);
        for (curve, colour) in curves.into_iter().zip(COLOURS) {
            let _ = write!(
                text,
                "<path fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.2\" d=\""
            );
            let size = curve.len().div_ceil(PARTS).max(1);
            let mut sign = 'M';
            for (times, values) in times.chunks(size).zip(curve.chunks(size)) {
                let x = time.at(times.first().copied().unwrap_or_default());
                let [least, most] = [f64::min, f64::max].map(|of: fn(f64, f64) -> f64| {
                    values.iter().copied().reduce(of).unwrap_or(0.0)
                });
                let _ = write!(text, "{sign}{x:.2} {:.2}", value.at(least));
                sign = 'L';
                if most > least {
                    let _ = write!(text, "V{:.2}", value.at(most));
                }
            }
            text.push_str("\"/>\n");
        }
        text
    }
}
