//! Parameters of the power model from a log of speeds, accelerations and the
//! drive's power.
//!
//! `P = v·(m·a + b·v + Fc·sign v)`, divided by the efficiency where it is
//! positive and multiplied where it is not, plus the standby power. Terms that
//! the log does not show are left out.

use super::error::{IdentifyError, Outcome};
use super::figure::Figure;
use super::normal::Normal;
use super::peak_factor::{PeakFactor, factor_of, ratios};
use super::sandwich::{sandwich, widening};

pub use super::power_log::PowerLog;

/// Rows at least.
const ROWS_MIN: usize = 50;
/// Lowest efficiency that is looked for.
const EFFICIENCY_MIN: f64 = 0.2;
/// Steps of the search: first even ones, then such that divide the best by the golden
/// ratio.
const EVEN: u32 = 16;
const GOLDEN: u32 = 32;
/// A log by itself is divided into so many parts that are predicted by the others.
const PARTS: usize = 8;

/// The fitted power model; kg·m², N·m·s/rad and N·m where the axis turns.
#[derive(Debug, Clone, PartialEq)]
pub struct PowerModel {
    /// Mass or inertia.
    pub mass: Figure,
    /// Viscous friction.
    pub viscous: Figure,
    /// Coulomb friction.
    pub coulomb: Figure,
    /// Efficiency; 1 with an error of 0 where the log shows no other.
    pub efficiency: Figure,
    /// Power at rest, W; 0 where the log shows none.
    pub standby_w: Figure,
    /// Share of the power's square that the model explains: about the mean where
    /// there is a standby power, else about zero.
    pub r2: f64,
    /// The same about the mean, in any case.
    pub r2_centered: f64,
    /// Root of the mean square of what is left, W.
    pub rms_w: f64,
    /// Largest power measured, W.
    pub peak_measured_w: f64,
    /// Largest power of the model, W.
    pub peak_model_w: f64,
    /// By which factor peaks exceed the model.
    pub peaks: PeakFactor,
    /// Rows.
    pub rows: usize,
}

/// One row: products whose factors are mass, viscous and Coulomb friction.
fn columns(v: f64, a: f64) -> [f64; 3] {
    [v * a, v * v, v.abs()]
}

/// Which of efficiency and standby power are looked for.
#[derive(Clone, Copy)]
struct Wanted {
    efficiency: bool,
    standby: bool,
}

/// What was solved for.
#[derive(Debug, Clone)]
struct Solved {
    /// Mass, viscous and Coulomb friction, and the standby power.
    values: [f64; 4],
    efficiency: f64,
    rest: f64,
}

impl Solved {
    fn mechanical(&self, v: f64, a: f64) -> f64 {
        let pairs = columns(v, a).into_iter().zip(self.values);
        pairs.map(|(x, value)| x * value).sum()
    }

    fn power(&self, v: f64, a: f64) -> f64 {
        let [.., standby] = self.values;
        let mechanical = self.mechanical(v, a);
        standby + mechanical * share(mechanical, self.efficiency)
    }
}

fn share(mechanical: f64, efficiency: f64) -> f64 {
    if mechanical >= 0.0 {
        1.0 / efficiency
    } else {
        efficiency
    }
}

/// Rows of a log of which some are left out.
#[derive(Clone, Copy)]
struct Part<'a> {
    log: &'a PowerLog,
    /// From here to there.
    without: (usize, usize),
}

impl<'a> Part<'a> {
    fn whole(log: &'a PowerLog) -> Self {
        Self {
            log,
            without: (0, 0),
        }
    }

    fn rows(self) -> impl Iterator<Item = (f64, f64, f64)> + 'a {
        let (from, to) = self.without;
        let log = self.log;
        let all = log.velocity.iter().zip(&log.acceleration).zip(&log.power);
        all.enumerate()
            .filter(move |(k, _)| !(from..to).contains(k))
            .map(|(_, ((v, a), p))| (*v, *a, *p))
    }
}

fn weak() -> IdentifyError {
    IdentifyError::new(
        "the log does not distinguish mass and friction: there is too little motion",
        "log rapids and feeds at several speeds, with starts and stops",
    )
}

