//! Contour errors as a picture: the path with its errors enlarged.

use std::io::{self, Write};

use super::drawing::{COLOURS, NAMES, PATH, begin, polyline, round_down};
use crate::contour::PlotPoint;

/// Points that can be distinguished; one more halves them.
const POINTS_MAX: usize = 8192;
const WIDTH: f64 = 900.0;
const MARGIN: f64 = 40.0;
/// An error is drawn as this share of the picture at most.
const SHARE: f64 = 0.06;
/// So many times the root mean square of the errors is drawn in full: where few are much larger
/// than all others, those others are seen.
const SHOWN_RMS: f64 = 3.0;
const RAPID: &str = "#dddddd";
const WORST: &str = "#a4161a";
const AXES: [char; 3] = ['X', 'Y', 'Z'];

/// Collects points in bounded memory, and draws them.
#[derive(Debug)]
pub struct ContourChart {
    points: Vec<PlotPoint>,
    /// Of so many samples one is kept: that with the largest error.
    step: u64,
    seen: u64,
    errors: Seen,
}

/// Errors of all samples of feeds.
#[derive(Debug, Default)]
struct Seen {
    largest_mm: f64,
    /// The point with the largest, and whether it is corrected.
    worst: Option<(PlotPoint, usize)>,
    square_sum: f64,
    count: u64,
}

impl Seen {
    fn take(&mut self, point: &PlotPoint) {
        for (which, (off, counts)) in point.off.iter().zip(point.counts).enumerate() {
            let square = size2(off);
            if !(counts && square.is_finite()) {
                continue;
            }
            self.square_sum += square;
            self.count += 1;
            if square.sqrt() > self.largest_mm {
                self.largest_mm = square.sqrt();
                self.worst = Some((*point, which));
            }
        }
    }

    fn rms_mm(&self) -> f64 {
        (self.square_sum / self.count.max(1) as f64).sqrt()
    }
}

impl Default for ContourChart {
    fn default() -> Self {
        Self {
            points: Vec::new(),
            step: 1,
            seen: 0,
            errors: Seen::default(),
        }
    }
}

fn size2(off: &[f64; 3]) -> f64 {
    off.iter().map(|d| d * d).sum()
}

fn worse(a: PlotPoint, b: PlotPoint) -> PlotPoint {
    let rank = |point: &PlotPoint| (point.counts[0], size2(&point.off[0]));
    if rank(&b) > rank(&a) { b } else { a }
}

impl ContourChart {
    /// Takes one more sample.
    pub fn add(&mut self, point: &PlotPoint) {
        self.errors.take(point);
        let starts = self.seen.is_multiple_of(self.step);
        self.seen += 1;
        match self.points.last_mut() {
            Some(last) if !starts => *last = worse(*last, *point),
            _ => self.points.push(*point),
        }
        if self.points.len() > POINTS_MAX {
            let joined = self.points.chunks(2).filter_map(|pair| match pair {
                [a, b] => Some(worse(*a, *b)),
                [a] => Some(*a),
                _ => None,
            });
            self.points = joined.collect();
            self.step *= 2;
            self.seen = self.points.len() as u64 * self.step;
        }
    }

    /// Draws the two axes that reach farthest: the path, and where feeds are off it.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write(&self, mut out: impl Write) -> io::Result<()> {
        let view = View::of(&self.points, &self.errors);
        begin(&mut out, WIDTH, view.height())?;
        view.caption(&self.errors, &mut out)?;
        for feeds in [false, true] {
            let colour = if feeds { PATH } else { RAPID };
            let pieces = self.points.chunk_by(|a, b| a.counts[0] == b.counts[0]);
            let pieces = pieces.filter(|it| it.first().is_some_and(|it| it.counts[0] == feeds));
            for piece in pieces {
                let path = piece.iter().map(|point| view.on_path(point, 0));
                polyline(&mut out, colour, path)?;
            }
        }
        let mut x = MARGIN;
        for (which, (colour, name)) in COLOURS.into_iter().zip(NAMES).enumerate() {
            let finite = |point: &PlotPoint| size2(&point.off[which]).is_finite();
            if !self.points.iter().any(finite) {
                continue;
            }
            let y = CAPTION - 10.0;
            writeln!(
                out,
                "<text x=\"{x}\" y=\"{y}\" fill=\"{colour}\">{name}</text>"
            )?;
            x += 180.0;
            let pieces = self
                .points
                .chunk_by(|a, b| a.counts[which] == b.counts[which]);
            for piece in pieces.filter(|it| it.first().is_some_and(|it| it.counts[which])) {
                let off = piece.iter().map(|point| view.off_path(point, which));
                polyline(&mut out, colour, off)?;
            }
        }
        if let Some((point, which)) = &self.errors.worst {
            let (x, y) = view.off_path(point, *which);
            writeln!(
                out,
                "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"6\" fill=\"none\" stroke=\"{WORST}\"/>"
            )?;
        }
        writeln!(out, "</svg>")
    }
}

/// Height of what stands above a picture.
const CAPTION: f64 = 70.0;

/// Places of the picture: which axes are seen, and how large.
struct View {
    /// Axis to the right, and the one up.
    axes: [usize; 2],
    least: [f64; 2],
    most: [f64; 2],
    /// The larger reach, mm.
    extent: f64,
    /// Picture units by mm.
    scale: f64,
    /// How much larger errors are drawn than the path.
    enlarge: f64,
}

