//! Demand of a blend: the piece of a circle in space that a controller lays
//! round a corner.
//!
//! Input: the blend and its profile. Output: the [`Totals`] of one converter.
//!
//! On the circle an axis with the parts `t` of the tangent and `n` of the normal
//! has `v_n = v·(t·cos θ + n·sin θ)`: a sinusoid as on an arc, with a phase of
//! its own. Each phase of the profile is cut where an axis turns back; all are
//! of constant acceleration.

use super::arc_circle::Circle;
use super::arc_energy;
use super::axis::Side;
use super::circle::{ArcAxis, Shape};
use super::demand::{Totals, Want};
use super::model::{ConverterPower, PowerModel};
use super::search::Search;
use super::straight;
use arrayvec::ArrayVec;
use gwatt_machine::AxisSet;
use gwatt_motion::Move;
use gwatt_plan::{Blend, Phase, PhaseKind, Profile};
use std::f64::consts::PI;

/// The axes that a blend may move, whatever the line before it moves.
pub(super) const BLENDED: AxisSet = AxisSet(0b111);

/// The converter's share of a blend after the line `mv`.
pub(super) fn totals(
    model: &PowerModel,
    converter: &ConverterPower,
    mv: &Move,
    blend: &Blend,
    profile: &Profile,
    want: Want,
) -> Totals {
    let active = active(converter, blend);
    let idle_w = converter.idle_w(mv, &model.axes, active);
    let circle = circle(model, converter, blend, idle_w);
    let mut totals = Totals::at_rest(idle_w, profile.duration_s(), want);
    let mut peak = Search::new(idle_w, want.floor_w);
    let mut regen = Search::new(0.0, want.regen_floor_w);
    let cuts = cuts(blend);
    for phase in &profile.phases {
        for piece in pieces(phase, &cuts) {
            if piece.position_mm + 0.5 * piece.length_mm() < blend.lead_mm {
                let mut lead = Profile::default();
                lead.phases.push(piece);
                let own = straight::totals(model, converter, mv, &lead, idle_w, want);
                totals.raise_peak(own.peak_w);
                totals.raise_regen(own.regen_w);
                totals.energy_j +=
                    own.energy_j - Totals::at_rest(idle_w, piece.duration_s, want).energy_j;
                continue;
            }
            circle.search_piece(&piece, (0.0, piece.duration_s), Side::Motor, &mut peak);
            circle.search_piece(&piece, (0.0, piece.duration_s), Side::Regen, &mut regen);
            if want.energy {
                totals.energy_j +=
                    arc_energy::piece_energy_j(&circle, &piece, 0.0, piece.duration_s);
            }
        }
    }
    totals.raise_peak(peak.upper());
    totals.raise_regen(regen.upper());
    totals
}

/// The converter's axes that move on the blend.
pub(super) fn active(converter: &ConverterPower, blend: &Blend) -> AxisSet {
    let mut active = AxisSet::default();
    for (axis, (tangent, normal)) in blend.tangent.into_iter().zip(blend.normal).enumerate() {
        if converter.axes.contains(axis) && (tangent, normal) != (0.0, 0.0) {
            active.insert(axis);
        }
    }
    active
}

/// The axes of a converter on the circle; θ is 0 where the circle begins.
pub(super) fn circle<'a>(
    model: &'a PowerModel,
    converter: &ConverterPower,
    blend: &Blend,
    idle_w: f64,
) -> Circle<'a> {
    let mut axes = ArrayVec::new();
    for (index, (tangent, normal)) in blend.tangent.into_iter().zip(blend.normal).enumerate() {
        let share = (tangent * tangent + normal * normal).sqrt();
        if converter.axes.contains(index) && share > 0.0 {
            let axis = &model.axes[index];
            axes.push(ArcAxis {
                axis,
                shape: Shape::Turn {
                    radius: blend.radius_mm * share * axis.si_per_unit,
                    // −sin of the angle is to be the share of the speed.
                    sin: -tangent / share,
                    cos: -normal / share,
                },
            });
        }
    }
    Circle {
        axes,
        credit_regen: converter.credit_regen,
        idle_w,
        start_angle: -blend.lead_mm / blend.radius_mm,
        sense: 1.0,
        angle_per_mm: 1.0 / blend.radius_mm,
    }
}

/// Path positions, in order, at which the circle begins or an axis turns back.
pub(super) fn cuts(blend: &Blend) -> ArrayVec<f64, 4> {
    let mut cuts = ArrayVec::new();
    cuts.push(blend.lead_mm);
    for (tangent, normal) in blend.tangent.into_iter().zip(blend.normal) {
        let mut angle = libm::atan2(-tangent, normal);
        if angle < 0.0 {
            angle += PI;
        }
        if angle > 0.0 && angle < blend.sweep_rad {
            cuts.push(blend.lead_mm + angle * blend.radius_mm);
        }
    }
    cuts.sort_unstable_by(f64::total_cmp);
    cuts
}

/// The phase between the cuts.
pub(super) fn pieces(phase: &Phase, cuts: &[f64]) -> ArrayVec<Phase, 5> {
    let mut pieces = ArrayVec::new();
    let mut rest = *phase;
    for cut in cuts {
        let distance = cut - rest.position_mm;
        if distance <= 0.0 || distance >= rest.length_mm() {
            continue;
        }
        if rest.kind != PhaseKind::ConstantAcceleration {
            let t = rest.time_at(*cut);
            if t > 0.0 && t < rest.duration_s {
                pieces.push(rest.between(0.0, t));
                rest = rest.between(t, rest.duration_s);
            }
            continue;
        }
        // distance = v·t + a·t²/2, without cancellation.
        let (v, a) = (rest.velocity_mm_s, rest.accel_mm_s2);
        let at_cut = (v * v + 2.0 * a * distance).max(0.0).sqrt();
        let t = 2.0 * distance / (v + at_cut);
        if !(t > 0.0 && t < rest.duration_s) {
            continue;
        }
        pieces.push(Phase {
            duration_s: t,
            end_velocity_mm_s: at_cut,
            ..rest
        });
        rest = Phase {
            duration_s: rest.duration_s - t,
            position_mm: *cut,
            velocity_mm_s: at_cut,
            ..rest
        };
    }
    pieces.push(rest);
    pieces
}
