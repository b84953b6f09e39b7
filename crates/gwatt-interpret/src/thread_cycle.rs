//! G76 of `LinuxCNC`: a thread in many passes ("G76 Threading Cycle"; the order
//! of moves as its interpreter 2.9 shows).
//!
//! From the drive line, on which the block begins: I to the thread's peak, then
//! K to its root; the sign of I says on which side. Pass n is J·n^(1/R) deep,
//! the last one K, followed by H spring passes. A pass goes in at the drive
//! line, along the thread to Z, and out; with Q its start is moved so that one
//! flank is cut; with L and E its ends run out over the length E.

use super::control::{Control, Run};
use super::thread::FIXED;
use gwatt_machine::AxisValues;
use gwatt_motion::MoveKind;

const X: usize = 0;
const Z: usize = 2;

/// The thread, lengths in program units.
struct Thread {
    /// +1: inner thread, −1: outer.
    side: f64,
    peak: f64,
    first_depth: f64,
    full_depth: f64,
    degression: f64,
    spring_passes: u64,
    /// Shift along the thread for each unit of depth.
    flank: f64,
    taper: f64,
    tapers_in: bool,
    tapers_out: bool,
    speed_mm_s: f64,
    taper_speed_mm_s: f64,
    start: AxisValues,
    end_z_mm: f64,
    /// Direction along Z.
    forward: f64,
}

impl Control<'_> {
    /// A block under G76.
    pub(super) fn thread_cycle(&mut self, run: &mut Run<'_, '_>) {
        run.facts.fixed = Some(FIXED);
        self.special.active = 0;
        let start = self.believed();
        let mut end = start;
        let whole = run.whole();
        if [X, Z]
            .iter()
            .any(|axis| self.position.unknown.contains(*axis))
        {
            run.report
                .error(
                    "cycle-from-unknown",
                    "a threading cycle, but where X and Z stand is not known",
                    whole,
                )
                .help("move them to a known position first, or give --start X0,Z0");
            return;
        }
        // Here E is no axis.
        let taper = run.words.take(b'E').unwrap_or(0.0);
        let Some(unknown) = self.targets(run, false, &mut end) else {
            return;
        };
        let Some(thread) = self.thread_words(&start, end[Z], taper, run) else {
            return;
        };
        let mut passes = 1.0;
        let mut depth = thread.first_depth;
        while depth < thread.full_depth {
            if !run.within_limits() {
                return;
            }
            self.thread_pass(&thread, depth, run);
            passes += 1.0;
            depth = thread.first_depth * libm::pow(passes, 1.0 / thread.degression);
        }
        for repeat in 0..=thread.spring_passes {
            let before = run.steps.len();
            if !run.within_limits() {
                return;
            }
            self.thread_pass(&thread, thread.full_depth, run);
            if repeat > 0 && !self.count_repeated(before, run) {
                return;
            }
        }
        self.go(run, MoveKind::Rapid, &end, unknown, None);
    }

    /// Reads the words of the cycle.
    fn thread_words(
        &self,
        start: &AxisValues,
        end_z_mm: f64,
        taper: f64,
        run: &mut Run<'_, '_>,
    ) -> Option<Thread> {
        let whole = run.whole();
        // "G7": I, J and K are diameters too (`convert_threading_cycle`).
        let share = if self.modal.diameter { 0.5 } else { 1.0 };
        let words = [(b'P', 1.0), (b'I', share), (b'J', share), (b'K', share)]
            .map(|(letter, share)| run.words.take(letter).map(|value| value * share));
        let [Some(pitch), Some(peak), Some(first_depth), Some(full_depth)] = words else {
            run.report
                .error(
                    "thread-words",
                    "G76 needs P, I, J and K in every block",
                    whole,
                )
                .help("pitch, peak, first depth and full depth");
            return None;
        };
        let degression = run.words.take(b'R').unwrap_or(1.0).max(1.0);
        let angle = run.words.take(b'Q').unwrap_or(0.0);
        let spring = run.words.take(b'H').unwrap_or(0.0);
        // L alone, or E alone, is no taper.
        let ends = run.words.take(b'L').unwrap_or(0.0);
        let faults = [
            (peak == 0.0, "I must not be 0"),
            (first_depth <= 0.0, "J must be greater than 0"),
            (full_depth <= first_depth, "K must be greater than J"),
            (angle.abs() > 80.0, "Q is beyond 80 degrees"),
            (
                !(0.0..=1e6).contains(&spring) || spring.fract() != 0.0,
                "H is no number of passes",
            ),
            (taper < 0.0, "E is negative"),
            (ends.fract() != 0.0, "L is not a whole number"),
            (degression > 1e3, "R is beyond reason"),
        ];
        if let Some((_, message)) = faults.into_iter().find(|(found, _)| *found) {
            run.report
                .error("thread-words", format!("G76: {message}"), whole)
                .help("check the words of the block");
            return None;
        }
        let speed_mm_s = self.thread_speed(pitch, b'P', run)?;
        let tapers = taper > 0.0 && (1.0..=3.0).contains(&ends);
        let forward = if start[Z] >= end_z_mm { -1.0 } else { 1.0 };
        Some(Thread {
            side: peak.signum(),
            peak: peak.abs(),
            first_depth,
            full_depth,
            degression,
            spring_passes: spring as u64,
            flank: forward * libm::tan(angle.to_radians()),
            taper,
            tapers_in: tapers && ends != 2.0,
            tapers_out: tapers && ends != 1.0,
            speed_mm_s,
            taper_speed_mm_s: speed_mm_s * libm::hypot(taper, full_depth) / taper,
            start: *start,
            end_z_mm,
            forward,
        })
    }

    /// One pass at a depth.
    fn thread_pass(&mut self, thread: &Thread, depth: f64, run: &mut Run<'_, '_>) {
        let unit = self.modal.mm_per_unit;
        let across = |value: f64| thread.start[X] + thread.side * value * unit;
        let along = |value: f64| value * unit;
        let away = across(depth - thread.full_depth);
        let outside = across(thread.peak + depth - thread.full_depth);
        let inside = across(thread.peak + depth);
        let run_out = thread.forward * along(thread.taper);
        let first_z = thread.start[Z] + along(thread.flank * depth);
        let last_z = thread.end_z_mm - along(thread.flank * (thread.full_depth - depth));
        let mut at = thread.start;
        let mut to = |control: &mut Self, run: &mut Run<'_, '_>, kind, x, z| {
            at[X] = x;
            at[Z] = z;
            control.part(run, kind, &at);
        };
        to(self, run, MoveKind::Rapid, away, first_z);
        if thread.tapers_in {
            self.special.speed_mm_s = Some(thread.taper_speed_mm_s);
            to(self, run, MoveKind::Thread, outside, first_z);
            to(self, run, MoveKind::Thread, inside, first_z + run_out);
        } else {
            to(self, run, MoveKind::Rapid, inside, first_z);
        }
        self.special.speed_mm_s = Some(thread.speed_mm_s);
        if thread.tapers_out {
            to(self, run, MoveKind::Thread, inside, last_z - run_out);
            self.special.speed_mm_s = Some(thread.taper_speed_mm_s);
            to(self, run, MoveKind::Thread, outside, last_z);
        } else {
            to(self, run, MoveKind::Thread, inside, last_z);
        }
        self.special.speed_mm_s = None;
        to(self, run, MoveKind::Rapid, away, last_z);
    }
}
