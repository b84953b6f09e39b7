//! The planned motion of a program and its spindle, instant by instant.
//!
//! Input: a program and a step. Output: an [`Instant`] at each step, at each
//! switching instant, and on both sides of each jump.

use std::collections::VecDeque;
use std::io::{self, Read, Seek};

use super::executor::Executor;
use super::series_volts::SeriesVolts;
use super::source::Source;
use super::watching::watching;
use super::{Failure, Options};
use crate::diagnostic::Diagnostic;
use crate::interpret::{Move, Step};
use crate::machine::Machine;
use crate::power::{
    Assessment, Assessor, AxisInstant, BusVoltages, Durations, Instant, Motion, PowerModel,
    SpindleInstant, Turning, VoltageCurve, Want,
};

/// Rows that a series may have, and how many steps of it are taken one by one: so
/// many, and so many for each line that moves. Beyond them a line gets rows farther
/// apart, but each piece of its motion still so many.
const ROWS_MAX: f64 = 2e8;
const STEPS: f64 = 2.5e5;
const STEPS_BY_LINE: f64 = 2.5e3;
const STEPS_LEAST: f64 = 1e3;
/// Share of a step by which a row may come close to a switching instant.
const NEAR: f64 = 1e-6;
/// Share by which rounding alone may make two states differ.
const ROUNDING: f64 = 1e-9;
/// Rounding of times between the motion and the spindle, as a share and in s.
const APART: f64 = 1e-12;
const APART_S: f64 = 1e-9;

/// Takes the rows of a series one by one.
pub trait SeriesSink {
    /// Takes the state at `time_s`, in the move that line `line` of the program
    /// commands.
    ///
    /// # Errors
    /// Whatever the writing gives.
    fn row(&mut self, time_s: f64, line: u64, instant: &Instant) -> io::Result<()>;

    /// Whether rows have the voltages of buses.
    fn wants_volts(&self) -> bool {
        false
    }

    /// Whether [`Self::voltages`] is wanted, for which the moves are judged as in a report.
    fn wants_voltages(&self) -> bool {
        false
    }

    /// Takes the voltages of buses over time as the limits over time have them.
    fn voltages(&mut self, curves: Vec<VoltageCurve>) {
        let _ = curves;
    }
}

/// Reads a program and hands over its planned motion at 100 % override, a row
/// every `step_s` and at every switching instant; where something jumps, two rows
/// with the same time. Where the machine has a spindle, the axes stand while the
/// program waits for it.
///
/// Of a move from an unknown start a row has the most that may be drawn and fed back, and NaN
/// for its axes. Rests that never end are left out. What lasts for very many steps gets rows
/// farther apart: the note that is given back says where first.
///
/// # Errors
/// See [`Failure`]; an error of `sink` becomes [`Failure::Output`].
pub fn series<R: Read + Seek + Send>(
    mut input: R,
    machine: &Machine,
    options: &Options,
    step_s: f64,
    sink: &mut dyn SeriesSink,
) -> Result<Option<Diagnostic>, Failure> {
    series_of(&mut input, machine, options, step_s, sink)
}

