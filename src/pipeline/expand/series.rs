//! Series of cycle blocks, and what their lines become.

use std::collections::BTreeMap;

/// Why a line stays as it is.
pub(super) type Refused = (u64, &'static str);

/// What the lines of a series become that change; or why the series stays.
pub(super) type Settled = Result<BTreeMap<u64, Vec<u8>>, Refused>;

/// What lines of a series become, or why they stay.
#[derive(Debug, Clone, Default)]
pub(super) struct Lines(BTreeMap<u64, Result<Vec<u8>, &'static str>>);

impl Lines {
    /// Takes what a line becomes, which is the same in all its runs.
    pub(super) fn add(&mut self, number: u64, bytes: Result<Vec<u8>, &'static str>) {
        let known = self.0.entry(number).or_insert_with(|| bytes.clone());
        match (&known, bytes) {
            (Ok(before), Ok(bytes)) if *before != bytes => *known = Err(EACH_TIME),
            (Ok(_), Err(why)) => *known = Err(why),
            _ => {}
        }
    }
}

impl From<Settled> for Lines {
    fn from(lines: Settled) -> Self {
        Self(match lines {
            Ok(lines) => lines
                .into_iter()
                .map(|(at, bytes)| (at, Ok(bytes)))
                .collect(),
            Err((line, why)) => BTreeMap::from([(line, Err(why))]),
        })
    }
}

/// One series of cycle blocks, from the one that begins the cycle to the one that ends it;
/// or one block that returns to the reference point.
pub(super) struct Series {
    /// What is said where it stays as it is.
    pub(super) stays: &'static str,
    /// Its lines, with their N words.
    pub(super) numbers: BTreeMap<u64, Option<f64>>,
    pub(super) written_out: Lines,
    pub(super) placed: Lines,
    /// Its blocks as they stay where others before them change: with all words of the cycle.
    /// Without them the series changes as a whole or not at all.
    pub(super) restated: BTreeMap<u64, Option<Vec<u8>>>,
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
            written_out: Lines::default(),
            placed: Lines::default(),
            restated: BTreeMap::new(),
            level: None,
            held: BTreeMap::new(),
        }
    }
}

/// Why a line that runs several times stays as it is.
pub(super) const EACH_TIME: &str = "it does something else each time it runs";

impl Series {
    pub(super) fn refuse(&mut self, line: u64, why: &'static str) {
        self.numbers.entry(line).or_default();
        self.written_out.add(line, Err(why));
        self.placed.add(line, Err(why));
    }

    /// All of it stays as it is.
    pub(super) fn refuse_all(&mut self, why: &'static str) {
        (self.placed, self.written_out) = (Lines::default(), Lines::default());
        self.restated.clear();
        if let Some(first) = self.numbers.keys().next().copied() {
            self.refuse(first, why);
        }
    }

    /// The cycle of its blocks so far has to stay in force.
    pub(super) fn keep_cycle(&mut self, why: &'static str) {
        for line in self.numbers.keys() {
            self.written_out.add(*line, Err(why));
        }
    }

    /// Takes a block as it stays, which is the same in all its runs.
    pub(super) fn restate(&mut self, line: u64, bytes: Option<&Vec<u8>>) {
        let known = self.restated.entry(line).or_insert_with(|| bytes.cloned());
        if known.as_ref() != bytes {
            *known = None;
        }
    }

    /// Whether one of its lines does something else each time it runs.
    pub(super) fn differs(&self) -> bool {
        let mut all = self.placed.0.values().chain(self.written_out.0.values());
        all.any(|line| *line == Err(EACH_TIME))
    }

    /// Takes over another one that shares lines with it.
    pub(super) fn join(&mut self, other: Self) {
        self.numbers.extend(other.numbers);
        for (own, other) in [
            (&mut self.written_out, other.written_out),
            (&mut self.placed, other.placed),
        ] {
            for (number, bytes) in other.0 {
                own.add(number, bytes);
            }
        }
        for (number, bytes) in other.restated {
            self.restate(number, bytes.as_ref());
        }
    }

    /// What its lines become, with all their moves as single blocks or with the ways to the
    /// holes alone; blocks that cannot be changed keep the cycle. The second result says why
    /// those stay.
    ///
    /// # Errors
    /// Why the series stays as it is.
    pub(super) fn settle(&self, all_moves: bool) -> (Settled, Vec<Refused>) {
        let mut refused = Vec::new();
        let mut lines = BTreeMap::new();
        for number in self.numbers.keys() {
            let placed = self.placed.0.get(number);
            let written_out = self.written_out.0.get(number).filter(|_| all_moves);
            if let Some(Err(why)) = written_out {
                refused.push((*number, *why));
            }
            let written_out = written_out.filter(|lines| lines.is_ok());
            match written_out.or(placed) {
                Some(Ok(bytes)) => {
                    lines.insert(*number, bytes.clone());
                }
                Some(Err(why)) if !refused.iter().any(|(line, _)| line == number) => {
                    refused.push((*number, *why));
                }
                _ => {}
            }
        }
        let first = lines.keys().next().copied();
        let Some(first) = first else {
            let why = refused.first().copied();
            return (why.map_or(Ok(lines), Err), refused);
        };
        for (number, why) in &refused {
            if lines.contains_key(number) {
                continue;
            }
            match self.restated.get(number) {
                Some(Some(bytes)) if *number > first => {
                    lines.insert(*number, bytes.clone());
                }
                Some(_) if *number < first => {}
                _ => return (Err((*number, why)), refused),
            }
        }
        (Ok(lines), refused)
    }
}
