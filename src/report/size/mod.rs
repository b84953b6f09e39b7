//! How large a converter must be: for people, as CSV, JSON and SVG.

mod chart;
mod json;
mod table;

use std::fmt::Write as _;

pub use chart::size_chart;
pub use json::size_json;
pub use table::size_csv;

use super::aligned::aligned;
use super::checked::Verdict;
use super::figure::round_to_digits;
use super::quantity::{duration, power};
use crate::diagnostic::Diagnostic;
use crate::machine::Machine;
use crate::pipeline::Certificate;
use crate::pipeline::size::{Curve, Outcome, ProgramSize, Quantity, Rung, Size, Sizing};

/// Microfarads in a farad.
const UF: f64 = 1e6;
/// Kinds of reason that are named for each program.
const KINDS_MAX: usize = 3;

/// Which rung of a sizing it is.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Step {
    /// The smallest value at which all are certified.
    Lowest,
    Ladder,
    /// The smallest value from which on nothing is slowed.
    NothingSlowed,
    /// That of the machine file.
    Machine,
    /// The smallest value for a wished loss, as a share.
    Loss(f64),
}

impl Step {
    /// The name in CSV and JSON.
    fn name(self) -> &'static str {
        match self {
            Self::Lowest => "lowest",
            Self::Ladder => "ladder",
            Self::NothingSlowed => "nothing-slowed",
            Self::Machine => "machine",
            Self::Loss(_) => "loss",
        }
    }

    /// The loss that was wished for.
    fn wished(self) -> Option<f64> {
        match self {
            Self::Loss(loss) => Some(loss),
            _ => None,
        }
    }

    /// The remark for people.
    fn remark(self) -> String {
        match self {
            Self::Lowest => "the lowest that is certified".to_owned(),
            Self::Ladder => String::new(),
            Self::NothingSlowed => "nothing is slowed".to_owned(),
            Self::Machine => "as in the machine file".to_owned(),
            Self::Loss(loss) => format!("for a loss of {} %", digits(100.0 * loss)),
        }
    }
}

/// All rungs, from the largest value on.
fn rungs(curve: &Curve) -> Vec<(Step, &Rung)> {
    let last = curve.ladder.len().saturating_sub(1);
    let mut rungs: Vec<(Step, &Rung)> = curve
        .ladder
        .iter()
        .enumerate()
        .map(|(index, rung)| match index {
            _ if index == last => (Step::NothingSlowed, rung),
            0 => (Step::Lowest, rung),
            _ => (Step::Ladder, rung),
        })
        .collect();
    rungs.push((Step::Machine, &curve.own));
    let losses = curve.losses.iter();
    rungs.extend(losses.map(|(loss, rung)| (Step::Loss(*loss), rung)));
    rungs.sort_by(|(_, a), (_, b)| b.value.total_cmp(&a.value));
    rungs
}

/// Whether nothing depends on a capacitance: the smallest that makes sense is enough.
fn is_no_matter(quantity: Quantity, curve: &Curve) -> bool {
    quantity == Quantity::Capacitance && curve.ladder.len() == 1
}

/// The programs that were sized.
fn sized(sizing: &Sizing) -> impl Iterator<Item = (&str, &ProgramSize)> {
    sizing
        .programs
        .iter()
        .filter_map(|(name, outcome)| match outcome {
            Outcome::Sized(size) => Some((name.as_str(), &**size)),
            _ => None,
        })
}

/// The worst of all programs: refused, or fits with no converter.
#[must_use]
pub fn size_verdict(size: &Size) -> Verdict {
    let outcomes = size.rating.programs.iter();
    let verdicts = outcomes.map(|(_, outcome)| match outcome {
        Outcome::Refused(_) => Verdict::Refused,
        Outcome::Never { .. } => Verdict::DoesNotFit,
        Outcome::Idle | Outcome::Sized(_) => Verdict::Fits,
    });
    verdicts.max().unwrap_or(Verdict::Fits)
}

