//! What a subprogram with SAVE gives back.

use super::Siemens;
use super::frame::Frame;
use crate::compensation::ContourFeed;
use crate::modal::Modal;
use gwatt_machine::LEVEL_GROUPS;

/// SAVE: what a subprogram gives back.
#[derive(Debug)]
pub(super) struct Saved {
    pub(super) modal: Modal,
    pub(super) frame: Frame,
    pub(super) modes: Modes,
    pub(super) levels: [Option<u8>; LEVEL_GROUPS],
}

/// Modal G groups that only this language has, by their numbers ("List of G functions").
#[derive(Debug)]
pub(super) struct Modes {
    /// 13: G70 next to G700.
    feed_in_mm: bool,
    /// 15: G96 next to G97.
    surface_speed: bool,
    /// 16: CFC and similar words.
    contour_feed: ContourFeed,
    /// 17: NORM, KONT.
    kont: bool,
    /// 18: G450, G451.
    intersects: bool,
    /// 29: DIAMON and similar words.
    diameters: [bool; 2],
    /// 10: G64 next to G641 to G645.
    by_distance: bool,
    /// 21: BRISK, SOFT.
    brisk: bool,
}

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
