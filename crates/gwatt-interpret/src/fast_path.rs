//! The short way through a block: straight moves with F, from state in which
//! nothing else can come of them. Nearly every block of a long program is one.
//!
//! It gives up before it has touched anything, and the block then goes through
//! `execute`; the tests of this file hold the two equal.

use super::code::Motion;
use super::control::Control;
use super::facts::Facts;
use super::modal::{Feed, NumberText};
use super::places::{EXTRUDER, POSITION_MAX_MM, STANDSTILL_MM};
use super::words::axis_of;
use crate::rules::rules_of;
use gwatt_machine::{AxisKind, AxisSet, AxisValues, Machine};
use gwatt_motion::{FeedMode, Move, MoveKind, Step, Stray, path_length};
use gwatt_syntax::{Block, Word};

/// Whether a controller's plain words always mean the same.
pub(super) fn is_direct(machine: &Machine) -> bool {
    let language = &machine.controller.language;
    let dialect = &language.dialect;
    rules_of(language).fixed_meaning && !dialect.active && !dialect.adapts()
}

/// What the words of a straight move say.
struct Straight<'a> {
    motion: Motion,
    motion_word: Option<&'a Word>,
    feed_word: Option<&'a Word>,
    end: AxisValues,
    moving: AxisSet,
}

