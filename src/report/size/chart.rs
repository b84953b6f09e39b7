//! Sizing as a picture: loss of time over the converter's rating, both by equal
//! factors, what must be taken back below it, and the same over the capacitance.
//!
//! The drawing is polylines with axes and holds no text of the user's.

use std::fmt::Write as _;
use std::io::{self, Write};

use super::{Step, is_no_matter, rungs, title, value};
use crate::pipeline::size::{Curve, Quantity, Rung, Size, Sizing};
use crate::report::quantity::{duration, power};

const WIDTH: f64 = 900.0;
const LEFT: f64 = 80.0;
const RIGHT: f64 = 120.0;
const TOP: f64 = 80.0;
const LOSSES: f64 = 300.0;
const REGEN: f64 = 120.0;
const GAP: f64 = 60.0;
/// Losses that are drawn, in percent: smaller ones lie on the floor.
const FLOOR: f64 = 0.01;
/// Marks that stand nearer to each other than this are not written.
const APART: f64 = 52.0;
const CURVE: &str = "#1f5fa8";
const REGEN_CURVE: &str = "#b3541e";
const OWN: &str = "#3a7d44";
const WISHED: &str = "#a4161a";
const GRID: &str = "#dddddd";
const CLOSED: &str = "#eeeeee";

/// Draws the sizing.
///
/// # Errors
/// Those of `out`.
pub fn size_chart(size: &Size, mut out: impl Write) -> io::Result<()> {
    let sizings = [Some(&size.rating), size.capacitance.as_ref()];
    let drawn: Vec<(&Sizing, &Curve)> = sizings
        .into_iter()
        .flatten()
        .filter_map(|sizing| Some((sizing, sizing.curve.as_ref()?)))
        .filter(|(sizing, curve)| !is_no_matter(sizing.quantity, curve))
        .collect();
    let each = TOP + LOSSES + GAP + REGEN + GAP;
    let height = each * drawn.len().max(1) as f64;
    writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height}\" \
         font-family=\"sans-serif\" font-size=\"12\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>"
    )?;
    for (index, (sizing, curve)) in drawn.iter().enumerate() {
        let panel = Panel::new(sizing.quantity, curve, each * index as f64);
        out.write_all(panel.draw().as_bytes())?;
    }
    if drawn.is_empty() {
        writeln!(
            out,
            "<text x=\"{LEFT}\" y=\"{TOP}\">no program can be sized</text>"
        )?;
    }
    writeln!(out, "</svg>")?;
    out.flush()
}

/// Places by equal factors.
#[derive(Debug, Clone, Copy)]
struct LogScale {
    least: f64,
    most: f64,
    from: f64,
    to: f64,
}

impl LogScale {
    fn at(&self, value: f64) -> f64 {
        let span = libm::log(self.most / self.least);
        let share = libm::log(value.max(self.least) / self.least) / span;
        self.from + share.min(1.0) * (self.to - self.from)
    }

    /// Round values within the scale.
    fn marks(&self, digits: &[f64]) -> Vec<f64> {
        let first = libm::floor(libm::log10(self.least)) as i32;
        let decades = (first..first + 20).map(|exponent| libm::pow(10.0, f64::from(exponent)));
        let marks = decades.flat_map(|decade| digits.iter().map(move |digit| digit * decade));
        let within = |mark: &f64| *mark >= self.least * 0.999 && *mark <= self.most * 1.001;
        marks.filter(within).collect()
    }
}

/// One quantity.
struct Panel<'a> {
    quantity: Quantity,
    curve: &'a Curve,
    top: f64,
    x: LogScale,
    loss: LogScale,
}