impl View {
    fn of(points: &[PlotPoint], errors: &Seen) -> Self {
        let mut least = [f64::INFINITY; 3];
        let mut most = [f64::NEG_INFINITY; 3];
        for point in points {
            for n in 0..3 {
                least[n] = least[n].min(point.path[0][n]);
                most[n] = most[n].max(point.path[0][n]);
            }
        }
        let reach = |n: usize| (most[n] - least[n]).max(0.0);
        let mut order = [0, 1, 2];
        // The smallest is looked along; of equals Z.
        order.sort_by(|a, b| reach(*b).total_cmp(&reach(*a)));
        let mut axes = [order[0], order[1]];
        axes.sort_unstable();
        let extent = axes.map(reach).into_iter().fold(1e-6, f64::max);
        let shown = errors.largest_mm.min(SHOWN_RMS * errors.rms_mm());
        Self {
            axes,
            least: axes.map(|n| least[n]),
            most: axes.map(|n| most[n]),
            extent,
            scale: (WIDTH - 2.0 * MARGIN) / (extent * (1.0 + 2.0 * SHARE)),
            enlarge: round_down(SHARE * extent / shown.max(1e-9 * extent)),
        }
    }

    fn reach(&self) -> [f64; 2] {
        [0, 1].map(|n| (self.most[n] - self.least[n]).max(0.0))
    }

    fn height(&self) -> f64 {
        CAPTION + MARGIN + (self.reach()[1] + 2.0 * SHARE * self.extent) * self.scale
    }

    /// The largest error that is drawn in full, mm.
    fn limit_mm(&self) -> f64 {
        SHARE * self.extent / self.enlarge
    }

    fn caption(&self, errors: &Seen, out: &mut impl Write) -> io::Result<()> {
        let digits = super::figure::round_to_digits;
        let [across, up] = self.axes.map(|n| AXES[n]);
        let [wide, high] = self.reach().map(|it| digits(it, 6));
        let enlarge = self.enlarge;
        let largest = errors.largest_mm * 1e3;
        let limit = self.limit_mm() * 1e3;
        writeln!(
            out,
            "<text x=\"{MARGIN}\" y=\"20\">{across} to the right, {up} up; {wide} × {high} mm</text>"
        )?;
        let cut = if largest > limit {
            format!("; those beyond {} µm are cut there", digits(limit, 3))
        } else {
            String::new()
        };
        writeln!(
            out,
            "<text x=\"{MARGIN}\" y=\"40\">errors of feeds {enlarge} times as large, at most {largest:.2} µm (ring){cut}</text>"
        )
    }

    fn place(&self, at: [f64; 2]) -> (f64, f64) {
        (
            MARGIN + (at[0] - self.least[0] + SHARE * self.extent) * self.scale,
            CAPTION + (self.most[1] - at[1] + SHARE * self.extent) * self.scale,
        )
    }

    /// Where the programmed path is.
    fn on_path(&self, point: &PlotPoint, which: usize) -> (f64, f64) {
        self.place(self.axes.map(|n| point.path[which][n]))
    }

    /// Where the load is, its error enlarged.
    fn off_path(&self, point: &PlotPoint, which: usize) -> (f64, f64) {
        let size = size2(&point.off[which]).sqrt();
        let times = if size > self.limit_mm() {
            self.enlarge * self.limit_mm() / size
        } else {
            self.enlarge
        };
        let at = |n: usize| point.path[which][n] + times * point.off[which][n];
        self.place(self.axes.map(at))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(x: f64, off: f64, feed: bool) -> PlotPoint {
        PlotPoint {
            path: [[x, 0.0, 0.0]; 2],
            off: [[0.0, off, 0.0], [f64::NAN; 3]],
            counts: [feed, false],
        }
    }

    fn drawn(chart: &ContourChart) -> String {
        let mut text = Vec::new();
        chart.write(&mut text).unwrap();
        String::from_utf8(text).unwrap()
    }

    /// 100 mm of feed 1 µm off, one sample 100 µm off, and a rapid 1 mm off, which does not
    /// count: 0.06·100 mm for three times the root mean square of 3.3 µm is 606, so 500 times,
    /// up to 0.06·100 mm/500 = 12 µm.
    #[test]
    fn one_large_error_does_not_hide_the_others_and_rapids_do_not_count() {
        let mut chart = ContourChart::default();
        for index in 0..1000_u32 {
            let off = if index == 700 { 0.1 } else { 0.001 };
            chart.add(&point(f64::from(index) * 0.1, off, true));
        }
        chart.add(&point(99.9, 1.0, false));
        chart.add(&point(100.0, 1.0, false));
        let text = drawn(&chart);
        let caption = "errors of feeds 500 times as large, at most 100.00 µm (ring); those beyond \
                       12 µm are cut there";
        assert!(text.contains(caption), "{text:.600}");
        assert!(text.contains("X to the right, Y up; 100 × 0 mm"));
        // The feed, the rapid, and the load along the feed alone.
        assert_eq!(text.matches("<polyline").count(), 3);
        assert!(!text.contains("with correction<"), "{text:.900}");
    }
}
