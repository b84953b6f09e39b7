//! Arcs in turned, scaled or mirrored coordinates: worked out as the program
//! has them, then mapped to the machine.
//!
//! Where their plane is none of the machine's, an arc becomes chords: a circle all the
//! same, since only a uniform scale is accepted, but no axis keeps still. On a chord of
//! the angle δ the tangent is up to δ/2 from it, which is `2·sin(δ/4)` between unit
//! vectors; that, and no plan of the chords, is what counts ([`Stray`]).

use std::f64::consts::TAU;

use super::control::{Control, Run};
use super::{frame, stray};
use gwatt_machine::{AxisSet, AxisValues};
use gwatt_motion::{Arc, FeedMode, MoveKind, Step, Stray};
use gwatt_syntax::source::Span;

/// Largest angle of a chord.
const CHORD_RAD: f64 = TAU / 48.0;
/// Chords of one arc.
const CHORDS_MAX: f64 = 4096.0;
/// What the end of an arc may be off where it is mapped in two ways, mm.
const ROUNDING_MM: f64 = 1e-6;

/// An arc in a plane that is none of the machine's.
pub(super) struct Tilted<'a> {
    /// In program coordinates, as are its ends.
    pub(super) arc: &'a Arc,
    pub(super) ends: [&'a AxisValues; 2],
    /// Where it ends in the machine.
    pub(super) to: &'a AxisValues,
}

impl Control<'_> {
    /// Start and end of an arc in program coordinates.
    pub(super) fn arc_ends_in_program(&self, end: &AxisValues) -> [AxisValues; 2] {
        [self.position.program(), self.position.frame.program(end)]
    }

    /// An arc of program coordinates in machine coordinates; `None` where it
    /// is no arc of that plane there.
    fn arc_in_machine(&self, arc: &Arc) -> Option<Arc> {
        let [first, second, _] = self.modal.plane;
        let map = self.position.frame.plane(self.modal.plane)?;
        let mut point = self.position.program();
        point[first] = arc.center[0];
        point[second] = arc.center[1];
        let mapped = self.position.frame.machine(&point);
        let center = [mapped[first], mapped[second]];
        let at = &self.position.at;
        Some(Arc {
            plane: arc.plane,
            center,
            radius_mm: arc.radius_mm * map.scale,
            start_angle_rad: libm::atan2(at[second] - center[1], at[first] - center[0]),
            sweep_rad: if map.flipped {
                -arc.sweep_rad
            } else {
                arc.sweep_rad
            },
        })
    }

    /// Reports an arc that is not followed.
    pub(super) fn refuse_tilted(span: Span, run: &mut Run<'_, '_>) {
        run.report
            .error(
                "arc-turned",
                "an arc that is no circle in a plane of the machine, as the coordinates are turned or scaled",
                span,
            )
            .help("choose the plane of the turn, and scale its axes alike");
    }

    /// An arc where the coordinates are turned, scaled or mirrored.
    pub(super) fn turned_arc(
        &mut self,
        tilted: &Tilted<'_>,
        unknown: AxisSet,
        run: &mut Run<'_, '_>,
    ) {
        if let Some(arc) = self.arc_in_machine(tilted.arc) {
            self.go(run, MoveKind::Arc, tilted.to, unknown, Some(arc));
        } else if !(unknown.is_empty() && self.tilted_by_turn(tilted, run)) {
            let whole = run.whole();
            Self::refuse_tilted(whole, run);
        }
    }

    /// An arc in a tilted plane of `LinuxCNC`: with a turn about Z (G10 L2 R) one of G18 or
    /// G19. Its interpreter turns the normal along (`ARC_FEED`), and permits what the
    /// smallest limits of X, Y and Z do: of a circle, not of a helix. False where it is
    /// not followed.
    fn tilted_by_turn(&mut self, tilted: &Tilted<'_>, run: &mut Run<'_, '_>) -> bool {
        let normal = self.modal.plane[2];
        let [start, end] = tilted.ends;
        if !self.rules.turns_tilt_arcs
            || (end[normal] - start[normal]).abs() > ROUNDING_MM
            || !self.position.frame.keeps_circles()
        {
            return false;
        }
        let frame = self.position.frame.clone();
        self.tilted_arc(tilted, |point| frame.machine(point), run)
    }

    /// An arc as chords, mapped to the machine by a map that keeps circles. False, and
    /// nothing done, where it is not followed.
    pub(super) fn tilted_arc(
        &mut self,
        tilted: &Tilted<'_>,
        map: impl Fn(&AxisValues) -> AxisValues,
        run: &mut Run<'_, '_>,
    ) -> bool {
        let Tilted { arc, ends, to } = tilted;
        let [start, end] = *ends;
        let chords = (arc.sweep_rad.abs() / CHORD_RAD).ceil().max(2.0);
        let mapped = map(end);
        let off = (0..frame::SPACE).any(|axis| (mapped[axis] - to[axis]).abs() > ROUNDING_MM);
        let exists = (0..frame::SPACE).all(|axis| self.machine.axes[axis].is_some());
        // Of these the speed is known only along arcs of the machine's planes.
        let timed =
            self.feed_mode_is(FeedMode::InverseTime) || self.spindle.surface_mm_min.is_some();
        let shifted = self.compensation.as_ref().is_some_and(|it| it.is_on());
        if chords > CHORDS_MAX || off || !exists || timed || shifted {
            return false;
        }
        let Some(speed_mm_s) = self.feed_speed(run, to, None, 1.0, true) else {
            return true;
        };
        let own = stray::of_arc(arc, start, end);
        let stray = Stray {
            direction: 2.0 * libm::sin(0.25 * arc.sweep_rad.abs() / chords) + own.direction,
            accel: own.accel,
            in_chords: true,
        };
        let from = self.position.at;
        let before = run.steps.len();
        let [first, second] = arc.plane;
        let radius =
            |at: &AxisValues| libm::hypot(at[first] - arc.center[0], at[second] - arc.center[1]);
        let (inner, outer) = (radius(start), radius(end));
        for chord in 1..=chords as u32 {
            let share = f64::from(chord) / chords;
            let mut place = **to;
            if share < 1.0 {
                let (sin, cos) = libm::sincos(arc.start_angle_rad + share * arc.sweep_rad);
                let own_mm = inner + share * (outer - inner);
                let mut point = *start;
                for axis in 0..frame::SPACE {
                    point[axis] += share * (end[axis] - start[axis]);
                }
                point[first] = arc.center[0] + own_mm * cos;
                point[second] = arc.center[1] + own_mm * sin;
                place = from;
                for (axis, place) in place.iter_mut().enumerate() {
                    *place += share * (to[axis] - from[axis]);
                }
                let mapped = map(&point);
                place[..frame::SPACE].copy_from_slice(&mapped[..frame::SPACE]);
            }
            self.go_at(run, &place, AxisSet::default(), Some(speed_mm_s));
        }
        let own = run.steps.get_mut(before..).unwrap_or_default();
        let moves = |step: &Step| match step {
            Step::Move(mv) => mv.moving.0,
            Step::Action(_) => 0,
        };
        let moving = own.iter().map(moves).fold(0, |all, own| all | own);
        for step in own {
            if let Step::Move(mv) = step {
                // What stands still over a chord may bulge out and come back.
                mv.moving.0 |= moving;
                mv.stray = stray;
            }
        }
        true
    }
}
