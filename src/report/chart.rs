//! A spindle's run as a picture: SVG with one panel each for speed,
//! acceleration, jerk, torque and power.
//!
//! The drawing is five polylines with axes, which takes less than the
//! dependencies of a plotting library; it holds no text of the user's.

use std::fmt::Write as _;
use std::io::{self, Write};

use super::figure::round_to_digits;
use crate::pipeline::Sample;

/// Buckets of samples; more cannot be distinguished.
const BUCKETS_MAX: usize = 2048;
/// Panels: name with unit.
const PANELS: [&str; 5] = [
    "speed, 1/min",
    "acceleration, 1/min/s",
    "jerk, 1/min/s²",
    "torque, N·m",
    "power, W",
];
const COLOURS: [&str; 5] = ["#1f5fa8", "#b3541e", "#6a4c93", "#3a7d44", "#a4161a"];
const WIDTH: f64 = 900.0;
const PANEL: f64 = 150.0;
const LEFT: f64 = 90.0;
const RIGHT: f64 = 20.0;
const TOP: f64 = 30.0;
const GAP: f64 = 40.0;
/// Lines of a grid that are aimed at.
const LINES: f64 = 6.0;

/// Some samples in a row: first, least, largest and last value of each figure.
#[derive(Debug, Clone, Copy)]
struct Bucket {
    from_s: f64,
    to_s: f64,
    first: [f64; 5],
    least: [f64; 5],
    most: [f64; 5],
    last: [f64; 5],
    target: (f64, f64),
}

/// Collects samples in bounded memory, and draws them.
#[derive(Debug, Default)]
pub struct SpindleChart {
    buckets: Vec<Bucket>,
    /// Samples that a bucket holds when it is full.
    size: u64,
    /// Samples in the last bucket.
    filled: u64,
}

impl SpindleChart {
    /// Takes one more sample.
    pub fn add(&mut self, sample: &Sample) {
        let values = [
            sample.motion.speed,
            sample.motion.accel,
            sample.jerk_rpm_s2,
            sample.torque_nm,
            sample.power_w,
        ];
        let alone = Bucket {
            from_s: sample.time_s,
            to_s: sample.time_s,
            first: values,
            least: values,
            most: values,
            last: values,
            target: (sample.target_rpm, sample.target_rpm),
        };
        self.filled += 1;
        if self.filled > self.size || self.buckets.is_empty() {
            self.filled = 1;
            self.size = self.size.max(1);
            self.buckets.push(alone);
            if self.buckets.len() > BUCKETS_MAX {
                self.halve();
            }
        } else if let Some(last) = self.buckets.last_mut() {
            last.join(&alone);
        }
    }

    /// Two buckets become one.
    fn halve(&mut self) {
        let joined = self.buckets.chunks(2).filter_map(|pair| {
            let mut bucket = *pair.first()?;
            if let Some(second) = pair.get(1) {
                bucket.join(second);
            }
            Some(bucket)
        });
        self.buckets = joined.collect();
        self.size *= 2;
        // An odd one at the end is filled on.
    }

