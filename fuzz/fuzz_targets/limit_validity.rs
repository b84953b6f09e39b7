//! What `limit` certifies fits when it is read again and stays as it is when
//! limited again, and what it does not certify has a reason.
//!
//! The first four bytes select machine, controller profile and options; the
//! rest is the program.
#![no_main]

use std::sync::OnceLock;

use gwatt::machine::{Machine, builtin};
use gwatt::pipeline::{
    Allowed, Certificate, Law, LimitOptions, LimitSummary, Options, PresetElse, RapidMark, Reading,
    Start, Strategy, analyze, limit,
};
use libfuzzer_sys::fuzz_target;

const STRATEGIES: [Strategy; 4] = [
    Strategy::Optimal,
    Strategy::Speed,
    Strategy::Accel,
    Strategy::Preset,
];

/// Each built-in machine with each built-in profile that it can be used with.
fn machines() -> &'static [Machine] {
    static MACHINES: OnceLock<Vec<Machine>> = OnceLock::new();
    MACHINES.get_or_init(|| {
        let mut machines = Vec::new();
        for machine in builtin::machines() {
            if let Err(errors) = Machine::load(machine.name) {
                panic!("{}: {errors:?}", machine.name);
            }
            for profile in builtin::controllers() {
                let text = with_controller(machine.text, profile.name);
                machines.extend(Machine::from_toml(machine.name, &text).map(|(it, _)| it));
            }
        }
        machines
    })
}

/// The machine file with another controller.
fn with_controller(text: &str, profile: &str) -> String {
    text.lines()
        .map(|line| match line.starts_with("controller = ") {
            true => format!("controller = \"{profile}\"\n"),
            false => format!("{line}\n"),
        })
        .collect()
}

fuzz_target!(|bytes: &[u8]| {
    let Some((&[machine, strategy, options, threads], program)) = bytes.split_first_chunk() else {
        return;
    };
    let machines = machines();
    let machine = &machines[usize::from(machine) % machines.len()];
    let how = LimitOptions {
        strategy: STRATEGIES[usize::from(strategy & 3)],
        law: if strategy & 4 == 0 {
            Law::Exact
        } else {
            Law::Patent
        },
        allowed: Allowed {
            feed: strategy & 8 == 0,
            ..Allowed::NOTHING
        },
        always: strategy & 16 != 0,
        preset_else: if strategy & 32 == 0 {
            PresetElse::Refuse
        } else {
            PresetElse::Speed
        },
    };
    let options = Options {
        once: false,
        rapid_mark: (options & 8 != 0).then(RapidMark::default),
        reading: Reading {
            start: if options & 1 == 0 {
                Reading::default().start
            } else {
                Start::Unknown
            },
            block_delete: if options & 2 == 0 {
                gwatt::interpret::BlockDelete::NONE
            } else {
                gwatt::interpret::BlockDelete::ALL
            },
            ..Reading::default()
        },
        certificate: match options >> 2 & 3 {
            0 | 1 => None,
            2 => Some(Certificate::Planned),
            _ => Some(Certificate::Robust),
        },
        threads: 1 + usize::from(threads & 1),
        count: None,
    };
    let run = |program: &[u8], options: &Options| -> Option<(Vec<u8>, LimitSummary)> {
        let mut output = Vec::new();
        let summary = limit(std::io::Cursor::new(program), machine, options, how, &mut output, None).ok()?;
        Some((output, summary))
    };
    let Some((output, summary)) = run(program, &options) else {
        return;
    };
    if options.threads > 1 {
        let single = run(
            program,
            &Options {
                threads: 1,
                ..options.clone()
            },
        );
        assert!(
            single == Some((output.clone(), summary.clone())),
            "threads change the result"
        );
    }
    if !summary.certified {
        assert!(!summary.reasons.is_empty(), "no reason is given");
        for reason in &summary.reasons {
            let _ = reason.render("fuzz.ngc", false);
            // A fault of the analysis or of the edits, never of the program.
            assert!(
                !matches!(
                    reason.rule,
                    "changed-sequence" | "changed-feed" | "went-up" | "unreadable-output"
                ),
                "the rewritten program differs: {reason:?}"
            );
        }
        return;
    }
    match analyze(std::io::Cursor::new(&output), machine, &options, None) {
        Ok(after) => {
            assert!(after.fits(), "the result does not fit: {:?}", after.worst);
            let (shown, found) = (summary.after.duration_s, after.duration_s);
            assert!((shown - found).abs() <= 1e-9 * found.abs().max(1.0));
        }
        Err(failure) => panic!("the result is refused: {failure:?}"),
    }
    let Some((again, _)) = run(&output, &options) else {
        panic!("the result cannot be limited again");
    };
    assert!(
        again == output,
        "limiting again changes the result:\n{}\n---\n{}",
        output.escape_ascii(),
        again.escape_ascii()
    );
});
