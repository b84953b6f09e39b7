//! What a printer's lines do, for the tests of this folder.

use crate::{Diagnostics, Effects, Facts, Interpreter, Reading};
use gwatt_machine::Machine;
use gwatt_motion::Step;
use gwatt_syntax::{Block, scan_line};

/// The steps of lines on a machine with X, and what is said of them; `rest` is added to its file.
pub(super) fn execute(controller: &str, rest: &str, lines: &[&str]) -> (Vec<Step>, Diagnostics) {
    let text = format!(
        "schema = 1\nname = \"t\"\ncontroller = \"{controller}\"\n[converter]\npeak_power_w = 500\n\
         [axes.X]\nrapid_mm_min = 6000\naccel_mm_s2 = 500\nmass_kg = 5\n{rest}"
    );
    let (machine, _) = Machine::from_toml("t.toml", &text).unwrap();
    let mut interpreter = Interpreter::new(&machine, &Reading::default());
    let (mut all, mut diagnostics) = (Vec::new(), Diagnostics::default());
    for (number, line) in (1..).zip(lines) {
        let (mut block, mut facts, mut steps) = (Block::default(), Facts::default(), Vec::new());
        scan_line(line.as_bytes(), number == 1, &mut block);
        let effects = Effects::new(&mut steps, &mut facts, &mut diagnostics);
        interpreter.execute(number, line.as_bytes(), &mut block, effects);
        all.append(&mut steps);
    }
    (all, diagnostics)
}
