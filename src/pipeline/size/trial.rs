//! One program at one value: a run of the limiter.

use std::collections::BTreeMap;
use std::fmt;
use std::io::{Read, Seek};

use rayon::prelude::*;

use super::scale::Scale;
use crate::diagnostic::Diagnostic;
use crate::machine::Machine;
use crate::pipeline::{Certificate, Failure, LimitOptions, LimitSummary, Options, limit};

/// A program that can be read as often as needed.
pub struct Job<'a, R> {
    /// Its name as it was given.
    pub name: String,
    /// How it is read and judged; `threads` counts for nothing here.
    pub options: Options,
    /// Opens it for reading from the beginning.
    pub open: Box<dyn Fn() -> Result<R, Failure> + Send + Sync + 'a>,
}

impl<R> fmt::Debug for Job<'_, R> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Job")
            .field("name", &self.name)
            .finish_non_exhaustive()
    }
}

/// What the limiter makes of a program at one value.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Trial {
    /// Whether the certificate holds: the other figures are those of a program that is
    /// written only then.
    pub certified: bool,
    /// Cycle time in s.
    pub duration_s: f64,
    /// Largest power that is drawn, W.
    pub peak_w: f64,
    /// Largest power that is fed back, W.
    pub regen_w: f64,
    /// Lines that were changed or inserted.
    pub edited_lines: u64,
    /// Which certificate it is.
    pub certificate: Option<Certificate>,
    /// Why there is none.
    pub reasons: Vec<Diagnostic>,
}

impl Trial {
    fn of(summary: LimitSummary) -> Self {
        let after = summary.after;
        Self {
            certified: summary.certified,
            duration_s: after.duration_s,
            peak_w: after.peak_w,
            regen_w: after.regen_w,
            edited_lines: summary.edited_lines,
            certificate: after.certificate,
            reasons: summary.reasons,
        }
    }

    /// Several programs together: sums of times and lines, the largest powers.
    pub(super) fn together<'t>(trials: impl Iterator<Item = &'t Self>) -> Self {
        let start = Self {
            certified: true,
            ..Self::default()
        };
        trials.fold(start, |total, trial| Self {
            certified: total.certified && trial.certified,
            duration_s: total.duration_s + trial.duration_s,
            peak_w: total.peak_w.max(trial.peak_w),
            regen_w: total.regen_w.max(trial.regen_w),
            edited_lines: total.edited_lines + trial.edited_lines,
            certificate: match (total.certificate, trial.certificate) {
                (Some(Certificate::Robust), _) | (_, Some(Certificate::Robust)) => {
                    Some(Certificate::Robust)
                }
                (one, other) => one.or(other),
            },
            reasons: total.reasons,
        })
    }
}

/// A program with what is known of it.
pub(super) struct Bench<'a, R> {
    job: &'a Job<'a, R>,
    pub(super) scale: &'a Scale<'a>,
    how: LimitOptions,
    threads: usize,
    /// By the bits of the value: the same value is tried once.
    trials: BTreeMap<u64, Trial>,
}

impl<'a, R: Read + Seek + Send> Bench<'a, R> {
    pub(super) fn new(
        job: &'a Job<'a, R>,
        scale: &'a Scale<'a>,
        how: LimitOptions,
        threads: usize,
    ) -> Self {
        Self {
            job,
            scale,
            how,
            threads,
            trials: BTreeMap::new(),
        }
    }

    pub(super) fn name(&self) -> &str {
        &self.job.name
    }

    /// Runs the limiter at a value.
    pub(super) fn limit_at(&self, value: f64) -> Result<LimitSummary, Failure> {
        self.limit(&self.scale.at(value), self.threads)
    }

    fn limit(&self, machine: &Machine, threads: usize) -> Result<LimitSummary, Failure> {
        let options = Options {
            threads,
            ..self.job.options.clone()
        };
        let input = (self.job.open)()?;
        limit(input, machine, &options, self.how, std::io::sink(), None)
    }

    /// The program at a value.
    pub(super) fn at(&mut self, value: f64) -> Result<&Trial, Failure> {
        let bits = value.to_bits();
        if !self.trials.contains_key(&bits) {
            let trial = self.fresh(value, self.threads)?;
            self.trials.insert(bits, trial);
        }
        Ok(self.trials.entry(bits).or_default())
    }

    /// The same, not looked up and not kept.
    fn fresh(&self, value: f64, threads: usize) -> Result<Trial, Failure> {
        let summary = self.limit(&self.scale.at(value), threads)?;
        Ok(Trial::of(summary))
    }

    /// Keeps what a run at a value came to.
    pub(super) fn know(&mut self, value: f64, summary: LimitSummary) -> Trial {
        let trial = Trial::of(summary);
        self.trials.insert(value.to_bits(), trial.clone());
        trial
    }
}

/// All programs at some values, in the order of the values and the programs.
pub(super) fn at_all<R: Read + Seek + Send>(
    benches: &mut [Bench<'_, R>],
    values: &[f64],
    threads: usize,
) -> Result<Vec<Vec<Trial>>, Failure> {
    let missing: Vec<(usize, f64)> = values
        .iter()
        .flat_map(|&value| (0..benches.len()).map(move |index| (index, value)))
        .filter(|(index, value)| {
            let bench = benches.get(*index);
            bench.is_some_and(|bench| !bench.trials.contains_key(&value.to_bits()))
        })
        .collect();
    let at_once = threads.min(missing.len()).max(1);
    let each_has = (threads / at_once).max(1);
    let known: &[Bench<'_, R>] = benches;
    let found = each(at_once, &missing, |&(index, value)| {
        known.get(index).map(|bench| bench.fresh(value, each_has))
    })?;
    for ((index, value), trial) in missing.into_iter().zip(found) {
        if let (Some(bench), Some(trial)) = (benches.get_mut(index), trial) {
            bench.trials.insert(value.to_bits(), trial?);
        }
    }
    let at = |value: f64| {
        let trials = benches.iter();
        trials
            .filter_map(|bench| bench.trials.get(&value.to_bits()).cloned())
            .collect()
    };
    Ok(values.iter().map(|&value| at(value)).collect())
}

/// Does `work` for all items, so many at once; the results are in the order of the
/// items.
///
/// # Errors
/// When threads cannot be started.
pub(super) fn each<I: Sync, O: Send>(
    at_once: usize,
    items: &[I],
    work: impl Fn(&I) -> O + Sync + Send,
) -> Result<Vec<O>, Failure> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(at_once)
        .build()
        .map_err(|error| {
            Failure::Unsuitable(format!("cannot start threads ({error}): give --threads 1"))
        })?;
    // One by one: some take far longer than others.
    Ok(pool.install(|| items.par_iter().with_max_len(1).map(work).collect()))
}
