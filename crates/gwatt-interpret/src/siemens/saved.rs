//! What a subprogram with SAVE gives back.

use super::frame::Frame;
use crate::modal::Modal;
use gwatt_machine::LEVEL_GROUPS;

/// SAVE: what a subprogram gives back.
#[derive(Debug)]
pub(super) struct Saved {
    pub(super) modal: Modal,
    pub(super) frame: Frame,
    pub(super) levels: [Option<u8>; LEVEL_GROUPS],
}
