//! SAVE: modal G groups are kept, and put in force again.

use super::Siemens;
use super::saved::Modes;

impl Siemens {
    pub(super) fn modes(&self) -> Modes {
        Modes {
            feed_in_mm: self.feed_in_mm,
            surface_speed: self.surface_speed,
            contour_feed: self.radius.feed,
            kont: self.radius.kont,
            intersects: self.radius.intersects,
            diameters: [self.diameter, self.radius_increments],
            by_distance: self.smoothing.by_distance,
            brisk: self.limits.brisk,
        }
    }

    /// Puts them in force again. What follows from them is done in the next block.
    pub(super) fn restore(&mut self, modes: &Modes) {
        self.feed_in_mm = modes.feed_in_mm;
        self.surface_speed = modes.surface_speed;
        self.radius.feed = modes.contour_feed;
        self.radius.kont = modes.kont;
        self.radius.intersects = modes.intersects;
        [self.diameter, self.radius_increments] = modes.diameters;
        self.smoothing.by_distance = modes.by_distance;
        self.limits.brisk = modes.brisk;
        self.returned = true;
    }
}
