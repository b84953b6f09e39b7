//! Programs run through the library: what is read, what it takes, and what `limit` writes.

use std::io::Cursor;

use gwatt::interpret::Move;
use gwatt::machine::{Machine, OverrideAt};
use gwatt::pipeline::{
    Allowed, Failure, LimitOptions, LimitSummary, Options, Row, Summary, analyze, limit, moves,
};

use crate::rows::Rows;

/// Cutting feeds may be lowered.
pub(crate) const FEEDS: Allowed = Allowed {
    feed: true,
    ..Allowed::NOTHING
};

/// As usual, with cutting feeds.
pub(crate) const WITH_FEEDS: LimitOptions = LimitOptions {
    allowed: FEEDS,
    ..LimitOptions::USUAL
};

/// One run of the program.
pub(crate) fn once() -> Options {
    Options {
        once: true,
        ..Options::default()
    }
}

/// What a program takes.
#[track_caller]
pub(crate) fn summary_of(machine: &Machine, program: &str) -> Summary {
    let summary = analyze(Cursor::new(program), machine, &Options::default(), None);
    summary.unwrap_or_else(|failure| panic!("{failure:?}\n{program}"))
}

/// The rows of a program.
#[track_caller]
pub(crate) fn rows_of(machine: &Machine, program: &str) -> Vec<Row> {
    rows_with(machine, &Options::default(), program)
}

/// The same with options.
#[track_caller]
pub(crate) fn rows_with(machine: &Machine, options: &Options, program: &str) -> Vec<Row> {
    let mut rows = Rows::default();
    let summary = analyze(Cursor::new(program), machine, options, Some(&mut rows));
    summary.unwrap_or_else(|failure| panic!("{failure:?}\n{program}"));
    rows.0
}

/// What `limit` writes, certified or not.
pub(crate) fn limited(
    machine: &Machine,
    options: &Options,
    how: LimitOptions,
    program: &str,
) -> Result<(String, LimitSummary), Failure> {
    let mut text = Vec::new();
    let summary = limit(Cursor::new(program), machine, options, how, &mut text, None)?;
    Ok((String::from_utf8(text).expect("text"), summary))
}

/// What `limit` writes for a program that it makes fit.
#[track_caller]
pub(crate) fn made_to_fit(
    machine: &Machine,
    options: &Options,
    how: LimitOptions,
    program: &str,
) -> (String, LimitSummary) {
    let done = limited(machine, options, how, program);
    let (text, summary) = done.unwrap_or_else(|failure| panic!("{failure:?}\n{program}"));
    assert!(summary.certified, "{program}\n{text}{:?}", summary.reasons);
    (text, summary)
}

/// The moves of a program up to its end or to what it is refused for.
pub(crate) fn moves_of(
    machine: &Machine,
    options: &Options,
    program: &str,
) -> (Vec<Move>, Option<Failure>) {
    let mut all = Vec::new();
    let read = moves(Cursor::new(program), machine, options, &mut |mv, _| {
        all.push(mv.clone());
        Ok(())
    });
    (all, read.err())
}

/// The machine with its knobs at these overrides: feed, rapid and spindle.
pub(crate) fn turned(machine: &Machine, [feed, rapid, spindle]: [f64; 3]) -> Machine {
    let mut machine = machine.clone();
    machine.limits.override_at = Some(OverrideAt {
        feed,
        rapid,
        spindle,
    });
    machine
}
