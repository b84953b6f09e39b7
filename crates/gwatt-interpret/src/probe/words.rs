//! What probing does.

use super::{SHORTEST_INCH, VALUES};
use crate::control::{Control, Run};
use crate::execute::Interpreter;
use crate::reading::ProbeResult;
use gwatt_machine::AxisSet;
use gwatt_machine::units::MM_PER_INCH;
use gwatt_motion::{MoveKind, Step};

impl Interpreter<'_> {
    /// How often the program has asked whether a probe has touched, as far as it is not
    /// known from the way itself: see [`ProbeWay`](crate::ProbeWay).
    #[must_use]
    pub fn probe_answers(&self) -> u32 {
        self.control.probe.answers()
    }
}

impl Control<'_> {
    /// Where it has come out that the last probe has touched nothing, it stands at its
    /// target; what has moved since has kept that place up to date.
    pub(crate) fn learn_from_probe(&mut self) {
        if self.probe.answer.get() == Some(false) {
            let known = std::mem::take(&mut self.probe.known_before);
            self.position.unknown.0 &= !known.0;
        }
    }

    /// A block under G38.2 to G38.5.
    pub(crate) fn probe(&mut self, code: u16, run: &mut Run<'_, '_>) {
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
        // Where they find nothing the program stops.
        let stops = matches!(code, 382 | 384);
        self.found(commanded, stops, run);
        if stops && self.probe.taken == Some(ProbeResult::Miss) {
            let whole = run.whole();
            let message = "the probe touches nothing: the program stops here with an error";
            run.report.note_once("probe-missed", message, whole);
            self.ended = true;
        }
    }

    /// G31, which is not modal (Fanuc "Skip function", Haas "G31 Feed until
    /// skip").
    pub(crate) fn skip(&mut self, run: &mut Run<'_, '_>) {
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
            self.found(commanded, false, run);
        }
    }

    /// These axes have probed; where the program `stops` without a touch, whatever comes
    /// next knows that there was one.
    fn found(&mut self, axes: u16, stops: bool, run: &mut Run<'_, '_>) {
        let touches = match self.probe.taken {
            Some(ProbeResult::Miss) => {
                let places = std::array::from_fn(|axis| self.place(axis));
                return self.probe.ends(places, Some(false));
            }
            Some(ProbeResult::Hit) => Some(true),
            Some(ProbeResult::Either(_)) | None => stops.then_some(true),
        };
        self.probe.ends([None; VALUES - 1], touches);
        self.probe.known_before = AxisSet(axes & !self.position.unknown.0);
        self.position.unknown.0 |= axes;
        let whole = run.whole();
        let message = "where a probe touches is not known: the next absolute move of an axis \
                       that probed counts at its full speed";
        run.report.note_once("probed", message, whole);
    }
}
