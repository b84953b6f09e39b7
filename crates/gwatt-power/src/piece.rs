//! Demand of a piece of a plan: a stretch of a move, a line that stands for
//! several, or a blend.
//!
//! Input: the piece with its profile, and the move that it belongs to. Output:
//! its [`Demand`].

use super::blend;
use super::demand::{Demand, Want};
use super::model::PowerModel;
use super::slower::{BETWEEN, speeds_mm_s};
use gwatt_machine::{AXES, AxisSet};
use gwatt_motion::Move;
use gwatt_plan::lookahead::{Piece, Planned, Speeds2};
use gwatt_plan::{Blend, Plan, Profile, Trajectory};

/// What a piece asks for, at the speed of its profile.
pub(super) fn piece_demand(
    model: &PowerModel,
    mv: &Move,
    planned: &Planned<u64>,
    want: Want,
) -> Demand {
    let mut profile = planned.profile();
    match &planned.piece {
        Piece::Along { from_mm, .. } => {
            for phase in &mut profile.phases {
                phase.position_mm += from_mm;
            }
            model.path_demand(mv, profile, want)
        }
        Piece::Joined { direction } => {
            let line = straight_line(mv, direction, planned.length_mm);
            model.path_demand(&line, profile, want)
        }
        Piece::Blend(blend) => model.blend_demand(mv, blend, &profile, want),
    }
}

/// What a piece that turns asks for at its own speeds or at lower ones, if that is of
/// interest. `None` for lines; of an S-curve that others share, too. What it asks for below
/// `found` is of no interest: the same moves ask for that already.
pub(super) fn slower_demand(
    model: &PowerModel,
    mv: &Move,
    planned: &Planned<u64>,
    want: Want,
    found: Option<&Demand>,
) -> Option<Demand> {
    let turns = match planned.piece {
        Piece::Along { .. } => mv.arc.is_some(),
        Piece::Joined { .. } => false,
        Piece::Blend(_) => true,
    };
    if !turns || is_quiet(model, mv, planned, want) {
        return None;
    }
    planned.slowed(1.0)?;
    let mut demand = piece_demand(model, mv, planned, below(model, want, [found, None]));
    let want = below(model, want, [found, Some(&demand)]);
    let mut slower = Demand::NONE;
    let top_mm_s = planned.top_speed_mm_s();
    for speed_mm_s in speeds_mm_s(top_mm_s) {
        let Some(piece) = planned.slowed(speed_mm_s / top_mm_s) else {
            continue;
        };
        if is_quiet(model, mv, &piece, want) {
            // So are slower ones: the bound grows with the speed.
            break;
        }
        slower.include(&piece_demand(model, mv, &piece, want));
    }
    demand.include_slower(slower);
    Some(demand)
}

/// Exact peaks.
const EXACT: Want = Want {
    energy: false,
    ..Want::PEAKS
};

/// What is wanted of speeds between which others lie: nothing that stays below what is of
/// interest with what may lie there, or below what is `found`. Of several converters all counts,
/// since one demand speaks of one of them.
fn below(model: &PowerModel, want: Want, found: [Option<&Demand>; 2]) -> Want {
    if model.converters.len() != 1 {
        return EXACT;
    }
    let [mut floor_w, mut regen_floor_w] = [want.floor_w, want.regen_floor_w];
    for found in found.into_iter().flatten() {
        floor_w = floor_w.max(found.peak_w);
        regen_floor_w = regen_floor_w.max(found.regen_w);
    }
    Want {
        floor_w: floor_w / BETWEEN,
        regen_floor_w: regen_floor_w / BETWEEN,
        ..EXACT
    }
}

/// How a piece that turns goes on where one of its ends is passed more slowly.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shift {
    /// It is a chord: as planned it may turn round within, where a slower one goes on.
    Chord,
    /// Its other end is passed as planned.
    Whole,
}

impl Shift {
    /// The speeds of a piece with an end at `low2`: its last one where it is braked.
    fn speeds2(self, planned: &Planned<u64>, low2: f64, falls: bool) -> Speeds2 {
        let Speeds2 { start, end, top } = planned.speeds2;
        let ramp2 = 2.0 * planned.accel_mm_s2 * planned.length_mm;
        let reached2 = low2 + ramp2;
        let other2 = if falls { start } else { end };
        let (high2, top) = match self {
            Self::Chord => (top.min(reached2), top.min(reached2)),
            Self::Whole => (other2.min(reached2), top.min(0.5 * (other2 + reached2))),
        };
        let top = top.max(high2);
        let (start, end) = if falls { (high2, low2) } else { (low2, high2) };
        Speeds2 { start, end, top }
    }
}

