//! `gwatt explain`.

use std::fmt::Write as _;

use anyhow::{Result, anyhow};
use gwatt::report::Verdict;
use gwatt::rules::{self, Rule};

use super::output::print;
use crate::cli::ExplainArgs;

/// Prints what rules mean, or lists all.
pub fn run(args: &ExplainArgs) -> Result<Verdict> {
    let found: Vec<&Rule> = args
        .rules
        .iter()
        .map(|name| find(name))
        .collect::<Result<_>>()?;
    let text = if found.is_empty() {
        listed()
    } else {
        let texts = found
            .iter()
            .map(|it| format!("{}\n\n{}\n", it.name, it.text));
        texts.collect::<Vec<_>>().join("\n\n")
    };
    print(|out| out.write_all(text.as_bytes()))?;
    Ok(Verdict::Fits)
}

/// A rule as people write it: `arc-radius`, or `error[arc-radius]` out of a message.
fn find(given: &str) -> Result<&'static Rule> {
    let inside = given
        .split_once('[')
        .and_then(|(_, rest)| rest.split_once(']'));
    let name = inside.map_or(given, |(name, _)| name).trim();
    rules::find(name).ok_or_else(|| {
        let close = rules::close_to(name);
        let what_to_do = if close.is_empty() {
            "`gwatt explain` lists all".to_owned()
        } else {
            format!(
                "did you mean {}? `gwatt explain` lists all",
                close.join(", ")
            )
        };
        anyhow!("no rule is named `{name}`: {what_to_do}")
    })
}

/// All rules in alphabetical order, each in a line.
fn listed() -> String {
    let mut all: Vec<&Rule> = rules::rules().iter().collect();
    all.sort_by_key(|rule| rule.name);
    let width = all.iter().map(|rule| rule.name.len()).max().unwrap_or(0);
    let mut text = String::new();
    for rule in all {
        let _ = writeln!(text, "{:width$}  {}", rule.name, rule.summary());
    }
    text
}
