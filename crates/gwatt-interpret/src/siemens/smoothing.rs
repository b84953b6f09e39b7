//! How far corners are rounded by distance (G641 to G645 with ADIS and ADISPOS).

/// What the program has set; 0 until it does.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Smoothing {
    /// One of G641 to G645 is in force, not G64.
    pub(super) by_distance: bool,
    /// ADIS and ADISPOS.
    pub(super) of_feeds: f64,
    pub(super) of_rapids: f64,
}

impl Smoothing {
    /// Whether a feed would be rounded where a rapid is not, or less: next to one of each the
    /// smaller distance counts.
    pub(super) fn rounds_feeds_more(self) -> bool {
        self.by_distance && self.of_feeds > self.of_rapids
    }
}