fn series_of(
    input: &mut dyn Source,
    machine: &Machine,
    options: &Options,
    step_s: f64,
    sink: &mut dyn SeriesSink,
) -> Result<Option<Diagnostic>, Failure> {
    let mut front = Executor::new(input, machine, options);
    let model = PowerModel::new(machine);
    let judges = sink.wants_voltages() && BusVoltages::new(machine, &model).is_some();
    let mut assessor = judging(machine, options, judges);
    let mut durations = Durations::default();
    let mut sampler = Sampler {
        volts: SeriesVolts::new(machine, &model).filter(|_| sink.wants_volts()),
        model,
        step_s,
        start_s: 0.0,
        next: 0,
        rows: 0,
        line: None,
        lines: 0,
        coarse: None,
        now: Instant::default(),
        last: None,
        motions: VecDeque::new(),
        moved_s: 0.0,
        x_mm: 0.0,
        sink,
    };
    while let Some(line) = front.next_line()? {
        let mut judged = |mv: &Move, judged: &Assessment, _: &[u8]| durations.add(mv, judged);
        for step in &*line.steps {
            match step {
                Step::Move(mv) => assessor.push(mv, b"", &mut judged),
                Step::Action(action) => assessor.act(action, &mut judged),
            }
            sampler.take_all(&mut assessor, false)?;
        }
        let moved = line.facts.turns_knob || line.steps.iter().any(Step::moves_axes);
        assessor.end_line(moved, &mut judged);
        assessor.lasting(&mut durations);
        sampler.take_all(&mut assessor, false)?;
    }
    assessor.finish(&mut |mv, judged, _| durations.add(mv, judged));
    assessor.lasting(&mut durations);
    sampler.take_all(&mut assessor, true)?;
    front.finish()?;
    if judges {
        sampler.sink.voltages(assessor.voltages());
    }
    Ok(sampler.coarse)
}

/// What plans the moves; `judges`: as in a report, with the voltages of buses.
fn judging<'m>(machine: &'m Machine, options: &Options, judges: bool) -> Assessor<'m> {
    if judges {
        return watching(machine, options).showing_voltage().showing();
    }
    let want = Want {
        energy: false,
        floor_w: f64::INFINITY,
        regen_floor_w: f64::INFINITY,
        accel: false,
    };
    Assessor::new(machine, options.certificate, want).showing()
}

/// Makes rows of motion.
struct Sampler<'a> {
    model: PowerModel,
    step_s: f64,
    /// When the stretch begins that comes next.
    start_s: f64,
    /// Number of the next step.
    next: u64,
    rows: u64,
    /// The line that moves, and how many have so far, one after the other.
    line: Option<u64>,
    lines: u64,
    /// The first that got rows farther apart.
    coarse: Option<Diagnostic>,
    now: Instant,
    /// The last row: its time, and what it showed.
    last: Option<(f64, Instant)>,
    /// Motion whose spindle is not known yet.
    motions: VecDeque<Motion>,
    /// How far the first of them is through, s.
    moved_s: f64,
    /// Where X was when it began.
    x_mm: f64,
    /// Where rows have the voltages of buses.
    volts: Option<SeriesVolts>,
    sink: &'a mut dyn SeriesSink,
}

/// A stretch of time in a motion, and what the spindle does from when on.
#[derive(Clone, Copy)]
struct Stretch<'t> {
    motion: &'t Motion,
    from_s: f64,
    to_s: f64,
    spindle: Option<(&'t Turning, f64)>,
}

impl Stretch<'_> {
    /// The spindle's own time at an instant of the motion.
    fn turned_s(&self, t: f64) -> f64 {
        let since_s = self.spindle.map_or(0.0, |(_, since_s)| since_s);
        since_s + (t - self.from_s)
    }

    /// The state at `t` by the laws that hold at `inside`; X was at `x_mm` when the motion began.
    fn at(&self, model: &PowerModel, [t, inside]: [f64; 2], x_mm: f64, now: &mut Instant) {
        self.motion.at(model, t, inside, now);
        if let Some((turning, _)) = self.spindle {
            let x_mm = [t, inside].map(|t| self.motion.x_mm(t, inside, x_mm));
            let turned = [t, inside].map(|t| self.turned_s(t));
            turning.add(model, turned, x_mm, now);
        }
    }

    /// From its beginning to its end, the instants at which something may jump.
    fn switches_s(&self, x_mm: f64) -> Vec<f64> {
        let (from, to) = (self.from_s, self.to_s);
        let mut switches = self.motion.switches_s();
        if let Some((turning, _)) = self.spindle {
            switches.retain(|t| *t > from && *t < to);
            switches.extend([from, to]);
            switches.sort_by(f64::total_cmp);
            let mut own = Vec::new();
            for pair in switches.windows(2) {
                let inside = f64::midpoint(pair[0], pair[1]);
                let turned = [pair[0], pair[1]].map(|t| self.turned_s(t));
                let own_s = |turned_s: f64| pair[0] + (turned_s - turned[0]);
                let at = |turned_s: f64| self.motion.x_mm(own_s(turned_s), inside, x_mm);
                let found = turning.switches_s(turned, at);
                own.extend(found.into_iter().map(own_s));
            }
            switches.extend(own.iter().filter(|t| **t > from && **t < to));
            switches.sort_by(f64::total_cmp);
            switches.dedup();
        }
        switches
    }
}

