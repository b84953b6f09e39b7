//! Makes a program fit that is given as text.
//!
//! `cargo run --example 3_limit_a_string`

use gwatt::pipeline::{Allowed, LimitOptions};
use gwatt::{Limit, Machine};

const PROGRAM: &str = "G21 G90
(three axes start together)
G0 X400 Y300 Z-200
G1 X0 F1200
M30
";

fn main() -> Result<(), gwatt::Error> {
    let (machine, _warnings) = Machine::load("three-axis")?;
    let before = gwatt::check(PROGRAM, &machine)?;
    println!(
        "before: {:.0} W in line {}",
        before.peak_w, before.peak_line
    );
    // Rapids may always become slower; cutting feeds where that is said.
    let limit = Limit {
        how: LimitOptions {
            allowed: Allowed {
                feed: true,
                ..Allowed::NOTHING
            },
            ..Limit::default().how
        },
        ..Limit::default()
    };
    let limited = limit.run(PROGRAM, &machine)?;
    let after = &limited.summary.after;
    println!(
        "after: {:.0} W, {:.2} s longer\n",
        after.peak_w,
        after.duration_s - before.duration_s
    );
    print!("{}", String::from_utf8_lossy(limited.text()));
    Ok(())
}
