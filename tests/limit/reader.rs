//! A reader of plain programs, apart from the one under test: G0 to G4, G20,
//! G21, G90, G91, F, X, Y, I, J, P.

/// A move, in mm and mm/min.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Move {
    pub(super) start: [f64; 2],
    pub(super) end: [f64; 2],
    /// Centre as an offset from the start, and whether it turns clockwise.
    pub(super) arc: Option<([f64; 2], bool)>,
    /// Time of a dwell.
    pub(super) dwell: Option<f64>,
    /// F, or nothing for a rapid.
    pub(super) feed: Option<f64>,
}

impl Move {
    /// The geometry alone.
    pub(super) fn path(&self) -> Self {
        Self {
            feed: None,
            ..self.clone()
        }
    }

    pub(super) fn length(&self) -> f64 {
        libm::hypot(self.end[0] - self.start[0], self.end[1] - self.start[1])
    }
}

/// The words of a line without comments.
fn words(line: &str) -> Vec<(char, f64)> {
    let mut plain = String::new();
    let mut depth = false;
    for c in line.chars() {
        match c {
            '(' => depth = true,
            ')' => depth = false,
            ';' => break,
            '%' | ' ' | '\t' => {}
            c if !depth => plain.push(c.to_ascii_uppercase()),
            _ => {}
        }
    }
    let mut words = Vec::new();
    let starts: Vec<usize> = plain
        .char_indices()
        .filter(|(_, c)| c.is_ascii_alphabetic())
        .map(|(at, _)| at)
        .collect();
    for (index, &start) in starts.iter().enumerate() {
        let end = starts.get(index + 1).copied().unwrap_or(plain.len());
        let letter = plain.as_bytes()[start] as char;
        words.push((letter, plain[start + 1..end].parse().expect("a number")));
    }
    words
}

/// All moves of a program.
pub(super) fn read(program: &str) -> Vec<Move> {
    let mut moves = Vec::new();
    let (mut at, mut unit, mut absolute) = ([0.0_f64; 2], 1.0, true);
    let (mut motion, mut feed) = (0, 0.0);
    for line in program.split(['\r', '\n']) {
        let words = words(line);
        let value = |letter| words.iter().find(|w| w.0 == letter).map(|w| w.1);
        let codes: Vec<i64> = words
            .iter()
            .filter(|word| word.0 == 'G')
            .map(|word| word.1 as i64)
            .collect();
        for code in &codes {
            match code {
                0..=3 => motion = *code,
                20 => unit = 25.4,
                21 => unit = 1.0,
                90 => absolute = true,
                91 => absolute = false,
                _ => {}
            }
        }
        if let Some(value) = value('F') {
            feed = value * unit;
        }
        let mut mv = Move {
            start: at,
            end: at,
            arc: None,
            dwell: None,
            feed: (motion != 0).then_some(feed),
        };
        if codes.contains(&4) {
            mv.dwell = value('P');
            mv.feed = None;
            moves.push(mv);
            continue;
        }
        if value('X').is_none() && value('Y').is_none() {
            continue;
        }
        for (axis, letter) in [(0, 'X'), (1, 'Y')] {
            if let Some(value) = value(letter) {
                let base = if absolute { 0.0 } else { at[axis] };
                mv.end[axis] = base + value * unit;
            }
        }
        if motion >= 2 {
            let offset = ['I', 'J'].map(|letter| value(letter).unwrap_or(0.0) * unit);
            mv.arc = Some((offset, motion == 2));
        }
        at = mv.end;
        moves.push(mv);
    }
    moves
}
