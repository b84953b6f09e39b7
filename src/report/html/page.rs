//! A page: one file, no network.
//!
//! Everything that comes from outside stands in a block of JSON, in which nothing can end a
//! script; the script puts it into the page as text.

use std::io::{self, Write};

use super::data::data;
use super::lines::LineTexts;
use super::picture;
use super::rows::PageRows;
use super::shares::PageSeries;
use crate::machine::Machine;
use crate::pipeline::{LimitSummary, Summary};

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
const SCRIPTS: [&str; 5] = [
    include_str!("page/data.js"),
    include_str!("page/charts.js"),
    include_str!("page/space.js"),
    include_str!("page/tables.js"),
    include_str!("page/page.js"),
];

/// What a program came to.
#[derive(Debug, Clone, Copy)]
pub enum Found<'a> {
    /// It was looked at as it is.
    Report(&'a Summary),
    /// It was limited.
    Limit {
        /// What was done.
        summary: &'a LimitSummary,
        /// It is written though not all of it fits.
        partly: bool,
    },
}

/// A program in pictures.
#[derive(Debug, Clone, Copy)]
pub struct Page<'a> {
    /// Its name.
    pub program: &'a str,
    /// The machine that it runs on.
    pub machine: &'a Machine,
    /// What it came to.
    pub found: Found<'a>,
    /// Its rows.
    pub rows: &'a PageRows,
    /// Its planned power, where that is known.
    pub before: Option<&'a PageSeries>,
    /// That of the written program.
    pub after: Option<&'a PageSeries>,
    /// The text of its lines.
    pub texts: &'a LineTexts,
}

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

    /// Whether a written program is shown.
    pub(super) fn is_limited(&self) -> bool {
        matches!(self.found, Found::Limit { .. })
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
