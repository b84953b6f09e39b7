//! The calls that `rs274` prints, to events in machine coordinates.
//!
//! Positions of its calls are program coordinates without offsets; the calls
//! give the offsets in force: G92, then the rotation, then the work offset and
//! the tool (LinuxCNC, "Coordinate Systems").

use super::event::{Event, Kind};

/// What the calls have set.
#[derive(Debug)]
struct Canon {
    mm_per_unit: f64,
    plane: [usize; 3],
    work: [f64; 6],
    g92: [f64; 6],
    tool: [f64; 6],
    /// Offsets that are not zero add their roundings.
    roundings: f64,
    rotation_deg: f64,
    /// As called, and in mm.
    feed: [f64; 2],
    per_revolution: bool,
    /// The feed follows the spindle: its value says nothing.
    synchronous: bool,
    rpm: f64,
    at: [f64; 6],
    events: Vec<Event>,
}

/// The events of a printed run, or the call that says too little.
pub fn events(printed: &str) -> Result<Vec<Event>, String> {
    let mut canon = Canon {
        mm_per_unit: 25.4,
        plane: [0, 1, 2],
        work: [0.0; 6],
        g92: [0.0; 6],
        tool: [0.0; 6],
        roundings: 0.0,
        rotation_deg: 0.0,
        feed: [0.0; 2],
        per_revolution: false,
        synchronous: false,
        rpm: 0.0,
        at: [0.0; 6],
        events: Vec::new(),
    };
    for line in printed.lines() {
        // "   12 N..... STRAIGHT_FEED(1.0000, …)"
        let mut parts = line.trim_start().splitn(3, ' ');
        let numbered = parts
            .next()
            .is_some_and(|number| number.parse::<u64>().is_ok());
        let call = parts.nth(1).unwrap_or_default().trim_start();
        let Some((name, rest)) = call.split_once('(').filter(|_| numbered) else {
            continue;
        };
        canon.call(name, rest.trim_end().trim_end_matches(')'))?;
    }
    Ok(canon.events)
}

fn numbers<const N: usize>(text: &str) -> [f64; N] {
    let mut values = [0.0; N];
    for (value, part) in values
        .iter_mut()
        .zip(text.split([',', ' ']).filter(|part| !part.is_empty()))
    {
        *value = part.parse().unwrap_or(f64::NAN);
    }
    values
}

impl Canon {
    fn call(&mut self, name: &str, arguments: &str) -> Result<(), String> {
        match name {
            "USE_LENGTH_UNITS" => {
                self.mm_per_unit = if arguments.contains("INCH") {
                    25.4
                } else {
                    1.0
                };
            }
            "SELECT_PLANE" => {
                self.plane = match arguments.rsplit('_').next() {
                    Some("XZ") => [2, 0, 1],
                    Some("YZ") => [1, 2, 0],
                    _ => [0, 1, 2],
                };
            }
            "SET_G5X_OFFSET" => {
                let [_, offset @ ..] = numbers::<7>(arguments);
                self.work = self.lengths(offset);
            }
            "SET_G92_OFFSET" => self.g92 = self.lengths(numbers(arguments)),
            "USE_TOOL_LENGTH_OFFSET" => {
                // X Y Z A B C U V W
                let [x, y, z, a, b, c] = numbers::<6>(arguments);
                self.tool = self.lengths([x, y, z, a, b, c]);
            }
            "SET_XY_ROTATION" => [self.rotation_deg] = numbers(arguments),
            "SET_FEED_RATE" => {
                let [rate] = numbers(arguments);
                self.feed = [rate, rate * self.mm_per_unit];
            }
            "SET_FEED_MODE" => {
                let [_, mode] = numbers::<2>(arguments);
                self.per_revolution = mode != 0.0;
            }
            "SET_SPINDLE_SPEED" => {
                let [_, rpm] = numbers::<2>(arguments);
                self.rpm = rpm.abs();
            }
            "START_SPEED_FEED_SYNCH" => self.synchronous = true,
            "STOP_SPEED_FEED_SYNCH" => self.synchronous = false,
            "STRAIGHT_TRAVERSE" => self.straight(Kind::Rapid, numbers(arguments)),
            "STRAIGHT_FEED" => self.straight(Kind::Feed, numbers(arguments)),
            "ARC_FEED" => self.arc(numbers(arguments)),
            "DWELL" => {
                let mut event = Event::new(Kind::Dwell, self.at);
                [event.seconds] = numbers(arguments);
                self.events.push(event);
            }
            "NURBS_FEED" | "STRAIGHT_PROBE" | "RIGID_TAP" => return Err(name.to_owned()),
            _ => {}
        }
        self.roundings = [&self.work, &self.g92, &self.tool]
            .iter()
            .filter(|offset| offset.iter().any(|value| *value != 0.0))
            .count() as f64;
        Ok(())
    }

    /// Lengths to mm; A B C are degrees.
    fn lengths(&self, mut values: [f64; 6]) -> [f64; 6] {
        for value in &mut values[..3] {
            *value *= self.mm_per_unit;
        }
        values
    }

    /// A place in mm and degrees, machine coordinates.
    fn place(&self, values: [f64; 6]) -> [f64; 6] {
        let mut values = self.lengths(values);
        for (value, offset) in values.iter_mut().zip(self.g92) {
            *value += offset;
        }
        if self.rotation_deg != 0.0 {
            let (sin, cos) = libm::sincos(self.rotation_deg.to_radians());
            let [x, y, ..] = values;
            values[0] = x * cos - y * sin;
            values[1] = x * sin + y * cos;
        }
        for (axis, value) in values.iter_mut().enumerate() {
            *value += self.work[axis] + self.tool[axis];
        }
        values
    }

    fn event(&self, kind: Kind, end: [f64; 6]) -> Event {
        let mut event = Event::new(kind, end);
        event.tolerance *= self.mm_per_unit * (1.0 + self.roundings);
        if kind != Kind::Rapid && !self.synchronous {
            let linear = (0..3).any(|axis| (end[axis] - self.at[axis]).abs() > event.tolerance);
            let turns = (3..6).any(|axis| (end[axis] - self.at[axis]).abs() > event.tolerance);
            let rate = self.feed[usize::from(linear || kind == Kind::Arc)];
            // What moves so little may be all of it rounding.
            let known = linear || turns || kind == Kind::Arc;
            let per_minute = if self.per_revolution { self.rpm } else { 1.0 };
            event.feed = known.then_some(rate * per_minute);
        }
        event
    }

    fn straight(&mut self, kind: Kind, values: [f64; 6]) {
        let event = self.event(kind, self.place(values));
        self.at = event.end;
        self.events.push(event);
    }

    fn arc(&mut self, call: [f64; 9]) {
        let [first, second, i, j, turns, third, a, b, c] = call;
        let point = |one: f64, two: f64| {
            let mut values = [0.0, 0.0, 0.0, a, b, c];
            for (axis, value) in self.plane.into_iter().zip([one, two, third]) {
                values[axis] = value;
            }
            self.place(values)
        };
        let center = point(i, j);
        let mut event = self.event(Kind::Arc, point(first, second));
        event.plane = [self.plane[0], self.plane[1]];
        event.center = event.plane.map(|axis| center[axis]);
        event.turns = turns as i64;
        self.at = event.end;
        self.events.push(event);
    }
}
