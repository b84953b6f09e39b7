//! Programs in, programs that fit out: `gwatt::pipeline` from the outside.

mod ahead;
mod blends;
mod called_cycles;
mod company;
mod cycles;
mod feed_modes;
mod figures;
mod firmware_moves;
mod first_feed;
mod flow_through;
mod halts;
mod ideal;
mod knobs;
mod jerk;
mod jumps;
mod klipper;
mod lathe;
mod left_feed;
mod levels;
mod lines;
mod languages;
mod marked;
mod no_word;
mod obstacles;
mod outputs;
mod pace;
mod own_words;
mod paced;
mod partial;
mod presets;
mod random;
mod rapid_percent;
mod reader;
mod returns;
mod rewriting;
mod rows;
mod same_moves;
mod shared_places;
mod split;
mod single_holes;
mod stop_words;
mod stops;
mod turned;
mod type_two;
mod waits;
mod ways;
mod whole;
mod within;
mod word_choice;
mod words_by_axis;

use gwatt::diagnostic::Diagnostic;
use gwatt::machine::Machine;
use gwatt::pipeline::{
    Allowed, Failure, Law, LimitOptions, LimitSummary, Options, Strategy, limit,
};

use crate::machines::{linear_axes, machine_from};

/// X and Y of 500 kg, 0.5 m/s and 5 m/s²: without friction an axis takes
/// 0.5 m/s · 500 kg · 5 m/s² = 1250 W at the end of its ramp.
#[derive(Clone, Copy)]
pub(crate) struct Rig {
    pub(crate) controller: &'static str,
    pub(crate) peak_w: f64,
    /// Further lines of the converter, of each axis, and at the end of the file.
    pub(crate) converter: &'static str,
    pub(crate) axis: &'static str,
    pub(crate) rest: &'static str,
    pub(crate) options: Run,
}

/// What is asked of a run.
#[derive(Clone, Copy)]
pub(crate) struct Run {
    pub(crate) strategy: Strategy,
    pub(crate) law: Law,
    pub(crate) allow_feed: bool,
    pub(crate) robust: bool,
    pub(crate) unknown_start: bool,
    pub(crate) threads: usize,
}

pub(crate) const RIG: Rig = Rig {
    controller: "iso",
    peak_w: 1000.0,
    converter: "",
    axis: "",
    rest: "",
    options: Run {
        strategy: Strategy::Optimal,
        law: Law::Exact,
        allow_feed: true,
        robust: false,
        unknown_start: false,
        threads: 1,
    },
};

/// Every block stops, whatever the controller does by itself.
pub(crate) const EXACT_STOP: &str = "[path]\nmode = \"exact-stop\"";

impl Rig {
    pub(crate) fn machine(&self) -> Machine {
        machine_from(&format!(
            "schema = 1\nname = \"rig\"\ncontroller = \"{}\"\n[converter]\npeak_power_w = {:?}\n{}\n{}\
             [limits]\nmargin = 0\n{}\n",
            self.controller,
            self.peak_w,
            self.converter,
            linear_axes("XY", [30000.0, 5000.0, 500.0], self.axis),
            self.rest
        ))
    }

    /// What `limit` makes of a program; only certified text may be delivered.
    pub(crate) fn limit(&self, program: &[u8]) -> Result<(Vec<u8>, LimitSummary), Failure> {
        run(&self.machine(), self.options, program)
    }

    /// The text of a program that was made to fit.
    pub(crate) fn fits(&self, program: &str) -> String {
        let (text, summary) = self.limit(program.as_bytes()).expect("a program");
        assert!(summary.certified, "{:?}", summary.reasons);
        assert!(summary.after.fits());
        String::from_utf8(text).expect("text")
    }

    /// Why a program could not be made to fit.
    pub(crate) fn reasons(&self, program: &str) -> Vec<Diagnostic> {
        let (_, summary) = self.limit(program.as_bytes()).expect("a program");
        assert!(!summary.certified);
        summary.reasons
    }

    /// The first reason for that, in one line.
    pub(crate) fn first_refusal(&self, program: &str) -> String {
        let found = self.refusal(program);
        let first = found.first().expect("a reason");
        format!("{}: {}", first.rule, first.message)
    }

    /// Why a program was refused.
    pub(crate) fn refusal(&self, program: &str) -> Vec<Diagnostic> {
        match self.limit(program.as_bytes()) {
            Err(Failure::Refused { diagnostics, .. }) => diagnostics,
            other => panic!("not refused: {other:?}"),
        }
    }

    pub(crate) fn strategy(self, strategy: Strategy) -> Self {
        let options = Run {
            strategy,
            ..self.options
        };
        Self { options, ..self }
    }
}

/// Runs `limit` and gives the text, certified or not.
pub(crate) fn run(
    machine: &Machine,
    run: Run,
    program: &[u8],
) -> Result<(Vec<u8>, LimitSummary), Failure> {
    let how = LimitOptions {
        strategy: run.strategy,
        law: run.law,
        allowed: Allowed {
            feed: run.allow_feed,
            ..Allowed::NOTHING
        },
        ..LimitOptions::USUAL
    };
    let mut text = Vec::new();
    let summary = limit(
        std::io::Cursor::new(program),
        machine,
        &options(run),
        how,
        &mut text,
        None,
    )?;
    Ok((text, summary))
}

pub(crate) fn options(run: Run) -> Options {
    let mut options = Options {
        threads: run.threads,
        ..Options::default()
    };
    if run.robust {
        options.certificate = Some(gwatt::pipeline::Certificate::Robust);
    }
    if run.unknown_start {
        options.reading.start = gwatt::pipeline::Start::Unknown;
    }
    options
}

/// Peak power and time of a program, by hand.
#[track_caller]
pub(crate) fn assert_figures(
    found: &gwatt::pipeline::Summary,
    peak_w: f64,
    duration_s: f64,
    program: impl std::fmt::Display,
) {
    let (found_w, found_s) = (found.peak_w, found.duration_s);
    assert!(
        (found_w - peak_w).abs() < 1e-6 * peak_w,
        "{program}: {found_w}"
    );
    assert!((found_s - duration_s).abs() < 1e-9, "{program}: {found_s}");
}