/// What a piece that turns asks for that is sped up or braked as planned, but from or to
/// any lower speed: at lower overrides each place is passed with `v² = x − δ`, x the
/// square of the planned speed, and the ramp goes on to places where the planned one has
/// turned round.
/// `sides`: whether it is sped up so, and braked; `want` and `found` as in [`slower_demand`].
pub(super) fn shifted_demand(
    model: &PowerModel,
    mv: &Move,
    planned: &Planned<u64>,
    (shift, sides): (Shift, [bool; 2]),
    (want, found): (Want, Option<&Demand>),
) -> Demand {
    let mut demand = piece_demand(model, mv, planned, below(model, want, [found, None]));
    let want = below(model, want, [found, Some(&demand)]);
    let Speeds2 { start, end, .. } = planned.speeds2;
    let mut lower = Demand::NONE;
    for (side, (low2, falls)) in sides.into_iter().zip([(start, false), (end, true)]) {
        let low_mm_s = low2.sqrt();
        // As planned a chord may turn round within, where a slower one goes on.
        let ends = [low_mm_s, 0.0];
        let speeds_mm_s = ends.into_iter().chain(speeds_mm_s(low_mm_s));
        for low_mm_s in speeds_mm_s.filter(|_| side) {
            let piece = Planned {
                speeds2: shift.speeds2(planned, low_mm_s * low_mm_s, falls),
                ..planned.clone()
            };
            if !is_quiet(model, mv, &piece, want) {
                lower.include(&piece_demand(model, mv, &piece, want));
            }
        }
    }
    demand.include_slower(lower);
    demand
}

/// Whether a quick bound shows that the peaks of a piece are of no interest.
#[inline]
pub(super) fn is_quiet(model: &PowerModel, mv: &Move, planned: &Planned<u64>, want: Want) -> bool {
    let curvature = match &planned.piece {
        Piece::Along { .. } => 0.0,
        Piece::Blend(blend) => 1.0 / blend.radius_mm,
        Piece::Joined { .. } => return false,
    };
    let v = planned.top_speed_mm_s();
    let a = planned.largest_accel_mm_s2();
    let quiet = model.is_below_floor(mv, [v, a + curvature * v * v], want);
    quiet || curvature == 0.0 && model.is_straight_below_floor(mv, [v, a], want)
}

impl PowerModel {
    /// The peaks and the energy of a move that runs along its path by `profile`.
    fn path_demand(&self, mv: &Move, profile: Profile, want: Want) -> Demand {
        let plan = Plan {
            duration_s: 0.0,
            speed_limit_mm_s: 0.0,
            accel_mm_s2: 0.0,
            top_speed_mm_s: 0.0,
            trajectory: Trajectory::Path(profile),
        };
        self.demand(mv, &plan, want)
    }

    /// The peaks and the energy of a blend after the move `mv`.
    pub(super) fn blend_demand(
        &self,
        mv: &Move,
        blend: &Blend,
        profile: &Profile,
        want: Want,
    ) -> Demand {
        let mut demand = Demand::NONE;
        // The line before may stand for several moves: its direction is where
        // the blend begins.
        let lead = straight_line(mv, &blend.tangent, 1.0);
        for (index, converter) in self.converters.iter().enumerate() {
            let totals = blend::totals(self, converter, &lead, blend, profile, want);
            demand.add(index, converter, totals);
        }
        demand
    }
}

/// A line in X, Y and Z, otherwise like the move.
pub(super) fn straight_line(mv: &Move, direction: &[f64], length_mm: f64) -> Move {
    let mut line = mv.clone();
    line.length_mm = length_mm;
    line.arc = None;
    line.start = [0.0; AXES];
    line.end = line.start;
    line.moving = AxisSet::default();
    for (axis, part) in direction.iter().enumerate() {
        line.end[axis] = part * length_mm;
        if *part != 0.0 {
            line.moving.insert(axis);
        }
    }
    line
}

