//! Accelerations over the speed.

/// Speeds at which they are looked up.
pub(super) const GRID: usize = 96;

/// The largest accelerations by speed, for speeding up and for braking.
pub(super) struct Accels {
    pub(crate) tables: [Vec<f64>; 2],
    pub(crate) top_mm_s: f64,
}

impl Accels {
    /// Up to which of the speeds there is any.
    pub(super) fn known(&self) -> usize {
        self.tables.iter().map(Vec::len).min().unwrap_or(0)
    }

    /// At a speed, for braking or for speeding up.
    pub(super) fn at(&self, speed_mm_s: f64, brakes: bool) -> f64 {
        let table = &self.tables[usize::from(brakes)];
        let place = (speed_mm_s / self.top_mm_s * GRID as f64 - 1.0).max(0.0);
        let last = self.known().saturating_sub(1);
        let at = |index: usize| table.get(index.min(last)).copied().unwrap_or(0.0);
        let low = place as usize;
        let share = (place - low as f64).min(1.0);
        at(low) + share * (at(low + 1) - at(low))
    }
}