/// A value as it is put into a machine file, such as `4236 W` or `3900 µF`.
fn value(quantity: Quantity, value: f64) -> String {
    match quantity {
        Quantity::Rating => format!("{} W", digits(value)),
        Quantity::Capacitance => format!("{} µF", digits(value * UF)),
    }
}

fn digits(value: f64) -> f64 {
    round_to_digits(value, 6)
}

/// A loss of time such as `0.84 %` or `152 %`.
fn loss(share: f64) -> String {
    let percent = 100.0 * share;
    let decimals = if percent < 99.995 { 2 } else { 0 };
    format!("{percent:.decimals$} %")
}

/// What a sizing is over.
fn title(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Rating => "peak power",
        Quantity::Capacitance => "capacitance",
    }
}

/// Reasons in one line each, one of a kind: where first, and how many more.
fn reasons_text(reasons: &[Diagnostic]) -> Vec<String> {
    let mut kinds: Vec<(&Diagnostic, usize)> = Vec::new();
    for reason in reasons {
        match kinds.iter_mut().find(|(it, _)| it.rule == reason.rule) {
            Some((_, more)) => *more += 1,
            None => kinds.push((reason, 0)),
        }
    }
    let lines = kinds.iter().take(KINDS_MAX).map(|(reason, more)| {
        let mut text = String::new();
        if reason.line > 0 {
            let _ = write!(text, "line {}: ", reason.line);
        }
        text.push_str(&reason.message);
        if let Some(help) = &reason.help {
            let _ = write!(text, " → {help}");
        }
        if *more > 0 {
            let _ = write!(text, " (and {more} more like it)");
        }
        text
    });
    lines.collect()
}

/// For people; `shown` is the machine as it was asked for.
#[must_use]
pub fn size_text(size: &Size, machine: &Machine, shown: &str, converter: usize) -> String {
    let mut text = format!("{shown}: {}", machine.name);
    if let Some(converter) = machine.converters.get(converter)
        && !converter.name.is_empty()
    {
        let _ = write!(text, ", converter {}", converter.name);
    }
    text.push('\n');
    text.push_str(&sizing_text(&size.rating));
    for condition in conditions(machine, converter) {
        let _ = writeln!(text, "  {condition}");
    }
    if let Some(capacitance) = &size.capacitance {
        text.push('\n');
        text.push_str(&sizing_text(capacitance));
    }
    text
}

/// What the figures rest on.
fn conditions(machine: &Machine, converter: usize) -> Vec<String> {
    let margin = digits(100.0 * machine.limits.margin);
    let mut list = vec![format!(
        "peak power is that of the data sheet: {margin} % of it are kept free"
    )];
    if let Some(converter) = machine.converters.get(converter) {
        let ratings = &converter.ratings;
        if ratings.continuous.is_some() || !ratings.overload.is_empty() {
            list.push("continuous power and overloads grow and shrink with it".to_owned());
        }
        if ratings.brake.is_some() {
            list.push("the braking resistor is that of the machine file".to_owned());
        }
    }
    if machine.converters.len() > 1 {
        list.push(
            "the other converters are those of the machine file; the largest power of any is shown"
                .to_owned(),
        );
    }
    list
}

fn sizing_text(sizing: &Sizing) -> String {
    let quantity = sizing.quantity;
    let mut text = programs_text(sizing);
    let curve = sizing.curve.as_ref();
    let Some(curve) = curve.filter(|curve| !is_no_matter(quantity, curve)) else {
        return text;
    };
    let mut rows = vec![
        [
            title(quantity),
            "time",
            "loss",
            "lines changed",
            "draws",
            "feeds back",
            "certificate",
            "",
        ]
        .map(String::from),
    ];
    rows.extend(
        rungs(curve)
            .into_iter()
            .map(|(step, rung)| row(quantity, step, rung)),
    );
    text.push_str(&aligned(&rows, "  "));
    text.push_str(&refused_text(sizing, curve));
    text
}