    /// Draws the picture.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write(&self, mut out: impl Write) -> io::Result<()> {
        let height = TOP + (PANEL + GAP) * PANELS.len() as f64;
        let from = self.buckets.first().map_or(0.0, |first| first.from_s);
        let to = self.buckets.last().map_or(1.0, |last| last.to_s);
        let time = Scale::new(from, to.max(from + 1e-9), LEFT, WIDTH - RIGHT);
        writeln!(
            out,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height}\" \
             font-family=\"sans-serif\" font-size=\"12\">\n\
             <rect width=\"100%\" height=\"100%\" fill=\"white\"/>"
        )?;
        for (index, (name, colour)) in PANELS.into_iter().zip(COLOURS).enumerate() {
            let top = TOP + (PANEL + GAP) * index as f64;
            out.write_all(self.panel(index, name, colour, top, &time).as_bytes())?;
        }
        writeln!(out, "</svg>")
    }

    fn panel(&self, index: usize, name: &str, colour: &str, top: f64, time: &Scale) -> String {
        let at = |values: &[f64; 5]| values.get(index).copied().unwrap_or(0.0);
        let (mut least, mut most) = (0.0_f64, 0.0_f64);
        for bucket in &self.buckets {
            least = least.min(at(&bucket.least));
            most = most.max(at(&bucket.most));
            if index == 0 {
                least = least.min(bucket.target.0.min(bucket.target.1));
                most = most.max(bucket.target.0.max(bucket.target.1));
            }
        }
        if most - least < 1e-12 {
            most = least + 1.0;
        }
        let room = 0.05 * (most - least);
        let value = Scale::new(least - room, most + room, top + PANEL, top);
        let frame = Frame {
            left: LEFT,
            right: WIDTH - RIGHT,
            top,
            bottom: top + PANEL,
            unit: "",
        };
        let mut text = grid(name, &frame, time, &value);
        if index == 0 {
            let points = self.buckets.iter().flat_map(|bucket| {
                [
                    (bucket.from_s, bucket.target.0),
                    (bucket.to_s, bucket.target.1),
                ]
            });
            polyline(&mut text, "#999999", time, &value, points);
        }
        let points = self.buckets.iter().flat_map(|bucket| bucket.outline(at));
        polyline(&mut text, colour, time, &value, points);
        text
    }
}

impl Bucket {
    /// The line through it: from the first value to the last, by way of the least and the
    /// largest only where they lie beyond both. A value that just rises stays one line then.
    fn outline(&self, at: impl Fn(&[f64; 5]) -> f64) -> impl Iterator<Item = (f64, f64)> {
        let [first, least, most, last] = [&self.first, &self.least, &self.most, &self.last].map(at);
        let middle = 0.5 * (self.from_s + self.to_s);
        let below = (least < first.min(last)).then_some((middle, least));
        let above = (most > first.max(last)).then_some((middle, most));
        let [one, other] = if first <= last {
            [below, above]
        } else {
            [above, below]
        };
        let ends = [
            Some((self.from_s, first)),
            one,
            other,
            Some((self.to_s, last)),
        ];
        ends.into_iter().flatten()
    }

    /// Takes the next one in.
    fn join(&mut self, next: &Self) {
        self.to_s = next.to_s;
        self.last = next.last;
        self.target.1 = next.target.1;
        let (least, most) = (self.least.iter_mut(), self.most.iter_mut());
        for (least, other) in least.zip(next.least) {
            *least = least.min(other);
        }
        for (most, other) in most.zip(next.most) {
            *most = most.max(other);
        }
    }
}

/// Values to places of the picture.
pub(super) struct Scale {
    least: f64,
    most: f64,
    from: f64,
    to: f64,
}

impl Scale {
    pub(super) fn new(least: f64, most: f64, from: f64, to: f64) -> Self {
        Self {
            least,
            most,
            from,
            to,
        }
    }

    pub(super) fn at(&self, value: f64) -> f64 {
        self.from + (value - self.least) / (self.most - self.least) * (self.to - self.from)
    }

    /// Round values for the lines of a grid.
    pub(super) fn marks(&self) -> impl Iterator<Item = f64> {
        let rough = (self.most - self.least) / LINES;
        let power = libm::pow(10.0, libm::floor(libm::log10(rough)));
        let step = [1.0, 2.0, 5.0, 10.0]
            .into_iter()
            .map(|digit| digit * power)
            .find(|step| *step >= rough)
            .unwrap_or(rough);
        let (first, most) = ((self.least / step).ceil(), self.most);
        (0..20)
            .map(move |index| (first + f64::from(index)) * step)
            .take_while(move |mark| *mark <= most)
            .map(|mark| round_to_digits(mark + 0.0, 10))
    }
}

/// Where a panel of a chart stands: its edges, and the unit after its values.
pub(super) struct Frame {
    pub(super) left: f64,
    pub(super) right: f64,
    pub(super) top: f64,
    pub(super) bottom: f64,
    pub(super) unit: &'static str,
}

