//! Peaks, energy and times of a program, move by move, by dense sampling.

use gwatt::interpret::Move;

use super::course::Course;
use super::electrical::{Bus, SpindleLoad};
use super::plant::Plant;
use super::spindle::Turning;

/// Samples of a stretch between two changes of law; where speed changes evenly
/// they serve energies alone.
const SAMPLES: usize = 64;
const PLAIN_SAMPLES: usize = 24;
/// Samples of a turn of an arc.
const PER_TURN: f64 = 400.0;
/// Stretches from which on they are short by themselves, and samples of all.
const MANY: usize = 60;
const ALL_SAMPLES: f64 = 400.0;
/// Stretches of less than this share of a move are none.
const ROUNDING: f64 = 1e-12;

/// What is asked of the converters by one move, by converter.
#[derive(Debug, Clone)]
pub struct Figures {
    pub duration_s: f64,
    pub peak_w: Vec<f64>,
    pub regen_w: Vec<f64>,
    pub energy_j: f64,
    /// Whether the peaks are those of closed forms.
    pub exact: bool,
}

/// A slice of time between two samples: how long, and what a converter sees at
/// its ends.
pub type Slice = (f64, [Bus; 2]);

/// A step of a program: a move, or a speed of the spindle (1/min, signed).
#[derive(Debug, Clone)]
pub enum Step {
    Move(Box<Move>),
    Spindle { rpm: f64, on: bool },
}

/// Samples a program.
pub struct Judge<'p> {
    plant: &'p Plant,
    overrides: [f64; 2],
    turning: Turning,
    now_s: f64,
    /// Slices of each converter, where they are wanted.
    pub slices: Option<Vec<Vec<Slice>>>,
}

impl<'p> Judge<'p> {
    /// A judge of programs at overrides of feeds and rapids.
    pub fn new(plant: &'p Plant, overrides: [f64; 2]) -> Self {
        Self {
            plant,
            overrides,
            turning: Turning::default(),
            now_s: 0.0,
            slices: None,
        }
    }

    /// Keeps all slices.
    pub fn keeping(mut self) -> Self {
        self.slices = Some(vec![vec![]; self.plant.converters.len()]);
        self
    }

    /// Takes a step; figures of moves.
    pub fn take(&mut self, step: &Step) -> Option<Figures> {
        match step {
            Step::Move(mv) => Some(self.judge(mv)),
            Step::Spindle { rpm, on } => {
                let spindle = self.plant.spindle.as_ref()?;
                self.turning.command(spindle, self.now_s, *rpm, *on);
                None
            }
        }
    }

    /// What the converters see at `t` s of a move.
    fn buses(&self, course: &Course, mv: &Move, [t, inside]: [f64; 2], buses: &mut Vec<Bus>) {
        let spindle = self.plant.spindle.as_ref();
        let load = spindle.map_or(SpindleLoad::default(), |spindle| {
            self.turning
                .spindle_load(spindle, self.now_s + t, self.now_s + inside)
        });
        let states = course.at(t, inside);
        buses.clear();
        for which in 0..self.plant.converters.len() {
            let own = spindle.is_some_and(|spindle| spindle.converter == which);
            let load = if own { load } else { SpindleLoad::default() };
            buses.push(self.plant.bus(which, &states, mv.loads, load));
        }
    }

    fn judge(&mut self, mv: &Move) -> Figures {
        let course = Course::new(self.plant, mv, self.overrides);
        let converters = self.plant.converters.len();
        let duration_s = course.duration_s();
        let mut figures = Figures {
            duration_s,
            peak_w: vec![f64::NEG_INFINITY; converters],
            regen_w: vec![0.0; converters],
            energy_j: 0.0,
            exact: course.is_plain(),
        };
        let mut breaks = course.breaks_s();
        let turns = self.turning.breaks_s().map(|t| t - self.now_s);
        let before = breaks.len();
        breaks.extend(turns.filter(|t| *t > 0.0 && *t < duration_s));
        figures.exact &= breaks.len() == before;
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        let (mut last, mut now) = (Vec::<Bus>::new(), Vec::new());
        for pair in breaks.windows(2) {
            let [from, to] = [pair[0], pair[1]];
            let inside = 0.5 * (from + to);
            let part = (to - from) / duration_s;
            // A cruise that is nothing but rounding.
            if part < ROUNDING {
                continue;
            }
            let samples = if breaks.len() > MANY {
                2 + (ALL_SAMPLES * part) as usize
            } else if course.is_plain() {
                PLAIN_SAMPLES
            } else {
                SAMPLES
            };
            let samples = samples.max((course.turns() * part * PER_TURN) as usize);
            let at = |i: usize| from + (to - from) * i as f64 / samples as f64;
            for i in 0..=samples {
                self.buses(&course, mv, [at(i), inside], &mut now);
                figures.raise(&now);
                if i > 0 {
                    let dt = at(i) - at(i - 1);
                    for (which, pair) in last.iter().zip(&now).enumerate() {
                        figures.energy_j += 0.5 * dt * (pair.0.nominal_w + pair.1.nominal_w);
                        if let Some(slices) = &mut self.slices {
                            slices[which].push((dt, [*pair.0, *pair.1]));
                        }
                    }
                }
                std::mem::swap(&mut last, &mut now);
            }
        }
        self.now_s += duration_s;
        figures
    }
}

impl Figures {
    fn raise(&mut self, buses: &[Bus]) {
        for (which, bus) in buses.iter().enumerate() {
            self.peak_w[which] = self.peak_w[which].max(bus.drawn_w);
            self.regen_w[which] = self.regen_w[which].max(bus.fed_w);
        }
    }

    /// Takes in what the same move asks at another override; the times stay.
    pub fn include(&mut self, other: &Self) {
        for which in 0..self.peak_w.len() {
            self.peak_w[which] = self.peak_w[which].max(other.peak_w[which]);
            self.regen_w[which] = self.regen_w[which].max(other.regen_w[which]);
        }
        self.exact &= other.exact;
    }
}
