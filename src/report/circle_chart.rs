//! Circles as pictures: how round the load runs.

use std::io::{self, Write};

use super::drawing::{COLOURS, NAMES, PATH, begin, polyline, round_down};
use crate::contour::{ArcResult, BINS};

/// Size of a circle's picture.
const CELL: f64 = 300.0;
const COLUMNS: usize = 3;
/// Height of the names of the lines above all circles.
const LEGEND: f64 = 30.0;

/// Circles with their errors enlarged, one picture each.
///
/// # Errors
/// Those of `out`.
pub fn circle_chart(arcs: &[ArcResult], mut out: impl Write) -> io::Result<()> {
    let columns = arcs.len().clamp(1, COLUMNS);
    let rows = arcs.len().div_ceil(columns).max(1);
    let width = CELL * columns as f64;
    begin(&mut out, width, LEGEND + (CELL + 40.0) * rows as f64)?;
    let corrected = arcs
        .iter()
        .any(|arc| arc.bins[1].iter().any(|off| off.is_finite()));
    let names = COLOURS
        .into_iter()
        .zip(NAMES)
        .take(1 + usize::from(corrected));
    for ((colour, name), x) in names.zip([10.0, 150.0]).filter(|_| !arcs.is_empty()) {
        writeln!(
            out,
            "<text x=\"{x}\" y=\"20\" fill=\"{colour}\">{name}</text>"
        )?;
    }
    if arcs.is_empty() {
        writeln!(
            out,
            "<text x=\"10\" y=\"20\">no arc is long enough for the load to settle</text>"
        )?;
    }
    for (index, arc) in arcs.iter().enumerate() {
        let left = CELL * (index % columns) as f64;
        let top = LEGEND + (CELL + 40.0) * (index / columns) as f64;
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
    let digits = super::figure::round_to_digits;
    let (radius, ring) = (
        digits(arc.radius_mm, 6),
        digits(0.1 * drawn / per_mm * 1e3, 3),
    );
    let lines = [
        format!("line {}, radius {radius} mm", arc.line),
        format!("about its mean; rings {ring} µm apart"),
    ];
    for (line, y) in lines.iter().zip([18.0, 34.0]) {
        writeln!(
            out,
            "<text x=\"{}\" y=\"{}\">{line}</text>",
            left + 10.0,
            top + y
        )?;
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    /// No caption reaches into the next picture, or beyond the page: 12 letters of 12 units
    /// take less than 80.
    #[test]
    fn captions_of_circles_stay_in_their_pictures() {
        let arc = ArcResult {
            line: 1_234_567,
            run: 1,
            plane: [0, 1],
            radius_mm: 1_234.567_89,
            speed_mm_s: 50.0,
            roundness: [None, None],
            bins: [vec![0.001_234_5; BINS], vec![-0.001; BINS]],
        };
        let mut text = Vec::new();
        circle_chart(&vec![arc; 5], &mut text).unwrap();
        let text = String::from_utf8(text).unwrap();
        assert!(text.contains(">line 1234567, radius 1234.57 mm</text>"));
        assert!(text.contains(">with correction</text>"));
        let captions = text.split("<text ").skip(1);
        for caption in captions.filter_map(|it| it.split('>').nth(1)) {
            let letters = caption.trim_end_matches("</text").chars().count();
            assert!(letters as f64 * 80.0 / 12.0 < CELL - 10.0, "{caption}");
        }
    }
}
