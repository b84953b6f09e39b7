//! What a subprogram with SAVE gives back.

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
    pub(super) feed_in_mm: bool,
    /// 15: G96 next to G97.
    pub(super) surface_speed: bool,
    /// 16: CFC and similar words.
    pub(super) contour_feed: ContourFeed,
    /// 17: NORM, KONT.
    pub(super) kont: bool,
    /// 18: G450, G451.
    pub(super) intersects: bool,
    /// 29: DIAMON and similar words.
    pub(super) diameters: [bool; 2],
    /// 10: G64 next to G641 to G645.
    pub(super) by_distance: bool,
    /// 21: BRISK, SOFT.
    pub(super) brisk: bool,
}