#[cfg(test)]
mod tests {
    use super::super::straight;
    use super::piece_demand;
    use crate::random::Random;
    use crate::sample::any_move;
    use crate::{PowerModel, Want};
    use gwatt_machine::{AxisSet, Machine};
    use gwatt_plan::Blend;
    use gwatt_plan::lookahead::{Piece, Planned, Slack, Speeds2};
    use std::fmt::Write as _;

    const MASS_KG: [f64; 3] = [500.0, 150.0, 300.0];
    const COULOMB_N: [f64; 3] = [90.0, 40.0, 60.0];
    const GRAVITY_N: [f64; 3] = [0.0, 0.0, 400.0];
    const EFFICIENCY: f64 = 0.8;

    fn machine() -> Machine {
        let mut text = "schema = 1\nname = \"test\"\ncontroller = \"linuxcnc\"\n\
             [converter]\npeak_power_w = 1e6\nregen_power_w = 1e6\n"
            .to_owned();
        for (axis, letter) in ["X", "Y", "Z"].into_iter().enumerate() {
            let _ = write!(
                text,
                "[axes.{letter}]\nkind = \"linear\"\nrapid_mm_min = 30000\naccel_mm_s2 = 2000\n\
                 efficiency = {EFFICIENCY:?}\nmass_kg = {:?}\ncoulomb_n = {:?}\ngravity_n = {:?}\n",
                MASS_KG[axis], COULOMB_N[axis], GRAVITY_N[axis]
            );
        }
        Machine::from_toml("test.toml", &text).expect("a machine").0
    }

    impl Random {
        /// Two unit directions at right angles; in the plane of X and Y if so.
        fn frame(&mut self, flat: bool) -> [[f64; 3]; 2] {
            let mut vector = || {
                let v = [(); 3].map(|()| 2.0 * self.next() - 1.0);
                [v[0], v[1], if flat { 0.0 } else { v[2] }]
            };
            let (a, b) = (vector(), vector());
            let dot =
                |a: [f64; 3], b: [f64; 3]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
            let unit = |a: [f64; 3]| a.map(|part| part / dot(a, a).sqrt());
            let tangent = unit(a);
            let along = dot(tangent, b);
            let normal = unit([0, 1, 2].map(|i| b[i] - along * tangent[i]));
            [tangent, normal]
        }
    }

    /// Electrical power of all axes, drawn and fed back, W.
    fn power(blend: &Blend, s: f64, v: f64, a: f64) -> [f64; 2] {
        let angle = (s - blend.lead_mm).max(0.0) / blend.radius_mm;
        let (sin, cos) = libm::sincos(angle);
        let turning = if s < blend.lead_mm {
            0.0
        } else {
            v * v / blend.radius_mm
        };
        let mut sums = [0.0; 2];
        for n in 0..3 {
            let tau = blend.tangent[n] * cos + blend.normal[n] * sin;
            let nu = blend.normal[n] * cos - blend.tangent[n] * sin;
            let speed = tau * v * 1e-3;
            let force = MASS_KG[n] * (tau * a + nu * turning) * 1e-3
                + COULOMB_N[n] * speed.signum()
                + GRAVITY_N[n];
            let mechanical = speed * force;
            sums[0] += mechanical.max(0.0) / EFFICIENCY;
            sums[1] += (-mechanical).max(0.0) * EFFICIENCY;
        }
        sums
    }

