//! G38.2 to G38.5, and G31: feeds that end where a probe touches, or lets go
//! (`LinuxCNC` "G38.n Straight Probe").
//!
//! The move is that to the target: nothing is faster or longer. Where it ends
//! is not known, and with it the place of every axis that moved and the result
//! (#5061 to #5070); unless it is taken for granted that the probe touches nothing.

use super::execute::{Control, Run};
use super::moves::{MoveKind, Step};
use super::position::ProbeResult;
use crate::units::MM_PER_INCH;

/// Shortest way to the target that is taken for a probing move, inches.
const SHORTEST_INCH: f64 = 0.01;

impl Control<'_> {
    /// A block under G38.2 to G38.5.
    pub(super) fn probe(&mut self, code: u16, run: &mut Run<'_, '_>) {
        run.facts.fixed = Some("it probes");
        self.special.active = 0;
        let mut end = self.position.at;
        let Some(unknown) = self.targets(run, false, &mut end) else {
            return;
        };
        let before = run.steps.len();
        self.go(run, MoveKind::Probe, &end, unknown, None);
        let Some(Step::Move(mv)) = run.steps.get(before) else {
            return;
        };
        let commanded = mv.moving.0 | mv.unknown_start.0;
        let shortest_mm = SHORTEST_INCH * MM_PER_INCH;
        if unknown.is_empty() && mv.length_mm < shortest_mm {
            let whole = run.whole();
            run.report
                .error(
                    "probe-length",
                    "the probe stands at its target already",
                    whole,
                )
                .help("probing needs a way of 0.254 mm (0.01 inch) at least");
            return;
        }
        self.found(commanded, run);
        // G38.2 and G38.4 stop the program where nothing is found.
        if self.probing == Some(ProbeResult::Miss) && matches!(code, 382 | 384) {
            let whole = run.whole();
            let message = "the probe touches nothing: the program stops here with an error";
            run.report.note_once("probe-missed", message, whole);
            self.ended = true;
        }
    }

    /// G31, which is not modal (Fanuc "Skip function", Haas "G31 Feed until
    /// skip").
    pub(super) fn skip(&mut self, run: &mut Run<'_, '_>) {
        run.facts.fixed = Some("it probes");
        run.facts.boundary = true;
        let mut end = self.position.at;
        let Some(unknown) = self.targets(run, run.facts.machine_coordinates, &mut end) else {
            return;
        };
        let before = run.steps.len();
        self.go(run, MoveKind::Probe, &end, unknown, None);
        if let Some(Step::Move(mv)) = run.steps.get(before) {
            let commanded = mv.moving.0 | mv.unknown_start.0;
            self.found(commanded, run);
        }
    }

    /// These axes have probed.
    fn found(&mut self, axes: u16, run: &mut Run<'_, '_>) {
        if self.probing == Some(ProbeResult::Miss) {
            self.probe_missed();
            return;
        }
        self.forget_probe(self.probing.map(|_| true));
        self.position.unknown.0 |= axes;
        let whole = run.whole();
        let message = "where a probe touches is not known: the next absolute move of an axis \
                       that probed counts at its full speed";
        run.report.note_once("probed", message, whole);
    }
}
