//! The path speed that F asks for.

use super::control::{Control, Run};
use super::modal::FEED_MODE_UNKNOWN;
use gwatt_machine::AxisValues;
use gwatt_machine::units::SECONDS_PER_MINUTE;
use gwatt_motion::{Arc, FeedMode};

const FEED_MODE_NOT_SAID: &str = "neither G94 nor G95 says what F means: it counts per revolution, the faster; say feed = \
     \"per-minute\" or \"per-revolution\" under [language] of the machine file";

impl Control<'_> {
    /// The path speed that F asks for, mm/s; reports an F that is missing.
    pub(super) fn feed_speed(
        &self,
        run: &mut Run<'_, '_>,
        end: &AxisValues,
        arc: Option<&Arc>,
        length_mm: f64,
        linear: bool,
    ) -> Option<f64> {
        let span = run.whole();
        let feed = match &self.modal.feed {
            Some(feed) if feed.value > 0.0 => feed,
            Some(_) => {
                run.report
                    .error("no-feed", "a feed move with F0", span)
                    .help("write the feed: F…");
                return None;
            }
            None => {
                if let Some(message) = self.rules.without_feed {
                    run.report.note_once("no-feed-yet", message, span);
                    return Some(f64::INFINITY);
                }
                run.report
                    .error("no-feed", "a feed move, but no F is in force", span)
                    .help("write F in this block or before; after G93, G94 or G95 it must be written again");
                return None;
            }
        };
        if self.feed_mode_is(FeedMode::InverseTime) {
            if self.rules.block_time_in_seconds {
                return Some(length_mm / feed.value);
            }
            if run.facts.feed_word.is_none() {
                let help = "under G93 every block needs its own F";
                run.report
                    .error("no-feed", "a feed move without F under G93", span)
                    .help(help);
                return None;
            }
            return Some(length_mm * feed.value / SECONDS_PER_MINUTE);
        }
        let per_unit = if linear {
            feed.linear_mm_s()
        } else {
            feed.rotary_deg_s()
        };
        if self.feed_mode_is(FeedMode::PerMinute) {
            return Some(per_unit);
        }
        let followed = self.spindle.followed_rpm;
        let rpm = followed.unwrap_or_else(|| self.highest_rpm(end, arc));
        let rpm = rpm.max(self.spindle.tool_rpm).max(self.spindle.left_rpm);
        if self.spindle.surface_mm_min.is_some() {
            let message = "under G96 a feed per revolution counts at the highest spindle speed \
                           of its block";
            run.report.note_once("surface-speed", message, span);
        }
        let unknown = self.modal.feed_mode_word == FEED_MODE_UNKNOWN;
        if unknown {
            run.report.note_once("feed-mode", FEED_MODE_NOT_SAID, span);
        }
        if rpm > 0.0 {
            // A turn takes less than a minute, but for the slowest of spindles.
            return Some(if unknown {
                per_unit * rpm.max(1.0)
            } else {
                per_unit * rpm
            });
        }
        if unknown {
            return Some(f64::INFINITY);
        }
        run.report
            .error(
                "no-spindle-speed",
                "a feed per revolution, but no spindle speed is in force",
                span,
            )
            .help("write S before the first move under G95");
        None
    }
}
