//! Converters over time: overload, continuous power, bus voltage and braking
//! resistor.
//!
//! Input: the power of each move as [`Slice`]s, in the order of the program.
//! Output: a [`Rating`] for each limit, with the worst value.
//!
//! ```text
//! power drawn P ─→ capacitor: D' = P − Pₛ, D ≥ 0 ─→ supplied S ─→ overload, RMS
//! power fed back R ─→ capacitor: U' = R − Rₛ, U ≥ 0
//!                  └→ braking resistor: H' = R − P_b, H ≥ 0
//! ```
//!
//! A program may run again at once and for ever: a run begins with what the one before
//! has left, and windows reach from one into the next.
//!
//! The converter supplies Pₛ, its peak power, at most. What is drawn beyond comes
//! from the capacitor, which is charged again with what is free: D is the energy
//! that it lacks. S is P, and Pₛ while D > 0; where peaks may not come from the
//! capacitor S is P. U is what the capacitor holds beyond its nominal voltage
//! because more was fed back than is taken, H the heat that the resistor has
//! taken and not given off yet. All limits are less the margin.
//!
//! What the spindle draws beside the axes comes on top, slice by slice
//! ([`Level`]).
//!
//! Of a move that may be blended in a way that is not modelled only the largest
//! power is known. It is taken to last no longer than with a stop at both ends, and
//! no shorter than its path at full speed: whichever is worse counts for each
//! limit. A move from an unknown start may last for ever.

mod beside;
mod kept;
mod limits;
mod linger;
mod overload;
mod rating;
mod rms;
mod span;
mod store;

pub(super) use beside::{Beside, Level, Steps};
pub(super) use kept::Kept;
pub use rating::{Measure, Rating};
pub(super) use span::Span;

use super::model::PowerModel;
use super::robust::Part;
use super::steps::StepEnergy;
use super::trace::{Flow, Slice};
use crate::interpret::Move;
use crate::machine::Machine;
use crate::plan::lookahead::Planned;
use crate::plan::{Plan, Trajectory};
use beside::{Levels, Waiting, Waits};
use limits::Limits;
use rating::Place;

/// Watches the converters that have limits over time.
#[derive(Debug)]
pub(super) struct Watch {
    tracks: Vec<Track>,
    /// Where the spindle's converter is watched: moves that wait for it.
    waiting: Option<Waiting>,
    /// Room for the slices of a move, and for powers by track.
    kept: Kept,
    powers: Vec<[f64; 2]>,
    /// The program runs again and again.
    pub repeated: bool,
    /// Overrides below the largest count.
    lower: bool,
}

/// One converter and one direction of its power.
#[derive(Debug)]
struct Track {
    converter: usize,
    flow: Flow,
    limits: Limits,
    /// Time so far in s.
    time_s: f64,
}

impl Watch {
    /// What the machine file limits over time; `None` where it limits nothing.
    pub fn new(machine: &Machine, model: &PowerModel) -> Option<Box<Self>> {
        let tracks: Vec<Track> = machine
            .converters
            .iter()
            .enumerate()
            .flat_map(|(index, converter)| {
                let margin = machine.limits.margin;
                let supply_w = model.limit_w(index);
                let regen_w = model.regen_limit_w(index);
                [
                    (Flow::Drawn, Limits::drawn(converter, margin, supply_w)),
                    (Flow::FedBack, Limits::fed_back(converter, margin, regen_w)),
                ]
                .map(|(flow, limits)| Track {
                    converter: index,
                    flow,
                    limits,
                    time_s: 0.0,
                })
            })
            .filter(|track| !track.limits.is_empty())
            .collect();
        let spindle = machine.spindle.as_ref();
        let converter = spindle
            .map(|spindle| spindle.converter)
            .filter(|converter| tracks.iter().any(|track| track.converter == *converter));
        let waiting = converter.map(|converter| Waiting {
            converter,
            ..Waiting::default()
        });
        (!tracks.is_empty()).then(|| {
            Box::new(Self {
                tracks,
                waiting,
                kept: Kept::default(),
                powers: Vec::new(),
                repeated: false,
                lower: machine.limits.override_at.is_none(),
            })
        })
    }

