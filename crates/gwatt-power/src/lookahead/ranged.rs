//! Pieces of a plan that may run slower, as how many blocks the controller sees is a matter of timing,
//! or as the motion may have stopped before them: each may be sped up and braked at any speed up to
//! its own.

use super::Ahead;
use super::joints::moves_of;
use crate::demand::{Demand, Want};
use crate::model::PowerModel;
use crate::observer::Observer;
use crate::surge::{Surge, surge_demand};
use gwatt_plan::lookahead::Planned;

impl Ahead {
    /// What such a piece may ask for; `None` for others.
    #[inline]
    pub(super) fn ranged(
        &mut self,
        model: &PowerModel,
        observer: &Observer,
        planned: &Planned<u64>,
    ) -> Option<Demand> {
        let in_doubt = |number| self.open.get(number).is_some_and(|own| own.in_doubt);
        // S-curves have the robust bound, of axes that keep their limits at joints too.
        let slower =
            planned.section.is_none() && (self.reach2.is_some() || moves_of(planned).any(in_doubt));
        if !(planned.ranged || slower) {
            return None;
        }
        let speed_mm_s = planned.top_speed_mm_s();
        let surge = Surge {
            rises_mm_s: Some(speed_mm_s),
            falls_mm_s: Some(speed_mm_s),
            accel_mm_s2: planned.accel_mm_s2.max(planned.slack.accel_mm_s2),
            section: None,
        };
        self.follow_surge(model, planned, &surge);
        self.watch_surge(model, observer, planned, Some(&surge), true);
        let open = self.open.get(planned.tag)?;
        let want = Want {
            energy: false,
            ..open.want
        };
        Some(surge_demand(model, &open.mv, planned, surge, want))
    }
}
