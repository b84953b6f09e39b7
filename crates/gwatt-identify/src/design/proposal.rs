//! The signal that is proposed, and those that it was compared with.

use super::candidate::{Kind, kinds, lowest_hz, made};
use super::foreseen::Foreseen;
use super::known::Known;
use crate::error::{IdentifyError, Outcome};
use crate::excitation::Excitation;

/// What the axis and its drive may do, in SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// The largest force or torque.
    pub amplitude: f64,
    /// Length of the signal, s; without it, as long as the figures need.
    pub seconds: Option<f64>,
    /// The way that is free, from end to end.
    pub stroke: Option<f64>,
    /// The largest speed.
    pub speed: Option<f64>,
}

/// A signal within the bounds, with what is to be expected of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// What it is.
    pub kind: Kind,
    /// Its amplitude; less than that which is allowed where stroke or speed ask for it.
    pub amplitude: f64,
    /// The distance between the ends of the motion, SI, the steady speed included.
    pub travel: f64,
    /// The largest speed, SI, the steady speed included.
    pub fastest: f64,
    /// The speed at which the axis is to move meanwhile, so that Coulomb friction keeps
    /// its sign; none where it has too little to matter.
    pub steady: Option<f64>,
    /// The standard errors.
    pub foreseen: Foreseen,
    /// How far these are from what a correction of 0.1 dB and 0.6° needs: 1 is there.
    pub by_wanted: f64,
}

/// A signal for an axis.
#[derive(Debug, Clone)]
pub struct Proposal {
    /// The signal.
    pub excitation: Excitation,
    /// What is to be expected of it.
    pub best: Candidate,
    /// The best of each other kind.
    pub others: Vec<Candidate>,
}

/// Coulomb friction matters from this share of the signal's rms on.
const MATTERS: f64 = 0.01;
/// The axis moves so much faster than the signal could turn it back.
const STEADY: f64 = 1.2;
/// Samples of a signal: several are held and compared.
const SAMPLES_MIN: f64 = 256.0;
const SAMPLES_MAX: f64 = 2e6;

/// Lengths where none is given, s: what is looked at first, and the longest.
const SECONDS: f64 = 16.0;
const SECONDS_MAX: f64 = 600.0;
/// A signal is so much longer than its errors need: they are known from a first recording.
const TO_SPARE: f64 = 1.2;

/// Compares signals for an axis and takes the best; where no length is given, as long as
/// its standard errors need, up to ten minutes.
///
/// # Errors
///
/// Bounds that are not positive, or within which no signal determines the axis.
pub fn propose(known: &Known, bounds: &Bounds) -> Outcome<Proposal> {
    let lasting = |seconds: f64| {
        check(known, bounds, seconds)?;
        compare(known, bounds, seconds)
    };
    if let Some(seconds) = bounds.seconds {
        return lasting(seconds);
    }
    let first = lasting(SECONDS)?;
    let times = TO_SPARE * first.best.by_wanted * first.best.by_wanted;
    if times <= 1.0 {
        return Ok(first);
    }
    lasting(libm::ceil((SECONDS * times).min(SECONDS_MAX)))
}

fn compare(known: &Known, bounds: &Bounds, seconds: f64) -> Outcome<Proposal> {
    let lowest = lowest_hz(known, seconds);
    let mut found: Vec<(Candidate, Excitation)> = Vec::new();
    let mut trouble = None;
    for from_hz in lowest {
        let mut is_scaled = false;
        for kind in kinds(known, from_hz, seconds) {
            if found.iter().any(|(other, _)| other.kind == kind) {
                continue;
            }
            match candidate(kind, known, bounds, seconds) {
                Ok((next, signal)) => {
                    is_scaled |= next.amplitude < bounds.amplitude;
                    keep(&mut found, next, signal);
                }
                Err(error) => trouble = Some(error),
            }
        }
        // Higher frequencies move the axis less: only where it moves too far.
        if !is_scaled {
            break;
        }
    }
    found.sort_by(|(a, _), (b, _)| a.by_wanted.total_cmp(&b.by_wanted));
    let mut found = found.into_iter();
    let Some((best, excitation)) = found.next() else {
        return Err(trouble.unwrap_or_else(|| {
            IdentifyError::new(
                format!("no signal of {seconds} s determines the axis"),
                "give more --seconds",
            )
        }));
    };
    Ok(Proposal {
        excitation,
        best,
        others: found.map(|(other, _)| other).collect(),
    })
}

