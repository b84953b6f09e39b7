//! Moves whose speed is found elsewhere: by measure (see [`Paces`](super::Paces)), or with their
//! neighbours.

use super::case::Case;
use super::change::{Change, feed_word, round_to_step};
use super::lever::{Levers, Obstacle, SpeedLever};
use super::solver::Solver;
use gwatt_plan::blended_speed;

impl Solver<'_> {
    /// A change that holds a move to a speed, mm/s at the largest override, besides what
    /// `with` does.
    ///
    /// # Errors
    /// What stands in the way.
    pub(super) fn held(
        &self,
        case: Case<'_>,
        levers: &Levers,
        with: &Change,
        most_mm_s: f64,
    ) -> Result<Change, Obstacle> {
        let Case { mv, permit, .. } = case;
        let changed = with.apply(self.machine, mv, permit);
        let own_mm_s = if changed.unknown_start.is_empty() {
            blended_speed(self.machine, &changed, self.largest)
        } else {
            self.fastest_axis(&changed)
        };
        if own_mm_s <= most_mm_s {
            return Ok(*with);
        }
        let lever = levers.speed.ok_or_else(|| self.no_speed_lever(case))?;
        let asked_mm_s = most_mm_s / self.largest.feed;
        let mut change = *with;
        match lever {
            SpeedLever::FeedWord | SpeedLever::AsFeed => {
                change.as_feed = lever == SpeedLever::AsFeed;
                change.exact_stop |= change.as_feed && case.exact_stop;
                let feed = feed_word(self.machine, mv, permit, asked_mm_s);
                let positive = feed > 0.0 && feed.is_finite();
                change.feed = positive.then_some(feed);
            }
            SpeedLever::RapidPercent(knob) => {
                let step = self.machine.controller.knobs.get(knob).map(|it| it.step);
                let percent = changed.rapid_factor * 100.0 * most_mm_s / own_mm_s;
                let percent = round_to_step(percent, step.unwrap_or(1.0));
                change.rapid_percent = (percent > 0.0).then_some((knob, percent));
            }
            SpeedLever::Cap(knob) => {
                let values = self.cap_values(case, knob, asked_mm_s);
                change.speed = values.map(|values| (knob, values));
            }
        }
        if change == *with {
            return Err(self.too_much(case));
        }
        self.respect_floor(case, &change)?;
        Ok(change)
    }

    /// A change that leaves a move a share of the speed that it has with what `with` does;
    /// `None` where no word says it.
    pub(super) fn slowed(
        &self,
        case: Case<'_>,
        lever: SpeedLever,
        with: &Change,
        share: f64,
    ) -> Option<Change> {
        let Case { mv, permit, .. } = case;
        let changed = with.apply(self.machine, mv, permit);
        if let SpeedLever::RapidPercent(knob) = lever {
            let step = self.machine.controller.knobs.get(knob)?.percent_step();
            let percent = round_to_step(changed.rapid_factor * share * 100.0, step);
            return (percent > 0.0).then_some(Change {
                rapid_percent: Some((knob, percent)),
                ..*with
            });
        }
        let capped = matches!(lever, SpeedLever::Cap(_));
        let own_mm_s = if changed.unknown_start.is_empty() {
            blended_speed(self.machine, &changed, self.largest)
        } else if capped {
            self.fastest_axis(&changed)
        } else if lever == SpeedLever::AsFeed {
            let given_mm_s = changed.feed_mm_s * self.largest.feed;
            self.slowest_axis(mv).min(given_mm_s)
        } else {
            changed.feed_mm_s.min(1e6) * self.largest.feed
        };
        let speed_mm_s = own_mm_s * share / self.largest.feed;
        if let SpeedLever::Cap(knob) = lever {
            let values = self.cap_values(case, knob, speed_mm_s)?;
            return Some(Change {
                speed: Some((knob, values)),
                ..*with
            });
        }
        let feed = feed_word(self.machine, mv, permit, speed_mm_s);
        (feed > 0.0 && feed.is_finite()).then_some(Change {
            feed: Some(feed),
            as_feed: lever == SpeedLever::AsFeed,
            ..*with
        })
    }
}