    /// Whether it has to be told what the spindle does.
    pub fn follows_spindle(&self) -> bool {
        self.waiting.is_some()
    }

    /// A move that takes no time.
    pub fn pass(&mut self) {
        if let Some(waiting) = &mut self.waiting {
            let slices = waiting.room();
            waiting.moves.push_back(Waits {
                place: Place::default(),
                slices,
                lasting: None,
            });
        }
    }

    /// What the spindle does during the next move, or by itself before it.
    pub fn beside(&mut self, model: &PowerModel, beside: &Beside) {
        let Some(waiting) = &mut self.waiting else {
            return;
        };
        let Some(mv) = &beside.alone else {
            waiting.hand_on(model, beside.levels.as_slice(), &mut self.tracks);
            return;
        };
        let place = Place::of(mv);
        let levels = beside.levels.as_slice();
        let duration_s = levels.iter().map(|level| level.duration_s).sum();
        for track in &mut self.tracks {
            let [drawn_w, fed_back_w] = model.resting_w(track.converter, mv);
            let power_w = match track.flow {
                Flow::Drawn => drawn_w,
                Flow::FedBack => fed_back_w,
            };
            if duration_s > 0.0 {
                let slice = Slice::constant(duration_s, power_w);
                let mut levels = Levels::new(levels, track, waiting.converter);
                levels.add(&slice, &mut |slice| track.take(slice, place));
            }
        }
    }

    /// Takes a move that runs as planned.
    pub fn plan(&mut self, model: &PowerModel, mv: &Move, plan: &Plan) {
        let place = Place::of(mv);
        if !plan.duration_s.is_finite() {
            // At rest for ever.
            let tracks = self.tracks.iter();
            let powers = tracks.map(|track| model.resting_w(track.converter, mv));
            self.powers.extend(powers);
            return self.last(Span::ANY, place);
        }
        if self.waiting.is_none() && mv.arc.is_some() {
            // Many slices: they are not kept.
            for track in &mut self.tracks {
                if let Some(tracer) = model.tracer(track.converter, track.flow) {
                    tracer.plan(mv, plan, &mut |slice| track.take(&slice, place));
                }
            }
            return self.linger(model, mv, plan.top_speed_mm_s);
        }
        let mut kept = std::mem::take(&mut self.kept);
        for (index, track) in self.tracks.iter().enumerate() {
            let Some(tracer) = model.tracer(track.converter, track.flow) else {
                continue;
            };
            if let Trajectory::Path(profile) = &plan.trajectory
                && track.limits.only_stores()
                && let Some(line) = tracer.line(mv, profile)
                && let Some(most_w) = tracer.fed_back_bound_w(&line)
            {
                kept.push_line(index, most_w, line);
            } else {
                tracer.plan(mv, plan, &mut |slice| kept.push(index, slice));
            }
        }
        let on_path = matches!(plan.trajectory, Trajectory::Path(_));
        let cruises_mm_s = if on_path { plan.top_speed_mm_s } else { 0.0 };
        self.kept(model, mv, &mut kept, cruises_mm_s);
        self.kept = kept;
    }

    /// A move has been taken that runs at up to this speed.
    fn linger(&mut self, model: &PowerModel, mv: &Move, top_speed_mm_s: f64) {
        let place = Place::of(mv);
        for track in &mut self.tracks {
            let (converter, lower) = (track.converter, self.lower && top_speed_mm_s > 0.0);
            let mut cruise = |above_w: f64| {
                if lower {
                    linger::lingers_s(model, converter, mv, top_speed_mm_s, above_w)
                } else {
                    0.0
                }
            };
            track.limits.linger(track.time_s, place, &mut cruise);
        }
    }

