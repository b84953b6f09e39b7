//! What is known of the speeds of several spindles ("SETMS", "G25, G26").

use std::collections::BTreeMap;

/// The spindle that is the master at power-on, and again after SETMS without a number.
pub(super) const FIRST: u32 = 1;

/// The highest number of a spindle.
pub(super) const SPINDLES_MAX: u32 = 99;

/// What is known of the spindles.
#[derive(Debug, Default)]
pub(super) struct Spindles {
    /// 1/min.
    speeds: BTreeMap<u32, f64>,
    /// The one of SETMS; `None`: that word has not come yet.
    master: Option<u32>,
    /// The highest limit of G25, below which no spindle turns, 1/min.
    pub(super) least_rpm: f64,
}

/// What a block says of them.
#[derive(Debug, Default)]
pub(super) struct Said {
    /// `S2=3000`.
    pub(super) speeds: Vec<(u32, f64)>,
    /// `SETMS(2)`.
    pub(super) master: Option<u32>,
}

impl Said {
    /// `SETMS` without a number.
    pub(super) const BACK: u32 = FIRST;
}

impl Spindles {
    pub(super) fn take(&mut self, said: &Said, plain: Option<f64>) {
        self.master = said.master.or(self.master);
        if let Some(speed) = plain {
            self.speeds.insert(self.master.unwrap_or(FIRST), speed);
        }
        let speeds = said.speeds.iter().copied();
        self.speeds
            .extend(speeds.filter(|(number, _)| *number <= SPINDLES_MAX));
    }

    /// The speed that is followed, where SETMS has said of which spindle; 0 where none is known.
    pub(super) fn followed(&self) -> Option<f64> {
        let master = self.master?;
        Some(self.limited(self.speeds.get(&master).copied().unwrap_or(0.0)))
    }

    /// A speed that G25 may raise.
    pub(super) fn limited(&self, speed: f64) -> f64 {
        if speed > 0.0 {
            speed.max(self.least_rpm)
        } else {
            speed
        }
    }
}
