//! Contour errors as pictures: the path with its errors enlarged, and circles.
//!
//! The drawings are polylines and hold no text of the user's.

use std::fmt::Write as _;
use std::io::{self, Write};

use crate::contour::{ArcResult, BINS, PlotPoint};

/// Points that can be distinguished; one more halves them.
const POINTS_MAX: usize = 8192;
const WIDTH: f64 = 900.0;
const MARGIN: f64 = 40.0;
/// The largest error is drawn as this share of the picture.
const SHARE: f64 = 0.06;
const PATH: &str = "#999999";
const COLOURS: [&str; 2] = ["#b3541e", "#3a7d44"];
const NAMES: [&str; 2] = ["without correction", "with correction"];
/// Size of a circle's picture.
const CELL: f64 = 300.0;
const COLUMNS: usize = 3;
const AXES: [char; 3] = ['X', 'Y', 'Z'];

/// Collects points in bounded memory, and draws them.
#[derive(Debug)]
pub struct ContourChart {
    points: Vec<PlotPoint>,
    /// Of so many samples one is kept: that with the largest error.
    step: u64,
    seen: u64,
}

impl Default for ContourChart {
    fn default() -> Self {
        Self {
            points: Vec::new(),
            step: 1,
            seen: 0,
        }
    }
}

fn size2(off: &[f64; 3]) -> f64 {
    off.iter().map(|d| d * d).sum()
}

fn worse(a: PlotPoint, b: PlotPoint) -> PlotPoint {
    if size2(&b.off[0]) > size2(&a.off[0]) {
        b
    } else {
        a
    }
}

impl ContourChart {
    /// Takes one more sample.
    pub fn add(&mut self, point: &PlotPoint) {
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

    /// Draws the two axes that reach farthest.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write(&self, mut out: impl Write) -> io::Result<()> {
        let mut least = [f64::INFINITY; 3];
        let mut most = [f64::NEG_INFINITY; 3];
        for point in &self.points {
            for n in 0..3 {
                least[n] = least[n].min(point.path[0][n]);
                most[n] = most[n].max(point.path[0][n]);
            }
        }
        let reach = |n: usize| (most[n] - least[n]).max(0.0);
        let mut order = [0, 1, 2];
        // The smallest is looked along; of equals Z.
        order.sort_by(|a, b| reach(*b).total_cmp(&reach(*a)));
        let mut shown = [order[0], order[1]];
        shown.sort_unstable();
        let [h, v] = shown;
        let extent = reach(h).max(reach(v)).max(1e-6);
        let largest = self
            .points
            .iter()
            .flat_map(|point| point.off)
            .map(|off| size2(&off))
            .filter(|size| size.is_finite())
            .fold(0.0, f64::max)
            .sqrt();
        let enlarge = round_down(SHARE * extent / largest.max(1e-9 * extent));
        let scale = (WIDTH - 2.0 * MARGIN) / (extent * (1.0 + 2.0 * SHARE));
        let place = |at: [f64; 2]| {
            (
                MARGIN + (at[0] - least[h] + SHARE * extent) * scale,
                MARGIN + 30.0 + (most[v] - at[1] + SHARE * extent) * scale,
            )
        };
        let height = 2.0 * MARGIN + 30.0 + (reach(v) + 2.0 * SHARE * extent) * scale;
        begin(&mut out, WIDTH, height)?;
        writeln!(
            out,
            "<text x=\"{MARGIN}\" y=\"20\">{} to the right, {} up; {:.4} mm wide; errors {enlarge} times as large, at most {:.2} µm</text>",
            AXES[h],
            AXES[v],
            extent,
            largest * 1e3
        )?;
        let path = self
            .points
            .iter()
            .map(|p| place([p.path[0][h], p.path[0][v]]));
        polyline(&mut out, PATH, path)?;
        let mut x = MARGIN;
        for (which, (colour, name)) in COLOURS.into_iter().zip(NAMES).enumerate() {
            let corrected = self.points.iter().any(|p| p.off[which][h].is_finite());
            if !corrected {
                continue;
            }
            writeln!(
                out,
                "<text x=\"{x}\" y=\"40\" fill=\"{colour}\">{name}</text>"
            )?;
            x += 180.0;
            let points = self.points.iter().map(|p| {
                place([
                    p.path[which][h] + enlarge * p.off[which][h],
                    p.path[which][v] + enlarge * p.off[which][v],
                ])
            });
            polyline(&mut out, colour, points)?;
        }
        writeln!(out, "</svg>")
    }
}

