//! The spindle while no axis moves: runs that do not fit by themselves, and
//! moves that wait for a run.

use super::SpindleBus;
use crate::cutting::cuts;
use crate::demand::{Demand, Totals};
use crate::duty_cycle::SpindleLoad;
use crate::spindle_state::SpindleState;
use crate::spindle_trace::SpindleSpan;
use crate::{Assessment, Certificate, Loads, SpindleShare};
use gwatt_machine::{AxisSet, SpindleWait};
use gwatt_motion::{Move, MoveKind};

/// The text of a row that belongs to no block.
const NO_TEXT: &[u8] = b"";

impl SpindleBus<'_> {
    /// What the converter gives while no axis moves and the motor draws between
    /// two powers.
    pub(super) fn alone(&self, next: Option<&Move>, [largest_w, least_w]: [f64; 2]) -> Demand {
        let mut demand = Demand::NONE;
        let Some(place) = self.place(next) else {
            return demand;
        };
        for (index, converter) in self.model.converters.iter().enumerate() {
            let idle_w = converter.idle_w(&place, &self.model.axes, AxisSet::default());
            demand.add(index, converter, Totals::new(idle_w));
        }
        let idle_w = demand.spindle_converter_w[0];
        self.add(&mut demand, [largest_w, least_w], idle_w, 0.0);
        demand
    }

    /// A move that stands for the place between two: it has the loads of both.
    pub(super) fn place(&self, next: Option<&Move>) -> Option<Move> {
        let mut place = next.or(self.last.as_ref())?.clone();
        place.loads |= self.last.as_ref().map_or(0, |last| last.loads);
        place.kind = MoveKind::Spindle;
        place.end = place.start;
        if let (None, Some(last)) = (next, &self.last) {
            (place.start, place.end) = (last.end, last.end);
        }
        place.moving = AxisSet::default();
        place.unknown_start = AxisSet::default();
        place.arc = None;
        place.length_mm = 0.0;
        place.dwell_s = 0.0;
        Some(place)
    }

    /// Writes a row of the spindle alone: in this line, at the place of this move.
    pub(super) fn row(
        &mut self,
        (line, next): (u64, Option<&Move>),
        mut demand: Demand,
        span: SpindleSpan,
        duration_s: f64,
        sink: &mut impl FnMut(&Move, &Assessment, &[u8]),
    ) {
        let Some(mut place) = self.place(next) else {
            return;
        };
        if line != place.line {
            place.number = None;
        }
        place.line = line;
        place.dwell_s = duration_s;
        let motor_j = if self.credits() {
            span.energy_j
        } else {
            span.drawn_j
        };
        let mut idle_w = 0.0;
        for converter in &self.model.converters {
            idle_w += converter.idle_w(&place, &self.model.axes, AxisSet::default());
        }
        demand.energy_j = motor_j + (idle_w + self.spindle.base_load_w) * duration_s;
        let assessment = Assessment {
            duration_s,
            speed_mm_s: 0.0,
            accel_mm_s2: 0.0,
            top_speed_mm_s: 0.0,
            ends2: [0.0; 2],
            fastest_s: duration_s,
            demand,
            loads: Loads::NONE,
            certificate: Certificate::Planned,
            blended: false,
            joined: false,
            ahead: false,
            spindle: SpindleShare {
                command: self.commands,
                ..SpindleShare::NONE
            },
        };
        sink(&place, &assessment, NO_TEXT);
    }

    /// Whether a move waits until the spindle has its speed.
    pub(super) fn waits(&self, mv: &Move) -> bool {
        let target = self.states[0].target();
        match self.spindle.wait {
            _ if mv.kind == MoveKind::Tap => true,
            SpindleWait::Blocks => target != 0.0,
            SpindleWait::Feeds => target != 0.0 && cuts(mv.kind),
            SpindleWait::Nothing | SpindleWait::Unknown => false,
        }
    }

    /// Waits for the run to end; a row where that takes time.
    pub(super) fn wait(&mut self, mv: &Move, sink: &mut impl FnMut(&Move, &Assessment, &[u8])) {
        let slower = self.slower.as_ref().map(|slower| &slower.state);
        if self
            .states
            .iter()
            .chain(slower)
            .all(SpindleState::is_steady)
        {
            return;
        }
        let extremes = self.states[0].henceforth(&self.motor);
        let mut duration_s = self.states[1].left_s();
        let mut span = self.states[1].span(&self.motor, duration_s);
        let reverses = self.states[1]
            .run_rpm()
            .is_some_and(|[from, to]| from * to < 0.0);
        if mv.kind == MoveKind::Tap && reverses {
            // The axis goes on meanwhile, for half of the time: what holds the
            // speed is counted there.
            duration_s *= 0.5;
            let held_j = self.motor.holding_w(self.states[1].target()) * duration_s;
            span.energy_j -= held_j;
            span.drawn_j -= held_j;
        }
        if let Some(place) = self.place(Some(mv))
            && self.spindle_loads.is_some()
        {
            let longest_s = self.states[0].left_s();
            let window = self.states[0].window(&self.motor, longest_s);
            let load = SpindleLoad {
                levels: self.levels(&window, (longest_s, false), 0.0),
                alone: Some(Box::new(place)),
            };
            self.spindle_loads.get_or_insert_default().push(load);
        }
        if self.shown.is_some() {
            self.show_wait(mv, duration_s);
        }
        self.states[1].settle();
        if self.unsure.is_none() {
            self.states[0].settle();
            if let Some(slower) = &mut self.slower {
                slower.state.settle();
            }
        }
        if duration_s > 0.0 {
            let demand = self.alone(Some(mv), extremes);
            self.row((mv.line, Some(mv)), demand, span, duration_s, sink);
        }
    }
}
