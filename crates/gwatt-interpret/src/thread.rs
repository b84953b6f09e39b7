//! G33 and G33.1: moves in step with the spindle (`LinuxCNC` "G33 Spindle
//! Synchronized Motion", "G33.1 Spindle Synchronized Rigid Tapping").
//!
//! K is the way in one revolution, along the path.

use super::control::{Control, Run};
use super::special::Turning;
use gwatt_machine::units::SECONDS_PER_MINUTE;
use gwatt_motion::MoveKind;

/// Why no word of such a block is changed.
pub(super) const FIXED: &str = "it moves in step with the spindle";

impl Control<'_> {
    /// G33 (330) and G33.1 (331).
    pub(super) fn thread(&mut self, number: u16, run: &mut Run<'_, '_>) {
        run.facts.fixed = Some(FIXED);
        self.special.active = 0;
        let start = self.believed();
        let mut end = start;
        let Some(unknown) = self.targets(run, false, &mut end) else {
            return;
        };
        let Some(pitch) = run.words.take(b'K') else {
            let whole = run.whole();
            run.report
                .error("thread-pitch", "a thread without its pitch K", whole)
                .help("write K in every block: the way in one revolution");
            return;
        };
        let Some(speed_mm_s) = self.thread_speed(pitch, b'K', run) else {
            return;
        };
        self.special.speed_mm_s = Some(speed_mm_s);
        if number == 330 {
            self.go(run, MoveKind::Thread, &end, unknown, None);
        } else if !unknown.is_empty() {
            let whole = run.whole();
            run.report
                .error(
                    "tap-from-unknown",
                    "G33.1 comes back to where it began, which is not known",
                    whole,
                )
                .help("move the axes to a known position first, or give --start X0,Y0,Z0");
        } else {
            let faster = run.words.take(b'I').filter(|value| *value != 0.0);
            let faster = faster.unwrap_or(1.0);
            if !(0.0..=1e3).contains(&faster) {
                let span = run.words.span(b'I', run.block);
                run.report
                    .error(
                        "thread-pitch",
                        "I of G33.1 is negative or beyond reason",
                        span,
                    )
                    .help("write how much faster it goes out");
                return;
            }
            // Back to where it stands, wherever the control believes it.
            let stood = self.position.at;
            self.part(run, MoveKind::Tap, &end);
            let turning = self.special.spindle;
            run.spin(turning.reversed());
            self.special.speed_mm_s = Some(speed_mm_s * faster);
            self.part(run, MoveKind::Tap, &stood);
            self.special.left = (stood != start).then_some(start);
            run.spin(turning);
        }
        self.special.speed_mm_s = None;
    }

    /// Speed of a thread with a pitch in program units, mm/s; reports what is
    /// missing.
    pub(super) fn thread_speed(
        &self,
        pitch: f64,
        letter: u8,
        run: &mut Run<'_, '_>,
    ) -> Option<f64> {
        let whole = run.whole();
        if self.special.spindle == Turning::Stopped {
            run.report
                .error(
                    "thread-spindle",
                    "a thread, but the spindle does not turn",
                    whole,
                )
                .help("write M3 or M4 before it");
            return None;
        }
        if self.modal.spindle_rpm <= 0.0 {
            run.report
                .error(
                    "no-spindle-speed",
                    "a thread, but no spindle speed is in force",
                    whole,
                )
                .help("write S before it");
            return None;
        }
        if !(pitch > 0.0 && pitch < 1e6) {
            let span = run.words.span(letter, run.block);
            run.report
                .error("thread-pitch", "the pitch must be greater than 0", span)
                .help("check the number");
            return None;
        }
        Some(pitch * self.modal.mm_per_unit * self.modal.spindle_rpm / SECONDS_PER_MINUTE)
    }
}