impl Sampler<'_> {
    /// Takes what is known by now; of the axes the last motion only at the end:
    /// the next one may begin before it ends.
    fn take_all(&mut self, assessor: &mut Assessor<'_>, ends: bool) -> Result<(), Failure> {
        for motion in assessor.motions() {
            let Some(last) = self.motions.pop_back() else {
                self.motions.push_back(motion);
                continue;
            };
            let done_s = if self.motions.is_empty() {
                self.moved_s
            } else {
                0.0
            };
            self.motions.extend(last.followed_by(motion, done_s));
        }
        let Some(turnings) = assessor.turnings() else {
            let kept = usize::from(!ends);
            while self.motions.len() > kept
                && let Some(motion) = self.motions.pop_front()
            {
                let to_s = motion.duration_s();
                self.take(&motion, to_s, None)?;
            }
            return Ok(());
        };
        for turning in turnings {
            self.turn(&turning)?;
        }
        Ok(())
    }

    /// A stretch of the spindle, with the motion next to it.
    fn turn(&mut self, turning: &Turning) -> Result<(), Failure> {
        if let Some(rest) = &turning.rest {
            return self.stretch(Stretch {
                motion: rest,
                from_s: 0.0,
                to_s: turning.duration_s,
                spindle: Some((turning, 0.0)),
            });
        }
        let apart_s = APART_S + APART * turning.duration_s;
        let mut turned_s = 0.0;
        while turning.duration_s - turned_s > apart_s
            && let Some(motion) = self.motions.pop_front()
        {
            let lasts_s = motion.duration_s();
            let left_s = turning.duration_s - turned_s;
            let ends = lasts_s - self.moved_s <= left_s + apart_s;
            let to_s = if ends { lasts_s } else { self.moved_s + left_s };
            let moved_s = to_s - self.moved_s;
            self.take(&motion, to_s, Some((turning, turned_s)))?;
            turned_s += moved_s;
            if !ends {
                self.moved_s = to_s;
                self.motions.push_front(motion);
            }
        }
        Ok(())
    }

    /// A motion up to an instant of it.
    fn take(
        &mut self,
        motion: &Motion,
        to_s: f64,
        spindle: Option<(&Turning, f64)>,
    ) -> Result<(), Failure> {
        let from_s = std::mem::take(&mut self.moved_s);
        self.stretch(Stretch {
            motion,
            from_s,
            to_s,
            spindle,
        })?;
        let lasts_s = motion.duration_s();
        if to_s >= lasts_s {
            self.x_mm = motion.x_mm(lasts_s, lasts_s, self.x_mm);
        }
        Ok(())
    }

    fn stretch(&mut self, stretch: Stretch<'_>) -> Result<(), Failure> {
        let lasts_s = stretch.to_s - stretch.from_s;
        let stride = self.stride(lasts_s, stretch.motion.mv.line);
        let rows = self.rows as f64 + lasts_s / (self.step_s * stride as f64);
        if rows.is_nan() || rows > ROWS_MAX {
            return Err(Failure::Unsuitable(format!(
                "the series has more than {ROWS_MAX} rows: a longer --step-ms is needed"
            )));
        }
        // The time of the motion's beginning.
        let start_s = self.start_s - stretch.from_s;
        for pair in stretch.switches_s(self.x_mm).windows(2) {
            let [from, to] = [pair[0], pair[1]];
            let inside = 0.5 * (from + to);
            if let Some(volts) = &mut self.volts {
                volts.jump();
            }
            self.row(&stretch, from, inside)?;
            loop {
                // Not summed up: the rounding of a million sums would show.
                let t = self.next as f64 * self.step_s - start_s;
                if t >= to - NEAR * self.step_s {
                    break;
                }
                if t > from + NEAR * self.step_s {
                    self.row(&stretch, t, inside)?;
                }
                self.next = self.next.saturating_add(stride);
            }
            self.row(&stretch, to, inside)?;
        }
        self.start_s += lasts_s;
        if stride > 1 {
            // Back to the first step after it.
            self.next = libm::ceil(self.start_s / self.step_s) as u64;
        }
        Ok(())
    }

    /// Every which step of a piece gets a row.
    fn stride(&mut self, lasts_s: f64, line: u64) -> u64 {
        if self.line != Some(line) {
            self.line = Some(line);
            self.lines += 1;
        }
        let left = STEPS + STEPS_BY_LINE * self.lines as f64 - self.rows as f64;
        let stride = libm::ceil(lasts_s / self.step_s / left.max(STEPS_LEAST));
        if stride <= 1.0 {
            return 1;
        }
        if self.coarse.is_none() {
            let rows_s = (stride * self.step_s * 1e6).round() / 1e6;
            let message = format!(
                "line {line} lasts {lasts_s:.0} s: from here on some rows are farther apart, {rows_s} s in this line"
            );
            let note = Diagnostic::note("coarse-series", message);
            self.coarse = Some(note.help("a longer --step-ms gives even rows"));
        }
        stride as u64
    }

    fn row(&mut self, stretch: &Stretch<'_>, t: f64, inside: f64) -> Result<(), Failure> {
        let (model, x_mm) = (&self.model, self.x_mm);
        stretch.at(model, [t, inside], x_mm, &mut self.now);
        if let Some(volts) = &mut self.volts {
            let at = |t: f64, now: &mut Instant| stretch.at(model, [t, inside], x_mm, now);
            volts.row(t, &mut self.now, at);
        }
        let time_s = self.start_s + (t - stretch.from_s);
        match &mut self.last {
            Some((last_s, last)) if *last_s == time_s && alike(last, &self.now) => return Ok(()),
            Some((last_s, last)) => {
                *last_s = time_s;
                last.clone_from(&self.now);
            }
            None => self.last = Some((time_s, self.now.clone())),
        }
        self.rows += 1;
        let line = stretch.motion.mv.line;
        self.sink
            .row(time_s, line, &self.now)
            .map_err(Failure::Output)
    }
}

