//! Limits over time, with the names of converters and files.

use crate::diagnostic::Diagnostic;
use crate::machine::{Machine, OverrideAt};
use crate::power::{Measure, Rating};

use crate::units::SECONDS_PER_MINUTE;

/// A limit over time and how near the program comes to it.
#[derive(Debug, Clone, PartialEq)]
pub struct OverTime {
    /// The figures.
    pub rating: Rating,
    /// Name of the converter; empty where there is one only.
    pub converter: String,
    /// The file that the line stands in; empty for the program itself.
    pub file: String,
    /// The program is known to have a place where it could wait, which is not permitted yet.
    pub may_pause: bool,
}

impl OverTime {
    /// With the names; `file` gives that of a text.
    pub(super) fn list(
        ratings: Vec<Rating>,
        machine: &Machine,
        file: impl Fn(u16) -> String,
    ) -> Vec<Self> {
        ratings
            .into_iter()
            .map(|rating| {
                let converter = machine.converters.get(rating.converter);
                Self {
                    rating,
                    converter: converter.map_or_else(String::new, |it| it.name.clone()),
                    file: file(rating.text),
                    may_pause: false,
                }
            })
            .collect()
    }

    /// What is limited, in words, such as `above 1980 W within 10 s`.
    #[must_use]
    pub fn title(&self) -> String {
        let mut title = match self.rating.measure {
            Measure::Overload {
                above_w, every_s, ..
            } => format!("overload above {above_w:.0} W within {every_s} s"),
            Measure::Continuous { window_s } if window_s >= SECONDS_PER_MINUTE => {
                let minutes = window_s / SECONDS_PER_MINUTE;
                format!("continuous power over {minutes} min")
            }
            Measure::Continuous { window_s } => format!("continuous power over {window_s} s"),
            Measure::LowestVoltage => "lowest bus voltage".to_owned(),
            Measure::HighestVoltage => "highest bus voltage".to_owned(),
            Measure::Brake { power_w } => {
                format!("braking resistor, energy beyond {power_w:.0} W")
            }
        };
        if !self.converter.is_empty() {
            title.push_str(", converter ");
            title.push_str(&self.converter);
        }
        if let Some(at) = &self.rating.overrides {
            title.push_str(&at_overrides(at));
        }
        if self.rating.any {
            title.push_str(", bound for all overrides");
        }
        title
    }

    /// Whether to wait may help: a power over time is missed.
    pub(super) fn pausing_helps(&self) -> bool {
        let means = matches!(
            self.rating.measure,
            Measure::Overload { .. } | Measure::Continuous { .. }
        );
        means && !self.rating.lasting && !self.rating.fits()
    }

    /// What helps where the limit is not kept.
    #[must_use]
    pub fn help(&self) -> &'static str {
        if self.rating.lasting {
            return "where it is not known when a move draws what, its largest power counts for \
                    as long as it may last: use exact stop, or lower the feed here";
        }
        match self.rating.measure {
            Measure::Overload { .. } | Measure::Continuous { .. } if self.may_pause => {
                "lower speeds or accelerations around this line, or let it pause (limit --allow \
                 pause)"
            }
            Measure::Overload { .. } | Measure::Continuous { .. } => {
                "lower speeds or accelerations around this line"
            }
            Measure::LowestVoltage => "lower speeds or accelerations here",
            Measure::HighestVoltage | Measure::Brake { .. } => "brake more slowly around this line",
        }
    }

    /// Why a program does not fit.
    pub(super) fn reason(&self) -> Diagnostic {
        let Rating {
            value,
            limit,
            measure,
            ..
        } = self.rating;
        let (title, unit) = (self.title(), measure.unit());
        let message = if value.is_finite() {
            format!("{title}: {value:.4} {unit} of {limit:.4} {unit}")
        } else {
            format!("{title}: more than {limit:.4} {unit}")
        };
        let mut reason = Diagnostic::error(measure.name(), message).help(self.help());
        reason.line = self.rating.line;
        reason
    }
}

/// At which lower overrides it is, such as ` at feed and rapid 50 %`.
fn at_overrides(at: &OverrideAt) -> String {
    let [feed, rapid] = [at.feed, at.rapid].map(|factor| (factor * 1000.0).round() / 10.0);
    if feed.to_bits() == rapid.to_bits() {
        format!(" at feed and rapid {feed} %")
    } else {
        format!(" at feed {feed} %, rapid {rapid} %")
    }
}
