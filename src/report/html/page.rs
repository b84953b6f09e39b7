//! A page: one file, no network.
//!
//! Everything that comes from outside stands in a block of JSON, in which nothing can end a
//! script; the script puts it into the page as text.

use std::io::{self, Write};

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
const SCRIPTS: [&str; 6] = [
    include_str!("page/data.js"),
    include_str!("page/charts.js"),
    include_str!("page/overlay.js"),
    include_str!("page/space.js"),
    include_str!("page/tables.js"),
    include_str!("page/page.js"),
];

impl Page<'_> {
    /// Writes the page.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_html(&self, out: &mut dyn Write) -> io::Result<()> {
        let data = harmless(&data(self).to_string());
        let (licences, scripts) = (LICENCES.concat(), SCRIPTS.concat());
        let mut rest = PAGE;
        for (mark, text) in [
            ("/*LICENCES*/", licences.as_str()),
            ("/*CHART_STYLE*/", CHART_STYLE),
            ("/*STYLE*/", STYLE),
            ("/*DATA*/", data.as_str()),
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

    /// Writes the power over time as a still picture (SVG).
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_svg(&self, out: &mut dyn Write) -> io::Result<()> {
        picture::write(self, out)
    }
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
