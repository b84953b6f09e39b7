//! Threads: G32, and G76 in its two forms ("Thread Cutting (G32)", "Multiple
//! Thread Cutting Cycle (G76)"; one block in the format of Series 10/11, which
//! is that of Haas).

use super::state::Finish;
use super::words::{note_parameter, turning_needs};
use super::{X, Z, xz};
use crate::control::{Control, Run};
use gwatt_machine::AxisValues;
use gwatt_machine::units::SECONDS_PER_MINUTE;
use gwatt_motion::MoveKind::{Rapid, Thread};

/// Repeats of the last pass, as two digits give them.
const REPEATS_MAX: f64 = 99.0;

/// A thread in many passes, machine coordinates.
struct Passes {
    root_mm: f64,
    end_mm: f64,
    /// How much larger the radius is at the start.
    taper_mm: f64,
    height_mm: f64,
    first_mm: f64,
    lead_mm: f64,
    /// Depths grow evenly, not with the square root.
    even: bool,
}

impl Control<'_> {
    /// The lead in force: F is the way in one revolution along the longer axis.
    pub(super) fn lead(&self, run: &mut Run<'_, '_>) -> Option<f64> {
        let lead_mm = self
            .modal
            .feed
            .as_ref()
            .map(|feed| feed.value * feed.mm_per_unit)
            .filter(|lead| *lead > 0.0 && *lead < 1e6);
        if lead_mm.is_none() {
            let whole = run.whole();
            run.report
                .error("thread-pitch", "a thread without its lead F", whole)
                .help("write F: the way in one revolution");
        }
        lead_mm
    }

    /// Cuts to `end` in step with the spindle; reports a speed that is missing.
    pub(super) fn thread_to(&mut self, end: &AxisValues, lead_mm: f64, run: &mut Run<'_, '_>) {
        let rpm = self.highest_rpm(end, None);
        if rpm <= 0.0 {
            let whole = run.whole();
            run.report
                .error(
                    "no-spindle-speed",
                    "a thread, but no spindle speed is in force",
                    whole,
                )
                .help("write S before it");
            return;
        }
        let at = &self.position.at;
        let way = [end[X] - at[X], end[Z] - at[Z]].map(f64::abs);
        let longer = way[0].max(way[1]);
        let share = if longer > 0.0 {
            libm::hypot(way[0], way[1]) / longer
        } else {
            1.0
        };
        self.special.speed_mm_s = Some(lead_mm * share * rpm / SECONDS_PER_MINUTE);
        self.part(run, Thread, end);
        self.special.speed_mm_s = None;
    }

    /// G32 and G33.
    pub(super) fn long_thread(&mut self, run: &mut Run<'_, '_>) {
        // The angle at which the spindle starts.
        run.words.take(b'Q');
        let mut end = self.position.at;
        if self.targets(run, false, &mut end).is_none() {
            return;
        }
        if let Some(lead_mm) = self.lead(run) {
            self.thread_to(&end, lead_mm, run);
        }
    }

    /// G76.
    pub(super) fn thread_cycle_of_lathe(&mut self, run: &mut Run<'_, '_>) {
        if !Self::names_x_or_z(run) {
            self.first_of_thread(run);
            return;
        }
        let one_block = run.words.has(b'K') || run.words.has(b'D');
        let taper_mm = self.plain_length(if one_block { b'I' } else { b'R' }, run);
        let height_mm = self.fine_length(if one_block { b'K' } else { b'P' }, run);
        let first_mm = self.fine_length(if one_block { b'D' } else { b'Q' }, run);
        let mut even = false;
        if one_block {
            let angle = run.words.take(b'A').unwrap_or(0.0);
            let method = run.words.take(b'P').unwrap_or(1.0);
            run.words.take(b'Q');
            even = method == 3.0 || method == 4.0;
            self.turning.finish = Finish {
                angle_deg: angle,
                ..Finish::default()
            };
            note_parameter(run);
        } else if !self.turning.finish.given {
            note_parameter(run);
        }
        let root_mm = self.take_target(X, run).unwrap_or(self.position.at[X]);
        let (Some(end_mm), Some(height_mm), Some(first_mm)) =
            (self.take_target(Z, run), height_mm, first_mm)
        else {
            let what = if one_block {
                "Z, K and D"
            } else {
                "Z, P and Q"
            };
            turning_needs(what, 760, run);
            return;
        };
        let (height_mm, first_mm) = (height_mm.abs(), first_mm.abs());
        if height_mm == 0.0 || first_mm == 0.0 {
            turning_needs("a depth", 760, run);
            return;
        }
        let Some(lead_mm) = self.lead(run) else {
            return;
        };
        let passes = Passes {
            root_mm,
            end_mm,
            taper_mm: taper_mm.unwrap_or(0.0),
            height_mm,
            first_mm,
            lead_mm,
            even,
        };
        self.cut_thread(&passes, run);
    }

    /// `G76 P(m)(r)(a) Q R`: passes at the end, chamfer in tenths of the lead,
    /// angle of the tool.
    fn first_of_thread(&mut self, run: &mut Run<'_, '_>) {
        let mut finish = self.turning.finish;
        if let Some(digits) = run.words.take(b'P') {
            let digits = digits.clamp(0.0, 999_999.0) as u32;
            finish.repeats = (digits / 10_000).max(1);
            finish.chamfer = f64::from(digits / 100 % 100) / 10.0;
            finish.angle_deg = f64::from(digits % 100);
        }
        if let Some(least_mm) = self.fine_length(b'Q', run) {
            finish.least_mm = least_mm.abs();
        }
        if let Some(last_mm) = self.plain_length(b'R', run) {
            finish.last_mm = last_mm.abs();
        }
        finish.given = true;
        self.turning.finish = finish;
    }

    fn cut_thread(&mut self, passes: &Passes, run: &mut Run<'_, '_>) {
        let finish = self.turning.finish;
        let rough_mm = (passes.height_mm - finish.last_mm).max(0.0);
        let mut depth_mm: f64 = 0.0;
        let mut count = 0.0;
        while depth_mm < rough_mm - 1e-9 {
            count += 1.0;
            let grown = if passes.even {
                passes.first_mm * count
            } else {
                passes.first_mm * libm::sqrt(count)
            };
            depth_mm = grown.max(depth_mm + finish.least_mm).min(rough_mm);
            self.one_pass(passes, depth_mm, run);
            if !run.within_limits() {
                return;
            }
        }
        let repeats = f64::from(finish.repeats).min(REPEATS_MAX) as u32;
        if finish.given || depth_mm < passes.height_mm {
            for _ in 0..repeats {
                self.one_pass(passes, passes.height_mm, run);
            }
        }
    }

    /// In, along the thread, out and back.
    fn one_pass(&mut self, passes: &Passes, depth_mm: f64, run: &mut Run<'_, '_>) {
        let finish = self.turning.finish;
        let at = self.position.at;
        let (x0, z0) = (at[X], at[Z]);
        let outward = if x0 >= passes.root_mm { 1.0 } else { -1.0 };
        let along = if passes.end_mm >= z0 { 1.0 } else { -1.0 };
        let x = passes.root_mm + outward * (passes.height_mm - depth_mm);
        // The tool goes in along a flank of the thread.
        let tangent = libm::tan((finish.angle_deg / 2.0).to_radians());
        let start_z = z0 + along * depth_mm * tangent;
        let chamfer_mm = (finish.chamfer * passes.lead_mm).min((passes.end_mm - start_z).abs());
        self.part(run, Rapid, &xz(at, x + passes.taper_mm, start_z));
        let before = passes.end_mm - along * chamfer_mm;
        // The taper as far as the chamfer begins.
        let whole = passes.end_mm - start_z;
        let share = if whole == 0.0 {
            0.0
        } else {
            (passes.end_mm - before) / whole
        };
        let x_before = x + passes.taper_mm * share;
        self.thread_to(&xz(at, x_before, before), passes.lead_mm, run);
        if chamfer_mm > 0.0 {
            let out = xz(at, x_before + outward * chamfer_mm, passes.end_mm);
            self.thread_to(&out, passes.lead_mm, run);
        }
        self.part(run, Rapid, &xz(at, x0, passes.end_mm));
        self.part(run, Rapid, &at);
    }
}