/// Fits the power model.
///
/// # Errors
///
/// When the log does not determine it.
pub fn fit(log: &PowerLog) -> Outcome<PowerModel> {
    let n = log.power.len();
    if n < ROWS_MIN {
        return Err(IdentifyError::new(
            format!("the log is too short: {n} rows"),
            "log at least some seconds of motion, with accelerations",
        ));
    }
    let whole = Part::whole(log);
    let mut wanted = Wanted {
        efficiency: false,
        standby: true,
    };
    let with = solve_for(whole, wanted).ok_or_else(weak)?;
    let standby = figures(whole, &with, wanted)
        .and_then(|[_, _, _, standby, _]| standby)
        .ok_or_else(weak)?;
    wanted.standby = standby.value > 4.0 * standby.std;
    let plain = solve_for(whole, wanted).ok_or_else(weak)?;
    // One parameter more must pay, and clearly.
    let looked_for = Wanted {
        efficiency: true,
        ..wanted
    };
    let pays =
        |found: &Solved| n as f64 * libm::log(plain.rest / found.rest) > libm::log(n as f64) + 10.0;
    let found = solve_for(whole, looked_for).filter(pays);
    wanted.efficiency = found.is_some();
    let best = found.unwrap_or(plain);
    finish(log, &best, wanted)
}

/// The model that is wanted.
fn solve_for(part: Part<'_>, wanted: Wanted) -> Option<Solved> {
    if !wanted.efficiency {
        return solve(part, 1.0, wanted.standby);
    }
    let at = |efficiency: f64| solve(part, efficiency, wanted.standby);
    let step = (1.0 - EFFICIENCY_MIN) / f64::from(EVEN);
    let mut best: Option<Solved> = None;
    for k in 0..=EVEN {
        let found = at(EFFICIENCY_MIN + step * f64::from(k));
        if let Some(found) = found
            && best.as_ref().is_none_or(|best| found.rest < best.rest)
        {
            best = Some(found);
        }
    }
    let mut best = best?;
    let (mut low, mut high) = (
        (best.efficiency - step).max(EFFICIENCY_MIN),
        (best.efficiency + step).min(1.0),
    );
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    for _ in 0..GOLDEN {
        let (left, right) = (high - golden * (high - low), low + golden * (high - low));
        let (Some(one), Some(two)) = (at(left), at(right)) else {
            break;
        };
        let better = if one.rest < two.rest {
            high = right;
            one
        } else {
            low = left;
            two
        };
        if better.rest < best.rest {
            best = better;
        }
    }
    Some(best)
}

/// Least squares at an efficiency; which rows drive and which brake follows from
/// the round before.
fn solve(part: Part<'_>, efficiency: f64, standby: bool) -> Option<Solved> {
    let mut solved: Option<Solved> = None;
    let rounds = if efficiency < 1.0 { 4 } else { 1 };
    let width = 3 + usize::from(standby);
    for _ in 0..rounds {
        let mut normal = Normal::new(width);
        for (v, a, p) in part.rows() {
            let mechanical = solved.as_ref().map_or(p, |it| it.mechanical(v, a));
            let factor = share(mechanical, efficiency);
            let [x, y, z] = columns(v, a).map(|x| x * factor);
            normal.add([x, y, z, 1.0].get(..width)?, p);
        }
        let solution = normal.solve()?;
        let mut values = [0.0; 4];
        for (slot, x) in values.iter_mut().zip(solution.x.iter()) {
            *slot = *x;
        }
        solved = Some(Solved {
            values,
            efficiency,
            rest: solution.rest,
        });
    }
    // The sign of the last round may differ from that of the one before.
    solved.map(|mut solved| {
        let gaps = part.rows().map(|(v, a, p)| p - solved.power(v, a));
        solved.rest = gaps.map(|gap| gap * gap).sum();
        solved
    })
}

