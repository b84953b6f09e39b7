//! What the moves of a program draw, the worst first.
//!
//! `cargo run --example 2_what_does_this_draw [PROGRAM [MACHINE]]`

use std::error::Error;

use gwatt::Machine;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next();
    let path = path.as_deref().unwrap_or("examples/simultaneous-start.ngc");
    let name = arguments.next();
    let (machine, _warnings) =
        Machine::load(name.as_deref().unwrap_or("three-axis")).map_err(gwatt::Error::from)?;
    let report = gwatt::report(std::fs::read(path)?, &machine)?;
    let summary = &report.summary;
    println!(
        "{path}: {:.1} s, peak {:.0} W in line {}, {:.1} Wh drawn",
        summary.duration_s,
        summary.peak_w,
        summary.peak_line,
        summary.energy_j.unwrap_or(0.0) / 3600.0,
    );
    let mut rows = report.rows;
    rows.sort_by(|a, b| b.peak_w.total_cmp(&a.peak_w));
    for row in rows.iter().take(5) {
        println!(
            "  line {:3}: {:4} start together at {:6.2} s and draw {:5.0} W of {:.0} W",
            row.line,
            row.axes.to_string(),
            row.start_s,
            row.peak_w,
            row.limit_w,
        );
    }
    Ok(())
}
