//! A whole program: both runs side by side, without and with correction.

use std::collections::VecDeque;

use super::circle::Circle;
use super::follow::{Follow, has_force_poles, times};
use super::prepare::{cannot_follow, moving, period, trouble};
use super::result::{
    ArcResult, AxisEffort, ContourRow, ContourSink, ContourSummary, ContourTrouble, Effort, Errors,
    PlotPoint, Settings,
};
use crate::interpret::MoveKind;
use crate::machine::{ALL_AXES, AXES, AxisKind, AxisSet, AxisValues, Machine};
use crate::pipeline::{Failure, Stretch};
use crate::plan::{AxisStates, Profile, Track};

/// Axes whose places make the contour.
const SPACE: usize = 3;
/// Longer than this nothing is waited for, s.
const WINDOW_MAX_S: f64 = 5.0;
/// Nor more stretches kept.
const OPEN_MAX: usize = 20_000;
/// Path accelerations below this are none, mm/s².
const CRUISE_MM_S2: f64 = 1e-6;

/// A stretch that the load may still be on.
struct Open {
    stretch: Stretch,
    start_s: f64,
}

/// A move that is not finished.
struct Waiting {
    number: u64,
    found: ContourRow,
    circle: Option<Circle>,
    independent: bool,
}

struct AxisRun {
    index: usize,
    follow: [Option<Box<Follow>>; 2],
    peak: [f64; 2],
    square_sum: [f64; 2],
}

/// Traces a program, stretch by stretch.
pub struct Tracer<'m, 's> {
    machine: &'m Machine,
    sink: &'s mut dyn ContourSink,
    axes: Vec<AxisRun>,
    corrected: bool,
    period_s: f64,
    /// How long a stretch may be the one that the load is on.
    window_s: f64,
    settle_s: f64,
    open: VecDeque<Open>,
    rows: VecDeque<Waiting>,
    /// Time of the next sample by its number, and of the end of all stretches.
    samples: u64,
    end_s: f64,
    /// Since when the present arc has run at constant speed, s.
    cruising_since: Option<f64>,
    errors: [Errors; 2],
    lines: [u64; 2],
    efforts: [Effort; 2],
    left_out: AxisSet,
    forces_rigid: bool,
}

impl<'m, 's> Tracer<'m, 's> {
    /// Prepares a machine.
    ///
    /// # Errors
    /// Responses that are missing or cannot be simulated, filters of different
    /// periods.
    pub fn new(
        machine: &'m Machine,
        settings: Settings,
        sink: &'s mut dyn ContourSink,
    ) -> Result<Self, ContourTrouble> {
        if machine.responses.follow.is_empty() {
            return Err(trouble(
                "the machine file does not say how loads follow commands".to_owned(),
                "write [axes.X.response] with zeros and poles, or let gwatt identify --from-command --into write it",
            ));
        }
        let period_s = period(machine, settings)?;
        let corrected = !machine.responses.corrections.is_empty();
        let (mut late_s, mut settle_s) = (0.0_f64, 0.0_f64);
        let mut forces_rigid = false;
        for (axis, response) in &machine.responses.follow {
            let [late, settle] = times(response, machine.responses.correction(*axis));
            late_s = late_s.max(late);
            settle_s = settle_s.max(settle);
            forces_rigid |= !has_force_poles(response);
        }
        Ok(Self {
            machine,
            sink,
            axes: Vec::new(),
            corrected,
            period_s,
            window_s: (9.0 * late_s + 10.0 * period_s).min(WINDOW_MAX_S),
            settle_s: settle_s + late_s,
            open: VecDeque::new(),
            rows: VecDeque::new(),
            samples: 0,
            end_s: 0.0,
            cruising_since: None,
            errors: [Errors::default(); 2],
            lines: [0; 2],
            efforts: [Effort::default(); 2],
            left_out: AxisSet::default(),
            forces_rigid,
        })
    }

