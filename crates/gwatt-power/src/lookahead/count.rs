//! Pieces of plans, counted for the moves that they belong to.

use super::joints::step_before;
use super::open::Open;
use super::{Ahead, Side};
use crate::demand::Demand;
use crate::model::PowerModel;
use crate::observer::Observer;
use crate::parabolic_blend::{Ride, Tandem};
use crate::piece::{is_quiet, piece_demand};
use crate::steps::StepEnergy;
use crate::surge::{Surge, surge_demand};
use crate::tandem_energy::shared_energy_j;
use gwatt_motion::Move;
use gwatt_plan::lookahead::{Piece, Planned};

impl Ahead {
    /// Counts a piece of path.
    #[inline]
    pub(super) fn take(
        &mut self,
        model: &PowerModel,
        observer: &mut Observer,
        planned: &Planned<u64>,
        peaks: bool,
        times: bool,
    ) {
        if planned.next.is_some() || planned.first != planned.tag {
            return self.take_shared(model, observer, planned, peaks, times);
        }
        let number = planned.tag;
        let Some(open) = self.open.get_mut(number) else {
            return;
        };
        if times && !observer.is_closed() {
            observer.show_piece(&open.mv, planned);
        }
        let duration_s = planned.duration_s();
        let rests = planned.speeds2.start == 0.0 && planned.speeds2.end == 0.0;
        open.alone &= rests && is_whole(&open.mv, planned);
        open.steady &= planned.speeds2.are_one();
        let with_energy = times && open.want.energy;
        let watched = peaks && observer.watch.is_some();
        if with_energy || watched {
            let step = self.step(planned, peaks);
            let Some(open) = self.open.get_mut(number) else {
                return;
            };
            if with_energy && let Some(step) = &step {
                open.assessment.demand.energy_j += step.supplied_j(model);
            }
            if watched {
                observer.keep(model, &open.mv, planned, step.as_ref(), &mut open.kept);
            }
        }
        if peaks {
            self.follow(model, planned);
        }
        let Some(open) = self.open.get_mut(number) else {
            return;
        };
        if times {
            open.assessment.duration_s += duration_s;
        }
        let matters = with_energy || peaks && !is_quiet(model, &open.mv, planned, open.want);
        if matters {
            let demand = piece_demand(model, &open.mv, planned, open.want);
            if with_energy {
                open.assessment.demand.energy_j += demand.energy_j;
            }
            if peaks {
                open.assessment.demand.include(&demand);
                let loads = &mut open.assessment.loads;
                loads.own = loads.own.max(demand.load_ratio);
            }
        }
        if peaks {
            let late = self.late(model, planned);
            let ranged = self.ranged(model, observer, planned);
            let surge = self.surge(model, observer, planned);
            let Some(open) = self.open.get_mut(number) else {
                return;
            };
            for demand in late.iter().chain(&ranged) {
                open.assessment.demand.include(demand);
                open.in_turn = false;
            }
            if let Some(surge) = surge {
                open.assessment.demand.include(&surge);
            }
            open.count_speeds(planned);
            let doubtful =
                open.in_doubt || self.reach2.is_some() || !planned.certain || planned.overlaps;
            if doubtful {
                self.ride(model, observer, planned, true, times);
                let certain = self.is_certain(planned, number, number);
                if let Some(open) = self.open.get_mut(number) {
                    open.certain &= certain;
                }
            }
        } else {
            self.ride(model, observer, planned, false, times);
        }
    }

    /// What a piece asks for where a lower pace comes into force late, or before it has come
    /// down to that.
    fn late(&mut self, model: &PowerModel, planned: &Planned<u64>) -> Option<Demand> {
        if planned.late_mm_s > 0.0 {
            let brakes_mm = planned.late_mm_s * planned.late_mm_s / planned.accel_mm_s2;
            self.late = Some((brakes_mm, planned.late_mm_s));
        }
        let (left_mm, late_mm_s) = self.late?;
        let left_mm = left_mm - planned.length_mm;
        let goes_on = left_mm > 0.0 && planned.speeds2.end > 0.0;
        self.late = goes_on.then_some((left_mm, late_mm_s));
        let open = self.open.get(planned.tag)?;
        let surge = Surge {
            rises_mm_s: Some(late_mm_s),
            falls_mm_s: Some(late_mm_s),
            accel_mm_s2: planned.accel_mm_s2,
            section: None,
        };
        Some(surge_demand(model, &open.mv, planned, surge, open.want))
    }