    #[test]
    fn a_blend_asks_for_what_sampling_finds() {
        let machine = machine();
        let model = PowerModel::new(&machine);
        let mv = any_move(&machine);
        let mut random = Random(7);
        for case in 0..200 {
            let [tangent, normal] = random.frame(case % 2 == 0);
            let blend = Blend {
                lead_mm: if case % 3 == 0 {
                    0.3 * random.next()
                } else {
                    0.0
                },
                radius_mm: 0.05 + 3.0 * random.next(),
                sweep_rad: 0.1 + 2.9 * random.next(),
                tangent,
                normal,
            };
            let length_mm = blend.lead_mm + blend.radius_mm * blend.sweep_rad;
            let (v0, v1) = (5.0 + 90.0 * random.next(), 5.0 + 90.0 * random.next());
            let accel_mm_s2 = (v1 * v1 - v0 * v0) / (2.0 * length_mm);
            let duration_s = 2.0 * length_mm / (v0 + v1);
            let planned = Planned {
                tag: 0,
                first: 0,
                next: Some(1),
                piece: Piece::Blend(blend),
                length_mm,
                speeds2: Speeds2 {
                    start: v0 * v0,
                    end: v1 * v1,
                    top: v0.max(v1) * v0.max(v1),
                },
                accel_mm_s2: accel_mm_s2.abs(),
                section: None,
                certain: true,
                rests: false,
                overlap_s: 0.0,
                overlaps: false,
                ranged: false,
                late_mm_s: 0.0,
                slack: Slack::default(),
            };
            let demand = piece_demand(&model, &mv, &planned, Want::ALL);
            let (mut peaks, mut energy_j) = ([0.0_f64; 2], 0.0);
            let samples = 4000;
            for i in 0..samples {
                let t = duration_s * (f64::from(i) + 0.5) / f64::from(samples);
                let (s, v) = (v0 * t + 0.5 * accel_mm_s2 * t * t, v0 + accel_mm_s2 * t);
                let sums = power(&blend, s, v, accel_mm_s2);
                peaks = [peaks[0].max(sums[0]), peaks[1].max(sums[1])];
                energy_j += sums[0] * duration_s / f64::from(samples);
            }
            let scale = peaks[0].max(peaks[1]);
            for (found, sampled) in [demand.peak_w, demand.regen_w].into_iter().zip(peaks) {
                assert!(found >= sampled * (1.0 - 1e-9), "{case}: {found} {sampled}");
                assert!(found <= sampled + 5e-3 * scale, "{case}: {found} {sampled}");
            }
            let off = (demand.energy_j - energy_j).abs();
            assert!(
                off <= 2e-3 * scale * duration_s,
                "{case}: {} {energy_j}",
                demand.energy_j
            );
        }
    }

    #[test]
    fn the_closer_bound_of_a_line_is_a_bound() {
        let machine = machine();
        let mut model = PowerModel::new(&machine);
        let mut mv = any_move(&machine);
        let mut random = Random(5);
        let (mut closest, mut bounded) = (f64::INFINITY, 0);
        for case in 0..400 {
            // Losses that grow with the speed and with the force.
            let curved = case % 3 == 1 || case % 4 == 2;
            model.converters[0].curved = AxisSet(if curved { 0b111 } else { 0 });
            for axis in &mut model.axes[..3] {
                axis.viscous = if case % 3 == 1 { 40.0 } else { 0.0 };
                axis.copper = if case % 4 == 2 { 2e-4 } else { 0.0 };
            }
            let [direction, _] = random.frame(false);
            mv = super::straight_line(&mv, &direction, 0.1 + 20.0 * random.next());
            let (v0, v1) = (90.0 * random.next(), 90.0 * random.next());
            let top = v0.max(v1) * (1.0 + random.next());
            let planned = Planned {
                tag: 0,
                first: 0,
                next: None,
                piece: Piece::Along {
                    from_mm: 0.0,
                    to_mm: mv.length_mm,
                },
                length_mm: mv.length_mm,
                speeds2: Speeds2 {
                    start: v0 * v0,
                    end: v1 * v1,
                    top: top * top,
                },
                accel_mm_s2: 200.0 + 1800.0 * random.next(),
                section: None,
                certain: true,
                rests: false,
                overlap_s: 0.0,
                overlaps: false,
                ranged: false,
                late_mm_s: 0.0,
                slack: Slack::default(),
            };
            let exact = piece_demand(&model, &mv, &planned, Want::PEAKS);
            let extremes = [planned.top_speed_mm_s(), planned.largest_accel_mm_s2()];
            let [peak_w, regen_w] =
                straight::bound_w(&model, &model.converters[0], &mv, extremes, 0.0);
            assert!(exact.peak_w <= peak_w, "{case}: {} {peak_w}", exact.peak_w);
            assert!(
                exact.regen_w <= regen_w,
                "{case}: {} {regen_w}",
                exact.regen_w
            );
            closest = closest.min(peak_w / exact.peak_w);
            bounded += usize::from(peak_w < 1.5 * exact.peak_w);
        }
        assert!(closest < 1.0 + 1e-6 && bounded > 100, "{closest} {bounded}");
    }
}