    /// Takes the next stretch.
    ///
    /// # Errors
    /// An axis whose response is not known, and those of the sink.
    pub fn push(&mut self, stretch: Stretch) -> Result<(), Failure> {
        if self.samples == 0 && self.axes.is_empty() {
            let start = stretch.track.at(stretch.path_at(0.0), 0.0);
            self.begin(&start.position)?;
        }
        self.refuse_unknown(&stretch)?;
        let start_s = self.end_s;
        self.end_s += stretch.duration_s;
        self.open_row(&stretch, start_s);
        self.open.push_back(Open { stretch, start_s });
        self.sample()
    }

    /// Lets the load come to rest, and ends.
    ///
    /// # Errors
    /// Those of the sink.
    pub fn finish(mut self) -> Result<ContourSummary, Failure> {
        let duration_s = self.end_s;
        if let Some(last) = self.open.back() {
            let state = last.stretch.path_at(last.stretch.duration_s);
            let end = last.stretch.track.at(state, last.stretch.duration_s);
            let rest = Stretch {
                kind: MoveKind::Dwell,
                track: Track::Rest(end.position),
                arc: None,
                profile: Profile::default(),
                range_mm: [0.0; 2],
                duration_s: self.settle_s.min(WINDOW_MAX_S),
                ..last.stretch.clone()
            };
            let start_s = self.end_s;
            self.end_s += rest.duration_s;
            self.open.push_back(Open {
                stretch: rest,
                start_s,
            });
            self.sample()?;
        }
        while let Some(row) = self.rows.pop_front() {
            self.emit(row)?;
        }
        let count = self.samples.max(1) as f64;
        let axes = self.axes.iter().map(|run| {
            let axis = self.machine.axes.get(run.index).and_then(Option::as_ref);
            AxisEffort {
                letter: ALL_AXES
                    .get(run.index)
                    .map_or('?', |id| id.letter() as char),
                rotary: axis.is_some_and(|axis| axis.kind == AxisKind::Rotary),
                force_peak_n: run.peak,
                force_rms_n: run.square_sum.map(|sum| (sum / count).sqrt()),
            }
        });
        Ok(ContourSummary {
            corrected: self.corrected,
            period_s: self.period_s,
            duration_s,
            errors: self.errors,
            lines: self.lines,
            axes: axes.collect(),
            efforts: self.efforts,
            conditions: self.conditions(),
        })
    }

    fn conditions(&self) -> Vec<String> {
        let mut list = vec![
            "linear model: friction that reverses and backlash are not in it".to_owned(),
            "power of the axes and the base load; spindle and switched loads are not in it"
                .to_owned(),
        ];
        if !self.corrected {
            list.push("no axis has a correction".to_owned());
        }
        if !self.left_out.is_empty() {
            list.push(format!(
                "the contour is that of X, Y and Z: {} move too",
                self.left_out
            ));
        }
        if self.forces_rigid {
            list.push(
                "force_poles are of higher order than poles: forces are those of rigid drives"
                    .to_owned(),
            );
        }
        list
    }

    fn begin(&mut self, start: &AxisValues) -> Result<(), Failure> {
        for (id, response) in &self.machine.responses.follow {
            let index = *id as usize;
            let Some(axis) = self.machine.axes.get(index).and_then(Option::as_ref) else {
                continue;
            };
            let letter = id.letter() as char;
            let filter = self.machine.responses.correction(*id);
            let make = |filter| {
                Follow::new(axis, response, filter, self.period_s, start[index])
                    .map(Box::new)
                    .map_err(|reason| {
                        Failure::Unsuitable(cannot_follow(letter, reason).to_string())
                    })
            };
            let with = if self.corrected {
                Some(make(filter)?)
            } else {
                None
            };
            self.axes.push(AxisRun {
                index,
                follow: [Some(make(None)?), with],
                peak: [0.0; 2],
                square_sum: [0.0; 2],
            });
        }
        Ok(())
    }