/// The name and the grid of a panel, with values and seconds along its edges.
pub(super) fn grid(name: &str, frame: &Frame, time: &Scale, value: &Scale) -> String {
    let Frame {
        left,
        right,
        top,
        bottom,
        unit,
    } = frame;
    let mut text = format!(
        "<text x=\"{left}\" y=\"{}\" font-weight=\"bold\">{name}</text>\n",
        top - 8.0
    );
    // In kW as in all texts, where there are any.
    let kilo = *unit == " W" && value.marks().any(|mark| mark.abs() >= 1e3);
    let (size, unit) = if kilo { (1e3, " kW") } else { (1.0, *unit) };
    for mark in value.marks() {
        let y = value.at(mark);
        let mark = mark / size;
        let _ = writeln!(
            text,
            "<path d=\"M{left} {y:.2}H{right}\" stroke=\"#dddddd\"/>\
             <text x=\"{}\" y=\"{:.2}\" text-anchor=\"end\">{mark}{unit}</text>",
            left - 6.0,
            y + 4.0
        );
    }
    for mark in time.marks() {
        let x = time.at(mark);
        let _ = writeln!(
            text,
            "<path d=\"M{x:.2} {top}V{bottom}\" stroke=\"#dddddd\"/>\
             <text x=\"{x:.2}\" y=\"{}\" text-anchor=\"middle\">{mark} s</text>",
            bottom + 15.0
        );
    }
    text
}

fn polyline(
    text: &mut String,
    colour: &str,
    time: &Scale,
    value: &Scale,
    points: impl Iterator<Item = (f64, f64)>,
) {
    let _ = write!(
        text,
        "<polyline fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.5\" points=\""
    );
    let mut last = String::new();
    for (t, v) in points {
        let point = format!("{:.2},{:.2} ", time.at(t), value.at(v));
        if point != last {
            text.push_str(&point);
            last = point;
        }
    }
    text.push_str("\"/>\n");
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::period::Motion;

    /// A speed that rises is one thin line, however many samples a bucket has.
    #[test]
    fn a_ramp_is_a_line() {
        let mut chart = SpindleChart::default();
        for index in 0..100_000_u32 {
            chart.add(&sample(index, f64::from(index)));
        }
        let speed = |values: &[f64; 5]| values[0];
        let outline = chart.buckets.iter().flat_map(|it| it.outline(speed));
        let outline: Vec<(f64, f64)> = outline.collect();
        assert_eq!(outline.len(), 2 * chart.buckets.len());
        assert!(outline.is_sorted());
    }

    fn sample(index: u32, speed: f64) -> Sample {
        Sample {
            time_s: f64::from(index) * 1e-3,
            target_rpm: 0.0,
            motion: Motion { speed, accel: 0.0 },
            jerk_rpm_s2: 0.0,
            torque_nm: 0.0,
            power_w: 0.0,
        }
    }

    /// However long the run, a single sample that stands out is still drawn.
    #[test]
    fn extremes_survive_in_bounded_memory() {
        let mut chart = SpindleChart::default();
        for index in 0..100_001_u32 {
            let speed = if index == 77_777 { 123.0 } else { 1.0 };
            chart.add(&sample(index, speed));
        }
        assert!(chart.buckets.len() <= BUCKETS_MAX);
        let most = chart.buckets.iter().map(|bucket| bucket.most[0]);
        assert_eq!(most.fold(0.0, f64::max), 123.0);
        let speed = |values: &[f64; 5]| values[0];
        let drawn = chart.buckets.iter().flat_map(|it| it.outline(speed));
        assert_eq!(drawn.map(|(_, it)| it).fold(0.0, f64::max), 123.0);
        let ends = chart.buckets.last().map(|bucket| bucket.to_s);
        assert_eq!(ends, Some(100.0));
        let gaps = chart
            .buckets
            .windows(2)
            .map(|pair| pair[1].from_s - pair[0].to_s);
        assert!(gaps.fold(0.0, f64::max) < 1.1e-3);
    }
}
