//! Drilling cycles ("Cycles", chapter "Drilling cycles and drilling patterns").
//!
//! All begin with RTP (retraction plane), RFP (reference plane), SDIS (safety
//! clearance), DP (depth) and DPR (depth below the reference plane), along the
//! axis at right angles to the plane; levels are absolute.

use super::Siemens;
use super::cycle_call::{Call, Kind};
use crate::control::{Control, Run};

/// Why no word of such a block is changed.
pub(super) const FIXED: &str = "it is part of a canned cycle";

impl Call {
    /// Whether it is a pattern of holes.
    pub(super) fn is_pattern(&self) -> bool {
        matches!(self.kind, Kind::Row | Kind::Circle)
    }

    /// Whether it makes straight moves and does not turn the spindle.
    pub(super) fn is_plain(&self) -> bool {
        matches!(self.kind, Kind::Drill | Kind::Deep | Kind::Bore)
    }

    /// The argument at a place from 1; `None` where it is left out.
    pub(super) fn value(&self, place: usize) -> Option<f64> {
        self.values.get(place.checked_sub(1)?).copied().flatten()
    }
}

/// The levels of a hole, program coordinates in mm.
#[derive(Debug, Clone, Copy)]
pub(super) struct Levels {
    /// The axis of the hole.
    pub(super) axis: usize,
    pub(super) retract: f64,
    /// Reference plane, and with the safety clearance.
    pub(super) reference: f64,
    pub(super) safe: f64,
    pub(super) depth: f64,
    /// -1 where the hole goes down.
    pub(super) sign: f64,
}

impl Control<'_> {
    /// Executes a cycle where the axes stand.
    pub(super) fn cycle(&mut self, state: &mut Siemens, call: &Call, run: &mut Run<'_, '_>) {
        run.facts.fixed = Some(FIXED);
        // What was edited before has to be put back before it.
        run.facts.boundary = true;
        run.facts.uses_feed = true;
        if let Some(argument) = call.not_followed(self.modal.plane) {
            let message = format!("{argument} has a value that is not followed");
            run.report
                .error("cycle", message, call.span)
                .help("leave it out, or write the holes by G0 and cycles without it");
            return;
        }
        if call.is_pattern() {
            return self.hole_pattern(state, call, run);
        }
        let Some(levels) = self.levels(call, run) else {
            return;
        };
        if state.extra.machine_coordinates {
            run.report
                .error("cycle", "a cycle with G53, G153 or SUPA", call.span)
                .help("write it in a block of its own");
            return;
        }
        match call.kind {
            Kind::Drill => self.cycle_drill(state, levels, call, run),
            Kind::Deep => self.deep_hole(state, levels, call, run),
            Kind::Tap | Kind::FloatingTap => {
                self.at_any_mode(|control| control.tap(state, levels, call, run));
            }
            Kind::Bore => self.cycle_bore(state, levels, call, run),
            _ => self.bore_aside(state, levels, call, run),
        }
    }

    fn levels(&self, call: &Call, run: &mut Run<'_, '_>) -> Option<Levels> {
        let axis = self.modal.plane[2];
        let unit = self.unit_of(axis);
        let value = |place| call.value(place).map(|value| value * unit);
        // DPR counts where both are given; it has no sign.
        let below = value(5).filter(|below| *below != 0.0);
        let wrong = match (value(1), value(2)) {
            (Some(retract), Some(reference)) => {
                // Where both planes are one, an absolute depth says which way it goes.
                let way = if retract == reference {
                    let absolute = value(4).filter(|_| below.is_none());
                    absolute.map_or(0.0, |depth| depth - reference)
                } else {
                    reference - retract
                };
                let sign = way.signum();
                let safe = reference - sign * value(3).unwrap_or(0.0).abs();
                let depth = below.map(|below| reference + sign * below.abs());
                match depth.or(value(4)) {
                    _ if way == 0.0 => {
                        "a cycle whose retraction plane is its reference plane, without a depth DP"
                    }
                    Some(depth) if (depth - safe) * sign >= 0.0 => {
                        return Some(Levels {
                            axis,
                            retract,
                            reference,
                            safe,
                            depth,
                            sign,
                        });
                    }
                    Some(_) => "a cycle whose depth lies above its reference plane",
                    None => "a cycle without a depth (DP or DPR)",
                }
            }
            _ => "a cycle without a retraction plane (RTP) and a reference plane (RFP)",
        };
        run.report
            .error("cycle", wrong, call.span)
            .help("the arguments are RTP, RFP, SDIS, DP, DPR and those of the cycle");
        None
    }
}