    /// Keeps a piece of a plan for the move that it belongs to, with the step of
    /// speed with which it begins.
    pub fn keep(
        &self,
        model: &PowerModel,
        mv: &Move,
        planned: &Planned<u64>,
        step: Option<&StepEnergy>,
        kept: &mut Kept,
    ) {
        for (index, track) in self.tracks.iter().enumerate() {
            let Some(tracer) = model.tracer(track.converter, track.flow) else {
                continue;
            };
            let (mut most_s, mut more_w) = (0.0, 0.0);
            if let Some(step) = step {
                most_s = step.response_s.min(planned.duration_s());
                more_w = tracer.step_j(step) / most_s;
            }
            if more_w <= 0.0 || more_w.is_nan() {
                tracer.piece(mv, planned, &mut |slice| kept.push(index, slice));
                continue;
            }
            tracer.piece(mv, planned, &mut |slice| {
                let [first, rest] = slice.cut(most_s);
                most_s -= slice.duration_s;
                for slice in first.map(|it| it.raised(more_w)).into_iter().chain(rest) {
                    kept.push(index, slice);
                }
            });
        }
    }

    /// Takes what was kept of a move that runs as planned, at up to a speed.
    pub fn kept(&mut self, model: &PowerModel, mv: &Move, kept: &mut Kept, top_speed_mm_s: f64) {
        let place = Place::of(mv);
        if let Some(waiting) = &mut self.waiting {
            let slices = std::mem::replace(kept, waiting.room());
            waiting.moves.push_back(Waits {
                place,
                slices,
                lasting: None,
            });
            return;
        }
        for (index, track) in self.tracks.iter_mut().enumerate() {
            track.take_kept(index, model, kept, &mut Levels::none(), place);
        }
        kept.clear();
        self.linger(model, mv, top_speed_mm_s);
    }

    /// Takes a move whose timing is not known: its largest speeds and those of
    /// its neighbours, pieces of its plan that may ask for more, and for how long
    /// it may last.
    pub fn unknown(
        &mut self,
        model: &PowerModel,
        mv: &Move,
        parts: &[Part<'_>],
        kept: &mut Kept,
        span: Span,
    ) {
        let place = Place::of(mv);
        for (index, track) in self.tracks.iter().enumerate() {
            let mut powers = model.robust_powers(track.converter, mv, parts);
            let of_flow = match track.flow {
                Flow::Drawn => &mut powers[0],
                Flow::FedBack => &mut powers[1],
            };
            let own = kept.slices(index).iter();
            *of_flow = own.fold(*of_flow, |most, slice| {
                super::demand::larger(most, slice.peak_w())
            });
            self.powers.push(powers);
        }
        kept.clear();
        self.last(span, place);
    }

    /// The powers by track last for a time that is not known.
    fn last(&mut self, span: Span, place: Place) {
        if let Some(waiting) = &mut self.waiting {
            let slices = waiting.room();
            waiting.moves.push_back(Waits {
                place,
                slices,
                lasting: Some((std::mem::take(&mut self.powers), span)),
            });
            return;
        }
        for (track, powers) in self.tracks.iter_mut().zip(self.powers.drain(..)) {
            track.span(powers, span, place);
        }
    }

    /// What was found, converter by converter.
    pub fn ratings(&self) -> Vec<Rating> {
        let tracks = self.tracks.iter();
        tracks
            .flat_map(|track| track.limits.ratings(track.converter, self.repeated))
            .collect()
    }
}

impl Track {
    /// All power passes here, slice by slice.
    fn take(&mut self, slice: &Slice, place: Place) {
        self.limits.take(slice, self.time_s, place);
        self.time_s += slice.duration_s;
    }

    /// A power that lasts for a time that is not known.
    fn span(&mut self, powers: [f64; 2], span: Span, place: Place) {
        let power_w = match self.flow {
            Flow::Drawn => powers[0],
            Flow::FedBack => powers[1],
        };
        self.limits.span(power_w, span, self.time_s, place);
        if span.longest_s.is_finite() {
            self.time_s += span.longest_s;
        }
    }
}
