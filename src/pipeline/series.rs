//! The planned motion of a program, instant by instant.
//!
//! Input: a program and a step. Output: an [`Instant`] at each step, at each
//! switching instant, and on both sides of each jump.

use std::io::{self, Read, Seek};

use super::front::Front;
use super::{Failure, Options};
use crate::interpret::Step;
use crate::machine::Machine;
use crate::power::{Assessor, AxisInstant, Instant, Motion, PowerModel, Want};

/// Rows that a series may have.
const ROWS_MAX: f64 = 2e8;
/// Share of a step by which a row may come close to a switching instant.
const NEAR: f64 = 1e-6;
/// Share by which rounding alone may make two states differ.
const ROUNDING: f64 = 1e-9;

/// Takes the rows of a series one by one.
pub trait SeriesSink {
    /// Takes the state at `time_s`, in the move that line `line` of the program
    /// commands.
    ///
    /// # Errors
    /// Whatever the writing gives.
    fn row(&mut self, time_s: f64, line: u64, instant: &Instant) -> io::Result<()>;
}

/// Reads a program and hands over its planned motion at 100 % override, a row
/// every `step_s` and at every switching instant; where something jumps, two rows
/// with the same time.
///
/// Rests that never end and moves from an unknown start have no place in time and
/// are left out.
///
/// # Errors
/// See [`Failure`]; an error of `sink` becomes [`Failure::Output`].
pub fn series<R: Read + Seek + Send>(
    input: R,
    machine: &Machine,
    options: &Options,
    step_s: f64,
    sink: &mut dyn SeriesSink,
) -> Result<(), Failure> {
    let mut front = Front::new(input, machine, options);
    // Nothing is judged here.
    let want = Want {
        energy: false,
        floor_w: f64::INFINITY,
        regen_floor_w: f64::INFINITY,
    };
    let mut assessor = Assessor::new(machine, options.certificate, want).showing();
    let mut sampler = Sampler {
        model: PowerModel::new(machine),
        step_s,
        start_s: 0.0,
        next: 0,
        rows: 0,
        now: Instant::default(),
        last: None,
        sink,
    };
    while let Some(line) = front.next_line()? {
        for step in &*line.steps {
            match step {
                Step::Move(mv) => assessor.push(mv, b"", &mut |_, _, _| {}),
                Step::Action(action) => assessor.act(action, &mut |_, _, _| {}),
            }
            sampler.take_all(assessor.motions())?;
        }
    }
    assessor.finish(&mut |_, _, _| {});
    sampler.take_all(assessor.motions())?;
    front.finish().map(|_| ())
}

/// Makes rows of motion.
struct Sampler<'a> {
    model: PowerModel,
    step_s: f64,
    /// When the motion begins that comes next.
    start_s: f64,
    /// Number of the next step.
    next: u64,
    rows: u64,
    now: Instant,
    /// The last row: its time, and what it showed.
    last: Option<(f64, Instant)>,
    sink: &'a mut dyn SeriesSink,
}

impl Sampler<'_> {
    fn take_all(&mut self, motions: impl Iterator<Item = Motion>) -> Result<(), Failure> {
        for motion in motions {
            self.take(&motion)?;
        }
        Ok(())
    }

    fn take(&mut self, motion: &Motion) -> Result<(), Failure> {
        let switches = motion.switches_s();
        let lasts_s = switches.last().copied().unwrap_or(0.0);
        let rows = self.rows as f64 + lasts_s / self.step_s;
        if rows > ROWS_MAX {
            return Err(Failure::Unsuitable(format!(
                "the series has more than {ROWS_MAX} rows: a longer --step-ms is needed"
            )));
        }
        for pair in switches.windows(2) {
            let [from, to] = [pair[0], pair[1]];
            let inside = 0.5 * (from + to);
            self.row(motion, from, inside)?;
            loop {
                // Not summed up: the rounding of a million sums would show.
                let t = self.next as f64 * self.step_s - self.start_s;
                if t >= to - NEAR * self.step_s {
                    break;
                }
                if t > from + NEAR * self.step_s {
                    self.row(motion, t, inside)?;
                }
                self.next += 1;
            }
            self.row(motion, to, inside)?;
        }
        self.start_s += lasts_s;
        Ok(())
    }

    fn row(&mut self, motion: &Motion, t: f64, inside: f64) -> Result<(), Failure> {
        motion.at(&self.model, t, inside, &mut self.now);
        let time_s = self.start_s + t;
        match &mut self.last {
            Some((last_s, last)) if *last_s == time_s && alike(last, &self.now) => return Ok(()),
            Some((last_s, last)) => {
                *last_s = time_s;
                last.clone_from(&self.now);
            }
            None => self.last = Some((time_s, self.now.clone())),
        }
        self.rows += 1;
        let line = motion.mv.line;
        self.sink
            .row(time_s, line, &self.now)
            .map_err(Failure::Output)
    }
}

/// Whether nothing jumps from one state to the other.
fn alike(a: &Instant, b: &Instant) -> bool {
    let near = |a: f64, b: f64| (a - b).abs() <= ROUNDING * a.abs().max(b.abs()).max(1e-3);
    let fields = |axis: &AxisInstant| {
        [
            axis.velocity_mm_s,
            axis.accel_mm_s2,
            axis.force_n,
            axis.power_w,
        ]
    };
    let axes = a.axes.iter().zip(&b.axes);
    let mut pairs = axes.flat_map(|(a, b)| fields(a).into_iter().zip(fields(b)));
    let powers = |a: &Vec<f64>, b: &Vec<f64>| a.iter().zip(b).all(|(a, b)| near(*a, *b));
    pairs.all(|(a, b)| near(a, b)) && powers(&a.bus_w, &b.bus_w) && powers(&a.regen_w, &b.regen_w)
}
