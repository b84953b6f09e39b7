//! The page on controls is made from the profiles, so that it cannot be older than they are.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use gwatt::machine::{
    Controller, Knob, KnobTarget, KnobUnit, PathMode, RapidJoint, RapidKnob, RapidPath, builtin,
};

const HEAD: &str = "\
# Controls

How each control moves, and what `limit` writes for it. What is read and what is refused stands in
[Programs it reads](programs.md). This page is made from the profiles
(`gwatt machine show NAME` prints one, with the source of each value); a machine file names its own
by `controller`, and may correct it. What a control has to be set to for a certificate stands with
the certificate as well.

*Planned* figures follow the control's own look-ahead. Where corners are not modelled and the
program blends, figures are a *robust* bound: [Glossary](glossary.md).

F of cutting feeds is written with `--allow feed` alone, on all controls. Words that no document
confirms take `--allow unverified`.
";

fn target(knob: &Knob) -> &'static str {
    match knob.target {
        KnobTarget::FeedAccel => "acceleration of feeds",
        KnobTarget::RapidAccel => "acceleration of rapids",
        KnobTarget::Accel => "acceleration",
        KnobTarget::Jerk => "jerk",
        KnobTarget::RapidSpeed => "speed of rapids",
        KnobTarget::Speed => "speed",
        KnobTarget::SpeedShare => "override of the speed",
        KnobTarget::CruiseRatio => "share of cruising",
    }
}

fn unit(knob: &Knob) -> &'static str {
    match knob.unit {
        KnobUnit::Percent => "%",
        KnobUnit::PerSecondSquared => "units/s²",
        KnobUnit::PerSecond => "units/s",
        KnobUnit::PerMinute => "units/min",
        KnobUnit::Share => "a share from 0 to 1",
    }
}

fn words(knobs: &[Knob]) -> String {
    let words: Vec<String> = knobs
        .iter()
        .map(|knob| {
            let doubt = if knob.verified { "" } else { ", not confirmed" };
            format!("`{}` ({}, {}{doubt})", knob.name, target(knob), unit(knob))
        })
        .collect();
    words.join(", ")
}

fn section(out: &mut String, control: &Controller) {
    let Controller {
        language, planner, ..
    } = control;
    let either = |is: bool, yes, no| if is { yes } else { no };
    let units = either(language.metric, "mm", "inch");
    let distance = either(language.absolute, "absolute", "incremental");
    let mode = match language.power_on_mode {
        PathMode::ExactStop => "exact stop",
        PathMode::LookAhead => "corners are run through",
    };
    let rapids = match planner.rapid {
        RapidPath::Linear => "straight lines, all axes arrive together",
        RapidPath::Independent => "each axis by itself",
    };
    let corners = match planner.look_ahead {
        Some(_) => "modelled: planned",
        None => "not modelled: robust where the program blends, else planned",
    };
    let mut written = words(&control.knobs);
    if control.rapid_knob == RapidKnob::G1 {
        let comma = either(written.is_empty(), "", ", ");
        written = written + comma + "rapids as feeds (`G1 F`)";
    }
    writeln!(out, "\n## {}\n\n{}.\n", control.name, control.description).unwrap();
    writeln!(out, "| | |\n|---|---|").unwrap();
    writeln!(out, "| at power-on | {units}, {distance}, {mode} |").unwrap();
    writeln!(out, "| rapids | {rapids} |").unwrap();
    writeln!(out, "| corners | {corners} |").unwrap();
    let skips = either(language.block_delete, "with `--block-delete`", "never");
    writeln!(out, "| blocks with `/` are skipped | {skips} |").unwrap();
    writeln!(out, "| gwatt writes | {written} |").unwrap();
    if let Some(stops) = stops(control) {
        writeln!(
            out,
            "| a feed written for a rapid is brought to rest by | {stops} |"
        )
        .unwrap();
    }
    if let Some((words, _)) = language.dwell_block(2.0) {
        writeln!(out, "| with `--allow pause` | `{words}` for two seconds |").unwrap();
    }
    if !control.wired.is_empty() {
        let wired = words(&control.wired);
        writeln!(
            out,
            "| and, if the machine file names the output | {wired} |"
        )
        .unwrap();
    }
    writeln!(
        out,
        "| to set in the machine file | {} |",
        settings(control)
    )
    .unwrap();
    if !language.levels.is_empty() {
        let levels = language.levels.join("`, `");
        writeln!(
            out,
            "| levels that `[[levels]]` of the machine file describes | `{levels}` |"
        )
        .unwrap();
    }
}

/// The words by which a rapid keeps its stops as a feed; `None` where rapids are run through
/// like feeds.
fn stops(control: &Controller) -> Option<String> {
    let Controller {
        language, planner, ..
    } = control;
    if planner.rapid_joint == RapidJoint::All {
        return None;
    }
    let mut words = Vec::new();
    if let Some(word) = language.stop_word() {
        words.push(format!("`{word}` in its block"));
    } else if language.stops_by_mode() {
        words.push("`G61` before it and `G64` after it".to_owned());
    }
    if language.family.facts().stops_by_exact_path && language.g61_1 == PathMode::ExactStop {
        words.push("`G61.1` before it and the mode again after it".to_owned());
    }
    if planner.dwell_stops {
        words.push(format!(
            "`{}` before and after it",
            language.shortest_dwell().0
        ));
    }
    Some(words.join(", "))
}

/// What a machine file has to say of a control, as the machine is set.
fn settings(control: &Controller) -> String {
    let Controller {
        language, planner, ..
    } = control;
    let mut settings = Vec::new();
    if planner.rapid == RapidPath::Independent {
        settings.push(
            "`rapid = \"linear\"` under `[path]` where a parameter lets rapids run along lines",
        );
    }
    if planner.look_ahead.is_some() {
        settings
            .push("its own settings of speed, acceleration and corners: `gwatt machine import`");
    } else {
        settings
            .push("`mode = \"exact-stop\"` under `[path]` where the machine stops at every block");
    }
    if language.dialect.adapts() {
        settings.push("`decimal_point` under `[language]`: what numbers without a point mean");
    }
    settings.join("; ")
}

#[test]
fn the_page_is_that_of_the_profiles() {
    let mut page = HEAD.to_owned();
    for control in builtin::controllers() {
        let (control, _) = Controller::from_toml(control.text).unwrap();
        section(&mut page, &control);
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/controls.md");
    if std::env::var_os("TRYCMD").is_some_and(|it| it == "overwrite") {
        fs::write(&path, &page).unwrap();
    }
    let shown = fs::read_to_string(&path).unwrap_or_default();
    assert!(
        page == shown,
        "docs/controls.md is old: `just bless` writes it again"
    );
}
