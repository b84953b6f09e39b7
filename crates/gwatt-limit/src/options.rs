//! What is asked of the limiter.

/// How power is brought down.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Strategy {
    /// The machine's presets for combinations of axes.
    Preset,
    /// Speed alone.
    Speed,
    /// Acceleration alone.
    Accel,
    /// The shortest time with the words that the controller has.
    Optimal,
    /// The same, and long straight blocks in several of one line, each with an
    /// acceleration of its own.
    Split,
}

/// What the strategy `preset` does with a move that does not fit and for whose axes the
/// machine has no preset.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PresetElse {
    /// It is refused.
    #[default]
    Refuse,
    /// It gets the speed at which it fits, as by the strategy `speed`.
    Speed,
}

/// How far the ratio V = limit/peak lowers speed or acceleration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Law {
    /// Solved for the real block.
    Exact,
    /// V² on the nominal values of the commanded axes.
    Patent,
}

/// What `limit` is asked to do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LimitOptions {
    /// How power is brought down.
    pub strategy: Strategy,
    /// How far.
    pub law: Law,
    /// What may be changed besides rapids and accelerations.
    pub allowed: Allowed,
    /// What preset or law say counts for moves that fit without it too: the strategy
    /// [`Strategy::Preset`] or [`Law::Patent`] alone.
    pub always: bool,
    /// Where there is no preset: the strategy [`Strategy::Preset`] alone.
    pub preset_else: PresetElse,
}

impl LimitOptions {
    /// What the command line does without options.
    pub const USUAL: Self = Self {
        strategy: Strategy::Optimal,
        law: Law::Exact,
        allowed: Allowed::NOTHING,
        always: false,
        preset_else: PresetElse::Refuse,
    };
}

impl Default for LimitOptions {
    fn default() -> Self {
        Self::USUAL
    }
}

/// What `limit` may change only with permission.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Allowed {
    /// Cutting feeds may be lowered.
    pub feed: bool,
    /// Canned cycles may be written out as single blocks.
    pub expand: bool,
    /// Rapids of axes that move each for itself may become lines, inside the machine's
    /// clearance.
    pub straighten: bool,
    /// Exact stops may be put between feeds that the control may blend.
    pub stop: bool,
    /// The program may wait between rapids and before tool changes, where a limit over
    /// time is missed otherwise.
    pub pause: bool,
    /// Words may be written that no document confirms (`verified = false` in the
    /// controller profile).
    pub unverified: bool,
}

impl Allowed {
    /// Nothing of it.
    pub const NOTHING: Self = Self {
        feed: false,
        expand: false,
        straighten: false,
        stop: false,
        pause: false,
        unverified: false,
    };

    /// What may help where no value of the permitted words is enough, for a person;
    /// `has_other_words`: the control has words for accelerations, which other strategies write.
    #[must_use]
    pub fn else_helps(self, has_other_words: bool) -> &'static str {
        match (self.feed, has_other_words) {
            (true, true) => "another strategy may help",
            (false, true) => "another strategy, or --allow feed, may help",
            (true, false) => "a larger converter helps, or less base load and friction",
            (false, false) => "--allow feed may help",
        }
    }

    /// The names that the command line has for it, with commas.
    #[must_use]
    pub fn names(self) -> String {
        let names: Vec<&str> = self.granted().collect();
        names.join(",")
    }

    /// How many permissions these are.
    #[must_use]
    pub fn count(self) -> usize {
        self.granted().count()
    }

    fn granted(self) -> impl Iterator<Item = &'static str> {
        let all = [
            (self.feed, "feed"),
            (self.expand, "expand"),
            (self.straighten, "straighten"),
            (self.stop, "stop"),
            (self.pause, "pause"),
            (self.unverified, "unverified"),
        ];
        let granted = all.into_iter().filter(|(allowed, _)| *allowed);
        granted.map(|(_, name)| name)
    }
}