/// Why there is no certificate, each reason once: at steps from above, and next to the
/// lowest.
fn refused_text(sizing: &Sizing, curve: &Curve) -> String {
    let mut refused: Vec<(f64, &str, &[Diagnostic])> = Vec::new();
    for (_, rung) in rungs(curve) {
        let programs = sized(sizing).zip(&rung.trials);
        refused.extend(programs.map(|((name, _), trial)| {
            let reasons = trial.reasons.as_slice();
            (rung.value, name, reasons)
        }));
    }
    for (name, size) in sized(sizing).filter(|(_, size)| size.lowest >= curve.lowest) {
        let below = size.below.iter();
        refused.extend(below.map(|(value, reasons)| (*value, name, reasons.as_slice())));
    }
    let mut text = String::new();
    let mut said = Vec::new();
    for (at, name, reasons) in refused {
        let mut kinds: Vec<&str> = reasons.iter().map(|reason| reason.rule).collect();
        kinds.sort_unstable();
        kinds.dedup();
        if kinds.is_empty() || said.contains(&(name, kinds.clone())) {
            continue;
        }
        said.push((name, kinds));
        let at = value(sizing.quantity, at);
        for reason in reasons_text(reasons) {
            let _ = writeln!(text, "  not with {at}: {name}: {reason}");
        }
    }
    text
}

/// What each program comes to.
fn programs_text(sizing: &Sizing) -> String {
    let quantity = sizing.quantity;
    let mut text = String::new();
    for (name, outcome) in &sizing.programs {
        match outcome {
            Outcome::Refused(_) => {
                let _ = writeln!(text, "{name}: refused, and not counted");
            }
            Outcome::Idle => {
                let _ = writeln!(text, "{name}: draws nothing, and is not counted");
            }
            Outcome::Never {
                peak_w,
                regen_w,
                reasons,
            } => {
                let _ = writeln!(
                    text,
                    "{name}: fits at no {}, and is not counted; it draws {} and feeds back {} \
                     at most",
                    title(quantity),
                    power(*peak_w),
                    power(*regen_w)
                );
                for reason in reasons_text(reasons) {
                    let _ = writeln!(text, "  {reason}");
                }
            }
            Outcome::Sized(size) => {
                let _ = writeln!(text, "{name}: {}", program_text(quantity, size));
            }
        }
    }
    text
}

fn program_text(quantity: Quantity, size: &ProgramSize) -> String {
    let (enough, lowest) = (value(quantity, size.enough), value(quantity, size.lowest));
    let mut text = String::new();
    if quantity == Quantity::Rating {
        let _ = write!(
            text,
            "{}, draws {} and feeds back {} at most; ",
            duration(size.duration_s),
            power(size.peak_w),
            power(size.regen_w)
        );
    }
    let _ = write!(text, "nothing is slowed from {enough} on");
    if size.lowest < size.enough {
        let _ = write!(text, ", certified down to {lowest}");
    }
    match &size.below {
        None => text.push_str(" (less was not tried)"),
        Some((_, reasons)) if reasons.is_empty() => {
            text.push_str(" (less takes longer than --until)");
        }
        Some(_) => {}
    }
    if size.unlimited.edited_lines > 0 {
        let _ = write!(
            text,
            "; other limits alone make it {}",
            duration(size.unlimited.duration_s)
        );
    }
    text
}

fn row(quantity: Quantity, step: Step, rung: &Rung) -> [String; 8] {
    let total = &rung.total;
    let value = value(quantity, rung.value);
    let remark = step.remark();
    if !total.certified {
        let no = ["", "", "", "", ""].map(String::from);
        let [time, loss, lines, draws, feeds_back] = no;
        let certificate = "none".to_owned();
        return [
            value,
            time,
            loss,
            lines,
            draws,
            feeds_back,
            certificate,
            remark,
        ];
    }
    [
        value,
        duration(total.duration_s),
        loss(rung.loss),
        total.edited_lines.to_string(),
        power(total.peak_w),
        power(total.regen_w),
        total.certificate.map_or("", Certificate::name).to_owned(),
        remark,
    ]
}
