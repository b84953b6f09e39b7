//! Overrides as they are given on the command line.

use std::str::FromStr;

use gwatt::machine::{Limits, OverrideAt};

/// Percent above which an override is a slip of the pen.
const PERCENT_MAX: f64 = 1000.0;

/// The knobs stand here; factors, 1 = 100 %. What is not given stays at the
/// machine's largest.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct OverrideArg {
    feed: Option<f64>,
    rapid: Option<f64>,
    spindle: Option<f64>,
}

impl OverrideArg {
    /// Makes these the overrides of a machine, and the only ones.
    pub fn apply(self, limits: &mut Limits) {
        let Self {
            feed,
            rapid,
            spindle,
        } = self;
        limits.override_at = Some(OverrideAt {
            feed: feed.unwrap_or(limits.feed_override_max),
            rapid: rapid.unwrap_or(limits.rapid_override_max),
            spindle: spindle.unwrap_or(limits.spindle_override_max),
        });
    }
}

impl FromStr for OverrideArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut given = Self::default();
        for item in text.split(',') {
            let Some((knob, value)) = item.split_once('=') else {
                let factor = factor(item)?;
                put(&mut given.feed, factor, "feed")?;
                put(&mut given.rapid, factor.min(1.0), "rapid")?;
                continue;
            };
            let factor = factor(value)?;
            match knob.trim() {
                "feed" => put(&mut given.feed, factor, "feed")?,
                "rapid" if factor > 1.0 => {
                    return Err("the rapids' own speed is 100 %; no override exceeds it".into());
                }
                "rapid" => put(&mut given.rapid, factor, "rapid")?,
                "spindle" => put(&mut given.spindle, factor, "spindle")?,
                other => {
                    return Err(format!(
                        "`{other}` is no override; there are feed, rapid and spindle"
                    ));
                }
            }
        }
        Ok(given)
    }
}

fn put(knob: &mut Option<f64>, factor: f64, name: &str) -> Result<(), String> {
    match knob.replace(factor) {
        None => Ok(()),
        Some(_) => Err(format!("{name} is given twice")),
    }
}

/// Percent, with the sign or without, as a factor.
fn factor(text: &str) -> Result<f64, String> {
    let number = text.trim().trim_end_matches('%').trim_end();
    match number.parse::<f64>() {
        Ok(percent) if percent > 0.0 && percent <= PERCENT_MAX => Ok(percent / 100.0),
        _ => Err(format!(
            "`{text}` is no override; a number of percent above 0 and up to {PERCENT_MAX} is needed"
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn overrides_are_percent() {
        let of = |text: &str| text.parse::<OverrideArg>();
        let both = |feed, rapid| OverrideArg {
            feed,
            rapid,
            spindle: None,
        };
        assert_eq!(of("70%"), Ok(both(Some(0.7), Some(0.7))));
        assert_eq!(of("150"), Ok(both(Some(1.5), Some(1.0))));
        assert_eq!(of("feed=70%,rapid=50"), Ok(both(Some(0.7), Some(0.5))));
        assert_eq!(of("spindle=80%").unwrap().spindle, Some(0.8));
        for (wrong, why) in [
            ("", "`` is no override; a number"),
            ("0", "above 0"),
            ("-5%", "above 0"),
            ("NaN", "above 0"),
            ("speed=70%", "`speed` is no override; there are feed"),
            ("rapid=110%", "100 %; no override exceeds it"),
            ("70%,feed=60%", "feed is given twice"),
        ] {
            let error = of(wrong).unwrap_err();
            assert!(error.contains(why), "{wrong}: {error}");
        }
    }
}
