//! Independent rapids at any override: the instants at which the axes switch shift
//! against each other.
//!
//! Input: a rapid whose axes run for themselves. Output: an upper bound of its peaks
//! over all overrides from 0 to the largest, at most [`CLOSE`] above what some override
//! has, unless that takes too many steps.
//!
//! At one override o the power is the largest where some axis switches, since it is
//! convex in time between two such instants; what is fed back bends the other way
//! by viscous friction alone, which is added. Between o₁ and o₂ an instant lies in a
//! window of time, and each axis is in one of few phases then, at speeds that are
//! bounded: the sum of their largest powers bounds all o between, and comes closer as
//! o₁ and o₂ do.

use super::axis::{AxisPower, Side};
use super::blend::BLENDED;
use super::demand::{Demand, Totals, Want, larger};
use super::independent;
use super::model::{ConverterPower, PowerModel};
use super::slower;
use arrayvec::ArrayVec;
use gwatt_machine::{AXES, AxisSet, Machine};
use gwatt_motion::{Move, MoveKind};
use gwatt_plan::{Overrides, PhaseKind, Plan, Profile, Trajectory, plan};

/// How close the bound comes, as a share.
pub(super) const CLOSE: f64 = 1e-6;
/// Ranges of the override that are looked at, at most.
const RANGES_MAX: usize = 400;
/// Parts of a ramp on which the bend of what is fed back counts.
const PARTS: u32 = 16;
/// One axis at one override: speeds in SI.
#[derive(Debug, Clone, Copy)]
struct Ride {
    axis: usize,
    /// Direction of motion.
    sign: f64,
    accel: f64,
    top: f64,
    /// When it has sped up, when it begins to brake, and when it has arrived, s.
    times_s: [f64; 3],
}

/// The axes of a converter at one override.
type Rides = ArrayVec<Ride, AXES>;

/// A range of overrides, with a bound of what is asked for.
struct Range {
    rides: [Rides; 2],
    knobs: [f64; 2],
    upper_w: f64,
}

/// Which of both peaks is meant.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Peak {
    Drawn,
    FedBack,
}

impl PowerModel {
    /// The demand of a plan at the largest overrides, with what any lower one may make
    /// of it where that matters; the energy is that of the plan.
    #[must_use]
    pub fn demand_at_any(
        &self,
        machine: &Machine,
        mv: &Move,
        planned: &Plan,
        largest: Overrides,
        want: Want,
    ) -> Demand {
        let mut demand = self.demand(mv, planned, want);
        if machine.limits.override_at.is_some() {
            return demand;
        }
        let profiles = match &planned.trajectory {
            Trajectory::Axes(profiles) => profiles,
            Trajectory::Path(_) => {
                demand = self.with_cruises(demand, mv, planned.top_speed_mm_s);
                let jerks = |axis: usize| {
                    let axis = machine.axes.get(axis).and_then(Option::as_ref);
                    axis.is_some_and(|it| it.jerk_mm_s3 > 0.0)
                };
                let gentler = mv.moving.iter().any(jerks) && self.has_copper(mv);
                if mv.arc.is_some() || gentler {
                    self.turn_slower(machine, mv, largest, want, &mut demand);
                }
                return demand;
            }
            Trajectory::Rest | Trajectory::Unknown(_) => return demand,
        };
        let at = |knob: f64| {
            let rapid = largest.rapid * knob;
            plan(machine, mv, Overrides { rapid, ..largest })
        };
        demand.include(&self.alone_at_any(mv, profiles, &at, want));
        if !profiles.iter().all(|(_, profile)| is_trapezoid(profile)) {
            demand.include(&self.each_at_its_worst(mv, profiles, want));
            return demand;
        }
        let mut any = Demand::NONE;
        for (index, converter) in self.converters.iter().enumerate() {
            let active = AxisSet(mv.moving.0 & converter.axes.0);
            if active.iter().count() < 2 {
                continue;
            }
            let mut totals = Totals::new(converter.idle_w(mv, &self.axes, active));
            let knob = Knob {
                model: self,
                converter,
                mv,
                idle_w: totals.idle_w,
                plan: &at,
            };
            for (peak, floor_w) in [
                (Peak::Drawn, want.floor_w),
                (Peak::FedBack, want.regen_floor_w),
            ] {
                let most_w = knob.most_w(peak, floor_w);
                match peak {
                    Peak::Drawn => totals.raise_peak(most_w),
                    Peak::FedBack => totals.raise_regen(most_w),
                }
            }
            any.add(index, converter, totals);
        }
        let close = |any: f64, own: f64| if any <= own * (1.0 + CLOSE) { own } else { any };
        if any.converter == demand.converter && any.load_ratio > f64::NEG_INFINITY {
            // Where no other override has more, the figures are those of the largest.
            any.peak_w = close(any.peak_w, demand.peak_w);
            any.regen_w = close(any.regen_w, demand.regen_w);
            any.load_ratio = close(any.load_ratio, demand.load_ratio);
        }
        if any.load_ratio > f64::NEG_INFINITY {
            demand.include(&any);
        }
        demand
    }
}

