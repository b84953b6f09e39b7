//! What the pictures of contour errors share: polylines on a white page, without any text of the
//! user's.

use std::fmt::Write as _;
use std::io::{self, Write};

/// Of what is programmed.
pub(super) const PATH: &str = "#999999";
/// Without correction, and with it.
pub(super) const COLOURS: [&str; 2] = ["#b3541e", "#3a7d44"];
/// See [`COLOURS`].
pub(super) const NAMES: [&str; 2] = ["without correction", "with correction"];

/// The head of a picture.
pub(super) fn begin(out: &mut impl Write, width: f64, height: f64) -> io::Result<()> {
    writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height:.0}\" \
         font-family=\"sans-serif\" font-size=\"12\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>"
    )
}

/// A line; points that are the same as the last, or nowhere, are left out.
pub(super) fn polyline(
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
pub(super) fn round_down(value: f64) -> f64 {
    if !(value > 0.0 && value.is_finite()) {
        return 1.0;
    }
    let power = libm::pow(10.0, libm::floor(libm::log10(value)));
    let digit = [5.0, 2.0, 1.0]
        .into_iter()
        .find(|digit| digit * power <= value);
    super::figure::round_to_digits(digit.unwrap_or(1.0) * power, 6)
}
