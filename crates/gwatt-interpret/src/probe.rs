//! G38.2 to G38.5, and G31: feeds that end where a probe touches, or lets go
//! (`LinuxCNC` "G38.n Straight Probe").
//!
//! The move is that to the target: nothing is faster or longer. Where it ends
//! is not known, and with it the place of every axis that moved and the result
//! (#5061 to #5070); unless it is taken for granted that the probe touches nothing.

use std::cell::Cell;

use super::execute::{Control, Interpreter, Run};
use super::position::ProbeResult;
use gwatt_machine::AxisSet;
use gwatt_machine::units::MM_PER_INCH;
use gwatt_motion::{MoveKind, Step};

/// Shortest way to the target that is taken for a probing move, inches.
const SHORTEST_INCH: f64 = 0.01;

/// Values of a probe's result: nine places, and whether it has touched.
const VALUES: usize = 10;

/// What is known of the last probe.
#[derive(Debug)]
pub(super) struct Probe {
    /// What probes are taken to find; `None`: not known.
    taken: Option<ProbeResult>,
    /// Parameters 5061 to 5070, as far as they are known.
    values: [Option<f64>; VALUES],
    /// What was answered about it, where both can be.
    answer: Cell<Option<bool>>,
    /// How often that was asked of probes.
    answers: Cell<u32>,
    /// Axes whose place was known up to the last probe: where it misses, it still is.
    known_before: AxisSet,
}

impl Probe {
    /// Before the first probe, with what probes are taken to find.
    pub(super) fn new(taken: Option<ProbeResult>) -> Self {
        // Those of the probe before, in another program.
        let mut values = [None; VALUES];
        values[VALUES - 1] = match taken {
            Some(ProbeResult::Hit) => Some(1.0),
            Some(ProbeResult::Miss) => Some(0.0),
            _ => None,
        };
        Self {
            taken,
            values,
            answer: Cell::new(None),
            answers: Cell::new(0),
            known_before: AxisSet::default(),
        }
    }

    /// How often it was asked whether a probe has touched, where both can be.
    pub(super) fn answers(&self) -> u32 {
        self.answers.get()
    }

    /// A parameter, from 0 for #5061; `None`: its value is not known.
    pub(super) fn value(&self, index: usize) -> Option<f64> {
        let known = self.values.get(index).copied()?;
        match self.taken {
            Some(ProbeResult::Either(way)) if index + 1 == VALUES => known.or_else(|| {
                let touches = self.answer.get().unwrap_or_else(|| {
                    let answer = self.answers.get();
                    self.answers.set(answer.saturating_add(1));
                    !way.misses(answer)
                });
                self.answer.set(Some(touches));
                Some(f64::from(touches))
            }),
            _ => known,
        }
    }

    /// The program assigns such a parameter.
    pub(super) fn set(&mut self, index: usize, value: f64) {
        if let Some(slot) = self.values.get_mut(index) {
            *slot = Some(value);
        }
    }

    /// The result of a probe that ends at these places, as far as they are known.
    fn ends(&mut self, places: [Option<f64>; VALUES - 1], touches: Option<bool>) {
        let [.., success] = &mut self.values;
        *success = touches.map(f64::from);
        for (slot, place) in self.values.iter_mut().zip(places) {
            *slot = place;
        }
        self.answer.set(None);
    }
}

impl Interpreter<'_> {
    /// How often the program has asked whether a probe has touched, as far as it is not
    /// known from the way itself: see [`ProbeWay`](super::ProbeWay).
    #[must_use]
    pub fn probe_answers(&self) -> u32 {
        self.control.probe.answers()
    }
}

impl Control<'_> {
    /// Where it has come out that the last probe has touched nothing, it stands at its
    /// target; what has moved since has kept that place up to date.
    pub(super) fn learn_from_probe(&mut self) {
        if self.probe.answer.get() == Some(false) {
            let known = std::mem::take(&mut self.probe.known_before);
            self.position.unknown.0 &= !known.0;
        }
    }

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
