//! What programs set of the rule by which corners are taken.

use super::left_out::note_corners;
use super::line::{Parameters, has, value};
use crate::control::{Control, Run};
use gwatt_machine::units::SECONDS_PER_MINUTE;
use gwatt_machine::{AxisId, CornerRule};
use gwatt_motion::{ActionKind, Corner, EarlyLimits, SpeedSteps, Square};
use gwatt_syntax::source::Span;

/// Values of M205 J that Marlin takes, mm.
const DEVIATION_MM: std::ops::RangeInclusive<f64> = 0.01..=0.3;

impl Control<'_> {
    /// Klipper's look-ahead: the speed at a right angle, mm/s, and the share of each hill
    /// that is cruised at least.
    ///
    /// Source: Klipper, "G-Codes", `SET_VELOCITY_LIMIT`; `ACCEL_TO_DECEL` of earlier
    /// versions is `ACCEL` less the ratio (`toolhead.py`).
    pub(super) fn limit_corners(
        &mut self,
        run: &mut Run<'_, '_>,
        corner_mm_s: Option<f64>,
        cruise_ratio: Option<f64>,
        span: Span,
    ) {
        let Some(own) = Square::of(self.machine) else {
            return;
        };
        let fine = corner_mm_s.is_none_or(|speed| (0.0..=1e7).contains(&speed))
            && cruise_ratio.is_none_or(|ratio| (0.0..1.0).contains(&ratio));
        if !fine {
            let help = "write a corner velocity from 0 and a cruise ratio from 0 to below 1";
            return Self::bad_value(run, span, help);
        }
        let before = self.knobs.corner.square().unwrap_or(own);
        let square = Square {
            corner_mm_s: corner_mm_s.unwrap_or(before.corner_mm_s),
            cruise_ratio: cruise_ratio.unwrap_or(before.cruise_ratio),
        };
        run.facts.turns_knob = true;
        self.take_corner(if square == own {
            Corner::default()
        } else {
            Corner::Square(square)
        });
    }

    /// M205 of Marlin: J the junction deviation, or X, Y, Z and E the steps of speed in mm/s,
    /// whichever the firmware is built for; M205 (mm/s) and M566 (mm/min) of `RepRapFirmware`:
    /// the steps, and P1 where they hold between moves of any kind.
    ///
    /// Sources: Marlin M205 (`M200-M205.cpp`), `RepRapFirmware` (`GCodes2.cpp`, cases 205 and 566).
    pub(super) fn corner_limits(
        &mut self,
        run: &mut Run<'_, '_>,
        parameters: &Parameters,
        number: u16,
        span: Span,
    ) {
        let unit = self.modal.mm_per_unit;
        let rules = self.machine.controller.planner.look_ahead;
        let rule = rules.map(|rules| rules.corner);
        if let Some(CornerRule::JunctionDeviation { deviation_mm, .. }) = rule {
            let own = value(parameters, b'J').map(|deviation| deviation * unit);
            if let Some(set_mm) = own.filter(|it| DEVIATION_MM.contains(it)) {
                run.facts.turns_knob = true;
                self.take_corner(if set_mm == deviation_mm {
                    Corner::default()
                } else {
                    Corner::Deviation(set_mm)
                });
            } else if own.is_some() {
                let message = "Marlin takes J from 0.01 to 0.3 mm alone: the value before it stays";
                run.report.note_once("corner-speeds", message, span);
            } else if names_corners(parameters) {
                note_corners(run, span);
            }
            return;
        }
        let Some(own) = SpeedSteps::of(self.machine) else {
            if names_corners(parameters) {
                note_corners(run, span);
            }
            return;
        };
        let per_minute = number == 5660;
        let mut steps = match self.knobs.corner {
            Corner::Steps(steps) => steps,
            _ => own,
        };
        for (axis, step) in SpeedSteps::AXES.into_iter().zip(&mut steps.mm_s) {
            let Some(value) = value(parameters, axis.letter()) else {
                continue;
            };
            let value = value * unit / if per_minute { SECONDS_PER_MINUTE } else { 1.0 };
            if !(0.0..=1e6).contains(&value) {
                return Self::bad_value(run, span, "write a speed from 0");
            }
            *step = value;
        }
        if per_minute && let Some(policy) = value(parameters, b'P') {
            // Bit 0 of the policy: between moves of any kind.
            steps.same_kind_only = policy.trunc() % 2.0 == 0.0;
        }
        if has(parameters, b'J') {
            note_corners(run, span);
        } else if names_other_axes(parameters) {
            let message = "steps of speed of other axes than X, Y, Z and E are not followed";
            run.report.note_once("corner-speeds", message, span);
        }
        run.facts.turns_knob = true;
        let before = self.knobs.corner;
        self.take_corner(if steps == own {
            Corner::default()
        } else {
            Corner::Steps(steps)
        });
        let early = self.machine.controller.language.printer.early_limits;
        if early && before != self.knobs.corner && !self.printer.stands {
            // Corners of moves that wait are worked out again as further moves come
            // (DDA::MatchSpeeds).
            let largest = steps.mm_s.into_iter().filter(|step| step.is_finite());
            let largest_mm_s = largest.fold(0.0, f64::max);
            run.act(ActionKind::EarlyLimits(EarlyLimits::Corners), largest_mm_s);
        }
    }

    /// The share of each hill that is cruised at least (Klipper).
    pub(super) fn cruise_ratio(&self) -> f64 {
        let square = self.knobs.corner.square();
        let square = square.or_else(|| Square::of(self.machine));
        square.map_or(0.0, |square| square.cruise_ratio)
    }

    pub(super) fn take_corner(&mut self, corner: Corner) {
        if self.knobs.corner != corner {
            self.knobs.corner = corner;
            self.modal.corner = corner;
        }
    }

    /// Corners as they are set, or as they were set before: the faster way counts.
    pub(super) fn corners_at_least(&mut self, other: Corner) {
        let (machine, now) = (self.machine, self.knobs.corner);
        let rules = machine.controller.planner.look_ahead;
        let faster = if let Some(own) = Square::of(machine) {
            let [now, other] = [now, other].map(|it| it.square().unwrap_or(own));
            let faster = now.or_faster(other);
            (faster != own).then_some(Corner::Square(faster))
        } else if let Some(own) = SpeedSteps::of(machine) {
            let [now, other] = [now, other].map(|it| match it {
                Corner::Steps(steps) => steps,
                _ => own,
            });
            let faster = now.or_faster(other);
            (faster != own).then_some(Corner::Steps(faster))
        } else if let Some(CornerRule::JunctionDeviation { deviation_mm, .. }) =
            rules.map(|rules| rules.corner)
        {
            let [now, other] = [now, other].map(|it| match it {
                Corner::Deviation(set_mm) => set_mm,
                _ => deviation_mm,
            });
            let faster = now.max(other);
            (faster != deviation_mm).then_some(Corner::Deviation(faster))
        } else {
            return;
        };
        self.take_corner(faster.unwrap_or_default());
    }
}

fn names_corners(parameters: &Parameters) -> bool {
    b"XYZEJ".iter().any(|letter| has(parameters, *letter))
}

/// Whether steps of other axes than X, Y, Z and E are set.
fn names_other_axes(parameters: &Parameters) -> bool {
    let other = |axis: AxisId| !SpeedSteps::AXES.contains(&axis);
    let mut axes = parameters
        .iter()
        .filter_map(|one| AxisId::from_letter(one.letter));
    axes.any(other)
}
