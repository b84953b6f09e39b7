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
//! What the spindle draws next to the axes comes on top, slice by slice
//! ([`Level`]).
//!
//! Of a move that may be blended in a way that is not modelled only the largest
//! power is known. It is taken to last no longer than with a stop at both ends, and
//! no shorter than its path at full speed: whichever is worse counts for each
//! limit. A move from an unknown start may last for ever.

mod spindle_load;
mod bounded;
mod bounds;
mod continuous;
mod buffered;
mod filling;
mod limits;
mod lower_overrides;
mod overload;
mod rating;
mod recorded;
mod rms;
mod shown_bus;
mod shown_voltage;
mod span;
mod store;
mod terms;
mod track;
mod voltage;
mod voltage_trace;
mod waiting;

use buffered::Added;
pub(super) use buffered::Buffered;
pub use rating::{Measure, Rating};
pub(super) use shown_bus::ShownBus;
pub(super) use span::{Known, Span};
pub(super) use spindle_load::{Level, SpindleLoad, Steps};
use track::Track;
pub use voltage::{VoltageCurve, VoltageSpan};
pub(super) use voltage_trace::Lasts;

use super::model::PowerModel;
use super::piece::straight_line;
use super::robust::Part;
use super::steps::StepEnergy;
use super::trace::{Flow, Slice};
use bounds::{bound, least_share, lower_of, shift};
use gwatt_machine::{Machine, RapidJoint};
use gwatt_motion::Move;
use gwatt_plan::lookahead::{Piece, Planned};
use gwatt_plan::{Plan, Trajectory};
use limits::Limits;
use rating::Place;
use spindle_load::Levels;
use terms::Models;
use voltage_trace::{Stretch, VoltageTrace};
use waiting::{Waiting, Waits};

/// Watches the converters that have limits over time.
#[derive(Debug)]
pub(super) struct DutyCycle {
    tracks: Vec<Track>,
    /// Where the spindle's converter is watched: moves that wait for it.
    waiting: Option<Waiting>,
    /// Room for the slices of a move, and for powers by track.
    kept: Buffered,
    powers: Vec<[f64; 3]>,
    /// The program runs again and again.
    pub repeated: bool,
    /// What bounds are computed with.
    models: Models,
    /// The least shares of the largest overrides that bounds go down to: of feeds, of
    /// rapids.
    least_shares: [f64; 2],
    /// Between rapids and feeds the motion stops.
    apart: bool,
    /// The voltages over time, where they are to be seen.
    voltage: Option<Box<VoltageTrace>>,
}

