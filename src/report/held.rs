//! Findings of a program, compared with those that are known.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use serde::Serialize;

use super::baseline::{Baseline, Known};
use super::known_comment::{Comment, comment};
use crate::pipeline::{OverTime, Summary, Unfit};

/// What a baseline makes of the findings of a program.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Held {
    /// Findings that it has, and that are no worse by now.
    known: usize,
    /// Findings that it does not have, and those that are worse.
    new: usize,
    /// Moves that do not fit and that no list names, for their number.
    #[serde(skip_serializing_if = "is_zero")]
    not_listed: u64,
    /// What of the new ones has grown, in words.
    grown: Vec<String>,
    /// What it has and the program has no more, in words.
    gone: Vec<String>,
    /// Comments that look like those of known findings and are none, in words.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    unclear: Vec<String>,
    /// Places of the known ones.
    #[serde(skip)]
    places: BTreeSet<Place>,
}

#[allow(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde hands over references"
)]
fn is_zero(count: &u64) -> bool {
    *count == 0
}

/// File, line, rule and text of a finding.
type Place = (String, u64, String, String);

fn place(known: &Known) -> Place {
    let Known {
        rule, file, text, ..
    } = known;
    (file.clone(), known.line, rule.clone(), text.clone())
}

impl Held {
    /// Holds the findings of `program` against those of `baseline`.
    #[must_use]
    pub fn new(baseline: &Baseline, program: &str, summary: &Summary) -> Self {
        Self::default().against(baseline, program, summary, &Known::of(summary))
    }

    /// The same, where comments that name findings of their own lines count too. What such a
    /// comment covers is not looked for in the baseline.
    #[must_use]
    pub fn with_comments(baseline: &Baseline, program: &str, summary: &Summary) -> Self {
        let mut held = Self::default();
        let mut others = Vec::new();
        for unfit in &summary.unfit {
            let found = Known::of_move(unfit);
            let own = match comment(&unfit.text) {
                Comment::Known(rule, value, limit) => found.as_commented(rule, value, limit),
                Comment::Unclear => {
                    let text = format!(
                        "the comment of line {} is not understood: write (gwatt: known {} {})",
                        found.line,
                        found.rule,
                        figure(&found)
                    );
                    held.unclear.push(text);
                    others.push(found);
                    continue;
                }
                Comment::None => {
                    others.push(found);
                    continue;
                }
            };
            if own.rule == found.rule && found.is_covered_by(&own) {
                held.known += 1;
                held.places.insert(place(&found));
            } else {
                let text = format!(
                    "{}, its comment has {} {}",
                    words(&found),
                    own.rule,
                    figure(&own)
                );
                held.grown.push(text);
                others.push(found);
            }
        }
        let over_time = Known::of(summary).into_iter().skip(summary.unfit.len());
        others.extend(over_time);
        held.against(baseline, program, summary, &others)
    }

    /// Holds these findings against those of `baseline`.
    fn against(
        mut self,
        baseline: &Baseline,
        program: &str,
        summary: &Summary,
        now: &[Known],
    ) -> Self {
        let held = &mut self;
        let mut then: BTreeMap<_, Vec<&Known>> = BTreeMap::new();
        for known in baseline.known(program) {
            then.entry(known.key()).or_default().push(known);
        }
        let mut groups: BTreeMap<_, Vec<&Known>> = BTreeMap::new();
        for found in now {
            groups.entry(found.key()).or_default().push(found);
        }
        for (key, found) in groups {
            held.group(found, then.remove(&key).unwrap_or_default());
        }
        let gone = then.values().flatten();
        held.gone.extend(gone.map(|known| words(known)));
        let listed: u64 = summary.unfit.iter().map(|unfit| unfit.runs).sum();
        held.not_listed = summary.unfit_count.saturating_sub(listed);
        self
    }