    /// Every axis that moves must have a response.
    fn refuse_unknown(&mut self, stretch: &Stretch) -> Result<(), Failure> {
        for axis in moving(&stretch.track).iter() {
            if axis >= SPACE {
                self.left_out.insert(axis);
            }
            if !self.axes.iter().any(|run| run.index == axis) {
                let letter = ALL_AXES.get(axis).map_or('?', |id| id.letter() as char);
                let found = trouble(
                    format!(
                        "line {}: axis {letter} moves, and the machine file does not say how its load follows",
                        stretch.line
                    ),
                    &format!("write [axes.{letter}.response]; an empty one follows at once"),
                );
                return Err(Failure::Unsuitable(found.to_string()));
            }
        }
        Ok(())
    }

    fn open_row(&mut self, stretch: &Stretch, start_s: f64) {
        let independent = matches!(stretch.track, Track::Axes { .. });
        match self.rows.back_mut() {
            Some(last) if last.number == stretch.number => {
                last.found.duration_s += stretch.duration_s;
                if last.circle.is_none() {
                    last.circle = stretch.arc.as_ref().map(Circle::of);
                }
                if let Some(arc) = &mut last.found.arc {
                    arc.speed_mm_s = arc.speed_mm_s.max(stretch.profile.top_speed_mm_s());
                }
            }
            _ => {
                self.cruising_since = None;
                self.rows.push_back(Waiting {
                    number: stretch.number,
                    found: ContourRow {
                        line: stretch.line,
                        run: stretch.run,
                        kind: stretch.kind,
                        start_s,
                        duration_s: stretch.duration_s,
                        errors: None,
                        arc: None,
                    },
                    circle: stretch.arc.as_ref().map(Circle::of),
                    independent,
                });
            }
        }
        if let Some(last) = self.rows.back_mut()
            && let (Some(circle), None) = (&last.circle, &last.found.arc)
        {
            last.found.arc = Some(ArcResult {
                line: stretch.line,
                run: stretch.run,
                plane: circle.plane,
                radius_mm: circle.radius_mm,
                speed_mm_s: stretch.profile.top_speed_mm_s(),
                roundness: [None, None],
                bins: [Vec::new(), Vec::new()],
            });
        }
    }

    /// All samples before the end of the last stretch.
    fn sample(&mut self) -> Result<(), Failure> {
        loop {
            let now = self.samples as f64 * self.period_s;
            if now >= self.end_s {
                return Ok(());
            }
            let Some(open) = self.open.back() else {
                return Ok(());
            };
            let t = now - open.start_s;
            let path = open.stretch.path_at(t);
            let states = open.stretch.track.at(path, t);
            let is_arc = open.stretch.arc.is_some();
            let number = open.stretch.number;
            if !is_arc || path.accel_mm_s2.abs() > CRUISE_MM_S2 {
                self.cruising_since = None;
            } else if self.cruising_since.is_none() {
                self.cruising_since = Some(now);
            }
            let settled = self
                .cruising_since
                .is_some_and(|since| now - since >= self.settle_s);
            self.step(now, &states, path.position_mm, settled.then_some(number));
            self.samples += 1;
            self.forget(now)?;
        }
    }

    /// One sample of both runs.
    fn step(&mut self, now: f64, states: &AxisStates, s: f64, settled: Option<u64>) {
        let runs = if self.corrected { 2 } else { 1 };
        let mut point = PlotPoint {
            path: [[0.0; 3]; 2],
            off: [[0.0; 3]; 2],
            counts: [false; 2],
        };
        for which in 0..runs {
            let mut load = [0.0; SPACE];
            for (axis, slot) in load.iter_mut().enumerate() {
                *slot = states.position[axis];
            }
            let mut powers = [0.0; AXES];
            for run in &mut self.axes {
                let n = run.index;
                let Some(follow) = run.follow.get_mut(which).and_then(Option::as_mut) else {
                    continue;
                };
                let command = [states.position[n], states.velocity[n]];
                let done = follow.step(command);
                if let Some(slot) = load.get_mut(n) {
                    *slot = done.position;
                }
                if let (Some(peak), Some(sum)) =
                    (run.peak.get_mut(which), run.square_sum.get_mut(which))
                {
                    *peak = peak.max(done.force.abs());
                    *sum += done.force * done.force;
                }
                powers[n] = done.power;
            }
            if let Some(effort) = self.efforts.get_mut(which) {
                effort.take(&self.machine.converters, &powers);
            }
            if let Some(number) = settled
                && let Some(row) = self.rows.iter_mut().rev().find(|row| row.number == number)
                && let Some(circle) = &mut row.circle
            {
                circle.take(which, load);
            }
            self.count_error(now, which, load, s, &mut point);
        }
        if runs == 1 {
            point.path[1] = point.path[0];
            point.off[1] = [f64::NAN; 3];
        }
        self.sink.point(&point);
    }