fn check(known: &Known, bounds: &Bounds, seconds: f64) -> Outcome<()> {
    let given = [
        ("amplitude", Some(bounds.amplitude)),
        ("stroke", bounds.stroke),
        ("speed", bounds.speed),
    ];
    for (name, value) in given {
        if let Some(value) = value.filter(|value| !(value.is_finite() && *value > 0.0)) {
            return Err(IdentifyError::new(
                format!("the {name} {value} is not positive"),
                "give a positive number",
            ));
        }
    }
    let samples = seconds / known.period_s;
    if !(SAMPLES_MIN..=SAMPLES_MAX).contains(&samples) {
        return Err(IdentifyError::new(
            format!(
                "{seconds} s are {samples:.0} samples, not between {SAMPLES_MIN} and {SAMPLES_MAX}"
            ),
            "choose another --seconds",
        ));
    }
    Ok(())
}

/// Keeps the better one of each kind.
fn keep(found: &mut Vec<(Candidate, Excitation)>, next: Candidate, signal: Excitation) {
    let is_alike = |a: &Kind, b: &Kind| match (a, b) {
        (Kind::Flat { to_hz: a, .. }, Kind::Flat { to_hz: b, .. }) => a == b,
        (Kind::Shaped { quiet: a, .. }, Kind::Shaped { quiet: b, .. }) => a == b,
        _ => false,
    };
    let alike = found
        .iter_mut()
        .find(|(other, _)| is_alike(&other.kind, &next.kind));
    match alike {
        Some(slot) if next.by_wanted < slot.0.by_wanted => *slot = (next, signal),
        Some(_) => {}
        None => found.push((next, signal)),
    }
}

fn candidate(
    kind: Kind,
    known: &Known,
    bounds: &Bounds,
    seconds: f64,
) -> Outcome<(Candidate, Excitation)> {
    let vague = || {
        IdentifyError::new(
            format!("{kind} does not determine the axis in {seconds} s"),
            "give more --seconds",
        )
    };
    let mut signal = made(kind, known, bounds.amplitude, seconds)?;
    let (travel, fastest, accel) = known.motion(&signal.values).ok_or_else(vague)?;
    let is_steady = known.coulomb > MATTERS * signal.rms;
    let steady = if is_steady { STEADY * fastest } else { 0.0 };
    let lasts = signal.values.len() as f64 * signal.period_s;
    let (travel, fastest) = (travel + steady * lasts, fastest + steady);
    // All of these are proportional to the amplitude.
    let within = |bound: Option<f64>, value: f64| bound.map_or(1.0, |b| (b / value).min(1.0));
    let share = within(bounds.stroke, travel).min(within(bounds.speed, fastest));
    if share < 1.0 {
        for x in &mut signal.values {
            *x *= share;
        }
        signal.peak *= share;
        signal.rms *= share;
    }
    let accel: Vec<f64> = accel.iter().map(|a| a * share).collect();
    let foreseen = Foreseen::of(known, &signal.values, &accel).ok_or_else(vague)?;
    let by_wanted = foreseen.by_wanted(known);
    if !by_wanted.is_finite() {
        return Err(vague());
    }
    let next = Candidate {
        kind,
        amplitude: bounds.amplitude * share,
        travel: travel * share,
        fastest: fastest * share,
        steady: is_steady.then_some(steady * share),
        foreseen,
        by_wanted,
    };
    Ok((next, signal))
}
