//! Findings that are known: a file that is kept next to programs, so that CI fails on new ones
//! alone.

use std::collections::BTreeMap;
use std::io::{self, Write};

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::figure::round_to_digits;
use super::finding::{PEAK_POWER, REGEN_POWER, is_regenerative};
use crate::diagnostic::excerpt;
use crate::pipeline::{OverTime, Summary, Unfit};
use crate::power::Measure;

/// Version of the format.
const VERSION: u32 = 1;
/// Characters of a line that are kept.
const TEXT_CHARS: usize = 200;
/// Digits of figures.
const DIGITS: i32 = 10;
/// What rounding, and another platform, may make of a figure.
const ROUNDED: f64 = 1.0 + 1e-6;

/// Findings of programs, as the last run that was accepted had them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Baseline {
    programs: BTreeMap<String, Vec<Known>>,
}

/// Why a baseline cannot be used.
#[derive(Debug, Error)]
pub enum BaselineError {
    /// It is not what gwatt has written.
    #[error("it is no baseline")]
    Format(#[from] serde_json::Error),
    /// It is of another version.
    #[error("it has version {0}, and this gwatt reads version {VERSION}: write it again")]
    Version(u32),
}

/// A finding.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Known {
    /// Its rule.
    pub(super) rule: String,
    /// The file of a subprogram; empty for the program itself.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub(super) file: String,
    /// Where it was; only for people, since lines move.
    pub(super) line: u64,
    /// The text of the line, or what is limited over time.
    pub(super) text: String,
    /// The figure: W, V, J or s; `None` is without bound.
    pub(super) value: Option<f64>,
    /// Its limit.
    pub(super) limit: f64,
}

impl Known {
    /// A move that does not fit.
    pub(super) fn of_move(unfit: &Unfit) -> Self {
        let (rule, value, limit) = if is_regenerative(unfit) {
            let limit_w = unfit.regen_limit_w.unwrap_or_default();
            (REGEN_POWER, unfit.regen_w, limit_w)
        } else {
            (PEAK_POWER, unfit.peak_w, unfit.limit_w)
        };
        Self {
            rule: rule.to_owned(),
            file: unfit.file.clone(),
            line: unfit.line,
            text: excerpt(&unfit.text, TEXT_CHARS).trim().to_owned(),
            value: figure(value),
            limit: round_to_digits(limit, DIGITS),
        }
    }

    /// A limit over time that is not known to be kept.
    pub(super) fn of_limit(found: &OverTime) -> Self {
        Self {
            rule: found.rating.measure.name().to_owned(),
            // The worst moment may move from file to file.
            file: String::new(),
            line: found.rating.line,
            text: found.title(),
            value: figure(found.rating.value),
            limit: round_to_digits(found.rating.limit, DIGITS),
        }
    }

    /// All of a program, moves first.
    pub(super) fn of(summary: &Summary) -> Vec<Self> {
        let moves = summary.unfit.iter().map(Self::of_move);
        let over_time = summary.over_time.iter().filter(|it| !it.rating.fits());
        moves.chain(over_time.map(Self::of_limit)).collect()
    }

    /// What makes two findings the same one, wherever its line stands by now.
    pub(super) fn key(&self) -> (&str, &str, &str) {
        (&self.rule, &self.file, &self.text)
    }

    /// How bad it is, in the unit of the value and as a share of the limit: larger is worse.
    pub(super) fn badness(&self) -> [f64; 2] {
        let value = self.value.unwrap_or(f64::INFINITY);
        if self.rule == Measure::LowestVoltage.name() {
            let value = self.value.unwrap_or(0.0).max(f64::MIN_POSITIVE);
            return [1.0 / value, self.limit / value];
        }
        [value, value / self.limit.max(f64::MIN_POSITIVE)]
    }

    /// Whether `other` is no better in any respect: what is new about `self` is nothing.
    pub(super) fn is_covered_by(&self, other: &Self) -> bool {
        let pairs = self.badness().into_iter().zip(other.badness());
        { pairs }.all(|(now, then)| now <= then * ROUNDED)
    }
}

fn figure(value: f64) -> Option<f64> {
    value.is_finite().then(|| round_to_digits(value, DIGITS))
}

/// The name under which a program stands in it: the same on every system.
fn name_of(program: &str) -> String {
    let name = if cfg!(windows) {
        program.replace('\\', "/")
    } else {
        program.to_owned()
    };
    name.strip_prefix("./").unwrap_or(&name).to_owned()
}

impl Baseline {
    /// Takes what a run has found of a program. One that fits is named without findings.
    pub fn add(&mut self, program: &str, summary: &Summary) {
        self.programs.insert(name_of(program), Known::of(summary));
    }

    /// Reads what [`write`](Self::write) has written.
    ///
    /// # Errors
    /// A text that is none.
    pub fn read(text: &str) -> Result<Self, BaselineError> {
        #[derive(Deserialize)]
        struct Version {
            version: u32,
        }
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        struct File {
            #[serde(rename = "version")]
            _version: u32,
            programs: BTreeMap<String, Vec<Known>>,
        }
        let Version { version } = serde_json::from_str(text)?;
        if version != VERSION {
            return Err(BaselineError::Version(version));
        }
        let File { programs, .. } = serde_json::from_str(text)?;
        Ok(Self { programs })
    }

    /// Writes it, a finding in a line, so that changes of it can be read.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write(&self, mut out: impl Write) -> io::Result<()> {
        write!(out, "{{\"version\": {VERSION}, \"programs\": {{")?;
        for (index, (program, known)) in self.programs.iter().enumerate() {
            let comma = if index == 0 { "" } else { "," };
            write!(out, "{comma}\n{}: [", serde_json::to_string(program)?)?;
            for (index, known) in known.iter().enumerate() {
                let comma = if index == 0 { "" } else { "," };
                write!(out, "{comma}\n  {}", serde_json::to_string(known)?)?;
            }
            write!(out, "]")?;
        }
        writeln!(out, "\n}}}}")
    }

    /// How many findings it has.
    #[must_use]
    pub fn count(&self) -> usize {
        self.programs.values().map(Vec::len).sum()
    }

    /// How many programs it names.
    #[must_use]
    pub fn programs(&self) -> usize {
        self.programs.len()
    }

    /// What it has of a program.
    pub(super) fn known(&self, program: &str) -> &[Known] {
        self.programs
            .get(&name_of(program))
            .map_or(&[], Vec::as_slice)
    }

    /// Programs that it has findings of, and that are not among these.
    #[must_use]
    pub fn others(&self, checked: &[String]) -> Vec<&str> {
        let names: Vec<String> = checked.iter().map(|program| name_of(program)).collect();
        let found = self.programs.iter().filter(|(_, known)| !known.is_empty());
        found
            .map(|(program, _)| program.as_str())
            .filter(|program| !names.iter().any(|name| name == program))
            .collect()
    }
}
