//! Limits that may act on the move before them, while that waits for the queue (RepRapFirmware).

use crate::control::{Control, Run};
use crate::knob::KnobState;
use gwatt_machine::{AxisSet, Machine};
use gwatt_motion::{ActionKind, EarlyLimits};

impl Control<'_> {
    /// The axes of a move that may wait for the queue while the next line is read; after an arc
    /// that is not read before all its chords are in it.
    pub(crate) fn not_queued(&self, is_arc: bool, moving: AxisSet, length_mm: f64) -> AxisSet {
        let rules = self.machine.controller.planner.look_ahead;
        let chord_mm = rules
            .and_then(|rules| rules.chords)
            .map(|chords| chords.max_mm);
        // A part of a chord may count as one.
        match chord_mm {
            Some(chord_mm) if is_arc && length_mm > 2.0 * chord_mm => AxisSet::default(),
            _ => moving,
        }
    }
}

impl Control<'_> {
    /// M220 and M221 change the move that waits (GCodes2.cpp, case 220; RawMove.cpp), also counted
    /// for one of the extruder alone, which they leave. The factors of feed and filament before.
    pub(super) fn early_factors(&self, run: &mut Run<'_, '_>, [feed, flow]: [f64; 2]) {
        for (limits, factor) in [
            (EarlyLimits::Feed, self.printer.feed_factor / feed),
            (EarlyLimits::Filament, self.printer.flow / flow),
        ] {
            if factor != 1.0 {
                run.act(ActionKind::EarlyLimits(limits), factor.max(1.0));
            }
        }
    }
}

/// By what factor limits that change rise at most: of the axes in `moving`, and along the path.
pub(super) fn rises(
    machine: &Machine,
    moving: AxisSet,
    before: &KnobState,
    after: &KnobState,
) -> impl Iterator<Item = (EarlyLimits, f64)> {
    let axes = || moving.iter();
    let accels = [
        (&before.feed_accel_mm_s2, &after.feed_accel_mm_s2),
        (&before.rapid_accel_mm_s2, &after.rapid_accel_mm_s2),
    ];
    let accels = accels
        .into_iter()
        .flat_map(|(before, after)| axes().map(|axis| [before[axis], after[axis]]));
    let paths = before
        .path_accel_mm_s2
        .into_iter()
        .zip(after.path_accel_mm_s2);
    let speeds = axes().map(|axis| {
        // Infinite is the machine's own.
        let own = machine.axes[axis].map_or(f64::INFINITY, |axis| axis.rapid_mm_s);
        let cap = |speed: f64| if speed.is_finite() { speed } else { own };
        [before, after].map(|it| cap(it.speed_mm_s[axis]))
    });
    let found = [
        (EarlyLimits::AxisAccel, rise(accels)),
        (EarlyLimits::PathAccel, rise(paths.map(Into::into))),
        (EarlyLimits::Speed, rise(speeds)),
    ];
    let changed = found.into_iter();
    changed.filter_map(|(limits, factor)| Some((limits, factor?)))
}

/// By what factor the second of each pair is above the first, at least 1; `None` where all pairs are
/// alike.
fn rise(pairs: impl Iterator<Item = [f64; 2]>) -> Option<f64> {
    let changed = pairs.filter(|[before, after]| before != after);
    let factors = changed.map(|[before, after]| {
        if before > 0.0 && before.is_finite() {
            after / before
        } else {
            1.0
        }
    });
    factors.fold(None, |most, factor| {
        Some(f64::max(most.unwrap_or(1.0), factor))
    })
}
