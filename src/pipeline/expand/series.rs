//! Series of cycle blocks, and what their lines become.

use std::collections::BTreeMap;

/// What the lines of one series of cycle blocks become, or why they stay, with the line.
pub(super) type Lines = Result<BTreeMap<u64, Vec<u8>>, (u64, &'static str)>;

/// One series of cycle blocks, from the one that begins the cycle to the one that ends it;
/// or one block that returns to the reference point.
pub(super) struct Series {
    /// What is said where it stays as it is.
    pub(super) stays: &'static str,
    /// Its lines, with their N words.
    pub(super) numbers: BTreeMap<u64, Option<f64>>,
    pub(super) written_out: Lines,
    pub(super) placed: Lines,
    /// Its first block with the level to return to, which an earlier block may have set.
    pub(super) level: Option<(u64, Vec<u8>)>,
    /// The words that hold until the cycle ends, by letter.
    pub(super) held: BTreeMap<u8, Vec<u8>>,
}

impl Default for Series {
    fn default() -> Self {
        Self {
            stays: "the canned cycle is not written out",
            numbers: BTreeMap::new(),
            written_out: Ok(BTreeMap::new()),
            placed: Ok(BTreeMap::new()),
            level: None,
            held: BTreeMap::new(),
        }
    }
}

/// Why a line that runs several times stays as it is.
const EACH_TIME: &str = "it does something else each time it runs";

impl Series {
    pub(super) fn refuse(&mut self, line: u64, why: &'static str) {
        self.numbers.entry(line).or_default();
        self.written_out = Err((line, why));
        self.placed = Err((line, why));
    }

    /// Takes over another one that shares lines with it.
    pub(super) fn join(&mut self, other: Self) {
        self.numbers.extend(other.numbers);
        for (own, other) in [
            (&mut self.written_out, other.written_out),
            (&mut self.placed, other.placed),
        ] {
            match other {
                Ok(lines) => {
                    for (number, bytes) in lines {
                        add(own, number, Ok(bytes));
                    }
                }
                Err(why) => *own = Err(why),
            }
        }
    }
}

/// Takes what a line becomes, which is the same in all its runs.
pub(super) fn add(lines: &mut Lines, number: u64, bytes: Result<Vec<u8>, &'static str>) {
    let Ok(known) = lines else { return };
    match bytes {
        Ok(bytes) => {
            if known.get(&number).is_some_and(|before| *before != bytes) {
                *lines = Err((number, EACH_TIME));
            } else {
                known.insert(number, bytes);
            }
        }
        Err(why) => *lines = Err((number, why)),
    }
}
