//! Axes that run for themselves, where the knob stands between two overrides: each axis
//! reaches its places later, by how much is not known.
//!
//! With the larger override as 1 and the lower one as σ, a place that is reached after τ is
//! reached between τ and τ/σ: the same motion run slowly all along is no quicker, since
//! nothing but the speed is lower. So at t an axis is where it is between σ·t and t at the
//! larger override, and draws no more than the most that it draws there, ramps counted at
//! least as cruises (see `raised`).

use super::slice::Slice;
use super::{Flow, Tracer};
use arrayvec::ArrayVec;
use gwatt_machine::AXES;
use gwatt_motion::Move;
use gwatt_plan::{Phase, Profile};

/// Parts of a ramp.
const PARTS: u32 = 16;

/// What an axis draws above rest at most for some time, W.
#[derive(Debug, Clone, Copy)]
struct Part {
    from_s: f64,
    to_s: f64,
    power_w: f64,
}

impl Tracer<'_> {
    /// Slices no lower than what is drawn at any override between `least_share` of the one
    /// planned for and that: `now` while the move lasts there, `late` what may come after.
    pub fn shifted(
        &self,
        mv: &Move,
        profiles: &[(usize, Profile)],
        least_share: f64,
        now: &mut impl FnMut(Slice),
        late: &mut impl FnMut(Slice),
    ) {
        let rest_w = self.rest_w(mv);
        let durations = profiles.iter().map(|(_, profile)| profile.duration_s());
        let duration_s = durations.fold(0.0, f64::max);
        let own = profiles
            .iter()
            .filter(|(axis, _)| self.converter.axes.contains(*axis));
        let axes: ArrayVec<Vec<Part>, AXES> = own
            .map(|(axis, profile)| self.parts(mv, *axis, profile))
            .take(AXES)
            .collect();
        let ends = axes.iter().flatten().map(|part| part.to_s);
        let mut instants: Vec<f64> = ends
            .chain([duration_s])
            .flat_map(|end_s| [end_s, end_s / least_share])
            .collect();
        instants.sort_by(f64::total_cmp);
        let mut from_s = 0.0;
        for to_s in instants {
            if to_s <= from_s {
                continue;
            }
            let most_w = |parts: &Vec<Part>| {
                let met = parts
                    .iter()
                    .filter(|part| part.from_s <= to_s && part.to_s >= from_s * least_share);
                met.fold(0.0, |most, part| crate::demand::larger(most, part.power_w))
            };
            let power_w = rest_w + axes.iter().map(most_w).sum::<f64>();
            let slice = Slice::constant(to_s - from_s, power_w);
            if to_s <= duration_s {
                now(slice);
            } else {
                late(slice);
            }
            from_s = to_s;
        }
    }

    /// What one axis draws above rest, in the order of time.
    fn parts(&self, mv: &Move, axis: usize, profile: &Profile) -> Vec<Part> {
        let unit = self.model.axes[axis].si_per_unit;
        let direction = [(axis, unit.copysign(mv.end[axis] - mv.start[axis]))];
        let rest_w = self.base_w(0.0) + self.held_w(axis);
        let mut parts = Vec::new();
        let mut now_s = 0.0;
        for phase in &profile.phases {
            let count = if phase.is_cruise() { 1 } else { PARTS };
            for part in super::raised::split(phase, f64::from(count)) {
                let to_s = now_s + part.duration_s;
                let power_w = self.most_w(&direction, &part) - rest_w;
                parts.push(Part {
                    from_s: now_s,
                    to_s,
                    power_w,
                });
                now_s = to_s;
            }
        }
        parts
    }

    fn most_w(&self, direction: &[(usize, f64)], phase: &Phase) -> f64 {
        let mut most_w = match self.flow {
            Flow::Drawn => 0.0,
            Flow::FedBack => f64::NEG_INFINITY,
        };
        self.raised_phase(direction, phase, 0.0, &mut |slice| {
            most_w = crate::demand::larger(most_w, slice.peak_w());
        });
        most_w
    }
}
