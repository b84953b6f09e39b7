//! What is decided about a move by itself, by strategy and law.

use super::alone::step_by_step;
use super::case::{Case, Ends};
use super::change::{Change, Permit};
use super::law;
use super::lever::{Levers, Obstacle, levers};
use super::optimum;
use super::options::{Law, Strategy};
use super::solver::Solver;
use gwatt_motion::{Move, MoveKind};
use gwatt_power::Assessment;

impl Solver<'_> {
    /// The change that makes a move fit which does not.
    ///
    /// # Errors
    /// What stands in the way.
    pub fn solve(
        &self,
        mv: &Move,
        assessment: &Assessment,
        permit: &Permit,
        ends: Ends,
    ) -> Result<Change, Obstacle> {
        let case = Case {
            mv,
            assessment,
            permit,
            ends,
            exact_stop: false,
        };
        let levers = levers(self.machine, self.how, mv, permit);
        if mv.kind == MoveKind::Dwell
            || assessment.top_speed_mm_s == 0.0 && mv.unknown_start.is_empty()
        {
            if assessment.spindle.drawn_w > 0.0 || assessment.spindle.fed_back_w > 0.0 {
                return Err(Obstacle::new(
                    "spindle-power",
                    "the spindle, with base load and switched loads, exceeds the limit",
                    "a lower S, or a drive that runs up more slowly; gwatt writes no S",
                ));
            }
            return Err(Obstacle::new(
                "base-load",
                "base load, switched loads and holding the axes alone exceed the limit",
                "no feed and no acceleration changes that: a larger converter is needed",
            ));
        }
        let solved = |ends: Ends| {
            let case = Case { ends, ..case };
            self.sooner_stopped(case, |case| self.by_strategy(case, &levers))
        };
        if !self.by_accel_alone(case, &levers) {
            return solved(ends);
        }
        match ends {
            Ends::Rest => solved(Ends::Alone(0)),
            Ends::Any(depth) => step_by_step(depth, solved),
            Ends::Alone(_) => solved(ends),
        }
    }

    /// The change that the strategy says.
    pub(super) fn by_strategy(&self, case: Case<'_>, levers: &Levers) -> Result<Change, Obstacle> {
        let change = match (self.how.strategy, self.how.law) {
            (Strategy::Preset, _) => self.by_preset(case, levers)?,
            (strategy, Law::Patent) => law::squared_ratio(self, case, levers, strategy)?,
            (Strategy::Speed, _) => self.by_speed(case, levers)?,
            (Strategy::Accel, _) => self.by_accel(case, levers)?,
            // Under the robust bound a neighbour's speed meets this move's
            // acceleration: where a pair was not enough, speeds alone go down.
            (Strategy::Optimal | Strategy::Split, _)
                if case.ends > Ends::Any(2) && levers.speed.is_some() =>
            {
                self.by_speed(case, levers)?
            }
            (Strategy::Optimal | Strategy::Split, _) => self.optimal(case, levers)?,
        };
        self.verify(case, change)
    }

    pub(super) fn by_speed(&self, case: Case<'_>, levers: &Levers) -> Result<Change, Obstacle> {
        let found = self.by_speed_word(case, levers);
        match self.how.strategy {
            Strategy::Speed => self.with_levels(case, levers, found),
            _ => found,
        }
    }

    pub(super) fn by_speed_word(
        &self,
        case: Case<'_>,
        levers: &Levers,
    ) -> Result<Change, Obstacle> {
        let lever = levers.speed.ok_or_else(|| self.no_speed_lever(case))?;
        self.speed(case, lever, &Change::default())
            .ok_or_else(|| self.too_much(case))
    }

    pub(super) fn by_accel(&self, case: Case<'_>, levers: &Levers) -> Result<Change, Obstacle> {
        let found = self.by_accel_word(case, levers);
        self.with_levels(case, levers, found)
    }

    pub(super) fn by_accel_word(
        &self,
        case: Case<'_>,
        levers: &Levers,
    ) -> Result<Change, Obstacle> {
        let knob = levers.accel.ok_or_else(|| self.no_accel_lever(case))?;
        // A block that is too short for its speed reaches less of it the more slowly it
        // accelerates, so that friction alone at full speed decides nothing.
        if let Some(change) = self.accel_alone(case, knob) {
            return Ok(change);
        }
        let Some(load) = self.cruise_load(case).filter(|load| *load > 1.0) else {
            return Err(self.too_much(case));
        };
        Err(Obstacle::new(
            "friction-alone",
            format!(
                "friction alone takes {:.1} % of the limit at the wanted speed",
                load * 100.0
            ),
            if self.how.allowed.feed {
                "lower the speed: --strategy optimal or speed"
            } else {
                "lower the speed: --strategy optimal or speed, with --allow feed for feeds"
            },
        ))
    }

    pub(super) fn optimal(&self, case: Case<'_>, levers: &Levers) -> Result<Change, Obstacle> {
        let found = self.optimal_words(case, levers);
        self.with_levels(case, levers, found)
    }

    pub(super) fn optimal_words(
        &self,
        case: Case<'_>,
        levers: &Levers,
    ) -> Result<Change, Obstacle> {
        match *levers {
            // Steps do not fall with the acceleration.
            Levers { speed: Some(_), .. } if self.load_by_steps(case, case.mv).is_some() => {
                self.by_speed(case, levers)
            }
            Levers {
                speed: Some(speed),
                accel,
                jerk,
                ..
            } if accel.or(jerk).is_some() => {
                optimum::best_pair(self, case, speed, levers).ok_or_else(|| self.too_much(case))
            }
            Levers { speed: Some(_), .. } => self.by_speed(case, levers),
            Levers { accel: Some(_), .. } => self.by_accel_word(case, levers),
            Levers {
                jerk: Some(knob), ..
            } => self
                .jerk_alone(case, knob)
                .ok_or_else(|| self.too_much(case)),
            _ => Err(self.no_speed_lever(case)),
        }
    }
}
