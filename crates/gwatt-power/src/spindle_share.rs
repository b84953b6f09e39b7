//! What the spindle asks for next to the axes.

/// What the spindle takes of a move's converter, for the limiter.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SpindleShare {
    /// What it draws at most on top of the axes, however late the move begins,
    /// W; base load of its drive and cutting at any feed included.
    pub drawn_w: f64,
    /// The same of what it feeds back.
    pub fed_back_w: f64,
    /// Electrical power of cutting by speed of the path, W/(mm/s).
    pub cutting_w_s_mm: f64,
    /// What it draws once it has its speed, W, where a move that cuts would wait
    /// for that and this one does not.
    pub settled_w: Option<f64>,
    /// It is on a run during the move: when the move begins matters.
    pub runs: bool,
    /// How many commands it has got so far.
    pub command: u32,
}

impl SpindleShare {
    /// Nothing.
    pub const NONE: Self = Self {
        drawn_w: 0.0,
        fed_back_w: 0.0,
        cutting_w_s_mm: 0.0,
        settled_w: None,
        runs: false,
        command: 0,
    };
}