    /// The nearest point of all stretches that the load may be on.
    fn count_error(
        &mut self,
        now: f64,
        which: usize,
        load: [f64; 3],
        s: f64,
        point: &mut PlotPoint,
    ) {
        let last = self.open.len().saturating_sub(1);
        let mut best: Option<(crate::plan::Nearest, u64)> = None;
        for (index, open) in self.open.iter().enumerate() {
            if open.start_s > now {
                break;
            }
            let hint = if index == last {
                s
            } else {
                open.stretch.range_mm[1]
            };
            let near = open
                .stretch
                .track
                .nearest(load, open.stretch.range_mm, hint);
            if best
                .as_ref()
                .is_none_or(|(b, _)| near.distance2 < b.distance2)
            {
                best = Some((near, open.stretch.number));
            }
        }
        let Some((near, number)) = best else { return };
        if let (Some(path), Some(off)) = (point.path.get_mut(which), point.off.get_mut(which)) {
            *path = near.point;
            for ((slot, a), b) in off.iter_mut().zip(load).zip(near.point) {
                *slot = a - b;
            }
        }
        let Some(row) = self.rows.iter_mut().find(|row| row.number == number) else {
            return;
        };
        if row.independent {
            return;
        }
        let errors = row.found.errors.get_or_insert_default();
        if let Some(own) = errors.get_mut(which) {
            own.take(near.distance2);
        }
        let counts = !matches!(row.found.kind, MoveKind::Rapid | MoveKind::Dwell);
        if counts && let Some(all) = self.errors.get_mut(which) {
            if near.distance2.sqrt() > all.largest_mm
                && let Some(line) = self.lines.get_mut(which)
            {
                *line = row.found.line;
            }
            all.take(near.distance2);
            if let Some(slot) = point.counts.get_mut(which) {
                *slot = true;
            }
        }
    }

    /// Stretches that the load has left, and moves without any.
    fn forget(&mut self, now: f64) -> Result<(), Failure> {
        while let Some(front) = self.open.front() {
            let old = now - (front.start_s + front.stretch.duration_s) > self.window_s;
            let moves = |open: &Open| !matches!(open.stretch.track, Track::Rest(_));
            // While all rests, the load still comes to where the last path ends.
            let later = self.open.iter().skip(1).any(moves) || !moves(front);
            if self.open.len() < 2 || !(old && later || self.open.len() > OPEN_MAX) {
                break;
            }
            self.open.pop_front();
        }
        let first = self
            .open
            .front()
            .map_or(u64::MAX, |open| open.stretch.number);
        while self.rows.front().is_some_and(|row| row.number < first) {
            if let Some(row) = self.rows.pop_front() {
                self.emit(row)?;
            }
        }
        Ok(())
    }

    fn emit(&mut self, row: Waiting) -> Result<(), Failure> {
        let Waiting {
            found: mut row,
            circle,
            ..
        } = row;
        if let (Some(circle), Some(arc)) = (circle, &mut row.arc) {
            arc.roundness = [circle.roundness(0), circle.roundness(1)];
            arc.bins = [circle.bins(0).to_vec(), circle.bins(1).to_vec()];
        }
        self.sink.row(&row).map_err(Failure::Output)
    }
}
