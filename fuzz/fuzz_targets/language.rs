//! Expressions and flow: whatever the program, its run ends, within its limits,
//! in moves or in a message.
//!
//! The first byte selects the machine; the rest is the program.
#![no_main]

use std::io::Cursor;
use std::sync::OnceLock;

use gwatt::machine::Machine;
use gwatt::pipeline::{Failure, Limits, Options, Reading, moves};
use libfuzzer_sys::fuzz_target;

/// LinuxCNC's language, and Fanuc's.
fn machines() -> &'static [Machine] {
    static MACHINES: OnceLock<Vec<Machine>> = OnceLock::new();
    MACHINES.get_or_init(|| {
        ["linuxcnc-mill", "vmc"]
            .into_iter()
            .filter_map(|name| Machine::load(name).ok().map(|(machine, _)| machine))
            .collect()
    })
}

const LIMITS: Limits = Limits {
    depth: 8,
    repeated_moves: 500,
    idle_lines: 2000,
};

fuzz_target!(|bytes: &[u8]| {
    let Some((&machine, program)) = bytes.split_first() else {
        return;
    };
    let machines = machines();
    let machine = &machines[usize::from(machine) % machines.len()];
    let options = Options {
        reading: Reading {
            limits: LIMITS,
            ..Reading::default()
        },
        ..Options::default()
    };
    let mut count = 0;
    let run = moves(Cursor::new(program), machine, &options, &mut |mv, _| {
        count += 1;
        assert!(mv.end.iter().all(|value| value.is_finite()), "{mv:?}");
        Ok(())
    });
    // A line moves at most a few times in its first run.
    let lines = program.split(|byte| matches!(byte, b'\n' | b'\r')).count() as u64;
    let most = LIMITS.repeated_moves + 100 * (lines + 1);
    assert!(count <= most, "{count} moves");
    if let Err(Failure::Refused { diagnostics, .. }) = run {
        assert!(!diagnostics.is_empty(), "no reason is given");
        for found in diagnostics {
            let _ = found.render("fuzz.ngc", false);
        }
    }
});
