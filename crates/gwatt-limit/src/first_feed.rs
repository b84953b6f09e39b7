//! The F that stands where none was in force: one for all blocks that count on none.

use super::change::round_feed_down;
use gwatt_machine::units::SECONDS_PER_MINUTE;

/// An F in the units of one block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FirstFeed {
    /// In program units per minute.
    pub value: f64,
    mm_per_unit: f64,
}

impl FirstFeed {
    /// An F of a block whose unit has `mm_per_unit` millimetres, but no more than `most_mm_s`.
    #[must_use]
    pub fn at_most(value: f64, mm_per_unit: f64, most_mm_s: f64) -> Self {
        let most = most_mm_s * SECONDS_PER_MINUTE / mm_per_unit;
        let value = if value > most {
            round_feed_down(most)
        } else {
            value
        };
        Self { value, mm_per_unit }
    }

    /// The lower one of two.
    #[must_use]
    pub fn lower(self, other: Self) -> Self {
        if other.value * other.mm_per_unit < self.value * self.mm_per_unit {
            other
        } else {
            self
        }
    }

    /// The same F in a block with another unit, rounded down.
    #[must_use]
    pub fn in_units(self, mm_per_unit: f64) -> f64 {
        if mm_per_unit == self.mm_per_unit {
            return self.value;
        }
        round_feed_down(self.value * self.mm_per_unit / mm_per_unit)
    }
}

#[cfg(test)]
mod tests {
    use super::FirstFeed;

    #[test]
    fn the_lowest_counts_in_every_unit() {
        let first = FirstFeed::at_most(6000.0, 1.0, 25.0);
        assert_eq!(first.value, 1500.0);
        let inches = FirstFeed::at_most(50.0, 25.4, f64::INFINITY);
        let lowest = first.lower(inches);
        assert_eq!(lowest.in_units(25.4), 50.0);
        assert_eq!(lowest.in_units(1.0), 1270.0);
        assert_eq!(inches.lower(first), lowest);
    }
}
