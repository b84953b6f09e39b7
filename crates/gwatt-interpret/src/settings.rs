//! Words that set modal state: feed, units, plane, modes; and the time of a
//! dwell.

use super::code::{GCode, Motion};
use super::control::{Control, Run};
use super::feed_expression::expression_of;
use super::g_codes::path_mode;
use super::modal::{Feed, NumberText};
use gwatt_machine::{PathMode, Point};
use gwatt_motion::{ActionKind, Corner, FeedMode};
use gwatt_syntax::source::Span;

/// Seconds in a least increment of the time of a dwell.
const LEAST_S: f64 = 1e-3;

impl Control<'_> {
    pub(super) fn feed_mode(&mut self, run: &mut Run<'_, '_>) {
        for index in 0..run.words.g.len() {
            let (code, number, _) = run.words.g[index];
            if let GCode::FeedMode(mode) = code {
                self.note_feed(f64::from(number) / 10.0, run);
                if mode != self.modal.feed_mode {
                    // An F of another meaning must not be taken over.
                    self.modal.feed = None;
                }
                self.modal.feed_mode = mode;
                self.modal.feed_mode_word = number;
            }
        }
    }

    /// Takes the F word. LinuxCNC reads it in the unit in force before the
    /// block; the others in the unit that the block itself sets.
    pub(super) fn read_feed(&mut self, run: &mut Run<'_, '_>) {
        let mut mm_per_unit = self.modal.mm_per_unit;
        if !self.rules.feed_in_old_unit || self.is_grbl() {
            for (code, ..) in &run.words.g {
                if let GCode::Units { mm_per_unit: unit } = code {
                    mm_per_unit = *unit;
                }
            }
        }
        run.facts.feed_mm_per_unit = mm_per_unit;
        if self.rules.block_time_in_seconds && self.feed_mode_is(FeedMode::InverseTime) {
            run.facts.own_feed = Some("its feed is the time of a block (G93)");
        }
        if run.words.take(b'F').is_none() {
            return;
        }
        let Some(word) = run.words.word(b'F', run.block) else {
            return;
        };
        if word.value < 0.0 {
            run.report
                .error("negative-feed", "the feed is negative", word.span)
                .help("write a positive F");
            return;
        }
        let text = word.number.of(run.report.text);
        let plain = |byte: &u8| matches!(byte, b'0'..=b'9' | b'.' | b'+' | b'-' | b' ' | b'\t');
        run.facts.computed_feed = !text.iter().all(plain);
        let shown;
        let (text, expression) = if run.facts.computed_feed {
            // Put back elsewhere, the expression might have another value.
            shown = word.value.to_string();
            (shown.as_bytes(), expression_of(word, run.report.text))
        } else {
            (text, NumberText::default())
        };
        run.facts.feed_word = Some(word);
        let feed = Feed {
            value: word.value,
            mm_per_unit,
            text: NumberText::new(text),
            expression,
        };
        let before = self.modal.feed.as_ref();
        let same = before.is_some_and(|before| before.value == feed.value);
        if !same && !run.words.has_axes() {
            self.note_feed(0.0, run);
        }
        self.modal.feed = Some(feed);
    }

    /// Plane, units, compensation, offsets, path and distance mode.
    pub(super) fn settings(&mut self, run: &mut Run<'_, '_>) {
        self.motion_word(run);
        self.compensation_words(run);
        for index in 0..run.words.g.len() {
            let (code, number, span) = run.words.g[index];
            match code {
                GCode::Plane(plane) => self.choose_plane(plane, span, run),
                GCode::Units { mm_per_unit } => {
                    self.modal.mm_per_unit = mm_per_unit;
                    self.modal.unit_is_said = true;
                }
                GCode::ToolLength(form) => self.tool_length(form, span, run),
                GCode::Diameter(on) => self.modal.diameter = on,
                GCode::Polar(on) => self.polar_mode(on, span, run),
                GCode::PathMode => self.path_mode(number, run),
                GCode::MirrorX => self.mirror_x(span, run),
                GCode::Ignored if self.moves_of_itself(b'G', number) => {
                    self.builder_moves(number, span, run);
                }
                GCode::Ignored => self.arguments_of_ignored(number, run),
                GCode::Retract(initial) => self.retract_level(initial, span, run),
                GCode::Absolute(absolute) => {
                    self.modal.absolute = absolute;
                    self.distance_stated();
                }
                GCode::ArcAbsolute(absolute) => self.modal.arc_absolute = absolute,
                GCode::MachineCoordinates => run.facts.machine_coordinates = true,
                GCode::WorkOffset(system) => self.select_system(u16::from(system), span, run),
                GCode::FurtherOffset => self.further_offset(span, run),
                GCode::Osp(code) => self.osp_setting(code, span, run),
                _ => {}
            }
        }
        if !self.cycle_has_d_and_h(run) {
            self.tool_length_again(run);
        }
        self.note_bent();
    }

    /// The motion of a block, in exact stop where a word of it asks for that.
    pub(super) fn motion_in_mode(&mut self, run: &mut Run<'_, '_>) {
        let mut words = run.words.g.iter();
        if !words.any(|(code, ..)| *code == GCode::ExactOnce) {
            return self.motion(run);
        }
        let kept = (self.modal.path_mode, self.modal.corner);
        (self.modal.path_mode, self.modal.corner) = (PathMode::ExactStop, Corner::Exact);
        self.motion(run);
        (self.modal.path_mode, self.modal.corner) = kept;
    }

    /// The ISG kernel ends a turn where the plane changes, with a warning.
    fn choose_plane(&mut self, plane: [usize; 3], span: Span, run: &mut Run<'_, '_>) {
        let ends_turn = self.rules.plane_ends_turn && plane != self.modal.plane;
        if !ends_turn || !self.refuse_while_turned(span, run) {
            self.modal.plane = plane;
        }
    }

    /// The word of the motion group.
    #[inline]
    pub(super) fn motion_word(&mut self, run: &mut Run<'_, '_>) {
        for (code, _, span) in &run.words.g {
            if let GCode::Motion(motion) = *code {
                let Some(motion) = self.enter(motion, run.words.groups) else {
                    continue;
                };
                self.modal.motion = motion;
                let words = run.block.words.iter().copied();
                run.facts.motion_word = words.into_iter().find(|word| word.span == *span);
            }
        }
    }

    /// Mirroring in X from X0 changes the sign of every X and with it no power,
    /// as long as X carries no weight.
    fn mirror_x(&self, span: Span, run: &mut Run<'_, '_>) {
        let weightless = self.machine.axes[0].is_none_or(|axis| axis.gravity_n == 0.0);
        if weightless && self.position.at[0] == 0.0 && self.position.absolute(0, 0.0) == 0.0 {
            let message = "G20 and G21 switch mirroring in X, not the unit (G70, G71): \
                           the sign of X is not shown, its power is the same";
            run.report.note_once("mirrored-x", message, span);
            return;
        }
        run.report
            .error(
                "mirrored-x",
                "G20 and G21 switch mirroring in X on this controller",
                span,
            )
            .help("for the unit write G70 (inch) or G71 (mm); mirroring is followed only at X0");
    }

    pub(super) fn path_mode(&mut self, number: u16, run: &mut Run<'_, '_>) {
        let asked = path_mode(number, &self.machine.controller.language);
        let exact = self.machine.path.mode == Some(PathMode::ExactStop);
        self.modal.path_mode = if exact { PathMode::ExactStop } else { asked };
        // "G64 Path Blending" (`LinuxCNC`): Q is P where only P is given.
        let blends = number == 640 || number == 3590;
        self.modal.corner = if blends {
            let mm_per_unit = self.modal.mm_per_unit;
            let [p, q] = [b'P', b'Q'].map(|letter| run.words.take(letter));
            let [tolerance_mm, join_mm] =
                [p, p.and(q.or(p))].map(|value| value.unwrap_or(0.0).max(0.0) * mm_per_unit);
            Corner::Round {
                tolerance_mm,
                join_mm,
            }
        } else {
            Corner::Exact
        };
        self.modal.corner_known = true;
        run.act(ActionKind::PathMode, f64::from(number) / 10.0);
    }

    pub(super) fn dwell_time(&mut self, run: &mut Run<'_, '_>) -> Option<f64> {
        if run.words.groups & GCode::Dwell.group() == 0 {
            return None;
        }
        let language = &self.machine.controller.language;
        let mut seconds = None;
        let span = run.whole();
        for (letter, unit) in &language.dwell {
            run.facts.dwell_takes_feed |= *letter == b'F';
            let Some(value) = run.words.take(*letter) else {
                continue;
            };
            // Of P and X one may be the time and the other a motion.
            if seconds.is_some() && !self.rules.lenient_dwell {
                run.report
                    .error("dwell-time", "two words could be the time of G4", span)
                    .help("write the dwell in a block of its own, with one time");
            }
            let whole = run
                .words
                .word(*letter, run.block)
                .is_some_and(|word| !word.number.of(run.report.text).contains(&b'.'));
            let dialect = &language.dialect;
            let own = dialect.dwell_whole.iter().find(|(name, _)| name == letter);
            let unit = own.filter(|_| whole).map_or(*unit, |(_, unit)| *unit);
            let fine = whole
                && own.is_none()
                && matches!(letter, b'X' | b'U')
                && self.counts_least(span, run);
            seconds = Some(value * if fine { unit * LEAST_S } else { unit });
        }
        match seconds {
            Some(time) if (0.0..=1e9).contains(&time) => return seconds,
            Some(_) => {
                let message = "the time of G4 is negative or beyond reason";
                run.report
                    .error("dwell-time", message, span)
                    .help("write a time from 0 to 1e9 s");
            }
            None if self.rules.lenient_dwell => return Some(0.0),
            None => {
                let letters: Vec<_> = language
                    .dwell
                    .iter()
                    .map(|(letter, _)| char::from(*letter).to_string())
                    .collect();
                let help = format!(
                    "this controller takes the time from {}",
                    letters.join(" or ")
                );
                run.report
                    .error("dwell-time", "G4 without a time", span)
                    .help(help);
            }
        }
        None
    }

    /// Whether a time that is written as a length, without a point, counts milliseconds as that
    /// would count least increments (B-63944EN, "Dwell (G04)"). Where it is not known how numbers
    /// without a point count, the shorter time does.
    fn counts_least(&self, span: Span, run: &mut Run<'_, '_>) -> bool {
        let dialect = self.dialect();
        match dialect.point {
            Some(Point::LeastIncrement) => true,
            Some(Point::Calculator) if !dialect.point_is_known => {
                let message = "the time of a dwell without a decimal point is counted in \
                               milliseconds, the shorter of two; write decimal_point under \
                               [language] in the machine file, or the time with a point";
                run.report.note_once("dwell-unit", message, span);
                true
            }
            _ => false,
        }
    }

    /// True when F counts for the motion in force.
    pub(super) fn obeys_feed(&self) -> bool {
        match self.modal.motion {
            Motion::None | Motion::Special(_) => false,
            Motion::Rapid => self.machine.controller.language.rapid_uses_feed,
            Motion::Linear | Motion::ArcCw | Motion::ArcCcw => true,
        }
    }

    /// Whether the feed mode in force is `mode`.
    pub(super) fn feed_mode_is(&self, mode: FeedMode) -> bool {
        self.modal.feed_mode == mode
    }
}