impl Control<'_> {
    /// Executes a block of straight motion; `None` when it is, or may be,
    /// anything more, and nothing has happened then.
    #[inline]
    pub(super) fn direct(
        &mut self,
        line: u64,
        text: &[u8],
        block: &Block,
        steps: &mut Vec<Step>,
        facts: &mut Facts,
    ) -> Option<()> {
        let skipped = block.tape || block.delete_level > 0;
        if !self.may_go_direct() || skipped || self.may_hide_words(text, block) {
            return None;
        }
        let mut straight = Straight {
            motion: self.modal.motion,
            motion_word: None,
            feed_word: None,
            end: self.position.at,
            moving: AxisSet::default(),
        };
        self.read_straight(block, &mut straight)?;
        let uses_feed = match straight.motion {
            Motion::Rapid => self.machine.controller.language.rapid_uses_feed,
            Motion::Linear => true,
            _ => return None,
        };
        let feed = match straight.feed_word {
            Some(word) => Some(plain_feed(word, text, self.modal.mm_per_unit)?),
            None => None,
        };
        let Straight { end, moving, .. } = &straight;
        let way = self.direct_way(end, *moving)?;
        let (kind, feed_mm_s) = self.direct_speed(uses_feed, feed.as_ref(), end, way)?;

        let known = AxisSet::default();
        let (accel_mm_s2, path_accel_mm_s2) = self.accels(kind, *moving, end, known);
        // From here on, it happens.
        (self.moved, self.printer.stands, self.printer.pending) = (true, false, *moving);
        steps.push(Step::Move(Move {
            line,
            number: block.number.map(|word| word.value),
            run: self.run,
            text: self.text,
            kind,
            start: self.position.at,
            end: *end,
            moving: *moving,
            unknown_start: known,
            assumed_start: known,
            arc: None,
            length_mm: way.0,
            feed_mm_s,
            feed_excess: 1.0,
            feed_mode: FeedMode::PerMinute,
            accel_mm_s2,
            path_accel_mm_s2,
            jerk_factor: self.knobs.jerk_of(*moving),
            rapid_factor: self.knobs.rapid_factor,
            pace: 1.0,
            dwell_s: 0.0,
            loads: self.loads.on(),
            path_mode: self.modal.path_mode,
            corner: self.modal.corner,
            stray: Stray::NONE,
        }));
        *facts = Facts {
            feed_word: straight.feed_word.copied(),
            motion_word: straight.motion_word.copied(),
            uses_motion: true,
            uses_feed,
            executed: true,
            plain: straight.motion == self.modal.motion
                && self.special.active == 0
                && feed.is_none_or(|feed| self.modal.feed == Some(feed)),
            feed_mm_per_unit: self.modal.mm_per_unit,
            ..Facts::default()
        };
        self.begun = true;
        self.position.at = *end;
        if straight.motion_word.is_some() {
            self.modal.motion = straight.motion;
            self.special.active = 0;
            self.special.spline.end();
        }
        if feed.is_some() {
            self.modal.feed = feed;
        }
        Some(())
    }

    /// What kind of move it is and its speed; `feed`: the F of its block. `None` also for a rapid
    /// while a laser is lit.
    #[inline]
    fn direct_speed(
        &self,
        uses_feed: bool,
        feed: Option<&Feed>,
        end: &AxisValues,
        way: (f64, bool),
    ) -> Option<(MoveKind, f64)> {
        if uses_feed {
            let feed = feed.or(self.modal.feed.as_ref())?;
            return Some((MoveKind::Feed, self.straight_speed(feed, end, way)?));
        }
        (!self.beam_waits_for_feed()).then_some((MoveKind::Rapid, f64::INFINITY))
    }

    /// The way to `end`: its length and whether linear axes move; `None` where a laser may wait for
    /// the axes there.
    #[inline]
    fn direct_way(&self, end: &AxisValues, moving: AxisSet) -> Option<(f64, bool)> {
        let way = path_length(&self.position.at, end, moving, None);
        (!self.is_empty_way(way.0)).then_some(way)
    }

    /// The speed of a straight feed to `end`, on a way with its length and whether linear axes
    /// move, mm/s; `None` for an F that is none.
    #[inline]
    fn straight_speed(
        &self,
        feed: &Feed,
        end: &AxisValues,
        (length_mm, linear): (f64, bool),
    ) -> Option<f64> {
        let speed_mm_s = if linear {
            feed.linear_mm_s()
        } else {
            feed.rotary_deg_s()
        };
        let most_mm_s = self
            .machine
            .max_feed_mm_s(&self.position.at, end, length_mm);
        (feed.value > 0.0).then(|| speed_mm_s.min(most_mm_s))
    }

    /// Reads words of axes, G0, G1 and F; `None` for others, for none of an
    /// axis, and for what is to be reported.
    #[inline]
    fn read_straight<'a>(&self, block: &'a Block, straight: &mut Straight<'a>) -> Option<()> {
        let modal = &self.modal;
        let mut named = AxisSet::default();
        for word in &block.words {
            let Some(axis) = axis_of(word.letter) else {
                match word.letter {
                    b'F' if straight.feed_word.is_none() && word.value >= 0.0 => {
                        straight.feed_word = Some(word);
                    }
                    b'G' if straight.motion_word.is_none() => {
                        straight.motion = match word.value {
                            0.0 => Motion::Rapid,
                            1.0 => Motion::Linear,
                            _ => return None,
                        };
                        straight.motion_word = Some(word);
                    }
                    _ => return None,
                }
                continue;
            };
            let absolute = if axis == EXTRUDER {
                modal.extruder_absolute
            } else {
                modal.absolute
            };
            let unknown = self.position.apart.contains(axis) && absolute;
            if named.contains(axis) || unknown {
                return None;
            }
            named.insert(axis);
            let mut value = word.value;
            if self.machine.axes[axis].as_ref()?.kind == AxisKind::Linear {
                value *= modal.mm_per_unit;
            }
            let start = straight.end[axis];
            let end = if absolute {
                self.position.frame.shifted(axis, value)
            } else {
                start + value
            };
            if end.abs() > POSITION_MAX_MM {
                return None;
            }
            if (end - start).abs() > STANDSTILL_MM {
                straight.moving.insert(axis);
            }
            straight.end[axis] = end;
        }
        (!named.is_empty()).then_some(())
    }

    /// Whether the state lets a straight move be just that.
    #[inline]
    pub(super) fn may_go_direct(&self) -> bool {
        self.direct
            && !self.ended
            && !self.bent
            && !self.printer.adjusts
            && self.modal.feed_mode == FeedMode::PerMinute
            && self.compensation.is_none()
            && self.corners.is_none()
            && self.special.left.is_none()
            && self.pending_actions.is_empty()
            && !self.loads.are_hidden()
            && self.knobs.pending.is_none()
            && !self.knobs.is_paced()
            && self.callee.is_none()
            && self.transfer.is_none()
    }
}

/// The feed that a word sets; `None` for one that is worked out.
fn plain_feed(word: &Word, text: &[u8], mm_per_unit: f64) -> Option<Feed> {
    let text = word.number.of(text);
    let plain = |byte: &u8| matches!(byte, b'0'..=b'9' | b'.' | b'+' | b'-' | b' ' | b'\t');
    text.iter().all(plain).then(|| Feed {
        value: word.value,
        mm_per_unit,
        text: NumberText::new(text),
        expression: NumberText::default(),
    })
}

#[cfg(test)]
mod tests;