impl DutyCycle {
    /// What the machine file limits over time; `None` where it limits nothing. Where
    /// overrides below the largest count, each limit is watched twice: at the largest, and
    /// as a bound over all.
    pub fn new(machine: &Machine, model: &PowerModel) -> Option<Box<Self>> {
        let lower = machine.limits.counts_lower();
        let all = |bounds: bool| {
            let converters = machine.converters.iter().enumerate();
            converters.flat_map(move |(index, converter)| {
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
                    bounds,
                    ends: lower_of(machine.limits.least_shares()) > 0.0,
                    most_w: f64::INFINITY,
                })
            })
        };
        let bounds = all(true).filter(|_| lower);
        let tracks: Vec<Track> = all(false)
            .chain(bounds)
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
                kept: Buffered::default(),
                powers: Vec::new(),
                repeated: false,
                models: Models::new(model, lower),
                least_shares: machine.limits.least_shares(),
                apart: machine.controller.planner.rapid_joint != RapidJoint::All,
                voltage: None,
            })
        })
    }

    /// Goes on with some of its limits, in the order of [`Self::ratings`].
    pub fn only(&mut self, watched: &[bool]) {
        for bounds in [false, true] {
            let mut watched = watched.iter().copied();
            let tracks = self.tracks.iter_mut();
            for track in tracks.filter(|track| track.bounds == bounds) {
                track.limits.only(|| watched.next().unwrap_or(true));
            }
        }
        self.tracks.retain(|track| !track.limits.is_empty());
    }

    /// Nothing of what is bounded exceeds the largest powers of the program, drawn and fed
    /// back, W. They are known of a single converter.
    pub fn cap(&mut self, [drawn_w, fed_back_w]: [f64; 2]) {
        for track in &mut self.tracks {
            track.most_w = match track.flow {
                Flow::Drawn => drawn_w,
                Flow::FedBack => fed_back_w,
            };
        }
    }

    /// Whether it needs to know what the spindle does.
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
        } else {
            self.end_stretch(Stretch::Move);
        }
    }

    /// What the spindle does during the next move, or by itself before it.
    pub fn spindle_load(&mut self, model: &PowerModel, load: &SpindleLoad) {
        let Some(waiting) = &mut self.waiting else {
            return;
        };
        let Some(mv) = &load.alone else {
            let levels = load.levels.as_slice();
            waiting.emit(model, &self.models, levels, &mut self.tracks);
            return self.end_stretch(Stretch::Move);
        };
        let place = Place::of(mv);
        let levels = load.levels.as_slice();
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
        self.end_stretch(Stretch::Spindle);
    }

    /// Takes a move that runs as planned.
    pub fn plan(&mut self, model: &PowerModel, mv: &Move, plan: &Plan) {
        let place = Place::of(mv);
        if !plan.duration_s.is_finite() {
            // At rest for ever.
            let tracks = self.tracks.iter();
            let powers = tracks.map(|track| {
                let [drawn_w, fed_back_w] = model.resting_w(track.converter, mv);
                [drawn_w, fed_back_w, 0.0]
            });
            self.powers.extend(powers);
            return self.last(Span::ANY, place);
        }
        let mut kept = std::mem::take(&mut self.kept);
        for (index, track) in self.tracks.iter_mut().enumerate() {
            let own = track.model(model, &self.models);
            let Some(tracer) = track.tracer(own) else {
                continue;
            };
            if track.bounds {
                let least_share = least_share(self.least_shares, mv);
                bound(&tracer, (mv, plan), least_share, index, &mut kept);
                if let Trajectory::Axes(profiles) = &plan.trajectory {
                    if least_share > 0.0 {
                        shift(&tracer, (mv, profiles), least_share, index, &mut kept);
                        continue;
                    }
                    let out = &mut |slice| kept.push(index, slice);
                    let apart = tracer.apart(mv, profiles, out);
                    let peak_w = kept.peak_w(index, 0);
                    if let Some(terms) = kept.terms(index) {
                        (terms.apart, terms.cruise_w) = (apart, peak_w);
                    }
                    continue;
                }
            }
            if let Trajectory::Path(profile) = &plan.trajectory
                && track.limits.only_stores()
                && let Some(line) = tracer.line(mv, profile)
                && let Some(most_w) = tracer.fed_back_bound_w(&line)
            {
                kept.push_line(index, most_w, line);
            } else if self.waiting.is_none() && mv.arc.is_some() && !track.bounds {
                // Many slices: they are not kept.
                tracer.plan(mv, plan, &mut |slice| track.take(&slice, place));
            } else {
                tracer.plan(mv, plan, &mut |slice| kept.push(index, slice));
                if track.bounds && mv.arc.is_some() {
                    let peak_w = kept.peak_w(index, 0);
                    if let Some(terms) = kept.terms(index) {
                        terms.cruise_w = peak_w;
                    }
                }
            }
        }
        self.kept(model, mv, &mut kept);
        self.kept = kept;
    }

    /// Keeps a piece of a plan for the move that it belongs to, with the step of
    /// speed with which it begins.
    pub fn keep(
        &self,
        model: &PowerModel,
        mv: &Move,
        planned: &Planned<u64>,
        step: Option<&StepEnergy>,
        kept: &mut Buffered,
    ) {
        for (index, track) in self.tracks.iter().enumerate() {
            let Some(tracer) = track.tracer(track.model(model, &self.models)) else {
                continue;
            };
            let before = kept.slices(index).len();
            let (mut most_s, mut more_w) = (0.0, 0.0);
            if let Some(step) = step {
                most_s = step.response_s.min(planned.duration_s());
                more_w = tracer.step_j(step) / most_s;
            }
            if more_w <= 0.0 || more_w.is_nan() {
                tracer.piece(mv, planned, &mut |slice| kept.push(index, slice));
            } else {
                tracer.piece(mv, planned, &mut |slice| {
                    let [first, rest] = slice.cut(most_s);
                    most_s -= slice.duration_s;
                    for slice in first.map(|it| it.raised(more_w)).into_iter().chain(rest) {
                        kept.push(index, slice);
                    }
                });
            }
            if track.bounds {
                if let Some(added) = kept.step(index) {
                    *added = Added {
                        more_w,
                        lasts_s: step.map_or(0.0, |step| step.response_s),
                    };
                }
                let rest_w = tracer.rest_w(mv);
                let cruise_w = match &planned.piece {
                    Piece::Along { .. } if mv.arc.is_none() => {
                        tracer.cruise_w(mv, planned.top_speed_mm_s())
                    }
                    Piece::Joined { direction } => {
                        let line = straight_line(mv, direction, planned.length_mm);
                        tracer.cruise_w(&line, planned.top_speed_mm_s())
                    }
                    _ => kept.peak_w(index, before),
                };
                if let Some(terms) = kept.terms(index) {
                    terms.rest_w = terms.rest_w.max(rest_w);
                    terms.cruise_w = terms.cruise_w.max(cruise_w);
                    terms.least_share = self.least_share(mv);
                }
            }
        }
    }

    /// Takes what was kept of a move that runs as planned.
    pub fn kept(&mut self, model: &PowerModel, mv: &Move, kept: &mut Buffered) {
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
            let own = track.model(model, &self.models);
            track.take_kept(index, own, kept, &mut Levels::none(), place);
        }
        kept.clear();
        self.end_stretch(Stretch::Move);
    }

    /// Takes a move whose timing is not known: its largest speeds and those of
    /// its neighbours, pieces of its plan that may ask for more, for how long
    /// it may last, and what it draws and feeds back at most where that is known.
    pub fn unknown(
        &mut self,
        model: &PowerModel,
        mv: &Move,
        parts: &[Part<'_>],
        kept: &mut Buffered,
        Known { span, most_w }: Known,
    ) {
        let place = Place::of(mv);
        for (index, track) in self.tracks.iter().enumerate() {
            let own = track.model(model, &self.models);
            let mut powers = own.robust_powers(track.converter, mv, parts);
            let of_flow = match track.flow {
                Flow::Drawn => &mut powers[0],
                Flow::FedBack => &mut powers[1],
            };
            let slices = kept.slices(index).iter();
            *of_flow = slices.fold(*of_flow, |most, slice| {
                super::demand::larger(most, slice.peak_w())
            });
            if let Some(most_w) = most_w {
                powers = std::array::from_fn(|side| powers[side].min(most_w[side]));
            }
            let rest_w = track.still_w(own, mv, parts);
            self.powers.push([powers[0], powers[1], rest_w]);
        }
        let span = self.within(span);
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
        self.end_stretch(Stretch::Move);
    }

    /// What was found, converter by converter. A limit that is kept at the largest
    /// overrides, but not by the bound over all, has that.
    pub fn ratings(&self) -> Vec<Rating> {
        let of = |bounds: bool| {
            let tracks = self
                .tracks
                .iter()
                .filter(move |track| track.bounds == bounds);
            tracks.flat_map(|track| track.limits.ratings(track.converter, self.repeated))
        };
        let mut ratings: Vec<Rating> = of(false).collect();
        for (rating, bound) in ratings.iter_mut().zip(of(true)) {
            if rating.keeps() && !bound.keeps() {
                rating.bound = Some(bound.value);
            }
        }
        ratings
    }
}
