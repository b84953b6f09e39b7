//! What a rigid axis has besides mass and friction, for people and as JSON.

use std::f64::consts::PI;
use std::fmt::Write as _;

use serde_json::{Map, Value, json};

use super::estimate::{insert, number, shown};
use crate::identify::effects::{Effect, Saturation};
use crate::identify::rigid::Rigid;
use crate::identify::{Figure, Kind};

fn times(figure: Figure, factor: f64) -> Figure {
    Figure {
        value: factor * figure.value,
        std: factor * figure.std,
    }
}

/// The unit of lengths, or angles, and how many of it are one in SI.
fn unit(rigid: &Rigid) -> (&'static str, f64) {
    if rigid.motion == Kind::Rotary {
        ("°", 180.0 / PI)
    } else {
        ("mm", 1e3)
    }
}

/// A line for each effect, and one for a limit of the force; forces in this unit.
pub(super) fn effects_text(rigid: &Rigid, force: &str) -> String {
    let mut text = String::new();
    let (length, factor) = unit(rigid);
    for effect in &rigid.effects {
        let _ = match *effect {
            Effect::Cogging {
                period, amplitude, ..
            } => writeln!(
                text,
                "  cogging           {} {force}, every {} {length}",
                shown(amplitude),
                shown(times(period, factor))
            ),
            Effect::Backlash { width, mass, .. } => {
                let share = 100.0 * (mass.value / rigid.mass.value).min(1.0);
                writeln!(
                    text,
                    "  backlash          {} {length}, within which {share:.0} % of the mass are not moved",
                    shown(times(width, factor))
                )
            }
            Effect::Stribeck { rise, speed, .. } => {
                let breakaway = rigid.coulomb.map_or(String::new(), |sliding| {
                    format!(": {:.4} {force} at breakaway", sliding.value + rise.value)
                });
                writeln!(
                    text,
                    "  Stribeck friction {} {force} more at rest, gone at some {} {length}/s{breakaway}",
                    shown(rise),
                    shown(times(speed, factor)),
                )
            }
        };
    }
    if let Some(saturation) = rigid.saturation {
        let (limit, share, what) = match saturation {
            Saturation::Drive { limit, share } => (
                limit,
                share,
                "the force stands there, and the motion agrees",
            ),
            Saturation::Recording { limit, share } => (
                limit,
                share,
                "the recording ends there, and the motion shows more",
            ),
            Saturation::Beyond { limit, share } => (
                limit,
                share,
                "more was recorded, and the motion shows no more",
            ),
        };
        let _ = writeln!(
            text,
            "  saturation        at {} {force}, {:.1} % of the samples: {what}",
            shown(Figure {
                value: limit,
                std: f64::NAN
            }),
            100.0 * share
        );
    }
    text
}

/// The effects as JSON: lengths in m (rad), forces in N (N·m).
pub(super) fn effects_json(rigid: &Rigid) -> Value {
    let length = if rigid.motion == Kind::Rotary {
        "rad"
    } else {
        "m"
    };
    let each = rigid.effects.iter().map(|effect| {
        let mut map = Map::new();
        let name = match *effect {
            Effect::Cogging {
                period, amplitude, ..
            } => {
                insert(&mut map, &format!("period_{length}"), Some(period));
                insert(&mut map, "amplitude_n", Some(amplitude));
                "cogging"
            }
            Effect::Backlash { width, mass, .. } => {
                insert(&mut map, &format!("width_{length}"), Some(width));
                insert(&mut map, "mass_within", Some(mass));
                "backlash"
            }
            Effect::Stribeck { rise, speed, .. } => {
                insert(&mut map, "rise_n", Some(rise));
                insert(&mut map, &format!("speed_{length}_s"), Some(speed));
                "Stribeck friction"
            }
        };
        map.insert("effect".into(), json!(name));
        map.insert("share".into(), number(Some(effect.share())));
        Value::Object(map)
    });
    each.collect()
}

/// A limit of the force as JSON; null for none.
pub(super) fn saturation_json(rigid: &Rigid) -> Value {
    let Some(saturation) = rigid.saturation else {
        return Value::Null;
    };
    let (of, limit, share) = match saturation {
        Saturation::Drive { limit, share } => ("drive", limit, share),
        Saturation::Recording { limit, share } => ("recording", limit, share),
        Saturation::Beyond { limit, share } => ("beyond", limit, share),
    };
    json!({"of": of, "limit_n": number(Some(limit)), "share": number(Some(share))})
}
