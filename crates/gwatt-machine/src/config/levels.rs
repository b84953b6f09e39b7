//! `[[levels]]` of a machine file: words that select accelerations or rapid speeds, and
//! what each makes of the axes.

use std::ops::Range;

use schemars::JsonSchema;
use serde::Deserialize;

use super::findings::Findings;
use super::level_words::{Taken, words};
use super::value::{At, NotNegative, OneOrMany, PerAxis, Positive, RapidPercent};
use crate::axis::{AXES, Axis};
use crate::controller::Controller;
use crate::knob::{Knob, KnobArgument, KnobTarget, KnobUnit};
use crate::levels::{LEVEL_GROUPS, Level, Levels};
use crate::model::Load;

/// Words of which one is in force at a time, each with what it makes of the axes.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct LevelsTable {
    /// Which moves the words act on.
    #[schemars(required)]
    pub(crate) acts_on: Option<At<ActsOnName>>,
    /// Whether a word acts between two moves that run into each other, without a stop;
    /// default false: then `limit` writes it only between moves that rest.
    pub(crate) between_moves: Option<At<bool>>,
    /// How long the axes stand for a word, in s; default 0.
    pub(crate) change_s: Option<NotNegative>,
    /// Whether a document of the vendor or of the machine's builder says what the words do;
    /// default: true where the controller profile knows of one, else false. Without one
    /// `limit` writes them with --allow unverified only.
    pub(crate) verified: Option<bool>,
    /// The levels; at least two.
    #[schemars(required)]
    pub(crate) level: Option<At<Vec<At<LevelTable>>>>,
}

/// A level.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct LevelTable {
    /// Its word, such as `G187 P1`, `DYNFINISH` or `M31`; several where they mean the same:
    /// the first is written.
    #[schemars(required)]
    pub(crate) word: Option<OneOrMany<String>>,
    /// Whether it holds when a program begins; one level of each group does.
    pub(crate) power_on: Option<At<bool>>,
    /// Accelerations in percent of those of the axes, for all axes.
    pub(crate) accel_percent: Option<Positive>,
    /// Accelerations in mm/s² (rotary: degrees/s²); axes that are not named keep their own.
    pub(crate) accel_mm_s2: Option<PerAxis<Positive>>,
    /// Speed of rapids in percent.
    pub(crate) rapid_percent: Option<RapidPercent>,
}

/// Which moves levels act on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum ActsOnName {
    Feeds,
    Rapids,
    All,
}

/// More than this many times its own acceleration is a mistake.
const MOST: f64 = 10.0;

/// Gives the controller these words.
pub(crate) fn take(
    findings: &mut Findings<'_>,
    tables: &[At<LevelsTable>],
    axes: &[Option<Axis>; AXES],
    loads: &[Load],
    controller: &mut Controller,
) {
    let mut taken = Taken::new(controller, loads);
    let mut found: Vec<Knob> = Vec::new();
    for (group, table) in tables.iter().enumerate() {
        if group >= LEVEL_GROUPS {
            let message = format!("more than {LEVEL_GROUPS} groups of levels");
            findings.error("machine-levels", &table.span, message, None);
            break;
        }
        let Some(knob) = knob(findings, table, axes, &mut taken, group) else {
            continue;
        };
        let clash = found.iter().chain(&controller.knobs);
        if let Some(other) = clash.clone().find(|other| clashes(other, &knob)) {
            let message = format!(
                "these levels and `{}` act on the same moves: what both make of them is not known",
                other.name
            );
            findings.error("machine-levels", &table.span, message, None);
        }
        found.push(knob);
    }
    controller.knobs.extend(found);
}

/// Whether both set the accelerations, or the speed, of the same moves. Percentages are
/// those of the level in force.
fn clashes(other: &Knob, knob: &Knob) -> bool {
    use KnobTarget::{FeedAccel, RapidAccel, RapidSpeed};
    let speeds = |knob: &Knob| {
        let levels = knob.levels.iter().flat_map(|levels| &levels.list);
        knob.target == RapidSpeed || levels.clone().any(|level| level.rapid_factor != 1.0)
    };
    let percent = other.levels.is_none() && other.unit == KnobUnit::Percent;
    let accels = other.sets_accel()
        && knob.sets_accel()
        && !percent
        && !matches!(
            (other.target, knob.target),
            (FeedAccel, RapidAccel) | (RapidAccel, FeedAccel)
        );
    // OVRRAP is read as a percentage of what the levels give.
    accels || speeds(other) && speeds(knob) && !other.is_named_for_all()
}

