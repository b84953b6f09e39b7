//! The power over time as a still picture: SVG, a panel for each program.
//!
//! Areas are the planned power by axis and spindle, the line is the peak of each block as
//! the report has it. What comes from outside is written so that it is text and nothing else.

use std::fmt::Write as _;
use std::io::{self, Write};

use super::bars::Bar;
use super::columns_drawn::{self, Peaks};
use super::data::{channel_places, channels};
use super::picture_voltage;
use super::shares::Span;
use super::shown::Page;
use super::voltage::{overloads, voltages};
use crate::power::PowerModel;
use crate::report::chart::{Frame, Scale, grid};
use crate::report::quantity::{duration, power};

const WIDTH: f64 = 1000.0;
const PANEL: f64 = 260.0;
const LEFT: f64 = 80.0;
const RIGHT: f64 = 20.0;
const TOP: f64 = 80.0;
const GAP: f64 = 60.0;
const LIMIT: &str = "#b00020";
const OVERLOAD: &str = "#a04a00";
/// By axis, then spindle, cutting, base load and moves from an unknown start.
const COLOURS: [&str; 14] = [
    "#4269d0", "#e3891b", "#3a9d5d", "#c4457a", "#7a5ac2", "#1c9aa8", "#a0673a", "#6b8e23",
    "#b8860b", "#2f7f6f", "#8f6bb8", "#d65f4d", "#9a9a9a", "#d0cdbd",
];

/// Writes the picture.
pub(super) fn write(page: &Page<'_>, out: &mut dyn Write) -> io::Result<()> {
    let mut panels = vec![("Bus power", peaks_of(page, false), page.before)];
    if page.has_two() {
        panels[0].0 = "Before";
        panels.push(("After", peaks_of(page, true), page.after));
    }
    let all = || panels.iter().flat_map(|panel| &panel.1);
    let most_s = all().map(|it| it[1]).filter(|it| it.is_finite());
    let most_s = most_s.fold(0.0, f64::max).max(1e-9);
    for (_, peaks, _) in &mut panels {
        *peaks = columns_drawn::peaks(std::mem::take(peaks), most_s);
    }
    let all = || panels.iter().flat_map(|panel| &panel.1);
    let limits = lines(page);
    let (least_w, most_w) = extent(all().copied(), &limits);
    let room = 0.06 * (most_w - least_w);
    let volts = [false, true].map(|after| voltages(page, after && page.has_two()));
    let low = if volts.iter().all(Vec::is_empty) {
        0.0
    } else {
        picture_voltage::PANEL + GAP
    };
    let height = TOP + (PANEL + GAP + low) * panels.len() as f64;
    writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height}\" \
         font-family=\"sans-serif\" font-size=\"12\" role=\"img\">\n\
         <title>Bus power of {0} on {1}</title>\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n\
         <text x=\"{LEFT}\" y=\"24\" font-size=\"16\" font-weight=\"bold\">{0} on {1}</text>",
        escaped(page.program),
        escaped(&page.machine.name)
    )?;
    out.write_all(legend(page).as_bytes())?;
    for (index, ((name, peaks, series), volts)) in panels.into_iter().zip(&volts).enumerate() {
        let top = TOP + (PANEL + GAP + low) * index as f64;
        let time = Scale::new(0.0, most_s, LEFT, WIDTH - RIGHT);
        let value = Scale::new(least_w - room, most_w + room, top + PANEL, top);
        let frame = Frame {
            left: LEFT,
            right: WIDTH - RIGHT,
            top,
            bottom: top + PANEL,
            unit: " W",
        };
        let mut text = grid(&heading(name, &peaks), &frame, &time, &value);
        if let Some(series) = series {
            let spans = columns_drawn::spans(&series.spans, most_s);
            areas(&mut text, page, &spans, &time, &value);
        }
        outline(&mut text, &peaks, &time, &value);
        for line in &limits {
            line.draw(&mut text, &value);
        }
        if !volts.is_empty() {
            let frame = Frame {
                top: top + PANEL + GAP,
                bottom: top + PANEL + low,
                unit: " V",
                ..frame
            };
            let name = escaped(&picture_voltage::name(volts));
            text += &picture_voltage::panel(&name, volts, &frame, &time);
        }
        out.write_all(text.as_bytes())?;
    }
    writeln!(out, "</svg>")
}