/// Whether nothing jumps from one state to the other.
fn alike(a: &Instant, b: &Instant) -> bool {
    let near = |a: f64, b: f64| {
        (a - b).abs() <= ROUNDING * a.abs().max(b.abs()).max(1e-3) || (a.is_nan() && b.is_nan())
    };
    let fields = |axis: &AxisInstant| {
        [
            axis.velocity_mm_s,
            axis.accel_mm_s2,
            axis.force_n,
            axis.power_w,
        ]
    };
    let turning = |spindle: &SpindleInstant| {
        [
            spindle.speed_rpm,
            spindle.accel_rpm_s,
            spindle.torque_nm,
            spindle.power_w,
            spindle.cutting_w,
        ]
    };
    let spindle = turning(&a.spindle).into_iter().zip(turning(&b.spindle));
    let axes = a.axes.iter().zip(&b.axes);
    let axes = axes.flat_map(|(a, b)| fields(a).into_iter().zip(fields(b)));
    let mut pairs = axes.chain(spindle);
    let powers = |a: &Vec<f64>, b: &Vec<f64>| a.iter().zip(b).all(|(a, b)| near(*a, *b));
    pairs.all(|(a, b)| near(a, b)) && powers(&a.bus_w, &b.bus_w) && powers(&a.regen_w, &b.regen_w)
}