impl<'a> Panel<'a> {
    fn new(quantity: Quantity, curve: &'a Curve, offset: f64) -> Self {
        let top = offset + TOP;
        let certified = rungs(curve).into_iter().map(|(_, rung)| rung);
        let certified = certified.filter(|rung| rung.total.certified);
        let worst = certified.map(|rung| 100.0 * rung.loss).fold(1.0, f64::max);
        let own = curve
            .own
            .value
            .clamp(0.5 * curve.lowest, 2.0 * curve.enough);
        let (least, most) = (curve.lowest.min(own), curve.enough.max(own));
        Self {
            quantity,
            curve,
            top,
            x: LogScale {
                least: least / 1.1,
                most: most * 1.1,
                from: LEFT,
                to: WIDTH - RIGHT,
            },
            loss: LogScale {
                least: FLOOR,
                most: 1.2 * worst,
                from: top + LOSSES,
                to: top,
            },
        }
    }

    fn draw(&self) -> String {
        let mut text = String::new();
        let regen_top = self.top + LOSSES + GAP;
        for (top, height) in [(self.top, LOSSES), (regen_top, REGEN)] {
            self.closed(&mut text, top, height);
            self.value_grid(&mut text, top, top + height);
        }
        self.loss_grid(&mut text);
        let _ = writeln!(
            text,
            "<text x=\"{LEFT}\" y=\"{}\" font-weight=\"bold\">loss of time over {}</text>\
             <text x=\"{}\" y=\"{}\" fill=\"#555555\">cycle time</text>",
            self.top - 50.0,
            title(self.quantity),
            WIDTH - RIGHT + 8.0,
            self.top - 14.0
        );
        self.line(&mut text, CURVE, |rung| self.loss.at(100.0 * rung.loss));
        self.regen(&mut text, regen_top);
        self.marked(&mut text);
        text
    }

    /// Where nothing is certified.
    fn closed(&self, text: &mut String, top: f64, height: f64) {
        let width = self.x.at(self.curve.lowest) - LEFT;
        let _ = writeln!(
            text,
            "<rect x=\"{LEFT}\" y=\"{top}\" width=\"{width:.2}\" height=\"{height}\" \
             fill=\"{CLOSED}\"/>"
        );
    }

    fn loss_grid(&self, text: &mut String) {
        let right = WIDTH - RIGHT;
        for mark in self.loss.marks(&[1.0]) {
            let y = self.loss.at(mark);
            let percent = super::digits(mark);
            let at = if mark <= FLOOR * 1.01 { "≤ " } else { "" };
            let time = duration(self.curve.duration_s * (1.0 + mark / 100.0));
            let _ = writeln!(
                text,
                "<path d=\"M{LEFT} {y:.2}H{right}\" stroke=\"{GRID}\"/>\
                 <text x=\"{}\" y=\"{:.2}\" text-anchor=\"end\">{at}{percent} %</text>\
                 <text x=\"{}\" y=\"{:.2}\" fill=\"#555555\">{time}</text>",
                LEFT - 6.0,
                y + 4.0,
                right + 8.0,
                y + 4.0
            );
        }
    }

    fn value_grid(&self, text: &mut String, top: f64, bottom: f64) {
        let few = self.x.most / self.x.least < 3.0;
        let digits: &[f64] = if few {
            &[1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0]
        } else {
            &[1.0, 2.0, 3.0, 5.0]
        };
        let mut last = f64::NEG_INFINITY;
        for mark in self.x.marks(digits) {
            let x = self.x.at(mark);
            let _ = write!(
                text,
                "<path d=\"M{x:.2} {top}V{bottom}\" stroke=\"{GRID}\"/>"
            );
            if x - last >= APART {
                let shown = value(self.quantity, mark);
                let _ = write!(
                    text,
                    "<text x=\"{x:.2}\" y=\"{}\" text-anchor=\"middle\">{shown}</text>",
                    bottom + 15.0
                );
                last = x;
            }
            text.push('\n');
        }
    }

