//! What the tool radius compensation depends on ("Tool radius compensation (G40,
//! G41, G42)", "Compensation at the outside corners (G450, G451, DISC)",
//! "Contour approach and retraction (NORM, KONT)").

use std::collections::HashMap;

use crate::compensation::ContourFeed;

/// What the program has chosen.
#[derive(Debug)]
pub(super) struct Radius {
    /// `$TC_DP6` and `$TC_DP15` (wear) by tool and edge, mm.
    pub(super) set: HashMap<(u32, u32), [f64; 2]>,
    pub(super) intersects: bool,
    pub(super) feed: ContourFeed,
    pub(super) kont: bool,
    pub(super) rounded: bool,
}

impl Default for Radius {
    fn default() -> Self {
        Self {
            set: HashMap::new(),
            intersects: false,
            feed: ContourFeed::Contour,
            kont: false,
            rounded: false,
        }
    }
}

impl Radius {
    pub(super) fn refused(&self) -> Option<&'static str> {
        if self.kont {
            Some("an approach round the start of the contour (KONT) is not followed")
        } else if self.rounded {
            Some("rounded outside corners (DISC above 0) are not followed")
        } else {
            None
        }
    }
}
