//! What F of a tap is, and the words of a canned cycle that other controls have for tools (Mazak
//! EIA/ISO programming manual, "Fixed cycle functions", G74 and G84: D and H; Mitsubishi M700V
//! programming manual, "Tapping cycle": F and `,R`).

use crate::code::Motion;
use crate::control::{Control, Run};
use crate::report::Report;
use gwatt_machine::TapFeed;
use gwatt_motion::FeedMode;
use gwatt_syntax::{Block, Word};

/// G74 and G84 (number × 10).
fn is_tap(number: u16) -> bool {
    matches!(number, 740 | 840)
}

impl Control<'_> {
    /// Whether D and H in this block belong to a canned cycle.
    pub(crate) fn cycle_has_d_and_h(&self, run: &Run<'_, '_>) -> bool {
        let cycle = matches!(self.modal.motion, Motion::Special(_));
        let drills = run.words.has_axes() || run.words.has(b'R') || run.facts.motion_word.is_some();
        cycle && drills && self.machine.controller.language.cycles_take_d_and_h
    }

    /// Takes D and H, where they are words of the cycle; `None` where they are not followed.
    pub(super) fn d_and_h(&mut self, number: u16, run: &mut Run<'_, '_>) -> Option<()> {
        if !self.machine.controller.language.cycles_take_d_and_h {
            return Some(());
        }
        if run.words.take(b'D').is_some_and(|distance| distance != 0.0) {
            run.cycle_value(
                b'D',
                "D of a canned cycle, a distance from R, is not followed",
            );
            return None;
        }
        let Some(h) = run.words.take(b'H') else {
            return Some(());
        };
        if !is_tap(number) {
            run.cycle_value(
                b'H',
                "H of a canned cycle that does not tap is not followed",
            );
            return None;
        }
        if h != 0.0 && !(1.0..=9999.0).contains(&h) {
            let message = "H of a tap is 0, or the speed of the return in percent, from 1 on";
            run.cycle_value(b'H', message);
            return None;
        }
        self.special.held.tap_h = Some(h);
        Some(())
    }

    /// Takes J of a tap, where it says how fast that comes out (Haas mill operator's manual, "G84
    /// Tapping Canned Cycle": retract multiple); `None` where it is no such number.
    pub(super) fn return_by_j(&mut self, number: u16, run: &mut Run<'_, '_>) -> Option<()> {
        if !(self.dialect().taps_return_by_j && is_tap(number)) {
            return Some(());
        }
        let Some(multiple) = run.words.take(b'J') else {
            return Some(());
        };
        if !(1.0..=9.0).contains(&multiple) || multiple.fract() != 0.0 {
            let message = "J of a tap is how many times as fast it comes out, from 1 to 9";
            run.cycle_value(b'J', message);
            return None;
        }
        self.special.held.tap_j = Some(multiple);
        Some(())
    }

    /// The return of a synchronous tap as H or J gives it, as a multiple of its feed.
    pub(super) fn tap_return_by_word(&self) -> Option<f64> {
        let held = &self.special.held;
        let by_h = held.tap_h.filter(|percent| *percent >= 1.0);
        // Whether J holds for the holes after its own is not known: the faster counts.
        let usual = self.machine.controller.language.tap_return_factor;
        let by_j = held
            .tap_j
            .map(|multiple| multiple.max(usual.unwrap_or(1.0)));
        by_h.map(|percent| percent / 100.0).or(by_j)
    }

    /// The speed of a tap, mm/s, where it is not that of the feed mode.
    pub(super) fn tap_feed_mm_s(&self, run: &mut Run<'_, '_>) -> Result<Option<f64>, ()> {
        let meaning = match self.special.held.tap_h {
            Some(0.0) => TapFeed::PerMinute,
            Some(_) => TapFeed::Pitch,
            None => self.machine.controller.language.tap_feed,
        };
        let by_turns = self.feed_mode_is(FeedMode::PerRevolution);
        let Some(feed) = &self.modal.feed else {
            return Ok(None);
        };
        if meaning == TapFeed::PerMinute || by_turns {
            return Ok(None);
        }
        let whole = run.whole();
        let rpm = self.modal.spindle_rpm;
        if rpm <= 0.0 {
            let message = "a tap whose F may be its pitch, but no spindle speed is in force";
            run.report
                .error("no-spindle-speed", message, whole)
                .help("write S before it");
            return Err(());
        }
        // As if F were for each turn.
        let pitch_mm_s = feed.linear_mm_s() * rpm;
        if meaning == TapFeed::Pitch {
            return Ok(Some(pitch_mm_s));
        }
        let message = "F of a tap is its pitch or a feed per minute, as a parameter of the control \
                       says: the faster counts; say tap_feed = \"pitch\" or \"per-minute\" under \
                       [language] of the machine file, on a Mazak also H in the block";
        run.report.note_once("tap-feed", message, whole);
        Ok(Some(pitch_mm_s.max(feed.linear_mm_s())))
    }

    /// Whether a block taps, for what stands in it with a comma.
    pub(crate) fn taps(&self, block: &Block) -> bool {
        let by_pitch = self.machine.controller.language.tap_feed != TapFeed::PerMinute;
        let begins = |word: &Word| word.letter == b'G' && [74.0, 84.0].contains(&word.value);
        let goes_on = matches!(self.modal.motion, Motion::Special(number) if is_tap(number));
        by_pitch && (goes_on || block.words.iter().any(begins))
    }

    /// `,R` of a tap: 1 says that F is the pitch. It would hold until the cycle ends; where the
    /// machine file says the same, nothing has to be kept.
    pub(crate) fn comma_of_tap(&self, word: &Word, report: &mut Report<'_, '_>) {
        let pitch = self.machine.controller.language.tap_feed == TapFeed::Pitch;
        if pitch && word.letter == b'R' && word.value == 1.0 {
            return;
        }
        let message = "`,R` of a tap, which says whether F is its pitch";
        report.error("cycle-word", message, word.span).help(
            "say tap_feed = \"pitch\" under [language] of the machine file, and write `,R1` or \
             none",
        );
    }
}
