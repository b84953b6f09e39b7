//! A page: one file, no network.
//!
//! Everything that comes from outside stands in a block of JSON, in which nothing can end a
//! script; the script puts it into the page as text.

use std::io::{self, Write};

use serde_json::Value;

use super::data::data;
use super::picture;
use super::shown::Page;

const PAGE: &str = include_str!("page/page.html");
const STYLE: &str = include_str!("page/page.css");
const CHART_STYLE: &str = include_str!("vendor/uPlot.min.css");
const CHART: &str = include_str!("vendor/uPlot.iife.min.js");
const SPACE: &str = include_str!("vendor/three.min.js");
const LICENCES: [&str; 4] = [
    "uPlot\n\n",
    include_str!("vendor/uPlot.LICENSE"),
    "\nthree.js\n\n",
    include_str!("vendor/three.LICENSE"),
];
const SCRIPTS: [&str; 7] = [
    include_str!("page/data.js"),
    include_str!("page/charts.js"),
    include_str!("page/voltage.js"),
    include_str!("page/overlay.js"),
    include_str!("page/space.js"),
    include_str!("page/tables.js"),
    include_str!("page/page.js"),
];

/// Where the data of a page stand.
const DATA: &str = "/*DATA*/";

impl Page<'_> {
    /// Writes the page.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_html(&self, out: &mut dyn Write) -> io::Result<()> {
        begin(out)?;
        self.write_data("data", out)?;
        end(out)
    }

    /// Its data, as an element of that name.
    pub(super) fn write_data(&self, id: &str, out: &mut dyn Write) -> io::Result<()> {
        element(id, &data(self), out)
    }

    /// Writes the power over time as a still picture (SVG).
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_svg(&self, out: &mut dyn Write) -> io::Result<()> {
        picture::write(self, out)
    }
}

/// The part of a page before the data.
pub(super) fn begin(out: &mut dyn Write) -> io::Result<()> {
    template(PAGE.split_once(DATA).map_or(PAGE, |it| it.0), out)
}

/// The part of a page after the data.
pub(super) fn end(out: &mut dyn Write) -> io::Result<()> {
    template(PAGE.split_once(DATA).map_or("", |it| it.1), out)
}

/// Data that the script finds by their name.
pub(super) fn element(id: &str, data: &Value, out: &mut dyn Write) -> io::Result<()> {
    let json = harmless(&data.to_string());
    write!(
        out,
        "<script type=\"application/json\" id=\"{id}\">{json}</script>"
    )
}

/// A part of a page, with styles and scripts in place of their marks.
fn template(part: &str, out: &mut dyn Write) -> io::Result<()> {
    let (licences, scripts) = (LICENCES.concat(), SCRIPTS.concat());
    let mut rest = part;
    for (mark, text) in [
        ("/*LICENCES*/", licences.as_str()),
        ("/*CHART_STYLE*/", CHART_STYLE),
        ("/*STYLE*/", STYLE),
        ("/*CHART*/", CHART),
        ("/*SPACE*/", SPACE),
        ("/*SCRIPT*/", scripts.as_str()),
    ] {
        if let Some((before, after)) = rest.split_once(mark) {
            out.write_all(before.as_bytes())?;
            out.write_all(text.trim_end().as_bytes())?;
            rest = after;
        }
    }
    out.write_all(rest.as_bytes())
}

/// JSON in which no tag can begin or end.
fn harmless(json: &str) -> String {
    let mut text = String::with_capacity(json.len());
    for letter in json.chars() {
        match letter {
            '<' => text.push_str("\\u003c"),
            '>' => text.push_str("\\u003e"),
            '&' => text.push_str("\\u0026"),
            '\u{2028}' => text.push_str("\\u2028"),
            '\u{2029}' => text.push_str("\\u2029"),
            other => text.push(other),
        }
    }
    text
}