/// The peaks of a program.
fn peaks_of(page: &Page<'_>, after: bool) -> Peaks {
    let bar = |it: &Bar| {
        let ([from_s, to_s], [drawn_w, back_w]) = if after {
            (it.after_s, it.most_after_w)
        } else {
            (it.span_s, it.most_w)
        };
        [from_s, to_s, drawn_w, back_w]
    };
    let mut peaks: Peaks = page.rows.bars.list.iter().map(bar).collect();
    // A move may wait for the spindle in one program and not in the other.
    peaks.sort_by(|a, b| a[0].total_cmp(&b[0]));
    peaks
}

/// From the least to the largest power of these peaks and lines, and no less than a watt.
fn extent(peaks: impl Iterator<Item = [f64; 4]>, lines: &[Line]) -> (f64, f64) {
    let powers = peaks.flat_map(|it| [it[2], -it[3]]);
    let powers = powers.chain(lines.iter().map(|line| line.power_w));
    let powers = powers.chain([0.0, 1.0]).filter(|it| it.is_finite());
    powers.fold((0.0, 0.0), |(least, most): (f64, f64), it| {
        (least.min(it), most.max(it))
    })
}

/// A power that is permitted, for ever or for a time.
struct Line {
    power_w: f64,
    label: String,
    lasts: bool,
}

impl Line {
    /// For ever, with its name on the right; for a time, on the left.
    fn draw(&self, text: &mut String, value: &Scale) {
        let y = value.at(self.power_w);
        let (colour, dashes) = if self.lasts {
            (LIMIT, "6 4")
        } else {
            (OVERLOAD, "2 4")
        };
        let (anchor, x) = if self.lasts {
            ("end", WIDTH - RIGHT - 4.0)
        } else {
            ("start", LEFT + 4.0)
        };
        let right = WIDTH - RIGHT;
        let _ = writeln!(
            text,
            "<path d=\"M{LEFT} {y:.2}H{right}\" stroke=\"{colour}\" stroke-dasharray=\"{dashes}\"/>\
             <text x=\"{x}\" y=\"{:.2}\" text-anchor=\"{anchor}\" fill=\"{colour}\" \
             stroke=\"white\" stroke-width=\"3\" paint-order=\"stroke\">{}</text>",
            y - 4.0,
            escaped(&self.label)
        );
    }
}

/// The limits of all converters, drawn up, fed back down, and the powers from which overload
/// counts.
fn lines(page: &Page<'_>) -> Vec<Line> {
    let model = PowerModel::new(page.machine);
    let converters = 0..page.machine.converters.len();
    let limits = converters.flat_map(|it| {
        let back = model.regen_limit_w(it).map(|limit_w| -limit_w);
        [Some(model.limit_w(it)), back]
    });
    let limit = |power_w: f64| Line {
        power_w,
        label: power(power_w),
        lasts: true,
    };
    let overload = |(power_w, label): (f64, String)| Line {
        power_w,
        label,
        lasts: false,
    };
    let limits = limits.flatten().filter(|it| it.is_finite()).map(limit);
    limits
        .chain(overloads(page).into_iter().map(overload))
        .collect()
}

fn heading(name: &str, peaks: &Peaks) -> String {
    let most_w = peaks.iter().fold(0.0, |most: f64, it| most.max(it[2]));
    let lasts_s = peaks.last().map_or(0.0, |it| it[1]);
    format!("{name}: peak {}, {}", power(most_w), duration(lasts_s))
}

