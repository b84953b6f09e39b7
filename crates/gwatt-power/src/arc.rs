//! Demand of arcs and helices.
//!
//! Input: an arc and its profile. Output: the [`Totals`] of one converter.
//!
//! Each phase is cut where the path meets a quadrant of the circle: between
//! quadrants no axis changes its direction, and every axis' power is a maximum
//! of smooth functions of time, whose second derivatives `circle` bounds. The
//! peaks come from `search`, the energy from `quadrature`. Pieces are visited
//! from the fast end of the phase, so that the slow ones fall below what has
//! been found. A cruise repeats after one turn.

use super::arc_circle::Circle;
use super::arc_energy;
use super::axis::Side;
use super::demand::{Totals, Want};
use super::search::Search;
use gwatt_plan::{Phase, PhaseKind, Profile};

/// The converter's share of an arc.
pub(super) fn totals(circle: &Circle<'_>, profile: &Profile, want: Want) -> Totals {
    let idle_w = circle.idle_w;
    let mut totals = Totals::at_rest(idle_w, profile.duration_s(), want);
    let steady = |phase: &Phase| phase.kind == PhaseKind::ConstantAcceleration;
    if !profile.phases.iter().all(steady) {
        changing_totals(circle, profile, want, &mut totals);
        return totals;
    }
    let mut peak = Search::new(idle_w, want.floor_w);
    let mut regen = Search::new(0.0, want.regen_floor_w);
    for phase in &profile.phases {
        circle.search(phase, Side::Motor, &mut peak);
    }
    // Braking feeds back most: last phases first.
    for phase in profile.phases.iter().rev() {
        circle.search(phase, Side::Regen, &mut regen);
    }
    totals.raise_peak(peak.upper());
    totals.raise_regen(regen.upper());
    if want.energy {
        for phase in &profile.phases {
            totals.energy_j += arc_energy::phase_energy_j(circle, phase);
        }
    }
    totals
}

/// The same where acceleration changes in phases: in parts on which neither
/// speed nor acceleration changes its sign, and with the circle turned round
/// where the path runs backwards.
fn changing_totals(circle: &Circle<'_>, profile: &Profile, want: Want, totals: &mut Totals) {
    let reversed = circle.reversed();
    let mut peak = Search::new(totals.idle_w, want.floor_w);
    let mut regen = Search::new(0.0, want.regen_floor_w);
    for phase in &profile.phases {
        for part in phase.parts() {
            let backwards = part.velocity_mm_s + part.end_velocity_mm_s < 0.0;
            let (circle, part) = if backwards {
                (&reversed, part.mirrored())
            } else {
                (circle, part)
            };
            circle.search(&part, Side::Motor, &mut peak);
            circle.search(&part, Side::Regen, &mut regen);
            if want.energy {
                totals.energy_j += arc_energy::phase_energy_j(circle, &part);
            }
        }
    }
    totals.raise_peak(peak.upper());
    totals.raise_regen(regen.upper());
}
