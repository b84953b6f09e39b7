//! What `limit` certifies fits when it is read again, and what it does not
//! certify has a reason.
//!
//! The first byte selects machine and options, the rest is the program.
#![no_main]

use std::sync::OnceLock;

use gwatt::machine::{Machine, builtin};
use gwatt::pipeline::{Law, LimitOptions, Options, Start, Strategy, analyze, limit};
use libfuzzer_sys::fuzz_target;

fn machines() -> &'static [Machine] {
    static MACHINES: OnceLock<Vec<Machine>> = OnceLock::new();
    MACHINES.get_or_init(|| {
        builtin::machines()
            .iter()
            .map(|machine| match Machine::load(machine.name) {
                Ok((machine, _)) => machine,
                Err(errors) => panic!("{}: {errors:?}", machine.name),
            })
            .collect()
    })
}

fuzz_target!(|bytes: &[u8]| {
    let Some((&choice, program)) = bytes.split_first() else {
        return;
    };
    let choice = usize::from(choice);
    let machines = machines();
    let machine = &machines[choice % machines.len()];
    let choice = choice / machines.len();
    let options = Options {
        start: if choice & 16 == 0 {
            Options::default().start
        } else {
            Start::Unknown
        },
        ..Options::default()
    };
    let how = LimitOptions {
        strategy: [
            Strategy::Optimal,
            Strategy::Speed,
            Strategy::Accel,
            Strategy::Preset,
        ][choice & 3],
        law: Law::Exact,
        allow_feed: choice & 4 == 0,
    };
    let mut output = Vec::new();
    let Ok(summary) = limit(program, machine, &options, how, &mut output, None) else {
        return;
    };
    if !summary.certified {
        assert!(!summary.reasons.is_empty(), "no reason is given");
        return;
    }
    match analyze(&output[..], machine, &options, None) {
        Ok(after) => {
            assert!(after.fits(), "the result does not fit: {:?}", after.worst);
            let (told, found) = (summary.after.duration_s, after.duration_s);
            assert!((told - found).abs() <= 1e-9 * found.abs().max(1.0));
        }
        Err(failure) => panic!("the result is refused: {failure:?}"),
    }
});