fn knob(
    findings: &mut Findings<'_>,
    table: &At<LevelsTable>,
    axes: &[Option<Axis>; AXES],
    taken: &mut Taken<'_>,
    group: usize,
) -> Option<Knob> {
    let LevelsTable {
        acts_on,
        between_moves,
        change_s,
        verified,
        level: tables,
    } = &table.value;
    let (acts_on, tables) = (acts_on.as_ref()?, tables.as_ref()?);
    let mut documented = true;
    let mut list = Vec::new();
    let mut power_on = Vec::new();
    let (mut accels, mut speeds) = (false, false);
    for table in &tables.value {
        let (words, known) = words(findings, table.value.word.as_ref(), taken);
        documented &= known;
        accels |= table.value.accel_percent.is_some() || table.value.accel_mm_s2.is_some();
        speeds |= table.value.rapid_percent.is_some();
        let holds = table.value.power_on.as_ref().is_some_and(|it| it.value);
        list.push((level(findings, table, axes, acts_on, words), holds));
        power_on.extend(holds.then_some(&table.span));
    }
    let fault = if list.len() < 2 {
        Some("levels need at least two words to choose from")
    } else if power_on.is_empty() {
        Some("none of these levels has power_on = true: which one holds at the start?")
    } else if power_on.len() > 1 {
        Some("two of these levels have power_on = true")
    } else if !accels && !speeds {
        Some("none of these levels has an acceleration or a speed")
    } else {
        None
    };
    if let Some(message) = fault {
        let help = "each [[levels.level]] has a `word` and `accel_percent`, `accel_mm_s2` or \
                    `rapid_percent`, and one of them power_on = true";
        findings.error(
            "machine-levels",
            &tables.span,
            message,
            Some(help.to_owned()),
        );
        return None;
    }
    let between = between_moves.as_ref().filter(|it| it.value);
    let change_s = change_s.as_ref().map_or(0.0, |it| it.value);
    if let Some(between) = between
        && change_s > 0.0
    {
        let message = "the axes stand for `change_s`: then the word does not act between moves";
        findings.error("machine-levels", &between.span, message, None);
    }
    list.sort_by(|(a, _), (b, _)| ease(a).total_cmp(&ease(b)));
    let power_on = list.iter().position(|(_, holds)| *holds)?;
    let list: Vec<Level> = list.into_iter().map(|(level, _)| level).collect();
    let names: Vec<&str> = list.iter().map(Level::text).collect();
    Some(Knob {
        code: None,
        name: names.join(", "),
        target: match acts_on.value {
            ActsOnName::Rapids if !accels => KnobTarget::RapidSpeed,
            ActsOnName::Rapids => KnobTarget::RapidAccel,
            ActsOnName::Feeds => KnobTarget::FeedAccel,
            ActsOnName::All => KnobTarget::Accel,
        },
        argument: KnobArgument::Level,
        unit: KnobUnit::PerSecondSquared,
        step: 1.0,
        min: 0.0,
        verified: verified.unwrap_or(documented),
        between_moves: between.is_some(),
        with_jerk: false,
        barrier: None,
        wait: None,
        change_s,
        levels: Some(Levels {
            list,
            power_on,
            group,
        }),
    })
}

/// By what levels are put in order: the product of what they let the axes do.
fn ease(level: &Level) -> f64 {
    let shares = level.accel_mm_s2.iter().filter(|accel| **accel > 0.0);
    shares.map(|accel| libm::log(*accel)).sum::<f64>() + libm::log(level.rapid_factor)
}

fn level(
    findings: &mut Findings<'_>,
    table: &At<LevelTable>,
    axes: &[Option<Axis>; AXES],
    acts_on: &At<ActsOnName>,
    words: Vec<crate::levels::LevelWord>,
) -> Level {
    let LevelTable {
        accel_percent,
        accel_mm_s2,
        rapid_percent,
        ..
    } = &table.value;
    if let (Some(percent), Some(_)) = (accel_percent, accel_mm_s2) {
        let message = "accelerations are given twice, in percent and in mm/s²";
        findings.error("machine-levels", &percent.span, message, None);
    }
    if let Some(percent) = rapid_percent
        && acts_on.value == ActsOnName::Feeds
    {
        let message = "a speed of rapids in levels that act on feeds";
        let help = Some("acts_on = \"rapids\" or \"all\"".to_owned());
        findings.error("machine-levels", &percent.span, message, help);
    }
    let share = accel_percent.as_ref().map_or(1.0, |it| it.value / 100.0);
    let mut accel: [f64; AXES] =
        std::array::from_fn(|axis| axes[axis].map_or(0.0, |own| own.accel_mm_s2 * share));
    if let Some(percent) = accel_percent {
        plausible(findings, share, "the axes", &percent.span);
    }
    for (axis, number) in accel_mm_s2.iter().flat_map(PerAxis::iter) {
        let name = axis.letter() as char;
        let Some(own) = &axes[axis as usize] else {
            let message = format!("the machine has no axis {name}");
            findings.error("machine-levels", &number.span, message, None);
            continue;
        };
        let times = number.value / own.accel_mm_s2;
        plausible(findings, times, &format!("axis {name}"), &number.span);
        accel[axis as usize] = number.value;
    }
    Level {
        words,
        accel_mm_s2: accel,
        rapid_factor: rapid_percent.as_ref().map_or(1.0, |it| it.value / 100.0),
    }
}

fn plausible(findings: &mut Findings<'_>, times: f64, whose: &str, span: &Range<usize>) {
    if times > MOST {
        let message = format!("{times:.0} times the acceleration of {whose}");
        let help = Some("2000 mm/s² are 2 m/s²".to_owned());
        findings.error("machine-levels", span, message, help);
    }
}
