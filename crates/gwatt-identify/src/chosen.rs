//! What a search looks at and what it chooses.

use super::data::Data;
use super::estimate::Estimate;
use super::fewer_rows::FewerRows;
use super::measured_noise::Noise;
use super::noise::Whiteness;

/// Samples on which models are compared; of commands more, as a sweep shows each
/// mode but once, and of forces where the first ones show less than all do.
pub const COMPARED: usize = 8_000;

/// Samples on which the best of them are; the last fit takes all.
pub const CHOSEN: usize = 24_000;

/// Samples of a long recording on which what is found on few of them is brought nearer to
/// what suits all, and small things are decided: a step on all of a million takes as long as
/// ten on these.
pub const MANY: usize = 4 * CHOSEN;

/// Lines on which modes are looked for, about.
pub const COARSE: usize = 700;

/// Order of the filter that makes noise white, at most.
pub const WHITENING_MAX: usize = 40;

/// Lags over which residuals are tested.
pub const LAGS: usize = 40;

/// A model that was chosen on some of the samples.
pub struct Chosen {
    /// The model.
    pub found: Estimate,
    /// Whether the delay was fitted.
    pub delay_is_free: bool,
    /// How far it is in doubt besides, s.
    pub delay_doubt_s: f64,
    /// What made the noise white.
    pub noise: Noise,
}

/// The rows on which models are compared, where they are more than usual and fewer show
/// as much.
#[must_use]
pub fn fewer_rows(rows: &Data<'_>, compared: usize, band_rad_s: f64) -> Option<FewerRows> {
    (compared > COMPARED)
        .then(|| FewerRows::of(rows, band_rad_s))
        .flatten()
}

/// The first samples, where they are much fewer than all; `None` where all are looked at.
#[must_use]
pub fn many<'a>(data: &Data<'a>) -> Option<Data<'a>> {
    (data.len() > 2 * MANY).then(|| data.head(MANY))
}

/// True where a filter makes white what is left.
#[must_use]
pub fn is_white(left: &[f64], taps: &[f64]) -> bool {
    Whiteness::of(&filtered(left, taps), LAGS).is_white()
}

/// A signal after the whitening filter, its beginning left out.
#[must_use]
pub fn filtered(x: &[f64], taps: &[f64]) -> Vec<f64> {
    let order = taps.len();
    x.windows(order + 1)
        .map(|window| {
            let past = window.iter().rev().skip(1);
            let sum: f64 = past.zip(taps).map(|(x, tap)| x * tap).sum();
            sum + window.last().copied().unwrap_or_default()
        })
        .collect()
}
