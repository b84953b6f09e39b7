//! Moves that wait, by number; their room is used again in place.
//!
//! The ring is no larger than need be: what is used again soon is still in the
//! processor's nearest cache.

use super::open::Open;
use crate::demand::Want;
use crate::duty_cycle::Buffered;
use gwatt_motion::Move;

/// A smaller ring is no gain.
const RING_MIN: usize = 8;

/// Moves that wait, in program order.
#[derive(Debug)]
pub(super) struct Queue {
    /// The move of number n lies at n modulo the size of the ring, a power of two;
    /// after the ring there is room for a larger one.
    slots: Vec<Option<Box<Open>>>,
    ring: usize,
    /// The first that waits, and the next that comes.
    first: u64,
    end: u64,
    /// The one that moved and was passed on last, unless what comes next begins at
    /// rest; it is room then.
    before: Option<Box<Open>>,
    has_before: bool,
}

/// A move on its way out.
pub(super) struct Leaving<'a> {
    pub before: Option<&'a Open>,
    pub own: &'a mut Open,
    pub next: Option<&'a Open>,
}

impl Queue {
    pub fn new() -> Self {
        Self {
            slots: vec![None],
            ring: 1,
            first: 0,
            end: 0,
            before: None,
            has_before: false,
        }
    }

    /// The number of the first that waits.
    pub fn first(&self) -> u64 {
        self.first
    }

    /// The number of the next that comes.
    pub fn end(&self) -> u64 {
        self.end
    }

    pub fn len(&self) -> usize {
        (self.end - self.first) as usize
    }

    pub fn is_empty(&self) -> bool {
        self.first == self.end
    }

    #[inline]
    fn slot(&self, number: u64) -> usize {
        number as usize & (self.ring - 1)
    }

    #[inline]
    fn waits(&self, number: u64) -> bool {
        self.first <= number && number < self.end
    }

    /// A move that waits.
    #[inline]
    pub fn get(&self, number: u64) -> Option<&Open> {
        let slot = self.slots.get(self.slot(number))?;
        slot.as_deref().filter(|_| self.waits(number))
    }

    /// The same, to be changed.
    #[inline]
    pub fn get_mut(&mut self, number: u64) -> Option<&mut Open> {
        let (slot, waits) = (self.slot(number), self.waits(number));
        let slot = self.slots.get_mut(slot)?;
        slot.as_deref_mut().filter(|_| waits)
    }

    /// Takes what is kept of a move over time.
    pub fn take_kept(&mut self, number: u64) -> Buffered {
        let open = self.get_mut(number);
        open.map_or_else(Buffered::default, |open| std::mem::take(&mut open.kept))
    }

    /// The last one.
    #[inline]
    pub fn back(&self) -> Option<&Open> {
        self.get(self.end.checked_sub(1)?)
    }

    /// The same, to be changed.
    #[inline]
    pub fn back_mut(&mut self) -> Option<&mut Open> {
        self.get_mut(self.end.checked_sub(1)?)
    }

    /// Adds a move of which no piece is planned yet.
    #[inline]
    pub fn push(&mut self, mv: &Move, text: &[u8], want: Want) -> &mut Open {
        if self.len() == self.ring {
            self.grow();
        }
        let slot = self.slot(self.end);
        self.end += 1;
        match &mut self.slots[slot] {
            Some(open) => {
                open.renew(mv, text, want);
                open
            }
            room => room.insert(Box::new(Open::new(mv, text, want))),
        }
    }

    #[cold]
    fn grow(&mut self) {
        if self.ring == self.slots.len() {
            self.slots.resize_with(2 * self.ring, || None);
        }
        self.resize(2 * self.ring);
    }

    /// Makes the ring smaller by half, where a quarter is enough.
    #[cold]
    fn shrink(&mut self) {
        if self.ring > RING_MIN && 4 * self.len() <= self.ring {
            self.resize(self.ring / 2);
        }
    }

    /// Those that wait fit into both rings.
    fn resize(&mut self, ring: usize) {
        let before = self.ring;
        self.ring = ring;
        for number in self.first..self.end {
            let slot = self.slot(number);
            self.slots.swap(number as usize & (before - 1), slot);
        }
    }

    /// The first that waits, between the one before it and another that waits.
    #[inline]
    pub fn leaving(&mut self, next: Option<u64>) -> Option<Leaving<'_>> {
        if self.is_empty() {
            return None;
        }
        let before = self.before.as_deref().filter(|_| self.has_before);
        let own = self.slot(self.first);
        let Some(next) = next else {
            let own = self.slots.get_mut(own)?.as_deref_mut()?;
            return Some(Leaving {
                before,
                own,
                next: None,
            });
        };
        let next = self.slot(next);
        let [own, next] = self.slots.get_disjoint_mut([own, next]).ok()?;
        Some(Leaving {
            before,
            own: own.as_deref_mut()?,
            next: next.as_deref(),
        })
    }

    /// Forgets the first that waits.
    #[inline]
    pub fn pass(&mut self) {
        self.first += u64::from(!self.is_empty());
    }

    /// The first that waits is now the one before.
    #[inline]
    pub fn leave(&mut self) {
        if !self.is_empty() {
            let slot = self.slot(self.first);
            std::mem::swap(&mut self.slots[slot], &mut self.before);
            self.has_before = true;
            self.first += 1;
            if slot == 0 {
                self.shrink();
            }
        }
    }

    /// What comes next begins at rest.
    pub fn begin_at_rest(&mut self) {
        self.has_before = false;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample::any_move;
    use gwatt_machine::Machine;

    const MACHINE: &str = "schema = 1\nname = \"test\"\ncontroller = \"linuxcnc\"\n\
         [converter]\npeak_power_w = 1e6\n\
         [axes.X]\nkind = \"linear\"\nrapid_mm_min = 3000\naccel_mm_s2 = 200\nmass_kg = 10\n\
         [axes.Y]\nkind = \"linear\"\nrapid_mm_min = 3000\naccel_mm_s2 = 200\nmass_kg = 10\n";

    /// Each move is found by its number, however the ring grows and shrinks.
    #[test]
    fn moves_stay_where_they_are_found() {
        let (machine, _) = Machine::from_toml("test.toml", MACHINE).expect("a machine");
        let (mut queue, mut mv) = (Queue::new(), any_move(&machine));
        let check = |queue: &Queue| {
            for number in queue.first()..queue.end() {
                assert_eq!(queue.get(number).unwrap().mv.line, number);
            }
            assert!(queue.get(queue.end()).is_none());
        };
        for waiting in [1, 3, 100, 2, 40, 0, 9, 1] {
            while queue.len() < waiting {
                mv.line = queue.end();
                queue.push(&mv, b"", Want::ALL);
                check(&queue);
            }
            for _ in 0..200 {
                mv.line = queue.end();
                queue.push(&mv, b"", Want::ALL);
                while queue.len() > waiting {
                    queue.leave();
                    let before = queue.before.as_ref().unwrap();
                    assert_eq!(before.mv.line + 1, queue.first());
                }
                check(&queue);
            }
            assert!(queue.ring < 8 * waiting.max(RING_MIN), "{}", queue.ring);
        }
        assert_eq!(queue.slots.len(), 128);
    }
}