/// Circles with their errors enlarged, one picture each.
///
/// # Errors
/// Those of `out`.
pub fn circle_chart(arcs: &[ArcResult], mut out: impl Write) -> io::Result<()> {
    let columns = arcs.len().clamp(1, COLUMNS);
    let rows = arcs.len().div_ceil(columns).max(1);
    begin(&mut out, CELL * columns as f64, (CELL + 40.0) * rows as f64)?;
    if arcs.is_empty() {
        writeln!(
            out,
            "<text x=\"10\" y=\"20\">no arc is long enough for the load to settle</text>"
        )?;
    }
    for (index, arc) in arcs.iter().enumerate() {
        let left = CELL * (index % columns) as f64;
        let top = (CELL + 40.0) * (index / columns) as f64;
        circle(arc, left, top, &mut out)?;
    }
    writeln!(out, "</svg>")
}

fn circle(arc: &ArcResult, left: f64, top: f64, out: &mut impl Write) -> io::Result<()> {
    let (x, y) = (left + 0.5 * CELL, top + 40.0 + 0.5 * CELL);
    let drawn = 0.38 * CELL;
    let bins = arc.bins.each_ref().map(|bins| about_mean(bins));
    let largest = bins
        .iter()
        .flatten()
        .fold(0.0_f64, |most, (_, off)| most.max(off.abs()));
    // In picture units by mm.
    let per_mm = round_down(0.2 * drawn / largest.max(1e-7));
    writeln!(
        out,
        "<text x=\"{}\" y=\"{}\">line {}: radius {:.4} mm, about its mean; one ring {:.3} µm</text>",
        left + 10.0,
        top + 18.0,
        arc.line,
        arc.radius_mm,
        0.1 * drawn / per_mm * 1e3
    )?;
    for ring in -2..=1 {
        let r = drawn * (1.0 + 0.1 * f64::from(ring));
        let colour = if ring == 0 { PATH } else { "#dddddd" };
        writeln!(
            out,
            "<circle cx=\"{x}\" cy=\"{y}\" r=\"{r:.2}\" fill=\"none\" stroke=\"{colour}\"/>"
        )?;
    }
    for (colour, bins) in COLOURS.into_iter().zip(&bins) {
        let points = bins.iter().map(|(bin, off)| {
            let angle = std::f64::consts::TAU * (*bin as f64 + 0.5) / BINS as f64;
            let (sin, cos) = libm::sincos(angle);
            let r = drawn + off * per_mm;
            (x + r * cos, y - r * sin)
        });
        polyline(out, colour, points)?;
    }
    Ok(())
}

/// Bins that were met, less their mean: the shrinkage is given in words.
fn about_mean(bins: &[f32]) -> Vec<(usize, f64)> {
    let met = || {
        let all = bins.iter().enumerate();
        all.filter(|(_, off)| off.is_finite())
            .map(|(bin, off)| (bin, f64::from(*off)))
    };
    let mean = met().map(|(_, off)| off).sum::<f64>() / met().count().max(1) as f64;
    met().map(|(bin, off)| (bin, off - mean)).collect()
}

fn begin(out: &mut impl Write, width: f64, height: f64) -> io::Result<()> {
    writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height:.0}\" \
         font-family=\"sans-serif\" font-size=\"12\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>"
    )
}

fn polyline(
    out: &mut impl Write,
    colour: &str,
    points: impl Iterator<Item = (f64, f64)>,
) -> io::Result<()> {
    let mut text = String::new();
    let mut last = String::new();
    for (x, y) in points {
        let mut point = String::new();
        let _ = write!(point, "{x:.2},{y:.2} ");
        if point != last && x.is_finite() && y.is_finite() {
            text.push_str(&point);
            last = point;
        }
    }
    writeln!(
        out,
        "<polyline fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.2\" points=\"{}\"/>",
        text.trim_end()
    )
}

/// The next lower 1, 2 or 5 times a power of ten.
fn round_down(value: f64) -> f64 {
    if !(value > 0.0 && value.is_finite()) {
        return 1.0;
    }
    let power = libm::pow(10.0, libm::floor(libm::log10(value)));
    let digit = [5.0, 2.0, 1.0]
        .into_iter()
        .find(|digit| digit * power <= value);
    super::figure::round_to_digits(digit.unwrap_or(1.0) * power, 6)
}
