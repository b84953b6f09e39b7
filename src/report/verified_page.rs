//! A recording over its prediction as a page: the verdict, what was found, both curves, and the
//! blocks. One file without scripts and without a network.

use std::io::{self, Write};

use super::html::escaped;
use super::overlay_chart::OverlayChart;
use super::quantity::power;
use super::tune_page::STYLE;
use super::verified::{VerifiedNames, verified_text, worst};
use crate::identify::overlay::{Agreement, Overlay, PowerTrace};

/// Blocks in the table: those that draw most above their prediction.
const ROWS: usize = 200;
/// Names of files may be long; the picture is drawn on white, and scrolls where there is little
/// room.
const OWN_STYLE: &str = "h1 { overflow-wrap: anywhere; } \
                         figure { margin: 0; background: white; overflow-x: auto; } \
                         figure svg { min-width: 44rem; max-width: none; }";

/// Writes the page.
///
/// # Errors
/// Those of `out`.
pub fn verified_page(
    names: &VerifiedNames,
    overlay: &Overlay,
    log: &PowerTrace,
    out: &mut dyn Write,
) -> io::Result<()> {
    let agreement = overlay.agreement();
    let class = if agreement == Agreement::Good {
        "good"
    } else {
        "bad"
    };
    let [program, log_name] = [&names.program, &names.log].map(|name| escaped(name));
    write!(
        out,
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{program}: {} (gwatt verify)</title>\n<style>\n{}\n{OWN_STYLE}\n</style>\n\
         </head>\n<body>\n<header>\n<h1>{program} and {log_name}</h1>\n\
         <p class=\"{class}\">Verdict: {}</p>\n</header>\n<main>\n\
         <pre tabindex=\"0\" aria-label=\"What was found\">{}</pre>\n\
         <h2>Power over time</h2>\n<figure tabindex=\"0\" aria-label=\"Measured power over \
         the prediction\">\n",
        agreement.name(),
        STYLE.trim_end(),
        agreement.name(),
        escaped(verified_text(names, overlay).trim_end()),
    )?;
    OverlayChart::new(overlay, log).write(&mut *out)?;
    let blocks = worst(overlay);
    write!(
        out,
        "</figure>\n<h2>Blocks that draw most above their prediction</h2>\n\
         <section tabindex=\"0\" aria-label=\"Blocks\">\n<table>\n<thead><tr>"
    )?;
    for name in [
        "line",
        "runs",
        "begins, s",
        "measured",
        "predicted",
        "measured by predicted",
    ] {
        write!(out, "<th scope=\"col\">{name}</th>")?;
    }
    writeln!(out, "</tr></thead>\n<tbody>")?;
    for block in blocks.iter().take(ROWS) {
        writeln!(
            out,
            "<tr><th scope=\"row\">{}</th><td>{}</td><td>{:.3}</td><td>{}</td><td>{}</td>\
             <td>{:.3}</td></tr>",
            block.block,
            block.runs,
            block.start_s,
            power(block.measured_w),
            power(block.predicted_w),
            block.measured_by_predicted(),
        )?;
    }
    writeln!(out, "</tbody>\n</table>\n</section>")?;
    if let Some(more) = blocks.len().checked_sub(ROWS).filter(|more| *more > 0) {
        writeln!(out, "<p>And {more} more: --csv has all of them.</p>")?;
    }
    writeln!(out, "</main>\n</body>\n</html>")
}