/// Who is drawn in which colour.
fn legend(page: &Page<'_>) -> String {
    let mut text = String::new();
    let mut x = LEFT;
    let own = channels(page).into_iter().enumerate();
    let own = own.filter(|(index, _)| draws(page, *index));
    let own = own.map(|(index, name)| (colour(page, index), name));
    let line = [("#222222", "peak of the block (report)"), (LIMIT, "limit")];
    let overload = (!overloads(page).is_empty()).then_some((OVERLOAD, "overload counts above"));
    let line = line
        .into_iter()
        .chain(overload)
        .map(|(colour, name)| (colour, name.to_owned()));
    for (colour, name) in own.chain(line) {
        let _ = writeln!(
            text,
            "<rect x=\"{x}\" y=\"38\" width=\"12\" height=\"12\" fill=\"{colour}\"/>\
             <text x=\"{}\" y=\"48\">{}</text>",
            x + 17.0,
            escaped(&name)
        );
        x += 34.0 + 6.2 * name.chars().count() as f64;
    }
    text
}

/// Whether a channel ever draws or feeds back.
fn draws(page: &Page<'_>, index: usize) -> bool {
    let place = channel_places(page).get(index).copied().unwrap_or(0);
    let series = [page.before, page.after].into_iter().flatten();
    let mut spans = series.flat_map(|series| &series.spans);
    spans.any(|it| it.drawn.values_w[place] > 0.0 || it.back.values_w[place] < 0.0)
}

fn colour(page: &Page<'_>, index: usize) -> &'static str {
    let place = channel_places(page).get(index).copied().unwrap_or(0);
    COLOURS
        .get(place.saturating_sub(2))
        .copied()
        .unwrap_or("#9a9a9a")
}

/// The planned power by axis and spindle: what is drawn upwards, what is fed back down.
fn areas(text: &mut String, page: &Page<'_>, spans: &[Span], time: &Scale, value: &Scale) {
    let count = spans.len();
    let (mut up, mut down) = (vec![0.0; count], vec![0.0; count]);
    for (index, place) in channel_places(page).into_iter().enumerate() {
        let colour = colour(page, index);
        let drawn = |it: &Span| it.drawn.values_w[place].max(0.0);
        let back = |it: &Span| -(-it.back.values_w[place]).max(0.0);
        area(text, colour, spans, &mut up, drawn, (time, value));
        area(text, colour, spans, &mut down, back, (time, value));
    }
}

/// One area on top of those before it, whose edge moves on.
fn area(
    text: &mut String,
    colour: &str,
    spans: &[Span],
    edge: &mut [f64],
    own: impl Fn(&Span) -> f64,
    (time, value): (&Scale, &Scale),
) {
    let mut ahead = String::new();
    let mut way_back: Vec<String> = Vec::new();
    let mut any = false;
    for (span, edge) in spans.iter().zip(edge) {
        let inner = *edge;
        *edge += own(span);
        any |= inner != *edge;
        for t in [span.from_s, span.to_s] {
            let point = |w: f64| format!("{:.2},{:.2} ", time.at(t), value.at(w));
            let (outer, inner) = (point(*edge), point(inner));
            if way_back.last() != Some(&inner) || !ahead.ends_with(&outer) {
                ahead.push_str(&outer);
                way_back.push(inner);
            }
        }
    }
    if any {
        way_back.reverse();
        let _ = writeln!(
            text,
            "<polygon fill=\"{colour}\" fill-opacity=\"0.75\" points=\"{ahead}{}\"/>",
            way_back.concat()
        );
    }
}

/// The peak of each block, and what it feeds back.
fn outline(text: &mut String, peaks: &Peaks, time: &Scale, value: &Scale) {
    for (which, sign) in [(2, 1.0), (3, -1.0)] {
        let mut path = String::new();
        for peak in peaks.iter().filter(|it| it[which].is_finite()) {
            let letter = if path.is_empty() { 'M' } else { 'L' };
            let y = value.at(sign * peak[which]);
            let (from, to) = (time.at(peak[0]), time.at(peak[1]));
            let _ = write!(path, "{letter}{from:.2} {y:.2}H{to:.2}");
        }
        if !path.is_empty() {
            let _ = writeln!(
                text,
                "<path d=\"{path}\" fill=\"none\" stroke=\"#222222\"/>"
            );
        }
    }
}

/// Text in which no tag begins.
pub(in crate::report) fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '&' => safe.push_str("&amp;"),
            '"' => safe.push_str("&quot;"),
            other => safe.push(other),
        }
    }
    safe
}