/// Mass, frictions, standby power and efficiency with their errors, each with what the
/// others leave open of it; `None` for what is not wanted.
fn figures(part: Part<'_>, solved: &Solved, wanted: Wanted) -> Option<[Option<Figure>; 5]> {
    let is_wanted = [true, true, true, wanted.standby, wanted.efficiency];
    let row = |v: f64, a: f64| -> Vec<f64> {
        let mechanical = solved.mechanical(v, a);
        let factor = share(mechanical, solved.efficiency);
        let [x, y, z] = columns(v, a).map(|x| x * factor);
        // Of M/η and M·η.
        let by_efficiency = if mechanical >= 0.0 {
            -mechanical / (solved.efficiency * solved.efficiency)
        } else {
            mechanical
        };
        let all = [x, y, z, 1.0, by_efficiency].into_iter().zip(is_wanted);
        all.filter(|(_, is_wanted)| *is_wanted)
            .map(|(x, _)| x)
            .collect()
    };
    let width = is_wanted.iter().filter(|is_wanted| **is_wanted).count();
    let mut normal = Normal::new(width);
    let mut scores: Vec<Vec<f64>> = Vec::new();
    for (k, (v, a, p)) in part.rows().enumerate() {
        if k == 0 || part.log.starts.contains(&k) {
            scores.push(Vec::new());
        }
        let row = row(v, a);
        let gap = p - solved.power(v, a);
        normal.add(&row, gap);
        if let Some(scores) = scores.last_mut() {
            scores.extend(row.iter().map(|x| x * gap));
        }
    }
    let covariance = sandwich(&scores, &normal.solve()?.inverse) * widening(normal.rows);
    let mut stds = covariance
        .diagonal()
        .iter()
        .map(|d| d.max(0.0).sqrt())
        .collect::<Vec<_>>()
        .into_iter();
    let [m, b, c, s] = solved.values;
    let values = [m, b, c, s, solved.efficiency].into_iter().zip(is_wanted);
    let mut found = [None; 5];
    for (slot, (value, is_wanted)) in found.iter_mut().zip(values) {
        if is_wanted {
            *slot = stds.next().map(|std| Figure { value, std });
        }
    }
    Some(found)
}

/// Ratios of measured to predicted peaks, each log predicted by the others; parts of it
/// where there is one alone.
fn held_out(log: &PowerLog, best: &Solved, wanted: Wanted, peak_w: f64) -> Vec<f64> {
    let n = log.power.len();
    let starts = if log.starts.len() > 1 {
        log.starts.clone()
    } else {
        (0..PARTS).map(|k| k * n / PARTS).collect()
    };
    let ends = starts.iter().skip(1).copied().chain([n]);
    let mut found = Vec::new();
    for (from, to) in starts.iter().copied().zip(ends) {
        let part = Part {
            log,
            without: (from, to),
        };
        // What few rows do not determine is predicted by all.
        let model = solve_for(part, wanted).unwrap_or_else(|| best.clone());
        let predicted: Vec<f64> = (from..to)
            .map(|k| {
                let at = |x: &[f64]| x.get(k).copied().unwrap_or_default();
                model.power(at(&log.velocity), at(&log.acceleration))
            })
            .collect();
        let measured = log.power.get(from..to).unwrap_or_default();
        found.extend(ratios(&predicted, measured, peak_w));
    }
    found
}

fn finish(log: &PowerLog, best: &Solved, wanted: Wanted) -> Outcome<PowerModel> {
    let n = log.power.len() as f64;
    let mean = log.power.iter().sum::<f64>() / n;
    let about =
        |centre: f64| -> f64 { log.power.iter().map(|p| (p - centre) * (p - centre)).sum() };
    let r2_centered = 1.0 - best.rest / about(mean);
    let model = Part::whole(log).rows().map(|(v, a, _)| best.power(v, a));
    let peak_model_w = model.fold(f64::NEG_INFINITY, f64::max);
    let peak_measured_w = log.power.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let found = figures(Part::whole(log), best, wanted).ok_or_else(weak)?;
    let [mass, viscous, coulomb, standby, efficiency] = found.map(|figure| {
        figure.unwrap_or(Figure {
            value: 0.0,
            std: 0.0,
        })
    });
    if mass.value <= 0.0 {
        return Err(IdentifyError::new(
            format!("the mass comes out as {:.3}, not positive", mass.value),
            "check units and signs of speed, acceleration and power, and that they are of the same time",
        ));
    }
    Ok(PowerModel {
        mass,
        viscous,
        coulomb,
        efficiency: if wanted.efficiency {
            efficiency
        } else {
            Figure {
                value: 1.0,
                std: 0.0,
            }
        },
        standby_w: standby,
        r2: if wanted.standby {
            r2_centered
        } else {
            1.0 - best.rest / about(0.0)
        },
        r2_centered,
        rms_w: (best.rest / n).sqrt(),
        peak_measured_w,
        peak_model_w,
        peaks: factor_of(&held_out(log, best, wanted, peak_model_w)),
        rows: log.power.len(),
    })
}
