//! Arcs in turned, scaled or mirrored coordinates: worked out as the program
//! has them, then mapped to the machine.

use super::execute::{Control, Run};
use super::moves::Arc;
use crate::machine::AxisValues;
use crate::source::Span;

impl Control<'_> {
    /// Start and end of an arc in program coordinates.
    pub(super) fn arc_ends_in_program(&self, end: &AxisValues) -> [AxisValues; 2] {
        [self.position.program(), self.position.frame.program(end)]
    }

    /// An arc of program coordinates in machine coordinates. Refused where it
    /// is no arc of that plane there.
    pub(super) fn arc_in_machine(
        &self,
        arc: &Arc,
        span: Span,
        run: &mut Run<'_, '_>,
    ) -> Option<Arc> {
        let [first, second, _] = self.modal.plane;
        let Some(map) = self.position.frame.plane(self.modal.plane) else {
            run.report
                .error(
                    "arc-turned",
                    "an arc that is no circle in a plane of the machine, as the coordinates are turned or scaled",
                    span,
                )
                .help("choose the plane of the turn, and scale its axes alike");
            return None;
        };
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
}