impl PowerModel {
    /// Whether friction that grows with speed counts in a move, or in a blend after it.
    pub(super) fn has_viscous(&self, mv: &Move) -> bool {
        self.has(mv, |axis| axis.viscous > 0.0)
    }

    /// Whether an axis that moves in it, or in a blend after it, loses power in its copper:
    /// turned or sped up more gently it may feed more back.
    pub(super) fn has_copper(&self, mv: &Move) -> bool {
        self.has(mv, |axis| axis.copper > 0.0)
    }

    fn has(&self, mv: &Move, what: impl Fn(&AxisPower) -> bool) -> bool {
        let axes = AxisSet(mv.moving.0 | BLENDED.0);
        axes.iter()
            .any(|axis| self.axes.get(axis).is_some_and(&what))
    }

    /// Includes what is asked for on an arc at lower overrides, if that is of interest.
    fn turn_slower(
        &self,
        machine: &Machine,
        mv: &Move,
        largest: Overrides,
        want: Want,
        demand: &mut Demand,
    ) {
        let at = |knob: f64| {
            let (feed, rapid) = (largest.feed * knob, largest.rapid * knob);
            plan(
                machine,
                mv,
                Overrides {
                    feed,
                    rapid,
                    ..largest
                },
            )
        };
        // Where less is taken for turning, more is left for speeding up.
        let steepest_mm_s2 = at(slower::LEAST).accel_mm_s2;
        let fastest_mm_s = at(1.0).top_speed_mm_s;
        let asked_mm_s = match mv.kind {
            MoveKind::Rapid => fastest_mm_s,
            _ => (mv.feed_mm_s * largest.feed).max(fastest_mm_s),
        };
        let per_mm = mv.arc.as_ref().map_or(0.0, |arc| 1.0 / arc.radius_mm);
        let turning_mm_s2 = fastest_mm_s * fastest_mm_s * per_mm;
        if self.is_below_floor(mv, [fastest_mm_s, steepest_mm_s2 + turning_mm_s2], want) {
            return;
        }
        let mut lower = Demand::NONE;
        for speed_mm_s in slower::speeds_mm_s(fastest_mm_s) {
            let plan = at(speed_mm_s / asked_mm_s);
            lower.include(&self.demand(mv, &plan, Want::PEAKS));
        }
        demand.include_slower(lower);
        if self.has_copper(mv) {
            // Just below its largest speed it turns without being sped up or braked.
            let plan = at(fastest_mm_s * slower::JUST_BELOW / asked_mm_s);
            demand.include(&self.demand(mv, &plan, Want::PEAKS));
        }
    }

    /// The same without losses in the copper.
    pub(super) fn lossless(&self) -> Self {
        let mut lossless = self.clone();
        lossless.axes.iter_mut().for_each(|axis| axis.copper = 0.0);
        lossless
    }

    /// The same without friction that grows with speed, without losses in the copper,
    /// and without what is drawn meanwhile taken off: what is fed back is then in
    /// proportion to the speed, and nowhere less.
    pub(super) fn unbraked(&self) -> Self {
        let mut unbraked = self.lossless();
        unbraked.axes.iter_mut().for_each(|axis| axis.viscous = 0.0);
        for converter in &mut unbraked.converters {
            converter.curved = AxisSet::default();
            converter.holding = AxisSet::default();
            converter.credit_regen = false;
        }
        unbraked
    }

    /// The largest powers of all axes at once, whenever each of them has its own: with
    /// other speeds they meet otherwise. An axis that is given less speed has no more
    /// acceleration at any, so that its largest power is that at its largest speed; what
    /// is fed back counts without the loss in the copper, which may fall faster.
    fn each_at_its_worst(&self, mv: &Move, profiles: &[(usize, Profile)], want: Want) -> Demand {
        let want = Want {
            energy: false,
            floor_w: f64::NEG_INFINITY,
            regen_floor_w: f64::NEG_INFINITY,
            ..want
        };
        let lossless = self.lossless();
        let mut demand = Demand::NONE;
        for (index, converter) in self.converters.iter().enumerate() {
            let active = AxisSet(mv.moving.0 & converter.axes.0);
            if active.iter().count() < 2 {
                continue;
            }
            let idle_w = converter.idle_w(mv, &self.axes, active);
            let mut peaks_w = [0.0; 2];
            for own in profiles.iter().filter(|(axis, _)| active.contains(*axis)) {
                let mut alone = mv.clone();
                alone.moving = AxisSet::default();
                alone.moving.insert(own.0);
                let one = std::slice::from_ref(own);
                let of = |model| independent::totals(model, converter, &alone, one, 0.0, want);
                let holding_w = self.axes.get(own.0).map_or(0.0, AxisPower::holding_w);
                peaks_w[0] += larger(of(self).peak_w, holding_w);
                peaks_w[1] += of(&lossless).regen_w;
            }
            let mut totals = Totals::new(idle_w);
            totals.raise_peak(idle_w + peaks_w[0]);
            totals.raise_regen(peaks_w[1]);
            demand.add(index, converter, totals);
        }
        demand
    }