    /// The step of speed before a piece, at the largest overrides or at 100 %.
    fn step(&mut self, planned: &Planned<u64>, peaks: bool) -> Option<StepEnergy> {
        let response_s = self.steps.response_s();
        let open = self.open.get(planned.tag)?;
        let side = match &mut self.nominal {
            Some(nominal) if !peaks => nominal,
            _ => &mut self.largest,
        };
        let (step, end_mm_s) = step_before(&open.mv, planned, &side.end_mm_s, response_s);
        side.end_mm_s = end_mm_s;
        Some(step)
    }

    /// Counts a piece of path that belongs to several moves.
    fn take_shared(
        &mut self,
        model: &PowerModel,
        observer: &mut Observer,
        planned: &Planned<u64>,
        peaks: bool,
        times: bool,
    ) {
        let (from, own) = (planned.first, planned.tag);
        let to = planned.next.unwrap_or(own);
        if times && let Some(open) = self.open.get(own) {
            match self.open.get(to).filter(|_| to > own) {
                Some(next) => observer.show_blend(&open.mv, &next.mv, planned),
                None => observer.show_piece(&open.mv, planned),
            }
        }
        let Some(open) = self.open.get(own) else {
            return;
        };
        let with_energy = times && open.want.energy;
        let watched = peaks && observer.watch.is_some();
        let step = (with_energy || watched).then(|| self.step(planned, peaks));
        let step = step.flatten();
        if peaks {
            self.follow(model, planned);
        }
        let Some(open) = self.open.get_mut(own) else {
            return;
        };
        if peaks {
            open.rests |= planned.rests;
            observer.keep(model, &open.mv, planned, step.as_ref(), &mut open.kept);
        }
        let mut demand = if !open.want.energy && is_quiet(model, &open.mv, planned, open.want) {
            Demand::NONE
        } else {
            piece_demand(model, &open.mv, planned, open.want)
        };
        if with_energy && let Some(step) = &step {
            demand.energy_j += step.supplied_j(model);
        }
        self.ride(model, observer, planned, peaks, times);
        let late = peaks.then(|| self.late(model, planned)).flatten();
        let ranged = peaks
            .then(|| self.ranged(model, observer, planned))
            .flatten();
        for one in late.iter().chain(&ranged) {
            demand.include(one);
        }
        if peaks {
            if let Some(surge) = self.surge(model, observer, planned) {
                demand.include(&surge);
            }
            if self.surges.is_some()
                && let Some(open) = self.open.get(own)
                && let Some(turned) = model.turned_down(&open.mv, planned)
            {
                demand.include(&turned);
            }
        }
        let certain = !peaks || self.is_certain(planned, from, to);
        let certain = (certain, late.is_none() && ranged.is_none());
        self.share_out(planned, demand, certain, [peaks, times]);
    }

    /// Gives each move of a piece its share of what the piece takes and asks for.
    fn share_out(
        &mut self,
        planned: &Planned<u64>,
        mut demand: Demand,
        (certain, in_turn): (bool, bool),
        [peaks, times]: [bool; 2],
    ) {
        let (from, own) = (planned.first, planned.tag);
        let to = planned.next.unwrap_or(own);
        // Half of a blend belongs to what is after it, if that is another move: it
        // may lie between two chords of one arc.
        let halves = if to == own { 1.0 } else { 0.5 };
        let lengths: f64 = (from..=own)
            .filter_map(|number| self.open.get(number))
            .map(|open| open.mv.length_mm)
            .sum();
        let energy_j = std::mem::take(&mut demand.energy_j);
        let duration_s = planned.duration_s();
        let rests = planned.speeds2.start == 0.0 && planned.speeds2.end == 0.0;
        for number in from..=to {
            let Some(open) = self.open.get_mut(number) else {
                continue;
            };
            if open.mv.length_mm <= 0.0 {
                continue;
            }
            let share = if number > own {
                1.0 - halves
            } else {
                halves * open.mv.length_mm / lengths
            };
            let assessment = &mut open.assessment;
            open.certain &= certain;
            open.in_turn &= in_turn;
            open.alone &= from == to && rests && is_whole(&open.mv, planned);
            open.steady &= planned.speeds2.are_one();
            if times {
                assessment.duration_s += share * duration_s;
                assessment.demand.energy_j += share * energy_j;
            }
            if peaks {
                assessment.fastest_s += share * duration_s;
                let top_speed_mm_s = planned.top_speed_mm_s();
                assessment.top_speed_mm_s = assessment.top_speed_mm_s.max(top_speed_mm_s);
                assessment.demand.include(&demand);
            }
        }
    }

