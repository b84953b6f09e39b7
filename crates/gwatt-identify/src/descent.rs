//! The way down on a sum of squares that all searches share: steps of the linearised
//! problem, damped (Levenberg and Marquardt).

/// How far a step is damped: less after one that led down, more after one that did not.
#[derive(Debug, Clone, Copy)]
pub struct Damping {
    /// Of the next step.
    pub now: f64,
    /// Less changes nothing.
    pub least: f64,
    /// With more nothing moves: the search is at its end.
    pub most: f64,
}

impl Damping {
    fn eased(&mut self) {
        self.now = (self.now * 0.1).max(self.least);
    }

    /// False at the end.
    fn raised(&mut self) -> bool {
        self.now *= 10.0;
        self.now <= self.most
    }
}

/// What a step came to.
pub enum Step<P> {
    /// A place, which may lie higher.
    To(P),
    /// None that a model may have.
    Nowhere,
    /// The data do not determine a step with so little damping.
    Unsolved,
    /// It is not worth going on.
    GivenUp,
}

/// What goes down.
pub trait Descending {
    /// Where a search stands.
    type Place;

    /// The sum of squares there.
    fn squares(&self, at: &Self::Place) -> f64;

    /// Whether there is to be a round with this number, from 0.
    fn goes_on(&self, round: usize, at: &Self::Place) -> bool;

    /// A step with so much damping.
    fn step(&self, round: usize, at: &Self::Place, damping: f64) -> Step<Self::Place>;

    /// Whether nothing more is worth while after a step down.
    fn is_enough(&self, round: usize, before: &Self::Place, after: &Self::Place) -> bool;
}

/// Goes down from a start; with the rounds that it took. `None` where the data determine no
/// step, however it is damped.
pub fn descend<D: Descending>(
    task: &D,
    start: D::Place,
    mut damping: Damping,
) -> Option<(D::Place, usize)> {
    let mut at = start;
    let mut rounds = 0;
    while task.goes_on(rounds, &at) {
        let round = rounds;
        rounds += 1;
        match task.step(round, &at, damping.now) {
            Step::To(next) if task.squares(&next) <= task.squares(&at) => {
                damping.eased();
                let is_enough = task.is_enough(round, &at, &next);
                at = next;
                if is_enough {
                    break;
                }
            }
            Step::GivenUp => break,
            Step::Unsolved => {
                if !damping.raised() {
                    return None;
                }
            }
            Step::To(_) | Step::Nowhere => {
                if !damping.raised() {
                    break;
                }
            }
        }
    }
    Some((at, rounds))
}

#[cfg(test)]
mod tests {
    use super::*;

    const DAMPING: Damping = Damping {
        now: 1.0,
        least: 1e-3,
        most: 1e3,
    };

    /// x², with steps of Newton shortened by the damping; below `solved` there is none.
    struct Parabola {
        solved: f64,
        uphill: bool,
    }

    impl Descending for Parabola {
        type Place = f64;

        fn squares(&self, at: &f64) -> f64 {
            at * at
        }

        fn goes_on(&self, round: usize, _: &f64) -> bool {
            round < 50
        }

        fn step(&self, _: usize, at: &f64, damping: f64) -> Step<f64> {
            if damping < self.solved {
                Step::Unsolved
            } else if self.uphill {
                Step::To(at + 1.0)
            } else {
                Step::To(at - at / (1.0 + damping))
            }
        }

        fn is_enough(&self, _: usize, _: &f64, after: &f64) -> bool {
            *after < 1e-6
        }
    }

    #[test]
    fn damping_falls_on_the_way_down() {
        let task = Parabola {
            solved: 0.0,
            uphill: false,
        };
        // By 2, 11, 101 and 1001: below a millionth after the fourth.
        let (at, rounds) = descend(&task, 1.0, DAMPING).unwrap();
        assert_eq!(rounds, 4);
        assert!((at - 1.0 / (2.0 * 11.0 * 101.0 * 1001.0)).abs() < 1e-12);
    }

    #[test]
    fn where_nothing_leads_down_the_search_ends_where_it_was() {
        let task = Parabola {
            solved: 0.0,
            uphill: true,
        };
        // With 1, 10, 100 and 1000.
        assert_eq!(descend(&task, 1.0, DAMPING), Some((1.0, 4)));
    }

    #[test]
    fn what_is_not_determined_has_no_end() {
        let task = Parabola {
            solved: f64::INFINITY,
            uphill: false,
        };
        assert_eq!(descend(&task, 1.0, DAMPING), None);
    }
}