    /// What is wanted of a move of which it is to be known whether it fits alone: peaks
    /// far below the limits need not be exact.
    #[must_use]
    pub fn around_limits(&self, mv: &Move) -> Want {
        let mut want = Want::PEAKS;
        if let [converter] = self.converters.as_slice()
            && !converter.feeds_spindle
            && mv.unknown_start.is_empty()
        {
            want.floor_w = 0.99 * converter.limit_w();
            want.regen_floor_w = 0.99 * self.regen_limit_w(0).unwrap_or(f64::INFINITY);
        }
        want
    }
}

/// Whether a profile is a ramp up, perhaps a cruise, and a ramp down.
fn is_trapezoid(profile: &Profile) -> bool {
    let steady = |kind: PhaseKind| kind == PhaseKind::ConstantAcceleration;
    let phases = &profile.phases;
    (2..=3).contains(&phases.len()) && phases.iter().all(|phase| steady(phase.kind))
}

/// An independent rapid on one converter.
struct Knob<'a, P> {
    model: &'a PowerModel,
    converter: &'a ConverterPower,
    mv: &'a Move,
    idle_w: f64,
    /// The plan at a share of the largest override.
    plan: &'a P,
}

impl<P: Fn(f64) -> Plan> Knob<'_, P> {
    /// The bound of one peak over all overrides; anything up to the floor where it is
    /// no larger.
    fn most_w(&self, peak: Peak, floor_w: f64) -> f64 {
        let top = self.rides(1.0);
        let mut best_w = self.bound_w(peak, [&top, &top]);
        let mut ranges = vec![self.range(peak, [Rides::new(), top], [0.0, 1.0])];
        loop {
            let worst =
                (0..ranges.len()).max_by(|a, b| ranges[*a].upper_w.total_cmp(&ranges[*b].upper_w));
            let Some(worst) = worst else {
                return best_w;
            };
            let upper_w = ranges[worst].upper_w;
            if upper_w <= larger(best_w * (1.0 + 0.5 * CLOSE), floor_w)
                || ranges.len() >= RANGES_MAX
            {
                return larger(upper_w, best_w);
            }
            let Range { rides, knobs, .. } = ranges.swap_remove(worst);
            let knob = 0.5 * (knobs[0] + knobs[1]);
            let middle = self.rides(knob);
            best_w = larger(best_w, self.bound_w(peak, [&middle, &middle]));
            let [low, high] = rides;
            ranges.push(self.range(peak, [low, middle.clone()], [knobs[0], knob]));
            ranges.push(self.range(peak, [middle, high], [knob, knobs[1]]));
        }
    }

    fn range(&self, peak: Peak, mut rides: [Rides; 2], knobs: [f64; 2]) -> Range {
        if rides[0].is_empty() {
            // At next to no override all lasts for ever.
            let [low, high] = &mut rides;
            low.clone_from(high);
            for ride in &mut rides[0] {
                ride.top = 0.0;
                ride.times_s = [0.0, f64::INFINITY, f64::INFINITY];
            }
        }
        let upper_w = self.bound_w(peak, [&rides[0], &rides[1]]);
        Range {
            rides,
            knobs,
            upper_w,
        }
    }

    /// The axes at a share of the largest override.
    fn rides(&self, knob: f64) -> Rides {
        let plan = (self.plan)(knob);
        let Trajectory::Axes(profiles) = &plan.trajectory else {
            return Rides::new();
        };
        let own = profiles
            .iter()
            .filter(|(axis, _)| self.converter.axes.contains(*axis));
        let rides = own.filter_map(|(axis, profile)| {
            let first = profile.phases.first()?;
            let last = profile.phases.last()?;
            let distance = self.mv.end[*axis] - self.mv.start[*axis];
            let si = self.model.axes[*axis].si_per_unit;
            let duration_s = profile.duration_s();
            Some(Ride {
                axis: *axis,
                sign: 1.0_f64.copysign(distance),
                accel: si * first.accel_mm_s2,
                top: si * first.end_velocity_mm_s,
                times_s: [first.duration_s, duration_s - last.duration_s, duration_s],
            })
        });
        rides.take(AXES).collect()
    }

    /// The bound between two overrides, the lower one first.
    fn bound_w(&self, peak: Peak, [low, high]: [&Rides; 2]) -> f64 {
        let mut most_w = 0.0_f64;
        let bends = peak == Peak::FedBack
            && high
                .iter()
                .any(|ride| self.model.axes[ride.axis].viscous > 0.0);
        let parts = if bends { PARTS } else { 1 };
        let mut look = |window: [f64; 2]| {
            most_w = larger(most_w, self.window_w(peak, [low, high], window, bends));
        };
        look([0.0, 0.0]);
        for (low, high) in low.iter().zip(high) {
            let [up, down, end] = [0, 1, 2].map(|i| [low.times_s[i], high.times_s[i]]);
            look(ordered(end));
            for part in 1..=parts {
                let share = f64::from(part) / f64::from(parts);
                look(ordered(up.map(|t| t * share)));
                let braked = |i: usize| {
                    let (from, to) = (down[i], end[i]);
                    if from < f64::INFINITY {
                        to + (from - to) * share
                    } else {
                        from
                    }
                };
                look(ordered([braked(0), braked(1)]));
            }
        }
        match peak {
            Peak::Drawn => self.idle_w + most_w,
            Peak::FedBack if self.converter.credit_regen => most_w - self.idle_w,
            Peak::FedBack => most_w,
        }
    }

    /// What all axes together may have within a window of time.
    fn window_w(&self, peak: Peak, [low, high]: [&Rides; 2], window: [f64; 2], bends: bool) -> f64 {
        let axes = low.iter().zip(high);
        axes.map(|(low, high)| {
            let power = &self.model.axes[low.axis];
            let own_w = self.axis_w(peak, power, [low, high], window);
            let bend_w = if bends {
                bend(power) * (high.top / f64::from(PARTS)).powi(2)
            } else {
                0.0
            };
            own_w + bend_w
        })
        .sum()
    }

    /// The most that one axis may have within a window of time.
    fn axis_w(
        &self,
        peak: Peak,
        power: &AxisPower,
        [low, high]: [&Ride; 2],
        [from_s, to_s]: [f64; 2],
    ) -> f64 {
        let (a, top) = (high.accel, high.top);
        let mut most_w = f64::NEG_INFINITY;
        let mut look = |accel: f64, from: f64, to: f64| {
            let speeds = [from.clamp(0.0, top), to.clamp(0.0, top)];
            most_w = most_w.max(phase_w(peak, power, high.sign, accel, speeds));
        };
        if from_s <= high.times_s[0] {
            look(a, a * from_s, a * to_s);
        }
        if to_s >= low.times_s[0] && from_s <= low.times_s[1] {
            look(0.0, low.top, top.min(a * to_s));
        }
        if to_s >= high.times_s[1] && from_s <= low.times_s[2] {
            look(
                -a,
                a * (high.times_s[2] - to_s),
                a * (low.times_s[2] - from_s),
            );
        }
        if to_s >= high.times_s[2] {
            let holding_w = power.holding_w();
            most_w = most_w.max(match peak {
                Peak::Drawn => holding_w,
                Peak::FedBack => -holding_w,
            });
        }
        if self.converter.credit_regen {
            most_w
        } else {
            most_w.max(0.0)
        }
    }
}

fn ordered([a, b]: [f64; 2]) -> [f64; 2] {
    if b < a { [b, a] } else { [a, b] }
}

/// An eighth of how much what is fed back bends with speed.
fn bend(power: &AxisPower) -> f64 {
    let viscous = power.viscous_most();
    0.25 * (power.inverse_efficiency * viscous + power.copper * viscous * viscous)
}

/// The most that an axis draws or feeds back between two speeds, SI.
fn phase_w(peak: Peak, power: &AxisPower, sign: f64, accel: f64, speeds: [f64; 2]) -> f64 {
    let side = match peak {
        Peak::Drawn => Side::Motor,
        Peak::FedBack => Side::Regen,
    };
    let drawn = |speed: f64| power.power(side, sign * speed, sign * accel, sign);
    let ends = speeds.map(drawn);
    match peak {
        Peak::Drawn => larger(ends[0], ends[1]),
        Peak::FedBack => {
            let forces = speeds.map(|speed| power.force(side, sign * speed, sign * accel, sign));
            let turns = forces[0] * forces[1] < 0.0;
            let most = larger(-ends[0], -ends[1]);
            let most = if turns { most.max(0.0) } else { most };
            most + bend(power) * (speeds[1] - speeds[0]).powi(2)
        }
    }
}