    /// A piece that may share its time with another one, and what both ask for
    /// together.
    fn ride(
        &mut self,
        model: &PowerModel,
        observer: &Observer,
        planned: &Planned<u64>,
        peaks: bool,
        times: bool,
    ) {
        let last = self.side(peaks).last_ride.take();
        if !planned.overlaps {
            return;
        }
        let ride = self.open.get(planned.tag).and_then(|open| {
            let speeds2 = [open.pace.asked2, open.pace.cap2];
            Ride::of(&open.mv, planned, speeds2.map(f64::sqrt))
        });
        let Some(ride) = ride else {
            return;
        };
        let apart = |last: &Ride| last.moves[1] < ride.moves[0];
        let last = last.filter(|last| planned.overlap_s > 0.0 && apart(last));
        let together = last.is_some();
        if let Some(last) = last {
            let rides = [&last, &ride];
            if peaks {
                self.ride_together(model, observer, rides, planned.overlap_s);
            }
            if times
                && let Some(open) = self.open.get_mut(planned.tag)
                && open.want.energy
            {
                let shared_j = shared_energy_j(model, &open.mv, rides, planned.overlap_s);
                open.assessment.demand.energy_j += shared_j;
            }
        }
        if peaks {
            for number in ride.moves[0]..=ride.moves[1] {
                if let Some(open) = self.open.get_mut(number) {
                    open.alone = false;
                    open.in_turn &= together || planned.overlap_s <= 0.0;
                }
            }
        }
        self.side(peaks).last_ride = Some(ride);
    }

    /// The planner that peaks come from, or else times and energies.
    fn side(&mut self, peaks: bool) -> &mut Side {
        match &mut self.nominal {
            Some(nominal) if !peaks => nominal,
            _ => &mut self.largest,
        }
    }

    /// What two pieces ask for that share some of their time.
    fn ride_together(
        &mut self,
        model: &PowerModel,
        observer: &Observer,
        rides: [&Ride; 2],
        overlap_s: f64,
    ) {
        let [last, ride] = rides;
        let tandem = if self.surges.is_some() {
            Tandem::at_any(rides, overlap_s)
        } else {
            Tandem::new(rides, overlap_s)
        };
        let [before, own] = [last.moves[1], ride.moves[1]];
        let Some(open) = self.open.get(own) else {
            return;
        };
        let demand = tandem.demand(model, &open.mv);
        let mut kept = self.open.take_kept(before);
        if let Some(open) = self.open.get_mut(own) {
            observer.together(model, &open.mv, &tandem, [&mut kept, &mut open.kept]);
        }
        if let Some(open) = self.open.get_mut(before) {
            open.kept = kept;
        }
        for number in last.moves[0]..=ride.moves[1] {
            if let Some(open) = self.open.get_mut(number) {
                open.assessment.demand.include(&demand);
            }
        }
    }

    /// Whether a piece runs as planned whatever happened where the motion was in
    /// doubt before it.
    fn is_certain(&mut self, planned: &Planned<u64>, from: u64, to: u64) -> bool {
        let blend = matches!(planned.piece, Piece::Blend(_));
        for number in from..=to {
            if let Some(open) = self.open.get_mut(number)
                && open.in_doubt
            {
                // After a stop there is no blend: the line begins at rest.
                open.in_doubt = blend;
                self.reach2 = Some(0.0);
            }
        }
        let end2 = planned.speeds2.end;
        if !planned.certain {
            self.reach2 = (end2 > 0.0).then_some(0.0);
            return false;
        }
        let Some(reach2) = self.reach2 else {
            return true;
        };
        // Half of the acceleration, since the blends differ as well.
        let reached2 = planned.reached2(reach2);
        self.reach2 = (reached2 < end2).then_some(reached2);
        false
    }
}

/// Whether a piece is the whole path of a move.
fn is_whole(mv: &Move, planned: &Planned<u64>) -> bool {
    matches!(planned.piece, Piece::Along { from_mm, to_mm }
        if from_mm == 0.0 && to_mm >= mv.length_mm)
}

impl Open {
    /// Takes in the speeds of a piece of the move.
    #[inline]
    fn count_speeds(&mut self, planned: &Planned<u64>) {
        self.rests |= planned.rests;
        let assessment = &mut self.assessment;
        assessment.fastest_s += planned.duration_s();
        let [start2, end2] = &mut assessment.ends2;
        if assessment.top_speed_mm_s == 0.0 {
            *start2 = planned.speeds2.start;
        }
        *end2 = planned.speeds2.end;
        assessment.top_speed_mm_s = assessment.top_speed_mm_s.max(planned.top_speed_mm_s());
    }
}
