//! What a store holds over time, in bounded memory.
//!
//! Input: what it holds, time after time. Output: [`Fill`]s, which are points of a line;
//! where there are too many, two that are near become one that holds as much as the fuller, so
//! that the most that it ever held stays.

/// Fills that are kept of a program, and of a move.
pub(super) const FILLS_MAX: usize = 4000;
pub(super) const MOVE_FILLS_MAX: usize = 250;
/// Of what an empty store could have given off the powers of this ratio are kept, from so
/// much on, J: that is what a run takes off which begins with what the one before has left.
const NOTED_RATIO: f64 = 1.1;
const NOTED_MIN_J: f64 = 1e-3;

/// What a store holds for some time, or at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Fill {
    pub from_s: f64,
    pub to_s: f64,
    /// What it holds in a run that begins with an empty store, J.
    pub held_j: f64,
    /// What has come in less what has left or could have left, J.
    pub net_j: f64,
    /// It comes from a power of which it is not known how long it lasts.
    pub lasting: bool,
}

/// Fills in the order of time.
#[derive(Debug, Clone)]
pub(super) struct Filling {
    most: usize,
    list: Vec<Fill>,
    /// Neighbours that last no longer together are one, s; none yet where it is below 0.
    near_s: f64,
    /// The most that an empty store could have given off at an instant that is kept, J.
    noted_j: f64,
}

impl Fill {
    fn is_empty(&self) -> bool {
        self.held_j <= 0.0
    }

    fn join(&mut self, next: &Self) {
        self.to_s = next.to_s;
        self.held_j = self.held_j.max(next.held_j);
        self.net_j = self.net_j.max(next.net_j);
        self.lasting |= next.lasting;
    }
}

impl Filling {
    /// An empty one that keeps so many.
    pub fn new(most: usize) -> Self {
        Self {
            most,
            list: Vec::new(),
            near_s: -1.0,
            noted_j: 0.0,
        }
    }

    pub fn list(&self) -> &[Fill] {
        &self.list
    }

    /// Hands its fills over, and begins again.
    pub fn take(&mut self) -> Vec<Fill> {
        (self.near_s, self.noted_j) = (-1.0, 0.0);
        std::mem::take(&mut self.list)
    }

    /// Takes the next one.
    pub fn add(&mut self, next: Fill) {
        let room_j = NOTED_RATIO * self.noted_j.max(NOTED_MIN_J);
        if next.is_empty()
            && -next.net_j <= room_j
            && let [.., before, last] = self.list.as_mut_slice()
            && before.is_empty()
            && last.is_empty()
        {
            // Nothing happens: the line goes on.
            if last.from_s < last.to_s {
                last.join(&next);
            } else {
                *last = next;
            }
            return;
        }
        self.noted_j = self.noted_j.max(-next.net_j);
        if let Some(last) = self.list.last_mut()
            && next.to_s - last.from_s <= self.near_s
        {
            last.join(&next);
            return;
        }
        self.list.push(next);
        if self.list.len() > self.most {
            self.halve();
        }
    }

    /// Joins pairs. Of `most` fills, no more than a quarter of them are pairs that are too long
    /// for it: each lasts more than 4/`most` of all.
    fn halve(&mut self) {
        let lasts_s = self.list.last().map_or(0.0, |last| last.to_s);
        self.near_s = 4.0 * lasts_s / self.most as f64;
        let mut joined: Vec<Fill> = Vec::with_capacity(self.most);
        for pair in self.list.chunks(2) {
            match *pair {
                [mut first, second] if second.to_s - first.from_s <= self.near_s => {
                    first.join(&second);
                    joined.push(first);
                }
                _ => joined.extend(pair),
            }
        }
        self.list = joined;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(time_s: f64, held_j: f64, net_j: f64) -> Fill {
        Fill {
            from_s: time_s,
            to_s: time_s,
            held_j,
            net_j,
            lasting: false,
        }
    }

    /// A store that is empty for a million instants takes few fills, and one peak among as many
    /// that are not stays.
    #[test]
    fn the_most_that_was_held_stays() {
        let mut calm = Filling::new(FILLS_MAX);
        for index in 0..1_000_000 {
            let time_s = f64::from(index);
            calm.add(at(time_s, 0.0, -2.0 * time_s));
        }
        assert!(calm.list().len() < 300, "{}", calm.list().len());
        assert_eq!(calm.list().last().map(|it| it.to_s), Some(999_999.0));
        let mut busy = Filling::new(FILLS_MAX);
        for index in 0..1_000_001 {
            let held_j = if index == 777_777 {
                900.0
            } else {
                f64::from(index % 5)
            };
            busy.add(at(f64::from(index), held_j, -f64::from(index)));
        }
        assert!(busy.list().len() <= FILLS_MAX);
        let longest_s = busy.list().iter().map(|it| it.to_s - it.from_s);
        assert!(longest_s.fold(0.0, f64::max) <= 1001.0);
        let most_j = busy.list().iter().map(|it| it.held_j).fold(0.0, f64::max);
        assert_eq!(most_j, 900.0);
        assert_eq!(busy.list().last().map(|it| it.to_s), Some(1_000_000.0));
        assert!(
            busy.list()
                .windows(2)
                .all(|pair| pair[0].to_s <= pair[1].from_s)
        );
    }
}
