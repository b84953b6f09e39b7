//! What a program does, as far as `rs274` prints it: both sides become this.

use std::fmt::Write as _;

/// Letters of the axes that `rs274` prints.
pub const AXES: [u8; 6] = *b"XYZABC";

/// Half of the fourth decimal, with room for the sum of two roundings.
const PRINTED: f64 = 0.6e-4;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Rapid,
    Feed,
    Arc,
    Dwell,
}

const NAMES: [(&str, Kind); 4] = [
    ("rapid", Kind::Rapid),
    ("feed", Kind::Feed),
    ("arc", Kind::Arc),
    ("dwell", Kind::Dwell),
];

/// One move or dwell, in mm, degrees, minutes and seconds, machine coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    pub kind: Kind,
    pub end: [f64; 6],
    /// First and second axis of the plane of an arc.
    pub plane: [usize; 2],
    pub center: [f64; 2],
    /// As the canonical call has it: 1 for an arc of up to one turn
    /// counter-clockwise, -2 for one of more than one turn clockwise.
    pub turns: i64,
    /// mm/min, or degrees/min where only rotary axes move; unknown: not compared.
    pub feed: Option<f64>,
    pub seconds: f64,
    /// How far the printed lengths may be off, in mm.
    pub tolerance: f64,
}

impl Event {
    pub fn new(kind: Kind, end: [f64; 6]) -> Self {
        Self {
            kind,
            end,
            plane: [0, 1],
            center: [0.0; 2],
            turns: 0,
            feed: None,
            seconds: 0.0,
            tolerance: PRINTED,
        }
    }

    /// What differs between `rs274`'s event and ours.
    pub fn difference(&self, ours: &Self) -> Option<&'static str> {
        let near = |a: f64, b: f64| (a - b).abs() <= self.tolerance + 1e-9 * a.abs();
        if self.kind != ours.kind {
            return Some("kind");
        }
        if self.kind == Kind::Dwell {
            return (!near(self.seconds, ours.seconds)).then_some("duration");
        }
        if !self.end.iter().zip(ours.end).all(|(a, b)| near(*a, b)) {
            return Some("end");
        }
        if self.kind == Kind::Arc {
            if self.plane != ours.plane || self.turns != ours.turns {
                return Some("turns");
            }
            if !self
                .center
                .iter()
                .zip(ours.center)
                .all(|(a, b)| near(*a, b))
            {
                return Some("center");
            }
        }
        match (self.feed, ours.feed) {
            (Some(a), Some(b)) if (a - b).abs() > 2.0 * self.tolerance.max(PRINTED) + 1e-6 * a => {
                Some("feed")
            }
            _ => None,
        }
    }

    /// Whether it goes nowhere from `start`.
    fn stays(&self, start: &[f64; 6]) -> bool {
        matches!(self.kind, Kind::Rapid | Kind::Feed)
            && self
                .end
                .iter()
                .zip(start)
                .all(|(a, b)| (a - b).abs() <= 2.0 * self.tolerance)
    }
}

/// Compares two runs; moves that go nowhere may be left out by either.
pub fn compare(theirs: &[Event], ours: &[Event]) -> Result<(), String> {
    let mut at = [0.0; 6];
    let (mut i, mut j) = (0, 0);
    loop {
        let (a, b) = (theirs.get(i), ours.get(j));
        let found = match (a, b) {
            (None, None) => return Ok(()),
            (Some(a), Some(b)) => a.difference(b),
            _ => Some("number of moves"),
        };
        let Some(what) = found else {
            at = a.map_or(at, |event| event.end);
            (i, j) = (i + 1, j + 1);
            continue;
        };
        // Without the move that goes nowhere the rest may be the same.
        if a.is_some_and(|event| event.stays(&at)) {
            i += 1;
        } else if b.is_some_and(|event| event.stays(&at)) {
            j += 1;
        } else {
            let shown = |event: Option<&Event>| {
                event.map_or("(end)".to_owned(), |event| line(event, &[f64::NAN; 6]))
            };
            return Err(format!(
                "{what} of move {}: rs274 {} | gwatt {}",
                i + 1,
                shown(a),
                shown(b)
            ));
        }
    }
}

/// An event as a line: only axes that differ from `before`.
fn line(event: &Event, before: &[f64; 6]) -> String {
    let name = NAMES.iter().find(|(_, kind)| *kind == event.kind);
    let mut out = name.map_or("", |(name, _)| name).to_owned();
    if event.kind == Kind::Dwell {
        let _ = write!(out, " P{:.4}", event.seconds);
        return out;
    }
    for (axis, letter) in AXES.iter().enumerate() {
        if event.end[axis] != before[axis] {
            let _ = write!(out, " {}{:.5}", *letter as char, event.end[axis]);
        }
    }
    if event.kind == Kind::Arc {
        let plane = event.plane.map(|axis| AXES[axis] as char);
        let [i, j] = event.center;
        let _ = write!(
            out,
            " {}{} I{i:.5} J{j:.5} R{}",
            plane[0], plane[1], event.turns
        );
    }
    if let Some(feed) = event.feed {
        let _ = write!(out, " F{feed:.4}");
    }
    if event.tolerance > PRINTED {
        let _ = write!(out, " ~{:.5}", event.tolerance);
    }
    out
}

/// Events as a text that [`parse`] reads.
pub fn text(events: &[Event]) -> String {
    let mut out = String::new();
    let mut at = [0.0; 6];
    for event in events {
        out += &line(event, &at);
        out.push('\n');
        if event.kind != Kind::Dwell {
            at = event.end;
        }
    }
    out
}

/// Reads what [`text`] wrote.
pub fn parse(text: &str) -> Vec<Event> {
    let mut at = [0.0; 6];
    let mut events = Vec::new();
    for line in text.lines() {
        let mut words = line.split(' ');
        let name = words.next().unwrap_or_default();
        let Some((_, kind)) = NAMES.iter().find(|(known, _)| *known == name) else {
            panic!("`{name}` is no event");
        };
        let mut event = Event::new(*kind, at);
        let axis_of = |letter: u8| AXES.iter().position(|axis| *axis == letter);
        for word in words {
            let (letter, rest) = word.split_at(1);
            let letter = letter.as_bytes()[0];
            let value = || rest.parse::<f64>().expect("a number");
            match letter {
                b'P' => event.seconds = value(),
                b'I' => event.center[0] = value(),
                b'J' => event.center[1] = value(),
                b'R' => event.turns = rest.parse().expect("a number"),
                b'F' => event.feed = Some(value()),
                b'~' => event.tolerance = value(),
                _ => match (axis_of(letter), axis_of(rest.as_bytes()[0])) {
                    (Some(first), Some(second)) => event.plane = [first, second],
                    (Some(axis), None) => event.end[axis] = value(),
                    _ => panic!("`{word}` is no word of an event"),
                },
            }
        }
        at = event.end;
        events.push(event);
    }
    events
}