    /// Findings that look alike: the worst is compared with the worst.
    fn group(&mut self, mut now: Vec<&Known>, mut then: Vec<&Known>) {
        let worst_first = |a: &&Known, b: &&Known| b.badness()[0].total_cmp(&a.badness()[0]);
        now.sort_by(worst_first);
        then.sort_by(worst_first);
        let mut left = then.into_iter().peekable();
        let mut fresh = Vec::new();
        for found in now {
            if left.next_if(|known| found.is_covered_by(known)).is_some() {
                self.known += 1;
                self.places.insert(place(found));
            } else {
                fresh.push(found);
            }
        }
        self.new += fresh.len();
        for found in fresh {
            // A known one that nothing stands for any more has become this.
            if let Some(known) = left.next() {
                let text = format!("{}, was {}", words(found), figure(known));
                self.grown.push(text);
            }
            self.places.remove(&place(found));
        }
        self.gone.extend(left.map(words));
    }

    /// Whether nothing is new.
    #[must_use]
    pub fn covers_all(&self) -> bool {
        self.new == 0 && self.not_listed == 0
    }

    /// Moves that do not fit and that no list names, for their number: new to any baseline.
    #[must_use]
    pub fn not_listed(&self) -> u64 {
        self.not_listed
    }

    /// Whether it has this move.
    #[must_use]
    pub fn has_move(&self, unfit: &Unfit) -> bool {
        self.places.contains(&place(&Known::of_move(unfit)))
    }

    /// Whether it has this limit over time.
    #[must_use]
    pub fn has_limit(&self, found: &OverTime) -> bool {
        self.places.contains(&place(&Known::of_limit(found)))
    }

    /// What is said of it below the verdict; nothing where there is nothing to say.
    pub(super) fn text(&self) -> String {
        let mut text = String::new();
        if self.known + self.new > 0 || self.not_listed > 0 {
            let _ = write!(text, "  baseline: {} known, {} new", self.known, self.new);
            if self.not_listed > 0 {
                let more = self.not_listed;
                let _ = write!(text, ", {more} more that no baseline lists, and so new");
            }
            text.push('\n');
        }
        for grown in &self.grown {
            let _ = writeln!(text, "  grown: {grown}");
        }
        for gone in &self.gone {
            let _ = writeln!(text, "  gone: {gone}");
        }
        for unclear in &self.unclear {
            let _ = writeln!(text, "  {unclear}");
        }
        text
    }
}

/// A finding in words.
fn words(known: &Known) -> String {
    let file = if known.file.is_empty() {
        String::new()
    } else {
        format!(" of {}", known.file)
    };
    let Known {
        rule, line, text, ..
    } = known;
    format!("{rule} in line {line}{file}, {}: {text}", figure(known))
}

