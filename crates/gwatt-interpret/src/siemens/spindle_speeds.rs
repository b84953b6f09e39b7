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
    /// LIMS, 1/min.
    limits: BTreeMap<u32, f64>,
    /// GWPSON: S is the speed of a grinding wheel at its edge, m/s.
    pub(super) grinds: bool,
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
    /// `LIMS=3000`, `LIMS[2]=500`.
    pub(super) limits: Vec<(Option<u32>, f64)>,
    /// SPOS and the like of the spindle that is counted: it stops.
    pub(super) orients: bool,
}

impl Said {
    /// `SETMS` without a number.
    pub(super) const BACK: u32 = FIRST;
}

impl Spindles {
    /// SETMS and LIMS of a block ("LIMS": without a number it is for the master spindle).
    pub(super) fn choose(&mut self, said: &Said) {
        self.master = said.master.or(self.master);
        let master = self.master();
        let limits = said.limits.iter();
        self.limits
            .extend(limits.map(|(number, limit)| (number.unwrap_or(master), *limit)));
    }

    /// The master spindle.
    pub(super) fn master(&self) -> u32 {
        self.master.unwrap_or(FIRST)
    }

    /// Its limit under G96, 1/min.
    pub(super) fn limit_rpm(&self) -> Option<f64> {
        self.limits.get(&self.master()).copied()
    }

    pub(super) fn take(&mut self, said: &Said, plain: Option<f64>) {
        if let Some(speed) = plain {
            self.speeds.insert(self.master(), speed);
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
