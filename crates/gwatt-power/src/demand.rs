//! What a move asks of its converters.

/// What is wanted of an evaluation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Want {
    /// Whether the energy is wanted.
    pub energy: bool,
    /// A motoring peak below this need not be exact, in W: anything up to it
    /// may be returned. −∞ for an exact peak.
    pub floor_w: f64,
    /// The same for the power that is fed back, in W.
    pub regen_floor_w: f64,
    /// Whether the acceleration that the path permits is wanted.
    pub accel: bool,
}

impl Want {
    /// Whether peaks that are no larger, drawn and fed back, are of no interest.
    #[inline]
    pub(super) fn passes(&self, [peak_w, regen_w]: [f64; 2]) -> bool {
        peak_w <= self.floor_w && regen_w <= self.regen_floor_w
    }

    /// Exact peaks, no energy.
    pub const PEAKS: Self = Self {
        energy: false,
        floor_w: f64::NEG_INFINITY,
        regen_floor_w: f64::NEG_INFINITY,
        accel: true,
    };
    /// Exact peaks and the energy.
    pub const ALL: Self = Self {
        energy: true,
        floor_w: f64::NEG_INFINITY,
        regen_floor_w: f64::NEG_INFINITY,
        accel: true,
    };
}

/// What a move asks of its converters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Demand {
    /// Largest power drawn in W, base load included; of converter `converter`.
    pub peak_w: f64,
    /// Largest power fed back in W, not negative; of converter `converter`.
    pub regen_w: f64,
    /// Energy drawn in J, of all converters; fed-back energy is subtracted
    /// only where a converter credits it. 0 if it was not wanted.
    pub energy_j: f64,
    /// The converter that comes closest to its limits.
    pub converter: usize,
    /// The largest of peak by limit and regenerative peak by limit over all
    /// converters: above 1 the move does not fit.
    pub load_ratio: f64,
    /// Peak and regenerative peak of the converter that feeds the spindle, W.
    pub(super) spindle_converter_w: [f64; 2],
}

impl Demand {
    /// Nothing asked yet; each converter is added to it.
    pub(super) const NONE: Self = Self {
        peak_w: 0.0,
        regen_w: 0.0,
        energy_j: 0.0,
        converter: 0,
        load_ratio: f64::NEG_INFINITY,
        spindle_converter_w: [0.0; 2],
    };

    /// Takes in what another part of the same move asks for; the energy is left
    /// aside.
    #[inline]
    pub(super) fn include(&mut self, other: &Self) {
        let spindle_converter_w = std::array::from_fn(|i| {
            larger(self.spindle_converter_w[i], other.spindle_converter_w[i])
        });
        if other.converter == self.converter || self.load_ratio == f64::NEG_INFINITY {
            self.converter = other.converter;
            self.peak_w = larger(self.peak_w, other.peak_w);
            self.regen_w = larger(self.regen_w, other.regen_w);
            self.load_ratio = larger(self.load_ratio, other.load_ratio);
        } else if other.load_ratio > self.load_ratio {
            *self = Self {
                energy_j: self.energy_j,
                ..*other
            };
        }
        self.spindle_converter_w = spindle_converter_w;
    }

    /// A demand that nobody wants to know more of; none where one of its peaks
    /// reaches what is of interest.
    #[inline]
    pub(super) fn below_floor(peak_w: f64, regen_w: f64, want: Want) -> Option<Self> {
        want.passes([peak_w, regen_w]).then_some(Self {
            peak_w,
            regen_w,
            spindle_converter_w: [peak_w, regen_w],
            ..Self::NONE
        })
    }
}

/// Peaks and energy of one converter while they are being found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Totals {
    /// What is drawn besides the moving axes, W.
    pub idle_w: f64,
    /// Largest power so far in W.
    pub peak_w: f64,
    /// Largest power fed back so far in W.
    pub regen_w: f64,
    /// Energy so far in J.
    pub energy_j: f64,
}

impl Totals {
    /// A converter at rest that draws `power_w` for `duration_s`.
    #[inline]
    pub fn at_rest(power_w: f64, duration_s: f64, want: Want) -> Self {
        let mut totals = Self::new(power_w);
        if want.energy && power_w != 0.0 {
            totals.energy_j = power_w * duration_s;
        }
        totals
    }

    /// A converter at rest, without its energy.
    #[inline]
    pub fn new(idle_w: f64) -> Self {
        Self {
            idle_w,
            peak_w: idle_w,
            regen_w: 0.0,
            energy_j: 0.0,
        }
    }

    /// Raises the motoring peak.
    #[inline]
    pub fn raise_peak(&mut self, power_w: f64) {
        self.peak_w = larger(self.peak_w, power_w);
    }

    /// Raises the regenerative peak.
    #[inline]
    pub fn raise_regen(&mut self, power_w: f64) {
        self.regen_w = larger(self.regen_w, power_w);
    }
}

/// The larger of two values. Where overflow has made one of them undefined the
/// result is infinite: never too low.
#[inline]
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if a >= b {
        a
    } else if b > a {
        b
    } else {
        f64::INFINITY
    }
}