/// Its figure.
fn figure(known: &Known) -> String {
    let unit = match known.rule.as_str() {
        "overload" => "s",
        "bus-voltage-low" | "bus-voltage-high" => "V",
        "brake-energy" => "J",
        _ => "W",
    };
    let limit = known.limit;
    match known.value {
        Some(value) => format!("{value:.1} {unit} of {limit:.1} {unit}"),
        None => format!("without bound, of {limit:.1} {unit}"),
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::Held;
    use crate::interpret::MoveKind;
    use crate::machine::AxisSet;
    use crate::pipeline::{Summary, Unfit};
    use crate::report::Baseline;

    fn unfit(line: u64, text: &str, peak_w: f64) -> Unfit {
        Unfit {
            line,
            file: String::new(),
            runs: 1,
            n_word: None,
            kind: MoveKind::Rapid,
            axes: AxisSet::default(),
            peak_w,
            limit_w: 1000.0,
            regen_w: 0.0,
            regen_limit_w: None,
            overload: peak_w / 1000.0,
            help: String::new(),
            text: text.into(),
        }
    }

    fn summary(moves: &[(u64, &str, f64)]) -> Summary {
        Summary {
            unfit: moves.iter().map(|it| unfit(it.0, it.1, it.2)).collect(),
            unfit_count: moves.len() as u64,
            ..Summary::default()
        }
    }

    fn baseline(summary: &Summary) -> Baseline {
        let mut text = Vec::new();
        let mut written = Baseline::default();
        written.add("./a.nc", summary);
        written.write(&mut text).unwrap();
        let read = Baseline::read(str::from_utf8(&text).unwrap()).unwrap();
        assert_eq!(read, written);
        read
    }

    #[test]
    fn lines_may_move_and_peaks_may_not_grow() {
        let then = [
            (3, "G0 X1", 2000.0),
            (5, "G0 X1", 1500.0),
            (9, "G0 Y1", 1200.0),
        ];
        let then = baseline(&summary(&then));
        let held = |now: &[(u64, &str, f64)]| Held::new(&then, "a.nc", &summary(now));
        let moved = [
            (13, "G0 X1", 1500.0),
            (15, " G0 X1", 2000.0),
            (19, "G0 Y1", 1200.0),
        ];
        let moved = held(&moved);
        assert!(moved.covers_all());
        assert_eq!(moved.text(), "  baseline: 3 known, 0 new\n");
        // Two peaks of 1.6 kW are not one of 2.0 and one of 1.5.
        let text = held(&[(3, "G0 X1", 1600.0), (5, "G0 X1", 1600.0)]).text();
        insta::assert_snapshot!(text, @"
          baseline: 1 known, 1 new
          grown: peak-power in line 5, 1600.0 W of 1000.0 W: G0 X1, was 1500.0 W of 1000.0 W
          gone: peak-power in line 9, 1200.0 W of 1000.0 W: G0 Y1
        ");
        let text = held(&[(3, "G0 X1", 2000.0), (4, "G0 Z1", 1001.0)]).text();
        insta::assert_snapshot!(text, @"
          baseline: 1 known, 1 new
          gone: peak-power in line 5, 1500.0 W of 1000.0 W: G0 X1
          gone: peak-power in line 9, 1200.0 W of 1000.0 W: G0 Y1
        ");
    }

    /// A smaller converter makes the same peak worse.
    #[test]
    fn limits_may_not_shrink() {
        let then = baseline(&summary(&[(3, "G0 X1", 2000.0)]));
        let mut now = summary(&[(3, "G0 X1", 2000.0)]);
        now.unfit[0].limit_w = 900.0;
        assert!(!Held::new(&then, "a.nc", &now).covers_all());
        assert!(!Held::new(&then, "b.nc", &summary(&[(3, "G0 X1", 1.0)])).covers_all());
    }

    #[test]
    fn what_no_list_names_is_new() {
        let mut many = summary(&[(3, "G0 X1", 2000.0)]);
        many.unfit_count = 7;
        let held = Held::new(&baseline(&many), "a.nc", &many);
        assert!(!held.covers_all());
        let text = "  baseline: 1 known, 0 new, 6 more that no baseline lists, and so new\n";
        assert_eq!(held.text(), text);
    }

    #[test]
    fn other_files_are_refused() {
        let said = |text| Baseline::read(text).unwrap_err().to_string();
        assert_eq!(said("{}"), "it is no baseline");
        let version = "it has version 9, and this gwatt reads version 1: write it again";
        assert_eq!(said(r#"{"version": 9}"#), version);
        assert_eq!(
            said(r#"{"version": 1, "programs": {"a": [{}]}}"#),
            "it is no baseline"
        );
    }

    proptest! {
        /// Whatever is covered could be paired one by one with something no better.
        #[test]
        fn as_many_at_each_height(
            then in prop::collection::vec(1001..1020u32, 0..8),
            now in prop::collection::vec(1001..1020u32, 0..8),
        ) {
            let of = |peaks: &[u32]| {
                let moves: Vec<_> = peaks.iter().map(|it| (1, "G0", f64::from(*it))).collect();
                summary(&moves)
            };
            let held = Held::new(&baseline(&of(&then)), "a.nc", &of(&now));
            let above = |list: &[u32], least: u32| list.iter().filter(|it| **it >= least).count();
            let fits = (1001..1020).all(|it| above(&now, it) <= above(&then, it));
            prop_assert_eq!(held.covers_all(), fits);
        }
    }
}