    /// What is drawn, from the smallest value on.
    fn drawn(&self) -> Vec<&'a Rung> {
        let mut drawn: Vec<&Rung> = rungs(self.curve)
            .into_iter()
            .map(|(_, rung)| rung)
            .collect();
        drawn.retain(|rung| (self.x.least..=self.x.most).contains(&rung.value));
        drawn.reverse();
        drawn.dedup_by_key(|rung| rung.value.to_bits());
        drawn
    }

    /// A line through what is certified; the rest interrupts it.
    fn line(&self, text: &mut String, colour: &str, y: impl Fn(&Rung) -> f64) {
        for run in self.drawn().split(|rung| !rung.total.certified) {
            let points: Vec<String> = run
                .iter()
                .map(|rung| format!("{:.2},{:.2}", self.x.at(rung.value), y(rung)))
                .collect();
            let _ = writeln!(
                text,
                "<polyline fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.5\" points=\"{}\"/>",
                points.join(" ")
            );
        }
        for rung in self.drawn().into_iter().filter(|it| it.total.certified) {
            let _ = writeln!(
                text,
                "<circle cx=\"{:.2}\" cy=\"{:.2}\" r=\"2.5\" fill=\"{colour}\"/>",
                self.x.at(rung.value),
                y(rung)
            );
        }
    }

    /// The largest power that is fed back, from 0 up.
    fn regen(&self, text: &mut String, top: f64) {
        let certified = self.drawn().into_iter().filter(|it| it.total.certified);
        let powers = certified.map(|rung| rung.total.regen_w);
        let most = powers.fold(1.0, f64::max);
        let y = |power_w: f64| top + REGEN * (1.0 - power_w / (1.1 * most));
        let _ = writeln!(
            text,
            "<text x=\"{LEFT}\" y=\"{}\" font-weight=\"bold\">largest power fed back</text>",
            top - 10.0
        );
        for share in [0.0, 0.5, 1.0] {
            let at = y(share * most);
            let _ = writeln!(
                text,
                "<path d=\"M{LEFT} {at:.2}H{}\" stroke=\"{GRID}\"/>\
                 <text x=\"{}\" y=\"{:.2}\" text-anchor=\"end\">{}</text>",
                WIDTH - RIGHT,
                LEFT - 6.0,
                at + 4.0,
                power(share * most)
            );
        }
        self.line(text, REGEN_CURVE, |rung| y(rung.total.regen_w));
    }

    /// The values that have a meaning of their own: a line each, with its value above
    /// where there is room.
    fn marked(&self, text: &mut String) {
        let bottom = self.top + LOSSES;
        let mut taken: [f64; 2] = [f64::NEG_INFINITY; 2];
        let mut marks = rungs(self.curve);
        marks.reverse();
        for (step, rung) in marks {
            let (colour, name) = match step {
                Step::Ladder => continue,
                Step::Lowest => ("#555555", "lowest".to_owned()),
                Step::NothingSlowed => (CURVE, "nothing slowed".to_owned()),
                Step::Machine => (OWN, "machine file".to_owned()),
                Step::Loss(loss) => (WISHED, format!("{} %", super::digits(100.0 * loss))),
            };
            if rung.value < self.x.least || rung.value > self.x.most {
                continue;
            }
            let x = self.x.at(rung.value);
            let label = format!("{name}: {}", value(self.quantity, rung.value));
            let _ = write!(
                text,
                "<path d=\"M{x:.2} {}V{bottom}\" stroke=\"{colour}\" stroke-dasharray=\"4 3\"/>",
                self.top
            );
            let half = 3.4 * label.chars().count() as f64;
            let middle = x.clamp(LEFT + half, WIDTH - RIGHT - half);
            let row = taken.iter().position(|end| middle - half > *end + 8.0);
            if let Some(row) = row
                && let Some(end) = taken.get_mut(row)
            {
                *end = middle + half;
                let y = self.top - 10.0 - 16.0 * row as f64;
                let _ = write!(
                    text,
                    "<text x=\"{middle:.2}\" y=\"{y:.2}\" text-anchor=\"middle\" \
                     fill=\"{colour}\">{label}</text>"
                );
            }
            text.push('\n');
        }
    }
}
